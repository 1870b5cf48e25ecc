//! Morph targets: meshes of equal topology that a mesh may turn into.

use glam::Vec3;
use impasto_core::bending::Vertices;

use crate::mesh_file::MeshFile;

/// For each vertex of `base`, its position and normal in `target`.
///
/// Both must have the same faces in the same order, corner by corner. Vertices are matched by the corners of triangles,
/// so the two files may split their vertices differently.
///
/// # Errors
/// A phrase that names the difference, where the topologies differ.
pub fn target_of(base: &MeshFile, target: &MeshFile) -> Result<Vertices, String> {
    let (base, target) = (&base.mesh, &target.mesh);
    let counts = |what: &str, here: usize, there: usize| {
        if here == there { Ok(()) } else { Err(format!("{there} {what} instead of {here}")) }
    };
    counts("polygons", base.polygon_count(), target.polygon_count())?;
    counts("triangles", base.triangles.len(), target.triangles.len())?;
    if base.polygon_of_triangle != target.polygon_of_triangle {
        return Err("its polygons have other numbers of corners".to_owned());
    }
    let mut positions: Vec<Option<Vec3>> = vec![None; base.positions.len()];
    let mut normals = vec![Vec3::ZERO; base.positions.len()];
    for (here, there) in base.triangles.iter().zip(&target.triangles) {
        for (&vertex, &other) in here.iter().zip(there) {
            let (vertex, other) = (vertex as usize, other as usize);
            let position = target.positions[other];
            if positions[vertex].is_some_and(|known| known != position) {
                return Err("its faces are connected differently".to_owned());
            }
            positions[vertex] = Some(position);
            normals[vertex] += target.normals[other];
        }
    }
    let pairs = normals.iter().zip(&base.normals);
    Ok(Vertices {
        normals: pairs.map(|(normal, usual)| normal.try_normalize().unwrap_or(*usual)).collect(),
        positions: positions
            .iter()
            .zip(&base.positions)
            .map(|(position, usual)| position.unwrap_or(*usual))
            .collect(),
    })
}
