//! Tests that the editor survives hostile files. Those in the folder that `IMPASTO_CORPUS` names are opened by a
//! process with little memory and time. Each must give a document or an error message, and stay unchanged. Another test
//! opens a shipped scene with changed bytes. The workspace's own `tests/it/hostile_scenes.rs` opens a small corpus.

#![cfg(unix)]

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command as Process;

use impasto_editor_model::Document;
use impasto_scene::load::LoadOptions;
use impasto_scene::load::salvage;

/// Limits of address space and time for all files together.
const MEMORY_KIB: u32 = 1 << 20;
const SECONDS: u32 = 240;

/// The environment variable with the path of the list of files to open.
const LIST: &str = "IMPASTO_TEST_OPENS";

fn tell(words: &str) {
    writeln!(std::io::stdout(), "\n{words}").expect("told");
}

/// Opens the listed files as the window does, makes all certain repairs, undoes them, and prints the outcome.
#[test]
#[ignore = "the test below starts it"]
fn opener() {
    let Some(list) = std::env::var_os(LIST) else { return };
    for file in std::fs::read_to_string(list).expect("a list").lines() {
        tell(&format!("opening: {file}"));
        open(Path::new(file));
    }
}

fn open(file: &Path) {
    match Document::open_with_problems(file, &LoadOptions::default()) {
        Err(report) => {
            assert!(report.0.iter().any(|problem| problem.severity.is_fatal()), "no fatal problem is named");
            tell(&format!("refused: {report}"));
        }
        Ok(mut document) => {
            let (rows, losses) = (document.problems().len(), document.loss_count());
            // What was opened is sound: an empty edit is accepted.
            let loaded = document.loaded();
            let again = loaded.with_scene(loaded.scene.clone(), &Default::default());
            assert!(again.is_ok(), "{:?}", again.map(drop));
            if losses > 0 {
                assert!(document.save().is_err(), "saved over what it could not read");
            }
            let _ = document.fix_certain();
            while document.undo().is_some() {}
            assert_eq!(document.loss_count(), losses);
            tell(&format!("opened: {losses} losses of {rows}"));
        }
    }
}

fn hostile_files() -> Option<Vec<PathBuf>> {
    let Some(corpus) = std::env::var_os("IMPASTO_CORPUS").map(PathBuf::from) else {
        // The test runner would show the output of `eprintln!` only if the test fails.
        let test = "hostile_files_open_or_are_refused_and_stay_what_they_are";
        let _ = writeln!(std::io::stderr(), "skipped: {test}: IMPASTO_CORPUS names no folder");
        return None;
    };
    let mut files = Vec::new();
    let mut open = vec![corpus.join("hostile"), corpus.join("models")];
    while let Some(folder) = open.pop() {
        for entry in std::fs::read_dir(&folder).expect("a folder of the corpus") {
            let entry = entry.expect("an entry");
            let path = entry.path();
            let is_ours = path.extension().is_some_and(|extension| extension == "obj" || extension == "ron");
            match entry.file_type().expect("a type") {
                kind if kind.is_dir() => open.push(path),
                _ if is_ours => files.push(path),
                _ => {}
            }
        }
    }
    files.sort();
    Some(files)
}

#[test]
fn hostile_files_open_or_are_refused_and_stay_what_they_are() {
    let Some(files) = hostile_files() else { return };
    assert!(files.len() > 50, "{} files", files.len());
    let contents = || -> Vec<Option<Vec<u8>>> { files.iter().map(|file| std::fs::read(file).ok()).collect() };
    let before = contents();
    let folder = tempfile::tempdir().expect("a folder");
    let list = folder.path().join("list");
    let lines: String = files.iter().map(|file| format!("{}\n", file.display())).collect();
    std::fs::write(&list, lines).expect("a list");
    let script = format!(
        "ulimit -v {MEMORY_KIB} && exec timeout {SECONDS} \"$0\" --exact hostile::opener --ignored --nocapture --test-threads=1"
    );
    let output = Process::new("sh")
        .args(["-c", &script])
        .arg(std::env::current_exe().expect("this test"))
        .env(LIST, &list)
        .output()
        .expect("sh runs");
    let said = String::from_utf8_lossy(&output.stdout);
    let told = |words: &str| said.lines().filter(|line| line.starts_with(words)).count();
    let last = said.lines().rfind(|line| line.starts_with("opening: ")).unwrap_or("nothing was opened");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{last}\nended with {:?}\n{said}\n{errors}", output.status);
    assert_eq!((told("opening: "), told("refused: ") + told("opened: ")), (files.len(), files.len()));
    for ((file, before), after) in files.iter().zip(&before).zip(&contents()) {
        assert!(before == after, "{} was touched", file.display());
    }
}

/// Reads copies of a shipped scene with some bytes changed, pseudo-randomly but always in the same way.
#[test]
fn scenes_with_bytes_changed_open_or_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("s.ron");
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let text = std::fs::read_to_string(scenes.join("still_life.ron")).expect("a scene");
    let mut random = 0x9e37_79b9_7f4a_7c15_u64;
    let mut next = |below: usize| {
        random ^= random << 13;
        random ^= random >> 7;
        random ^= random << 17;
        (random % below as u64) as usize
    };
    let (mut opened, mut lossy) = (0, 0);
    for _ in 0..300 {
        let mut bytes = text.clone().into_bytes();
        for _ in 0..=next(4) {
            let at = next(bytes.len());
            match next(3) {
                0 => bytes[at] = b"()[]{},:\"x0-"[next(12)],
                1 => drop(bytes.drain(at..(at + next(40)).min(bytes.len()))),
                _ => bytes.insert(at, b"()[]{},:\"x0-"[next(12)]),
            }
        }
        let Ok(text) = String::from_utf8(bytes) else { continue };
        match salvage::salvage_text(&path, &text, &LoadOptions::default()) {
            Ok(salvaged) => {
                opened += 1;
                lossy += usize::from(!salvaged.losses.is_empty());
                let loaded = &salvaged.loaded;
                let again = loaded.with_scene(loaded.scene.clone(), &Default::default());
                assert!(again.is_ok(), "{:?}", again.map(drop));
            }
            Err(report) => assert!(!report.0.is_empty()),
        }
    }
    assert!(opened > 270 && lossy > 200, "{opened} opened, {lossy} with losses");
}
