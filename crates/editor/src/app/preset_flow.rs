//! Saves, lists and applies the user's own presets, and has pictures of all presets painted.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use egui::{Context, TextureHandle, TextureOptions};
use impasto_editor_model::command::{Command, Regions, StrokeChange, StrokesOf};
use impasto_editor_model::editor::Offer;
use impasto_gl_render::ShaderTexts;
use impasto_gl_render::context::Driver;
use impasto_scene::load::strokes_file::{self, ENDING};
use impasto_scene::presets;
use impasto_scene::strokes_file::StrokesFile;
use impasto_scene::whole_file::failure_in_words;

use super::EditorApp;
use crate::files::file_ask::FileAsk;
use crate::files::own_presets::{
    OwnPreset, preset_command, presets_folder, presets_in, save_preset, seen_with_preset,
};
use crate::panels::problems::TroubleOf;
use crate::preset_pictures::{PresetPictures, SceneOf, Wanted};
use crate::window::Waker;

/// At most this many presets get a picture; further ones are chosen by their names.
const MOST_PICTURES: usize = 40;

/// The user's presets, and the pictures of all presets.
pub(super) struct PresetFlow {
    /// The presets in the user's folder.
    pub(super) own: Vec<OwnPreset>,
    /// The scene or region whose settings are to be saved or replaced, while a file is chosen.
    of: Option<StrokesOf>,
    driver: Driver,
    waker: Waker,
    /// Paints the pictures; `None` until the first one is wanted.
    painter: Option<PresetPictures>,
    pictures: BTreeMap<String, TextureHandle>,
    /// What the pictures show: the version of the scene, the scene or region that gets the presets, and the frame at
    /// which the list was opened.
    shows: Option<(u64, StrokesOf, f64)>,
    /// Whether the list was open in the last pass.
    is_listed: bool,
    /// Whether the pictures are being painted, or are done.
    paints: bool,
}

impl PresetFlow {
    pub(super) fn new(driver: Driver, waker: Waker) -> Self {
        Self {
            own: Vec::new(),
            of: None,
            driver,
            waker,
            painter: None,
            pictures: BTreeMap::new(),
            shows: None,
            is_listed: false,
            paints: false,
        }
    }

    /// The pictures that are painted, by preset.
    pub(super) fn pictures(&self) -> &BTreeMap<String, TextureHandle> {
        &self.pictures
    }

    /// Drops all pictures, and gives up those under way.
    pub(super) fn forget_pictures(&mut self) {
        self.pictures.clear();
        (self.shows, self.paints) = (None, false);
        if let Some(painter) = &self.painter {
            painter.want(Vec::new(), ShaderTexts::default());
        }
    }

    /// Begins a pass: takes the pictures that came, and stops painting others once the list is closed.
    pub(super) fn follow(&mut self, ctx: &Context) {
        let Some(painter) = &self.painter else { return };
        for (name, image) in painter.take() {
            let picture = ctx.load_texture(format!("preset {name}"), image, TextureOptions::LINEAR);
            self.pictures.insert(name, picture);
        }
        if !std::mem::take(&mut self.is_listed) && std::mem::take(&mut self.paints) {
            painter.want(Vec::new(), ShaderTexts::default());
        }
    }
}

impl EditorApp {
    pub(super) fn list_presets(&mut self) {
        self.presets.own = presets_folder().map_or_else(Vec::new, |folder| presets_in(&folder));
    }

    /// Has pictures of the scene painted, one for each preset applied to `of`, up to [`MOST_PICTURES`], unless they are
    /// already done or being painted.
    pub(super) fn picture_presets(&mut self, of: StrokesOf) {
        self.presets.is_listed = true;
        let (version, now) = (self.editor.shown().1, self.editor.session.frame.round());
        // Keeps the frame at which the list was opened, because the shot may play while the list is open.
        let opened_at = self.presets.shows.as_ref().filter(|_| self.presets.paints).map(|(.., frame)| *frame);
        let frame = opened_at.unwrap_or(now);
        let shows = Some((version, of.clone(), frame));
        if self.presets.shows != shows {
            self.presets.forget_pictures();
            self.presets.shows = shows;
        }
        // The picture of the window comes first.
        if self.presets.paints || self.picture_flow.at_rest().is_none() {
            return;
        }
        self.presets.paints = true;
        if self.presets.painter.is_none() {
            let waker = self.presets.waker.clone();
            self.presets.painter = PresetPictures::start(self.presets.driver, move || waker.wake()).ok();
        }
        let trial = self.editor.document().trial();
        let built_in = presets::names().map(|name| {
            let change = StrokeChange::Preset(Some(name.to_owned()));
            let command = Command::Regions(Regions::SetStroke(of.clone(), change));
            let trial = trial.clone();
            let scene: SceneOf = Arc::new(move || trial.with(&command, None).ok());
            (name.to_owned(), scene)
        });
        let own = self.presets.own.iter().map(|own| {
            let (trial, of, path) = (trial.clone(), of.clone(), own.path.clone());
            let scene: SceneOf = Arc::new(move || seen_with_preset(&trial, &of, &path));
            (own.key(), scene)
        });
        let wanted = built_in.chain(own).take(MOST_PICTURES);
        let wanted = wanted.filter(|(name, _)| !self.presets.pictures.contains_key(name));
        let wanted = wanted.map(|(name, scene)| Wanted { name, scene, frame }).collect();
        if let Some(painter) = &self.presets.painter {
            painter.want(wanted, self.shaders.texts());
        }
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
                self.presets.forget_pictures();
                self.toast(format!("Saved the preset {}", strokes_file::name_of(path)), None, false);
                self.list_presets();
            }
            Err(words) => self.trouble(TroubleOf::SavePreset(of, path.to_owned()), words),
        }
    }

    /// Tries again to save settings that could not be saved.
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
