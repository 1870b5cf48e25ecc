//! Tests of shots: what a glTF file brings into a scene, what the scene overrides, and what stays when the file is
//! exported again.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use glam::DVec3;
use impasto_core::TriangleMesh;
use impasto_editor_model::command::{Command, Edit, KeyOf, SceneEdit, Time};
use impasto_editor_model::{Document, Item};
use impasto_gl_render::context::Driver;
use impasto_painting::{FrameOptions, prepare};
use impasto_scene::document::{Lens, LightKind};
use impasto_scene::load::{LoadOptions, load};
use impasto_scene::loaded::LoadedScene;
use impasto_scene::{motion, save};
use impasto_tests::glb::{self, Node};
use impasto_tests::pictures::{renderer, wrap_half};
use impasto_tests::shapes;

/// A folder with a shot of two balls and a box between them.
struct Home(tempfile::TempDir);

impl Home {
    fn new() -> Self {
        let home = Self(tempfile::tempdir().unwrap());
        home.export(&shapes::sphere(24, 12), ["Ball", "Box", "Far"]);
        home
    }

    fn at(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// Writes the shot, with nodes in the order of `names`. `Box` is a cube, all others are the mesh `ball`. `Ball`
    /// turns by 90 degrees.
    fn export(&self, ball: &TriangleMesh, names: [&str; 3]) {
        let cube = shapes::cube();
        let nodes = names.map(|name| {
            let (mesh, x) = match name {
                "Ball" | "Kugel" => (ball, -1.2),
                "Box" => (&cube, 1.2),
                _ => (ball, 3.4),
            };
            let turn_deg = if x < 0.0 { 90.0 } else { 0.0 };
            Node { name, mesh, translation: [x, 0.0, 0.0], turn_deg }
        });
        glb::write(&self.at("shot.glb"), &nodes);
    }

    fn scene(&self, text: &str) -> LoadedScene {
        std::fs::write(self.at("s.ron"), text).unwrap();
        loaded(&self.at("s.ron"))
    }
}

fn loaded(path: &Path) -> LoadedScene {
    load(path, &LoadOptions::default()).unwrap_or_else(|report| panic!("{report}"))
}

fn names(loaded: &LoadedScene) -> Vec<&str> {
    loaded.scene.objects.iter().map(|object| object.name.as_str()).collect()
}

#[test]
fn a_shot_brings_objects_camera_light_and_frames_and_none_is_saved() {
    let home = Home::new();
    let shot = loaded(&home.at("shot.glb"));
    assert_eq!(names(&shot), ["Ball", "Box", "Far"]);
    assert_eq!((shot.scene.timeline.first, shot.scene.timeline.last), (0, 48));
    assert_eq!(shot.scene.size, (1280, 720));
    let kinds: Vec<LightKind> = shot.scene.lights.iter().map(|light| light.kind).collect();
    assert_eq!(kinds, [LightKind::Sun, LightKind::Ambient]);
    let camera = motion::camera_at(&shot.scene, 12.0);
    assert!((camera.eye - DVec3::new(0.0, 0.0, 6.0)).length() < 1e-9);
    assert!(
        matches!(camera.lens, Lens::Perspective { fov_y_deg, .. } if (fov_y_deg - 0.6f64.to_degrees()).abs() < 1e-5)
    );
    // A quarter turn in 48 frames, evenly: 30 degrees at frame 16.
    let pose = motion::poses_at(&shot.scene, 16.0)[0];
    let x = pose.transform_vector3(DVec3::X);
    assert!((x.z.atan2(x.x).to_degrees() + 30.0).abs() < 1e-4, "{x}");
    // The saved scene names the file, and nothing that is in it.
    let text = save::to_ron(&shot.scene);
    assert!(text.contains("shot: \"shot.glb\""), "{text}");
    assert!(["objects", "camera", "timeline", "lights"].iter().all(|field| !text.contains(field)), "{text}");
    let again = home.scene(&text);
    assert_eq!(names(&again), names(&shot));
    assert_eq!(again.scene.lights, shot.scene.lights);
    assert_eq!(save::to_ron(&again.scene), text);
    // Two nodes with the same mesh share it.
    let mesh = |index: usize| &shot.meshes[&shot.scene.objects[index].mesh];
    assert!(Arc::ptr_eq(mesh(0), mesh(2)) && !Arc::ptr_eq(mesh(0), mesh(1)));
    let painting = prepare(Arc::new(shot)).unwrap();
    let frame = painting.at(0.0, &FrameOptions::new([320, 180]));
    assert!(frame.strokes.iter().filter(|stroke| stroke.body_id == 1).count() > 100);
}

const SCENE: &str = r##"#![enable(implicit_some)]
(
    version: 1,
    size: (640, 360),
    shot: "shot.glb",
    timeline: (fps: 12, first: 3, last: 7),
    objects: [
        (name: "Box", mesh: "shot.glb#Box", keys: [(frame: 0, translation: (0, 2, 0))]),
        (name: "Ball", material: (color: "#b3262a")),
        (name: "Bal", hold: 2),
    ],
    regions: [
        (name: "fur", on: Object("Bal")),
        (name: "skin", on: Object("Ball"), direction: Angle(20)),
    ],
)
"##;

#[test]
fn a_scene_overrides_a_shot_by_name_and_what_is_gone_stays_in_the_file() {
    let home = Home::new();
    let scene = home.scene(SCENE);
    assert_eq!(names(&scene), ["Box", "Ball", "Far"]);
    let said: Vec<String> = scene.warnings.iter().map(ToString::to_string).collect();
    assert!(
        said.iter().any(|line| line.contains("no object \"Bal\"") && line.contains("did you mean \"Ball\"")),
        "{said:?}"
    );
    assert!(said.iter().any(|line| line.contains("there is no object \"Bal\"")), "{said:?}");
    // Frames count at the scene's own rate, and an object's keys in the scene replace the shot's track.
    assert_eq!((scene.scene.timeline.first, scene.scene.timeline.last), (3, 7));
    let poses = motion::poses_at(&scene.scene, 8.0);
    assert_eq!(poses[0].translation, DVec3::new(0.0, 2.0, 0.0));
    let x = poses[1].transform_vector3(DVec3::X);
    assert!((x.z.atan2(x.x).to_degrees() + 30.0).abs() < 1e-4, "frame 8 at 12 a second is 2/3 s");
    // A deleted object would come back from the shot, so it is saved as hidden.
    let mut edited = scene.scene.clone();
    edited.objects.retain(|object| object.name != "Far");
    let text = save::to_ron(&edited);
    for part in [
        "(name: \"Far\", hidden: true)",
        "(name: \"Bal\", hold: 2)",
        "(name: \"Ball\", material: (color: \"#b3262a\"))",
    ] {
        assert!(text.contains(part), "{part} in {text}");
    }
    let again = home.scene(&text);
    assert_eq!(names(&again), ["Box", "Ball", "Far"]);
    assert!(again.scene.objects[2].hidden);
    assert_eq!(save::to_ron(&again.scene), text);
}

#[test]
fn a_light_of_the_shot_that_was_deleted_stays_dark() {
    let home = Home::new();
    let shot = loaded(&home.at("shot.glb"));
    let mut edited = shot.scene.clone();
    let sun = edited.lights.iter().position(|light| light.kind == LightKind::Sun).unwrap();
    let name = edited.lights.remove(sun).name;
    let text = save::to_ron(&edited);
    let again = home.scene(&text);
    assert_eq!(again.scene.lights.len(), shot.scene.lights.len());
    for light in motion::lights_at(&again.scene, 10.0) {
        assert_eq!(light.intensity == 0.0, light.name == name, "{light:?}");
        assert_ne!(light.kind, LightKind::Sun, "a dark sun would still be the light that casts shadows");
    }
    assert_eq!(save::to_ron(&again.scene), text);
}

#[test]
fn a_camera_of_several_is_chosen_by_name() {
    let home = Home::new();
    let text = std::fs::read(home.at("shot.glb")).unwrap();
    // A second camera: the node of the sun gets one.
    let with_two: Vec<u8> = {
        let json_end = 20 + u32::from_le_bytes(text[12..16].try_into().unwrap()) as usize;
        let mut root: serde_json::Value = serde_json::from_slice(&text[20..json_end]).unwrap();
        root["nodes"][4]["camera"] = serde_json::json!(0);
        glb::bytes(&root, text[json_end + 8..].to_vec())
    };
    std::fs::write(home.at("shot.glb"), with_two).unwrap();
    let first = home.scene("(version: 1, shot: \"shot.glb\")");
    let warnings: Vec<String> = first.warnings.iter().map(ToString::to_string).collect();
    assert!(
        warnings.iter().any(|line| line.contains("there are 2 cameras") && line.contains("of_shot: \"Sun\"")),
        "{warnings:?}"
    );
    assert_eq!(motion::camera_at(&first.scene, 0.0).eye.z, 6.0);
    let other = home.scene("(version: 1, shot: \"shot.glb\", camera: (of_shot: \"Sun\"))");
    assert!(other.warnings.is_empty(), "{:?}", other.warnings);
    assert_eq!(motion::camera_at(&other.scene, 0.0).eye.z, 0.0);
    assert!(save::to_ron(&other.scene).contains("camera: (of_shot: \"Sun\"),"));
}

#[test]
fn errors_of_a_shot_name_file_and_place() {
    let home = Home::new();
    let said = |text: &str| {
        std::fs::write(home.at("s.ron"), text).unwrap();
        load(&home.at("s.ron"), &LoadOptions::default()).expect_err("refused").to_string()
    };
    let missing = said("(version: 1, shot: \"none.glb\")");
    assert!(missing.contains("s.ron:1:") && missing.contains("was not found"), "{missing}");
    assert!(said("(version: 1, shot: \"../up.glb\")").contains("is refused"));
    assert!(said("(version: 1)").contains("has no `camera`"));
    std::fs::write(home.at("bad.glb"), b"glTF").unwrap();
    let bad = said("(version: 1, shot: \"bad.glb\")");
    assert!(bad.contains("bad.glb"), "{bad}");
    std::fs::write(home.at("draco.gltf"), r#"{"asset":{"version":"2.0"},"extensionsRequired":["KHR_draco_mesh_compression"],"extensionsUsed":["KHR_draco_mesh_compression"]}"#).unwrap();
    assert!(said("(version: 1, shot: \"draco.gltf\")").contains("without compression"));
}

#[test]
fn a_painting_survives_a_new_export() {
    let home = Home::new();
    let text = SCENE.replace("hold: 2", "particles: 10").replace(
        "direction: Angle(20)",
        "direction: Around((0.2, 1, 0.1)), strokes: (angle_jitter_deg: 0, swing_deg: 0, contour: 0)",
    );
    // The centre and the angle of each stroke on the ball.
    let angles = |scene: LoadedScene| -> Vec<([f32; 2], f32)> {
        let body = 1 + names(&scene).iter().position(|name| *name == "Ball").unwrap() as u32;
        let frame = prepare(Arc::new(scene)).unwrap().at(4.0, &FrameOptions::new([640, 360]));
        let of_ball =
            frame.strokes.iter().filter(|stroke| stroke.body_id == body && stroke.facing_fade > 0.9);
        of_ball.map(|stroke| (stroke.center_px, stroke.angle_rad)).collect()
    };
    let before = angles(home.scene(&text));
    // Another order of nodes, a finer ball, and one object renamed.
    home.export(&shapes::sphere(40, 20), ["Fern", "Ball", "Box"]);
    let scene = home.scene(&text);
    assert_eq!(names(&scene), ["Box", "Ball", "Fern"]);
    let after = angles(scene);
    let mut differences: Vec<f64> = Vec::new();
    for (at, angle) in &after {
        let away = |other: &[f32; 2]| (other[0] - at[0]).hypot(other[1] - at[1]);
        let nearest = before.iter().min_by(|a, b| away(&a.0).total_cmp(&away(&b.0))).unwrap();
        if away(&nearest.0) < 0.7 {
            differences.push(wrap_half(f64::from(angle - nearest.1)).abs().to_degrees());
        }
    }
    differences.sort_by(f64::total_cmp);
    assert!(differences.len() > 50, "{}", differences.len());
    let [median, p95] = [50, 95].map(|share| differences[differences.len() * share / 100]);
    // Near the silhouette the coarse ball's facets turn strokes by a degree or two. A lost direction would be off by
    // tens of degrees.
    assert!(median < 0.5 && p95 < 3.0, "{median} {p95}");
}

#[test]
fn what_a_shot_moves_is_posed_once_it_has_own_keys() {
    let home = Home::new();
    let mut document = Document::open(&home.at("shot.glb"), &LoadOptions::default()).unwrap();
    let ball = || KeyOf::Object("Ball".to_owned());
    let pose = |document: &Document, frame: f64| motion::poses_at(document.scene(), frame)[0];
    let before: Vec<_> = (0..=48).map(|frame| pose(&document, f64::from(frame))).collect();
    for refused in [
        Command::Time(Time::SetKey(ball(), 12.0)),
        Command::Time(Time::SetKey(KeyOf::Camera, 12.0)),
        Command::Edit(Edit::Rename(Item::Object("Ball".to_owned()), "Kugel".to_owned())),
    ] {
        let words = document.apply(&refused).expect_err("the shot has it").0;
        assert!(words.contains("shot.glb"), "{words}");
    }
    document.apply(&Command::Time(Time::OwnKeys(ball()))).unwrap();
    for (frame, before) in before.iter().enumerate() {
        assert!(pose(&document, frame as f64).abs_diff_eq(*before, 1e-6), "{frame}");
    }
    // A steady turn about one axis needs two keys. There may be a third, because the turn ends at 90 degrees about Y,
    // where the Euler angles of the keys are ill-conditioned.
    assert!(document.scene().objects[0].keys.len() <= 3);
    document.apply(&Command::Time(Time::OwnKeys(KeyOf::Camera))).unwrap();
    assert_eq!(document.scene().camera.keys.len(), 2);
    document.apply(&Command::Time(Time::SetKey(ball(), 12.0))).unwrap();
    let text = save::to_ron(document.scene());
    assert!(text.contains("(name: \"Ball\", keys: [") || text.contains("name: \"Ball\",\n"), "{text}");
    assert!(document.undo().is_some() && document.undo().is_some() && document.undo().is_some());
    assert_eq!(pose(&document, 20.0), before[20]);
}

#[test]
fn a_new_export_is_read_while_the_window_is_open_and_undo_holds() {
    let home = Home::new();
    std::fs::write(home.at("s.ron"), SCENE).unwrap();
    let mut document = Document::open(&home.at("s.ron"), &LoadOptions::default()).unwrap();
    document.apply(&Command::Scene(SceneEdit::SetSeed(5))).unwrap();
    home.export(&shapes::sphere(40, 20), ["Ball", "Box", "Fern"]);
    let step = document.read_files_again().unwrap();
    let note = step.note.unwrap();
    assert!(note.contains("new: Fern") && note.contains("gone: Far"), "{note}");
    let named = |document: &Document| -> Vec<String> {
        document.scene().objects.iter().map(|object| object.name.clone()).collect()
    };
    assert_eq!(named(&document), ["Box", "Ball", "Fern"]);
    document.undo().unwrap();
    assert_eq!(
        (named(&document), document.scene().seed),
        (vec!["Box".into(), "Ball".into(), "Far".into()], 5)
    );
    document.redo().unwrap();
    assert_eq!(
        (named(&document), document.scene().seed),
        (vec!["Box".into(), "Ball".into(), "Fern".into()], 5)
    );
}

#[test]
fn colours_of_vertices_are_painted() {
    let home = tempfile::tempdir().unwrap();
    let mut bin = Vec::new();
    // A quad whose left half is red and whose right half is blue, by the colours of its vertices.
    let corners = [
        [-1.0f32, -1.0],
        [0.0, -1.0],
        [0.0, 1.0],
        [-1.0, 1.0],
        [0.0, -1.0],
        [1.0, -1.0],
        [1.0, 1.0],
        [0.0, 1.0],
    ];
    bin.extend(corners.iter().flat_map(|[x, y]| [*x, *y, 0.0]).flat_map(f32::to_le_bytes));
    let colors = (0..8).map(|vertex| if vertex < 4 { [1.0f32, 0.0, 0.0] } else { [0.0, 0.0, 1.0] });
    bin.extend(colors.flatten().flat_map(f32::to_le_bytes));
    bin.extend([0u16, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7].iter().flat_map(|corner| corner.to_le_bytes()));
    let root = serde_json::json!({
        "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [0, 1] }],
        "nodes": [{ "name": "Quad", "mesh": 0 }, { "name": "Cam", "camera": 0, "translation": [0, 0, 3] }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0, "COLOR_0": 1 }, "indices": 2, "material": 0 }] }],
        "materials": [{ "name": "Flat", "extensions": { "KHR_materials_unlit": {} } }],
        "extensionsUsed": ["KHR_materials_unlit"],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 0] },
            { "bufferView": 1, "componentType": 5126, "count": 8, "type": "VEC3" },
            { "bufferView": 2, "componentType": 5123, "count": 12, "type": "SCALAR" },
        ],
        "bufferViews": [
            { "buffer": 0, "byteOffset": 0, "byteLength": 96 }, { "buffer": 0, "byteOffset": 96, "byteLength": 96 },
            { "buffer": 0, "byteOffset": 192, "byteLength": 24 },
        ],
        "buffers": [{ "byteLength": bin.len() }],
        "cameras": [{ "type": "perspective", "perspective": { "yfov": 0.5, "znear": 0.1, "zfar": 10.0 } }],
    });
    let path = home.path().join("quad.glb");
    std::fs::write(&path, glb::bytes(&root, bin)).unwrap();
    let options = |style: &str| {
        let mut options = LoadOptions::default();
        options.overrides.push(("style".to_owned(), style.to_owned()));
        options
    };
    for style in ["Reference", "RotatingStrokes()"] {
        let painting = prepare(Arc::new(load(&path, &options(style)).unwrap())).unwrap();
        let frame = painting.at(0.0, &FrameOptions::new([160, 90]));
        let picture = renderer(Driver::Egl).render(&frame).unwrap();
        let mean = |columns: std::ops::Range<usize>| -> [f64; 3] {
            let pixels: Vec<&[u8]> = (30..60)
                .flat_map(|row| columns.clone().map(move |column| row * 160 + column))
                .map(|pixel| &picture.rgba8[4 * pixel..4 * pixel + 3])
                .collect();
            std::array::from_fn(|channel| {
                pixels.iter().map(|pixel| f64::from(pixel[channel])).sum::<f64>() / pixels.len() as f64
            })
        };
        let [left, right] = [mean(50..74), mean(86..110)];
        assert!(left[0] > 2.0 * left[2] && right[2] > 2.0 * right[0], "{style}: {left:?} {right:?}");
    }
}
