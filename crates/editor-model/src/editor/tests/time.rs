//! Tests of time in the editor: keys, poses that are not keyed yet, playback and scrubbing.

use impasto_scene::document::{Ease, ObjectKey, Scene};

use super::*;
use crate::command::{KeyOf, Pose, Time};
use crate::playback::Pacing;
use crate::timeline::{KeyAt, KeysEvent, LanePosition, TimelineEvent};

/// An editor in Animate at a frame, with the apple selected; and the apple's name.
fn animating(frame: f64) -> (Editor, String) {
    let mut editor = with_apple();
    let name = editor.document().scene().objects[0].name.clone();
    editor.select(Selection::only(Item::Object(name.clone())));
    assert!(editor.run(&Command::Time(Time::SetRange(0, 119))));
    act(&mut editor, Action::Animate);
    editor.session.frame = frame;
    editor.tick(0.0);
    (editor, name)
}

/// Moves the apple by typing G X .5 Enter.
fn move_by_half(editor: &mut Editor) {
    let at = middle_of_the_apple(editor);
    event(editor, PointerKind::Move, at, HERE);
    for pressed in [Key::Letter('G'), Key::Letter('X'), Key::NumPadPoint, Key::Digit(5), Key::Enter] {
        key(editor, pressed);
    }
}

fn frames(scene: &Scene) -> Vec<f64> {
    scene.objects[0].keys.iter().map(|key| key.frame).collect()
}

fn x_at(scene: &Scene, frame: f64) -> f64 {
    motion::poses_at(scene, frame)[0].translation.x
}

fn words(editor: &mut Editor) -> Vec<String> {
    editor.take_said().into_iter().map(|said| said.words).collect()
}

#[test]
fn the_first_pose_also_keys_the_reference_and_undo_takes_both() {
    let (mut editor, name) = animating(60.0);
    let before = editor.document().scene().clone();
    let count = editor.document().undo_count();
    move_by_half(&mut editor);
    let scene = editor.document().scene();
    assert_eq!(frames(scene), [0.0, 60.0]);
    assert!((x_at(scene, 60.0) - x_at(&before, 60.0) - 0.5).abs() < 1e-9);
    assert_eq!(x_at(scene, 0.0), x_at(&before, 0.0), "at frame 0 the apple stays where it was");
    assert_eq!(editor.document().undo_count(), count + 1);
    assert_eq!(words(&mut editor), [format!("Also keyed frame 0, so that {name} moves from there")]);
    act(&mut editor, Action::Undo);
    assert_eq!(*editor.document().scene(), before);
}

#[test]
fn without_auto_key_a_pose_stays_at_its_frame_until_it_is_keyed() {
    let (mut editor, name) = animating(60.0);
    editor.session.auto_key = false;
    let (before, count) = (editor.document().scene().clone(), editor.document().undo_count());
    move_by_half(&mut editor);
    move_by_half(&mut editor);
    assert_eq!((editor.document().scene(), editor.document().undo_count()), (&before, count));
    assert!(
        (x_at(&editor.shown().0.scene, 60.0) - x_at(&before, 60.0) - 1.0).abs() < 1e-9,
        "the second move adds to the first"
    );
    assert!(editor.time().is_loose(&name));
    assert_eq!(editor.status(), format!("{name} is not keyed here  [I] keep it"));
    // An edit of something else leaves the pose as it is.
    assert!(editor.run(&Command::Time(Time::SetFps(25.0))));
    assert!(editor.time().is_loose(&name) && x_at(&editor.shown().0.scene, 60.0) > 0.9);
    assert_eq!(editor.document().scene().timeline.fps, 25.0);
    key(&mut editor, Key::Letter('I'));
    assert!(!editor.time().is_loose(&name));
    assert_eq!(frames(editor.document().scene()), [0.0, 60.0]);
    assert!((x_at(editor.document().scene(), 60.0) - x_at(&before, 60.0) - 1.0).abs() < 1e-9);
    assert_eq!(editor.document().undo_count(), count + 2, "one entry for the rate, one for the key");
}

