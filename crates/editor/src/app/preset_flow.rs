//! Presets of the user's own: saves them, lists them, and applies them.

use std::path::{Path, PathBuf};

use egui::Context;
use impasto_editor_model::command::{Command, Regions, StrokesOf};
use impasto_editor_model::editor::Offer;
use impasto_scene::load::strokes_file::{self, ENDING};
use impasto_scene::strokes_file::StrokesFile;
use impasto_scene::whole_file::failure_in_words;
use impasto_scene::{assets, save};

use super::EditorApp;
use crate::files::file_ask::FileAsk;
use crate::files::own_presets::{OwnPreset, presets_folder, presets_in, take_brushes_along};
use crate::panels::problems::TroubleOf;

/// The user's presets.
#[derive(Default)]
pub(super) struct PresetFlow {
    /// Those in the user's folder.
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
        let mut preset = StrokesFile::of(scene, index);
        let folder = path.parent().unwrap_or(Path::new(".")).to_owned();
        let taken = take_brushes_along(&mut preset, |name| document.file_at_hand(name), &folder);
        let written = taken.map_err(|error| error.to_string()).and_then(|()| {
            save::write_preset(path, &preset).map_err(|error| {
                format!("the preset could not be saved to {}: {}", path.display(), failure_in_words(&error))
            })
        });
        match written {
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
        match self.preset_for_scene(path) {
            Err(words) => self.trouble(trouble, words),
            Ok(preset) => {
                let name = strokes_file::name_of(path);
                let preset = Box::new(preset);
                let command = Command::Regions(Regions::ApplyPreset { of, preset, name: name.clone() });
                if let Some(refusal) = self.editor.document().would_refuse(&command) {
                    return self.trouble(trouble, refusal.to_string());
                }
                if self.editor.run(&command) {
                    self.toast(format!("Preset {name}"), Some(Offer::Undo), false);
                }
            }
        }
    }

    fn preset_for_scene(&self, path: &Path) -> Result<StrokesFile, String> {
        let mut preset = strokes_file::load(path).map_err(|report| {
            let words: Vec<String> = report.0.iter().take(3).map(ToString::to_string).collect();
            words.join("; ")
        })?;
        let beside: PathBuf = path.to_owned();
        let file_of = |name: &str| {
            let root = beside.parent().filter(|folder| !folder.as_os_str().is_empty());
            let root = root.unwrap_or(Path::new("."));
            let request = assets::AssetRequest { beside: &beside, root, name, max_bytes: u64::MAX };
            assets::AssetFolders::default().find(&request).ok()
        };
        take_brushes_along(&mut preset, file_of, self.editor.document().folder())
            .map_err(|error| error.to_string())?;
        Ok(preset)
    }
}
