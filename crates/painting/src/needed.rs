//! Where an object needs its particles: a floor that runs to the horizon is made only as densely as the shot sees each
//! spot of it.

use std::sync::Arc;

use glam::{DVec2, DVec3, DVec4, Vec3};
use impasto_core::ScreenMap;
use impasto_core::presence;
use impasto_core::sampling::{Cell, Cells, Needed, Surface};
use impasto_scene::presets::LayerKind;
use rayon::prelude::*;

use crate::context::{Context, ObjectInputs};
use crate::counts::{CoatCount, CountInputs, Counted, LEAST_ON_WHOLE};
use crate::particle_count::Sighting;
use crate::parts::BodyParts;
use crate::presence_bound::LEAST_COUNTED_FADE;

const LAYERS: usize = LayerKind::ALL.len();

/// Particles are left out of a coat only if at most this share of those that it would have everywhere is needed. Then the
/// nearest spots may get more than they would have had, until this share of particles is made, or `MOST_MADE`.
const MOST_SHARE: f64 = 0.5;
const MOST_MADE: f64 = 50_000.0;

/// The longest order: enough for a floor of some ten kilometres.
const MOST_ON_WHOLE: f64 = 1e12;

/// At most so many pairs of a cell and a view are looked at: beyond that, particles lie everywhere.
const MOST_PAIRS: usize = 12_000_000;

/// A cell's parts are alike while its radius is at most this share of its distance.
const EVEN: f64 = 0.1;

/// A cell that is not all inside the view is cut while its radius is more than this share of half the picture.
const LARGE: f64 = 0.25;

/// A cell that needs fewer particles is not cut, and none is cut more often than `MOST_DEPTH` times.
const FEW: f64 = 4.0;
const MOST_DEPTH: u32 = 12;

/// All cells together are cut about so often; each that is to be cut, this often at least.
const MOST_CUTS: usize = 65_536;
const LEAST_CUTS: usize = 16;

/// All that decides where the particles of an object are needed.
pub(crate) struct NeededInputs {
    pub(crate) counted: Arc<CountInputs>,
    /// Every view of the object; `None` if it must be ready for any view.
    pub(crate) sightings: Option<Vec<Sighting>>,
    /// How far from the middle of the picture there are particles, in half sizes of the picture.
    pub(crate) margin: f64,
    /// How far strokes reach beyond their particles, pixels at the scene's own size.
    pub(crate) reach_px: f64,
    /// How far strokes are lifted off the surface, model units.
    pub(crate) most_offset: f64,
}

impl PartialEq for NeededInputs {
    fn eq(&self, other: &Self) -> bool {
        (Arc::ptr_eq(&self.counted, &other.counted) || self.counted == other.counted)
            && self.sightings == other.sightings
            && (self.margin, self.reach_px) == (other.margin, other.reach_px)
            && self.most_offset == other.most_offset
    }
}

impl NeededInputs {
    pub(crate) fn new(context: &Context<'_>, object: ObjectInputs<'_>, counted: &Arc<CountInputs>) -> Self {
        let strokes = || object.used.iter().map(|&rule| &context.rules[usize::from(rule)].strokes);
        Self {
            counted: Arc::clone(counted),
            sightings: context.seen.sightings(object.index),
            margin: context.seen.margin(),
            reach_px: counted.most_reach_px(),
            most_offset: strokes().map(|strokes| f64::from(strokes.offset).abs()).fold(0.0, f64::max),
        }
    }

