//! Where an object needs its particles: each spot of a floor that runs to the horizon gets only as many as the shot
//! needs there.
//!
//! Here an *order* is a coat's progressive order on the whole surface, [`CoatCount::count_on_whole`] particles long.
//! Only those of its particles that are needed are made.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use glam::{DVec3, Mat3, Vec3};
use impasto_core::bending::{most_growth, normals_around};
use impasto_core::presence;
use impasto_core::sampling::{Cell, CellPiece, Cells, Needed, Surface};
use impasto_scene::presets::LayerKind;
use rayon::prelude::*;

use crate::context::{Context, ObjectInputs};
use crate::counts::{CoatCount, CountInputs, Counted, LEAST_ON_WHOLE, Unneeded, following};
use crate::eye::Eye;
use crate::own_depths::{Covered, OwnDepths};
use crate::particle_count::{Reach, Sighting};
use crate::parts::BodyParts;

const LAYERS: usize = LayerKind::ALL.len();

/// Particles are left out of a coat only if it needs at most this share of those that it would have on its whole
/// surface: `MOST_SHARE` on a body at rest, `MOST_SHARE_MOVING` on one whose vertices move.
const MOST_SHARE: f64 = 0.5;
const MOST_SHARE_MOVING: f64 = 0.8;

/// Where particles are left out of a body at rest, its nearest spots may get more of them than with particles
/// everywhere. In all, a coat then makes at most half as many as with particles everywhere or, if that is more, this
/// many. A camera that turns all round on a floor needs that many.
const MOST_MADE: f64 = 50_000.0;

/// The longest order, in particles: enough for a floor of some ten kilometres.
const MOST_ON_WHOLE: f64 = 1e12;

/// If the number of cells, before any is cut, times the number of views is more than this, particles lie everywhere.
const MOST_PAIRS: usize = 12_000_000;

/// In each view, the vertices of a body that bends are moved, and the pieces of its cells are looked at. If that is
/// more than `MOST_PAIRS` vertices and pieces in all views, or more than this many for each particle that might be left
/// out, particles lie everywhere: to look could take longer than to make them.
const PAIRS_PER_PARTICLE: usize = 2;

/// A cell that needs fewer particles than `FEW` is not cut. Cells are cut into parts, these into smaller ones, and so
/// on at most `MOST_DEPTH` times.
const FEW: f64 = 4.0;
const MOST_DEPTH: u32 = 12;

/// An object whose faces cover its part of the picture at least `HEAP` times over is a heap: surface that the object
/// itself hides needs no particles. If other groups of its mesh are objects too, `HEAP_OF_GROUP` times are enough. An
/// order of a heap may be longer than with particles everywhere, as long as at most `MOST_MADE_OF_HEAP` of its
/// particles are made. When cells of a heap are cut, an order longer than `MOST_OF_HEAP` particles counts as that long.
const HEAP: f64 = 12.0;
const HEAP_OF_GROUP: f64 = 6.0;
const MOST_MADE_OF_HEAP: f64 = 20_000.0;
const MOST_OF_HEAP: f64 = 400_000.0;

/// If more than this share of a heap's surface is seen by no view, its order is strict ([`Needed::is_strict`]). The
/// share is more than a half, since one view already misses about half of the surface of sheets with two visible sides.
const MUCH_UNSEEN: f64 = 0.6;

/// Where the smooth normals at the corners of a triangle differ so much that their mean may be shorter than this, the
/// normal of a particle between them may point anywhere.
const LEAST_BLENDED: f64 = 0.1;

/// About how many cuts all cells together may have, and how many each cell that is to be cut may have at least.
const MOST_CUTS: usize = 65_536;
const LEAST_CUTS: usize = 16;

/// All that decides where the particles of an object are needed.
pub(crate) struct NeededInputs {
    pub(crate) counted: Arc<CountInputs>,
    /// Every view of the object; `None` if it must be ready for any view.
    pub(crate) sightings: Option<Vec<Sighting>>,
    pub(crate) reach: Reach,
}

