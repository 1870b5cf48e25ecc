//! The window's own file dialog: a list of a folder's files, and a field for a path. It needs nothing from the desktop.

mod listing;
#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};

use egui::{
    Align, Color32, Context, Id, Key, Layout, Modifiers, RichText, ScrollArea, Sense, Stroke, TextEdit, Ui,
    vec2,
};

use impasto_scene::load::strokes_file;
use impasto_scene::whole_file::failure_in_words;

use super::file_ask::FileAsk;
use super::incoming::{Kind, name_of};
use crate::icons;
use crate::theme::{Tokens, measure, type_face};
use crate::widgets::{Button, Dialog, dialog, sheet};
use listing::{ListedFile, Listing, resolve};

/// Width of the sheet, and height of its list, points.
const WIDTH: f32 = 620.0;
const LIST_HEIGHT: f32 = 260.0;

/// The answer of a [`PathSheet`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Picked {
    /// This file. If it is to be saved and exists already, the user has agreed to replace it.
    File(PathBuf),
    /// The user cancelled.
    Cancelled,
}

/// The sheet, while it is open.
pub struct PathSheet {
    ask: FileAsk,
    listing: Listing,
    /// The text of the field.
    typed: String,
    /// Why the file in the field cannot be used.
    error: Option<String>,
    /// The file that would be replaced, while the question about it is open.
    replaces: Option<PathBuf>,
    /// Whether the field takes the focus in the next pass.
    wants_focus: bool,
    /// Whether the name in the field, without its ending, is selected in the next pass.
    selects_name: bool,
    /// The name of the folder that is to be made, while it is typed.
    new_folder: Option<String>,
}

impl PathSheet {
    /// A sheet that starts in the folder `start` or, when saving, with the file `start` in the field.
    pub fn new(ask: FileAsk, start: &Path) -> Self {
        let is_file = ask.is_save() && !start.is_dir();
        let typed = if is_file { name_of(start) } else { String::new() };
        let folder = if is_file { start.parent().unwrap_or(Path::new("")) } else { start };
        let listing = Listing::read(&nearest_folder(folder), ask.kinds());
        Self {
            ask,
            listing,
            typed,
            error: None,
            replaces: None,
            wants_focus: true,
            selects_name: is_file,
            new_folder: None,
        }
    }

    /// A sheet that asks first whether the file `path` may be replaced.
    pub fn asking_to_replace(ask: FileAsk, path: &Path) -> Self {
        let replaces = (!path.is_dir()).then(|| path.to_owned());
        Self { replaces, ..Self::new(ask, path) }
    }

