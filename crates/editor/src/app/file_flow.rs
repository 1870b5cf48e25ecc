//! What happens on New, Open, Save, Import and when files are dropped, with the questions that come first.

use std::path::{Path, PathBuf};
use std::time::Instant;

use egui::{Context, Ui};
use impasto_editor_model::PictureFor;
use impasto_editor_model::document::{Document, SaveError};
use impasto_editor_model::editor::Mend;
use impasto_editor_model::keymap::Preset;

use super::EditorApp;
use crate::files::beside::Copies;
use crate::files::dialogs::{Answer, FileDialogs};
use crate::files::file_ask::FileAsk;
use crate::files::incoming::{self, Present, Step};
use crate::files::preferences::{self, Keys, Preferences};
use crate::panels::ask_close::{self, Question};
use crate::panels::problems::{self, MeshFor, TroubleOf};
use crate::panels::welcome::{self, Choices, Left};
use crate::theme;

/// What happens once unsaved work is saved or dropped.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Next {
    Close,
    New,
    Open(PathBuf),
    /// Save to the document's own file.
    SaveOwn,
    /// Ask for a file to save to.
    Save(FileAsk),
}

pub(super) struct FileFlow {
    pub(super) dialogs: FileDialogs,
    /// What happens once the question about unsaved work is answered.
    waiting: Option<Next>,
    /// The question about unsaved work that is open.
    asks: Option<Unsaved>,
    /// The object for which a mesh is being chosen.
    pub(super) mesh_of: Option<String>,
    /// What a picture is being chosen for.
    pub(super) picture_for: Option<PictureFor>,
    /// Where the scene looks for the missing file that the user is locating.
    pub(super) bring_to: Option<PathBuf>,
    /// When the first unsaved edit was noticed.
    edited_since: Option<Instant>,
    /// A save into another folder, while the user is asked whether to copy the scene's files there.
    save_elsewhere: Option<SaveElsewhere>,
    closes: bool,
}

struct SaveElsewhere {
    target: PathBuf,
    to: SaveTo,
    copies: Copies,
}

/// Work that closing the document would lose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Unsaved {
    /// Text that was edited in the panel of problems and has not been parsed into the document since.
    Text,
    /// Edits of the scene.
    Edits,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum SaveTo {
    /// The file becomes the document's own.
    Own,
    /// A copy; the document keeps its own file.
    Copy,
}

impl FileFlow {
    pub(super) fn new(dialogs: FileDialogs) -> Self {
        Self {
            dialogs,
            waiting: None,
            asks: None,
            mesh_of: None,
            picture_for: None,
            bring_to: None,
            edited_since: None,
            save_elsewhere: None,
            closes: false,
        }
    }

    pub(super) fn is_asking(&self) -> bool {
        self.asks.is_some() || self.save_elsewhere.is_some() || self.dialogs.is_open()
    }
}

/// Saves the preferences. The error is a sentence for the user.
pub(super) fn keep(preferences: &Preferences) -> Result<(), String> {
    let Some(folder) = preferences::config_folder() else { return Ok(()) };
    preferences::save(&folder, preferences).map_err(|error| error.to_string())
}

impl EditorApp {
    /// Whether the window may close now. If not, a question is open: about frames being rendered, or unsaved work.
    pub(super) fn may_close(&mut self) -> bool {
        if self.render.holds_window() {
            return false;
        }
        let Some(unsaved) = self.unsaved() else {
            self.note_closing();
            return true;
        };
        self.wait_for(Next::Close, unsaved);
        false
    }

    pub(super) fn new_asking(&mut self) {
        self.go_on_or_ask(Next::New);
    }

    pub(super) fn open_asking(&mut self, path: &Path) {
        self.go_on_or_ask(Next::Open(path.to_owned()));
    }

    pub(super) fn quit_asking(&mut self) {
        if !self.render.holds_window() {
            self.go_on_or_ask(Next::Close);
        }
    }

    fn go_on_or_ask(&mut self, next: Next) {
        match self.unsaved() {
            Some(unsaved) => self.wait_for(next, unsaved),
            None => self.go_on(next),
        }
    }

    /// The unsaved work to ask about first; none if everything is saved.
    fn unsaved(&self) -> Option<Unsaved> {
        let document = self.editor.document();
        let has_text = problems::unread_text(&self.ctx, document).is_some();
        let edits = || document.is_edited().then_some(Unsaved::Edits);
        has_text.then_some(Unsaved::Text).or_else(edits)
    }

