//! Turns faces into a mesh: cuts them into triangles, shares vertices, adds missing normals. Every mesh format ends
//! here.

mod polygon;

use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};

use foldhash::fast::RandomState;
use glam::{DVec3, Vec2, Vec3, Vec3Swizzles as _};
use impasto_core::TriangleMesh;
use impasto_core::color::linear_from_srgb;
use indexmap::IndexSet;
use rayon::prelude::*;

/// Where the file gives no normals, faces that meet at more than this angle keep the crease between them. A fruit of
/// few polygons (some 16 to 30 degrees from face to face) is smooth, a chamfer of 45 degrees is not.
pub(crate) const CREASE_ANGLE_DEG: f64 = 44.0;

/// A triangle counts as having no area if twice its area is at most this share of its longest edge squared.
const DEGENERATE: f64 = 1e-12;

/// If more triangles than this meet at a place, each one's normal is compared with the mean of all, not with every
/// other one, to find creases.
const MANY_TRIANGLES: usize = 256;

/// Stands for no vertex.
const NONE: u32 = u32::MAX;

/// The least number of faces or triangles that a core takes at a time.
const SHARE: usize = 4096;

/// The vertices of a mesh file, and the corners of its faces, face by face.
#[derive(Debug, Default)]
pub(crate) struct Geometry {
    /// For each vertex; a zero is never −0.
    pub positions: Vec<Vec3>,
    /// For each vertex; `None` where the file gives none.
    pub uvs: Vec<Option<Vec2>>,
    /// For each vertex, of unit length; `None` where the file gives none that can be used.
    pub normals: Vec<Option<Vec3>>,
    /// For each vertex, sRGB with 8 bits a channel; empty where no vertex has one.
    pub colors: Vec<[u8; 3]>,
    /// The vertex of each corner.
    pub corners: Vec<u32>,
    /// Where the corners of each face end; they begin where those of the face before it end.
    pub ends: Vec<u32>,
    /// Whether vertices stay apart even where they agree in all values, since they may part when the mesh bends.
    pub keeps_vertices: bool,
}

pub(crate) struct Built {
    pub mesh: TriangleMesh,
    /// For each triangle, the number of the face that it was cut from.
    pub face_of_triangle: Vec<u32>,
    /// For each vertex of the mesh, the index of the [`Geometry`]'s vertex that it comes from; empty unless vertices
    /// are kept apart.
    pub source_of_vertex: Vec<u32>,
}

/// Values that differ in their bits, numbered in the order of their first use.
type Distinct<const N: usize> = IndexSet<[u32; N], RandomState>;

/// Unusual faces that [`Builder`] met.
#[derive(Debug, Default)]
pub(crate) struct Oddities {
    /// How many faces have no area, and the index of the first.
    pub flat_faces: (usize, u32),
    /// How many faces could only be cut roughly, and the index of the first.
    pub rough_faces: (usize, u32),
    /// How many faces have over 1,000 corners, and the index of the first.
    pub large_faces: (usize, u32),
    /// How many triangles have normals in the file that run along them (lie nearly in the triangle's plane), and the
    /// index of the first one's face. New normals are made for them.
    pub along_faces: (usize, u32),
    /// How many triangles lie on others with the same corners, and the index of the first one's face. They are left
    /// out.
    pub doubled_faces: (usize, u32),
}

impl Oddities {
    /// Adds the oddities that were met while later faces were cut. The other kinds are found once all faces are cut.
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
    /// Vertices of the [`Geometry`].
    vertices: [u32; 3],
    face: u32,
}

pub(crate) struct Builder<'a> {
    geometry: &'a Geometry,
    triangles: Vec<Triangle>,
    /// How many more point-in-triangle tests may be made; cutting a polygon with care needs them.
    tests_left: u64,
    /// Whether the file's normals are ignored where they run along their face.
    drops_along: bool,
    pub odd: Oddities,
}