#[test]
fn keying_one_of_two_loose_poses_leaves_the_other_loose() {
    let (mut editor, apple) = animating(60.0);
    editor.session.auto_key = false;
    let objects = editor.document().scene().objects.iter();
    let names: Vec<String> = objects.map(|object| object.name.clone()).collect();
    editor.select(names.iter().map(|name| Item::Object(name.clone())).collect());
    move_by_half(&mut editor);
    assert!(names.len() > 1 && names.iter().all(|name| editor.time().is_loose(name)), "{names:?}");
    assert!(editor.run(&Command::Time(Time::SetKey(KeyOf::Object(apple.clone()), 60.0))));
    let loose: Vec<&String> = names.iter().filter(|name| editor.time().is_loose(name)).collect();
    assert!(loose.len() == names.len() - 1 && !loose.contains(&&apple), "{loose:?}");
}

#[test]
fn a_step_from_between_two_frames_goes_to_the_next_whole_one() {
    let (mut editor, _) = animating(3.5);
    act(&mut editor, Action::StepOn);
    assert_eq!(editor.session.frame, 4.0);
    act(&mut editor, Action::StepOn);
    assert_eq!(editor.session.frame, 5.0);
    editor.session.frame = 3.5;
    act(&mut editor, Action::StepBack);
    assert_eq!(editor.session.frame, 3.0);
    act(&mut editor, Action::StepBack);
    assert_eq!(editor.session.frame, 2.0);
}

#[test]
fn an_unkeyed_pose_that_was_left_can_be_brought_back() {
    let (mut editor, name) = animating(60.0);
    editor.session.auto_key = false;
    let before = editor.document().scene().clone();
    move_by_half(&mut editor);
    editor.take_said();
    act(&mut editor, Action::StepOn);
    editor.tick(1.0);
    assert_eq!(editor.shown().0.scene, before);
    let said = editor.take_said();
    assert_eq!(said[0].words, format!("{name} went back to its keys"));
    assert_eq!(said[0].offers, Some(Offer::PoseAgain));
    editor.pose_again();
    editor.tick(1.1);
    assert_eq!(editor.session.frame, 60.0);
    assert!(editor.time().is_loose(&name) && x_at(&editor.shown().0.scene, 60.0) > 0.4);
    // Locking the object drops its unkeyed pose.
    assert!(editor.run(&Command::Edit(Edit::SetLocked(vec![Item::Object(name.clone())], true))));
    assert!(!editor.time().is_loose(&name));
    assert_eq!(editor.shown().0.scene, *editor.document().scene());
}

#[test]
fn with_the_view_locked_to_it_orbit_keys_the_shot() {
    let (mut editor, _) = animating(60.0);
    let before = editor.document().scene().clone();
    let at = middle_of_the_apple(&editor);
    editor.session.lock_to_view = true;
    let count = editor.document().undo_count();
    drag(&mut editor, Button::Middle, [at, at + DVec2::new(80.0, 0.0)], HERE);
    assert_eq!(editor.looking, Looking::Shot);
    assert_eq!(editor.document().undo_count(), count + 1);
    let keys: Vec<f64> = editor.document().scene().camera.keys.iter().map(|key| key.frame).collect();
    assert_eq!(keys, [0.0, 60.0, 90.0]);
    let eye = |scene: &Scene, frame| motion::camera_at(scene, frame).eye;
    assert_eq!(eye(editor.document().scene(), 0.0), eye(&before, 0.0));
    assert_ne!(eye(editor.document().scene(), 60.0), eye(&before, 60.0));
    // A press without a drag keys nothing.
    drag(&mut editor, Button::Middle, [at, at], HERE);
    assert_eq!(editor.document().undo_count(), count + 1);
    event(&mut editor, PointerKind::Wheel(1.0), at, HERE);
    event(&mut editor, PointerKind::Wheel(1.0), at, HERE);
    assert_eq!(editor.document().undo_count(), count + 2, "steps of the wheel are one entry");
    editor.session.lock_to_view = false;
    drag(&mut editor, Button::Middle, [at, at + DVec2::new(80.0, 0.0)], HERE);
    assert_ne!(editor.looking, Looking::Shot);
    assert_eq!(editor.document().undo_count(), count + 2);
}

