//! The pieces that the inspector is built from: sections, labelled rows, names, colours, the eye and the lock.

use egui::text::{LayoutJob, TextWrapping};
use egui::{
    Align, Color32, Frame, Id, Layout, Margin, Rect, Response, RichText, Role, Sense, Ui, WidgetInfo, vec2,
};
use impasto_editor_model::Item;
use impasto_editor_model::command::{Command, Edit};
use impasto_scene::document::Color;

use super::Asker;
use crate::icons::{self, Icon};
use crate::panels::Ask;
use crate::panels::column_state::ColumnState;
use crate::theme::{Tokens, measure, type_face};
use crate::widgets::{self, Tip};

/// From this window width on, in points, more sections start open.
const WIDE: f32 = 1600.0;
/// Room for the eye and the lock at a head's end.
const HEAD_END: f32 = 64.0;

/// Whether the window is wide enough for more sections to start open.
pub(super) fn is_wide(ui: &Ui) -> bool {
    ui.ctx().content_rect().width() >= WIDE
}

/// A section that opens and folds; `note` is at the right end of its head.
pub(super) fn section(
    ui: &mut Ui,
    name: &str,
    note: &str,
    open_at_first: bool,
    contents: impl FnOnce(&mut Ui),
) {
    let key = ColumnState::key_of(name);
    let (known, all_open) =
        ColumnState::with(ui.ctx(), |state| (state.sections.get(key).copied(), state.all_open));
    let mut open = all_open || known.unwrap_or(open_at_first);
    widgets::enter_part(ui.ctx(), name);
    if widgets::section(ui, name, note, &mut open).changed() {
        ColumnState::with(ui.ctx(), |state| state.sections.insert(key.to_owned(), open));
    }
    if open {
        body(ui, contents);
    }
}

/// Rows with the panel's padding.
pub(super) fn body(ui: &mut Ui, contents: impl FnOnce(&mut Ui)) {
    Frame::new().inner_margin(Margin { left: 12, right: 12, top: 0, bottom: 4 }).show(ui, |ui| {
        ui.spacing_mut().item_spacing.y = 4.0;
        contents(ui);
    });
}

/// A row with a label at its left, which is as wide as the labels of numbers.
pub(super) fn row<R>(ui: &mut Ui, label: &str, contents: impl FnOnce(&mut Ui) -> R) -> R {
    row_with(ui, label, measure::LABEL, contents)
}

/// As [`row`], with a label `wide` points wide.
pub(super) fn row_with<R>(ui: &mut Ui, label: &str, wide: f32, contents: impl FnOnce(&mut Ui) -> R) -> R {
    ui.horizontal(|ui| {
        ui.set_min_height(measure::FIELD);
        let gap = ui.spacing().item_spacing.x;
        let (rect, _) = ui.allocate_exact_size(vec2(wide - gap, measure::FIELD), Sense::hover());
        paint_label(ui, rect, label);
        contents(ui)
    })
    .inner
}

/// Paints a label, without an accessibility node: a screen reader gets the name from the control beside it.
fn paint_label(ui: &Ui, rect: Rect, label: &str) {
    let weak = Tokens::of(ui).weak;
    let mut job = LayoutJob::simple_singleline(label.to_owned(), type_face::body(), weak);
    job.wrap = TextWrapping::truncate_at_width(rect.width());
    let galley = ui.painter().layout_job(job);
    let at = egui::Align2::LEFT_CENTER.anchor_size(rect.left_center(), galley.size());
    ui.painter().galley(at.min, galley, weak);
}

/// Small weak words over the whole width.
pub(super) fn note(ui: &mut Ui, words: &str) {
    let weak = Tokens::of(ui).weak;
    ui.add(egui::Label::new(RichText::new(words).font(type_face::small()).color(weak)).wrap());
}

/// The head of the inspector, for example with an icon, a name and a note. [`at_end`] lays out what stands at its right
/// end.
pub(super) fn head(ui: &mut Ui, contents: impl FnOnce(&mut Ui)) {
    let tokens = Tokens::of(ui);
    ui.painter().hline(ui.max_rect().x_range(), ui.cursor().top() + 0.5, (1.0, tokens.div));
    ui.horizontal(|ui| {
        ui.set_height(37.0);
        ui.add_space(8.0);
        contents(ui);
    });
}

/// Lays out the right end of a head, from right to left.
pub(super) fn at_end(ui: &mut Ui, contents: impl FnOnce(&mut Ui)) {
    ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
        ui.add_space(6.0);
        ui.spacing_mut().item_spacing.x = 0.0;
        contents(ui);
    });
}