fn count(tally: &mut (usize, u32), face: u32) {
    if tally.0 == 0 {
        tally.1 = face;
    }
    tally.0 += 1;
}

fn bits<const N: usize>(values: [f32; N]) -> [u32; N] {
    values.map(f32::to_bits)
}

impl<'a> Builder<'a> {
    /// Cuts all faces.
    pub fn new(geometry: &'a Geometry) -> Self {
        let empty = || Self {
            geometry,
            triangles: Vec::new(),
            tests_left: polygon::MAX_TESTS,
            drops_along: false,
            odd: Oddities::default(),
        };
        let count = geometry.ends.len();
        let share = count.div_ceil(rayon::current_num_threads() * 4).max(SHARE);
        let spent = AtomicU64::new(0);
        let parts: Vec<Self> = (0..count.div_ceil(share))
            .into_par_iter()
            .map(|part| empty().cut(part * share..((part + 1) * share).min(count), &spent))
            .collect();
        if spent.into_inner() >= polygon::MAX_TESTS {
            // The tests are used up. Which polygons must do without tests depends on the polygons before them, so all
            // are cut again in order.
            return empty().cut(0..count, &AtomicU64::new(0)).mended();
        }
        let mut whole = empty();
        whole.triangles.reserve_exact(parts.iter().map(|part| part.triangles.len()).sum());
        for part in parts {
            whole.triangles.extend(part.triangles);
            whole.odd.join(&part.odd);
        }
        whole.mended()
    }

    /// Drops doubled triangles, and looks for normals that run along their faces.
    fn mended(mut self) -> Self {
        self.drop_doubled();
        self.find_along();
        self
    }

    /// Drops triangles that lie on others with the same corners in the same order: they would get strokes that cannot
    /// be seen. Does so only if the area of all triangles is far too large for a body of this size, and never if
    /// vertices are kept apart.
    fn drop_doubled(&mut self) {
        /// Doubled triangles are looked for if the mesh has at least this many times the area of the box around it.
        const MUCH_AREA: f64 = 16.0;
        if self.geometry.keeps_vertices {
            return;
        }
        let mut bounds = (DVec3::MAX, DVec3::MIN);
        let mut area = 0.0;
        for triangle in &self.triangles {
            let [a, b, c] = triangle.vertices.map(|vertex| self.at(vertex));
            bounds = [a, b, c].into_iter().fold(bounds, |(low, high), at| (low.min(at), high.max(at)));
            area += (b - a).cross(c - a).length() / 2.0;
        }
        let size = bounds.1 - bounds.0;
        if self.triangles.is_empty() || area < MUCH_AREA * 2.0 * (size * size.yzx()).element_sum() {
            return;
        }
        let mut seen: IndexSet<[[u32; 3]; 3], RandomState> = IndexSet::default();
        let (geometry, odd) = (self.geometry, &mut self.odd);
        self.triangles.retain(|triangle| {
            let mut places =
                triangle.vertices.map(|vertex| bits(geometry.positions[vertex as usize].to_array()));
            // The corners begin with the least one; their winding stays.
            let least = (0..3).min_by_key(|&corner| places[corner]).unwrap_or_default();
            places.rotate_left(least);
            let is_new = seen.insert(places);
            if !is_new {
                count(&mut odd.doubled_faces, triangle.face);
            }
            is_new
        });
    }

    /// Finds faces whose normals in the file run along them: they would get no light. A sliver may rightly have such
    /// normals, so nothing is done if such faces have only a small share of the area.
    fn find_along(&mut self) {
        const SHARE_OF_AREA: f64 = 0.01;
        let mut areas = [0.0; 2];
        let mut found = (0, 0);
        for triangle in &self.triangles {
            let Some(is_along) = self.is_along(triangle) else { continue };
            let [a, b, c] = triangle.vertices.map(|vertex| self.at(vertex));
            areas[usize::from(is_along)] += (b - a).cross(c - a).length();
            if is_along {
                count(&mut found, triangle.face);
            }
        }
        if areas[1] > SHARE_OF_AREA * (areas[0] + areas[1]) {
            self.odd.along_faces = found;
            self.drops_along = true;
        }
    }

