//! Asks for a file: with the desktop's dialog if there is one, else with a sheet in the window.
//!
//! The desktop's dialog can be missing or stuck without reporting it. So it runs on a thread of its own. If it is
//! cancelled sooner than a user could do it, the desktop has no dialog, and the sheet is shown. After [`PATIENCE`]
//! the window offers its own sheet instead.

#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::time::{Duration, Instant};

use egui::{Align2, Area, Context, Frame, Id, Margin, RichText, vec2};
use impasto_editor_model::render_settings::FileKind;

use super::file_ask::FileAsk;
use super::incoming::PICTURES;
use super::path_sheet::{PathSheet, Picked};
use crate::theme::{Theme, measure, type_face};
use crate::widgets::Button;

/// No user cancels a dialog this soon after it was opened.
const FASTEST_CANCEL: Duration = Duration::from_millis(300);

/// How long the window waits for the desktop's dialog before it offers its own sheet.
pub const PATIENCE: Duration = Duration::from_secs(3);

/// The answer to a [`FileAsk`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Answer {
    /// What was asked.
    pub ask: FileAsk,
    /// The file; none if the user cancelled. When saving, its name has the right ending, and an existing file may be
    /// replaced.
    pub path: Option<PathBuf>,
}

/// Where file dialogs come from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Source {
    /// The desktop, if it has them.
    #[default]
    Desktop,
    /// Always the window's own sheet.
    InApp,
}

/// Asks for one file at a time.
pub struct FileDialogs {
    source: Source,
    choose: Choose,
    open: Option<Open>,
}

/// Shows the desktop's dialog and waits for the answer. The path is the start folder or, when saving, the proposed
/// file.
type Choose = fn(FileAsk, &Path) -> Option<PathBuf>;

struct Open {
    ask: FileAsk,
    start: PathBuf,
    since: Instant,
    shown: ShownAs,
}

enum ShownAs {
    Desktop(Receiver<Option<PathBuf>>),
    Sheet(PathSheet),
}

impl FileDialogs {
    /// Dialogs from `source`; from the window if the desktop has none.
    pub fn new(source: Source) -> Self {
        let source = if has_session_bus() { source } else { Source::InApp };
        Self { source, choose: choose_on_desktop, open: None }
    }

    /// Whether a dialog is open; no other can be opened meanwhile.
    pub fn is_open(&self) -> bool {
        self.open.is_some()
    }

    /// Asks for a file. `start` is the folder to start in or, when saving, the proposed file. Does nothing while
    /// another dialog is open.
    pub fn open(&mut self, ctx: &Context, ask: FileAsk, start: &Path) {
        if self.open.is_some() {
            return;
        }
        let shown = match self.source {
            Source::InApp => ShownAs::Sheet(PathSheet::new(ask, start)),
            Source::Desktop => {
                let (answer, answers) = channel();
                let (choose, from, ctx) = (self.choose, start.to_owned(), ctx.clone());
                std::thread::spawn(move || {
                    // Fails once the sheet has replaced the dialog and nobody listens.
                    let _late = answer.send(choose(ask, &from));
                    ctx.request_repaint();
                });
                ShownAs::Desktop(answers)
            }
        };
        self.open = Some(Open { ask, start: start.to_owned(), since: Instant::now(), shown });
        ctx.request_repaint();
    }

    /// The answer, given once; `None` as long as the user has not answered. Call it in every pass, because it shows the
    /// window's own sheet.
    pub fn poll(&mut self, ctx: &Context) -> Option<Answer> {
        let open = self.open.as_mut()?;
        let ask = open.ask;
        let path = match &mut open.shown {
            ShownAs::Sheet(sheet) => match sheet.show(ctx)? {
                Picked::File(path) => Some(path),
                Picked::Cancelled => None,
            },
            ShownAs::Desktop(answers) => match (answers.try_recv(), open.since.elapsed()) {
                (Ok(Some(path)), _) => {
                    let completed = ask.completed(path.clone());
                    // The desktop asked about replacing only the file whose name was typed. The file with the added
                    // ending is another one, so the sheet asks about it.
                    if completed != path && completed.symlink_metadata().is_ok() {
                        open.shown = ShownAs::Sheet(PathSheet::asking_to_replace(ask, &completed));
                        ctx.request_repaint();
                        return None;
                    }
                    Some(completed)
                }
                (Ok(None), waited) if waited > FASTEST_CANCEL => None,
                (Ok(None) | Err(TryRecvError::Disconnected), _) => {
                    // There is no dialog here: do not try it again.
                    self.source = Source::InApp;
                    open.shown = ShownAs::Sheet(PathSheet::new(ask, &open.start));
                    ctx.request_repaint();
                    return None;
                }
                (Err(TryRecvError::Empty), waited) => {
                    match PATIENCE.checked_sub(waited).filter(|rest| !rest.is_zero()) {
                        Some(rest) => {
                            ctx.request_repaint_after(rest);
                            return None;
                        }
                        None => match offer(ctx)? {
                            Offer::Sheet => {
                                open.shown = ShownAs::Sheet(PathSheet::new(ask, &open.start));
                                ctx.request_repaint();
                                return None;
                            }
                            Offer::Cancel => None,
                        },
                    }
                }
            },
        };
        self.open = None;
        Some(Answer { ask, path })
    }
}

