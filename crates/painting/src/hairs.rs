//! Directions as an editor shows them: few strokes of the body layer, spread evenly over the picture, without their paint.

use glam::DVec3;
use impasto_core::screen_map::facing;
use impasto_scene::document::Solver;
use impasto_scene::motion::{self, CameraPose};
use impasto_scene::presets::LayerKind;

use crate::at::{FrameOptions, Look, SeenCoat};
use crate::prepare::Painting;
use crate::stroke::along_contour;
use crate::view::PictureView;

/// A stroke of the body layer as a direction at a place of the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hair {
    /// Index of the object in the scene.
    pub object: usize,
    /// Index of the region in the scene; `regions.len()` for the implicit one.
    pub region: usize,
    /// Index of the particle in the progressive order of its object's body layer.
    pub particle: usize,
    /// Rank in (0, 1): low ranks come first.
    pub rank: f32,
    /// Pixels, origin at the upper left corner of the picture, Y down.
    pub position_px: [f32; 2],
    /// The stroke's angle as it is drawn: counter-clockwise from +X with Y **up**, radians in (−π, π].
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
    /// Model space, static scale applied.
    pub position: DVec3,
    /// Unit normal, model space.
    pub normal: DVec3,
    /// How far away the stroke that answers may be, model units.
    pub radius: f64,
}

/// How a stroke of the body layer lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShownDirection {
    /// Counter-clockwise from +X with Y up, radians in (−π, π].
    pub angle_rad: f32,
    /// κ in 0..=1: how far the angle can be trusted.
    pub kappa: f32,
}

/// A stroke faces likewise when its normal is within 60 degrees.
const LIKEWISE: f64 = 0.5;

impl Painting {
    /// Directions in a view: of all strokes of the body layer that are in the picture and face the eye, the one of the lowest
    /// rank in each cell of `cell_px` × `cell_px`, equal ranks by object. What stands in front of them is not asked; see
    /// [`Painting::hairs_where`]. In the order of the cells, row by row.
    pub fn hairs(&self, camera: &CameraPose, frame: f64, options: &FrameOptions, cell_px: f32) -> Vec<Hair> {
        self.hairs_where(camera, frame, options, (cell_px, &|_| true))
    }

    /// As [`Painting::hairs`], of those strokes for which `counts` holds. A hair that is asked about has everything but its
    /// angle and κ, which are 0.
    pub fn hairs_where(
        &self,
        camera: &CameraPose,
        frame: f64,
        options: &FrameOptions,
        (cell_px, counts): (f32, &dyn Fn(&Hair) -> bool),
    ) -> Vec<Hair> {
        let look = self.look(camera, frame, options, |coat| coat.kind == LayerKind::Body);
        let cell_px = cell_px.max(1.0);
        let [width_px, height_px] = options.size_px.map(|side| side as f32);
        let columns = (width_px / cell_px).ceil().max(1.0) as usize;
        let rows = (height_px / cell_px).ceil().max(1.0) as usize;
        let mut cells: Vec<Option<(usize, Hair)>> = vec![None; columns * rows];
        for (number, seen) in look.seen.iter().enumerate() {
            let solved = seen.all_solved();
            let count = solved.area_px.len() as f32;
            for index in 0..solved.area_px.len() {
                let x = solved.x_px[index] + look.half_px[0];
                let y = look.half_px[1] - solved.y_px[index];
                let depth = solved.depth[index];
                let inside = x >= 0.0 && y >= 0.0 && x < width_px && y < height_px;
                let faces = solved.area_px[index] > 0.0 && look.is_between(depth);
                if !(inside && faces) {
                    continue;
                }
                let rank = (index as f32 + 0.5) / count;
                let cell = (x / cell_px) as usize + (y / cell_px) as usize * columns;
                if cells[cell].is_some_and(|(_, held)| held.rank <= rank) {
                    continue;
                }
                let jacobian = seen.map.jacobian(seen.baked.position_of(index));
                let hair = Hair {
                    object: seen.coat.object,
                    region: usize::from(seen.coat.seats.region(index)),
                    particle: index,
                    rank,
                    position_px: [x, y],
                    angle_rad: 0.0,
                    kappa: 0.0,
                    depth,
                    facing: facing(jacobian, seen.baked.normal_of(index)) as f32,
                };
                if hair.facing > 0.0 && counts(&hair) {
                    cells[cell] = Some((number, hair));
                }
            }
        }
        let direction = |(number, hair): (usize, Hair)| {
            let ShownDirection { angle_rad, kappa } = look.direction(&look.seen[number], hair.particle);
            Hair { angle_rad, kappa, ..hair }
        };
        cells.into_iter().flatten().map(direction).collect()
    }

