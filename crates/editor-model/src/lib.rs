//! Everything that the editor decides, without a window: document, commands, undo, tools, picking.

pub mod camera_rig;
pub mod path;
pub mod picking;
