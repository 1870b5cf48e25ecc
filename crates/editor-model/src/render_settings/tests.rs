//! Tests of the render sheet: plans, faults, command lines and progress.

use impasto_scene::aovs::{AOVS, Aov};
use impasto_scene::document::Style;

use super::*;

fn document() -> Document {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    Document::open(&scenes.join("apple.ron"), &Default::default()).unwrap()
}

#[test]
fn a_sheet_begins_with_the_whole_shot_beside_the_scene() {
    let document = document();
    let settings = RenderSettings::of(document.scene());
    let plan = settings.plan(&document, 7.0).unwrap();
    let timeline = &document.scene().timeline;
    assert_eq!(plan.frames.iter().collect::<Vec<_>>(), (timeline.first..=timeline.last).collect::<Vec<_>>());
    assert_eq!(plan.size_px, [document.scene().size.0, document.scene().size.1]);
    let beside = std::path::absolute(document.folder()).unwrap().join("out/frame_0003.png");
    assert_eq!(plan.path(3), beside);
    assert!(!plan.is_outside());
    let only = RenderSettings { which: Which::This, ..settings.clone() }.plan(&document, 7.0).unwrap();
    assert_eq!(only.frames.iter().collect::<Vec<_>>(), [7]);
    for output in ["../out/f_####.png", "/tmp/f_####.png"] {
        let plan = RenderSettings { output: output.to_owned(), ..settings.clone() }.plan(&document, 0.0);
        assert!(plan.unwrap().is_outside(), "{output}");
    }
}

#[test]
fn faults_are_reported_at_their_fields() {
    let document = document();
    let settings = RenderSettings::of(document.scene());
    let list =
        |list: &str| RenderSettings { which: Which::Listed, list: list.to_owned(), ..settings.clone() };
    let output = |output: &str| RenderSettings { output: output.to_owned(), ..settings.clone() };
    let size = |size_px| RenderSettings { size_px, ..settings.clone() };
    for (settings, field, part) in [
        (list("1-"), Field::Frames, "no frame list"),
        (list("0-99999999"), Field::Frames, "limit"),
        (size([0, 10]), Field::Size, "at least one"),
        (size([20_000, 10]), Field::Size, "16384"),
        (size([16_384, 16_384]), Field::Size, "in all"),
        (output(""), Field::Output, "name a file"),
        (output("out/"), Field::Output, "name a file"),
        (output("film.avi"), Field::Output, ".png"),
        (output("film.avi"), Field::Output, ".mp4, .mov, .webm or .mkv"),
        (RenderSettings { transparent: true, ..output("film.mp4") }, Field::Output, ".webm"),
    ] {
        let fault = settings.plan(&document, 0.0).unwrap_err();
        assert!(fault.field == field && fault.words.contains(part), "{settings:?}: {fault:?}");
    }
}

#[test]
fn files_that_are_there_are_counted_and_the_scenes_own_refused() {
    let folder = tempfile::tempdir().unwrap();
    let mut document = Document::empty(folder.path());
    document.save_as(&folder.path().join("s.ron")).unwrap();
    let settings = RenderSettings {
        which: Which::Listed,
        list: "0-9".to_owned(),
        output: "f_##.png".to_owned(),
        ..RenderSettings::of(document.scene())
    };
    let plan = settings.plan(&document, 0.0).unwrap();
    assert_eq!(plan.existing_count(), 0);
    for name in ["f_03.png", "f_09.png", "f_10.png", "f_3.png"] {
        std::fs::write(folder.path().join(name), "x").unwrap();
    }
    assert_eq!(plan.existing_count(), 2);
    assert!(plan.ready().is_ok());
    let mut own = settings.plan(&document, 0.0).unwrap();
    let mut loaded = (*own.loaded).clone();
    loaded.path = folder.path().join("f_03.png");
    own.loaded = Arc::new(loaded);
    assert!(own.ready().unwrap_err().to_string().contains("f_03.png"));
    let capitals = RenderSettings { output: "f_##.PNG".to_owned(), ..settings.clone() };
    assert_eq!(capitals.plan(&document, 0.0).unwrap().existing_count(), 2, "files end in small letters");
    #[cfg(unix)]
    {
        // The name of one frame is a link to the file that the scene is read from.
        std::os::unix::fs::symlink(folder.path().join("s.ron"), folder.path().join("f_05.png")).unwrap();
        let words = settings.plan(&document, 0.0).unwrap().ready().unwrap_err().to_string();
        assert!(words.contains("s.ron"), "{words}");
        std::fs::remove_file(folder.path().join("f_05.png")).unwrap();
    }
    let blocked = RenderSettings { output: "f_3.png/f_##.png".to_owned(), ..settings };
    let words = blocked.plan(&document, 0.0).unwrap().ready().unwrap_err().to_string();
    assert!(words.contains("cannot write into") && words.contains("f_3.png"), "{words}");
}

