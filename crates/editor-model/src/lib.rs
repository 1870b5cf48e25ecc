//! Everything that the editor decides, without a window: document, commands, undo, tools, picking.

pub mod camera_rig;
pub mod gizmo;
pub mod keymap;
pub mod path;
pub mod picking;
pub mod transform;
