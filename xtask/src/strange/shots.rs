//! Strange glTF shots: a small shot whose features are chosen by chance, and whose JSON and numbers are then damaged.

use serde_json::{Value, json};

use super::binaries::float;
use super::chance::Chance;
use super::damage;

const FLOAT: u32 = 5126;

/// The binary data so far, and the views and accessors that read it.
#[derive(Default)]
struct Store {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Store {
    /// Adds numbers and returns their accessor's index.
    fn floats(&mut self, kind: &str, width: usize, numbers: &[f64]) -> usize {
        let bytes: Vec<u8> = numbers.iter().flat_map(|number| (*number as f32).to_le_bytes()).collect();
        let bounds = |pick: fn(f64, f64) -> f64, from: f64| -> Vec<f64> {
            (0..width)
                .map(|axis| numbers.iter().skip(axis).step_by(width).copied().fold(from, pick))
                .collect()
        };
        let least = bounds(f64::min, f64::INFINITY);
        let most = bounds(f64::max, f64::NEG_INFINITY);
        let view = self.view(&bytes);
        self.accessors
            .push(json!({ "bufferView": view, "componentType": FLOAT, "count": numbers.len() / width,
            "type": kind, "min": least, "max": most }));
        self.accessors.len() - 1
    }

    fn shorts(&mut self, kind: &str, width: usize, numbers: &[u16]) -> usize {
        let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        let view = self.view(&bytes);
        self.accessors.push(
            json!({ "bufferView": view, "componentType": 5123, "count": numbers.len() / width, "type": kind }),
        );
        self.accessors.len() - 1
    }

    fn view(&mut self, bytes: &[u8]) -> usize {
        let offset = self.bytes.len();
        self.bytes.extend(bytes);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.views.push(json!({ "buffer": 0, "byteOffset": offset, "byteLength": bytes.len() }));
        self.views.len() - 1
    }
}

/// A shot as one binary file.
pub fn glb(chance: &mut Chance) -> Vec<u8> {
    let (mut root, bytes) = shot(chance);
    if chance.may_be_odd() {
        damage::json(chance, &mut root);
    }
    whole(chance, &root, &bytes)
}

/// Puts JSON and numbers into a GLB file; its lengths may lie.
pub fn whole(chance: &mut Chance, root: &Value, bytes: &[u8]) -> Vec<u8> {
    let mut text = root.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut bytes = bytes.to_vec();
    bytes.resize(bytes.len().next_multiple_of(4), 0);
    let mut length = |true_length: usize| -> [u8; 4] {
        if !chance.is_odd() {
            return (true_length as u32).to_le_bytes();
        }
        chance.of(&[0u32, 1, 12, 0x7fff_ffff, 0xffff_fffc]).to_le_bytes()
    };
    let mut file = b"glTF\x02\0\0\0".to_vec();
    file.extend(length(28 + text.len() + bytes.len()));
    file.extend(length(text.len()));
    file.extend(b"JSON");
    file.extend(text);
    file.extend(length(bytes.len()));
    file.extend(b"BIN\0");
    file.extend(bytes);
    file
}

/// A shot: a few bodies with skins, shape keys and keys of motion, cameras and lights.
fn shot(chance: &mut Chance) -> (Value, Vec<u8>) {
    let mut store = Store::default();
    let meshes: Vec<Value> = (0..chance.count(4)).map(|_| mesh(chance, &mut store)).collect();
    let count = chance.count(12).max(3);
    let mut nodes: Vec<Value> = (0..count).map(|index| node(chance, index, meshes.len())).collect();
    // Later nodes hang below earlier ones.
    let mut roots = vec![0];
    for index in 1..count {
        let parent = chance.below(index);
        match nodes[parent].get_mut("children").and_then(Value::as_array_mut) {
            Some(children) if chance.happens(0.5) => children.push(json!(index)),
            _ => roots.push(index),
        }
    }
    nodes.iter_mut().for_each(without_an_empty_list);
    nodes[0]["camera"] = json!(0);
    // Meshes name the joints 0, 1 and 2.
    let joints: Vec<usize> = (0..count).filter(|&index| index < 3 || chance.happens(0.3)).collect();
    let identity = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0];
    let mut root = json!({
        "asset": { "version": "2.0" },
        "scene": 0,
        "scenes": [{ "nodes": roots }],
        "meshes": meshes,
        "cameras": [camera(chance)],
        "materials": materials(chance),
        "extensions": { "KHR_lights_punctual": { "lights": [
            { "type": "directional", "intensity": float(chance, 3.0) },
            { "type": "point", "color": [1.0, float(chance, 0.7), 0.4], "intensity": float(chance, 100.0) },
            { "type": "spot", "intensity": 50.0, "spot": { "outerConeAngle": float(chance, 0.6) } },
        ] } },
        "extensionsUsed": ["KHR_lights_punctual"],
    });
    if chance.happens(0.5) {
        let numbers: Vec<f64> =
            joints.iter().flat_map(|_| identity).map(|number| float(chance, number)).collect();
        let binds = store.floats("MAT4", 16, &numbers);
        root["skins"] = json!([{ "joints": joints, "inverseBindMatrices": binds }]);
        let skinned: Vec<usize> = (0..count).filter(|&index| nodes[index].get("mesh").is_some()).collect();
        for index in skinned {
            if chance.happens(0.4) {
                nodes[index]["skin"] = json!(0);
            }
        }
    }
    root["animations"] =
        Value::Array((0..chance.below(3)).map(|_| animation(chance, &mut store, count)).collect());
    without_an_empty_list(&mut root);
    root["nodes"] = Value::Array(nodes);
    root["accessors"] = json!(store.accessors);
    root["bufferViews"] = json!(store.views);
    root["buffers"] = json!([{ "byteLength": store.bytes.len() }]);
    (root, store.bytes)
}

