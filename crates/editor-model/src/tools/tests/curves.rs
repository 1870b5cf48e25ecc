//! Tests of the guide curve tool.

use super::*;

const TOOL: Tool = Tool::GuideCurve;
const A: [f64; 2] = [260.0, 200.0];
const B: [f64; 2] = [320.0, 160.0];
const C: [f64; 2] = [380.0, 200.0];

fn key(world: &mut World, action: Action) -> ToolOutput {
    world.take(TOOL, ToolEvent::Key(action))
}

/// Where the points of the only guide show.
fn shown(world: &World) -> Vec<DVec2> {
    world.guides(0)[0].points.iter().map(|point| world.view.project(DVec3::from(point.at)).unwrap()).collect()
}

#[test]
fn clicks_and_enter_draw_a_curve_on_the_surface() {
    let mut world = World::new();
    assert_eq!(world.hover(TOOL, A).status, "[Click] add point  [Enter] finish  [Esc] drop it");
    for at in [A, B, C] {
        let [pressed, released] = world.click(TOOL, at, NONE);
        assert!(pressed.commit.is_none() && released.commit.is_none() && world.hand.is_busy());
    }
    let hovered = world.hover(TOOL, [390.0, 220.0]);
    assert!(hovered.preview.is_some() && hovered.handles_px.len() == 3 && hovered.line_px.len() > 10);
    assert!(key(&mut world, Action::Confirm).commit.is_some());
    assert_eq!((world.document.undo_count(), world.document.undo_text()), (1, Some("Draw guide")));
    assert_eq!(world.document.selection().active(), Some(&Item::Guide("skin".to_owned(), 0)));
    let line = shown(&world);
    for at in [A, B, C].map(DVec2::from) {
        let gap = line
            .windows(2)
            .map(|pair| crate::gizmo::off_px(at, pair[0], pair[1]))
            .fold(f64::INFINITY, f64::min);
        assert!(gap < 2.5, "{at}: {gap}");
    }
    for point in &world.guides(0)[0].points {
        assert!((DVec3::from(point.at).length() - 1.0).abs() < 0.01, "it lies on the ball");
    }
    assert!(!world.hand.is_busy());
}

#[test]
fn a_double_press_or_the_last_point_ends_it() {
    let mut world = World::new();
    world.click(TOOL, A, NONE);
    world.click(TOOL, B, NONE);
    world.press(TOOL, B, NONE);
    assert_eq!((world.document.undo_count(), world.hand.is_busy()), (1, false), "a double press ends it");
    let mut world = World::new();
    for at in [A, B, [323.0, 162.0]] {
        world.click(TOOL, at, NONE);
    }
    assert_eq!((world.document.undo_count(), world.hand.is_busy()), (1, false), "a press on the last point");
}

#[test]
fn backspace_takes_points_back_and_too_few_are_dropped() {
    let mut world = World::new();
    for at in [A, B, C] {
        world.click(TOOL, at, NONE);
    }
    assert_eq!(key(&mut world, Action::TakeBack).handles_px.len(), 2);
    key(&mut world, Action::TakeBack);
    assert!(key(&mut world, Action::Confirm).commit.is_none(), "one point is no curve");
    assert!(!world.hand.is_busy());
    world.click(TOOL, A, NONE);
    key(&mut world, Action::TakeBack);
    assert!(!world.hand.is_busy());
    for at in [A, B, C] {
        world.click(TOOL, at, NONE);
    }
    assert!(world.take(TOOL, ToolEvent::Cancel).preview.is_none());
    assert!(key(&mut world, Action::Confirm).commit.is_none());
    assert_eq!(world.document.undo_count(), 0);
}

#[test]
fn a_curve_stays_on_its_object() {
    let mut world = World::new();
    world.click(TOOL, A, NONE);
    for at in [[580.0, 180.0], [20.0, 20.0]] {
        let output = world.press(TOOL, at, NONE);
        assert_eq!(output.refusal.unwrap().0, "The curve is on ball: its points must lie there");
        assert!(world.hand.is_busy(), "what was drawn stays");
        world.secs += 1.0;
    }
}

/// A world with one curve, drawn with two clicks and selected.
fn drawn() -> World {
    let mut world = World::new();
    for at in [A, C] {
        world.click(TOOL, at, NONE);
    }
    key(&mut world, Action::Confirm);
    world
}

