//! Measures how long it takes to read a glTF file of a million triangles into our mesh, with every number checked.
//! Beside it, the `gltf` crate hands out the same numbers.

use std::path::Path;

use anyhow::{Context as _, ensure};
use glam::Vec3;
use impasto_scene::assets::AssetFolders;
use impasto_scene::load;
use impasto_scene::mesh_file::MeshFile;
use impasto_tests::glb::{self, Node};
use impasto_tests::shapes;

use crate::bench::Bench;
use crate::floor::Streams;
use crate::race::{Contender, race};
use crate::table::Row;

/// How many quads the ball in the file has around its axis, and from pole to pole.
const QUADS: [u32; 2] = [1000, 500];

fn ours(path: &Path) -> anyhow::Result<MeshFile> {
    let read = load::load_mesh(path, &AssetFolders::default());
    read.map(|(file, _)| file).map_err(|report| anyhow::anyhow!("{report}"))
}

/// Positions, normals and corners, as the `gltf` crate reads them.
type Lists = (Vec<[f32; 3]>, Vec<[f32; 3]>, Vec<u32>);

fn theirs(path: &Path) -> anyhow::Result<Lists> {
    let file = gltf::Gltf::from_slice(&std::fs::read(path)?)?;
    let bytes = file.blob.as_deref().context("a binary file")?;
    let mesh = file.meshes().next().context("a mesh")?;
    let primitive = mesh.primitives().next().context("a primitive")?;
    let reader = primitive.reader(|_| Some(bytes));
    Ok((
        reader.read_positions().context("positions")?.collect(),
        reader.read_normals().context("normals")?.collect(),
        reader.read_indices().context("indices")?.into_u32().collect(),
    ))
}

fn area(corners: impl Iterator<Item = [Vec3; 3]>) -> f64 {
    corners.map(|[a, b, c]| f64::from((b - a).cross(c - a).length()) * 0.5).sum()
}

/// Measures both readers.
pub fn run(bench: &mut Bench) -> anyhow::Result<()> {
    let path = bench.peers.folder()?.join("million.glb");
    if !path.is_file() {
        let ball = shapes::sphere(QUADS[0], QUADS[1]);
        glb::write(&path, &[Node { name: "Ball", mesh: &ball, translation: [0.0; 3], turn_deg: 0.0 }]);
    }
    let (file, (positions, _, corners)) = (ours(&path)?, theirs(&path)?);
    let triangles = file.mesh.triangles.len();
    let our_area = area((0..triangles).map(|triangle| file.mesh.corners(triangle)));
    let at = |corner: u32| Vec3::from(positions[corner as usize]);
    let their_area = area(corners.chunks_exact(3).map(|face| [at(face[0]), at(face[1]), at(face[2])]));
    ensure!(
        3 * triangles == corners.len() && (our_area / their_area - 1.0).abs() < 1e-5,
        "{triangles} triangles of area {our_area} here, {} of {their_area} there",
        corners.len() / 3
    );
    let file_bytes = std::fs::metadata(&path)?.len() as usize;
    // 24 bytes hold position and normal of a vertex; 24 hold corners, polygon, group and material of a triangle.
    let mesh_bytes = 24 * (file.mesh.positions.len() + triangles);
    drop((file, positions, corners));
    let contenders = vec![
        Contender::here("Impasto", "every number checked, made a mesh", || ours(&path)),
        Contender::here("gltf 1.4", "its lists, collected; 1 thread", || theirs(&path)),
        Streams::of_bytes(file_bytes, mesh_bytes).contender(),
    ];
    let figures = race(&bench.pace(false), contenders)?;
    let input = format!("{triangles} triangles, {:.0} MB", file_bytes as f64 * 1e-6);
    bench.push(Row::of_race("loading_gltf", &input, figures, true));
    Ok(())
}
