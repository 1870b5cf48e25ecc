//! What bends a body: morph targets, joints and a point cache, in model space.

use std::sync::{Arc, OnceLock};

use glam::{DAffine3, DMat3, Vec3};
use impasto_core::bending::{Bend, Bonds, Gradients, Target, Vertices};
use impasto_scene::mesh_file::{MeshFile, Points};
use impasto_scene::morph;
use impasto_scene::point_cache::PointCache;
use rayon::prelude::*;

use crate::body_shape::BodyShape;

/// What bends a surface, model space.
#[derive(Debug, Default)]
pub(crate) struct BodyBend {
    /// Morph targets and joints.
    pub(crate) bend: Option<Bend>,
    pub(crate) cache: Option<BodyCache>,
    /// The shape that the surface's mesh has, without noise.
    pub(crate) rest: BodyShape,
    /// Gives the deformation gradient F at each vertex; made when first asked for.
    pub(crate) gradients: OnceLock<Gradients>,
    /// What went wrong when a point cache was read.
    pub(crate) fault: OnceLock<String>,
}

/// A point cache, and which of its points each vertex of a mesh follows.
#[derive(Clone, Debug)]
pub(crate) struct BodyCache {
    pub(crate) cache: Arc<PointCache>,
    pub(crate) points: Arc<Points>,
    pub(crate) model_from_file: DMat3,
}

impl BodyBend {
    /// The bend of the mesh of `file`. `morph` is a mesh of the same topology that it may morph into.
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

    /// Says which vertices with the same position and normal at rest stay together. Noise separates none of them, since
    /// the way it moves a vertex depends only on the position and normal.
    pub(crate) fn bonds(&self) -> Bonds<'_> {
        match (&self.cache, &self.bend) {
            (Some(cache), _) => Bonds::Points(&cache.points.of_vertex),
            (None, Some(bend)) => Bonds::Bend(bend),
            (None, None) => Bonds::All,
        }
    }

    /// The same bend with another shape as its rest. Its gradients are found anew when they are asked for; a fault is
    /// carried over.
    pub(crate) fn resting(self, rest: BodyShape) -> Self {
        Self { bend: self.bend, cache: self.cache, fault: self.fault, rest, ..Self::default() }
    }
}

/// Brings a bend into model space: transforms its joints or, if it has none, its vertices and targets.
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

impl BodyCache {
    /// Where the vertices of the mesh are at a frame, model space.
    pub(crate) fn positions(&self, frame: f64) -> std::io::Result<Vec<Vec3>> {
        let (points, place) = (self.cache.at(frame)?, self.model_from_file.as_mat3());
        Ok(self.points.of_vertex.par_iter().map(|&point| place * points[point as usize]).collect())
    }
}
