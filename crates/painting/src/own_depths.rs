//! Finds what a view does not see of a body because the body itself hides it. In a heap of faces, most of the surface
//! is hidden. Strokes there cannot show, so no particles are made there.

use std::ops::Range;

use glam::{DVec2, DVec3};
use impasto_core::sampling::{Cell, CellPiece, Surface};
use rayon::prelude::*;

use crate::particle_count::{Reach, Sighting};

/// One depth is stored for each square with a side of this many pixels.
const CELL_PX: f64 = 4.0;

/// Limits on the work: with more faces times views, or more squares in the grids of all views, the depths are not
/// computed.
const MOST_FACES: usize = 16_000_000;
const MOST_SQUARES: usize = 32_000_000;

/// About how many times faces may be tested against squares: in all views together, and in one view. Where more tests
/// would be needed, only every n-th face is taken. The others hide nothing.
const MOST_TESTS: f64 = 1e8;
const MOST_TESTS_IN_VIEW: f64 = 4e6;

/// The resolve shader tests whether a stroke's own body hides it, at places up to this distance from the stroke's
/// middle. The distance is that for small strokes: in a heap, few large strokes can be seen.
const ASKED_PX: f64 = 8.7;

/// The resolve shader begins to hide a small stroke that lies `HIDDEN_PX + HIDDEN_SLANTED_PX / slant` pixels behind the
/// nearest surface. These pixels are lengths: what a pixel of a picture of the scene's own size covers at the stroke's
/// depth. The slant is the cosine between the face's normal and the direction to the eye, at least `LEAST_SLANT`. A
/// stroke that lies three times as far behind is hidden wholly. Strokes that would be hidden in part count as hidden
/// here, on purpose: in a heap, strokes of other faces lie over them.
const HIDDEN_PX: f64 = 2.5;
const HIDDEN_SLANTED_PX: f64 = 3.5;
const LEAST_SLANT: f64 = 0.2;

/// Places on a triangle, as weights of its corners, that are tested to find whether some of it is hidden.
const SPOTS: [[f64; 3]; 7] = [
    [1.0 / 3.0; 3],
    [0.8, 0.1, 0.1],
    [0.1, 0.8, 0.1],
    [0.1, 0.1, 0.8],
    [0.1, 0.45, 0.45],
    [0.45, 0.1, 0.45],
    [0.45, 0.45, 0.1],
];

/// How a view sees a piece of surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Covered {
    /// Nothing of the body is known to lie in front of it.
    Nowhere,
    /// Some of it may be hidden.
    InPart,
    /// It faces away, or all strokes on it are hidden, at least in part.
    Wholly,
}

/// The nearest depths of a body in one view.
pub(crate) struct OwnDepths {
    sighting: Sighting,
    /// How far strokes are lifted off their surface at most, in units of depth.
    lift: f64,
    /// The corner of the first square, pixels.
    low_px: DVec2,
    /// First the nearest depth at the middle of each square, infinite where no face lies. Then for each two by two
    /// entries of the level before, the greatest of them, and so on.
    levels: Vec<Level>,
}

/// The depths on one level, row by row.
struct Level {
    size: [usize; 2],
    depths: Vec<f32>,
}

/// A triangle in the picture.
struct Shown {
    px: [DVec2; 3],
    /// The corners' depths, and the divisors of their projection, which are 1 without perspective.
    depths: [f64; 3],
    divisors: [f64; 3],
}

impl OwnDepths {
    /// The depths in every view, of the triangles that let nothing through. `None` where that would be too much work,
    /// where no triangle hides anything, and where a pose scales directions differently.
    pub(crate) fn of_all(
        surface: &Surface<'_>,
        sightings: &[Sighting],
        is_solid: impl Fn(usize) -> bool + Sync,
        reach: Reach,
    ) -> Option<Vec<Self>> {
        let squares = |sighting: &Sighting| {
            grid_size(sighting, reach.margin).into_iter().fold(1, usize::saturating_mul)
        };
        let is_little = surface.faces().count().saturating_mul(sightings.len()) <= MOST_FACES
            && sightings.iter().map(squares).fold(0, usize::saturating_add) <= MOST_SQUARES;
        let hides = surface.faces().any(|(triangle, ..)| is_solid(triangle as usize))
            && sightings.iter().all(|sighting| sighting.map.uneven.is_none());
        let most_tests = (MOST_TESTS / sightings.len().max(1) as f64).min(MOST_TESTS_IN_VIEW);
        let of = |sighting: &Sighting| Self::new(surface, sighting, &is_solid, reach, most_tests);
        (is_little && hides).then(|| sightings.par_iter().map(of).collect())
    }

