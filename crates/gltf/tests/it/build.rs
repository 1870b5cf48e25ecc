//! Small glTF files made in code, and how tests read them.

use impasto_gltf::{Finding, Gltf, read};
use serde_json::{Value, json};

/// A buffer, its views and its accessors in the making.
#[derive(Default)]
pub struct Buffer {
    pub bytes: Vec<u8>,
    pub views: Vec<Value>,
    pub accessors: Vec<Value>,
}

impl Buffer {
    /// Adds a view and gives its index.
    pub fn view(&mut self, bytes: &[u8]) -> usize {
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.views.push(json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() }));
        self.bytes.extend_from_slice(bytes);
        self.views.len() - 1
    }

    /// Adds an accessor of `f32`s on a view of its own.
    pub fn floats(&mut self, kind: &str, numbers: &[f32]) -> usize {
        let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        let width = width(kind);
        let bound = |pick: fn(f32, f32) -> f32| -> Vec<f32> {
            (0..width)
                .filter_map(|axis| numbers.iter().skip(axis).step_by(width).copied().reduce(pick))
                .collect()
        };
        let view = self.view(&bytes);
        self.accessor(json!({
            "bufferView": view, "componentType": 5126, "count": numbers.len() / width, "type": kind,
            "min": bound(f32::min), "max": bound(f32::max),
        }))
    }

    /// Adds an accessor of `u16`s on a view of its own.
    pub fn shorts(&mut self, numbers: &[u16]) -> usize {
        let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        let view = self.view(&bytes);
        self.accessor(
            json!({ "bufferView": view, "componentType": 5123, "count": numbers.len(), "type": "SCALAR" }),
        )
    }

    /// Adds an accessor that is given as JSON, and gives its index.
    pub fn accessor(&mut self, accessor: Value) -> usize {
        self.accessors.push(accessor);
        self.accessors.len() - 1
    }

    /// Completes `document`: adds the asset, the views, the accessors, and this buffer as a data URI.
    pub fn finish(&self, mut document: Value) -> Value {
        document["asset"] = json!({ "version": "2.0" });
        let uri = format!("data:application/octet-stream;base64,{}", base64(&self.bytes));
        document["buffers"] = json!([{ "byteLength": self.bytes.len(), "uri": uri }]);
        document["bufferViews"] = json!(self.views);
        document["accessors"] = json!(self.accessors);
        document
    }

    /// As [`Buffer::finish`], but as the bytes of a `.glb` that holds the buffer.
    pub fn glb(&self, document: Value) -> Vec<u8> {
        let mut document = self.finish(document);
        document["buffers"] = json!([{ "byteLength": self.bytes.len() }]);
        let mut text = document.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let mut bin = self.bytes.clone();
        bin.resize(bin.len().next_multiple_of(4), 0);
        let mut glb = b"glTF".to_vec();
        let word = |glb: &mut Vec<u8>, number: usize| glb.extend((number as u32).to_le_bytes());
        word(&mut glb, 2);
        word(&mut glb, 12 + 8 + text.len() + 8 + bin.len());
        word(&mut glb, text.len());
        glb.extend(b"JSON");
        glb.extend(&text);
        word(&mut glb, bin.len());
        glb.extend(b"BIN\0");
        glb.extend(&bin);
        glb
    }
}

pub fn width(kind: &str) -> usize {
    match kind {
        "SCALAR" => 1,
        "VEC2" => 2,
        "VEC3" => 3,
        "VEC4" => 4,
        "MAT4" => 16,
        _ => panic!("{kind}"),
    }
}

pub fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = String::new();
    for three in bytes.chunks(3) {
        let word =
            three.iter().fold(0_u32, |word, &byte| word << 8 | u32::from(byte)) << (8 * (3 - three.len()));
        for digit in 0..4 {
            let letter = DIGITS[(word >> (18 - 6 * digit)) as usize & 63] as char;
            text.push(if digit <= three.len() { letter } else { '=' });
        }
    }
    text
}

