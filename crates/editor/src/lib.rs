//! The editor's window: egui panels and the viewport. What they show and change lies in the crate `editor-model`.

mod app;
pub mod files;
mod frame_reading;
pub mod icons;
mod options;
pub mod panels;
mod preset_pictures;
mod priority;
pub mod rendering;
pub mod theme;
pub mod viewport;
pub mod widgets;
pub mod window;
pub mod worker;

use files::incoming;
use files::preferences::{self, DriverChoice, Loaded, Preferences};
use impasto_gl_render::shader_folder::ShaderFolder;

pub use options::EditOptions;

/// Why the editor did not open.
#[derive(Debug, thiserror::Error)]
pub enum EditError {
    /// The file or the shaders cannot be used; the text says why.
    #[error("{0}")]
    Refused(String),
    /// The window could not be opened, or failed while it was open.
    #[error(transparent)]
    Window(#[from] window::WindowError),
}

/// Opens the editor and stays until it is closed. Must be called on the main thread, once.
///
/// # Errors
/// [`EditError`]: a file that is neither scene nor mesh, shaders that cannot be read, no display, no OpenGL.
pub fn run(options: &EditOptions) -> Result<(), EditError> {
    if let Some(path) = &options.path {
        // A file that cannot begin a scene is refused here, just as when it is dropped on an empty window.
        let plan = incoming::plan(std::slice::from_ref(path), incoming::Present::Nothing);
        if let Some(words) = plan.refused.into_iter().next() {
            return Err(EditError::Refused(words));
        }
    }
    let shaders =
        options.shaders.as_deref().map(ShaderFolder::open).transpose().map_err(EditError::Refused)?;
    let loaded = match preferences::config_folder() {
        Some(folder) => preferences::load(&folder),
        None => Loaded { preferences: Preferences::default(), note: None },
    };
    if options.driver.unwrap_or(loaded.preferences.driver) == DriverChoice::Software {
        window::force_software();
    }
    let (width, height) = loaded.preferences.window_size;
    let window_options = window::Options { size: egui::vec2(width, height), ..window::Options::default() };
    Ok(window::run(window_options, |opened| app::EditorApp::new(options, loaded, shaders, opened))?)
}
