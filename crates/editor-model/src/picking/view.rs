//! A camera with its viewport: from a pixel to a ray, and from the world to a pixel.

use glam::{DAffine3, DMat4, DVec2, DVec3};
use impasto_core::ScreenMap;
use impasto_core::screen_map::PixelLens;
use impasto_scene::document::Lens;
use impasto_scene::motion::CameraPose;

/// What a viewport shows. Pixels count from its top left corner, Y down, as pointers report them.
#[derive(Clone, Debug, PartialEq)]
pub struct View {
    /// The camera.
    pub camera: CameraPose,
    /// Width and height of the picture that the camera fills, in pixels, both > 0.
    pub size_px: DVec2,
}

/// A half line in world space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it begins: on the near plane of the lens.
    pub origin: DVec3,
    /// The unit vector along it.
    pub direction: DVec3,
}

impl View {
    /// The axes of the camera in world space, unit: right, up, and the gaze.
    pub fn axes(&self) -> [DVec3; 3] {
        let view = self.camera.view_from_world();
        [view.row(0), view.row(1), -view.row(2)].map(|row| row.truncate())
    }

    /// The ray through a pixel.
    pub fn ray(&self, at_px: DVec2) -> Ray {
        let world_from_view: DMat4 = self.camera.view_from_world().inverse();
        let from_centre = (at_px - self.size_px * 0.5) * DVec2::new(1.0, -1.0) - self.shift_px();
        let (origin, direction) = match self.camera.lens {
            Lens::Perspective { near, .. } => {
                let direction = from_centre.extend(-self.focal_px());
                (direction * (near / self.focal_px()), direction)
            }
            Lens::Orthographic { height, near, .. } => {
                ((from_centre * (height / self.size_px.y)).extend(-near), DVec3::NEG_Z)
            }
        };
        Ray {
            origin: world_from_view.transform_point3(origin),
            direction: world_from_view.transform_vector3(direction).normalize_or(DVec3::NEG_Z),
        }
    }

    /// The pixel at which a point of the world appears; `None` if it is nearer than the near plane.
    pub fn project(&self, position_in_world: DVec3) -> Option<DVec2> {
        let map = self.map(DAffine3::IDENTITY);
        let near = match self.camera.lens {
            Lens::Perspective { near, .. } | Lens::Orthographic { near, .. } => near,
        };
        // A little nearer is allowed: rays begin on the near plane, and their first point must still project.
        let least = near - near.abs() * 1e-9;
        (map.depth(position_in_world) >= least).then(|| self.viewport_px(map.project(position_in_world)))
    }

    /// Depth of a point along the gaze, world units.
    pub fn depth(&self, position_in_world: DVec3) -> f64 {
        self.map(DAffine3::IDENTITY).depth(position_in_world)
    }

    /// How many pixels a world unit perpendicular to the gaze takes at a point's depth. A point nearer than the near
    /// plane counts as lying on it.
    pub fn px_per_unit(&self, position_in_world: DVec3) -> f64 {
        match self.camera.lens {
            Lens::Perspective { near, .. } => self.focal_px() / self.depth(position_in_world).max(near),
            Lens::Orthographic { height, .. } => self.size_px.y / height,
        }
    }

    /// The map in which strokes are solved: from an object's own space to pixels from the picture's centre, Y up.
    pub fn map(&self, world_from_model: DAffine3) -> ScreenMap {
        let lens = match self.camera.lens {
            Lens::Perspective { .. } => PixelLens::Perspective { focal_px: self.focal_px() },
            Lens::Orthographic { height, .. } => {
                PixelLens::Orthographic { px_per_unit: self.size_px.y / height }
            }
        };
        ScreenMap::new(self.camera.view_from_world(), world_from_model, lens).shifted(self.shift_px())
    }

    /// The point that appears at a pixel and has the depth of another point.
    pub fn at_depth_of(&self, at_px: DVec2, position_in_world: DVec3) -> DVec3 {
        let ray = self.ray(at_px);
        let gaze = self.axes()[2];
        ray.origin + ray.direction * ((position_in_world - ray.origin).dot(gaze) / ray.direction.dot(gaze))
    }

    fn viewport_px(&self, from_centre_px: DVec2) -> DVec2 {
        self.size_px * 0.5 + from_centre_px * DVec2::new(1.0, -1.0)
    }

    /// The shift of the lens, pixels, Y up.
    fn shift_px(&self) -> DVec2 {
        self.camera.shift * (0.5 * self.size_px.y)
    }

    fn focal_px(&self) -> f64 {
        match self.camera.lens {
            Lens::Perspective { fov_y_deg, .. } => {
                0.5 * self.size_px.y / (0.5 * fov_y_deg.to_radians()).tan()
            }
            Lens::Orthographic { .. } => 1.0,
        }
    }
}
