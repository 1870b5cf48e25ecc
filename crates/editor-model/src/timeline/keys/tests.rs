//! Tests of selecting, dragging and copying keys.

use impasto_scene::document::{BackgroundKey, CameraKey, Color, Ease, LightKey, ObjectKey, Scene};
use impasto_scene::motion;

use super::super::{keyed_frames, lanes};
use super::*;
use crate::command::{KeyedValue, Pose, StrokesOf};

fn scene() -> Scene {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/apple.ron");
    let loaded = impasto_scene::load::load(&path, &Default::default()).expect("a shipped scene");
    let mut scene = loaded.scene;
    let camera = |frame| CameraKey { frame, ..scene.camera.keys[0].clone() };
    scene.camera.keys = vec![camera(0.0), camera(119.0)];
    scene.objects.truncate(1);
    scene.objects[0].name = "apple".to_owned();
    let key = |frame, ease| ObjectKey { ease, ..ObjectKey::at(frame) };
    scene.objects[0].keys = vec![key(0.0, Ease::Smooth), key(60.0, Ease::Linear), key(96.0, Ease::Step)];
    scene
}

fn apple(frame: f64) -> KeyAt {
    (KeyOf::Object("apple".to_owned()), frame)
}

/// A place in lanes that are 32 points high, at 4 points a frame.
fn at(frame: f64, lane: usize) -> LanePosition {
    LanePosition { x_px: frame * 4.0, y_px: lane as f64 * 32.0 + 16.0, frame, lane }
}

fn press(key: Option<KeyAt>, at: LanePosition) -> KeysEvent {
    KeysEvent::Press { at, key, adds: false }
}

fn time(command: Option<Command>) -> Option<Time> {
    command.map(|command| match command {
        Command::Time(time) => time,
        other => panic!("{other:?}"),
    })
}

#[test]
fn frames_with_keys_come_in_order_and_once() {
    assert_eq!(keyed_frames(&scene()), [0.0, 60.0, 96.0, 119.0]);
}

#[test]
fn a_key_that_is_set_again_keeps_its_ease() {
    let mut scene = scene();
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/apple.ron");
    let loaded = impasto_scene::load::load(&path, &Default::default()).expect("a shipped scene");
    let pose = Pose::Object("apple".to_owned(), ObjectKey::at(0.0));
    let set = Command::Time(Time::PoseAtFrame(pose, 96.0));
    set.edit(&mut scene, &loaded).expect("it fits");
    let eases: Vec<Ease> = scene.objects[0].keys.iter().map(|key| key.ease).collect();
    assert_eq!(eases, [Ease::Smooth, Ease::Linear, Ease::Step]);
    let [one, other] = ["#102030", "#405060"].map(|hex| Color::from_hex(hex).expect("a colour"));
    scene.background_keys = vec![BackgroundKey { frame: 5.0, color: one, ease: Ease::Step }];
    let set = Command::Time(Time::PutValue(KeyedValue::Background(other), 5.0));
    set.edit(&mut scene, &loaded).expect("it fits");
    assert_eq!(scene.background_keys, [BackgroundKey { frame: 5.0, color: other, ease: Ease::Step }]);
}

#[test]
fn a_drag_of_three_points_snaps_to_frames_and_is_one_command() {
    let lanes = lanes(&scene());
    let mut hand = KeysHand::default();
    assert_eq!(hand.take(press(Some(apple(60.0)), at(60.2, 1)), &lanes), None);
    assert_eq!(hand.selected(), [apple(60.0)]);
    hand.take(KeysEvent::Move(at(60.7, 1)), &lanes);
    assert_eq!(hand.dragged(), None, "a movement of two points is no drag yet");
    for to in [65.0, 70.0, 72.8] {
        assert_eq!(hand.take(KeysEvent::Move(at(to, 1)), &lanes), None, "nothing is done before the release");
    }
    assert_eq!(hand.dragged(), Some(Dragged { by: 13.0, copies: false }));
    let moved = time(hand.take(KeysEvent::Release, &lanes));
    assert_eq!(moved, Some(Time::MoveKeys(vec![apple(60.0)], 13.0)));
    assert_eq!(hand.dragged(), None);
    assert_eq!(hand.take(KeysEvent::Release, &lanes), None);
}

