//! The user's preferences and recent files, kept as readable RON in the user's config folder.

mod own_keys;
mod store;
#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};

use impasto_editor_model::session::{Mode, Pressure};
use serde::{Deserialize, Serialize};

use crate::theme::Theme;

pub use own_keys::OwnKeysText;
pub use store::{Loaded, PreferencesError, config_folder, film_folder, load, recovery_folder, save};

/// The newest layout that this build reads.
pub const VERSION: u32 = 1;

/// How many files *Open recent* lists.
pub const MAX_RECENT: usize = 10;

/// For how many scenes the last mode and view are remembered.
pub const MAX_LAST_SEEN: usize = 50;

/// The user's choices, recent files, and last views. Fields that are missing in the file get their defaults; unknown
/// ones are ignored.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Preferences {
    /// The layout of the file.
    pub version: u32,
    /// The key bindings.
    pub keys: Keys,
    /// Keys in place of those that `keys` and `digits_as_numpad` give.
    pub own_keys: OwnKeysText,
    /// The colour theme.
    #[serde(with = "ThemeText")]
    pub theme: Theme,
    /// Size of the interface, 0.75 to 3.
    pub scale: f32,
    /// Whether the welcome sheet is shown at the start.
    pub show_welcome: bool,
    /// What draws the paintings.
    pub driver: DriverChoice,
    /// Seconds from an edit to the copy of unsaved work; 0 for no copies.
    pub copy_after_secs: u32,
    /// Whether the digits above the letters choose views, as those of the number pad do.
    pub digits_as_numpad: bool,
    /// Whether to preview what a comb would do, before the press.
    pub foresee_strokes: bool,
    /// What the pressure of a pen changes.
    #[serde(with = "PressureText")]
    pub pressure: Pressure,
    /// Whether to leave out animations that are not needed.
    pub reduced_motion: bool,
    /// Files that were opened or saved, newest first.
    pub recent: Vec<PathBuf>,
    /// The last mode and view in each scene, newest first.
    pub last_seen: Vec<LastSeen>,
    /// Width and height of the window, points.
    pub window_size: (f32, f32),
}

impl Default for Preferences {
    fn default() -> Self {
        Self {
            version: VERSION,
            keys: Keys::default(),
            own_keys: OwnKeysText::default(),
            theme: Theme::default(),
            scale: 1.0,
            show_welcome: true,
            driver: DriverChoice::default(),
            copy_after_secs: 10,
            digits_as_numpad: false,
            foresee_strokes: true,
            pressure: Pressure::default(),
            reduced_motion: false,
            recent: Vec::new(),
            last_seen: Vec::new(),
            window_size: (1280.0, 800.0),
        }
    }
}

/// The program whose key bindings and drags the editor uses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum Keys {
    /// As in Blender.
    #[default]
    Blender,
    /// As in Maya.
    Maya,
}

/// What draws the paintings.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub enum DriverChoice {
    /// The graphics card if there is one, else software.
    #[default]
    Auto,
    /// EGL.
    Egl,
    /// OSMesa, always in software.
    Osmesa,
    /// OSMesa, and the window in software, too.
    Software,
}

/// The last mode and view in one scene.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct LastSeen {
    /// The scene file.
    pub file: PathBuf,
    /// The mode.
    #[serde(with = "ModeText")]
    pub mode: Mode,
    /// The free view; none if it was the shot camera.
    pub view: Option<LastView>,
}

impl Default for LastSeen {
    fn default() -> Self {
        Self { file: PathBuf::new(), mode: Mode::default(), view: None }
    }
}

/// A free view. World space, world units.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LastView {
    /// Where the eye is.
    pub eye: [f64; 3],
    /// What it looks at.
    pub target: [f64; 3],
    /// Turn about the line of sight, degrees.
    #[serde(default)]
    pub roll_deg: f64,
    /// Whether the view is orthographic.
    #[serde(default)]
    pub orthographic: bool,
}

impl LastView {
    /// Whether the view can be used: its numbers are finite and below 1e9, and the eye is not at the target.
    pub fn is_sound(&self) -> bool {
        let numbers = self.eye.iter().chain(&self.target).chain([&self.roll_deg]);
        self.eye != self.target && numbers.into_iter().all(|number| number.is_finite() && number.abs() < 1e9)
    }
}

impl Preferences {
    /// Puts a file that was opened or saved on top of the recent ones. A path that is not valid Unicode is left out.
    pub fn note_recent(&mut self, file: &Path) {
        let Some(file) = storable(file) else { return };
        self.recent.retain(|known| *known != file);
        self.recent.insert(0, file);
        self.recent.truncate(MAX_RECENT);
    }

    /// The recent files that still exist, newest first.
    pub fn recent_there(&self) -> Vec<&Path> {
        self.recent.iter().map(PathBuf::as_path).filter(|file| file.is_file()).collect()
    }

    /// Remembers the last mode and view in a scene.
    pub fn note_last_seen(&mut self, file: &Path, mode: Mode, view: Option<LastView>) {
        let Some(file) = storable(file) else { return };
        self.last_seen.retain(|known| known.file != file);
        self.last_seen.insert(0, LastSeen { file, mode, view });
        self.last_seen.truncate(MAX_LAST_SEEN);
    }

    /// The last mode and view in a scene, if they are remembered.
    pub fn last_seen_in(&self, file: &Path) -> Option<&LastSeen> {
        let file = storable(file)?;
        self.last_seen.iter().find(|known| known.file == file)
    }

    /// Brings values, which may have been edited by hand, into the ranges that the editor can use.
    fn settle(&mut self) {
        let within = |value: f32, least: f32, most: f32, otherwise: f32| {
            if value.is_finite() { value.clamp(least, most) } else { otherwise }
        };
        self.version = VERSION;
        self.scale = within(self.scale, 0.75, 3.0, 1.0);
        self.copy_after_secs = self.copy_after_secs.min(7200);
        self.window_size.0 = within(self.window_size.0, 640.0, 16_384.0, 1280.0);
        self.window_size.1 = within(self.window_size.1, 440.0, 16_384.0, 800.0);
        self.recent.truncate(MAX_RECENT);
        self.last_seen.truncate(MAX_LAST_SEEN);
        for seen in &mut self.last_seen {
            seen.view = seen.view.filter(LastView::is_sound);
        }
    }
}

/// The absolute path; none if it is not valid Unicode.
fn storable(file: &Path) -> Option<PathBuf> {
    let file = std::path::absolute(file).ok()?;
    file.to_str().is_some().then_some(file)
}

/// How a theme is written in the file.
#[derive(Serialize, Deserialize)]
#[serde(remote = "Theme")]
enum ThemeText {
    Dark,
    Light,
}

/// How the pressure of a pen is written in the file.
#[derive(Serialize, Deserialize)]
#[serde(remote = "Pressure")]
enum PressureText {
    Off,
    Radius,
    Strength,
}

/// How a mode is written in the file.
#[derive(Serialize, Deserialize)]
#[serde(remote = "Mode")]
enum ModeText {
    Arrange,
    Paint,
    Animate,
}