    fn wait_for(&mut self, next: Next, unsaved: Unsaved) {
        self.files.waiting = Some(next);
        self.files.asks = Some(unsaved);
    }

    fn go_on(&mut self, next: Next) {
        match next {
            Next::Close => {
                self.note_closing();
                self.files.closes = true;
            }
            Next::New => {
                self.long.forget();
                self.note_last_seen();
                let folder = self.editor.document().folder().to_owned();
                self.forget_document();
                self.editor.open(Document::empty(&folder));
                self.sheets.problems = false;
                self.keymap();
            }
            Next::SaveOwn => drop(self.save(None)),
            Next::Save(ask) => self.ask_where_to_save(ask),
            Next::Open(path) => self.open(&path),
        }
    }

    /// Saves to `target`, or to the document's own file. Returns whether the file was written.
    pub(super) fn save(&mut self, target: Option<&Path>) -> bool {
        let saved = self.editor.save(target);
        self.saved(saved)
    }

    /// Deals with the result of a save. Returns whether the file was written.
    pub(super) fn saved(&mut self, saved: Result<(), SaveError>) -> bool {
        match saved {
            Ok(()) => {
                self.troubles.retain(|trouble| !trouble.of.is_settled_by_saving());
                if let Some(file) = self.editor.document().file().map(Path::to_owned) {
                    self.preferences.note_recent(&file);
                    self.note_last_seen();
                }
                true
            }
            Err(SaveError::FilesElsewhere { target, .. }) => {
                self.offer_to_copy_files(target, SaveTo::Own);
                false
            }
            Err(error) => {
                // Closing or opening goes on only after a save that succeeds.
                self.files.waiting = None;
                self.ask_about_saving(error);
                false
            }
        }
    }

    /// Shows sheets and questions about files. Returns whether the window is to close.
    pub(super) fn file_sheets(&mut self, ctx: &Context, ui: &mut Ui) -> bool {
        self.welcome_sheet(ctx);
        self.dropped(ui);
        let is_edited = self.editor.document().is_edited();
        if !is_edited {
            self.files.edited_since = None;
        } else if self.files.edited_since.is_none() {
            self.files.edited_since = Some(Instant::now());
        }
        if let Some(unsaved) = self.files.asks {
            match unsaved {
                Unsaved::Text => self.ask_about_text(ctx),
                Unsaved::Edits => self.ask_about_changes(ctx),
            }
        } else if self.files.save_elsewhere.is_some() {
            self.ask_to_copy_files(ctx);
        } else if self.safe.is_asking() {
            self.ask_about_safety(ctx);
        } else if let Some(frame) = self.sheets.recapture
            && let Some(answer) = ask_close::ask(ctx, &Question::Recapture { frame })
        {
            if answer == ask_close::Answer::Recapture {
                self.editor.recapture(frame);
            }
            self.sheets.recapture = None;
        } else if let Some((_, taken)) = &self.sheets.take_faces
            && let Some(answer) = ask_close::ask(ctx, &Question::TakeFaces { taken: taken.clone() })
            && let Some((command, _)) = self.sheets.take_faces.take()
            && answer == ask_close::Answer::TakeFaces
        {
            self.editor.run(&command);
        }
        if let Some(answer) = self.files.dialogs.poll(ctx) {
            self.answered(answer);
        }
        self.files.closes
    }

    fn ask_about_text(&mut self, ctx: &Context) {
        let question = Question::UnreadText { name: self.editor.document().name() };
        let Some(answer) = ask_close::ask(ctx, &question) else { return };
        self.files.asks = None;
        match (answer, self.files.waiting.take()) {
            (ask_close::Answer::Discard, Some(Next::SaveOwn)) => {
                let is_saved = self.save(None);
                if is_saved {
                    problems::forget_text(ctx);
                }
            }
            (ask_close::Answer::Discard, Some(next @ Next::Save(_))) => {
                problems::forget_text(ctx);
                self.go_on(next);
            }
            (ask_close::Answer::Discard, Some(next)) if self.editor.document().is_edited() => {
                self.wait_for(next, Unsaved::Edits);
            }
            (ask_close::Answer::Discard, Some(next)) => self.go_on(next),
            (ask_close::Answer::ReadText, _) => {
                if let Some(text) = problems::unread_text(ctx, self.editor.document()) {
                    self.mend(Mend::ReadText(text));
                }
            }
            _ => {}
        }
    }

