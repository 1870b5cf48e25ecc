//! Preferences that can be set from the command search.

use impasto_editor_model::keymap::{Digits, Preset};

use crate::theme::Theme;

/// A preference with its value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Preference {
    /// Dark or light.
    Theme(Theme),
    /// The scale of the interface; 1 is 100 %.
    Scale(f32),
    /// Whose key bindings are used.
    Keys(Preset),
    /// What the digits above the letters do.
    Digits(Digits),
    /// Whether the user sees, before the press, how a comb would lay the strokes.
    ForeseeStrokes(bool),
    /// Whether animations that are not needed are left out.
    ReducedMotion(bool),
}
