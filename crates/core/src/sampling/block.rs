//! Computes the random places and normals of many candidates of dart throwing at once: a block of them, side by side,
//! in wide vectors.

use glam::Vec3;

use super::throw::Throw;
use super::{Particle, Surface};
use crate::wide::{Wide, widest};

/// How many candidates a block has.
pub(super) const LANES: usize = 64;

/// [`LANES`] candidates.
pub(super) struct Block {
    faces: [u32; LANES],
    /// For each candidate, the weights of the second and third corner of its face.
    barycentric: [[f32; LANES]; 2],
}

impl Block {
    /// The candidates with these numbers. With all faces lined up, a candidate lies at a random point of the surface's
    /// whole `area`, which is cut into `steps` equal steps. `face` finds the candidate's face from the area that lies
    /// before this point, and from the step that the point is in.
    #[inline]
    pub(super) fn new(
        (seed, numbers): (u32, &[u32; LANES]),
        (steps, area): (usize, f64),
        face: impl Fn(f64, i32) -> u32,
    ) -> Self {
        let thrown = widest(Throwing { seed, numbers, steps, area });
        let mut faces = [0; LANES];
        for (face_of, (&area, &step)) in faces.iter_mut().zip(thrown.areas.iter().zip(&thrown.steps)) {
            *face_of = face(area, step);
        }
        Self { faces, barycentric: thrown.barycentric }
    }

    /// Where a candidate lies: its face, and the weights of the face's second and third corner.
    #[inline]
    pub(super) fn place(&self, lane: usize) -> (usize, [f32; 2]) {
        (self.faces[lane] as usize, self.barycentric.each_ref().map(|weights| weights[lane]))
    }

    /// All candidates as particles, as [`Surface::particle`] gives them.
    #[inline]
    pub(super) fn particles(&self, surface: &Surface<'_>) -> [Particle; LANES] {
        let mut corners = Corners::EMPTY;
        for lane in 0..LANES {
            let face = surface.faces[self.faces[lane] as usize];
            let triangle = surface.mesh.triangles[face.triangle as usize];
            for (corner, vertex) in triangle.into_iter().enumerate() {
                let position = surface.mesh.positions[vertex as usize].to_array();
                let normal = surface.mesh.normals[vertex as usize].to_array();
                for axis in 0..3 {
                    corners.positions[corner][axis][lane] = position[axis];
                    corners.normals[corner][axis][lane] = normal[axis];
                }
            }
            corners.sides[lane] = if face.flipped { -1.0 } else { 1.0 };
        }
        let placed = widest(Placing { corners: &corners, barycentric: &self.barycentric });
        std::array::from_fn(|lane| {
            let (face, barycentric) = self.place(lane);
            if placed.normals_cancel[lane] {
                return surface.particle(face, barycentric);
            }
            let face = surface.faces[face];
            let of = |axes: &[[f32; LANES]; 3]| Vec3::from_array(axes.each_ref().map(|axis| axis[lane]));
            Particle {
                triangle: face.triangle,
                barycentric,
                flipped: face.flipped,
                position: of(&placed.positions),
                normal: of(&placed.normals),
            }
        })
    }
}

/// Finds the random places of a block.
struct Throwing<'a> {
    seed: u32,
    numbers: &'a [u32; LANES],
    /// Into how many equal steps the surface's area is cut.
    steps: usize,
    /// The surface's area.
    area: f64,
}

struct Thrown {
    /// With all faces lined up, the area that lies before each candidate.
    areas: [f64; LANES],
    /// The step of area that each candidate is in.
    steps: [i32; LANES],
    barycentric: [[f32; LANES]; 2],
}

impl Wide for Throwing<'_> {
    type Output = Thrown;

    #[inline(always)]
    fn run(self) -> Thrown {
        let mut thrown = Thrown { areas: [0.0; LANES], steps: [0; LANES], barycentric: [[0.0; LANES]; 2] };
        for lane in 0..LANES {
            let throw = Throw::new(self.seed, self.numbers[lane]);
            thrown.areas[lane] = throw.area(self.area);
            thrown.steps[lane] = throw.step(self.steps);
            let [v, w] = throw.barycentric();
            thrown.barycentric[0][lane] = v;
            thrown.barycentric[1][lane] = w;
        }
        thrown
    }
}

/// The corners of each candidate's triangle, indexed by corner, axis and candidate.
struct Corners {
    positions: [[[f32; LANES]; 3]; 3],
    normals: [[[f32; LANES]; 3]; 3],
    /// 1 on the triangle's front, −1 on its back.
    sides: [f32; LANES],
}

impl Corners {
    const EMPTY: Self =
        Self { positions: [[[0.0; LANES]; 3]; 3], normals: [[[0.0; LANES]; 3]; 3], sides: [0.0; LANES] };
}

/// [`Particle::on`] for a block, with the same bits.
struct Placing<'a> {
    corners: &'a Corners,
    barycentric: &'a [[f32; LANES]; 2],
}

struct Placed {
    positions: [[f32; LANES]; 3],
    normals: [[f32; LANES]; 3],
    /// Whether the normals of the corners cancel, so that another normal must be found.
    normals_cancel: [bool; LANES],
}

impl Wide for Placing<'_> {
    type Output = Placed;

    #[inline(always)]
    fn run(self) -> Placed {
        let Self { corners, barycentric: [vs, ws] } = self;
        let mut placed = Placed {
            positions: [[0.0; LANES]; 3],
            normals: [[0.0; LANES]; 3],
            normals_cancel: [false; LANES],
        };
        for lane in 0..LANES {
            let (v, w) = (vs[lane], ws[lane]);
            let u = 1.0 - v - w;
            let of = |axes: &[[f32; LANES]; 3]| [axes[0][lane], axes[1][lane], axes[2][lane]];
            let ([a, b, c], [na, nb, nc]) = (
                [of(&corners.positions[0]), of(&corners.positions[1]), of(&corners.positions[2])],
                [of(&corners.normals[0]), of(&corners.normals[1]), of(&corners.normals[2])],
            );
            let [bx, by, bz] = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
            let [cx, cy, cz] = [c[0] - a[0], c[1] - a[1], c[2] - a[2]];
            let across = [by * cz - cy * bz, bz * cx - cz * bx, bx * cy - cx * by];
            let mixed = |a: [f32; 3], b: [f32; 3], c: [f32; 3]| {
                [
                    a[0] * u + b[0] * v + c[0] * w,
                    a[1] * u + b[1] * v + c[1] * w,
                    a[2] * u + b[2] * v + c[2] * w,
                ]
            };
            let (position, smooth) = (mixed(a, b, c), mixed(na, nb, nc));
            let facing = smooth[0] * across[0] + smooth[1] * across[1] + smooth[2] * across[2];
            let turned = if facing * corners.sides[lane] < 0.0 { -1.0 } else { 1.0 };
            let length_sq = smooth[0] * smooth[0] + smooth[1] * smooth[1] + smooth[2] * smooth[2];
            let scale = 1.0 / length_sq.sqrt();
            placed.normals_cancel[lane] = !((scale > 0.0) & (scale < f32::INFINITY));
            for axis in 0..3 {
                placed.positions[axis][lane] = position[axis];
                placed.normals[axis][lane] = smooth[axis] * turned * scale;
            }
        }
        placed
    }
}
