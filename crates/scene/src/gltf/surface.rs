//! Turns nodes of a glTF file into one mesh file: primitives placed, cut and joined, with normals where the file has
//! none.

use std::sync::Arc;

use glam::{DAffine3, DVec3, Vec2, Vec3};
use impasto_core::cofactors::cofactors;
use impasto_core::color::srgb_from_linear;
use impasto_gltf::{Mesh, Node, Primitive};

use super::GltfFile;
use super::bend::{self, Run};
use super::joints::moved_by;
use super::materials;
use crate::mesh_file::MeshFile;
use crate::surface::{Builder, Built, Geometry};

/// The mesh of several nodes, each placed; `None` where there is no triangle with an area. Groups are those that the
/// file states for its vertices; where it states none, the nodes, by name.
pub(super) fn mesh_of_nodes<'a>(
    file: &GltfFile,
    nodes: impl Iterator<Item = &'a (usize, DAffine3)>,
) -> Option<MeshFile> {
    let mut joined = Joined::default();
    nodes.for_each(|node| joined.add_node(file, *node, true));
    joined.finish(file).map(|(mesh, _)| mesh)
}

/// The mesh of one node, placed, with what bends it; `None` where there is no triangle with an area. Groups are those
/// that the file states for its vertices; where it states none, the primitives, named by [`group_name`].
pub(super) fn mesh_of_node(file: &GltfFile, node: (usize, DAffine3)) -> Option<MeshFile> {
    let mut joined = Joined::default();
    let bends = bend::bends(file, node.0);
    // Points are numbered for a single copy of the mesh: of several instances, a cache would move only the first.
    let of_file = &file.gltf.nodes[node.0];
    let has_points = of_file.instances.is_none()
        && of_file.mesh.is_some_and(|mesh| {
            let primitives = &file.gltf.meshes[mesh].primitives;
            !primitives.is_empty() && primitives.iter().all(|primitive| primitive.points.is_some())
        });
    joined.geometry.keeps_vertices = bends || has_points;
    joined.add_node(file, node, false);
    let runs = std::mem::take(&mut joined.runs);
    let (mut mesh, source_of_vertex) = joined.finish(file)?;
    if bends {
        mesh.bend = Some(Arc::new(bend::of(file, node.0, &runs, &source_of_vertex, &mesh.mesh)));
    }
    if has_points {
        mesh.points = bend::points(file, node.0, &runs, &source_of_vertex).map(Arc::new);
    }
    Some(mesh)
}

impl Joined {
    fn add_node(&mut self, file: &GltfFile, (index, placed): (usize, DAffine3), by_node: bool) {
        let node = &file.gltf.nodes[index];
        let Some(mesh) = node.mesh.map(|mesh| &file.gltf.meshes[mesh]) else { return };
        let copies = match &node.instances {
            Some(instances) => instances.iter().map(|copy| placed * copy.parent_from_local()).collect(),
            None => vec![placed],
        };
        for (number, primitive) in mesh.primitives.iter().enumerate() {
            let group = if by_node { node.name.clone() } else { group_name(file, mesh, primitive) };
            let group = self.group(group);
            let material = primitive.material.unwrap_or(file.gltf.materials.len());
            let vertices = Vertices::of(file, node, mesh, primitive);
            let groups = self.groups_of_faces(mesh, primitive, group);
            for copy in &copies {
                let first = self.geometry.positions.len();
                // Only bending and point caches need to know where vertices come from.
                if self.geometry.keeps_vertices {
                    let kept = Arc::clone(&vertices.kept);
                    self.runs.push(Run { primitive: number, copy: *copy, first, kept });
                }
                self.add(&vertices, *copy, material as u32);
                self.group_of_face.extend(&groups);
            }
        }
    }
}

/// The group of a primitive: its material's name; without one, `default` if it is the only primitive, else its number.
fn group_name(file: &GltfFile, mesh: &Mesh, primitive: &Primitive) -> String {
    let material = primitive.material.map(|material| file.gltf.materials[material].name.as_str());
    match material.filter(|name| !name.is_empty()) {
        Some(name) => name.to_owned(),
        None if mesh.primitives.len() == 1 => "default".to_owned(),
        None => format!("part {}", primitive.index),
    }
}

