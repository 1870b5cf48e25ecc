//! Fuzzes OBJ files: they are read or refused, and what is read is sound. The bytes after the first zero byte are the
//! MTL file `m.mtl`, which the OBJ file may name.

#![no_main]

use std::path::PathBuf;
use std::sync::OnceLock;

use impasto_scene::assets::AssetFolders;
use impasto_scene::obj;
use libfuzzer_sys::fuzz_target;

fn folder() -> &'static PathBuf {
    static FOLDER: OnceLock<PathBuf> = OnceLock::new();
    FOLDER.get_or_init(|| impasto_fuzz::folder("obj"))
}

fuzz_target!(|bytes: &[u8]| {
    let mut parts = bytes.splitn(2, |&byte| byte == 0);
    let (text, materials) = (parts.next().unwrap_or_default(), parts.next().unwrap_or_default());
    let path = folder().join("m.obj");
    std::fs::write(&path, text).expect("written");
    std::fs::write(folder().join("m.mtl"), materials).expect("written");
    let Ok((file, _)) = obj::read(&path, folder(), &AssetFolders::default()) else { return };
    let mesh = &file.mesh;
    assert!(!mesh.triangles.is_empty());
    assert!(mesh.positions.iter().all(|at| at.is_finite()));
    assert!(mesh.normals.iter().all(|normal| (normal.length() - 1.0).abs() < 1e-3));
    assert!(mesh.uvs.iter().all(|uv| uv.is_finite()));
    assert!(mesh.triangles.iter().flatten().all(|&vertex| (vertex as usize) < mesh.positions.len()));
    assert!(mesh.group_of_triangle.iter().all(|&group| (group as usize) < file.groups.len()));
    assert!(mesh.material_of_triangle.iter().all(|&material| (material as usize) < file.materials.len()));
});
