//! Tests of the timeline's lanes: the names of its controls, the pointer on keys, and how it looks.

use egui::accesskit::Role;
use egui::{Key, Pos2, pos2, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use egui_kittest::{Harness, SnapshotResults};
use impasto_editor::panels::Ask;
use impasto_editor::theme::Theme;
use impasto_editor_model::command::{KeyOf, Pose, Time};
use impasto_editor_model::keymap::Action;
use impasto_editor_model::playback::{Course, Pacing};
use impasto_editor_model::session::Mode;
use impasto_editor_model::timeline::{KeyAt, KeysEvent, lanes};
use impasto_editor_model::{Command, Item, Selection};
use impasto_scene::document::{Ease, ObjectKey};

use super::page::{self, Page};
use super::{acts, click, harness, snapshot};

/// High enough for the rail of tools above the lanes.
const NARROW: (f32, f32) = (1280.0, 620.0);
const WIDE: (f32, f32) = (1920.0, 620.0);

pub(super) fn apple(frame: f64) -> KeyAt {
    (KeyOf::Object("apple".to_owned()), frame)
}

/// A page in the mode Animate, with an apple that has keys at frames 0, 37, 60 and 96.
pub(super) fn animated() -> Page {
    let mut page = Page { document: page::apple(), ..Page::new() }.in_mode(Mode::Animate);
    let mut apply = |time: Time| drop(page.document.apply(&Command::Time(time)).expect("it can be done"));
    apply(Time::SetRange(0, 119));
    for frame in [0.0, 37.0, 60.0, 96.0] {
        let pose = ObjectKey { translation: [frame * 0.01, 0.0, 0.0], ..ObjectKey::at(frame) };
        apply(Time::PoseAtFrame(Pose::Object("apple".to_owned(), pose), frame));
    }
    apply(Time::SetEase(vec![apple(0.0), apple(37.0)], Ease::Smooth));
    apply(Time::SetEase(vec![apple(60.0)], Ease::Linear));
    apply(Time::SetEase(vec![apple(96.0)], Ease::Step));
    page.document.select(Selection::only(Item::Object("apple".to_owned())));
    page.session.frame = 37.0;
    page
}

fn lanes_of(page: Page) -> Harness<'static, Page> {
    harness(page, Theme::Dark, NARROW)
}

/// The keys in the apple's lane: the name and the place in the window of each.
fn keys(harness: &Harness<'_, Page>) -> Vec<(String, Pos2)> {
    let list = harness.get_by_role_and_label(Role::List, "apple keys");
    let items = list.query_all_by_role(Role::ListItem);
    let mut keys: Vec<_> =
        items.map(|node| (node.accesskit_node().label().unwrap_or_default(), node.rect().center())).collect();
    keys.sort_by(|a, b| a.1.x.total_cmp(&b.1.x));
    keys
}

fn commands(page: &Page) -> Vec<&Time> {
    let asked = page.asked.iter();
    asked
        .map(|ask| match ask {
            Ask::Do(Command::Time(time)) => time,
            other => panic!("{other:?}"),
        })
        .collect()
}

pub(super) fn drag(harness: &mut Harness<'_, Page>, from: Pos2, to: Pos2) {
    harness.drag_at(from);
    harness.run();
    for part in [0.3, 0.7, 1.0] {
        harness.hover_at(from.lerp(to, part));
        harness.run();
    }
    harness.drop_at(to);
    harness.run();
}

#[test]
fn every_control_of_the_timeline_has_its_name() {
    let mut harness = lanes_of(animated());
    for name in [
        "First frame",
        "Previous frame",
        "Play",
        "Next frame",
        "Last frame",
        "Current frame",
        "Auto key",
        "Set key",
        "Curves",
        "Pacing",
        "Range start",
        "Range end",
        "Frames per second",
        "Loop",
        "Hide keys",
        "Ruler",
        "Lock to view",
        "shot keys",
        "apple keys",
        "Select apple",
    ] {
        let sizes: Vec<_> = harness.get_all_by_label(name).map(|node| node.rect().size()).collect();
        assert_eq!(sizes.len(), 1, "{name}");
        assert!(sizes[0].x >= 24.0 && sizes[0].y >= 24.0, "{name} is {} points", sizes[0]);
    }
    let names: Vec<String> = keys(&harness).into_iter().map(|(name, _)| name).collect();
    assert_eq!(
        names,
        [
            "key at frame 0, smooth",
            "key at frame 37, smooth",
            "key at frame 60, linear",
            "key at frame 96, hold"
        ]
    );
    click(&mut harness, "Auto key");
    click(&mut harness, "Lock to view");
    assert!(!harness.state().session.auto_key && harness.state().session.lock_to_view);
    click(&mut harness, "Set key");
    assert_eq!(acts(harness.state()), [Action::SetKey]);
    let name = harness.get_by_label("Select apple").rect().center();
    right_click(&mut harness, name);
    assert!(
        matches!(harness.state().asked.last(), Some(Ask::Menu(Some(Item::Object(name)))) if name == "apple")
    );
    click(&mut harness, "Select shot");
    assert!(
        matches!(harness.state().asked.last(), Some(Ask::Select(selection)) if selection.active() == Some(&Item::Camera))
    );
    click(&mut harness, "Hide keys");
    assert!(harness.query_by_label("apple keys").is_none());
    click(&mut harness, "Show keys");
    assert!(harness.query_by_label("apple keys").is_some());
    // Each mode remembers for itself whether the lanes show. In Arrange they are hidden at first.
    harness.state_mut().session.mode = Mode::Arrange;
    harness.run();
    assert!(harness.query_by_label("apple keys").is_none());
}

