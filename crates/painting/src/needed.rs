//! Where an object needs its particles: a floor that runs to the horizon is made only as densely as the shot sees each
//! spot of it.

use std::sync::Arc;

use glam::{DVec2, DVec3, DVec4};
use impasto_core::ScreenMap;
use impasto_core::presence;
use impasto_core::sampling::{Cell, Cells, Needed, Surface};
use impasto_scene::presets::LayerKind;
use rayon::prelude::*;

use crate::context::{Context, ObjectInputs};
use crate::counts::{CoatCount, CountInputs, Counted};
use crate::particle_count::Sighting;
use crate::parts::BodyParts;
use crate::presence_bound::LEAST_COUNTED_FADE;

const LAYERS: usize = LayerKind::ALL.len();

/// Orders with fewer particles are made everywhere.
const LEAST_IN_ORDER: f64 = 16_384.0;

/// Particles are left out only where at most this share of those that would lie everywhere is needed. The nearest spots
/// may then be denser than these, as long as no more than this share is made, or than `MOST_MADE`.
const MOST_SHARE: f64 = 0.5;
const MOST_MADE: f64 = 50_000.0;

/// The longest order: enough for a floor of some ten kilometres.
const MOST_IN_ORDER: f64 = 1e12;

/// At most so many pairs of a cell and a view are looked at: beyond that, particles lie everywhere.
const MOST_PAIRS: usize = 12_000_000;

/// A cell's parts are alike while its radius is at most this share of its distance.
const EVEN: f64 = 0.1;

/// A cell that needs fewer particles is not cut, and none is cut more often than `MOST_DEPTH` times.
const FEW: f64 = 4.0;
const MOST_DEPTH: u32 = 10;

/// How far beyond the picture's border strokes are made, in half sizes of the picture from its middle: an editor shows
/// what lies round the shot, and pictures may be wider than the scene states.
pub(crate) const MARGIN: f64 = 1.5;

/// All that decides where the particles of an object are needed.
pub(crate) struct NeededInputs {
    pub(crate) counted: Arc<CountInputs>,
    /// Every view of the object; `None` if it must be ready for any view.
    pub(crate) sightings: Option<Vec<Sighting>>,
    /// How far strokes reach beyond their particles, pixels at the scene's own size.
    pub(crate) reach_px: f64,
    /// How far strokes are lifted off the surface, model units.
    pub(crate) most_offset: f64,
}

impl PartialEq for NeededInputs {
    fn eq(&self, other: &Self) -> bool {
        (Arc::ptr_eq(&self.counted, &other.counted) || self.counted == other.counted)
            && self.sightings == other.sightings
            && (self.reach_px, self.most_offset) == (other.reach_px, other.most_offset)
    }
}

/// Whether any coat has so many particles that it may pay to make them only where they are needed.
pub(crate) fn may_pay(counted: &Counted) -> bool {
    counted.wanted.iter().any(|&wanted| wanted > LEAST_IN_ORDER)
}

