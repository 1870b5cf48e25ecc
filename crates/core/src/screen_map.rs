//! The map from points of model space to pixels of the picture, and its Jacobian.

use glam::{DAffine3, DMat3, DMat4, DVec2, DVec3, DVec4};

/// Projects points of one body into one picture: pixels, origin in the picture's centre, Y up.
///
/// With homogeneous `p = (x, y, z, 1)`: `x_px = (row_x·p)/(row_w·p)` and `y_px = (row_y·p)/(row_w·p)`. A perspective
/// lens has `row_w = row_depth`, an orthographic one `row_w = (0, 0, 0, 1)`; everything else is the same for both.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScreenMap {
    /// Numerator of the x coordinate.
    pub row_x: DVec4,
    /// Numerator of the y coordinate.
    pub row_y: DVec4,
    /// Denominator of both.
    pub row_w: DVec4,
    /// Depth along the gaze, world units, positive in front.
    pub row_depth: DVec4,
    /// The body's pose, where it does not scale all directions alike.
    pub uneven: Option<UnevenPose>,
}

/// The linear part of a pose that does not scale all directions alike.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UnevenPose {
    /// What the pose does to steps on the surface.
    pub world_from_model: DMat3,
    /// What the pose does to the direction of normals; the length that comes out means nothing.
    pub world_from_normal: DMat3,
}

/// How the camera projects onto a picture of a given height.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PixelLens {
    /// `focal_px` = height / (2 tan(fov_y / 2)).
    Perspective {
        /// Distance from the eye to the picture plane, in pixels.
        focal_px: f64,
    },
    /// Parallel rays.
    Orthographic {
        /// Pixels per world unit.
        px_per_unit: f64,
    },
}

impl ScreenMap {
    /// The map of a body at `world_from_model` seen through `view_from_world` (right-handed, looking down −Z).
    pub fn new(view_from_world: DMat4, world_from_model: DAffine3, lens: PixelLens) -> Self {
        let view_from_model = view_from_world * DMat4::from(world_from_model);
        let (x, y, depth) = (view_from_model.row(0), view_from_model.row(1), -view_from_model.row(2));
        let (scale, row_w) = match lens {
            PixelLens::Perspective { focal_px } => (focal_px, depth),
            PixelLens::Orthographic { px_per_unit } => (px_per_unit, DVec4::W),
        };
        let pose = world_from_model.matrix3;
        let uneven = is_uneven(pose, UNEVEN)
            .then(|| UnevenPose { world_from_model: pose, world_from_normal: pose.inverse().transpose() });
        Self { row_x: x * scale, row_y: y * scale, row_w, row_depth: depth, uneven }
    }

    /// The same map with `offset_px` added to every place in the picture: the shift of a lens.
    #[must_use]
    pub fn shifted(self, offset_px: DVec2) -> Self {
        if offset_px == DVec2::ZERO {
            return self;
        }
        let (row_x, row_y) = (self.row_x + self.row_w * offset_px.x, self.row_y + self.row_w * offset_px.y);
        Self { row_x, row_y, ..self }
    }

    /// As [`facing`], but right also where the body's pose scales directions differently.
    #[inline]
    pub fn facing(&self, jacobian: [DVec3; 2], normal_in_model: DVec3) -> f64 {
        let Some(UnevenPose { world_from_model, world_from_normal }) = self.uneven else {
            return facing(jacobian, normal_in_model);
        };
        // Let M be the pose, and n and m the normal and the direction to the eye in model space. In world space these
        // two are M⁻ᵀ n and M m, and their dot product is still n·m.
        let towards_eye = jacobian[0].cross(jacobian[1]);
        let lengths =
            (world_from_normal * normal_in_model).length() * (world_from_model * towards_eye).length();
        let cosine = normal_in_model.dot(towards_eye) / lengths;
        if cosine.is_finite() { cosine } else { 0.0 }
    }

    /// Where a point of model space shows, in pixels from the picture's centre; not finite on the eye's plane.
    pub fn project(&self, position_in_model: DVec3) -> DVec2 {
        let p = position_in_model.extend(1.0);
        DVec2::new(self.row_x.dot(p), self.row_y.dot(p)) / self.row_w.dot(p)
    }

    /// Depth of a point of model space along the gaze.
    pub fn depth(&self, position_in_model: DVec3) -> f64 {
        self.row_depth.dot(position_in_model.extend(1.0))
    }

