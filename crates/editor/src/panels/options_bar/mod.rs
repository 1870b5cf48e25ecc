//! The options bar: the settings of the current tool, in one row. Settings that have no room are in a menu at the bar's
//! end, so that no word is ever cut.

mod settings;
#[cfg(test)]
mod tests;

use egui::{Panel, Popup, PopupCloseBehavior, RichText, Ui, vec2};
use impasto_editor_model::Item;
use impasto_editor_model::session::{Mode, Tool, ToolOptions};

use self::settings::{BarPlace, Control, Setting};
use super::tool_names::face;
use super::top_bar::WIDE;
use super::{Ask, PanelInput, divider, row, row_from_right, text_width, within};
use crate::icons;
use crate::theme::{Tokens, measure, type_face};
use crate::widgets::{self, NumberField};
use impasto_scene::document::Color;

/// The width of the line between groups of settings, with the space on either side.
const DIVIDER: f32 = 9.0 + measure::GAP;
/// The width of the button at the bar's end, with its space.
const MORE: f32 = measure::BUTTON + 2.0 * measure::GAP;

/// Translates words of the bar; tests put longer ones in their place.
type Translate = fn(&'static str) -> &'static str;

/// Shows the bar in the top 40 points of `ui`.
pub fn options_bar(ui: &mut Ui, shown: &PanelInput<'_>, asks: &mut Vec<Ask>) {
    let frame = egui::Frame::new().fill(Tokens::of(ui).panel);
    Panel::top("options bar").exact_size(measure::OPTIONS_BAR).resizable(false).frame(frame).show(ui, |ui| {
        if let Some(options) = bar(ui, shown, |words| words) {
            asks.push(shown.session_with(|session| session.options = options));
        }
    });
}

/// The bar's contents. Returns the options if one was changed.
fn bar(ui: &mut Ui, shown: &PanelInput<'_>, say: Translate) -> Option<ToolOptions> {
    let mut options = shown.session.options.clone();
    let tool = shown.session.tool();
    let all = settings::of(tool, &options, shown.session.has_pen);
    let wide = ui.ctx().content_rect().width() >= WIDE;
    let whole = ui.max_rect();
    within(ui, whole, row(), |ui| {
        ui.spacing_mut().item_spacing.x = measure::GAP;
        ui.add_space(14.0);
        head(ui, tool, say);
        let mut right = whole.right() - MORE;
        let mut hidden = Vec::new();
        for (index, setting) in all.iter().enumerate() {
            let width = width(ui, setting, say);
            let fits = ui.cursor().left() + width + measure::GAP <= right;
            match setting.place {
                BarPlace::Always if fits => on_bar(ui, setting, &mut options, say),
                BarPlace::Wide if fits && wide => on_bar(ui, setting, &mut options, say),
                BarPlace::WideRight if fits && wide => {
                    right -= width + measure::GAP;
                    let rect = egui::Rect::from_x_y_ranges(right..=right + width, whole.y_range());
                    within(ui, rect, row(), |ui| control(ui, setting, &mut options, say));
                }
                _ => hidden.push(index),
            }
        }
        hint(ui, shown, tool, right, say);
        let rect = egui::Rect::from_x_y_ranges(whole.right() - MORE..=whole.right(), whole.y_range());
        within(ui, rect, row_from_right(), |ui| {
            ui.add_space(measure::GAP);
            let hidden: Vec<_> = hidden.into_iter().map(|index| &all[index]).collect();
            more(ui, &hidden, &mut options, say);
        });
    });
    (options != shown.session.options).then_some(options)
}

fn head(ui: &mut Ui, tool: Tool, say: Translate) {
    let (face, tokens) = (face(tool), Tokens::of(ui));
    ui.label(RichText::new(face.icon.glyph()).font(type_face::icon(measure::ICON)).color(tokens.accent_text));
    let name = if tool == Tool::ShotCamera { "Shot camera" } else { face.name };
    ui.label(RichText::new(say(name)).font(type_face::head()).color(tokens.text));
    ui.add_space(4.0);
}

/// How much of the bar a setting takes, points.
fn width(ui: &Ui, setting: &Setting, say: Translate) -> f32 {
    let control = match &setting.control {
        Control::Choice(choice) => {
            widgets::segmented_width(ui, choice.words.iter().map(|(words, _)| say(words)))
        }
        Control::Number(number) => number.width,
        Control::Check { words, .. } => 24.0 + text_width(ui, say(words), type_face::body()),
        Control::Mirror => widgets::TOGGLE_GROUP,
        Control::Colour { .. } => measure::BUTTON,
    };
    let label = match setting.label {
        "" => 0.0,
        label => text_width(ui, say(label), type_face::small()) + measure::GAP,
    };
    let divider = if setting.apart { DIVIDER } else { 0.0 };
    divider + label + control
}

fn on_bar(ui: &mut Ui, setting: &Setting, options: &mut ToolOptions, say: Translate) {
    if setting.apart {
        divider(ui);
    }
    if !setting.label.is_empty() {
        note(ui, say(setting.label));
    }
    control(ui, setting, options, say);
}

fn note(ui: &mut Ui, words: &str) {
    let words = RichText::new(words).font(type_face::small()).color(Tokens::of(ui).weak);
    ui.add(egui::Label::new(words).extend());
}

fn control(ui: &mut Ui, setting: &Setting, options: &mut ToolOptions, say: Translate) {
    let Some(why) = setting.off else { return control_on(ui, setting, options, say) };
    let inner = ui.add_enabled_ui(false, |ui| control_on(ui, setting, options, say));
    inner.response.on_disabled_hover_text(say(why));
}

fn control_on(ui: &mut Ui, setting: &Setting, options: &mut ToolOptions, say: Translate) {
    match &setting.control {
        Control::Choice(choice) => {
            let words: Vec<_> = choice.words.iter().map(|(words, name)| (say(words), *name)).collect();
            let mut chosen = (choice.get)(options);
            if widgets::segmented_named(ui, &words, &mut chosen).changed() {
                (choice.set)(options, chosen);
            }
        }
        Control::Number(number) => {
            let value = (number.get)(options);
            let default = *(number.get)(&mut ToolOptions::default()) * number.times;
            let mut shown = *value * number.times;
            let field = NumberField::new(number.name, &mut shown, number.range.0..=number.range.1);
            let field = field.unlabelled(number.width).unit(number.unit).default_value(default);
            if field.tip("", number.effect).show(ui).changed {
                *value = shown / number.times;
            }
        }
        Control::Check { words, get } => {
            widgets::checkbox(ui, say(words), get(options));
        }
        Control::Colour { name, get } => {
            let color = get(options);
            let [r, g, b] = color.0.map(|channel| (channel * 255.0).round() as u8);
            let mut picked = egui::Color32::from_rgb(r, g, b);
            if widgets::color_square(ui, name, &mut picked).changed() {
                let [r, g, b, _] = picked.to_array();
                *color = Color([r, g, b].map(|channel| f32::from(channel) / 255.0));
            }
        }
        Control::Mirror => {
            widgets::toggle_group(ui, ["Mirror X", "Mirror Y", "Mirror Z"], &mut options.mirror);
        }
    }
}

/// A hint about the tool or the mode, if there is room.
fn hint(ui: &mut Ui, shown: &PanelInput<'_>, tool: Tool, right: f32, say: Translate) {
    let pieces: [(String, bool); 4] = match (tool, shown.document.selection().active()) {
        (Tool::Pick | Tool::ShotCamera, _) => [
            (say(face(tool).effect).to_owned(), false),
            Default::default(),
            Default::default(),
            Default::default(),
        ],
        (_, Some(Item::Object(name))) if shown.session.mode == Mode::Animate => [
            (say("Posing").to_owned(), false),
            (name.clone(), true),
            (say("at frame").to_owned(), false),
            (format!("{}", shown.session.frame), true),
        ],
        (Tool::Select, _) => [
            (say(face(tool).effect).to_owned(), false),
            Default::default(),
            Default::default(),
            Default::default(),
        ],
        _ => return,
    };
    let wide: f32 = pieces.iter().map(|(words, _)| text_width(ui, words, type_face::small()) + 4.0).sum();
    if ui.cursor().left() + wide + DIVIDER > right {
        return;
    }
    divider(ui);
    ui.spacing_mut().item_spacing.x = 4.0;
    let tokens = Tokens::of(ui);
    for (words, stands_out) in pieces.iter().filter(|(words, _)| !words.is_empty()) {
        let colour = if *stands_out { tokens.text } else { tokens.weak };
        ui.label(RichText::new(words).font(type_face::small()).color(colour));
    }
}

/// The button at the bar's end, with the menu that it opens.
fn more(ui: &mut Ui, hidden: &[&Setting], options: &mut ToolOptions, say: Translate) {
    let name = "More tool options";
    let response =
        ui.add_enabled_ui(!hidden.is_empty(), |ui| widgets::icon_button(ui, icons::MORE_OPTIONS, name)).inner;
    let response = response.on_disabled_hover_text("All settings of this tool are on the bar");
    Popup::menu(&response).close_behavior(PopupCloseBehavior::CloseOnClickOutside).show(|ui| {
        let label = |setting: &&Setting| text_width(ui, say(setting.label), type_face::small());
        let labels = hidden.iter().map(label).fold(0.0, f32::max);
        egui::Frame::new().inner_margin(measure::GAP).show(ui, |ui| {
            for setting in hidden {
                ui.horizontal(|ui| {
                    ui.spacing_mut().item_spacing.x = measure::GAP;
                    let left = ui.cursor().left();
                    if !setting.label.is_empty() {
                        note(ui, say(setting.label));
                        ui.add_space(labels + left + measure::GAP - ui.cursor().left());
                    }
                    control(ui, setting, options, say);
                    ui.allocate_space(vec2(0.0, measure::ROW));
                });
            }
        });
    });
}
