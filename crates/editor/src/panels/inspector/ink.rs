//! The inspector's rows for the settings of a scene that is drawn in ink (sumi-e).

use egui::Ui;
use impasto_editor_model::command::{Command, SceneEdit};
use impasto_scene::document::{
    CanvasFollows, Color, InkDrawing, InkLight, InkRule, Number as StyleNumber, Style, SumiE,
};

use super::Asker;
use super::number::Number;
use super::parts::{reset, row, seen};
use crate::widgets;

/// The number fields keep `silhouette_to` above `silhouette_from` by at least this.
const MIN_DIFFERENCE: f64 = 0.01;

/// Shows the settings except `to_light`; under `InkRule::Source`, only those that have an effect there. `shown`
/// includes the change that is being previewed, `stored` does not.
pub(super) fn show(ui: &mut Ui, asker: &mut Asker<'_, '_>, [shown, stored]: [&SumiE; 2]) {
    choices(ui, asker, [shown, stored]);
    let is_painter = shown.rule == InkRule::Painter;
    for number in SumiE::numbers().filter(|number| is_painter || has_effect_in_source(number)) {
        one_number(ui, asker, number, [shown, stored]);
    }
    for index in 0..4 {
        tone(ui, asker, index, [shown, stored]);
    }
    type ColorOf = fn(&mut SumiE) -> &mut Color;
    let colours: [(&str, ColorOf); 3] =
        [("Paper", |ink| &mut ink.paper), ("Ink", |ink| &mut ink.ink), ("Seal", |ink| &mut ink.seal)];
    for (name, of) in colours.into_iter().filter(|(name, _)| is_painter || *name == "Paper") {
        row(ui, name, |ui| {
            let own = |ink: &SumiE| *of(&mut ink.clone());
            let set = |color: Color| {
                let mut ink = stored.clone();
                *of(&mut ink) = color;
                edit(ink, format!("{name} colour"))
            };
            asker.colour(ui, &format!("{name} colour"), seen(own(shown)), set);
            let usual = own(&SumiE::default());
            if own(shown) != usual && reset(ui, &format!("{name} colour")) {
                asker.ask(set(usual));
            }
        });
    }
}

/// Shows the settings that offer a few words to choose from.
fn choices(ui: &mut Ui, asker: &mut Asker<'_, '_>, [shown, stored]: [&SumiE; 2]) {
    row(ui, "Rule", |ui| {
        let mut chosen = usize::from(shown.rule == InkRule::Source);
        if widgets::segmented_of(ui, "Rule", &["Painter", "Source"], &mut chosen).changed() {
            let (rule, words) =
                [(InkRule::Painter, "Rule: painter"), (InkRule::Source, "Rule: source")][chosen];
            asker.ask(edit(SumiE { rule, ..stored.clone() }, words.to_owned()));
        }
    });
    if shown.rule == InkRule::Painter {
        row(ui, "Drawing", |ui| {
            let drawings = [InkDrawing::Both, InkDrawing::Wash, InkDrawing::Strokes];
            let mut chosen = drawings.iter().position(|drawing| *drawing == shown.drawing).unwrap_or(0);
            let words = ["Both", "Wash", "Strokes"];
            if widgets::segmented_of(ui, "Drawing", &words, &mut chosen).changed() {
                let drawing = drawings[chosen];
                let words = format!("Drawing: {}", words[chosen].to_lowercase());
                asker.ask(edit(SumiE { drawing, ..stored.clone() }, words));
            }
        });
        row(ui, "Light", |ui| {
            let mut chosen = usize::from(shown.light == InkLight::Eye);
            if widgets::segmented_of(ui, "Light", &["Scene", "Eye"], &mut chosen).changed() {
                let (light, words) = [
                    (InkLight::Scene, "Light of the scene"),
                    (InkLight::Eye, "Light that goes with the eye"),
                ][chosen];
                asker.ask(edit(SumiE { light, ..stored.clone() }, words.to_owned()));
            }
        });
    }
    row(ui, "Paper follows", |ui| {
        let mut chosen = usize::from(shown.paper_follows == CanvasFollows::Camera);
        if widgets::segmented_of(ui, "Paper follows", &["Picture", "Camera"], &mut chosen).changed() {
            let (paper_follows, words) = [
                (CanvasFollows::Picture, "Paper follows the picture"),
                (CanvasFollows::Camera, "Paper follows the camera"),
            ][chosen];
            asker.ask(edit(SumiE { paper_follows, ..stored.clone() }, words.to_owned()));
        }
    });
}

/// Whether a number has an effect under `InkRule::Source`.
fn has_effect_in_source(number: &StyleNumber<SumiE>) -> bool {
    ["silhouette_from", "silhouette_to", "softness", "fibres"].contains(&number.field)
}

fn one_number(ui: &mut Ui, asker: &mut Asker<'_, '_>, of: &StyleNumber<SumiE>, [shown, stored]: [&SumiE; 2]) {
    let (words, unit) = match of.field.strip_suffix("_px") {
        Some(words) => (words, "px"),
        None => (of.field, ""),
    };
    let name = match of.field {
        "silhouette_from" => "Rim from".to_owned(),
        "silhouette_to" => "Rim to".to_owned(),
        "bleed_px" => "Bleed px".to_owned(),
        _ => sentence(words),
    };
    let limits = match of.field {
        "silhouette_from" => 0.0..=(stored.silhouette_to - MIN_DIFFERENCE).max(0.0),
        "silhouette_to" => (stored.silhouette_from + MIN_DIFFERENCE).min(1.0)..=1.0,
        _ => of.limits.clone(),
    };
    let usual = (of.get)(&SumiE::default());
    let step = if unit == "px" { (0.5, 1) } else { (0.05, 2) };
    let number = Number {
        unit,
        range: limits.clone(),
        limits: Some(limits),
        scene_decides: false,
        step,
        default: Some(usual),
        ..Number::new(&name, of.effect)
    };
    asker.number(ui, &number, [shown, stored].map(of.get), |to| {
        let mut ink = stored.clone();
        let to = to.unwrap_or(usual);
        *(of.of)(&mut ink) = to;
        edit(ink, format!("{name} {to:.2}"))
    });
}

/// Shows one of the four tones, which must stay between the tones beside it.
fn tone(ui: &mut Ui, asker: &mut Asker<'_, '_>, index: usize, [shown, stored]: [&SumiE; 2]) {
    let name = format!("Tone {}", index + 1);
    let below = if index > 0 { stored.tones[index - 1] } else { 0.0 };
    let above = stored.tones.get(index + 1).copied().unwrap_or(1.0);
    let usual = SumiE::default().tones[index];
    let number = Number {
        range: below..=above,
        limits: Some(below..=above),
        scene_decides: false,
        step: (0.05, 2),
        default: (below..=above).contains(&usual).then_some(usual),
        ..Number::new(&name, "From the darkest ink, 1, to the thinnest, 4: 0 is black, 1 the paper.")
    };
    asker.number(ui, &number, [shown.tones[index], stored.tones[index]], |to| {
        let mut ink = stored.clone();
        ink.tones[index] = to.unwrap_or(usual);
        edit(ink, format!("{name}: {:.2}", to.unwrap_or(usual)))
    });
}

/// A field's name as words, with a capital.
pub(super) fn sentence(field: &str) -> String {
    let words = field.replace('_', " ");
    let mut letters = words.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

fn edit(ink: SumiE, words: String) -> Command {
    Command::Scene(SceneEdit::SetStyle(Style::SumiE(ink), words))
}