    /// Whether the file's normals of all three corners run along the triangle. `None` if the file lacks one of them.
    fn is_along(&self, triangle: &Triangle) -> Option<bool> {
        /// The cosine of 84 degrees.
        const NEARLY_ALONG: f64 = 0.1;
        let normals = self.stated_normals(triangle)?;
        let [a, b, c] = triangle.vertices.map(|vertex| self.at(vertex));
        let across = (b - a).cross(c - a).normalize_or_zero();
        Some(normals.iter().all(|normal| normal.as_dvec3().dot(across).abs() < NEARLY_ALONG))
    }

    /// Cuts a range of the faces. If the range is only a part of the faces, its tests are added to `spent`, which all
    /// cores share. Cutting stops once `spent` reaches the limit, because [`Self::new`] then starts again. If the range
    /// is all faces, cutting goes on to the end, without tests once they are used up.
    fn cut(mut self, faces: Range<usize>, spent: &AtomicU64) -> Self {
        self.triangles.reserve(faces.len());
        let ends = &self.geometry.ends;
        let is_all = faces.len() == ends.len();
        let mut start = faces.start.checked_sub(1).map_or(0, |before| ends[before]);
        for face in faces {
            if spent.load(Ordering::Relaxed) >= polygon::MAX_TESTS {
                break;
            }
            let before = self.tests_left;
            self.add(face as u32, &self.geometry.corners[start as usize..ends[face] as usize]);
            start = ends[face];
            if !is_all && self.tests_left < before {
                spent.fetch_add(before - self.tests_left, Ordering::Relaxed);
            }
        }
        self
    }

    #[inline]
    fn at(&self, vertex: u32) -> DVec3 {
        self.geometry.positions[vertex as usize].as_dvec3()
    }

    /// Cuts one face of at least three corners.
    fn add(&mut self, face: u32, corners: &[u32]) {
        let before = self.triangles.len();
        let mut is_rough = false;
        if let &[a, b, c] = corners {
            self.add_triangle(face, [a, b, c]);
        } else {
            let points: Vec<DVec3> = corners.iter().map(|&vertex| self.at(vertex)).collect();
            let cut = polygon::cut(&points, &mut self.tests_left);
            is_rough = cut.is_rough;
            if points.len() > 1000 {
                count(&mut self.odd.large_faces, face);
            }
            for numbers in cut.triangles {
                self.add_triangle(face, numbers.map(|number| corners[number]));
            }
        }
        if self.triangles.len() == before {
            count(&mut self.odd.flat_faces, face);
        } else if is_rough {
            count(&mut self.odd.rough_faces, face);
        }
    }

    /// Adds a triangle unless it has no area.
    #[inline]
    fn add_triangle(&mut self, face: u32, vertices: [u32; 3]) {
        let [a, b, c] = vertices.map(|vertex| self.at(vertex));
        let cross = (b - a).cross(c - a);
        let longest = (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared());
        if cross.length() > DEGENERATE * longest {
            self.triangles.push(Triangle { vertices, face });
        }
    }

