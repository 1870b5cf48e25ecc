//! Tests against a real Blender. It makes shots, exports them, and says where everything is (`tests/blender/shots.py`).
//! It also reads our EXR files in its compositor (`tests/blender/compositing.py`).
//!
//! The tests run where `IMPASTO_BPY` names a Python that has Blender as a module (`pip install bpy`), and are skipped
//! elsewhere.

use std::path::Path;
use std::process::Command;
use std::sync::Arc;

use glam::{DVec2, DVec3, DVec4};
use impasto_painting::{Painting, Preparer};
use impasto_scene::document::Lens;
use impasto_scene::load::{LoadOptions, load};
use impasto_scene::motion::{CameraPose, camera_at, hidden_at, poses_at};
use serde_json::Value;

const SIZE_PX: DVec2 = DVec2::new(640.0, 360.0);

/// The furthest that a vertex may be from where Blender has it.
const MOST_PX: f64 = 0.01;

/// How far a field of view may be from Blender's.
const MOST_RAD: f64 = 1e-5;

/// The furthest that a vertex may be from where Blender has it in the world, as a share of its object's size.
const MOST_SHARE: f64 = 3e-6;

/// Where a point is in the picture, pixels from the lower left; `None` behind the eye.
fn seen(camera: &CameraPose, at: DVec3) -> Option<DVec2> {
    let view = camera.view_from_world() * DVec4::from((at, 1.0));
    let half_height = match camera.lens {
        Lens::Perspective { fov_y_deg, .. } => -view.z * (0.5 * fov_y_deg.to_radians()).tan(),
        Lens::Orthographic { height, .. } => 0.5 * height,
    };
    let from_middle = view.truncate().truncate() / half_height * (0.5 * SIZE_PX.y);
    let shift_px = camera.shift * (0.5 * SIZE_PX.y);
    (view.z < 0.0).then_some(from_middle + shift_px + 0.5 * SIZE_PX)
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
}

/// Blender's places of an object's vertices in a frame: in the world (Y up), and in the picture.
fn places(frame: &Value, object: &str) -> Vec<(DVec3, DVec2)> {
    let rows = frame["objects"][object].as_array().into_iter().flatten().map(numbers);
    rows.map(|row| (DVec3::new(row[0], row[2], -row[1]), DVec2::new(row[3], row[4]))).collect()
}

/// Our vertices of an object in a frame, in the world.
fn vertices(painting: &Painting, index: usize, frame: f64) -> Vec<DVec3> {
    let pose = poses_at(painting.scene(), frame)[index];
    let positions = painting.surface(index).positions_at(&painting.shapes_at(frame)[index]);
    positions.iter().map(|at| pose.transform_point3(at.as_dvec3())).collect()
}

/// The largest differences from Blender over all frames and objects: of a vertex in the picture, pixels; of the field
/// of view, radians; of a vertex in the world, as a share of its object's size.
fn differences(shot: &Path, frames: &[Value]) -> [f64; 3] {
    let loaded = load(shot, &LoadOptions::default()).unwrap_or_else(|report| panic!("{report}"));
    let painting = Preparer::default().prepare_plain(&Arc::new(loaded.clone())).unwrap();
    let (mut most_px, mut most_rad, mut most_share, mut compared) = (0.0f64, 0.0f64, 0.0f64, 0);
    for (index, object) in loaded.scene.objects.iter().enumerate() {
        // Our vertices are matched with Blender's in one frame. In all others the pairs must stay together.
        let Some(shown) = frames.iter().find(|truth| !places(truth, &object.name).is_empty()) else {
            panic!("Blender shows no {:?}", object.name)
        };
        let first = vertices(&painting, index, shown["frame"].as_f64().unwrap());
        let (low, high) = first.iter().fold((DVec3::MAX, DVec3::MIN), |(l, h), at| (l.min(*at), h.max(*at)));
        let pairs: Vec<usize> = places(shown, &object.name)
            .iter()
            .map(|(at, _)| {
                let away = |index: &usize| first[*index].distance_squared(*at);
                (0..first.len()).min_by(|a, b| away(a).total_cmp(&away(b))).unwrap()
            })
            .collect();
        for truth in frames {
            let frame = truth["frame"].as_f64().unwrap();
            let (camera, ours) = (camera_at(&loaded.scene, frame), vertices(&painting, index, frame));
            let blender_hides = places(truth, &object.name).is_empty();
            let name = &object.name;
            assert_eq!(
                hidden_at(&loaded.scene, frame)[index],
                blender_hides,
                "whether {name:?} is hidden in frame {frame}: ours, Blender's"
            );
            for (&own, (in_world, blenders)) in pairs.iter().zip(places(truth, &object.name)) {
                most_share = most_share.max(ours[own].distance(in_world) / (high - low).length());
                let Some(at) = seen(&camera, ours[own]) else { continue };
                most_px = most_px.max(at.distance(blenders));
                compared += 1;
            }
        }
    }
    for truth in frames {
        let camera = camera_at(&loaded.scene, truth["frame"].as_f64().unwrap());
        if let (Lens::Perspective { fov_y_deg, .. }, Some(blenders)) =
            (camera.lens, truth["fov_y_rad"].as_f64())
        {
            most_rad = most_rad.max((fov_y_deg.to_radians() - blenders).abs());
        }
    }
    assert!(compared > 2_000, "only {compared} vertices were compared");
    [most_px, most_rad, most_share]
}

