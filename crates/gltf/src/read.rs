//! Reads a file from the outside in: container, JSON, buffers, accessors, then all that is built from them. Each step
//! needs the results of earlier steps, so reading stops after a step that finds errors.

use crate::bytes::Bytes;
use crate::cursor::Cursor;
use crate::decode::Accessors;
use crate::finding::{Checked, Finding, Findings, Severity};
use crate::read_animation::{self, Driven};
use crate::read_mesh::{self, Counts};
use crate::read_node::{self, Joints, Referred};
use crate::source::{Open, Source};
use crate::{Gltf, accessor, camera_light, container, extensions, images, json, material};

/// Reads a glTF 2.0 file, `.gltf` or `.glb`, from its bytes. Opens nothing itself: it asks `open` for buffers and
/// pictures in files beside the glTF file, by names that were checked to stay in the folder.
///
/// No list is made longer than the bytes hold. Where the format lets a file claim zeros without bytes, a limit applies
/// ([`crate::SPARE_BYTES`]). The second result is a list of warnings, which say what was replaced or left out.
///
/// # Errors
/// At least one fatal finding first, then warnings: the file is broken, needs a feature that is not read, or exceeds a
/// limit.
pub fn read(file: Vec<u8>, open: &mut Open<'_>) -> Result<(Gltf, Vec<Finding>), Vec<Finding>> {
    let mut findings = Findings::default();
    let read = read_file(Bytes::new(file), open, &mut findings);
    let gltf = findings.take(read).flatten();
    match gltf {
        Some(gltf) if !findings.any_fatal() => Ok((gltf, findings.into_list())),
        _ => Err(findings.into_list()),
    }
}

/// `None`: there are fatal findings, which say why.
fn read_file(file: Bytes, open: &mut Open<'_>, findings: &mut Findings) -> Checked<Option<Gltf>> {
    let container = container::split(&file, findings)?;
    let json = json::parse(&container.json)?;
    let root = Cursor::root(&json).checked_object()?;
    check_version(&root, findings)?;
    warn_of_empty_lists(&root, findings)?;
    extensions::check(&root, findings)?;
    if findings.any_fatal() {
        return Ok(None);
    }
    let mut source = Source::new(open, file.len() as u64);
    source.read_views(&root, container.bin.as_ref(), findings)?;
    if findings.any_fatal() {
        return Ok(None);
    }
    let list = accessor::read_all(&root, &source.views, findings)?;
    if findings.any_fatal() {
        return Ok(None);
    }
    let mut accessors = Accessors::new(source, root.list("accessors")?, list);
    read_parts(&root, &mut accessors, findings)
}

fn read_parts(
    root: &Cursor<'_, '_>,
    accessors: &mut Accessors<'_, '_, '_>,
    findings: &mut Findings,
) -> Checked<Option<Gltf>> {
    take_memory_of_lists(root, accessors)?;
    let image_count = root.list("images")?.len();
    let textures = material::textures(root, image_count, findings)?;
    if findings.any_fatal() {
        return Ok(None);
    }
    let materials = material::materials(root, textures.len(), findings)?;
    let mut is_needed = vec![false; image_count];
    for used in materials.iter().flat_map(|material| [material.base_color_texture, material.emissive_texture])
    {
        if let Some(image) = used.and_then(|used| textures[used.texture].image) {
            is_needed[image] = true;
        }
    }
    let images = images::images(root, &mut accessors.source, &is_needed, findings)?;
    let variants = variants(root, findings)?;
    let cameras = camera_light::cameras(root, findings)?;
    let lights = camera_light::lights(root, findings)?;
    if findings.any_fatal() {
        return Ok(None);
    }
    let counts = Counts { materials: materials.len(), variants: variants.len() };
    let meshes = read_mesh::read_all(root, accessors, counts, findings)?;
    let node_count = root.list("nodes")?.len();
    let skins = read_node::skins(root, accessors, node_count, findings)?;
    if findings.any_fatal() {
        return Ok(None);
    }
    let joints_of_meshes: Vec<Joints> = meshes.iter().map(|mesh| Joints::of(mesh)).collect();
    let referred = Referred {
        nodes: node_count,
        meshes: &meshes,
        cameras: cameras.len(),
        lights: lights.len(),
        skins: &skins,
        joints_of_meshes: &joints_of_meshes,
    };
    let nodes = read_node::nodes(root, &referred, accessors, findings)?;
    if findings.any_fatal() {
        return Ok(None);
    }
    let roots = read_node::roots(root, &nodes, findings)?;
    let driven = Driven {
        nodes: &nodes,
        meshes: &meshes,
        cameras: &cameras,
        lights: lights.len(),
        materials: materials.len(),
    };
    let animations = read_animation::read_all(root, &driven, accessors, findings)?;
    Ok(Some(Gltf {
        nodes,
        roots,
        meshes,
        materials,
        textures,
        images,
        cameras,
        lights,
        skins,
        animations,
        variants,
    }))
}