#[test]
fn keys_are_dragged_by_the_pointer_and_snap_to_frames() {
    let mut harness = lanes_of(animated());
    let places = keys(&harness);
    let per_frame = (places[3].1.x - places[0].1.x) / 96.0;
    let from = places[2].1;
    // The drag begins a little beside the key and ends between two frames.
    drag(&mut harness, from + vec2(3.0, 4.0), from + vec2(3.0 + 13.3 * per_frame, -20.0));
    assert_eq!(commands(harness.state()), [&Time::MoveKeys(vec![apple(60.0)], 13.0)]);
    assert_eq!(harness.state().time.keys.selected(), [apple(60.0)]);
    // A press that moves by one point is a click: it selects the key and does not drag it.
    harness.state_mut().asked.clear();
    drag(&mut harness, places[1].1, places[1].1 + vec2(1.0, 0.0));
    assert_eq!((harness.state().asked.len(), harness.state().time.keys.selected()), (0, &[apple(37.0)][..]));
    // A drag that begins between keys draws a box; this one covers the last two keys.
    drag(&mut harness, places[2].1 - vec2(30.0, 10.0), places[3].1 + vec2(14.0, 10.0));
    assert_eq!(harness.state().time.keys.selected(), [apple(60.0), apple(96.0)]);
    assert_eq!(harness.state().asked.len(), 0);
}

#[test]
fn a_click_between_keys_changes_the_ease_and_a_right_click_lists_them() {
    let mut harness = lanes_of(animated());
    let places = keys(&harness);
    let between = places[1].1.lerp(places[2].1, 0.5);
    harness.drag_at(between);
    harness.run();
    harness.drop_at(between);
    harness.run();
    assert_eq!(commands(harness.state()), [&Time::SetEase(vec![apple(37.0)], Ease::Linear)]);
    harness.state_mut().asked.clear();
    right_click(&mut harness, between);
    assert!(harness.query_by_label("Delete key").is_none(), "no key is there");
    click(&mut harness, "Ease hold");
    assert_eq!(commands(harness.state()), [&Time::SetEase(vec![apple(37.0)], Ease::Step)]);
    for (name, ease) in [
        ("Ease in", Ease::In),
        ("Ease out", Ease::Out),
        ("Ease bounce", Ease::Bounce),
        ("Ease curve", Ease::USUAL_CURVE),
    ] {
        harness.state_mut().asked.clear();
        right_click(&mut harness, between);
        click(&mut harness, name);
        assert_eq!(commands(harness.state()), [&Time::SetEase(vec![apple(37.0)], ease)]);
    }
    harness.state_mut().asked.clear();
    right_click(&mut harness, places[3].1);
    click(&mut harness, "Delete key");
    assert_eq!(commands(harness.state()), [&Time::DeleteKeys(vec![apple(96.0)])]);
}

pub(super) fn right_click(harness: &mut Harness<'_, Page>, at: Pos2) {
    harness.event(egui::Event::PointerMoved(at));
    for pressed in [true, false] {
        let button = egui::PointerButton::Secondary;
        harness.event(egui::Event::PointerButton { pos: at, button, pressed, modifiers: Default::default() });
    }
    harness.run();
}

#[test]
fn keys_are_copied_and_pasted_at_another_frame_from_the_menu() {
    let mut harness = lanes_of(animated());
    let places = keys(&harness);
    let per_frame = (places[3].1.x - places[0].1.x) / 96.0;
    right_click(&mut harness, places[1].1);
    assert_eq!(harness.state().time.keys.selected(), [apple(37.0)], "the clicked key is selected");
    click(&mut harness, "Copy key");
    assert!(harness.query_by_label("Copy key").is_none(), "the menu closes");
    let at = places[0].1 + vec2(80.0 * per_frame, 2.0);
    right_click(&mut harness, at);
    click(&mut harness, "Paste key at 80");
    assert_eq!(commands(harness.state()), [&Time::CopyKeys(vec![apple(37.0)], 43.0)]);
    harness.state_mut().asked.clear();
    right_click(&mut harness, at);
    click(&mut harness, "Key apple at 80");
    assert_eq!(commands(harness.state()), [&Time::SetKey(apple(0.0).0, 80.0)]);
    right_click(&mut harness, at);
    click(&mut harness, "Go to frame 80");
    assert_eq!(harness.state().session.frame, 80.0);
}

