//! Tests of the tool that lays strokes by hand.

use impasto_scene::document::{Amount, Color, Touch};

use super::*;

const LEFT: [f64; 2] = [270.0, 200.0];
const MIDDLE: [f64; 2] = [320.0, 160.0];
const RIGHT: [f64; 2] = [370.0, 200.0];
const ASIDE: [f64; 2] = [320.0, 250.0];
const OFF: [f64; 2] = [4.0, 4.0];

fn touches(world: &World) -> &[Touch] {
    &world.document.scene().touches
}

#[test]
fn a_click_places_one_stroke_and_a_drag_a_long_one() {
    let mut world = World::new();
    let aimed = world.hover(Tool::Touch, LEFT);
    assert!(
        aimed.status.starts_with("[Click] one stroke  [Drag] a long one  [Shift] erase"),
        "{}",
        aimed.status
    );
    world.drag(Tool::Touch, &[LEFT], NONE);
    assert_eq!((world.document.undo_count(), world.document.undo_text()), (1, Some("Lay touch")));
    assert_eq!(world.document.selection().active(), Some(&Item::Touch("touch".to_owned())));
    let [one] = touches(&world) else { panic!() };
    assert_eq!((one.on.as_str(), one.points.len()), ("ball", 1));
    // The stroke is as wide as the ring. Its width counts in pixels of the picture, which is as large as the view here.
    assert_eq!((one.width_px, one.length_px), (14.0, 48.0));

    let pressed = world.press(Tool::Touch, LEFT, NONE);
    assert!(pressed.preview.is_some() && pressed.status == "Laying a touch on ball   [Esc] take it back");
    world.drag_to(Tool::Touch, MIDDLE, NONE);
    world.drag_to(Tool::Touch, RIGHT, NONE);
    assert_eq!(world.document.shown().scene.touches.len(), 2, "shown while it is drawn");
    assert_eq!(touches(&world).len(), 1);
    world.release(Tool::Touch);
    assert_eq!(world.document.undo_text(), Some("Lay touch 2"));
    let [_, long] = touches(&world) else { panic!() };
    assert!((3..40).contains(&long.points.len()), "{}", long.points.len());
    for point in &long.points {
        let at = DVec3::from(point.at);
        assert!((at.length() - 1.0).abs() < 0.01 && at.normalize().dot(point.normal.into()) > 0.99);
    }
    let shown = |point: &[f64; 3]| world.view.project(DVec3::from(*point)).unwrap();
    assert!(shown(&long.points[0].at).distance(LEFT.into()) < 2.0);
    assert!(shown(&long.points[long.points.len() - 1].at).distance(RIGHT.into()) < 2.0);
    world.document.undo().unwrap();
    assert_eq!(touches(&world).len(), 1);
    world.document.redo().unwrap();
    assert_eq!(touches(&world).len(), 2);
}

#[test]
fn the_settings_of_the_tool_become_those_of_the_touch() {
    let mut world = World::new();
    let color = Color([0.2, 0.4, 0.6]);
    (world.options.touch_color, world.options.touch_opacity) = (color, 0.5);
    (world.options.touch_taper, world.options.touch_radius_px) = (0.75, 4.0);
    world.drag(Tool::Touch, &[LEFT, RIGHT], NONE);
    world.options.touch_from_picture = true;
    world.drag(Tool::Touch, &[LEFT], NONE);
    let [long, one] = touches(&world) else { panic!() };
    assert_eq!((long.width_px, long.color, long.opacity, long.taper), (8.0, Some(color), 0.5, 0.75));
    assert_eq!((one.color, one.length_px), (None, 27.0));
}

#[test]
fn its_width_has_keys_of_its_own() {
    let mut world = World::new();
    world.hover(Tool::Touch, LEFT);
    let output = world.take(Tool::Touch, ToolEvent::Key(Action::LargerRadius));
    let options = output.options.unwrap();
    assert_eq!(options.radius_px, 30.0, "the radius of the brushes stays");
    assert!((options.touch_radius_px - 7.7).abs() < 1e-9, "{}", options.touch_radius_px);
}

