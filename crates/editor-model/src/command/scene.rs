//! Commands on the scene as a whole: size, seed, background, exposure and style.

use impasto_scene::document::{Color, Scene, Style};

use super::Done;
use super::region::in_file;
use crate::refusal::Refusal;

/// Size, seed, background, exposure and style.
#[derive(Clone, Debug, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "edits are made one at a time")]
pub enum SceneEdit {
    /// Sets the picture's width and height in pixels. Stroke sizes are stated for a picture of this size.
    SetSize(u32, u32),
    /// Sets the seed of all random choices.
    SetSeed(u32),
    /// Sets the background: what shows where nothing is painted.
    SetBackground(Color),
    /// Sets the stops by which all lights are brightened.
    SetExposure(f64),
    /// Sets the style, with a text of what changed: *Canvas: linen*.
    SetStyle(Style, String),
}

impl SceneEdit {
    pub(super) fn edit(&self, scene: &mut Scene) -> Result<Done, Refusal> {
        match self {
            Self::SetSize(width, height) => {
                scene.size = (*width, *height);
                Ok(Done::new(format!("Size {width} × {height}")))
            }
            Self::SetSeed(seed) => {
                scene.seed = *seed;
                Ok(Done::new(format!("Seed {seed}")))
            }
            Self::SetBackground(color) => {
                scene.background = in_file(*color);
                Ok(Done::new("Background"))
            }
            Self::SetExposure(stops) => {
                scene.exposure = *stops;
                Ok(Done::new(format!("Exposure {stops:+}")))
            }
            Self::SetStyle(style, words) => {
                scene.style = style.clone();
                Ok(Done::new(words.clone()))
            }
        }
    }
}
