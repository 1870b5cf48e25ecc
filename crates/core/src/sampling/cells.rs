//! Cuts a surface into cells, and these into smaller ones, so that particles can be made in some of them and not in
//! others.

use std::ops::Range;
use std::sync::Arc;

use glam::{DVec3, Vec3};

use super::{Face, Surface};
use crate::hash;
use crate::mesh::of_corners;

/// The first cells are about this share of the surface's area, or smaller.
const SHARE: f64 = 1.0 / 4096.0;

/// Each edge of a face is first cut into at most this many parts, so a face into at most 64 × 64 cells.
const MOST_FIRST_CUTS: f64 = 64.0;

/// A cell is not split further once the edges of its face are cut into at least this many parts.
const MOST_CUTS: u32 = 1 << 16;

/// The first cells of a surface: parts of a large face, or small faces that follow each other in the mesh.
pub struct Cells(Vec<Cell>);

/// One cell.
#[derive(Clone, Debug)]
pub struct Cell {
    extent: Extent,
    /// Random bits; hardly any two cells of a surface have the same.
    pub(super) bits: u32,
    /// Centre of a sphere that holds the cell, model units.
    pub center: DVec3,
    /// Radius of this sphere.
    pub radius: f64,
    /// The mean of the flat normals of its visible sides, unit length; zero where these cancel.
    pub normal: DVec3,
    /// How far any normal of its visible sides, smooth or flat, may be from `normal`: the length of the difference.
    pub spread: f64,
    /// How far it reaches from its centre along `normal` or against it, model units.
    pub thickness: f64,
    /// Its share of the surface's area.
    pub share: f64,
}

/// A triangle of a cell.
#[derive(Clone, Copy, Debug)]
pub struct CellPiece {
    /// The vertices of the mesh's triangle on which it lies.
    pub vertices: [u32; 3],
    /// Its corners, model units.
    pub corners: [DVec3; 3],
    /// The flat unit normal of its visible side.
    pub flat: DVec3,
    /// The mesh's unit normals at the triangle's corners, turned to this side. `None` if some of them point to one side
    /// of the triangle and some to the other: then a particle's normal may point anywhere on this side.
    pub smooth: Option<[DVec3; 3]>,
}

/// The faces, or the part of a face, that a cell consists of.
#[derive(Clone, Debug)]
enum Extent {
    /// Whole faces that follow each other. If both sides of their triangles can be seen, `side` says which of them the
    /// cell holds: `true` is the back.
    Faces { faces: Range<u32>, side: Option<bool> },
    /// One of the small triangles into which a face is cut.
    Part {
        face: u32,
        /// Into how many parts each edge of the face is cut.
        cuts: u32,
        row: u32,
        column: u32,
        /// Whether it is the second triangle at this row and column, which stands upside down.
        second: bool,
    },
}

impl Cells {
    /// Cuts a surface. The result depends on the surface alone.
    pub fn new(surface: &Surface<'_>) -> Self {
        let area = surface.area();
        let mut cells = Vec::new();
        // `run`: small faces that follow each other. `two_sided`: both sides of their triangles can be seen.
        // `run_share`: the run's share of the surface's area.
        let (mut run, mut two_sided, mut run_share) = (0..0u32, false, 0.0);
        let close = |run: &Range<u32>, two_sided: bool, share: f64, cells: &mut Vec<Cell>| {
            if run.start < run.end && two_sided {
                for side in [false, true] {
                    cells.push(Cell::of_faces(surface, run.clone(), Some(side), 0.5 * share));
                }
            } else if run.start < run.end {
                cells.push(Cell::of_faces(surface, run.clone(), None, share));
            }
        };
        let faces: Vec<(u32, f64)> =
            surface.faces().map(|(triangle, _, face_area)| (triangle, face_area / area)).collect();
        let mut face = 0;
        for of_triangle in faces.chunk_by(|one, next| one.0 == next.0) {
            let sides = of_triangle.len() as u32;
            let share: f64 = of_triangle.iter().map(|(_, share)| share).sum();
            let is_large = share > SHARE;
            if is_large || run_share + share > SHARE || two_sided != (sides == 2) {
                close(&run, two_sided, run_share, &mut cells);
                (run, two_sided, run_share) = (face..face, sides == 2, 0.0);
            }
            if is_large {
                for side in 0..sides {
                    Cell::push_parts(surface, face + side, share / f64::from(sides), &mut cells);
                }
                run = face + sides..face + sides;
            } else {
                run.end = face + sides;
                run_share += share;
            }
            face += sides;
        }
        close(&run, two_sided, run_share, &mut cells);
        cells.iter_mut().zip(0..).for_each(|(cell, number)| cell.bits = hash::scramble(number));
        Self(cells)
    }

