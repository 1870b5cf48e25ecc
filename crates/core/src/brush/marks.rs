//! Makes the marks of the built-in brushes: textures of paint, height and tint, from noise that imitates hairs.

use super::lattice::{Between, Lattice};
use super::{Mark, NAMES, SIZE, Texel};
use crate::hash;
use crate::presence::smoothstep;

/// Length of a mark in half widths: strokes are about three times as long as wide.
const ASPECT: f32 = 6.2;

#[derive(Clone, Copy)]
struct Brush {
    hairs: f32,
    /// How deep the mark's start and its end are rounded, in half widths.
    caps: [f32; 2],
    /// How ragged the end is, as a share of the length.
    ragged: f32,
    /// Dryness at the start and at the end.
    dry: [f32; 2],
    /// How deep the furrows are that the hairs draw in the paint.
    furrows: f32,
    /// Height of the ridges of paint: along the edges, and where the brush lifts.
    ridges: [f32; 2],
    shape: Shape,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Shape {
    /// As wide at its ends as in the middle.
    Straight,
    /// A little narrower towards its ends.
    Belly,
    /// Hairs that spread.
    Fan,
    Taper,
}

const USUAL: Brush = Brush {
    hairs: 22.0,
    caps: [0.22, 0.0],
    ragged: 0.20,
    dry: [0.10, 0.42],
    furrows: 0.68,
    ridges: [0.38, 0.30],
    shape: Shape::Straight,
};

/// The brushes, in the order of [`NAMES`].
const BRUSHES: [Brush; NAMES.len()] = [
    USUAL,
    Brush { hairs: 18.0, caps: [0.8, 0.55], ragged: 0.16, dry: [0.06, 0.36], shape: Shape::Belly, ..USUAL },
    Brush {
        hairs: 12.0,
        caps: [1.05, 1.05],
        ragged: 0.10,
        dry: [0.04, 0.25],
        furrows: 0.47,
        shape: Shape::Belly,
        ..USUAL
    },
    Brush { hairs: 26.0, ragged: 0.40, dry: [0.55, 1.0], shape: Shape::Fan, ..USUAL },
    Brush { hairs: 26.0, ragged: 0.40, dry: [0.55, 1.0], ..USUAL },
    Brush {
        hairs: 5.0,
        caps: [0.0, 0.0],
        ragged: 0.05,
        dry: [0.05, 0.22],
        furrows: 0.10,
        ridges: [0.55, 0.70],
        ..USUAL
    },
    Brush {
        hairs: 5.0,
        caps: [0.5, 0.4],
        ragged: 0.05,
        dry: [0.0, 0.12],
        furrows: 0.35,
        ridges: [0.30, 0.1],
        shape: Shape::Taper,
    },
];

pub(super) fn of_brush(index: usize, variant: u32) -> Mark {
    let brush = BRUSHES[index];
    let hairs = Hairs::new(brush, hash::combine(hash::of_name(NAMES[index]), variant));
    let mut texels = Vec::with_capacity(SIZE[0] * SIZE[1]);
    let us = (0..SIZE[0]).map(|column| Mark::uv(column)[0]);
    let columns: Vec<AlongHere> = us.map(|u| hairs.along(u, u.clamp(0.0, 1.0))).collect();
    for row in 0..SIZE[1] {
        let v = Mark::uv(row * SIZE[0])[1];
        let across = hairs.across(v);
        for here in &columns {
            texels.push(match brush.shape {
                // Spreading hairs shift u and v differently in every texel.
                Shape::Fan => {
                    let spread = v / (0.50 + 0.48 * here.along.powf(1.2));
                    hairs.texel(&hairs.along(here.u - 0.10 * v * v, here.along), &hairs.across(spread))
                }
                Shape::Straight | Shape::Belly | Shape::Taper => hairs.texel(here, &across),
            });
        }
    }
    Mark::store(&texels)
}

/// The noise of one mark.
struct Hairs {
    brush: Brush,
    streaks: Streaks,
    wander: Lattice,
    edges: [Lattice; 2],
    start_smooth: Lattice,
    start_hair: Lattice,
    end_smooth: Lattice,
    end_hair: Lattice,
}

impl Hairs {
    fn new(brush: Brush, seed: u32) -> Self {
        let line = |which: u32, cycles: f32| Lattice::line(hash::combine(seed, which), cycles);
        Self {
            brush,
            streaks: Streaks::new(hash::combine(seed, 1), brush.hairs),
            wander: line(2, 3.0),
            edges: [line(3, 9.0), line(4, 9.0)],
            start_smooth: line(5, 3.0),
            start_hair: line(6, brush.hairs),
            end_smooth: line(7, 3.0),
            end_hair: line(8, brush.hairs),
        }
    }

    /// What all texels at one `u` share. `along` is the place along the mark, 0..=1. It differs from `u` only at texels
    /// beyond the mark's ends, and where spreading hairs shift `u`.
    fn along(&self, u: f32, along: f32) -> AlongHere {
        let brush = &self.brush;
        let width = match brush.shape {
            Shape::Straight | Shape::Fan => 1.0,
            Shape::Belly => 1.0 - 0.16 * (2.0 * along - 1.0).abs().powi(4),
            Shape::Taper => 0.92 - 0.80 * along.powf(1.3),
        };
        AlongHere {
            u,
            along,
            // Equal at both ends, so that the mark as a whole stays straight.
            wander: (0.5 * (self.wander.along(u) + self.wander.along(1.0 - u)) - 0.5) * 0.10,
            widths: [0, 1].map(|side| width + (self.edges[side].along(u) - 0.5) * 0.10),
            dryness: brush.dry[0] + (brush.dry[1] - brush.dry[0]) * along.powf(1.6),
            columns: self.streaks.columns(u),
        }
    }

