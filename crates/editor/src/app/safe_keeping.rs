//! Keeps work from being lost: recovery copies, offers of copies that a crash left behind, and files that other
//! programs change.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use egui::Context;
use impasto_editor_model::document::{Document, SaveError};
use impasto_editor_model::recovery::{Cadence, Keeper, Kept, Offer, Recovery};
use impasto_editor_model::stamp::hash;
use impasto_editor_model::watch::{News, Watch};
use impasto_scene::load::LoadOptions;
use impasto_scene::problem::Report;

use super::EditorApp;
use crate::files::file_ask::FileAsk;
use crate::files::preferences;
use crate::panels::ask_close::{self, Answer, Question};
use crate::panels::problems::{self, TroubleOf};

/// How often the document's files are checked for changes.
const LOOK: Duration = Duration::from_secs(1);

/// The recovery copy of the open document, offers of older copies, and the files that are watched.
pub(super) struct SafeKeeping {
    folder: Option<PathBuf>,
    keeper: Option<Keeper>,
    cadence: Cadence,
    /// Whether a copy of the open document is on the disk or being written.
    has_copy: bool,
    /// Copies that earlier runs of the editor left behind, to be asked about one by one.
    offers: VecDeque<Offer>,
    watch: Watch,
    next_look: Instant,
    start: Instant,
    asks: Option<About>,
    trouble: Option<String>,
}

/// The question that is open.
#[derive(Clone, Copy, Debug)]
enum About {
    /// Another program changed the file, and there are unsaved edits.
    Changed,
    /// Saving would overwrite what another program has written.
    SavingOver,
    /// Problems are left, so the scene cannot be saved over its file: how many, and the line of the first one.
    Losses(usize, usize),
}

impl SafeKeeping {
    /// Opens the recovery folder; if that fails, the window reports it.
    pub(super) fn new() -> Self {
        let folder = preferences::recovery_folder();
        let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        let name = format!("{}-{}", std::process::id(), since.as_nanos());
        let open = |folder: &PathBuf| Keeper::new(Recovery::open(folder, &name)?);
        let opened = folder.as_ref().map(open).transpose();
        let trouble = opened.as_ref().err().map(|error| format!("Unsaved work will not be copied: {error}"));
        let now = Instant::now();
        Self {
            folder,
            keeper: opened.ok().flatten(),
            cadence: Cadence::default(),
            has_copy: false,
            offers: VecDeque::new(),
            watch: Watch::default(),
            next_look: now,
            start: now,
            asks: None,
            trouble,
        }
    }

    pub(super) fn is_asking(&self) -> bool {
        self.asks.is_some() || !self.offers.is_empty()
    }

    /// Makes the next pass check the files.
    pub(super) fn look_now(&mut self) {
        self.next_look = Instant::now();
    }

    /// Removes the recovery copy, since the work was saved or dropped.
    pub(super) fn give_up(&mut self) {
        if std::mem::take(&mut self.has_copy)
            && let Some(keeper) = &self.keeper
        {
            keeper.forget();
        }
        self.cadence = Cadence::default();
    }

    fn keep(&mut self, document: &Document, unread: Option<String>) {
        let Some(keeper) = &self.keeper else { return };
        let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        self.cadence.kept_now(version_of(document, unread.as_deref()));
        let mut work = document.work(since.as_secs());
        work.copy.unread = unread;
        keeper.keep(work);
        self.has_copy = true;
    }
}

/// A number that changes with each edit of the scene or of its text.
fn version_of(document: &Document, unread: Option<&str>) -> u64 {
    let revision = document.revision();
    unread.map_or(revision, |text| revision.wrapping_add(hash(text.as_bytes())))
}