    fn ask_about_changes(&mut self, ctx: &Context) {
        let minutes = self.files.edited_since.map_or(0, |since| since.elapsed().as_secs() / 60);
        let question = Question::SaveChanges { name: self.editor.document().name(), minutes };
        let Some(answer) = ask_close::ask(ctx, &question) else { return };
        self.files.asks = None;
        match answer {
            ask_close::Answer::Save if self.editor.document().file().is_some() => {
                if self.save(None)
                    && let Some(next) = self.files.waiting.take()
                {
                    self.go_on(next);
                }
            }
            // The waiting step follows once the file is written.
            ask_close::Answer::Save => {
                let start = self.editor.document().suggested_file();
                self.files.dialogs.open(ctx, FileAsk::SaveAs, &start);
            }
            ask_close::Answer::Discard => {
                if let Some(next) = self.files.waiting.take() {
                    self.go_on(next);
                }
            }
            _ => self.files.waiting = None,
        }
    }

    fn answered(&mut self, answer: Answer) {
        let Some(path) = answer.path else {
            self.files.waiting = None;
            return;
        };
        if !answer.ask.is_save()
            && let Err(words) = answer.ask.fits(&path)
        {
            return self.toast(words, None, true);
        }
        match answer.ask {
            FileAsk::Open => self.open_asking(&path),
            FileAsk::ImportMesh => self.take_step(Step::Import(path)),
            FileAsk::SaveAs => {
                if self.save(Some(&path))
                    && let Some(next) = self.files.waiting.take()
                {
                    self.go_on(next);
                }
            }
            // A scene that was read with errors: the copy becomes the document, and the broken file stays as it is.
            FileAsk::SaveCopy if self.editor.document().saving_loses() => drop(self.save(Some(&path))),
            FileAsk::SaveCopy => self.save_copy(&path),
            FileAsk::LocateMesh => self.replace_mesh(&path),
            FileAsk::Missing => self.bring_file(&path),
            FileAsk::ChoosePicture => {
                if let Some(of) = self.files.picture_for.take() {
                    self.picture(&of, &path);
                }
            }
            FileAsk::SavePreset => self.save_preset(&path),
            FileAsk::LoadPreset => self.load_preset(&path),
            FileAsk::RenderOutput { .. } => self.render_to(&path),
        }
    }

    fn save_copy(&mut self, path: &Path) {
        match self.editor.save_copy(path) {
            Ok(()) => {}
            Err(SaveError::FilesElsewhere { target, .. }) => self.offer_to_copy_files(target, SaveTo::Copy),
            Err(error) => self.ask_about_saving(error),
        }
    }

    /// Asks for a file to save to. If the scene's text has edits that are not applied yet, asks about them first.
    pub(super) fn save_asking(&mut self, ask: FileAsk) {
        match self.unsaved() {
            Some(Unsaved::Text) => self.wait_for(Next::Save(ask), Unsaved::Text),
            _ => self.ask_where_to_save(ask),
        }
    }

    /// Saves to the document's own file. If the scene's text has edits that are not applied yet, asks about them first.
    /// Does not ask if the save will be refused anyway, because of problems in the scene.
    pub(super) fn save_own_asking(&mut self) {
        match self.unsaved() {
            Some(Unsaved::Text) if !self.editor.document().saving_loses() => {
                self.wait_for(Next::SaveOwn, Unsaved::Text);
            }
            _ => drop(self.save(None)),
        }
    }

    fn ask_where_to_save(&mut self, ask: FileAsk) {
        let document = self.editor.document();
        let start = match ask {
            FileAsk::SaveCopy => document.suggested_copy(),
            _ => document.suggested_file(),
        };
        let ctx = self.ctx.clone();
        self.files.dialogs.open(&ctx, ask, &start);
    }

    /// Asks whether the scene's files are to be copied into the folder of `target`.
    fn offer_to_copy_files(&mut self, target: PathBuf, to: SaveTo) {
        let document = self.editor.document();
        let folder = target.parent().unwrap_or(Path::new("."));
        match Copies::between(document.folder(), folder, document.files_named()) {
            Ok(copies) => self.files.save_elsewhere = Some(SaveElsewhere { target, to, copies }),
            Err(error) => {
                self.files.waiting = None;
                self.trouble(TroubleOf::Save(Some(target)), error.to_string());
            }
        }
    }

