//! Writes a shot as a glTF 2.0 file in one piece (`.glb`): meshes, materials, lights, a camera and keys.

use anyhow::{Context as _, ensure};
use glam::{DQuat, DVec2, DVec3};
use serde_json::{Value, json};

use crate::poly_mesh::PolyMesh;

mod soft;

pub use soft::{Bend, Influence, Target};

/// A shot that is being put together.
#[derive(Default)]
pub struct Glb {
    bin: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    meshes: Vec<Value>,
    materials: Vec<Value>,
    textures: Vec<Value>,
    images: Vec<Value>,
    lights: Vec<Value>,
    nodes: Vec<Value>,
    /// The nodes that have no parent.
    roots: Vec<usize>,
    skins: Vec<Value>,
    channels: Vec<Value>,
    samplers: Vec<Value>,
}

/// Something that stands in the shot.
pub struct Node<'a> {
    /// Its name.
    pub name: &'a str,
    /// What it is: a member of the node such as `"mesh"`, and that member's value.
    pub is: (&'static str, Value),
    /// Where it stands.
    pub place: DVec3,
    /// How it is turned.
    pub turn: DQuat,
}

/// How a mesh is coloured.
pub enum Coat<'a> {
    /// The materials of its palette.
    Palette,
    /// One material, and a texture coordinate (V down) for each point.
    Texture(usize, &'a [DVec2]),
    /// A colour for each point, linear 0..=1.
    Colors(&'a [DVec3]),
    /// The materials of its palette, each multiplied by a colour for each point.
    Tinted(&'a [DVec3]),
}

impl Glb {
    /// Adds a material with this linear base colour, 0..=1. The texture with the index `texture`, as [`Glb::texture`]
    /// returned it, multiplies that colour. Returns the material's index.
    pub fn material(&mut self, name: &str, color: [f64; 3], texture: Option<usize>, roughness: f64) -> usize {
        let [red, green, blue] = color;
        let mut pbr = json!({
            "baseColorFactor": [red, green, blue, 1.0], "metallicFactor": 0.0, "roughnessFactor": roughness,
        });
        if let Some(texture) = texture {
            pbr["baseColorTexture"] = json!({ "index": texture });
        }
        self.materials.push(json!({ "name": name, "pbrMetallicRoughness": pbr }));
        self.materials.len() - 1
    }

    /// Adds a repeating texture of `size_px` RGB pixels, top row first. Returns its index.
    ///
    /// # Errors
    /// There are not as many pixels as the size says.
    pub fn texture(&mut self, name: &str, size_px: [u32; 2], rgb8: &[u8]) -> anyhow::Result<usize> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, size_px[0], size_px[1]);
        encoder.set_color(png::ColorType::Rgb);
        encoder.write_header()?.write_image_data(rgb8).context("a texture")?;
        let view = self.view(&bytes);
        self.images.push(json!({ "name": name, "bufferView": view, "mimeType": "image/png" }));
        self.textures.push(json!({ "source": self.images.len() - 1 }));
        Ok(self.textures.len() - 1)
    }

    /// Adds a mesh; its polygons are cut into fans. Returns its index.
    ///
    /// # Errors
    /// It has more points than 16 bits can count, or a colour of its palette cannot be read.
    pub fn mesh(&mut self, mesh: &PolyMesh, coat: &Coat<'_>) -> anyhow::Result<usize> {
        let attributes = json!({ "POSITION": self.positions(mesh)? });
        let primitives = self.primitives(mesh, coat, attributes)?;
        self.meshes.push(json!({ "name": mesh.name, "primitives": primitives }));
        Ok(self.meshes.len() - 1)
    }

    /// Adds the points of a mesh. Returns the index of their accessor.
    fn positions(&mut self, mesh: &PolyMesh) -> anyhow::Result<usize> {
        ensure!(mesh.positions.len() < 65_536, "{}: too many points", mesh.name);
        Ok(self.vectors(&mesh.positions))
    }

    /// Adds the materials and faces of a mesh and the attributes of its coat. Returns one primitive for each material
    /// that has faces; all have the given `attributes` and those of the coat.
    fn primitives(
        &mut self,
        mesh: &PolyMesh,
        coat: &Coat<'_>,
        mut attributes: Value,
    ) -> anyhow::Result<Vec<Value>> {
        if let Coat::Tinted(colors) = *coat {
            attributes["COLOR_0"] = json!(self.tints(colors));
        }
        let mut primitives = Vec::new();
        match *coat {
            Coat::Palette | Coat::Tinted(_) => {
                for (name, hex) in mesh.palette {
                    let faces = mesh.faces.iter().filter(|face| face.look.material == *name);
                    let indices = self.indices(faces.map(|face| face.corners.as_slice()));
                    let material = self.material(name, linear(hex)?, None, 0.9);
                    primitives.extend(indices.map(|indices| (indices, material)));
                }
            }
            Coat::Texture(material, uvs) => {
                let uvs: Vec<[f64; 2]> = uvs.iter().map(DVec2::to_array).collect();
                attributes["TEXCOORD_0"] = json!(self.floats(uvs.as_flattened(), "VEC2"));
                let indices = self.indices(mesh.faces.iter().map(|face| face.corners.as_slice()));
                primitives.extend(indices.map(|indices| (indices, material)));
            }
            Coat::Colors(colors) => {
                attributes["COLOR_0"] = json!(self.vectors(colors));
                let indices = self.indices(mesh.faces.iter().map(|face| face.corners.as_slice()));
                let material = self.material(mesh.name, [1.0; 3], None, 0.5);
                primitives.extend(indices.map(|indices| (indices, material)));
            }
        }
        let primitive = |(indices, material)| json!({ "attributes": attributes, "indices": indices, "material": material });
        Ok(primitives.into_iter().map(primitive).collect())
    }

    /// Adds a light, as KHR_lights_punctual states it. Returns its index.
    pub fn light(&mut self, light: Value) -> usize {
        self.lights.push(light);
        self.lights.len() - 1
    }

    /// Adds a node. Returns its index.
    pub fn node(&mut self, node: Node<'_>) -> usize {
        let (member, value) = node.is;
        self.nodes.push(json!({
            "name": node.name, "translation": node.place.to_array(), "rotation": node.turn.to_array(), member: value,
        }));
        self.roots.push(self.nodes.len() - 1);
        self.nodes.len() - 1
    }

    /// Gives a node keys of place and turn, each with its time in seconds; linear between.
    pub fn keys(&mut self, node: usize, keys: &[(f64, DVec3, DQuat)]) {
        let times: Vec<f64> = keys.iter().map(|(time_s, ..)| *time_s).collect();
        let places: Vec<DVec3> = keys.iter().map(|(_, place, _)| *place).collect();
        let turns: Vec<[f64; 4]> = keys.iter().map(|(.., turn)| turn.to_array()).collect();
        let input = self.floats(&times, "SCALAR");
        for (path, output) in
            [("translation", self.vectors(&places)), ("rotation", self.floats(turns.as_flattened(), "VEC4"))]
        {
            self.channel(node, path, [input, output]);
        }
    }

    /// Adds an animation channel: the node's property `path` (such as `rotation`) follows an accessor of times and one
    /// of values.
    fn channel(&mut self, node: usize, path: &str, [input, output]: [usize; 2]) {
        let sampler = self.samplers.len();
        self.samplers.push(json!({ "input": input, "output": output }));
        self.channels.push(json!({ "sampler": sampler, "target": { "node": node, "path": path } }));
    }

    /// The bytes of the file. Its one camera has this vertical field of view and an aspect ratio of 16 by 9. The node
    /// that stands for the camera has `("camera", 0)` in [`Node::is`].
    pub fn finish(self, fov_y_rad: f64) -> Vec<u8> {
        let mut root = json!({
            "asset": { "version": "2.0", "generator": "cargo xtask meshes" },
            "scene": 0,
            "scenes": [{ "nodes": self.roots }],
            "nodes": self.nodes,
            "meshes": self.meshes,
            "materials": self.materials,
            "cameras": [{ "type": "perspective",
                "perspective": { "yfov": fov_y_rad, "aspectRatio": 16.0 / 9.0, "znear": 0.05, "zfar": 60.0 } }],
            "animations": [{ "name": "Shot", "channels": self.channels, "samplers": self.samplers }],
            "extensionsUsed": ["KHR_lights_punctual"],
            "extensions": { "KHR_lights_punctual": { "lights": self.lights } },
            "accessors": self.accessors,
            "bufferViews": self.views,
            "buffers": [{ "byteLength": self.bin.len() }],
        });
        // An empty list is against the rules of glTF.
        for (name, list) in [("textures", self.textures), ("images", self.images)] {
            if !list.is_empty() {
                root[name] = list.into();
            }
        }
        if !self.skins.is_empty() {
            root["skins"] = json!(self.skins);
        }
        let mut text = root.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let whole = 12 + 8 + text.len() + 8 + self.bin.len();
        let mut file = b"glTF".to_vec();
        let number = |file: &mut Vec<u8>, number: usize| file.extend((number as u32).to_le_bytes());
        number(&mut file, 2);
        number(&mut file, whole);
        for (kind, chunk) in [(b"JSON", text), (b"BIN\0", self.bin)] {
            number(&mut file, chunk.len());
            file.extend(kind);
            file.extend(chunk);
        }
        file
    }

    /// Adds bytes, padded to a multiple of four. Returns the index of their view.
    fn view(&mut self, bytes: &[u8]) -> usize {
        self.views.push(json!({ "buffer": 0, "byteOffset": self.bin.len(), "byteLength": bytes.len() }));
        self.bin.extend(bytes);
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        self.views.len() - 1
    }

    /// Adds points or directions. Returns the index of their accessor.
    fn vectors(&mut self, vectors: &[DVec3]) -> usize {
        let numbers: Vec<[f64; 3]> = vectors.iter().map(DVec3::to_array).collect();
        self.floats(numbers.as_flattened(), "VEC3")
    }

    /// Adds numbers. Returns the index of their accessor.
    fn floats(&mut self, numbers: &[f64], kind: &str) -> usize {
        let width = match kind {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" => 4,
            _ => 16,
        };
        let numbers: Vec<f32> = numbers.iter().map(|&number| number as f32).collect();
        let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        let view = self.view(&bytes);
        let bound = |pick: fn(f32, f32) -> f32| -> Vec<f32> {
            let of = |axis: usize| numbers.iter().copied().skip(axis).step_by(width).reduce(pick);
            (0..width).filter_map(of).collect()
        };
        self.accessors.push(json!({
            "bufferView": view, "componentType": 5126, "count": numbers.len() / width, "type": kind,
            "min": bound(f32::min), "max": bound(f32::max),
        }));
        self.accessors.len() - 1
    }

    /// Adds the corners of faces, cut into fans. Returns the index of their accessor; `None` for no face.
    fn indices<'a>(&mut self, faces: impl Iterator<Item = &'a [usize]>) -> Option<usize> {
        let fans = faces.flat_map(|corners| {
            (2..corners.len()).flat_map(move |corner| [corners[0], corners[corner - 1], corners[corner]])
        });
        let bytes: Vec<u8> = fans.flat_map(|corner| (corner as u16).to_le_bytes()).collect();
        if bytes.is_empty() {
            return None;
        }
        let view = self.view(&bytes);
        self.accessors.push(
            json!({ "bufferView": view, "componentType": 5123, "count": bytes.len() / 2, "type": "SCALAR" }),
        );
        Some(self.accessors.len() - 1)
    }
}

/// A colour `#rrggbb` in linear light.
pub fn linear(hex: &str) -> anyhow::Result<[f64; 3]> {
    let value = u32::from_str_radix(hex.trim_start_matches('#'), 16).context("a colour")?;
    Ok([16, 8, 0].map(|shift: u32| {
        let channel = f64::from(value >> shift & 0xff) / 255.0;
        if channel <= 0.04045 { channel / 12.92 } else { ((channel + 0.055) / 1.055).powf(2.4) }
    }))
}