/// The lists of objects at the top level of a document.
const LISTS: [&str; 13] = [
    "accessors",
    "animations",
    "bufferViews",
    "buffers",
    "cameras",
    "images",
    "materials",
    "meshes",
    "nodes",
    "samplers",
    "scenes",
    "skins",
    "textures",
];

/// An empty list is against the specification, and harmless.
fn warn_of_empty_lists(root: &Cursor<'_, '_>, findings: &mut Findings) -> Checked<()> {
    for name in LISTS {
        let list = root.list(name)?;
        if let Some(member) = root.member(name).filter(|_| list.len() == 0) {
            findings.add(member.warning("the list is empty", ""));
        }
    }
    Ok(())
}

/// Accounts for the memory of the lists that are made from the JSON: `{}` has two bytes in the file, and may become a
/// node.
fn take_memory_of_lists(root: &Cursor<'_, '_>, accessors: &mut Accessors<'_, '_, '_>) -> Checked<()> {
    const BYTES_EACH: usize = 600;
    for name in LISTS {
        let count = root.list(name)?.len();
        accessors.take_memory(count, BYTES_EACH, root)?;
    }
    Ok(())
}

fn check_version(root: &Cursor<'_, '_>, findings: &mut Findings) -> Checked<()> {
    let asset = root.required("asset")?;
    let version_cursor = asset.required("version")?;
    let [major, minor] = version(&version_cursor)?;
    if major != 2 {
        let message = format!("the file is glTF {major}.{minor}, and glTF 2 is read");
        return Err(Box::new(version_cursor.finding(Severity::Unsupported, message, "export as glTF 2.0")));
    }
    if let Some(member) = asset.member("minVersion") {
        let least = version(&member)?;
        if least > [2, 0] {
            let message = format!("the file needs glTF {}.{}, and 2.0 is read", least[0], least[1]);
            return Err(Box::new(member.finding(Severity::Unsupported, message, "export as glTF 2.0")));
        }
    } else if minor > 0 {
        findings.add(version_cursor.warning(format!("the file is glTF 2.{minor}, and is read as 2.0"), ""));
    }
    Ok(())
}

fn version(cursor: &Cursor<'_, '_>) -> Checked<[u32; 2]> {
    let parse = |text: &str| {
        let (major, minor) = text.split_once('.')?;
        Some([major.parse().ok()?, minor.parse().ok()?])
    };
    parse(cursor.text()?).ok_or_else(|| cursor.error("it is no version, as in 2.0"))
}

fn variants(root: &Cursor<'_, '_>, findings: &mut Findings) -> Checked<Vec<String>> {
    let Some(extensions) = root.object("extensions")? else { return Ok(Vec::new()) };
    let Some(extension) = extensions.object(extensions::VARIANTS)? else { return Ok(Vec::new()) };
    let mut names = Vec::new();
    for variant in extension.list("variants")?.iter() {
        let name = variant.optional_text("name")?;
        if name.is_none() {
            findings.add(variant.warning("the variant has no name", ""));
        }
        names.push(name.unwrap_or_default().to_owned());
    }
    if names.len() > 1 {
        let message = format!("of {} variants of materials, the first is used", names.len());
        findings.add(extension.warning(message, ""));
    }
    Ok(names)
}