    /// How many particles each coat is to have, and where.
    pub(crate) fn counts(
        &self,
        counted: &Counted,
        surface: &Surface<'_>,
        parts: &BodyParts,
    ) -> [CoatCount; LAYERS] {
        let mut counts = counted.counts.map(CoatCount::everywhere);
        let Some(sightings) = &self.sightings else { return counts };
        let cells = Cells::new(surface);
        if cells.all().len() * sightings.len() > MOST_PAIRS {
            return counts;
        }
        let eyes: Vec<Eye> = sightings
            .iter()
            .map(|sighting| Eye::new(sighting, self.margin, [self.reach_px, self.most_offset]))
            .collect();
        let all_eyes: Vec<usize> = (0..eyes.len()).collect();
        let wanted_per_px = self.counted.wanted_per_px(surface.mesh(), parts);
        let seen = |cell: &Cell| {
            let seen = SeenCell::new(cell, &eyes, &all_eyes);
            if seen.px_per_area <= 0.0 {
                return (seen, [0.0; LAYERS]);
            }
            let most = |most: [f32; LAYERS], triangle: usize| {
                let [a, b, c] = surface.mesh().corners(triangle).map(Vec3::as_dvec3);
                let wanted = wanted_per_px(triangle, (a + b + c) / 3.0, cell.normal);
                std::array::from_fn(|kind| most[kind].max(wanted[kind]))
            };
            let wanted = cell.triangles(surface).fold([0.0; LAYERS], most);
            // A stroke shows until its ordinal is so many times the number wanted.
            let still_present = (-f64::from(presence::ABSENT_LN)).exp();
            let needed =
                wanted.map(|wanted| f64::from(wanted) * surface.area() * still_present * counted.more_wanted);
            (seen, needed)
        };
        let mut seen: Vec<(SeenCell, [f64; LAYERS])> = cells.all().par_iter().map(seen).collect();
        let is_cut = |(seen, needed): &(SeenCell, [f64; LAYERS])| seen.is_to_cut(most(needed));
        let cuts = MOST_CUTS / seen.iter().filter(|seen| is_cut(seen)).count().max(1);
        let refine = |(seen, needed): &mut (SeenCell, [f64; LAYERS])| {
            seen.refine(surface, &eyes, (most(needed), MOST_DEPTH, cuts.max(LEAST_CUTS)));
        };
        seen.par_iter_mut().for_each(refine);
        let tree = SeenTree::new(seen);
        for (kind, count) in counts.iter_mut().enumerate() {
            if counted.may_depend_on_views[kind]
                && let Some(needed) = tree.count(kind, counted.counts[kind] as f64)
            {
                *count = needed;
            }
        }
        counts
    }
}

/// The most particles that any layer needs for each pixel that a unit of surface fills.
fn most(needed: &[f64; LAYERS]) -> f64 {
    needed.iter().copied().fold(0.0, f64::max)
}

/// A cell, with the smaller ones that it is cut into where a view sees them very differently.
struct SeenCell {
    cell: Cell,
    /// The views that may see it.
    eyes: Vec<usize>,
    /// The most pixels that a unit of its surface may fill: see [`Eye::most_per_area`].
    px_per_area: f64,
    /// The same of the views that have it in their picture, not only round it.
    px_in_picture: f64,
    /// Whether its parts differ much.
    is_uneven: bool,
    parts: Vec<Self>,
}

impl SeenCell {
    fn new(cell: &Cell, eyes: &[Eye], of: &[usize]) -> Self {
        let mut seen = Self {
            cell: cell.clone(),
            eyes: Vec::new(),
            px_per_area: 0.0,
            px_in_picture: 0.0,
            is_uneven: false,
            parts: Vec::new(),
        };
        for &eye in of {
            let (px_per_area, is_uneven) = eyes[eye].most_per_area(cell);
            if px_per_area > 0.0 {
                seen.eyes.push(eye);
                seen.px_per_area = seen.px_per_area.max(px_per_area);
                if eyes[eye].has_in_picture(cell) {
                    seen.px_in_picture = seen.px_in_picture.max(px_per_area);
                }
                seen.is_uneven |= is_uneven;
            }
        }
        seen
    }

    /// Whether its parts differ much and it needs many particles: `needed` for each pixel that a unit of surface fills.
    fn is_to_cut(&self, needed: f64) -> bool {
        self.is_uneven && needed * self.px_per_area * self.cell.share >= FEW
    }

    /// Cuts the cell while it is to be cut, at most so deep and into so many parts.
    fn refine(&mut self, surface: &Surface<'_>, eyes: &[Eye], (needed, depth, cuts): (f64, u32, usize)) {
        if depth == 0 || cuts == 0 || !self.is_to_cut(needed) {
            return;
        }
        let parts = self.cell.split(surface);
        self.parts = parts.iter().map(|part| Self::new(part, eyes, &self.eyes)).collect();
        let sharing = self.parts.iter().filter(|part| part.is_to_cut(needed)).count().max(1);
        let cuts = (cuts - 1).div_ceil(sharing);
        self.parts.iter_mut().for_each(|part| part.refine(surface, eyes, (needed, depth - 1, cuts)));
        if !self.parts.is_empty() {
            let most = |of: fn(&Self) -> f64| self.parts.iter().map(of).fold(0.0, f64::max);
            (self.px_per_area, self.px_in_picture) =
                (most(|part| part.px_per_area), most(|part| part.px_in_picture));
        }
    }
}