fn camera_keys(scene: &Scene) -> Vec<(f64, [f64; 3])> {
    scene.camera.keys.iter().map(|key| (key.frame, key.eye)).collect()
}

/// Moves the shot camera with its tool, or orbits to another view and brings the camera there.
fn move_the_shot(editor: &mut Editor, by_tool: bool) {
    let at = middle_of_the_apple(editor);
    if by_tool {
        let view = view(editor);
        editor.take_up(Tool::ShotCamera, &view);
        drag(editor, Button::Left, [at, at + DVec2::new(80.0, 0.0)], HERE);
    } else {
        drag(editor, Button::Middle, [at, at + DVec2::new(80.0, 0.0)], HERE);
        act(editor, Action::CameraFromView);
    }
}

#[test]
fn in_animate_the_shot_camera_is_keyed_at_this_frame_and_no_other_key_moves() {
    for by_tool in [true, false] {
        let (mut editor, _) = animating(60.0);
        let before = camera_keys(editor.document().scene());
        move_the_shot(&mut editor, by_tool);
        let [first, new, last] = camera_keys(editor.document().scene())[..] else { panic!("a key is added") };
        assert_eq!(vec![first, last], before);
        assert_eq!(new.0, 60.0);
        assert_eq!(editor.looking, Looking::Shot);
        // A second move changes the key that the first one made.
        move_the_shot(&mut editor, by_tool);
        let after = camera_keys(editor.document().scene());
        assert_eq!((after.len(), after[0], after[2]), (3, first, last));
        assert_ne!(after[1], new);
        // Without Auto key the pose waits until it is keyed.
        editor.session.auto_key = false;
        editor.session.frame = 30.0;
        move_the_shot(&mut editor, by_tool);
        assert_eq!(camera_keys(editor.document().scene()), after);
        assert!(editor.time().is_loose("shot"));
    }
}

#[test]
fn in_arrange_the_shot_camera_moves_with_all_its_keys() {
    for by_tool in [true, false] {
        let (mut editor, _) = animating(60.0);
        act(&mut editor, Action::Arrange);
        editor.session.frame = 60.0;
        let before = camera_keys(editor.document().scene());
        move_the_shot(&mut editor, by_tool);
        let after = camera_keys(editor.document().scene());
        assert_eq!(after.len(), before.len());
        assert!(before.iter().zip(&after).all(|(before, after)| before.0 == after.0 && before.1 != after.1));
    }
}

/// Plays for `secs` seconds with pictures that come at once; returns the frames that were shown.
fn play_on(editor: &mut Editor, from: f64, secs: f64) -> Vec<f64> {
    let mut shown = Vec::new();
    for step in 1..=(secs * 100.0) as u32 {
        editor.tick(from + f64::from(step) * 0.01);
        let frame = editor.frame_to_draw();
        if editor.shown_frame(frame) {
            shown.push(editor.session.frame);
        }
    }
    shown
}

#[test]
fn space_plays_whole_frames_and_any_edit_ends_it() {
    let (mut editor, _) = animating(116.0);
    key(&mut editor, Key::Space);
    assert_eq!(editor.status(), "Playing 0\u{2013}119, 24 fps, 0 frames dropped   [Space] stop");
    let shown = play_on(&mut editor, 0.0, 0.3);
    assert_eq!(shown, [117.0, 118.0, 119.0, 0.0, 1.0, 2.0, 3.0]);
    assert!(editor.run(&Command::Time(Time::SetFps(12.0))));
    assert!(!editor.time().playback.is_playing());
    key(&mut editor, Key::Space);
    assert!(editor.time().playback.is_playing());
    key(&mut editor, Key::Space);
    assert!(!editor.time().playback.is_playing());
    // A step moves the playhead, which stops playback.
    key(&mut editor, Key::Space);
    act(&mut editor, Action::StepOn);
    editor.tick(1.0);
    assert!(!editor.time().playback.is_playing());
    editor.session.pacing = Pacing::EveryFrame;
    key(&mut editor, Key::Space);
    assert!(editor.status().starts_with("Playing 0\u{2013}119, every frame, "), "{}", editor.status());
    act(&mut editor, Action::Undo);
    assert!(!editor.time().playback.is_playing());
    key(&mut editor, Key::Space);
    assert!(editor.time().playback.is_playing());
    editor.stop_playing();
    assert!(!editor.time().playback.is_playing());
}

