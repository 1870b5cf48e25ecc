//! A level of dart throwing whose candidates are thrown cell by cell, so that cells in which no particles are needed
//! cost nothing.

use glam::Vec3;
use rayon::prelude::*;

use super::cells::{Cell, Cells, Needed};
use super::dart_field::{Accepted, DartField};
use super::dart_grid::Dart;
use super::levels::{ProgressiveState, TRIES};
use super::{Particle, Surface, barycentric};
use crate::hash;
use crate::wide::{Wide, widest};

/// The first tries of a level are accepted a little more often than the last: after the share t of its tries, the level
/// has the share t + `FRONT_LOAD` t (1 − t) of its particles.
const FRONT_LOAD: f64 = 0.157;

/// In how many cells one task throws candidates.
const CELLS: usize = 32;

/// A cell that would have more tries than this in a level is split.
const MOST_TRIES: f64 = 48.0;

/// Where faces lie on each other, there is only room for the particles of one face, and most tries are in vain. So
/// tries are saved in such cells: if a cell had room for a tenth of the particles meant for it, it gets `SPARE` tenths
/// of its tries in the next level, but never more than all of them.
const SPARE: f64 = 8.0;

/// The least share of its tries that a cell gets, so that room that opens up at finer spacings is found.
const LEAST_TRIED: f64 = 1.0 / 32.0;

/// The cells in which the present level is thrown.
pub(super) struct ActiveCells<'a> {
    cells: Vec<Cell>,
    /// What each level reads of all these cells, in the same order. It is an array of its own because a level reads the
    /// cell itself only for a try, and where faces lie on each other, most cells get none.
    asked: Vec<AskedCell>,
    needed: Option<&'a Needed>,
}

/// What each level reads of a cell, even if the cell gets no try.
#[derive(Clone, Copy)]
struct AskedCell {
    /// Its share of the surface's area.
    share: f64,
    /// Its random bits.
    bits: u32,
    /// Its index in `needed`.
    index: u32,
    filled: Filled,
}

/// How many particles the levels were meant to add in a cell since it was made, and how many they added. Counted only
/// where tries are saved.
#[derive(Clone, Copy)]
struct Filled {
    meant: f64,
    added: f64,
    /// The value that was expected of [`Filled::share`] when the cell was made. It counts like one more particle: if
    /// 0.3 was expected, as if one more had been meant for the cell, and 0.3 of it added.
    expected: f64,
}

impl Filled {
    /// An estimate: of the particles meant for the cell, the share that it has room for.
    #[inline(always)]
    fn share(self) -> f64 {
        (self.added + self.expected) / (self.meant + 1.0)
    }

    /// The share of its tries that the cell gets in the next level.
    #[inline(always)]
    fn tried(self) -> f64 {
        (SPARE * self.share()).clamp(LEAST_TRIED, 1.0)
    }
}

impl AskedCell {
    /// A new cell, expected to have room for the share `expected` of the particles meant for it.
    fn new(cell: &Cell, index: u32, expected: f64) -> Self {
        let filled = Filled { meant: 0.0, added: 0.0, expected };
        Self { share: cell.share, bits: cell.bits, index, filled }
    }
}

impl<'a> ActiveCells<'a> {
    /// The first cells of a surface, each expected to have room for the share `expected` of the particles meant for it.
    pub(super) fn new(surface: &Surface<'_>, needed: Option<&'a Needed>, expected: f64) -> Self {
        let cells: Vec<Cell> = Cells::new(surface).into_iter().collect();
        let asked = cells.iter().zip(0..);
        let asked = asked.map(|(cell, index)| AskedCell::new(cell, index, expected)).collect();
        Self { cells, asked, needed }
    }

    /// Drops the cells that need no particle from this ordinal on. Splits those that would have many tries and, if
    /// `needed` is strict, all those whose parts are listed.
    fn refine(&mut self, surface: &Surface<'_>, (tries, ordinal): (f64, f32)) {
        let needed = self.needed;
        let is_whole = |asked: &AskedCell| {
            asked.share * tries <= MOST_TRIES
                && needed
                    .is_none_or(|needed| !needed.is_strict || needed.first_part[asked.index as usize] == 0)
        };
        let is_needed =
            |asked: &AskedCell| needed.is_none_or(|needed| needed.of_cell[asked.index as usize] > ordinal);
        // The cells that stay move up to the places of those that do not.
        let (mut stay, mut many) = (0, Vec::new());
        for at in 0..self.cells.len() {
            let asked = self.asked[at];
            if !is_needed(&asked) {
                continue;
            }
            if !is_whole(&asked) {
                many.push((self.cells[at].clone(), asked));
                continue;
            }
            if stay < at {
                self.cells.swap(stay, at);
                self.asked[stay] = asked;
            }
            stay += 1;
        }
        self.cells.truncate(stay);
        self.asked.truncate(stay);
        while let Some((cell, asked)) = many.pop() {
            let parts = cell.split(surface);
            if parts.is_empty() {
                self.cells.push(cell);
                self.asked.push(asked);
                continue;
            }
            for (part, number) in parts.into_iter().zip(0..) {
                let index = needed.map_or(0, |needed| needed.part(asked.index, number));
                let asked = AskedCell::new(&part, index, asked.filled.share());
                match is_whole(&asked) {
                    _ if !is_needed(&asked) => {}
                    true => {
                        self.cells.push(part);
                        self.asked.push(asked);
                    }
                    false => many.push((part, asked)),
                }
            }
        }
    }