/// Small weak words in a head, which leave room for what stands at its end.
pub(super) fn head_note(ui: &mut Ui, words: &str) {
    let weak = Tokens::of(ui).weak;
    ui.scope(|ui| {
        ui.set_max_width((ui.available_width() - HEAD_END).max(0.0));
        ui.add(egui::Label::new(RichText::new(words).font(type_face::small()).color(weak)).truncate());
    });
}

pub(super) fn head_icon(ui: &mut Ui, icon: Icon, colour: Color32) {
    let (rect, _) = ui.allocate_exact_size(vec2(measure::HIT, measure::HIT), Sense::hover());
    let font = type_face::icon(measure::ICON);
    ui.painter().text(rect.center(), egui::Align2::CENTER_CENTER, icon.glyph(), font, colour);
}

/// One line of text to edit; in a head, it is as wide as its words. Returns the new text when the line loses the focus,
/// unless it equals `current` or `Esc` was pressed.
pub(super) fn text(ui: &mut Ui, name: &str, key: Id, current: &str, look: FieldStyle) -> Option<String> {
    let id = key.with(name);
    let draft: Option<String> = ui.data(|data| data.get_temp(id.with("draft")));
    let mut typed = draft.clone().unwrap_or_else(|| current.to_owned());
    let tokens = Tokens::of(ui);
    let (font, colour) = match look {
        FieldStyle::Head => (type_face::head(), tokens.text),
        FieldStyle::Field => (type_face::number(), tokens.text),
        FieldStyle::Wrong => (type_face::number(), tokens.vermilion),
    };
    let room = ui.available_width();
    let wide = match look {
        FieldStyle::Head => {
            let words = ui.painter().layout_no_wrap(typed.clone(), font.clone(), colour).size().x;
            (words + 3.0).clamp(24.0, (room - HEAD_END).max(24.0))
        }
        FieldStyle::Field | FieldStyle::Wrong => room - 16.0,
    };
    let frame = match look {
        FieldStyle::Head => Frame::NONE,
        FieldStyle::Field => Frame::new().fill(tokens.field).corner_radius(4.0),
        FieldStyle::Wrong => {
            Frame::new().fill(tokens.field).corner_radius(4.0).stroke((1.0, tokens.vermilion))
        }
    };
    let margin = if look == FieldStyle::Head { Margin::symmetric(0, 4) } else { Margin::symmetric(8, 4) };
    let edit = egui::TextEdit::singleline(&mut typed)
        .id(id)
        .font(font)
        .text_color(colour)
        .frame(frame.inner_margin(margin))
        .desired_width(wide);
    let response = ui.add(edit);
    widgets::reached(&response, name);
    response.widget_info(|| {
        let mut info = WidgetInfo::labeled(Role::TextInput, true, name);
        info.current_text_value = Some(typed.clone());
        info
    });
    if response.lost_focus() {
        ui.data_mut(|data| data.remove::<String>(id.with("draft")));
        let dropped = ui.input(|input| input.key_pressed(egui::Key::Escape));
        return (!dropped && typed != current).then_some(typed);
    }
    if response.has_focus() {
        ui.data_mut(|data| data.insert_temp(id.with("draft"), typed));
    }
    None
}

/// How a line of text looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FieldStyle {
    Head,
    Field,
    /// As a field with something wrong in it.
    Wrong,
}

/// A small icon to reset a setting to its default. Returns whether it was clicked.
pub(super) fn reset(ui: &mut Ui, name: &str) -> bool {
    let (rect, response) = ui.allocate_exact_size(vec2(measure::ROW_END, measure::HIT), Sense::click());
    let tokens = Tokens::of(ui);
    let colour = if response.hovered() { tokens.text } else { tokens.weak };
    let font = type_face::icon(14.0);
    ui.painter().text(rect.center(), egui::Align2::CENTER_CENTER, icons::UNDO.glyph(), font, colour);
    let name = format!("Reset {name}");
    widgets::reached(&response, &name);
    if response.has_focus() {
        let ring = egui::Stroke::new(2.0, tokens.accent_text);
        ui.painter().rect_stroke(rect, 4.0, ring, egui::StrokeKind::Inside);
    }
    response.widget_info(|| WidgetInfo::labeled(Role::Button, response.enabled(), &name));
    response.clicked()
}

