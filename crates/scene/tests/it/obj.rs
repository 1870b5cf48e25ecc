//! Tests of reading OBJ files: good files are read whole, errors in bad ones have a place, and a file with random
//! changes gives a sound mesh or a report.

use std::fs;
use std::path::Path;

use impasto_scene::assets::AssetFolders;
use impasto_scene::mesh_file::MeshFile;
use impasto_scene::obj;
use impasto_scene::problem::{Problem, Report, TextPosition};

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

fn read(folder: &Path, text: &[u8]) -> Result<(MeshFile, Vec<Problem>), Report> {
    let path = folder.join("model.obj");
    // A new file each time, since overwriting waits for the disk on some file systems.
    fs::remove_file(&path).ok();
    fs::write(&path, text).expect("the temporary folder can be written");
    obj::read(&path, folder, &AssetFolders::default())
}

fn first_place(result: Result<(MeshFile, Vec<Problem>), Report>) -> Option<TextPosition> {
    result
        .expect_err("the text is wrong")
        .0
        .iter()
        .find(|problem| problem.severity.is_fatal())
        .and_then(|problem| problem.place)
}

fn assert_sound(file: &MeshFile) {
    let mesh = &file.mesh;
    let count = mesh.triangles.len();
    assert!(count > 0 && !file.groups.is_empty() && !file.materials.is_empty());
    assert!(mesh.positions.iter().all(|at| at.is_finite()));
    assert!(mesh.normals.len() == mesh.positions.len());
    assert!(mesh.normals.iter().all(|normal| (normal.length() - 1.0).abs() < 1e-3));
    assert!(mesh.uvs.is_empty() || mesh.uvs.len() == mesh.positions.len());
    assert!(mesh.triangles.iter().flatten().all(|&vertex| (vertex as usize) < mesh.positions.len()));
    assert!(mesh.polygon_of_triangle.len() == count && mesh.polygon_of_triangle.is_sorted());
    assert!(mesh.group_of_triangle.len() == count && mesh.material_of_triangle.len() == count);
    assert!(mesh.group_of_triangle.iter().all(|&group| (group as usize) < file.groups.len()));
    assert!(mesh.material_of_triangle.iter().all(|&material| (material as usize) < file.materials.len()));
}

fn corner_set(corners: impl Iterator<Item = [f32; 3]>) -> Vec<[u32; 3]> {
    let mut corners: Vec<[u32; 3]> = corners.map(|corner| corner.map(f32::to_bits)).collect();
    corners.sort_unstable();
    corners.dedup();
    corners
}

#[test]
fn good_files_have_the_polygons_that_tobj_reads() {
    let meshes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/meshes");
    let options = tobj::LoadOptions { single_index: true, ..tobj::LoadOptions::default() };
    let mut polygons = 0;
    for entry in fs::read_dir(&meshes).expect("the shipped meshes are there") {
        let path = entry.expect("the folder can be read").path();
        if path.extension().is_none_or(|extension| extension != "obj") {
            continue;
        }
        let (file, _) = obj::read(&path, &meshes, &AssetFolders::default()).expect("a shipped mesh is good");
        let (models, _) = tobj::load_obj(&path, &options).expect("a shipped mesh is good");
        let mut theirs = Vec::new();
        for mesh in models.iter().map(|model| &model.mesh) {
            let at = |index: u32| [0, 1, 2].map(|axis| mesh.positions[3 * index as usize + axis] as f32);
            // The list of arities is empty when all faces are triangles.
            let all_triangles = vec![3; mesh.indices.len() / 3];
            let arities = if mesh.face_arities.is_empty() { &all_triangles } else { &mesh.face_arities };
            let mut indices = mesh.indices.iter();
            for &arity in arities {
                theirs.push(corner_set(indices.by_ref().take(arity as usize).map(|&index| at(index))));
            }
        }
        let numbered: Vec<(u32, [u32; 3])> =
            file.mesh.polygon_of_triangle.iter().copied().zip(file.mesh.triangles.iter().copied()).collect();
        let ours: Vec<Vec<[u32; 3]>> = numbered
            .chunk_by(|a, b| a.0 == b.0)
            .map(|polygon| {
                let corners = polygon.iter().flat_map(|(_, triangle)| *triangle);
                corner_set(corners.map(|vertex| file.mesh.positions[vertex as usize].to_array()))
            })
            .collect();
        assert!(ours == theirs, "{}: {} polygons, tobj {}", path.display(), ours.len(), theirs.len());
        polygons += ours.len();
    }
    assert!(polygons > 10_000, "{polygons}");
}

#[test]
fn errors_stand_where_they_are() {
    let folder = tempfile::tempdir().unwrap();
    for (line, column) in
        [("f 1 2 9", 7), ("f 1 0 3", 5), ("f 1 2 1.5", 7), ("v 0 nan 0", 5), ("v 0 1.0D0 1", 5), ("v 1 1", 1)]
    {
        let text = format!("\u{feff}{SQUARE}{line}\nf 1 2 3\n");
        assert_eq!(
            first_place(read(folder.path(), text.as_bytes())),
            Some(TextPosition { line: 5, column }),
            "{line}"
        );
    }
}