#[test]
fn a_command_is_offered_for_a_file_only_and_quoted_for_a_shell() {
    let folder = tempfile::tempdir().unwrap();
    let mut document = Document::empty(folder.path());
    let settings = RenderSettings::of(document.scene());
    let words = settings.plan(&document, 0.0).unwrap().command(&document).unwrap_err();
    assert!(words.starts_with("Save the scene first"), "{words}");
    document.save_as(&folder.path().join("it's.ron")).unwrap();
    let plan = settings.plan(&document, 0.0).unwrap();
    let text = shell_words("impasto", &plan.command(&document).unwrap());
    assert!(text.starts_with("impasto render '/") && text.contains(r"it'\''s.ron' --frames="), "{text}");
    let skips = |plan: &RenderPlan| plan.command(&document).unwrap().contains(&"--skip-existing".to_owned());
    assert_eq!([skips(&plan), skips(&plan.clone().keeping())], [false, true]);
}

#[test]
fn progress_is_put_into_words() {
    let mut progress = RenderProgress {
        stage: Stage::Drawing,
        total: 120,
        written: 47,
        gone_s: 115.0,
        drawing_s: 112.8,
        strokes: 5774,
        ..RenderProgress::default()
    };
    assert_eq!(progress.count(), "47 of 120");
    assert_eq!(progress.time_words(), "1 min 55 s gone, about 2 min 55 s left");
    assert_eq!(progress.frame_words(), "2.4 s a frame, 5,774 strokes");
    // Kept frames count as done: nothing is left, so there is no time left to estimate.
    progress.kept = 73;
    assert_eq!((progress.share(), progress.left_s()), (1.0, None));
    progress.outcome = Some(Outcome::Done);
    assert_eq!(progress.state_words(), "47 frames written, 73 were there");
    progress.gone_s = 3905.0;
    assert_eq!(progress.time_words(), "took 1 h 5 min");
}

#[test]
fn sizes_keep_the_shape_of_the_scene() {
    let mut scene = document().scene().clone();
    scene.size = (1280, 720);
    assert_eq!([scaled(&scene, 50), scaled(&scene, 150)], [[640, 360], [1920, 1080]]);
    assert_eq!(size_4k(&scene), [3840, 2160]);
    scene.size = (500, 1000);
    assert_eq!(size_4k(&scene), [1920, 3840]);
}

/// An empty scene with these words as its `aovs`, saved in a folder.
fn document_with_aovs(folder: &Path, aovs: &[&str]) -> Document {
    let mut document = Document::empty(folder);
    document.save_as(&folder.join("s.ron")).unwrap();
    let text = std::fs::read_to_string(folder.join("s.ron")).unwrap();
    let text = text.replacen("version: 1,", &format!("version: 1, aovs: {aovs:?},"), 1);
    std::fs::write(folder.join("s.ron"), text).unwrap();
    let document = Document::open(&folder.join("s.ron"), &Default::default()).unwrap();
    assert_eq!(document.scene().aovs, aovs);
    document
}

