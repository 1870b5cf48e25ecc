//! The document: what a `.ron` scene file means, mesh files, keyframes, located errors.

pub mod document;
pub mod mesh_file;
mod values;