#[test]
fn a_click_beside_the_menu_of_the_lanes_only_closes_it() {
    let mut harness = lanes_of(animated());
    let places = keys(&harness);
    right_click(&mut harness, places[1].1);
    assert!(harness.query_by_label("Delete key").is_some());
    // Between two keys, where a click would change the ease.
    let between = places[2].1.lerp(places[3].1, 0.8);
    harness.drag_at(between);
    harness.run();
    harness.drop_at(between);
    harness.run();
    assert!(harness.query_by_label("Delete key").is_none());
    assert_eq!(harness.state().asked.len(), 0, "{:?}", harness.state().asked);
    assert_eq!(harness.state().time.keys.selected(), [apple(37.0)]);
    right_click(&mut harness, places[1].1);
    harness.key_press(Key::Escape);
    harness.run();
    assert!(harness.query_by_label("Delete key").is_none(), "Esc closes it too");
}

#[test]
fn a_frame_is_typed_as_a_number_or_as_a_time() {
    let mut harness = lanes_of(animated());
    for (typed, frame) in [("1.5 s", 36.0), ("\u{2212}4", -4.0), ("ten", -4.0)] {
        harness.get_by_label("Current frame").focus();
        harness.run();
        harness.key_press(Key::Enter);
        harness.run();
        harness.event(egui::Event::Text(typed.to_owned()));
        harness.run();
        harness.key_press(Key::Enter);
        harness.run();
        assert_eq!(harness.state().session.frame, frame, "{typed}");
    }
}

#[test]
fn the_ruler_of_the_lanes_scrubs_and_its_ends_are_the_range() {
    let mut harness = lanes_of(animated());
    let places = keys(&harness);
    let ruler = harness.get_by_label("Ruler").rect();
    harness.drag_at(pos2(places[2].1.x, ruler.top() + 6.0));
    harness.run();
    assert_eq!(harness.state().session.frame, 60.0);
    harness.drop_at(pos2(places[2].1.x, ruler.top() + 6.0));
    harness.run();
    let per_frame = (places[3].1.x - places[0].1.x) / 96.0;
    let last = places[0].1.x + 119.0 * per_frame;
    let grip = pos2(last + 8.0, ruler.bottom() - 8.0);
    drag(&mut harness, grip, grip - vec2(19.0 * per_frame, 0.0));
    let range = harness.state().asked.iter().rev().find_map(|ask| match ask {
        Ask::Preview(Command::Time(Time::SetRange(first, last))) => Some((*first, *last)),
        _ => None,
    });
    assert_eq!(range, Some((0, 100)));
    assert_eq!(harness.state().session.frame, 60.0, "a grip does not scrub");
}

/// Plays the page so that frames are dropped in a few places.
fn dropped(page: &mut Page) {
    let course = Course { first: 0, last: 119, fps: 24.0, looped: true, pacing: Pacing::RealTime };
    let playback = &mut page.time.playback;
    playback.play(0.0, course, 0.0);
    let mut now = 0.0;
    for frame in [1.0, 2.0, 18.0, 19.0, 21.0, 30.0] {
        now = (frame + 0.5) / 24.0;
        playback.tick(course, now);
        playback.shown(frame, now);
    }
    playback.tick(course, now);
}

#[test]
fn what_plays_is_paused_and_says_what_it_dropped() {
    let mut page = animated();
    dropped(&mut page);
    let count = page.time.playback.dropped();
    assert!(count > 20);
    let mut harness = lanes_of(page);
    let words = harness.get_by_label("Dropped frames").accesskit_node().value();
    assert_eq!(words, Some(format!("{count} dropped")));
    assert!(harness.query_by_label("Play").is_none());
    click(&mut harness, "Pause");
    assert_eq!(acts(harness.state()), [Action::Play]);
}

#[test]
fn the_lanes_look_as_they_did() {
    let mut results = SnapshotResults::new();
    let mut page = animated();
    dropped(&mut page);
    page.time.playback.stop();
    let of = lanes(page.document.scene());
    page.time.keys.take(KeysEvent::Select(apple(37.0)), &of);
    snapshot(&mut results, &mut lanes_of(page), "timeline_dark");
    // A key is dragged onto another, which it would replace.
    let mut harness = harness(animated(), Theme::Light, WIDE);
    let places = keys(&harness);
    harness.drag_at(places[1].1);
    harness.run();
    harness.hover_at(places[1].1.lerp(places[2].1, 0.5));
    harness.run();
    harness.hover_at(places[2].1);
    snapshot(&mut results, &mut harness, "timeline_drag_light_wide");
}
