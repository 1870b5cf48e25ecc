//! Tests of edits of objects: touches and directions go with their object, the ground is replaced, and copies and new
//! parents keep the pose.

use std::path::Path;

use glam::DVec3;
use impasto_editor_model::command::{Arrange, Command, Edit, SceneEdit, Touches};
use impasto_editor_model::{Document, Item};
use impasto_scene::document::{Direction, Lens, Object, Region, Scene, Touch, TouchPoint, Up};
use impasto_scene::load::LoadOptions;
use impasto_scene::motion::{CameraPose, camera_at, poses_at};
use impasto_scene::new_scene::Ground;

const AT: [f64; 3] = [0.4, 0.3, -0.2];

/// Two cubes of side 0.8, with a touch on each.
fn cubes() -> Document {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/touching_cubes.ron");
    let mut document = Document::open(&path, &LoadOptions::default()).expect("a shipped scene opens");
    let place = TouchPoint { at: AT, normal: [0.6, 0.8, 0.0] };
    let touches = ["still", "turning"].map(|on| Touch::new(format!("on {on}"), on, vec![place]));
    document.apply(&Command::Touches(Touches::Lay(touches.to_vec()))).expect("they are laid");
    document
}

/// Applies an edit of the cube `still`. Returns the position and the normal of the touch on that cube afterwards.
fn touch_after(edit: Arrange) -> [DVec3; 2] {
    let mut document = cubes();
    let before = document.scene().clone();
    document.apply(&Command::Arrange(edit)).expect("it fits");
    let [own, other] = &document.scene().touches[..] else { panic!("two touches") };
    assert_eq!(*other, before.touches[1], "what lies on another object stays");
    let found = [own.points[0].at, own.points[0].normal].map(DVec3::from);
    document.undo();
    assert_eq!(*document.scene(), before);
    found
}

#[test]
fn touches_go_with_an_object_that_is_stretched_scaled_or_turned_upright() {
    let object = || "still".to_owned();
    let at = DVec3::from(AT);
    let slope = DVec3::new(0.6 / 2.0, 0.8, 0.0).normalize();
    let stretched = Arrange::Stretch { object: object(), factors: DVec3::new(2.0, 1.0, 0.5) };
    for (edit, place, normal) in [
        (stretched, at * DVec3::new(2.0, 1.0, 0.5), slope),
        (Arrange::ScaleTo(object(), 1.6), at * 2.0, DVec3::new(0.6, 0.8, 0.0)),
        // The old Z axis becomes Y, and the old Y axis becomes −Z.
        (Arrange::TurnUpright(object()), DVec3::new(0.4, -0.2, -0.3), DVec3::new(0.6, 0.0, -0.8)),
    ] {
        let [found, turned] = touch_after(edit.clone());
        assert!((found - place).length() < 1e-5, "{edit:?}: at {found}, not {place}");
        assert!((turned - normal).length() < 1e-5, "{edit:?}: normal {turned}, not {normal}");
    }
}

/// An uneven scale stays on the axes of the mesh file, whichever of them was up.
#[test]
fn a_body_that_is_turned_upright_keeps_its_shape() {
    for (_, up) in Up::ALL {
        let set = [("up", format!("{up:?}")), ("scale", "(2, 3, 5)".to_owned())];
        let overrides = set.map(|(field, value)| (format!("objects.still.{field}"), value)).into();
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/touching_cubes.ron");
        let options = LoadOptions { overrides, ..LoadOptions::default() };
        let mut document = Document::open(&path, &options).expect("a shipped scene opens");
        let shape = |document: &Document| {
            let still = document.scene().objects.iter().find(|object| object.name == "still");
            let still = still.expect("it is there");
            let matrix = still.model_from_file();
            (still.up, [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(DVec3::length))
        };
        let (_, lengths) = shape(&document);
        document.apply(&Command::Arrange(Arrange::TurnUpright("still".to_owned()))).expect("it fits");
        let upright = if up == Up::Y { Up::Z } else { Up::Y };
        assert_eq!(shape(&document), (upright, lengths), "{up:?}");
    }
}

#[test]
fn a_ground_that_is_chosen_takes_the_place_of_the_old_one_and_keeps_its_color() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/zoom.ron");
    let mut document = Document::open(&path, &LoadOptions::default()).expect("a shipped scene opens");
    let before = document.scene().clone();
    let ground = |scene: &Scene| {
        let of_scene = |object: &&Object| Ground::of_object(object).is_some();
        scene.objects.iter().find(of_scene).cloned()
    };
    let old = ground(&before).expect("a backdrop");
    let set = |ground| Command::Scene(SceneEdit::SetGround(ground));

    document.apply(&set(Ground::Vignette)).expect("it fits");
    let laid = ground(document.scene()).expect("a patch of floor");
    assert_eq!(Ground::of_scene(document.scene()), Ground::Vignette);
    assert_eq!(laid.material.unwrap().color, old.material.as_ref().unwrap().color);
    let on_old = |scene: &Scene| scene.regions.iter().filter(|r| r.on.object() == Some(&old.name)).count();
    assert_eq!((on_old(&before), on_old(document.scene())), (2, 0), "its regions go with it");
    document.apply(&set(Ground::Plain)).expect("it fits");
    assert_eq!(document.scene().objects.len(), before.objects.len() - 1);
    document.undo();
    document.undo();
    assert_eq!(*document.scene(), before);

    let lock = Edit::SetLocked(vec![Item::Object(old.name.clone())], true);
    document.apply(&Command::Edit(lock)).expect("it can be locked");
    assert!(document.apply(&set(Ground::Plain)).is_err(), "a locked ground stays");
}

