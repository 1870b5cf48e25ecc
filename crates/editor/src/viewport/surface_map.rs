//! A coarse map of the visible surfaces. It serves to outline objects, to tint regions and painted amounts, and to hide
//! direction lines that are behind surfaces. It is drawn on the CPU in the window's thread, because the picture itself
//! comes later from another thread.

use std::sync::Arc;

use glam::{DAffine3, DVec2, DVec4};
use impasto_core::ScreenMap;
use impasto_editor_model::picking::View;
use impasto_painting::frame::BodySurface;
use impasto_painting::{BodyShape, Painting};
use impasto_scene::document::Lens;
use impasto_scene::motion;

/// How far behind the visible surface a point may lie and still count as on it, as a share of the surface's depth.
const LEEWAY: f32 = 0.006;

/// The nearest face in each cell of a grid over the viewport.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceMap {
    /// Columns and rows.
    size: [usize; 2],
    cells_per_point: f64,
    /// Depth along the gaze per cell, world units; infinite if the cell is empty.
    depth: Vec<f32>,
    faces: Vec<Face>,
    places: Vec<FacePlace>,
}

/// A face of an object.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Face {
    /// Index of the object in the scene.
    pub object: u32,
    /// Index of the triangle in its mesh.
    pub triangle: u32,
}

/// A place on a face, as it is seen.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FacePlace {
    /// Weights of the triangle's second and third corner; the three weights add up to 1.
    pub barycentric: [f32; 2],
    /// Whether the triangle is seen from its back.
    pub flipped: bool,
}

const NOTHING: Face = Face { object: u32::MAX, triangle: u32::MAX };

/// An object as it stands at a frame.
#[derive(Clone, Debug)]
pub struct StandingBody {
    /// Its surface.
    pub surface: Arc<BodySurface>,
    /// How it is bent and displaced at the frame.
    pub shape: BodyShape,
    /// Its pose.
    pub world_from_model: DAffine3,
    /// Whether it is drawn: false for a hidden object.
    pub visible: bool,
}

impl StandingBody {
    /// The bodies of a painting at a frame, in the order of the scene's objects.
    pub fn all(painting: &Painting, frame: f64) -> Vec<Self> {
        let scene = painting.scene();
        let poses = motion::poses_at(scene, frame);
        let body = |(object, shape)| Self {
            surface: Arc::clone(painting.surface(object)),
            shape,
            world_from_model: poses[object],
            visible: !scene.objects[object].hidden,
        };
        painting.shapes_at(frame).into_iter().enumerate().map(body).collect()
    }
}

/// Equal if they share one surface, and shape, pose and visibility are equal.
impl PartialEq for StandingBody {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.surface, &other.surface)
            && (&self.shape, self.world_from_model, self.visible)
                == (&other.shape, other.world_from_model, other.visible)
    }
}

/// A corner of a triangle before the perspective division: `place` and `depth` are linear in its position.
#[derive(Clone, Copy)]
struct Corner {
    /// x, y and w of the place: it lies x / w to the right of the picture's centre and y / w above it, in points.
    place: [f64; 3],
    depth: f64,
    /// Where it lies in the triangle before clipping: barycentric weights of that triangle's second and third corner.
    share: [f64; 2],
}

impl SurfaceMap {
    /// Draws the visible bodies; their indices are those of the scene's objects. `cells_per_point` is 1 or less.
    pub fn new(bodies: &[StandingBody], view: &View, cells_per_point: f64) -> Self {
        let size = [view.size_px.x, view.size_px.y]
            .map(|side| ((side * cells_per_point).ceil() as usize).clamp(1, 4096));
        let cells = size[0] * size[1];
        let mut map = Self {
            size,
            cells_per_point,
            depth: vec![f32::INFINITY; cells],
            faces: vec![NOTHING; cells],
            places: vec![FacePlace::default(); cells],
        };
        let near = match view.camera.lens {
            Lens::Perspective { near, .. } | Lens::Orthographic { near, .. } => near,
        };
        for (object, body) in bodies.iter().enumerate().filter(|(_, body)| body.visible) {
            let corners = corners(body, &view.map(body.world_from_model));
            for (triangle, vertices) in body.surface.mesh.triangles.iter().enumerate() {
                let face = Face { object: object as u32, triangle: triangle as u32 };
                map.add(vertices.map(|vertex| corners[vertex as usize]), near, view.size_px, face);
            }
        }
        map
    }

