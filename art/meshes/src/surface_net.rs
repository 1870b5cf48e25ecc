//! Makes a mesh of a body that is given as a distance field: a closed skin of quads by naive surface nets (Gibson,
//! "Constrained Elastic Surface Nets", 1998), then evened out and pulled onto the body.

use std::collections::HashMap;

use glam::DVec3;

use super::poly_mesh::{Face, Look, PolyMesh};

/// Where to look for a body, and how finely. The whole body must lie within the grid, at least a cell from its sides.
#[derive(Clone, Copy, Debug)]
pub struct Grid {
    /// The corner with the smallest coordinates.
    pub low: DVec3,
    /// The corner with the greatest coordinates.
    pub high: DVec3,
    /// Size of a cell: about the size of a face.
    pub cell: DVec3,
}

impl Grid {
    fn counts(&self) -> [usize; 3] {
        let cells = ((self.high - self.low) / self.cell).ceil();
        [cells.x as usize + 1, cells.y as usize + 1, cells.z as usize + 1]
    }

    fn point(&self, [x, y, z]: [usize; 3]) -> DVec3 {
        self.low + self.cell * DVec3::new(x as f64, y as f64, z as f64)
    }
}

/// A body's distance field at the points of a grid, negative inside.
struct Samples {
    counts: [usize; 3],
    values: Vec<f64>,
}

impl Samples {
    /// Computes the field at every point near the skin. In a block far from the skin, all points get the value of the
    /// block's middle.
    fn take(grid: &Grid, field: &impl Fn(DVec3) -> f64) -> Self {
        const BLOCK: usize = 6;
        let counts = grid.counts();
        let mut samples = Self { counts, values: vec![0.0; counts.iter().product()] };
        let reach = 0.5 * BLOCK as f64 * grid.cell.length() * 1.5;
        for block_z in (0..counts[2]).step_by(BLOCK) {
            for block_y in (0..counts[1]).step_by(BLOCK) {
                for block_x in (0..counts[0]).step_by(BLOCK) {
                    let block = [block_x, block_y, block_z];
                    let middle = grid.point(block) + grid.cell * (0.5 * (BLOCK - 1) as f64);
                    let there = field(middle);
                    let far = (there.abs() > reach).then_some(there);
                    let end: [usize; 3] = std::array::from_fn(|axis| (block[axis] + BLOCK).min(counts[axis]));
                    for z in block_z..end[2] {
                        for y in block_y..end[1] {
                            for x in block_x..end[0] {
                                let index = samples.index([x, y, z]);
                                samples.values[index] = far.unwrap_or_else(|| field(grid.point([x, y, z])));
                            }
                        }
                    }
                }
            }
        }
        samples
    }

    fn index(&self, [x, y, z]: [usize; 3]) -> usize {
        (z * self.counts[1] + y) * self.counts[0] + x
    }

    fn value(&self, at: [usize; 3]) -> f64 {
        self.values[self.index(at)]
    }

    fn is_inside(&self, at: [usize; 3]) -> bool {
        self.value(at) < 0.0
    }
}

/// Weaves the skin of the body `field` into a mesh and returns the range of its points; all faces get one look.
///
/// There is one point per cell that the skin crosses, and one face per edge of the grid that it crosses. Where the
/// body is thinner than two cells, the skin is torn.
pub fn weave(
    mesh: &mut PolyMesh,
    grid: &Grid,
    field: impl Fn(DVec3) -> f64,
    look: Look,
) -> std::ops::Range<usize> {
    let samples = Samples::take(grid, &field);
    let first = mesh.positions.len();
    let mut points = HashMap::new();
    let [nx, ny, nz] = samples.counts;
    for z in 0..nz - 1 {
        for y in 0..ny - 1 {
            for x in 0..nx - 1 {
                if let Some(point) = crossing(grid, &samples, [x, y, z]) {
                    points.insert([x, y, z], mesh.positions.len());
                    mesh.positions.push(point);
                }
            }
        }
    }
    for z in 1..nz - 1 {
        for y in 1..ny - 1 {
            for x in 1..nx - 1 {
                for axis in 0..3 {
                    let from = [x, y, z];
                    let mut to = from;
                    to[axis] += 1;
                    let leaves = samples.is_inside(from);
                    if leaves == samples.is_inside(to) {
                        continue;
                    }
                    let (right, up) = ((axis + 1) % 3, (axis + 2) % 3);
                    let mut corners = [[1, 1], [0, 1], [0, 0], [1, 0]]
                        .map(|[back, down]| {
                            let mut cell = from;
                            cell[right] -= back;
                            cell[up] -= down;
                            points[&cell]
                        })
                        .to_vec();
                    if !leaves {
                        corners.reverse();
                    }
                    mesh.faces.push(Face { corners, look });
                }
            }
        }
    }
    first..mesh.positions.len()
}

/// The mean of the places where the skin crosses the edges of a cell; `None` if it crosses no edge.
fn crossing(grid: &Grid, samples: &Samples, cell: [usize; 3]) -> Option<DVec3> {
    let corner = |bits: usize| [cell[0] + (bits & 1), cell[1] + (bits >> 1 & 1), cell[2] + (bits >> 2)];
    let (mut sum, mut count) = (DVec3::ZERO, 0.0);
    for from in 0..8 {
        for axis in [1, 2, 4] {
            if from & axis != 0 {
                continue;
            }
            let (from, to) = (corner(from), corner(from | axis));
            if samples.is_inside(from) != samples.is_inside(to) {
                let (a, b) = (samples.value(from), samples.value(to));
                sum += grid.point(from).lerp(grid.point(to), a / (a - b));
                count += 1.0;
            }
        }
    }
    (count > 0.0).then(|| sum / count)
}

/// Spreads points evenly over the body `field` and lays them onto it: `rounds` times, each point goes half the way to
/// the middle of its neighbours and then along the field's slope onto the skin.
pub fn tighten(
    mesh: &mut PolyMesh,
    points: std::ops::Range<usize>,
    field: impl Fn(DVec3) -> f64,
    rounds: usize,
) {
    let mut neighbours = vec![Vec::new(); mesh.positions.len()];
    for face in &mesh.faces {
        for (index, &from) in face.corners.iter().enumerate() {
            neighbours[from].push(face.corners[(index + 1) % face.corners.len()]);
        }
    }
    for _ in 0..rounds {
        let before = mesh.positions.clone();
        for point in points.clone() {
            let around = &neighbours[point];
            let middle = around.iter().map(|&to| before[to]).sum::<DVec3>() / around.len() as f64;
            mesh.positions[point] = onto_skin(before[point].lerp(middle, 0.5), &field);
        }
    }
}

/// One step of Newton's method along the field's slope.
fn onto_skin(point: DVec3, field: &impl Fn(DVec3) -> f64) -> DVec3 {
    let there = field(point);
    let slope = slope(point, there, field);
    point - slope * (there / slope.length_squared().max(0.1))
}

/// The gradient of a field at a point where its value is `there`.
pub fn slope(point: DVec3, there: f64, field: &impl Fn(DVec3) -> f64) -> DVec3 {
    const STEP: f64 = 1e-4;
    DVec3::from_array(DVec3::AXES.map(|axis| (field(point + axis * STEP) - there) / STEP))
}
