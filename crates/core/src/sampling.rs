//! Spreads particles over a surface, as progressive blue noise or with the source paper's equal counts per polygon.

mod block;
mod candidates;
mod cell_level;
mod cells;
mod dart_field;
mod dart_grid;
mod face_cones;
mod levels;
mod packed;
mod paper;
mod progressive;
mod throw;

use glam::{Vec2, Vec3};

use crate::TriangleMesh;
use crate::mesh::of_corners;
use crate::shells::{Side, sides};
use dart_grid::Dart;

pub use candidates::scattered;
pub use cells::{Cell, CellPiece, Cells, Needed};
pub use levels::ProgressiveState;
pub use packed::PackedParticle;
pub use paper::{PolygonParticle, per_polygon};
pub use progressive::{ProgressiveOrder, progressive, samples};

/// A particle: a point of a triangle, so that it follows any deformation of the mesh, with its position and normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Particle {
    /// Index of the triangle.
    pub triangle: u32,
    /// Weights of the triangle's second and third corner; the first has what is left of 1.
    pub barycentric: [f32; 2],
    /// Whether the particle is on the triangle's back.
    pub flipped: bool,
    /// Position in model space.
    pub position: Vec3,
    /// Unit normal in model space, smooth over shared vertices, on the particle's own side of the triangle.
    pub normal: Vec3,
}

impl Particle {
    /// The same point of the same triangle after the vertices have moved.
    #[inline]
    pub fn on(&self, mesh: &TriangleMesh, positions: &[Vec3], normals: &[Vec3]) -> Self {
        let corners = mesh.triangles[self.triangle as usize];
        let [a, b, c] = of_corners(positions, corners);
        let [na, nb, nc] = of_corners(normals, corners);
        let [v, w] = self.barycentric;
        let u = 1.0 - v - w;
        let mut across = (b - a).cross(c - a);
        if self.flipped {
            across = -across;
        }
        let smooth = na * u + nb * v + nc * w;
        let normal = if smooth.dot(across) < 0.0 { -smooth } else { smooth };
        let normal = normal.try_normalize().or_else(|| across.try_normalize()).unwrap_or(self.normal);
        Self { position: a * u + b * v + c * w, normal, ..*self }
    }

    /// The texture coordinate at the particle, if the mesh has any.
    pub fn uv(&self, mesh: &TriangleMesh) -> Option<Vec2> {
        let [a, b, c] =
            mesh.triangles[self.triangle as usize].map(|vertex| mesh.uvs.get(vertex as usize).copied());
        let [v, w] = self.barycentric;
        Some(a? * (1.0 - v - w) + b? * v + c? * w)
    }

    /// The mesh's own colour here, linear; `None` where it has none.
    pub fn color(&self, mesh: &TriangleMesh) -> Option<Vec3> {
        let [a, b, c] =
            mesh.triangles[self.triangle as usize].map(|vertex| mesh.colors.get(vertex as usize).copied());
        let [v, w] = self.barycentric;
        Some(a? * (1.0 - v - w) + b? * v + c? * w)
    }
}

/// The faces of a mesh, which are the visible sides of its triangles, with a running sum of their areas.
#[derive(Clone, Debug)]
pub struct Surface<'mesh> {
    mesh: &'mesh TriangleMesh,
    faces: Vec<Face>,
    /// For each face, the area of all faces up to and including it, model units squared.
    area_up_to: Vec<f64>,
}

#[derive(Clone, Copy, Debug)]
struct Face {
    triangle: u32,
    flipped: bool,
}

impl<'mesh> Surface<'mesh> {
    /// The visible sides of those triangles for which `keep` holds. Triangles without area are left out.
    pub fn new(mesh: &'mesh TriangleMesh, keep: impl Fn(usize) -> bool) -> Self {
        Self::with_sides(mesh, &sides(mesh), keep)
    }

    /// As [`Surface::new`], for callers that have the result of [`crate::shells::sides`] already.
    pub fn with_sides(mesh: &'mesh TriangleMesh, sides: &[Side], keep: impl Fn(usize) -> bool) -> Self {
        let mut surface = Self { mesh, faces: Vec::new(), area_up_to: Vec::new() };
        let mut sum = 0.0;
        for (triangle, &side) in sides.iter().enumerate() {
            let area = triangle_area(mesh, triangle);
            if !(keep(triangle) && area > 0.0) {
                continue;
            }
            let flips: &[bool] = match side {
                Side::Front => &[false],
                Side::Back => &[true],
                Side::Both => &[false, true],
            };
            for &flipped in flips {
                sum += area;
                surface.faces.push(Face { triangle: triangle as u32, flipped });
                surface.area_up_to.push(sum);
            }
        }
        surface
    }

    /// The mesh whose sides these are.
    pub fn mesh(&self) -> &TriangleMesh {
        self.mesh
    }

    /// Sum of the areas of all visible sides, model units squared; a sheet counts twice.
    pub fn area(&self) -> f64 {
        self.area_up_to.last().copied().unwrap_or(0.0)
    }

    /// For each visible side, its triangle, whether it is the triangle's back, and its area in model units squared.
    pub fn faces(&self) -> impl Iterator<Item = (u32, bool, f64)> + '_ {
        self.faces.iter().enumerate().map(|(index, face)| {
            let before = if index == 0 { 0.0 } else { self.area_up_to[index - 1] };
            (face.triangle, face.flipped, self.area_up_to[index] - before)
        })
    }

    /// Position of a point of a face. It is the one that [`Surface::particle`] gives, at a third of the cost.
    #[inline(always)]
    fn position(&self, face: usize, [v, w]: [f32; 2]) -> Vec3 {
        let [a, b, c] = self.mesh.corners(self.faces[face].triangle as usize);
        a * (1.0 - v - w) + b * v + c * w
    }

    /// Particles of this surface as darts.
    fn darts(&self, particles: &[Particle]) -> Vec<Dart> {
        let dart = |(particle, number): (&Particle, u32)| {
            let face = self.faces.partition_point(|face| {
                (face.triangle, face.flipped) < (particle.triangle, particle.flipped)
            });
            Dart { position: particle.position, face: face as u32, number }
        };
        particles.iter().zip(0..).map(dart).collect()
    }

    /// The particle at a point of a face.
    fn particle(&self, face: usize, barycentric: [f32; 2]) -> Particle {
        let Face { triangle, flipped } = self.faces[face];
        let unplaced = Particle { triangle, barycentric, flipped, position: Vec3::ZERO, normal: Vec3::Y };
        unplaced.on(self.mesh, &self.mesh.positions, &self.mesh.normals)
    }
}

fn triangle_area(mesh: &TriangleMesh, triangle: usize) -> f64 {
    let [a, b, c] = mesh.corners(triangle).map(Vec3::as_dvec3);
    (b - a).cross(c - a).length() * 0.5
}

/// Spreads two numbers in 0..1 evenly over a triangle, as weights of its second and third corner.
#[inline(always)]
fn barycentric(first: f32, second: f32) -> [f32; 2] {
    let root = first.sqrt();
    [root * (1.0 - second), root * second]
}

/// The greatest spacing that `count` points can have on an area: that of the hexagonal lattice, √(2A / (√3 N)).
pub fn hexagonal_spacing(area: f64, count: usize) -> f64 {
    (2.0 * area / (3f64.sqrt() * count as f64)).sqrt()
}

#[cfg(test)]
mod tests;
