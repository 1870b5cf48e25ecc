//! Repairs of scenes that could not be read whole, and reading files again after they changed on disk.

use impasto_scene::problem::Report;

use super::Editor;
use crate::document::{Document, Step};
use crate::refusal::Refusal;
use crate::watch::News;

/// A repair of the document.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Mend {
    /// Repairs one loss (a part of the source that could not be read), by its index.
    Fix(usize),
    /// Repairs all losses whose repair is certain.
    FixCertain,
    /// Moves a guide onto the surface that it belongs to. The guide is given by the name of its region and its index
    /// in that region.
    Snap(String, usize),
    /// Reads this text in place of the source.
    ReadText(String),
    /// Reads the file again, as far as it can be read.
    ReadAgain,
    /// Reads again the files that the scene names; edits of the scene stay.
    ReadFiles,
}

/// A repaired document, made on any thread; [`Editor::take`] puts it in place.
pub struct Mended {
    document: Document,
    result: Result<Step, Refusal>,
    /// Revision of the document, and whether it was edited, when the repair began.
    version_of: (u64, bool),
    /// The message on success, for a repair that the user did not ask for; `None` if the user asked.
    unasked: Option<String>,
}

/// Whether a repaired document was put in place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Took {
    /// It was put in place; true if that changed anything.
    In(bool),
    /// What changed on disk could not be read, for this reason; the document is as before.
    Unread(String),
    /// It was dropped, because the document was edited or saved meanwhile.
    Late,
}

impl Editor {
    /// Does a repair. Returns whether anything changed.
    pub fn mend(&mut self, mend: &Mend) -> bool {
        let mended = self.mending(mend.clone())();
        self.take(mended) == Took::In(true)
    }

    /// A repair as a function for any thread, since it may read many files. [`Editor::take`] puts the result in place.
    pub fn mending(&self, mend: Mend) -> impl FnOnce() -> Mended + Send + use<> {
        let mut document = self.document.clone();
        move || {
            let version_of = version_of(&document);
            let result = match mend {
                Mend::Fix(loss) => document.fix_problem(loss),
                Mend::FixCertain => document.fix_certain(),
                Mend::Snap(region, guide) => document.snap_guide(&region, guide),
                Mend::ReadText(text) => document.read_text(&text),
                Mend::ReadFiles => take_in(&mut document, News::Files),
                Mend::ReadAgain => document.read_again().map_err(|report: Report| Refusal::of(&report)),
            };
            Mended { document, result, version_of, unasked: None }
        }
    }

    /// Puts a repaired document in place, unless the document has changed meanwhile.
    pub fn take(&mut self, mended: Mended) -> Took {
        if version_of(&self.document) != mended.version_of {
            return Took::Late;
        }
        let selection = self.document.selection().clone();
        self.document = mended.document;
        if *self.document.selection() != selection {
            self.document.select(selection);
        }
        self.version += 1;
        match (mended.unasked, mended.result) {
            (None, result) => Took::In(self.told(result)),
            (Some(words), Ok(_)) => {
                self.say(words);
                Took::In(true)
            }
            (Some(_), Err(refusal)) => Took::Unread(refusal.0),
        }
    }

    /// A function for any thread that reads what changed on disk. [`Editor::take`] puts the result in place; view,
    /// selection and mode stay. `None` if that would lose edits, so that the user has to be asked first.
    pub fn taking_in(&self, news: News) -> Option<impl FnOnce() -> Mended + Send + use<>> {
        if news == News::Scene && self.document.is_edited() {
            return None;
        }
        let mut document = self.document.clone();
        Some(move || {
            let (name, version_of) = (document.name(), version_of(&document));
            let what = match news {
                News::Scene => name,
                News::Files => format!("A file of {name}"),
            };
            let result = take_in(&mut document, news)
                .map_err(|refusal| Refusal::new(format!("{what} changed on disk: {}", refusal.0)));
            let unasked = Some(format!("{what} changed on disk, and was read again"));
            Mended { document, result, version_of, unasked }
        })
    }
}

