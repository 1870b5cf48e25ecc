//! Makes the stroke of a particle in a view: size, presence, mark, paint.

use glam::{DVec2, DVec3};
use impasto_core::ScreenMap;
use impasto_core::angle::wrap_pi;
use impasto_core::hash;
use impasto_core::lift::PixelMap2;
use impasto_core::presence::{self, smoothstep};
use impasto_core::solve::SeenParticle;
use impasto_scene::document::{Edges, Solver};
use impasto_scene::presets::{LayerKind, ResolvedLayer, ResolvedStrokes};

use crate::brushes;
use crate::counts::most_wanted;
use crate::frame::{Mixing, Paint, Stroke, StrokeSource};
use crate::frame_options::{Rotation, StrokeColors};
use crate::looks::Look;
use crate::order::OrderEntry;
use crate::painting_view::{CoatView, PaintingView, PlacedParticle};
use crate::parts::{fit_of, wanted_where_small};
use crate::presence_bound::LEAST_COUNTED_FADE;
use crate::stroke_size::{LENGTH_SHARE, WIDTH_SHARE, reach_px};
use crate::traits::{
    BEND, BOW, DRYNESS_JITTER, LENGTH_JITTER, SIZE_JITTER, THICKNESS_JITTER, USUAL_JITTER_DEG, WIDTH_JITTER,
};

/// Standard deviation of the logarithm of a stroke's thickness.
const THICKNESS_DEVIATION: f32 = 0.2;

/// The bow in half widths: its standard deviation at the usual angle jitter, and its largest value.
const BOW_DEVIATION: f32 = 0.35;
const MOST_BOW: f32 = 0.9;

/// Chance multiplies a stroke's bend by a factor. This is the standard deviation of the factor's logarithm, as a share
/// of the size jitter.
const BEND_SHARE: f32 = 1.5;

/// How strongly the slow noise of edges changes the overrun.
const EDGE_SWING: f32 = 0.6;

/// The `supply_ln` (see [`presence::of_supply`]) of a stroke that is present whatever its rank.
const WHOLE: f32 = 8.0;

/// A particle that may show, with the values that its stroke depends on.
pub(crate) struct Candidate {
    pub(crate) entry: OrderEntry,
    /// Index in the painting order.
    pub(crate) place: u32,
    pub(crate) seen: SeenParticle,
    pub(crate) region: u16,
    pub(crate) part: usize,
    pub(crate) bits: u32,
    /// Its look, if it was known when the candidate was chosen.
    pub(crate) look: Option<Look>,
    pub(crate) albedo_srgb8: u32,
}

/// The size of a particle's stroke, and what its presence follows from.
struct Supplied {
    /// Length and width, pixels at the scene's own size, before chance changes them.
    size_px: [f32; 2],
    /// How boldly the stroke's colours are mixed, 0..=1.
    boldness: f32,
    supply_ln: f32,
}