    fn new(
        surface: &Surface<'_>,
        sighting: &Sighting,
        is_solid: impl Fn(usize) -> bool,
        reach: Reach,
        most_tests: f64,
    ) -> Self {
        let half_px = sighting.half_size_px * reach.margin;
        let size = grid_size(sighting, reach.margin);
        let mut depths = vec![f32::INFINITY; size[0] * size[1]];
        let shown = |(triangle, flipped, _): (u32, bool, f64)| {
            let corners = surface.mesh().corners(triangle as usize).map(|at| at.as_dvec3());
            is_solid(triangle as usize).then(|| Shown::of(sighting, corners, flipped)).flatten()
        };
        let squares = |shown: &Shown| squares(shown.bounds(), -half_px, size);
        let work = |shown: &Shown| squares(shown).map_or(0.0, |[x, y]| (x.len() * y.len()) as f64);
        let all: f64 = surface.faces().filter_map(shown).map(|shown| work(&shown)).sum();
        let step = (all / most_tests).ceil().max(1.0) as usize;
        for shown in surface.faces().step_by(step | 1).filter_map(shown) {
            let Some([columns, rows]) = squares(&shown) else { continue };
            for row in rows {
                for column in columns.clone() {
                    let at_px = (DVec2::new(column as f64, row as f64) + 0.5) * CELL_PX - half_px;
                    if let Some(depth) = shown.depth_at(at_px) {
                        let nearest = &mut depths[row * size[0] + column];
                        *nearest = nearest.min(depth as f32);
                    }
                }
            }
        }
        let first = Level { size, depths };
        let mut levels = vec![first];
        while let Some(last) = levels.last().filter(|level| level.size != [1, 1]) {
            levels.push(last.halved());
        }
        let lift = reach.most_offset() * sighting.map.row_depth.truncate().length();
        Self { sighting: sighting.clone(), lift, low_px: -half_px, levels }
    }

    /// How the view sees a cell.
    pub(crate) fn covers(&self, surface: &Surface<'_>, cell: &Cell) -> Covered {
        let mut pieces = cell.pieces(surface).map(|piece| self.covers_piece(&piece));
        let Some(first) = pieces.next() else { return Covered::Wholly };
        if pieces.all(|piece| piece == first) { first } else { Covered::InPart }
    }

    fn covers_piece(&self, CellPiece { corners, flat, smooth, .. }: &CellPiece) -> Covered {
        let Sighting { map, near, .. } = &self.sighting;
        let depths = corners.map(|corner| map.depth(corner));
        let nearest = depths.into_iter().fold(f64::INFINITY, f64::min);
        let px = corners.map(|corner| map.project(corner));
        if nearest <= *near || !px.iter().all(|px| px.is_finite()) {
            return Covered::Nowhere;
        }
        // Where a particle's normal may point anywhere, one of these faces the eye.
        let [a, b, c] = smooth.unwrap_or([-*flat; 3]);
        let normals = [*flat, a, b, c];
        let facings = corners.map(|corner| {
            let jacobian = map.jacobian(corner);
            normals.map(|normal| map.facing(jacobian, normal))
        });
        if self.lift == 0.0 && facings.as_flattened().iter().all(|&facing| facing <= 0.0) {
            return Covered::Wholly;
        }
        let slant = facings.as_flattened().iter().fold(1.0, |least: f64, facing| least.min(facing.abs()));
        let slant = slant.max(LEAST_SLANT);
        let [along_x, along_y] = map.jacobian(corners[0]);
        let unit = map.row_depth.truncate().length() / along_x.cross(along_y).length().sqrt();
        let slack = unit * (HIDDEN_PX + HIDDEN_SLANTED_PX / slant) + self.lift;
        // A stroke that is lifted off its face may show beside the surface that hides the face.
        let reach_px = ASKED_PX + self.lift / unit;
        let low = px[0].min(px[1]).min(px[2]) - reach_px;
        let high = px[0].max(px[1]).max(px[2]) + reach_px;
        if nearest - slack > self.greatest_over(low, high) {
            return Covered::Wholly;
        }
        let is_hidden = |weights: [f64; 3]| {
            let at = (0..3).map(|corner| corners[corner] * weights[corner]).sum::<DVec3>();
            let px = map.project(at);
            map.depth(at) - slack > self.greatest_over(px, px)
        };
        if SPOTS.into_iter().any(is_hidden) { Covered::InPart } else { Covered::Nowhere }
    }

