//! Commands on the scene as a whole: size, seed, ground, background, exposure and style.

use impasto_scene::document::{Color, Object, Scene, Style};
use impasto_scene::loaded::LoadedScene;
use impasto_scene::new_scene::Ground;

use super::Done;
use super::edit::delete_object;
use super::region::in_file;
use crate::refusal::Refusal;

/// Size, seed, ground, background, exposure and style.
#[derive(Clone, Debug, PartialEq)]
#[expect(clippy::large_enum_variant, reason = "edits are made one at a time")]
pub enum SceneEdit {
    /// Sets the picture's width and height in pixels. Stroke sizes are stated for a picture of this size.
    SetSize(u32, u32),
    /// Sets the seed of all random choices.
    SetSeed(u32),
    /// Sets what the objects stand on. The scene's first ground is removed, with its regions and everything that is
    /// painted on it. The new ground gets the colour of the old one. Children of the old ground move to its parent.
    SetGround(Ground),
    /// Sets the background: what shows where nothing is painted.
    SetBackground(Color),
    /// Sets the stops by which all lights are brightened.
    SetExposure(f64),
    /// Sets the style, with a text of what changed: *Canvas: linen*.
    SetStyle(Style, String),
}

impl SceneEdit {
    pub(super) fn edit(&self, scene: &mut Scene, before: &LoadedScene) -> Result<Done, Refusal> {
        match self {
            Self::SetSize(width, height) => {
                scene.size = (*width, *height);
                Ok(Done::new(format!("Size {width} × {height}")))
            }
            Self::SetSeed(seed) => {
                scene.seed = *seed;
                Ok(Done::new(format!("Seed {seed}")))
            }
            Self::SetGround(ground) => set_ground(scene, before, *ground),
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

fn set_ground(scene: &mut Scene, before: &LoadedScene, ground: Ground) -> Result<Done, Refusal> {
    let is_ground = |object: &&Object| Ground::of_object(object).is_some();
    let old = scene.objects.iter().find(is_ground).cloned();
    if let Some(object) = &old {
        delete_object(scene, &object.name)?;
    }
    let color = old.and_then(|object| object.material?.color);
    ground.lay_under(scene, &before.meshes, color).map_err(|why| Refusal::new(why.to_string()))?;
    let word = Ground::ALL.iter().find(|(_, other)| *other == ground).map_or("", |(word, _)| word);
    Ok(Done::new(format!("Ground: {word}")))
}
