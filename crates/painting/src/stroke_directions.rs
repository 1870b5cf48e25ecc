//! The directions of strokes without their paint, for an editor: a few of the body layer, spread over the picture.

use glam::DVec3;
use impasto_core::solve::{Bounds, SeenParticle};
use impasto_scene::document::Solver;
use impasto_scene::motion::CameraPose;
use impasto_scene::presets::LayerKind;

use crate::coat::Coat;
use crate::frame_options::FrameOptions;
use crate::painting::Painting;
use crate::painting_view::{CoatView, PaintingView, PlacedParticle};
use crate::stroke::along_contour;

/// The direction of one stroke of the body layer, and where it is in the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrokeDirection {
    /// Index of the object in the scene.
    pub object: usize,
    /// Index of the region in the scene; `regions.len()` for the implicit one.
    pub region: usize,
    /// Index of the particle in its object's body layer. Particles are in the order in which they were sampled.
    pub particle: usize,
    /// The particle's place in the order of sampling, as a share of the particles that its object's whole surface would
    /// have, in (0, 1].
    pub rank: f32,
    /// Pixels, origin at the upper left corner of the picture, Y down.
    pub position_px: [f32; 2],
    /// The stroke's angle, boil left out: counter-clockwise from +X with Y **up**, radians in (−π, π].
    pub angle_rad: f32,
    /// κ in 0..=1: how far the angle can be trusted.
    pub kappa: f32,
    /// Along the gaze, world units.
    pub depth: f32,
    /// Cosine between the surface normal and the direction to the eye, greater than 0.
    pub facing: f32,
}

/// A place on the surface of an object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePlace {
    /// Index of the object in the scene.
    pub object: usize,
    /// Model space, on the surface at rest: the object's fixed `scale` is applied, its keys are not.
    pub position: DVec3,
    /// Unit normal there.
    pub normal: DVec3,
    /// Only strokes within this distance count, model units.
    pub radius: f64,
}

/// The angle of a stroke of the body layer in a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShownDirection {
    /// Counter-clockwise from +X with Y up, radians in (−π, π].
    pub angle_rad: f32,
    /// κ in 0..=1: how far the angle can be trusted.
    pub kappa: f32,
}

/// The cosine of 60 degrees. A stroke counts only if the angle between its normal and the place's is smaller.
const LEAST_COSINE: f64 = 0.5;