    /// The two rows of the Jacobian J (pixels per model unit) at a point, for any lens.
    #[inline]
    pub fn jacobian(&self, position_in_model: DVec3) -> [DVec3; 2] {
        let p = position_in_model.extend(1.0);
        let w = self.row_w.dot(p);
        let (u, v) = (self.row_x.dot(p) / w, self.row_y.dot(p) / w);
        [
            (self.row_x.truncate() - self.row_w.truncate() * u) / w,
            (self.row_y.truncate() - self.row_w.truncate() * v) / w,
        ]
    }
}

/// A pose is uneven where squares of lengths differ by more than this share.
const UNEVEN: f64 = 1e-9;

/// Whether a linear map scales directions differently, so that squares of lengths differ by more than `share`.
pub fn is_uneven(pose: DMat3, share: f64) -> bool {
    let [x, y, z] = [pose.x_axis, pose.y_axis, pose.z_axis];
    let size = x.length_squared();
    let off = [y.length_squared() - size, z.length_squared() - size, x.dot(y), y.dot(z), z.dot(x)];
    off.iter().any(|off| off.abs() > share * size)
}

/// Projected area in px² per unit of surface with this unit normal, positive where the surface faces the eye:
/// `n · (j_x × j_y)`.
#[inline]
pub fn area_px(jacobian: [DVec3; 2], normal_in_model: DVec3) -> f64 {
    normal_in_model.dot(jacobian[0].cross(jacobian[1]))
}

/// Cosine between the normal and the direction to the eye; 0 where the Jacobian is singular.
#[inline]
pub fn facing(jacobian: [DVec3; 2], normal_in_model: DVec3) -> f64 {
    let towards_eye = jacobian[0].cross(jacobian[1]);
    let length = towards_eye.length();
    if length > 0.0 { normal_in_model.dot(towards_eye) / length } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;

    fn tilted_map(lens: PixelLens) -> ScreenMap {
        let view = DMat4::from_rotation_translation(DQuat::from_rotation_z(0.3), DVec3::new(0.1, -0.2, -4.0));
        let pose =
            DAffine3::from_rotation_translation(DQuat::from_rotation_y(0.7), DVec3::new(0.2, 0.1, 0.3));
        ScreenMap::new(view, pose, lens)
    }

    #[test]
    fn jacobian_is_the_derivative_of_the_projection() {
        for lens in
            [PixelLens::Perspective { focal_px: 900.0 }, PixelLens::Orthographic { px_per_unit: 200.0 }]
        {
            let map = tilted_map(lens);
            let at = DVec3::new(0.4, -0.3, 0.5);
            let jacobian = map.jacobian(at);
            for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                let step = 1e-5;
                let slope = (map.project(at + axis * step) - map.project(at - axis * step)) / (2.0 * step);
                assert!((slope.x - jacobian[0].dot(axis)).abs() < 1e-4, "{lens:?}");
                assert!((slope.y - jacobian[1].dot(axis)).abs() < 1e-4, "{lens:?}");
            }
        }
    }

    #[test]
    fn a_stretched_body_faces_the_eye_as_its_surface_in_the_world_does() {
        let view = DMat4::from_translation(DVec3::new(0.0, 0.0, -5.0));
        let lens = PixelLens::Perspective { focal_px: 700.0 };
        let pose = DAffine3::from_scale(DVec3::new(3.0, 1.0, 0.4)) * DAffine3::from_rotation_y(0.7);
        let (stretched, still) =
            (ScreenMap::new(view, pose, lens), ScreenMap::new(view, DAffine3::IDENTITY, lens));
        let (at, normal) = (DVec3::new(0.2, -0.3, 0.4), DVec3::new(0.3, 0.2, 0.9).normalize());
        let normal_in_world = (pose.matrix3.inverse().transpose() * normal).normalize();
        let expected = still.facing(still.jacobian(pose.transform_point3(at)), normal_in_world);
        let found = stretched.facing(stretched.jacobian(at), normal);
        assert!((found - expected).abs() < 1e-12 && expected > 0.1, "{found} {expected}");
        assert!(stretched.uneven.is_some() && still.uneven.is_none());
    }

    #[test]
    fn facing_is_the_cosine_to_the_eye() {
        let map = tilted_map(PixelLens::Perspective { focal_px: 900.0 });
        let at = DVec3::new(0.4, -0.3, 0.5);
        // The eye is where numerators and denominator vanish together.
        let eye = DMat3::from_cols(map.row_x.truncate(), map.row_y.truncate(), map.row_w.truncate())
            .transpose()
            .inverse()
            * -DVec3::new(map.row_x.w, map.row_y.w, map.row_w.w);
        let normal = DVec3::new(0.1, 0.2, 0.9).normalize();
        let expected = normal.dot((eye - at).normalize());
        assert!((facing(map.jacobian(at), normal) - expected).abs() < 1e-12);
    }
}
