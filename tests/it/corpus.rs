//! The corpus of hostile and real files, where `IMPASTO_CORPUS` names its folder: every OBJ, MTL, picture and RON case in a
//! child process with 1 GiB of memory and 10 seconds, against what its list expects.
//!
//! The child is this test binary again, running [`one_case`] alone: exit code 10 is a sound mesh, 11 one with warnings, 3 a report with
//! an error, 4 one with a limit; anything else (a panic, a signal, a time-out) is a failure.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use impasto_scene::assets::AssetFolders;
use impasto_scene::load::{self, LoadOptions};
use impasto_scene::mesh_file::MeshFile;
use impasto_scene::obj;
use impasto_scene::problem::{Problem, Report, Severity};

const CASE: &str = "IMPASTO_CORPUS_CASE";
const MEMORY_KIB: u32 = 1 << 20;
const TIME: Duration = Duration::from_secs(10);

/// What a child said of its file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Outcome {
    Fine,
    Warned,
    Error,
    Limit,
}

/// The corpus folder, or a line that says why nothing is tested.
fn corpus() -> Option<PathBuf> {
    let folder = std::env::var_os("IMPASTO_CORPUS").map(PathBuf::from);
    if folder.is_none() {
        eprintln!("skipped: IMPASTO_CORPUS does not name the corpus folder");
    }
    folder
}

/// The rows of a CSV text as lists of cells; quotes keep commas and line ends.
fn rows(text: &str) -> Vec<Vec<String>> {
    let mut rows = vec![vec![String::new()]];
    let mut is_quoted = false;
    for letter in text.chars() {
        let row = rows.last_mut().expect("there is always a row and a cell");
        match letter {
            '"' => is_quoted = !is_quoted,
            ',' if !is_quoted => row.push(String::new()),
            '\n' if !is_quoted => rows.push(vec![String::new()]),
            '\r' if !is_quoted => {}
            other => row.last_mut().expect("there is always a row and a cell").push(other),
        }
    }
    rows
}

/// The cells of the named columns, row by row.
fn columns<const N: usize>(file: &Path, names: [&str; N]) -> Vec<[String; N]> {
    let rows = rows(&fs::read_to_string(file).expect("the list can be read"));
    let places =
        names.map(|name| rows[0].iter().position(|cell| cell == name).expect("the list has the column"));
    let last = places.into_iter().max().expect("a column is asked for");
    rows[1..].iter().filter(|row| row.len() > last).map(|row| places.map(|at| row[at].clone())).collect()
}

/// Reads one file in a child; an `Err` says how the child failed.
fn outcome(file: &Path) -> Result<Outcome, String> {
    let mut child = Command::new("sh")
        .args(["-c", "ulimit -v \"$1\"; shift; exec \"$@\"", "sh", &MEMORY_KIB.to_string()])
        .arg(std::env::current_exe().expect("a child can be run"))
        .args(["--exact", "corpus::one_case", "--ignored", "--nocapture", "--test-threads=1"])
        .env(CASE, file)
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("a child can be run");
    let start = Instant::now();
    loop {
        if let Some(status) = child.try_wait().expect("a child can be run") {
            return match status.code() {
                Some(10) => Ok(Outcome::Fine),
                Some(11) => Ok(Outcome::Warned),
                Some(3) => Ok(Outcome::Error),
                Some(4) => Ok(Outcome::Limit),
                _ => Err(format!("ended with {status}")),
            };
        }
        if start.elapsed() > TIME {
            child.kill().expect("a child can be run");
            child.wait().expect("a child can be run");
            return Err(format!("took over {TIME:?}"));
        }
        std::thread::sleep(Duration::from_millis(2));
    }
}

fn is_usable(outcome: &Result<Outcome, String>) -> bool {
    matches!(outcome, Ok(Outcome::Fine | Outcome::Warned))
}

/// Everything that a mesh file promises.
fn assert_sound(file: &MeshFile) {
    let mesh = &file.mesh;
    let vertices = mesh.positions.len();
    let triangles = mesh.triangles.len();
    assert!(triangles > 0);
    assert!(mesh.positions.iter().all(|at| at.is_finite()));
    assert!(mesh.normals.len() == vertices && mesh.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-3));
    assert!(mesh.uvs.is_empty() || mesh.uvs.len() == vertices);
    assert!(mesh.uvs.iter().all(|uv| uv.is_finite()));
    assert!(mesh.triangles.iter().flatten().all(|&vertex| (vertex as usize) < vertices));
    assert!(mesh.polygon_of_triangle.len() == triangles && mesh.polygon_of_triangle.is_sorted());
    assert!(mesh.group_of_triangle.len() == triangles && mesh.material_of_triangle.len() == triangles);
    assert!(mesh.group_of_triangle.iter().all(|&group| (group as usize) < file.groups.len()));
    assert!(mesh.material_of_triangle.iter().all(|&number| (number as usize) < file.materials.len()));
    let area: f64 = (0..triangles)
        .map(|triangle| {
            let [a, b, c] = mesh.corners(triangle).map(|at| at.as_dvec3());
            (b - a).cross(c - a).length() / 2.0
        })
        .sum();
    assert!(area.is_finite() && area as f32 > 0.0, "total area {area}");
    assert!(file.materials.iter().flat_map(|material| material.color).all(|c| (0.0..=1.0).contains(&c)));
}

