//! Tests that the editor's commands alone can build the shipped still life from its meshes, and that the saved file has
//! the same strokes when the command line loads it.

use std::path::Path;
use std::process::Command as Process;
use std::sync::Arc;

use glam::{DAffine3, DVec3};
use impasto_editor_model::command::{
    Arrange, Command, Directions, Edit, Gesture, KeyOf, Pose, RegionTarget, Regions, SceneEdit, Shift, Time,
};
use impasto_editor_model::{Document, Item};
use impasto_painting::{FrameOptions, prepare};
use impasto_scene::document::{Guide, GuidePoint, Light, Object, Scene};
use impasto_scene::load::{LoadOptions, load};
use impasto_scene::motion::{self, CameraPose};
use impasto_tests::command::{impasto, root};

fn run(document: &mut Document, command: Command) {
    let step = document.apply(&command).unwrap_or_else(|refusal| panic!("{command:?}: {refusal}"));
    assert!(!step.text.is_empty(), "did nothing: {command:?}");
}

/// Builds one object of the wanted scene, beginning with the import of its mesh.
fn build_object(document: &mut Document, wanted: &Object) {
    let before: Vec<String> = document.scene().regions.iter().map(|region| region.name.clone()).collect();
    document.import(&wanted.mesh).unwrap();
    let made = document.scene().objects.last().unwrap().name.clone();
    if made != wanted.name {
        run(document, Command::Edit(Edit::Rename(Item::Object(made), wanted.name.clone())));
    }
    // The import adds a region for each group; this script makes its own instead.
    let regions = document.scene().regions.iter().map(|region| region.name.clone());
    let regions: Vec<Item> = regions.filter(|name| !before.contains(name)).map(Item::Region).collect();
    assert!(!regions.is_empty(), "{} came without regions", wanted.name);
    run(document, Command::Edit(Edit::Delete(regions)));
    let name = wanted.name.clone();
    if wanted.scale.0 != [1.0; 3] {
        let factors = DVec3::from(wanted.scale.0);
        run(document, Command::Arrange(Arrange::Stretch { object: name.clone(), factors }));
    }
    if wanted.material.is_some() {
        run(document, Command::Arrange(Arrange::SetMaterial(name.clone(), wanted.material.clone())));
    }
    // First the object goes from where the import put it to the origin.
    let placed = motion::key_at(document.scene(), document.scene().objects.last().unwrap(), 0.0);
    let shift =
        Shift { world_from_world: DAffine3::from_translation(-DVec3::from(placed.translation)), frame: 0.0 };
    if placed.translation != [0.0; 3] {
        run(
            document,
            Command::Arrange(Arrange::ShiftMotion { objects: vec![name.clone()], shift, verb: "Move" }),
        );
    }
    for key in &wanted.keys {
        let pose = Pose::Object(name.clone(), key.clone());
        let of = KeyOf::Object(name.clone());
        let _ = document.apply(&Command::Time(Time::PoseAtFrame(pose, key.frame))).unwrap();
        let _ = document.apply(&Command::Time(Time::SetEase(vec![(of, key.frame)], key.ease))).unwrap();
    }
    let extra: Vec<(KeyOf, f64)> = document
        .scene()
        .objects
        .last()
        .unwrap()
        .keys
        .iter()
        .filter(|key| !wanted.keys.iter().any(|other| other.frame == key.frame))
        .map(|key| (KeyOf::Object(name.clone()), key.frame))
        .collect();
    if !extra.is_empty() {
        run(document, Command::Time(Time::DeleteKeys(extra)));
    }
}

