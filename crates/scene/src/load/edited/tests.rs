//! Tests of loading an edited scene with files that are already loaded.

use std::fs;
use std::sync::Arc;

use super::*;
use crate::document::{Guide, Object, Region, Scale, Selector};
use crate::load::{LoadOptions, load};
use crate::problem::Severity;

const CUBE: &str =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 5 0 0\nv 5 1 0\nv 5 0.5 0\ng front\nf 1 2 3 4\nf 5 6 7\n";

const SCENE: &str = r#"(
    version: 1,
    camera: (keys: [(frame: 0, eye: (0, 1, 4), target: (0, 0, 0))]),
    objects: [(name: "apple", mesh: "a.obj", keys: [(frame: 0), (frame: 9)]), (name: "b", mesh: "b.obj")],
)"#;

fn folder() -> (tempfile::TempDir, LoadedScene) {
    let folder = tempfile::tempdir().unwrap();
    for name in ["a.obj", "b.obj", "c.obj"] {
        fs::write(folder.path().join(name), CUBE).unwrap();
    }
    let path = folder.path().join("scene.ron");
    fs::write(&path, SCENE).unwrap();
    let loaded = load(&path, &LoadOptions::default()).unwrap();
    (folder, loaded)
}

fn edited(loaded: &LoadedScene, edit: impl FnOnce(&mut Scene)) -> Result<LoadedScene, Report> {
    let mut scene = loaded.scene.clone();
    edit(&mut scene);
    loaded.with_scene(scene, &AssetFolders::default())
}

#[test]
fn loaded_files_are_shared_new_ones_read_and_unused_ones_dropped() {
    let (folder, loaded) = folder();
    let of =
        |loaded: &LoadedScene, name: &str| loaded.warnings.iter().filter(|w| w.path.ends_with(name)).count();
    assert_eq!((of(&loaded, "a.obj"), of(&loaded, "b.obj")), (1, 1), "{:?}", loaded.warnings);
    // Loaded files are not read again, so they may be gone.
    for name in ["a.obj", "b.obj"] {
        fs::remove_file(folder.path().join(name)).unwrap();
    }
    let again = edited(&loaded, |scene| scene.objects[1].mesh = "c.obj".to_owned()).unwrap();
    assert!(Arc::ptr_eq(&loaded.meshes["a.obj"], &again.meshes["a.obj"]));
    assert_eq!(again.meshes.keys().collect::<Vec<_>>(), ["a.obj", "c.obj"]);
    assert_eq!([of(&again, "a.obj"), of(&again, "b.obj"), of(&again, "c.obj")], [1, 0, 1]);
    assert_eq!(again.path, loaded.path);
    let same = edited(&again, |_| {}).unwrap();
    assert_eq!(same.warnings, again.warnings);
    let without = edited(&loaded, |scene| scene.objects.clear()).unwrap();
    assert!(without.meshes.is_empty() && without.warnings.is_empty());
    let gone = edited(&without, |scene| scene.objects.push(Object::new("b", "b.obj")));
    let Err(Report(problems)) = gone else { panic!("a file that is gone was read") };
    assert_eq!(&*problems[0].field_path, "objects[0].mesh");
    assert!(problems[0].message.starts_with("objects.b.mesh: "), "{}", problems[0]);
}

#[test]
fn a_mesh_that_became_a_scene_is_still_an_input() {
    let (folder, _) = folder();
    let mesh = folder.path().join("c.obj");
    let mut loaded = edited(&load(&mesh, &LoadOptions::default()).unwrap(), |_| {}).unwrap();
    assert_eq!(loaded.inputs(), std::slice::from_ref(&mesh));
    loaded.path = folder.path().join("c.ron");
    assert_eq!(loaded.inputs(), [loaded.path.clone(), mesh]);
}

