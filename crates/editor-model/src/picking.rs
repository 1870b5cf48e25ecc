//! Picking: rays through pixels, and the surfaces that they hit.

use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3};
use impasto_core::sampling::Particle;
use impasto_painting::frame::BodySurface;
use impasto_painting::{BodyShape, Painting};

mod surface;
#[cfg(test)]
mod tests;
mod view;

use surface::SurfaceTree;

pub use surface::SurfacePoint;
pub use view::{Ray, View};

/// Finds the surfaces that rays hit. Has a tree per object, rebuilt when the object's surface changes.
#[derive(Clone, Default)]
pub struct Picker {
    /// One per object, in the order of the scene.
    trees: Vec<Arc<SurfaceTree>>,
    /// Trees that were built elsewhere, for the next update.
    offered: Vec<Arc<SurfaceTree>>,
}

/// Where a ray meets the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Index of the object in the scene.
    pub object: usize,
    /// Index of the triangle in the object's mesh.
    pub triangle: u32,
    /// Weights of the triangle's three corners, sum 1.
    pub barycentric: [f64; 3],
    /// The point of the surface at rest, in the object's own space.
    pub position_in_model: DVec3,
    /// Smooth normal of the painted side, unit. A sheet is painted on both sides: its normal is that of the side that
    /// the ray met.
    pub normal_in_model: DVec3,
    /// Normal of the flat triangle on the same side, unit.
    pub face_normal_in_model: DVec3,
    /// The point that was hit, on the surface as it is now, in world space.
    pub position_in_world: DVec3,
    /// Distance from the ray's origin, world units.
    pub distance: f64,
    /// Whether the painted side was met: false inside a closed surface.
    pub front: bool,
    /// Whether the painted side is the triangle's back, the side from which its corners wind clockwise.
    pub flipped: bool,
}

impl Picker {
    /// Takes over the objects' surfaces in the order of the scene, each with its shape. Returns how many trees had to
    /// be built.
    pub fn update(&mut self, bodies: &[(Arc<BodySurface>, BodyShape)]) -> usize {
        let kept = std::mem::take(&mut self.trees);
        let offered = std::mem::take(&mut self.offered);
        let mut built = 0;
        self.trees = bodies
            .iter()
            .enumerate()
            .map(|(index, (surface, shape))| {
                // The tree of the same index is tried first, then all: an added or removed object shifts later indices.
                let all = kept.get(index).into_iter().chain(&kept).chain(&offered);
                let known = all.into_iter().find(|tree| tree.is_of(surface, shape));
                known.map_or_else(
                    || {
                        built += 1;
                        Arc::new(SurfaceTree::new(Arc::clone(surface), shape.clone()))
                    },
                    Arc::clone,
                )
            })
            .collect();
        built
    }

    /// As [`Picker::update`], with the surfaces of a painting as they are at a frame.
    pub fn follow(&mut self, painting: &Painting, frame: f64) -> usize {
        let shapes = painting.shapes_at(frame);
        let surfaces = (0..shapes.len()).map(|object| Arc::clone(painting.surface(object)));
        self.update(&surfaces.zip(shapes).collect::<Vec<_>>())
    }

    /// Takes the trees of another picker, so that the next update need not build them: large surfaces can be built on
    /// another thread.
    pub fn learn(&mut self, other: Self) {
        self.offered = other.trees;
    }

    /// The nearest visible surface on a ray, from either side. `poses` are the objects' `world_from_model`.
    pub fn pick(&self, ray: &Ray, poses: &[DAffine3], visible: impl Fn(usize) -> bool) -> Option<Hit> {
        let mut nearest: Option<Hit> = None;
        for (object, (tree, pose)) in self.trees.iter().zip(poses).enumerate() {
            if !visible(object) {
                continue;
            }
            let model_from_world = pose.inverse();
            let origin = model_from_world.transform_point3(ray.origin);
            let direction = model_from_world.transform_vector3(ray.direction);
            let farthest = nearest.map_or(f64::INFINITY, |hit| hit.distance);
            if let Some((point, distance, front)) = tree.first_hit(origin, direction, farthest) {
                let at = pose.transform_point3(point.position_now);
                nearest = Some(Hit::new(object, &point, at, distance, front));
            }
        }
        nearest
    }

