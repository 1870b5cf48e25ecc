//! The second pass: faces cut into triangles, vertices shared, normals made good.

use std::collections::HashMap;
use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};

use glam::{DVec3, Vec2, Vec3};
use impasto_core::TriangleMesh;
use rayon::prelude::*;

use super::lint::Face;
use super::plain::{Corner, NONE};
use super::polygon;

/// Faces that meet at more than this angle keep the crease between them, where the file gives no normals: a low
/// polygon fruit (some 16 to 30 degrees from face to face) is smooth, a chamfer of 45 degrees is not.
pub(super) const CREASE_ANGLE_DEG: f64 = 44.0;

/// A triangle counts as having no area below this share of its longest edge squared.
const DEGENERATE: f64 = 1e-12;

/// Round a corner with more triangles than this, the crease is judged against the mean normal, not pair by pair.
const MANY_TRIANGLES: usize = 256;

/// So many vertices of one place are looked through one by one; further ones are looked up.
const MANY_VERTICES: usize = 8;

/// Triangles or corners that one core takes at a time, at least.
pub(super) const SHARE: usize = 4096;

/// What the corners of faces mean.
#[derive(Clone, Copy, Debug)]
pub(super) struct Values<'a> {
    pub places: &'a [Vec3],
    pub uvs: &'a [[f32; 2]],
    /// Of unit length, from the file.
    pub normals: &'a [[f32; 3]],
    /// `position` is the number of a place: corners at one place have one number.
    pub corners: &'a [Corner],
}

/// What [`Builder`] made, beside the mesh.
#[derive(Debug, Default)]
pub(super) struct Oddities {
    /// Faces without any area, and the number of the first.
    pub flat_faces: (usize, u32),
    /// Faces that could not be cut with care, and the number of the first.
    pub rough_faces: (usize, u32),
    /// Faces with over 1,000 corners, and the number of the first.
    pub large_faces: (usize, u32),
}

impl Oddities {
    /// Adds those of later faces.
    fn join(&mut self, later: &Self) {
        for (tally, later) in [
            (&mut self.flat_faces, later.flat_faces),
            (&mut self.rough_faces, later.rough_faces),
            (&mut self.large_faces, later.large_faces),
        ] {
            *tally = if tally.0 == 0 { later } else { (tally.0 + later.0, tally.1) };
        }
    }
}

struct Triangle {
    corners: [u32; 3],
    face: u32,
}

/// Faces, one after the other, that become a mesh.
pub(super) struct Builder<'a> {
    values: Values<'a>,
    triangles: Vec<Triangle>,
    tests_left: u64,
    pub odd: Oddities,
}

fn count(tally: &mut (usize, u32), face: u32) {
    if tally.0 == 0 {
        tally.1 = face;
    }
    tally.0 += 1;
}

impl<'a> Builder<'a> {
    /// Cuts all faces.
    pub fn new(values: Values<'a>, faces: &[Face]) -> Self {
        let share = faces.len().div_ceil(rayon::current_num_threads() * 4).max(SHARE);
        let spent = AtomicU64::new(0);
        let cut = |at: usize| Self::cut(values, faces, at..(at + share).min(faces.len()), &spent);
        let parts: Vec<Self> =
            (0..faces.len().div_ceil(share)).into_par_iter().map(|part| cut(part * share)).collect();
        if spent.into_inner() >= polygon::MAX_TESTS {
            // Which polygons are cut without care then depends on those before them.
            return Self::cut(values, faces, 0..faces.len(), &AtomicU64::new(0));
        }
        let mut parts = parts.into_iter();
        let mut whole = parts.next().unwrap_or_else(|| Self::empty(values));
        whole.triangles.reserve_exact(parts.as_slice().iter().map(|part| part.triangles.len()).sum());
        for part in parts {
            whole.triangles.extend(part.triangles);
            whole.odd.join(&part.odd);
        }
        whole
    }

    fn empty(values: Values<'a>) -> Self {
        Self { values, triangles: Vec::new(), tests_left: polygon::MAX_TESTS, odd: Oddities::default() }
    }

    /// Cuts some of the faces, unless too many tests are `spent` by all cores together.
    fn cut(values: Values<'a>, faces: &[Face], range: Range<usize>, spent: &AtomicU64) -> Self {
        let mut part = Self::empty(values);
        part.triangles.reserve(range.len());
        let is_alone = range.len() == faces.len();
        let mut start = range.start.checked_sub(1).map_or(0, |before| faces[before].end);
        for number in range {
            if spent.load(Ordering::Relaxed) >= polygon::MAX_TESTS {
                break;
            }
            let end = faces[number].end;
            let before = part.tests_left;
            part.add(number as u32, start..end);
            start = end;
            if !is_alone && part.tests_left < before {
                spent.fetch_add(before - part.tests_left, Ordering::Relaxed);
            }
        }
        part
    }

    #[inline]
    fn at(&self, corner: u32) -> DVec3 {
        self.values.places[self.values.corners[corner as usize].position as usize].as_dvec3()
    }

