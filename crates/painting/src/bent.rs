//! Bodies that have left their rest: where their vertices are at a frame, and what carries strokes there.

use std::collections::VecDeque;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use glam::{DAffine3, DMat3, Mat3, Vec3};
use impasto_core::TriangleMesh;
use impasto_core::bending::{Bend, CarriedPlace, Carrier, Gradients, Target, Vertices};
use impasto_core::sampling::PackedParticle;
use impasto_core::shells::sides;
use impasto_scene::mesh_file::{MeshFile, Points};
use impasto_scene::morph;
use impasto_scene::point_cache::PointCache;
use rayon::prelude::*;

use crate::body::{BodyShape, BodySurface};
use crate::noise_displace;

/// What bends a surface, model space.
#[derive(Debug, Default)]
pub(crate) struct BodyBend {
    /// Morph targets and joints.
    pub(crate) bend: Option<Bend>,
    pub(crate) cache: Option<BodyCache>,
    /// The shape in which the surface's mesh is; its noise is left out.
    pub(crate) rest: BodyShape,
    /// How the surface is strained; found when first asked for.
    gradients: OnceLock<Gradients>,
    /// What went wrong when a point cache was read.
    fault: OnceLock<String>,
}

/// A point cache, and how a mesh goes with it.
#[derive(Clone, Debug)]
pub(crate) struct BodyCache {
    pub(crate) cache: Arc<PointCache>,
    pub(crate) points: Arc<Points>,
    pub(crate) model_from_file: DMat3,
}

impl BodyBend {
    /// Of a mesh file, with the mesh of the same topology that it may morph into.
    pub(crate) fn new(
        file: &MeshFile,
        morph: Option<&MeshFile>,
        cache: Option<BodyCache>,
        model_from_file: DMat3,
    ) -> Self {
        let bound =
            || Vertices { positions: file.mesh.positions.clone(), normals: file.mesh.normals.clone() };
        let mut bend = file.bend.as_deref().cloned();
        // The scene's check refuses morphs of another topology.
        if let Some(target) = morph.and_then(|target| morph::target_of(file, target).ok()) {
            let bend = bend.get_or_insert_with(|| Bend { bound: bound(), ..Bend::default() });
            bend.targets.push(Target::between(&bound(), &target));
            bend.rest.weights.resize(bend.targets.len(), 0.0);
        }
        let bend = bend.map(|bend| placed(bend, model_from_file));
        Self { bend, cache, ..Self::default() }
    }

    /// The same at rest in another shape, of which nothing was measured yet.
    pub(crate) fn resting(self, rest: BodyShape) -> Self {
        Self { bend: self.bend, cache: self.cache, rest, ..Self::default() }
    }
}

/// A bend in model space: joints take vertices there; without joints, the vertices themselves are placed.
fn placed(mut bend: Bend, model_from_file: DMat3) -> Bend {
    if bend.skin.is_some() {
        let place = DAffine3::from_mat3(model_from_file);
        bend.rest.joints.iter_mut().for_each(|joint| *joint = place * *joint);
        return bend;
    }
    let position = model_from_file.as_mat3();
    let normal = model_from_file.inverse().transpose().as_mat3();
    bend.bound.positions.iter_mut().for_each(|at| *at = position * *at);
    let lengths: Vec<f32> =
        bend.bound.normals.iter().map(|own| (normal * *own).length().max(1e-30)).collect();
    bend.bound.normals.iter_mut().zip(&lengths).for_each(|(own, length)| *own = normal * *own / *length);
    for target in &mut bend.targets {
        target.positions.iter_mut().for_each(|step| *step = position * *step);
        for (step, vertex) in target.normals.iter_mut().zip(&target.vertices) {
            *step = normal * *step / lengths[*vertex as usize];
        }
    }
    bend
}

/// A surface that is not at rest.
#[derive(Debug)]
pub struct Bent {
    surface: Arc<BodySurface>,
    /// Where the vertices are, with the normals with which they are drawn.
    pub vertices: Vertices,
    carrier: OnceLock<Carrier>,
}

impl Bent {
    /// What carries places of the surface.
    pub(crate) fn carrier(&self) -> &Carrier {
        self.carrier.get_or_init(|| {
            let positions = &self.vertices.positions;
            Carrier::new(positions, &self.surface.gradients().at(positions))
        })
    }

    /// Where a place is now.
    pub(crate) fn place(&self, place: PackedParticle) -> CarriedPlace {
        self.carrier().place(&self.surface.mesh, place)
    }
}

impl BodySurface {
    /// A surface that nothing bends, without materials.
    pub fn still(mesh: TriangleMesh) -> Self {
        Self { sides: sides(&mesh), mesh, bending: BodyBend::default(), materials: Vec::new() }
    }

    /// Whether the surface in this shape is its mesh.
    pub fn is_at_rest(&self, shape: &BodyShape) -> bool {
        let rest = &self.bending.rest;
        (&shape.pose, shape.cache_frame) == (&rest.pose, rest.cache_frame) && shape.displacing().is_none()
    }

    /// Whether joints, targets or a point cache may bend it.
    pub fn bends(&self) -> bool {
        self.bending.bend.is_some() || self.bending.cache.is_some()
    }

