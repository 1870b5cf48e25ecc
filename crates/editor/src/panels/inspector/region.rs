//! The inspector's page for a region: its head, its base direction, its seam.

use egui::Ui;
use impasto_editor_model::command::{Command, Directions, RegionTarget, Regions, StrokesOf};
use impasto_editor_model::{Item, Selection};
use impasto_scene::document::{Bend, Direction, Region, Seam, Sense};

use super::Asker;
use super::controls::Control;
use super::number::{ANY, Number, decimals};
use super::parts::{at_end, axes, body, head, head_note, note, pick, row, section};
use super::{amounts, guides, over_time, paint_layers, strokes};
use crate::panels::Ask;
use crate::panels::tree::region_color;
use crate::widgets::{self, Button, Tip};

/// Width of the label before three fields, points.
const NARROW_LABEL: f32 = 54.0;

/// The names of the base directions, in the order of [`kind`].
const BASES: [&str; 8] = ["Automatic", "Angle", "Crossing", "Along", "Around", "Up", "Toward", "Curvature"];

pub(super) fn show(ui: &mut Ui, asker: &mut Asker<'_, '_>, name: &str) {
    let scenes = [asker.scene(), asker.stored()];
    let [Some(region), Some(stored)] =
        scenes.map(|scene| scene.regions.iter().find(|region| region.name == name))
    else {
        return;
    };
    let item = Item::Region(name.to_owned());
    head(ui, |ui| {
        asker.colour(ui, "Region colour", region_color(scenes[0], name), |color| {
            Command::Regions(Regions::SetColor(name.to_owned(), color))
        });
        asker.name(ui, "Region name", &item);
        let on = region.on.object();
        head_note(ui, &on.map_or("on everything".to_owned(), |object| format!("on {object}")));
        at_end(ui, |ui| asker.eye_and_lock(ui, &item, "Region", [region.hidden, region.locked]));
    });
    let on_locked = scenes[0]
        .objects
        .iter()
        .find(|object| object.locked && Some(object.name.as_str()) == region.on.object());
    let locked = if region.locked { Some(name) } else { on_locked.map(|object| object.name.as_str()) };
    if let Some(what) = locked {
        body(ui, |ui| note(ui, &format!("{what} is locked.")));
    }
    ui.add_enabled_ui(locked.is_none(), |ui| {
        section(ui, "Direction", "", true, |ui| direction(ui, asker, [region, stored]));
        strokes::of_region(ui, asker, name);
        paint_layers::section_of(ui, asker, Some(name));
        if let Some(object) = region.on.object() {
            body(ui, |ui| to_material(ui, asker, object));
        }
        guides::section_of(ui, asker, [region, stored]);
        amounts::section_of(ui, asker, region);
        strokes::advanced(ui, asker, Some(name));
        over_time::of_strokes(ui, asker, &StrokesOf::Region(name.to_owned()));
    });
}

/// A button that goes to the material of the object: a region has strokes and pigments of its own, but the surface
/// below them is that of its object.
fn to_material(ui: &mut Ui, asker: &mut Asker<'_, '_>, object: &str) {
    let name = format!("Material of {object}");
    let button = Button::new("Colour and texture\u{2026}").name(&name).show(ui);
    let effect = "The surface below the strokes is that of the object: its colour, texture and gloss.";
    if (Tip { name: &name, effect, ..Tip::default() }).on(button).clicked() {
        asker.asks.push(Ask::Select(Selection::only(Item::Object(object.to_owned()))));
        let section = "Material".to_owned();
        asker.asks.push(Ask::Reach(Control { name: section.clone(), section }));
    }
}

fn direction(ui: &mut Ui, asker: &mut Asker<'_, '_>, [region, stored]: [&Region; 2]) {
    base(ui, asker, [region, stored]);
    let turn = Number {
        unit: "\u{b0}",
        default: Some(0.0),
        ..Number::new("Turn", "Turns all directions of the region, combed ones too, counter-clockwise.")
    };
    let of = &region.name;
    let by = stored.turn_deg;
    asker.number(ui, &turn, [region.turn_deg, stored.turn_deg], |to| {
        let region = RegionTarget::Named(of.clone());
        Command::Directions(Directions::Turn { region, by_deg: to.unwrap_or(0.0) - by })
    });
    row(ui, "Sense", |ui| {
        let mut sense = usize::from(region.sense == Sense::Arrows);
        if widgets::segmented_of(ui, "Sense", &["Lines", "Arrows"], &mut sense).changed() {
            let sense = if sense == 1 { Sense::Arrows } else { Sense::Lines };
            asker.ask(Command::Directions(Directions::SetSense(of.clone(), sense)));
        }
    });
    let soft = |seam: Seam| match seam {
        Seam::Hard => None,
        Seam::Soft(over) => Some(over),
    };
    let set = |seam| Command::Regions(Regions::SetSeam(of.clone(), seam));
    row(ui, "Seam", |ui| {
        let mut seam = usize::from(soft(region.seam).is_some());
        if widgets::segmented_of(ui, "Seam", &["Hard", "Soft"], &mut seam).changed() {
            asker.ask(set(if seam == 1 { Seam::Soft(0.1) } else { Seam::Hard }));
        }
        if let (Some(shown), Some(stored)) = (soft(region.seam), soft(stored.seam)) {
            let distance = Number {
                range: 0.0..=1.0,
                limits: Some(0.0..=f64::INFINITY),
                step: (0.01, 3),
                unlabelled: Some(56.0),
                ..Number::new("Seam distance", "How far directions turn into each other on either side.")
            };
            asker.number(ui, &distance, [shown, stored], |over| set(Seam::Soft(over.unwrap_or(0.1))));
        }
    });
}

