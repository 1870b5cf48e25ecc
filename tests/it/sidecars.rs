//! Tests of a shot's sidecar (frame rate, range, collections, exposure), of shifted lenses, and of `impasto serve` and
//! `impasto set`, which the Blender extension runs.

use std::io::{BufRead as _, BufReader, Write as _};
use std::path::Path;
use std::process::{Command, Stdio};

use glam::DVec2;
use impasto_aovs::{Drawn, read};
use impasto_frame_files::exr_file::{Channel, Samples};
use impasto_gl_render::context::Driver;
use impasto_painting::{FrameOptions, prepare};
use impasto_scene::aovs::AovSet;
use impasto_scene::load::{LoadOptions, load};
use impasto_scene::motion::{CameraPose, camera_at};
use impasto_tests::command::{impasto, root};
use impasto_tests::glb::{self, Node};
use impasto_tests::pictures::renderer;
use impasto_tests::shapes;
use serde_json::{Value, json};

/// A folder with a shot of two balls, and a scene that paints it.
fn home(sidecar: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let ball = shapes::sphere(24, 12);
    let node = |name, x| Node { name, mesh: &ball, translation: [x, 0.0, 0.0], turn_deg: 0.0 };
    glb::write(&folder.path().join("shot.glb"), &[node("Ball", -1.2), node("Egg", 1.2)]);
    std::fs::write(folder.path().join("shot.impasto.json"), sidecar).unwrap();
    let scene = "#![enable(implicit_some)]\n(\n    version: 1,\n    // mine\n    size: (96, 54),\n    shot: \"shot.glb\",\n)\n";
    std::fs::write(folder.path().join("s.ron"), scene).unwrap();
    folder
}

#[test]
fn a_sidecar_says_what_the_file_cannot() {
    let folder = home(
        r#"{"version": 1, "fps": 30, "frames": [5, 9], "exposure_stops": 1.5, "collections": {"Toys": ["Egg"]}}"#,
    );
    let path = folder.path().join("s.ron");
    let options = LoadOptions {
        overrides: vec![(
            "regions".to_owned(),
            r#"[(name: "toys", on: Collection("Toys")), (name: "none", on: Collection("Gone"))]"#.to_owned(),
        )],
        ..LoadOptions::default()
    };
    let loaded = load(&path, &options).unwrap_or_else(|report| panic!("{report}"));
    let timeline = &loaded.scene.timeline;
    assert_eq!((timeline.fps, timeline.first, timeline.last), (30.0, 5, 9));
    let stage = &loaded.scene.stage;
    let [toys, none] = [0, 1].map(|index| loaded.scene.regions[index].on.clone());
    assert_eq!(
        [toys.reaches(stage, "Egg"), toys.reaches(stage, "Ball"), none.reaches(stage, "Egg")],
        [true, false, false]
    );
    assert!(
        loaded.warnings.iter().any(|warning| warning.message.contains("\"Gone\"")),
        "{:?}",
        loaded.warnings
    );
    assert!(loaded.inputs().contains(&folder.path().join("shot.impasto.json")));
    let frame = prepare(std::sync::Arc::new(loaded)).unwrap().at(5.0, &FrameOptions::new([96, 54]));
    assert_eq!(frame.exposure, 1.5f32.exp2());
}

