//! `impasto info`: what is in a scene or a mesh.

use std::collections::{BTreeSet, HashMap};
use std::io::Write as _;
use std::sync::Arc;

use impasto_painting::{Painting, PrepareOptions};
use impasto_scene::document::Region;
use impasto_scene::mesh_file::MeshFile;

use crate::args::InfoArguments;
use crate::failure::Failure;
use crate::session::{self, Prepared};
use crate::talk::Loudness;

pub(crate) fn run(arguments: &InfoArguments) -> Result<(), Failure> {
    let loaded = session::read_scene(&arguments.scene, false)?;
    let Prepared { painting, storing: _storing } =
        session::prepare_scene(loaded, &arguments.scene, PrepareOptions::default(), Loudness::Warnings)?;
    let facts = facts(&painting);
    let mut out = std::io::stdout();
    if arguments.json {
        writeln!(out, "{facts}")?;
        return Ok(());
    }
    let scene = painting.scene();
    writeln!(out, "{}", painting.loaded().path.display())?;
    writeln!(
        out,
        "size {} x {}, frames {} to {} at {} a second",
        scene.size.0, scene.size.1, scene.timeline.first, scene.timeline.last, scene.timeline.fps
    )?;
    for mesh in facts["meshes"].as_array().into_iter().flatten() {
        writeln!(
            out,
            "mesh {}{}: {} polygons, {} triangles, {} vertices, {} groups, {} materials, bounds {} to {}",
            text(&mesh["path"]),
            match mesh["also"].as_array().map_or(0, Vec::len) {
                0 => String::new(),
                others => format!(" (and {others} more of its instances)"),
            },
            mesh["polygons"],
            mesh["triangles"],
            mesh["vertices"],
            mesh["groups"].as_array().map_or(0, Vec::len),
            mesh["materials"].as_array().map_or(0, Vec::len),
            mesh["bounds"][0],
            mesh["bounds"][1],
        )?;
    }
    if let (Some(name), Some(shot)) = (&scene.shot, &scene.stage.shot) {
        let span = match shot.span_s() {
            Some([first, last]) => format!("moves from {first:.3} to {last:.3} seconds"),
            None => "nothing moves".to_owned(),
        };
        let objects = scene.objects.iter().filter(|object| shot.has_object(&object.name)).count();
        let camera = if shot.has_camera() { "a camera" } else { "no camera" };
        writeln!(out, "shot {name}: {objects} objects, {camera}, {span}")?;
    }
    for object in facts["objects"].as_array().into_iter().flatten() {
        writeln!(
            out,
            "object {}: {} particles, area {:.4}{}",
            text(&object["name"]),
            object["particles"],
            object["area"].as_f64().unwrap_or(0.0),
            if object["hidden"] == true { ", hidden" } else { "" }
        )?;
        let singular = object["singularities"].as_array().map_or(&[][..], Vec::as_slice);
        if !singular.is_empty() {
            writeln!(out, "  strokes have no direction at {} points:", singular.len())?;
            for point in singular {
                writeln!(out, "    {} index {}", point["position"], point["index"])?;
            }
        }
    }
    let regions: Vec<String> = scene.regions.iter().map(region_words).collect();
    writeln!(out, "regions: {}", if regions.is_empty() { "none".to_owned() } else { regions.join(", ") })?;
    writeln!(
        out,
        "{} particles, at most {:.1} MB of them, {} lights",
        facts["particles"],
        painting.particle_bytes() as f64 / 1e6,
        scene.lights.len()
    )?;
    Ok(())
}

/// A region's name, with what is special about it.
fn region_words(region: &Region) -> String {
    let mut facts = Vec::new();
    match region.guides.len() {
        0 => {}
        1 => facts.push("1 guide".to_owned()),
        guides => facts.push(format!("{guides} guides")),
    }
    if !region.amounts.is_empty() {
        let words: Vec<&str> = region.amounts.iter().map(|amount| amount.of.word()).collect();
        facts.push(format!("painted {}", words.join(", ")));
    }
    if region.turn_deg != 0.0 {
        facts.push(format!("turned by {} degrees", region.turn_deg));
    }
    if region.hidden {
        facts.push("hidden".to_owned());
    }
    if facts.is_empty() { region.name.clone() } else { format!("{} ({})", region.name, facts.join(", ")) }
}

fn text(value: &serde_json::Value) -> &str {
    value.as_str().unwrap_or_default()
}

fn facts(painting: &Painting) -> serde_json::Value {
    let loaded = painting.loaded();
    let scene = &loaded.scene;
    // A mesh in memory that several nodes share is listed once.
    let mut same: HashMap<*const MeshFile, Vec<&String>> = HashMap::new();
    for (path, file) in &loaded.meshes {
        same.entry(Arc::as_ptr(file)).or_default().push(path);
    }
    let meshes: Vec<serde_json::Value> = loaded
        .meshes
        .iter()
        .map(|(path, file)| (path, file, &same[&Arc::as_ptr(file)]))
        .filter(|(path, _, same)| same[0] == *path)
        .map(|(path, file, same)| {
            let (low, high) = file.mesh.bounds().unwrap_or_default();
            let used: BTreeSet<u32> = file.mesh.material_of_triangle.iter().copied().collect();
            serde_json::json!({
                "path": path,
                "also": &same[1..],
                "polygons": file.mesh.polygon_count(),
                "triangles": file.mesh.triangles.len(),
                "vertices": file.mesh.positions.len(),
                "has_uv": !file.mesh.uvs.is_empty(),
                "groups": file.groups,
                "materials": used.iter().map(|&material| &file.materials[material as usize].name).collect::<Vec<_>>(),
                "bounds": [low.to_array(), high.to_array()],
            })
        })
        .collect();
    let counts = painting.particle_counts();
    let objects: Vec<serde_json::Value> = scene
        .objects
        .iter()
        .enumerate()
        .map(|(index, object)| {
            serde_json::json!({
                "name": object.name,
                "mesh": object.mesh,
                "particles": counts[index],
                "area": painting.surface_area(index),
                "hidden": object.hidden,
                // Points where a combed field of directions whirls or forks.
                "singularities": painting
                    .singularities(index)
                    .iter()
                    .map(|point| {
                        let position = point.position.to_array().map(|at| (at * 1e4).round() / 1e4);
                        serde_json::json!({ "position": position, "index": point.index })
                    })
                    .collect::<Vec<_>>(),
            })
        })
        .collect();
    serde_json::json!({
        "version": 1,
        "path": loaded.path,
        "size": [scene.size.0, scene.size.1],
        "timeline": { "fps": scene.timeline.fps, "first": scene.timeline.first, "last": scene.timeline.last },
        "shot": scene.stage.shot.as_ref().map(|shot| {
            serde_json::json!({ "path": scene.shot, "has_camera": shot.has_camera(), "span_s": shot.span_s() })
        }),
        "meshes": meshes,
        "objects": objects,
        "regions": scene.regions.iter().map(|region| &region.name).collect::<Vec<_>>(),
        "lights": scene.lights.len(),
        "particles": counts.iter().sum::<usize>(),
        "particle_bytes": painting.particle_bytes(),
    })
}