/// glTF allows no empty lists.
fn without_an_empty_list(value: &mut Value) {
    if let Value::Object(map) = value {
        map.retain(|_, inner| inner.as_array().is_none_or(|list| !list.is_empty()));
    }
}

fn camera(chance: &mut Chance) -> Value {
    if chance.happens(0.3) {
        return json!({ "type": "orthographic", "orthographic": { "xmag": float(chance, 3.0), "ymag": float(chance, 3.0),
            "znear": float(chance, 0.1), "zfar": float(chance, 100.0) } });
    }
    json!({ "type": "perspective", "perspective": { "yfov": float(chance, 0.7), "znear": float(chance, 0.1),
        "zfar": float(chance, 100.0), "aspectRatio": float(chance, 1.5) } })
}

fn materials(chance: &mut Chance) -> Value {
    (0..3)
        .map(|index| {
            let color = [0.9, 0.4, 0.2, 0.7].map(|part| float(chance, part));
            json!({ "name": chance.name(&["red", "skin", "wood"]), "doubleSided": index == 1,
                "alphaMode": chance.of(&["OPAQUE", "MASK", "BLEND"]),
                "pbrMetallicRoughness": { "baseColorFactor": color, "roughnessFactor": float(chance, 0.5) } })
        })
        .collect()
}

fn node(chance: &mut Chance, index: usize, meshes: usize) -> Value {
    let numbers = |chance: &mut Chance, usual: [f64; 3]| usual.map(|number| float(chance, number));
    let (x, y) = (chance.between(-1.0, 1.0), chance.between(-1.0, 1.0));
    let mut node = json!({ "name": chance.name(&["ball", "arm", "lamp", "floor"]), "children": [] });
    if index == 0 {
        node["translation"] = json!(numbers(chance, [0.0, 0.0, 5.0]));
        return node;
    }
    node["translation"] = json!(numbers(chance, [x, y, 0.0]));
    node["rotation"] = json!([0.0, float(chance, 0.6), 0.0, float(chance, 0.8)]);
    node["scale"] = json!(numbers(chance, [1.0, 1.0 + 0.3 * x, 1.0]));
    match chance.below(4) {
        0 => node["extensions"] = json!({ "KHR_lights_punctual": { "light": chance.below(3) } }),
        _ => node["mesh"] = json!(chance.below(meshes)),
    }
    node
}

