//! Tests of the render sheet: plans, faults, command lines and progress.

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
        (output("film.mp4"), Field::Output, ".png"),
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
    // Frames that are not rendered again take no time, so they say nothing about the time left.
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