    /// The mesh. Corners that agree in all values are one vertex; vertices are numbered in the order of their first
    /// use.
    pub fn finish(&self) -> Built {
        let Geometry { positions, uvs, normals, colors, keeps_vertices, .. } = self.geometry;
        let made_normals = self.corner_normals();
        let mut used = self.triangles.iter().flat_map(|triangle| triangle.vertices);
        let has_uvs = used.any(|vertex| uvs[vertex as usize].is_some());
        let mut vertices = Distinct::with_capacity_and_hasher(positions.len(), RandomState::default());
        // For each vertex of the file, the number that it was given last. It gets several where made normals differ.
        let mut last: Vec<u32> = vec![NONE; positions.len()];
        let mut number = |vertex: u32, made: Option<Vec3>| {
            let vertex = vertex as usize;
            let known = last[vertex];
            if known != NONE && made.is_none() {
                return known;
            }
            let normal = bits(made.or(normals[vertex]).unwrap_or_default().to_array());
            if known != NONE && vertices[known as usize][5..8] == normal {
                return known;
            }
            let ([x, y, z], [nx, ny, nz]) = (bits(positions[vertex].to_array()), normal);
            let [u, v] = bits(uvs[vertex].unwrap_or_default().to_array());
            let [r, g, b] = colors.get(vertex).copied().unwrap_or_default();
            // If vertices are kept apart, their index stands in the place of their colour.
            let color = if *keeps_vertices { vertex as u32 } else { u32::from_be_bytes([0, r, g, b]) };
            let number = vertices.insert_full([x, y, z, u, v, nx, ny, nz, color]).0 as u32;
            last[vertex] = number;
            number
        };
        let mut mesh = TriangleMesh::default();
        let (mut polygon, mut face) = (0, self.triangles.first().map_or(0, |first| first.face));
        for (at, triangle) in self.triangles.iter().enumerate() {
            let [a, b, c] = triangle.vertices;
            mesh.triangles.push(match made_normals.get(at) {
                Some(&[of_a, of_b, of_c]) => {
                    [number(a, Some(of_a)), number(b, Some(of_b)), number(c, Some(of_c))]
                }
                None => [number(a, None), number(b, None), number(c, None)],
            });
            polygon += u32::from(triangle.face != face);
            face = triangle.face;
            mesh.polygon_of_triangle.push(polygon);
        }
        let value = |vertex: &[u32; 9], at: usize| f32::from_bits(vertex[at]);
        let vector = |vertex, at| Vec3::new(value(vertex, at), value(vertex, at + 1), value(vertex, at + 2));
        mesh.positions = vertices.iter().map(|vertex| vector(vertex, 0)).collect();
        mesh.normals = vertices.iter().map(|vertex| vector(vertex, 5)).collect();
        if has_uvs {
            mesh.uvs = vertices.iter().map(|vertex| Vec2::new(value(vertex, 3), value(vertex, 4))).collect();
        }
        if !colors.is_empty() {
            let linear = |vertex: &[u32; 9]| {
                let [_, r, g, b] = match keeps_vertices {
                    true => {
                        let [r, g, b] = colors[vertex[8] as usize];
                        [0, r, g, b]
                    }
                    false => vertex[8].to_be_bytes(),
                };
                Vec3::from([r, g, b].map(|channel| linear_from_srgb(f32::from(channel) / 255.0)))
            };
            mesh.colors = vertices.iter().map(linear).collect();
        }
        let source_of_vertex = match keeps_vertices {
            true => vertices.iter().map(|vertex| vertex[8]).collect(),
            false => Vec::new(),
        };
        let face_of_triangle = self.triangles.iter().map(|triangle| triangle.face).collect();
        Built { mesh, face_of_triangle, source_of_vertex }
    }

    /// The file's normals for a triangle. `None` if a corner has none, or if they run along the triangle and such
    /// normals are ignored.
    fn file_normals(&self, triangle: &Triangle) -> Option<[Vec3; 3]> {
        self.stated_normals(triangle).filter(|_| !self.drops_along || self.is_along(triangle) == Some(false))
    }

    /// The file's normals for a triangle. `None` if a corner has none.
    fn stated_normals(&self, triangle: &Triangle) -> Option<[Vec3; 3]> {
        let [a, b, c] = triangle.vertices.map(|vertex| self.geometry.normals[vertex as usize]);
        Some([a?, b?, c?])
    }

