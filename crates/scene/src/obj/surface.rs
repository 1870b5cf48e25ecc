//! The second pass: faces cut into triangles, vertices shared, normals made good.

use std::collections::HashMap;

use glam::{DVec3, Vec2, Vec3};
use impasto_core::TriangleMesh;

use super::polygon;

/// Faces that meet at more than this angle keep the crease between them, where the file gives no normals: a low
/// polygon fruit (some 16 to 30 degrees from face to face) is smooth, a chamfer of 45 degrees is not.
pub(super) const CREASE_ANGLE_DEG: f64 = 44.0;

/// A triangle counts as having no area below this share of its longest edge squared.
const DEGENERATE: f64 = 1e-12;

/// Round a corner with more triangles than this, the crease is judged against the mean normal, not pair by pair.
const MANY_TRIANGLES: usize = 256;

/// A corner with its values looked up.
#[derive(Clone, Copy, Debug)]
pub(super) struct SurfaceCorner {
    /// Number of the position; corners at one place have one number.
    pub place: u32,
    pub uv: Option<Vec2>,
    /// Of unit length, from the file.
    pub normal: Option<Vec3>,
}

/// What [`Builder`] made, beside the mesh.
#[derive(Debug, Default)]
pub(super) struct Oddities {
    /// Faces without any area, and the number of the first.
    pub flat_faces: (usize, usize),
    /// Faces that could not be cut with care, and the number of the first.
    pub rough_faces: (usize, usize),
    /// Faces with over 1,000 corners, and the number of the first.
    pub large_faces: (usize, usize),
}

struct Triangle {
    corners: [SurfaceCorner; 3],
    normal: DVec3,
    polygon: u32,
    face: usize,
}

/// Faces, one after the other, that become a mesh.
pub(super) struct Builder<'a> {
    places: &'a [Vec3],
    triangles: Vec<Triangle>,
    polygons: u32,
    tests_left: u64,
    pub odd: Oddities,
}

fn count(tally: &mut (usize, usize), face: usize) {
    if tally.0 == 0 {
        tally.1 = face;
    }
    tally.0 += 1;
}

impl<'a> Builder<'a> {
    pub fn new(places: &'a [Vec3]) -> Self {
        Self {
            places,
            triangles: Vec::new(),
            polygons: 0,
            tests_left: polygon::MAX_TESTS,
            odd: Oddities::default(),
        }
    }

    fn at(&self, corner: SurfaceCorner) -> DVec3 {
        self.places[corner.place as usize].as_dvec3()
    }

    /// Cuts one face of at least three corners.
    pub fn add(&mut self, face: usize, corners: &[SurfaceCorner]) {
        let points: Vec<DVec3> = corners.iter().map(|&corner| self.at(corner)).collect();
        let cut = polygon::cut(&points, &mut self.tests_left);
        if corners.len() > 1000 {
            count(&mut self.odd.large_faces, face);
        }
        let before = self.triangles.len();
        for numbers in cut.triangles {
            let [a, b, c] = numbers.map(|number| points[number]);
            let cross = (b - a).cross(c - a);
            let longest =
                (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared());
            if cross.length() > DEGENERATE * longest {
                let corners = numbers.map(|number| corners[number]);
                self.triangles.push(Triangle {
                    corners,
                    normal: cross.normalize(),
                    polygon: self.polygons,
                    face,
                });
            }
        }
        if self.triangles.len() == before {
            count(&mut self.odd.flat_faces, face);
            return;
        }
        self.polygons += 1;
        if cut.is_rough {
            count(&mut self.odd.rough_faces, face);
        }
    }

