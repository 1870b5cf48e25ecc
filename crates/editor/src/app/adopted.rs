//! Takes files that the user chose for the scene: pictures of brushes, textures and noise, and files that were missing.

use std::path::Path;

use impasto_editor_model::PictureFor;
use impasto_editor_model::editor::{Mend, Offer};

use super::EditorApp;
use crate::files::incoming::{adopt_picture, bring, name_of};
use crate::panels::problems::TroubleOf;

impl EditorApp {
    /// Uses the picture at `path` for `of`. A picture outside the scene's folder is copied there first.
    pub(super) fn picture(&mut self, of: &PictureFor, path: &Path) {
        self.forget_pictures(of);
        let name = match adopt_picture(path, self.editor.document().folder(), of.folder()) {
            Ok(adopted) => adopted.name,
            Err(error) => return self.picture_trouble(of, path, error.to_string()),
        };
        if self.use_picture(of, path, Some(name)) {
            let words = format!("{} is {} now", name_of(path), of.words());
            self.toast(words, Some(Offer::Undo), false);
        }
    }

    /// Uses the picture `name`, a path relative to the scene's folder, for `of`. Without a name, removes the picture.
    pub(super) fn name_picture(&mut self, of: &PictureFor, name: Option<String>) {
        self.forget_pictures(of);
        let path = self.editor.document().folder().join(name.as_deref().unwrap_or_default());
        if name.is_some() && path.is_file() {
            return self.picture(of, &path);
        }
        self.use_picture(of, &path, name);
    }

    /// Names a picture in the document. If the document refuses it, the scene stays as it is and the list of problems
    /// says why. Returns whether it was done.
    fn use_picture(&mut self, of: &PictureFor, path: &Path, name: Option<String>) -> bool {
        let document = self.editor.document();
        let Some(command) = of.command(document.scene(), name) else {
            self.toast(format!("{} is not there any more", of.words()), None, true);
            return false;
        };
        if let Some(refusal) = document.would_refuse(&command) {
            // The user has just chosen this picture, so the path of its field in the scene is left out.
            let words = refusal.to_string();
            let words = words.split_once(".texture: ").map_or(words.as_str(), |(_, words)| words).to_owned();
            self.picture_trouble(of, path, words);
            return false;
        }
        self.editor.run(&command)
    }

    fn picture_trouble(&mut self, of: &PictureFor, path: &Path, words: String) {
        self.trouble(TroubleOf::Picture(of.clone(), path.to_owned()), words);
    }

    /// Removes the troubles with earlier pictures for `of` from the list.
    fn forget_pictures(&mut self, of: &PictureFor) {
        self.troubles.retain(|trouble| !matches!(&trouble.of, TroubleOf::Picture(other, _) if other == of));
    }

    /// Copies the chosen file to where the scene looks for a missing one, and reads it.
    pub(super) fn bring_file(&mut self, path: &Path) {
        let Some(to) = self.files.bring_to.take() else { return };
        match bring(path, &to) {
            Ok(()) => self.mend(Mend::ReadFiles),
            Err(words) => self.toast(words, None, true),
        }
    }
}
