//! A corpus of real and hostile files, where `IMPASTO_CORPUS` names one: every file is checked by the real command, with
//! little memory and little time, against what its list expects.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use impasto_scene::assets::AssetFolders;
use impasto_scene::mesh_file::MeshFile;
use impasto_scene::obj;
use impasto_tests::command::impasto;

/// Address space and time for one file.
const MEMORY_KIB: u32 = 1 << 20;
const SECONDS: u32 = 10;

fn corpus() -> Option<PathBuf> {
    let folder = std::env::var_os("IMPASTO_CORPUS").map(PathBuf::from);
    if folder.is_none() {
        eprintln!("not run: IMPASTO_CORPUS names no folder");
    }
    folder
}

/// `impasto check FILE` with limits; 124 when it took too long.
fn check(file: &Path) -> Output {
    let script = format!("ulimit -v {MEMORY_KIB} && exec timeout {SECONDS} \"$0\" check \"$1\"");
    Command::new("sh").arg("-c").arg(script).arg(impasto()).arg(file).output().expect("sh runs")
}

/// Rows of a CSV file with a header, as (header, value) look-ups; quoted fields may hold commas and doubled quotes.
fn rows(path: &Path) -> Vec<impl Fn(&str) -> String + use<>> {
    let text = std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let mut lines = text.lines().map(fields);
    let header = lines.next().expect("a header");
    lines
        .map(|row| {
            let header = header.clone();
            move |name: &str| {
                let column = header
                    .iter()
                    .position(|field| field == name)
                    .unwrap_or_else(|| panic!("no column {name}"));
                row[column].clone()
            }
        })
        .collect()
}

fn fields(line: &str) -> Vec<String> {
    let (mut fields, mut field, mut quoted) = (Vec::new(), String::new(), false);
    let mut rest = line.chars().peekable();
    while let Some(character) = rest.next() {
        match character {
            '"' if quoted && rest.peek() == Some(&'"') => field.extend(rest.next()),
            '"' => quoted = !quoted,
            ',' if !quoted => fields.push(std::mem::take(&mut field)),
            _ => field.push(character),
        }
    }
    fields.push(field);
    fields
}

#[test]
fn hostile_files_end_as_their_list_says() {
    let Some(corpus) = corpus() else { return };
    let (mut failures, mut count) = (Vec::new(), 0);
    for row in rows(&corpus.join("hostile.csv")) {
        if !["obj", "mtl", "tex", "ron"].contains(&row("kind").as_str()) {
            continue;
        }
        count += 1;
        let output = check(&corpus.join(row("file")));
        let said = String::from_utf8_lossy(&output.stderr);
        let code = output.status.code();
        let as_expected = match row("expect").as_str() {
            "OK" => code == Some(0),
            "WARN" => code == Some(0) && said.contains(": warning: "),
            "REJECT" => code == Some(3) && said.contains(": error: "),
            "LIMIT" => code == Some(3) && said.contains(": limit: "),
            other => panic!("the list expects {other:?}"),
        };
        if !as_expected {
            failures.push(format!("{} expects {}, got {code:?}: {said}", row("id"), row("expect")));
        }
    }
    assert!(count > 50, "{count} rows");
    assert!(failures.is_empty(), "{} of {count}:\n{}", failures.len(), failures.join("\n"));
}

#[test]
fn real_models_are_read_or_refused_with_a_reason() {
    let Some(corpus) = corpus() else { return };
    let (mut failures, mut count) = (Vec::new(), 0);
    for row in rows(&corpus.join("models.csv")) {
        let file = corpus.join(row("file"));
        // Some models of the list may not be passed on, and so are not there.
        if file.extension().is_none_or(|extension| extension != "obj") || !file.exists() {
            continue;
        }
        count += 1;
        let output = check(&file);
        let said = String::from_utf8_lossy(&output.stderr);
        let fine = match (row("verdict").as_str(), output.status.code()) {
            ("good", code) => code == Some(0),
            (_, Some(0)) => row("verdict") == "odd" || said.contains(": warning: "),
            (_, Some(3)) => said.contains(": error: "),
            _ => false,
        };
        if !fine {
            failures.push(format!(
                "{} ({}): {:?}: {said}",
                row("name"),
                row("verdict"),
                output.status.code()
            ));
        }
    }
    assert!(count > 30, "{count} models");
    assert!(failures.is_empty(), "{} of {count}:\n{}", failures.len(), failures.join("\n"));
}