impl PartialEq for NeededInputs {
    fn eq(&self, other: &Self) -> bool {
        (Arc::ptr_eq(&self.counted, &other.counted) || self.counted == other.counted)
            && self.sightings == other.sightings
            && self.reach == other.reach
    }
}

impl NeededInputs {
    pub(crate) fn new(context: &Context<'_>, object: ObjectInputs<'_>, counted: &Arc<CountInputs>) -> Self {
        let offset = |&rule: &u16| f64::from(context.rules[usize::from(rule)].strokes.offset);
        let around = |[least, most]: [f64; 2], offset: f64| [least.min(offset), most.max(offset)];
        let offsets = object.used.iter().map(offset).fold([f64::INFINITY, f64::NEG_INFINITY], around);
        let [least, most] = if object.used.is_empty() { [0.0; 2] } else { offsets };
        let (sightings, noise) = match counted.unneeded() {
            Unneeded::None => (None, 0.0),
            Unneeded::AtRest => (context.seen.sightings(object.index), 0.0),
            Unneeded::OfMoving { noise } => (context.seen.sightings_moving(object.index), noise),
        };
        let reach = Reach {
            margin: context.seen.margin(),
            reach_px: counted.most_reach_px(),
            following: following(context, object),
            offsets: [least - noise, most + noise],
        };
        Self { counted: Arc::clone(counted), sightings, reach }
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
        let wanted_per_px = self.counted.wanted_per_px(surface.mesh(), parts);
        let needed_per_px = |cell: &Cell| {
            let most = |most: [f32; LAYERS], triangle: usize| {
                let [a, b, c] = surface.mesh().corners(triangle).map(Vec3::as_dvec3);
                let wanted = wanted_per_px(triangle, (a + b + c) / 3.0, cell.normal);
                std::array::from_fn(|kind| most[kind].max(wanted[kind]))
            };
            let wanted = cell.triangles(surface).fold([0.0; LAYERS], most);
            // A stroke shows while its ordinal is less than this many times the number wanted.
            let still_present = (-f64::from(presence::ABSENT_LN)).exp();
            wanted.map(|wanted| f64::from(wanted) * surface.area() * still_present * counted.more_wanted)
        };
        let seen = match self.counted.unneeded() {
            Unneeded::None => None,
            Unneeded::AtRest if cells.all().len() * sightings.len() > MOST_PAIRS => None,
            Unneeded::AtRest => {
                let heap = if self.counted.is_group() { HEAP_OF_GROUP } else { HEAP };
                // What is hidden of strokes that grow is not known.
                let may_hide = counted.deepness >= heap && self.reach.following.is_none();
                let own = may_hide.then(|| {
                    let is_solid = |triangle: usize| self.counted.is_solid(triangle);
                    OwnDepths::of_all(surface, sightings, is_solid, self.reach)
                });
                let own = own.flatten();
                let kind_of_body = if own.is_some() { KindOfBody::Heap } else { KindOfBody::AtRest };
                Some((self.seen_at_rest(surface, &cells, own, needed_per_px), kind_of_body))
            }
            Unneeded::OfMoving { noise } => {
                let may_be_left_out = counted.counts.iter().zip(counted.may_depend_on_views);
                let particles: usize = may_be_left_out.filter(|(_, may)| *may).map(|(count, _)| count).sum();
                let pieces: usize = cells.all().iter().map(|cell| cell.triangles(surface).count()).sum();
                let pairs = sightings.len() * (surface.mesh().positions.len() + pieces);
                let seen = || self.seen_moving(surface, &cells, noise > 0.0, needed_per_px);
                (pairs <= MOST_PAIRS.min(PAIRS_PER_PARTICLE * particles))
                    .then(|| (seen(), KindOfBody::Moving))
            }
        };
        let Some((seen, kind_of_body)) = seen else { return counts };
        let tree = SeenTree::new(seen);
        for (kind, count) in counts.iter_mut().enumerate() {
            if counted.may_depend_on_views[kind]
                && let Some(needed) = tree.count(kind, counted.counts[kind] as f64, kind_of_body)
            {
                *count = needed;
            }
        }
        counts
    }

