//! Tests that no work is lost when the editor is killed. A process that edits, writes recovery copies and saves is
//! killed a hundred times, at random moments: no copy that was reported as written is lost, and the scene file is
//! always whole.

#![cfg(unix)]

use std::io::{BufRead as _, BufReader, Write as _};
use std::path::Path;
use std::process::{Command as Process, Stdio};
use std::time::Duration;

use impasto_editor_model::Document;
use impasto_editor_model::command::{Command, SceneEdit};
use impasto_editor_model::recovery::Recovery;
use impasto_scene::load::LoadOptions;

const FOLDER: &str = "IMPASTO_TEST_KILLED_IN";
const SCENE: &str = "(version: 1, camera: (keys: [(frame: 0, eye: (0, 1, 4), target: (0, 0, 0))]), \
    objects: [(name: \"wall\", mesh: \"impasto:backdrop\")])";

/// Edits the scene until it is killed. The scene's seed counts the edits. Prints a line after each copy and each save.
#[test]
#[ignore = "runs until it is killed; the test below starts it"]
fn painter() {
    let Some(folder) = std::env::var_os(FOLDER) else { return };
    let folder = Path::new(&folder);
    let mut document = Document::open(&folder.join("s.ron"), &LoadOptions::default()).expect("opens");
    let name = format!("{}-1", std::process::id());
    let recovery = Recovery::open(&folder.join("recovery"), &name).expect("a place");
    let mut out = std::io::stdout();
    for seed in document.scene().seed + 1.. {
        document.apply(&Command::Scene(SceneEdit::SetSeed(seed))).expect("edited");
        recovery.keep(&document.work(u64::from(seed))).expect("kept");
        writeln!(out, "\nkept {seed}").expect("told");
        if seed % 3 == 0 {
            document.save().expect("saved");
            writeln!(out, "\nsaved {seed}").expect("told");
            recovery.forget().expect("forgotten");
        }
    }
}

#[test]
fn nothing_written_is_lost_when_killed_at_any_moment() {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = folder.path().join("s.ron");
    let place = folder.path().join("recovery");
    std::fs::write(&scene, SCENE).expect("written");
    let (mut random, mut offered, mut seen) = (0x2545_f491_4f6c_dd1d_u64, 0, 0);
    for run in 0..100 {
        let mut child = Process::new(std::env::current_exe().expect("this test"))
            .args(["--exact", "killed::painter", "--ignored", "--nocapture"])
            .env(FOLDER, folder.path())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("started");
        let mut lines = BufReader::new(child.stdout.take().expect("piped")).lines();
        let mut told = Vec::new();
        random ^= random << 13;
        random ^= random >> 7;
        random ^= random << 17;
        // Waits until the process has made some edits, then lets it go on for a random time.
        let mut left = random % 8 + 1;
        while left > 0 {
            let line = lines.next().expect("it paints on").expect("text");
            left -= u64::from(line.starts_with("kept "));
            told.push(line);
        }
        std::thread::sleep(Duration::from_micros((random >> 8) % 6000));
        child.kill().expect("killed");
        child.wait().expect("gone");
        told.extend(lines.map(|line| line.expect("text")));
        let last = |what: &str| {
            let counts = told.iter().filter_map(|line| line.strip_prefix(what)?.parse::<u32>().ok());
            counts.max().unwrap_or(0)
        };
        let (kept, saved) = (last("kept "), last("saved "));
        assert!(kept > 0, "run {run}: no copy was reported: {told:?}");
        let on_disk = Document::open(&scene, &LoadOptions::default());
        let on_disk = on_disk.unwrap_or_else(|report| panic!("run {run}: {report}")).scene().seed;
        assert!(
            on_disk >= saved && on_disk <= kept,
            "run {run}: {on_disk} on disk, {saved} saved, {kept} kept"
        );
        let offers = Recovery::offers(&place);
        assert!(offers.len() <= 1, "run {run}: {offers:?}");
        let mut newest = on_disk;
        for offer in offers {
            offered += 1;
            let document = Document::recovered(&offer.copy, &LoadOptions::default()).expect("opens");
            assert!(document.is_edited());
            assert_eq!(u64::from(document.scene().seed), offer.copy.at_unix_secs);
            newest = newest.max(document.scene().seed);
            offer.discard().expect("gone");
        }
        // The last copy may have been complete before it was reported.
        assert!((kept..=kept + 1).contains(&newest), "run {run}: {newest} is left, {kept} was kept");
        seen = seen.max(newest);
    }
    assert!(
        offered > 20 && seen > 100,
        "{offered} offers, {seen} edits: the process was killed too soon to show anything"
    );
    // Now nothing is offered, and looking for offers must have emptied the recovery folder. A save that was cut off
    // may leave its part file beside the scene.
    assert!(Recovery::offers(&place).is_empty());
    let left = std::fs::read_dir(&place).expect("there").count();
    assert_eq!(left, 0, "litter in the recovery folder");
    for entry in std::fs::read_dir(folder.path()).expect("there") {
        let name = entry.expect("an entry").file_name().to_string_lossy().into_owned();
        let is_part = name.starts_with(".s.ron~") && name.ends_with(".part");
        assert!(is_part || ["s.ron", "recovery"].contains(&name.as_str()), "{name}");
    }
}
