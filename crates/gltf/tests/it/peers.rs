//! Reads the files of Debian's package `assimp-testmodels`, and compares how many triangles they have with what the
//! outside crate `gltf` counts. Skipped where the package is not installed; `cargo xtask test` installs it.

use std::path::{Path, PathBuf};

use crate::corpus::read_path;

fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    for path in entries.flatten().map(|entry| entry.path()) {
        if path.is_dir() {
            files(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "gltf" || extension == "glb") {
            found.push(path);
        }
    }
}

/// Triangles as the outside crate `gltf` counts them; `None` where it does not read the file.
fn triangles_of_peer(path: &Path) -> Option<usize> {
    use gltf::mesh::Mode;
    let read = std::panic::catch_unwind(|| {
        let bytes = std::fs::read(path).expect("it was listed");
        let document = gltf::Gltf::from_slice(&bytes).ok()?;
        let primitives =
            document.meshes().flat_map(|mesh| mesh.primitives().collect::<Vec<_>>()).map(|primitive| {
                let corners = primitive.indices().or_else(|| primitive.get(&gltf::Semantic::Positions));
                let corners = corners.map_or(0, |accessor| accessor.count());
                match primitive.mode() {
                    Mode::Triangles => corners / 3,
                    Mode::TriangleStrip | Mode::TriangleFan => corners.saturating_sub(2),
                    _ => 0,
                }
            });
        Some(primitives.sum())
    });
    read.ok().flatten()
}

#[test]
fn testmodels_have_as_many_triangles() {
    let mut paths = Vec::new();
    files(Path::new("/usr/share/assimp/models/glTF2"), &mut paths);
    paths.sort();
    if paths.is_empty() {
        return eprintln!("skipped: the package assimp-testmodels is not installed");
    }
    let (mut differ, mut equal) = (0, 0);
    for path in paths {
        let peer = triangles_of_peer(&path);
        let own = read_path(&path);
        let count = own.as_ref().ok().map(|(gltf, _)| {
            let primitives = gltf.meshes.iter().flat_map(|mesh| &mesh.primitives);
            primitives.map(|primitive| primitive.triangles.len()).sum::<usize>()
        });
        let why = match &own {
            Ok((_, warnings)) => warnings.first().map_or(String::new(), ToString::to_string),
            Err(findings) => findings[0].to_string(),
        };
        equal += usize::from(peer.is_some() && peer == count);
        if peer != count {
            differ += usize::from(peer.is_some() && count.is_some());
            eprintln!("{}: gltf {peer:?}, here {count:?} {why}", path.display());
        }
    }
    assert!(differ == 0 && equal >= 30, "{differ} counts differ, {equal} are equal");
}
