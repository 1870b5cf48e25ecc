//! Files from the user's side: asking for them, taking in what is dropped, and what is kept between sessions.

pub mod beside;
pub mod dialogs;
pub mod file_ask;
pub mod incoming;
pub mod nearby;
pub mod path_sheet;
pub mod preferences;
pub mod show_folder;
