//! A light: its kind, colour, intensity, and direction or place.

use egui::Ui;
use impasto_editor_model::Item;
use impasto_editor_model::command::{Arrange, Command};
use impasto_scene::document::{Color, Light, LightKind};
use impasto_scene::limits::MAX_INTENSITY;

use super::Asker;
use super::number::Number;
use super::parts::{head, head_icon, note, pick, reset, row, section, seen};
use super::region::vector;
use crate::icons;
use crate::theme::Tokens;
use crate::widgets::Tip;

pub(super) fn show(ui: &mut Ui, asker: &mut Asker<'_, '_>, name: &str) {
    let [Some(light), Some(stored)] =
        [asker.scene(), asker.stored()].map(|scene| scene.lights.iter().find(|light| light.name == name))
    else {
        return;
    };
    let weak = Tokens::of(ui).weak;
    head(ui, |ui| {
        head_icon(ui, icons::LIGHT, weak);
        asker.name(ui, "Light name", &Item::Light(name.to_owned()));
    });
    section(ui, "Light", "", true, |ui| rows(ui, asker, [light, stored]));
}

fn rows(ui: &mut Ui, asker: &mut Asker<'_, '_>, [light, stored]: [&Light; 2]) {
    let set = |light: Light, what: &str| {
        Command::Arrange(Arrange::SetLight { name: stored.name.clone(), light, what: what.to_owned() })
    };
    let kinds = [LightKind::Sun, LightKind::Point, LightKind::Ambient];
    row(ui, "Kind", |ui| {
        let tip = Tip {
            name: "Kind of light",
            effect: "A sun casts shadows; a lamp fades with distance; a sky comes from all around.",
            ..Tip::default()
        };
        let chosen = kinds.iter().position(|kind| *kind == light.kind).unwrap_or(0);
        let words = ["Sun", "Lamp", "Sky"];
        if let Some(picked) = pick(ui, tip, &words, chosen) {
            asker.ask(set(of_kind(stored, kinds[picked]), &format!("is a {}", words[picked].to_lowercase())));
        }
    });
    row(ui, "Colour", |ui| {
        asker.colour(ui, "Light colour", seen(light.color), |color| {
            set(Light { color, ..stored.clone() }, "colour")
        });
    });
    let intensity = Number {
        range: 0.0..=5.0,
        limits: Some(0.0..=MAX_INTENSITY),
        step: (0.05, 2),
        default: Some(1.0),
        ..Number::new("Intensity", "How bright it is; multiplies the colour.")
    };
    asker.number(ui, &intensity, [light.intensity, stored.intensity], |to| {
        let to = to.unwrap_or(1.0);
        let what = if to < stored.intensity { "dimmer" } else { "brighter" };
        set(Light { intensity: to, ..stored.clone() }, what)
    });
    if let (LightKind::Sun, Some(shown), Some(was)) = (light.kind, light.direction, stored.direction) {
        let effect = "Where the light travels to, in the world.";
        vector(ui, asker, "Shines", effect, [shown, was], |direction| {
            set(Light { direction: Some(direction), ..stored.clone() }, "direction")
        });
    }
    if let (LightKind::Point, Some(shown), Some(was)) = (light.kind, light.position, stored.position) {
        vector(ui, asker, "Place", "Where the lamp stands, in the world.", [shown, was], |position| {
            set(Light { position: Some(position), ..stored.clone() }, "place")
        });
    }
    if light.kind == LightKind::Ambient {
        row(ui, "Ground", |ui| {
            asker.colour(ui, "Ground colour", seen(light.ground.unwrap_or(dim(light.color))), |color| {
                set(Light { ground: Some(color), ..stored.clone() }, "ground")
            });
            if light.ground.is_none() {
                note(ui, "from the colour above");
            } else if reset(ui, "Ground colour") {
                asker.ask(set(Light { ground: None, ..stored.clone() }, "ground"));
            }
        });
    }
}

/// Roughly the light from below that a sky has while no ground colour is set: its own colour, dimmed.
fn dim(Color(channels): Color) -> Color {
    Color(channels.map(|channel| channel * 0.4))
}

/// The light as another kind, with defaults for what that kind needs.
fn of_kind(light: &Light, kind: LightKind) -> Light {
    let mut light = Light { kind, direction: None, position: None, ground: None, ..light.clone() };
    match kind {
        LightKind::Sun => light.direction = Some([0.4, -0.8, -0.45]),
        LightKind::Point => light.position = Some([0.0, 2.0, 0.0]),
        LightKind::Ambient => {}
    }
    light
}
