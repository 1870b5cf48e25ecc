//! Where the shot lies in the viewport, and the wider lens that also shows what is around it.

use egui::{Pos2, Rect, Vec2, vec2};
use glam::DVec2;
use impasto_editor_model::picking::View;
use impasto_scene::document::Lens;
use impasto_scene::motion::CameraPose;

/// A viewport and the shot in its middle, as large as fits, with the scene's aspect.
///
/// The picture fills the viewport. The camera's lens is widened so that the picture shows, within the rectangle `shot`,
/// exactly what a picture of the shot shows. The free camera is widened in the same way, so that nothing moves when the
/// user leaves the shot camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Framing {
    viewport: Rect,
    shot: Rect,
    pixels_per_point: f32,
}

impl Framing {
    /// The framing of a viewport at this place in the window, for a scene of this size.
    pub fn new(viewport: Rect, scene_size: (u32, u32), pixels_per_point: f32) -> Self {
        let size = viewport.size().max(vec2(1.0, 1.0));
        let viewport = Rect::from_min_size(viewport.min, size);
        let aspect = scene_size.0.max(1) as f32 / scene_size.1.max(1) as f32;
        let shot_size = if size.x / size.y > aspect {
            vec2(size.y * aspect, size.y)
        } else {
            vec2(size.x, size.x / aspect)
        };
        Self { viewport, shot: Rect::from_center_size(viewport.center(), shot_size), pixels_per_point }
    }

    /// The whole viewport, in points of the window.
    pub fn viewport(&self) -> Rect {
        self.viewport
    }

    /// The shot's part of the viewport, in points of the window.
    pub fn shot(&self) -> Rect {
        self.shot
    }

    /// The camera, with its lens widened to the viewport.
    pub fn widened(&self, camera: &CameraPose) -> CameraPose {
        let more = f64::from(self.viewport.height()) / f64::from(self.shot.height());
        let lens = match camera.lens {
            Lens::Perspective { fov_y_deg, near, far } => {
                let slope = (0.5 * fov_y_deg.to_radians()).tan() * more;
                Lens::Perspective { fov_y_deg: 2.0 * slope.atan().to_degrees(), near, far }
            }
            Lens::Orthographic { height, near, far } => {
                Lens::Orthographic { height: height * more, near, far }
            }
        };
        CameraPose { lens, shift: camera.shift / more, ..camera.clone() }
    }

    /// The view through a camera in this viewport, for picking and tools. Its coordinates are in points from the
    /// viewport's upper left corner.
    pub fn view(&self, camera: &CameraPose) -> View {
        let size = self.viewport.size();
        View { camera: self.widened(camera), size_px: DVec2::new(f64::from(size.x), f64::from(size.y)) }
    }

    /// Width and height of the exact picture, pixels.
    pub fn size_px(&self) -> [u32; 2] {
        let size: Vec2 = self.viewport.size() * self.pixels_per_point;
        [size.x, size.y].map(|side| side.round().clamp(1.0, 16384.0) as u32)
    }

    /// Height of the shot within the picture, pixels.
    pub fn shot_height_px(&self) -> f32 {
        self.size_px()[1] as f32 * self.shot.height() / self.viewport.height()
    }

    /// Where in the window to draw a picture of `size_px` pixels in which the shot is `shot_height_px` pixels high, so
    /// that this shot lies exactly over the shot of the framing. A picture that was drawn for the present size of the
    /// viewport fills it.
    pub fn place_of(&self, size_px: [u32; 2], shot_height_px: f32) -> Rect {
        if size_px == self.size_px() {
            return self.viewport;
        }
        let points_per_px = self.shot.height() / shot_height_px;
        let size = Vec2::from(size_px.map(|side| side as f32)) * points_per_px;
        Rect::from_center_size(self.viewport.center(), size)
    }

    /// Converts a place in the window to points from the viewport's upper left corner.
    pub fn from_window(&self, at: Pos2) -> DVec2 {
        let from = at - self.viewport.min;
        DVec2::new(f64::from(from.x), f64::from(from.y))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    fn framing(width: f32, height: f32) -> Framing {
        Framing::new(Rect::from_min_size(egui::pos2(48.0, 80.0), vec2(width, height)), (1280, 720), 1.0)
    }

    #[test]
    fn the_shot_is_as_large_as_fits_and_in_the_middle() {
        let wide = framing(950.0, 472.0);
        assert_eq!(wide.shot().height(), 472.0);
        assert!((wide.shot().width() - 472.0 * 16.0 / 9.0).abs() < 1e-3);
        let high = framing(950.0, 652.0);
        assert_eq!(high.shot().width(), 950.0);
        assert_eq!(high.shot().center(), high.viewport().center());
        assert!((high.shot_height_px() - 950.0 * 9.0 / 16.0).abs() < 1e-3);
    }

    #[test]
    fn an_older_picture_keeps_its_shape_until_the_new_one_comes() {
        let [before, now] = [framing(950.0, 650.0), framing(950.0, 430.0)];
        assert_eq!(now.place_of(now.size_px(), now.shot_height_px()), now.viewport());
        let place = now.place_of(before.size_px(), before.shot_height_px());
        assert!((place.aspect_ratio() - 950.0 / 650.0).abs() < 1e-3);
        assert_eq!(place.center(), now.viewport().center());
        // Its shot covers that of the viewport.
        let shot_high = place.height() * before.shot().height() / before.viewport().height();
        assert!((shot_high - now.shot().height()).abs() < 0.1, "{shot_high}");
    }

    #[test]
    fn what_the_shot_shows_lies_in_its_part_of_the_viewport() {
        let lenses = [
            Lens::Perspective { fov_y_deg: 28.0, near: 0.05, far: 100.0 },
            Lens::Orthographic { height: 2.0, near: 0.05, far: 100.0 },
        ];
        for lens in lenses {
            for framing in [framing(950.0, 650.0), framing(700.0, 300.0)] {
                let camera = CameraPose {
                    eye: DVec3::new(0.3, 1.0, 4.0),
                    target: DVec3::new(0.1, 0.2, 0.0),
                    roll_rad: 0.4,
                    shift: DVec2::ZERO,
                    lens: lens.clone(),
                };
                let shot = framing.shot();
                let alone = View {
                    camera: camera.clone(),
                    size_px: DVec2::new(f64::from(shot.width()), f64::from(shot.height())),
                };
                let corner = framing.from_window(shot.min);
                for point in [DVec3::ZERO, DVec3::new(0.4, 0.3, 1.0), DVec3::new(-0.7, 0.1, -2.0)] {
                    let apart = framing.view(&camera).project(point).unwrap() - corner;
                    let gap = (apart - alone.project(point).unwrap()).length();
                    assert!(gap < 1e-3, "{lens:?} {point}: {gap}");
                }
            }
        }
    }
}
