//! The shipped meshes and the shipped shots, modelled in code: `cargo xtask meshes` writes them to `scenes/meshes`.

mod apple;
mod apple_fine;
mod bamboo;
mod blade;
mod blast;
mod blocks;
mod board;
mod carp;
mod cloth;
mod cottage;
mod curve;
mod deer;
mod effects;
mod fish;
mod glb;
mod globe;
mod head;
mod hills;
mod jug;
mod lane;
mod lemon;
mod limb;
mod orange;
mod parade;
mod poly_mesh;
mod puppet;
mod room;
mod seal;
mod sky;
mod surface_net;
mod tree;
mod valley;
mod walker;

use std::path::{Path, PathBuf};

use anyhow::Context as _;

use poly_mesh::PolyMesh;

/// The folder of the meshes, from the repository's root.
const FOLDER: &str = "scenes/meshes";

/// Writes every shipped mesh (an OBJ file and its MTL file), the shots, and the flag's point cache.
fn main() -> anyhow::Result<()> {
    let folder = folder();
    std::fs::create_dir_all(&folder).with_context(|| format!("cannot make {}", folder.display()))?;
    for mesh in shipped() {
        for (name, text) in files(&mesh)? {
            let path = folder.join(name);
            std::fs::write(&path, text).with_context(|| format!("cannot write {}", path.display()))?;
        }
    }
    for (name, bytes) in shots()? {
        let path = folder.join(name);
        std::fs::write(&path, bytes).with_context(|| format!("cannot write {}", path.display()))?;
    }
    Ok(())
}

/// Name and bytes of each shipped shot, and of each point cache.
fn shots() -> anyhow::Result<[(&'static str, Vec<u8>); 3]> {
    Ok([("lane.glb", lane::lane()?), ("parade.glb", parade::parade()?), ("flag.pc2", parade::cache())])
}

/// The folder of the meshes in the repository that this package lies in.
fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(FOLDER)
}

fn shipped() -> Vec<PolyMesh> {
    vec![
        apple::apple(),
        apple_fine::apple_fine(),
        bamboo::bamboo(),
        carp::carp(),
        cloth::cloth(),
        blast::blast_fire(),
        blast::blast_smoke(),
        blast::blast_sparks(),
        blocks::cube(),
        deer::deer(),
        head::bust(),
        effects::ball(),
        effects::floor(),
        effects::mushroom_cloud(),
        fish::fish(),
        parade::flag(),
        globe::globe(),
        head::head(),
        jug::jug(),
        lemon::lemon(),
        blocks::log(),
        orange::orange(),
        lemon::pear(),
        room::plane(),
        board::plank(),
        board::plate(),
        puppet::puppet_long(),
        puppet::puppet_round(),
        blocks::simple_objects(),
        room::table(),
        room::wall(),
        cottage::cottage(),
        tree::bush(),
        tree::poplar(),
        tree::tree(),
        hills::hills(),
        seal::seal(),
        sky::sky(),
        valley::valley(),
        valley::water(),
        walker::walker(),
    ]
}

/// Name and text of the two files of a mesh.
fn files(mesh: &PolyMesh) -> anyhow::Result<[(String, String); 2]> {
    Ok([(format!("{}.obj", mesh.name), mesh.to_obj()?), (format!("{}.mtl", mesh.name), mesh.to_mtl()?)])
}

#[cfg(test)]
mod tests {
    use std::collections::HashMap;

    use super::*;

    #[test]
    fn committed_files_are_what_the_code_writes() {
        let folder = folder();
        for mesh in shipped() {
            for (name, text) in files(&mesh).unwrap() {
                let committed = std::fs::read_to_string(folder.join(&name)).unwrap();
                assert!(committed == text, "{name} is stale: run `cargo xtask meshes`");
            }
        }
        for (name, bytes) in shots().unwrap() {
            let committed = std::fs::read(folder.join(name)).unwrap();
            assert!(committed == bytes, "{name} is stale: run `cargo xtask meshes`");
        }
    }

    #[test]
    fn counts_are_the_papers() {
        for (name, polygons) in [("apple", 550), ("fish", 8618), ("simple_objects", 3978)] {
            let mesh = shipped().into_iter().find(|mesh| mesh.name == name).unwrap();
            assert_eq!(mesh.faces.len(), polygons, "{name}");
        }
    }

    /// Sheets that only ever show one side.
    const OPEN: [&str; 9] = ["cloth", "flag", "floor", "hills", "seal", "sky", "valley", "wall", "water"];

    /// Meshes whose billows touch along an edge: that edge is walked twice in each direction.
    const TOUCHING: [&str; 2] = ["blast_fire", "blast_smoke"];

    /// In a closed body the faces walk every edge once in each direction, and enclose a positive volume.
    #[test]
    fn bodies_are_closed_and_wind_outwards() {
        for mesh in shipped().into_iter().filter(|mesh| !OPEN.contains(&mesh.name)) {
            let mut edges = HashMap::new();
            let mut volume = 0.0;
            for face in &mesh.faces {
                for (index, &from) in face.corners.iter().enumerate() {
                    let to = face.corners[(index + 1) % face.corners.len()];
                    *edges.entry((from, to)).or_insert(0) += 1;
                }
                let at = |corner: usize| mesh.positions[face.corners[corner]];
                for corner in 2..face.corners.len() {
                    volume += at(0).dot(at(corner - 1).cross(at(corner)));
                }
            }
            assert!(volume > 0.0, "{} is inside out", mesh.name);
            for (&(from, to), &count) in &edges {
                let most = if TOUCHING.contains(&mesh.name) { 2 } else { 1 };
                let back = edges.get(&(to, from));
                assert!(count <= most && back == Some(&count), "{}: edge {from}-{to}", mesh.name);
            }
        }
    }
}
