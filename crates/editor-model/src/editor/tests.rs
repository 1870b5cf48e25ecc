//! Tests of the editor through plain events: drags, cancelling, typed numbers, stroke previews.

use std::path::Path;
use std::sync::OnceLock;

use glam::DVec2;
use impasto_painting::prepare;
use impasto_scene::document::LightKind;
use impasto_scene::load::LoadOptions;

use super::*;
use crate::camera_rig::ZOOM_PER_STEP;
use crate::command::{Arrange, Edit, Regions};
use crate::keymap::{Action, Button};
use crate::session::Axes;

mod lights;
mod menus;
mod selecting;
mod time;

const SIZE_PX: DVec2 = DVec2::new(960.0, 540.0);

/// An editor with `apple.ron`, prepared. All share one painting of it, since preparing is the slow part.
fn with_apple() -> Editor {
    static PAINTING: OnceLock<Painting> = OnceLock::new();
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/apple.ron");
    let document = Document::open(&path, &LoadOptions::default()).expect("a shipped scene opens");
    let mut editor = Editor::new(document);
    let painting = PAINTING.get_or_init(|| prepare(Arc::clone(editor.shown().0)).expect("it prepares"));
    editor.prepared(painting.clone());
    editor
}

fn prepared(editor: &mut Editor) {
    let painting = prepare(Arc::clone(editor.shown().0)).expect("it prepares");
    editor.prepared(painting);
}

fn view(editor: &Editor) -> View {
    View { camera: editor.camera(), size_px: SIZE_PX }
}

fn event(editor: &mut Editor, kind: PointerKind, at_px: DVec2, held: Modifiers) {
    let view = view(editor);
    let at_secs = editor.at_secs + 0.01;
    editor.pointer(&PointerEvent { kind, at_px, held, at_secs, pressure: 1.0 }, &view);
}

fn drag(editor: &mut Editor, button: Button, path: [DVec2; 2], held: Modifiers) {
    event(editor, PointerKind::Move, path[0], held);
    event(editor, PointerKind::Press(button), path[0], held);
    for step in 1..=20 {
        event(editor, PointerKind::Move, path[0].lerp(path[1], f64::from(step) / 20.0), held);
    }
    event(editor, PointerKind::Release(button), path[1], held);
}

fn click(editor: &mut Editor, at: DVec2) {
    for kind in [PointerKind::Move, PointerKind::Press(Button::Left), PointerKind::Release(Button::Left)] {
        event(editor, kind, at, HERE);
    }
}

fn act(editor: &mut Editor, action: Action) {
    let view = view(editor);
    editor.act(action, &view);
}

fn key(editor: &mut Editor, key: Key) {
    let view = view(editor);
    assert!(editor.key(key, Modifiers::default(), false, &view), "{key:?} means nothing here");
}

/// Where the middle of the apple shows, in pixels.
fn middle_of_the_apple(editor: &Editor) -> DVec2 {
    let scene = editor.document().scene();
    let apple =
        scene.objects.iter().position(|object| object.name.contains("apple")).expect("there is an apple");
    let [low, high] = editor.picker().bounds_in_world([apple], &editor.poses()).expect("it has a surface");
    view(editor).project((low + high) * 0.5).expect("it is in the picture")
}

const HERE: Modifiers = Modifiers { ctrl: false, shift: false, alt: false };

#[test]
fn one_drag_is_previewed_and_becomes_one_entry() {
    let mut editor = with_apple();
    act(&mut editor, Action::Paint);
    let at = middle_of_the_apple(&editor);
    let first = editor.document().scene().clone();
    event(&mut editor, PointerKind::Move, at, HERE);
    assert!(!editor.tool_output().rings.is_empty(), "no ring");
    event(&mut editor, PointerKind::Press(Button::Left), at, HERE);
    for step in 1..=20 {
        event(&mut editor, PointerKind::Move, at + DVec2::new(4.0 * f64::from(step), -2.0), HERE);
    }
    assert!(editor.is_moving());
    assert_ne!(editor.shown().0.scene, first, "nothing shows while the hand moves");
    assert_eq!(*editor.document().scene(), first, "the document changes before the release");
    event(&mut editor, PointerKind::Release(Button::Left), at + DVec2::new(80.0, -2.0), HERE);
    assert_eq!(editor.document().undo_count(), 1);
    let combed = editor.document().undo_text().expect("an entry").to_owned();
    assert!(combed.starts_with("Comb "), "{combed}");
    let guides: usize = editor.document().scene().regions.iter().map(|region| region.guides.len()).sum();
    assert_eq!(guides, first.regions.iter().map(|region| region.guides.len()).sum::<usize>() + 1);
    assert!(matches!(editor.document().selection().active(), Some(Item::Region(_))));
    act(&mut editor, Action::Undo);
    assert_eq!(*editor.document().scene(), first);
}