#[test]
fn a_scrub_pauses_and_playback_goes_on_from_there() {
    let (mut editor, _) = animating(0.0);
    for plays in [false, true] {
        if plays {
            key(&mut editor, Key::Space);
            play_on(&mut editor, 0.0, 0.5);
        }
        editor.timeline(TimelineEvent::Scrub(40.0));
        editor.tick(1.0);
        assert!(!editor.time().playback.is_playing());
        editor.timeline(TimelineEvent::Scrub(50.0));
        editor.timeline(TimelineEvent::EndScrub);
        assert_eq!((editor.time().playback.is_playing(), editor.session.frame), (plays, 50.0));
    }
    assert_eq!(play_on(&mut editor, 1.0, 0.1), [51.0, 52.0]);
}

fn press(editor: &mut Editor, key: KeyAt) {
    let at = LanePosition { x_px: key.1 * 4.0, y_px: 48.0, frame: key.1, lane: 1 };
    editor.timeline(TimelineEvent::Keys(KeysEvent::Press { at, key: Some(key), adds: false }));
}

fn drag_key(editor: &mut Editor, key: KeyAt, to: f64) {
    press(editor, key);
    let at = LanePosition { x_px: to * 4.0, y_px: 48.0, frame: to, lane: 1 };
    editor.timeline(TimelineEvent::Keys(KeysEvent::Move(at)));
    editor.timeline(TimelineEvent::Keys(KeysEvent::Release));
}

#[test]
fn keys_are_dragged_copied_nudged_and_deleted_and_each_is_one_entry() {
    let (mut editor, name) = animating(60.0);
    move_by_half(&mut editor);
    let of = || KeyOf::Object(name.clone());
    let count = editor.document().undo_count();
    drag_key(&mut editor, (of(), 60.0), 73.0);
    assert_eq!(frames(editor.document().scene()), [0.0, 73.0]);
    assert_eq!(editor.document().undo_text(), Some("Move 1 key"));
    assert_eq!(editor.time().keys.selected(), [(of(), 73.0)], "the key stays selected at its new frame");
    // Shift D, a move and a press copy a key.
    let view = view(&editor);
    assert!(editor.key(Key::Letter('D'), Modifiers { shift: true, ..HERE }, false, &view));
    for frame in [73.0, 83.0] {
        let at = LanePosition { x_px: frame * 4.0, y_px: 48.0, frame, lane: 1 };
        editor.timeline(TimelineEvent::Keys(KeysEvent::Move(at)));
    }
    assert!(editor.status().starts_with("Copy 1 key by +10"), "{}", editor.status());
    press(&mut editor, (of(), 0.0));
    assert_eq!(frames(editor.document().scene()), [0.0, 73.0, 83.0]);
    assert_eq!(editor.document().undo_text(), Some("Copy 1 key"));
    // Arrows nudge while a key is selected in a lane; all nudges are one entry.
    editor.tick(10.0);
    for _ in 0..3 {
        key(&mut editor, Key::Right);
    }
    assert_eq!(frames(editor.document().scene()), [0.0, 73.0, 86.0]);
    assert_eq!((editor.session.frame, editor.document().undo_count()), (60.0, count + 3));
    key(&mut editor, Key::Delete);
    assert_eq!(frames(editor.document().scene()), [0.0, 73.0]);
    assert_eq!(editor.document().scene().objects.len(), 2, "the key is deleted, not the apple");
    assert_eq!(editor.time().keys.selected(), []);
    // With nothing selected the arrows step through frames.
    key(&mut editor, Key::Right);
    assert_eq!(editor.session.frame, 61.0);
}

#[test]
fn keys_of_what_is_locked_stay_and_stay_selected() {
    let (mut editor, name) = animating(60.0);
    move_by_half(&mut editor);
    assert!(editor.run(&Command::Edit(Edit::SetLocked(vec![Item::Object(name.clone())], true))));
    editor.take_said();
    drag_key(&mut editor, (KeyOf::Object(name.clone()), 60.0), 73.0);
    assert_eq!(frames(editor.document().scene()), [0.0, 60.0]);
    assert_eq!(words(&mut editor), [format!("{name} is locked")]);
    assert_eq!(editor.time().keys.selected(), [(KeyOf::Object(name), 60.0)]);
}