#[test]
fn a_copy_of_what_a_shot_brings_stands_and_moves_as_it_does() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/lane.ron");
    let mut document = Document::open(&path, &LoadOptions::default()).expect("a shipped scene opens");
    let names: Vec<String> = document.scene().objects.iter().map(|object| object.name.clone()).collect();
    let of_shot = |name: &String| {
        let scene = document.scene();
        scene.objects.iter().any(|object| object.name == *name && scene.is_moved_by_shot(object))
    };
    let moved: Vec<String> = names.into_iter().filter(of_shot).collect();
    assert!(moved.len() > 3, "the shot moves {moved:?}");
    for name in moved {
        document.apply(&Command::Edit(Edit::Duplicate(vec![Item::Object(name.clone())]))).expect("copied");
        let scene = document.scene();
        let index = scene.objects.iter().position(|object| object.name == name).expect("there");
        let copy = scene.objects.len() - 1;
        for frame in [0.0, 13.0, 48.0] {
            let poses = poses_at(scene, frame);
            let gap = (poses[copy].translation - poses[index].translation).length();
            assert!(gap < 1e-4, "the copy of {name} is {gap} off at frame {frame}");
            assert!(poses[copy].abs_diff_eq(poses[index], 1e-3), "the copy of {name} is turned at {frame}");
        }
        document.undo();
    }
}

#[test]
fn a_copy_is_not_locked() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/lane.ron");
    let mut document = Document::open(&path, &LoadOptions::default()).expect("a shipped scene opens");
    let scene = document.scene();
    let on_object = |region: &&Region| region.on.object().is_some();
    let region = scene.regions.iter().find(on_object).expect("a region");
    let object = Item::Object(region.on.object().expect("an object").to_owned());
    let (region, counts) = (Item::Region(region.name.clone()), (scene.objects.len(), scene.regions.len()));
    let all = || vec![object.clone(), region.clone()];
    document.apply(&Command::Edit(Edit::SetLocked(all(), true))).expect("locked");
    document.apply(&Command::Edit(Edit::Duplicate(all()))).expect("copied");
    let scene = document.scene();
    assert!(scene.objects.len() > counts.0 && scene.regions.len() > counts.1 + 1);
    assert!(scene.objects[counts.0..].iter().all(|copy| !copy.locked));
    assert!(scene.regions[counts.1..].iter().all(|copy| !copy.locked));
}

#[test]
fn the_camera_takes_how_much_an_orthographic_view_shows() {
    let mut document = cubes();
    let (near, far) = (0.1, 50.0);
    let lens = |height: f64| Lens::Orthographic { height, near, far };
    document.apply(&Command::Arrange(Arrange::SetLens(lens(3.0)))).expect("it fits");
    let place = |document: &mut Document, lens: Lens| {
        let pose = CameraPose { lens, ..camera_at(document.scene(), 0.0) };
        document.apply(&Command::Arrange(Arrange::SetCamera { frame: 0.0, pose })).expect("it fits");
        document.scene().camera.lens.clone()
    };
    assert_eq!(place(&mut document, lens(1.25)), lens(1.25));
    let perspective = Lens::Perspective { fov_y_deg: 35.0, near, far };
    assert_eq!(place(&mut document, perspective), lens(1.25), "the projection stays");
    document.undo();
    assert_eq!(document.scene().camera.lens, lens(3.0));
}

/// The pose of an object in the world at frame 0.
fn pose(scene: &Scene, name: &str) -> glam::DAffine3 {
    let index = scene.objects.iter().position(|object| object.name == name).expect("it is there");
    poses_at(scene, 0.0)[index]
}

#[test]
fn an_object_stays_where_it_is_when_it_is_put_under_another_or_taken_off() {
    let mut document = cubes();
    let parent = |parent: Option<&str>| {
        let (object, parent) = ("still".to_owned(), parent.map(str::to_owned));
        Command::Edit(Edit::SetParent { object, parent })
    };
    let before = pose(document.scene(), "still");
    assert!(!pose(document.scene(), "turning").abs_diff_eq(glam::DAffine3::IDENTITY, 1e-3));
    document.apply(&parent(Some("turning"))).expect("it goes under it");
    assert!(pose(document.scene(), "still").abs_diff_eq(before, 1e-9));
    let has_parent = |document: &Document| {
        document.scene().objects.iter().any(|object| object.parent.as_deref() == Some("turning"))
    };
    assert!(has_parent(&document));
    document.apply(&parent(None)).expect("it comes off");
    assert!(!has_parent(&document));
    assert!(pose(document.scene(), "still").abs_diff_eq(before, 1e-9));
}

#[test]
fn what_a_region_states_in_an_object_s_space_goes_with_that_object_alone() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/touching_cubes.ron");
    let toward = |region: &str| (format!("regions.{region}.direction"), "Toward((1, 0.5, 0.2))".to_owned());
    let overrides = vec![toward("still"), toward("turning")];
    let options = LoadOptions { overrides, ..LoadOptions::default() };
    let mut document = Document::open(&path, &options).expect("a shipped scene opens");
    let stretch = Arrange::Stretch { object: "still".to_owned(), factors: DVec3::new(2.0, 1.0, 0.5) };
    document.apply(&Command::Arrange(stretch)).expect("it fits");
    for (name, wanted) in [("still", [2.0, 0.5, 0.1]), ("turning", [1.0, 0.5, 0.2])] {
        let mut regions = document.scene().regions.iter();
        let region = regions.find(|region| region.name == name).expect("it is there");
        let Direction::Toward(at) = region.direction else { panic!("{:?}", region.direction) };
        assert!(DVec3::from(at).abs_diff_eq(DVec3::from(wanted), 1e-6), "{name}: {at:?}");
    }
}