    /// The point of an object's surface at rest that is nearest to `position_in_model`, at most `max_distance` (model
    /// units) from it. A point counts only if the normal of its painted side is less than 90 degrees from `facing`. A
    /// sheet is painted on both sides, so the side that faces that way is taken.
    pub fn closest_on_surface(
        &self,
        object: usize,
        position_in_model: DVec3,
        facing: DVec3,
        max_distance: f64,
    ) -> Option<SurfacePoint> {
        self.trees.get(object)?.closest(position_in_model, max_distance, facing)
    }

    /// A map from an object at rest to the object as it is now, both in its own space. It holds near `at_rest`, a point
    /// close to the surface at rest.
    pub fn now_from_rest(&self, object: usize, at_rest: DVec3) -> DAffine3 {
        self.trees.get(object).map_or(DAffine3::IDENTITY, |tree| tree.now_from_rest(at_rest))
    }

    /// Whether joints, shape keys or a point cache may bend an object.
    pub fn bends(&self, object: usize) -> bool {
        self.trees.get(object).is_some_and(|tree| tree.bends())
    }

    /// Least and greatest corner of the box round an object as it is now, in its own space; `None` without triangles.
    pub fn bounds_in_model(&self, object: usize) -> Option<[DVec3; 2]> {
        self.trees.get(object)?.bounds()
    }

    /// The surface of an object.
    pub fn surface(&self, object: usize) -> Option<&BodySurface> {
        self.trees.get(object).map(|tree| tree.surface())
    }

    /// Least and greatest corner of the box round some triangles of an object as they are now, in the object's own
    /// space. The triangles are those for whose middle `within` is true. The [`Hit`] that `within` gets has its
    /// `position_in_world` in the object's own space, too.
    pub fn bounds_where(&self, object: usize, within: impl Fn(&Hit) -> bool) -> Option<[DVec3; 2]> {
        let tree = self.trees.get(object)?;
        let mut bounds: Option<[DVec3; 2]> = None;
        for triangle in 0..tree.surface().mesh.triangles.len() as u32 {
            let middle = tree.middle(triangle);
            let hit = Hit::new(object, &middle, middle.position_now, 0.0, true);
            if within(&hit) {
                for corner in tree.corners(triangle) {
                    let [low, high] = bounds.unwrap_or([corner, corner]);
                    bounds = Some([low.min(corner), high.max(corner)]);
                }
            }
        }
        bounds
    }

    /// Least and greatest corner of the box round some objects as they stand, in world space; `None` without triangles.
    pub fn bounds_in_world(
        &self,
        objects: impl IntoIterator<Item = usize>,
        poses: &[DAffine3],
    ) -> Option<[DVec3; 2]> {
        let mut bounds: Option<[DVec3; 2]> = None;
        for object in objects {
            let (Some(own), Some(pose)) = (self.bounds_in_model(object), poses.get(object)) else { continue };
            for corner in 0..8 {
                let pick = |axis: usize| own[corner >> axis & 1][axis];
                let at = pose.transform_point3(DVec3::new(pick(0), pick(1), pick(2)));
                let [low, high] = bounds.unwrap_or([at, at]);
                bounds = Some([low.min(at), high.max(at)]);
            }
        }
        bounds
    }
}

/// How many world units a unit of an object's own space is long. For a pose that scales unevenly, this is the cube root
/// of the factor on volumes.
pub fn world_units_per_model_unit(world_from_model: DAffine3) -> f64 {
    let axes: DMat3 = world_from_model.matrix3;
    axes.determinant().abs().cbrt()
}

impl Hit {
    fn new(object: usize, point: &SurfacePoint, at: DVec3, distance: f64, front: bool) -> Self {
        Self {
            object,
            triangle: point.triangle,
            barycentric: point.barycentric,
            position_in_model: point.position,
            normal_in_model: point.normal,
            face_normal_in_model: point.face_normal,
            position_in_world: at,
            distance,
            front,
            flipped: point.flipped,
        }
    }

    /// The hit as a particle.
    pub fn particle(&self) -> Particle {
        Particle {
            triangle: self.triangle,
            barycentric: [self.barycentric[1] as f32, self.barycentric[2] as f32],
            flipped: self.flipped,
            position: self.position_in_model.as_vec3(),
            normal: self.normal_in_model.as_vec3(),
        }
    }

    /// How many pixels a unit of the object's own space takes at this hit, perpendicular to the gaze.
    pub fn px_per_model_unit(&self, view: &View, poses: &[DAffine3]) -> f64 {
        let scale = poses.get(self.object).map_or(1.0, |&pose| world_units_per_model_unit(pose));
        view.px_per_unit(self.position_in_world) * scale
    }
}
