//! Finds how strokes should turn, for comparison with the painted strokes: computes the local map between two pictures
//! by finite differences. The camera matrix is written out here, so that this code shares no function with the code
//! that paints.

use glam::{DAffine3, DMat3, DVec2, DVec3, DVec4};
use impasto_core::TriangleMesh;
use impasto_core::bending::Vertices;
use impasto_core::sampling::Particle;
use impasto_scene::document::Lens;
use impasto_scene::motion::CameraPose;

/// A camera with the size of its picture.
#[derive(Clone, Debug)]
pub struct TrueView {
    /// Rows x, y and w of the matrix clip_from_world; row z is not needed.
    rows: [DVec4; 3],
    half_px: DVec2,
    eye: DVec3,
    /// The gaze of an orthographic lens; `None` for a perspective lens.
    parallel: Option<DVec3>,
}

impl TrueView {
    /// The view of a camera in a picture of this size.
    pub fn new(camera: &CameraPose, size_px: [u32; 2]) -> Self {
        let gaze = (camera.target - camera.eye).normalize();
        let up = if gaze.cross(DVec3::Y).length() > 1e-10 { DVec3::Y } else { DVec3::Z };
        let right = gaze.cross(up).normalize();
        let above = right.cross(gaze);
        // The camera's own axes turn counter-clockwise by the roll.
        let (sin, cos) = camera.roll_rad.sin_cos();
        let axes = [right * cos + above * sin, above * cos - right * sin];
        let size = DVec2::new(f64::from(size_px[0]), f64::from(size_px[1]));
        let row = |axis: DVec3, scale: f64| (axis * scale).extend(-axis.dot(camera.eye) * scale);
        let (scale, w) = match camera.lens {
            Lens::Perspective { fov_y_deg, .. } => {
                (1.0 / (0.5 * fov_y_deg.to_radians()).tan(), gaze.extend(-gaze.dot(camera.eye)))
            }
            Lens::Orthographic { height, .. } => (2.0 / height, DVec4::W),
        };
        let shift = camera.shift * DVec2::new(size.y / size.x, 1.0);
        Self {
            rows: [row(axes[0], scale * size.y / size.x) + w * shift.x, row(axes[1], scale) + w * shift.y, w],
            half_px: size * 0.5,
            eye: camera.eye,
            parallel: matches!(camera.lens, Lens::Orthographic { .. }).then_some(gaze),
        }
    }

    /// Where a point of world space shows, pixels from the picture's centre, Y up.
    pub fn pixel(&self, at: DVec3) -> DVec2 {
        let [x, y, w] = self.rows.map(|row| row.dot(at.extend(1.0)));
        DVec2::new(x / w, y / w) * self.half_px
    }

    /// Whether a point is in front of the eye; always true with an orthographic lens.
    pub fn is_in_front(&self, at: DVec3) -> bool {
        self.rows[2].dot(at.extend(1.0)) > 0.0
    }

    /// Cosine between a unit normal and the direction to the eye.
    pub fn facing(&self, at: DVec3, normal: DVec3) -> f64 {
        let towards_eye = self.parallel.map_or_else(|| (self.eye - at).normalize_or_zero(), |gaze| -gaze);
        normal.dot(towards_eye)
    }

    /// How many pixels a point moves per unit along each of two tangents, by central differences: the columns of a 2×2
    /// matrix.
    fn columns(&self, at: DVec3, tangents: [DVec3; 2], step: f64) -> [DVec2; 2] {
        tangents
            .map(|tangent| (self.pixel(at + tangent * step) - self.pixel(at - tangent * step)) / (2.0 * step))
    }
}

/// A point of a surface in model space.
#[derive(Clone, Copy, Debug)]
pub struct SurfacePoint {
    /// Position.
    pub position: DVec3,
    /// Unit normal.
    pub normal: DVec3,
}

/// How a point of a surface moves in model space, from the body's shape in the reference view to its current one.
#[derive(Clone, Copy, Debug)]
pub struct PointMotion {
    /// The point in the reference's shape.
    pub before: SurfacePoint,
    /// The point in the current shape.
    pub after: SurfacePoint,
    /// F, the deformation gradient: it carries directions from the reference's shape to the current one. It is the
    /// identity on a surface that keeps its shape.
    pub carry: DMat3,
}

impl PointMotion {
    /// A point of a surface that keeps its shape.
    pub fn rigid(point: SurfacePoint) -> Self {
        Self { before: point, after: point, carry: DMat3::IDENTITY }
    }

    /// The motion of a particle between two shapes of a surface that bends. F follows from the edges of the particle's
    /// triangle and the normal.
    pub fn of(mesh: &TriangleMesh, particle: &Particle, shapes: [&Vertices; 2]) -> Self {
        let corners = mesh.triangles[particle.triangle as usize].map(|vertex| vertex as usize);
        let weights = {
            let [v, w] = particle.barycentric.map(f64::from);
            [1.0 - v - w, v, w]
        };
        let at = |shape: &Vertices| {
            let places = corners.map(|vertex| shape.positions[vertex].as_dvec3());
            let normals = corners.map(|vertex| shape.normals[vertex].as_dvec3());
            let blend = |values: [DVec3; 3]| (0..3).map(|i| values[i] * weights[i]).sum::<DVec3>();
            let side = if particle.flipped { -1.0 } else { 1.0 };
            let across = (places[1] - places[0]).cross(places[2] - places[0]) * side;
            let smooth = blend(normals);
            let normal = if smooth.dot(across) < 0.0 { -smooth } else { smooth }.normalize_or_zero();
            let frame = DMat3::from_cols(places[1] - places[0], places[2] - places[0], normal);
            (SurfacePoint { position: blend(places), normal }, frame)
        };
        let ((before, from), (after, to)) = (at(shapes[0]), at(shapes[1]));
        let carry = if from == to { DMat3::IDENTITY } else { to * from.inverse() };
        Self { before, after, carry }
    }
}