    /// The greatest depth within a box; infinite where the box reaches beyond the squares.
    fn greatest_over(&self, low: DVec2, high: DVec2) -> f64 {
        let [low, high] = [low, high].map(|at| (at - self.low_px) / CELL_PX);
        let [columns, rows] = self.levels[0].size;
        // NaN counts as beyond, too.
        if !(low.min_element() >= 0.0 && high.x < columns as f64 && high.y < rows as f64) {
            return f64::INFINITY;
        }
        let ([left, bottom], [right, top]) =
            ([low.x as usize, low.y as usize], [high.x as usize, high.y as usize]);
        let level = ((right - left).max(top - bottom) / 3).checked_ilog2().unwrap_or(0) as usize;
        let Level { size, depths } = &self.levels[level];
        let mut greatest = 0.0;
        for row in bottom >> level..=top >> level {
            for column in left >> level..=right >> level {
                greatest = depths[row * size[0] + column].max(greatest);
            }
        }
        f64::from(greatest)
    }
}

impl Level {
    /// The next level, with half as many columns and rows.
    fn halved(&self) -> Self {
        let [columns, rows] = self.size;
        let size = [columns.div_ceil(2), rows.div_ceil(2)];
        let of = |row: usize, column: usize| {
            let mut greatest = 0.0f32;
            for row in 2 * row..rows.min(2 * row + 2) {
                for column in 2 * column..columns.min(2 * column + 2) {
                    greatest = greatest.max(self.depths[row * columns + column]);
                }
            }
            greatest
        };
        let depths = (0..size[1]).flat_map(|row| (0..size[0]).map(move |column| (row, column)));
        Self { size, depths: depths.map(|(row, column)| of(row, column)).collect() }
    }
}

impl Shown {
    /// A triangle's visible side; `None` where it faces away or reaches nearer than the near plane.
    fn of(sighting: &Sighting, corners: [DVec3; 3], flipped: bool) -> Option<Self> {
        let map = &sighting.map;
        let px = corners.map(|corner| map.project(corner));
        let shown = Self {
            px,
            depths: corners.map(|corner| map.depth(corner)),
            divisors: corners.map(|corner| map.row_w.dot(corner.extend(1.0))),
        };
        let [a, b, c] = corners;
        let across = if flipped { (c - a).cross(b - a) } else { (b - a).cross(c - a) };
        let faces_the_eye = map.facing(map.jacobian(a), across.normalize_or_zero()) > 0.0;
        let is_before = shown.depths.iter().all(|&depth| depth > sighting.near);
        (is_before && faces_the_eye && px.iter().all(|px| px.is_finite())).then_some(shown)
    }

    fn bounds(&self) -> [DVec2; 2] {
        let [a, b, c] = self.px;
        [a.min(b).min(c), a.max(b).max(c)]
    }

    /// Its depth at a place in the picture; `None` beside it.
    fn depth_at(&self, at: DVec2) -> Option<f64> {
        let [a, b, c] = self.px;
        let areas = [(b - at).perp_dot(c - at), (c - at).perp_dot(a - at), (a - at).perp_dot(b - at)];
        let is_inside = areas.iter().all(|&area| area >= 0.0) || areas.iter().all(|&area| area <= 0.0);
        let weights: [f64; 3] = std::array::from_fn(|corner| areas[corner] / self.divisors[corner]);
        let sum: f64 = weights.iter().sum();
        let depth = (0..3).map(|corner| weights[corner] * self.depths[corner]).sum::<f64>() / sum;
        (is_inside && depth.is_finite()).then_some(depth)
    }
}

/// How many columns and rows of squares a view has. They reach as far from the middle of the picture as the view's
/// particles: `margin` half sizes of the picture.
fn grid_size(sighting: &Sighting, margin: f64) -> [usize; 2] {
    let size = (sighting.half_size_px * margin * 2.0 / CELL_PX).ceil().max(DVec2::ONE);
    [size.x as usize, size.y as usize]
}

