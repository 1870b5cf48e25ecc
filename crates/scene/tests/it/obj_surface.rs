//! Tests of what a good OBJ file becomes: triangles, normals and groups, whatever its encoding and size.

use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use impasto_scene::assets::AssetFolders;
use impasto_scene::mesh_file::MeshFile;
use impasto_scene::obj;
use impasto_scene::problem::{Problem, TextPosition};

const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

fn read(text: impl AsRef<[u8]>) -> (MeshFile, Vec<Problem>) {
    let folder = tempfile::tempdir().expect("the temporary folder can be used");
    let path = folder.path().join("model.obj");
    fs::write(&path, text).expect("the temporary folder can be used");
    obj::read(&path, folder.path(), &AssetFolders::default()).unwrap_or_else(|report| panic!("{report}"))
}

/// The signed area of each triangle as seen from +Z: negative when it faces away.
fn areas(file: &MeshFile) -> Vec<f64> {
    (0..file.mesh.triangles.len())
        .map(|triangle| {
            let [a, b, c] = file.mesh.corners(triangle).map(|corner| corner.as_dvec3());
            (b - a).cross(c - a).z / 2.0
        })
        .collect()
}

/// The area of a polygon in the XY plane (the shoelace formula).
fn shoelace(points: &[[f64; 2]]) -> f64 {
    let after = points.iter().cycle().skip(1);
    points.iter().zip(after).map(|(a, b)| (a[0] * b[1] - b[0] * a[1]) / 2.0).sum()
}

fn one_polygon(points: &[[f64; 2]]) -> String {
    let mut text = String::new();
    for [x, y] in points {
        let _ = writeln!(text, "v {x} {y} 0");
    }
    text.push('f');
    for corner in 1..=points.len() {
        let _ = write!(text, " {corner}");
    }
    text + "\n"
}

fn star(corners: u32) -> Vec<[f64; 2]> {
    (0..corners)
        .map(|corner| {
            let (sin, cos) = (f64::from(corner) / f64::from(corners) * TAU).sin_cos();
            let radius = if corner % 2 == 0 { 1.0 } else { 0.3 };
            [cos * radius, sin * radius]
        })
        .collect()
}

/// A comb with its teeth up; half of its corners are concave.
fn comb(teeth: u32) -> Vec<[f64; 2]> {
    let mut points = vec![[0.0, -1.0], [f64::from(2 * teeth), -1.0]];
    points.extend((0..=2 * teeth).rev().map(|at| [f64::from(at), if at % 2 == 0 { 0.0 } else { 5.0 }]));
    points
}

fn spiral(corners: u32) -> Vec<[f64; 2]> {
    let arm = |at: u32, wider: f64| {
        let angle = f64::from(at) * 0.1;
        [(angle + wider) * angle.cos(), (angle + wider) * angle.sin()]
    };
    let outer = (1..corners).map(|at| arm(at, 2.0));
    outer.chain((1..corners).rev().map(|at| arm(at, 0.0))).collect()
}

#[test]
fn concave_polygons_are_covered_once() {
    for (name, points) in
        [("star", star(24)), ("large star", star(10_000)), ("comb", comb(200)), ("spiral", spiral(300))]
    {
        let (file, _) = read(one_polygon(&points));
        let areas = areas(&file);
        assert_eq!(file.mesh.polygon_count(), 1, "{name}");
        assert!(areas.iter().all(|&area| area > 0.0), "{name}: a triangle is turned over");
        let expected = shoelace(&points);
        let sum: f64 = areas.iter().sum();
        assert!((sum / expected - 1.0).abs() < 1e-4, "{name}: {sum} of {expected}");
    }
}

#[test]
fn large_files_with_much_of_one_thing_are_read() {
    let mut switching = SQUARE.to_owned();
    let mut libraries = SQUARE.to_owned() + "f 1 2 3\n";
    for line in 0..100_000 {
        let _ = writeln!(switching, "v {line} 0 0\nv {line} 1 0\nv {line} 0 1");
        let _ = writeln!(switching, "usemtl m{}\ng part{}\nf -3 -2 -1", line % 2, line % 7);
        let _ = writeln!(libraries, "mtllib missing{line}.mtl");
    }
    let mut stars = String::new();
    for z in 0..31 {
        for [x, y] in star(10_000) {
            let _ = writeln!(stars, "v {x} {y} {z}");
        }
        let corners: Vec<String> = (1..=10_000).rev().map(|back| format!("-{back}")).collect();
        let _ = writeln!(stars, "f {}", corners.join(" "));
    }
    // Work that is quadratic in the lines would take hours.
    for (name, text, triangles) in
        [("switching", switching, 100_000), ("libraries", libraries, 1), ("stars", stars, 31 * 9998)]
    {
        assert_eq!(read(text).0.mesh.triangles.len(), triangles, "{name}");
    }
}