fn version_of(document: &Document) -> (u64, bool) {
    (document.revision(), document.is_edited())
}

fn take_in(document: &mut Document, news: News) -> Result<Step, Refusal> {
    let first = |report: Report| Refusal::of(&report);
    // A source may have no open losses: it is then stored for a text that the user is editing, or because undo may
    // reopen a loss. Such a document does not count as read in part.
    let read_in_part = document.source().filter(|_| document.loss_count() > 0);
    match (news, read_in_part.map(|source| source.text.clone())) {
        // The user may be repairing the file in another program: it is read as far as possible, to show what is still
        // wrong.
        (News::Scene, Some(_)) => document.read_again().map_err(first),
        (News::Scene, None) => document.reload().map_err(first),
        (News::Files, Some(text)) => document.read_text(&text),
        (News::Files, None) => document.read_files_again(),
    }
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::path::Path;

    use super::*;
    use crate::command::{Command, SceneEdit};
    use crate::selection::{Item, Selection};

    const SCENE: &str = "(version: 1, camera: (keys: [(frame: 0, eye: (0, 1, 4), target: (0, 0, 0))]), \
        objects: [(name: \"leaf\", mesh: \"leaf.obj\")])";
    const QUAD: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n";

    fn editor(folder: &Path) -> Editor {
        fs::write(folder.join("s.ron"), SCENE).expect("written");
        fs::write(folder.join("leaf.obj"), QUAD).expect("written");
        Editor::new(Document::open(&folder.join("s.ron"), &Default::default()).expect("opens"))
    }

    fn seed(editor: &mut Editor, seed: u32) {
        assert!(editor.run(&Command::Scene(SceneEdit::SetSeed(seed))));
    }

    fn triangles(editor: &Editor) -> usize {
        editor.document().loaded().meshes["leaf.obj"].mesh.triangles.len()
    }

    #[test]
    fn a_changed_mesh_is_read_in_the_background_and_again_if_the_document_changed_meanwhile() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut editor = editor(folder.path());
        fs::write(folder.path().join("leaf.obj"), QUAD.replace("f 1", "v 2 2 2\nf 2 3 4\nf 1"))
            .expect("written");
        let late = editor.taking_in(News::Files).expect("reading the mesh again loses no edits");
        seed(&mut editor, 7);
        let late = std::thread::spawn(late).join().expect("read");
        assert_eq!(editor.take(late), Took::Late);
        assert_eq!((triangles(&editor), editor.document().scene().seed), (1, 7), "the edit stays");
        let again = editor.taking_in(News::Files).expect("edits of the scene do not prevent reading");
        // What is selected meanwhile stays selected.
        let again = again();
        let leaf = Selection::only(Item::Object("leaf".to_owned()));
        editor.select(leaf.clone());
        assert_eq!(editor.take(again), Took::In(true));
        assert_eq!((triangles(&editor), editor.document().scene().seed), (2, 7));
        assert_eq!(*editor.document().selection(), leaf);
    }

    #[test]
    fn edits_on_both_sides_are_asked_about_and_a_save_drops_what_is_being_read() {
        let folder = tempfile::tempdir().expect("a folder");
        let mut editor = editor(folder.path());
        seed(&mut editor, 7);
        assert!(editor.taking_in(News::Scene).is_none());
        let again = editor.mending(Mend::ReadAgain)();
        editor.save(None).expect("saved");
        assert_eq!(editor.take(again), Took::Late);
        assert_eq!(editor.document().scene().seed, 7);
        // The user chose to drop the edits; undo brings them back.
        seed(&mut editor, 8);
        assert!(editor.mend(&Mend::ReadAgain));
        assert_eq!(editor.document().scene().seed, 7);
        assert!(editor.document.undo().is_some());
        assert_eq!(editor.document().scene().seed, 8);
    }
}