/// The columns and rows of squares whose middles may lie within a box; `None` where there are none.
fn squares([low, high]: [DVec2; 2], low_px: DVec2, size: [usize; 2]) -> Option<[Range<usize>; 2]> {
    let [low, high] = [low, high].map(|at| (at - low_px) / CELL_PX - 0.5);
    let range = |low: f64, high: f64, size: usize| {
        let range = low.ceil().max(0.0) as usize..((high.floor() + 1.0).max(0.0) as usize).min(size);
        (!range.is_empty()).then_some(range)
    };
    Some([range(low.x, high.x, size[0])?, range(low.y, high.y, size[1])?])
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DAffine3, Vec3};
    use impasto_core::sampling::Cells;
    use impasto_core::screen_map::PixelLens;
    use impasto_core::{ScreenMap, TriangleMesh};

    use crate::body_shape::BodyShape;

    const REACH: Reach = Reach { margin: 1.5, reach_px: 20.0, following: None, offsets: [0.0; 2] };

    /// Squares that lie 0.1 below each other, each of 2 x 2 units, from y = 0 down.
    fn pile(squares: usize) -> TriangleMesh {
        let mut mesh = TriangleMesh::default();
        for square in 0..squares as u32 {
            let y = -0.1 * square as f32;
            mesh.positions.extend(
                [[-1.0, 1.0], [1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]].map(|[x, z]| Vec3::new(x, y, z)),
            );
            mesh.normals.extend([Vec3::Y; 4]);
            mesh.triangles
                .extend([[0, 1, 2], [0, 2, 3]].map(|of: [u32; 3]| of.map(|corner| corner + 4 * square)));
        }
        mesh
    }

    /// From above the pile, 5 units away, so that it fills 160 x 160 pixels.
    fn from_above(lens: PixelLens) -> Sighting {
        let eye = DVec3::new(0.0, 5.0, 0.0);
        let view = glam::dcamera::rh::view::look_at_mat4(eye, DVec3::ZERO, DVec3::NEG_Z);
        let map = ScreenMap::new(view, DAffine3::IDENTITY, lens);
        Sighting { map, half_size_px: DVec2::new(320.0, 180.0), near: 0.1, shape: BodyShape::default() }
    }

    /// The share of each square's upper side that is hidden wholly; and the share of the whole surface that lies on
    /// lower sides and is not hidden wholly.
    fn hidden(mesh: &TriangleMesh, sighting: &Sighting, is_solid: bool) -> (Vec<f64>, f64) {
        let surface = Surface::new(mesh, |_| true);
        let own = OwnDepths::new(&surface, sighting, |_| is_solid, REACH, 4e6);
        let (mut hidden, mut below) = (vec![0.0; mesh.triangles.len() / 2], 0.0);
        let mut cells: Vec<(Cell, u32)> = Cells::new(&surface).into_iter().map(|cell| (cell, 0)).collect();
        while let Some((cell, cuts)) = cells.pop() {
            let covered = own.covers(&surface, &cell);
            if cell.normal.y < 0.0 {
                below += if covered == Covered::Wholly { 0.0 } else { cell.share };
            } else if covered == Covered::Wholly {
                let square = cell.triangles(&surface).next().unwrap() / 2;
                hidden[square] += cell.share * 2.0 * hidden.len() as f64;
            } else if cuts < 4 {
                cells.extend(cell.split(&surface).into_iter().map(|part| (part, cuts + 1)));
            }
        }
        (hidden, below)
    }

    #[test]
    fn a_pile_hides_all_but_its_uppermost_sheet_and_its_border() {
        let lenses =
            [PixelLens::Perspective { focal_px: 400.0 }, PixelLens::Orthographic { px_per_unit: 80.0 }];
        for lens in lenses {
            let (hidden, below) = hidden(&pile(12), &from_above(lens), true);
            assert_eq!(hidden[0], 0.0, "{lens:?}");
            // The second sheet is only eight pixels (0.1 units) behind the first, little more than the six pixels from
            // which on strokes count as hidden. So this test leaves it out.
            for (square, &share) in hidden.iter().enumerate().skip(2) {
                assert!(share > 0.6, "sheet {square}: {share}, {lens:?}");
                // In the orthographic view all sheets end at the same pixels; in perspective the lower ones end farther
                // in.
                let is_seen_beside = matches!(lens, PixelLens::Orthographic { .. }) || square < 4;
                assert!(!is_seen_beside || share < 0.95, "sheet {square}: {share}, {lens:?}");
            }
            assert_eq!(below, 0.0, "lower sides face away, {lens:?}");
        }
    }

    #[test]
    fn what_lets_something_through_hides_nothing() {
        let (hidden, _) = hidden(&pile(12), &from_above(PixelLens::Perspective { focal_px: 400.0 }), false);
        assert_eq!(hidden, [0.0; 12]);
    }

    /// Strokes that stand out by 0.15 units may be seen over the sheet above their own; and nothing is known of a body
    /// that is stretched.
    #[test]
    fn lifted_strokes_and_stretched_bodies_are_told_apart() {
        let mesh = pile(12);
        let surface = Surface::new(&mesh, |_| true);
        let sighting = from_above(PixelLens::Orthographic { px_per_unit: 80.0 });
        let lifted = Reach { offsets: [0.0, 0.15], ..REACH };
        let hidden_of = |reach: Reach| -> f64 {
            let own = OwnDepths::of_all(&surface, std::slice::from_ref(&sighting), |_| true, reach).unwrap();
            let cells = Cells::new(&surface);
            let hidden =
                |cell: &&Cell| own[0].covers(&surface, cell) == Covered::Wholly && cell.normal.y > 0.0;
            cells.all().iter().filter(hidden).map(|cell| cell.share).sum()
        };
        let [flat, over] = [REACH, lifted].map(hidden_of);
        assert!(over < flat - 0.05, "{flat} is hidden of flat strokes, {over} of lifted ones");
        let view = glam::dcamera::rh::view::look_at_mat4(DVec3::Y * 5.0, DVec3::ZERO, DVec3::NEG_Z);
        let pose = DAffine3::from_scale(DVec3::new(1.0, 0.2, 1.0));
        let lens = PixelLens::Orthographic { px_per_unit: 80.0 };
        let stretched = Sighting { map: ScreenMap::new(view, pose, lens), ..sighting.clone() };
        assert!(OwnDepths::of_all(&surface, &[stretched], |_| true, REACH).is_none());
        assert!(
            OwnDepths::of_all(&surface, std::slice::from_ref(&sighting), |_| false, REACH).is_none(),
            "all has holes"
        );
    }

    #[test]
    fn of_a_box_the_greatest_depth_is_found() {
        // A ramp 160 pixels wide: from x = -80 to 80 its depth grows from 5 to 6.
        let mesh = TriangleMesh {
            positions: [[-1.0, 0.0, 1.0], [1.0, -1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 0.0, -1.0]]
                .map(Vec3::from)
                .to_vec(),
            normals: vec![Vec3::Y; 4],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            ..TriangleMesh::default()
        };
        let surface = Surface::new(&mesh, |_| true);
        let sighting = from_above(PixelLens::Orthographic { px_per_unit: 80.0 });
        let own = OwnDepths::new(&surface, &sighting, |_| true, REACH, 4e6);
        for [left, right] in [[-60.0, -50.0], [-40.0, 2.0], [-10.0, -10.0], [5.0, 21.0], [40.0, 47.0]] {
            let found = own.greatest_over(DVec2::new(left, -3.0), DVec2::new(right, 4.0));
            let at_right = 5.5 + 0.5 * right / 80.0;
            // Depths are known only for each square, and for wide boxes for blocks of squares. So the result may be too
            // small by what the depth grows over one square, or too great by what it grows over two squares and the
            // box.
            let least = at_right - CELL_PX / 160.0;
            let most = at_right + (2.0 * CELL_PX + right - left) / 160.0;
            assert!((least..=most).contains(&found), "{left} to {right}: {found}, not {at_right}");
        }
        assert_eq!(own.greatest_over(DVec2::ZERO, DVec2::splat(100.0)), f64::INFINITY, "past the border");
        assert_eq!(own.greatest_over(DVec2::ZERO, DVec2::new(0.0, 1e9)), f64::INFINITY, "past the picture");
        assert_eq!(own.greatest_over(DVec2::NAN, DVec2::NAN), f64::INFINITY);
    }
}
