//! How large a surface's form is at each place: how far one can go from there before the surface turns away.

use std::collections::HashMap;

use glam::Vec3;
use rayon::prelude::*;

use crate::sampling::{self, Surface, hexagonal_spacing};

/// At most this many samples measure a surface: their distances are looked at in pairs.
const MOST_SAMPLES: usize = 4096;

/// A sample lies on the same form as another while their normals differ by at most 40 degrees.
const LEAST_COSINE: f32 = 0.906;

/// And while the other lies off its tangent plane by at most this share of the distance, as on a ball at that angle: an eye ends
/// at its lids although the cheek faces the same way.
const MOST_RISE: f32 = 0.22;

/// The form ends at the radius at which it fills only this share of the disc; a right-angled corner of a plane fills 0.25.
const LEAST_SHARE: f32 = 0.2;

/// The first radius that is looked at, in spacings of the samples: less is too few samples to judge by.
const FIRST_RADIUS: f32 = 2.5;

/// Radii that are looked at: each is this many times the last.
const RADIUS_STEP: f32 = 1.189_207_1;
const RADII: usize = 40;

/// The deviation of the Gaussian that smooths the measure, in spacings; samples are looked for in cells of twice that.
const SMOOTHING: f32 = 1.2;

/// The size of the form all over a surface, measured at samples of it.
///
/// Around a point, the samples within a radius R whose normals agree with the point's cover the area that the form still has there.
/// On a plane that is the whole disc; past the end of the form it falls behind. The size is the R at which it covers a fifth of the
/// disc: 3.2 widths of a flat strip, the radius of a sphere, 2.8 radii of a long cylinder. Both sides of a plate count by themselves, so a thin
/// plate is as large as it looks.
#[derive(Clone, Debug, Default)]
pub struct FormSize {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    /// ln of the size, model units.
    size_ln: Vec<f32>,
    /// The samples in each cell of a grid.
    cells: HashMap<[i32; 3], Vec<u32>>,
    cell: f32,
    deviation: f32,
    least: f32,
}

impl FormSize {
    /// Measures a surface; the same for the same surface and seed.
    pub fn of(surface: &Surface<'_>, seed: u32) -> Self {
        let samples = sampling::progressive(surface, MOST_SAMPLES, seed);
        let positions: Vec<Vec3> = samples.iter().map(|sample| sample.position).collect();
        let normals: Vec<Vec3> = samples.iter().map(|sample| sample.normal).collect();
        let spacing = hexagonal_spacing(surface.area(), samples.len().max(1)) as f32;
        if samples.is_empty() || !(spacing.is_finite() && spacing > 0.0) {
            return Self::default();
        }
        let density = (samples.len() as f64 / surface.area()) as f32;
        let size = |at: &Vec3, normal: &Vec3| size_at(*at, *normal, &positions, &normals, [spacing, density]);
        let size_ln: Vec<f32> =
            positions.par_iter().zip(&normals).map(|(at, normal)| size(at, normal).ln()).collect();
        let deviation = SMOOTHING * spacing;
        let cell = 2.0 * deviation;
        let mut cells: HashMap<[i32; 3], Vec<u32>> = HashMap::new();
        for (index, at) in positions.iter().enumerate() {
            cells.entry(cell_of(*at, cell)).or_default().push(index as u32);
        }
        let mut field = Self { positions, normals, size_ln, cells, cell, deviation, least: 0.0 };
        field.size_ln = field
            .positions
            .par_iter()
            .zip(&field.normals)
            .map(|(&at, &normal)| field.at(at, normal).ln())
            .collect();
        field.least = field.size_ln.iter().fold(f32::INFINITY, |least, &size| least.min(size)).exp();
        field
    }

    /// The size of the form at a point of the surface with this unit normal, model units; infinite on a surface without area.
    pub fn at(&self, position: Vec3, normal: Vec3) -> f32 {
        let middle = cell_of(position, self.cell);
        let (mut sum, mut weights) = (0.0, 0.0);
        let mut nearest = (f32::INFINITY, f32::INFINITY);
        for index in 0..27 {
            let offset = [index % 3 - 1, index / 3 % 3 - 1, index / 9 - 1];
            let Some(cell) =
                self.cells.get(&std::array::from_fn(|axis| middle[axis].wrapping_add(offset[axis])))
            else {
                continue;
            };
            for &sample in cell {
                let sample = sample as usize;
                let agreement = normal.dot(self.normals[sample]);
                let distance_sq = position.distance_squared(self.positions[sample]);
                if distance_sq < nearest.0 {
                    nearest = (distance_sq, self.size_ln[sample]);
                }
                if agreement > 0.0 {
                    let weight = agreement * (-0.5 * distance_sq / (self.deviation * self.deviation)).exp();
                    sum += weight * self.size_ln[sample];
                    weights += weight;
                }
            }
        }
        if weights > 1e-6 { (sum / weights).exp() } else { nearest.1.exp() }
    }

    /// The least size anywhere, model units.
    pub fn least(&self) -> f32 {
        if self.positions.is_empty() { f32::INFINITY } else { self.least }
    }
}

fn cell_of(at: Vec3, cell: f32) -> [i32; 3] {
    // A cast saturates, so a far point has a cell too.
    (at / cell).floor().to_array().map(|coordinate| coordinate as i32)
}