    /// A unit normal for each corner of each triangle. Where the file gives normals for all three corners, these are
    /// taken. Elsewhere a corner's normal is the mean normal of those triangles round it that meet this triangle at
    /// less than the crease angle, weighted by their angles at the corner (Thürmer and Wüthrich 1998). The list is
    /// empty if all triangles have the file's normals.
    fn corner_normals(&self) -> Vec<[Vec3; 3]> {
        if self.triangles.par_iter().with_min_len(SHARE).all(|triangle| self.file_normals(triangle).is_some())
        {
            return Vec::new();
        }
        let around = Around::new(self);
        let least_dot = CREASE_ANGLE_DEG.to_radians().cos();
        let is_near = |a: DVec3, b: DVec3| a.dot(b) >= least_dot;
        let mean_of_all: Vec<DVec3> = (0..around.first.len() as u32 - 1)
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
            // Each normal in the mean is near `own`, so the mean is zero only if all the angles are zero.
            let mean = if mean == DVec3::ZERO { own } else { mean };
            mean.as_vec3().normalize()
        };
        self.triangles
            .par_iter()
            .zip(&around.normals)
            .with_min_len(SHARE)
            .map(|(triangle, &own)| {
                let places = triangle.vertices.map(|vertex| around.place_of_vertex[vertex as usize]);
                self.file_normals(triangle).unwrap_or_else(|| places.map(|place| normal(own, place)))
            })
            .collect()
    }
}

/// The triangles round each place. Vertices with equal positions are at one place, so that seams of the file's vertices
/// do not show as creases.
struct Around {
    place_of_vertex: Vec<u32>,
    /// Where the triangles of each place begin in `list`, and a last entry for its end.
    first: Vec<u32>,
    /// The triangles of all places, place by place: three times the triangle's number, plus which corner (0 to 2) is at
    /// the place.
    list: Vec<u32>,
    /// Unit normals of the triangles.
    normals: Vec<DVec3>,
    /// Angles of the triangles' corners in radians.
    angles: Vec<[f64; 3]>,
}

impl Around {
    fn new(builder: &Builder<'_>) -> Self {
        let positions = &builder.geometry.positions;
        let mut places = Distinct::with_capacity_and_hasher(positions.len(), RandomState::default());
        let place_of_vertex: Vec<u32> =
            positions.iter().map(|at| places.insert_full(bits(at.to_array())).0 as u32).collect();
        let place = |vertex: u32| place_of_vertex[vertex as usize] as usize;
        let mut first = vec![0; places.len() + 2];
        for corner in builder.triangles.iter().flat_map(|triangle| triangle.vertices) {
            first[place(corner) + 2] += 1;
        }
        for place in 1..first.len() {
            first[place] += first[place - 1];
        }
        let mut list = vec![0; builder.triangles.len() * 3];
        for (number, corner) in builder.triangles.iter().flat_map(|triangle| triangle.vertices).enumerate() {
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
                let points = triangle.vertices.map(|vertex| builder.at(vertex));
                let [a, b, c] = points;
                let angles = [0, 1, 2].map(|corner| {
                    let [at, next, last] = [0, 1, 2].map(|step| points[(corner + step) % 3]);
                    (next - at).angle_between(last - at)
                });
                ((b - a).cross(c - a).normalize(), angles)
            })
            .unzip();
        Self { place_of_vertex, first, list, normals, angles }
    }

    #[inline]
    fn of(&self, place: u32) -> &[u32] {
        &self.list[self.first[place as usize] as usize..self.first[place as usize + 1] as usize]
    }

    fn all(&self, place: u32, is_so: impl Fn(DVec3) -> bool) -> bool {
        self.of(place).iter().all(|&number| is_so(self.normals[number as usize / 3]))
    }

    /// The mean normal, weighted by angles, of those triangles round a place whose normals are `near`; zero where they
    /// cancel.
    fn mean(&self, place: u32, near: impl Fn(DVec3) -> bool) -> DVec3 {
        let others = self.of(place).iter().map(|&number| (number as usize / 3, number as usize % 3));
        others
            .filter(|&(other, _)| near(self.normals[other]))
            .map(|(other, corner)| self.normals[other] * self.angles[other][corner])
            .sum::<DVec3>()
            .normalize_or_zero()
    }
}