#[test]
fn faces_do_without_texture_coordinates_and_normals_that_the_file_does_not_have() {
    let folder = tempfile::tempdir().unwrap();
    let plain = read(folder.path(), format!("{SQUARE}f 1 2 3 4\n").as_bytes()).unwrap().0;
    for (face, warned) in [
        ("f 1/1 2/2 3/3 4/4", 1),
        ("f 1//1 2//2 3//3 4//4", 1),
        ("f 1/1/1 2/2/2 3/3/3 4/4/4", 2),
        ("f 1/-1 2 3 4", 1),
    ] {
        let (file, warnings) = read(folder.path(), format!("{SQUARE}{face}\n").as_bytes()).unwrap();
        assert_eq!((&file, warnings.len()), (&plain, warned), "{face}");
        assert_eq!(warnings[0].place, Some(TextPosition { line: 5, column: 3 }), "{face}");
    }
    // When the file has texture coordinates, an index beyond them is an error.
    for face in ["f 1/1 2/2 3/1", "f 1/-2 2/1 3/1"] {
        assert!(read(folder.path(), format!("vt 0 0\n{SQUARE}{face}\n").as_bytes()).is_err(), "{face}");
    }
    let ahead = read(folder.path(), format!("{SQUARE}f 1/-1 2/1 3/1\nvt 0 0\n").as_bytes());
    assert_eq!(first_place(ahead), Some(TextPosition { line: 5, column: 3 }));
}

/// tobj's list of texture coordinates has no entries for corners without any. Entries of later corners must still go to
/// their own corners.
#[test]
fn corners_with_and_without_texture_coordinates_and_normals_go_together() {
    let folder = tempfile::tempdir().unwrap();
    let values = "vt 0.25 0\nvt 0.5 0\nvt 0.75 0\nvn 0 0.6 0.8\n";
    let faces = "f 1 2 3\nf 2/1 3//1 4/2/1\nf 1/3/1 2/2/1 4/1/1\n";
    let (file, _) = read(folder.path(), format!("{SQUARE}{values}{faces}").as_bytes()).unwrap();
    let corners = file.mesh.triangles.iter().flatten().map(|&vertex| vertex as usize);
    let found: Vec<(f32, bool)> =
        corners.map(|vertex| (file.mesh.uvs[vertex].x, file.mesh.normals[vertex].y != 0.0)).collect();
    let uvs = [0.0, 0.0, 0.0, 0.25, 0.0, 0.5, 0.75, 0.5, 0.25];
    let expected: Vec<(f32, bool)> = uvs.into_iter().zip((0..9).map(|corner| corner > 5)).collect();
    assert_eq!(found, expected);
}

#[test]
fn a_concave_polygon_keeps_its_area() {
    let folder = tempfile::tempdir().unwrap();
    let text = "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 2 1 0\nv 0 4 0\nf 1 2 3 4 5\n";
    let (file, _) = read(folder.path(), text.as_bytes()).unwrap();
    let area = |triangle: usize| {
        let [a, b, c] = file.mesh.corners(triangle);
        (b - a).cross(c - a).z / 2.0
    };
    let areas: Vec<f32> = (0..file.mesh.triangles.len()).map(area).collect();
    assert!(areas.iter().all(|&area| area > 0.0), "{areas:?}");
    assert_eq!(areas.iter().sum::<f32>(), 10.0);
}

#[test]
fn nothing_outside_the_folder_is_read() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("secret.mtl"), "newmtl m\nKd 1 0 0\n").unwrap();
    let inner = folder.path().join("inner");
    fs::create_dir(&inner).unwrap();
    let text = format!("mtllib ../secret.mtl\nusemtl m\n{SQUARE}f 1 2 3 4\n");
    let (file, warnings) = read(&inner, text.as_bytes()).unwrap();
    assert_eq!((file.materials[0].color, warnings.len()), ([0.8; 3], 1));
}

#[test]
fn mutations_give_a_sound_mesh_or_a_report() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("m.mtl"), "newmtl a b\nKd 0.5 0.5\n").unwrap();
    let good = format!(
        "mtllib m.mtl\ng a\nusemtl a b\n{SQUARE}vt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1 4/1/1\nf -1 -2 -3\n"
    );
    let swaps: [&[u8]; 8] = [b"nan", b"-9", b"1e38", b"/", b"\\\n", b"\xff", b"99999999999", b"\nf "];
    let mut state = 7_u64;
    let mut next = |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    for case in 0..2000 {
        let mut text = good.clone().into_bytes();
        if case < good.len() {
            text.truncate(case);
        } else {
            for _ in 0..=next(3) {
                let at = next(text.len());
                let end = (at + next(4)).min(text.len());
                text.splice(at..end, swaps[next(swaps.len())].iter().copied());
            }
        }
        match read(folder.path(), &text) {
            Ok((file, _)) => assert_sound(&file),
            Err(report) => assert!(report.0.iter().any(|problem| problem.severity.is_fatal()), "case {case}"),
        }
    }
}
