//! The inspector of a light: its kind, colour, intensity, and direction or place.

use egui::Ui;
use impasto_core::color::{linear_from_srgb, srgb_from_linear};
use impasto_editor_model::Item;
use impasto_editor_model::command::{Arrange, Command, KeyOf, set_light};
use impasto_scene::document::{Color, Light, LightKey, LightKind};
use impasto_scene::limits::MAX_INTENSITY;
use impasto_scene::motion;

use super::Asker;
use super::number::Number;
use super::parts::{head, head_icon, note, pick, reset, row, section, seen};
use super::pose::of_key;
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
    let frame = asker.shown.session.frame;
    let is_keyed = !stored.keys.is_empty();
    let title = if is_keyed { format!("Light at frame {frame}") } else { "Light".to_owned() };
    section(ui, &title, "", true, |ui| rows(ui, asker, [light, stored]));
    let key = stored.keys.iter().find(|key| key.frame == frame);
    of_key(ui, asker, KeyOf::Light(name.to_owned()), key.map(|key| key.ease));
}

/// The values of the light at the frame that is shown. A light without keys has the same values at every frame.
fn rows(ui: &mut Ui, asker: &mut Asker<'_, '_>, [light, kept]: [&Light; 2]) {
    let frame = asker.shown.session.frame;
    let [light, stored] = [(asker.scene(), light), (asker.stored(), kept)]
        .map(|(scene, light)| motion::light_at(scene, light, frame));
    let scene = asker.stored();
    let states = |stated: LightKey, what: &str| {
        set_light(scene, &kept.name, stated, what).unwrap_or(Command::Several(String::new(), Vec::new()))
    };
    let set = |light: Light, what: &str| {
        Command::Arrange(Arrange::SetLight { name: kept.name.clone(), light, what: what.to_owned() })
    };
    let kinds = [LightKind::Sun, LightKind::Point, LightKind::Spot, LightKind::Ambient];
    row(ui, "Kind", |ui| {
        let tip = Tip {
            name: "Kind of light",
            effect: "A sun casts shadows; a lamp fades with distance; a spot shines into a cone; a sky comes from all around.",
            ..Tip::default()
        };
        let chosen = kinds.iter().position(|kind| *kind == light.kind).unwrap_or(0);
        let words = ["Sun", "Lamp", "Spot", "Sky"];
        if let Some(picked) = pick(ui, tip, &words, chosen) {
            asker.ask(set(of_kind(kept, kinds[picked]), &format!("is a {}", words[picked].to_lowercase())));
        }
    });
    row(ui, "Colour", |ui| {
        asker.colour(ui, "Light colour", seen(light.color), |color| {
            states(LightKey { color: Some(color), ..LightKey::at(frame) }, "colour")
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
        states(LightKey { intensity: Some(to), ..LightKey::at(frame) }, what)
    });
    if let (Some(shown), Some(was)) = (light.direction, stored.direction) {
        let effect = "Where the light travels to, in the world.";
        vector(ui, asker, "Shines", effect, [shown, was], |direction| {
            states(LightKey { direction: Some(direction), ..LightKey::at(frame) }, "direction")
        });
    }
    if let (Some(shown), Some(was)) = (light.position, stored.position) {
        vector(ui, asker, "Place", "Where the lamp stands, in the world.", [shown, was], |position| {
            states(LightKey { position: Some(position), ..LightKey::at(frame) }, "place")
        });
    }
    if light.kind == LightKind::Spot {
        let usual = Light::USUAL_CONE_DEG;
        let cone = |light: &Light| light.cone_deg.unwrap_or(usual);
        let ([inner, outer], [inner_was, outer_was]) = (cone(&light), cone(&stored));
        let angle = |name, effect, least: f64, most: f64, default: f64| Number {
            range: least..=most,
            limits: Some(least..=most),
            step: (0.5, 1),
            unit: "°",
            default: Some(default),
            ..Number::new(name, effect)
        };
        let ends = angle("Cone", "From the axis of the spot to where its light ends.", 1.0, 90.0, usual[1]);
        asker.number(ui, &ends, [outer, outer_was], |to| {
            let outer = to.unwrap_or(usual[1]);
            set(Light { cone_deg: Some([inner_was.min(outer), outer]), ..kept.clone() }, "cone")
        });
        let fades =
            angle("Fades from", "From the axis to where its light begins to fade.", 0.0, outer, usual[0]);
        asker.number(ui, &fades, [inner, inner_was], |to| {
            set(Light { cone_deg: Some([to.unwrap_or(usual[0]), outer_was]), ..kept.clone() }, "soft edge")
        });
    }
    if light.kind == LightKind::Ambient {
        row(ui, "Ground", |ui| {
            asker.colour(
                ui,
                "Ground colour",
                seen(light.ground.unwrap_or(off_the_floor(light.color))),
                |color| states(LightKey { ground: Some(color), ..LightKey::at(frame) }, "ground"),
            );
            if light.ground.is_none() {
                note(ui, "from the colour above");
            } else if kept.keys.is_empty() && reset(ui, "Ground colour") {
                asker.ask(set(Light { ground: None, ..kept.clone() }, "ground"));
            }
        });
    }
}

/// The colour of a sky's light from below while no ground colour is set.
fn off_the_floor(Color(channels): Color) -> Color {
    let channel = |at: usize| {
        srgb_from_linear((linear_from_srgb(channels[at]) * Light::OFF_THE_FLOOR[at]).clamp(0.0, 1.0))
    };
    Color(std::array::from_fn(channel))
}

/// The light as another kind, with defaults for what that kind needs. Its old direction, place, cone and ground colour
/// are dropped, from its keys too.
fn of_kind(light: &Light, kind: LightKind) -> Light {
    let mut light =
        Light { kind, direction: None, position: None, cone_deg: None, ground: None, ..light.clone() };
    for key in &mut light.keys {
        (key.direction, key.position, key.ground) = (None, None, None);
    }
    match kind {
        LightKind::Sun => light.direction = Some([0.4, -0.8, -0.45]),
        LightKind::Point => light.position = Some([0.0, 2.0, 0.0]),
        LightKind::Spot => {
            (light.direction, light.position) = (Some([0.0, -1.0, 0.0]), Some([0.0, 2.0, 0.0]));
        }
        LightKind::Ambient => {}
    }
    light
}
