//! The row that chooses what the scene's objects stand on. Both the page of the scene and that of the ground show it.

use egui::Ui;
use impasto_editor_model::command::{Command, SceneEdit};
use impasto_scene::new_scene::Ground;

use super::Asker;
use super::parts::row;
use crate::widgets;

pub(super) fn choice(ui: &mut Ui, asker: &mut Asker<'_, '_>) {
    row(ui, "Ground", |ui| {
        let now = Ground::of_scene(asker.scene());
        let mut chosen = Ground::ALL.iter().position(|(_, ground)| *ground == now).unwrap_or(0);
        if widgets::combo(ui, "Ground", None, &["Backdrop", "Vignette", "Plain"], &mut chosen).changed() {
            asker.ask(Command::Scene(SceneEdit::SetGround(Ground::ALL[chosen].1)));
        }
    });
}
