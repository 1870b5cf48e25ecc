//! The bar along the top: menus, undo, the document's name, the mode, commands.

use egui::{Align2, Panel, Response, RichText, Role, Sense, Ui, WidgetInfo, vec2};
use impasto_editor_model::keymap::Action;
use impasto_editor_model::session::Mode;

use super::{Ask, PanelInput, divider, menus, row, row_from_right, text_width, within};
use crate::icons::{self, Icon};
use crate::theme::{Tokens, measure, type_face};
use crate::widgets::{self, Button, Tip};

/// In a window at least this wide, in points, the bars show controls that are behind a button in narrower ones.
pub(super) const WIDE: f32 = 1600.0;
/// The mode switch begins at least this far from the left, in points, which leaves room for the document's name. In a
/// narrow window it begins further left, if need be at [`LEFT`], so that the controls at its right fit. If they do not
/// fit even so, it stays where it begins in a wide one.
const SWITCH_LEFT: f32 = 525.0;
/// Room for the menus and for undo at the left end, points.
const LEFT: f32 = 346.0;
/// Room for the controls at the right end in a narrow window, points.
const RIGHT: f32 = 152.0;
const SWITCH_WIDTH: f32 = 278.0;
const MODES: [Mode; 3] = [Mode::Arrange, Mode::Paint, Mode::Animate];

/// Takes the top 40 points of `ui`.
pub fn top_bar(ui: &mut Ui, shown: &PanelInput<'_>, asks: &mut Vec<Ask>) {
    let frame = egui::Frame::new().fill(Tokens::of(ui).alt);
    Panel::top("top bar").exact_size(measure::TOP_BAR).resizable(false).frame(frame).show(ui, |ui| {
        let whole = ui.max_rect();
        let room = whole.width() - SWITCH_WIDTH - RIGHT;
        let most = if room < LEFT { SWITCH_LEFT } else { room.min(SWITCH_LEFT) };
        let switch = whole.left() + most.max((whole.width() - SWITCH_WIDTH) / 2.0);
        let part = |left: f32, right: f32| egui::Rect::from_x_y_ranges(left..=right, whole.y_range());
        let end = switch + SWITCH_WIDTH + measure::GAP;
        within(ui, part(whole.left(), switch - 6.0), row(), |ui| left(ui, shown, asks));
        within(ui, part(switch, end), row(), |ui| modes(ui, shown, asks));
        within(ui, part(end, whole.right()), row_from_right(), |ui| right(ui, shown, asks));
    });
}

fn left(ui: &mut Ui, shown: &PanelInput<'_>, asks: &mut Vec<Ask>) {
    ui.spacing_mut().item_spacing.x = 0.0;
    ui.add_space(15.0);
    let mark = RichText::new(icons::APP.glyph()).font(type_face::icon(measure::ICON));
    ui.label(mark.color(Tokens::of(ui).accent_text));
    ui.add_space(6.0);
    menus::menus(ui, shown, asks);
    ui.add_space(8.0);
    divider(ui);
    ui.add_space(5.0);
    for (action, icon, entry) in [
        (Action::Undo, icons::UNDO, shown.document.undo_text()),
        (Action::Redo, icons::REDO, shown.document.redo_text()),
    ] {
        if undo_button(ui, shown, action, icon, entry).clicked() {
            asks.push(Ask::Act(action));
        }
        ui.add_space(4.0);
    }
    ui.add_space(6.0);
    document(ui, shown, asks);
}

/// The button for undo or redo; its tooltip names the entry of the history.
fn undo_button(
    ui: &mut Ui,
    shown: &PanelInput<'_>,
    action: Action,
    icon: Icon,
    entry: Option<&str>,
) -> Response {
    let response =
        ui.add_enabled_ui(entry.is_some(), |ui| widgets::icon_button(ui, icon, action.name())).inner;
    match entry {
        Some(entry) => {
            ui.ctx().accesskit_node_builder(response.id, |node| node.set_description(entry));
            let name = format!("{} {entry}", action.name());
            Tip { name: &name, key: &shown.keys_of(action), effect: "", range: "" }.on(response)
        }
        None => response.on_disabled_hover_text(shown.why_not(action).unwrap_or_default()),
    }
}

/// The least room for the document's name if words such as *edited* stand beside it, points.
const LEAST_NAME: f32 = 48.0;