    /// The mesh, and for each triangle the number of the face that it was cut from.
    pub fn finish(&self) -> (TriangleMesh, Vec<usize>) {
        let normals = self.corner_normals();
        let has_uvs =
            self.triangles.iter().any(|triangle| triangle.corners.iter().any(|corner| corner.uv.is_some()));
        let mut mesh = TriangleMesh::default();
        let mut numbers: HashMap<(u32, [u32; 2], [u32; 3]), u32> = HashMap::new();
        for (triangle, corner_normals) in self.triangles.iter().zip(normals) {
            let mut vertices = [0; 3];
            for ((vertex, corner), normal) in vertices.iter_mut().zip(triangle.corners).zip(corner_normals) {
                let uv = corner.uv.unwrap_or(Vec2::ZERO);
                let key =
                    (corner.place, uv.to_array().map(f32::to_bits), normal.to_array().map(f32::to_bits));
                *vertex = *numbers.entry(key).or_insert_with(|| {
                    mesh.positions.push(self.places[corner.place as usize]);
                    mesh.normals.push(normal);
                    if has_uvs {
                        mesh.uvs.push(uv);
                    }
                    mesh.positions.len() as u32 - 1
                });
            }
            mesh.triangles.push(vertices);
            mesh.polygon_of_triangle.push(triangle.polygon);
        }
        (mesh, self.triangles.iter().map(|triangle| triangle.face).collect())
    }

    /// A unit normal for each corner: the file's where all three corners of the triangle have one, else the mean of the
    /// faces round the corner's place that meet this one below the crease angle, weighted by their angles there
    /// (Thürmer and Wüthrich 1998).
    fn corner_normals(&self) -> Vec<[Vec3; 3]> {
        let (first, around) = self.triangles_by_place();
        let least_dot = CREASE_ANGLE_DEG.to_radians().cos();
        let smooth = |triangle: &Triangle, corner: SurfaceCorner| {
            let place = corner.place as usize;
            let near =
                |other: &&(usize, f64)| self.triangles[other.0].normal.dot(triangle.normal) >= least_dot;
            let others = around[first[place]..first[place + 1]].iter().filter(near);
            let mean = others
                .map(|&(other, angle)| self.triangles[other].normal * angle)
                .sum::<DVec3>()
                .normalize_or_zero();
            // Each of the summed normals is near this one, so the mean can only vanish with all the angles.
            if mean == DVec3::ZERO { triangle.normal } else { mean }
        };
        let mut many: HashMap<u32, DVec3> = HashMap::new();
        self.triangles
            .iter()
            .map(|triangle| {
                if let [Some(a), Some(b), Some(c)] = triangle.corners.map(|corner| corner.normal) {
                    return [a, b, c];
                }
                triangle.corners.map(|corner| {
                    let place = corner.place as usize;
                    if first[place + 1] - first[place] <= MANY_TRIANGLES {
                        return smooth(triangle, corner).as_vec3().normalize();
                    }
                    let mean = *many.entry(corner.place).or_insert_with(|| {
                        let others = &around[first[place]..first[place + 1]];
                        let sum: DVec3 =
                            others.iter().map(|&(other, angle)| self.triangles[other].normal * angle).sum();
                        sum.normalize_or_zero()
                    });
                    let normal = if mean.dot(triangle.normal) >= least_dot { mean } else { triangle.normal };
                    normal.as_vec3().normalize()
                })
            })
            .collect()
    }

    /// For each place, where its triangles begin in the list, and the list of (triangle, angle there in radians).
    fn triangles_by_place(&self) -> (Vec<usize>, Vec<(usize, f64)>) {
        let mut first = vec![0; self.places.len() + 2];
        for corner in self.triangles.iter().flat_map(|triangle| triangle.corners) {
            first[corner.place as usize + 2] += 1;
        }
        for place in 1..first.len() {
            first[place] += first[place - 1];
        }
        let mut around = vec![(0, 0.0); self.triangles.len() * 3];
        for (number, triangle) in self.triangles.iter().enumerate() {
            for corner in 0..3 {
                let [at, next, last] = [0, 1, 2].map(|step| self.at(triangle.corners[(corner + step) % 3]));
                let slot = &mut first[triangle.corners[corner].place as usize + 1];
                around[*slot] = (number, (next - at).angle_between(last - at));
                *slot += 1;
            }
        }
        first.pop();
        (first, around)
    }
}