    /// The surface in a shape; `None` at rest.
    pub fn bent(self: &Arc<Self>, shape: &BodyShape) -> Option<Arc<Bent>> {
        let vertices = (!self.is_at_rest(shape)).then(|| self.vertices_at(shape))?;
        Some(Arc::new(Bent { surface: Arc::clone(self), vertices, carrier: OnceLock::new() }))
    }

    /// Positions of the vertices of the surface in this shape.
    pub fn positions_at(&self, shape: &BodyShape) -> Vec<Vec3> {
        if self.is_at_rest(shape) { self.mesh.positions.clone() } else { self.vertices_at(shape).positions }
    }

    /// The vertices of the surface in this shape.
    pub fn vertices_at(&self, shape: &BodyShape) -> Vertices {
        let bent = self.unnoised(shape);
        match shape.displacing() {
            Some((noise, lookup)) => noise_displace::displaced(&bent, noise, lookup),
            None => bent,
        }
    }

    /// What went wrong when its point cache was read, if anything did.
    pub(crate) fn fault(&self) -> Option<&String> {
        self.bending.fault.get()
    }

    pub(crate) fn gradients(&self) -> &Gradients {
        self.bending.gradients.get_or_init(|| Gradients::new(&self.mesh))
    }

    /// The vertices as targets, joints or a cache put them.
    fn unnoised(&self, shape: &BodyShape) -> Vertices {
        let BodyBend { bend, cache, rest, .. } = &self.bending;
        if let Some((cache, frame)) = cache.as_ref().zip(shape.cache_frame) {
            return match cache.positions(frame) {
                Ok(positions) => self.with_own_normals(positions),
                Err(error) => {
                    let path = cache.cache.path().display();
                    let _ = self.bending.fault.set(format!("{path}, at frame {frame}: {error}"));
                    self.at_rest()
                }
            };
        }
        match bend {
            Some(bend) if shape.pose != rest.pose => {
                let bent = bend.at(shape.pose.as_deref().unwrap_or(&bend.rest));
                if bend.turns_normals { self.with_own_normals(bent.positions) } else { bent }
            }
            _ => self.at_rest(),
        }
    }

    fn at_rest(&self) -> Vertices {
        Vertices { positions: self.mesh.positions.clone(), normals: self.mesh.normals.clone() }
    }

    /// Vertices whose normals turn as the surface round them does.
    fn with_own_normals(&self, positions: Vec<Vec3>) -> Vertices {
        let gradients: Vec<Mat3> = self.gradients().at(&positions);
        let normals = self.gradients().normals(&self.mesh.normals, &gradients);
        Vertices { positions, normals }
    }
}

impl BodyCache {
    fn positions(&self, frame: f64) -> std::io::Result<Vec<Vec3>> {
        let (points, place) = (self.cache.at(frame)?, self.model_from_file.as_mat3());
        Ok(self.points.of_vertex.par_iter().map(|&point| place * points[point as usize]).collect())
    }
}

/// All bodies of a scene at one frame; `None` for those at rest.
pub(crate) type BentBodies = Arc<Vec<Option<Arc<Bent>>>>;

/// The bodies at the frames that were asked for last: several steps of one picture ask for the same frame.
#[derive(Default)]
pub(crate) struct BentMemo(Mutex<VecDeque<Remembered>>);

struct Remembered {
    frame: f64,
    shapes: Vec<BodyShape>,
    bodies: BentBodies,
}

/// How many frames are remembered.
const REMEMBERED: usize = 3;

impl BentMemo {
    /// The bodies at a frame, which have these surfaces. `shapes_at` is asked where the frame is not known.
    pub(crate) fn at<'a>(
        &self,
        frame: f64,
        surfaces: impl Iterator<Item = &'a Arc<BodySurface>>,
        shapes_at: impl FnOnce() -> Vec<BodyShape>,
    ) -> BentBodies {
        let known = |memo: &VecDeque<Remembered>| {
            let same = |entry: &&Remembered| entry.frame.to_bits() == frame.to_bits();
            memo.iter().find(same).map(|entry| Arc::clone(&entry.bodies))
        };
        if let Some(bodies) = known(&self.0.lock().unwrap_or_else(PoisonError::into_inner)) {
            return bodies;
        }
        let shapes = shapes_at();
        // A body in the shape of a frame before is the same one: what was drawn or uploaded for it holds.
        let before: Vec<Option<Arc<Bent>>> = {
            let memo = self.0.lock().unwrap_or_else(PoisonError::into_inner);
            let of_shape = |(object, shape): (usize, &BodyShape)| {
                let same = memo.iter().find(|entry| entry.shapes[object] == *shape)?;
                same.bodies[object].clone()
            };
            shapes.iter().enumerate().map(of_shape).collect()
        };
        let surfaces: Vec<&Arc<BodySurface>> = surfaces.collect();
        let bend = |((surface, shape), before): ((&&Arc<BodySurface>, &BodyShape), Option<Arc<Bent>>)| {
            before.or_else(|| surface.bent(shape))
        };
        let bodies: Vec<_> = surfaces.par_iter().zip(&shapes).zip(before).map(bend).collect();
        let bodies = Arc::new(bodies);
        let mut memo = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = known(&memo) {
            return known;
        }
        memo.truncate(REMEMBERED - 1);
        memo.push_front(Remembered { frame, shapes, bodies: Arc::clone(&bodies) });
        bodies
    }
}
