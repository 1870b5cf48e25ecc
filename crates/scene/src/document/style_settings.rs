//! What every style says about itself, so that all other code can treat styles alike.

use std::ops::RangeInclusive;

use serde::{Deserialize, Serialize};

use super::numbers::Number;
use crate::aovs::AovSet;

/// The settings of a style. Other code asks about a style only through this trait.
pub trait StyleSettings {
    /// Names and words, the same for every scene in this style.
    fn info(&self) -> &'static StyleInfo;

    /// How a scene is prepared for this style.
    fn preparation(&self) -> Preparation {
        Preparation::default()
    }

    /// What EXR files of this style can hold beside the colour.
    fn aovs(&self) -> AovSet {
        AovSet::OF_SCENE
    }

    /// The rules that the settings must meet, in the order in which they are reported.
    fn rules(&self) -> Vec<SettingRule> {
        Vec::new()
    }
}

/// Names and words of a style.
#[derive(Debug, PartialEq, Eq)]
pub struct StyleInfo {
    /// Its name in scene files.
    pub name: &'static str,
    /// Its name on the command line; its own files and folders are called the same.
    pub file_name: &'static str,
    /// Another spelling that the command line takes.
    pub alias: Option<&'static str>,
    /// Its name in the editor.
    pub label: &'static str,
    /// What it looks like, in a few words.
    pub summary: &'static str,
    /// The stroke preset of scenes that name none; `None` for the usual one.
    pub preset: Option<&'static str>,
}

/// How a scene is prepared for a style.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Preparation {
    /// Whether strokes are painted at all.
    pub has_strokes: bool,
    /// How the turn of a stroke is found.
    pub solver: Solver,
    /// Whether strokes that were placed by hand are painted.
    pub lays_touches: bool,
    /// Whether there are large thin strokes and a tone under the body layer.
    pub underpainting: bool,
    /// Whether contours and highlights are drawn by layers of their own.
    pub contour_and_lights: bool,
    /// How much of the canvas is felt where paint is thin; 0 for a smooth board.
    pub weave: f64,
    /// What the canvas, or the paper, moves with.
    pub canvas_follows: CanvasFollows,
    /// How many samples a pixel has along each side.
    pub samples: u32,
    /// How much the paint stands up; 0 is flat.
    pub relief: f64,
    /// Strength of the varnish; 0 is none.
    pub varnish: f64,
}

/// A rule that a style's settings must meet.
#[derive(Clone, Debug, PartialEq)]
pub enum SettingRule {
    /// The number in this field lies within its limits.
    Range {
        /// The field.
        field: &'static str,
        /// The number.
        value: f64,
        /// The values that a scene file may give.
        limits: RangeInclusive<f64>,
    },
    /// The three numbers in this field are a direction: not all of them are 0.
    Direction {
        /// The field.
        field: &'static str,
        /// The direction.
        value: [f64; 3],
    },
    /// A rule of the style's own, which is broken.
    Broken {
        /// The field.
        field: &'static str,
        /// What is wrong.
        message: &'static str,
        /// What to do about it.
        mend: &'static str,
    },
}

impl SettingRule {
    /// The rule that a number of these settings lies within its limits.
    pub(crate) fn range<T>(number: &Number<T>, settings: &T) -> Self {
        Self::Range { field: number.field, value: (number.get)(settings), limits: number.limits.clone() }
    }
}

/// What the canvas moves with.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
pub enum CanvasFollows {
    /// It stands still, as a picture on an easel.
    #[default]
    Picture,
    /// It moves, turns and scales with the point that the camera looks at in the reference pose.
    Camera,
}

/// How the turn of a stroke is found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
pub enum Solver {
    /// From the surface's tangent plane, in closed form.
    #[default]
    Tangent,
    /// The source paper's estimate over neighbours, depth-weighted, baked once.
    Horn,
    /// The source paper's full sum over neighbours in every frame.
    HornExact,
}

impl Default for Preparation {
    /// For a style without strokes.
    fn default() -> Self {
        Self {
            has_strokes: false,
            solver: Solver::default(),
            lays_touches: false,
            underpainting: true,
            contour_and_lights: true,
            weave: 0.0,
            canvas_follows: CanvasFollows::default(),
            samples: 1,
            relief: 0.0,
            varnish: 0.0,
        }
    }
}