    /// Cuts one face of at least three corners.
    fn add(&mut self, face: u32, corners: Range<u32>) {
        let before = self.triangles.len();
        let mut is_rough = false;
        if corners.len() == 3 {
            self.add_triangle(face, [0, 1, 2].map(|step| corners.start + step));
        } else {
            let points: Vec<DVec3> = corners.clone().map(|corner| self.at(corner)).collect();
            let cut = polygon::cut(&points, &mut self.tests_left);
            is_rough = cut.is_rough;
            if points.len() > 1000 {
                count(&mut self.odd.large_faces, face);
            }
            for numbers in cut.triangles {
                self.add_triangle(face, numbers.map(|number| corners.start + number as u32));
            }
        }
        if self.triangles.len() == before {
            count(&mut self.odd.flat_faces, face);
        } else if is_rough {
            count(&mut self.odd.rough_faces, face);
        }
    }

    /// Keeps a triangle that has any area.
    #[inline]
    fn add_triangle(&mut self, face: u32, corners: [u32; 3]) {
        let (a, b, c) = (self.at(corners[0]), self.at(corners[1]), self.at(corners[2]));
        let cross = (b - a).cross(c - a);
        let longest = (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared());
        if cross.length() > DEGENERATE * longest {
            self.triangles.push(Triangle { corners, face });
        }
    }

    /// The mesh, and for each triangle the number of the face that it was cut from.
    pub fn finish(&self) -> (TriangleMesh, Vec<u32>) {
        let normals = self.corner_normals();
        let corners_of = |triangle: &Triangle| triangle.corners.map(|at| self.values.corners[at as usize]);
        let has_uvs =
            self.triangles.iter().any(|triangle| corners_of(triangle).iter().any(|at| at.uv != NONE));
        let mut vertices = Vertices::new(self.values.places, has_uvs);
        let mut triangles = Vec::with_capacity(self.triangles.len());
        let mut polygon_of_triangle = Vec::with_capacity(self.triangles.len());
        let (mut polygon, mut face) = (0, self.triangles.first().map_or(0, |first| first.face));
        for (number, triangle) in self.triangles.iter().enumerate() {
            let corners = corners_of(triangle);
            let normals = match normals.get(number) {
                Some(normals) => *normals,
                None => corners.map(|corner| Vec3::from_array(self.values.normals[corner.normal as usize])),
            };
            let mut vertex = |at: usize| {
                let uv = self.values.uvs.get(corners[at].uv as usize).copied().unwrap_or_default();
                vertices.number(corners[at].position, Vec2::from_array(uv), normals[at])
            };
            triangles.push([vertex(0), vertex(1), vertex(2)]);
            polygon += u32::from(triangle.face != face);
            face = triangle.face;
            polygon_of_triangle.push(polygon);
        }
        let Vertices { positions, normals, uvs, .. } = vertices;
        let mesh = TriangleMesh {
            positions,
            normals,
            uvs,
            triangles,
            polygon_of_triangle,
            ..TriangleMesh::default()
        };
        (mesh, self.triangles.iter().map(|triangle| triangle.face).collect())
    }

    /// Whether the file's normals are used for a triangle: all three corners have one.
    fn has_normals(&self, triangle: &Triangle) -> bool {
        triangle.corners.iter().all(|&corner| self.values.corners[corner as usize].normal != NONE)
    }

    /// A unit normal for each corner: the file's where all three corners of the triangle have one, else the mean of the
    /// faces round the corner's place that meet this one below the crease angle, weighted by their angles there
    /// (Thürmer and Wüthrich 1998). None at all where every triangle has the file's.
    fn corner_normals(&self) -> Vec<[Vec3; 3]> {
        if self.triangles.par_iter().with_min_len(SHARE).all(|triangle| self.has_normals(triangle)) {
            return Vec::new();
        }
        let around = Around::new(self);
        let least_dot = CREASE_ANGLE_DEG.to_radians().cos();
        let is_near = |a: DVec3, b: DVec3| a.dot(b) >= least_dot;
        let mean_of_all: Vec<DVec3> = (0..self.values.places.len() as u32)
            .into_par_iter()
            .with_min_len(SHARE)
            .map(|place| around.mean(place, |_| true))
            .collect();
        let normal = |own: DVec3, place: u32| {
            let of_all = mean_of_all[place as usize];
            let mean = if around.of(place).len() > MANY_TRIANGLES {
                if is_near(of_all, own) { of_all } else { own }
            } else if around.all(place, |other| is_near(other, own)) {
                of_all
            } else {
                around.mean(place, |other| is_near(other, own))
            };
            // Each of the summed normals is near this one, so the mean can only vanish with all the angles.
            let mean = if mean == DVec3::ZERO { own } else { mean };
            mean.as_vec3().normalize()
        };
        self.triangles
            .par_iter()
            .zip(&around.normals)
            .with_min_len(SHARE)
            .map(|(triangle, &own)| {
                let corners = triangle.corners.map(|corner| self.values.corners[corner as usize]);
                if self.has_normals(triangle) {
                    corners.map(|corner| Vec3::from_array(self.values.normals[corner.normal as usize]))
                } else {
                    corners.map(|corner| normal(own, corner.position))
                }
            })
            .collect()
    }
}

