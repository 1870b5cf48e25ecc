//! Number fields of the inspector. A drag is previewed, and becomes one entry of the history. Steps in quick succession
//! become one entry too.

use std::ops::RangeInclusive;

use egui::Ui;
use impasto_editor_model::command::Command;

use super::Asker;
use crate::panels::Ask;
use crate::widgets::NumberField;

/// How a number is shown and edited.
#[derive(Clone, Debug)]
pub(super) struct Number<'a> {
    /// The name for screen readers.
    pub(super) name: &'a str,
    /// The label, where the name is too long to be the label itself.
    pub(super) label: Option<&'a str>,
    /// What the number belongs to. It tells numbers of the same name apart where one selection has several.
    pub(super) of: &'a str,
    /// What the number does, one sentence.
    pub(super) effect: &'a str,
    /// Shown after the value.
    pub(super) unit: &'a str,
    /// Shown before the value: X, Y, Z.
    pub(super) letter: &'a str,
    /// The numbers that a drag can reach.
    pub(super) range: RangeInclusive<f64>,
    /// The numbers that typing and steps can reach. None: the same as a drag.
    pub(super) limits: Option<RangeInclusive<f64>>,
    /// Whether the scene may refuse a number within these limits; a typed number is then checked against the scene.
    pub(super) scene_decides: bool,
    /// The size of a step, and the digits after the decimal point.
    pub(super) step: (f64, usize),
    /// What the reset icon brings back.
    pub(super) default: Option<f64>,
    /// For a box without a label, its width in points. None: the box has a label.
    pub(super) unlabelled: Option<f32>,
    /// Whether the number is shown in ochre, as a warning that it will be lost: it belongs to a pose that is not keyed.
    pub(super) warns: bool,
}

pub(super) const ANY: RangeInclusive<f64> = f64::NEG_INFINITY..=f64::INFINITY;

impl<'a> Number<'a> {
    /// A number without a unit or limits.
    pub(super) fn new(name: &'a str, effect: &'a str) -> Self {
        Self {
            name,
            label: None,
            of: "",
            effect,
            unit: "",
            letter: "",
            range: ANY,
            limits: None,
            scene_decides: true,
            step: (1.0, 0),
            default: None,
            unlabelled: None,
            warns: false,
        }
    }

    /// A number from 0 to 1.
    pub(super) fn share(name: &'a str, effect: &'a str) -> Self {
        Self { range: 0.0..=1.0, step: (0.05, 2), ..Self::new(name, effect) }
    }
}

impl Asker<'_, '_> {
    /// Draws a number that is `shown` now and `stored` in the history, and asks for the user's changes to it. `command`
    /// gets the new value, or `None` for a reset by the icon or a double click.
    pub(super) fn number(
        &mut self,
        ui: &mut Ui,
        number: &Number<'_>,
        [shown, stored]: [f64; 2],
        command: impl Fn(Option<f64>) -> Command,
    ) {
        let mut value = shown;
        let document = self.shown.document;
        let refused =
            |value: f64| document.would_refuse(&command(Some(value))).map(|refusal| refusal.to_string());
        let mut field = NumberField::new(number.name, &mut value, number.range.clone())
            .unit(number.unit)
            .letter(number.letter)
            .step(number.step.0, number.step.1)
            .warn(number.warns)
            .limits(number.limits.clone().unwrap_or(number.range.clone()))
            .label(number.label.unwrap_or(number.name))
            .tip("", number.effect);
        if number.scene_decides {
            field = field.refused(&refused);
        }
        if let Some(default) = number.default {
            field = field.default_value(default);
        }
        if let Some(width) = number.unlabelled {
            field = field.unlabelled(width);
        }
        let answer = field.show(ui);
        if answer.reset {
            self.ask(command(None));
        } else if answer.stepped {
            if value != shown {
                let of = self.shown.document.selection().active();
                let key = format!("{} of {} of {of:?}", number.name, number.of);
                self.asks.push(Ask::DoMerged(command(Some(value)), key));
            }
        } else if answer.ended {
            // Back at the stored value, there is nothing to undo.
            self.asks.push(if value == stored { Ask::EndPreview } else { Ask::Do(command(Some(value))) });
        } else if answer.changed {
            self.asks.push(Ask::Preview(command(Some(value))));
        }
    }
}

/// The digits after the decimal point that a narrow field has room for.
pub(super) fn decimals(value: f64) -> usize {
    match value.abs() {
        ..10.0 => 3,
        10.0..100.0 => 2,
        _ => 1,
    }
}