enum Offer {
    Sheet,
    Cancel,
}

/// A small bar at the bottom: says that the desktop's dialog is open, and offers the window's own instead.
fn offer(ctx: &Context) -> Option<Offer> {
    let theme = if ctx.global_style().visuals.dark_mode { Theme::Dark } else { Theme::Light };
    let tokens = theme.tokens();
    let area = Area::new(Id::unique("waiting for the desktop's dialog"));
    let area = area.anchor(Align2::CENTER_BOTTOM, vec2(0.0, -(measure::STATUS_LINE + measure::STRIP)));
    let frame =
        Frame::new().fill(tokens.panel).stroke((1.0, tokens.div)).corner_radius(measure::SHEET_CORNER);
    area.show(ctx, |ui| {
        frame
            .inner_margin(Margin::same(12))
            .show(ui, |ui| {
                ui.horizontal(|ui| {
                    let words = "The file dialog of your desktop is open.";
                    ui.label(RichText::new(words).font(type_face::body()).color(tokens.text));
                    if Button::new("Choose here instead").show(ui).clicked() {
                        return Some(Offer::Sheet);
                    }
                    let cancel = Button::new("Cancel").plain().show(ui).clicked();
                    cancel.then_some(Offer::Cancel)
                })
                .inner
            })
            .inner
    })
    .inner
}

/// Whether there is a D-Bus session bus, through which the desktop's dialogs are opened.
fn has_session_bus() -> bool {
    let is_set = |name| std::env::var_os(name).filter(|value| !value.is_empty());
    if is_set("DBUS_SESSION_BUS_ADDRESS").is_some() {
        return true;
    }
    is_set("XDG_RUNTIME_DIR").is_some_and(|folder| PathBuf::from(folder).join("bus").exists())
}

/// The filters that the desktop's dialog offers: the words of each filter, and the endings of its files.
fn filters(ask: FileAsk) -> Vec<(&'static str, Vec<String>)> {
    const SCENES: &[&str] = &["ron"];
    const MESHES: &[&str] = &["obj", "gltf", "glb"];
    const RENDERED: &[&str] = FileKind::PngAndExr.endings();
    const MOVIES: &[&str] = FileKind::Movie.endings();
    let filters: &[(&str, &[&[&str]])] = match ask {
        FileAsk::Open => {
            &[("Scenes and meshes", &[SCENES, MESHES]), ("Scenes", &[SCENES]), ("Meshes", &[MESHES])]
        }
        FileAsk::ImportMesh | FileAsk::LocateMesh => &[("Meshes", &[MESHES])],
        FileAsk::SaveAs | FileAsk::SaveCopy => &[("Scenes", &[SCENES])],
        FileAsk::Missing => &[],
        FileAsk::ChoosePicture => &[("Pictures", &[PICTURES])],
        FileAsk::SavePreset | FileAsk::LoadPreset => &[("Presets", &[&["strokes.ron", "ron"]])],
        FileAsk::RenderOutput { .. } => {
            &[("Pictures and movies", &[RENDERED, MOVIES]), ("Pictures", &[RENDERED]), ("Movies", &[MOVIES])]
        }
    };
    // On some desktops, filters are case-sensitive.
    let both = |ending: &str| [ending.to_owned(), ending.to_ascii_uppercase()];
    let endings = |lists: &[&[&str]]| lists.iter().copied().flatten().copied().flat_map(both).collect();
    filters.iter().map(|(words, lists)| (*words, endings(lists))).collect()
}

fn choose_on_desktop(ask: FileAsk, start: &Path) -> Option<PathBuf> {
    let mut dialog = rfd::FileDialog::new().set_title(ask.title());
    for (words, endings) in filters(ask) {
        dialog = dialog.add_filter(words, &endings);
    }
    if !ask.is_save() {
        return dialog.set_directory(start).pick_file();
    }
    if let Some(folder) = start.parent() {
        dialog = dialog.set_directory(folder);
    }
    if let Some(name) = start.file_name() {
        dialog = dialog.set_file_name(name.to_string_lossy());
    }
    dialog.save_file()
}