#[test]
fn shots_stand_where_blender_has_them() {
    let Some(python) = std::env::var_os("IMPASTO_BPY") else {
        return eprintln!("skipped: IMPASTO_BPY names no Python with Blender");
    };
    let folder = tempfile::tempdir().unwrap();
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("blender/shots.py");
    let made = Command::new(python).arg(script).arg(folder.path()).output().unwrap();
    assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
    for name in ["nested", "constrained", "layered", "mirrored", "bending"] {
        let truth = std::fs::read_to_string(folder.path().join(format!("{name}.json"))).unwrap();
        let frames: Vec<Value> = serde_json::from_str(&truth).unwrap();
        let [px, rad, share] = differences(&folder.path().join(format!("{name}.glb")), &frames);
        let count = frames.len();
        eprintln!(
            "{name}: at most {px:.5} px, {rad:.1e} rad and {share:.1e} of a size from Blender in {count} frames"
        );
        assert!(
            px <= MOST_PX && rad <= MOST_RAD && share <= MOST_SHARE,
            "{name}: {px} px, {rad} rad, {share}"
        );
    }
}

/// The shots of `tests/blender/extension/shots.py`, as the extension exports them: with point caches, cuts, lens shift
/// and instances. How far vertices are off in the world is printed, and not checked.
#[test]
fn what_the_extension_exports_stands_where_blender_has_it() {
    let Some(python) = std::env::var_os("IMPASTO_BPY") else {
        return eprintln!("skipped: IMPASTO_BPY names no Python with Blender");
    };
    let folder = tempfile::tempdir().unwrap();
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("blender/extension/shots.py");
    let made = Command::new(python)
        .arg(script)
        .arg(folder.path())
        .env("PYTHONDONTWRITEBYTECODE", "1")
        .output()
        .unwrap();
    assert!(made.status.success(), "{}", String::from_utf8_lossy(&made.stderr));
    for name in ["walk", "cloth", "cuts", "instances", "rich", "slanted"] {
        let truth = std::fs::read_to_string(folder.path().join(format!("{name}.json"))).unwrap();
        let frames: Vec<Value> = serde_json::from_str(&truth).unwrap();
        let [px, rad, share] = differences(&folder.path().join(name).join("shot.glb"), &frames);
        eprintln!("{name}: at most {px:.5} px, {rad:.1e} rad and {share:.1e} of a size from Blender");
        assert!(px <= MOST_PX && rad <= MOST_RAD, "{name}: {px} px, {rad} rad, {share}");
    }
}

/// The Cryptomatte node finds an object by its name, here of Latin and Japanese letters, and gives the coverage that
/// the file states.
#[test]
fn the_compositor_reads_passes_and_mattes() {
    let Some(python) = std::env::var_os("IMPASTO_BPY") else {
        return eprintln!("skipped: IMPASTO_BPY names no Python with Blender");
    };
    const NAME: &str = "Café 日";
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    std::fs::write(at("sheet.obj"), "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n").unwrap();
    let scene = format!(
        "#![enable(implicit_some)]\n(version: 1, size: (96, 54), \
         camera: (keys: [(frame: 0, eye: (0, 0, 5), target: (0, 0, 0))]), \
         objects: [(name: \"{NAME}\", mesh: \"sheet.obj\", particles: 400)], strokes: (length_px: 16, width_px: 5))"
    );
    std::fs::write(at("a.ron"), scene).unwrap();
    let mut render = Command::new(impasto_tests::command::impasto());
    render.current_dir(folder.path()).args(["render", "a.ron", "-f", "0", "-o", "a.exr", "--aov", "all"]);
    assert!(render.status().unwrap().success());
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("blender/compositing.py");
    let mut blender = Command::new(python);
    blender.arg(script).arg(at("a.exr")).arg(folder.path()).args([NAME, "96", "54"]);
    let done = blender.output().unwrap();
    assert!(done.status.success(), "{}", String::from_utf8_lossy(&done.stderr));
    assert!(
        !String::from_utf8_lossy(&done.stderr).contains("report this as a bug"),
        "a pass that Blender cannot read"
    );
    let passes: Value = serde_json::from_slice(&std::fs::read(at("passes.json")).unwrap()).unwrap();
    for wanted in ["Combined", "Depth", "N", "P", "motion", "light", "objectid", "CryptoStroke00"] {
        assert!(
            passes["outputs"].as_array().unwrap().iter().any(|name| name == wanted),
            "{wanted}: {passes}"
        );
    }
    let read = |file: &str, channels: &[&str]| {
        impasto_frame_files::exr_file::read(&at(file), channels).unwrap().values
    };
    let stated = read("a.exr", &["CryptoObject00.R", "CryptoObject00.G"]);
    let matte = read("matte.exr", &["R"]);
    let bits = impasto_aovs::cryptomatte::id_bits(NAME);
    let covered = stated[0].iter().zip(&stated[1]);
    let covered: Vec<f32> =
        covered.map(|(id, amount)| if id.to_bits() == bits { *amount } else { 0.0 }).collect();
    assert!(covered.iter().sum::<f32>() > 500.0, "the matte of the sheet in our file covers too few pixels");
    let off = covered.iter().zip(&matte[0]).map(|(stated, found)| (stated - found).abs()).fold(0.0, f32::max);
    println!("Blender's matte is off by at most {off}");
    assert!(off < 1e-6, "Blender's matte is off by {off}");
}
