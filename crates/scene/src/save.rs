//! Writes a document as a scene file that a person can read. Fields with their default values are left out, and equal
//! documents give equal bytes.

use std::path::Path;

use serde::Serialize;

use crate::document::{Camera, Scene};
use crate::strokes_file::StrokesFile;
use crate::whole_file;

mod layout;
mod serializer;

use layout::Value;

/// The document as text that [`crate::load::parse`] reads back as an equal document. What comes from its shot alone is
/// left out.
///
/// Colours are written with 8 bits a channel, which is all that a scene file can hold.
pub fn to_ron(scene: &Scene) -> String {
    let saved = scene.without_shot();
    let mut value = saved.serialize(serializer::ToValue).expect("a document holds only what RON can say");
    if saved.shot.is_some() {
        leave_to_shot(&mut value, &saved);
    }
    format!("#![enable(implicit_some)]\n{}\n", layout::lay_out(&value))
}

/// The preset as text that [`crate::load::strokes_file::parse`] reads back as an equal one.
pub fn preset_to_ron(preset: &StrokesFile) -> String {
    let value = preset.serialize(serializer::ToValue).expect("a preset holds only what RON can say");
    format!("#![enable(implicit_some)]\n{}\n", layout::lay_out(&value))
}

/// Takes out what a scene with a shot need not state.
fn leave_to_shot(value: &mut Value, saved: &Scene) {
    let Value::Group(root) = value else { return };
    root.items.retain(|(field, _)| match *field {
        "camera" => saved.camera != Camera::default(),
        "objects" => !saved.objects.is_empty(),
        _ => true,
    });
    for (field, objects) in &mut root.items {
        let Value::Group(objects) = objects else { continue };
        objects
            .items
            .retain(|(inner, _)| *field != "camera" || *inner != "keys" || !saved.camera.keys.is_empty());
        for (_, object) in objects.items.iter_mut().filter(|_| *field == "objects") {
            let Value::Group(object) = object else { continue };
            object.items.retain(|(field, value)| {
                *field != "mesh" || !matches!(value, Value::Word(word) if word == "\"\"")
            });
        }
    }
}

/// Writes the file of a preset, whole or not at all.
///
/// # Errors
///
/// What the file system said; the old file is then untouched.
pub fn write_preset(path: &Path, preset: &StrokesFile) -> std::io::Result<()> {
    whole_file::write(path, preset_to_ron(preset).as_bytes())
}

/// Writes a scene file so that at any moment, even after a crash, the path holds the old file or the new one, whole.
/// A link is followed: the file that it points to is replaced.
///
/// # Errors
///
/// What the file system said; the old file is then untouched.
pub fn write(path: &Path, scene: &Scene) -> std::io::Result<()> {
    whole_file::write(path, to_ron(scene).as_bytes())
}

#[cfg(test)]
mod tests;
