//! Files from the user's side: file dialogs, dropped and imported files, and preferences.

pub mod beside;
pub mod dialogs;
pub mod file_ask;
pub mod incoming;
pub mod nearby;
pub mod own_presets;
pub mod path_sheet;
pub mod preferences;
pub mod show_folder;
