//! Reads files on a thread, so that the window never waits; the status line shows what takes long.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::time::{Duration, Instant};

use egui::Context;
use impasto_editor_model::command::{Arrange, Command, StrokesOf};
use impasto_editor_model::editor::{Mend, Mended, Took};
use impasto_editor_model::watch::News;
use impasto_editor_model::{Document, Item, PictureFor};
use impasto_scene::load::{LoadOptions, load_mesh};
use impasto_scene::mesh_file::MeshFile;
use impasto_scene::problem::Report;

use super::EditorApp;
use crate::files::incoming::{Adopted, Step, adopt_mesh, name_of};
use crate::panels::problems::{MeshFor, TroubleOf, note_read};
use crate::panels::work::{Work, WorkKind};
use crate::window::Waker;

/// Work that takes longer than this is shown in the status line.
const SHOWN_AFTER: Duration = Duration::from_millis(200);

enum Outcome {
    Opened(PathBuf, Result<Box<Document>, Report>),
    /// A mesh that was read from this path.
    Mesh(PathBuf, MeshFor, Result<(Adopted, Arc<MeshFile>), String>),
    /// The document, repaired or read again.
    Mended {
        mended: Box<Mended>,
        /// What another program changed, if the document is read again because of that.
        news: Option<News>,
        /// The text that was read in place of the file's.
        text: Option<String>,
    },
}

struct Reading {
    words: String,
    since: Instant,
    outcome: Receiver<Outcome>,
    /// Folder and revision of the document when reading began.
    folder: PathBuf,
    revision: u64,
}

/// The file that is being read, and the files that wait for it.
pub(super) struct LongWork {
    waker: Waker,
    reading: Option<Reading>,
    queue: VecDeque<Step>,
}

impl LongWork {
    pub(super) fn new(waker: Waker) -> Self {
        Self { waker, reading: None, queue: VecDeque::new() }
    }

    /// Drops what is being read and what waits: their results are ignored.
    pub(super) fn forget(&mut self) {
        self.reading = None;
        self.queue.clear();
    }

    /// Drops the pictures and presets that wait: they were meant for the scene or mesh that could not be read.
    fn drop_brushes(&mut self) {
        self.queue.retain(|step| !matches!(step, Step::Picture(_) | Step::Preset(_)));
    }

    /// The entry in the status line; none while reading has taken less than [`SHOWN_AFTER`].
    pub(super) fn work(&self) -> Option<Work> {
        let reading = self.reading.as_ref().filter(|reading| reading.since.elapsed() >= SHOWN_AFTER)?;
        Some(Work { words: reading.words.clone(), share: None, kind: WorkKind::Reading })
    }

    /// Starts reading and drops what was being read. [`EditorApp::follow_reading`] takes the outcome in a later pass.
    fn read(&mut self, words: String, document: &Document, work: impl FnOnce() -> Outcome + Send + 'static) {
        let (sender, outcome) = channel();
        let waker = self.waker.clone();
        let run = move || {
            // Sending fails once reading was stopped, because nobody listens any more.
            let _stopped = sender.send(work());
            waker.wake();
        };
        let spawned = std::thread::Builder::new().name("reading".to_owned()).spawn(run);
        let folder = document.folder().to_owned();
        // Without a thread the channel is closed: the next pass reports that reading failed.
        if spawned.is_err() {
            self.waker.wake();
        }
        self.reading =
            Some(Reading { words, since: Instant::now(), outcome, folder, revision: document.revision() });
    }
}

impl EditorApp {
    /// Opens a scene or a mesh in place of the document.
    pub(super) fn open(&mut self, path: &Path) {
        self.long.forget();
        let path = path.to_owned();
        let words = format!("Opening {}\u{2026}", name_of(&path));
        self.long.read(words, self.editor.document(), move || {
            let document = Document::open_with_problems(&path, &LoadOptions::default());
            Outcome::Opened(path, document.map(Box::new))
        });
    }

    pub(super) fn read_mesh(&mut self, path: &Path, what_for: MeshFor) {
        let (path, folder) = (path.to_owned(), self.editor.document().folder().to_owned());
        let words = format!("Importing {}\u{2026}", name_of(&path));
        self.long.read(words, self.editor.document(), move || {
            let read = || {
                let adopted = adopt_mesh(&path, &folder).map_err(|error| error.to_string())?;
                let file = folder.join(&adopted.name);
                let (mesh, _) = load_mesh(&file, &LoadOptions::default().folders)
                    .map_err(|report| report.0.first().map_or_else(String::new, ToString::to_string))?;
                Ok((adopted, Arc::new(mesh)))
            };
            let read = read();
            Outcome::Mesh(path, what_for, read)
        });
    }

    /// Repairs the document or reads it again.
    pub(super) fn mend(&mut self, mend: Mend) {
        if let Some(reading) = &self.long.reading {
            let words = format!("{} Stop it first, or wait", reading.words);
            return self.toast(words, None, true);
        }
        let words = format!("Reading {}\u{2026}", self.editor.document().name());
        let text = if let Mend::ReadText(text) = &mend { Some(text.clone()) } else { None };
        let mending = self.editor.mending(mend);
        let outcome = move || Outcome::Mended { mended: Box::new(mending()), news: None, text };
        self.long.read(words, self.editor.document(), outcome);
    }

    /// Starts to read what another program changed. False if that would lose edits, so that the user has to be asked.
    pub(super) fn take_in(&mut self, news: News) -> bool {
        let Some(taking_in) = self.editor.taking_in(news) else { return false };
        let words = format!("Reading {}\u{2026}", self.editor.document().name());
        let outcome = move || Outcome::Mended { mended: Box::new(taking_in()), news: Some(news), text: None };
        self.long.read(words, self.editor.document(), outcome);
        true
    }

