//! Tests of the timeline's curves: which lane they show, their handles, and how they look.

use egui::accesskit::Role;
use egui::{Key, Pos2, pos2, vec2};
use egui_kittest::kittest::Queryable as _;
use egui_kittest::{Harness, SnapshotResults};
use impasto_editor::theme::Theme;
use impasto_editor::widgets::leaves_space;
use impasto_editor_model::command::{Command, Time};
use impasto_editor_model::{Item, Selection};
use impasto_scene::document::Ease;

use super::page::Page;
use super::timeline::{animated, apple, drag, right_click};
use super::{click, harness, snapshot};

const SIZE: (f32, f32) = (1280.0, 620.0);

/// A page that shows curves and carries out what they ask of its document.
fn curved() -> Page {
    let mut page = Page { applies: true, ..animated() };
    page.session.toggle_curves();
    page
}

fn curves_of(page: Page) -> Harness<'static, Page> {
    harness(page, Theme::Dark, SIZE)
}

/// The ease of the apple's key, as it is stored and as it shows.
fn eases(page: &Page, frame: f64) -> [Ease; 2] {
    [page.document.scene(), &page.document.shown().scene].map(|scene| {
        let object = scene.objects.iter().find(|object| object.name == "apple").expect("the apple");
        object.keys.iter().find(|key| key.frame == frame).expect("the key").ease
    })
}

fn place(harness: &Harness<'_, Page>, name: &str) -> Pos2 {
    harness.get_by_role_and_label(Role::Slider, name).rect().center()
}

/// Where the keys are drawn.
fn keys(harness: &Harness<'_, Page>) -> Vec<Pos2> {
    let list = harness.get_by_role_and_label(Role::List, "apple curves");
    let mut places: Vec<_> =
        list.query_all_by_role(Role::ListItem).map(|node| node.rect().center()).collect();
    places.sort_by(|a, b| a.x.total_cmp(&b.x));
    places
}

#[test]
fn the_curves_of_the_selected_lane_take_the_place_of_the_lanes() {
    let mut harness = curves_of(animated());
    assert!(harness.query_by_label("apple curves").is_none());
    click(&mut harness, "Curves");
    assert!(harness.state().session.shows_curves());
    assert!(
        harness.query_by_label("apple curves").is_some() && harness.query_by_label("apple keys").is_none()
    );
    assert_eq!(keys(&harness).len(), 4);
    // A lane with two keys or more has handles. When another item is selected, the curves of its lane show.
    assert!(harness.query_by_role_and_label(Role::Slider, "First handle").is_some());
    harness.state_mut().document.select(Selection::only(Item::Camera));
    harness.run();
    assert!(
        harness.query_by_label("shot curves").is_some() && harness.query_by_label("apple curves").is_none()
    );
    harness.state_mut().session.toggle_curves();
    harness.run();
    assert!(harness.query_by_label("apple keys").is_some());
}

#[test]
fn a_handle_is_dragged_shown_at_once_and_kept_as_one_entry() {
    let mut harness = curves_of(curved());
    let before = harness.state().document.scene().clone();
    let count = harness.state().document.undo_count();
    let [left, right] = [keys(&harness)[1], keys(&harness)[2]];
    let from = place(&harness, "First handle");
    // The first handle of `Smooth` is level with its key, a third of the way to the next one.
    assert!((from.x - (left.x + (right.x - left.x) / 3.0)).abs() < 0.6 && (from.y - left.y).abs() < 0.6);
    let to = pos2(left.x + (right.x - left.x) * 0.8, left.y + 12.0);
    harness.drag_at(from);
    harness.run();
    harness.hover_at(from.lerp(to, 0.5));
    harness.run();
    harness.hover_at(to);
    harness.run();
    let [stored, shown] = eases(harness.state(), 37.0);
    assert!(stored == Ease::Smooth && matches!(shown, Ease::Curve(..)), "{shown:?}");
    harness.drop_at(to);
    harness.run();
    let [stored, shown] = eases(harness.state(), 37.0);
    assert_eq!(stored, shown);
    let Ease::Curve(first, second) = stored else { panic!("{stored:?}") };
    assert!((first[0] - 0.8).abs() < 0.01 && first[1] < -0.05, "{first:?}");
    assert_eq!(second, [0.667, 1.0]);
    assert_eq!(harness.state().document.undo_count(), count + 1);
    harness.state_mut().document.undo();
    assert_eq!(*harness.state().document.scene(), before);
    // The second handle, dragged far out, stops at the greatest time (1) and the greatest value (3) allowed.
    harness.run();
    let from = place(&harness, "Second handle");
    drag(&mut harness, from, pos2(right.x + 200.0, 0.0));
    let [Ease::Curve(_, second), _] = eases(harness.state(), 37.0) else { panic!("no curve") };
    assert_eq!(second, [1.0, 3.0]);
}