#[test]
fn problems_name_their_field() {
    let (_folder, loaded) = folder();
    let refused = edited(&loaded, |scene| {
        scene.objects[0].keys[1].scale = Scale::even(0.0);
        scene.objects[1].name = "b.c".to_owned();
        scene.objects[1].hold = 0;
        scene.regions.push(Region::new("r", Selector::Group("apple".to_owned(), "frnt".to_owned())));
        scene.camera.keys[0].roll_deg = f64::NAN;
    });
    let Err(Report(problems)) = refused else { panic!("a faulty scene was taken") };
    let fatal: Vec<_> = problems.iter().filter(|problem| problem.severity.is_fatal()).collect();
    let said = |field_path: &str, message: &str| {
        let found = fatal.iter().find(|problem| &*problem.field_path == field_path);
        let found = found.unwrap_or_else(|| panic!("nothing about {field_path}: {problems:?}"));
        assert!(found.message.starts_with(message), "{found}");
        assert!(found.place.is_none() && !found.mend.is_empty());
    };
    said("objects[0].keys[1].scale", "objects.apple.keys[1].scale: 0 is out of range");
    said("objects[1].hold", "objects[1].hold: 0 is out of range");
    said("regions[0].on", "regions.r.on: there is no group \"frnt\" in a.obj");
    said("camera.keys[0].roll_deg", "camera.keys[0].roll_deg: NaN");
    assert_eq!(fatal.len(), 4, "{problems:?}");
}

#[test]
fn loaded_problems_have_fields_and_warnings_follow_the_edits() {
    let (_folder, loaded) = folder();
    let off = |scene: &mut Scene| {
        let text = SCENE.replace("(\n    version", "(regions: [(name: \"r\", on: Object(\"apple\"), guides: [(points: [(at: (0, 0, 3), normal: (0, 0, 1)), (at: (1, 0, 3), normal: (0, 0, 1))], radius: 0.2)])], version");
        *scene = crate::load::parse(std::path::Path::new("s.ron"), &text).unwrap();
    };
    let warned = edited(&loaded, off).unwrap();
    let of_document: Vec<_> = warned.warnings.iter().filter(|w| !w.field_path.is_empty()).collect();
    assert_eq!(of_document.len(), 1);
    assert_eq!(&*of_document[0].field_path, "regions[0].guides[0].points[0].at");
    assert_eq!(of_document[0].severity, Severity::Warning);
    assert!(of_document[0].message.starts_with("regions.r.guides[0].points[0].at: the guide is 3 away"));
    let mended = edited(&warned, |scene| {
        let on_surface = |guide: &mut Guide| guide.points.iter_mut().for_each(|point| point.at[2] = 0.05);
        scene.regions[0].guides.iter_mut().for_each(on_surface);
    });
    assert!(mended.unwrap().warnings.iter().all(|warning| warning.field_path.is_empty()));
}

#[test]
fn dabs_that_touch_nothing_are_told_until_they_are_mended() {
    let (_folder, loaded) = folder();
    let region = r#"(regions: [(name: "r", on: Dabs("apple", [
        (at: (0.5, 0.5, 0.05), normal: (0, 0, 1), radius: 0.2),
        (at: (0.5, 0.5, 0.5), normal: (0, 0, 1), radius: 0.2),
    ]))], version"#;
    let text = SCENE.replace("(\n    version", region);
    let scene = crate::load::parse(std::path::Path::new("s.ron"), &text).unwrap();
    let told = |loaded: &LoadedScene| -> Vec<String> {
        let of_document = loaded.warnings.iter().filter(|w| !w.field_path.is_empty());
        of_document.map(|warning| warning.message.clone()).collect()
    };
    let warned = edited(&loaded, |edited| *edited = scene).unwrap();
    assert_eq!(told(&warned), ["regions.r.on: 1 of 2 dabs touch nothing of \"apple\""]);
    // The warning stays while something else is edited, and goes when the dab does.
    let moved = edited(&warned, |scene| scene.objects[1].name = "c".to_owned()).unwrap();
    assert_eq!(told(&moved), told(&warned));
    let mended = edited(&moved, |scene| {
        let Selector::Dabs(_, dabs) = &mut scene.regions[0].on else { panic!("no dabs") };
        dabs.truncate(1);
    });
    assert_eq!(told(&mended.unwrap()), Vec::<String>::new());
}