#[test]
fn what_interrupts_a_drag_cancels_it_without_a_trace() {
    let by_escape: fn(&mut Editor) = |editor| key(editor, Key::Escape);
    let by_lost_focus: fn(&mut Editor) = |editor| editor.focus_lost(&view(editor));
    let by_mode: fn(&mut Editor) = |editor| editor.set_mode(Mode::Arrange, &view(editor));
    let by_comparing: fn(&mut Editor) = |editor| act(editor, Action::Compare);
    for cancel in [by_escape, by_lost_focus, by_mode, by_comparing] {
        let mut editor = with_apple();
        act(&mut editor, Action::Paint);
        let at = middle_of_the_apple(&editor);
        let first = editor.document().scene().clone();
        event(&mut editor, PointerKind::Move, at, HERE);
        event(&mut editor, PointerKind::Press(Button::Left), at, HERE);
        event(&mut editor, PointerKind::Move, at + DVec2::new(60.0, 10.0), HERE);
        cancel(&mut editor);
        assert_eq!(editor.shown().0.scene, first);
        event(&mut editor, PointerKind::Release(Button::Left), at + DVec2::new(60.0, 10.0), HERE);
        assert_eq!(*editor.document().scene(), first);
        assert_eq!(editor.document().undo_count(), 0);
        assert!(!editor.is_moving());
    }
}

#[test]
fn a_click_with_a_brush_selects_the_region_under_it() {
    let mut editor = with_apple();
    act(&mut editor, Action::Paint);
    editor.select(Selection::default());
    let at = middle_of_the_apple(&editor);
    click(&mut editor, at);
    let active = editor.document().selection().active();
    assert!(matches!(active, Some(Item::Region(_))), "{active:?}");
    assert_eq!(editor.document().undo_count(), 0);
}

#[test]
fn a_tool_that_is_taken_up_shows_its_ring_at_once() {
    let mut editor = with_apple();
    act(&mut editor, Action::Paint);
    let at = middle_of_the_apple(&editor);
    event(&mut editor, PointerKind::Move, at, HERE);
    let view = view(&editor);
    editor.take_up(Tool::Fill, &view);
    editor.take_up(Tool::Comb, &view);
    assert!(!editor.tool_output().rings.is_empty(), "no ring");
}

#[test]
fn a_click_ends_with_its_release() {
    let mut editor = with_apple();
    act(&mut editor, Action::Arrange);
    let at = middle_of_the_apple(&editor);
    click(&mut editor, at);
    event(&mut editor, PointerKind::Move, at + DVec2::new(90.0, 20.0), HERE);
    assert!(!editor.is_moving());
    assert!(matches!(editor.document().selection().active(), Some(Item::Object(_))));
}

#[test]
fn painting_on_a_locked_region_is_refused_with_a_message() {
    let mut editor = with_apple();
    let names: Vec<Item> =
        editor.document().scene().objects.iter().map(|object| Item::Object(object.name.clone())).collect();
    assert!(editor.run(&Command::Edit(Edit::SetLocked(names, true))));
    prepared(&mut editor);
    act(&mut editor, Action::Paint);
    let at = middle_of_the_apple(&editor);
    let count = editor.document().undo_count();
    drag(&mut editor, Button::Left, [at, at + DVec2::new(60.0, 0.0)], HERE);
    assert_eq!(editor.document().undo_count(), count);
    let said = editor.take_said();
    assert!(said.iter().any(|said| said.words.contains("is locked") && said.is_refusal), "{said:?}");
}

#[test]
fn a_typed_move_shifts_all_keys() {
    let mut editor = with_apple();
    let name = editor.document().scene().objects[0].name.clone();
    editor.select(Selection::only(Item::Object(name)));
    editor.session.options.axes = Axes::World;
    let before = editor.poses()[0].translation;
    let at = middle_of_the_apple(&editor);
    event(&mut editor, PointerKind::Move, at, HERE);
    for pressed in [Key::Letter('G'), Key::Letter('X'), Key::NumPadPoint, Key::Digit(5), Key::Enter] {
        key(&mut editor, pressed);
    }
    let moved = editor.poses()[0].translation - before;
    assert!(moved.abs_diff_eq(DVec3::new(0.5, 0.0, 0.0), 1e-9), "{moved}");
    assert_eq!(editor.document().undo_count(), 1);
    for pressed in
        [Key::Letter('R'), Key::Letter('Z'), Key::Sign('-'), Key::Digit(3), Key::Digit(0), Key::Escape]
    {
        key(&mut editor, pressed);
    }
    assert_eq!(editor.document().undo_count(), 1);
}

