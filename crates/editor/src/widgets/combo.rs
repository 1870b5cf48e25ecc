//! Controls that open a menu: one that picks one of several, and one with a menu of other controls.

use egui::{Align2, Color32, Popup, PopupCloseBehavior, Response, Role, Sense, Ui, vec2};

use super::draw;
use super::reach::reached;
use crate::icons::{self, Icon};
use crate::theme::{Tokens, measure, type_face};

/// Picks one of `choices` from a menu; `chosen` is the index of the one that is picked. With an icon, the control has
/// no fill at rest, as on a chip.
///
/// The response is marked as changed when another one is picked.
pub fn combo(ui: &mut Ui, name: &str, icon: Option<Icon>, choices: &[&str], chosen: &mut usize) -> Response {
    let shown = choices.get(*chosen).copied().unwrap_or_default();
    let mut response = face(ui, name, icon, shown);
    let wide = response.rect.width().max(120.0);
    let mut picked = None;
    Popup::menu(&response).width(wide).show(|ui| {
        for (index, choice) in choices.iter().enumerate() {
            if choice_row(ui, choice, index == *chosen).clicked() {
                picked = Some(index);
            }
        }
    });
    if let Some(index) = picked.filter(|index| index != chosen) {
        *chosen = index;
        response.mark_changed();
    }
    response
}

/// Shows `shown`. A click opens a menu of other controls, which stays open until the user clicks outside it.
pub fn drop_down(ui: &mut Ui, name: &str, shown: &str, contents: impl FnOnce(&mut Ui)) -> Response {
    let response = face(ui, name, None, shown);
    let menu = Popup::menu(&response).close_behavior(PopupCloseBehavior::CloseOnClickOutside);
    menu.show(contents);
    response
}

/// As [`drop_down`], but without the menu. The caller opens a menu on the response.
pub fn drop_down_face(ui: &mut Ui, name: &str, shown: &str) -> Response {
    face(ui, name, None, shown)
}

/// Draws the control itself, without its menu.
fn face(ui: &mut Ui, name: &str, icon: Option<Icon>, shown: &str) -> Response {
    let tokens = Tokens::of(ui);
    let before = icon.map_or(0.0, |_| measure::SMALL_ICON + 6.0);
    let padding = if icon.is_some() { 7.0 } else { 8.0 };
    let size =
        vec2(draw::width(ui, shown, type_face::body()) + before + 2.0 * padding + 18.0, measure::FIELD);
    let (rect, response) = ui.allocate_exact_size(size, Sense::click());
    let rest = if icon.is_some() { Color32::TRANSPARENT } else { tokens.wid };
    let fill = draw::fill(tokens, &response, rest);
    let painter = ui.painter();
    painter.rect_filled(rect, draw::corner(), fill);
    let mut at = rect.left_center() + vec2(padding, 0.0);
    if let Some(icon) = icon {
        draw::icon(
            painter,
            at + vec2(measure::SMALL_ICON / 2.0, 0.0),
            icon,
            measure::SMALL_ICON,
            tokens.text,
        );
        at.x += before;
    }
    draw::words(painter, at, Align2::LEFT_CENTER, shown, type_face::body(), tokens.text);
    let down = rect.right_center() - vec2(padding + 5.0, 0.0);
    draw::icon(painter, down, icons::MENU_DOWN, measure::ICON, tokens.text);
    draw::focus_ring(ui, &response, rect, measure::CORNER);
    reached(&response, name);
    response.widget_info(|| {
        let mut info = egui::WidgetInfo::labeled(Role::ComboBox, response.enabled(), name);
        info.current_text_value = Some(shown.to_owned());
        info
    });
    response
}

/// A row of a menu that picks one of several; `on` tells whether it is the one that is picked.
pub fn choice_row(ui: &mut Ui, words: &str, on: bool) -> Response {
    let tokens = Tokens::of(ui);
    let wide = ui.available_width().max(draw::width(ui, words, type_face::body()) + 40.0);
    let (rect, response) = ui.allocate_exact_size(vec2(wide, measure::ROW), Sense::click());
    let fill = if response.hovered() || response.has_focus() { tokens.hov } else { Color32::TRANSPARENT };
    ui.painter().rect_filled(rect, draw::corner(), fill);
    if on {
        draw::icon(
            ui.painter(),
            rect.left_center() + vec2(14.0, 0.0),
            icons::CHECK,
            16.0,
            tokens.accent_text,
        );
    }
    let at = rect.left_center() + vec2(28.0, 0.0);
    draw::words(ui.painter(), at, Align2::LEFT_CENTER, words, type_face::body(), tokens.text);
    draw::named_state(&response, Role::MenuItemRadio, words, on);
    response
}
