//! The section of the inspector that lists what is painted onto a region's strokes.

use egui::Ui;
use impasto_editor_model::command::{Amounts, Command};
use impasto_editor_model::keymap::Action;
use impasto_scene::document::{Amount, PaintedAmount, Region};

use super::Asker;
use super::parts::{is_wide, note, row, section};
use crate::widgets::{self, Tip};

pub(super) fn section_of(ui: &mut Ui, asker: &mut Asker<'_, '_>, region: &Region) {
    let count = region.amounts.len();
    let open = is_wide(ui) || count > 0;
    section(ui, "Painted amounts", &count.to_string(), open, |ui| {
        if count == 0 {
            let keys = asker.shown.with_keys_of(Action::Amount, " ({})");
            note(ui, &format!("Nothing is painted. Paint width, length, density or flatness{keys}."));
        }
        for (index, amount) in region.amounts.iter().enumerate() {
            row(ui, label(amount.of), |ui| list(ui, asker, (region, index), amount));
        }
        if count > 1
            && widgets::Button::new("Clear all").name("Clear all amounts").danger().show(ui).clicked()
        {
            asker.ask(Command::Amounts(Amounts::ClearAll(region.name.clone())));
        }
    });
}

fn list(ui: &mut Ui, asker: &mut Asker<'_, '_>, (region, index): (&Region, usize), amount: &PaintedAmount) {
    let dabs = match amount.dabs.len() {
        1 => "1 dab".to_owned(),
        many => format!("{many} dabs"),
    };
    note(ui, &amount.object.as_ref().map_or(dabs.clone(), |object| format!("{dabs} on {object}")));
    let name = match &amount.object {
        Some(object) => format!("Clear {} on {object}", amount.of.word()),
        None => format!("Clear {}", amount.of.word()),
    };
    let button = widgets::Button::new("Clear").name(&name).show(ui);
    let tip = Tip {
        name: &name,
        effect: "Takes these dabs away; strokes go back to what the region states.",
        ..Tip::default()
    };
    if tip.on(button).clicked() {
        asker.ask(Command::Amounts(Amounts::Clear(region.name.clone(), index)));
    }
}

fn label(of: Amount) -> &'static str {
    match of {
        Amount::Width => "Width",
        Amount::Length => "Length",
        Amount::Density => "Density",
        Amount::Flatness => "Flatness",
    }
}