    /// What all texels at one `v` share.
    fn across(&self, v: f32) -> AcrossHere {
        let across = v * 0.5 + 0.5;
        AcrossHere {
            v,
            cap: 1.0 - (1.0 - (v * v).min(1.0)).sqrt(),
            start: [0.06 * self.start_smooth.along(across), 0.045 * self.start_hair.along(across)],
            ragged: self.brush.ragged
                * (0.7 * self.end_hair.along(across) + 0.3 * self.end_smooth.along(across)),
            hairs: self.streaks.hairs(across),
            rows: self.streaks.rows(across),
        }
    }

    fn texel(&self, here: &AlongHere, over: &AcrossHere) -> Texel {
        let (brush, u, v) = (&self.brush, here.u, over.v);
        let side = here.widths[usize::from(v > 0.0)] - (v - here.wander).abs();
        let start = (u - over.start[0] - over.start[1]) * ASPECT - brush.caps[0] * over.cap;
        let end = (1.0 - u - over.ragged) * ASPECT - brush.caps[1] * over.cap;
        let inside = (start / 0.4).min(end / 0.68).min(side / 0.16).clamp(0.0, 1.0);
        let (streaks, mixed) = self.streaks.between(&here.columns, &over.rows, over.hairs);
        let paint = inside * (1.0 - here.dryness * (1.0 - streaks) * 1.25).max(0.0);
        let tint = 0.6 * mixed + 0.4 * (streaks * 2.0 - 1.0);
        let covered = smoothstep((paint - 0.05) / 0.30);
        if covered == 0.0 {
            return Texel { paint, height: 0.0, tint };
        }
        let bell = |x: f32, middle: f32, width: f32| (-((x - middle) / width).powi(2)).exp();
        let rim = bell(side, 0.07, 0.06);
        let pile = bell(end, 0.13, 0.12) * (0.5 + 0.7 * streaks);
        let body = 0.50 - 0.20 * here.along
            + brush.furrows * (streaks - 0.5)
            + brush.ridges[0] * rim * (1.0 - 0.5 * here.along)
            + brush.ridges[1] * pile;
        Texel { paint, height: body.max(0.0) * covered, tint }
    }
}

struct AlongHere {
    u: f32,
    along: f32,
    wander: f32,
    /// Half widths: from the middle to either edge.
    widths: [f32; 2],
    dryness: f32,
    columns: [Between; STREAKS],
}

struct AcrossHere {
    v: f32,
    cap: f32,
    start: [f32; 2],
    ragged: f32,
    hairs: f32,
    rows: [Between; STREAKS],
}

/// How many lattices vary along the mark as well as across it: three for the paint, one for how far another colour is
/// mixed in.
const STREAKS: usize = 4;

pub(super) struct Streaks {
    /// The last one says how far another colour is mixed in.
    along: [Lattice; STREAKS],
    hairs: [Lattice; 3],
}

impl Streaks {
    pub(super) fn new(seed: u32, hairs: f32) -> Self {
        let field = |which: u32, cycles: [f32; 2]| Lattice::new(hash::combine(seed, which), cycles);
        Self {
            along: [
                field(1, [2.2, 1.3 * hairs]),
                field(2, [5.0, 2.2 * hairs]),
                field(3, [14.0, 2.6 * hairs]),
                field(9, [1.2, hairs / 3.0]),
            ],
            hairs: [1.0, 2.0, 4.0].map(|times| field(4 + times as u32, [times * hairs, 0.0])),
        }
    }

    /// How much paint the hairs carry here, about 0..1, and how far another colour is mixed in, −1..1.
    pub(super) fn at(&self, u: f32, across: f32) -> (f32, f32) {
        self.between(&self.columns(u), &self.rows(across), self.hairs(across))
    }

    fn columns(&self, u: f32) -> [Between; STREAKS] {
        std::array::from_fn(|which| self.along[which].column(u))
    }

    fn rows(&self, across: f32) -> [Between; STREAKS] {
        std::array::from_fn(|which| self.along[which].row(across))
    }

    /// How much paint the hairs carry at a place across the brush, the same over the whole length of the mark.
    fn hairs(&self, across: f32) -> f32 {
        0.4 * self.hairs[0].along(across)
            + 0.35 * self.hairs[1].along(across)
            + 0.25 * self.hairs[2].along(across)
    }

    fn between(&self, columns: &[Between; STREAKS], rows: &[Between; STREAKS], hairs: f32) -> (f32, f32) {
        let noise = |which: usize| self.along[which].between(columns[which], rows[which]);
        let along = 0.55 * noise(0) + 0.30 * noise(1) + 0.15 * noise(2);
        (0.6 * along + 0.4 * hairs, noise(3) * 2.0 - 1.0)
    }
}