#[test]
fn keys_that_a_drag_would_replace_are_known_before_and_escape_leaves_no_trace() {
    let lanes = lanes(&scene());
    let mut hand = KeysHand::default();
    hand.take(press(Some(apple(60.0)), at(60.0, 1)), &lanes);
    hand.take(KeysEvent::Move(at(95.0, 1)), &lanes);
    assert_eq!(hand.replaces(&lanes), []);
    hand.take(KeysEvent::Move(at(96.0, 1)), &lanes);
    assert_eq!(hand.replaces(&lanes), [apple(96.0)]);
    hand.take(KeysEvent::Cancel, &lanes);
    assert_eq!((hand.dragged(), hand.selected()), (None, &[apple(60.0)][..]));
    assert_eq!(hand.take(KeysEvent::Release, &lanes), None);
    // A dragged key does not replace another dragged key. A copy does, because the keys themselves stay.
    hand.take(KeysEvent::Press { at: at(96.0, 1), key: Some(apple(96.0)), adds: true }, &lanes);
    hand.take(KeysEvent::Move(at(132.0, 1)), &lanes);
    assert_eq!(hand.dragged().map(|dragged| dragged.by), Some(36.0));
    assert_eq!(hand.replaces(&lanes), []);
    hand.take(KeysEvent::Copy, &lanes);
    assert_eq!(hand.replaces(&lanes), [apple(96.0)]);
    let copied = time(hand.take(KeysEvent::Release, &lanes));
    assert_eq!(copied, Some(Time::CopyKeys(vec![apple(60.0), apple(96.0)], 36.0)));
}

#[test]
fn copies_follow_the_pointer_until_a_press() {
    let lanes = lanes(&scene());
    let mut hand = KeysHand::default();
    assert_eq!(hand.take(KeysEvent::Copy, &lanes), None);
    assert!(!hand.follows(), "nothing is selected");
    hand.take(KeysEvent::Select(apple(0.0)), &lanes);
    hand.take(KeysEvent::Copy, &lanes);
    hand.take(KeysEvent::Move(at(50.0, 1)), &lanes);
    hand.take(KeysEvent::Move(at(60.0, 1)), &lanes);
    assert!(hand.follows());
    let copied = time(hand.take(press(Some(apple(0.0)), at(60.0, 1)), &lanes));
    assert_eq!(copied, Some(Time::CopyKeys(vec![apple(0.0)], 10.0)));
    assert_eq!(hand.take(KeysEvent::Release, &lanes), None, "the button of that press goes up");
}

#[test]
fn a_box_selects_across_lanes_and_a_click_between_keys_changes_the_ease() {
    let lanes = lanes(&scene());
    let mut hand = KeysHand::default();
    hand.take(press(None, at(110.0, 1)), &lanes);
    hand.take(KeysEvent::Move(at(125.0, 0)), &lanes);
    assert_eq!(hand.selected(), [(KeyOf::Camera, 119.0)]);
    hand.take(KeysEvent::Move(at(50.0, 1)), &lanes);
    assert_eq!(hand.selected(), [apple(60.0), apple(96.0)]);
    assert!(hand.boxed().is_some());
    assert_eq!(hand.take(KeysEvent::Release, &lanes), None);
    assert_eq!(hand.selected().len(), 2);
    // A click between two keys changes the ease from one to the other, and not the selection.
    let eased = |hand: &mut KeysHand, frame| {
        hand.take(press(None, at(frame, 1)), &lanes);
        time(hand.take(KeysEvent::Release, &lanes))
    };
    assert_eq!(eased(&mut hand, 30.0), Some(Time::SetEase(vec![apple(0.0)], Ease::Linear)));
    assert_eq!(eased(&mut hand, 80.0), Some(Time::SetEase(vec![apple(60.0)], Ease::Step)));
    assert_eq!(hand.selected().len(), 2);
    // A curve was made by hand: no click throws it away.
    let mut curved = scene();
    for key in curved.objects.iter_mut().flat_map(|object| &mut object.keys) {
        key.ease = Ease::Curve([0.2, 0.0], [0.4, 1.2]);
    }
    let curved = super::super::lanes(&curved);
    hand.take(press(None, at(30.0, 1)), &curved);
    assert_eq!(hand.take(KeysEvent::Release, &curved), None);
    // After the last key there is no ease to change: a click clears the selection.
    assert_eq!(eased(&mut hand, 110.0), None);
    assert_eq!(hand.selected(), []);
    assert!(!hand.has_focus());
}