/// All cells, in the order of [`Needed`].
struct SeenTree {
    /// For each cell its share of the surface, and the particles that it needs of each layer.
    cells: Vec<(f64, [f64; LAYERS])>,
    /// The greatest need of each layer in any picture.
    most_in_picture: [f64; LAYERS],
    first_part: Arc<Vec<u32>>,
}

impl SeenTree {
    /// From the first cells, with what they need for each pixel that a unit of surface fills.
    fn new(first: Vec<(SeenCell, [f64; LAYERS])>) -> Self {
        let (mut cells, mut first_part) = (Vec::new(), Vec::new());
        let mut most_in_picture = [0.0f64; LAYERS];
        let mut level = first;
        let mut next_first = level.len();
        while !level.is_empty() {
            let mut next = Vec::new();
            for (seen, needed) in level {
                let times = |px_per_area: f64| needed.map(|of| if of > 0.0 { of * px_per_area } else { 0.0 });
                cells.push((seen.cell.share, times(seen.px_per_area)));
                let in_picture = times(seen.px_in_picture);
                most_in_picture = std::array::from_fn(|kind| most_in_picture[kind].max(in_picture[kind]));
                first_part.push(if seen.parts.is_empty() { 0 } else { (next_first + next.len()) as u32 });
                next.extend(seen.parts.into_iter().map(|part| (part, needed)));
            }
            next_first += next.len();
            level = next;
        }
        Self { cells, most_in_picture, first_part: Arc::new(first_part) }
    }

    /// The count of a layer that has this many particles if they lie everywhere; `None` where it does not pay to leave
    /// some out.
    fn count(&self, kind: usize, everywhere: f64) -> Option<CoatCount> {
        let smallest = || self.cells.iter().zip(&*self.first_part).filter(|(_, first)| **first == 0);
        let made = |count_on_whole: f64| -> f64 {
            smallest().map(|((share, needed), _)| share * needed[kind].min(count_on_whole)).sum()
        };
        let most = self.most_in_picture[kind].min(MOST_ON_WHOLE);
        let enough = MOST_SHARE * everywhere;
        if made(everywhere) > enough {
            return None;
        }
        let count_on_whole = longest([everywhere, most], enough.max(MOST_MADE), made);
        if count_on_whole <= LEAST_ON_WHOLE {
            return None;
        }
        Some(CoatCount {
            count_on_whole: count_on_whole.ceil() as usize,
            needed: Some(Arc::new(Needed {
                of_cell: self
                    .cells
                    .iter()
                    .map(|(_, needed)| needed[kind].min(count_on_whole) as f32)
                    .collect(),
                first_part: Arc::clone(&self.first_part),
            })),
            made: (made(count_on_whole) + LEAST_ON_WHOLE).ceil() as usize,
        })
    }
}

/// The longest order between these two lengths of which at most `most_made` particles are made, as of the shortest.
/// `made` tells how many are made of an order of this length; it grows with the length.
fn longest([shortest, longest]: [f64; 2], most_made: f64, made: impl Fn(f64) -> f64) -> f64 {
    let longest = longest.max(shortest);
    if made(longest) <= most_made {
        return longest;
    }
    let (mut short, mut long) = (shortest, longest);
    for _ in 0..30 {
        let middle = 0.5 * (short + long);
        if made(middle) <= most_made {
            short = middle;
        } else {
            long = middle;
        }
    }
    short
}

/// Sides of a space in model space; each with the length of its first three numbers.
type Planes = [(DVec4, f64); 5];

/// Whether all of a sphere lies on the near side of all planes.
fn is_inside(planes: &Planes, center: DVec3, radius: f64) -> bool {
    planes.iter().all(|(plane, length)| plane.dot(center.extend(1.0)) < -length * radius)
}

/// Whether all of a sphere lies beyond one of the planes.
fn is_beyond(planes: &Planes, center: DVec3, radius: f64) -> bool {
    planes.iter().any(|(plane, length)| plane.dot(center.extend(1.0)) > length * radius)
}

/// A view of a body, ready to ask how densely it sees a cell.
struct Eye {
    map: ScreenMap,
    /// Where these are positive, nothing is seen.
    planes: Planes,
    /// The same for the picture alone.
    picture: Planes,
    half_px: DVec2,
    near: f64,
    row_w_length: f64,
    most_offset: f64,
}

