//! Presets of the user's own: saves them, lists them, and applies them.

use std::path::Path;

use egui::Context;
use impasto_editor_model::command::StrokesOf;
use impasto_editor_model::editor::Offer;
use impasto_scene::load::strokes_file::{self, ENDING};
use impasto_scene::strokes_file::StrokesFile;
use impasto_scene::whole_file::failure_in_words;

use super::EditorApp;
use crate::files::file_ask::FileAsk;
use crate::files::own_presets::{OwnPreset, preset_command, presets_folder, presets_in, save_preset};
use crate::panels::problems::TroubleOf;

/// The user's presets.
#[derive(Default)]
pub(super) struct PresetFlow {
    /// The presets in the user's folder.
    pub(super) own: Vec<OwnPreset>,
    /// Whose settings are to be saved or replaced, while a file is chosen.
    of: Option<StrokesOf>,
}

impl EditorApp {
    /// Looks which presets are in the user's folder.
    pub(super) fn list_presets(&mut self) {
        self.presets.own = presets_folder().map_or_else(Vec::new, |folder| presets_in(&folder));
    }

    /// Lets the user choose a file for the settings of the scene or of a region.
    pub(super) fn ask_for_preset(&mut self, ask: FileAsk, of: StrokesOf, ctx: &Context) {
        let folder = presets_folder().unwrap_or_else(|| self.editor.document().folder().to_owned());
        if ask.is_save()
            && let Err(error) = std::fs::create_dir_all(&folder)
        {
            let words = format!("{}: {}", folder.display(), failure_in_words(&error));
            return self.toast(words, None, true);
        }
        let name = match &of {
            StrokesOf::Scene => self.editor.document().name().trim_end_matches(".ron").to_owned(),
            StrokesOf::Region(name) => name.replace(['/', '\\'], " "),
        };
        self.presets.of = Some(of);
        let start = if ask.is_save() { folder.join(format!("{name}{ENDING}")) } else { folder };
        self.files.dialogs.open(ctx, ask, &start);
    }

    /// Saves the settings that were asked for.
    pub(super) fn save_preset(&mut self, path: &Path) {
        let Some(of) = self.presets.of.take() else { return };
        let document = self.editor.document();
        let scene = document.scene();
        let index = match &of {
            StrokesOf::Scene => None,
            StrokesOf::Region(name) => {
                let index = scene.regions.iter().position(|region| region.name == *name);
                if index.is_none() {
                    return self.toast(format!("{name} is not there any more"), None, true);
                }
                index
            }
        };
        let preset = StrokesFile::of(scene, index);
        match save_preset(preset, |name| document.file_at_hand(name), path) {
            Ok(()) => {
                self.toast(format!("Saved the preset {}", strokes_file::name_of(path)), None, false);
                self.list_presets();
            }
            Err(words) => self.trouble(TroubleOf::SavePreset(of, path.to_owned()), words),
        }
    }

    /// Saves again what could not be saved.
    pub(super) fn save_preset_again(&mut self, of: StrokesOf, path: &Path) {
        self.settled(&TroubleOf::SavePreset(of.clone(), path.to_owned()));
        self.presets.of = Some(of);
        self.save_preset(path);
    }

    /// Applies the preset that was chosen.
    pub(super) fn load_preset(&mut self, path: &Path) {
        if let Some(of) = self.presets.of.take() {
            self.use_preset(of, path);
        }
    }

    /// Replaces the settings of the scene, or of a region, by those of a preset; its pictures are copied beside the
    /// scene. If anything is wrong with the preset, nothing changes.
    pub(super) fn use_preset(&mut self, of: StrokesOf, path: &Path) {
        let trouble = TroubleOf::Preset(of.clone(), path.to_owned());
        self.settled(&trouble);
        match preset_command(self.editor.document(), &of, path) {
            Err(words) => self.trouble(trouble, words),
            Ok(command) => {
                if let Some(refusal) = self.editor.document().would_refuse(&command) {
                    return self.trouble(trouble, refusal.to_string());
                }
                if self.editor.run(&command) {
                    let name = strokes_file::name_of(path);
                    self.toast(format!("Preset {name}"), Some(Offer::Undo), false);
                }
            }
        }
    }
}