impl PaintingView<'_> {
    /// Whether the stroke of a particle may be present, judged without its look.
    pub(crate) fn may_be_present(&self, candidate: &Candidate) -> bool {
        // With 1, no scumble is left out: patches can only make it rarer.
        self.supplied(candidate, 1.0).is_some()
    }

    /// The size and the supply of a particle's stroke; `None` if the stroke is absent, whichever way its surface faces.
    /// `patches` is how much scumble is wanted, 0..=1.
    fn supplied(&self, candidate: &Candidate, patches: f32) -> Option<Supplied> {
        let &Candidate { entry, ref seen, region, part, .. } = candidate;
        let (coat_view, index) = (&self.coats[entry.coat as usize], entry.particle as usize);
        let coat = coat_view.coat;
        let strokes = self.strokes_of(region);
        let layer = strokes.layer_of(coat.kind);
        if layer.coverage <= 0.0 {
            return None;
        }
        let cap = self.painting.bodies[coat.object].caps[part];
        let grown = coat_view.growth(index, self);
        let size_px = [layer.length_px, layer.width_px];
        let form = coat.traits.form(index);
        let size_px = cap.fitted(size_px, form, fit_of(coat.kind, strokes.fit));
        // A stroke that is smaller than its layer states carries less paint, mixed less boldly.
        let boldness = (size_px[1] / layer.width_px).clamp(0.2, 1.0).sqrt();
        let wanted = wanted_where_small(coat.kind, size_px[1] / layer.width_px);
        let painted = coat.amounts.of(index);
        let size_px = [size_px[0] * grown * painted.length, size_px[1] * grown * painted.width];
        let supply_ln = match (&coat_view.shown, &coat.sampled.polygons) {
            (Some(shown), Some(polygons)) if polygons.is_shown(shown, index) => WHOLE,
            (Some(_), _) => return None,
            _ => {
                let wanted_per_px =
                    layer.coverage * patches * wanted * painted.density / (size_px[0] * size_px[1]);
                self.supply_ln(coat_view, index, seen.area_px, wanted_per_px)
            }
        };
        let most_ln = supply_ln + most_wanted(coat.kind).ln() - LEAST_COUNTED_FADE.ln();
        (most_ln > presence::ABSENT_LN).then_some(Supplied { size_px, boldness, supply_ln })
    }

    /// The stroke of a particle; `None` if it cannot show, whatever the resolve shader would find there.
    pub(crate) fn stroke(&self, candidate: &Candidate) -> Option<(Stroke, StrokeSource)> {
        let &Candidate { entry, place, ref seen, region, bits, .. } = candidate;
        let (coat_view, index) = (&self.coats[entry.coat as usize], entry.particle as usize);
        let coat = coat_view.coat;
        let strokes = self.strokes_of(region);
        let layer = strokes.layer_of(coat.kind);
        let look = candidate.look.unwrap_or_else(|| coat_view.look(index));
        let drift = look.drift;
        let patches = if coat.kind == LayerKind::Scumble { patch(drift[1]) } else { 1.0 };
        let Supplied { size_px, boldness, supply_ln } = self.supplied(candidate, patches)?;
        let placed = coat_view.placed(index, &look);
        let &PlacedParticle { position, normal, lift, .. } = &placed;
        let jacobian = coat_view.map.jacobian(position);
        let facing = coat_view.map.facing(jacobian, normal) as f32;
        if facing <= 0.0 {
            return None;
        }
        // With the source paper's rule, no stroke fades. With ours, more strokes make up for those that fade.
        let facing_fade = if coat_view.shown.is_some() { 1.0 } else { presence::of_facing(facing) };
        let supply_ln = supply_ln - facing_fade.max(LEAST_COUNTED_FADE).ln();
        if supply_ln + most_wanted(coat.kind).ln() <= presence::ABSENT_LN {
            return None;
        }
        let lift = match self.painting.solver {
            Solver::Tangent => lift,
            Solver::Horn | Solver::HornExact => coat_view.surface_lift(index),
        };
        let map: PixelMap2 = lift.map(jacobian);
        let angle_rad = along_contour(
            self.angle_rad(coat_view, index, &placed),
            strokes.contour,
            normal,
            &coat_view.map,
            facing,
        );
        let chance = Chance { bits };
        let size_px = chance.size_px(size_px, strokes.size_jitter).map(|side| side * self.px_scale);
        let boiled =
            self.boil(strokes).filter(|_| coat.kind != LayerKind::Underpainting).map(|boil| boil.of(bits));
        let size_px =
            boiled.map_or(size_px, |boiled| [size_px[0] * boiled.size[0], size_px[1] * boiled.size[1]]);
        let angle_rad =
            boiled.map_or(angle_rad, |boiled| wrap_pi(f64::from(angle_rad + boiled.turn_rad)) as f32);
        let drift = boiled.map_or(drift, |boiled| [drift[0] + boiled.drift, drift[1]]);
        let shift_px = boiled.map_or([0.0; 2], |boiled| boiled.shift_px(angle_rad, size_px));
        let flat = Outline { angle_rad, length_px: size_px[0], width_px: size_px[1], skew: 0.0 };
        let Outline { angle_rad, length_px, width_px, skew } = match self.rotation {
            Rotation::Mapped => {
                let base = coat_view.base_angle_rad(index);
                let lift = match self.painting.solver {
                    Solver::Horn | Solver::HornExact => lift.turned(base),
                    Solver::Tangent => lift,
                };
                mapped(lift.map(jacobian), flat, f64::from(self.px_scale))
            }
            Rotation::On | Rotation::Off | Rotation::Random => flat,
        };
        let (taper, bend_rad) = taper_and_bend(coat.kind, strokes);
        // A stroke that bends may reach its whole length along either axis.
        let (sin, cos) = if bend_rad == 0.0 { angle_rad.sin_cos() } else { (1.0, 1.0) };
        let most_width_px = width_px * (1.0 + taper.abs());
        let reach = [[cos, sin], [sin, cos]].map(|axis| reach_px(axis, [length_px, most_width_px]));
        let center_px = [seen.x_px + shift_px[0], seen.y_px + shift_px[1]];
        if (0..2).any(|axis| center_px[axis].abs() > self.half_px[axis] + reach[axis]) {
            return None;
        }
        let jitter_share = (strokes.angle_jitter_rad.to_degrees() / USUAL_JITTER_DEG as f32).min(1.0);
        let stroke = Stroke {
            center_px: [0, 1].map(|axis| center_px[axis] + self.half_px[axis]),
            depth: seen.depth,
            angle_rad,
            length_px,
            width_px,
            facing_fade,
            supply_ln,
            bits,
            body_id: coat.object as u32 + 1,
            albedo_srgb8: match self.colors {
                StrokeColors::Scene => candidate.albedo_srgb8,
                StrokeColors::Trust => trust_srgb8(map.kappa() as f32),
            },
            mark: {
                let order = coat.sampled.particles.ordinal(index) as u32;
                brushes::mark(&coat.first_marks[region as usize], order, bits)
            },
            paint: chance.paint(layer, strokes.size_jitter > 0.0, boldness),
            mixing: mixing(strokes, boldness, self.painting.palette_of_rule[region as usize]),
            normal_in_world: (coat_view.world_from_model.matrix3.inverse().transpose() * normal)
                .normalize_or_zero()
                .as_vec3()
                .to_array(),
            bow: (BOW_DEVIATION * jitter_share * chance.normal(BOW)).clamp(-MOST_BOW, MOST_BOW),
            overrun_px: self.overrun_px(strokes.edges, layer.overrun, drift[1]),
            drift,
            skew,
            taper,
            bend_rad: 0.0,
        };
        let most_rad = stroke.most_bend_rad();
        let bend_rad = (bend_rad * chance.bend(strokes.size_jitter)).clamp(-most_rad, most_rad);
        let stroke = Stroke { bend_rad, ..stroke };
        let source = StrokeSource {
            place,
            particle: entry.particle,
            region: u32::from(region),
            kappa: map.kappa() as f32,
            facing,
            rank: coat.sampled.rank(index),
        };
        Some((stroke, source))
    }

    /// ln(supply / rank). ρ* strokes are wanted per pixel, and the coat's whole area would fill A pixels at this
    /// particle's scale. With n particles, the supply is ρ*·A / n and the rank (ordinal + ½) / n, so their ratio is
    /// ρ*·A / (ordinal + ½). It does not depend on n: twice as many particles leave the first half unchanged.
    fn supply_ln(&self, coat: &CoatView<'_>, index: usize, area_px: f32, wanted_per_px: f32) -> f32 {
        let area_px = area_px / (self.px_scale * self.px_scale);
        let sampled = &coat.coat.sampled;
        let ordinal = f64::from(sampled.particles.ordinal(index));
        let wanted = f64::from(wanted_per_px * area_px) * sampled.area / (ordinal + 0.5);
        wanted.ln() as f32
    }

    pub(crate) fn overrun_px(&self, edges: Edges, of_layer: f32, noise: f32) -> f32 {
        match edges {
            Edges::Clip => 0.0,
            Edges::Overrun(px) => {
                px as f32 * of_layer * (1.0 + EDGE_SWING * noise.clamp(-1.5, 1.2)) * self.px_scale
            }
            Edges::Free => Stroke::FREE,
        }
    }
}

