//! The editor's window: egui panels and the viewport over `editor-model`.

pub mod icons;
pub mod panels;
pub mod theme;
pub mod widgets;
pub mod window;
pub mod worker;
