//! Measures how long a mesh file of a million triangles takes to read: with our reader, which checks every line before
//! tobj reads it, and with tobj alone. Ours should take at most 1.4 times as long, but nothing checks that.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, ensure};
use glam::{DVec3, Vec3};
use impasto_core::TriangleMesh;
use impasto_scene::assets::AssetFolders;
use impasto_scene::obj;

use crate::bench::Bench;
use crate::floor::Streams;
use crate::race::{Contender, race};
use crate::table::Row;

/// Cells of the sheet in the file; two triangles each.
const CELLS: [u32; 2] = [1000, 500];

const TRIANGLES: usize = 2 * (CELLS[0] * CELLS[1]) as usize;

/// The file of a wavy sheet with normals and texture coordinates; written if it does not exist.
fn file(folder: &Path) -> anyhow::Result<PathBuf> {
    let path = folder.join("million.obj");
    if path.is_file() {
        return Ok(path);
    }
    let mut text = String::from("o sheet\n");
    for row in 0..=CELLS[1] {
        for column in 0..=CELLS[0] {
            let [u, v] = [(column, CELLS[0]), (row, CELLS[1])].map(|(at, of)| at as f32 / of as f32);
            let (z, slope) = (0.05 * (20.0 * u).sin(), (20.0 * u).cos());
            let normal = Vec3::new(-slope, 0.0, 1.0).normalize();
            writeln!(text, "v {:.6} {v:.6} {z:.6}\nvt {u:.6} {v:.6}", 2.0 * u)?;
            writeln!(text, "vn {:.6} {:.6} {:.6}", normal.x, normal.y, normal.z)?;
        }
    }
    let vertex = |row: u32, column: u32| row * (CELLS[0] + 1) + column + 1;
    for row in 0..CELLS[1] {
        for column in 0..CELLS[0] {
            let [a, b] = [vertex(row, column), vertex(row, column + 1)];
            let [c, d] = [vertex(row + 1, column + 1), vertex(row + 1, column)];
            for [i, j, k] in [[a, b, c], [a, c, d]] {
                writeln!(text, "f {i}/{i}/{i} {j}/{j}/{j} {k}/{k}/{k}")?;
            }
        }
    }
    std::fs::write(&path, text).with_context(|| format!("{} cannot be written", path.display()))?;
    Ok(path)
}

fn ours(path: &Path) -> anyhow::Result<TriangleMesh> {
    let folder = path.parent().context("a file in a folder")?;
    let read = obj::read(path, folder, &AssetFolders::default());
    read.map(|(file, _)| file.mesh).map_err(|report| anyhow::anyhow!("{report}"))
}

fn theirs(path: &Path) -> anyhow::Result<Vec<tobj::Model>> {
    let options = tobj::LoadOptions { single_index: true, triangulate: true, ..Default::default() };
    Ok(tobj::load_obj(path, &options)?.0)
}

fn area(corners: impl Iterator<Item = [Vec3; 3]>) -> f64 {
    corners.map(|[a, b, c]| f64::from((b - a).cross(c - a).length()) * 0.5).sum()
}

/// Measures both readers.
pub fn run(bench: &mut Bench) -> anyhow::Result<()> {
    let path = file(&bench.peers.folder()?)?;
    let (mesh, models) = (ours(&path)?, theirs(&path)?);
    let their_triangles: usize = models.iter().map(|model| model.mesh.indices.len() / 3).sum();
    ensure!(
        mesh.triangles.len() == TRIANGLES && their_triangles == TRIANGLES,
        "the file has {TRIANGLES} triangles; Impasto read {}, tobj {their_triangles}",
        mesh.triangles.len()
    );
    let our_area = area((0..TRIANGLES).map(|triangle| mesh.corners(triangle)));
    let vertex = |model: &tobj::Model, index: u32| {
        DVec3::from_slice(&model.mesh.positions[3 * index as usize..]).as_vec3()
    };
    let their_area: f64 = models
        .iter()
        .map(|model| {
            area(
                model
                    .mesh
                    .indices
                    .chunks_exact(3)
                    .map(|corners| [0, 1, 2].map(|corner| vertex(model, corners[corner]))),
            )
        })
        .sum();
    ensure!((our_area / their_area - 1.0).abs() < 1e-5, "areas {our_area} and {their_area}");
    let file_bytes = std::fs::metadata(&path)?.len() as usize;
    // 32 bytes hold position, normal and texture coordinates of a vertex; 24 hold corners, polygon, group and material
    // of a triangle.
    let mesh_bytes = 32 * mesh.positions.len() + 24 * TRIANGLES;
    drop((mesh, models));
    let contenders = vec![
        Contender::here("Impasto", "every line checked, then read by tobj", || ours(&path)),
        Contender::here("tobj 4", "alone; 1 thread", || theirs(&path)),
        Streams::of_bytes(file_bytes, mesh_bytes).contender(),
    ];
    let figures = race(&bench.pace(false), contenders)?;
    let input = format!("1,000,000 triangles, {:.0} MB", file_bytes as f64 * 1e-6);
    bench.push(Row::of_race("loading", &input, figures, true));
    Ok(())
}
