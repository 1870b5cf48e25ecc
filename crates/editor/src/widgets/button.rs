//! Widgets: buttons with words or an icon.

use egui::{Align2, Color32, Response, Role, Sense, Ui, vec2};

use super::draw;
use crate::icons::Icon;
use crate::theme::{Tokens, measure, type_face};

/// How much a button stands out.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Weight {
    Plain,
    Usual,
    /// What most users want; only one button of a group.
    Primary,
    Danger,
}

/// A button with words, and an icon before them if it has one.
pub struct Button<'a> {
    words: &'a str,
    name: &'a str,
    icon: Option<Icon>,
    weight: Weight,
    on: Option<bool>,
    height: f32,
}

impl<'a> Button<'a> {
    /// A button that reads `words`, which are also its name.
    pub fn new(words: &'a str) -> Self {
        Self { words, name: words, icon: None, weight: Weight::Usual, on: None, height: measure::BUTTON }
    }

    /// The name, if it differs from the words.
    pub fn name(self, name: &'a str) -> Self {
        Self { name, ..self }
    }

    /// An icon before the words.
    pub fn icon(self, icon: Icon) -> Self {
        Self { icon: Some(icon), ..self }
    }

    /// Filled with the accent colour, for what most users want.
    pub fn primary(self) -> Self {
        Self { weight: Weight::Primary, ..self }
    }

    /// No fill until the pointer is over it.
    pub fn plain(self) -> Self {
        Self { weight: Weight::Plain, ..self }
    }

    /// Words in vermilion, for an action that removes something.
    pub fn danger(self) -> Self {
        Self { weight: Weight::Danger, ..self }
    }

    /// A button that stays on or off.
    pub fn on(self, on: bool) -> Self {
        Self { on: Some(on), ..self }
    }

    /// As high as the buttons of a sheet.
    pub fn on_sheet(self) -> Self {
        Self { height: measure::SHEET_BUTTON, ..self }
    }

    /// Draws it. Clicked by the pointer, `Space` or `Enter`.
    pub fn show(self, ui: &mut Ui) -> Response {
        let tokens = Tokens::of(ui);
        let primary = self.weight == Weight::Primary;
        let font = if primary { type_face::head() } else { type_face::body() };
        let before = self.icon.map_or(0.0, |_| measure::ICON + 6.0);
        let padding = if self.height > measure::BUTTON { 16.0 } else { 12.0 };
        let wide = draw::width(ui, self.words, font.clone()) + before + 2.0 * padding;
        let (rect, response) = ui.allocate_exact_size(vec2(wide, self.height), Sense::click());
        let on = self.on == Some(true);
        let (rest, mut colour) = match self.weight {
            Weight::Primary => (tokens.accent, tokens.on_accent),
            Weight::Danger => (tokens.wid, tokens.vermilion),
            Weight::Plain => (Color32::TRANSPARENT, tokens.text),
            Weight::Usual => (tokens.wid, tokens.text),
        };
        let mut fill = draw::fill(tokens, &response, rest);
        if primary {
            let dark = if response.is_pointer_button_down_on() { 0.82 } else { 1.0 };
            let light = if response.hovered() { 0.92 } else { 1.0 };
            fill = tokens.accent.gamma_multiply(dark * light).to_opaque();
        } else if on {
            (fill, colour) = (tokens.sel, tokens.accent_text);
        } else if response.hovered() && self.weight == Weight::Danger {
            colour = tokens.text;
        }
        let painter = ui.painter();
        painter.rect_filled(rect, draw::corner(), fill);
        let mut at = rect.left_center() + vec2(padding, 0.0);
        if let Some(icon) = self.icon {
            draw::icon(painter, at + vec2(measure::ICON / 2.0, 0.0), icon, measure::ICON, colour);
            at.x += before;
        }
        draw::words(painter, at, Align2::LEFT_CENTER, self.words, font, colour);
        draw::focus_ring(ui, &response, rect, measure::CORNER);
        match self.on {
            Some(on) => draw::named_state(&response, Role::Button, self.name, on),
            None => draw::named(&response, Role::Button, self.name),
        }
        response
    }
}

/// A button for what most users want, filled with the accent colour.
pub fn primary_button(ui: &mut Ui, words: &str) -> Response {
    Button::new(words).primary().show(ui)
}

/// A square button of one icon, 28 points; it fills when the pointer is over it.
pub fn icon_button(ui: &mut Ui, icon: Icon, name: &str) -> Response {
    let response = square(ui, icon, None, Color32::TRANSPARENT);
    draw::named(&response, Role::Button, name);
    response
}

/// As [`icon_button`], filled like the field that it stands in for.
pub fn field_button(ui: &mut Ui, icon: Icon, name: &str) -> Response {
    let rest = Tokens::of(ui).field;
    let response = square(ui, icon, None, rest);
    draw::named(&response, Role::Button, name);
    response
}

/// A square button of one icon that stays on or off.
pub fn icon_toggle(ui: &mut Ui, icon: Icon, name: &str, on: &mut bool) -> Response {
    let mut response = square(ui, icon, Some(*on), Color32::TRANSPARENT);
    if response.clicked() {
        *on = !*on;
        response.mark_changed();
    }
    draw::named_state(&response, Role::Button, name, *on);
    response
}

fn square(ui: &mut Ui, icon: Icon, on: Option<bool>, rest: Color32) -> Response {
    let tokens = Tokens::of(ui);
    let side = if on.is_some() { 26.0 } else { measure::BUTTON };
    let (rect, response) = ui.allocate_exact_size(vec2(side, side), Sense::click());
    let (rest, colour) =
        if on == Some(true) { (tokens.sel, tokens.accent_text) } else { (rest, tokens.text) };
    let fill = if on == Some(true) { rest } else { draw::fill(tokens, &response, rest) };
    ui.painter().rect_filled(rect, draw::corner(), fill);
    draw::icon(ui.painter(), rect.center(), icon, measure::ICON, colour);
    draw::focus_ring(ui, &response, rect, measure::CORNER);
    response
}
