//! Which extensions are read, and which are ignored because what they add is not painted. A file that requires any
//! other is refused.

use foldhash::{HashSet, HashSetExt};

use crate::cursor::Cursor;
use crate::finding::{Checked, Findings, Severity};

pub(crate) const LIGHTS: &str = "KHR_lights_punctual";
pub(crate) const QUANTIZATION: &str = "KHR_mesh_quantization";
pub(crate) const TEXTURE_TRANSFORM: &str = "KHR_texture_transform";
pub(crate) const UNLIT: &str = "KHR_materials_unlit";
pub(crate) const EMISSIVE_STRENGTH: &str = "KHR_materials_emissive_strength";
pub(crate) const VARIANTS: &str = "KHR_materials_variants";
pub(crate) const POINTER: &str = "KHR_animation_pointer";
pub(crate) const VISIBILITY: &str = "KHR_node_visibility";
pub(crate) const INSTANCING: &str = "EXT_mesh_gpu_instancing";
pub(crate) const WEBP: &str = "EXT_texture_webp";
pub(crate) const DRACO: &str = "KHR_draco_mesh_compression";
pub(crate) const MESHOPT: [&str; 2] = ["EXT_meshopt_compression", "KHR_meshopt_compression"];

const READ: [&str; 10] = [
    LIGHTS,
    QUANTIZATION,
    TEXTURE_TRANSFORM,
    UNLIT,
    EMISSIVE_STRENGTH,
    VARIANTS,
    POINTER,
    VISIBILITY,
    INSTANCING,
    WEBP,
];

/// Extensions that change nothing in a picture.
const SILENT: [&str; 6] = [
    "KHR_xmp_json_ld",
    "KHR_xmp",
    "KHR_node_selectability",
    "KHR_node_hoverability",
    "KHR_interactivity",
    "EXT_structural_metadata",
];

/// Extensions, besides those of `KHR_materials_`, whose effects are not seen. A file that requires one is still read.
const UNSEEN: [&str; 5] =
    ["EXT_lights_image_based", "EXT_lights_ies", "KHR_audio_emitter", "KHR_physics_rigid_bodies", "MSFT_lod"];

/// Reads `extensionsUsed` and `extensionsRequired`. It is called before buffers and accessors are read, so that a file
/// that needs Draco is refused for that reason.
pub(crate) fn check(root: &Cursor<'_, '_>, findings: &mut Findings) -> Checked<()> {
    let required = root.list("extensionsRequired")?;
    let mut names = HashSet::new();
    for item in required.iter() {
        let Some(name) = findings.take(item.text()) else { continue };
        if !names.insert(name) {
            findings.add(item.warning(format!("{name:?} is listed twice"), ""));
            continue;
        }
        if findings.is_full() {
            return Ok(());
        }
        if READ.contains(&name) || SILENT.contains(&name) {
            continue;
        }
        if is_unseen(name) {
            findings
                .add(item.warning(format!("{name} is not read: what it adds to the looks is not seen"), ""));
        } else {
            let message = format!("the file needs {name}, which is not read");
            findings.add(item.finding(Severity::Unsupported, message, mend(name)));
        }
    }
    let mut used_names = HashSet::new();
    for item in root.list("extensionsUsed")?.iter() {
        let Some(name) = findings.take(item.text()) else { continue };
        if !used_names.insert(name) {
            findings.add(item.warning(format!("{name:?} is listed twice"), ""));
        } else if !names.contains(&name) {
            if is_unseen(name) {
                findings.add(
                    item.warning(format!("{name} is not read: what it adds to the looks is not seen"), ""),
                );
            } else if name == "KHR_texture_basisu" || name == "MSFT_texture_dds" {
                let message = format!("{name} is not read: the plain pictures beside it are used");
                findings.add(item.warning(message, ""));
            }
        }
    }
    for name in names {
        if !used_names.contains(name) {
            let message = format!("{name} is required but not listed in extensionsUsed");
            findings.add(root.warning(message, ""));
        }
    }
    undeclared(root, &used_names, findings);
    Ok(())
}

/// Warns of extensions that the file has but does not declare. Those in [`READ`] are read all the same.
fn undeclared(root: &Cursor<'_, '_>, used: &HashSet<&str>, findings: &mut Findings) {
    let mut told: Vec<&str> = Vec::new();
    walk(root.json(), &mut |name| {
        if told.len() < 50 && !used.contains(name) && !told.contains(&name) {
            told.push(name);
            let message = format!("{name:?} is used, but not listed in extensionsUsed");
            findings.add(root.warning(message, "list it there"));
        }
    });
}

fn walk<'t>(json: &'t crate::json::Json<'_>, tell: &mut dyn FnMut(&'t str)) {
    use crate::json::Json;
    match json {
        Json::Array(items) => {
            // Arrays of numbers are long and hold nothing to find.
            for item in items.iter().filter(|item| matches!(item, Json::Array(_) | Json::Object(_))) {
                walk(item, tell);
            }
        }
        Json::Object(members) => {
            for (name, value) in members {
                if name == "extensions"
                    && let Json::Object(extensions) = value
                {
                    for (extension, _) in extensions {
                        tell(extension);
                    }
                }
                if name != "extras" {
                    walk(value, tell);
                }
            }
        }
        _ => {}
    }
}

fn is_unseen(name: &str) -> bool {
    name.starts_with("KHR_materials_") && !READ.contains(&name) || UNSEEN.contains(&name)
}

fn mend(name: &str) -> &'static str {
    if name == DRACO || MESHOPT.contains(&name) {
        "export without compression"
    } else if name == "KHR_texture_basisu" || name == "MSFT_texture_dds" {
        "export with PNG, JPEG or WebP pictures"
    } else {
        "export without it"
    }
}
