//! The shipped scenes as they were looked at and found good, and scenes that are not.

use std::collections::BTreeSet;
use std::sync::Arc;

use impasto_gl_render::context::Driver;
use impasto_painting::{FrameOptions, prepare};
use impasto_scene::load::{LoadOptions, load};
use impasto_tests::command::root;
use impasto_tests::pictures::renderer;

use crate::hostile_scenes::{load_in_folder, scene_text};

const SIZE_PX: [u32; 2] = [192, 108];

/// The colours of a golden, three bytes a pixel.
fn golden(name: &str) -> Vec<u8> {
    let path = root().join(format!("tests/goldens/noise_displace/{name}.png"));
    let file = std::fs::File::open(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let mut reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut bytes).unwrap();
    assert_eq!(([info.width, info.height], info.color_type), (SIZE_PX, png::ColorType::Rgb));
    bytes
}

#[test]
fn row_10_three_bodies_look_as_they_did_on_either_driver() {
    for (scene, frame) in [("noise_displace", 12.0), ("explosion", 30.0)] {
        let path = root().join(format!("scenes/{scene}.ron"));
        let loaded = load(&path, &LoadOptions::default()).unwrap_or_else(|report| panic!("{report}"));
        let painting = prepare(Arc::new(loaded)).unwrap();
        let expected = golden(scene);
        for driver in [Driver::Egl, Driver::Osmesa] {
            let mut renderer = renderer(driver);
            let picture = renderer.render(&painting.at(frame, &FrameOptions::new(SIZE_PX))).unwrap();
            let bodies: BTreeSet<u32> = renderer.read_reference().body_id.into_iter().collect();
            let all = 1..=painting.scene().objects.len() as u32;
            let within = painting.scene().objects.iter().position(|object| object.name == "core");
            for body in all.filter(|body| Some(*body as usize) != within.map(|index| index + 1)) {
                assert!(bodies.contains(&body), "{scene}: body {body} is not seen");
            }
            let pixels = picture.rgba8.chunks_exact(4).flat_map(|pixel| &pixel[..3]);
            let off = pixels.zip(&expected).map(|(a, b)| f64::from(a.abs_diff(*b))).sum::<f64>();
            let mean = off / expected.len() as f64;
            println!("{scene} {driver:?}: {mean:.3} of 255 from its golden");
            // Strokes may lie in another order by a rounding; the picture as a whole may not.
            assert!(mean < 1.0, "{scene} {driver:?}: {mean} of 255 from its golden");
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