#[test]
fn the_middle_button_leaves_the_shot_and_zero_comes_back() {
    let mut editor = with_apple();
    let shot = editor.camera();
    let at = middle_of_the_apple(&editor);
    drag(&mut editor, Button::Middle, [at, at + DVec2::new(80.0, 30.0)], HERE);
    assert_ne!(editor.camera(), shot);
    assert_eq!(editor.document().undo_count(), 0, "a free view is no entry");
    act(&mut editor, Action::LookThrough);
    assert_eq!(editor.camera(), shot);
}

#[test]
fn painting_begins_at_the_reference_and_leaves_the_frame_as_it_was() {
    let mut editor = with_apple();
    editor.session.frame = 3.0;
    act(&mut editor, Action::TogglePaint);
    assert_eq!((editor.session.mode, editor.session.frame), (Mode::Paint, 0.0));
    act(&mut editor, Action::TogglePaint);
    assert_eq!((editor.session.mode, editor.session.frame), (Mode::Arrange, 3.0));
}

#[test]
fn a_refused_command_says_why_once() {
    let mut editor = with_apple();
    let command = Command::Regions(Regions::SetColor("nobody".to_owned(), Default::default()));
    assert!(!editor.run(&command) && !editor.run(&command));
    let said = editor.take_said();
    assert_eq!(said.len(), 1, "{said:?}");
    assert!(said[0].words.contains("nobody"));
}

#[test]
fn stroke_previews_show_from_the_first_movement_until_the_pointer_rests() {
    let mut editor = with_apple();
    act(&mut editor, Action::Paint);
    let at = middle_of_the_apple(&editor);
    event(&mut editor, PointerKind::Move, at, HERE);
    assert!(editor.tool_output().comb_preview.is_none(), "a preview shows before the pointer moves");
    for step in 1..=4 {
        event(&mut editor, PointerKind::Move, at + DVec2::new(5.0 * f64::from(step), 0.0), HERE);
    }
    let comb_preview = editor.tool_output().comb_preview.expect("it moves over the apple");
    assert_eq!(comb_preview.along, DVec2::X);
    assert!((comb_preview.at_px - at - DVec2::new(20.0, 0.0)).length() < 1e-6, "{comb_preview:?}");

    // The ring previews the same strokes that the whole picture has there.
    let painting = editor.painting().expect("it is prepared");
    let options = impasto_painting::FrameOptions::new([960, 540]);
    let camera = editor.camera();
    let place = impasto_painting::SurfacePlace {
        object: comb_preview.object,
        position: comb_preview.position_in_model,
        normal: comb_preview.normal_in_model,
        radius: comb_preview.radius,
    };
    let near = painting.stroke_directions_near(&place, &camera, 0.0, &options, 40);
    assert_eq!(near.len(), 40);
    let is_near = |direction_line: &impasto_painting::StrokeDirection| {
        near.iter().any(|near| near.particle == direction_line.particle)
    };
    let of_object = |direction_line: &impasto_painting::StrokeDirection| {
        direction_line.object == comb_preview.object && is_near(direction_line)
    };
    let all = painting.stroke_directions(&camera, 0.0, &options, 1.0, &of_object);
    assert!(all.len() > 30, "{}", all.len());
    for direction_line in &all {
        assert!(near.contains(direction_line), "{direction_line:?}");
        let off_px = DVec2::from(direction_line.position_px.map(f64::from)).distance(comb_preview.at_px);
        assert!(off_px < editor.session.options.radius_px * 1.05, "{off_px}");
    }

    let view = view(&editor);
    let moved_secs = editor.at_secs;
    // As in the window, `tick` is called before `rested`.
    for (rest_secs, rests) in [(0.2, false), (0.5, true)] {
        editor.tick(moved_secs + rest_secs);
        editor.rested(moved_secs + rest_secs, &view);
        assert_eq!(editor.tool_output().label.is_some(), rests, "after {rest_secs} s");
        assert_eq!(editor.tool_output().comb_preview.is_none(), rests, "after {rest_secs} s");
    }
    assert!(editor.tool_output().label.as_ref().is_some_and(|label| label.contains("trust")));

    editor.session.options.foresee = false;
    for step in 1..=4 {
        event(&mut editor, PointerKind::Move, at + DVec2::new(5.0 * f64::from(step), 0.0), HERE);
    }
    assert!(editor.tool_output().comb_preview.is_none(), "a preview shows though previews are switched off");
}

