//! The sheet that lists all keyboard shortcuts, and what the mouse does.

use egui::{RichText, ScrollArea, Ui, vec2};
use impasto_editor_model::keymap::{Button, Keymap, Modifiers, Navigation, Preset, Scope};

use super::{Ask, PanelInput, row, row_from_right, within};
use crate::icons;
use crate::theme::{Tokens, measure, type_face};
use crate::widgets::{self, sheet};

const COLUMN: f32 = 256.0;
const ROW: f32 = 20.0;

/// The shortcuts that work in one part of the editor.
struct Group {
    name: &'static str,
    rows: Vec<(&'static str, String)>,
}

/// Shows the sheet over everything. Returns true once it closes.
pub fn shortcuts(ctx: &egui::Context, shown: &PanelInput<'_>, asks: &mut Vec<Ask>) -> bool {
    let room = ctx.content_rect().size() - vec2(48.0, 48.0);
    let inner = room.x.min(1136.0) - 2.0 * measure::SHEET_PADDING;
    let columns = ((inner / COLUMN) as usize).max(1);
    sheet(ctx, "Keys", inner + 2.0 * measure::SHEET_PADDING, |ui| {
        let tokens = Tokens::of(ui);
        let mut close = false;
        ui.horizontal(|ui| {
            ui.label(RichText::new("Keys").font(type_face::sheet_title()).color(tokens.text));
            let like = match shown.keymap.preset {
                Preset::Blender => "like Blender",
                Preset::Maya => "like Maya",
            };
            let like = match shown.keymap.own.is_empty() {
                true => like.to_owned(),
                false => format!("{like}, some changed"),
            };
            ui.label(RichText::new(like).font(type_face::body()).color(tokens.weak));
            ui.with_layout(row_from_right(), |ui| {
                close = widgets::icon_button(ui, icons::CLOSE, "Close keys").clicked();
                if widgets::Button::new("Change keys\u{2026}").name("Change keys").show(ui).clicked() {
                    asks.push(Ask::KeySheet);
                    close = true;
                }
            });
        });
        ui.add_space(measure::GAP);
        let lines = lines(groups(shown.keymap));
        // One more line, because no column may end with a heading.
        let high = lines.len().div_ceil(columns) + 1;
        let most = room.y - 2.0 * measure::SHEET_PADDING - 48.0;
        ScrollArea::vertical().max_height(most).min_scrolled_height(most).show(ui, |ui| {
            ui.horizontal_top(|ui| {
                ui.spacing_mut().item_spacing.x = 0.0;
                for part in in_columns(&lines, high) {
                    ui.allocate_ui(vec2(inner / columns as f32, high as f32 * ROW), |ui| column(ui, part));
                }
            });
        });
        close || ui.input(|input| input.key_pressed(egui::Key::Escape))
    })
}

/// One line of a column: a heading, a shortcut, or an empty line between two groups.
enum Line {
    Head(&'static str),
    Key(&'static str, String),
    Space,
}

fn lines(groups: Vec<Group>) -> Vec<Line> {
    let mut lines = Vec::new();
    for group in groups {
        if !lines.is_empty() {
            lines.push(Line::Space);
        }
        lines.push(Line::Head(group.name));
        lines.extend(group.rows.into_iter().map(|(name, keys)| Line::Key(name, keys)));
    }
    lines
}

/// Divides the lines into columns of at most `high` lines. No column ends with a heading or begins with an empty line.
fn in_columns(mut lines: &[Line], high: usize) -> Vec<&[Line]> {
    let mut columns = Vec::new();
    loop {
        while let [Line::Space, rest @ ..] = lines {
            lines = rest;
        }
        if lines.is_empty() {
            return columns;
        }
        let mut end = lines.len().min(high.max(2));
        if matches!(lines[end - 1], Line::Head(_)) {
            end -= 1;
        }
        let (column, rest) = lines.split_at(end.max(1));
        columns.push(column);
        lines = rest;
    }
}

fn column(ui: &mut Ui, lines: &[Line]) {
    let tokens = Tokens::of(ui);
    let (rect, _) = ui.allocate_exact_size(ui.available_size(), egui::Sense::hover());
    for (index, line) in lines.iter().enumerate() {
        let top = rect.left_top() + vec2(0.0, index as f32 * ROW);
        let place = egui::Rect::from_min_size(top, vec2(rect.width() - 20.0, ROW));
        match line {
            Line::Head(name) => within(ui, place, row(), |ui| {
                ui.label(RichText::new(*name).font(type_face::head()).color(tokens.text));
            }),
            Line::Key(name, keys) => {
                within(ui, place, row(), |ui| {
                    ui.label(RichText::new(*name).font(type_face::small()).color(tokens.weak));
                });
                within(ui, place, row_from_right(), |ui| {
                    let keys = RichText::new(keys).font(egui::FontId::monospace(11.0));
                    ui.label(keys.color(tokens.text));
                });
            }
            Line::Space => (),
        }
    }
}

fn groups(keymap: &Keymap) -> Vec<Group> {
    let listed: Vec<_> = keymap.listed().collect();
    let of = |name, scopes: &[Option<Scope>]| {
        let within = listed.iter().filter(|line| scopes.contains(&line.scope));
        Group { name, rows: within.map(|line| (line.action.name(), line.keys.clone())).collect() }
    };
    vec![
        of("Everywhere", &[None]),
        of("Arrange and Animate", &[Some(Scope::Arrange), Some(Scope::Animate)]),
        of("Paint", &[Some(Scope::Paint)]),
        of("Keys on a lane", &[Some(Scope::Lane)]),
        of("While moving or drawing", &[Some(Scope::Transform), Some(Scope::Drawing)]),
        of("In a field", &[Some(Scope::Typing)]),
        Group { name: "Mouse", rows: mouse(keymap) },
    ]
}

/// What the pointer's buttons do to the view.
fn mouse(keymap: &Keymap) -> Vec<(&'static str, String)> {
    let none = Modifiers::default();
    let held = [
        ("", none),
        ("Shift ", Modifiers { shift: true, ..none }),
        ("Ctrl ", Modifiers { ctrl: true, ..none }),
        ("Alt ", Modifiers { alt: true, ..none }),
    ];
    let buttons = [
        ("Left", Button::Left),
        ("Middle", Button::Middle),
        ("Right", Button::Right),
        ("Wheel", Button::Wheel),
    ];
    let ways = |does: Navigation| {
        let mut ways = Vec::new();
        for (name, button) in buttons {
            let bare = keymap.navigation(button, none) == Some(does);
            for (prefix, modifiers) in held {
                // If the button does this without a modifier, it is not listed again with one.
                let said = bare && modifiers != none;
                if keymap.navigation(button, modifiers) == Some(does) && !said {
                    ways.push(format!("{prefix}{name}"));
                }
            }
        }
        ways.join(", ")
    };
    vec![("Orbit", ways(Navigation::Orbit)), ("Pan", ways(Navigation::Pan)), ("Zoom", ways(Navigation::Zoom))]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_key_of_the_table_is_listed_once() {
        for preset in [Preset::Blender, Preset::Maya] {
            let keymap = Keymap { preset, ..Keymap::default() };
            let shown: usize = groups(&keymap).iter().map(|group| group.rows.len()).sum();
            assert_eq!(shown, keymap.listed().count() + 3, "a scope has no group");
        }
    }

    #[test]
    fn no_column_ends_with_a_head_and_all_fit() {
        for preset in [Preset::Blender, Preset::Maya] {
            let lines = lines(groups(&Keymap { preset, ..Keymap::default() }));
            for count in 1..=5 {
                let columns = in_columns(&lines, lines.len().div_ceil(count) + 1);
                assert!(columns.len() <= count, "{} of {count}", columns.len());
                for column in columns {
                    assert!(!matches!(column, [.., Line::Head(_)] | [Line::Space, ..]));
                }
            }
        }
    }

    #[test]
    fn mouse_buttons_are_listed_as_each_preset_has_them() {
        let of = |preset| mouse(&Keymap { preset, ..Keymap::default() }).into_iter().map(|row| row.1);
        assert!(of(Preset::Blender).eq(["Alt Left, Middle", "Shift Middle", "Ctrl Middle, Wheel"]));
        assert!(of(Preset::Maya).eq(["Alt Left", "Alt Middle", "Alt Right, Wheel"]));
    }
}