#[test]
fn creases_stay_and_low_polygon_curves_are_smooth() {
    let roof = |height: f64| {
        read(format!(
            "v -1 0 0\nv 0 {height} 0\nv 1 0 0\nv -1 0 -1\nv 0 {height} -1\nv 1 0 -1\nf 1 2 5 4\nf 2 3 6 5\n"
        ))
        .0
    };
    // With 6 vertices, both sides share the two of the ridge; with 8, each side has its own.
    assert_eq!(roof((20_f64).to_radians().tan()).mesh.positions.len(), 6);
    assert_eq!(roof((30_f64).to_radians().tan()).mesh.positions.len(), 8);
}

#[test]
fn the_files_normals_are_used_but_for_bad_ones() {
    let face = "f 1//1 2//1 3//1 4//1\n";
    let (file, warnings) = read(format!("{SQUARE}vn 0 3 4\n{face}"));
    assert!(
        file.mesh.normals.iter().all(|normal| (normal.y - 0.6).abs() < 1e-6 && (normal.z - 0.8).abs() < 1e-6)
    );
    assert!(warnings.is_empty());
    for bad in ["vn 0 0 0", "vn nan 0 1", "vn 0 1", "vn 0 0 1e400"] {
        let (file, warnings) = read(format!("{SQUARE}{bad}\n{face}"));
        assert!(file.mesh.normals.iter().all(|normal| normal.z == 1.0), "{bad}");
        assert_eq!(warnings.len(), 1, "{bad}");
    }
}

#[test]
fn groups_and_materials_go_with_their_faces() {
    let text = format!(
        "{SQUARE}f 1 2 3\no body\nf 1 2 3\ng left arm\nusemtl red #2\nf 1 2 3 4\ng  left\tarm \nf 2 3 4\ng\nf 2 3 4\n"
    );
    let (file, _) = read(text);
    assert_eq!(file.groups, ["default", "body", "left arm"]);
    assert_eq!(file.mesh.group_of_triangle, [0, 1, 2, 2, 2, 1]);
    assert_eq!(file.mesh.polygon_of_triangle, [0, 1, 2, 2, 3, 4]);
    let names: Vec<&str> = file.materials.iter().map(|material| material.name.as_str()).collect();
    assert_eq!(names, ["", "red #2"]);
    assert_eq!(file.mesh.material_of_triangle, [0, 0, 1, 1, 1, 1]);
}

#[test]
fn encodings_and_line_ends_make_no_difference() {
    let text = format!("{SQUARE}g caf\u{e9}\nf 1 2 3 4\n");
    let (plain, _) = read(&text);
    let wide = |to_bytes: fn(u16) -> [u8; 2], mark: [u8; 2]| -> Vec<u8> {
        mark.into_iter().chain(text.encode_utf16().flat_map(to_bytes)).collect()
    };
    let variants: [(&str, Vec<u8>); 6] = [
        ("mark", format!("\u{feff}{text}").into()),
        ("CRLF", text.replace('\n', "\r\n").into()),
        ("CR", text.replace('\n', "\r").into()),
        ("tabs and joints", text.replace("v 0 ", "v\t0 \\\n").into()),
        ("UTF-16 LE", wide(u16::to_le_bytes, [0xff, 0xfe])),
        ("UTF-16 BE", wide(u16::to_be_bytes, [0xfe, 0xff])),
    ];
    for (name, bytes) in variants {
        assert_eq!(read(bytes).0, plain, "{name}");
    }
    let latin1: Vec<u8> = text.chars().map(|letter| letter as u8).collect();
    assert_eq!(read(latin1).0.mesh, plain.mesh);
}

#[test]
fn a_last_line_without_an_end_is_kept_where_it_can_be_whole() {
    for (last, triangles) in [("f 2 3 4", 3), ("f 2 3", 2), ("f 2 3 -", 2), ("v 1 2", 2), ("v 1 2 -", 2)] {
        let (file, warnings) = read(format!("{SQUARE}f 1 2 3 4\n{last}"));
        assert_eq!((file.mesh.triangles.len(), warnings.len()), (triangles, 1), "{last}");
    }
}

