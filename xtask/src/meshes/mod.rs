//! The shipped meshes, made by code: `cargo xtask meshes` writes them to `scenes/meshes`.

mod apple;
mod blocks;
mod curve;
mod fish;
mod jug;
mod lemon;
mod poly_mesh;
mod room;

use std::path::Path;

use anyhow::Context as _;

use poly_mesh::PolyMesh;

/// Where the meshes are kept, from the repository's root.
const FOLDER: &str = "scenes/meshes";

/// Writes every shipped mesh, an OBJ and its MTL, under `root`.
///
/// # Errors
/// When a mesh came out wrong, or a file cannot be written.
pub fn run(root: &Path) -> anyhow::Result<()> {
    let folder = root.join(FOLDER);
    std::fs::create_dir_all(&folder).with_context(|| format!("cannot make {}", folder.display()))?;
    for mesh in shipped() {
        for (name, text) in files(&mesh)? {
            let path = folder.join(name);
            std::fs::write(&path, text).with_context(|| format!("cannot write {}", path.display()))?;
        }
    }
    Ok(())
}

/// Every shipped mesh.
fn shipped() -> Vec<PolyMesh> {
    vec![
        apple::apple(),
        blocks::cube(),
        fish::fish(),
        jug::jug(),
        lemon::lemon(),
        blocks::log(),
        lemon::pear(),
        room::plane(),
        blocks::simple_objects(),
        room::table(),
        room::wall(),
    ]
}

/// Name and text of the two files of a mesh.
fn files(mesh: &PolyMesh) -> anyhow::Result<[(String, String); 2]> {
    Ok([(format!("{}.obj", mesh.name), mesh.to_obj()?), (format!("{}.mtl", mesh.name), mesh.to_mtl()?)])
}
