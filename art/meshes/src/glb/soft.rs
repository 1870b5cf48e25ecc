//! Soft bodies in a shot: meshes that bend with a skeleton or turn into other shapes, and the keys that move them.

use anyhow::ensure;
use glam::{DQuat, DVec3};
use serde_json::{Value, json};

use super::{Coat, Glb};
use crate::poly_mesh::PolyMesh;

/// The joints that a point follows, as indices into its skin, and their shares. The shares sum to one; the first is the
/// greatest.
pub type Influence = [(usize, f64); 4];

/// A shape that a mesh can turn into.
pub struct Target<'a> {
    /// Its name.
    pub name: &'a str,
    /// The places of the mesh's points in this shape.
    pub positions: Vec<DVec3>,
}

/// What changes the shape of a mesh.
pub enum Bend<'a> {
    /// Nothing: it keeps its shape.
    Never,
    /// The joints of a skin: for each point, those that it follows.
    Joints(&'a [Influence]),
    /// Morph targets.
    Targets(&'a [Target<'a>]),
}

impl Glb {
    /// Adds a mesh with one normal per point, so that no edge shows. Returns its index.
    ///
    /// # Errors
    /// It has more points than 16 bits can count, a colour of its palette cannot be read, or `bend` does not have one
    /// entry for each point.
    pub fn smooth_mesh(
        &mut self,
        mesh: &PolyMesh,
        coat: &Coat<'_>,
        bend: &Bend<'_>,
    ) -> anyhow::Result<usize> {
        let count = mesh.positions.len();
        let normals = mesh.normals();
        let mut attributes = json!({ "POSITION": self.positions(mesh)?, "NORMAL": self.vectors(&normals) });
        if let Bend::Joints(influences) = *bend {
            ensure!(influences.len() == count, "{}: not one influence per point", mesh.name);
            let [joints, weights] = self.influences(influences);
            attributes["JOINTS_0"] = json!(joints);
            attributes["WEIGHTS_0"] = json!(weights);
        }
        let mut primitives = self.primitives(mesh, coat, attributes)?;
        let mut whole = json!({ "name": mesh.name });
        if let Bend::Targets(targets) = *bend {
            ensure!(targets.iter().all(|to| to.positions.len() == count), "{}: another count", mesh.name);
            let deltas: Vec<Value> = targets.iter().map(|to| self.target(mesh, &normals, to)).collect();
            for primitive in &mut primitives {
                primitive["targets"] = json!(deltas);
            }
            let names: Vec<&str> = targets.iter().map(|target| target.name).collect();
            whole["weights"] = json!(vec![0.0; targets.len()]);
            whole["extras"] = json!({ "targetNames": names });
        }
        whole["primitives"] = json!(primitives);
        self.meshes.push(whole);
        Ok(self.meshes.len() - 1)
    }

    /// Adds a node under another one. Returns its index.
    pub fn child(&mut self, parent: usize, node: Value) -> usize {
        let index = self.nodes.len();
        self.nodes.push(node);
        match self.nodes[parent]["children"].as_array_mut() {
            Some(children) => children.push(json!(index)),
            None => self.nodes[parent]["children"] = json!([index]),
        }
        index
    }

    /// Adds a node with a mesh that bends with a skeleton: `joints` gives the node of each joint, and where it rests.
    /// The new node is a root of the scene and has no transform of its own.
    pub fn skinned(&mut self, name: &str, mesh: usize, joints: &[(usize, DVec3)]) {
        let bind = |at: &DVec3| {
            let [x, y, z] = (-*at).to_array();
            [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, x, y, z, 1.0]
        };
        let binds: Vec<[f64; 16]> = joints.iter().map(|(_, at)| bind(at)).collect();
        let binds = self.floats(binds.as_flattened(), "MAT4");
        let nodes: Vec<usize> = joints.iter().map(|(node, _)| *node).collect();
        self.skins.push(json!({ "name": name, "joints": nodes, "inverseBindMatrices": binds }));
        self.nodes.push(json!({ "name": name, "mesh": mesh, "skin": self.skins.len() - 1 }));
        self.roots.push(self.nodes.len() - 1);
    }

    /// Gives nodes keys of their turns only, all at the same times in seconds; linear between.
    pub fn turns(&mut self, times_s: &[f64], nodes: &[(usize, Vec<DQuat>)]) {
        let input = self.floats(times_s, "SCALAR");
        for (node, turns) in nodes {
            let turns: Vec<[f64; 4]> = turns.iter().map(DQuat::to_array).collect();
            let output = self.floats(turns.as_flattened(), "VEC4");
            self.channel(*node, "rotation", [input, output]);
        }
    }