    pub(super) fn is_reading(&self) -> bool {
        self.long.reading.is_some()
    }

    /// Does this step at once, or after the file that is being read.
    pub(super) fn take_step(&mut self, step: Step) {
        if self.long.reading.is_some() {
            return self.long.queue.push_back(step);
        }
        match step {
            Step::Open(path) => self.open_asking(&path),
            Step::Begin(path) => self.open(&path),
            Step::Import(path) => self.import(&path),
            Step::Preset(path) => {
                let of = match self.editor.document().selection().active() {
                    Some(Item::Region(name) | Item::Guide(name, _)) => StrokesOf::Region(name.clone()),
                    _ => StrokesOf::Scene,
                };
                self.use_preset(of, &path);
            }
            Step::Picture(path) => {
                let of = PictureFor::dropped(self.editor.document().selection());
                self.picture(&of, &path);
            }
        }
    }

    /// Takes the outcome of reading, once it is there, and goes on with what waits.
    pub(super) fn follow_reading(&mut self, ctx: &Context) {
        let Some(reading) = self.long.reading.take() else { return };
        match reading.outcome.try_recv() {
            Ok(outcome) => self.take_read(outcome, &reading),
            Err(TryRecvError::Empty) => {
                ctx.request_repaint_after(SHOWN_AFTER.saturating_sub(reading.since.elapsed()));
                self.long.reading = Some(reading);
                return;
            }
            Err(TryRecvError::Disconnected) => {
                let words = reading.words.trim_end_matches('\u{2026}');
                self.toast(format!("{words} broke off; nothing changed"), None, true);
            }
        }
        while self.long.reading.is_none()
            && let Some(step) = self.long.queue.pop_front()
        {
            self.take_step(step);
        }
    }

    /// The work in the background, for the status line, from right to left.
    pub(super) fn works(&self, ctx: &Context) -> Vec<Work> {
        let mut works: Vec<Work> = self.render.work().into_iter().collect();
        works.extend(self.long.work());
        if let Some(waited) = self.picture_flow.preparing_for() {
            match SHOWN_AFTER.checked_sub(waited).filter(|rest| !rest.is_zero()) {
                Some(rest) => ctx.request_repaint_after(rest),
                None => {
                    let words = format!("Preparing {}\u{2026}", self.what_is_painted());
                    works.push(Work { words, share: None, kind: WorkKind::Preparing });
                }
            }
        }
        works
    }

    /// Name of the only object, or of the scene.
    fn what_is_painted(&self) -> String {
        let document = self.editor.document();
        match &document.scene().objects[..] {
            [only] => only.name.clone(),
            _ => document.name().trim_end_matches(".ron").to_owned(),
        }
    }

    /// Stops reading; the document stays as it is.
    pub(super) fn stop_reading(&mut self) {
        if let Some(reading) = &self.long.reading {
            let words =
                format!("{} was stopped; nothing changed", reading.words.trim_end_matches('\u{2026}'));
            self.toast(words, None, false);
        }
        self.long.forget();
    }

    fn take_read(&mut self, outcome: Outcome, reading: &Reading) {
        let document = self.editor.document();
        match outcome {
            Outcome::Opened(path, opened) => {
                // Edits that were made while the file was read are not thrown away.
                if document.revision() != reading.revision && document.is_edited() {
                    let name = document.name();
                    let words = format!("{} was not opened: {name} was edited meanwhile", name_of(&path));
                    return self.toast(words, None, true);
                }
                if opened.is_err() {
                    self.long.drop_brushes();
                }
                self.opened(&path, opened.map(|document| *document));
            }
            Outcome::Mended { .. } | Outcome::Mesh(..) if document.folder() != reading.folder => {}
            Outcome::Mended { mended, news, text } => match (self.editor.take(*mended), news) {
                (Took::Unread(words), Some(news)) => self.trouble(TroubleOf::ChangedOutside(news), words),
                (Took::In(false) | Took::Unread(_), None) => {}
                (Took::In(_), news) => {
                    text.iter().for_each(|text| note_read(&self.ctx, text));
                    self.settled(&TroubleOf::ChangedOutside(News::Files));
                    if news != Some(News::Files) {
                        self.settled(&TroubleOf::ChangedOutside(News::Scene));
                    }
                }
                (Took::Late, Some(news)) => self.changed_outside(news),
                (Took::Late, None) => {
                    let words =
                        format!("{} was edited meanwhile: nothing was read", self.editor.document().name());
                    self.toast(words, None, true);
                }
            },
            Outcome::Mesh(path, what_for, Ok((adopted, file))) => {
                self.settled(&TroubleOf::Mesh(what_for.clone(), path));
                if !adopted.copied.is_empty() {
                    self.toast(format!("Copied {} beside the scene", adopted.name), None, false);
                }
                self.editor.hold_mesh(&adopted.name, file);
                match what_for {
                    MeshFor::Import => drop(self.editor.import(&adopted.name)),
                    MeshFor::Replace(object) => {
                        let command = Arrange::ReplaceMesh { object, mesh: adopted.name };
                        self.editor.run(&Command::Arrange(command));
                        let of = TroubleOf::ChangedOutside(News::Files);
                        if self.troubles.iter().any(|trouble| trouble.of == of) {
                            // The replaced mesh may be the one that was missing, so read the changed files again.
                            self.changed_outside(News::Files);
                        }
                    }
                }
            }
            Outcome::Mesh(path, what_for, Err(words)) => {
                // Pictures and presets that came together with the mesh were meant for it.
                self.long.drop_brushes();
                self.trouble(TroubleOf::Mesh(what_for, path), words);
            }
        }
    }
}
