//! The sections of the inspector for how the strokes and the background change over time.

use egui::Ui;
use impasto_editor_model::command::{Command, KeyOf, KeyedValue, StrokesOf, Time, strokes_at};
use impasto_scene::document::{Ease, Key, Scene, StrokesKey};

use super::Asker;
use super::number::Number;
use super::parts::{note, section};
use super::pose::key_rows;

/// A number of a stroke key.
struct Row {
    label: &'static str,
    effect: &'static str,
    unit: &'static str,
    /// The shown value times this is the value in the file.
    file_per_shown: f64,
    /// The least and the greatest value, as shown.
    range: [f64; 2],
    step: (f64, usize),
    /// The default, as a value in the file.
    usual: f64,
    of: fn(&mut StrokesKey) -> &mut f64,
}

/// What the rows of factors have in common.
const FACTOR: Row = Row {
    label: "",
    effect: "",
    unit: "\u{d7}",
    file_per_shown: 1.0,
    range: [0.05, 20.0],
    step: (0.05, 2),
    usual: 1.0,
    of: |key| &mut key.size,
};
/// What the rows of shares have in common.
const SHARE: Row = Row { unit: "%", file_per_shown: 0.01, range: [0.0, 100.0], step: (5.0, 0), ..FACTOR };

const ROWS: [Row; 4] = [
    Row {
        label: "Size",
        effect: "Multiplies length and width at this frame; strokes come and go by rank.",
        ..FACTOR
    },
    Row {
        label: "Coverage",
        effect: "Multiplies how many strokes lie over each other at this frame.",
        range: [0.0, 4.0],
        of: |key| &mut key.coverage,
        ..FACTOR
    },
    Row {
        label: "Dryness",
        effect: "Dries the brushes at this frame: 100 % leaves only traces.",
        usual: 0.0,
        of: |key| &mut key.dryness,
        ..SHARE
    },
    Row {
        label: "Palette mix",
        effect: "How far colours keep to the palette at this frame.",
        of: |key| &mut key.palette_mix,
        ..SHARE
    },
];

/// How the strokes of a region, or of the scene, are changed at the frame that is shown. Changing a number sets a key
/// at this frame.
pub(super) fn of_strokes(ui: &mut Ui, asker: &mut Asker<'_, '_>, of: &StrokesOf) {
    let frame = asker.shown.session.frame;
    let keys = keys_of(asker.stored(), of);
    let words = match keys.len() {
        0 => "no keys".to_owned(),
        1 => "1 key".to_owned(),
        many => format!("{many} keys"),
    };
    section(ui, "Strokes over time", &words, false, |ui| {
        let [now, was] = [asker.scene(), asker.stored()].map(|scene| strokes_at(scene, of, frame));
        for row in &ROWS {
            let shown = |key: &StrokesKey| *(row.of)(&mut key.clone()) / row.file_per_shown;
            let number = Number {
                unit: row.unit,
                range: row.range[0]..=row.range[1],
                limits: Some(row.range[0]..=row.range[1]),
                step: row.step,
                default: Some(row.usual / row.file_per_shown),
                ..Number::new(row.label, row.effect)
            };
            asker.number(ui, &number, [shown(&now), shown(&was)], |to| {
                let mut key = was.clone();
                *(row.of)(&mut key) = to.map_or(row.usual, |to| to * row.file_per_shown);
                Command::Time(Time::PutValue(KeyedValue::Strokes(of.clone(), key), frame))
            });
        }
        key_rows(ui, asker, KeyOf::Strokes(of.clone()), ease_at(keys, frame));
    });
}

/// The key of the background at the frame that is shown.
pub(super) fn of_background(ui: &mut Ui, asker: &mut Asker<'_, '_>) {
    let (frame, keys) = (asker.shown.session.frame, &asker.stored().background_keys);
    section(ui, "Background over time", "", false, |ui| {
        if keys.is_empty() {
            note(ui, "Without keys it is the same throughout.");
        }
        key_rows(ui, asker, KeyOf::Background, ease_at(keys, frame));
    });
}

fn keys_of<'a>(scene: &'a Scene, of: &StrokesOf) -> &'a [StrokesKey] {
    match of {
        StrokesOf::Scene => &scene.strokes.keys,
        StrokesOf::Region(name) => {
            let region = scene.regions.iter().find(|region| region.name == *name);
            region.map_or(&[], |region| &region.strokes.keys)
        }
    }
}

fn ease_at(keys: &[impl Key], frame: f64) -> Option<Ease> {
    keys.iter().find(|key| key.frame() == frame).map(Key::ease)
}