    /// The cells of a body that stays at rest. Beside each stands, for each layer, how long an order it needs. This
    /// length is stated per pixel that a unit of the cell's surface fills: 3 means that the order must have 3000
    /// particles where a unit of surface fills 1000 pixels. `own` tells what a heap hides of itself in each view.
    fn seen_at_rest(
        &self,
        surface: &Surface<'_>,
        cells: &Cells,
        own: Option<Vec<OwnDepths>>,
        needed_per_px: impl Fn(&Cell) -> [f64; LAYERS] + Sync,
    ) -> Vec<(SeenCell, [f64; LAYERS])> {
        let sightings = self.sightings.iter().flatten();
        let mut eyes: Vec<Eye> = sightings.map(|sighting| Eye::new(sighting, self.reach)).collect();
        let most_on_whole = if own.is_some() { MOST_OF_HEAP } else { f64::INFINITY };
        eyes.iter_mut().zip(own.into_iter().flatten()).for_each(|(eye, own)| eye.own = Some(own));
        let all_eyes: Vec<usize> = (0..eyes.len()).collect();
        let seen = |cell: &Cell| {
            let seen = SeenCell::new(surface, cell, &eyes, &all_eyes);
            let needed = if seen.px_per_area > 0.0 { needed_per_px(cell) } else { [0.0; LAYERS] };
            (seen, needed)
        };
        let mut seen: Vec<(SeenCell, [f64; LAYERS])> = cells.all().par_iter().map(seen).collect();
        let is_cut = |(seen, needed): &(SeenCell, [f64; LAYERS])| seen.is_to_cut(most(needed), most_on_whole);
        let cuts = MOST_CUTS / seen.iter().filter(|seen| is_cut(seen)).count().max(1);
        let refine = |(seen, needed): &mut (SeenCell, [f64; LAYERS])| {
            let cuts = cuts.max(LEAST_CUTS);
            seen.refine(
                surface,
                &eyes,
                Cutting { needed: most(needed), most_on_whole, depth: MOST_DEPTH, cuts },
            );
        };
        seen.par_iter_mut().for_each(refine);
        seen
    }

    /// The same for a body whose vertices move. Its cells are not cut, and none gets more particles than if they lay
    /// everywhere. Where noise moves vertices too, a cell that is seen needs all its particles: how far noise makes a
    /// surface grow is not known.
    fn seen_moving(
        &self,
        surface: &Surface<'_>,
        cells: &Cells,
        has_noise: bool,
        needed_per_px: impl Fn(&Cell) -> [f64; LAYERS] + Sync,
    ) -> Vec<(SeenCell, [f64; LAYERS])> {
        // For each cell, the most pixels that a unit of its surface may fill, as the bits of a float: positive floats
        // are in the order of their bits.
        let most: Vec<AtomicU64> = cells.all().iter().map(|_| AtomicU64::new(0)).collect();
        let body = self.counted.surface();
        let look = |sighting: &Sighting| {
            let eye = Eye::new(sighting, self.reach);
            let shape = &sighting.shape;
            let (positions, gradients) =
                if has_noise { (body.positions_at(shape), None) } else { body.moved_to(shape) };
            for (cell, most) in cells.all().iter().zip(&most) {
                for piece in cell.pieces_at(surface, &positions) {
                    let of_corner = |vertex: u32| gradients.as_ref().map(|all| all[vertex as usize]);
                    let gradients = piece.vertices.map(|vertex| of_corner(vertex).unwrap_or(Mat3::IDENTITY));
                    let px_per_area = if has_noise {
                        if eye.seen_part(piece.corners).is_empty() { 0.0 } else { f64::INFINITY }
                    } else {
                        most_on_piece(&eye, &piece, gradients)
                    };
                    most.fetch_max(px_per_area.to_bits(), Ordering::Relaxed);
                }
            }
        };
        let mut shapes = self.sightings.iter().flatten().map(|sighting| &sighting.shape);
        if !has_noise && shapes.any(|shape| !body.is_at_rest(shape)) {
            // Made here once: the threads below would each make them.
            body.gradients();
        }
        self.sightings.par_iter().flatten().for_each(look);
        let seen = |(cell, most): (&Cell, AtomicU64)| {
            let px_per_area = f64::from_bits(most.into_inner());
            let needed = if px_per_area > 0.0 { needed_per_px(cell) } else { [0.0; LAYERS] };
            (SeenCell::whole(cell, px_per_area), needed)
        };
        cells.all().par_iter().zip(most).map(seen).collect()
    }
}