    /// How strokes lie at a place as a camera sees them: those of the nearest particle of the object's body layer that faces
    /// likewise and is within the place's radius. `None` where there is none, or where it is behind the eye.
    pub fn angle_at(&self, place: &SurfacePlace, camera: &CameraPose, frame: f64) -> Option<ShownDirection> {
        let options = FrameOptions::new([self.scene().size.0, self.scene().size.1]);
        let wanted = |coat: &crate::coat::Coat| coat.kind == LayerKind::Body && coat.object == place.object;
        let look = self.look(camera, frame, &options, wanted);
        let seen = look.seen.first()?;
        let (mut nearest, mut least_sq) = (None, place.radius * place.radius);
        for index in 0..seen.baked.len() {
            let distance_sq = seen.baked.position_of(index).distance_squared(place.position);
            if distance_sq <= least_sq && seen.baked.normal_of(index).dot(place.normal) > LIKEWISE {
                (nearest, least_sq) = (Some(index), distance_sq);
            }
        }
        let index = nearest.filter(|&index| look.is_between(seen.solved(index).depth))?;
        Some(look.direction(seen, index))
    }

    /// The strokes of an object's body layer round a place, as a camera sees them: those that face likewise, are within the
    /// place's radius and not behind the eye. At most `most`, the first ones of the progressive order.
    pub fn hairs_near(
        &self,
        place: &SurfacePlace,
        (camera, frame): (&CameraPose, f64),
        options: &FrameOptions,
        most: usize,
    ) -> Vec<Hair> {
        let wanted = |coat: &crate::coat::Coat| coat.kind == LayerKind::Body && coat.object == place.object;
        let look = self.look(camera, frame, options, wanted);
        let Some(seen) = look.seen.first() else { return Vec::new() };
        let (solved, baked) = (seen.all_solved(), &seen.baked);
        let is_near = |index: &usize| {
            let apart_sq = baked.position_of(*index).distance_squared(place.position);
            apart_sq < place.radius * place.radius
                && baked.normal_of(*index).dot(place.normal) > LIKEWISE
                && solved.area_px[*index] > 0.0
                && look.is_between(solved.depth[*index])
        };
        let count = solved.area_px.len();
        let hair = |index: usize| {
            let ShownDirection { angle_rad, kappa } = look.direction(seen, index);
            let jacobian = seen.map.jacobian(baked.position_of(index));
            Hair {
                object: place.object,
                region: usize::from(seen.coat.seats.region(index)),
                particle: index,
                rank: (index as f32 + 0.5) / count as f32,
                position_px: [solved.x_px[index] + look.half_px[0], look.half_px[1] - solved.y_px[index]],
                angle_rad,
                kappa,
                depth: solved.depth[index],
                facing: facing(jacobian, baked.normal_of(index)) as f32,
            }
        };
        (0..count).filter(is_near).map(hair).filter(|hair| hair.facing > 0.0).take(most).collect()
    }
}

impl Look<'_> {
    fn direction(&self, seen: &SeenCoat<'_>, index: usize) -> ShownDirection {
        let (position, normal) = (seen.baked.position_of(index), seen.baked.normal_of(index));
        let jacobian = seen.map.jacobian(position);
        let region = seen.coat.seats.region(index);
        let contour = self.painting.rules[usize::from(region)].strokes.contour;
        let facing = facing(jacobian, normal) as f32;
        let lift = match self.painting.solver {
            Solver::Tangent => seen.baked.lift_of(index),
            Solver::Horn | Solver::HornExact => seen.coat.ground.surface_lift(index, region),
        };
        ShownDirection {
            angle_rad: along_contour(
                self.angle_rad(seen, index, &seen.solved(index)),
                contour,
                normal,
                (&seen.map, facing),
            ),
            kappa: lift.map(jacobian).kappa() as f32,
        }
    }
}

impl Painting {
    /// Those coats that are `wanted`, as a camera sees them.
    pub(crate) fn look(
        &self,
        camera: &CameraPose,
        frame: f64,
        options: &FrameOptions,
        wanted: impl Fn(&crate::coat::Coat) -> bool,
    ) -> Look<'_> {
        let scene = self.scene();
        let view = PictureView { pose: camera.clone(), size_px: options.size_px };
        let (poses, shapes) = (motion::poses_at(scene, frame), self.shapes_at(frame));
        Look::new(self, (&view, frame), (&poses, shapes), options, wanted)
    }
}