/// A view of a body in a pose.
#[derive(Clone, Copy, Debug)]
pub struct BodyView<'a> {
    /// The camera.
    pub view: &'a TrueView,
    /// World space from model space.
    pub world_from_model: DAffine3,
}

impl BodyView<'_> {
    /// Position and unit normal in world space.
    fn in_world(&self, point: SurfacePoint) -> (DVec3, DVec3) {
        let at = self.world_from_model.transform_point3(point.position);
        (at, (self.world_from_model.matrix3.inverse().transpose() * point.normal).normalize_or_zero())
    }

    /// Cosine between the point's normal and the direction to the eye; 0 behind the eye.
    pub fn facing(&self, point: SurfacePoint) -> f64 {
        let (at, normal) = self.in_world(point);
        if self.view.is_in_front(at) { self.view.facing(at, normal) } else { 0.0 }
    }

    /// J B: the tangents B as they show in the picture, pixels per unit.
    fn tangents_px(&self, point: SurfacePoint, tangents: [DVec3; 2]) -> [DVec2; 2] {
        let (at, _) = self.in_world(point);
        let tangents = tangents.map(|tangent| self.world_from_model.transform_vector3(tangent));
        let step = 1e-6 * (at - self.view.eye).length().max(1e-3);
        self.view.columns(at, tangents, step)
    }
}

/// A, the local map from the picture of one view to that of another, at a point of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScreenTurn {
    /// φ(A), the rotation of the similarity nearest to A, radians.
    pub polar_rad: f64,
    /// A, by columns.
    pub map: [DVec2; 2],
}

impl ScreenTurn {
    /// From the reference view to the current one: `A = (J_now F B)(J_ref B)⁻¹`. The columns of B are two tangents of
    /// the surface, and J is a view's Jacobian, which takes steps in space to steps in pixels. `None` where the
    /// reference view sees the surface edge-on.
    pub fn between(point_motion: &PointMotion, reference: BodyView<'_>, now: BodyView<'_>) -> Option<Self> {
        let point = point_motion.before;
        let first = point.normal.any_orthonormal_vector();
        let tangents = [first, point.normal.cross(first)];
        let [a, b] = reference.tangents_px(point, tangents);
        let [c, d] =
            now.tangents_px(point_motion.after, tangents.map(|tangent| point_motion.carry * tangent));
        let determinant = a.x * b.y - b.x * a.y;
        // Solves A [a b] = [c d] for A.
        let map = [(c * b.y - d * a.y) / determinant, (d * a.x - c * b.x) / determinant];
        let polar_rad = (map[0].y - map[1].x).atan2(map[0].x + map[1].y);
        (polar_rad.is_finite() && determinant.abs() > 1e-12).then_some(Self { polar_rad, map })
    }

    /// Whether A is the identity: in the picture the surface has not turned or changed shape, but it may have moved.
    pub fn is_still(&self) -> bool {
        (self.map[0] - DVec2::X).length() + (self.map[1] - DVec2::Y).length() < 1e-9
    }

    /// The angle at which a line on the surface shows now, if it shows at `angle_rad` in the reference view: arg(A d),
    /// where d is the line's direction there.
    pub fn material_rad(&self, angle_rad: f64) -> f64 {
        let (sin, cos) = angle_rad.sin_cos();
        let line = self.map[0] * cos + self.map[1] * sin;
        line.y.atan2(line.x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn camera(eye: DVec3, roll_deg: f64) -> CameraPose {
        CameraPose {
            eye,
            target: DVec3::new(0.1, 0.2, 0.0),
            roll_rad: roll_deg.to_radians(),
            shift: DVec2::ZERO,
            lens: Lens::Perspective { fov_y_deg: 35.0, near: 0.1, far: 50.0 },
        }
    }

    const POINT: SurfacePoint =
        SurfacePoint { position: DVec3::new(0.2, 0.1, 0.3), normal: DVec3::new(0.0, 0.6, 0.8) };

    #[test]
    fn a_roll_of_the_camera_turns_strokes_back_by_as_much() {
        let size = [640, 360];
        let reference = TrueView::new(&camera(DVec3::new(0.3, 0.9, 3.0), 0.0), size);
        let rolled = TrueView::new(&camera(DVec3::new(0.3, 0.9, 3.0), 37.0), size);
        let body = |view| BodyView { view, world_from_model: DAffine3::from_rotation_y(0.3) };
        let turn = ScreenTurn::between(&PointMotion::rigid(POINT), body(&reference), body(&rolled)).unwrap();
        assert!((turn.polar_rad.to_degrees() + 37.0).abs() < 1e-5, "{}", turn.polar_rad.to_degrees());
        assert!((turn.material_rad(0.4).to_degrees() - 0.4f64.to_degrees() + 37.0).abs() < 1e-5);
    }

    #[test]
    fn the_target_is_in_the_middle_of_the_picture() {
        let view = TrueView::new(&camera(DVec3::new(2.0, 1.0, 3.0), 20.0), [640, 360]);
        assert!(view.pixel(DVec3::new(0.1, 0.2, 0.0)).length() < 1e-9);
        assert!(view.is_in_front(DVec3::ZERO) && !view.is_in_front(DVec3::new(4.0, 2.0, 6.0)));
    }
}
