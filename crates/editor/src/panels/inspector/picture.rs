//! A row of the inspector that names a picture file: typed, or chosen from a dialog.

use egui::Ui;
use impasto_editor_model::PictureFor;

use super::Asker;
use super::parts::{FieldStyle, reset, row, text};
use crate::icons;
use crate::panels::Ask;
use crate::theme::measure;
use crate::widgets::{self, Tip};

/// The picture that something uses.
pub(super) struct Picture<'a> {
    pub(super) label: &'a str,
    /// The row's name for screen readers, as in *Surface noise file*.
    pub(super) name: &'a str,
    /// What the picture does, one sentence.
    pub(super) effect: &'a str,
    pub(super) of: PictureFor,
    /// The file, as the scene names it.
    pub(super) file: Option<&'a str>,
}

impl Asker<'_, '_> {
    /// Draws the row. An empty name removes the picture, as the reset icon does.
    pub(super) fn picture(&mut self, ui: &mut Ui, picture: &Picture<'_>) {
        let Picture { label, name, effect, of, file } = picture;
        let key = egui::Id::unique(("picture", of));
        let is_there = file.is_none_or(|file| self.shown.document.shown().textures.contains_key(file));
        let look = if is_there { FieldStyle::Field } else { FieldStyle::Wrong };
        row(ui, label, |ui| {
            ui.spacing_mut().item_spacing.x = 4.0;
            let end = if file.is_some() { measure::ROW_END + 4.0 } else { 0.0 };
            let room = ui.available_width() - measure::BUTTON - 4.0 - end;
            let typed = ui.scope(|ui| {
                ui.set_max_width(room);
                text(ui, name, key, file.unwrap_or_default(), look)
            });
            if let Some(typed) = typed.inner {
                let typed = typed.trim().to_owned();
                self.asks.push(Ask::NamePicture(of.clone(), Some(typed).filter(|typed| !typed.is_empty())));
            }
            let browse = format!("Browse for {name}");
            let button = widgets::icon_button(ui, icons::OPEN_FOLDER, &browse);
            let range = "A picture that is dropped on the window is taken too, while the object is selected.";
            let range = if matches!(of, PictureFor::Texture(_)) { range } else { "" };
            if (Tip { name: "Choose a picture", key: "", effect, range }).on(button).clicked() {
                self.asks.push(Ask::ChoosePicture(of.clone()));
            }
            if file.is_some() && reset(ui, name) {
                self.asks.push(Ask::NamePicture(of.clone(), None));
            }
        });
    }
}
