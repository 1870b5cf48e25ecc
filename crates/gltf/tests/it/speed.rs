//! Time and memory of large files. By hand, in release: `cargo test --release -- --ignored --nocapture large`.

use std::time::Instant;

use serde_json::json;

use crate::build::{Buffer, read_alone};
use impasto_gltf::{Animator, Playing, Posed};

/// A million triangles with positions, normals and texture coordinates, and four pictures of 14 MB: 100 MB.
fn large_glb() -> Vec<u8> {
    let side = 708_u32;
    let mut buffer = Buffer::default();
    let (mut positions, mut normals, mut uvs, mut indices) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for row in 0..=side {
        for column in 0..=side {
            let (x, y) = (column as f32 / side as f32, row as f32 / side as f32);
            positions.extend([x, y, (9.0 * x).sin() * 0.1]);
            normals.extend([0.0, 0.0, 1.0]);
            uvs.extend([x, 1.0 - y]);
            if row < side && column < side {
                let corner = row * (side + 1) + column;
                let above = corner + side + 1;
                indices.extend([corner, corner + 1, above, above, corner + 1, above + 1]);
            }
        }
    }
    let count = indices.len();
    let bytes: Vec<u8> = indices.iter().flat_map(|index: &u32| index.to_le_bytes()).collect();
    let view = buffer.view(&bytes);
    let indices = buffer
        .accessor(json!({ "bufferView": view, "componentType": 5125, "count": count, "type": "SCALAR" }));
    let positions = buffer.floats("VEC3", &positions);
    let normals = buffer.floats("VEC3", &normals);
    let uvs = buffer.floats("VEC2", &uvs);
    let mut picture = vec![7_u8; 18_000_000];
    picture[..8].copy_from_slice(b"\x89PNG\r\n\x1a\n");
    let pictures: Vec<usize> = (0..4).map(|_| buffer.view(&picture)).collect();
    let images: Vec<_> =
        pictures.iter().map(|&view| json!({ "bufferView": view, "mimeType": "image/png" })).collect();
    let mut document = json!({
        "scene": 0, "scenes": [{ "nodes": [0] }], "nodes": [{ "mesh": 0 }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": positions, "NORMAL": normals, "TEXCOORD_0": uvs },
            "indices": indices }] }],
        "images": images,
    });
    document["asset"] = json!({ "version": "2.0" });
    buffer.glb(document)
}

/// A number of kB from what the system tells of this process.
fn status_kb(name: &str) -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").expect("this is Linux");
    let line = status.lines().find(|line| line.starts_with(name)).expect("it is told");
    line.split_whitespace().nth(1).and_then(|number| number.parse().ok()).expect("a number")
}

/// Alone in its process, because it tells the highest memory of the process: writes the file first, reads it when
/// asked a second time.
#[test]
#[ignore = "100 MB"]
fn large_file() {
    let path = std::env::temp_dir().join("impasto_large.glb");
    if !path.exists() {
        std::fs::write(&path, large_glb()).expect("there is space");
        eprintln!("written: run again");
        return;
    }
    let before = status_kb("VmHWM");
    let start = Instant::now();
    let bytes = std::fs::read(&path).expect("it was written");
    let len = bytes.len();
    let opened = start.elapsed();
    let (gltf, _) = read_alone(bytes).expect("it is good");
    let read = start.elapsed();
    let after = status_kb("VmHWM");
    let triangles = gltf.meshes[0].primitives[0].triangles.len();
    eprintln!("{} MB, {triangles} triangles: opened in {opened:?}, read in {read:?}", len / 1_000_000);
    eprintln!("highest memory {} MB, before {} MB", after / 1000, before / 1000);
    std::fs::remove_file(path).expect("it is there");
}

#[test]
#[ignore = "a time, in release only"]
fn large_motion() {
    for has_own_times in [false, true] {
        let mut buffer = Buffer::default();
        let frames = 10_000_u16;
        let times: Vec<f32> = (0..frames).map(|frame| f32::from(frame) / 24.0).collect();
        let shared = buffer.floats("SCALAR", &times);
        let (mut samplers, mut channels, mut nodes) = (Vec::new(), Vec::new(), Vec::new());
        for node in 0..200_u16 {
            nodes.push(if node % 10 == 9 { json!({}) } else { json!({ "children": [node + 1] }) });
            for (path, kind) in [("translation", "VEC3"), ("rotation", "VEC4"), ("scale", "VEC3")] {
                let input = if has_own_times { buffer.floats("SCALAR", &times) } else { shared };
                let value = |frame: u16| {
                    let angle = (f32::from(frame) * 0.01 + f32::from(node)).sin();
                    if kind == "VEC4" {
                        vec![angle.sin(), 0.0, 0.0, angle.cos()]
                    } else {
                        vec![angle, 1.0, 2.0]
                    }
                };
                let values: Vec<f32> = (0..frames).flat_map(value).collect();
                let output = buffer.floats(kind, &values);
                channels.push(json!({ "sampler": samplers.len(), "target": { "node": node, "path": path } }));
                samplers.push(json!({ "input": input, "output": output }));
            }
        }
        let document =
            json!({ "nodes": nodes, "animations": [{ "samplers": samplers, "channels": channels }] });
        let glb = buffer.glb(document);
        let (gltf, _) = read_alone(glb).expect("it is good");
        let (animator, _) = Animator::new(&gltf, Playing::All).expect("all may play");
        let mut posed = Posed::default();
        let mut sum = 0.0;
        let times = 5000;
        for (order, stride) in [("in order", 1), ("at random", 7919)] {
            let start = Instant::now();
            for index in 0..times {
                animator.pose_into(f64::from(index * stride % 9999) / 24.0 + 0.01, &mut posed);
                sum += posed.world_from_node[199].translation.x;
            }
            let each = start.elapsed() / times;
            eprintln!("times of their own: {has_own_times}, frames {order}: {each:?} a pose ({sum:.1})");
        }
    }
}