#[test]
fn a_mesh_in_an_edited_scene_without_a_file_gives_it_a_folder_and_a_camera() {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let elsewhere = std::env::temp_dir();
    let mut editor = Editor::new(Document::empty(&elsewhere));
    let lamp = Arrange::AddLight { kind: LightKind::Point, at: DVec3::ONE, toward: DVec3::ZERO };
    assert!(editor.run(&Command::Arrange(lamp)));
    let lights = editor.document().scene().lights.len();
    let camera = editor.document().scene().camera.clone();
    assert!(editor.live_in(&scenes.join("meshes")));
    assert!(editor.import("apple.obj"));
    assert_eq!(editor.document().folder(), scenes.join("meshes"));
    assert_eq!(editor.document().suggested_file(), scenes.join("meshes/apple.ron"));
    assert_eq!(editor.document().scene().lights.len(), lights, "what was edited before is kept");
    assert_ne!(editor.document().scene().camera, camera, "the camera does not move to show the whole mesh");
    assert!(!editor.live_in(&elsewhere), "the folder changes though a mesh is named relative to it");
    act(&mut editor, Action::Undo);
    assert_eq!(editor.document().scene().camera, camera);
}

#[test]
fn a_shot_that_begins_late_opens_at_its_first_frame() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/apple.ron");
    let late = LoadOptions {
        overrides: vec![("timeline.first".to_owned(), "20".to_owned())],
        ..LoadOptions::default()
    };
    let document = || Document::open(&path, &late).expect("a shipped scene opens");
    assert_eq!(Editor::new(document()).session.frame, 20.0);
    let mut editor = with_apple();
    editor.session.frame = 50.0;
    editor.open(document());
    assert_eq!(editor.session.frame, 20.0, "a scene that replaces another does not open at its first frame");
}

/// The scene of the apple, with a built-in backdrop in place of the wall.
fn with_backdrop() -> Editor {
    let mut editor = with_apple();
    let (object, mesh) = ("wall".to_owned(), "impasto:backdrop".to_owned());
    assert!(editor.run(&Command::Arrange(Arrange::ReplaceMesh { object, mesh })));
    prepared(&mut editor);
    editor
}

/// A place in the picture where the wall shows.
fn on_the_wall(editor: &Editor) -> DVec2 {
    let view = view(editor);
    let scene = editor.document().scene();
    let places =
        (1..20).flat_map(|x| (1..12).map(move |y| DVec2::new(48.0 * f64::from(x), 45.0 * f64::from(y))));
    let is_wall =
        |at: &DVec2| editor.hit(*at, &view).is_some_and(|hit| scene.objects[hit.object].name == "wall");
    places.into_iter().find(is_wall).expect("the wall shows")
}

#[test]
fn a_drag_that_misses_selects_the_wall_and_does_not_move_it() {
    let mut editor = with_backdrop();
    for mode in [Action::Arrange, Action::Animate] {
        act(&mut editor, mode);
        let (before, at) = (editor.document().scene().clone(), on_the_wall(&editor));
        // In the second round the wall is selected already; it must not move then, either.
        for _ in 0..2 {
            drag(&mut editor, Button::Left, [at, at + DVec2::new(60.0, 10.0)], HERE);
            assert_eq!(editor.document().selection().active(), Some(&Item::Object("wall".to_owned())));
            assert!(*editor.document().scene() == before, "the drag moved the wall");
        }
        // The move key does move it.
        for pressed in [Key::Letter('G'), Key::Letter('X'), Key::Digit(1), Key::Enter] {
            key(&mut editor, pressed);
        }
        assert!(*editor.document().scene() != before);
    }
}