/// An upper bound on the pixels that a unit of surface at rest fills on a moved piece; 0 where the view does not see
/// the piece. Near an outline the pixels are divided by the fade of the strokes there, since more strokes make up for
/// those that fade. `gradients` are F at the corners of the mesh's triangle.
fn most_on_piece(eye: &Eye, piece: &CellPiece, gradients: [Mat3; 3]) -> f64 {
    let seen = eye.seen_part(piece.corners);
    if seen.is_empty() {
        return 0.0;
    }
    if !seen.corners().iter().all(|corner| corner.is_finite()) {
        return f64::INFINITY;
    }
    // A particle's normal is a weighted mean of the smooth ones, made longer to have the length 1.
    let blended = piece.smooth.and_then(|smooth| {
        let mean = smooth.iter().sum::<DVec3>().normalize_or_zero();
        let shortest = smooth.map(|normal| normal.dot(mean)).into_iter().fold(1.0, f64::min);
        (shortest >= LEAST_BLENDED).then_some((smooth, shortest))
    });
    match blended {
        Some((smooth, shortest)) => {
            let around = normals_around(gradients, smooth.map(|normal| normal.as_vec3()));
            eye.most_on(&seen, around.map(Vec3::as_dvec3)) / shortest
        }
        None => eye.most_facing(&seen, f64::from(most_growth(gradients))),
    }
}

/// The greatest of the lengths that the layers' orders need: see [`NeededInputs::seen_at_rest`].
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
    /// The same, of only those views that have it in the picture itself and not just in the margin round it.
    px_in_picture: f64,
    /// Whether a view may need far more particles on some of its parts than on others, or may see only some of it.
    is_uneven: bool,
    parts: Vec<Self>,
}

/// How a cell is to be cut.
#[derive(Clone, Copy)]
struct Cutting {
    /// The length of the longest order that any layer needs for the cell, in particles per pixel that a unit of surface
    /// fills.
    needed: f64,
    /// A longer order counts as this long, in particles.
    most_on_whole: f64,
    /// How often a part may be cut again.
    depth: u32,
    /// How many cuts are left.
    cuts: usize,
}

impl SeenCell {
    /// A cell that is not to be cut, nor to get more particles than if they lay everywhere.
    fn whole(cell: &Cell, px_per_area: f64) -> Self {
        let cell = cell.clone();
        Self { cell, eyes: Vec::new(), px_per_area, px_in_picture: 0.0, is_uneven: false, parts: Vec::new() }
    }

    fn new(surface: &Surface<'_>, cell: &Cell, eyes: &[Eye], of: &[usize]) -> Self {
        let mut seen = Self::whole(cell, 0.0);
        for &eye in of {
            let (px_per_area, is_uneven) = eyes[eye].most_per_area(cell);
            let covered = || eyes[eye].own.as_ref().map_or(Covered::Nowhere, |own| own.covers(surface, cell));
            let covered = if px_per_area > 0.0 { covered() } else { Covered::Wholly };
            if covered != Covered::Wholly {
                seen.eyes.push(eye);
                seen.px_per_area = seen.px_per_area.max(px_per_area);
                if eyes[eye].has_in_picture(cell) {
                    seen.px_in_picture = seen.px_in_picture.max(px_per_area);
                }
                seen.is_uneven |= is_uneven || covered == Covered::InPart;
            }
        }
        seen
    }

    /// Whether it is uneven and needs at least [`FEW`] particles. It needs its share of an order that has `needed`
    /// particles for each pixel that a unit of surface fills, but at most `most_on_whole`.
    fn is_to_cut(&self, needed: f64, most_on_whole: f64) -> bool {
        self.is_uneven
            && needed > 0.0
            && (needed * self.px_per_area).min(most_on_whole) * self.cell.share >= FEW
    }