#[test]
fn fuzzed_files_neither_crash_nor_hang() {
    let Some(corpus) = corpus() else { return };
    let scratch = tempfile::tempdir().unwrap();
    let mut count = 0;
    for kind in ["obj", "mtl"] {
        let folder = corpus.join("models/fuzz-ufbx").join(kind);
        let mut files: Vec<PathBuf> =
            std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().path()).collect();
        files.sort();
        for file in files {
            let mesh = scratch.path().join("case.obj");
            if kind == "obj" {
                std::fs::copy(&file, &mesh).unwrap();
            } else {
                std::fs::copy(&file, scratch.path().join("case.mtl")).unwrap();
                std::fs::write(&mesh, "mtllib case.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n")
                    .unwrap();
            }
            let code = check(&mesh).status.code();
            assert!(matches!(code, Some(0 | 3)), "{}: exit code {code:?}", file.display());
            count += 1;
        }
    }
    assert!(count > 50, "{count} files");
}

/// Pictures are wrapped in a triangle that wears them: a good one is taken, a bad one is left out with a warning.
#[test]
fn real_pictures_are_worn_or_left_out() {
    let Some(corpus) = corpus() else { return };
    let scratch = tempfile::tempdir().unwrap();
    let mesh = scratch.path().join("case.obj");
    std::fs::write(&mesh, "mtllib case.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n").unwrap();
    std::fs::write(scratch.path().join("case.mtl"), "newmtl a\nmap_Kd picture.png\n").unwrap();
    let mut count = 0;
    for row in rows(&corpus.join("models.csv")) {
        if row("class") != "tex" {
            continue;
        }
        count += 1;
        let picture = std::fs::read(corpus.join(row("file"))).unwrap();
        std::fs::write(scratch.path().join("picture.png"), picture).unwrap();
        let output = check(&mesh);
        let said = String::from_utf8_lossy(&output.stderr);
        let is_bad = row("verdict") == "bad";
        assert!(
            output.status.success() && (!is_bad || said.contains(": warning: ")),
            "{}: {said}",
            row("name")
        );
        let (file, _) = obj::read(&mesh, scratch.path(), &AssetFolders::default()).unwrap();
        assert_eq!(file.materials[0].texture.is_none(), is_bad, "{}", row("name"));
    }
    assert!(count > 0, "no picture");
}

/// Whatever mesh is taken keeps every promise of the type.
#[test]
fn meshes_that_are_read_are_sound() {
    let Some(corpus) = corpus() else { return };
    let mut count = 0;
    let lists = ["hostile.csv", "models.csv"].map(|list| rows(&corpus.join(list)));
    let files = lists.iter().flatten().map(|row| corpus.join(row("file")));
    for path in files.filter(|file| file.extension().is_some_and(|extension| extension == "obj")) {
        let folder = path.parent().unwrap();
        if let Ok((file, _)) = obj::read(&path, folder, &AssetFolders::default()) {
            count += 1;
            assert_sound(&file, &path);
        }
    }
    assert!(count > 50, "{count} meshes");
}

fn assert_sound(file: &MeshFile, path: &Path) {
    let mesh = &file.mesh;
    let (vertices, triangles) = (mesh.positions.len(), mesh.triangles.len());
    let path = path.display();
    assert!(triangles > 0, "{path}");
    assert!(mesh.positions.iter().all(|at| at.is_finite()), "{path}");
    assert_eq!(mesh.normals.len(), vertices, "{path}");
    assert!(mesh.normals.iter().all(|normal| (normal.length() - 1.0).abs() < 1e-3), "{path}");
    assert!(mesh.uvs.is_empty() || mesh.uvs.len() == vertices, "{path}");
    assert!(mesh.uvs.iter().all(|uv| uv.is_finite()), "{path}");
    assert!(mesh.triangles.iter().flatten().all(|&vertex| (vertex as usize) < vertices), "{path}");
    assert!(mesh.polygon_of_triangle.len() == triangles && mesh.polygon_of_triangle.is_sorted(), "{path}");
    let is_below = |numbers: &[u32], end: usize| {
        numbers.len() == triangles && numbers.iter().all(|&number| (number as usize) < end)
    };
    assert!(is_below(&mesh.group_of_triangle, file.groups.len()), "{path}");
    assert!(is_below(&mesh.material_of_triangle, file.materials.len()), "{path}");
    let area: f32 = (0..triangles)
        .map(|triangle| {
            let [a, b, c] = mesh.corners(triangle);
            (b - a).cross(c - a).length() / 2.0
        })
        .sum();
    assert!(area.is_finite() && area > 0.0, "{path}: area {area}");
    let mut channels = file.materials.iter().flat_map(|material| material.color);
    assert!(channels.all(|channel| (0.0..=1.0).contains(&channel)), "{path}");
}
