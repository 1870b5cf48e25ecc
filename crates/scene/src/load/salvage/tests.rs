//! Tests of reading as much as possible of a scene with errors.

use std::fs;
use std::path::{Path, PathBuf};

use super::*;
use crate::load;

const CUBE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\ng side\nf 1 4 3 2\n";

struct Folder(tempfile::TempDir);

impl Folder {
    fn new() -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        fs::create_dir(folder.path().join("meshes")).expect("made");
        for name in ["leaf.obj", "apple.obj"] {
            fs::write(folder.path().join("meshes").join(name), CUBE).expect("written");
        }
        Self(folder)
    }

    fn path(&self) -> PathBuf {
        self.0.path().join("s.ron")
    }

    fn read(&self, text: &str) -> Salvaged {
        fs::write(self.path(), text).expect("written");
        let salvaged =
            salvage(&self.path(), &LoadOptions::default()).unwrap_or_else(|report| panic!("{report}"));
        assert_eq!(fs::read_to_string(self.path()).expect("there"), text, "the file was touched");
        salvaged
    }
}

fn scene(objects: &str, more: &str) -> String {
    format!(
        "(\n  version: 1,\n  camera: (keys: [(frame: 0, eye: (0, 1, 4), target: (0, 0, 0))]),\n  objects: [\n{objects}\n  ],\n{more}\n)\n"
    )
}

fn said(salvaged: &Salvaged) -> Vec<String> {
    let line = |loss: &Loss| {
        let place = loss.problem.place.expect("a place");
        format!("{}:{} {} / {}", place.line, place.column, loss.problem.message, loss.instead)
    };
    salvaged.losses.iter().map(line).collect()
}

fn names(salvaged: &Salvaged) -> Vec<&str> {
    salvaged.loaded.scene.objects.iter().map(|object| object.name.as_str()).collect()
}

fn all_fixed(salvaged: &Salvaged, path: &Path) -> Salvaged {
    let fixes: Vec<&Fix> = salvaged.losses.iter().filter_map(|loss| loss.fix.as_ref()).collect();
    salvage_text(path, &mended(&salvaged.text, &fixes), &LoadOptions::default()).expect("opens")
}

#[test]
fn a_scene_without_errors_loses_nothing() {
    let folder = Folder::new();
    let text = scene("    (name: \"a\", mesh: \"meshes/apple.obj\"),", "");
    let salvaged = folder.read(&text);
    assert!(salvaged.losses.is_empty());
    let loaded = load::load(&folder.path(), &LoadOptions::default()).expect("loads");
    assert_eq!(salvaged.loaded.scene, loaded.scene);
    assert_eq!(salvaged.loaded.warnings, loaded.warnings);
}