fn build(document: &mut Document, wanted: &Scene) {
    run(document, Command::Scene(SceneEdit::SetSeed(wanted.seed)));
    run(document, Command::Scene(SceneEdit::SetBackground(wanted.background)));
    // A new scene may already have the wanted range, and `run` fails on a command that changes nothing: another range
    // is set first.
    run(document, Command::Time(Time::SetRange(0, 1)));
    run(document, Command::Time(Time::SetRange(wanted.timeline.first, wanted.timeline.last)));
    let lights = document.scene().lights.iter().map(|light| Item::Light(light.name.clone())).collect();
    run(document, Command::Edit(Edit::Delete(lights)));
    for light in &wanted.lights {
        let at = light.position.map_or(DVec3::Y, DVec3::from);
        run(document, Command::Arrange(Arrange::AddLight { kind: light.kind, at, toward: DVec3::ZERO }));
        let name = document.scene().lights.last().unwrap().name.clone();
        let light = Light { name: light.name.clone(), ..light.clone() };
        let set =
            Arrange::SetLight { name: name.clone(), light: light.clone(), what: "as wanted".to_owned() };
        run(document, Command::Arrange(set));
        if name != light.name {
            run(document, Command::Edit(Edit::Rename(Item::Light(name), light.name.clone())));
        }
    }
    run(document, Command::Arrange(Arrange::SetLens(wanted.camera.lens.clone())));
    for key in &wanted.camera.keys {
        let pose = CameraPose { lens: wanted.camera.lens.clone(), ..motion::camera_at(wanted, key.frame) };
        run(document, Command::Time(Time::PoseAtFrame(Pose::Camera(pose), key.frame)));
        let _ = document
            .apply(&Command::Time(Time::SetEase(vec![(KeyOf::Camera, key.frame)], key.ease)))
            .unwrap();
    }
    for object in &wanted.objects {
        build_object(document, object);
    }
    for region in &wanted.regions {
        run(document, Command::Regions(Regions::Add(Box::new(region.clone()))));
    }
}

/// A comb over the front of the lemon, and a curve round the orange.
fn guides() -> [(&'static str, Gesture, Guide); 2] {
    let along = |points: [DVec3; 4], radius: f64| Guide {
        points: points
            .map(|at| GuidePoint { at: at.to_array(), normal: at.normalize().to_array(), turn_deg: 0.0 })
            .to_vec(),
        object: None,
        view: None,
        radius,
        strength: 0.8,
        falloff: Default::default(),
        mode: Default::default(),
        curve: false,
    };
    let round = |turn: f64| DVec3::new(turn.sin(), 0.2, turn.cos()).normalize() * 0.25;
    let over = |turn: f64| DVec3::new(0.1, turn.sin(), turn.cos()).normalize() * 0.19;
    [
        ("lemon", Gesture::Comb, along([-0.6, -0.2, 0.2, 0.6].map(over), 0.1)),
        ("orange", Gesture::Curve, along([-0.9, -0.3, 0.3, 0.9].map(round), 0.12)),
    ]
}

#[test]
fn a_script_builds_the_still_life_from_its_meshes() {
    let shipped = load(&root().join("scenes/still_life.ron"), &LoadOptions::default()).unwrap();
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("meshes")).unwrap();
    for entry in std::fs::read_dir(root().join("scenes/meshes")).unwrap() {
        let from = entry.unwrap().path();
        if from.is_file() {
            std::fs::copy(&from, folder.path().join("meshes").join(from.file_name().unwrap())).unwrap();
        }
    }
    let mut document = Document::empty(folder.path());
    build(&mut document, &shipped.scene);
    assert_eq!(*document.scene(), Scene { size: document.scene().size, ..shipped.scene.clone() });

    for (region, gesture, guide) in guides() {
        let region = RegionTarget::Named(region.to_owned());
        run(&mut document, Command::Directions(Directions::Stroke { region, gesture, guides: vec![guide] }));
    }
    let file = folder.path().join("still_life.ron");
    assert!(document.is_edited());
    document.save_as(&file).unwrap();
    assert!(!document.is_edited() && document.undo_text() == Some("Draw guide"));

    // Loaded as the command line loads it, the file has the same strokes, bit for bit.
    let loaded = load(&file, &LoadOptions::default()).unwrap_or_else(|report| panic!("{report}"));
    assert_eq!(loaded.scene, *document.scene());
    let options = FrameOptions::new([480, 270]);
    let strokes = |loaded| prepare(loaded).unwrap().at(61.0, &options).strokes;
    assert_eq!(strokes(Arc::new(loaded)), strokes(Arc::clone(document.loaded())));
    check_and_render(&file);
}

fn check_and_render(file: &Path) {
    let checked = Process::new(impasto()).arg("check").arg(file).output().unwrap();
    assert!(checked.status.success(), "{}", String::from_utf8_lossy(&checked.stderr));
    let picture = file.with_extension("png");
    let rendered = Process::new(impasto())
        .arg("render")
        .arg(file)
        .args(["--frames", "61", "--size", "320x180", "-o"])
        .arg(&picture)
        .output()
        .unwrap();
    assert!(rendered.status.success(), "{}", String::from_utf8_lossy(&rendered.stderr));
    assert!(std::fs::metadata(&picture).unwrap().len() > 10_000);
}
