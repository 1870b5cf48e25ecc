//! Opening scenes with errors: as much as can be read, with the text for repairs.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use impasto_scene::document::Scene;
use impasto_scene::load::LoadOptions;
use impasto_scene::load::salvage::{self, Loss, Salvaged};
use impasto_scene::loaded::LoadedScene;
use impasto_scene::mesh_file::MeshFile;
use impasto_scene::problem::Report;

use super::Document;
use crate::history::History;
use crate::recovery::Copy;
use crate::stamp::Stamp;

/// The text of a scene that could not be read completely.
#[derive(Clone, Debug)]
pub struct Source {
    /// The text.
    pub text: String,
    /// What could not be read, in the order of the text.
    pub losses: Vec<Loss>,
    /// The scene as far as it was read.
    pub(super) scene: Scene,
    /// What stands in for meshes that cannot be used.
    stand_ins: BTreeMap<String, Arc<MeshFile>>,
}

impl Source {
    /// None where nothing was lost.
    pub(super) fn of(salvaged: &Salvaged) -> Option<Self> {
        let Salvaged { loaded, losses, text } = salvaged;
        let names = losses.iter().filter_map(|loss| loss.mesh.as_ref());
        let stand_in = |name: &String| Some((name.clone(), Arc::clone(loaded.meshes.get(name)?)));
        let stand_ins = names.filter_map(stand_in).collect();
        (!losses.is_empty()).then(|| Self {
            text: text.clone(),
            losses: losses.clone(),
            scene: loaded.scene.clone(),
            stand_ins,
        })
    }

    /// The scene with all stand-ins added, so that an edit can use them again.
    pub(super) fn held(&self, loaded: &LoadedScene) -> LoadedScene {
        let mut held = loaded.clone();
        for (name, stand_in) in &self.stand_ins {
            held.meshes.entry(name.clone()).or_insert_with(|| Arc::clone(stand_in));
        }
        held
    }
}

impl Document {
    /// Opens a scene as far as it can be read. While anything of it could not be, saving over its file is refused.
    ///
    /// # Errors
    /// Where there is nothing to open.
    pub fn open_with_problems(path: &Path, options: &LoadOptions) -> Result<Self, Report> {
        let whole = match Self::open(path, options) {
            Ok(document) => return Ok(document),
            Err(report) => report,
        };
        if !path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("ron")) {
            return Err(whole);
        }
        let stamp = Stamp::of(path);
        let salvaged = salvage::salvage(path, options)?;
        let source = Source::of(&salvaged).map(Arc::new);
        let document = Self::of(salvaged.loaded, Some(path.to_owned()), options.clone());
        Ok(Self { stamp, source, ..document })
    }

    /// Opens a copy of unsaved work, as an edited document. Files are found from the scene's original folder.
    ///
    /// # Errors
    /// Where nothing of the copy can be read.
    pub fn recovered(copy: &Copy, options: &LoadOptions) -> Result<Self, Report> {
        let salvaged = salvage::salvage_text(&copy.path, &copy.text, options)?;
        let source = Source::of(&salvaged).map(Arc::new);
        // A scene that was read with losses must not overwrite its file, whose losses are not known any more.
        let file = copy.file.clone().filter(|_| !copy.lossy);
        let stamp = copy.stamp.filter(|_| file.is_some());
        let document = Self::of(salvaged.loaded, file, options.clone());
        Ok(Self { stamp, source, history: History::new(false), ..document })
    }

    /// The text that the scene was read from, as long as not all of it could be read.
    pub fn source(&self) -> Option<&Arc<Source>> {
        self.source.as_ref()
    }

    /// Whether a mesh, as an object names it, is not there or cannot be used: nothing or a box stands in for it.
    pub fn lacks_mesh(&self, mesh: &str) -> bool {
        let is_boxed = |source: &Arc<Source>| source.stand_ins.contains_key(mesh);
        self.source.as_ref().is_some_and(is_boxed) || !self.shown().meshes.contains_key(mesh)
    }
}