    /// Notes how many particles a level was meant to add on the whole surface, and the cell of each that it added.
    fn note(&mut self, meant: f64, added: impl Iterator<Item = u32>) {
        for asked in &mut self.asked {
            asked.filled.meant += meant * asked.share;
        }
        for cell in added {
            self.asked[cell as usize].filled.added += 1.0;
        }
    }
}

/// A level.
pub(super) struct CellLevel {
    pub(super) seed: u32,
    /// How many particles the order is meant to have when the level begins, and when it ends.
    pub(super) ends: [usize; 2],
    /// The state of the order before the level.
    pub(super) state: ProgressiveState,
    pub(super) radius: f32,
}

/// How many candidates get their random numbers together.
const LANES: usize = 8;

/// Candidates that are yet to get their random numbers. They may be of several cells: where faces lie on each other, a
/// cell seldom has more than one.
#[derive(Default)]
struct Batch {
    len: usize,
    /// For each candidate the index of its cell among those of the task, the level's seed for that cell, and the
    /// candidate's number in the cell.
    cells: [u32; LANES],
    seeds: [u32; LANES],
    numbers: [u32; LANES],
}

/// The random numbers of a batch.
struct Randoms {
    bits: [u32; LANES],
    /// See [`Thrown::turn`].
    turns: [u32; LANES],
    /// Numbers in 0..1, which choose the face.
    which: [f32; LANES],
    /// Weights of the second and third corner, spread evenly over a triangle.
    on_triangle: [[f32; LANES]; 2],
}

impl Randoms {
    #[inline(always)]
    fn new(Batch { seeds, numbers, .. }: &Batch) -> Self {
        let mut randoms =
            Self { bits: [0; LANES], turns: [0; LANES], which: [0.0; LANES], on_triangle: [[0.0; LANES]; 2] };
        for lane in 0..LANES {
            let bits = hash::combine(seeds[lane], numbers[lane]);
            let [which, first, second] = [1, 2, 3].map(|which| hash::unit(hash::combine(bits, which)));
            let [v, w] = barycentric(first, second);
            randoms.bits[lane] = bits;
            randoms.turns[lane] = hash::combine(bits, 0);
            randoms.which[lane] = which;
            randoms.on_triangle[0][lane] = v;
            randoms.on_triangle[1][lane] = w;
        }
        randoms
    }
}

/// Throws a level's candidates in some cells. All that it calls often is inlined (see [`Wide`]).
struct Throwing<'a> {
    level: &'a CellLevel,
    surface: &'a Surface<'a>,
    cells: &'a [Cell],
    asked: &'a [AskedCell],
    /// The index of the first of these cells among the active ones.
    first_cell: u32,
    needed: Option<&'a Needed>,
    field: &'a DartField,
    accepted: &'a Accepted<'a>,
    saves_tries: bool,
}

impl Wide for Throwing<'_> {
    /// The candidates that are needed and that no accepted particle crowds.
    type Output = Vec<Thrown>;

    #[inline(always)]
    fn run(self) -> Vec<Thrown> {
        let (mut clear, mut batch, mut cell, mut number) = (Vec::new(), Batch::default(), 0, 0);
        let [mut seed, mut count] = [0; 2];
        let mut is_over = false;
        while !is_over {
            // Fills a batch from one cell after the other.
            batch.len = 0;
            while batch.len < LANES && !is_over {
                if number < count {
                    let lane = batch.len;
                    (batch.cells[lane], batch.seeds[lane], batch.numbers[lane]) =
                        (cell as u32 - 1, seed, number);
                    (batch.len, number) = (lane + 1, number + 1);
                } else if let Some(asked) = self.asked.get(cell) {
                    let tried = if self.saves_tries { asked.filled.tried() } else { 1.0 };
                    (seed, count) = self.level.thrown(asked, tried);
                    (cell, number) = (cell + 1, 0);
                } else {
                    is_over = true;
                }
            }
            self.throw(&batch, &mut clear);
        }
        clear
    }
}

