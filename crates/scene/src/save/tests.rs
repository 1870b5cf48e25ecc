//! Tests of saving scenes: they read back equal, look hand-written, and replace files whole.

mod any;

use std::path::Path;

use proptest::prelude::*;

use super::*;
use crate::document::NoiseDisplace;
use crate::load::parse;
use any::any_scene;

#[test]
fn a_noise_displaced_material_has_usual_values() {
    let text = |material: &str| {
        let scene = format!(
            "(version: 1, camera: (keys: [(frame: 0, eye: (0, 0, 4), target: (0, 0, 0))]), objects: [(name: \"a\", mesh: \"a.obj\", material: {material})])"
        );
        parse(Path::new("a.ron"), &scene).unwrap()
    };
    let usual = text("(noise_displace: ())");
    let noise = usual.objects[0].material.clone().unwrap().noise_displace.unwrap();
    assert_eq!(noise, NoiseDisplace::default());
    assert!(to_ron(&usual).contains("noise_displace: ()"));
    let bare = text("(noise_displace: (surface: None, vertex: (scale: 0.25)))");
    let written = to_ron(&bare);
    assert!(written.contains("(noise_displace: (vertex: (scale: 0.25), surface: None))"), "{written}");
    assert_eq!(parse(Path::new("a.ron"), &written).unwrap(), bare);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(256) })]

    fn any_scene_reads_back(scene in any_scene()) {
        let text = to_ron(&scene);
        let read = parse(Path::new("s.ron"), &text).map_err(|report| {
            TestCaseError::fail(format!("{report}\n{text}"))
        })?;
        prop_assert_eq!(&read, &scene);
        prop_assert_eq!(to_ron(&read), text);
    }
}

#[test]
fn what_is_saved_reads_back_equal_and_saves_to_the_same_bytes() {
    // A strategy holds all of its parts by value: together they are larger than the stack of a test's thread.
    let thread = std::thread::Builder::new().stack_size(64 << 20).spawn(any_scene_reads_back);
    thread.expect("a thread").join().expect("every scene reads back");
}

const READABLE: &str = r##"#![enable(implicit_some)]
(
    version: 1,
    size: (1280, 720),
    timeline: (fps: 24, first: 0, last: 119),
    camera: (
        lens: Perspective(fov_y_deg: 32, near: 0.05, far: 100),
        keys: [
            (frame: 0, eye: (0, 1.1, 4), target: (0, 0.5, 0), ease: Smooth),
            (frame: 119, eye: (0, 1.1, 4), target: (0, 0.5, 0), roll_deg: 90),
        ],
    ),
    lights: [(name: "window", kind: Sun, direction: (-0.5, -1, -0.6), color: "#fff1dc", intensity: 2.5)],
    objects: [
        (
            name: "apple",
            mesh: "meshes/apple.obj",
            particles: 45658,
            material: (color: "#b3262a"),
            keys: [
                (frame: 0),
                (frame: 60, translation: (0.8, 0, 0), rotation_deg: (0, 0, -140)),
            ],
        ),
        (name: "leaf", mesh: "meshes/apple.obj", group: "leaf", parent: "apple", hidden: true, locked: true),
    ],
    strokes: (preset: "oil study"),
    regions: [
        (
            name: "skin",
            on: Several(
                "apple",
                [
                    Group("skin"),
                    Flood((at: (0, 0.5, 0.2), normal: (0, 0, 1)), 30),
                    Dabs(
                        [
                            (at: (0, 0.4, 0.2), normal: (0, 0, 1), radius: 0.1, take_away: true),
                            (at: (0, 0.4, 0.2), normal: (0, 0, 1), radius: 0.02),
                        ],
                    ),
                ],
            ),
            guides: [
                (
                    mode: Smooth,
                    points: [
                        (at: (0, 0.4, 0.2), normal: (0, 0, 1)),
                        (at: (0, 0.6, 0.2), normal: (0, 0, 1), turn_deg: 30),
                    ],
                    radius: 0.2,
                ),
            ],
            turn_deg: -15,
            hidden: true,
            locked: true,
            color: "#008df9",
        ),
    ],
    style: RotatingStrokes(solver: Tangent),
)
"##;

#[test]
fn a_saved_scene_reads_as_a_person_would_write_it() {
    let scene = parse(Path::new("s.ron"), READABLE).unwrap();
    assert_eq!(to_ron(&scene), READABLE);
}

#[test]
fn writing_replaces_the_file_whole_and_leaves_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.ron");
    std::fs::write(&path, "old").unwrap();
    let scene = parse(Path::new("s.ron"), READABLE).unwrap();
    write(&path, &scene).unwrap();
    assert_eq!(std::fs::read_to_string(&path).unwrap(), READABLE);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn a_file_that_cannot_be_written_is_left_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("scene.ron");
    std::fs::write(&path, "old").unwrap();
    let mut permissions = std::fs::metadata(&path).unwrap().permissions();
    permissions.set_readonly(true);
    std::fs::set_permissions(&path, permissions).unwrap();
    let scene = parse(Path::new("s.ron"), READABLE).unwrap();
    assert!(write(&path, &scene).is_err());
    assert_eq!(std::fs::read_to_string(&path).unwrap(), "old");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    assert!(write(&folder.path().join("no/such/folder.ron"), &scene).is_err());
}
