//! The inspector's page for the scene as a whole: size, ground and background of the picture, time, style, strokes of
//! all regions, reference.

use egui::Ui;
use impasto_editor_model::command::{Command, KeyedValue, SceneEdit, StrokesOf, Time};
use impasto_scene::document::{Reference, Style};
use impasto_scene::limits::MAX_SIDE_PX;
use impasto_scene::motion;

use super::number::Number;
use super::parts::{head, note, row, section, seen};
use super::{Asker, ground, ink, over_time, paint_layers, rotating_strokes, strokes};
use crate::panels::Ask;
use crate::panels::timeline::transport::FPS;
use crate::theme::type_face;
use crate::widgets::{self, Button, Tip};

pub(super) fn show(ui: &mut Ui, asker: &mut Asker<'_, '_>) {
    if asker.scene().objects.is_empty() {
        ui.add_space(12.0);
        ui.vertical_centered(|ui| note(ui, "Select something to see its settings."));
        return;
    }
    head(ui, |ui| {
        ui.add_space(4.0);
        ui.label(egui::RichText::new("Scene").font(type_face::head()));
    });
    section(ui, "Picture", "", true, |ui| picture(ui, asker));
    section(ui, "Time", "", true, |ui| time(ui, asker));
    section(ui, "Style", "", true, |ui| style(ui, asker));
    section(ui, "All strokes", "", false, |ui| strokes::contents(ui, asker, None));
    paint_layers::section_of(ui, asker, None);
    strokes::advanced(ui, asker, None);
    over_time::of_strokes(ui, asker, &StrokesOf::Scene);
    over_time::of_background(ui, asker);
    section(ui, "Reference", "", false, |ui| reference(ui, asker));
}

fn picture(ui: &mut Ui, asker: &mut Asker<'_, '_>) {
    let [(width, height), (was_width, was_height)] = [asker.scene().size, asker.stored().size];
    let number = |name| Number {
        unit: "px",
        range: 16.0..=3840.0,
        limits: Some(1.0..=f64::from(MAX_SIDE_PX)),
        step: (10.0, 0),
        ..Number::new(name, "The size that strokes are meant for; pictures can be rendered at any.")
    };
    let set = |width: f64, height: f64| Command::Scene(SceneEdit::SetSize(width as u32, height as u32));
    asker.number(ui, &number("Width px"), [width, was_width].map(f64::from), |to| {
        set(to.unwrap_or(1280.0), f64::from(was_height))
    });
    asker.number(ui, &number("Height px"), [height, was_height].map(f64::from), |to| {
        set(f64::from(was_width), to.unwrap_or(720.0))
    });
    ground::choice(ui, asker);
    row(ui, "Background", |ui| {
        let (frame, scene) = (asker.shown.session.frame, asker.scene());
        let is_keyed = !scene.background_keys.is_empty();
        asker.colour(ui, "Background colour", seen(motion::background_at(scene, frame)), |color| {
            if is_keyed {
                Command::Time(Time::PutValue(KeyedValue::Background(color), frame))
            } else {
                Command::Scene(SceneEdit::SetBackground(color))
            }
        });
    });
    let [shown, stored] = [asker.scene(), asker.stored()].map(|scene| scene.exposure);
    let exposure = Number {
        unit: "stops",
        range: -3.0..=3.0,
        limits: Some(-16.0..=16.0),
        step: (0.1, 2),
        default: Some(0.0),
        ..Number::new("Exposure", "Each stop doubles the brightness of all lights.")
    };
    let set = |stops: Option<f64>| Command::Scene(SceneEdit::SetExposure(stops.unwrap_or(0.0)));
    asker.number(ui, &exposure, [shown, stored], set);
}

fn time(ui: &mut Ui, asker: &mut Asker<'_, '_>) {
    let [shown, stored] = [asker.scene(), asker.stored()].map(|scene| scene.timeline.clone());
    let rate = Number {
        unit: "fps",
        range: 1.0..=60.0,
        limits: Some(FPS),
        step: (1.0, 2),
        default: Some(24.0),
        ..Number::new("Rate", "Frames per second.")
    };
    asker.number(ui, &rate, [shown.fps, stored.fps], |fps| Command::Time(Time::SetFps(fps.unwrap_or(24.0))));
    let (first, last) = (stored.first, stored.last);
    let number = Number {
        limits: Some(f64::NEG_INFINITY..=last as f64),
        ..Number::new("First", "First frame of the shot.")
    };
    asker.number(ui, &number, [shown.first as f64, first as f64], |to| {
        Command::Time(Time::SetRange(to.map_or(first, |to| to as i64), last))
    });
    let number = Number {
        limits: Some(first as f64..=f64::INFINITY),
        ..Number::new("Last", "Last frame of the shot.")
    };
    asker.number(ui, &number, [shown.last as f64, last as f64], |to| {
        Command::Time(Time::SetRange(first, to.map_or(last, |to| to as i64)))
    });
}

fn style(ui: &mut Ui, asker: &mut Asker<'_, '_>) {
    let [shown, stored] = [asker.scene(), asker.stored()].map(|scene| scene.style.clone());
    row(ui, "Style", |ui| {
        let all = Style::all();
        let labels = all.each_ref().map(|style| style.info().label);
        let mut chosen = all.iter().position(|style| style.info() == shown.info()).unwrap_or(0);
        if widgets::segmented_of(ui, "Style", &labels, &mut chosen).changed() {
            let words = format!("Style: {}", labels[chosen].to_lowercase());
            asker.ask(Command::Scene(SceneEdit::SetStyle(all[chosen].clone(), words)));
        }
    });
    match (&shown, &stored) {
        (Style::SumiE(shown), Style::SumiE(stored)) => ink::show(ui, asker, [shown, stored]),
        (Style::RotatingStrokes(shown), Style::RotatingStrokes(stored)) => {
            rotating_strokes::show(ui, asker, [shown, stored]);
        }
        _ => {}
    }
}

fn reference(ui: &mut Ui, asker: &mut Asker<'_, '_>) {
    let frame = asker.shown.session.frame.round() as i64;
    let words = match &asker.scene().reference {
        Reference::Frame(frame) => format!("Directions are stated at frame {frame}."),
        Reference::View { frame, .. } => {
            format!("Directions are stated from a view of its own, at frame {frame}.")
        }
    };
    note(ui, &words);
    let is_it = asker.scene().reference == Reference::Frame(frame);
    ui.add_enabled_ui(!is_it, |ui| {
        let words = format!("Recapture at frame {frame}");
        let button = Button::new(&words).name("Recapture").show(ui);
        let tip = Tip {
            name: "Recapture",
            effect: "Takes this frame as the new reference; directions stay as they look now.",
            ..Tip::default()
        };
        if tip.on(button).clicked() {
            asker.asks.push(Ask::Recapture(frame));
        }
    });
}
