//! Brush strokes as a scene file states them: how they turn, and what the paint is like as a body.

use serde::Deserialize;

use super::style_settings::{CanvasFollows, Preparation, SettingRule, Solver, StyleInfo, StyleSettings};
use crate::limits::MAX_STRENGTH;

/// Brush strokes: how they turn, and what the paint is like as a body.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct RotatingStrokes {
    /// How the turn is found.
    pub solver: Solver,
    /// Large thin strokes under the body layer, so that no hole shows the ground.
    pub underpainting: bool,
    /// What is painted on.
    pub canvas: Canvas,
    /// How much of the canvas is felt where paint is thin, 0 and up; 1 is quiet linen.
    pub weave: f64,
    /// What the canvas moves with.
    pub canvas_follows: CanvasFollows,
    /// How much the paint stands up, 0 flat; 1 oil paint.
    pub relief: f64,
    /// A coat over the finished picture: deeper darks, fuller colour; 0 none, 1 thin.
    pub varnish: f64,
}

/// What is painted on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub enum Canvas {
    /// A smooth board.
    Board,
    /// Woven linen.
    #[default]
    Linen,
}

impl Default for RotatingStrokes {
    fn default() -> Self {
        Self {
            solver: Solver::default(),
            underpainting: true,
            canvas: Canvas::default(),
            weave: 1.0,
            canvas_follows: CanvasFollows::default(),
            relief: 1.0,
            varnish: 1.0,
        }
    }
}

impl RotatingStrokes {
    /// The names of the fields in a scene file.
    pub(crate) const FIELDS: &'static [&'static str] =
        &["solver", "underpainting", "canvas", "weave", "canvas_follows", "relief", "varnish"];
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
        [("weave", self.weave), ("relief", self.relief), ("varnish", self.varnish)]
            .map(|(field, value)| SettingRule::Range { field, value, most: MAX_STRENGTH })
            .to_vec()
    }
}