#[test]
fn the_ending_follows_the_kind_and_the_kind_a_typed_ending() {
    let document = document();
    let mut settings = RenderSettings::of(document.scene());
    for (kind, output) in [
        (FileKind::Exr, "out/frame_####.exr"),
        (FileKind::PngAndExr, "out/frame_####.png"),
        (FileKind::Png16, "out/frame_####.png"),
    ] {
        settings.choose_kind(kind);
        assert_eq!((settings.output.as_str(), settings.ending()), (output, &output[15..]));
    }
    for (typed, kind) in [
        ("b/f.PNG", FileKind::Png16),
        ("b/f", FileKind::Png16),
        ("b/f.exr ", FileKind::Exr),
        ("b/f.ex", FileKind::Exr),
        ("b/f.png", FileKind::Png8),
    ] {
        settings.choose_output(typed.to_owned());
        assert_eq!(settings.kind, kind, "{typed}");
    }
    for (output, renamed) in [("f", "f.exr"), ("f.0001", "f.0001.exr"), ("d.png/", "d.png/"), ("", "")] {
        let mut settings = RenderSettings { output: output.to_owned(), ..settings.clone() };
        settings.choose_kind(FileKind::Exr);
        assert_eq!(settings.output, renamed);
    }
}

#[test]
fn exr_files_hold_what_the_scene_says_until_something_else_is_chosen() {
    let folder = tempfile::tempdir().unwrap();
    let document = document_with_aovs(folder.path(), &["depth", "stroke.id"]);
    let scene = document.scene();
    let mut settings = RenderSettings::of(scene);
    assert_eq!(settings.plan(&document, 0.0).unwrap().aovs(), None, "PNG files hold none");
    settings.choose_kind(FileKind::Exr);
    let of_scene = AovSet::of_words(["depth", "stroke.id"]).unwrap();
    assert_eq!(settings.plan(&document, 0.0).unwrap().aovs(), Some(of_scene));
    let ticked = settings.aovs.with(Aov::Normal, true, scene).with(Aov::StrokeId, false, scene);
    let depth = ticked.with(Aov::Normal, false, scene);
    for (choice, words) in [
        (settings.aovs, "The scene\u{2019}s 2 AOVs"),
        (AovChoice::All, "All 26 AOVs"),
        (AovChoice::NONE, "No AOVs"),
        (ticked, "2 AOVs"),
        (depth, "AOV depth"),
    ] {
        assert_eq!(choice.words(scene), words);
    }
    // A style without strokes has only the AOVs that need no paint.
    let mut plain = scene.clone();
    plain.style = Style::named("reference").unwrap();
    assert_eq!(AovChoice::All.set(&plain), AovSet::OF_SCENE);
    assert_eq!(settings.aovs.words(&plain), "The scene\u{2019}s 1 AOV");
    let none = AovChoice::OfScene.words(self::document().scene());
    assert_eq!(none, "No AOVs", "the scene of the apple names no AOVs");
}

#[test]
fn a_command_names_the_kind_and_what_is_beside_the_colour() {
    let folder = tempfile::tempdir().unwrap();
    let document = document_with_aovs(folder.path(), &["scene"]);
    let these = AovChoice::These(AovSet::of_words(["layers", "depth"]).unwrap());
    for (kind, aovs, words) in [
        (FileKind::Png8, AovChoice::All, "out/frame_####.png"),
        (FileKind::Png16, AovChoice::All, "out/frame_####.png --bits 16"),
        (FileKind::Exr, AovChoice::OfScene, "out/frame_####.exr"),
        (FileKind::Exr, AovChoice::NONE, "out/frame_####.exr --aov none"),
        (FileKind::Exr, AovChoice::All, "out/frame_####.exr --aov all"),
        (FileKind::PngAndExr, these, "out/frame_####.png --exr --aov depth,layers"),
    ] {
        let mut settings = RenderSettings { aovs, ..RenderSettings::of(document.scene()) };
        settings.choose_kind(kind);
        let command = settings.plan(&document, 0.0).unwrap().command(&document).unwrap();
        let line = command.join(" ");
        assert!(line.ends_with(words), "{line}");
    }
}

#[test]
fn a_frame_of_two_files_is_there_when_either_is() {
    let folder = tempfile::tempdir().unwrap();
    let document = Document::empty(folder.path());
    let mut settings = RenderSettings {
        which: Which::Listed,
        list: "0-9".to_owned(),
        output: "f_##.png".to_owned(),
        ..RenderSettings::of(document.scene())
    };
    for name in ["f_03.png", "f_03.exr", "f_07.exr"] {
        std::fs::write(folder.path().join(name), "x").unwrap();
    }
    for (kind, count) in [(FileKind::Png8, 1), (FileKind::Exr, 2), (FileKind::PngAndExr, 2)] {
        settings.choose_kind(kind);
        assert_eq!(settings.plan(&document, 0.0).unwrap().existing_count(), count, "{kind:?}");
    }
    let mut own = settings.plan(&document, 0.0).unwrap();
    let mut loaded = (*own.loaded).clone();
    loaded.path = folder.path().join("f_07.exr");
    own.loaded = Arc::new(loaded);
    assert!(own.ready().unwrap_err().to_string().contains("f_07.exr"));
}