    /// Columns and rows.
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// Cells per point of the viewport.
    pub fn cells_per_point(&self) -> f64 {
        self.cells_per_point
    }

    /// The face in a cell; `None` if it is empty.
    pub fn face(&self, column: usize, row: usize) -> Option<Face> {
        let face = *self.faces.get(column + row * self.size[0])?;
        (face != NOTHING).then_some(face)
    }

    /// The face in a cell and the place on it; `None` if the cell is empty.
    pub fn place(&self, column: usize, row: usize) -> Option<(Face, FacePlace)> {
        Some((self.face(column, row)?, self.places[column + row * self.size[0]]))
    }

    /// Whether a point of an object is visible: whether a visible face of the same object, in the point's cell or the
    /// cells around it, lies as far from the eye as the point or farther. `LEEWAY` is allowed for.
    pub fn shows(&self, at_px: DVec2, depth: f64, object: usize) -> bool {
        let at = (at_px * self.cells_per_point).floor();
        if !(at.x >= 0.0 && at.y >= 0.0 && at.x < self.size[0] as f64 && at.y < self.size[1] as f64) {
            return false;
        }
        let (column, row) = (at.x as usize, at.y as usize);
        let columns = column.saturating_sub(1)..=(column + 1).min(self.size[0] - 1);
        let mut farthest = 0.0_f32;
        for row in row.saturating_sub(1)..=(row + 1).min(self.size[1] - 1) {
            for index in columns.clone().map(|column| column + row * self.size[0]) {
                if self.faces[index].object == object as u32 {
                    farthest = farthest.max(self.depth[index]);
                }
            }
        }
        depth as f32 <= farthest * (1.0 + LEEWAY)
    }

    fn add(&mut self, mut corners: [Corner; 3], near: f64, size_px: DVec2, face: Face) {
        (corners[1].share, corners[2].share) = ([1.0, 0.0], [0.0, 1.0]);
        if corners.iter().all(|corner| corner.depth >= near) {
            return self.fill(corners, size_px, face);
        }
        let kept = clip_at_near(corners, near);
        for index in 2..kept.len() {
            self.fill([kept[0], kept[index - 1], kept[index]], size_px, face);
        }
    }

    /// Draws a triangle that is beyond the near plane.
    fn fill(&mut self, corners: [Corner; 3], size_px: DVec2, face: Face) {
        let place = |corner: Corner| {
            let [x, y, w] = corner.place;
            (size_px * 0.5 + DVec2::new(x, -y) / w) * self.cells_per_point
        };
        let [a, b, c] = corners.map(place);
        let area = (b - a).perp_dot(c - a);
        if !area.is_normal() {
            return;
        }
        let (low, high) = (a.min(b).min(c), a.max(b).max(c));
        let limit = DVec2::new(self.size[0] as f64, self.size[1] as f64);
        let first = (low - 0.5).ceil().clamp(DVec2::ZERO, limit);
        let last = (high - 0.5).floor().clamp(DVec2::NEG_ONE, limit - 1.0);
        // Most triangles are so small that their bounding box contains no middle of a cell.
        if first.x > last.x || first.y > last.y {
            return;
        }
        // Depth / w and 1 / w are linear on the screen for every lens.
        let over_w = corners.map(|corner| DVec2::new(corner.depth, 1.0) / corner.place[2]);
        let sides = [(b, c - b), (c, a - c), (a, b - a)];
        for row in first.y as i64..=last.y as i64 {
            let y = row as f64 + 0.5;
            let [from, to] = columns_inside(&sides, area, y, [first.x, last.x]);
            for column in from as i64..=to as i64 {
                let at = DVec2::new(column as f64 + 0.5, y);
                let weights = sides.map(|(start, side)| side.perp_dot(at - start) / area);
                if weights[0] < 0.0 || weights[1] < 0.0 || weights[2] < 0.0 {
                    continue;
                }
                let mixed = over_w[0] * weights[0] + over_w[1] * weights[1] + over_w[2] * weights[2];
                let depth = (mixed.x / mixed.y) as f32;
                let index = column as usize + row as usize * self.size[0];
                if depth < self.depth[index] {
                    self.depth[index] = depth;
                    self.faces[index] = face;
                    // The share is linear on the surface, so share / w is linear on the screen.
                    let share = |of: usize| {
                        let over_w = |corner: usize| corners[corner].share[of] / corners[corner].place[2];
                        (0..3).map(|corner| weights[corner] * over_w(corner)).sum::<f64>() / mixed.y
                    };
                    let barycentric = [share(0) as f32, share(1) as f32];
                    // Rows run downwards, so a triangle that is counter-clockwise on the screen has a negative area.
                    self.places[index] = FacePlace { barycentric, flipped: area > 0.0 };
                }
            }
        }
    }
}

