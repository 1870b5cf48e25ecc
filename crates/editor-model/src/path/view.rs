//! The view in which a guide was drawn, in the object's own space.

use glam::{DAffine3, DVec3};
use impasto_scene::document::{GuideView, Lens};
use impasto_scene::motion::CameraPose;

/// A camera in an object's own space. Roll, focal length, lens shift and picture size are left out, because they turn,
/// scale and shift a gesture and the surface under it alike.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ObjectView {
    /// The eye.
    pub eye: DVec3,
    /// What it looks at.
    pub target: DVec3,
    /// How its rays run.
    pub rays: Rays,
    /// The frame, for an object that bends.
    pub frame: Option<f64>,
}

/// How the rays of a lens run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rays {
    /// From the eye.
    Central,
    /// Along the gaze.
    Parallel,
}

/// Two views count as equal if their gazes (unit vectors) differ by at most this, and (with central rays) their eyes
/// differ by at most this share of the distance to the target.
const SAME: f64 = 1e-7;
/// If the eye moves away to this many times its distance from the target, its rays are practically parallel.
const FAR: f64 = 1e5;

impl ObjectView {
    /// The view of a camera, in the space of an object with this pose.
    pub fn new(camera: &CameraPose, world_from_model: DAffine3) -> Self {
        let model_from_world = world_from_model.inverse();
        let rays = match camera.lens {
            Lens::Perspective { .. } => Rays::Central,
            Lens::Orthographic { .. } => Rays::Parallel,
        };
        let [eye, target] = [camera.eye, camera.target].map(|at| model_from_world.transform_point3(at));
        Self { eye, target, rays, frame: None }
    }

    /// The same view, with the frame for an object that bends.
    pub fn at_frame(self, frame: Option<f64>) -> Self {
        Self { frame, ..self }
    }

    /// The view that is stored with a guide drawn in this view; `None` if this view is the reference. `middle` is a
    /// point of the guide.
    pub fn guide_view(&self, reference: &Self, middle: DVec3) -> Option<GuideView> {
        if self.is_same_as(reference) {
            return None;
        }
        let distance = self.eye.distance(self.target);
        // A guide's view is taken to have the same kind of rays as the reference, so a view of the other kind is
        // converted.
        let [eye, target] = match (self.rays, reference.rays) {
            (Rays::Parallel, Rays::Central) => {
                let centre = middle.reject_from(self.gaze()) + self.target.project_onto(self.gaze());
                [centre - self.gaze() * (distance * FAR), centre]
            }
            (Rays::Central, Rays::Parallel) => [self.eye, middle],
            _ => [self.eye, self.target],
        };
        Some(GuideView { eye: eye.to_array(), target: target.to_array(), frame: self.frame })
    }

    /// Its mirror image in planes through the object's origin: `flip` has −1 for each mirrored axis, else 1.
    pub fn mirrored(&self, flip: DVec3) -> Self {
        Self { eye: self.eye * flip, target: self.target * flip, ..*self }
    }

    pub(super) fn gaze(&self) -> DVec3 {
        (self.target - self.eye).normalize_or(DVec3::NEG_Z)
    }

    fn is_same_as(&self, other: &Self) -> bool {
        let aligned = (self.gaze() - other.gaze()).length() <= SAME;
        let distance = other.eye.distance(other.target);
        let together = self.eye.distance(other.eye) <= SAME * distance;
        self.rays == other.rays
            && self.frame == other.frame
            && aligned
            && (together || self.rays == Rays::Parallel)
    }
}