impl NeededInputs {
    pub(crate) fn new(context: &Context<'_>, object: ObjectInputs<'_>, counted: &Arc<CountInputs>) -> Self {
        let strokes = || object.used.iter().map(|&rule| &context.rules[usize::from(rule)].strokes);
        Self {
            counted: Arc::clone(counted),
            sightings: context.seen.sightings(object.index),
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
        let eyes: Vec<Eye> = sightings.iter().map(|sighting| self.eye(sighting)).collect();
        let all_eyes: Vec<usize> = (0..eyes.len()).collect();
        let wanted_per_px = self.counted.wanted_per_px(surface.mesh(), parts);
        let seen = |cell: &Cell| {
            let mut seen = SeenCell::new(cell, &eyes, &all_eyes);
            if seen.px_per_area <= 0.0 {
                return (seen, [0.0; LAYERS]);
            }
            let most = |most: [f32; LAYERS], triangle: usize| {
                let wanted = wanted_per_px(triangle, cell.center, cell.normal);
                std::array::from_fn(|kind| most[kind].max(wanted[kind]))
            };
            let wanted = cell.triangles(surface).fold([0.0; LAYERS], most);
            // A stroke shows until its ordinal is so many times the number wanted.
            let still_present = (-f64::from(presence::ABSENT_LN)).exp();
            let needed =
                wanted.map(|wanted| f64::from(wanted) * surface.area() * still_present * counted.more_wanted);
            let most_needed = needed.into_iter().fold(0.0, f64::max);
            seen.refine(surface, &eyes, (most_needed, MOST_DEPTH));
            (seen, needed)
        };
        let seen: Vec<(SeenCell, [f64; LAYERS])> = cells.all().par_iter().map(seen).collect();
        let tree = SeenTree::new(seen);
        for (kind, count) in counts.iter_mut().enumerate() {
            if counted.wanted[kind] > LEAST_IN_ORDER
                && let Some(needed) = tree.count(kind, counted.counts[kind] as f64)
            {
                *count = needed;
            }
        }
        counts
    }

    fn eye(&self, sighting: &Sighting) -> Eye {
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
        Eye {
            planes: planes(MARGIN, 2.0 * self.reach_px),
            picture: planes(1.0, 0.0),
            near: sighting.near,
            row_w_length: map.row_w.truncate().length(),
            map: *map,
            most_offset: self.most_offset,
        }
    }
}

/// A cell, with the smaller ones that it is cut into where a view sees them very differently.
struct SeenCell {
    cell: Cell,
    /// The views that may see it.
    eyes: Vec<usize>,
    /// The most pixels that a unit of its surface may fill: see [`Eye::most_per_area`].
    px_per_area: f64,
    /// The same of the views that have it in their picture, not only beside it.
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
            let (px_per_area, beside) = eyes[eye].most_per_area(cell);
            if px_per_area > 0.0 {
                seen.eyes.push(eye);
                seen.px_per_area = seen.px_per_area.max(px_per_area);
                if eyes[eye].has_in_picture(cell) {
                    seen.px_in_picture = seen.px_in_picture.max(px_per_area);
                }
                seen.is_uneven |= beside > EVEN;
            }
        }
        seen
    }

    /// Cuts the cell while its parts differ much and it needs many particles: `needed` for each pixel that a unit of
    /// surface fills.
    fn refine(&mut self, surface: &Surface<'_>, eyes: &[Eye], (needed, depth): (f64, u32)) {
        if !self.is_uneven || depth == 0 || needed * self.px_per_area * self.cell.share < FEW {
            return;
        }
        let parts = self.cell.split(surface);
        self.parts = parts.iter().map(|part| Self::new(part, eyes, &self.eyes)).collect();
        self.parts.iter_mut().for_each(|part| part.refine(surface, eyes, (needed, depth - 1)));
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
        let made = |in_order: f64| -> f64 {
            smallest().map(|((share, needed), _)| share * needed[kind].min(in_order)).sum()
        };
        let most = self.most_in_picture[kind].min(MOST_IN_ORDER);
        let enough = MOST_SHARE * everywhere;
        if made(everywhere) > enough {
            return None;
        }
        let in_order = longest([everywhere, most], enough.max(MOST_MADE), made);
        Some(CoatCount {
            in_order: in_order.ceil() as usize,
            needed: Some(Arc::new(Needed {
                of_cell: self.cells.iter().map(|(_, needed)| needed[kind].min(in_order) as f32).collect(),
                first_part: Arc::clone(&self.first_part),
            })),
            made: (made(in_order) + LEAST_IN_ORDER).ceil() as usize,
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
    near: f64,
    row_w_length: f64,
    most_offset: f64,
}

impl Eye {
    /// Whether a cell may be in the picture.
    fn has_in_picture(&self, cell: &Cell) -> bool {
        !is_beyond(&self.picture, cell.center, cell.radius + self.most_offset)
    }

    /// The most pixels that a unit of a cell's surface may fill in this view, if strokes near an outline count as many
    /// times as they are laid there; 0 where the view does not see the cell. And how large the cell is beside its
    /// distance.
    fn most_per_area(&self, cell: &Cell) -> (f64, f64) {
        let radius = cell.radius + self.most_offset;
        if is_beyond(&self.planes, cell.center, radius) {
            return (0.0, 0.0);
        }
        let center = cell.center.extend(1.0);
        let map = &self.map;
        let is_perspective = self.row_w_length > 0.0;
        let w = map.row_w.dot(center);
        if is_perspective && w - self.row_w_length * radius <= self.near {
            return (f64::INFINITY, f64::INFINITY);
        }
        let [along_x, along_y] = map.jacobian(cell.center);
        let to_eye = along_x.cross(along_y);
        let px_per_area = to_eye.length();
        // How much nearer, and in how different a direction, the cell's nearest point may be.
        let beside = self.row_w_length * radius / w;
        let nearer = (1.0 + beside) / (1.0 - beside).powi(3);
        let thickness = (cell.thickness + self.most_offset) / cell.radius * beside;
        let facing = (cell.normal.dot(to_eye) / px_per_area + thickness) / (1.0 - beside) + cell.spread;
        if facing <= 0.0 {
            return (0.0, beside);
        }
        let most = px_per_area * nearer * most_over_fade(facing.min(1.0), map.uneven.is_some());
        // Where it is not a number, the cell is seen along its own plane.
        (if most.is_nan() { f64::INFINITY } else { most }, beside)
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

    #[test]
    fn grazing_strokes_need_no_more_than_is_kept_for_them() {
        for step in 1..=1000 {
            let facing = f64::from(step) / 1000.0;
            let fade = f64::from(presence::of_facing(facing as f32).max(LEAST_COUNTED_FADE));
            assert!(facing / fade <= most_over_fade(facing, false) * 1.000_001, "at {facing}");
            assert!(most_over_fade(facing, false) <= most_over_fade(facing, true));
        }
    }

    #[test]
    fn the_longest_order_makes_at_most_so_many() {
        assert_eq!(longest([1e3, 5e6], 1e5, |length| length * 0.01), 5e6);
        let length = longest([1e3, 5e6], 1e5, |length| length * 0.5);
        assert!((length - 2e5).abs() < 1.0, "{length}");
        assert_eq!(longest([3e5, 2e5], 2e5, |length| length * 0.5), 3e5);
    }
}
