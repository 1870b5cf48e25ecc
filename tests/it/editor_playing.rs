//! Tests of playing in the editor: frames come in order, dropped ones are counted, and each has the strokes that
//! `impasto render` draws. The timing is tested elsewhere, with a simulated clock: in the editor model's `playback`.

use std::sync::Arc;

use glam::DVec2;
use impasto_editor_model::Editor;
use impasto_editor_model::document::Document;
use impasto_editor_model::keymap::Action;
use impasto_editor_model::picking::View;
use impasto_editor_model::playback::Pacing;
use impasto_editor_model::timeline::TimelineEvent;
use impasto_painting::{FrameOptions, Painting, prepare};
use impasto_scene::load::LoadOptions;
use impasto_scene::motion::CameraPose;
use impasto_tests::screen::{EditorWindow, Screen, wait_for};

use crate::editor_window::apple_alone;

const FRAMES: f64 = 120.0;

/// A folder with a scene of 120 frames: the apple alone, of few particles, turns while the camera rolls.
fn folder() -> tempfile::TempDir {
    let (folder, alone) = apple_alone(1500);
    let key = "keys: [(frame: 0, translation: (0, 0, 0), rotation_deg: (0, -25, 0))]";
    let rolls = "keys: [(frame: 0, rotation_deg: (0, -25, 0)), (frame: 119, rotation_deg: (0, -25, -180))]";
    assert!(alone.contains(key) && alone.contains("last: 90"));
    let film = alone.replacen(key, rolls, 1).replacen("last: 90", "last: 119", 1);
    std::fs::write(folder.path().join("film.ron"), film).unwrap();
    folder
}

/// A frame that was shown, the clock at that moment (in frames), and the number of frames dropped by then.
#[derive(Clone, Copy, Debug)]
struct ShownFrame {
    frame: f64,
    clock: f64,
    dropped: f64,
}

fn shown_frames(editor: &EditorWindow<'_>) -> Vec<ShownFrame> {
    let number = |text: Option<&str>| text.unwrap().rsplit(' ').next().unwrap().parse::<f64>().unwrap();
    let line = |line: String| {
        let mut parts = line.split(", ");
        let [frame, clock, dropped] = [(); 3].map(|()| number(parts.next()));
        ShownFrame { frame, clock, dropped }
    };
    editor.printed("playing: ").into_iter().map(line).collect()
}

/// The number of frames from one to another in a film that loops.
fn frames_between(from: f64, to: f64) -> f64 {
    (to - from).rem_euclid(FRAMES)
}

#[test]
fn a_film_goes_on_in_order_and_counts_what_it_drops() {
    let Some(screen) = Screen::open() else { return };
    let folder = folder();
    let editor = EditorWindow::open(&screen, "playing", folder.path(), "film.ron");
    editor.keys(&["space"]);
    wait_for("more than a round of the film", || {
        let shown = shown_frames(&editor);
        (shown.len() > 60 && shown.windows(2).any(|pair| pair[1].clock < pair[0].clock)).then_some(())
    });
    editor.keep_picture("midst");
    editor.keys(&["space"]);
    let last = wait_for("the frame that it stopped at, exactly drawn", || {
        let frame = shown_frames(&editor).last()?.frame;
        let value = format!("Arrange, select, shot camera, frame {frame}");
        editor.rest().1.starts_with(&value).then_some(frame)
    });
    assert!((0.0..FRAMES).contains(&last) && last.fract() == 0.0);

    let shown = shown_frames(&editor);
    let (mut before, mut dropped) = (0.0, 0.0);
    for now in &shown {
        dropped += frames_between(before, now.frame) - 1.0;
        assert_eq!(now.dropped, dropped, "{now:?}");
        before = now.frame;
    }
    println!("{} frames shown, {dropped} dropped", shown.len());
    assert_eq!(editor.quit(), Some(0));
}

#[test]
fn what_is_played_scrubbed_to_and_rendered_is_the_same_to_the_bit() {
    let folder = folder();
    let path = folder.path().join("film.ron");
    let document = Document::open(&path, &LoadOptions::default()).unwrap();
    let painting = prepare(Arc::clone(document.loaded())).unwrap();
    // What `impasto render` prepares: the file, read again.
    let rendered =
        prepare(Arc::clone(Document::open(&path, &LoadOptions::default()).unwrap().loaded())).unwrap();
    let options = FrameOptions::new([320, 180]);
    let mut editor = Editor::new(document);
    editor.prepared(painting.clone());
    for pacing in [Pacing::RealTime, Pacing::EveryFrame] {
        editor.session.pacing = pacing;
        editor.session.frame = 110.0;
        let view = View { camera: editor.camera(), size_px: DVec2::new(320.0, 180.0) };
        editor.tick(0.0);
        editor.act(Action::Play, &view);
        let mut asked = Vec::new();
        for step in 1..=200 {
            editor.tick(f64::from(step) * 0.0137);
            let frame = editor.frame_to_draw();
            if editor.shown_frame(frame) {
                asked.push(frame);
            }
        }
        assert!(asked.len() > 50, "{pacing:?}: {}", asked.len());
        assert!(asked.iter().all(|frame| frame.fract() == 0.0 && (0.0..FRAMES).contains(frame)), "{asked:?}");
        assert!(asked.contains(&0.0) && asked.contains(&119.0), "it played past the end, back to the start");
        for &frame in asked.iter().step_by(9) {
            let strokes = |painting: &Painting, camera: &CameraPose, frame: f64| {
                let frame = painting.seen_by(camera, frame, &options);
                assert!(frame.strokes.len() > 300);
                format!("{:?}", (frame.strokes, frame.view))
            };
            let camera = editor.camera_at(frame);
            let played = strokes(&painting, &camera, frame);
            editor.timeline(TimelineEvent::Scrub(frame));
            let scrubbed = strokes(&painting, &editor.camera(), editor.session.frame);
            let there = rendered.at(frame, &options);
            assert!(played == scrubbed, "{pacing:?}: frame {frame} differs when scrubbed to");
            assert!(
                played == format!("{:?}", (there.strokes, there.view)),
                "{pacing:?}: frame {frame} differs when rendered"
            );
        }
        editor.timeline(TimelineEvent::EndScrub);
        editor.act(Action::Play, &view);
    }
}