#[test]
fn a_bad_sidecar_is_one_error_with_its_place() {
    for (sidecar, place, word) in [
        ("{\"version\": 1,\n \"fps\": \"many\"}", "shot.impasto.json: line 2", "invalid type"),
        ("{\"version\": 7}", "shot.impasto.json:", "version"),
        ("not at all", "shot.impasto.json: line 1", "expected"),
        (r#"{"version": 1, "world": [0.5, -1, 0]}"#, "shot.impasto.json:", "`world`"),
        (r#"{"version": 1, "caches": {"Ball": "../../etc/passwd"}}"#, "", "folder"),
        (r#"{"version": 1, "caches": {"Ball": "gone.pc2"}}"#, "", "gone.pc2"),
        // A cache that is no PC2 file.
        (r#"{"version": 1, "caches": {"Ball": "shot.glb"}}"#, "", "PC2"),
    ] {
        let folder = home(sidecar);
        let report = load(&folder.path().join("s.ron"), &LoadOptions::default()).unwrap_err().to_string();
        assert!(
            report.contains(place) && report.contains(word) && report.lines().count() <= 2,
            "{sidecar}: {report}"
        );
    }
}

/// The depth, light and shadow planes of a scene at frame 12, seen through its camera after `change`.
fn planes(
    renderer: &mut impasto_gl_render::Renderer,
    scene: &Path,
    change: impl Fn(&mut CameraPose),
) -> Vec<(String, Vec<f32>)> {
    let loaded = load(scene, &LoadOptions::default()).unwrap_or_else(|report| panic!("{report}"));
    let painting = prepare(std::sync::Arc::new(loaded)).unwrap();
    let options = FrameOptions::new([320, 180]);
    let mut camera = camera_at(painting.scene(), 12.0);
    change(&mut camera);
    let frame = painting.seen_by(&camera, 12.0, &options);
    renderer.gather_paint(true);
    renderer.render(&frame).unwrap();
    let wanted = AovSet::of_words(["depth", "light", "shadow"]).unwrap();
    let drawn = Drawn { painting: &painting, frame: &frame, number: 12.0, options: &options, wanted };
    let found = read(renderer, &drawn).unwrap();
    let of_data =
        found.channels.into_iter().filter(|channel| channel.name.contains('.') || channel.name == "Z");
    of_data
        .map(|Channel { name, samples }| match samples {
            Samples::Half(values) => (name, values.iter().map(|value| value.to_f32()).collect()),
            Samples::Float(values) => (name, values),
            Samples::Uint(_) => (name, Vec::new()),
        })
        .collect()
}

/// A lens shifted by whole pixels gives the same picture, moved: depth, light and shadow move with the surfaces.
#[test]
fn a_shifted_lens_moves_the_picture_and_nothing_else() {
    // These are even, because ambient occlusion is computed at every second pixel. Those pixels must fall on the same
    // places of the surfaces.
    const BY_PX: [i32; 2] = [32, -16];
    let scene = root().join("scenes/lane.ron");
    let mut renderer = renderer(Driver::Auto);
    let still = planes(&mut renderer, &scene, |_| {});
    let moved = planes(&mut renderer, &scene, |camera| {
        // A shift counts in half heights of the picture, which is 180 pixels high.
        camera.shift = DVec2::new(f64::from(BY_PX[0]), f64::from(BY_PX[1])) / 90.0;
    });
    assert!(still.len() >= 5, "{:?}", still.iter().map(|(name, _)| name).collect::<Vec<_>>());
    for ((name, still), (_, moved)) in still.iter().zip(&moved) {
        let (mut off, mut count) = (0, 0);
        for y in 20..160i32 {
            for x in 30..290i32 {
                // Rows run downwards.
                let there = (x + BY_PX[0], y - BY_PX[1]);
                let at = |(x, y): (i32, i32)| (y * 320 + x) as usize;
                let (own, other) = (still[at((x, y))], moved[at(there)]);
                count += 1;
                off += usize::from((own - other).abs() > 0.02 * own.abs().max(0.2));
            }
        }
        // Pixels at edges of bodies may differ. So may pixels at edges of shadows, since the shadow map is fitted to
        // the view.
        assert!(off * 100 < count * 2, "{name}: {off} of {count} pixels differ");
    }
}

fn run(arguments: &[&str]) -> std::process::Output {
    Command::new(impasto()).args(arguments).output().unwrap()
}

/// A running `impasto serve`, and its stdout.
struct Asking(std::process::Child, BufReader<std::process::ChildStdout>);

impl Asking {
    fn begin(scene: &Path) -> Self {
        let mut child = Command::new(impasto())
            .args(["serve", &scene.to_string_lossy()])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let out = BufReader::new(child.stdout.take().unwrap());
        Self(child, out)
    }

    fn say(&mut self, line: &str) {
        writeln!(self.0.stdin.as_mut().unwrap(), "{line}").unwrap();
    }

    /// Waits for the next answer with one of these events, and returns it.
    fn hear(&mut self, events: &[&str]) -> Value {
        loop {
            let mut line = String::new();
            assert!(self.1.read_line(&mut line).unwrap() > 0, "impasto serve has ended");
            let value: Value = serde_json::from_str(&line).unwrap();
            if events.contains(&value["event"].as_str().unwrap()) {
                return value;
            }
        }
    }
}

#[test]
fn serve_gives_the_pixels_of_render_and_goes_on_after_errors() {
    let folder = home(r#"{"version": 1, "frames": [1, 3]}"#);
    let scene = folder.path().join("s.ron");
    let mut asking = Asking::begin(&scene);
    assert_eq!(asking.hear(&["started"])["version"], 1);
    asking.say("what?");
    assert!(asking.hear(&["error"])["message"].as_str().unwrap().contains("not understood"));
    let order = |output: &str, plain: bool| {
        let output = folder.path().join(output);
        json!({ "command": "render", "id": 4, "frames": "1-3", "output": output, "size": [64, 36], "aovs": ["depth"],
                "plain": plain, "ahead": 1 })
        .to_string()
    };
    asking.say(&order("plain_##.exr", true));
    assert_eq!(asking.hear(&["ready"])["last"], 3);
    for frame in 1..=3 {
        let heard = asking.hear(&["frame", "error"]);
        assert_eq!((&heard["frame"], &heard["id"]), (&json!(frame), &json!(4)));
        // The file after the next one is not written until this one is taken.
        let after = folder.path().join(format!("plain_{:02}.exr", frame + 2));
        assert!(!after.exists());
        asking.say(r#"{"command": "taken"}"#);
    }
    asking.hear(&["done"]);
    let done = run(&[
        "render",
        &scene.to_string_lossy(),
        "-f",
        "1-3",
        "--size",
        "64x36",
        "--aov",
        "depth",
        "-q",
        "-o",
        &folder.path().join("own_##.exr").to_string_lossy(),
    ]);
    assert!(done.status.success());
    for frame in 1..=3 {
        let read = |name: &str| {
            let file = folder.path().join(format!("{name}_{frame:02}.exr"));
            exr::prelude::read_first_flat_layer_from_file(file).unwrap().layer_data.channel_data
        };
        assert_eq!(read("plain"), read("own"));
    }
    // A scene that becomes wrong is reported with the place of its error. Once mended, it is painted again.
    let text = std::fs::read_to_string(&scene).unwrap();
    std::fs::write(&scene, text.replace("size", "sise")).unwrap();
    asking.say(&order("later_##.exr", false));
    assert!(asking.hear(&["error", "frame"])["message"].as_str().unwrap().contains("s.ron:5:"));
    std::fs::write(&scene, &text).unwrap();
    asking.say(&order("later_##.exr", false));
    asking.hear(&["frame"]);
    asking.say(r#"{"command": "stop"}"#);
    asking.hear(&["stopped", "done"]);
    drop(asking.0.stdin.take());
    assert!(asking.0.wait().unwrap().success());
}

#[test]
fn set_writes_one_field_and_leaves_the_text() {
    let folder = home(r#"{"version": 1}"#);
    let scene = folder.path().join("s.ron");
    let text = || std::fs::read_to_string(&scene).unwrap();
    let before = text();
    let set = |values: &[&str]| {
        let mut arguments = vec!["set".to_owned(), scene.to_string_lossy().into_owned()];
        arguments.extend(values.iter().map(|&value| value.to_owned()));
        let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
        let done = run(&arguments);
        (done.status.success(), String::from_utf8(done.stderr).unwrap())
    };
    assert!(set(&["strokes.scale=1.5"]).0);
    assert!(text().contains("// mine") && text().contains("strokes: (scale: 1.5"), "{}", text());
    assert!(set(&["strokes.scale=2"]).0);
    assert!(
        set(&[
            r#"regions+=(name: "a", on: Object("Ball"))"#,
            r#"regions+=(name: "b", on: EachMaterial("x"))"#
        ])
        .0
    );
    assert!(set(&["regions[1].strokes.coverage=3", "regions.a.turn_deg=7"]).0);
    let found = load(&scene, &LoadOptions::default()).unwrap().scene;
    assert_eq!(
        (found.strokes.scale, found.regions[1].strokes.coverage, found.regions[0].turn_deg),
        (Some(2.0), Some(3.0), 7.0)
    );
    // `[1]+=` inserts an item before item 1, and an empty value removes an item.
    let names = || {
        let scene = load(&scene, &LoadOptions::default()).unwrap().scene;
        scene.regions.iter().map(|region| region.name.clone()).collect::<Vec<_>>()
    };
    assert!(set(&[r#"regions[1]+=(name: "c", on: Everything)"#]).0);
    assert_eq!(names(), ["a", "c", "b"]);
    assert!(set(&[r#"regions.a+=(name: "d", on: Everything)"#, "regions[0]=", "regions.c="]).0);
    assert_eq!(names(), ["a", "b"]);
    // Once all values are removed, the text is as before, but for white space.
    assert!(
        set(&[
            "strokes.scale=",
            "regions[1].strokes.coverage=",
            "regions[0].turn_deg=",
            "strokes=",
            "regions="
        ])
        .0
    );
    let without = |text: &str| text.split_whitespace().collect::<String>();
    assert_eq!(without(&text()), without(&before));
    // Wrong values are refused, and the file stays as it was.
    for wrong in
        ["strokes.scale=1e9", "strokes.skale=1", "strokes.scale=many", "regions+=3", "size+=1", "nothing"]
    {
        let before = text();
        let (is_done, words) = set(&[wrong]);
        assert!(!is_done && !words.is_empty() && text() == before, "{wrong}: {words}");
    }
    // A file that is no text is refused as every command refuses it.
    std::fs::write(&scene, b"(version: 1,\n name: \"\xff\")").unwrap();
    let (is_done, words) = set(&["strokes.scale=2"]);
    assert!(!is_done && words.contains(":2:9: error: this file is not UTF-8 text"), "{words}");
}