/// The document's name; it is cut off with an ellipsis if it would reach the mode switch.
fn document(ui: &mut Ui, shown: &PanelInput<'_>, asks: &mut Vec<Ask>) {
    let tokens = Tokens::of(ui);
    let (name, edited) = (shown.document.name(), shown.document.is_edited());
    let off = shown.document.saving_loses();
    let words = match (off, edited) {
        (true, _) => "saving over it is off",
        (false, true) => "edited",
        (false, false) => "",
    };
    let of_words = text_width(ui, words, type_face::small()) + if off { 4.0 } else { 0.0 };
    // If there is no room for the words, only the dot or the lock is shown.
    let has_room = ui.available_width() >= LEAST_NAME + 22.0 + of_words;
    let mark = match words {
        "" => 0.0,
        _ if has_room => 22.0 + of_words,
        _ => 22.0,
    };
    let mut job = egui::text::LayoutJob::simple_singleline(name.clone(), type_face::body(), tokens.text);
    job.wrap = egui::text::TextWrapping::truncate_at_width((ui.available_width() - mark).max(24.0));
    let galley = ui.painter().layout_job(job);
    let size = vec2(galley.size().x + mark, measure::BUTTON);
    let (rect, response) = ui.allocate_exact_size(size, if off { Sense::click() } else { Sense::hover() });
    let name_right = rect.left() + galley.size().x;
    let at = Align2::LEFT_CENTER.anchor_size(rect.left_center(), galley.size()).min;
    ui.painter().galley(at, galley, tokens.text);
    let beside = |right: f32| egui::pos2(name_right + right, rect.center().y);
    if off {
        let font = type_face::icon(measure::SMALL_ICON);
        let (glyph, colour) = (icons::LOCKED.glyph(), tokens.vermilion);
        ui.painter().text(beside(14.0), Align2::CENTER_CENTER, glyph, font, colour);
        let words = if has_room { words } else { "" };
        ui.painter().text(beside(26.0), Align2::LEFT_CENTER, words, type_face::small(), colour);
    } else if edited {
        ui.painter().circle_filled(beside(11.0), 3.5, tokens.ochre);
        let words = if has_room { words } else { "" };
        ui.painter().text(beside(20.0), Align2::LEFT_CENTER, words, type_face::small(), tokens.weak);
    }
    response.widget_info(|| WidgetInfo::labeled(Role::Status, true, "Document"));
    let also = |is: bool, words: &str| if is { format!(", {words}") } else { String::new() };
    let spoken = format!("{name}{}{}", also(edited, "edited"), also(off, "saving over it is off"));
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_value(spoken));
    let file = shown.document.file().map(|file| file.display().to_string()).unwrap_or_default();
    if off {
        let words = format!("{file}\nClick for the list of problems.");
        asks.extend(response.on_hover_text(words).clicked().then_some(Ask::ShowProblems));
    } else if !file.is_empty() {
        response.on_hover_text(file);
    }
}

fn modes(ui: &mut Ui, shown: &PanelInput<'_>, asks: &mut Vec<Ask>) {
    let session = shown.session;
    let mut mode = MODES.iter().position(|mode| *mode == session.mode).unwrap_or(0);
    if widgets::mode_switch(ui, &mut mode).changed() {
        asks.push(Ask::Act([Action::Arrange, Action::Paint, Action::Animate][mode]));
    }
}

/// The controls at the right end, from right to left.
fn right(ui: &mut Ui, shown: &PanelInput<'_>, asks: &mut Vec<Ask>) {
    ui.spacing_mut().item_spacing.x = measure::GAP;
    ui.add_space(measure::GAP);
    let reason = shown.why_not(Action::Render);
    let render = Button::new("Render\u{2026}").name("Render").icon(icons::RENDER);
    let response = ui.add_enabled_ui(reason.is_none(), |ui| render.show(ui)).inner;
    if response.on_disabled_hover_text(reason.unwrap_or_default()).clicked() {
        asks.push(Ask::Act(Action::Render));
    }
    let keys = shown.keys_of(Action::Palette);
    let found = if ui.ctx().content_rect().width() >= WIDE {
        search_field(ui, &keys)
    } else {
        let effect = "Finds any command by its name.";
        let response = widgets::field_button(ui, icons::SEARCH, Action::Palette.name());
        Tip { name: Action::Palette.name(), key: &keys, effect, range: "" }.on(response)
    };
    if found.clicked() {
        asks.push(Ask::Act(Action::Palette));
    }
}

/// A button that looks like a field, 220 points wide, and opens the search.
fn search_field(ui: &mut Ui, keys: &str) -> Response {
    let tokens = Tokens::of(ui);
    let (rect, response) = ui.allocate_exact_size(vec2(220.0, measure::BUTTON), Sense::click());
    let fill = if response.hovered() { tokens.hov } else { tokens.field };
    let (colour, painter) = (if response.hovered() { tokens.text } else { tokens.weak }, ui.painter());
    painter.rect_filled(rect, measure::CORNER, fill);
    let at = rect.left_center();
    let glyph = (icons::SEARCH.glyph(), type_face::icon(measure::ICON));
    painter.text(at + vec2(17.0, 0.0), Align2::CENTER_CENTER, glyph.0, glyph.1, tokens.text);
    painter.text(at + vec2(32.0, 0.0), Align2::LEFT_CENTER, "Find a command", type_face::body(), colour);
    let cap = text_width(ui, keys, egui::FontId::monospace(11.0)) + 10.0;
    let cap_rect =
        egui::Rect::from_center_size(rect.right_center() - vec2(cap / 2.0 + 6.0, 0.0), vec2(cap, 16.0));
    within(ui, cap_rect, row(), |ui| widgets::key_cap(ui, keys));
    if response.has_focus() {
        let ring = egui::Stroke::new(2.0, tokens.accent_text);
        ui.painter().rect_stroke(rect.expand(1.0), measure::CORNER + 1.0, ring, egui::StrokeKind::Outside);
    }
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, Action::Palette.name()));
    response
}