/// Reads a scene with everything that it names, or a mesh, which has to be sound.
fn warnings_of(path: &Path) -> Result<Vec<Problem>, Report> {
    if path.extension().is_some_and(|extension| extension == "ron") {
        return load::load(path, &LoadOptions::default()).map(|loaded| loaded.warnings);
    }
    let (file, warnings) =
        obj::read(path, path.parent().expect("a file lies in a folder"), &AssetFolders::default())?;
    assert_sound(&file);
    // What is a sound mesh is a scene, too.
    if path.extension().is_some_and(|extension| extension == "obj") {
        load::load(path, &LoadOptions::default())?;
    }
    Ok(warnings)
}

#[test]
#[ignore = "the child of the other tests here: reads the file that IMPASTO_CORPUS_CASE names"]
fn one_case() {
    let Some(path) = std::env::var_os(CASE).map(PathBuf::from) else { return };
    let code = match warnings_of(&path) {
        Ok(warnings) => {
            for warning in &warnings {
                eprintln!("{warning}");
            }
            if warnings.is_empty() { 10 } else { 11 }
        }
        Err(report) => {
            eprintln!("{report}");
            let worst = report.0.iter().map(|problem| problem.severity).max();
            match worst.expect("a report has a problem") {
                Severity::Limit => 4,
                Severity::Error => 3,
                Severity::Warning => panic!("a report of warnings only"),
            }
        }
    };
    std::process::exit(code);
}

#[test]
fn hostile_files_end_as_the_list_expects() {
    let Some(corpus) = corpus() else { return };
    let mut faults = String::new();
    let mut count = 0;
    for [id, file, kind, expect] in columns(&corpus.join("hostile.csv"), ["id", "file", "kind", "expect"]) {
        if !["obj", "mtl", "tex", "ron"].contains(&kind.as_str()) {
            continue;
        }
        count += 1;
        let outcome = outcome(&corpus.join(file));
        let is_met = match expect.as_str() {
            "OK" => is_usable(&outcome),
            "WARN" => outcome == Ok(Outcome::Warned),
            "REJECT" => outcome == Ok(Outcome::Error),
            "LIMIT" => outcome == Ok(Outcome::Limit),
            other => panic!("{id}: {other:?} is no expectation"),
        };
        if !is_met {
            let _ = writeln!(faults, "{id}: {expect} expected, {outcome:?}");
        }
    }
    assert!(count > 0, "the list has no case");
    assert!(faults.is_empty(), "{faults}");
}

/// Odd models that are refused: two without any face, one whose faces have no area, one with numbers such as `3.1+e2`.
const REFUSED_ODD: [&str; 4] = ["as_pointcloud", "mg_negative", "uf_obj_zoo", "as_numbers"];

#[test]
fn real_models_and_pictures_end_as_the_list_expects() {
    let Some(corpus) = corpus() else { return };
    let mut faults = String::new();
    let (mut count, mut absent) = (0, Vec::new());
    for [name, class, file, verdict] in
        columns(&corpus.join("models.csv"), ["name", "class", "file", "verdict"])
    {
        let path = corpus.join(&file);
        let is_picture = class == "tex";
        if !(is_picture || ["good", "odd"].contains(&class.as_str())) || file.ends_with(".mtl") {
            continue;
        }
        if !path.exists() {
            absent.push(name);
            continue;
        }
        count += 1;
        let outcome = if is_picture { outcome_with_picture(&path) } else { outcome(&path) };
        let is_met = match verdict.as_str() {
            "bad" if is_picture => outcome == Ok(Outcome::Warned),
            "bad" => outcome == Ok(Outcome::Error),
            _ if REFUSED_ODD.contains(&name.as_str()) => outcome == Ok(Outcome::Error),
            _ => is_usable(&outcome),
        };
        if !is_met {
            let _ = writeln!(faults, "{name}: {verdict}, but {outcome:?}");
        }
    }
    eprintln!("{count} tested; listed, but not there: {absent:?}");
    assert!(count > 0, "the list has no model");
    assert!(faults.is_empty(), "{faults}");
}

/// Reads a triangle with this picture on it.
fn outcome_with_picture(picture: &Path) -> Result<Outcome, String> {
    let folder = tempfile::tempdir().expect("the temporary folder can be used");
    fs::copy(picture, folder.path().join("picture.png")).expect("the temporary folder can be used");
    fs::write(folder.path().join("case.mtl"), "newmtl m\nmap_Kd picture.png\n")
        .expect("the temporary folder can be used");
    outcome(&triangle_with(folder.path()))
}

/// A triangle whose material is `m` of `case.mtl` in the same folder.
fn triangle_with(folder: &Path) -> PathBuf {
    let model = folder.join("case.obj");
    fs::write(&model, "mtllib case.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        .expect("the temporary folder can be used");
    model
}

#[test]
fn fuzzed_files_neither_crash_nor_hang() {
    let Some(corpus) = corpus() else { return };
    let folder = tempfile::tempdir().unwrap();
    let mut faults = String::new();
    let mut count = 0;
    for kind in ["obj", "mtl"] {
        for entry in fs::read_dir(corpus.join("models/fuzz-ufbx").join(kind)).unwrap() {
            let path = entry.unwrap().path();
            count += 1;
            let outcome = if kind == "obj" {
                outcome(&path)
            } else {
                fs::copy(&path, folder.path().join("case.mtl")).unwrap();
                outcome(&triangle_with(folder.path()))
            };
            if let Err(why) = outcome {
                let _ = writeln!(faults, "{}: {why}", path.display());
            }
        }
    }
    assert!(count > 0, "there is no fuzzed file");
    assert!(faults.is_empty(), "{faults}");
}
