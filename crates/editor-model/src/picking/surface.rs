//! The surface of one object for picking: a bounding volume hierarchy over its triangles, in the object's own space.

use std::sync::{Arc, OnceLock};
use std::time::Duration;

use glam::{DAffine3, DMat3, DVec3, Vec3, Vec3A};
use impasto_core::TriangleMesh;
use impasto_core::nearest::nearest_point;
use impasto_core::shells::Side;
use impasto_painting::BodyShape;
use impasto_painting::frame::BodySurface;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2;
use obvhs::ray::RayHit;
use obvhs::{Boundable, BvhBuildParams};

/// A point of a surface, in the object's own space. All fields but `position_now` are of the surface at rest, because
/// the document states everything on that surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// Index of its triangle.
    pub triangle: u32,
    /// Weights of the triangle's three corners, sum 1.
    pub barycentric: [f64; 3],
    /// Its position at rest.
    pub position: DVec3,
    /// Its position now, on the bent surface.
    pub position_now: DVec3,
    /// Smooth normal, unit, of the painted side. A sheet is painted on both sides: its normal is that of the side that
    /// was asked for.
    pub normal: DVec3,
    /// Normal of the flat triangle, unit, of the same side.
    pub face_normal: DVec3,
    /// Whether that side is the triangle's back, the side from which its corners wind clockwise.
    pub flipped: bool,
}

pub(super) struct SurfaceTree {
    surface: Arc<BodySurface>,
    /// What bends it, and its noise.
    shape: BodyShape,
    now: Placed,
    /// The surface at rest, if `now` is not at rest; built when it is first needed.
    rest: OnceLock<Placed>,
}

/// The triangles of a surface, with its vertices at given positions.
struct Placed {
    positions: Vec<Vec3>,
    tree: Bvh2,
    /// Least and greatest corner.
    bounds: Option<[DVec3; 2]>,
}

/// The box round a triangle, enlarged against rounding.
struct TriangleBox(Aabb);

impl Boundable for TriangleBox {
    fn aabb(&self) -> Aabb {
        self.0
    }
}

impl Placed {
    fn new(mesh: &TriangleMesh, positions: Vec<Vec3>) -> Self {
        let corners = |triangle: &[u32; 3]| triangle.map(|vertex| positions[vertex as usize]);
        let used = mesh.triangles.iter().flat_map(corners);
        let (low, high) =
            used.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), at| (low.min(at), high.max(at)));
        let bounds = (!mesh.triangles.is_empty()).then(|| [low.as_dvec3(), high.as_dvec3()]);
        // Rays are tested against boxes in single precision, so boxes are a few rounding errors larger than the
        // triangles.
        let margin =
            bounds.map_or(0.0, |_| 1e-6 * (low.abs().max(high.abs()).max_element() + f32::MIN_POSITIVE));
        let boxes: Vec<TriangleBox> = mesh
            .triangles
            .iter()
            .map(|triangle| {
                let [a, b, c] = corners(triangle).map(Vec3A::from);
                let margin = Vec3A::splat(margin);
                TriangleBox(Aabb::new(a.min(b).min(c) - margin, a.max(b).max(c) + margin))
            })
            .collect();
        let tree = if boxes.is_empty() {
            Bvh2::default()
        } else {
            build_bvh2(&boxes, BvhBuildParams::very_fast_build(), &mut Duration::default())
        };
        Self { positions, tree, bounds }
    }

    fn corners(&self, mesh: &TriangleMesh, triangle: u32) -> [DVec3; 3] {
        mesh.triangles[triangle as usize].map(|vertex| self.positions[vertex as usize].as_dvec3())
    }
}

impl SurfaceTree {
    pub(super) fn new(surface: Arc<BodySurface>, shape: BodyShape) -> Self {
        let now = Placed::new(&surface.mesh, surface.positions_at(&shape));
        Self { surface, shape, now, rest: OnceLock::new() }
    }

    fn rest(&self) -> &Placed {
        if self.surface.is_at_rest(&self.shape) {
            return &self.now;
        }
        self.rest.get_or_init(|| Placed::new(self.mesh(), self.mesh().positions.clone()))
    }

    /// A map from the object at rest to the object as it is now: that of the triangle nearest to `at_rest`. It holds
    /// near that point.
    pub(super) fn now_from_rest(&self, at_rest: DVec3) -> DAffine3 {
        if self.surface.is_at_rest(&self.shape) {
            return DAffine3::IDENTITY;
        }
        let Some((triangle, weights)) = self.nearest(at_rest, f64::INFINITY, |_, _| true) else {
            return DAffine3::IDENTITY;
        };
        let (then, now) = (self.rest().corners(self.mesh(), triangle), self.corners(triangle));
        let frame = |[a, b, c]: [DVec3; 3]| {
            DMat3::from_cols(b - a, c - a, (b - a).cross(c - a).normalize_or(DVec3::Y))
        };
        let gradient = frame(now) * frame(then).inverse();
        let gradient = if gradient.is_finite() { gradient } else { DMat3::IDENTITY };
        let moved = blend(now, weights) - gradient * blend(then, weights);
        DAffine3 { matrix3: gradient, translation: moved }
    }