/// The triangles round each place.
struct Around {
    /// Where those of each place begin in `list`; one more, for the end.
    first: Vec<u32>,
    /// Triangle times three, plus the number of its corner there.
    list: Vec<u32>,
    /// Unit normals of the triangles.
    normals: Vec<DVec3>,
    /// Angles of the triangles' corners in radians.
    angles: Vec<[f64; 3]>,
}

impl Around {
    fn new(builder: &Builder<'_>) -> Self {
        let place = |corner: u32| builder.values.corners[corner as usize].position as usize;
        let mut first = vec![0; builder.values.places.len() + 2];
        for corner in builder.triangles.iter().flat_map(|triangle| triangle.corners) {
            first[place(corner) + 2] += 1;
        }
        for place in 1..first.len() {
            first[place] += first[place - 1];
        }
        let mut list = vec![0; builder.triangles.len() * 3];
        for (number, corner) in builder.triangles.iter().flat_map(|triangle| triangle.corners).enumerate() {
            let slot = &mut first[place(corner) + 1];
            list[*slot as usize] = number as u32;
            *slot += 1;
        }
        first.pop();
        let (normals, angles) = builder
            .triangles
            .par_iter()
            .with_min_len(SHARE)
            .map(|triangle| {
                let points = triangle.corners.map(|corner| builder.at(corner));
                let [a, b, c] = points;
                let angles = [0, 1, 2].map(|corner| {
                    let [at, next, last] = [0, 1, 2].map(|step| points[(corner + step) % 3]);
                    (next - at).angle_between(last - at)
                });
                ((b - a).cross(c - a).normalize(), angles)
            })
            .unzip();
        Self { first, list, normals, angles }
    }

    #[inline]
    fn of(&self, place: u32) -> &[u32] {
        &self.list[self.first[place as usize] as usize..self.first[place as usize + 1] as usize]
    }

    fn all(&self, place: u32, is_so: impl Fn(DVec3) -> bool) -> bool {
        self.of(place).iter().all(|&number| is_so(self.normals[number as usize / 3]))
    }

    /// The mean direction of the triangles round a place, of those whose normals are `near`; zero where it vanishes.
    fn mean(&self, place: u32, near: impl Fn(DVec3) -> bool) -> DVec3 {
        let others = self.of(place).iter().map(|&number| (number as usize / 3, number as usize % 3));
        others
            .filter(|&(other, _)| near(self.normals[other]))
            .map(|(other, corner)| self.normals[other] * self.angles[other][corner])
            .sum::<DVec3>()
            .normalize_or_zero()
    }
}

/// Vertices numbered in the order of their first use; corners that agree in all values are one vertex.
struct Vertices<'a> {
    places: &'a [Vec3],
    has_uvs: bool,
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    uvs: Vec<Vec2>,
    /// The first vertex of each place, and for each vertex the next of its place ([`NONE`] where there is none).
    first: Vec<u32>,
    next: Vec<u32>,
    /// Those of places that have more than [`MANY_VERTICES`].
    others: HashMap<(u32, [u32; 2], [u32; 3]), u32>,
}

impl<'a> Vertices<'a> {
    fn new(places: &'a [Vec3], has_uvs: bool) -> Self {
        let count = places.len();
        Self {
            places,
            has_uvs,
            positions: Vec::with_capacity(count),
            normals: Vec::with_capacity(count),
            uvs: Vec::with_capacity(if has_uvs { count } else { 0 }),
            first: vec![NONE; count],
            next: Vec::with_capacity(count),
            others: HashMap::new(),
        }
    }

    #[inline]
    fn number(&mut self, place: u32, uv: Vec2, normal: Vec3) -> u32 {
        let (uv_bits, normal_bits) = (uv.to_array().map(f32::to_bits), normal.to_array().map(f32::to_bits));
        let mut end = NONE;
        let mut vertex = self.first[place as usize];
        let mut steps = 0;
        while vertex != NONE {
            let at = vertex as usize;
            if self.normals[at].to_array().map(f32::to_bits) == normal_bits
                && (!self.has_uvs || self.uvs[at].to_array().map(f32::to_bits) == uv_bits)
            {
                return vertex;
            }
            (end, vertex, steps) = (vertex, self.next[at], steps + 1);
        }
        let new = self.positions.len() as u32;
        if steps >= MANY_VERTICES {
            let number = *self.others.entry((place, uv_bits, normal_bits)).or_insert(new);
            if number != new {
                return number;
            }
        } else if end == NONE {
            self.first[place as usize] = new;
        } else {
            self.next[end as usize] = new;
        }
        self.positions.push(self.places[place as usize]);
        self.normals.push(normal);
        if self.has_uvs {
            self.uvs.push(uv);
        }
        self.next.push(NONE);
        new
    }
}
