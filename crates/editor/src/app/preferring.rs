//! Applies and saves the preferences that are set in the command search, the options bar and the sheet of keys.

use egui::Context;
use impasto_editor_model::keymap::{Digits, OwnKeys, Preset};

use super::EditorApp;
use crate::files::preferences::Keys;
use crate::panels::Preference;
use crate::theme;

impl EditorApp {
    /// Saves the setting of pen pressure if the options bar has changed it.
    pub(super) fn keep_pressure(&mut self) {
        let pressure = self.editor.session.options.pressure;
        if pressure != self.preferences.pressure {
            self.preferences.pressure = pressure;
            self.keep_preferences();
        }
    }

    /// Uses these keys in place of the preset's, and keeps them.
    pub(super) fn keep_own_keys(&mut self, own: &OwnKeys) {
        self.preferences.own_keys.set(own);
        self.keymap();
        self.keep_preferences();
    }

    /// Applies a preference, and saves it.
    pub(super) fn prefer(&mut self, preference: Preference, ctx: &Context) {
        let preferences = &mut self.preferences;
        match preference {
            Preference::Theme(theme) => preferences.theme = theme,
            Preference::Scale(scale) => preferences.scale = scale,
            Preference::Keys(Preset::Blender) => preferences.keys = Keys::Blender,
            Preference::Keys(Preset::Maya) => preferences.keys = Keys::Maya,
            Preference::Digits(digits) => preferences.digits_as_numpad = digits == Digits::NumPad,
            Preference::ForeseeStrokes(foresees) => preferences.foresee_strokes = foresees,
            Preference::ReducedMotion(reduced) => preferences.reduced_motion = reduced,
        }
        self.keymap();
        theme::apply(ctx, self.preferences.theme, self.preferences.scale);
        self.keep_preferences();
    }
}