#[test]
fn escape_takes_a_drag_back() {
    let mut harness = curves_of(curved());
    let before = harness.state().document.scene().clone();
    let count = harness.state().document.undo_count();
    let from = place(&harness, "First handle");
    harness.drag_at(from);
    harness.run();
    harness.hover_at(from + vec2(30.0, -20.0));
    harness.run();
    assert!(matches!(eases(harness.state(), 37.0)[1], Ease::Curve(..)));
    harness.key_press(Key::Escape);
    harness.step();
    // While the handle has the focus, Esc goes to the handle. Otherwise the window would consume Esc.
    assert!(harness.ctx.memory(|memory| memory.focused()).is_some(), "Esc took the focus from the handle");
    harness.run();
    assert_eq!(eases(harness.state(), 37.0), [Ease::Smooth; 2]);
    harness.hover_at(from + vec2(40.0, -30.0));
    harness.run();
    harness.drop_at(from + vec2(40.0, -30.0));
    harness.run();
    assert_eq!(*harness.state().document.scene(), before);
    assert_eq!(harness.state().document.undo_count(), count);
    assert_eq!(eases(harness.state(), 37.0)[1], Ease::Smooth);
}

#[test]
fn arrows_move_a_handle_that_was_clicked_or_dragged() {
    let mut harness = curves_of(curved());
    for drag_px in [0.0, 30.0] {
        let from = place(&harness, "First handle");
        drag(&mut harness, from, from + vec2(drag_px, 0.0));
        let before = place(&harness, "First handle");
        harness.key_press(Key::ArrowUp);
        harness.run();
        let after = place(&harness, "First handle");
        assert!(after.y < before.y - 0.2 && (after.x - before.x).abs() < 0.5, "{before} to {after}");
        assert!(leaves_space(&harness.ctx), "Space would not play");
    }
    // A click elsewhere gives up the focus.
    click(&mut harness, "Curves");
    assert!(harness.ctx.memory(|memory| memory.focused()).is_none() && !leaves_space(&harness.ctx));
}

#[test]
fn curves_that_go_while_a_handle_is_dragged_take_the_drag_back() {
    let mut harness = curves_of(curved());
    let count = harness.state().document.undo_count();
    let from = place(&harness, "First handle");
    harness.drag_at(from);
    harness.run();
    harness.hover_at(from + vec2(30.0, -20.0));
    harness.run();
    assert!(matches!(eases(harness.state(), 37.0)[1], Ease::Curve(..)));
    harness.state_mut().session.toggle_curves();
    harness.run();
    assert_eq!(eases(harness.state(), 37.0), [Ease::Smooth; 2], "the preview stays");
    harness.drop_at(from + vec2(30.0, -20.0));
    harness.state_mut().session.toggle_curves();
    harness.run();
    assert_eq!(eases(harness.state(), 37.0), [Ease::Smooth; 2]);
    assert_eq!(harness.state().document.undo_count(), count);
}