#[test]
fn shift_takes_touches_away_and_elsewhere_strokes() {
    let mut world = World::new();
    world.drag(Tool::Touch, &[LEFT, MIDDLE, RIGHT], NONE);
    world.drag(Tool::Touch, &[ASIDE], NONE);
    world.drag(Tool::Touch, &[[MIDDLE[0], MIDDLE[1] - 20.0], [MIDDLE[0], MIDDLE[1] + 20.0]], SHIFT);
    assert_eq!(world.document.undo_text(), Some("Erase touch"));
    let names: Vec<&str> = touches(&world).iter().map(|touch| touch.name.as_str()).collect();
    assert_eq!(names, ["touch 2"], "the one beside stays");
    world.document.undo().unwrap();
    assert_eq!(touches(&world).len(), 2);

    // Where no touch lies, the strokes themselves are thinned to nothing.
    world.drag(Tool::Touch, &[[300.0, 110.0], [340.0, 110.0]], SHIFT);
    assert_eq!(touches(&world).len(), 2);
    let amounts = &world.document.scene().regions[0].amounts;
    assert!(amounts.len() == 1 && amounts[0].of == Amount::Density);
    assert!(amounts[0].dabs.iter().all(|dab| dab.by == 0.0));
    // The dabs reach 1.5 times as far as the ring, whose radius is half of a touch's width.
    let reach = amounts[0].dabs[0].radius;
    world.drag(Tool::Touch, &[[300.0, 110.0], [340.0, 110.0]], NONE);
    let [from, .., to] = &*touches(&world)[2].points else { panic!("a long touch") };
    let px_per_unit = 40.0 / DVec3::from(from.at).distance(to.at.into());
    let reach_px = reach * px_per_unit;
    let ring_px = world.options.touch_radius_px;
    assert!((reach_px / (1.5 * ring_px) - 1.0).abs() < 0.05, "{reach_px} for a ring of {ring_px}");
    world.document.undo().unwrap();
    // The setting `touch_erases` swaps laying and erasing.
    world.options.touch_erases = true;
    world.drag(Tool::Touch, &[ASIDE], NONE);
    assert_eq!(touches(&world).len(), 1);
    world.drag(Tool::Touch, &[ASIDE], SHIFT);
    assert_eq!(touches(&world).len(), 2);
}

#[test]
fn ctrl_selects_a_touch_and_esc_leaves_none() {
    let mut world = World::new();
    world.drag(Tool::Touch, &[LEFT, MIDDLE, RIGHT], NONE);
    world.drag(Tool::Touch, &[ASIDE], NONE);
    let picked = world.press(Tool::Touch, MIDDLE, CTRL);
    assert_eq!(picked.select, Some(Item::Touch("touch".to_owned())));
    world.release(Tool::Touch);
    world.press(Tool::Touch, LEFT, NONE);
    world.drag_to(Tool::Touch, RIGHT, NONE);
    world.take(Tool::Touch, ToolEvent::Cancel);
    assert_eq!(touches(&world).len(), 2);
    assert!(world.press(Tool::Touch, OFF, NONE).refusal.is_some());
}

#[test]
fn touches_go_with_their_object_and_a_locked_one_keeps_them() {
    let mut world = World::new();
    world.drag(Tool::Touch, &[LEFT, RIGHT], NONE);
    let ball = || Item::Object("ball".to_owned());
    world.document.apply(&Command::Edit(Edit::Duplicate(vec![ball()]))).unwrap();
    let on = |world: &World| -> Vec<(String, String)> {
        touches(world).iter().map(|touch| (touch.name.clone(), touch.on.clone())).collect()
    };
    let both = [("touch", "ball"), ("touch 2", "ball 2")].map(|(a, b)| (a.to_owned(), b.to_owned()));
    assert_eq!(on(&world), both);
    world.document.apply(&Command::Edit(Edit::Rename(ball(), "globe".to_owned()))).unwrap();
    assert_eq!(on(&world)[0].1, "globe");
    let globe = Item::Object("globe".to_owned());
    world.document.apply(&Command::Edit(Edit::SetLocked(vec![globe.clone()], true))).unwrap();
    let touch = Item::Touch("touch".to_owned());
    assert!(world.document.apply(&Command::Edit(Edit::Delete(vec![touch]))).is_err());
    world.document.apply(&Command::Edit(Edit::SetLocked(vec![globe.clone()], false))).unwrap();
    world.document.apply(&Command::Edit(Edit::Delete(vec![globe]))).unwrap();
    assert_eq!(on(&world), both[1..]);
}
