//! The inspector: the settings of the active item, or of the scene if nothing is selected.

mod amounts;
mod brushes;
mod camera;
mod controls;
mod edited_strokes;
mod ground;
mod guides;
mod ink;
mod layer_numbers;
mod light;
mod noise;
mod number;
mod object;
mod over_time;
mod paint_layers;
mod parts;
mod picture;
mod pigments;
mod pose;
mod preset_chooser;
mod region;
mod rotating_strokes;
mod scene;
mod strokes;
mod touch;

use egui::{ScrollArea, Ui};
use impasto_editor_model::Item;
use impasto_editor_model::command::Command;
use impasto_scene::document::Scene;

use super::{Ask, PanelInput};
use crate::widgets;
pub use controls::{Control, controls, reach};

/// The settings of what is selected. It fills the width and height of `ui`, which has no margins.
pub fn inspector(ui: &mut Ui, shown: &PanelInput<'_>, asks: &mut Vec<Ask>) {
    ui.spacing_mut().item_spacing.y = 0.0;
    let active = shown.document.selection().active().cloned();
    let mut asker = Asker { shown, asks };
    // Each item has its own scroll position; a guide shares that of its region.
    let salt = match &active {
        Some(Item::Guide(region, _)) => Some(Item::Region(region.clone())),
        other => other.clone(),
    };
    ScrollArea::vertical().id_salt(("inspector", salt)).auto_shrink(false).show(ui, |ui| {
        widgets::reachable(ui, |ui| match &active {
            Some(Item::Region(name)) => region::show(ui, &mut asker, name),
            Some(Item::Guide(name, _)) => region::show(ui, &mut asker, name),
            Some(Item::Object(name)) => object::show(ui, &mut asker, name),
            Some(Item::Light(name)) => light::show(ui, &mut asker, name),
            Some(Item::Touch(name)) => touch::show(ui, &mut asker, name),
            Some(Item::Camera) => camera::show(ui, &mut asker),
            None => scene::show(ui, &mut asker),
        });
        ui.add_space(12.0);
    });
}

/// What is shown, and the list that takes the inspector's requests for changes.
struct Asker<'a, 'b> {
    shown: &'a PanelInput<'a>,
    asks: &'b mut Vec<Ask>,
}

impl<'a> Asker<'a, '_> {
    /// The scene as it is shown, with the change being previewed.
    fn scene(&self) -> &'a Scene {
        &self.shown.document.shown().scene
    }

    /// The scene as the history has it, with poses that are not keyed yet.
    fn stored(&self) -> &'a Scene {
        let loose = self.shown.time.loose_scene().map(|loaded| &loaded.scene);
        loose.unwrap_or(self.shown.document.scene())
    }

    fn ask(&mut self, command: Command) {
        self.asks.push(Ask::Do(command));
    }
}