/// A combo with a tooltip; returns the choice if another one was picked.
pub(super) fn pick(ui: &mut Ui, tip: Tip<'_>, choices: &[&str], chosen: usize) -> Option<usize> {
    let mut picked = chosen;
    let response = widgets::combo(ui, tip.name, None, choices, &mut picked);
    tip.on(response);
    (picked != chosen).then_some(picked)
}

/// A scene's colour, converted for egui.
pub(super) fn seen(Color(channels): Color) -> Color32 {
    let [r, g, b] = channels.map(|channel| (channel.clamp(0.0, 1.0) * 255.0).round() as u8);
    Color32::from_rgb(r, g, b)
}

impl Asker<'_, '_> {
    /// A square of colour with its picker. While the pointer is down, the picked colour is only previewed. When the
    /// pointer is released, the change becomes one entry of the history.
    pub(super) fn colour(
        &mut self,
        ui: &mut Ui,
        name: &str,
        shown: Color32,
        command: impl Fn(Color) -> Command,
    ) -> Response {
        let mut picked = shown;
        let response = widgets::color_square(ui, name, &mut picked);
        let draft_id = response.id.with("picked");
        let held = ui.input(|input| input.pointer.any_down());
        let of = |colour: Color32| {
            let [r, g, b, _] = colour.to_array();
            Color([r, g, b].map(|channel| f32::from(channel) / 255.0))
        };
        if response.changed() && held {
            ui.data_mut(|data| data.insert_temp(draft_id, picked));
            self.asks.push(Ask::Preview(command(of(picked))));
        } else if !held {
            let draft: Option<Color32> = ui.data_mut(|data| data.remove_temp(draft_id));
            let last = if response.changed() { Some(picked) } else { draft };
            if let Some(last) = last {
                self.ask(command(of(last)));
            }
        }
        response
    }

    /// The eye and the lock at the end of a head, which hide and lock the item. With the `kind` *Region* their names
    /// are *Region hidden* and *Region locked*.
    pub(super) fn eye_and_lock(&mut self, ui: &mut Ui, item: &Item, kind: &str, [hidden, locked]: [bool; 2]) {
        let icon = if locked { icons::LOCKED } else { icons::UNLOCKED };
        if small_toggle(ui, icon, &format!("{kind} locked"), locked) {
            self.ask(Command::Edit(Edit::SetLocked(vec![item.clone()], !locked)));
        }
        let icon = if hidden { icons::HIDDEN } else { icons::VISIBLE };
        if small_toggle(ui, icon, &format!("{kind} hidden"), hidden) {
            self.ask(Command::Edit(Edit::SetHidden(vec![item.clone()], !hidden)));
        }
    }

    /// The name in the head; typing another one renames the item.
    pub(super) fn name(&mut self, ui: &mut Ui, label: &str, item: &Item) {
        let key = Id::unique(("name", item));
        if let Some(name) = text(ui, label, key, item.name(), FieldStyle::Head) {
            self.ask(Command::Edit(Edit::Rename(item.clone(), name)));
        }
    }
}

/// A small icon whose shape shows a state. Returns whether it was clicked, to toggle the state.
fn small_toggle(ui: &mut Ui, icon: Icon, name: &str, on: bool) -> bool {
    let (rect, response) = ui.allocate_exact_size(vec2(measure::HIT, measure::HIT), Sense::click());
    let tokens = Tokens::of(ui);
    let colour = if response.hovered() || on { tokens.text } else { tokens.weak };
    let font = type_face::icon(measure::SMALL_ICON);
    ui.painter().text(rect.center(), egui::Align2::CENTER_CENTER, icon.glyph(), font, colour);
    if response.has_focus() {
        let ring = egui::Stroke::new(2.0, tokens.accent_text);
        ui.painter().rect_stroke(rect, 4.0, ring, egui::StrokeKind::Inside);
    }
    widgets::reached(&response, name);
    response.widget_info(|| WidgetInfo::selected(Role::Button, response.enabled(), on, name));
    response.clicked()
}

/// Three numbers of a place or a direction side by side, each with its axis.
pub(super) fn axes(
    ui: &mut Ui,
    label: &str,
    wide: f32,
    mut field: impl FnMut(&mut Ui, (usize, &'static str, String), f32),
) {
    row_with(ui, label, wide, |ui| {
        let gap = ui.spacing().item_spacing.x;
        let width = ((ui.available_width() - 2.0 * gap) / 3.0).floor();
        for (axis, letter) in ["X", "Y", "Z"].into_iter().enumerate() {
            field(ui, (axis, letter, format!("{label} {letter}")), width);
        }
    });
}
