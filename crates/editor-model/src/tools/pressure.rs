//! What the pressure of a pen does to a gesture. A pointer without pressure counts as pressure 1, which changes no bit
//! of the result.

use super::{Surroundings, amounts};
use crate::path::{PathPoint, SurfacePath};
use crate::session::{Pressure, ToolOptions};

/// The lightest touch of a pen gives this share of the radius or strength, so that no gesture is lost.
const LEAST: f64 = 0.05;

/// The factors by which pressure scales a brush.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Felt {
    pub(super) radius: f64,
    pub(super) strength: f64,
}

impl Felt {
    pub(super) fn of(pressure: f64, options: &ToolOptions) -> Self {
        let share = pressure.clamp(LEAST, 1.0);
        match options.pressure {
            Pressure::Off => Self { radius: 1.0, strength: 1.0 },
            Pressure::Radius => Self { radius: share, strength: 1.0 },
            Pressure::Strength => Self { radius: 1.0, strength: share },
        }
    }

    /// The factors of a whole gesture: those of its mean pressure, to a hundredth, so that a saved number stays short.
    pub(super) fn of_path(path: &SurfacePath, options: &ToolOptions) -> Self {
        Self::of((path.mean_pressure() * 100.0).round() / 100.0, options)
    }

    pub(super) fn at(point: &PathPoint, options: &ToolOptions) -> Self {
        Self::of(point.pressure, options)
    }

    /// `strength` scaled, and rounded for the scene unless the factor is 1.
    pub(super) fn strength(self, strength: f64) -> f64 {
        if self.strength == 1.0 { strength } else { amounts::short(strength * self.strength, 1.0) }
    }

    /// The options with the radius scaled, for the ring of the brush.
    pub(super) fn options(self, around: &Surroundings) -> ToolOptions {
        ToolOptions { radius_px: around.options.radius_px * self.radius, ..around.options.clone() }
    }
}