/// The vertices of a primitive at rest.
struct Vertices {
    positions: Vec<DVec3>,
    normals: Option<Vec<DVec3>>,
    uvs: Option<Vec<Vec2>>,
    /// sRGB.
    colors: Option<Vec<[u8; 3]>>,
    /// The corners of each triangle.
    triangles: Arc<Vec<[u32; 3]>>,
    /// For each vertex, its index in the primitive; empty if all of the primitive's vertices are here.
    kept: Arc<Vec<u32>>,
}

impl Vertices {
    /// The vertices of a primitive, morphed by the weights at rest and moved by the joints.
    fn of(file: &GltfFile, node: &Node, mesh: &Mesh, primitive: &Primitive) -> Self {
        let wide = |of: &[f32; 3]| DVec3::from(of.map(f64::from));
        let mut positions: Vec<DVec3> = primitive.positions.iter().map(wide).collect();
        let mut normals: Option<Vec<DVec3>> =
            primitive.normals.as_ref().map(|list| list.iter().map(wide).collect());
        let weights = node.weights.as_ref().unwrap_or(&mesh.weights);
        for (target, &weight) in primitive.targets.iter().zip(weights).filter(|(_, weight)| **weight != 0.0) {
            let add = |to: &mut Vec<DVec3>, deltas: &[[f32; 3]]| {
                to.iter_mut().zip(deltas).for_each(|(at, delta)| *at += f64::from(weight) * wide(delta));
            };
            if let Some(deltas) = &target.positions {
                add(&mut positions, deltas);
            }
            if let (Some(normals), Some(deltas)) = (&mut normals, &target.normals) {
                add(normals, deltas);
            }
        }
        let has_joints = mesh.primitives.iter().any(|primitive| primitive.influences.is_some());
        if let Some(skin) = node.skin.filter(|_| has_joints) {
            let joints = file.rest.world_from_bound(&file.gltf.skins[skin]);
            for (vertex, at) in positions.iter_mut().enumerate() {
                let matrix = moved_by(&joints, primitive, vertex);
                *at = matrix.transform_point3(*at);
                if let Some(normals) = &mut normals {
                    normals[vertex] = cofactors(matrix.matrix3) * normals[vertex];
                }
            }
        }
        let uvs = uvs_of(file, primitive);
        let byte = |channel: f32| (srgb_from_linear(channel) * 255.0).round() as u8;
        let opaque = |&[r, g, b, _]: &[f32; 4]| [r, g, b].map(byte);
        let colors = primitive.colors.as_ref().map(|list| list.iter().map(opaque).collect());
        let triangles = Arc::clone(&primitive.triangles);
        let mut vertices = Self { positions, normals, uvs, colors, triangles, kept: Arc::default() };
        // Primitives may share their vertices: each takes those that it uses.
        if vertices.positions.len() > vertices.triangles.len() {
            vertices.drop_unused();
        }
        vertices
    }

    /// Drops the vertices that no triangle uses; the others keep their order.
    fn drop_unused(&mut self) {
        let mut is_used = vec![false; self.positions.len()];
        self.triangles.iter().flatten().for_each(|&vertex| is_used[vertex as usize] = true);
        let mut count = 0;
        let place = |used: &bool| {
            count += u32::from(*used);
            count.wrapping_sub(1)
        };
        let place: Vec<u32> = is_used.iter().map(place).collect();
        if count as usize == is_used.len() {
            return;
        }
        fn keep<T>(list: &mut Vec<T>, is_used: &[bool]) {
            let mut used = is_used.iter();
            list.retain(|_| used.next() == Some(&true));
            list.shrink_to_fit();
        }
        self.kept = Arc::new((0..is_used.len() as u32).filter(|&vertex| is_used[vertex as usize]).collect());
        keep(&mut self.positions, &is_used);
        self.normals.iter_mut().for_each(|list| keep(list, &is_used));
        self.uvs.iter_mut().for_each(|list| keep(list, &is_used));
        self.colors.iter_mut().for_each(|list| keep(list, &is_used));
        let placed = |corners: &[u32; 3]| corners.map(|vertex| place[vertex as usize]);
        self.triangles = Arc::new(self.triangles.iter().map(placed).collect());
    }
}