    /// Cuts the cell if it is to be cut, and then its parts in the same way.
    fn refine(&mut self, surface: &Surface<'_>, eyes: &[Eye], cutting: Cutting) {
        let Cutting { needed, most_on_whole, depth, cuts } = cutting;
        if depth == 0 || cuts == 0 || !self.is_to_cut(needed, most_on_whole) {
            return;
        }
        let parts = self.cell.split(surface);
        self.parts = parts.iter().map(|part| Self::new(surface, part, eyes, &self.eyes)).collect();
        let sharing = self.parts.iter().filter(|part| part.is_to_cut(needed, most_on_whole)).count().max(1);
        let cutting = Cutting { depth: depth - 1, cuts: (cuts - 1).div_ceil(sharing), ..cutting };
        self.parts.iter_mut().for_each(|part| part.refine(surface, eyes, cutting));
        if !self.parts.is_empty() {
            let most = |of: fn(&Self) -> f64| self.parts.iter().map(of).fold(0.0, f64::max);
            (self.px_per_area, self.px_in_picture) =
                (most(|part| part.px_per_area), most(|part| part.px_in_picture));
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum KindOfBody {
    AtRest,
    /// At rest, and a heap.
    Heap,
    /// Its vertices move.
    Moving,
}

/// All cells, in the order of [`Needed`].
struct SeenTree {
    /// For each cell, its share of the surface and, for each layer, the ordinal below which it needs particles.
    cells: Vec<(f64, [f64; LAYERS])>,
    /// For each layer, the greatest such ordinal that a picture needs without the margin round it.
    most_in_picture: [f64; LAYERS],
    first_part: Arc<Vec<u32>>,
}

impl SeenTree {
    /// Builds the tree from the largest cells. Beside each stands, for each layer, how long an order it needs: see
    /// [`NeededInputs::seen_at_rest`].
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

    /// The count of the layer with the index `kind`, which has `everywhere` particles if they lie everywhere; `None`
    /// where it does not pay to leave some out.
    fn count(&self, kind: usize, everywhere: f64, kind_of_body: KindOfBody) -> Option<CoatCount> {
        let smallest = || self.cells.iter().zip(&*self.first_part).filter(|(_, first)| **first == 0);
        let made = |count_on_whole: f64| -> f64 {
            smallest().map(|((share, needed), _)| share * needed[kind].min(count_on_whole)).sum()
        };
        let most = self.most_in_picture[kind].min(MOST_ON_WHOLE);
        let (most_share, most_made) = match kind_of_body {
            KindOfBody::AtRest => (MOST_SHARE, (0.5 * everywhere).max(MOST_MADE)),
            KindOfBody::Heap => (MOST_SHARE, MOST_MADE_OF_HEAP),
            // No spot gets more than it would have had.
            KindOfBody::Moving => (MOST_SHARE_MOVING, made(everywhere)),
        };
        if made(everywhere) > most_share * everywhere {
            return None;
        }
        let count_on_whole = longest([everywhere, most], most_made, made);
        if count_on_whole <= LEAST_ON_WHOLE {
            return None;
        }
        let unseen: f64 =
            smallest().filter(|((_, needed), _)| needed[kind] <= 0.0).map(|((share, _), _)| share).sum();
        Some(CoatCount {
            count_on_whole: count_on_whole.ceil() as usize,
            needed: Some(Arc::new(Needed {
                of_cell: self
                    .cells
                    .iter()
                    .map(|(_, needed)| needed[kind].min(count_on_whole) as f32)
                    .collect(),
                first_part: Arc::clone(&self.first_part),
                is_strict: kind_of_body == KindOfBody::Heap && unseen > MUCH_UNSEEN,
            })),
            made: (made(count_on_whole) + LEAST_ON_WHOLE).ceil() as usize,
        })
    }
}

/// The greatest length, between these two, of an order of which at most `most_made` particles are made; `shortest` if
/// even that is too long. `made` takes a length and gives how many particles of such an order are made. This number
/// must grow with the length.
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

#[cfg(test)]
mod tests;