/// The size of the form at one sample; the samples have this spacing, and this many lie on a unit of area.
fn size_at(
    at: Vec3,
    normal: Vec3,
    positions: &[Vec3],
    normals: &[Vec3],
    [spacing, density]: [f32; 2],
) -> f32 {
    let first = FIRST_RADIUS * spacing;
    let first_sq = first * first;
    let per_step = 1.0 / (2.0 * RADIUS_STEP.ln());
    // How many samples of the form lie between one radius and the next.
    let mut counts = [0u32; RADII];
    for (other, &there) in positions.iter().zip(normals) {
        let away = *other - at;
        let distance_sq = away.length_squared();
        let rise = normal.dot(away);
        if there.dot(normal) < LEAST_COSINE || rise * rise > MOST_RISE * MOST_RISE * distance_sq {
            continue;
        }
        let beyond = distance_sq / first_sq;
        let step = if beyond <= 1.0 { 0 } else { (beyond.ln() * per_step).ceil() as usize };
        if step < RADII {
            counts[step] += 1;
        }
    }
    let mut covered = 0;
    let mut radius = first;
    for count in counts {
        covered += count;
        let covered_area = covered as f32 / density;
        if covered_area < LEAST_SHARE * std::f32::consts::PI * radius * radius {
            return (covered_area / (LEAST_SHARE * std::f32::consts::PI)).sqrt();
        }
        radius *= RADIUS_STEP;
    }
    radius
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::TriangleMesh;
    use glam::Vec2;

    /// A surface of revolution about y with this radius at each height.
    fn turned(profile: &[(f32, f32)], around: u32) -> TriangleMesh {
        let mut mesh = TriangleMesh::default();
        for &(height, radius) in profile {
            for step in 0..around {
                let turn = Vec2::from_angle(step as f32 / around as f32 * std::f32::consts::TAU);
                mesh.positions.push(Vec3::new(turn.x * radius, height, turn.y * radius));
                mesh.normals.push(Vec3::new(turn.x, 0.0, turn.y));
            }
        }
        for row in 0..profile.len() as u32 - 1 {
            for step in 0..around {
                let at = |row: u32, step: u32| row * around + step % around;
                let [a, b, c, d] =
                    [at(row, step), at(row, step + 1), at(row + 1, step + 1), at(row + 1, step)];
                mesh.triangles.extend([[a, c, b], [a, d, c]]);
            }
        }
        mesh
    }

    fn ball(radius: f32) -> TriangleMesh {
        let mut mesh = turned(&sphere(radius), 96);
        mesh.normals = mesh.positions.iter().map(|at| at.normalize()).collect();
        mesh
    }

    fn sphere(radius: f32) -> Vec<(f32, f32)> {
        (0..=64)
            .map(|step| (step as f32 / 64.0 * std::f32::consts::PI).sin_cos())
            .map(|(sin, cos)| (-cos * radius, sin * radius))
            .collect()
    }

    #[test]
    fn the_size_of_a_ball_and_of_a_rod_are_their_radius_times_a_constant() {
        let mesh = ball(2.0);
        let size = FormSize::of(&Surface::new(&mesh, |_| true), 7);
        for direction in [Vec3::X, Vec3::Y, Vec3::new(0.6, 0.5, -0.62).normalize()] {
            let found = size.at(direction * 2.0, direction);
            assert!((found / 2.0 - 0.97).abs() < 0.08, "{direction}: {found}");
        }
        let rod: Vec<(f32, f32)> = (0..=80).map(|step| (step as f32 * 0.25 - 10.0, 0.5)).collect();
        let mesh = turned(&rod, 48);
        let size = FormSize::of(&Surface::new(&mesh, |_| true), 7);
        let found = size.at(Vec3::X * 0.5, Vec3::X);
        // Radii are looked at in steps of a fifth.
        assert!((found / 0.5 / 2.8 - 1.0).abs() < 0.11, "{found}");
    }

    #[test]
    fn a_thin_plate_is_as_large_as_it_looks_and_a_knob_on_it_is_small() {
        let mut mesh = TriangleMesh::default();
        let corner = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
        for z in [0.0, 0.02] {
            mesh.positions.extend([
                corner(-2.0, -2.0, z),
                corner(2.0, -2.0, z),
                corner(2.0, 2.0, z),
                corner(-2.0, 2.0, z),
            ]);
        }
        mesh.normals = (0..8).map(|vertex| if vertex < 4 { Vec3::NEG_Z } else { Vec3::Z }).collect();
        mesh.triangles = vec![[0, 2, 1], [0, 3, 2], [4, 5, 6], [4, 6, 7]];
        let plate_alone = FormSize::of(&Surface::new(&mesh, |_| true), 7).at(Vec3::Z * 0.02, Vec3::Z);
        assert!(plate_alone > 3.0, "{plate_alone}");
        let knob = ball(0.2);
        let first = mesh.positions.len() as u32;
        mesh.positions.extend(knob.positions.iter().map(|&at| at + Vec3::new(1.0, 1.0, 0.3)));
        mesh.normals.extend(knob.normals);
        mesh.triangles.extend(knob.triangles.iter().map(|corners| corners.map(|vertex| vertex + first)));
        let size = FormSize::of(&Surface::new(&mesh, |_| true), 7);
        let side = Vec3::new(0.7, 0.7, 0.14).normalize();
        let on_knob = size.at(Vec3::new(1.0, 1.0, 0.3) + side * 0.2, side);
        let on_plate = size.at(Vec3::new(-1.0, -1.0, 0.02), Vec3::Z);
        assert!(on_knob < 0.5 && on_plate > 2.5, "knob {on_knob}, plate {on_plate}");
        assert!(size.least() <= on_knob);
    }

    #[test]
    fn a_surface_without_area_bounds_nothing() {
        let mesh = TriangleMesh {
            positions: vec![Vec3::ZERO; 3],
            normals: vec![Vec3::Y; 3],
            triangles: vec![[0, 1, 2]],
            ..Default::default()
        };
        let size = FormSize::of(&Surface::new(&mesh, |_| true), 7);
        assert!(size.at(Vec3::ZERO, Vec3::Y).is_infinite() && size.least().is_infinite());
    }
}