#[derive(Clone, Copy)]
struct Outline {
    angle_rad: f32,
    length_px: f32,
    width_px: f32,
    skew: f32,
}

/// The outline of a stroke that is mapped like a texture. `map` takes pixels along and across the stroke in the
/// reference picture, at the scene's own size, to pixels of this picture. `flat` is the outline without mapping, in
/// pixels of this picture; its angle is not used.
fn mapped(map: PixelMap2, flat: Outline, px_scale: f64) -> Outline {
    let along = DVec2::new(map.x.x, map.y.x) * f64::from(flat.length_px) / px_scale;
    let across = DVec2::new(map.x.y, map.y.y) * f64::from(flat.width_px) / px_scale;
    let axis = along.normalize_or(DVec2::X);
    let width = across.dot(axis.perp()).abs().max(1e-3);
    Outline {
        angle_rad: axis.to_angle() as f32,
        length_px: along.length() as f32,
        width_px: width as f32,
        skew: (across.dot(axis) / width) as f32,
    }
}

/// The colour for a trust κ: red up to 0.72 (a mirrored map has at most 0.71), yellow half-way, green from 0.9.
fn trust_srgb8(kappa: f32) -> u32 {
    const RED: [f32; 3] = [176.0, 38.0, 28.0];
    const YELLOW: [f32; 3] = [240.0, 205.0, 70.0];
    const GREEN: [f32; 3] = [28.0, 120.0, 96.0];
    let trust = ((kappa - 0.72) / 0.18).clamp(0.0, 1.0) * 2.0;
    let (from, to, t) = if trust < 1.0 { (RED, YELLOW, trust) } else { (YELLOW, GREEN, trust - 1.0) };
    let byte = |channel: usize| (from[channel] + (to[channel] - from[channel]) * t).round() as u32;
    u32::from(Stroke::AS_IT_IS) << 24 | byte(2) << 16 | byte(1) << 8 | byte(0)
}

