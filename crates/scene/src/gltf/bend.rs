//! Collects what bends the mesh of a node: its morph targets and its joints, vertex by vertex.

use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3, Vec3};
use impasto_core::TriangleMesh;
use impasto_core::bending::{Bend, BendPose, SkinWeights, Target};
use impasto_core::cofactors::cofactors;
use impasto_gltf::{Mesh, Posed, Primitive};

use super::GltfFile;
use super::joints::moved_by;
use crate::mesh_file::Points;

/// Consecutive vertices of a joined mesh that come from one primitive.
#[derive(Debug)]
pub(super) struct Run {
    /// Index of the primitive in its mesh.
    pub primitive: usize,
    /// The transform by which they were placed.
    pub copy: DAffine3,
    /// Index of the first of them in the joined mesh.
    pub first: usize,
    /// Their indices in the primitive; empty if they are all of its vertices.
    pub kept: Arc<Vec<u32>>,
}

/// Where a vertex comes from: its primitive, its index there, and the transform by which it was placed.
struct Origin<'a> {
    primitive: &'a Primitive,
    vertex: usize,
    copy: DAffine3,
}

/// Whether joints or morph targets bend a node's mesh.
pub(super) fn bends(file: &GltfFile, node: usize) -> bool {
    let node = &file.gltf.nodes[node];
    let Some(mesh) = node.mesh.map(|mesh| &file.gltf.meshes[mesh]) else { return false };
    // Instanced copies of a skinned mesh are not bent: they stay at rest.
    let is_skinned = node.skin.is_some() && node.instances.is_none();
    is_skinned && mesh.primitives.iter().any(|primitive| primitive.influences.is_some())
        || node.skin.is_none() && mesh.target_count > 0
}

/// The weights of a node's targets, and for each of its joints the transform into model space from the space in which
/// the mesh was bound.
pub(super) fn pose(file: &GltfFile, node: usize, posed: &Posed) -> BendPose {
    let weights = posed.weights[node].clone();
    let skin = file.gltf.nodes[node].skin.map(|skin| &file.gltf.skins[skin]);
    BendPose { weights, joints: skin.map_or(Vec::new(), |skin| posed.world_from_bound(skin)) }
}

/// What bends a node's mesh. `source_of_vertex` gives, for each vertex of the mesh, its index among the joined
/// vertices.
pub(super) fn of(
    file: &GltfFile,
    node: usize,
    runs: &[Run],
    source_of_vertex: &[u32],
    mesh_at_rest: &TriangleMesh,
) -> Bend {
    let node_data = &file.gltf.nodes[node];
    let Some(mesh) = node_data.mesh.map(|mesh| &*file.gltf.meshes[mesh]) else { return Bend::default() };
    let rest = pose(file, node, &file.rest);
    let is_skinned = !rest.joints.is_empty();
    let origins: Vec<Origin<'_>> =
        source_of_vertex.iter().map(|&source| origin(mesh, runs, source as usize)).collect();
    let turns_normals = origins.iter().any(|origin| {
        let primitive = origin.primitive;
        let lacks =
            |target: &impasto_gltf::MorphTarget| target.positions.is_some() && target.normals.is_none();
        primitive.targets.iter().any(|target| primitive.normals.is_none() || lacks(target))
    });
    let mut bend = Bend {
        targets: vec![Target::default(); mesh.target_count],
        skin: is_skinned.then(|| skin_weights(&origins)),
        turns_normals,
        ..Bend::default()
    };
    for (vertex, origin) in origins.iter().enumerate() {
        let placed = if is_skinned { DAffine3::IDENTITY } else { origin.copy };
        let position = wide(origin.primitive.positions[origin.vertex]);
        let turn = cofactors(placed.matrix3);
        // If the file has no normal, the one that was made for the mesh at rest is used. In a skinned mesh, the rest
        // pose of the joints has turned that normal, so the turn is undone.
        let normal = match &origin.primitive.normals {
            Some(normals) => turn * wide(normals[origin.vertex]),
            None => unmoved(origin, &rest, is_skinned).transpose() * mesh_at_rest.normals[vertex].as_dvec3(),
        };
        let length = if normal.length() > 0.0 { normal.length() } else { 1.0 };
        bend.bound.positions.push(placed.transform_point3(position).as_vec3() + Vec3::ZERO);
        bend.bound.normals.push((normal / length).as_vec3());
        for (target, of_file) in bend.targets.iter_mut().zip(&origin.primitive.targets) {
            let delta = |list: &Option<Arc<Vec<[f32; 3]>>>| {
                list.as_ref().map_or(DVec3::ZERO, |list| wide(list[origin.vertex]))
            };
            let moved = placed.matrix3 * delta(&of_file.positions);
            let turned = turn * delta(&of_file.normals) / length;
            target.push(vertex as u32, moved.as_vec3(), turned.as_vec3());
        }
    }
    bend.rest = rest;
    bend
}

