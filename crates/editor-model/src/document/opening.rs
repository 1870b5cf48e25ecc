//! Opens scenes with errors as far as they can be read, and opens copies of unsaved work.

use std::path::Path;
use std::sync::Arc;

use impasto_scene::load::LoadOptions;
use impasto_scene::load::salvage;
use impasto_scene::problem::Report;

use super::Document;
use crate::history::History;
use crate::recovery::Copy;
use crate::source::Source;
use crate::stamp::Stamp;

impl Document {
    /// Opens a scene as far as it can be read. Until all of its text can be read, saving over its file is refused.
    ///
    /// # Errors
    /// If nothing of it can be read.
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

    /// Opens a copy of unsaved work. Paths stay relative to the scene's original folder. The text that the scene was
    /// read from comes back with its problems, if they are still the same or the user was editing that text.
    ///
    /// # Errors
    /// If nothing of the copy can be read.
    pub fn recovered(copy: &Copy, options: &LoadOptions) -> Result<Self, Report> {
        let salvaged = salvage::salvage_text(&copy.path, &copy.text, options)?;
        let read_from = copy.source.as_ref().and_then(|text| {
            Some(Source::with_any_losses(&salvage::salvage_text(&copy.path, text, options).ok()?))
        });
        // If files came or went since the copy was made, other parts of the text may be unreadable now than then. It is
        // then not known which parts the copy lost, and a merge would take a lost part for one that the user deleted.
        let is_known = read_from.as_ref().is_some_and(|source| {
            let has_box = |mesh: &String| source.has_stand_in(mesh);
            copy.losses == Some(source.losses_hash())
                && salvaged.losses.iter().all(|loss| loss.mesh.as_ref().is_some_and(has_box))
        });
        // A scene that was read with losses may overwrite its file only if it is known what was lost.
        let file = copy.file.clone().filter(|_| !copy.lossy || is_known);
        let stamp = copy.stamp.filter(|_| file.is_some());
        let is_as_read = read_from.as_ref().is_some_and(|source| source.scene == salvaged.loaded.scene);
        let source = match &copy.unread {
            // The user was editing the source text. That edit is shown beside a source, so there must be one, even if
            // nothing was lost.
            Some(_) => read_from.or_else(|| Some(Source::with_any_losses(&salvaged))),
            None => read_from.filter(|_| is_known).or_else(|| Source::of(&salvaged)),
        };
        let document = Self::of(salvaged.loaded, file, options.clone());
        let history = History::new(is_known && is_as_read && copy.changes == 0);
        Ok(Self { stamp, source: source.map(Arc::new), history, ..document })
    }

    /// The text that the scene was read from, if parts of it could not be read or used, or the user was editing it.
    pub fn source(&self) -> Option<&Arc<Source>> {
        self.source.as_ref()
    }

    /// Whether a mesh, by its name in the scene, is missing or cannot be used, so that a box or nothing is shown in its
    /// place.
    pub fn lacks_mesh(&self, mesh: &str) -> bool {
        let has_box = |source: &Arc<Source>| source.has_stand_in(mesh);
        self.source.as_ref().is_some_and(has_box) || !self.shown().meshes.contains_key(mesh)
    }
}
