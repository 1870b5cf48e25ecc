//! Takes files that the user chose for the scene: brushes, pictures of noise, files that were missing.

use std::path::Path;

use impasto_editor_model::Item;
use impasto_editor_model::command::{Arrange, Command, Regions, StrokeChange, StrokesOf};
use impasto_editor_model::editor::Mend;
use impasto_scene::document::BrushMix;

use super::EditorApp;
use crate::files::incoming::{adopt_picture, bring};
use crate::panels::NoisePart;

impl EditorApp {
    /// Makes a picture the brush of the selected region, or of the scene.
    pub(super) fn brush(&mut self, path: &Path) {
        let folder = self.editor.document().folder().to_owned();
        match adopt_picture(path, &folder) {
            Ok(adopted) => {
                let of = match self.editor.document().selection().active() {
                    Some(Item::Region(name)) => StrokesOf::Region(name.clone()),
                    _ => StrokesOf::Scene,
                };
                let brush = StrokeChange::Brush(Some(BrushMix(vec![adopted.name])));
                self.editor.run(&Command::Regions(Regions::SetStroke(of, brush)));
            }
            Err(error) => self.toast(error.to_string(), None, true),
        }
    }

    /// Makes a picture the noise that asked for one.
    pub(super) fn noise_picture(&mut self, path: &Path) {
        let Some((object, part)) = self.files.noise_of.take() else { return };
        let adopted = match adopt_picture(path, self.editor.document().folder()) {
            Ok(adopted) => adopted,
            Err(error) => return self.toast(error.to_string(), None, true),
        };
        let known = self.editor.document().scene().objects.iter().find(|known| known.name == object);
        let Some(mut material) = known.and_then(|known| known.material.clone()) else { return };
        if let Some(noise) = &mut material.noise_displace {
            let texture = match part {
                NoisePart::Vertex => noise.vertex.as_mut().map(|vertex| &mut vertex.texture),
                NoisePart::Surface => noise.surface.as_mut().map(|surface| &mut surface.texture),
            };
            if let Some(texture) = texture {
                *texture = Some(adopted.name);
            }
        }
        self.editor.run(&Command::Arrange(Arrange::SetMaterial(object, Some(material))));
    }

    /// Copies a file that was missing to where it is looked for, and reads it.
    pub(super) fn bring_file(&mut self, path: &Path) {
        let Some(to) = self.files.bring_to.take() else { return };
        match bring(path, &to) {
            Ok(()) => self.mend(Mend::ReadFiles),
            Err(words) => self.toast(words, None, true),
        }
    }
}