#[test]
fn keys_stay_within_the_largest_frame_numbers() {
    let lanes = lanes(&scene());
    let mut hand = KeysHand::default();
    hand.take(KeysEvent::SelectAll, &lanes);
    assert_eq!(hand.selected().len(), 5);
    hand.take(press(Some(apple(0.0)), at(0.0, 1)), &lanes);
    hand.take(KeysEvent::Move(at(4e12, 1)), &lanes);
    assert_eq!(hand.dragged().map(|dragged| dragged.by), Some(MAX_FRAME - 119.0));
    hand.take(KeysEvent::Move(at(-4e12, 1)), &lanes);
    assert_eq!(hand.dragged().map(|dragged| dragged.by), Some(-MAX_FRAME));
    hand.take(KeysEvent::Cancel, &lanes);
    let fewer = lanes[..1].to_vec();
    hand.retain(&fewer);
    assert_eq!(hand.selected().len(), 2, "the apple is gone");
}

#[test]
fn lights_background_and_strokes_have_lanes_once_they_have_keys() {
    let mut document = scene();
    let (before, light) = (lanes(&document).len(), document.lights[0].name.clone());
    let owners = [
        KeyOf::Light(light.clone()),
        KeyOf::Background,
        KeyOf::Strokes(StrokesOf::Scene),
        KeyOf::Strokes(StrokesOf::Region(document.regions[0].name.clone())),
    ];
    let run = |time: Time, document: &mut Scene| time.edit(document).expect("a sound edit");
    for of in &owners {
        for frame in [0.0, 40.0] {
            run(Time::SetKey(of.clone(), frame), &mut document);
        }
    }
    let lanes_now = lanes(&document);
    assert_eq!(lanes_now[before..].iter().map(|lane| lane.of.clone()).collect::<Vec<_>>(), owners);
    // Puts one value at a frame. The light's other values at that frame do not change.
    let intensity = document.lights[0].intensity;
    let stated = LightKey { intensity: Some(9.0), ..LightKey::at(20.0) };
    run(Time::PutValue(KeyedValue::Light(light, stated), 20.0), &mut document);
    assert_eq!(document.lights[0].keys.len(), 3);
    assert_eq!(motion::light_at(&document, &document.lights[0], 20.0).intensity, 9.0);
    assert_eq!(motion::light_at(&document, &document.lights[0], 40.0).intensity, intensity);
    assert_eq!(document.lights[0].keys[1].direction, document.lights[0].direction);
    // A key that is moved onto another replaces it, and brings its own ease.
    run(Time::SetEase(vec![(KeyOf::Background, 0.0)], Ease::Step), &mut document);
    run(Time::MoveKeys(vec![(KeyOf::Background, 0.0)], 40.0), &mut document);
    let keys: Vec<_> = document.background_keys.iter().map(|key| (key.frame, key.ease)).collect();
    assert_eq!(keys, [(40.0, Ease::Step)]);
    run(Time::CopyKeys(vec![(owners[2].clone(), 0.0), (owners[2].clone(), 40.0)], 40.0), &mut document);
    let frames: Vec<f64> = document.strokes.keys.iter().map(|key| key.frame).collect();
    assert_eq!(frames, [0.0, 40.0, 80.0]);
    run(Time::DeleteKeys(vec![(KeyOf::Background, 40.0)]), &mut document);
    assert_eq!(lanes(&document).len(), before + 3);
    let all = document.camera.keys.iter().map(|key| (KeyOf::Camera, key.frame)).collect();
    assert!(Time::DeleteKeys(all).edit(&mut document).is_err());
}
