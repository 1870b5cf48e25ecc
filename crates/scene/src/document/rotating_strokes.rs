//! The style of brush strokes, as a scene file states it: how strokes turn, and what the paint and its canvas look
//! like.

use serde::{Deserialize, Serialize};

use super::numbers::usual_fields;
use super::style_settings::{CanvasFollows, Preparation, SettingRule, Solver, StyleInfo, StyleSettings};
use crate::limits::MAX_STRENGTH;

usual_fields! {
    /// Brush strokes: how they turn, and what the paint and its canvas look like.
    pub struct RotatingStrokes {
        /// How the turn is found.
        pub solver: Solver = Solver::Tangent; saved always,
        /// Large thin strokes under the body layer, so that no hole shows the ground.
        pub underpainting: bool = true,
        /// What is painted on.
        pub canvas: Canvas = Canvas::Linen,
        /// How much of the canvas is felt where paint is thin.
        pub weave: f64 = 1.0; within 0.0..=MAX_STRENGTH,
        /// What the canvas moves with.
        pub canvas_follows: CanvasFollows = CanvasFollows::Picture,
        /// How much the paint stands up: 0 flat, 1 oil paint.
        pub relief: f64 = 1.0; within 0.0..=MAX_STRENGTH,
        /// Deeper darks and fuller colour: 0 none, 1 thin.
        pub varnish: f64 = 1.0; within 0.0..=MAX_STRENGTH,
    }
}

/// What is painted on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
pub enum Canvas {
    /// A smooth board.
    Board,
    /// Woven linen.
    #[default]
    Linen,
}

impl StyleSettings for RotatingStrokes {
    fn info(&self) -> &'static StyleInfo {
        &StyleInfo {
            name: "RotatingStrokes",
            file_name: "rotating_strokes",
            alias: None,
            label: "Strokes",
            summary: "Brush strokes",
            preset: None,
        }
    }

    fn preparation(&self) -> Preparation {
        Preparation {
            has_strokes: true,
            solver: self.solver,
            underpainting: self.underpainting,
            weave: if self.canvas == Canvas::Linen { self.weave } else { 0.0 },
            canvas_follows: self.canvas_follows,
            relief: self.relief,
            varnish: self.varnish,
        }
    }

    fn rules(&self) -> Vec<SettingRule> {
        Self::numbers().map(|number| SettingRule::range(number, self)).collect()
    }
}