impl Painting {
    /// The directions of some strokes of the body layer: at most one for each cell of `cell_px` × `cell_px` pixels, row
    /// by row. Of the strokes in a cell that face the eye and are `accepted`, the one of the lowest rank is taken; of
    /// equal ranks, the first object's.
    ///
    /// `accepted` must judge whether another body hides a stroke. The directions that it is given have no angle and κ
    /// yet: both are 0.
    pub fn stroke_directions(
        &self,
        camera: &CameraPose,
        frame: f64,
        options: &FrameOptions,
        cell_px: f32,
        accepted: &dyn Fn(&StrokeDirection) -> bool,
    ) -> Vec<StrokeDirection> {
        let view = self.view(camera, frame, options, |coat| coat.kind == LayerKind::Body);
        let cell_px = cell_px.max(1.0);
        let [width_px, height_px] = options.size_px.map(|side| side as f32);
        let columns = (width_px / cell_px).ceil().max(1.0) as usize;
        let rows = (height_px / cell_px).ceil().max(1.0) as usize;
        let mut cells: Vec<Option<(&CoatView<'_>, StrokeDirection)>> = vec![None; columns * rows];
        let bounds = Bounds { half_px: view.half_px, near_far: view.near_far, most_per_area: f32::INFINITY };
        for coat in &view.coats {
            for index in indices(&coat.within(&bounds)) {
                let seen = coat.seen(index);
                let [x, y] = view.position_px(&seen);
                // A position just inside the right or lower border may be rounded to the border, one cell too far.
                let [column, row] = [(x / cell_px) as usize, (y / cell_px) as usize];
                let cell = column.min(columns - 1) + row.min(rows - 1) * columns;
                if cells[cell].is_some_and(|(_, best)| best.rank <= coat.coat.sampled.rank(index)) {
                    continue;
                }
                let direction = view.without_angle(coat, &seen, index);
                if direction.facing > 0.0 && accepted(&direction) {
                    cells[cell] = Some((coat, direction));
                }
            }
        }
        cells.into_iter().flatten().map(|(coat, direction)| view.with_angle(coat, direction)).collect()
    }

    /// The angle of strokes at a place as a camera sees them. It is taken from the nearest particle of the object's
    /// body layer that is within the place's radius and faces about the same way. `None` if there is none, or if it is
    /// not between the camera's near and far planes.
    pub fn angle_at(&self, place: &SurfacePlace, camera: &CameraPose, frame: f64) -> Option<ShownDirection> {
        let options = FrameOptions::new([self.scene().size.0, self.scene().size.1]);
        let view = self.view(camera, frame, &options, |coat| place.is_on(coat));
        let coat = view.coats.first()?;
        let (mut nearest, mut least_sq) = (None, place.radius * place.radius);
        for index in 0..coat.len() {
            let distance_sq = coat.at_rest(index).distance_squared(place.position);
            if distance_sq <= least_sq
                && coat.coat.baked.placed.normal_of(index).dot(place.normal) > LEAST_COSINE
            {
                (nearest, least_sq) = (Some(index), distance_sq);
            }
        }
        let index = nearest.filter(|&index| view.is_between(coat.seen(index).depth))?;
        Some(view.shown_direction(coat, index))
    }

    /// The directions of strokes of an object's body layer round a place, as a camera sees them. These strokes are
    /// within the place's radius, face about the same way as the place, and face the eye. If there are more than
    /// `most`, those that were sampled first are taken.
    pub fn stroke_directions_near(
        &self,
        place: &SurfacePlace,
        camera: &CameraPose,
        frame: f64,
        options: &FrameOptions,
        most: usize,
    ) -> Vec<StrokeDirection> {
        let view = self.view(camera, frame, options, |coat| place.is_on(coat));
        let Some(coat) = view.coats.first() else { return Vec::new() };
        let is_near = |index: &usize| {
            let distance_sq = coat.at_rest(*index).distance_squared(place.position);
            distance_sq < place.radius * place.radius
                && coat.coat.baked.placed.normal_of(*index).dot(place.normal) > LEAST_COSINE
        };
        (0..coat.len())
            .filter(is_near)
            .map(|index| (index, coat.seen(index)))
            .filter(|(_, seen)| seen.area_px > 0.0 && view.is_between(seen.depth))
            .map(|(index, seen)| view.without_angle(coat, &seen, index))
            .filter(|direction| direction.facing > 0.0)
            .take(most)
            .map(|direction| view.with_angle(coat, direction))
            .collect()
    }
}

impl SurfacePlace {
    /// Whether a coat is the body layer of the place's object.
    fn is_on(&self, coat: &Coat) -> bool {
        coat.kind == LayerKind::Body && coat.object == self.object
    }
}

/// The numbers of the bits that are set, in order; 64 to a word, the first in the lowest bit.
fn indices(words: &[u64]) -> impl Iterator<Item = usize> + '_ {
    words.iter().enumerate().flat_map(|(word, &bits)| {
        let mut left = bits;
        std::iter::from_fn(move || {
            let bit = left.trailing_zeros() as usize;
            left &= left.checked_sub(1)?;
            Some(word * 64 + bit)
        })
    })
}

impl PaintingView<'_> {
    /// Where a particle is in the picture, pixels from its upper left corner, Y down.
    fn position_px(&self, seen: &SeenParticle) -> [f32; 2] {
        [seen.x_px + self.half_px[0], self.half_px[1] - seen.y_px]
    }

    /// The direction of a particle's stroke, with angle and κ left at 0.
    fn without_angle(&self, coat: &CoatView<'_>, seen: &SeenParticle, index: usize) -> StrokeDirection {
        let [position, normal] = coat.position_and_normal(index);
        let jacobian = coat.map.jacobian(position);
        StrokeDirection {
            object: coat.coat.object,
            region: usize::from(coat.coat.traits.region(index)),
            particle: index,
            rank: coat.coat.sampled.rank(index),
            position_px: self.position_px(seen),
            angle_rad: 0.0,
            kappa: 0.0,
            depth: seen.depth,
            facing: coat.map.facing(jacobian, normal) as f32,
        }
    }

    fn with_angle(&self, coat: &CoatView<'_>, direction: StrokeDirection) -> StrokeDirection {
        let ShownDirection { angle_rad, kappa } = self.shown_direction(coat, direction.particle);
        StrokeDirection { angle_rad, kappa, ..direction }
    }

    fn shown_direction(&self, coat: &CoatView<'_>, index: usize) -> ShownDirection {
        let placed = coat.placed(index, &coat.look(index));
        let &PlacedParticle { position, normal, lift, .. } = &placed;
        let jacobian = coat.map.jacobian(position);
        let region = coat.coat.traits.region(index);
        let contour = self.strokes_of(region).contour;
        let facing = coat.map.facing(jacobian, normal) as f32;
        let lift = match self.painting.solver {
            Solver::Tangent => lift,
            Solver::Horn | Solver::HornExact => coat.surface_lift(index),
        };
        let angle_rad = self.angle_rad(coat, index, &placed);
        ShownDirection {
            angle_rad: along_contour(angle_rad, contour, normal, &coat.map, facing),
            kappa: lift.map(jacobian).kappa() as f32,
        }
    }
}
