//! Touches: strokes that were placed by hand, as a scene file states them.

use serde::{Deserialize, Serialize};

use super::{Color, is_default, is_one, one};

/// One stroke that was placed by hand. It lies where it was put, over all other paint of its object, and moves with the
/// surface.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Touch {
    /// Unique.
    pub name: String,
    /// The object that it lies on.
    pub on: String,
    /// The places of the touch, in the object's own space. A touch with two or more places runs smoothly through them;
    /// a touch at a single place lies along the strokes around it.
    pub points: Vec<TouchPoint>,
    /// How wide it is, pixels at the scene's size, from 1 to 400, however near the camera is.
    #[serde(default = "usual_width_px")]
    pub width_px: f64,
    /// How long it is if it has a single place, pixels at the scene's size, from 1 to 4000.
    #[serde(default = "usual_length_px", skip_serializing_if = "is_usual_length")]
    pub length_px: f64,
    /// Its colour, exactly; left out, the colour that strokes have there, which follows the light.
    #[serde(default, skip_serializing_if = "is_default")]
    pub color: Option<Color>,
    /// How far it covers what is below, from 0 to 1.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub opacity: f64,
    /// How much narrower it is at its end than at its start, from −1 to 1.
    #[serde(default, skip_serializing_if = "is_default")]
    pub taper: f64,
    /// The brush; left out, that of the body layer there.
    #[serde(default, skip_serializing_if = "is_default")]
    pub brush: Option<String>,
    /// Left out of the picture.
    #[serde(default, skip_serializing_if = "is_default")]
    pub hidden: bool,
}

/// A place of a touch; in the object's own space, so that it holds at any frame and survives a new mesh.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct TouchPoint {
    /// Where.
    pub at: [f64; 3],
    /// Normal of the surface there: the touch lies on the side that faces this way.
    pub normal: [f64; 3],
}

const fn usual_width_px() -> f64 {
    14.0
}

const fn usual_length_px() -> f64 {
    48.0
}

fn is_usual_length(length_px: &f64) -> bool {
    *length_px == Touch::USUAL_LENGTH_PX
}

impl Touch {
    /// The width of a touch that states none, pixels.
    pub const USUAL_WIDTH_PX: f64 = usual_width_px();

    /// The length of a touch at a single place that states none, pixels.
    pub const USUAL_LENGTH_PX: f64 = usual_length_px();

    /// A touch of the usual looks.
    pub fn new(name: impl Into<String>, on: impl Into<String>, points: Vec<TouchPoint>) -> Self {
        Self {
            name: name.into(),
            on: on.into(),
            points,
            width_px: Self::USUAL_WIDTH_PX,
            length_px: Self::USUAL_LENGTH_PX,
            color: None,
            opacity: 1.0,
            taper: 0.0,
            brush: None,
            hidden: false,
        }
    }
}
