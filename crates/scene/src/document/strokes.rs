//! The table of stroke numbers: a number of `strokes: (…)` is one row here, and everything else follows from the row.

mod declare;

use std::ops::RangeInclusive;

use self::InspectorPlace::{Advanced, Main};
use self::declare::{angle, plain, stroke_numbers};
use super::numbers::number;
use super::{BrushMix, Color, Edges, LayerSettings, Number, ResolvedLayer, StrokesKey, is_default};
use crate::limits::{MAX_COVERAGE, MAX_LENGTH, MAX_STRENGTH, MAX_STROKE_PX};

/// A number of [`StrokeSettings`].
#[derive(Clone, Debug)]
pub struct StrokeNumber {
    /// Its name, its range in a scene file, what it does, and how to get and set it.
    pub number: Number<StrokeSettings, Option<f64>>,
    /// Its value once preset, scene and region are combined, in the units of a scene file.
    pub resolved: fn(&ResolvedStrokes) -> f64,
    /// How an inspector shows it.
    pub shown: Shown,
}

/// How an inspector shows a number.
#[derive(Clone, Debug)]
pub struct Shown {
    /// What people call it: *Length*.
    pub label: &'static str,
    /// Shown behind the value.
    pub unit: &'static str,
    /// Factor from the value shown to the value in the file.
    pub file_per_shown: f64,
    /// The range of a drag, as shown. Typed values may go as far as the limits of a scene file.
    pub drag: RangeInclusive<f64>,
    /// One step of the wheel or of an arrow key, as shown.
    pub step: f64,
    /// Digits behind the point.
    pub decimals: usize,
    /// Where it stands.
    pub place: InspectorPlace,
}

/// Where a number stands in the inspector, counted from the top.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum InspectorPlace {
    /// Seen at once.
    Main(u8),
    /// Under Advanced.
    Advanced(u8),
}

/// Starting points for rows, one for each kind of number; a row states what differs.
const PIXELS: Shown = Shown {
    label: "",
    unit: "px",
    file_per_shown: 1.0,
    drag: 0.0..=100.0,
    step: 1.0,
    decimals: 0,
    place: Main(0),
};
const DEGREES: Shown = Shown { unit: "°", drag: 0.0..=45.0, ..PIXELS };
const PERCENT: Shown = Shown { unit: "%", file_per_shown: 0.01, step: 5.0, ..PIXELS };
const FACTOR: Shown = Shown { unit: "×", drag: 0.0..=8.0, step: 0.1, decimals: 1, ..PIXELS };