    /// Shows the sheet and returns the answer, once there is one.
    pub fn show(&mut self, ctx: &Context) -> Option<Picked> {
        if let Some(path) = self.replaces.clone() {
            let title = format!("Replace \u{201c}{}\u{201d}?", name_of(&path));
            let words = "A file of this name is there already. What is in it would be lost.";
            let asked = Dialog { title: &title, words, verbs: &["Replace", "Keep it"], cancel: 1 };
            let verb = dialog(ctx, &asked)?;
            self.replaces = None;
            self.wants_focus = true;
            return (verb == 0).then_some(Picked::File(path));
        }
        let mut done = None;
        sheet(ctx, self.ask.title(), WIDTH, |ui| {
            let tokens = Tokens::of(ui);
            ui.spacing_mut().item_spacing.y = measure::GAP;
            ui.label(RichText::new(self.ask.title()).font(type_face::title()).color(tokens.text));
            // Esc leaves the field of a new folder before it leaves the sheet.
            let was_naming = self.new_folder.is_some();
            self.folder(ui);
            done = self.list(ui).or(self.field(ui));
            ui.add_space(measure::GAP);
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                let verb = if self.ask.is_save() { "Save" } else { "Open" };
                if Button::new(verb).on_sheet().primary().show(ui).clicked() {
                    done = self.submit();
                }
                if Button::new("Cancel").on_sheet().show(ui).clicked() {
                    done = Some(Picked::Cancelled);
                }
                if self.ask.is_save() {
                    ui.with_layout(Layout::left_to_right(Align::Center), |ui| self.make_folder(ui));
                }
            });
            if !was_naming && ui.input(|input| input.key_pressed(Key::Escape)) {
                done = Some(Picked::Cancelled);
            }
        });
        done
    }

    /// The path of the listed folder.
    fn folder(&self, ui: &mut Ui) {
        let tokens = Tokens::of(ui);
        let shown = self.listing.folder.display().to_string();
        let text = RichText::new(&shown).font(type_face::small()).color(tokens.weak);
        let label = ui.add(egui::Label::new(text).truncate());
        label.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Group, true, "Folder"));
        ui.ctx().accesskit_node_builder(label.id, |node| node.set_value(shown));
    }

    fn list(&mut self, ui: &mut Ui) -> Option<Picked> {
        let mut chosen = None;
        let mut done = None;
        let rows = self.listing.rows.len();
        let frame = egui::Frame::new().fill(Tokens::of(ui).field).corner_radius(measure::CORNER);
        frame.show(ui, |ui| {
            ui.spacing_mut().item_spacing.y = 0.0;
            let id = ("rows", &self.listing.folder);
            let area = ScrollArea::vertical().id_salt(id).auto_shrink(false).max_height(LIST_HEIGHT);
            area.show_rows(ui, measure::TREE_ROW, rows, |ui, shown| {
                for row in &self.listing.rows[shown] {
                    let is_on = self.typed == row.name();
                    let response = show_row(ui, row, is_on);
                    let enter = response.has_focus() && ui.input(|input| input.key_pressed(Key::Enter));
                    if response.clicked() {
                        chosen = Some((row.clone(), enter || response.double_clicked()));
                    }
                }
            });
        });
        if let Some(words) = &self.listing.note {
            let tokens = Tokens::of(ui);
            ui.label(RichText::new(words).font(type_face::small()).color(tokens.weak));
        }
        match chosen {
            Some((ListedFile::Parent | ListedFile::Folder(_), _)) => {
                if let Some((row, _)) = &chosen {
                    self.enter(row.name());
                }
            }
            Some((ListedFile::File(name), is_final)) => {
                self.typed = name;
                self.error = None;
                if is_final {
                    done = self.submit();
                }
            }
            None => (),
        }
        done
    }

    /// The field for the name, and what is wrong with it.
    fn field(&mut self, ui: &mut Ui) -> Option<Picked> {
        let tokens = Tokens::of(ui);
        let id = Id::unique("file name of the path sheet");
        if ui.memory(|memory| memory.has_focus(id)) {
            self.complete_on_tab(ui, id);
        }
        let line = if self.error.is_some() { tokens.vermilion } else { Color32::TRANSPARENT };
        let frame = egui::Frame::new().stroke(Stroke::new(1.0, line)).corner_radius(measure::CORNER);
        let edit = TextEdit::singleline(&mut self.typed)
            .id(id)
            .font(type_face::body())
            .desired_width(f32::INFINITY)
            .min_size(vec2(0.0, measure::FIELD))
            .hint_text("Name, or a whole path")
            // Tab completes the name, and moves to the next control only if there is nothing to complete.
            .lock_focus(true);
        let response = frame.show(ui, |ui| ui.add(edit)).inner;
        ui.ctx().accesskit_node_builder(response.id, |node| node.set_label("File name"));
        if std::mem::take(&mut self.wants_focus) {
            response.request_focus();
        }
        if std::mem::take(&mut self.selects_name) {
            let typed = Path::new(&self.typed);
            let stem = match self.ask {
                FileAsk::SavePreset => strokes_file::name_of(typed),
                _ => typed.file_stem().unwrap_or_default().to_string_lossy().into_owned(),
            };
            let stem = stem.chars().count();
            let [from, to] = [0, stem].map(|at| egui::text::CCursor::new(egui::text::CharIndex(at)));
            let mut state = TextEdit::load_state(ui.ctx(), id).unwrap_or_default();
            state.cursor.set_char_range(Some(egui::text::CCursorRange::two(from, to)));
            state.store(ui.ctx(), id);
        }
        if response.changed() {
            self.error = None;
        }
        if let Some(words) = &self.error {
            let error = ui.label(RichText::new(words).font(type_face::small()).color(tokens.vermilion));
            ui.ctx().accesskit_node_builder(error.id, |node| node.set_live(egui::accesskit::Live::Assertive));
        }
        let enter = response.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        enter.then(|| self.submit()).flatten()
    }

    fn complete_on_tab(&mut self, ui: &Ui, field: Id) {
        let pressed = |modifiers| ui.input_mut(|input| input.consume_key(modifiers, Key::Tab));
        if pressed(Modifiers::SHIFT) {
            ui.memory_mut(|memory| memory.move_focus(egui::FocusDirection::Previous));
            return;
        }
        if !pressed(Modifiers::NONE) {
            return;
        }
        match self.listing.complete(&self.typed, self.ask.kinds()) {
            Some(longer) => {
                let end = egui::text::CCursor::new(egui::text::CharIndex(longer.chars().count()));
                self.typed = longer;
                self.error = None;
                let mut state = TextEdit::load_state(ui.ctx(), field).unwrap_or_default();
                state.cursor.set_char_range(Some(egui::text::CCursorRange::one(end)));
                state.store(ui.ctx(), field);
            }
            None => ui.memory_mut(|memory| memory.move_focus(egui::FocusDirection::Next)),
        }
    }

    fn enter(&mut self, folder: &str) {
        self.listing = Listing::read(&resolve(&self.listing.folder, folder), self.ask.kinds());
        self.error = None;
        if !self.ask.is_save() {
            self.typed.clear();
        }
    }

    /// The button that makes a folder, or the field for its name.
    fn make_folder(&mut self, ui: &mut Ui) {
        let Some(mut name) = self.new_folder.clone() else {
            if Button::new("New folder").on_sheet().show(ui).clicked() {
                self.new_folder = Some(String::new());
            }
            return;
        };
        let id = Id::unique("name of a new folder");
        let is_fresh = TextEdit::load_state(ui.ctx(), id).is_none();
        let edit = TextEdit::singleline(&mut name).id(id).font(type_face::body()).desired_width(180.0);
        let response = ui.add(edit.hint_text("Name of the folder").min_size(vec2(0.0, measure::FIELD)));
        ui.ctx().accesskit_node_builder(response.id, |node| node.set_label("Folder name"));
        if is_fresh {
            response.request_focus();
        }
        let enter = response.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
        let escape = ui.input(|input| input.key_pressed(Key::Escape));
        if Button::new("Make it").on_sheet().show(ui).clicked() || enter {
            let folder = resolve(&self.listing.folder, name.trim());
            match std::fs::create_dir(&folder) {
                _ if name.trim().is_empty() => self.error = Some("Type a name for the folder".to_owned()),
                Ok(()) => self.enter(&folder.to_string_lossy()),
                Err(error) => {
                    self.error = Some(format!("{} was not made: {}", name.trim(), failure_in_words(&error)))
                }
            }
            self.wants_focus = true;
        }
        let is_done = enter || escape || response.lost_focus();
        self.new_folder = (!is_done).then_some(name);
        if is_done {
            ui.data_mut(|data| data.remove::<egui::text_edit::TextEditState>(id));
        }
    }

    /// Acts on what is in the field: returns a file that can be used, enters a folder, asks before a file is
    /// replaced, or shows why the file cannot be used.
    fn submit(&mut self) -> Option<Picked> {
        self.wants_focus = true;
        match self.judge() {
            Ok(Judged::Folder(folder)) => {
                self.typed.clear();
                self.enter(&folder.to_string_lossy());
                None
            }
            Ok(Judged::Replaces(path)) => {
                self.replaces = Some(path);
                None
            }
            Ok(Judged::File(path)) => Some(Picked::File(path)),
            Err(words) => {
                self.error = Some(words);
                None
            }
        }
    }

    fn judge(&self) -> Result<Judged, String> {
        let typed = self.typed.trim();
        if typed.is_empty() {
            let verb = if self.ask.is_save() { "Type a name" } else { "Choose a file, or type its name" };
            return Err(verb.to_owned());
        }
        let path = resolve(&self.listing.folder, typed);
        if path.is_dir() {
            return Ok(Judged::Folder(path));
        }
        let folder = path.parent().unwrap_or(Path::new("/"));
        if !folder.is_dir() {
            return Err(format!("There is no folder {}", folder.display()));
        }
        if self.ask.is_save() {
            if typed.ends_with('/') {
                return Err(format!("There is no folder {}", path.display()));
            }
            let path = self.ask.completed(path);
            return match std::fs::symlink_metadata(&path) {
                Ok(metadata) if metadata.is_dir() => Err(format!("{} is a folder", name_of(&path))),
                Ok(_) => Ok(Judged::Replaces(path)),
                Err(_) => Ok(Judged::File(path)),
            };
        }
        if !path.is_file() {
            return Err(format!("There is no file {} in {}", name_of(&path), folder.display()));
        }
        self.ask.fits(&path).map(|()| Judged::File(path))
    }
}