#[test]
fn a_handle_is_dragged_on_the_surface() {
    let mut world = drawn();
    let last = *shown(&world).last().unwrap();
    let hovered = world.hover(TOOL, last.to_array());
    assert!(hovered.handles_px.len() >= 2 && hovered.status.starts_with("[Drag] move the point"));
    world.press(TOOL, last.to_array(), NONE);
    let near = last + DVec2::new(1.0, 1.0);
    assert!(world.drag_to(TOOL, near.to_array(), NONE).preview.is_none(), "not yet a drag");
    let to = [390.0, 230.0];
    assert!(world.drag_to(TOOL, to, NONE).preview.is_some());
    assert!(world.release(TOOL).commit.is_some());
    assert_eq!((world.document.undo_count(), world.document.undo_text()), (2, Some("Edit guide g1")));
    assert!((*shown(&world).last().unwrap() - DVec2::from(to)).length() < 0.01);
    let at = *shown(&world).last().unwrap();
    world.click(TOOL, at.to_array(), NONE);
    assert_eq!(world.document.undo_count(), 2, "a click moves nothing");
    world.press(TOOL, at.to_array(), NONE);
    world.drag_to(TOOL, [350.0, 250.0], NONE);
    world.take(TOOL, ToolEvent::FocusLost);
    assert_eq!(*shown(&world).last().unwrap(), at);
}

#[test]
fn a_press_on_the_line_inserts_and_alt_drags_the_radius() {
    let mut world = drawn();
    let line = shown(&world);
    // A place with no handle near.
    let (index, pair) = line
        .windows(2)
        .enumerate()
        .max_by(|a, b| a.1[0].distance(a.1[1]).total_cmp(&b.1[0].distance(b.1[1])))
        .unwrap();
    if pair[0].distance(pair[1]) > 26.0 {
        let middle = (pair[0] + pair[1]) * 0.5;
        world.click(TOOL, middle.to_array(), NONE);
        assert_eq!(shown(&world).len(), line.len() + 1);
        assert!((shown(&world)[index + 1] - middle).length() < 0.01);
        assert!(world.document.undo().is_some());
    }
    let first = line[0];
    world.press(TOOL, first.to_array(), ALT);
    world.drag_to(TOOL, (first + DVec2::X * 50.0).to_array(), ALT);
    world.release(TOOL);
    assert_eq!(world.document.undo_text(), Some("Guide radius"));
    let guide = &world.guides(0)[0];
    let px = world.view.px_per_unit(DVec3::from(guide.points[0].at));
    assert!((guide.radius * px - 50.0).abs() < 1.0, "{}", guide.radius * px);
}

#[test]
fn a_long_piece_takes_a_point_where_it_is_pressed() {
    let mut world = drawn();
    let mut sparse = world.guides(0).to_vec();
    let points = &mut sparse[0].points;
    *points = vec![points[0].clone(), points.last().unwrap().clone()];
    let region = "skin".to_owned();
    world.run(Command::Directions(crate::command::Directions::Erase { region, guides: sparse }));
    world.select(Item::Guide("skin".to_owned(), 0));
    let middle = (shown(&world)[0] + shown(&world)[1]) * 0.5;
    assert_eq!(world.hover(TOOL, middle.to_array()).status, "[Click] add a point to this curve");
    world.press(TOOL, middle.to_array(), NONE);
    let to = middle + DVec2::Y * 20.0;
    world.drag_to(TOOL, to.to_array(), NONE);
    let count = world.document.undo_count();
    world.release(TOOL);
    assert_eq!(world.document.undo_count(), count + 1, "inserted and dragged is one entry");
    assert!(shown(&world).len() == 3 && (shown(&world)[1] - to).length() < 0.01);
}

#[test]
fn the_arrow_flips_and_delete_takes_a_point_out() {
    let mut world = drawn();
    let before = world.guides(0)[0].points.clone();
    let line = shown(&world);
    let last = line.len() - 1;
    let tip = line[last] + (line[last] - line[last - 1]).normalize() * 16.0;
    assert_eq!(world.hover(TOOL, tip.to_array()).status, "[Click] flip this curve");
    world.click(TOOL, tip.to_array(), NONE);
    assert!(world.guides(0)[0].points.iter().eq(before.iter().rev()));
    world.hover(TOOL, line[last].to_array());
    assert!(key(&mut world, Action::Delete).commit.is_some());
    assert_eq!(world.guides(0).first().map_or(0, |guide| guide.points.len()), before.len() - 1);
    world.hover(TOOL, [20.0, 20.0]);
    assert!(key(&mut world, Action::Delete).commit.is_none(), "off every handle, the tool takes no Delete");
}

#[test]
fn curves_are_mirrored_and_the_own_one_is_selected() {
    let mut world = World::new();
    world.options.mirror = [false, true, false];
    for at in [[280.0, 200.0], [360.0, 220.0]] {
        world.click(TOOL, at, NONE);
    }
    key(&mut world, Action::Confirm);
    assert_eq!((world.guides(0).len(), world.document.undo_count()), (2, 1));
    assert_eq!(world.document.selection().active(), Some(&Item::Guide("skin".to_owned(), 1)));
    assert!(world.guides(0)[1].points[0].at[1] < 0.0 && world.guides(0)[0].points[0].at[1] > 0.0);
}