#[test]
fn a_long_press_changes_nothing_and_a_right_click_on_a_handle_lists_the_eases() {
    let mut harness = curves_of(curved());
    let count = harness.state().document.undo_count();
    let at = place(&harness, "First handle");
    harness.drag_at(at);
    // Longer than a click may last, so that egui begins a drag.
    harness.run_steps(120);
    harness.drop_at(at);
    harness.run();
    assert_eq!(eases(harness.state(), 37.0), [Ease::Smooth; 2]);
    assert_eq!(harness.state().document.undo_count(), count);
    right_click(&mut harness, at);
    click(&mut harness, "Ease bounce");
    assert_eq!(eases(harness.state(), 37.0)[0], Ease::Bounce);
}

#[test]
fn a_double_click_straightens_and_arrows_step() {
    let mut harness = curves_of(curved());
    harness.ctx.options_mut(|options| options.input_options.max_double_click_delay = 2.0);
    let double_click = |harness: &mut Harness<'_, Page>, name: &str| {
        // Waits, so that these clicks and earlier ones do not make a triple click.
        harness.run_steps(20);
        let at = place(harness, name);
        for _ in 0..2 {
            harness.drag_at(at);
            harness.step();
            harness.drop_at(at);
            harness.step();
        }
        harness.run();
    };
    double_click(&mut harness, "First handle");
    assert_eq!(eases(harness.state(), 37.0)[0], Ease::Curve([0.333, 0.333], [0.667, 1.0]));
    double_click(&mut harness, "Second handle");
    assert_eq!(eases(harness.state(), 37.0)[0], Ease::Linear);
    harness.get_by_role_and_label(Role::Slider, "First handle").focus();
    harness.run();
    harness.key_press(Key::ArrowUp);
    harness.run();
    harness.key_press(Key::ArrowLeft);
    harness.run();
    assert_eq!(eases(harness.state(), 37.0)[0], Ease::Curve([0.323, 0.343], [0.667, 0.667]));
}

#[test]
fn a_click_chooses_a_segment_and_a_right_click_lists_the_eases() {
    let mut harness = curves_of(curved());
    let places = keys(&harness);
    let middle = |index: usize| pos2(0.5 * (places[index].x + places[index + 1].x), places[0].y - 40.0);
    let is_between = |harness: &Harness<'_, Page>, index: usize| {
        let x = place(harness, "First handle").x;
        places[index].x < x && x < places[index + 1].x
    };
    assert!(is_between(&harness, 1), "the segment of the frame that is shown");
    harness.drag_at(middle(2));
    harness.run();
    harness.drop_at(middle(2));
    harness.run();
    assert!(is_between(&harness, 2));
    right_click(&mut harness, middle(0));
    click(&mut harness, "Ease out");
    assert!(is_between(&harness, 0));
    assert_eq!(eases(harness.state(), 0.0)[0], Ease::Out);
    harness.state_mut().document.undo();
    assert_eq!(eases(harness.state(), 0.0)[0], Ease::Smooth);
}

#[test]
fn the_curves_look_as_they_did() {
    let mut results = SnapshotResults::new();
    let page = || {
        let mut page = curved();
        let mut set = |frame: f64, ease: Ease| {
            drop(page.document.apply(&Command::Time(Time::SetEase(vec![apple(frame)], ease))).expect("set"));
        };
        set(0.0, Ease::Out);
        set(37.0, Ease::Curve([0.2, -0.3], [0.4, 1.2]));
        set(60.0, Ease::Bounce);
        page.session.frame = 45.0;
        page
    };
    snapshot(&mut results, &mut harness(page(), Theme::Dark, SIZE), "curves_dark");
    let mut light = harness(page(), Theme::Light, SIZE);
    let at = pos2(keys(&light)[2].x + 40.0, keys(&light)[2].y - 40.0);
    right_click(&mut light, at);
    snapshot(&mut results, &mut light, "curves_menu_light");
}
