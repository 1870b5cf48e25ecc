//! A camera with a picture's size, and the matrices and maps that projection and drawing take from it.

use glam::{DMat4, DVec2, DVec3};
use impasto_core::horn_exact::ClipView;
use impasto_core::screen_map::{PixelLens, ScreenMap};
use impasto_scene::document::Lens;
use impasto_scene::motion::CameraPose;

use crate::frame::FrameView;

/// A camera, and the size of the picture that it takes.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PictureView {
    pub(crate) pose: CameraPose,
    pub(crate) size_px: [u32; 2],
}

impl PictureView {
    pub(crate) fn near(&self) -> f64 {
        self.near_far().0
    }

    fn near_far(&self) -> (f64, f64) {
        match self.pose.lens {
            Lens::Perspective { near, far, .. } | Lens::Orthographic { near, far, .. } => (near, far),
        }
    }

    /// Where points of a body show, pixels from the picture's centre.
    pub(crate) fn screen_map(&self, world_from_model: glam::DAffine3) -> ScreenMap {
        let height_px = f64::from(self.size_px[1]);
        let lens = match self.pose.lens {
            Lens::Perspective { fov_y_deg, .. } => {
                PixelLens::Perspective { focal_px: 0.5 * height_px / (0.5 * fov_y_deg.to_radians()).tan() }
            }
            Lens::Orthographic { height, .. } => PixelLens::Orthographic { px_per_unit: height_px / height },
        };
        ScreenMap::new(self.pose.view_from_world(), world_from_model, lens)
            .shifted(self.pose.shift * (0.5 * height_px))
    }

    /// The same map as [`PictureView::screen_map`], but through OpenGL's matrices, as the source paper's own solver
    /// needs it.
    pub(crate) fn clip_view(&self, world_from_model: glam::DAffine3) -> ClipView {
        let size_px = DVec2::new(f64::from(self.size_px[0]), f64::from(self.size_px[1]));
        let clip_from_model =
            self.clip_from_view() * self.pose.view_from_world() * DMat4::from(world_from_model);
        ClipView { clip_from_model, size_px }
    }

    /// The view as a frame has it. The origin of the frame's world space is at `origin_in_world`.
    pub(crate) fn frame_view(&self, origin_in_world: DVec3) -> FrameView {
        let (near, far) = self.near_far();
        let there = DMat4::from_translation(origin_in_world);
        FrameView {
            origin_in_world,
            view_from_world: (self.pose.view_from_world() * there).as_mat4(),
            clip_from_view: self.clip_from_view().as_mat4(),
            eye_in_world: (self.pose.eye - origin_in_world).as_vec3(),
            orthographic: matches!(self.pose.lens, Lens::Orthographic { .. }),
            near_far: [near as f32, far as f32],
        }
    }

    fn clip_from_view(&self) -> DMat4 {
        let aspect = f64::from(self.size_px[0]) / f64::from(self.size_px[1]);
        let (near, far) = self.near_far();
        let centred = match self.pose.lens {
            Lens::Perspective { fov_y_deg, .. } => {
                glam::dcamera::rh::proj::opengl::perspective(fov_y_deg.to_radians(), aspect, near, far)
            }
            Lens::Orthographic { height, .. } => {
                let (half_width, half_height) = (0.5 * height * aspect, 0.5 * height);
                glam::dcamera::rh::proj::opengl::orthographic(
                    -half_width,
                    half_width,
                    -half_height,
                    half_height,
                    near,
                    far,
                )
            }
        };
        // Added after the division by w, as in `ScreenMap::shifted`.
        let shift = self.pose.shift / DVec2::new(aspect, 1.0);
        if shift == DVec2::ZERO { centred } else { DMat4::from_translation(shift.extend(0.0)) * centred }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DAffine3, DVec3};

    #[test]
    fn pixels_and_clip_space_agree() {
        for lens in [
            Lens::Perspective { fov_y_deg: 50.0, near: 0.1, far: 50.0 },
            Lens::Orthographic { height: 3.0, near: 0.1, far: 50.0 },
        ] {
            for size_px in [[1280, 720], [270, 630], [501, 501]] {
                let pose = CameraPose {
                    eye: DVec3::new(1.0, 2.0, 4.0),
                    target: DVec3::new(0.1, 0.5, -0.2),
                    roll_rad: 0.6,
                    shift: DVec2::new(0.3, -0.7),
                    lens: lens.clone(),
                };
                let view = PictureView { pose, size_px };
                let body = DAffine3::from_rotation_y(0.4);
                let point = DVec3::new(0.3, -0.2, 0.25);
                let difference = view.screen_map(body).project(point) - view.clip_view(body).pixel(point);
                assert!(difference.length() < 1e-9, "{lens:?} {size_px:?}: {difference}");
            }
        }
    }
}