/// The first and the last column, within `range`, that a triangle may cover in the row whose middle is at `y`. One more
/// column is added at either end, so that rounding loses none. `area` is twice the triangle's signed area. Each side is
/// a corner and the vector to the next corner.
fn columns_inside(sides: &[(DVec2, DVec2); 3], area: f64, y: f64, range: [f64; 2]) -> [f64; 2] {
    let [mut from, mut to] = range;
    for &(start, side) in sides {
        // From one column to the next, the weight of the corner opposite this side grows by this much.
        let slope = -side.y / area;
        let crossing = start.x + side.x * (y - start.y) / side.y - 0.5;
        if slope > 0.0 {
            from = from.max((crossing - 1.0).ceil());
        } else if slope < 0.0 {
            to = to.min((crossing + 1.0).floor());
        }
    }
    [from, to]
}

fn corners(body: &StandingBody, map: &ScreenMap) -> Vec<Corner> {
    let corner = |at: glam::Vec3| {
        let p: DVec4 = at.as_dvec3().extend(1.0);
        Corner {
            place: [map.row_x.dot(p), map.row_y.dot(p), map.row_w.dot(p)],
            depth: map.row_depth.dot(p),
            share: [0.0; 2],
        }
    };
    body.surface.positions_at(&body.shape).into_iter().map(corner).collect()
}

/// Clips a triangle at the near plane, which leaves none, three or four corners.
fn clip_at_near(corners: [Corner; 3], near: f64) -> Vec<Corner> {
    let mut kept = Vec::with_capacity(4);
    for index in 0..3 {
        let (from, to) = (corners[index], corners[(index + 1) % 3]);
        if from.depth >= near {
            kept.push(from);
        }
        if (from.depth >= near) != (to.depth >= near) {
            let share = (near - from.depth) / (to.depth - from.depth);
            let mix = |a: f64, b: f64| a + (b - a) * share;
            let place = std::array::from_fn(|part| mix(from.place[part], to.place[part]));
            let mixed = |of: usize| mix(from.share[of], to.share[of]);
            kept.push(Corner { place, depth: near, share: [mixed(0), mixed(1)] });
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_cell_of_a_triangle_is_left_out_of_its_rows() {
        let mut state = 7_u32;
        let mut random = || {
            state = state.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
            f64::from(state >> 8) / f64::from(1 << 24)
        };
        let (mut inside, mut tried) = (0, 0);
        for round in 0..400 {
            // Small and medium triangles, and large ones that reach far past the map. Some have a level side.
            let wide = [3.0, 30.0, 4e5][round % 3];
            let mut corner = || DVec2::new(20.0 + wide * (random() - 0.5), 15.0 + wide * (random() - 0.5));
            let [a, mut b, c] = [corner(), corner(), corner()];
            if round % 5 == 0 {
                b.y = a.y;
            }
            let area = (b - a).perp_dot(c - a);
            let sides = [(b, c - b), (c, a - c), (a, b - a)];
            for row in 0..30 {
                let y = f64::from(row) + 0.5;
                let [from, to] = columns_inside(&sides, area, y, [0.0, 39.0]);
                for column in 0..40 {
                    let at = DVec2::new(f64::from(column) + 0.5, y);
                    tried += 1;
                    if sides.iter().all(|&(start, side)| side.perp_dot(at - start) / area >= 0.0) {
                        inside += 1;
                        assert!((from..=to).contains(&f64::from(column)), "{a} {b} {c}: {column}, {row}");
                    }
                }
            }
        }
        assert!(inside > 10_000 && inside < tried / 2, "{inside} of {tried}");
    }
}