/// Triangles from a rim to a middle point, with joint weights and a shape key.
fn mesh(chance: &mut Chance, store: &mut Store) -> Value {
    let rim = chance.count(200).max(3);
    let mut places = vec![[0.0, 0.0, 0.4]];
    places.extend((0..rim).map(|at| {
        let turn = std::f64::consts::TAU * at as f64 / rim as f64;
        [turn.cos(), turn.sin(), 0.0]
    }));
    let numbers: Vec<f64> = places.iter().flatten().map(|&number| float(chance, number)).collect();
    let mut attributes = json!({ "POSITION": store.floats("VEC3", 3, &numbers) });
    if chance.happens(0.5) {
        let normals: Vec<f64> =
            places.iter().flat_map(|_| [0.0, 0.0, 1.0]).map(|number| float(chance, number)).collect();
        attributes["NORMAL"] = json!(store.floats("VEC3", 3, &normals));
    }
    if chance.happens(0.5) {
        let joints: Vec<u16> = (0..4 * places.len()).map(|_| chance.below(3) as u16).collect();
        let weights: Vec<f64> =
            places.iter().flat_map(|_| [0.5, 0.5, 0.0, 0.0]).map(|number| float(chance, number)).collect();
        attributes["JOINTS_0"] = json!(store.shorts("VEC4", 4, &joints));
        attributes["WEIGHTS_0"] = json!(store.floats("VEC4", 4, &weights));
    }
    if chance.happens(0.3) {
        let uvs: Vec<f64> =
            places.iter().flat_map(|at| [at[0], at[1]]).map(|number| float(chance, number)).collect();
        attributes["TEXCOORD_0"] = json!(store.floats("VEC2", 2, &uvs));
    }
    let corners: Vec<u16> = (0..rim as u16).flat_map(|at| [0, at + 1, (at + 1) % rim as u16 + 1]).collect();
    let mut primitive = json!({ "attributes": attributes, "indices": store.shorts("SCALAR", 1, &corners),
        "material": chance.below(3), "mode": if chance.is_odd() { chance.below(8) } else { 4 } });
    if chance.happens(0.3) {
        let moved: Vec<f64> = numbers.iter().map(|number| number * 0.3).collect();
        primitive["targets"] = json!([{ "POSITION": store.floats("VEC3", 3, &moved) }]);
    }
    json!({ "name": chance.name(&["ring", "leaf"]), "primitives": [primitive] })
}

fn animation(chance: &mut Chance, store: &mut Store, nodes: usize) -> Value {
    let keys = chance.count(30);
    let times: Vec<f64> = (0..keys).map(|key| float(chance, key as f64 / 24.0)).collect();
    let times = store.floats("SCALAR", 1, &times);
    let (mut samplers, mut channels) = (Vec::new(), Vec::new());
    for _ in 0..chance.count(6) {
        let (path, kind, usual): (&str, &str, &[f64]) = *chance.of(&[
            &("translation", "VEC3", &[0.1, 0.2, 0.3][..]),
            &("rotation", "VEC4", &[0.0, 0.6, 0.0, 0.8][..]),
            &("scale", "VEC3", &[1.0, 1.1, 0.9][..]),
            &("weights", "SCALAR", &[0.5][..]),
        ]);
        let way = chance.of(&["LINEAR", "STEP", "CUBICSPLINE"]);
        let repeated = keys * if way == "CUBICSPLINE" { 3 } else { 1 };
        let values: Vec<f64> = (0..repeated)
            .flat_map(|_| usual.iter().map(|&number| float(chance, number)).collect::<Vec<f64>>())
            .collect();
        let output = store.floats(kind, usual.len(), &values);
        channels.push(
            json!({ "sampler": samplers.len(), "target": { "node": chance.below(nodes), "path": path } }),
        );
        samplers.push(json!({ "input": times, "output": output, "interpolation": way }));
    }
    json!({ "name": chance.name(&["walk", "run"]), "samplers": samplers, "channels": channels })
}

/// A sidecar: cuts, shifts, caches and more, by the names of the shot's nodes.
pub fn sidecar(chance: &mut Chance) -> Vec<u8> {
    let mut root = json!({
        "version": 1, "fps": float(chance, 24.0), "frames": [0, chance.count(100)],
        "cuts": [{ "frame": 1, "camera": chance.name(&["ball", "arm"]) }],
        "shifts": { chance.name(&["ball"]): { "first": 1, "ndc": [[float(chance, 0.1), 0.0], [0.2, 0.1]] } },
        "caches": { chance.name(&["ball", "floor"]): chance.name(&["c.pc2"]) },
        "collections": { chance.name(&["all"]): [chance.name(&["ball"]), chance.name(&["arm"])] },
        "world": [float(chance, 0.2), 0.2, 0.3], "exposure_stops": float(chance, 0.5),
    });
    if chance.may_be_odd() {
        damage::json(chance, &mut root);
    }
    root.to_string().into_bytes()
}
