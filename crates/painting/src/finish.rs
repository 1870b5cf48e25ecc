//! Computes the finish of a frame (ground, canvas, relief and varnish) from what the document states.

use glam::{Affine2, DAffine3, DMat2, DVec2, DVec3};
use impasto_scene::document::{CanvasFollows, Preparation, Scene};
use impasto_scene::motion;
use impasto_scene::presets::{self, LayerKind};

use crate::frame::{Finish, Ground};
use crate::lights;
use crate::view::PictureView;

/// Direction to the light on the relief where the scene has no sun: to the upper left, as in most studios.
const DEFAULT_RELIEF_LIGHT: DVec3 = DVec3::new(-0.55, 0.62, 0.56);

/// The least and the greatest sine of the relief light's angle over the canvas. A lower light would shade the relief
/// too harshly, and a higher light too flatly.
const HEIGHTS: [f64; 2] = [0.45, 0.7];

/// A scene's finish, before a view places the canvas.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct FinishRule {
    finish: Finish,
    /// Where the camera looked in the reference pose, world space, for a canvas that follows the camera.
    anchor: Option<DVec3>,
    reference: PictureView,
}

impl FinishRule {
    pub(crate) fn new(scene: &Scene, style: &Preparation, reference: &PictureView) -> Self {
        let paper = presets::is_paper(scene);
        let ground = presets::ground(scene);
        let toned = presets::paints_layer(scene, LayerKind::Underpainting);
        let strength = |value: f64| if paper { 0.0 } else { value as f32 };
        let finish = Finish {
            ground: toned.then(|| Ground { color: lights::linear(ground.color), hides: ground.opacity }),
            weave: strength(style.weave),
            canvas_from_px: Affine2::IDENTITY,
            samples: style.samples,
            relief: strength(style.relief),
            to_relief_light: relief_light(scene, reference),
            varnish: strength(style.varnish),
        };
        let follows = style.canvas_follows == CanvasFollows::Camera;
        let anchor = follows.then_some(reference.pose.target);
        Self { finish, anchor, reference: reference.clone() }
    }

    /// The finish of a picture in this view. `shot_height_px` is the height of the shot in it: less than the picture's
    /// where the editor shows more than the shot. With `keep_stroke_px` the canvas keeps its size in pixels too.
    pub(crate) fn at(&self, view: &PictureView, shot_height_px: f64, keep_stroke_px: bool) -> Finish {
        let size_px = f64::from(self.reference.size_px[1]) / shot_height_px;
        let unit_px = if keep_stroke_px { 1.0 } else { size_px };
        let canvas_from_px =
            self.anchor.and_then(|anchor| self.canvas_from_px(anchor, view, [size_px, unit_px]));
        Finish { canvas_from_px: canvas_from_px.unwrap_or(Affine2::IDENTITY), ..self.finish }
    }

    /// The transform that moves, turns and scales the canvas with `anchor`, the point that the camera looked at in the
    /// reference pose. `None` where that point is too near to show, or behind the eye. One pixel of this picture is as
    /// long as `size_px` pixels of a picture of the scene's size, and as `unit_px` units of [`Finish::canvas_from_px`].
    fn canvas_from_px(
        &self,
        anchor: DVec3,
        view: &PictureView,
        [size_px, unit_px]: [f64; 2],
    ) -> Option<Affine2> {
        let (before, now) =
            (self.reference.screen_map(DAffine3::IDENTITY), view.screen_map(DAffine3::IDENTITY));
        let scale_of = |map: &impasto_core::ScreenMap| {
            let [x, y] = map.jacobian(anchor);
            x.cross(y).length().sqrt()
        };
        let (from, to) = (now.project(anchor), before.project(anchor));
        let scale = scale_of(&before) / scale_of(&now);
        let seen = now.depth(anchor) > view.near() && before.depth(anchor) > self.reference.near();
        if !seen || !scale.is_finite() || scale <= 0.0 || !from.is_finite() || !to.is_finite() {
            return None;
        }
        // A camera rolled by +a turns the picture by −a.
        let turn = DMat2::from_angle(view.pose.roll_rad - self.reference.pose.roll_rad) * (scale / size_px);
        let shift: DVec2 = to - turn * (from * unit_px);
        let map = Affine2::from_mat2_translation(turn.as_mat2(), shift.as_vec2());
        Some(map).filter(Affine2::is_finite)
    }
}

