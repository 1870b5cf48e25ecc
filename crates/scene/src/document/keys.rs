//! Keys: values that a scene file states for single frames. The keys of the camera and of objects are poses, declared
//! in `document` itself; here are the keys of lights, of the background and of strokes.

use serde::{Deserialize, Serialize};

use super::{CameraKey, Color, Ease, ObjectKey, is_default, is_one, one};

/// What all kinds of keys have in common.
pub trait Key: Clone {
    /// The frame; need not be whole.
    fn frame(&self) -> f64;
    /// How values move from this key to the next.
    fn ease(&self) -> Ease;
    /// Moves it to another frame.
    fn set_frame(&mut self, frame: f64);
    /// Sets how values move from this key to the next.
    fn set_ease(&mut self, ease: Ease);
}

macro_rules! keys {
    ($($kind:ty),+) => {
        $(impl Key for $kind {
            fn frame(&self) -> f64 {
                self.frame
            }
            fn ease(&self) -> Ease {
                self.ease
            }
            fn set_frame(&mut self, frame: f64) {
                self.frame = frame;
            }
            fn set_ease(&mut self, ease: Ease) {
                self.ease = ease;
            }
        })+
    };
}

keys!(BackgroundKey, CameraKey, LightKey, ObjectKey, StrokesKey);

/// The values of a light at a frame. A value that is left out stays as it was at the key before. At the keys before the
/// first that states a value, the light has its own value; if it states none, it has that key's value from the start.
/// Before its first key a light is as at that key.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct LightKey {
    /// The frame; need not be whole.
    pub frame: f64,
    /// Multiplies the colour, from 0 to 1000000.
    #[serde(default, skip_serializing_if = "is_default")]
    pub intensity: Option<f64>,
    /// Colour; between keys, colours mix as light does.
    #[serde(default, skip_serializing_if = "is_default")]
    pub color: Option<Color>,
    /// `Ambient`: the colour from below.
    #[serde(default, skip_serializing_if = "is_default")]
    pub ground: Option<Color>,
    /// `Sun`, `Spot`: where the light travels to, world space, not zero; it turns evenly from key to key.
    #[serde(default, skip_serializing_if = "is_default")]
    pub direction: Option<[f64; 3]>,
    /// `Point`, `Spot`: where it stands, world space.
    #[serde(default, skip_serializing_if = "is_default")]
    pub position: Option<[f64; 3]>,
    /// How the values move from this key to the next.
    #[serde(default, skip_serializing_if = "is_default")]
    pub ease: Ease,
}

/// The background at a frame.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct BackgroundKey {
    /// The frame; need not be whole.
    pub frame: f64,
    /// The colour; between keys, colours mix as light does.
    pub color: Color,
    /// How it moves from this key to the next.
    #[serde(default, skip_serializing_if = "is_default")]
    pub ease: Ease,
}

/// How the strokes of a scene or region are changed at a frame. Strokes come and go in the order of their fixed ranks,
/// so none pops.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct StrokesKey {
    /// The frame; need not be whole.
    pub frame: f64,
    /// Multiplies length and width, from 0.05 to 20.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub size: f64,
    /// Multiplies the coverage, from 0 to 4.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub coverage: f64,
    /// How far the brushes are dried, from 0, as dry as each layer states, to 1, quite dry.
    #[serde(default, skip_serializing_if = "is_default")]
    pub dryness: f64,
    /// How far colours keep to the palette, from 0, not at all, to 1, wholly.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub palette_mix: f64,
    /// How the values move from this key to the next.
    #[serde(default, skip_serializing_if = "is_default")]
    pub ease: Ease,
}

impl StrokesKey {
    /// A key at a frame that changes nothing.
    pub fn at(frame: f64) -> Self {
        Self { frame, size: 1.0, coverage: 1.0, dryness: 0.0, palette_mix: 1.0, ease: Ease::default() }
    }
}

impl LightKey {
    /// A key at a frame that states nothing.
    pub fn at(frame: f64) -> Self {
        Self {
            frame,
            intensity: None,
            color: None,
            ground: None,
            direction: None,
            position: None,
            ease: Ease::default(),
        }
    }
}