#[test]
fn every_aov_is_in_one_group_under_words_of_its_own() {
    let groups = AovGroup::all();
    let labels = groups.map(|group| group.label);
    assert_eq!(labels, ["Scene", "Strokes", "Paint", "Mattes"]);
    let all: Vec<_> = groups.into_iter().flat_map(AovGroup::rows).map(|(_, row)| row.aov).collect();
    assert_eq!(all, AOVS.map(|row| row.aov), "in the order of the table");
    for group in groups {
        let mut words: Vec<_> = group.rows().map(|(words, _)| words).collect();
        words.sort_unstable();
        words.dedup();
        assert_eq!(words.len(), group.rows().count(), "{group:?}");
    }
}

#[test]
fn a_movie_is_one_file_of_all_frames() {
    let folder = tempfile::tempdir().unwrap();
    let mut document = Document::empty(folder.path());
    document.save_as(&folder.path().join("s.ron")).unwrap();
    let mut settings = RenderSettings::of(document.scene());
    settings.choose_kind(FileKind::Movie);
    assert_eq!((settings.output.as_str(), settings.ending()), ("out/frame.mp4", "mp4"));
    settings.choose_output("films/my film.mov".to_owned());
    settings.choose_kind(FileKind::Movie);
    assert_eq!(settings.output, "films/my film.mov", "a movie keeps its ending");
    let plan = settings.plan(&document, 0.0).unwrap();
    let path = std::path::absolute(folder.path().join("films/my film.mov")).unwrap();
    assert_eq!((plan.path(0), plan.path(7), plan.kind), (path.clone(), path.clone(), FileKind::Movie));
    assert_eq!(plan.existing_count(), 0);
    plan.ready().unwrap();
    std::fs::write(&path, "").unwrap();
    assert!(plan.existing_count() > 0);
    let command = plan.command(&document).unwrap();
    assert!(command.contains(&path.to_string_lossy().into_owned()), "{command:?}");
    // A transparent movie needs a kind that has transparency.
    assert!(RenderSettings { transparent: true, ..settings.clone() }.plan(&document, 0.0).is_ok());
    settings.choose_kind(FileKind::Png8);
    assert_eq!(settings.output, "films/my film_####.png", "frames have numbers again");
    // A name of nothing but a number.
    for (frames, movie) in [("out/####.png", "out/movie.mp4"), ("####.exr", "movie.mp4"), ("out/", "out/")] {
        settings.choose_output(frames.to_owned());
        settings.choose_kind(FileKind::Movie);
        assert_eq!(settings.output, movie);
    }
}

#[test]
fn frames_of_an_earlier_rendering_are_not_finished() {
    let folder = tempfile::tempdir().unwrap();
    let document = Document::empty(folder.path());
    let settings = RenderSettings {
        which: Which::Listed,
        list: "0-9".to_owned(),
        output: "f_##.png".to_owned(),
        ..RenderSettings::of(document.scene())
    };
    for name in ["f_00.png", "f_01.png", "f_02.png", "f_07.png"] {
        std::fs::write(folder.path().join(name), "x").unwrap();
    }
    let plan = settings.plan(&document, 0.0).unwrap();
    let numbers = |plan: &RenderPlan, done: u64| -> Vec<i64> {
        plan.finished(done).into_iter().map(|(frame, _)| frame).collect()
    };
    assert_eq!(numbers(&plan, 0), Vec::<i64>::new());
    assert_eq!(numbers(&plan, 2), [0, 1]);
    assert_eq!(numbers(&plan, 10), [0, 1, 2, 7]);
    assert_eq!(numbers(&plan.keeping(), 2), [0, 1, 2, 7], "kept files count as finished");
}
