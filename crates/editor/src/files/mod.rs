//! Files from the user's side: asking for them, taking in what is dropped, and what is kept between sessions.

pub mod dialogs;
pub mod incoming;
pub mod path_sheet;
pub mod preferences;
