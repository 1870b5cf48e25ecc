//! Lists failures in the window until they are settled, and does what settles them.

use impasto_editor_model::watch::News;
use impasto_scene::built_in_mesh::is_built_in;
use impasto_scene::mesh_format::file_and_node;

use super::EditorApp;
use crate::files::file_ask::FileAsk;
use crate::panels::problems::{Settle, Trouble, TroubleOf};

impl EditorApp {
    /// Lists a failure. Shows the list if the failure is new in it.
    pub(super) fn trouble(&mut self, of: TroubleOf, words: String) {
        // Leaves out the advice that helps only on the command line.
        let words = words.replace(", or name its folder with --asset-dir", "");
        let (words, mend, settles): (_, _, &'static [Settle]) = match &of {
            TroubleOf::Save(_) => {
                (words, "Your work is still here, and not in the file", &[Settle::SaveAs, Settle::Retry])
            }
            TroubleOf::Copy => (
                format!("Unsaved work could not be copied: {words}"),
                "A crash would lose what is not saved",
                &[Settle::SaveAs, Settle::Retry, Settle::Dismiss],
            ),
            TroubleOf::ChangedOutside(News::Files) if self.object_without_mesh().is_some() => {
                let words = words.split("; put the file there").next().unwrap_or_default().to_owned();
                let mend = "What was read last stays. Locate the mesh, or put it back and retry";
                (words, mend, &[Settle::Locate, Settle::Retry, Settle::Dismiss])
            }
            TroubleOf::ChangedOutside(_) => {
                (words, "What was read last stays", &[Settle::Retry, Settle::Dismiss])
            }
            TroubleOf::Open(_)
            | TroubleOf::Mesh(..)
            | TroubleOf::Picture(..)
            | TroubleOf::Preset(..)
            | TroubleOf::SavePreset(..) => (words, "Nothing changed", &[Settle::Retry, Settle::Dismiss]),
        };
        let trouble = Trouble { of, words, mend: mend.to_owned(), settles };
        match self.troubles.iter_mut().find(|known| known.of == trouble.of) {
            Some(known) if *known == trouble => {}
            Some(known) => *known = trouble,
            None => {
                self.troubles.push(trouble);
                self.sheets.problems = true;
            }
        }
    }

    /// Removes a settled failure from the list.
    pub(super) fn settled(&mut self, of: &TroubleOf) {
        self.troubles.retain(|trouble| trouble.of != *of);
    }

    /// The first object whose mesh is not on disk.
    fn object_without_mesh(&self) -> Option<String> {
        let document = self.editor.document();
        let mut objects = document.scene().objects.iter().filter(|object| !is_built_in(&object.mesh));
        let lacks = |mesh: &str| document.file_at_hand(file_and_node(mesh).0).is_none();
        objects.find(|object| lacks(&object.mesh)).map(|object| object.name.clone())
    }

    pub(super) fn choose_mesh(&mut self, object: String) {
        self.files.mesh_of = Some(object);
        let start = self.editor.document().folder().to_owned();
        self.files.dialogs.open(&self.ctx, FileAsk::LocateMesh, &start);
    }

    /// Does what a button of the list stands for. `index` is the place of its failure in the list.
    pub(super) fn settle(&mut self, index: usize, settle: Settle) {
        let Some(of) = self.troubles.get(index).map(|trouble| trouble.of.clone()) else { return };
        match (settle, &of) {
            (Settle::Dismiss, _) => self.settled(&of),
            (Settle::SaveAs, _) => self.save_asking(FileAsk::SaveAs),
            (Settle::Locate, _) => match self.object_without_mesh() {
                Some(object) => self.choose_mesh(object),
                // No mesh is missing any more.
                None => self.settle(index, Settle::Retry),
            },
            (Settle::Retry, TroubleOf::Save(None)) => self.save_own_asking(),
            (Settle::Retry, TroubleOf::Save(target)) => drop(self.save(target.as_deref())),
            (Settle::Retry, TroubleOf::Copy) => self.keep_before_risk(),
            (Settle::Retry, TroubleOf::Open(path)) => self.open_asking(path),
            (Settle::Retry, TroubleOf::ChangedOutside(_)) if self.is_reading() => {
                self.toast("Something is being read: wait for it, or stop it".to_owned(), None, true);
            }
            (Settle::Retry, TroubleOf::ChangedOutside(news)) => self.changed_outside(*news),
            (Settle::Retry, TroubleOf::Mesh(what_for, path)) => self.read_mesh(path, what_for.clone()),
            (Settle::Retry, TroubleOf::Picture(of, path)) => self.picture(of, path),
            (Settle::Retry, TroubleOf::Preset(of, path)) => self.use_preset(of.clone(), path),
            (Settle::Retry, TroubleOf::SavePreset(of, path)) => self.save_preset_again(of.clone(), path),
        }
    }
}