/// Taper and bend of a layer's strokes. The underpainting is there to cover: it stays broad and straight.
fn taper_and_bend(kind: LayerKind, strokes: &ResolvedStrokes) -> (f32, f32) {
    if kind == LayerKind::Underpainting { (0.0, 0.0) } else { (strokes.taper, strokes.bend_rad) }
}

/// How much scumble is wanted, 0..=1, where the slow noise (mean 0, deviation 1) has this value. Scumble lies in
/// patches.
fn patch(noise: f32) -> f32 {
    smoothstep(0.5 + 0.45 * noise).max(0.02)
}

pub(crate) fn mixing(strokes: &ResolvedStrokes, boldness: f32, palette: u8) -> Mixing {
    let byte = |value: f32, scale: f32| (value * scale).round() as u8;
    Mixing {
        jitter: byte(strokes.color_jitter * boldness, Mixing::SCALE),
        temperature: byte(strokes.temperature, Mixing::SCALE),
        grading: byte(strokes.grading, 255.0),
        palette,
    }
}

/// Turns a stroke near its body's outline towards the nearer one of the outline's two directions, by a share that grows
/// to 0.9 × `contour` at the outline.
pub(crate) fn along_contour(
    angle_rad: f32,
    contour: f32,
    normal: DVec3,
    map: &ScreenMap,
    facing: f32,
) -> f32 {
    let weight = contour * 0.9 * (1.0 - smoothstep((facing - 0.10) / 0.50));
    let in_picture = DVec2::new(
        normal.dot(map.row_x.truncate().normalize_or_zero()),
        normal.dot(map.row_y.truncate().normalize_or_zero()),
    );
    if weight <= 0.0 || in_picture.length_squared() < 1e-12 {
        return angle_rad;
    }
    let contour_rad = in_picture.perp().to_angle() as f32;
    let twice = |angle: f32| DVec2::from_angle(2.0 * f64::from(angle));
    let mixed = twice(angle_rad) * f64::from(1.0 - weight) + twice(contour_rad) * f64::from(weight);
    let turned = 0.5 * mixed.to_angle();
    // The doubled angle has lost which end is the start: take the end nearer to the old one.
    let half_turns = ((f64::from(angle_rad) - turned) / std::f64::consts::PI).round();
    wrap_pi(turned + half_turns * std::f64::consts::PI) as f32
}