/// Texture coordinates, V up, moved as the material says. They are those of the picture that shows; if none shows,
/// those of the base colour's picture, or else of the emission's.
fn uvs_of(file: &GltfFile, primitive: &Primitive) -> Option<Vec<Vec2>> {
    let material = &file.gltf.materials.get(primitive.material?)?;
    let used = materials::shown_picture(material);
    let used = used.or(material.base_color_texture).or(material.emissive_texture)?;
    let list = primitive.uvs[used.uv_set].as_ref()?;
    let moved = |&uv: &[f32; 2]| {
        let [u, v] = used.transform.apply(uv);
        Vec2::new(u, 1.0 - v)
    };
    Some(list.iter().map(moved).collect())
}

/// Primitives that were joined so far.
#[derive(Default)]
struct Joined {
    geometry: Geometry,
    /// Where the geometry's vertices come from; empty unless its `keeps_vertices` is set.
    runs: Vec<Run>,
    groups: Vec<String>,
    group_of_face: Vec<u32>,
    material_of_face: Vec<u32>,
}

impl Joined {
    fn group(&mut self, name: String) -> u32 {
        let known = self.groups.iter().position(|other| *other == name);
        known.unwrap_or_else(|| {
            self.groups.push(name);
            self.groups.len() - 1
        }) as u32
    }

    /// The group of each triangle of a primitive: that of its first corner, or else `whole`.
    fn groups_of_faces(&mut self, mesh: &Mesh, primitive: &Primitive, whole: u32) -> Vec<u32> {
        let Some(groups) = &primitive.groups else { return vec![whole; primitive.triangles.len()] };
        let known: Vec<u32> = mesh.group_names.iter().map(|name| self.group(name.clone())).collect();
        let of = |&[corner, ..]: &[u32; 3]| {
            let number = (groups[corner as usize] as usize).checked_sub(1);
            number.and_then(|number| known.get(number).copied()).unwrap_or(whole)
        };
        primitive.triangles.iter().map(of).collect()
    }

    fn add(&mut self, vertices: &Vertices, placed: DAffine3, material: u32) {
        let first = self.geometry.positions.len() as u32;
        // Adding 0 makes −0 and 0 the same.
        self.geometry
            .positions
            .extend(vertices.positions.iter().map(|&at| placed.transform_point3(at).as_vec3() + Vec3::ZERO));
        let turn = cofactors(placed.matrix3);
        let unit = |normal: &DVec3| (turn * *normal).try_normalize().map(|normal| normal.as_vec3());
        let count = vertices.positions.len();
        match &vertices.normals {
            Some(normals) => self.geometry.normals.extend(normals.iter().map(unit)),
            None => self.geometry.normals.extend(std::iter::repeat_n(None, count)),
        }
        // If other primitives have colours, one without is white.
        if vertices.colors.is_some() || !self.geometry.colors.is_empty() {
            self.geometry.colors.resize(first as usize, [255; 3]);
            match &vertices.colors {
                Some(colors) => self.geometry.colors.extend(colors),
                None => self.geometry.colors.resize(first as usize + count, [255; 3]),
            }
        }
        match &vertices.uvs {
            Some(uvs) => self.geometry.uvs.extend(uvs.iter().copied().map(Some)),
            None => self.geometry.uvs.extend(std::iter::repeat_n(None, count)),
        }
        // Mirroring reverses the winding; it is turned back here.
        let is_mirrored = placed.matrix3.determinant() < 0.0;
        for &[a, b, c] in vertices.triangles.iter() {
            let corners = if is_mirrored { [a, c, b] } else { [a, b, c] };
            self.geometry.corners.extend(corners.map(|corner| first + corner));
            self.geometry.ends.push(self.geometry.corners.len() as u32);
        }
        let faces = vertices.triangles.len();
        self.material_of_face.extend(std::iter::repeat_n(material, faces));
    }

    /// The mesh, and for each of its vertices the index of the joined vertex from which it comes (empty unless
    /// `keeps_vertices` is set). `None` without triangles.
    fn finish(self, file: &GltfFile) -> Option<(MeshFile, Vec<u32>)> {
        let Built { mut mesh, face_of_triangle: faces, source_of_vertex } =
            Builder::new(&self.geometry).finish();
        mesh.group_of_triangle = faces.iter().map(|&face| self.group_of_face[face as usize]).collect();
        mesh.material_of_triangle = faces.iter().map(|&face| self.material_of_face[face as usize]).collect();
        let groups = if self.groups.is_empty() { vec!["default".to_owned()] } else { self.groups };
        let file = MeshFile::still(mesh, groups, file.materials.clone());
        (!file.mesh.triangles.is_empty()).then_some((file, source_of_vertex))
    }
}