/// Reads a document that needs no other file.
pub fn read_alone(bytes: Vec<u8>) -> Result<(Gltf, Vec<Finding>), Vec<Finding>> {
    read(bytes, &mut |_, _| Err("there is no such file".to_owned()))
}

/// Reads a document that has to be right.
pub fn good(document: &Value) -> (Gltf, Vec<Finding>) {
    match read_alone(document.to_string().into_bytes()) {
        Ok(read) => read,
        Err(findings) => panic!("{}", lines(&findings)),
    }
}

pub fn lines(findings: &[Finding]) -> String {
    findings.iter().map(|finding| format!("{finding}\n")).collect()
}

/// A document with something of everything: mesh, indices, morph target, skin, instances, texture, material, cameras,
/// lights, variants, animations with pointers.
pub fn rich() -> (Buffer, Value) {
    let mut buffer = Buffer::default();
    let positions = buffer.floats("VEC3", &[0., 0., 0., 1., 0., 0., 0., 1., 0., 1., 1., 0.]);
    let normals = buffer.floats("VEC3", &[0., 0., 1., 0., 0., 1., 0., 0., 1., 0., 0., 1.]);
    let uvs = buffer.floats("VEC2", &[0., 0., 1., 0., 0., 1., 1., 1.]);
    let indices = buffer.shorts(&[0, 1, 2, 2, 1, 3]);
    let deltas = buffer.floats("VEC3", &[0., 0., 1., 0., 0., 0., 0., 0., 0., 0., 0., 0.]);
    let joints_view = buffer.view(&[0, 1, 0, 0].repeat(4));
    let joints = buffer
        .accessor(json!({ "bufferView": joints_view, "componentType": 5121, "count": 4, "type": "VEC4" }));
    let weights = buffer.floats("VEC4", &[0.5, 0.5, 0., 0.].repeat(4));
    let colors_view = buffer.view(&[255, 128, 0, 255].repeat(4));
    let colors = buffer.accessor(
        json!({ "bufferView": colors_view, "componentType": 5121, "normalized": true, "count": 4, "type": "VEC4" }),
    );
    let identity = [1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1.];
    let binds = buffer.floats("MAT4", &identity.repeat(2));
    let times = buffer.floats("SCALAR", &[0., 1., 2.]);
    let moves = buffer.floats("VEC3", &[0., 0., 0., 1., 0., 0., 1., 1., 0.]);
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let turns = buffer.floats("VEC4", &[0., 0., 0., 1., 0., 0., half, half, 0., 0., 1., 0.]);
    let numbers = buffer.floats("SCALAR", &[0.5, 0.7, 0.9]);
    let sparse_indices = buffer.view(&[1, 0, 3, 0]);
    let sparse_values = buffer.view(&[0; 24]);
    let sparse = buffer.accessor(json!({
        "componentType": 5126, "count": 4, "type": "VEC3",
        "sparse": { "count": 2, "indices": { "bufferView": sparse_indices, "componentType": 5123 },
                    "values": { "bufferView": sparse_values } },
    }));
    let spots = buffer.floats("VEC3", &[0., 0., 0., 5., 0., 0.]);
    let picture = buffer.view(b"\x89PNG\r\n\x1a\n....IEND\xAE\x42\x60\x82");
    let document = json!({
        "extensionsUsed": ["KHR_lights_punctual", "KHR_materials_variants", "KHR_animation_pointer",
            "KHR_texture_transform", "KHR_node_visibility", "EXT_mesh_gpu_instancing",
            "KHR_materials_emissive_strength", "KHR_materials_unlit"],
        "extensionsRequired": ["KHR_lights_punctual"],
        "extensions": {
            "KHR_lights_punctual": { "lights": [
                { "type": "spot", "intensity": 100.0, "range": 10.0, "color": [1.0, 0.5, 0.25],
                  "spot": { "innerConeAngle": 0.1, "outerConeAngle": 0.5 } },
                { "type": "directional" }] },
            "KHR_materials_variants": { "variants": [{ "name": "day" }] },
        },
        "scene": 0,
        "scenes": [{ "nodes": [0, 3] }],
        "nodes": [
            { "name": "Root", "children": [1, 2], "translation": [1.0, 2.0, 3.0] },
            { "name": "Thing", "mesh": 0, "skin": 0, "weights": [0.25], "rotation": [0.0, 0.0, 0.0, 1.0], "scale": [1.0, 1.0, 1.0] },
            { "name": "Eye", "camera": 0, "children": [4],
              "matrix": [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 5.0, 1.0] },
            { "name": "Lamp", "extensions": { "KHR_lights_punctual": { "light": 0 },
                "KHR_node_visibility": { "visible": true } } },
            { "name": "Copies", "mesh": 0, "camera": 1,
              "extensions": { "EXT_mesh_gpu_instancing": { "attributes": { "TRANSLATION": spots } } } }],
        "meshes": [{ "name": "Quad", "weights": [0.5], "extras": { "targetNames": ["bulge"] }, "primitives": [{
            "attributes": { "POSITION": positions, "NORMAL": normals, "TEXCOORD_0": uvs, "COLOR_0": colors,
                            "JOINTS_0": joints, "WEIGHTS_0": weights },
            "indices": indices, "material": 0, "mode": 4,
            "targets": [{ "POSITION": deltas, "NORMAL": sparse }],
            "extensions": { "KHR_materials_variants": { "mappings": [{ "material": 1, "variants": [0] }] } } }] }],
        "materials": [
            { "name": "Plain", "pbrMetallicRoughness": { "baseColorFactor": [1.0, 0.5, 0.25, 1.0], "metallicFactor": 0.0,
                "roughnessFactor": 0.5, "baseColorTexture": { "index": 0, "texCoord": 0, "extensions": {
                    "KHR_texture_transform": { "offset": [0.5, 0.0], "rotation": 1.0, "scale": [2.0, 2.0] } } } },
              "alphaMode": "MASK", "alphaCutoff": 0.25, "doubleSided": true },
            { "name": "Glow", "emissiveFactor": [1.0, 0.5, 0.0],
              "extensions": { "KHR_materials_emissive_strength": { "emissiveStrength": 3.0 }, "KHR_materials_unlit": {} } }],
        "textures": [{ "source": 0, "sampler": 0 }],
        "samplers": [{ "magFilter": 9728, "minFilter": 9987, "wrapS": 33071, "wrapT": 33648 }],
        "images": [{ "bufferView": picture, "mimeType": "image/png" }],
        "cameras": [
            { "type": "perspective", "perspective": { "yfov": 0.6, "aspectRatio": 1.5, "znear": 0.1, "zfar": 100.0 } },
            { "type": "orthographic", "orthographic": { "xmag": 2.0, "ymag": 1.0, "znear": 0.0, "zfar": 10.0 } }],
        "skins": [{ "joints": [0, 2], "inverseBindMatrices": binds, "skeleton": 0 }],
        "animations": [{ "name": "All",
            "samplers": [
                { "input": times, "output": moves, "interpolation": "LINEAR" },
                { "input": times, "output": turns },
                { "input": times, "output": numbers, "interpolation": "STEP" }],
            "channels": [
                { "sampler": 0, "target": { "node": 0, "path": "translation" } },
                { "sampler": 1, "target": { "node": 1, "path": "rotation" } },
                { "sampler": 2, "target": { "node": 1, "path": "weights" } },
                { "sampler": 2, "target": { "path": "pointer", "extensions": {
                    "KHR_animation_pointer": { "pointer": "/cameras/0/perspective/yfov" } } } }] }],
    });
    let document = buffer.finish(document);
    (buffer, document)
}
