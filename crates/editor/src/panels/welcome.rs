//! The welcome sheet: three steps to begin with, a few settings, and what to open.

use egui::{Align, Align2, Layout, Rect, RichText, Sense, Ui, vec2};
use impasto_editor_model::keymap::{Action, Keymap, Modifiers, Preset, Scope};

use super::{row, row_from_right, within};
use crate::icons::{self, Icon};
use crate::theme::{Theme, Tokens, measure, type_face};
use crate::widgets::{self, Button, sheet};

/// The choices on the sheet; each takes effect at once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Choices {
    /// Whose key bindings are used.
    pub keys: Preset,
    /// Dark or light.
    pub theme: Theme,
    /// The scale of the interface; 1 is 100 %.
    pub scale: f32,
    /// Whether the sheet shows when the editor starts.
    pub at_start: bool,
}

/// How the sheet was left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Left {
    /// To open a mesh.
    OpenMesh,
    /// To open the still life that comes with Impasto.
    StillLife,
    /// To open a scene.
    OpenScene,
    /// To work on the scene behind the sheet.
    Closed,
}

const WIDTH: f32 = 720.0;
const HEIGHT: f32 = 412.0;
const CARD: f32 = 148.0;
const SIZES: [(f32, &str, &str); 4] = [
    (0.9, "90 %", "Interface size 90 %"),
    (1.0, "100 %", "Interface size 100 %"),
    (1.25, "125 %", "Interface size 125 %"),
    (1.5, "150 %", "Interface size 150 %"),
];

/// Shows the sheet over everything. Returns how the user left it, once that happens.
pub fn welcome(ctx: &egui::Context, choices: &mut Choices) -> Option<Left> {
    sheet(ctx, "Welcome", WIDTH, |ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        ui.set_min_height(HEIGHT - 2.0 * measure::SHEET_PADDING - 2.0);
        let close = head(ui);
        ui.add_space(18.0);
        cards(ui, &Keymap { preset: choices.keys, ..Keymap::default() });
        ui.add_space(14.0);
        settings(ui, choices);
        ui.add_space(22.0);
        let line = ui.available_rect_before_wrap();
        ui.painter().hline(line.x_range(), line.top(), (1.0, Tokens::of(ui).div));
        ui.add_space(18.0);
        let keymap = Keymap { preset: choices.keys, ..Keymap::default() };
        let left = buttons(ui, choices).or(opens(ui, &keymap).then_some(Left::OpenScene));
        let escape = ui.input(|input| input.key_pressed(egui::Key::Escape));
        left.or((close || escape).then_some(Left::Closed))
    })
}

/// Whether the user pressed the shortcut that opens a scene. The first card shows this shortcut.
fn opens(ui: &Ui, keymap: &Keymap) -> bool {
    let opens = |event: &egui::Event| {
        let egui::Event::Key { key, pressed: true, modifiers, .. } = event else { return false };
        let held = Modifiers { ctrl: modifiers.command, shift: modifiers.shift, alt: modifiers.alt };
        widgets::key_of(*key)
            .is_some_and(|key| keymap.action_for(key, held, Scope::Arrange) == Some(Action::OpenScene))
    };
    ui.input(|input| input.events.iter().any(opens))
}

fn head(ui: &mut Ui) -> bool {
    let tokens = Tokens::of(ui);
    let top = ui.max_rect();
    ui.label(RichText::new("Paint a scene in three steps").font(type_face::sheet_title()).color(tokens.text));
    ui.add_space(4.0);
    let words = "Strokes sit on the model, stay flat on the picture, and turn with what they lie on.";
    ui.label(RichText::new(words).font(type_face::body()).color(tokens.weak));
    let corner = Rect::from_min_size(top.right_top() + vec2(-24.0, 0.0), vec2(28.0, 28.0));
    within(ui, corner, row(), |ui| widgets::icon_button(ui, icons::CLOSE, "Close welcome")).clicked()
}

/// A step: its title, its icon, its text, and its keys, each with a few words on what it does.
type Step<'a> = (&'a str, Icon, &'a str, &'a [(&'a str, &'a str)]);