    /// Gives a node keys of the weights of its mesh's targets, each with its time in seconds; linear between.
    pub fn weights<const N: usize>(&mut self, node: usize, keys: &[(f64, [f64; N])]) {
        let times: Vec<f64> = keys.iter().map(|(time_s, _)| *time_s).collect();
        let weights: Vec<[f64; N]> = keys.iter().map(|(_, weights)| *weights).collect();
        let ends = [self.floats(&times, "SCALAR"), self.floats(weights.as_flattened(), "SCALAR")];
        self.channel(node, "weights", ends);
    }

    /// Adds joints as bytes and their shares as 16 bits, which sum to one exactly. Returns their accessors.
    fn influences(&mut self, influences: &[Influence]) -> [usize; 2] {
        const ONE: u16 = u16::MAX;
        let (mut joints, mut weights) = (Vec::new(), Vec::new());
        for influence in influences {
            let mut shares = influence.map(|(_, share)| (share * f64::from(ONE)).round() as u16);
            // The first joint has the greatest share: it takes what rounding left.
            let others: u16 = shares[1..].iter().sum();
            shares[0] = ONE - others;
            joints.extend(influence.map(|(joint, _)| joint as u8));
            weights.extend(shares.iter().flat_map(|share| share.to_le_bytes()));
        }
        let [joints, weights] = [self.view(&joints), self.view(&weights)];
        let count = influences.len();
        [(joints, 5121, false), (weights, 5123, true)].map(|(view, kind, normalized)| {
            self.accessors.push(json!({
                "bufferView": view, "componentType": kind, "count": count, "type": "VEC4", "normalized": normalized,
            }));
            self.accessors.len() - 1
        })
    }

    /// Adds a colour for each point, linear 0..=1, as bytes. Returns the index of their accessor.
    pub(super) fn tints(&mut self, colors: &[DVec3]) -> usize {
        let byte = |channel: f64| (channel * 255.0).round() as u8;
        let bytes: Vec<u8> =
            colors.iter().flat_map(|color| [byte(color.x), byte(color.y), byte(color.z), 255]).collect();
        let view = self.view(&bytes);
        self.accessors.push(json!({
            "bufferView": view, "componentType": 5121, "count": colors.len(), "type": "VEC4", "normalized": true,
        }));
        self.accessors.len() - 1
    }

    /// Adds the differences between a mesh and one of its targets. Returns the target's attributes.
    fn target(&mut self, mesh: &PolyMesh, normals: &[DVec3], target: &Target<'_>) -> Value {
        let turned = PolyMesh { positions: target.positions.clone(), ..mesh.clone() }.normals();
        let moved: Vec<DVec3> =
            target.positions.iter().zip(&mesh.positions).map(|(to, at)| *to - *at).collect();
        let turned: Vec<DVec3> = turned.iter().zip(normals).map(|(to, at)| *to - *at).collect();
        json!({ "POSITION": self.sparse(&moved, 5e-5), "NORMAL": self.sparse(&turned, 4e-3) })
    }

    /// Adds vectors as a sparse accessor: those not longer than `least` count as zero and are not stored. The first is
    /// always stored, since the list may not be empty. Returns the accessor's index.
    fn sparse(&mut self, vectors: &[DVec3], least: f64) -> usize {
        let kept =
            |(index, vector): (usize, &DVec3)| (index == 0 || vector.length() > least).then_some(index);
        let kept: Vec<usize> = vectors.iter().enumerate().filter_map(kept).collect();
        let indices: Vec<u8> = kept.iter().flat_map(|&index| (index as u16).to_le_bytes()).collect();
        let values: Vec<[f32; 3]> = kept.iter().map(|&index| vectors[index].as_vec3().to_array()).collect();
        let bytes: Vec<u8> = values.as_flattened().iter().flat_map(|number| number.to_le_bytes()).collect();
        let bound = |pick: fn(f32, f32) -> f32| -> Vec<f32> {
            (0..3).map(|axis| values.iter().map(|value| value[axis]).fold(0.0, pick)).collect()
        };
        let [indices, values] = [self.view(&indices), self.view(&bytes)];
        let (min, max) = (bound(f32::min), bound(f32::max));
        self.accessors.push(json!({
            "componentType": 5126, "count": vectors.len(), "type": "VEC3", "min": min, "max": max,
            "sparse": {
                "count": kept.len(),
                "indices": { "bufferView": indices, "componentType": 5123 },
                "values": { "bufferView": values },
            },
        }));
        self.accessors.len() - 1
    }
}