    /// All of them.
    pub fn all(&self) -> &[Cell] {
        &self.0
    }
}

impl IntoIterator for Cells {
    type Item = Cell;
    type IntoIter = std::vec::IntoIter<Cell>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.into_iter()
    }
}

impl Cell {
    fn of_faces(surface: &Surface<'_>, faces: Range<u32>, side: Option<bool>, share: f64) -> Self {
        let mesh = surface.mesh;
        let is_on_side = |face: &&Face| side.is_none_or(|side| face.flipped == side);
        let faces_of: Vec<Face> = surface.faces[faces.start as usize..faces.end as usize]
            .iter()
            .filter(is_on_side)
            .copied()
            .collect();
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        let mut sum = DVec3::ZERO;
        for face in &faces_of {
            for corner in mesh.corners(face.triangle as usize).map(Vec3::as_dvec3) {
                (low, high) = (low.min(corner), high.max(corner));
            }
            sum += normals(surface, *face).0;
        }
        let normal = sum.normalize_or_zero();
        let spread = faces_of.iter().map(|&face| spread(normal, normals(surface, face))).fold(0.0, f64::max);
        let center = 0.5 * (low + high);
        let corners = faces_of.iter().flat_map(|face| mesh.corners(face.triangle as usize));
        let thickness =
            corners.map(|corner| (corner.as_dvec3() - center).dot(normal).abs()).fold(0.0, f64::max);
        let extent = Extent::Faces { faces, side };
        let radius = 0.5 * low.distance(high);
        Self { extent, bits: 0, center, radius, normal, spread, thickness, share }
    }

    /// Cuts a face.
    fn push_parts(surface: &Surface<'_>, face: u32, share: f64, cells: &mut Vec<Self>) {
        let cuts = (share / SHARE).sqrt().ceil().clamp(1.0, MOST_FIRST_CUTS) as u32;
        let whole = Self::of_faces(surface, face..face + 1, None, share);
        for (row, column) in (0..cuts).flat_map(|row| (0..cuts - row).map(move |column| (row, column))) {
            let seconds = if column + 1 < cuts - row { &[false, true][..] } else { &[false] };
            for &second in seconds {
                cells.push(whole.part(surface, Extent::Part { face, cuts, row, column, second }, cuts));
            }
        }
    }

    /// The part `extent` of the cell. Each edge of the cell is cut into `cuts` parts.
    fn part(&self, surface: &Surface<'_>, extent: Extent, cuts: u32) -> Self {
        let Extent::Part { face, .. } = extent else { unreachable!("whole faces are no part") };
        let triangle = surface.faces[face as usize].triangle as usize;
        let [a, b, c] = surface.mesh.corners(triangle).map(Vec3::as_dvec3);
        let at = |weights: [f32; 2]| extent.at([a, b, c], weights);
        let center = at([1.0 / 3.0; 2]);
        let corners = CORNERS.map(at);
        let radius = corners.map(|corner| corner.distance(center)).into_iter().fold(0.0, f64::max);
        let share = self.share / (f64::from(cuts) * f64::from(cuts));
        Self { extent, center, radius, thickness: 0.0, share, ..self.clone() }
    }

