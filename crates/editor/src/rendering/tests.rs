//! Tests of rendering to files: whole frames, stopping, files that exist already, and errors of the disk.

use std::path::Path;

use impasto_editor_model::Document;
use impasto_editor_model::render_settings::{RenderSettings, Which};

use super::*;

const LONG: Duration = Duration::from_secs(120);

fn plan(folder: &Path, frames: &str) -> RenderPlan {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let mut document = Document::open(&scenes.join("meshes/cube.obj"), &Default::default()).unwrap();
    document
        .apply(&impasto_editor_model::Command::Scene(impasto_editor_model::command::SceneEdit::SetSeed(7)))
        .unwrap();
    let settings = RenderSettings {
        which: Which::Listed,
        list: frames.to_owned(),
        size_px: [64, 36],
        output: folder.join("f_##.png").to_string_lossy().into_owned(),
        driver: RenderDriver::Osmesa,
        ..RenderSettings::of(document.scene())
    };
    settings.plan(&document, 0.0).unwrap()
}

fn files(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut names: Vec<String> =
        entries.map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

fn is_whole(path: &Path) -> bool {
    image::open(path).is_ok_and(|picture| (picture.width(), picture.height()) == (64, 36))
}

#[test]
fn frames_are_written_and_those_that_are_there_can_stay() {
    let folder = tempfile::tempdir().unwrap();
    // A file stays if its last bytes are those of a PNG file. A file that was cut off is replaced.
    let mine = b"mine\0\0\0\0IEND\xae\x42\x60\x82";
    std::fs::write(folder.path().join("f_01.png"), mine).unwrap();
    std::fs::write(folder.path().join("f_02.png"), "cut").unwrap();
    let plan = plan(folder.path(), "0-2").keeping();
    assert_eq!(plan.existing_count(), 2);
    let rendering = Rendering::start(plan, Default::default(), || ()).unwrap();
    assert!(rendering.wait(LONG));
    let progress = rendering.progress();
    assert_eq!((&progress.outcome, progress.written, progress.kept), (&Some(Outcome::Done), 2, 1));
    assert!(progress.strokes > 0 && progress.left_s().is_none());
    assert_eq!(progress.last, Some(folder.path().join("f_02.png")));
    assert_eq!(rendering.take_picture().unwrap().size, [64, 36]);
    assert_eq!(files(folder.path()), ["f_00.png", "f_01.png", "f_02.png"]);
    assert_eq!(std::fs::read(folder.path().join("f_01.png")).unwrap(), mine);
    assert!(is_whole(&folder.path().join("f_00.png")) && is_whole(&folder.path().join("f_02.png")));
}

#[test]
fn what_is_stopped_leaves_whole_frames_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let rendering = Rendering::start(plan(folder.path(), "0-99999"), Default::default(), || ()).unwrap();
    while rendering.progress().written < 2 && !rendering.is_over() {
        std::thread::sleep(Duration::from_millis(5));
    }
    rendering.stop();
    assert!(rendering.wait(LONG));
    let progress = rendering.progress();
    assert_eq!(progress.outcome, Some(Outcome::Stopped));
    let names = files(folder.path());
    assert_eq!(names.len() as u64, progress.written, "{names:?}");
    assert!(names.iter().all(|name| is_whole(&folder.path().join(name))), "{names:?}");
}

#[test]
fn an_error_names_frame_and_file_and_leaves_the_frames_before() {
    let folder = tempfile::tempdir().unwrap();
    // A file cannot replace a folder that is not empty.
    std::fs::create_dir_all(folder.path().join("f_01.png/in the way")).unwrap();
    let rendering = Rendering::start(plan(folder.path(), "0-2"), Default::default(), || ()).unwrap();
    assert!(rendering.wait(LONG));
    let Some(Outcome::Failed(words)) = rendering.progress().outcome else { panic!("it cannot go well") };
    let path = folder.path().join("f_01.png").display().to_string();
    assert!(words.contains("Frame 1 ") && words.contains(&path), "{words}");
    assert_eq!(files(folder.path()), ["f_00.png", "f_01.png"]);
    assert!(is_whole(&folder.path().join("f_00.png")));
}

#[test]
fn a_folder_that_cannot_be_made_is_reported_before_anything_is_drawn() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("file"), "").unwrap();
    let rendering =
        Rendering::start(plan(&folder.path().join("file"), "0"), Default::default(), || ()).unwrap();
    assert!(rendering.wait(LONG));
    let Some(Outcome::Failed(words)) = rendering.progress().outcome else { panic!("it cannot go well") };
    assert!(words.contains("cannot write into"), "{words}");
}

#[test]
fn a_movie_is_written_whole_or_ffmpeg_is_missed_before_anything_is_painted() {
    let folder = tempfile::tempdir().unwrap();
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let document = Document::open(&scenes.join("meshes/cube.obj"), &Default::default()).unwrap();
    let mut settings = RenderSettings {
        which: Which::Listed,
        list: "0-2".to_owned(),
        size_px: [64, 36],
        driver: RenderDriver::Osmesa,
        ..RenderSettings::of(document.scene())
    };
    settings.choose_output(folder.path().join("film.mp4").to_string_lossy().into_owned());
    let plan = settings.plan(&document, 0.0).unwrap();
    assert_eq!(plan.kind, FileKind::Movie);
    let rendering = Rendering::start(plan, Default::default(), || ()).unwrap();
    assert!(rendering.wait(LONG));
    let progress = rendering.progress();
    if std::process::Command::new("ffmpeg").arg("-version").output().is_ok() {
        assert_eq!((&progress.outcome, progress.written), (&Some(Outcome::Done), 3));
        assert_eq!(files(folder.path()), ["film.mp4"]);
        assert!(std::fs::metadata(folder.path().join("film.mp4")).unwrap().len() > 100);
    } else {
        let Some(Outcome::Failed(words)) = &progress.outcome else { panic!("{:?}", progress.outcome) };
        assert!(words.contains("film.mp4") && words.contains("ffmpeg, which is not installed"), "{words}");
        assert_eq!((progress.written, rendering.take_picture().is_none()), (0, true));
        assert!(files(folder.path()).is_empty());
    }
}
