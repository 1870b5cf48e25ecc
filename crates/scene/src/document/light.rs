//! Lights, as a scene file states them.

use serde::{Deserialize, Serialize};

use super::{Color, LightKey, is_default, is_one, one};

/// A light with its name.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Light {
    /// Shown to people; unique.
    pub name: String,
    /// `Sun`, `Point`, `Spot` or `Ambient`.
    pub kind: LightKind,
    /// `Sun`, `Spot`: where the light travels to, world space, not zero.
    #[serde(default, skip_serializing_if = "is_default")]
    pub direction: Option<[f64; 3]>,
    /// `Point`, `Spot`: where it stands, world space.
    #[serde(default, skip_serializing_if = "is_default")]
    pub position: Option<[f64; 3]>,
    /// `Spot`: from its axis to where the light begins to fade, and to where it ends, degrees from 0 to 90; left out, (0, 45).
    #[serde(default, skip_serializing_if = "is_default")]
    pub cone_deg: Option<[f64; 2]>,
    /// Colour; for `Ambient` the colour from above.
    #[serde(default = "Color::white", skip_serializing_if = "Color::is_white")]
    pub color: Color,
    /// `Ambient`: the colour from below; left out, `color`, dimmer and warmer.
    #[serde(default, skip_serializing_if = "is_default")]
    pub ground: Option<Color>,
    /// Multiplies the colour, from 0 to 1000000. A point light of intensity 1 lights a facing surface at distance 1 as
    /// a sun of 1.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub intensity: f64,
    /// Its values over time, frames strictly increasing.
    #[serde(default, skip_serializing_if = "is_default")]
    pub keys: Vec<LightKey>,
}

impl Light {
    /// The `cone_deg` of a `Spot` that states none, degrees.
    pub const USUAL_CONE_DEG: [f64; 2] = [0.0, 45.0];

    /// How much of the light from above comes from below where an `Ambient` light states no `ground`, by linear channel:
    /// as if bounced off a warm floor.
    pub const OFF_THE_FLOOR: [f32; 3] = [0.5, 0.42, 0.34];

    /// A white light of intensity 1 without keys, from nowhere yet: suns need a direction, point lights a position.
    pub fn new(name: impl Into<String>, kind: LightKind) -> Self {
        Self {
            name: name.into(),
            kind,
            direction: None,
            position: None,
            cone_deg: None,
            color: Color::white(),
            ground: None,
            intensity: 1.0,
            keys: Vec::new(),
        }
    }
}

/// What kind of light.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub enum LightKind {
    /// Parallel light; the first one casts shadows.
    Sun,
    /// Light from a point, falling off with the square of the distance; without a sun, the brightest `Point` or `Spot`
    /// casts shadows.
    Point,
    /// As `Point`, into a cone with a soft edge.
    Spot,
    /// Light from all around: `color` from above, `ground` from below.
    Ambient,
}