#[test]
fn warnings_of_all_files_are_kept_and_each_is_told_once() {
    let folder = Folder::new();
    // A mesh that refers to texture coordinates that it lacks, and a picture without an opaque pixel.
    let odd = CUBE.replace("f 1 4 3 2", "f 1/7 4/7 3/7 2/7");
    fs::write(folder.0.path().join("meshes/bent.obj"), odd).expect("written");
    for name in ["skin.png", "brush.png"] {
        let grey = |x| if x == 1 { 255 } else { 0 };
        let picture = image::RgbaImage::from_fn(3, 3, |x, _| image::Rgba([grey(x), grey(x), grey(x), 0]));
        picture.save(folder.0.path().join(name)).expect("written");
    }
    let object = |name: &str| {
        format!(
            r#"    (name: "{name}", mesh: "meshes/apple.obj", morph: "meshes/bent.obj", material: (texture: "skin.png")),"#
        )
    };
    let objects = [object("a"), object("b")].concat();
    let text = scene(&objects, r#"  strokes: (brush: "brush.png"),"#);
    let salvaged = folder.read(&text);
    assert!(salvaged.losses.is_empty(), "{:?}", said(&salvaged));
    let warnings = &salvaged.loaded.warnings;
    for file in ["bent.obj", "skin.png", "brush.png"] {
        let of_file = warnings.iter().filter(|warning| warning.path.ends_with(file));
        assert_eq!(of_file.count(), 1, "{file}: {warnings:?}");
    }
    let loaded = load::load(&folder.path(), &LoadOptions::default()).expect("loads");
    assert_eq!(*warnings, loaded.warnings);
}

#[test]
fn an_unknown_field_is_left_out_and_one_near_it_is_a_certain_fix() {
    let folder = Folder::new();
    let text = scene(
        "    (name: \"a\", mesh: \"meshes/apple.obj\"),",
        "  strokes: (widht_px: 9, length_px: 40, nonsense: [(1)]),",
    );
    let salvaged = folder.read(&text);
    assert_eq!(salvaged.loaded.scene.strokes.length_px, Some(40.0));
    assert_eq!(salvaged.losses.len(), 2, "{:?}", said(&salvaged));
    assert!(said(&salvaged)[0].starts_with("7:13 unknown field `widht_px`"), "{:?}", said(&salvaged));
    let fix = salvaged.losses[0].fix.as_ref().expect("a fix");
    assert!(fix.is_certain && fix.verb == "Rename");
    assert_eq!(salvaged.losses[1].fix, None);
    let fixed = all_fixed(&salvaged, &folder.path());
    assert_eq!(fixed.loaded.scene.strokes.width_px, Some(9.0));
    assert_eq!(fixed.losses.len(), 1);
    // When the right field is already present, there is no fix: it would write the field twice.
    let text = scene("", "  strokes: (widht_px: 9, width_px: 10),");
    assert_eq!(folder.read(&text).losses[0].fix, None);
}

#[test]
fn a_box_stands_in_for_a_mesh_and_all_else_of_the_object_is_kept() {
    let folder = Folder::new();
    let object = r#"    (name: "leaf", mesh: "meshes/laef.obj", group: "blade", keys: [(frame: 0, translation: (0, 2, 0))]),
    (name: "more", mesh: "leaf.obj"),"#;
    let region = r#"  regions: [(name: "r", on: Material("leaf", "green"))],"#;
    let salvaged = folder.read(&scene(object, region));
    assert_eq!(said(&salvaged).len(), 2, "{:?}", said(&salvaged));
    assert!(salvaged.losses.iter().all(|loss| loss.instead == "A box stands in for it."));
    let leaf = &salvaged.loaded.scene.objects[0];
    assert_eq!((leaf.mesh.as_str(), leaf.keys[0].translation), ("meshes/laef.obj", [0.0, 2.0, 0.0]));
    // The scene can be edited: the box has everything that the scene looks for in the mesh.
    let again = salvaged.loaded.with_scene(salvaged.loaded.scene.clone(), &Default::default());
    assert!(again.is_ok(), "{again:?}");
    let fixes: Vec<_> = salvaged.losses.iter().map(|loss| loss.fix.clone().expect("a fix")).collect();
    assert_eq!((fixes[0].verb.as_str(), fixes[0].is_certain), ("Use leaf.obj", false));
    // A file of the same name in another folder is a certain fix.
    assert_eq!((fixes[1].verb.as_str(), fixes[1].is_certain), ("Use leaf.obj", true));
    let fixed = mended(&salvaged.text, &[&fixes[1]]);
    assert!(fixed.contains(r#"(name: "more", mesh: "meshes/leaf.obj")"#), "{fixed}");
    // With two files of that name there is no fix.
    fs::write(folder.0.path().join("leaf.obj.obj"), "").expect("written");
    fs::create_dir(folder.0.path().join("other")).expect("made");
    fs::write(folder.0.path().join("other/leaf.obj"), CUBE).expect("written");
    let text = scene("    (name: \"m\", mesh: \"lost/leaf.obj\"),", "");
    assert_eq!(folder.read(&text).losses[0].fix, None);
}

#[test]
fn everything_before_a_broken_bracket_is_read() {
    let folder = Folder::new();
    let objects = "    (name: \"a\", mesh: \"meshes/apple.obj\", particles: 100),\n    (name: \"b\", mesh: \"meshes/leaf.obj\",\n    (name: \"c\", mesh: \"meshes/leaf.obj\"),\n    (name: \"d\", mesh: \"meshes/leaf.obj\"),";
    let salvaged = folder.read(&scene(objects, "  strokes: (length_px: 40),"));
    assert_eq!(names(&salvaged), ["a", "b"]);
    let said = said(&salvaged);
    assert!(said[0].starts_with("7:5 cannot read past line 7, column 5: "), "{said:?}");
    assert!(said[0].ends_with("Everything before it is open; 2 objects after it are not."), "{said:?}");
    assert_eq!(said.len(), 1);
    // The file ends in the middle of an object.
    let whole = scene(objects, "");
    let end = whole.find("mesh: \"meshes/leaf.obj\"").expect("there");
    let salvaged = folder.read(&whole[..end + 9]);
    assert_eq!(names(&salvaged), ["a"], "{:?}", self::said(&salvaged));
}

#[test]
fn an_invalid_value_is_removed_with_as_little_else_as_possible() {
    let folder = Folder::new();
    let object = r#"    (name: "a", mesh: "meshes/apple.obj", parent: "nobody", keys: [(frame: 0), (frame: "x"), (frame: 5, scale: -1)]),
    (name: "b", mesh: 7),"#;
    let salvaged = folder.read(&scene(object, "  size: (0, 40),\n  lights: [(name: \"l\", kind: Moon)],"));
    assert_eq!(names(&salvaged), ["a"]);
    let a = &salvaged.loaded.scene.objects[0];
    assert_eq!((a.parent.as_deref(), a.keys.len()), (None, 2));
    assert_eq!(salvaged.loaded.scene.size, (1280, 720));
    assert!(salvaged.loaded.scene.lights.is_empty());
    let said = said(&salvaged);
    assert_eq!(said.len(), 6, "{said:#?}");
    assert!(
        said.iter()
            .any(|line| line.contains("`7` does not fit")
                && line.ends_with("The object is left out until then.")),
        "{said:#?}"
    );
}

#[test]
fn a_field_with_several_errors_is_removed_alone() {
    let folder = Folder::new();
    let object = r#"    (name: "a", mesh: "meshes/apple.obj", keys: [(frame: 0), (frame: 5, translation: (0, 2, 0), rotation_deg: (1e300, 1e300, 1e300))]),"#;
    let salvaged = folder.read(&scene(object, "  timeline: (first: -5, last: -99999999999),"));
    let keys = &salvaged.loaded.scene.objects[0].keys;
    assert_eq!(keys.len(), 2, "{:?}", said(&salvaged));
    assert_eq!((keys[1].translation, keys[1].rotation_deg), ([0.0, 2.0, 0.0], [0.0; 3]));
    assert_eq!(salvaged.loaded.scene.timeline.first, -5);
    assert!(said(&salvaged).len() >= 4, "each error is told: {:?}", said(&salvaged));
}

#[test]
fn brackets_in_comments_within_comments_do_not_count() {
    let folder = Folder::new();
    let objects = "    (name: \"a\", mesh: \"meshes/apple.obj\"), /* ] /* ( */ ) ] ) */\n    (name: \"b\", mesh: \"meshes/leaf.obj\"),\n    (name: \"c\", mesh: \"meshes/leaf.obj\",\n    (name: \"d\", mesh: \"meshes/leaf.obj\"),";
    let salvaged = folder.read(&scene(objects, ""));
    assert_eq!(names(&salvaged), ["a", "b", "c"], "{:?}", said(&salvaged));
}

#[test]
fn a_scene_without_camera_objects_or_version_gets_usual_ones() {
    let folder = Folder::new();
    let salvaged = folder.read("(\n  strokes: (length_px: 40),\n)\n");
    assert_eq!(salvaged.loaded.scene.strokes.length_px, Some(40.0));
    assert_eq!(salvaged.loaded.scene.camera.keys.len(), 1);
    assert!(!salvaged.losses.is_empty());
    let salvaged = folder.read("(version: 1, camera: (keys: []), objects: [] // the end\n)");
    assert_eq!(salvaged.loaded.scene.camera.keys.len(), 1);
}

#[test]
fn a_missing_camera_is_told_beside_other_losses_and_a_mistyped_one_only_once() {
    let folder = Folder::new();
    let of_camera = |text: &str| {
        let salvaged = folder.read(text);
        assert_eq!(salvaged.loaded.scene.camera.keys.len(), 1, "{text}");
        let of_camera = |loss: &&Loss| loss.problem.message.contains("has no `camera`");
        salvaged.losses.iter().filter(of_camera).map(|loss| loss.problem.message.clone()).collect::<Vec<_>>()
    };
    let told = of_camera("(version: 1, sede: 4, objects: [])");
    assert_eq!(told.len(), 1, "{told:?}");
    let told = of_camera("(version: 1, camra: (keys: []), objects: [])");
    assert_eq!(told.len(), 0, "{told:?}");
    let told = of_camera("(version: 1, camera: (keys: 4), objects: [])");
    assert_eq!(told.len(), 0, "{told:?}");
}

#[test]
fn losses_beyond_the_most_that_are_listed_leave_the_listed_ones_alone() {
    let folder = Folder::new();
    let object = |index: usize| format!("    (name: \"o{index}\", mesh: \"meshes/leaf.obj\", hiden: false),");
    let objects: Vec<String> = (0..limits::MAX_PROBLEMS + 20).map(object).collect();
    let salvaged = folder.read(&scene(&objects.join("\n"), ""));
    let (more, listed) = salvaged.losses.split_last().expect("losses");
    assert_eq!(listed.len(), limits::MAX_PROBLEMS);
    assert!(more.problem.message.starts_with("20 more"), "{}", more.problem.message);
    for loss in listed {
        let line = loss.problem.place.expect("a place").line;
        let fixed = mended(&salvaged.text, &[loss.fix.as_ref().expect("a rename")]);
        assert!(fixed.lines().nth(line - 1).is_some_and(|line| line.contains("hidden: ")), "line {line}");
    }
}

#[test]
fn text_that_is_not_a_scene_is_refused() {
    let folder = Folder::new();
    for text in ["", "// only words", "(version: 2, camera: ())", "{\"version\": 1}", "\0"] {
        fs::write(folder.path(), text).expect("written");
        let report = salvage(&folder.path(), &LoadOptions::default()).expect_err(text);
        assert!(!report.0.is_empty(), "{text:?}");
    }
    assert!(salvage(&folder.0.path().join("nothing.ron"), &LoadOptions::default()).is_err());
}

#[test]
fn every_beginning_of_a_scene_opens_or_is_refused_in_words() {
    let folder = Folder::new();
    let object = "    (name: \"a\", mesh: \"meshes/apple.obj\", keys: [(frame: 0, translation: (0, 2, 0))]),\n    (name: \"ü\", mesh: \"meshes/leaf.obj\"), /* b */";
    let whole = "#![enable(implicit_some)]\n".to_owned()
        + &scene(
            object,
            "  regions: [(name: \"r\", on: Group(\"a\", \"side\"), strokes: (length_px: 4))], // end",
        );
    assert!(folder.read(&whole).losses.is_empty());
    let (mut opened, mut count) = (0, 0);
    // Cut anywhere after the scene's opening bracket; before it there is no scene.
    let first = whole.find("(\n").expect("a bracket") + 1;
    for end in (first..whole.len() - 3).filter(|&end| whole.is_char_boundary(end)) {
        count += 1;
        match salvage_text(&folder.path(), &whole[..end], &LoadOptions::default()) {
            Ok(salvaged) => {
                opened += 1;
                assert!(!salvaged.losses.is_empty(), "nothing said of {:?}", &whole[..end]);
            }
            Err(report) => assert!(!report.0.is_empty()),
        }
    }
    assert_eq!(opened, count);
}
