//! The document: what a `.ron` scene file means, mesh files, keyframes, located errors.

pub mod assets;
pub mod document;
pub mod loaded;
pub mod mesh_file;
pub mod motion;
pub mod presets;
pub mod problem;
mod values;
