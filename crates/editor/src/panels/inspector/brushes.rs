//! Brushes to choose from, as small pictures.

use egui::{Ui, vec2};
use impasto_core::brush;
use impasto_editor_model::command::Command;
use impasto_scene::document::BrushMix;

use super::Asker;
use super::parts::{note, reset};
use crate::panels::brush_thumbnails::thumbnail;
use crate::widgets::{self, Tip};

pub(super) struct BrushRow<'a> {
    /// The layer of paint that has these brushes; the buttons' names end with it. Empty for the brushes that a region
    /// or the scene states for its strokes.
    pub(super) of: &'a str,
    /// The brushes that are used now; one named twice is taken twice as often.
    pub(super) mix: &'a [String],
    /// Whether the mix is stated here, so that it can be reset.
    pub(super) is_own: bool,
}

/// One radio button for each brush. With Shift or Ctrl, a click adds a brush to the mix or takes it out. `set` makes
/// the command that sets a mix, or with `None` resets it.
pub(super) fn show(
    ui: &mut Ui,
    asker: &mut Asker<'_, '_>,
    row: &BrushRow<'_>,
    set: impl Fn(Option<BrushMix>) -> Command,
) {
    let loaded = asker.shown.document.shown();
    let &BrushRow { of, mix, is_own } = row;
    let ending = if of.is_empty() { String::new() } else { format!(" of {of}") };
    let names = brush::NAMES.iter().copied().chain(loaded.brushes.keys().map(String::as_str));
    ui.add_space(4.0);
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = vec2(3.0, 0.0);
        for name in names {
            let Some(picture) = thumbnail(ui.ctx(), name, loaded) else { continue };
            let on = mix.iter().any(|other| other == name);
            let label = format!("Brush {name}{ending}");
            let response = widgets::brush_thumbnail(ui, &label, picture.id(), on);
            let tip = Tip { name, effect: effect_of(name), range: "Ctrl-click mixes brushes.", key: "" };
            let response = tip.on(response);
            if !response.clicked() {
                continue;
            }
            let mixes = ui.input(|input| input.modifiers.shift || input.modifiers.command);
            let mut wanted = if mixes { mix.to_vec() } else { vec![name.to_owned()] };
            if mixes && on && mix.iter().any(|other| other != name) {
                wanted.retain(|other| other != name);
            } else if mixes && !on {
                wanted.push(name.to_owned());
            }
            if wanted != *mix {
                asker.ask(set(Some(BrushMix(wanted))));
            }
        }
        if is_own && reset(ui, &format!("Brush{ending}")) {
            asker.ask(set(None));
        }
    });
    ui.add_space(2.0);
    if mix.len() > 1 {
        note(ui, &format!("Mixed: {}", counted(mix)));
    }
}

/// How often each brush of a mix is taken, as *filbert 2, round 1*.
pub(super) fn counted(mix: &[String]) -> String {
    let words: Vec<String> =
        by_count(mix).into_iter().map(|(name, times)| format!("{name} {times}")).collect();
    words.join(", ")
}

/// Each brush of a mix, in order, with how often it is taken.
pub(super) fn by_count(mix: &[String]) -> Vec<(&str, usize)> {
    let mut found: Vec<(&str, usize)> = Vec::new();
    for name in mix {
        match found.iter_mut().find(|(known, _)| known == name) {
            Some((_, times)) => *times += 1,
            None => found.push((name, 1)),
        }
    }
    found
}

fn effect_of(brush: &str) -> &'static str {
    match brush {
        "flat" => "Square ends and even edges.",
        "filbert" => "Rounded ends, soft sides.",
        "round" => "Pointed, full in the middle.",
        "fan" => "Many thin lines side by side.",
        "dry" => "Broken paint that lets the ground through.",
        "knife" => "A flat slab of thick paint.",
        "rigger" => "One long thin line.",
        _ => "A picture of this scene's own.",
    }
}
