//! Tests that a kill at any moment leaves a file as it was or wholly new, never half written. `IMPASTO_KILLS` says how
//! often each command is killed.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use impasto_tests::command::impasto;

const SCENE: &str = r#"#![enable(implicit_some)]
(
    version: 1,
    size: (160, 90),
    timeline: (fps: 24, first: 0, last: 3),
    camera: (keys: [(frame: 0, eye: (0, 0, 4), target: (0, 0, 0)), (frame: 3, eye: (0, 0, 4), target: (0, 0, 0), roll_deg: 30)]),
    objects: [(name: "sphere", mesh: "sphere.obj")],
    strokes: (scale: 1.0),
)
"#;

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("scene.ron"), SCENE).unwrap();
    std::fs::write(folder.path().join("sphere.obj"), sphere()).unwrap();
    folder
}

/// An OBJ file of a sphere of 24 by 12 faces.
fn sphere() -> String {
    use std::fmt::Write as _;
    let (around, down) = (24, 12);
    let mut text = String::new();
    for row in 0..=down {
        for column in 0..around {
            let (u, v) = (
                f64::from(column) / f64::from(around) * std::f64::consts::TAU,
                f64::from(row) / f64::from(down) * std::f64::consts::PI,
            );
            writeln!(text, "v {} {} {}", v.sin() * u.sin(), v.cos(), v.sin() * u.cos()).unwrap();
        }
    }
    for row in 0..down {
        for column in 0..around {
            let next = (column + 1) % around;
            let at = |row: i32, column: i32| row * around + column + 1;
            let corners = [at(row, column), at(row + 1, column), at(row + 1, next), at(row, next)]
                .map(|index| index.to_string());
            writeln!(text, "f {}", corners.join(" ")).unwrap();
        }
    }
    text
}

fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(impasto());
    command
        .current_dir(folder)
        .args(arguments)
        .env("IMPASTO_CACHE", "")
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    command
}

/// Runs the command to its end. Returns how long it took.
fn run(folder: &Path, arguments: &[&str]) -> Duration {
    let start = Instant::now();
    assert!(command(folder, arguments).status().unwrap().success(), "{arguments:?}");
    start.elapsed()
}

/// How often each command is killed.
fn kills() -> u32 {
    std::env::var("IMPASTO_KILLS").ok().and_then(|text| text.parse().ok()).unwrap_or(8)
}

/// Starts and kills the command [`kills`] times, at moments spread over `takes`, the time of a whole run. Calls `check`
/// after each kill. Returns how many runs had not ended by themselves.
fn killed(folder: &Path, arguments: &[&str], takes: Duration, mut check: impl FnMut()) -> u32 {
    let mut hit = 0;
    for index in 0..kills() {
        let mut child = command(folder, arguments).spawn().unwrap();
        std::thread::sleep(takes.mul_f64((f64::from(index) + 0.5) / f64::from(kills())));
        hit += u32::from(child.try_wait().unwrap().is_none());
        // SIGKILL: the program cannot handle it.
        child.kill().unwrap();
        child.wait().unwrap();
        check();
    }
    assert!(hit > 0, "every run was over before its kill");
    hit
}

/// The files of a folder by name, without the unfinished ones, which begin with a dot.
fn files(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let Ok(entries) = std::fs::read_dir(folder) else { return BTreeMap::new() };
    let paths = entries.map(|entry| entry.unwrap().path());
    let finished = paths.filter(|path| !path.file_name().unwrap().to_string_lossy().starts_with('.'));
    finished
        .filter(|path| path.is_file())
        .map(|path| (PathBuf::from(path.file_name().unwrap()), std::fs::read(&path).unwrap()))
        .collect()
}

const OLD: &str = "strokes.scale=1.3";

#[test]
fn a_frame_is_the_old_one_or_the_new_one() {
    let folder = folder();
    let paint = |more: &[&'static str]| [&["render", "scene.ron", "-q", "-f", "0-3", "-o"], more].concat();
    run(folder.path(), &paint(&["old/####.png", "--set", OLD]));
    let takes = run(folder.path(), &paint(&["new/####.png"]));
    let [old, new] = ["old", "new"].map(|name| files(&folder.path().join(name)));
    assert!(old.len() == 4 && new.len() == 4 && old.iter().all(|(name, bytes)| new[name] != *bytes));
    let shared = folder.path().join("frames");
    std::fs::create_dir(&shared).unwrap();
    let mut seen = [0; 2];
    killed(folder.path(), &paint(&["frames/####.png"]), takes, || {
        for (name, bytes) in files(&shared) {
            let is = [old[&name] == bytes, new[&name] == bytes];
            assert!(is[0] || is[1], "{} is half", name.display());
            is.iter().zip(&mut seen).for_each(|(is, seen)| *seen += u32::from(*is));
        }
        old.iter().for_each(|(name, bytes)| std::fs::write(shared.join(name), bytes).unwrap());
    });
    assert!(seen[0] > 0, "{seen:?}");
}

#[test]
fn a_scene_file_is_the_old_one_or_the_new_one() {
    let folder = folder();
    let path = folder.path().join("scene.ron");
    let old = std::fs::read_to_string(&path).unwrap();
    let set = ["set", "scene.ron", OLD];
    let takes = run(folder.path(), &set);
    let new = old.replace("scale: 1.0", "scale: 1.3");
    assert_eq!(std::fs::read_to_string(&path).unwrap(), new);
    killed(folder.path(), &set, takes, || {
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(text == old || text == new, "{text}");
        std::fs::write(&path, &old).unwrap();
    });
}

#[test]
fn a_pack_is_there_whole_or_not_at_all() {
    let folder = folder();
    let tar = folder.path().join("shot.tar");
    let pack = ["pack", "scene.ron", "-q", "-o", "shot.tar"];
    let takes = run(folder.path(), &pack);
    let new = std::fs::read(&tar).unwrap();
    let old = [&new[..], &[0; 512]].concat();
    killed(folder.path(), &pack, takes, || {
        let bytes = std::fs::read(&tar).unwrap();
        assert!(bytes == old || bytes == new, "{} bytes", bytes.len());
        std::fs::write(&tar, &old).unwrap();
    });
    let into_a_folder = ["pack", "scene.ron", "-q", "-o", "shot"];
    killed(folder.path(), &into_a_folder, takes, || {
        if folder.path().join("shot").exists() {
            run(folder.path(), &["pack", "--check", "shot"]);
            std::fs::remove_dir_all(folder.path().join("shot")).unwrap();
        }
    });
}

#[test]
fn what_is_kept_is_there_whole_or_not_at_all() {
    let folder = folder();
    let strokes = |into: &'static str| ["strokes", "scene.ron", "-o", "/dev/null", "--cache", into];
    let takes = run(folder.path(), &strokes("whole"));
    let whole = files(&folder.path().join("whole"));
    assert_eq!(whole.len(), 1);
    let kept = folder.path().join("kept");
    killed(folder.path(), &strokes("kept"), takes, || {
        for (name, bytes) in files(&kept) {
            assert!(whole[&name] == bytes, "{} is half", name.display());
            std::fs::remove_file(kept.join(name)).unwrap();
        }
    });
    // What killed runs left behind does not disturb a later run.
    run(folder.path(), &strokes("kept"));
    assert!(files(&kept) == whole);
}
