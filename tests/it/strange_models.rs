//! Tests of odd OBJ files such as users bring: which warnings they cause, and what is read.

use glam::Vec3;
use impasto_scene::assets::AssetFolders;
use impasto_scene::mesh_file::MeshFile;
use impasto_scene::obj;
use impasto_scene::problem::Problem;

const QUAD: &str = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n";

/// Reads a text as `model.obj`, beside a `model.mtl`.
fn read(text: &str, materials: &str) -> (MeshFile, Vec<Problem>) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("model.obj");
    std::fs::write(&path, text).unwrap();
    std::fs::write(folder.path().join("model.mtl"), materials).unwrap();
    obj::read(&path, folder.path(), &AssetFolders::default()).unwrap_or_else(|report| panic!("{report}"))
}

/// Reads a text that must cause exactly one warning, with these words in it.
fn read_with_one_warning(text: &str, materials: &str, says: &str) -> MeshFile {
    let (mesh, warnings) = read(text, materials);
    assert!(warnings.len() == 1 && warnings[0].to_string().contains(says), "{warnings:?}");
    mesh
}

#[test]
fn normals_that_run_along_their_faces_are_made_anew() {
    let text = format!("{QUAD}vn 1 0 0\nvn 0 1 0.05\nf 1//1 2//2 3//1 4//2\n");
    let mesh = read_with_one_warning(&text, "", ":7:1: warning: the normals of this face run along it");
    assert!(
        mesh.mesh.normals.iter().all(|normal| normal.abs_diff_eq(Vec3::Z, 1e-6)),
        "{:?}",
        mesh.mesh.normals
    );
    // A single sliver beside a large face keeps such normals, since smoothing often gives them to slivers.
    let sliver = "v 1 0 0\nv 1 0.001 0\nv 1 0 0.001\nvn 0 0 1\n";
    let text = format!("{QUAD}{sliver}f 1//1 2//1 3//1 4//1\nf 5//1 6//1 7//1\n");
    let (mesh, warnings) = read(&text, "");
    assert!(warnings.is_empty() && mesh.mesh.normals.iter().all(|normal| *normal == Vec3::Z));
    // Normals that lean far over, as on a chamfer, are kept.
    let (mesh, warnings) = read(&format!("{QUAD}vn 0.9 0 0.44\nf 1//1 2//1 3//1 4//1\n"), "");
    assert!(warnings.is_empty() && mesh.mesh.normals.iter().all(|normal| normal.x > 0.8));
}

#[test]
fn lines_that_obj_does_not_know_are_told_in_the_right_number() {
    let one = format!("{QUAD}f 1 2 3 4\nfoo 1\n");
    read_with_one_warning(
        &one,
        "",
        ":6:1: warning: this line begins with a word that OBJ does not know (\"foo\")",
    );
    let two = format!("{QUAD}f 1 2 3 4\nfoo 1\nbar\n");
    read_with_one_warning(
        &two,
        "",
        ":6:1: warning: 2 lines begin with words that OBJ does not know (\"bar\", \"foo\")",
    );
}

#[test]
fn faces_that_lie_on_each_other_are_read_once_where_they_are_many() {
    let times = |count: usize| format!("{QUAD}{}", "f 1 2 3\nf 3 4 1\nf 2 3 1\n".repeat(count));
    let mesh =
        read_with_one_warning(&times(40), "", "lies on another one with the same corners (118 such faces)");
    assert_eq!(mesh.mesh.triangles.len(), 2);
    // A face and its back, as in double-sided models, are both kept, and so are a few doubled faces.
    let (mesh, warnings) = read(&format!("{QUAD}f 1 2 3 4\nf 4 3 2 1\nf 1 2 3 4\n"), "");
    assert!(warnings.is_empty() && mesh.mesh.triangles.len() == 6);
    let both = format!("{QUAD}{}", "f 1 2 3\nf 3 2 1\n".repeat(60));
    assert_eq!(read(&both, "").0.mesh.triangles.len(), 2);
}

#[test]
fn a_last_face_without_a_line_end_is_read_where_all_corners_end_in_a_slash() {
    let (mesh, warnings) = read(&format!("{QUAD}vt 0 0\nf 1/1/ 2/1/ 3/1/\nf 1/1/ 3/1/ 4/1/"), "");
    assert!(warnings.is_empty() && mesh.mesh.triangles.len() == 2, "{warnings:?}");
    let cut = format!("{QUAD}vt 0 0\nvn 0 0 1\nf 1/1/1 2/1/1 3/1/1\nf 1/1/1 3/1/1 4/1/");
    assert_eq!(read_with_one_warning(&cut, "", "seems cut short").mesh.triangles.len(), 1);
}

#[test]
fn colours_that_are_no_numbers_are_no_places() {
    let text = QUAD.replace("1 1 0\n", "1 1 0 nan 0.5 inf\n");
    let mesh = read_with_one_warning(
        &format!("{text}f 1 2 3 4\n"),
        "",
        "colour or weight that is not made of finite",
    );
    assert_eq!(mesh.mesh.triangles.len(), 2);
}

#[test]
fn a_material_that_is_described_twice_keeps_its_first_colour() {
    let text = format!("mtllib model.mtl\n{QUAD}usemtl a\nf 1 2 3 4\n");
    let materials = "newmtl a\nKd 1 0 0\nnewmtl a\nKd 0 1 0\n";
    let mesh = read_with_one_warning(
        &text,
        materials,
        "model.mtl:3:1: warning: the material \"a\" is described already",
    );
    assert_eq!(mesh.materials[0].color, [1.0, 0.0, 0.0]);
}

#[test]
fn names_neither_steer_a_terminal_nor_fill_it() {
    let long = "x".repeat(10_000_000);
    for name in ["\u{1b}[31mred\u{7}", long.as_str()] {
        let (_, warnings) = read(&format!("{QUAD}usemtl {name}\nf 1 2 3 4\n"), "");
        let shown = warnings[0].to_string();
        assert!(shown.contains("no file describes the material") && shown.len() < 600, "{}", shown.len());
        assert!(!shown.contains(|letter: char| letter.is_control()));
    }
}