    fn ask_to_copy_files(&mut self, ctx: &Context) {
        let Some(SaveElsewhere { target, copies, .. }) = &self.files.save_elsewhere else { return };
        let folder = target.parent().unwrap_or(Path::new("."));
        let question = Question::TakeAlong { count: copies.count(), folder: folder.display().to_string() };
        let Some(answer) = ask_close::ask(ctx, &question) else { return };
        let Some(SaveElsewhere { target, to, copies }) = self.files.save_elsewhere.take() else { return };
        if answer != ask_close::Answer::Copy {
            self.files.waiting = None;
            return;
        }
        if let Err(error) = copies.carry_out(target.parent().unwrap_or(Path::new("."))) {
            self.files.waiting = None;
            return self.trouble(TroubleOf::Save(Some(target)), error.to_string());
        }
        match to {
            SaveTo::Own => {
                if self.save(Some(&target))
                    && let Some(next) = self.files.waiting.take()
                {
                    self.go_on(next);
                }
            }
            SaveTo::Copy => self.save_copy(&target),
        }
    }

    pub(super) fn import(&mut self, path: &Path) {
        let document = self.editor.document();
        if Present::of(document) == Present::Nothing {
            return self.open(path);
        }
        // `live_in` moves the document to the mesh's folder if the document has no file and names no files.
        if let Some(folder) = std::path::absolute(path).ok().as_deref().and_then(Path::parent) {
            self.editor.live_in(folder);
        }
        self.read_mesh(path, MeshFor::Import);
    }

    /// Gives the mesh that was chosen to the object that asked for one.
    fn replace_mesh(&mut self, path: &Path) {
        let Some(object) = self.files.mesh_of.take() else { return };
        self.read_mesh(path, MeshFor::Replace(object));
    }

    fn dropped(&mut self, ui: &mut Ui) {
        let paths: Vec<PathBuf> =
            ui.input(|input| input.raw.dropped_files.iter().map(|file| file.path().to_owned()).collect());
        if paths.is_empty() || self.is_modal() && !self.sheets.welcome {
            return;
        }
        self.sheets.welcome = false;
        let plan = incoming::plan(&paths, Present::of(self.editor.document()));
        for words in plan.refused {
            self.toast(words, None, true);
        }
        for step in plan.steps {
            self.take_step(step);
        }
    }

    fn welcome_sheet(&mut self, ctx: &Context) {
        if !self.sheets.welcome || self.files.is_asking() {
            return;
        }
        let before = Choices {
            keys: self.editor.keymap.preset,
            theme: self.preferences.theme,
            scale: self.preferences.scale,
            at_start: self.preferences.show_welcome,
        };
        let mut choices = before;
        let left = welcome::welcome(ctx, &mut choices);
        if choices != before {
            self.preferences.keys = match choices.keys {
                Preset::Blender => Keys::Blender,
                Preset::Maya => Keys::Maya,
            };
            self.preferences.theme = choices.theme;
            (self.preferences.scale, self.preferences.show_welcome) = (choices.scale, choices.at_start);
            self.keymap();
            theme::apply(ctx, choices.theme, choices.scale);
            self.keep_preferences();
        }
        let start = self.editor.document().folder().to_owned();
        match left {
            None => return,
            Some(Left::OpenMesh | Left::OpenScene) => {
                self.files.dialogs.open(ctx, FileAsk::Open, &start);
            }
            Some(Left::StillLife) => match still_life() {
                Some(path) => self.open(&path),
                None => {
                    let words =
                        "The still life comes with Impasto's source: open scenes/still_life.ron there";
                    self.toast(words, None, true);
                }
            },
            Some(Left::Closed) => {}
        }
        self.sheets.welcome = false;
    }
}

/// Finds the still life that comes with Impasto: in the working folder, beside the program, or in the source.
fn still_life() -> Option<PathBuf> {
    let file = Path::new("scenes/still_life.ron");
    let mut folders: Vec<PathBuf> = std::env::current_dir().into_iter().collect();
    if let Ok(program) = std::env::current_exe() {
        folders.extend(program.ancestors().skip(1).take(4).map(Path::to_owned));
    }
    folders.into_iter().map(|folder| folder.join(file)).find(|path| path.is_file())
}
