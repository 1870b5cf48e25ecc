//! The arguments that say which scene to read, and how a model without a scene is placed.

use std::path::PathBuf;

use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use impasto_scene::document::Up;
use impasto_scene::new_scene::{Ground, Placing, ViewFrom};

use crate::cache::CacheArguments;
use crate::failure::Failure;
use crate::memory_size::size_bytes;

/// How to read a scene.
#[derive(Args, Debug)]
pub(crate) struct SceneArguments {
    /// A scene (.ron), a model (.obj) or a shot (.glb, .gltf).
    pub(crate) scene: PathBuf,
    /// A further folder that meshes and textures may come from; can be repeated.
    #[arg(long = "asset-dir", value_name = "DIR")]
    pub(crate) asset_dirs: Vec<PathBuf>,
    /// Override a value of the scene, such as strokes.width_px=12; can be repeated.
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub(crate) set: Vec<String>,
    #[command(flatten)]
    pub(crate) placing: PlacingArguments,
    /// How many threads work; all cores when left out. The result is the same.
    #[arg(long, value_name = "N")]
    pub(crate) threads: Option<usize>,
    /// The most memory that particles may take, such as 512M or 4G; what the system has free when left out.
    #[arg(long, value_name = "SIZE", value_parser = size_bytes)]
    pub(crate) memory: Option<u64>,
    #[command(flatten)]
    pub(crate) cache: CacheArguments,
}

/// How a model without a scene is placed.
#[derive(Args, Clone, Copy, Debug, Default)]
pub(crate) struct PlacingArguments {
    /// Which axis of a model's file points up; found out when left out. A scene says it itself.
    #[arg(long, value_name = "AXIS", allow_hyphen_values = true, value_parser = named(&UP_CHOICES))]
    up: Option<UpChoice>,
    /// From which side a model is seen; auto, the default, takes the three-quarter view that shows the most of its
    /// form.
    #[arg(long, value_name = "SIDE", value_parser = named(&ViewFrom::ALL))]
    view: Option<ViewFrom>,
    /// What a model stands on: backdrop is a floor and a wall (the default), vignette a patch of floor, plain nothing.
    #[arg(long, value_name = "GROUND", value_parser = named(&Ground::ALL))]
    ground: Option<Ground>,
}

/// What `--up` may name.
#[derive(Clone, Copy, Debug)]
enum UpChoice {
    FoundOut,
    Stated(Up),
}

const UP_CHOICES: [(&str, UpChoice); 7] = {
    let mut choices = [("auto", UpChoice::FoundOut); 7];
    let mut index = 0;
    while index < Up::ALL.len() {
        choices[index + 1] = (Up::ALL[index].0, UpChoice::Stated(Up::ALL[index].1));
        index += 1;
    }
    choices
};

/// Reads one of these names as the value that it stands for.
fn named<T: Copy + Send + Sync + 'static>(
    choices: &'static [(&'static str, T)],
) -> impl TypedValueParser<Value = T> {
    PossibleValuesParser::new(choices.iter().map(|(name, _)| *name)).map(move |word| {
        let known = choices.iter().find(|(name, _)| *name == word);
        known.map_or(choices[0].1, |(_, value)| *value)
    })
}

impl PlacingArguments {
    /// The placing of this file. For a scene (.ron), any of these arguments is refused.
    pub(crate) fn of(self, scene: &std::path::Path) -> Result<Placing, Failure> {
        let is_scene = scene.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("ron"));
        if is_scene && (self.up.is_some() || self.view.is_some() || self.ground.is_some()) {
            let words =
                "--up, --view and --ground place a model; in a scene, change its objects and its camera";
            return Err(Failure::Usage(words.to_owned()));
        }
        let up = match self.up {
            Some(UpChoice::Stated(up)) => Some(up),
            Some(UpChoice::FoundOut) | None => None,
        };
        Ok(Placing { up, view: self.view.unwrap_or_default(), ground: self.ground.unwrap_or_default() })
    }
}
