//! The style of brush strokes, as a scene file states it: how strokes turn, and what the paint and its canvas look
//! like.

use serde::{Deserialize, Serialize};

use super::numbers::usual_fields;
use super::style_settings::{CanvasFollows, Preparation, SettingRule, Solver, StyleInfo, StyleSettings};
use crate::aovs::AovSet;
use crate::limits::MAX_STRENGTH;

usual_fields! {
    /// Brush strokes: how they turn, and what the paint and its canvas look like.
    pub struct RotatingStrokes {
        /// How the turn is found.
        pub solver: Solver = Solver::Tangent; saved always,
        /// A tone and large thin strokes under the body layer, so that no hole shows the background.
        pub underpainting: bool = true,
        /// What is painted on.
        pub canvas: Canvas = Canvas::Linen,
        /// How much of the canvas is felt where paint is thin.
        pub weave: f64 = 1.0; within 0.0..=MAX_STRENGTH,
        /// What the canvas moves with.
        pub canvas_follows: CanvasFollows = CanvasFollows::Picture,
        /// Samples along each side of a pixel of the picture: 1, 2 or 4. With more than 1, paint can end within a
        /// pixel, and thin things are steady. Drafts have 1.
        pub samples: u32 = 2,
        /// How much the paint stands up: 0 flat, 1 oil paint.
        pub relief: f64 = 1.0; within 0.0..=MAX_STRENGTH,
        /// Deeper darks and fuller colour: 0 none, 1 thin.
        pub varnish: f64 = 1.0; within 0.0..=MAX_STRENGTH,
    }
}

/// The numbers of samples that a pixel may have along each side.
pub const SAMPLES: [u32; 3] = [1, 2, 4];

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
            lays_touches: true,
            underpainting: self.underpainting,
            contour_and_lights: true,
            weave: if self.canvas == Canvas::Linen { self.weave } else { 0.0 },
            canvas_follows: self.canvas_follows,
            samples: self.samples,
            relief: self.relief,
            varnish: self.varnish,
        }
    }

    fn aovs(&self) -> AovSet {
        AovSet::ALL
    }

    fn rules(&self) -> Vec<SettingRule> {
        let mut rules: Vec<_> = Self::numbers().map(|number| SettingRule::range(number, self)).collect();
        if !SAMPLES.contains(&self.samples) {
            rules.push(SettingRule::Broken {
                field: "samples",
                message: "a pixel has 1, 2 or 4 samples a side",
                mend: "write samples: 2",
            });
        }
        rules
    }
}
