//! The stage of a scene: what its shot brings. The document knows a shot only as the trait [`Brought`]; [`crate::shot`]
//! reads the file.

use std::fmt::Debug;
use std::sync::Arc;

use glam::{DAffine3, DMat4, DVec2};
use impasto_core::bending::BendPose;
use impasto_gltf::Posed;

use super::{Lens, Light, Object, Scene};

/// The shot of a scene, if it has one. Two stages are equal if they share one shot or both have none; files are not
/// compared.
#[derive(Clone, Debug, Default)]
pub struct Stage {
    /// The shot.
    pub shot: Option<Arc<dyn Brought>>,
    /// What the document states for objects that the shot does not have any more.
    pub lost: Arc<Vec<Object>>,
}

impl PartialEq for Stage {
    fn eq(&self, other: &Self) -> bool {
        match (&self.shot, &other.shot) {
            (Some(own), Some(other)) => Arc::ptr_eq(own, other),
            (own, other) => own.is_none() && other.is_none(),
        }
    }
}

/// An object that a document states without a mesh, and that the shot does not have.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Lost {
    /// Its index in the document before [`Brought::enter`] takes it out.
    pub index: usize,
    /// Its name.
    pub name: String,
    /// The name in the shot that is most like it.
    pub near: Option<String>,
}

/// The camera of a shot at one time.
#[derive(Clone, Debug, PartialEq)]
pub struct Seen {
    /// World from view: −Z forward, Y up.
    pub world_from_view: DMat4,
    /// The lens.
    pub lens: Lens,
    /// Shift of the lens: added to positions in the picture, in half heights of the picture, Y up.
    pub shift: DVec2,
}

/// What a shot brings into a scene, at any time.
pub trait Brought: Debug + Send + Sync {
    /// Whether it has a camera to look through.
    fn has_camera(&self) -> bool;

    /// Whether it brings this object.
    fn has_object(&self, name: &str) -> bool;

    /// The first and the last time of its animations, seconds; `None` where nothing moves.
    fn span_s(&self) -> Option<[f32; 2]>;

    /// Where everything stands at a time, seconds.
    fn at(&self, time_s: f64) -> Posed;

    /// World from model of an object; `None` if the shot does not bring it.
    fn pose_of(&self, posed: &Posed, name: &str) -> Option<DAffine3>;

    /// Whether joints or targets bend an object with this mesh.
    fn bends(&self, name: &str, mesh: &str) -> bool;

    /// How joints and targets bend an object with this mesh, in the space of its mesh file; `None` where the shot does
    /// not bend it.
    fn bend_of(&self, posed: &Posed, name: &str, mesh: &str) -> Option<BendPose>;

    /// Whether things are hidden or shown over time.
    fn changes_visibility(&self) -> bool;

    /// Whether an object shows. Objects that the shot does not bring always do.
    fn is_visible(&self, posed: &Posed, name: &str) -> bool;

    /// The camera at a time in seconds, with the lens fitted to a picture of this size in pixels; `None` if the shot
    /// has no camera. The picture shows all that the camera shows in its own aspect, and more at two sides if the
    /// picture's aspect differs.
    fn camera(&self, time_s: f64, size: (u32, u32)) -> Option<Seen>;

    /// Whether a collection holds an object; `None` where the shot knows no such collection.
    fn in_collection(&self, collection: &str, object: &str) -> Option<bool>;

    /// How much brighter the finished picture is shown, stops.
    fn exposure_stops(&self) -> f32;

    /// A light of the scene in this pose of the shot: intensity, colour, direction, position and cone are the shot's,
    /// unless the document changed them.
    fn light(&self, light: &Light, posed: &Posed) -> Light;

    /// Puts the shot on the scene's stage. Adds its objects and lights, except those whose names the document states
    /// itself. If the document states such an object without a mesh, the object gets the shot's mesh, and the shot's
    /// point cache if it states none itself. An object without a mesh that the shot does not have goes from the scene
    /// to [`Stage::lost`], and is returned. Takes the shot's rate, frames and sky where the document states none.
    fn enter(self: Arc<Self>, scene: &mut Scene) -> Vec<Lost>;

    /// The document as it is saved: without what comes from the shot alone. An object of the shot that was deleted is
    /// stated as hidden, and a light as one of intensity 0, since they would come back otherwise.
    fn left(&self, scene: &Scene) -> Scene;
}

impl Scene {
    /// Whether an object moves as the shot has it: the shot brings it, and it has no keys of its own.
    pub fn is_moved_by_shot(&self, object: &Object) -> bool {
        object.keys.is_empty() && self.stage.shot.as_ref().is_some_and(|shot| shot.has_object(&object.name))
    }

    /// Whether the camera is the shot's.
    pub fn has_camera_of_shot(&self) -> bool {
        self.camera.keys.is_empty() && self.stage.shot.as_ref().is_some_and(|shot| shot.has_camera())
    }

    /// The document as it is saved: without what comes from its shot alone.
    pub fn without_shot(&self) -> Self {
        self.stage.shot.as_ref().map_or_else(|| self.clone(), |shot| shot.left(self))
    }
}