    /// The smaller cells that it consists of; none if it is as small as cells get.
    pub fn split(&self, surface: &Surface<'_>) -> Vec<Self> {
        let mut cells = match self.extent {
            Extent::Faces { faces: Range { start, end }, side } if end - start > per_triangle(side) => {
                let step = per_triangle(side);
                let middle = start + (end - start) / step / 2 * step;
                let share_of = |faces: &Range<u32>| {
                    let before =
                        |face: u32| face.checked_sub(1).map_or(0.0, |at| surface.area_up_to[at as usize]);
                    (before(faces.end) - before(faces.start)) / f64::from(step) / surface.area()
                };
                [start..middle, middle..end]
                    .map(|faces| {
                        let share = share_of(&faces);
                        Self::of_faces(surface, faces, side, share)
                    })
                    .to_vec()
            }
            Extent::Faces { faces: Range { start, .. }, side } => {
                let face = start + u32::from(side == Some(true));
                let whole = Extent::Part { face, cuts: 1, row: 0, column: 0, second: false };
                whole.quarters().map(|extent| self.part(surface, extent, 2)).to_vec()
            }
            Extent::Part { cuts, .. } if cuts < MOST_CUTS => {
                self.extent.quarters().map(|extent| self.part(surface, extent, 2)).to_vec()
            }
            Extent::Part { .. } => Vec::new(),
        };
        cells.iter_mut().zip(1..).for_each(|(cell, number)| cell.bits = hash::combine(self.bits, number));
        cells
    }

    /// The triangles on which it lies.
    pub fn triangles<'a>(&self, surface: &'a Surface<'_>) -> impl Iterator<Item = usize> + use<'a> {
        self.faces(surface).map(|face| face.triangle as usize)
    }

    /// The faces on which it lies.
    fn faces<'a>(&self, surface: &'a Surface<'_>) -> impl Iterator<Item = &'a Face> + use<'a> {
        let (faces, side) = match &self.extent {
            Extent::Faces { faces, side } => (faces.clone(), *side),
            Extent::Part { face, .. } => (*face..*face + 1, None),
        };
        let faces = surface.faces[faces.start as usize..faces.end as usize].iter();
        faces.filter(move |face| side.is_none_or(|side| face.flipped == side))
    }

    /// The triangles that it consists of, with the normals of their visible sides.
    pub fn pieces<'a>(&'a self, surface: &'a Surface<'_>) -> impl Iterator<Item = CellPiece> + 'a {
        self.pieces_at(surface, &surface.mesh.positions)
    }

    /// The same while the vertices of the mesh are at `positions`; the normals are still those at rest.
    pub fn pieces_at<'a>(
        &'a self,
        surface: &'a Surface<'_>,
        positions: &'a [Vec3],
    ) -> impl Iterator<Item = CellPiece> + 'a {
        self.faces(surface).map(|&face| {
            let vertices = surface.mesh.triangles[face.triangle as usize];
            let corners = of_corners(positions, vertices).map(Vec3::as_dvec3);
            let (flat, smooth) = normals(surface, face);
            CellPiece {
                vertices,
                corners: CORNERS.map(|weights| self.extent.at(corners, weights)),
                flat,
                smooth,
            }
        })
    }

    /// Picks a point of the cell. Returns its face, and the weights of the face's second and third corner. `which` is
    /// a random number, uniform in 0..1. `on_triangle` is a random point, uniform over a triangle, as weights of the
    /// second and third corner.
    #[inline(always)]
    pub(super) fn place(
        &self,
        surface: &Surface<'_>,
        which: f32,
        on_triangle: [f32; 2],
    ) -> (usize, [f32; 2]) {
        match &self.extent {
            Extent::Faces { faces, side } => {
                let [from, to] = [faces.start as usize, faces.end as usize];
                let before = if from == 0 { 0.0 } else { surface.area_up_to[from - 1] };
                let area = before + f64::from(which) * (surface.area_up_to[to - 1] - before);
                let face = from + surface.area_up_to[from..to].partition_point(|&sum| sum <= area);
                let face = face.min(to - 1);
                match side {
                    None => (face, on_triangle),
                    // The front comes before the back.
                    Some(side) => (face - (face - from) % 2 + usize::from(*side), on_triangle),
                }
            }
            part @ Extent::Part { face, .. } => (*face as usize, part.weights(on_triangle)),
        }
    }
}

/// The three corners of a triangle, each given by the weights of the second and the third corner.
const CORNERS: [[f32; 2]; 3] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];

impl Extent {
    /// A point of the part, or of a whole face, from the corners of the face.
    fn at(&self, [a, b, c]: [DVec3; 3], weights: [f32; 2]) -> DVec3 {
        let [v, w] = self.weights(weights).map(f64::from);
        a + (b - a) * v + (c - a) * w
    }