/// Direction to the first sun of the reference, in the axes of the reference's camera. The sun's height over the canvas
/// is held to [`HEIGHTS`]. [`DEFAULT_RELIEF_LIGHT`] if there is no sun, or if it shines straight along the gaze.
fn relief_light(scene: &Scene, reference: &PictureView) -> [f32; 3] {
    let (_, frame) = motion::referred_to(scene, &scene.reference);
    let lights = lights::resolve(scene, frame, (glam::Vec3::ZERO, 1.0), DVec3::ZERO);
    let view = reference.pose.view_from_world();
    let seen = lights.suns.first().map(|sun| view.transform_vector3(sun.to_light.as_dvec3()));
    let flat = seen.map(|light| light.truncate()).filter(|flat| flat.length() > 1e-3);
    let Some(flat) = flat else { return DEFAULT_RELIEF_LIGHT.normalize().as_vec3().to_array() };
    let height = seen.map_or(0.0, |light| light.z).clamp(HEIGHTS[0], HEIGHTS[1]);
    let flat = flat.normalize() * (1.0 - height * height).sqrt();
    flat.extend(height).as_vec3().to_array()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec2;
    use impasto_scene::document::Lens;
    use impasto_scene::motion::CameraPose;

    fn view(eye: DVec3, roll_rad: f64) -> PictureView {
        let pose = CameraPose {
            eye,
            target: DVec3::new(0.2, -0.1, 0.0),
            roll_rad,
            shift: DVec2::ZERO,
            lens: Lens::Perspective { fov_y_deg: 35.0, near: 0.1, far: 50.0 },
        };
        PictureView { pose, size_px: [640, 360] }
    }

    #[test]
    fn a_canvas_that_follows_moves_as_what_is_looked_at() {
        let reference = view(DVec3::new(0.0, 0.0, 5.0), 0.0);
        let anchor = reference.pose.target;
        let rule =
            FinishRule { finish: Finish::default(), anchor: Some(anchor), reference: reference.clone() };
        // A point beside the anchor, in the plane that faces the reference camera.
        let beside = anchor + DVec3::new(0.05, 0.03, 0.0);
        for other in [view(DVec3::new(0.0, 0.0, 3.0), 0.0), view(DVec3::new(0.0, 0.0, 5.0), 0.4)] {
            let map = rule.at(&other, 360.0, false).canvas_from_px;
            let before = reference.screen_map(DAffine3::IDENTITY);
            let now = other.screen_map(DAffine3::IDENTITY);
            for point in [anchor, beside] {
                let on_canvas = map.transform_point2(now.project(point).as_vec2());
                let difference = (on_canvas.as_dvec2() - before.project(point)).length();
                assert!(difference < 0.1, "off by {difference} px");
            }
        }
        let still = rule.at(&reference, 360.0, false).canvas_from_px;
        assert!((still.transform_point2(Vec2::new(50.0, -20.0)) - Vec2::new(50.0, -20.0)).length() < 1e-3);
        // In a picture twice as large, positions are halved; or not, if the canvas keeps its size in pixels.
        for eye in [DVec3::new(0.0, 0.0, 5.0), DVec3::new(1.0, 0.4, 3.0)] {
            let large = PictureView {
                size_px: [1280, 720],
                pose: CameraPose { target: DVec3::ZERO, ..view(eye, 0.3).pose },
            };
            let at_px = large.screen_map(DAffine3::IDENTITY).project(anchor);
            let wanted = reference.screen_map(DAffine3::IDENTITY).project(anchor);
            for (keep_stroke_px, unit_px) in [(false, 0.5), (true, 1.0)] {
                let map = rule.at(&large, 720.0, keep_stroke_px).canvas_from_px;
                let on_canvas = map.transform_point2((at_px * unit_px).as_vec2()).as_dvec2();
                assert!(
                    at_px.length() > 5.0 && on_canvas.distance(wanted) < 0.1,
                    "{on_canvas}, not {wanted}"
                );
            }
        }
    }
}