#[test]
fn a_copy_that_lands_on_a_key_takes_its_place() {
    let (mut editor, name) = animating(60.0);
    move_by_half(&mut editor);
    let of = || KeyOf::Object(name.clone());
    let third = Pose::Object(name.clone(), ObjectKey { translation: [3.0; 3], ..ObjectKey::at(0.0) });
    assert!(editor.run(&Command::Time(Time::PoseAtFrame(third, 90.0))));
    assert!(editor.run(&Command::Time(Time::SetEase(vec![(of(), 0.0)], Ease::Step))));
    let first = editor.document().scene().objects[0].keys[0].clone();
    let second = editor.document().scene().objects[0].keys[1].clone();
    // The copy of the first key lands on the second one, which is copied too.
    assert!(editor.run(&Command::Time(Time::CopyKeys(vec![(of(), 0.0), (of(), 60.0)], 60.0))));
    let keys = &editor.document().scene().objects[0].keys;
    assert_eq!(frames(editor.document().scene()), [0.0, 60.0, 90.0, 120.0]);
    assert_eq!(keys[1], ObjectKey { frame: 60.0, ..first });
    assert_eq!(keys[3], ObjectKey { frame: 120.0, ..second });
}

#[test]
fn undo_brings_back_a_pose_that_was_left_and_drops_one_that_shows() {
    let (mut editor, name) = animating(60.0);
    editor.session.auto_key = false;
    let (before, count) = (editor.document().scene().clone(), editor.document().undo_count());
    move_by_half(&mut editor);
    act(&mut editor, Action::StepOn);
    editor.tick(1.0);
    assert!(!editor.time().is_loose(&name));
    act(&mut editor, Action::Undo);
    assert!(editor.time().is_loose(&name), "the pose is back");
    assert_eq!((editor.session.frame, editor.document().undo_count()), (60.0, count));
    act(&mut editor, Action::Undo);
    assert!(!editor.time().is_loose(&name), "the pose is undone");
    assert_eq!((editor.document().undo_count(), &editor.shown().0.scene), (count, &before));
    act(&mut editor, Action::Undo);
    assert_eq!(editor.document().undo_count(), count - 1, "the next undo takes the entry before");
}

#[test]
fn both_camera_tools_key_this_frame_alone() {
    for by_view in [false, true] {
        let (mut editor, _) = animating(30.0);
        let camera = |editor: &Editor| editor.document().scene().camera.keys.clone();
        let before = camera(&editor);
        if by_view {
            drag(&mut editor, Button::Middle, [DVec2::new(300.0, 200.0), DVec2::new(360.0, 230.0)], HERE);
            act(&mut editor, Action::CameraFromView);
        } else {
            editor.session.set_tool(Tool::ShotCamera);
            drag(&mut editor, Button::Left, [DVec2::new(300.0, 200.0), DVec2::new(360.0, 230.0)], HERE);
        }
        let after = camera(&editor);
        let at_30 = |keys: &[impasto_scene::document::CameraKey]| keys.iter().any(|key| key.frame == 30.0);
        assert!(!at_30(&before) && at_30(&after), "by view: {by_view}");
        for key in &before {
            assert!(after.contains(key), "another key was moved");
        }
    }
}

#[test]
fn a_click_with_the_shot_camera_sets_no_key() {
    for auto_key in [true, false] {
        let (mut editor, _) = animating(30.0);
        editor.session.auto_key = auto_key;
        editor.session.set_tool(Tool::ShotCamera);
        let before = (camera_keys(editor.document().scene()), editor.document().undo_count());
        drag(&mut editor, Button::Left, [DVec2::new(300.0, 200.0); 2], HERE);
        let after = (camera_keys(editor.document().scene()), editor.document().undo_count());
        assert_eq!(after, before);
        assert!(!editor.time().is_loose("shot"));
    }
}