impl Eye {
    /// A view with particles to this margin (see [`NeededInputs`]), for strokes that reach so far from their particles,
    /// pixels, and are lifted so far, model units.
    fn new(sighting: &Sighting, margin: f64, [reach_px, most_offset]: [f64; 2]) -> Self {
        let map = &sighting.map;
        let planes = |margin: f64, reach_px: f64| {
            let half_px = sighting.half_size_px * margin + DVec2::splat(reach_px);
            let side = |row: DVec4, half_px: f64| row - map.row_w * half_px;
            let sides = [
                side(map.row_x, half_px.x),
                side(-map.row_x, half_px.x),
                side(map.row_y, half_px.y),
                side(-map.row_y, half_px.y),
                DVec4::W * sighting.near - map.row_depth,
            ];
            sides.map(|plane| (plane, plane.truncate().length()))
        };
        Self {
            planes: planes(margin, 2.0 * reach_px),
            picture: planes(1.0, 0.0),
            half_px: sighting.half_size_px,
            near: sighting.near,
            row_w_length: map.row_w.truncate().length(),
            map: *map,
            most_offset,
        }
    }

    /// Whether a cell may be in the picture.
    fn has_in_picture(&self, cell: &Cell) -> bool {
        !is_beyond(&self.picture, cell.center, cell.radius + self.most_offset)
    }

    /// An upper bound on the pixels that a unit of a cell's surface fills in this view, divided by the fade of strokes near
    /// an outline; 0 where the view does not see the cell. And whether its parts may differ much: it is large beside its
    /// depth, or a large part of the picture and not all inside.
    fn most_per_area(&self, cell: &Cell) -> (f64, bool) {
        let radius = cell.radius + self.most_offset;
        if is_beyond(&self.planes, cell.center, radius) {
            return (0.0, false);
        }
        let center = cell.center.extend(1.0);
        let map = &self.map;
        let is_perspective = self.row_w_length > 0.0;
        let w = map.row_w.dot(center);
        if is_perspective && w - self.row_w_length * radius <= self.near {
            return (f64::INFINITY, true);
        }
        let [along_x, along_y] = map.jacobian(cell.center);
        let to_eye = along_x.cross(along_y);
        let px_per_area = to_eye.length();
        // How much nearer, and in how different a direction, the cell's nearest point may be.
        let radius_per_depth = self.row_w_length * radius / w;
        let nearer = (1.0 + radius_per_depth) / (1.0 - radius_per_depth).powi(3);
        let thickness = (cell.thickness + self.most_offset) / cell.radius * radius_per_depth;
        // The distance to the cell's plane, over the least or the greatest distance to one of its points.
        let above = cell.normal.dot(to_eye) / px_per_area + thickness;
        let facing =
            above / if above > 0.0 { 1.0 - radius_per_depth } else { 1.0 + radius_per_depth } + cell.spread;
        if facing <= 0.0 {
            return (0.0, false);
        }
        let most = px_per_area * nearer * most_over_fade(facing.min(1.0), map.uneven.is_some());
        // Where it is not a number, the cell is seen along its own plane.
        let is_large = cell.radius * px_per_area.sqrt() > LARGE * self.half_px.min_element();
        let is_uneven = radius_per_depth > EVEN || is_large && !is_inside(&self.planes, cell.center, radius);
        (if most.is_nan() { f64::INFINITY } else { most }, is_uneven)
    }
}

/// The greatest `f / fade(f)` for `f` up to this facing: strokes that face the eye less are more, to make up for those
/// that fade.
fn most_over_fade(facing: f64, uneven: bool) -> f64 {
    let least = f64::from(LEAST_COUNTED_FADE);
    // In a body that is stretched, the facing in the world is another one.
    if uneven {
        return facing / least;
    }
    // It grows until the fade is more than the least that counts, then falls, and follows the facing from 0.2 on.
    facing.max((facing / least).min(MOST_GRAZING))
}

