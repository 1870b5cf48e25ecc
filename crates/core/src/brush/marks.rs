//! The marks of the brushes that come with Impasto.

use super::lattice::Lattice;
use super::{Mark, NAMES, SIZE, Texel, VARIANTS};
use crate::hash;
use crate::presence::smoothstep;

/// Length of a mark in half widths: strokes are about three times as long as wide.
const ASPECT: f32 = 6.2;

/// What sets one brush apart from another.
#[derive(Clone, Copy)]
struct Brush {
    hairs: f32,
    /// Rounding of the loaded start and of the lifted end, half widths.
    caps: [f32; 2],
    /// How ragged the end is, shares of the length.
    ragged: f32,
    /// Dryness at the start and at the end.
    dry: [f32; 2],
    /// How much the hairs show in the paint's body.
    furrows: f32,
    /// Ridge of paint pushed aside along the edges, and where the brush lifts.
    ridges: [f32; 2],
    shape: Shape,
}

/// Outline of a brush.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Shape {
    /// As wide at its ends as in the middle.
    Straight,
    /// A little narrower towards its ends.
    Belly,
    /// Hairs that spread.
    Fan,
    /// Pointed.
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

/// In the order of [`NAMES`].
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

/// All marks of a brush.
pub(super) fn of_brush(index: usize) -> Vec<Mark> {
    let brush = BRUSHES[index];
    (0..VARIANTS)
        .map(|variant| {
            let stroke = Hairs::new(brush, hash::combine(hash::of_name(NAMES[index]), variant));
            let texels: Vec<Texel> = (0..SIZE[0] * SIZE[1])
                .map(|texel| {
                    let [u, v] = Mark::place(texel);
                    stroke.texel(u, v)
                })
                .collect();
            Mark::store(&texels)
        })
        .collect()
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

    fn texel(&self, u: f32, v: f32) -> Texel {
        let brush = &self.brush;
        let along = u.clamp(0.0, 1.0);
        let (u, v) = match brush.shape {
            Shape::Fan => (u - 0.10 * v * v, v / (0.50 + 0.48 * along.powf(1.2))),
            _ => (u, v),
        };
        let across = v * 0.5 + 0.5;
        let width = match brush.shape {
            Shape::Straight | Shape::Fan => 1.0,
            Shape::Belly => 1.0 - 0.16 * (2.0 * along - 1.0).abs().powi(4),
            Shape::Taper => 0.92 - 0.80 * along.powf(1.3),
        };
        // The same at both ends, so that a mark as a whole lies straight.
        let wander = (0.5 * (self.wander.along(u) + self.wander.along(1.0 - u)) - 0.5) * 0.10;
        let edge = (self.edges[usize::from(v > 0.0)].along(u) - 0.5) * 0.10;
        let side = width + edge - (v - wander).abs();
        let cap = 1.0 - (1.0 - (v * v).min(1.0)).sqrt();
        let start = (u - 0.06 * self.start_smooth.along(across) - 0.045 * self.start_hair.along(across))
            * ASPECT
            - brush.caps[0] * cap;
        let ragged = brush.ragged * (0.7 * self.end_hair.along(across) + 0.3 * self.end_smooth.along(across));
        let end = (1.0 - u - ragged) * ASPECT - brush.caps[1] * cap;
        let inside = (start / 0.4).min(end / 0.68).min(side / 0.16).clamp(0.0, 1.0);
        let streaks = self.streaks.at(u, across);
        let dryness = brush.dry[0] + (brush.dry[1] - brush.dry[0]) * along.powf(1.6);
        let paint = inside * (1.0 - dryness * (1.0 - streaks) * 1.25).max(0.0);
        let bell = |x: f32, middle: f32, width: f32| (-((x - middle) / width).powi(2)).exp();
        let rim = bell(side, 0.07, 0.06);
        let pile = bell(end, 0.13, 0.12) * (0.5 + 0.7 * streaks);
        let body = 0.50 - 0.20 * along
            + brush.furrows * (streaks - 0.5)
            + brush.ridges[0] * rim * (1.0 - 0.5 * along)
            + brush.ridges[1] * pile;
        let tint = 0.6 * self.streaks.mixed(u, across) + 0.4 * (streaks * 2.0 - 1.0);
        Texel { paint, height: body.max(0.0) * smoothstep((paint - 0.05) / 0.30), tint }
    }
}

/// Streaks that the hairs draw.
pub(super) struct Streaks {
    along: [Lattice; 3],
    hairs: [Lattice; 3],
    mixed: Lattice,
}

impl Streaks {
    pub(super) fn new(seed: u32, hairs: f32) -> Self {
        let field = |which: u32, cycles: [f32; 2]| Lattice::new(hash::combine(seed, which), cycles);
        Self {
            along: [
                field(1, [2.2, 1.3 * hairs]),
                field(2, [5.0, 2.2 * hairs]),
                field(3, [14.0, 2.6 * hairs]),
            ],
            hairs: [1.0, 2.0, 4.0].map(|times| field(4 + times as u32, [times * hairs, 0.0])),
            mixed: field(9, [1.2, hairs / 3.0]),
        }
    }

    /// How much paint the hairs carry here, about 0..1.
    pub(super) fn at(&self, u: f32, across: f32) -> f32 {
        let along = 0.55 * self.along[0].at(u, across)
            + 0.30 * self.along[1].at(u, across)
            + 0.15 * self.along[2].at(u, across);
        let hairs = 0.4 * self.hairs[0].along(across)
            + 0.35 * self.hairs[1].along(across)
            + 0.25 * self.hairs[2].along(across);
        0.6 * along + 0.4 * hairs
    }

    /// Half-mixed paint, −1..1.
    pub(super) fn mixed(&self, u: f32, across: f32) -> f32 {
        self.mixed.at(u, across) * 2.0 - 1.0
    }
}