/// Reads a square with this MTL file beside it. Returns the mesh file and the number of warnings.
fn materials(folder: &Path, mtl: &[u8]) -> (MeshFile, usize) {
    for name in ["my library.mtl", "model.obj"] {
        fs::remove_file(folder.join(name)).ok();
    }
    fs::write(folder.join("my library.mtl"), mtl).expect("the temporary folder can be used");
    let path = folder.join("model.obj");
    fs::write(&path, format!("mtllib my library.mtl\nusemtl red paint\n{SQUARE}f 1 2 3 4\n"))
        .expect("the temporary folder can be used");
    let (file, warnings) = obj::read(&path, folder, &AssetFolders::default()).expect("the model is good");
    (file, warnings.len())
}

#[test]
fn colours_are_read_and_bad_ones_are_grey() {
    let folder = tempfile::tempdir().unwrap();
    for (lines, color, warned) in [
        ("Kd 1 0.5 0", [1.0, 0.5, 0.0], 0),
        ("Kd 1 0.5 0 1", [1.0, 0.5, 0.0], 0),
        ("Kd 0.5", [0.5; 3], 0),
        ("Kd 2 -1 0", [1.0, 0.0, 0.0], 1),
        ("Kd 0.1 0.2", [0.8; 3], 1),
        ("Kd inf 0 0", [0.8; 3], 1),
        ("Kd spectral file.rfl 1", [0.8; 3], 1),
        ("d 0\nKd 0 1 0", [0.0, 1.0, 0.0], 1),
        ("map_Kd -o 1 2 3 -s 1 1 -clamp on no such.png", [0.8; 3], 1),
        ("map_Kd -bm", [0.8; 3], 1),
        ("", [0.8; 3], 0),
    ] {
        let (file, warnings) = materials(folder.path(), format!("newmtl red  paint\n{lines}\n").as_bytes());
        assert_eq!((file.materials[0].color, warnings), (color, warned), "{lines}");
    }
}

#[test]
fn a_picture_is_found_behind_its_options() {
    let folder = tempfile::tempdir().unwrap();
    let picture = image::RgbaImage::from_pixel(3, 2, image::Rgba([10, 20, 30, 255]));
    picture.save(folder.path().join("red paint #1.png")).unwrap();
    let (file, warnings) =
        materials(folder.path(), b"newmtl red paint\nmap_Kd -o 0.5 -mm 0 1 red paint #1.png\n");
    let texture = file.materials[0].texture.as_ref().unwrap();
    assert_eq!((texture.size_px, texture.rgba8[0], warnings), ([3, 2], [10, 20, 30, 255], 0));
    assert_eq!(file.materials[0].color, [1.0; 3]);
}

#[test]
fn a_missing_picture_is_located_in_its_mtl_file() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("m.mtl"), "newmtl a\r\n# caf\u{e9}\r\n  map_Kd none.png\r\n").unwrap();
    let path = folder.path().join("model.obj");
    fs::write(&path, format!("mtllib m.mtl\nusemtl a\n{SQUARE}f 1 2 3\n")).unwrap();
    let (_, warnings) = obj::read(&path, folder.path(), &AssetFolders::default()).unwrap();
    assert_eq!(warnings.len(), 1);
    assert!(warnings[0].path.ends_with("m.mtl"));
    assert_eq!(warnings[0].place, Some(TextPosition { line: 3, column: 3 }));
}

#[test]
fn random_bytes_of_materials_never_stop_a_model() {
    let folder = tempfile::tempdir().unwrap();
    let words: [&[u8]; 10] =
        [b"newmtl ", b"red paint", b"Kd ", b"0.5 ", b"nan ", b"map_Kd ", b"\n", b"\xff", b"-o ", b"Tr 1\n"];
    let mut state = 11_u64;
    let mut next = |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    for _ in 0..1000 {
        let mtl: Vec<u8> = (0..next(20)).flat_map(|_| words[next(words.len())].to_vec()).collect();
        let (file, _) = materials(folder.path(), &mtl);
        assert!(file.materials[0].color.iter().all(|channel| (0.0..=1.0).contains(channel)));
    }
}
