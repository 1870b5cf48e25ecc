//! Remembers the lane whose name was clicked last. The background and the scene's strokes cannot be selected as items,
//! so the user clicks the names of their lanes to see their curves.

use egui::{Id, Ui};
use impasto_editor_model::command::KeyOf;

fn id() -> Id {
    Id::unique("lane that was clicked")
}

pub(super) fn note(ui: &Ui, of: &KeyOf) {
    ui.data_mut(|data| data.insert_temp(id(), of.clone()));
}

/// The owner of the lane, if one was clicked.
pub(super) fn last(ui: &Ui) -> Option<KeyOf> {
    ui.data(|data| data.get_temp(id()))
}