/// The random numbers of one particle.
struct Chance {
    bits: u32,
}

impl Chance {
    fn normal(&self, which: u32) -> f32 {
        hash::normal(hash::combine(self.bits, which))
    }

    fn size_px(&self, [length, width]: [f32; 2], jitter: f32) -> [f32; 2] {
        let size = jitter * self.normal(SIZE_JITTER);
        [
            length * (size + jitter * LENGTH_SHARE * self.normal(LENGTH_JITTER)).exp(),
            width * (size + jitter * WIDTH_SHARE * self.normal(WIDTH_JITTER)).exp(),
        ]
    }

    fn bend(&self, jitter: f32) -> f32 {
        (BEND_SHARE * jitter * self.normal(BEND)).exp()
    }

    fn paint(&self, layer: &ResolvedLayer, varied: bool, boldness: f32) -> Paint {
        let byte = |value: f32| value.round().clamp(0.0, 255.0) as u8;
        let (thickness, dryness) = if varied {
            let dryness = hash::unit(hash::combine(self.bits, DRYNESS_JITTER));
            ((THICKNESS_DEVIATION * self.normal(THICKNESS_JITTER)).exp(), 0.4 + 1.2 * dryness)
        } else {
            (1.0, 1.0)
        };
        Paint {
            opacity: byte(layer.opacity * 255.0),
            thickness: byte(layer.thickness * thickness * boldness * Paint::THICKNESS_SCALE),
            pickup: byte(layer.pickup * 255.0),
            dryness: byte((layer.dryness * dryness).min(1.0) * 255.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DAffine3, DMat4};
    use impasto_core::screen_map::PixelLens;

    #[test]
    fn strokes_near_the_outline_lie_along_it_and_the_others_stay() {
        let view = DMat4::from_translation(DVec3::new(0.0, 0.0, -5.0));
        let lens = PixelLens::Orthographic { px_per_unit: 100.0 };
        let map = ScreenMap::new(view, DAffine3::IDENTITY, lens);
        let at = |contour: f32, tilt_deg: f64, angle_deg: f32| {
            let normal = DVec3::new(tilt_deg.to_radians().sin(), 0.0, tilt_deg.to_radians().cos());
            let facing = normal.z as f32;
            along_contour(angle_deg.to_radians(), contour, normal, &map, facing).to_degrees()
        };
        // The contour of a normal that leans to +x runs along y.
        assert!((at(1.0, 85.0, 40.0) - 88.0).abs() < 4.0, "{}", at(1.0, 85.0, 40.0));
        assert!((at(1.0, 85.0, -137.0) + 92.0).abs() < 4.0, "{}", at(1.0, 85.0, -137.0));
        assert_eq!(at(1.0, 30.0, 7.0), 7.0f32.to_radians().to_degrees());
        assert_eq!(at(0.0, 85.0, 7.0), 7.0f32.to_radians().to_degrees());
    }

    #[test]
    fn scumble_lies_in_patches_and_leaves_the_rest() {
        assert!(patch(-1.5) < 0.05 && (patch(0.0) - 0.5).abs() < 1e-6 && patch(1.5) > 0.95);
    }
}