/// The greatest `f / fade(f)` for `f` below 0.2.
const MOST_GRAZING: f64 = 0.243;

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DAffine3;
    use impasto_core::TriangleMesh;
    use impasto_core::sampling;
    use impasto_core::screen_map::{PixelLens, area_px};

    use crate::body_shape::BodyShape;

    #[test]
    fn grazing_strokes_need_no_more_than_is_kept_for_them() {
        for step in 1..=1000 {
            let facing = f64::from(step) / 1000.0;
            let fade = f64::from(presence::of_facing(facing as f32).max(LEAST_COUNTED_FADE));
            assert!(facing / fade <= most_over_fade(facing, false) * 1.000_001, "at {facing}");
            assert!(most_over_fade(facing, false) <= most_over_fade(facing, true));
        }
    }

    /// A bumpy field, from near and from afar, from above and along it, through either lens.
    #[test]
    fn no_place_needs_more_than_its_cell() {
        let mut mesh = TriangleMesh::default();
        for index in 0..60u32 * 60 {
            let [x, z] = [index % 60, index / 60].map(|number| number as f32 * 0.2 - 6.0);
            let height = |x: f32, z: f32| (1.3 * x).sin() * (1.1 * z + 0.4).cos();
            let slope =
                [height(x + 0.01, z) - height(x - 0.01, z), height(x, z + 0.01) - height(x, z - 0.01)];
            mesh.positions.push(Vec3::new(x, height(x, z), z));
            mesh.normals.push(Vec3::new(-slope[0], 0.02, -slope[1]).normalize());
        }
        for cell in 0..59u32 * 59 {
            let a = cell / 59 * 60 + cell % 59;
            mesh.triangles.extend([[a, a + 60, a + 1], [a + 1, a + 60, a + 61]]);
        }
        let surface = Surface::new(&mesh, |_| true);
        let cells: Vec<Cell> = Cells::new(&surface).into_iter().collect();
        let particles = sampling::scattered(&surface, 20_000, 4);
        let of_triangle: Vec<Vec<usize>> = {
            let mut of_triangle = vec![Vec::new(); mesh.triangles.len()];
            for (index, cell) in cells.iter().enumerate() {
                cell.triangles(&surface).for_each(|triangle| of_triangle[triangle].push(index));
            }
            of_triangle
        };
        let mut seen = 0;
        for (eye, target, lens) in [
            ([0.0, 2.0, 9.0], [0.0, 0.0, 0.0], PixelLens::Perspective { focal_px: 500.0 }),
            ([0.3, 1.1, 0.2], [3.0, 1.0, -2.0], PixelLens::Perspective { focal_px: 300.0 }),
            ([1.0, -4.0, 2.0], [0.0, 0.0, 0.0], PixelLens::Perspective { focal_px: 400.0 }),
            ([4.0, 3.0, 4.0], [0.0, 0.0, 0.0], PixelLens::Orthographic { px_per_unit: 50.0 }),
        ] {
            let view = glam::dcamera::rh::view::look_at_mat4(eye.into(), target.into(), DVec3::Y);
            for pose in [DAffine3::IDENTITY, DAffine3::from_scale(DVec3::new(1.5, 0.7, 1.0))] {
                let map = ScreenMap::new(view, pose, lens);
                let sighting = Sighting {
                    map,
                    half_size_px: DVec2::new(320.0, 180.0),
                    near: 0.05,
                    shape: BodyShape::default(),
                };
                let of_sighting = Eye::new(&sighting, 1.0, [0.0; 2]);
                for particle in &particles {
                    let (at, normal) = (particle.position.as_dvec3(), particle.normal.as_dvec3());
                    let px = map.project(at).abs();
                    let jacobian = map.jacobian(at);
                    let facing = map.facing(jacobian, normal) as f32;
                    if map.depth(at) <= 0.05 || !px.cmplt(sighting.half_size_px).all() || facing <= 0.0 {
                        continue;
                    }
                    seen += 1;
                    let fade = f64::from(presence::of_facing(facing).max(LEAST_COUNTED_FADE));
                    let needed = area_px(jacobian, normal) / fade;
                    let most = of_triangle[particle.triangle as usize]
                        .iter()
                        .map(|&cell| of_sighting.most_per_area(&cells[cell]).0)
                        .fold(0.0, f64::max);
                    assert!(needed <= most * 1.000_1, "{needed} of {most}, {lens:?}, {pose:?}");
                }
            }
        }
        assert!(seen > 10_000, "{seen}");
    }

    #[test]
    fn the_longest_order_makes_at_most_so_many() {
        assert_eq!(longest([1e3, 5e6], 1e5, |length| length * 0.01), 5e6);
        let length = longest([1e3, 5e6], 1e5, |length| length * 0.5);
        assert!((length - 2e5).abs() < 1.0, "{length}");
        assert_eq!(longest([3e5, 2e5], 2e5, |length| length * 0.5), 3e5);
    }
}