fn base(ui: &mut Ui, asker: &mut Asker<'_, '_>, [region, stored]: [&Region; 2]) {
    let set = |direction| {
        let region = RegionTarget::Named(region.name.clone());
        Command::Directions(Directions::SetBase { region, direction })
    };
    let angle = |name, unlabelled| Number {
        unit: "\u{b0}",
        unlabelled,
        ..Number::new(name, "Counter-clockwise from the picture's right, as seen in the reference.")
    };
    row(ui, "Base", |ui| {
        let tip = Tip {
            name: "Base direction",
            effect: "Where strokes lie that no guide reaches.",
            range: "Automatic by default.",
            ..Tip::default()
        };
        if let Some(kind) = pick(ui, tip, &BASES, kind(&region.direction)) {
            asker.ask(set(of_kind(kind)));
        }
        if let (Direction::Angle(shown), Direction::Angle(stored)) = (&region.direction, &stored.direction) {
            asker.number(ui, &angle("Base angle", Some(64.0)), [*shown, *stored], |to| {
                set(Direction::Angle(to.unwrap_or(0.0)))
            });
        }
    });
    match (&region.direction, &stored.direction) {
        (Direction::Crossing(a, b), Direction::Crossing(was_a, was_b)) => {
            asker.number(ui, &angle("First angle", None), [*a, *was_a], |to| {
                set(Direction::Crossing(to.unwrap_or(0.0), *was_b))
            });
            asker.number(ui, &angle("Second angle", None), [*b, *was_b], |to| {
                set(Direction::Crossing(*was_a, to.unwrap_or(0.0)))
            });
        }
        (Direction::Along(axis), Direction::Along(was)) => {
            vector(ui, asker, "Axis", "Strokes run along this axis of the object.", [*axis, *was], |to| {
                set(Direction::Along(to))
            });
        }
        (Direction::Around(axis), Direction::Around(was)) => {
            vector(ui, asker, "Axis", "Strokes wind round this axis of the object.", [*axis, *was], |to| {
                set(Direction::Around(to))
            });
        }
        (Direction::Toward(at), Direction::Toward(was)) => {
            vector(ui, asker, "Point", "Strokes point to here, in the object's space.", [*at, *was], |to| {
                set(Direction::Toward(to))
            });
        }
        (Direction::Curvature(bend), _) => row(ui, "Bend", |ui| {
            let mut most = usize::from(*bend == Bend::Max);
            if widgets::segmented_of(ui, "Bend", &["Least", "Most"], &mut most).changed() {
                asker.ask(set(Direction::Curvature(if most == 1 { Bend::Max } else { Bend::Min })));
            }
        }),
        _ => {}
    }
}

/// A vector as three numbers, each named by the label and its axis.
pub(super) fn vector(
    ui: &mut Ui,
    asker: &mut Asker<'_, '_>,
    label: &str,
    effect: &str,
    [shown, stored]: [[f64; 3]; 2],
    command: impl Fn([f64; 3]) -> Command,
) {
    axes(ui, label, NARROW_LABEL, |ui, (axis, letter, name), width| {
        let number = Number {
            letter,
            range: ANY,
            step: (0.01, decimals(shown[axis])),
            unlabelled: Some(width),
            ..Number::new(&name, effect)
        };
        asker.number(ui, &number, [shown[axis], stored[axis]], |to| {
            let mut all = stored;
            all[axis] = to.unwrap_or(0.0);
            command(all)
        });
    });
}

fn kind(direction: &Direction) -> usize {
    match direction {
        Direction::Auto => 0,
        Direction::Angle(_) => 1,
        Direction::Crossing(..) => 2,
        Direction::Along(_) => 3,
        Direction::Around(_) => 4,
        Direction::Up => 5,
        Direction::Toward(_) => 6,
        Direction::Curvature(_) => 7,
    }
}

/// The initial value of a base direction of this kind.
fn of_kind(kind: usize) -> Direction {
    match kind {
        1 => Direction::Angle(0.0),
        2 => Direction::Crossing(-45.0, 45.0),
        3 => Direction::Along([0.0, 1.0, 0.0]),
        4 => Direction::Around([0.0, 1.0, 0.0]),
        5 => Direction::Up,
        6 => Direction::Toward([0.0; 3]),
        7 => Direction::Curvature(Bend::Min),
        _ => Direction::Auto,
    }
}