#[test]
fn framing_a_region_frames_its_object() {
    let mut editor = with_apple();
    let apple = editor.document().scene().objects.iter().find(|object| object.name.contains("apple"));
    let apple = apple.expect("there is an apple").name.clone();
    let region = editor.document().scene().regions.iter().find(|of| of.on.object() == Some(apple.as_str()));
    let region = region.expect("the apple has a region").name.clone();
    let framed = |editor: &mut Editor, item: Item| {
        act(editor, Action::LookThrough);
        editor.select(Selection::only(item));
        act(editor, Action::FrameSelected);
        editor.camera()
    };
    let shot = editor.camera();
    let by_object = framed(&mut editor, Item::Object(apple));
    assert_ne!(by_object, shot);
    assert_eq!(framed(&mut editor, Item::Region(region)), by_object);
}

#[test]
fn over_a_backdrop_the_view_zooms_and_turns_about_the_models_before_it() {
    let mut editor = with_backdrop();
    editor.select(Selection::default());
    let models = |editor: &Editor| {
        let objects = &editor.document().scene().objects;
        let all = (0..objects.len()).filter(|&index| !objects[index].mesh.starts_with("impasto:"));
        let [low, high] = editor.picker().bounds_in_world(all, &editor.poses()).expect("they have surfaces");
        (low + high) * 0.5
    };
    let (at, middle) = (on_the_wall(&editor), models(&editor));
    let before = view(&editor).px_per_unit(middle);
    event(&mut editor, PointerKind::Wheel(2.0), at, HERE);
    let grown = view(&editor).px_per_unit(middle) / before;
    let wanted = ZOOM_PER_STEP.powi(-2);
    assert!((grown / wanted - 1.0).abs() < 1e-6, "grew {grown} times in two steps, not {wanted}");
    let place = view(&editor).project(middle).expect("it shows");
    drag(&mut editor, Button::Middle, [at, at + DVec2::new(90.0, 20.0)], HERE);
    let moved = view(&editor).project(middle).expect("it shows").distance(place);
    assert!(moved < 1e-6, "the models moved by {moved} pixels");
}

#[test]
fn a_copy_follows_the_pointer_at_once() {
    let mut editor = with_apple();
    act(&mut editor, Action::Arrange);
    let at = middle_of_the_apple(&editor);
    drag(&mut editor, Button::Left, [at, at], HERE);
    let count = editor.document().scene().objects.len();
    act(&mut editor, Action::Duplicate);
    assert!(editor.is_moving(), "the copy is held");
    event(&mut editor, PointerKind::Move, at + DVec2::new(90.0, 0.0), HERE);
    event(&mut editor, PointerKind::Press(Button::Left), at + DVec2::new(90.0, 0.0), HERE);
    let objects = &editor.document().scene().objects;
    assert_eq!(objects.len(), count + 1);
    let copy = editor.document().selection().active().expect("the copy is selected").name();
    let places = ["apple", copy].map(|name| {
        let object = objects.iter().find(|object| object.name == name).expect("it is there");
        object.keys[0].translation
    });
    assert_ne!(places[0], places[1]);
    // With Maya's keys, the copy does not follow the pointer.
    let mut editor = with_apple();
    editor.keymap.preset = crate::keymap::Preset::Maya;
    drag(&mut editor, Button::Left, [at, at], HERE);
    act(&mut editor, Action::Duplicate);
    assert!(!editor.is_moving());
}

#[test]
fn the_move_key_moves_the_selected_camera_until_a_click() {
    let mut editor = with_apple();
    act(&mut editor, Action::Arrange);
    editor.select(Selection::only(Item::Camera));
    let (before, at) = (editor.document().scene().camera.clone(), DVec2::new(400.0, 250.0));
    event(&mut editor, PointerKind::Move, at, HERE);
    key(&mut editor, Key::Letter('G'));
    event(&mut editor, PointerKind::Move, at + DVec2::new(50.0, 20.0), HERE);
    assert_eq!(editor.document().scene().camera, before, "the camera has new keys before the click");
    assert_ne!(editor.shot().eye, motion::camera_at(editor.document().scene(), 0.0).eye, "the camera stays");
    event(&mut editor, PointerKind::Press(Button::Left), at + DVec2::new(50.0, 20.0), HERE);
    event(&mut editor, PointerKind::Release(Button::Left), at + DVec2::new(50.0, 20.0), HERE);
    assert_ne!(editor.document().scene().camera, before);
    act(&mut editor, Action::Undo);
    assert_eq!(editor.document().scene().camera, before);
    key(&mut editor, Key::Letter('G'));
    event(&mut editor, PointerKind::Move, at, HERE);
    key(&mut editor, Key::Escape);
    assert!(!editor.is_moving());
    assert_eq!((&editor.document().scene().camera, editor.document().undo_count()), (&before, 0));
}
