//! Small glTF shots, written by code.

use std::path::Path;

use impasto_core::TriangleMesh;
use serde_json::{Value, json};

/// A node of a shot that shows a mesh.
pub struct Node<'a> {
    /// Its name.
    pub name: &'a str,
    /// What it shows.
    pub mesh: &'a TriangleMesh,
    /// Where it stands, through the whole shot.
    pub translation: [f32; 3],
    /// Turn about Y at the end of the shot, degrees; 0 at its beginning.
    pub turn_deg: f32,
}

/// Writes a shot of two seconds: these nodes, a camera at (0, 0, 6) that looks down −Z, and a sun. Nodes with the same
/// mesh share it. Keys are linear.
pub fn write(path: &Path, nodes: &[Node<'_>]) {
    let mut bin = Vec::new();
    let (mut views, mut accessors) = (Vec::new(), Vec::new());
    let mut add = |numbers: &[f32], kind: &str, width: usize| {
        let offset = bin.len();
        bin.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
        views.push(json!({ "buffer": 0, "byteOffset": offset, "byteLength": numbers.len() * 4 }));
        let bounds = |pick: fn(f32, f32) -> f32, from: f32| -> Vec<f32> {
            let of = |axis: usize| numbers.iter().skip(axis).step_by(width).fold(from, |a, &b| pick(a, b));
            (0..width).map(of).collect()
        };
        accessors.push(json!({
            "bufferView": views.len() - 1, "componentType": 5126, "count": numbers.len() / width, "type": kind,
            "min": bounds(f32::min, f32::INFINITY), "max": bounds(f32::max, f32::NEG_INFINITY),
        }));
        accessors.len() - 1
    };
    let (mut meshes, mut list, mut channels, mut samplers) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    let times = add(&[0.0, 2.0], "SCALAR", 1);
    let (mut indices, mut mesh_of_node) = (Vec::new(), Vec::new());
    for (index, node) in nodes.iter().enumerate() {
        let known = nodes[..index].iter().position(|other| std::ptr::eq(other.mesh, node.mesh));
        mesh_of_node.push(match known {
            Some(other) => mesh_of_node[other],
            None => {
                let flat =
                    |list: &[glam::Vec3]| list.iter().flat_map(|at| at.to_array()).collect::<Vec<f32>>();
                let position = add(&flat(&node.mesh.positions), "VEC3", 3);
                let normal = add(&flat(&node.mesh.normals), "VEC3", 3);
                indices.push(node.mesh.triangles.iter().flatten().copied().collect::<Vec<u32>>());
                let attributes = json!({ "POSITION": position, "NORMAL": normal });
                meshes.push(json!({ "primitives": [{ "attributes": attributes }] }));
                meshes.len() - 1
            }
        });
        list.push(json!({ "name": node.name, "mesh": mesh_of_node[index], "translation": node.translation }));
        let (sin, cos) = (0.5 * node.turn_deg.to_radians()).sin_cos();
        let turn = add(&[0.0, 0.0, 0.0, 1.0, 0.0, sin, 0.0, cos], "VEC4", 4);
        samplers.push(json!({ "input": times, "output": turn }));
        channels.push(json!({ "sampler": index, "target": { "node": index, "path": "rotation" } }));
    }
    for (mesh, corners) in meshes.iter_mut().zip(&indices) {
        let offset = bin.len();
        bin.extend(corners.iter().flat_map(|corner| corner.to_le_bytes()));
        views.push(json!({ "buffer": 0, "byteOffset": offset, "byteLength": corners.len() * 4 }));
        let view = views.len() - 1;
        accessors.push(
            json!({ "bufferView": view, "componentType": 5125, "count": corners.len(), "type": "SCALAR" }),
        );
        mesh["primitives"][0]["indices"] = json!(accessors.len() - 1);
    }
    list.push(json!({ "name": "Cam", "camera": 0, "translation": [0.0, 0.0, 6.0] }));
    list.push(json!({ "name": "Sun", "rotation": [-0.5, 0.0, 0.0, 0.866_025_4],
        "extensions": { "KHR_lights_punctual": { "light": 0 } } }));
    let root = json!({
        "asset": { "version": "2.0" }, "scene": 0,
        "scenes": [{ "nodes": (0..list.len()).collect::<Vec<_>>() }],
        "nodes": list, "meshes": meshes, "accessors": accessors, "bufferViews": views,
        "buffers": [{ "byteLength": bin.len() }],
        "cameras": [{ "type": "perspective",
            "perspective": { "yfov": 0.6, "aspectRatio": 1.777_777_8, "znear": 0.1, "zfar": 100.0 } }],
        "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": { "KHR_lights_punctual": { "lights": [{ "type": "directional", "intensity": 683.0 }] } },
        "animations": [{ "channels": channels, "samplers": samplers }],
    });
    std::fs::write(path, bytes(&root, bin)).expect("written");
}

/// Rewrites a shot: `change` edits its JSON document and its binary buffer.
pub fn edit(path: &Path, change: impl FnOnce(&mut Value, &mut Vec<u8>)) {
    let file = std::fs::read(path).expect("a shot");
    let number = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().expect("four bytes")) as usize;
    let text_end = 20 + number(12);
    let mut root = serde_json::from_slice(&file[20..text_end]).expect("a document");
    let mut bin = file[text_end + 8..].to_vec();
    change(&mut root, &mut bin);
    root["buffers"][0]["byteLength"] = json!(bin.len());
    std::fs::write(path, bytes(&root, bin)).expect("written");
}

/// The bytes of a `.glb` file with this JSON document and binary buffer.
pub fn bytes(root: &Value, mut bin: Vec<u8>) -> Vec<u8> {
    let mut text = root.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    bin.resize(bin.len().next_multiple_of(4), 0);
    let whole = 12 + 8 + text.len() + 8 + bin.len();
    let mut file = b"glTF".to_vec();
    file.extend(2u32.to_le_bytes());
    file.extend((whole as u32).to_le_bytes());
    for (kind, chunk) in [(b"JSON", &text), (b"BIN\0", &bin)] {
        file.extend((chunk.len() as u32).to_le_bytes());
        file.extend(kind);
        file.extend(chunk);
    }
    file
}
