//! Tests that every body of the shipped noise scenes is seen, that bad materials are reported, and that extreme ones
//! give a picture.

use std::collections::BTreeSet;
use std::sync::Arc;

use impasto_gl_render::context::Driver;
use impasto_painting::{FrameOptions, prepare};
use impasto_tests::pictures::renderer;
use impasto_tests::scenes;

use crate::hostile_scenes::{load_in_folder, scene_text};

#[test]
fn every_body_of_the_shipped_scenes_is_seen() {
    for (scene, frame) in [("noise_displace", 12.0), ("explosion", 30.0)] {
        let painting = scenes::painting(scene);
        let mut renderer = renderer(Driver::Egl);
        renderer.render(&painting.at(frame, &FrameOptions::new([192, 108]))).unwrap();
        let bodies: BTreeSet<u32> = renderer.read_reference().body_id.into_iter().collect();
        let all = 1..=painting.scene().objects.len() as u32;
        // The core lies inside another body, so it need not be seen.
        let core = painting.scene().objects.iter().position(|object| object.name == "core");
        for body in all.filter(|body| Some(*body as usize) != core.map(|index| index + 1)) {
            assert!(bodies.contains(&body), "{scene}: body {body} is not seen");
        }
    }
}

#[test]
fn a_bad_material_is_named_with_its_place() {
    let folder = tempfile::tempdir().unwrap();
    for (noise, says) in [
        ("surface: (layer_count: 0)", "scene.ron:2:92: error: 0 is out of range; give a number from 1 to 64"),
        ("surface: (layer_count: 1000000000)", "scene.ron:2:92: error: 1e9 is out of range"),
        ("surface: (layer_count: 1e9)", "scene.ron:2:92: error: `1e9` does not fit"),
        ("vertex: (value: (NaN, 0.1))", "scene.ron:2:85: error: NaN is out of range"),
        ("vertex: (value: 0.1)", "scene.ron:2:85: error: `0.1` does not fit"),
        ("vertex: (scale: inf)", "scene.ron:2:85: error: inf is out of range"),
        ("vertex: (texture: \"gone.png\")", "scene.ron:2:87: error: \"gone.png\" was not found"),
        ("surface: (texture: \"bomb.png\")", "scene.ron:2:88: limit: "),
        ("surface: (texture: \"/etc/passwd\")", "scene.ron:2:88: error: \"/etc/passwd\" is refused"),
        ("surface: (opacity: 1.5)", "error: 1.5 is out of range; give a number from 0 to 1"),
        ("period_secs: 0", "error: 0 is out of range"),
        ("surface: (tint: \"red\")", "it takes a colour"),
        ("octaves: 3", "error: unknown field `octaves`"),
    ] {
        let fields =
            format!("objects: [(name: \"a\", mesh: \"cube.obj\", material: (noise_displace: ({noise})))]");
        let report = load_in_folder(folder.path(), scene_text(&fields).as_bytes()).unwrap_err();
        let said: Vec<String> = report.0.iter().map(ToString::to_string).collect();
        let errors = report.0.iter().filter(|problem| problem.severity.is_fatal()).count();
        assert!(errors == 1 && said.iter().any(|line| line.contains(says)), "{noise}: {said:?}");
    }
}

#[test]
fn extreme_but_allowed_values_give_a_picture() {
    let folder = tempfile::tempdir().unwrap();
    let mut renderer = renderer(Driver::Egl);
    for noise in [
        "vertex: (value: (1000, -1000), scale: 1000)",
        "vertex: (value: (0, 0), scale: -1000, along: Normal, normals: Displaced), surface: None",
        "surface: (layer_count: 64, speed: -1000, tiling: (1000, 0), intensity: 1000, bloom: 10, threshold: 0), period_secs: 0.01",
        "surface: (layer_count: 1, opacity: 0)",
        "vertex: None, surface: None",
    ] {
        let fields = format!(
            "objects: [(name: \"a\", mesh: \"cube.obj\", material: (noise_displace: ({noise})))], timeline: (fps: 24, first: -1000000000, last: -999999999)"
        );
        let loaded = load_in_folder(folder.path(), scene_text(&fields).as_bytes());
        let loaded = loaded.unwrap_or_else(|report| panic!("{noise}: {report}"));
        let painting = prepare(Arc::new(loaded)).unwrap();
        let frame = painting.at(-1e9, &FrameOptions::new([96, 54]));
        let finite = |stroke: &impasto_painting::frame::Stroke| {
            stroke.angle_rad.is_finite() && stroke.center_px.iter().all(|at| at.is_finite())
        };
        assert!(frame.strokes.iter().all(finite), "{noise}");
        renderer.render(&frame).unwrap();
        assert!(renderer.read_reference().depth.iter().all(|depth| depth.is_finite()), "{noise}");
        let paint = renderer.read_paint();
        assert!(paint.iter().flatten().all(|value| value.is_finite()), "{noise}");
    }
}

/// The plain render leaves such a body out, so paint must ignore it too. Then the edges of bodies behind it are as
/// sharp as if it were hidden.
#[test]
fn a_wholly_transparent_body_is_as_if_hidden() {
    let painted = |field: &str, value: &str| {
        let set = [
            (field, value),
            (
                "objects.ball.keys",
                "[(frame: 0, translation: (0.85, 0.7, 1.2)), (frame: 24, translation: (0, 0.7, 1.2))]",
            ),
            ("style", "RotatingStrokes(solver: Tangent)"),
        ];
        let painting = scenes::painting_with("noise_displace", &set);
        let mut renderer = renderer(Driver::Egl);
        renderer.render(&painting.at(7.0, &FrameOptions::new([256, 144]))).unwrap();
        renderer.read_paint()
    };
    let transparent = painted("objects.ball.material.noise_displace.surface.opacity", "0");
    let hidden = painted("objects.ball.hidden", "true");
    let differ = transparent.iter().zip(&hidden).filter(|(one, other)| one != other).count();
    assert_eq!(differ, 0, "pixels of {}", hidden.len());
}
