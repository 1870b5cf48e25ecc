//! The views from which the window shows a scene: through the shot's camera or free ones, reaching beyond the shot.

use impasto_painting::SeenFrom;
use impasto_scene::document::{Lens, Scene};
use impasto_scene::motion::{self, CameraPose};

use super::ViewJob;
use super::mailbox::Order;

/// Where the views of a job look from, and how far they reach. Large surfaces get most of their particles there.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct EditorViews {
    /// Cameras besides the shot's, each with a frame.
    free: Vec<(CameraPose, f64)>,
    /// How far the views reach from the middle of the shot: 1 is the border of the shot, 2 is twice as far.
    margin: f64,
}

/// Margins are rounded up to a multiple of this, so that a change of the window's size seldom changes the margin.
const MARGIN_STEP: f64 = 0.5;

/// [`ViewJob::shot_camera`] undoes the widening only up to rounding, so lenses that differ by at most this share count
/// as the same.
const SAME_LENS: f64 = 1e-4;

/// Whether a drag or playback is under way.
pub(super) fn is_moving(order: &Order) -> bool {
    order.job.views.iter().any(|view| view.moving)
}

impl EditorViews {
    pub(super) fn of(order: &Order) -> Self {
        let (scene, views) = (&order.job.loaded.scene, &order.job.views);
        let free = views.iter().filter(|view| is_free(view, scene));
        let reach = |view: &ViewJob| {
            let aspect = f64::from(scene.size.0.max(1)) / f64::from(scene.size.1.max(1));
            let [width, height] = view.size_px.map(f64::from);
            let shot_height = f64::from(view.shot_height_px.max(1.0));
            (height / shot_height).max(width / (shot_height * aspect))
        };
        let reach = views.iter().map(reach).fold(SeenFrom::MARGIN, f64::max).min(SeenFrom::MOST_MARGIN);
        Self {
            free: free.map(|view| (view.shot_camera(), view.frame)).collect(),
            margin: (reach / MARGIN_STEP - 0.01).ceil() * MARGIN_STEP,
        }
    }

    pub(super) fn seen_from(&self) -> SeenFrom<'_> {
        SeenFrom::Shot { also: &self.free, margin: self.margin }
    }
}

/// Whether the view is free: neither the shot's view at a whole frame of the timeline, nor the reference's view.
fn is_free(view: &ViewJob, scene: &Scene) -> bool {
    let [shot, now] = [motion::camera_at(scene, view.frame), view.shot_camera()];
    let near = |a: f64, b: f64| (a - b).abs() <= SAME_LENS * a.abs().max(b.abs());
    let same_lens = match (&shot.lens, &now.lens) {
        (Lens::Perspective { fov_y_deg: a, .. }, Lens::Perspective { fov_y_deg: b, .. })
        | (Lens::Orthographic { height: a, .. }, Lens::Orthographic { height: b, .. }) => near(*a, *b),
        _ => false,
    };
    let of = |pose: &CameraPose| (pose.eye, pose.target, pose.roll_rad);
    let in_timeline = (scene.timeline.first as f64..=scene.timeline.last as f64).contains(&view.frame);
    let is_of_shot = of(&shot) == of(&now) && same_lens && view.frame.fract() == 0.0 && in_timeline;
    let (reference, frame) = motion::referred_to(scene, &scene.reference);
    !is_of_shot && (of(&reference), frame) != (of(&now), view.frame)
}
