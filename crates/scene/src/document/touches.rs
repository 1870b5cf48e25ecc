//! Touches: strokes that were placed by hand, as a scene file states them.

use serde::{Deserialize, Serialize};

use super::{Color, is_default, is_one, one};

/// One stroke that was placed by hand. It lies where it was put, over all other paint of its object, and moves with the surface.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Touch {
    /// Unique.
    pub name: String,
    /// The object that it lies on.
    pub on: String,
    /// Where it goes, in the object's own space: it runs smoothly through two or more places; at a single one it lies along the
    /// strokes round it.
    pub points: Vec<TouchPoint>,
    /// How wide it is, pixels at the scene's size, from 1 to 400, however near the camera is.
    #[serde(default = "TouchSize::width")]
    pub width_px: f64,
    /// How long it is if it has a single place, pixels at the scene's size, from 1 to 4000.
    #[serde(default = "TouchSize::length", skip_serializing_if = "TouchSize::is_length")]
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

/// The size of a touch that states none.
pub struct TouchSize {
    /// Pixels at the scene's size.
    pub width_px: f64,
    /// Pixels at the scene's size.
    pub length_px: f64,
}

/// The size of a touch that states none.
pub const TOUCH_SIZE: TouchSize = TouchSize { width_px: 14.0, length_px: 48.0 };

impl TouchSize {
    fn width() -> f64 {
        TOUCH_SIZE.width_px
    }

    fn length() -> f64 {
        TOUCH_SIZE.length_px
    }

    fn is_length(length_px: &f64) -> bool {
        *length_px == TOUCH_SIZE.length_px
    }
}

impl Touch {
    /// A touch of the usual looks.
    pub fn new(name: impl Into<String>, on: impl Into<String>, points: Vec<TouchPoint>) -> Self {
        Self {
            name: name.into(),
            on: on.into(),
            points,
            width_px: TOUCH_SIZE.width_px,
            length_px: TOUCH_SIZE.length_px,
            color: None,
            opacity: 1.0,
            taper: 0.0,
            brush: None,
            hidden: false,
        }
    }
}