enum Judged {
    File(PathBuf),
    Folder(PathBuf),
    /// A save would overwrite this file.
    Replaces(PathBuf),
}

fn show_row(ui: &mut Ui, row: &ListedFile, is_on: bool) -> egui::Response {
    let tokens = Tokens::of(ui);
    let size = vec2(ui.available_width(), measure::TREE_ROW);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    let fill = match (is_on, response.hovered()) {
        (true, _) => tokens.sel,
        (false, true) => tokens.hov,
        (false, false) => Color32::TRANSPARENT,
    };
    ui.painter().rect_filled(rect, measure::CORNER, fill);
    if response.has_focus() {
        let ring = Stroke::new(2.0, tokens.accent_text);
        ui.painter().rect_stroke(rect, measure::CORNER, ring, egui::StrokeKind::Inside);
    }
    let icon = match row {
        ListedFile::Parent | ListedFile::Folder(_) => icons::OPEN_FOLDER,
        ListedFile::File(_) => icons::OBJECT,
    };
    let middle = rect.left_center() + vec2(measure::PANEL_PADDING, 0.0);
    let font = type_face::icon(measure::SMALL_ICON);
    ui.painter().text(middle, egui::Align2::LEFT_CENTER, icon.glyph(), font, tokens.weak);
    let at = middle + vec2(measure::SMALL_ICON + measure::GAP, 0.0);
    let mut job =
        egui::text::LayoutJob::simple_singleline(row.name().to_owned(), type_face::body(), tokens.text);
    job.wrap = egui::text::TextWrapping::truncate_at_width((rect.right() - at.x - measure::GAP).max(0.0));
    let galley = ui.painter().layout_job(job);
    let at = egui::Align2::LEFT_CENTER.anchor_size(at, galley.size()).min;
    ui.painter().galley(at, galley, tokens.text);
    response.widget_info(|| egui::WidgetInfo::selected(egui::Role::Button, true, is_on, row.name()));
    response
}

/// The folder, or its nearest parent that exists.
fn nearest_folder(folder: &Path) -> PathBuf {
    let whole = std::path::absolute(folder)
        .or_else(|_| std::env::current_dir())
        .unwrap_or_else(|_| PathBuf::from("/"));
    let nearest = whole.ancestors().find(|folder| folder.is_dir()).unwrap_or(Path::new("/"));
    // This removes a slash at the end.
    nearest.components().collect()
}