// A row has
// - a comment of a sentence or two: what the number does, for the inspector and for `docs/scene_file.md`;
// - its field in a scene file => its field in `ResolvedStrokes`, as `plain` (the same number) or as an `angle` (degrees
//   in the file, radians once resolved);
// - `usual`: its value in the default preset, and in every preset that says nothing else (`presets/table.rs`);
// - `limits`: the values that a scene file may give;
// - `shown`: how the inspector shows it. `place` is where it stands there: `Main(3)` is third from the top,
//   `Advanced(3)` third under Advanced.
//
// `body` holds the sizes of the body layer, which `presets.rs` resolves by hand; `form` how a stroke lies on its
// surface; `color` its colour. `CONTRIBUTING.md` says what else a new row needs.
stroke_numbers! {
    body {
        /// How long strokes of the body layer are in the picture, pixels at the scene's size. Strokes of other layers
        /// keep their shape, and their area changes in proportion to that of body strokes.
        length_px {
            limits: 0.001..=MAX_STROKE_PX,
            resolved: |strokes| f64::from(strokes.body().length_px),
            shown: Shown { label: "Length", drag: 4.0..=160.0, place: Main(1), ..PIXELS },
        }
        /// How wide strokes of the body layer are in the picture, pixels at the scene's size; other layers follow as
        /// with the length.
        width_px {
            limits: 0.001..=MAX_STROKE_PX,
            resolved: |strokes| f64::from(strokes.body().width_px),
            shown: Shown { label: "Width", drag: 1.0..=60.0, place: Main(2), ..PIXELS },
        }
        /// Makes the strokes of all layers larger or smaller; 1 leaves them.
        scale {
            limits: 0.01..=100.0,
            resolved: |_| 1.0,
            shown: Shown { label: "Scale", drag: 0.1..=4.0, step: 0.05, decimals: 2, place: Advanced(1), ..FACTOR },
        }
        /// How many strokes of the body layer lie over each other; under 1, what lies below them shows.
        coverage {
            limits: 0.001..=MAX_COVERAGE,
            resolved: |strokes| f64::from(strokes.body().coverage),
            shown: Shown { label: "Coverage", place: Main(3), ..FACTOR },
        }
    }
    form {
        /// 1 keeps strokes flat on the picture, 0 lets them follow the surface.
        flatness => flatness as plain {
            usual: 1.0,
            limits: 0.0..=1.0,
            shown: Shown {
                label: "Flatness", unit: "2D", drag: 0.0..=1.0, step: 0.05, decimals: 2, place: Main(4), ..PIXELS
            },
        }
        /// How far strokes shrink where the form is small, as at eyes, fingers and handles; 0 keeps them at their size.
        fit => fit as plain {
            usual: 1.0,
            limits: 0.0..=1.0,
            shown: Shown { label: "Fit to form", drag: 0.0..=100.0, place: Advanced(11), ..PERCENT },
        }
        /// How far strokes stand off the surface, in units of the object.
        offset => offset as plain {
            usual: 0.0,
            limits: -MAX_LENGTH..=MAX_LENGTH,
            shown: Shown {
                label: "Offset", unit: "u", drag: 0.0..=1.0, step: 0.01, decimals: 3, place: Advanced(8), ..PIXELS
            },
        }
        /// 0 keeps strokes at their size in the picture, 100 % at their size on the surface.
        size_follow => size_follow as plain {
            usual: 0.0,
            limits: 0.0..=1.0,
            shown: Shown { label: "Size follows", place: Advanced(7), ..PERCENT },
        }
        /// How much narrower strokes end than they start; 100 % ends in a point, -100 % starts in one.
        taper => taper as plain {
            usual: 0.0,
            limits: -1.0..=1.0,
            shown: Shown { label: "Taper", drag: -100.0..=100.0, place: Advanced(5), ..PERCENT },
        }
        /// How far strokes turn to their left from start to end; below 0 to their right. In the middle they keep their
        /// direction.
        bend_deg => bend_rad as angle {
            usual: 0.0,
            limits: -180.0..=180.0,
            shown: Shown { label: "Bend", drag: -180.0..=180.0, step: 5.0, place: Advanced(6), ..DEGREES },
        }
        /// How far strokes stray from their direction, each on its own: the standard deviation.
        angle_jitter_deg => angle_jitter_rad as angle {
            usual: 7.0,
            limits: 0.0..=180.0,
            shown: Shown { label: "Angle jitter", place: Main(5), ..DEGREES },
        }
        /// A slow swing of the direction over the surface: its standard deviation.
        swing_deg => swing_rad as angle {
            usual: 6.0,
            limits: 0.0..=180.0,
            shown: Shown { label: "Swing", place: Advanced(2), ..DEGREES },
        }
        /// How far strokes near the limb, the visible edge of a body, lie along it. This part of their direction
        /// follows the view.
        contour => contour as plain {
            usual: 0.0,
            limits: 0.0..=1.0,
            shown: Shown { label: "Contour", place: Advanced(3), ..PERCENT },
        }
        /// How much sizes differ from stroke to stroke: the standard deviation.
        size_jitter => size_jitter as plain {
            usual: 0.16,
            limits: 0.0..=1.0,
            shown: Shown { label: "Size jitter", place: Advanced(4), ..PERCENT },
        }
        /// Lays the strokes anew as the film runs, each a little elsewhere, as painted films do; 0 keeps them still.
        boil => boil as plain {
            usual: 0.0,
            limits: 0.0..=1.0,
            shown: Shown { label: "Boil", place: Advanced(12), ..PERCENT },
        }
        /// For how many frames strokes hold before they are laid anew: 2 is on twos.
        boil_on => boil_on as plain {
            usual: 2.0,
            limits: 1.0..=1000.0,
            shown: Shown { label: "Boil on", unit: "frames", drag: 1.0..=12.0, place: Advanced(13), ..PIXELS },
        }
    }
    color {
        /// How much colours differ from stroke to stroke; 100 % as oil paint is mixed.
        color_jitter => color_jitter as plain {
            usual: 1.0,
            limits: 0.0..=MAX_STRENGTH,
            shown: Shown { label: "Colour jitter", drag: 0.0..=200.0, place: Main(6), ..PERCENT },
        }
        /// How much warmer lights and cooler shadows are than in the plain render.
        temperature => temperature as plain {
            usual: 1.0,
            limits: 0.0..=MAX_STRENGTH,
            shown: Shown { label: "Temperature", drag: 0.0..=200.0, place: Advanced(9), ..PERCENT },
        }
        /// How far colours are pulled to a painter's values: planes of one value, rich darks.
        grading => grading as plain {
            usual: 1.0,
            limits: 0.0..=1.0,
            shown: Shown { label: "Grading", place: Advanced(10), ..PERCENT },
        }
    }
}

impl StrokeNumber {
    /// A number by its field in a scene file.
    pub fn named(field: &str) -> Option<&'static Self> {
        STROKE_NUMBERS.iter().find(|row| row.number.field == field)
    }

    /// The limits of what may be typed, in the units shown.
    pub fn limits_shown(&self) -> RangeInclusive<f64> {
        let shown = |value: f64| value / self.shown.file_per_shown;
        shown(*self.number.limits.start())..=shown(*self.number.limits.end())
    }
}
