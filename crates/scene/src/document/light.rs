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
    /// `Spot`: two angles from the cone's axis, degrees from 0 to 90. At the first the light begins to fade, at the
    /// second it ends. Left out, (0, 45).
    #[serde(default, skip_serializing_if = "is_default")]
    pub cone_deg: Option<[f64; 2]>,
    /// Colour; for `Ambient` the colour from above.
    #[serde(default = "Color::white", skip_serializing_if = "Color::is_white")]
    pub color: Color,
    /// `Ambient`: the colour from below; left out, `color`, dimmer and warmer.
    #[serde(default, skip_serializing_if = "is_default")]
    pub ground: Option<Color>,
    /// Multiplies the colour, from 0 to 1000000. At a distance of 1, a point light of intensity 1 lights a surface that
    /// faces it as brightly as a sun of intensity 1.
    #[serde(default = "one", skip_serializing_if = "is_one")]
    pub intensity: f64,
    /// Its values over time, frames strictly increasing.
    #[serde(default, skip_serializing_if = "is_default")]
    pub keys: Vec<LightKey>,
}

impl Light {
    /// The `cone_deg` of a `Spot` that states none, degrees.
    pub const USUAL_CONE_DEG: [f64; 2] = [0.0, 45.0];

    /// The light from below as a share of the light from above, for an `Ambient` light that states no `ground`: as if
    /// bounced off a warm floor. One share for each linear channel.
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