/// For each vertex of a node's mesh, the index of its point in a point cache. `None` unless the file states the points
/// of all vertices.
pub(super) fn points(file: &GltfFile, node: usize, runs: &[Run], source_of_vertex: &[u32]) -> Option<Points> {
    let mesh = &*file.gltf.meshes[file.gltf.nodes[node].mesh?];
    let all = mesh.primitives.iter().filter_map(|primitive| primitive.points.as_ref());
    let count = all.flat_map(|points| points.iter()).max().map_or(0, |&last| last as usize + 1);
    let point = |&source: &u32| {
        let origin = origin(mesh, runs, source as usize);
        origin.primitive.points.as_ref().map(|points| points[origin.vertex])
    };
    let of_vertex = source_of_vertex.iter().map(point).collect::<Option<Vec<u32>>>()?;
    Some(Points { count, of_vertex })
}

fn wide(vector: [f32; 3]) -> DVec3 {
    DVec3::from(vector.map(f64::from))
}

fn origin<'a>(mesh: &'a Mesh, runs: &[Run], source: usize) -> Origin<'a> {
    let run = &runs[runs.partition_point(|run| run.first <= source).saturating_sub(1)];
    let number = source - run.first;
    let vertex = run.kept.get(number).map_or(number, |&kept| kept as usize);
    Origin { primitive: &mesh.primitives[run.primitive], vertex, copy: run.copy }
}

/// The linear part of the transform that carries a vertex and its surroundings from the unbent mesh to the mesh at
/// rest.
fn unmoved(origin: &Origin<'_>, rest: &BendPose, is_skinned: bool) -> DMat3 {
    if is_skinned { moved_by(&rest.joints, origin.primitive, origin.vertex).matrix3 } else { DMat3::IDENTITY }
}

/// The joints and weights of all vertices. A vertex of a primitive without joints moves with the first joint.
fn skin_weights(origins: &[Origin<'_>]) -> SkinWeights {
    let of = |origin: &Origin<'_>| origin.primitive.influences.as_ref().map_or(1, |all| all.per_vertex);
    let per_vertex = origins.iter().map(of).max().unwrap_or(1);
    let mut skin = SkinWeights { per_vertex, ..SkinWeights::default() };
    for (vertex, origin) in origins.iter().enumerate() {
        match &origin.primitive.influences {
            Some(own) => {
                let range = origin.vertex * own.per_vertex..(origin.vertex + 1) * own.per_vertex;
                skin.joints.extend(&own.joints[range.clone()]);
                skin.weights.extend(&own.weights[range]);
            }
            None => {
                skin.joints.push(0);
                skin.weights.push(1.0);
            }
        }
        skin.joints.resize((vertex + 1) * per_vertex, 0);
        skin.weights.resize((vertex + 1) * per_vertex, 0.0);
    }
    skin
}