impl Throwing<'_> {
    #[inline(always)]
    fn throw(&self, batch: &Batch, clear: &mut Vec<Thrown>) {
        let Self { level, surface, cells, asked, first_cell, needed, field, accepted, .. } = self;
        let Randoms { bits, turns, which, on_triangle: [v, w] } = Randoms::new(batch);
        for lane in 0..batch.len {
            let index = batch.cells[lane] as usize;
            let most = needed.map_or(f32::INFINITY, |needed| needed.of_cell[asked[index].index as usize]);
            let (turn, bits) = (turns[lane], bits[lane]);
            if level.ordinal(turn_share(turn)) >= most {
                continue;
            }
            let (face, weights) = cells[index].place(surface, which[lane], [v[lane], w[lane]]);
            let position = surface.position(face, weights);
            let dart = Dart { position, face: face as u32, number: 0 };
            let normal = || surface.particle(face, weights).normal;
            if field.is_clear(accepted, &dart, normal) {
                let cell = first_cell + batch.cells[lane];
                clear.push(Thrown { turn, bits, cell, face: face as u32, weights, position });
            }
        }
    }
}

/// The particles that a level adds, in the order in which they were tried.
#[derive(Default)]
pub(super) struct Added {
    pub(super) particles: Vec<Particle>,
    pub(super) ordinals: Vec<f32>,
}

/// A candidate. Candidates are tried in the order of `turn` (0 is the beginning of the level, 2³² its end), those with
/// equal turns in the order of `bits`.
#[derive(Clone, Copy)]
struct Thrown {
    turn: u32,
    bits: u32,
    /// Index among the active cells.
    cell: u32,
    face: u32,
    weights: [f32; 2],
    position: Vec3,
}

impl CellLevel {
    /// The particles that the level adds.
    pub(super) fn added(
        &self,
        surface: &Surface<'_>,
        active: &mut ActiveCells<'_>,
        field: &DartField,
        accepted: &Accepted<'_>,
    ) -> Added {
        let tries = self.tries();
        active.refine(surface, (tries, self.ordinal(0.0)));
        // Tries are saved in crowded orders, and in strict ones: a strict order is for a body that hides most of
        // itself, and the faces of such a body often lie close to each other.
        let saves_tries = self.state.is_crowded() || active.needed.is_some_and(|needed| needed.is_strict);
        let of_cells = |(chunk, (cells, asked)): (usize, (&[Cell], &[AskedCell]))| {
            widest(Throwing {
                level: self,
                surface,
                cells,
                asked,
                first_cell: (chunk * CELLS) as u32,
                needed: active.needed,
                field,
                accepted,
                saves_tries,
            })
        };
        let chunks = active.cells.par_chunks(CELLS).zip(active.asked.par_chunks(CELLS));
        let found: Vec<Vec<Thrown>> = chunks.enumerate().map(of_cells).collect();
        let mut clear = found.concat();
        clear.par_sort_unstable_by_key(|thrown| {
            (thrown.turn, thrown.bits, thrown.face, thrown.weights.map(f32::to_bits))
        });
        let dart =
            |(thrown, number): (&Thrown, u32)| Dart { position: thrown.position, face: thrown.face, number };
        let darts: Vec<Dart> = clear.iter().zip(0..).map(dart).collect();
        let particle = |number: u32| {
            let Thrown { face, weights, .. } = clear[number as usize];
            surface.particle(face as usize, weights)
        };
        let kept =
            field.thinned(&(0..darts.len() as u32), &darts, self.radius, |number| particle(number).normal);
        if saves_tries {
            let meant = (self.ends[1] - self.ends[0]) as f64;
            active.note(meant, kept.iter().map(|dart| clear[dart.number as usize].cell));
        }
        Added {
            particles: kept.par_iter().with_min_len(64).map(|dart| particle(dart.number)).collect(),
            ordinals: kept
                .iter()
                .map(|dart| self.ordinal(turn_share(clear[dart.number as usize].turn)))
                .collect(),
        }
    }

    /// How many candidates it has on the whole surface.
    fn tries(&self) -> f64 {
        (self.ends[1] - self.ends[0]) as f64 * TRIES as f64
    }

    /// The level's seed for a cell, and how many candidates are thrown there, needed or not: the share `tried` of the
    /// cell's tries.
    #[inline(always)]
    fn thrown(&self, cell: &AskedCell, tried: f64) -> (u32, u32) {
        let seed = hash::combine(hash::combine(self.seed, cell.bits), self.ends[0] as u32);
        let tries = self.tries() * cell.share * tried;
        // Chance decides whether the fraction of a try makes one more.
        (seed, (tries + f64::from(hash::unit(seed))) as u32)
    }

    /// The ordinal of a particle that was tried after this share of the level's tries.
    #[inline(always)]
    pub(super) fn ordinal(&self, share: f64) -> f32 {
        let [begin, end] = self.ends.map(|end| end as f64);
        let filled = share + FRONT_LOAD * share * (1.0 - share);
        self.state.ordinal_at(begin + (end - begin) * filled) as f32
    }
}

#[inline(always)]
fn turn_share(turn: u32) -> f64 {
    f64::from(turn) / 4_294_967_296.0
}
