//! Tests of recovery copies: offered after a crash, never while their session lives.

use std::path::PathBuf;
use std::sync::OnceLock;

use impasto_scene::load::LoadOptions;

use super::*;
use crate::Document;
use crate::command::{Command, SceneEdit};

/// A small scene file, in a folder that lasts as long as the tests.
fn scene() -> &'static Path {
    static SCENE: OnceLock<(tempfile::TempDir, PathBuf)> = OnceLock::new();
    let (_, path) = SCENE.get_or_init(|| {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("still_life.ron");
        let text = "(version: 1, camera: (keys: [(frame: 0, eye: (0, 1, 4), target: (0, 0, 0))]), \
            objects: [(name: \"wall\", mesh: \"impasto:backdrop\")])";
        fs::write(&path, text).expect("written");
        (folder, path)
    });
    path
}

fn edited(seed: u32) -> Document {
    let mut document = Document::open(scene(), &LoadOptions::default()).expect("opens");
    document.apply(&Command::Scene(SceneEdit::SetSeed(seed))).expect("done");
    document
}

fn files(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a folder");
    let mut names: Vec<String> =
        entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

/// Leaves the files of a crashed session behind, with its lock free.
fn crashed(folder: &Path, name: &str, at: u64) {
    let document = edited(at as u32);
    let recovery = Recovery::open(folder, name).expect("opens");
    recovery.keep(&document.work(at)).expect("kept");
}

#[test]
fn a_copy_that_was_left_behind_is_offered_and_comes_back_edited_and_unsaved() {
    let folder = tempfile::tempdir().expect("a folder");
    crashed(folder.path(), "1-1", 1000);
    let here = Recovery::open(folder.path(), "2-1").expect("opens");
    let offers = Recovery::offers(folder.path());
    let [offer] = &offers[..] else { panic!("{offers:?}") };
    let copy = &offer.copy;
    assert_eq!((copy.name().as_str(), copy.at_unix_secs, copy.changes), ("still_life.ron", 1000, 1));
    assert!(!copy.is_of_another_file());
    let document = Document::recovered(copy, &LoadOptions::default()).expect("opens");
    assert_eq!(document.scene(), edited(1000).scene());
    assert!(document.is_edited());
    assert_eq!(document.file(), Some(scene()));
    // The copy now belongs to this session, and stays on the disk throughout.
    let offer = offers.into_iter().next().expect("one");
    here.take_over(offer).expect("taken");
    assert_eq!(files(folder.path()), ["2-1.lock", "2-1.ron"]);
    here.forget().expect("forgotten");
    drop(here);
    assert!(files(folder.path()).is_empty());
}

#[test]
fn the_copy_of_a_living_session_is_not_offered_and_one_copy_not_twice() {
    let folder = tempfile::tempdir().expect("a folder");
    let alive = Recovery::open(folder.path(), "1-1").expect("opens");
    alive.keep(&edited(1).work(1)).expect("kept");
    crashed(folder.path(), "2-2", 5);
    let offers = Recovery::offers(folder.path());
    assert_eq!(offers.len(), 1);
    assert!(Recovery::offers(folder.path()).is_empty(), "a copy is offered though another window holds it");
    // If the user answers "later", the copy is offered again.
    drop(offers);
    let offers = Recovery::offers(folder.path());
    assert_eq!(offers.len(), 1);
    for offer in offers {
        offer.discard().expect("gone");
    }
    assert!(Recovery::offers(folder.path()).is_empty());
    drop(alive);
    assert_eq!(Recovery::offers(folder.path()).len(), 1);
}

#[test]
fn only_the_newest_copies_are_kept_and_litter_of_dead_sessions_is_removed() {
    let folder = tempfile::tempdir().expect("a folder");
    for index in 0..MAX_COPIES + 3 {
        crashed(folder.path(), &format!("{index}-1"), index as u64);
    }
    for litter in ["900-1.lock", ".0-1.ron~abc.part", ".901-1.ron~x.part"] {
        fs::write(folder.path().join(litter), "").expect("written");
    }
    fs::write(folder.path().join("notes.txt"), "not ours").expect("written");
    let _here = Recovery::open(folder.path(), "here-1").expect("opens");
    let offers = Recovery::offers(folder.path());
    assert_eq!(offers.len(), MAX_COPIES);
    assert_eq!(offers[0].copy.at_unix_secs, (MAX_COPIES + 2) as u64, "the first is not the newest");
    drop(offers);
    // A dead session's other files are removed together with its copy.
    let left = files(folder.path());
    assert_eq!(left.len(), 2 * MAX_COPIES + 2, "{left:?}");
    assert!(left.contains(&"notes.txt".to_owned()));
}

#[test]
fn a_copy_that_is_not_whole_is_not_offered() {
    let folder = tempfile::tempdir().expect("a folder");
    crashed(folder.path(), "1-1", 1);
    let file = folder.path().join("1-1.ron");
    let whole = fs::read(&file).expect("read");
    let _here = Recovery::open(folder.path(), "2-1").expect("opens");
    for length in [0, 10, whole.len() / 2, whole.len() - 2] {
        fs::write(&file, &whole[..length]).expect("written");
        assert!(Recovery::offers(folder.path()).is_empty(), "{length} bytes of {}", whole.len());
        assert!(file.exists());
    }
    fs::write(&file, &whole).expect("written");
    assert_eq!(Recovery::offers(folder.path()).len(), 1);
}

#[test]
fn copies_of_untitled_scenes_and_of_files_changed_since_are_recognised() {
    let folder = tempfile::tempdir().expect("a folder");
    let scenes = tempfile::tempdir().expect("a folder");
    let own = scenes.path().join("s.ron");
    let mut document = Document::empty(scenes.path());
    document.apply(&Command::Scene(SceneEdit::SetSeed(3))).expect("done");
    Recovery::open(folder.path(), "1-1").expect("opens").keep(&document.work(2)).expect("kept");
    document.save_as(&own).expect("saved");
    document.apply(&Command::Scene(SceneEdit::SetSeed(4))).expect("done");
    Recovery::open(folder.path(), "2-1").expect("opens").keep(&document.work(1)).expect("kept");
    fs::write(&own, "(version: 1)").expect("written");
    let offers = Recovery::offers(folder.path());
    let [untitled, other] = &offers[..] else { panic!("{offers:?}") };
    assert_eq!((untitled.copy.name().as_str(), untitled.copy.file.as_deref()), ("Untitled", None));
    assert!(!untitled.copy.is_of_another_file() && other.copy.is_of_another_file());
    // Saving over a file that somebody else changed asks first.
    let mut document = Document::recovered(&other.copy, &LoadOptions::default()).expect("opens");
    let refused = document.save().expect_err("asks");
    assert!(matches!(refused, crate::document::SaveError::ChangedOutside { .. }), "{refused}");
    assert_eq!(fs::read_to_string(&own).expect("there"), "(version: 1)");
}

#[test]
fn the_thread_writes_the_last_copy_and_removes_forgotten_ones() {
    let folder = tempfile::tempdir().expect("a folder");
    let keeper = Keeper::new(Recovery::open(folder.path(), "1-1").expect("opens")).expect("a thread");
    for at in 1..=30 {
        keeper.keep(edited(at).work(u64::from(at)));
    }
    drop(keeper);
    let here = Recovery::open(folder.path(), "2-1").expect("opens");
    let offers = Recovery::offers(folder.path());
    assert_eq!(offers.iter().map(|offer| offer.copy.at_unix_secs).collect::<Vec<_>>(), [30]);
    let keeper = Keeper::new(here).expect("a thread");
    for offer in offers {
        keeper.take_over(offer);
    }
    keeper.keep(edited(31).work(31));
    keeper.forget();
    drop(keeper);
    assert!(files(folder.path()).is_empty(), "{:?}", files(folder.path()));
}