    /// Weights on the face, from those on the part itself.
    #[inline(always)]
    fn weights(&self, [v, w]: [f32; 2]) -> [f32; 2] {
        let &Self::Part { cuts, row, column, second, .. } = self else { return [v, w] };
        let [v, w] = if second { [1.0 - v, 1.0 - w] } else { [v, w] };
        [(row as f32 + v) / cuts as f32, (column as f32 + w) / cuts as f32]
    }

    /// The four parts of a part.
    fn quarters(&self) -> [Self; 4] {
        let &Self::Part { face, cuts, row, column, second } = self else {
            unreachable!("whole faces are no part")
        };
        let of = |down: u32, along: u32, second: bool| Self::Part {
            face,
            cuts: 2 * cuts,
            row: 2 * row + down,
            column: 2 * column + along,
            second,
        };
        if second {
            [of(1, 1, false), of(1, 1, true), of(0, 1, true), of(1, 0, true)]
        } else {
            [of(0, 0, false), of(1, 0, false), of(0, 1, false), of(0, 0, true)]
        }
    }
}

/// How many faces of `Extent::Faces` belong to one triangle.
fn per_triangle(side: Option<bool>) -> u32 {
    if side.is_some() { 2 } else { 1 }
}

/// The flat unit normal of a face's visible side, and the smooth ones at its corners: see [`CellPiece`].
fn normals(surface: &Surface<'_>, face: Face) -> (DVec3, Option<[DVec3; 3]>) {
    let mesh = surface.mesh;
    let [a, b, c] = mesh.corners(face.triangle as usize).map(Vec3::as_dvec3);
    let across = (b - a).cross(c - a).normalize_or_zero();
    let flat = if face.flipped { -across } else { across };
    let smooth = of_corners(&mesh.normals, mesh.triangles[face.triangle as usize]).map(Vec3::as_dvec3);
    // A particle's normal is flipped after interpolation. So the corner normals may be flipped here only if all three
    // need it.
    let smooth = match smooth.map(|of| of.dot(flat) < 0.0) {
        [false, false, false] => Some(smooth),
        [true, true, true] => Some(smooth.map(|normal| -normal)),
        _ => None,
    };
    (flat, smooth)
}

/// How far the unit normals of a face, and normals interpolated between them, may be from the normal `from`: the length
/// of the difference.
fn spread(from: DVec3, (flat, smooth): (DVec3, Option<[DVec3; 3]>)) -> f64 {
    let Some(smooth) = smooth else { return 2.0 };
    let most = smooth.map(|normal| normal.distance(from)).into_iter().fold(flat.distance(from), f64::max);
    // If a corner normal is more than 1 away, interpolated normals are taken to point anywhere.
    if most > 1.0 { 2.0 } else { most }
}

/// Which particles of a progressive order each cell needs: those with an ordinal below the cell's limit.
#[derive(Clone, Debug, PartialEq)]
pub struct Needed {
    /// For each cell, its limit. The cells of [`Cells`] stand before the smaller ones that they are split into.
    pub of_cell: Vec<f32>,
    /// For each cell, the index of the first of its smaller cells ([`Cell::split`]), or 0 if those are not listed.
    /// Smaller cells that are not listed have the limit of the cell that was split.
    pub first_part: Arc<Vec<u32>>,
    /// Whether the later levels, which are thrown cell by cell, split every cell whose smaller cells are listed. If
    /// `true`, these levels add no particle where none is needed, but their particles differ from those of an order for
    /// the whole surface. If `false`, cells with few tries stay whole, which is faster.
    pub is_strict: bool,
}

impl Needed {
    /// The greatest number in `of_cell`.
    pub(super) fn most(&self) -> f32 {
        self.of_cell.iter().copied().fold(0.0, f32::max)
    }

    /// The index in `of_cell` of one of the smaller cells that the cell `of` is split into; `number` counts these from
    /// 0. Returns `of` itself where they are not listed.
    pub(super) fn part(&self, of: u32, number: u32) -> u32 {
        match self.first_part[of as usize] {
            0 => of,
            first => first + number,
        }
    }
}