    /// Whether it was built for this surface in this shape.
    pub(super) fn is_of(&self, surface: &Arc<BodySurface>, shape: &BodyShape) -> bool {
        let rests = |shape: &BodyShape| surface.is_at_rest(shape);
        Arc::ptr_eq(&self.surface, surface) && (self.shape == *shape || (rests(&self.shape) && rests(shape)))
    }

    /// Least and greatest corner of the surface as it is now; `None` without triangles.
    pub(super) fn bounds(&self) -> Option<[DVec3; 2]> {
        self.now.bounds
    }

    pub(super) fn bends(&self) -> bool {
        self.surface.bends()
    }

    pub(super) fn surface(&self) -> &BodySurface {
        &self.surface
    }

    /// The middle of a triangle, with the normals of its front.
    pub(super) fn middle(&self, triangle: u32) -> SurfacePoint {
        self.point(triangle, [1.0 / 3.0; 3], |_| true).0
    }

    fn mesh(&self) -> &TriangleMesh {
        &self.surface.mesh
    }

    /// Corners of a triangle as they are now, in the object's own space.
    pub(super) fn corners(&self, triangle: u32) -> [DVec3; 3] {
        self.now.corners(self.mesh(), triangle)
    }

    /// The first point that a ray meets within `farthest`, its distance, and whether its painted side was met.
    /// Everything is in the object's own space; distances are in lengths of `direction`.
    pub(super) fn first_hit(
        &self,
        origin: DVec3,
        direction: DVec3,
        farthest: f64,
    ) -> Option<(SurfacePoint, f64, bool)> {
        let [low, high] = self.now.bounds?;
        let length = direction.length();
        if !origin.is_finite() || !(length.is_normal()) {
            return None;
        }
        // The tree is searched in single precision. That suffices, because a ray from afar is made to begin just before
        // the sphere round the surface's box.
        let (centre, reach) = ((low + high) * 0.5, (high - low).length() * 0.5);
        let unit = direction / length;
        let skipped = ((centre - origin).dot(unit) - reach * 1.01).max(0.0);
        let near = origin + unit * skipped;
        let ray = obvhs::ray::Ray::new_inf(near.as_vec3a(), unit.as_vec3a());
        let mut best = (farthest * length - skipped, None);
        let mut try_triangle = |slot: usize| -> f32 {
            let triangle = self.now.tree.primitive_indices[slot];
            if let Some((distance, weights)) = meet(self.corners(triangle), near, unit)
                && distance < best.0
            {
                best = (distance, Some((triangle, weights)));
            }
            (best.0 as f32).next_up()
        };
        self.now.tree.ray_traverse(ray, &mut RayHit::none(), |_, slot| try_triangle(slot));
        let (distance, found) = best;
        let (triangle, weights) = found?;
        let (point, front) = self.point(triangle, weights, |face| face.dot(unit) < 0.0);
        Some((point, (distance + skipped) / length, front))
    }

    /// The point of the surface at rest that is nearest to `to`, at most `farthest` away. A point counts only if the
    /// normal of its painted side is less than 90 degrees from `facing`. A sheet is painted on both sides, so the side
    /// that faces that way is taken.
    pub(super) fn closest(&self, to: DVec3, farthest: f64, facing: DVec3) -> Option<SurfacePoint> {
        let point = |triangle, weights| self.point_at_rest(triangle, weights, |face| face.dot(facing) > 0.0);
        let counts = |triangle, weights| {
            let (point, agrees) = point(triangle, weights);
            agrees && point.normal.dot(facing) > 0.0
        };
        let (triangle, weights) = self.nearest(to, farthest, counts)?;
        Some(point(triangle, weights).0)
    }

    /// Of the triangles at rest that count and are at most `farthest` away, the one that is nearest to `to`, with the
    /// weights of its nearest point. `counts` judges a triangle by the weights of that point.
    fn nearest(
        &self,
        to: DVec3,
        farthest: f64,
        counts: impl Fn(u32, [f64; 3]) -> bool,
    ) -> Option<(u32, [f64; 3])> {
        let rest = self.rest();
        if rest.tree.nodes.is_empty() || !to.is_finite() {
            return None;
        }
        let near = to.as_vec3a();
        let gap_sq = |node: u32| {
            let aabb = rest.tree.nodes[node as usize].aabb();
            f64::from((near.clamp(aabb.min, aabb.max) - near).length_squared()) * (1.0 - 1e-5)
        };
        let mut best = (farthest * farthest, None);
        let mut stack = vec![(gap_sq(0), 0u32)];
        while let Some((gap, index)) = stack.pop() {
            if gap > best.0 {
                continue;
            }
            let node = &rest.tree.nodes[index as usize];
            if node.is_leaf() {
                for slot in node.first_index..node.first_index + node.prim_count {
                    let triangle = rest.tree.primitive_indices[slot as usize];
                    let corners = rest.corners(self.mesh(), triangle);
                    let weights = closest_weights(corners, to);
                    let distance_sq = (blend(corners, weights) - to).length_squared();
                    if distance_sq <= best.0 && counts(triangle, weights) {
                        best = (distance_sq, Some((triangle, weights)));
                    }
                }
            } else {
                let children = [node.first_index, node.first_index + 1].map(|child| (gap_sq(child), child));
                let [nearer, farther] =
                    if children[0].0 <= children[1].0 { children } else { [children[1], children[0]] };
                stack.extend([farther, nearer]);
            }
        }
        best.1
    }