fn cards(ui: &mut Ui, keymap: &Keymap) {
    let key = |action| keymap.shortcut_text(action).unwrap_or_default();
    let [open, paint, animate, play] =
        [Action::OpenScene, Action::TogglePaint, Action::Animate, Action::Play].map(key);
    let steps: [Step<'_>; 3] = [
        (
            "Open a mesh",
            icons::OBJECT,
            "Drop a mesh anywhere. It is framed, lit and covered with strokes at once.",
            &[(&open, "")],
        ),
        (
            "Comb it",
            icons::COMB,
            "Drag over the surface the way the brush should go. The strokes follow your hand.",
            &[(&paint, "to Paint, then drag")],
        ),
        (
            "Move it",
            icons::ANIMATE,
            "Go to a later frame, drag the object, press play. The strokes turn along.",
            &[(&animate, "to Animate,"), (&play, "plays")],
        ),
    ];
    let wide = (ui.available_width() - 24.0) / 3.0;
    let (row, _) = ui.allocate_exact_size(vec2(ui.available_width(), CARD), Sense::hover());
    for (index, (title, icon, words, keys)) in steps.into_iter().enumerate() {
        let left = row.left() + index as f32 * (wide + 12.0);
        let card = Rect::from_min_size(egui::pos2(left, row.top()), vec2(wide, CARD));
        let tokens = Tokens::of(ui);
        ui.painter().rect_filled(card, 6.0, tokens.alt);
        let middle = card.left_top() + vec2(28.0, 28.0);
        let painter = ui.painter();
        painter.circle_filled(middle, 12.0, tokens.sel);
        let number = (index + 1).to_string();
        painter.text(middle, Align2::CENTER_CENTER, number, type_face::head(), tokens.accent_text);
        painter.text(middle + vec2(20.0, 0.0), Align2::LEFT_CENTER, title, type_face::title(), tokens.text);
        let glyph = (icon.glyph(), type_face::icon(24.0));
        let end = egui::pos2(card.right() - 28.0, middle.y);
        painter.text(end, Align2::CENTER_CENTER, glyph.0, glyph.1, tokens.accent_text);
        let inside = Rect::from_min_max(card.min + vec2(16.0, 52.0), card.max - vec2(14.0, 12.0));
        within(ui, inside, Layout::top_down(Align::Min), |ui| {
            let words = RichText::new(words).font(type_face::body()).line_height(Some(18.0));
            ui.label(words.color(tokens.weak));
            ui.add_space(8.0);
            ui.horizontal(|ui| {
                ui.spacing_mut().item_spacing.x = 5.0;
                for (key, words) in keys {
                    widgets::key_cap(ui, key);
                    ui.label(RichText::new(*words).font(type_face::small()).color(tokens.weak));
                }
            });
        });
    }
}

fn settings(ui: &mut Ui, choices: &mut Choices) {
    let tokens = Tokens::of(ui);
    let labelled_row = |ui: &mut Ui, label: &str, contents: &mut dyn FnMut(&mut Ui)| {
        let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), 26.0), Sense::hover());
        within(ui, rect, row(), |ui| {
            ui.label(RichText::new(label).font(type_face::body()).color(tokens.weak));
        });
        let rect = rect.with_min_x(rect.left() + 164.0);
        within(ui, rect, row(), |ui| {
            ui.spacing_mut().item_spacing.x = 24.0;
            contents(ui);
        });
    };
    labelled_row(ui, "Mouse and keys like", &mut |ui| {
        for (keys, words, name) in
            [(Preset::Blender, "Blender", "Keys like Blender"), (Preset::Maya, "Maya", "Keys like Maya")]
        {
            if widgets::radio_named(ui, words, name, choices.keys == keys).clicked() {
                choices.keys = keys;
            }
        }
        let words = match choices.keys {
            Preset::Blender => "Middle drag orbits, Shift pans, the wheel zooms.",
            Preset::Maya => "Alt and left drag orbits, middle pans, the wheel zooms.",
        };
        ui.label(RichText::new(words).font(type_face::small()).color(tokens.weak));
    });
    ui.add_space(8.0);
    labelled_row(ui, "Theme", &mut |ui| {
        for (theme, name) in [(Theme::Dark, "Dark"), (Theme::Light, "Light")] {
            if widgets::radio(ui, name, choices.theme == theme).clicked() {
                choices.theme = theme;
            }
        }
        ui.with_layout(row_from_right(), |ui| {
            let names = SIZES.map(|(_, words, name)| (words, name));
            let mut size = SIZES.iter().position(|(scale, ..)| *scale == choices.scale).unwrap_or(usize::MAX);
            if widgets::segmented_named(ui, &names, &mut size).changed() {
                choices.scale = SIZES.get(size).map_or(1.0, |size| size.0);
            }
            ui.label(RichText::new("Interface size").font(type_face::body()).color(tokens.weak));
        });
    });
}

fn buttons(ui: &mut Ui, choices: &mut Choices) -> Option<Left> {
    let mut left = None;
    ui.horizontal(|ui| {
        let mesh = Button::new("Open a mesh\u{2026}").name("Open a mesh").icon(icons::OPEN_FOLDER).primary();
        let scene = Button::new("Open a scene\u{2026}").name("Open a scene").plain();
        let still_life = Button::new("Try the still life").icon(icons::SHADING);
        for (button, leaves) in
            [(mesh, Left::OpenMesh), (still_life, Left::StillLife), (scene, Left::OpenScene)]
        {
            if button.on_sheet().show(ui).clicked() {
                left = Some(leaves);
            }
        }
        ui.with_layout(row_from_right(), |ui| {
            let mut never = !choices.at_start;
            widgets::checkbox(ui, "Don't show this at start", &mut never);
            choices.at_start = !never;
        });
    });
    left
}
