//! Meshes: vertices and triangles as they are drawn, whatever their form in the file.

use std::sync::Arc;

/// A mesh: what a node shows.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// The name in the file; empty for none.
    pub name: String,
    /// Its parts, in the order of the file. Parts of points or lines, or without vertices, are left out.
    pub primitives: Vec<Primitive>,
    /// How many morph targets each primitive has.
    pub target_count: usize,
    /// Default weights of the morph targets: `target_count` of them.
    pub weights: Vec<f32>,
    /// Names of the morph targets, where the exporter wrote them (`extras.targetNames`): `target_count` or none.
    pub target_names: Vec<String>,
    /// Names of the groups that primitives refer to (`extras.groupNames`).
    pub group_names: Vec<String>,
}

/// A part of a mesh with one material. Lists that several primitives read from one accessor are one list in memory,
/// except colours without alpha, `points` and `groups`.
#[derive(Clone, Debug, PartialEq)]
pub struct Primitive {
    /// Its index among the mesh's primitives in the file. Some of those may be left out here.
    pub index: usize,
    /// One position per vertex, finite, in the space of the node.
    pub positions: Arc<Vec<[f32; 3]>>,
    /// One normal per vertex, finite, as in the file: mostly of unit length. `None`: the faces are flat.
    pub normals: Option<Arc<Vec<[f32; 3]>>>,
    /// Texture coordinates of sets 0 and 1, one per vertex, finite. **V points down**: (0, 0) is the top left corner
    /// of the picture.
    pub uvs: [Option<Arc<Vec<[f32; 2]>>>; 2],
    /// Linear colour and alpha per vertex, finite; multiplies the base colour.
    pub colors: Option<Arc<Vec<[f32; 4]>>>,
    /// What moves the vertices when the node has a skin.
    pub influences: Option<Arc<Influences>>,
    /// Morph targets: as many as [`Mesh::target_count`].
    pub targets: Vec<MorphTarget>,
    /// Index into the file's materials; `None`: the default material. With KHR_materials_variants, the one of the first
    /// variant.
    pub material: Option<usize>,
    /// The point of the modelling program at which each vertex lies (the attribute `_POINT`), counted from 0.
    pub points: Option<Arc<Vec<u32>>>,
    /// The group of each vertex (the attribute `_GROUP`): 0 for none, else 1 plus an index into [`Mesh::group_names`].
    /// That index may be beyond the end of the list.
    pub groups: Option<Arc<Vec<u32>>>,
    /// Vertex indices, each less than `positions.len()`, counter-clockwise seen from outside.
    pub triangles: Arc<Vec<[u32; 3]>>,
}

/// What morphing by a weight of one adds to each vertex.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MorphTarget {
    /// Added to the positions; one per vertex, finite.
    pub positions: Option<Arc<Vec<[f32; 3]>>>,
    /// Added to the normals; one per vertex, finite.
    pub normals: Option<Arc<Vec<[f32; 3]>>>,
}

/// Joints and weights of vertices.
#[derive(Clone, Debug, PartialEq)]
pub struct Influences {
    /// How many joints move a vertex: 4 or 8.
    pub per_vertex: usize,
    /// `per_vertex` indices into the joints of the skin, for each vertex. Those with weight 0 may be out of range.
    pub joints: Vec<u16>,
    /// `per_vertex` weights for each vertex: not negative, with a sum of one.
    pub weights: Vec<f32>,
    /// The largest joint index with a weight above 0.
    pub largest_joint: u16,
}