    /// A point with the normals of its painted side, and whether that side is looked at. `looked_at` judges a side by
    /// its face normal on the surface as it is now.
    fn point(
        &self,
        triangle: u32,
        barycentric: [f64; 3],
        looked_at: impl Fn(DVec3) -> bool,
    ) -> (SurfacePoint, bool) {
        let winding = winding(self.corners(triangle));
        let sign = self.painted_side(triangle, looked_at(winding));
        (self.on_side(triangle, barycentric, sign), looked_at(winding * sign))
    }

    /// As [`Self::point`], but `looked_at` is given face normals of the surface at rest.
    fn point_at_rest(
        &self,
        triangle: u32,
        barycentric: [f64; 3],
        looked_at: impl Fn(DVec3) -> bool,
    ) -> (SurfacePoint, bool) {
        let winding = winding(self.rest().corners(self.mesh(), triangle));
        let sign = self.painted_side(triangle, looked_at(winding));
        (self.on_side(triangle, barycentric, sign), looked_at(winding * sign))
    }

    /// The painted side of a triangle: 1 for its front, −1 for its back. For a sheet, which is painted on both sides,
    /// it is the side that is looked at. On a closed shell, too, a front that is looked at counts as painted. That is
    /// wrong only inside a shell that winds inwards, where the eye hardly ever is.
    fn painted_side(&self, triangle: u32, front_is_looked_at: bool) -> f64 {
        let is_front = front_is_looked_at || self.surface.sides[triangle as usize] == Side::Front;
        if is_front { 1.0 } else { -1.0 }
    }

    fn on_side(&self, triangle: u32, barycentric: [f64; 3], sign: f64) -> SurfacePoint {
        let corners = self.mesh().corners(triangle as usize).map(Vec3::as_dvec3);
        let winding = winding(corners);
        let face_normal = winding * sign;
        let normals = self.mesh().triangles[triangle as usize]
            .map(|vertex| self.mesh().normals[vertex as usize].as_dvec3());
        let smooth = blend(normals, barycentric).normalize_or(winding);
        // A file's normals and its winding may disagree about the side. Then the winding decides.
        let normal = if smooth.dot(face_normal) < 0.0 { -smooth } else { smooth };
        let (position, position_now) =
            (blend(corners, barycentric), blend(self.corners(triangle), barycentric));
        let flipped = sign < 0.0;
        SurfacePoint { triangle, barycentric, position, position_now, normal, face_normal, flipped }
    }
}

fn winding([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a).normalize_or(DVec3::Y)
}

fn blend(corners: [DVec3; 3], [u, v, w]: [f64; 3]) -> DVec3 {
    corners[0] * u + corners[1] * v + corners[2] * w
}

/// Where a ray meets a triangle from either side: distance in lengths of `direction`, and the corners' weights (Möller
/// and Trumbore 1997).
fn meet([a, b, c]: [DVec3; 3], origin: DVec3, direction: DVec3) -> Option<(f64, [f64; 3])> {
    let (ab, ac) = (b - a, c - a);
    let across = direction.cross(ac);
    let determinant = ab.dot(across);
    let to_origin = origin - a;
    let v = to_origin.dot(across) / determinant;
    let w = direction.dot(to_origin.cross(ab)) / determinant;
    let distance = ac.dot(to_origin.cross(ab)) / determinant;
    // Each edge gets the tolerance of a rounding error, so that no ray slips between two triangles.
    let slack = -1e-12;
    let inside = v >= slack && w >= slack && v + w <= 1.0 - slack;
    (inside && distance >= 0.0 && distance.is_finite()).then_some((distance, [1.0 - v - w, v, w]))
}

/// Weights of the point of a triangle that is nearest to `to`; for a triangle without area, those of its first corner.
fn closest_weights([a, b, c]: [DVec3; 3], to: DVec3) -> [f64; 3] {
    let near = nearest_point(to, [a, b, c]);
    let normal = (b - a).cross(c - a);
    let share = |from: DVec3, to: DVec3| (to - from).cross(near - from).dot(normal) / normal.length_squared();
    let (v, w) = (share(c, a), share(a, b));
    if v.is_finite() && w.is_finite() { [1.0 - v - w, v, w] } else { [1.0, 0.0, 0.0] }
}