impl EditorApp {
    /// Finds the copies that earlier runs of the editor left behind, to ask about them: those of the scene `of`, or
    /// all.
    pub(super) fn offer_copies(&mut self, of: Option<&Path>) {
        let Some(folder) = &self.safe.folder else { return };
        let of = of.map(|path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned()));
        let mut offers = Recovery::offers(folder);
        if let Some(of) = of {
            offers.retain(|offer| offer.copy.file.as_ref() == Some(&of));
        }
        self.safe.offers = offers.into();
    }

    /// Writes a recovery copy if one is due, and checks whether other programs changed the document's files.
    pub(super) fn keep_safe(&mut self, ctx: &Context) {
        if let Some(words) = self.safe.trouble.take() {
            self.toast(words, None, true);
        }
        let kept = self.safe.keeper.as_ref().map_or_else(Vec::new, Keeper::done);
        for kept in kept {
            match kept {
                Kept::At(_) => self.settled(&TroubleOf::Copy),
                Kept::Not(words) => self.trouble(TroubleOf::Copy, words),
            }
        }
        let document = self.editor.document();
        let unread = problems::unread_text(ctx, document);
        let after_secs = self.preferences.copy_after_secs;
        if !document.is_edited() && unread.is_none() {
            self.safe.give_up();
        } else if after_secs > 0 {
            let after_secs = f64::from(after_secs);
            let now_secs = self.safe.start.elapsed().as_secs_f64();
            let version = version_of(document, unread.as_deref());
            if self.safe.cadence.is_due(Some(version), now_secs, after_secs) {
                self.safe.keep(document, unread);
            }
            ctx.request_repaint_after(LOOK);
        }
        let has_files = document.file().is_some() || !document.loaded().meshes.is_empty();
        if has_files && !self.editor.is_moving() && self.safe.asks.is_none() && !self.is_reading() {
            if Instant::now() >= self.safe.next_look {
                self.safe.next_look = Instant::now() + LOOK;
                if let Some(news) = self.safe.watch.look(self.editor.document()) {
                    self.changed_outside(news);
                }
            }
            ctx.request_repaint_after(LOOK);
        }
    }

    /// Writes a recovery copy now, before something that may go wrong.
    pub(super) fn keep_before_risk(&mut self) {
        let document = self.editor.document();
        let unread = problems::unread_text(&self.ctx, document);
        if (document.is_edited() || unread.is_some()) && self.preferences.copy_after_secs > 0 {
            self.safe.keep(document, unread);
        }
    }

    pub(super) fn changed_outside(&mut self, news: News) {
        self.keep_before_risk();
        if !self.take_in(news) {
            self.safe.asks = Some(About::Changed);
        }
    }

    /// Reports why a save failed, or asks what to do.
    pub(super) fn ask_about_saving(&mut self, error: SaveError) {
        match error {
            SaveError::ChangedOutside { .. } => self.safe.asks = Some(About::SavingOver),
            SaveError::Problems { count, line } => self.safe.asks = Some(About::Losses(count, line)),
            SaveError::Unwritable { ref target, .. } => {
                let own = self.editor.document().file() == Some(target);
                let of = TroubleOf::Save((!own).then(|| target.clone()));
                self.trouble(of, error.to_string());
            }
            error => self.toast(error.to_string(), None, true),
        }
    }

    /// Shows the open question and carries out its answer.
    pub(super) fn ask_about_safety(&mut self, ctx: &Context) {
        let name = self.editor.document().name();
        let question = match self.safe.asks {
            Some(About::Changed) => Question::ChangedOutside { name },
            Some(About::SavingOver) => Question::SaveOver { name },
            Some(About::Losses(count, line)) => Question::Problems { count, line },
            None => return self.ask_about_copy(ctx),
        };
        let Some(answer) = ask_close::ask(ctx, &question) else { return };
        self.safe.asks = None;
        match answer {
            Answer::ReadAgain => self.mend(impasto_editor_model::editor::Mend::ReadAgain),
            Answer::SaveOver => {
                let saved = self.editor.save_over();
                self.saved(saved);
            }
            Answer::SaveAs => {
                let start = self.editor.document().suggested_copy();
                self.files.dialogs.open(ctx, FileAsk::SaveAs, &start);
            }
            Answer::SaveCopy => {
                let start = self.editor.document().suggested_copy();
                self.files.dialogs.open(ctx, FileAsk::SaveCopy, &start);
            }
            Answer::ShowProblem => self.sheets.problems = true,
            _ => {}
        }
        self.sheets.problems |= self.editor.document().loss_count() > 0;
    }

    fn ask_about_copy(&mut self, ctx: &Context) {
        let Some(offer) = self.safe.offers.front() else { return };
        let question = Question::Recovered {
            name: offer.copy.name(),
            age: offer.copy.age(SystemTime::now()),
            changes: offer.copy.changes,
            has_text: offer.copy.unread.is_some(),
            of_another: offer.copy.is_of_another_file(),
        };
        let Some(answer) = ask_close::ask(ctx, &question) else { return };
        let Some(offer) = self.safe.offers.pop_front() else { return };
        match answer {
            Answer::OpenCopy => self.open_copy(offer),
            Answer::Discard => {
                if let Err(error) = offer.discard() {
                    self.toast(format!("The copy was not removed: {error}"), None, true);
                }
            }
            // The answer was *Later*: dropping the offer releases its lock, so that it will be offered again.
            _ => {}
        }
    }

    fn open_copy(&mut self, offer: Offer) {
        match Document::recovered(&offer.copy, &LoadOptions::default()) {
            Ok(document) => {
                self.keep_before_risk();
                self.forget_document();
                self.editor.open(document);
                self.keymap();
                self.sheets.welcome = false;
                self.sheets.problems = self.editor.document().loss_count() > 0 || offer.copy.unread.is_some();
                if let Some(typed) = &offer.copy.unread {
                    problems::restore_text(&self.ctx, self.editor.document(), typed.clone());
                }
                self.toast(
                    format!("{} as it was being painted; it is not saved", offer.copy.name()),
                    None,
                    false,
                );
                self.safe.offers.clear();
                if let Some(keeper) = &self.safe.keeper {
                    keeper.take_over(offer);
                    self.safe.has_copy = true;
                    let unread = problems::unread_text(&self.ctx, self.editor.document());
                    self.safe.cadence.kept_now(version_of(self.editor.document(), unread.as_deref()));
                }
            }
            Err(Report(problems)) => {
                if let Some(problem) = problems.first() {
                    self.toast(problem.to_string(), None, true);
                }
            }
        }
    }
}
