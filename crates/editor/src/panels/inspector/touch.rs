//! The inspector of a touch, which is a stroke that was placed by hand: its colour, brush and numbers.

use egui::Ui;
use impasto_core::brush;
use impasto_editor_model::Item;
use impasto_editor_model::command::{Command, Edit, Touches};
use impasto_scene::document::Touch;
use impasto_scene::limits::{TOUCH_LENGTH_PX, TOUCH_WIDTH_PX};

use super::Asker;
use super::number::Number;
use super::parts::{at_end, body, head, head_icon, note, pick, reset, row, section, seen};
use crate::icons;
use crate::theme::Tokens;
use crate::widgets::{self, Tip};

pub(super) fn show(ui: &mut Ui, asker: &mut Asker<'_, '_>, name: &str) {
    let find = |touches: &'_ [Touch]| touches.iter().position(|touch| touch.name == name);
    let [shown, stored] = [asker.scene(), asker.stored()];
    let (Some(now), Some(kept)) = (find(&shown.touches), find(&stored.touches)) else { return };
    let (touch, stored) = (&shown.touches[now], &stored.touches[kept]);
    let weak = Tokens::of(ui).weak;
    let item = Item::Touch(name.to_owned());
    head(ui, |ui| {
        head_icon(ui, icons::TOUCH, weak);
        asker.name(ui, "Touch name", &item);
        at_end(ui, |ui| {
            let (icon, words) =
                if stored.hidden { (icons::HIDDEN, "Show touch") } else { (icons::VISIBLE, "Hide touch") };
            if widgets::icon_button(ui, icon, words).clicked() {
                asker.ask(Command::Edit(Edit::SetHidden(vec![item.clone()], !stored.hidden)));
            }
        });
    });
    section(ui, "Touch", "", true, |ui| {
        let places = match touch.points.len() {
            1 => "a single stroke".to_owned(),
            count => format!("through {count} points"),
        };
        note(ui, &format!("On {}, {places}, over all other paint", touch.on));
        paint(ui, asker, [touch, stored]);
        numbers(ui, asker, [touch, stored]);
    });
    body(ui, |ui| {
        if widgets::Button::new("Delete").name("Delete touch").danger().show(ui).clicked() {
            asker.ask(Command::Edit(Edit::Delete(vec![item.clone()])));
        }
    });
}

fn set(stored: &Touch, what: &str, change: impl FnOnce(&mut Touch)) -> Command {
    let mut touch = stored.clone();
    change(&mut touch);
    let (name, what) = (stored.name.clone(), what.to_owned());
    Command::Touches(Touches::Set { name, touch: Box::new(touch), what })
}

/// Colour and brush.
fn paint(ui: &mut Ui, asker: &mut Asker<'_, '_>, [touch, stored]: [&Touch; 2]) {
    row(ui, "Colour", |ui| {
        let shown = touch.color.map_or(Tokens::of(ui).weak, seen);
        asker.colour(ui, "Touch colour", shown, |color| {
            set(stored, "colour", |touch| touch.color = Some(color))
        });
        if touch.color.is_none() {
            note(ui, "from the picture");
        } else if reset(ui, "Touch colour") {
            asker.ask(set(stored, "colour from the picture", |touch| touch.color = None));
        }
    });
    row(ui, "Brush", |ui| {
        let own = "as there";
        let choices: Vec<&str> = [own].into_iter().chain(brush::NAMES).collect();
        let chosen = touch.brush.as_deref().and_then(|name| choices.iter().position(|known| *known == name));
        let tip = Tip {
            name: "Touch brush",
            effect: "The brush that leaves its mark; as there: that of the strokes round it.",
            ..Tip::default()
        };
        if let Some(picked) = pick(ui, tip, &choices, chosen.unwrap_or(0)) {
            let brush = (picked > 0).then(|| choices[picked].to_owned());
            asker.ask(set(stored, "brush", |touch| touch.brush = brush));
        }
    });
}

fn numbers(ui: &mut Ui, asker: &mut Asker<'_, '_>, [touch, stored]: [&Touch; 2]) {
    let width = Number {
        unit: "px",
        range: 1.0..=120.0,
        limits: Some(TOUCH_WIDTH_PX),
        step: (0.5, 1),
        default: Some(Touch::USUAL_WIDTH_PX),
        ..Number::new("Touch width", "How wide it is in the picture, however near the camera is.")
    };
    asker.number(ui, &width, [touch.width_px, stored.width_px], |to| {
        set(stored, "width", |touch| touch.width_px = to.unwrap_or(Touch::USUAL_WIDTH_PX))
    });
    if touch.points.len() == 1 {
        let length = Number {
            unit: "px",
            range: 1.0..=400.0,
            limits: Some(TOUCH_LENGTH_PX),
            default: Some(Touch::USUAL_LENGTH_PX),
            ..Number::new("Touch length", "How long it is in the picture.")
        };
        asker.number(ui, &length, [touch.length_px, stored.length_px], |to| {
            set(stored, "length", |touch| touch.length_px = to.unwrap_or(Touch::USUAL_LENGTH_PX))
        });
    }
    let opacity =
        Number { default: Some(1.0), ..Number::share("Touch opacity", "How far it covers what is below.") };
    asker.number(ui, &opacity, [touch.opacity, stored.opacity], |to| {
        set(stored, "opacity", |touch| touch.opacity = to.unwrap_or(1.0))
    });
    let taper = Number {
        range: -1.0..=1.0,
        step: (0.05, 2),
        default: Some(0.0),
        ..Number::new("Touch taper", "How much narrower it is at its end than at its start.")
    };
    asker.number(ui, &taper, [touch.taper, stored.taper], |to| {
        set(stored, "taper", |touch| touch.taper = to.unwrap_or(0.0))
    });
}
