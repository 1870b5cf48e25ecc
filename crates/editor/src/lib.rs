//! The editor's window: egui panels and the viewport over `editor-model`.

pub mod worker;
