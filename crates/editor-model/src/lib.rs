//! Everything that the editor decides, without a window: document, commands, undo, tools, picking.
//!
//! ```text
//! plain events ─▶ tools ─▶ Command ─▶ Document::preview  (the scene as it would be; nothing is kept)
//!                                 └─▶ Document::apply    (one entry of the history)
//! ```
//!
//! So a test can change the document in every way in which a user can.

pub mod camera_rig;
mod change;
pub mod command;
pub mod document;
pub mod editor;
mod euler;
pub mod finished_frames;
pub mod gizmo;
mod history;
pub mod keymap;
mod names;
pub mod path;
pub mod picking;
mod picture_for;
pub mod playback;
pub mod recovery;
mod refusal;
pub mod render_settings;
pub mod selection;
pub mod session;
mod source;
pub mod stamp;
pub mod stroke_fields;
pub mod timeline;
pub mod tools;
pub mod transform;
pub mod watch;

pub use command::Command;
pub use document::Document;
pub use editor::Editor;
pub use picture_for::{NoisePart, PictureFor};
pub use refusal::Refusal;
pub use selection::{Item, Selection};
pub use session::Session;
