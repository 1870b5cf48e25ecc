//! Tests of the brush tools: comb, smooth, smear, erase, region brush.

use impasto_scene::document::{GuideMode, Selector};

use super::*;
use crate::command::{Directions, Gesture};
use crate::session::{RegionBy, RegionDoes};

const LEFT: [f64; 2] = [270.0, 200.0];
const RIGHT: [f64; 2] = [370.0, 200.0];

#[test]
fn a_comb_aims_strokes_and_leaves_one_entry() {
    let mut world = World::new();
    let aimed = world.hover(Tool::Comb, LEFT);
    assert_eq!(aimed.status, "[Drag] comb  [Shift] smooth  [Ctrl] against  [F] radius  [Middle] orbit");
    assert!(!aimed.rings[0].hollow && aimed.needle.is_some_and(|needle| !needle.headed));
    let pressed = world.press(Tool::Comb, LEFT, NONE);
    assert!(pressed.commit.is_none() && pressed.refusal.is_none() && world.hand.is_busy());
    assert_eq!(pressed.status, "Combing skin, radius 30 px   [Esc] take it back");
    world.drag_to(Tool::Comb, [320.0, 200.0], NONE);
    let moved = world.drag_to(Tool::Comb, RIGHT, NONE);
    assert_eq!(moved.status, "Combing skin, 0°, radius 30 px   [Esc] take it back");
    assert!(moved.needle.is_some_and(|needle| needle.headed && needle.along == DVec2::X));
    assert!(
        matches!(&moved.preview, Some(Command::Directions(Directions::Stroke { guides, .. })) if guides.len() == 1)
    );
    assert_eq!(world.document.shown().scene.regions[0].guides.len(), 1, "shown while it is drawn");
    assert!(world.guides(0).is_empty());
    let released = world.release(Tool::Comb);
    assert!(released.commit.is_some() && released.preview.is_none() && !world.hand.is_busy());
    assert_eq!((world.document.undo_count(), world.document.undo_text()), (1, Some("Comb skin")));
    assert_eq!(world.document.selection().active(), Some(&Item::Region("skin".to_owned())));
    let guide = &world.guides(0)[0];
    assert!(guide.view.is_none() && guide.object.is_none() && guide.strength == 0.8);
    let ends = [&guide.points[0], guide.points.last().unwrap()].map(|point| DVec3::from(point.at));
    let shown = ends.map(|at| world.view.project(at).unwrap());
    assert!((shown[0] - DVec2::from(LEFT)).length() < 0.6 && (shown[1] - DVec2::from(RIGHT)).length() < 0.6);
}

#[test]
fn esc_and_a_lost_focus_leave_it_as_if_never_begun() {
    for event in [ToolEvent::Cancel, ToolEvent::FocusLost, ToolEvent::Key(Action::Cancel)] {
        for tool in [
            Tool::Comb,
            Tool::Smooth,
            Tool::Erase,
            Tool::Region,
            Tool::Fill,
            Tool::TurnDirection,
            Tool::Amount,
        ] {
            let mut world = World::new();
            world.drag(Tool::Comb, &[LEFT, RIGHT], NONE);
            world.options.flip = false;
            let before = world.document.scene().clone();
            world.press(tool, LEFT, NONE);
            world.drag_to(tool, RIGHT, NONE);
            assert!(world.hand.is_busy(), "{tool:?}");
            let output = world.take(tool, event);
            assert!(output.commit.is_none() && output.preview.is_none() && !world.hand.is_busy());
            assert_eq!(world.document.shown().scene, before, "{tool:?}");
            // The button is still down: a drag and the release after the cancel do nothing.
            assert!(world.drag_to(tool, LEFT, NONE).preview.is_none());
            assert!(world.release(tool).commit.is_none());
            assert_eq!((world.document.undo_count(), world.document.scene()), (1, &before), "{tool:?}");
        }
    }
}

#[test]
fn another_tool_drops_what_was_begun() {
    let mut world = World::new();
    world.press(Tool::Comb, LEFT, NONE);
    world.drag_to(Tool::Comb, RIGHT, NONE);
    world.hover(Tool::Erase, RIGHT);
    assert!(!world.hand.is_busy());
    world.release(Tool::Comb);
    assert_eq!(world.document.undo_count(), 0);
}

#[test]
fn painting_where_it_is_impossible_is_refused_with_a_message() {
    let mut world = World::new();
    let nothing = "Nothing to paint here: the ring must lie on an object";
    for tool in [
        Tool::Comb,
        Tool::Smooth,
        Tool::Erase,
        Tool::Region,
        Tool::Fill,
        Tool::TurnDirection,
        Tool::GuideCurve,
    ] {
        assert_eq!(refused(&world.press(tool, [20.0, 20.0], NONE)), nothing, "{tool:?}");
        assert!(!world.hand.is_busy());
    }
    let empty = world.hover(Tool::Comb, [20.0, 20.0]);
    assert!(empty.rings.len() == 1 && empty.rings[0].hollow && empty.refusal.is_none());
    world.run(Command::Edit(Edit::SetLocked(vec![Item::Region("skin".to_owned())], true)));
    let hover = world.hover(Tool::Comb, LEFT);
    assert_eq!((hover.status.as_str(), hover.refusal), ("skin is locked. [L] unlocks it", None));
    for tool in [Tool::Comb, Tool::Erase, Tool::Fill, Tool::TurnDirection, Tool::GuideCurve] {
        assert_eq!(refused(&world.press(tool, LEFT, NONE)), "skin is locked", "{tool:?}");
        assert!(!world.hand.is_busy());
    }
    assert!(world.press(Tool::Comb, [320.0, 60.0], NONE).refusal.is_none(), "the lid is not locked");
    world.take(Tool::Comb, ToolEvent::Cancel);
    world.run(Command::Edit(Edit::SetLocked(vec![Item::Object("ball".to_owned())], true)));
    assert_eq!(refused(&world.press(Tool::Comb, [320.0, 60.0], NONE)), "ball is locked");
    world.run(Command::Edit(Edit::SetHidden(vec![Item::Object("ball".to_owned())], true)));
    assert_eq!(refused(&world.press(Tool::Comb, LEFT, NONE)), nothing, "what is hidden is looked through");
}

#[test]
fn a_hidden_region_is_not_painted_on() {
    let mut world = World::new();
    world.run(Command::Edit(Edit::SetHidden(vec![Item::Region("skin".to_owned())], true)));
    assert_eq!(refused(&world.press(Tool::Comb, LEFT, NONE)), "skin is hidden");
}

#[test]
fn where_no_region_lies_a_comb_makes_one() {
    let mut world = World::new();
    world.drag(Tool::Comb, &[[560.0, 180.0], [600.0, 180.0]], NONE);
    let region = &world.document.scene().regions[0];
    assert_eq!((region.name.as_str(), &region.on), ("plate", &Selector::Object("plate".to_owned())));
    assert_eq!((region.guides.len(), world.document.undo_count()), (1, 1));
}

#[test]
fn the_comb_stays_in_the_region_of_its_press_and_its_pieces_are_one_entry() {
    let mut world = World::new();
    // Up into the upper region and back.
    world.drag(Tool::Comb, &[[300.0, 180.0], [300.0, 60.0], [340.0, 60.0], [340.0, 180.0]], NONE);
    assert_eq!((world.guides(0).len(), world.guides(1).len(), world.document.undo_count()), (2, 0, 1));
    for point in world.guides(0).iter().flat_map(|guide| &guide.points) {
        assert!(point.at[1] <= 0.5);
    }
    // Off the ball and back onto it.
    let mut world = World::new();
    world.press(Tool::Comb, [400.0, 180.0], NONE);
    for at in [[560.0, 180.0], [560.0, 200.0]] {
        world.drag_to(Tool::Comb, at, NONE);
    }
    let lifted = world.drag_to(Tool::Comb, [500.0, 330.0], NONE);
    assert!(lifted.rings.iter().all(|ring| ring.hollow), "the hand is off the object of the press");
    world.drag_to(Tool::Comb, [400.0, 220.0], NONE);
    world.release(Tool::Comb);
    assert_eq!((world.guides(0).len(), world.document.undo_count()), (2, 1));
}

#[test]
fn shift_smooths_and_ctrl_goes_against() {
    let mut world = World::new();
    world.drag(Tool::Comb, &[LEFT, RIGHT], NONE);
    world.drag(Tool::Comb, &[LEFT, RIGHT], SHIFT);
    assert_eq!(world.document.undo_text(), Some("Smooth skin"));
    assert_eq!(world.guides(0)[1].mode, GuideMode::Smooth);
    world.drag(Tool::Comb, &[LEFT, RIGHT], CTRL);
    let [along, _, against] = world.guides(0) else { panic!() };
    assert!(along.points.iter().eq(against.points.iter().rev()));
    world.options.against = true;
    world.drag(Tool::Comb, &[LEFT, RIGHT], CTRL);
    assert_eq!(world.guides(0)[3].points, world.guides(0)[0].points, "Ctrl turns `against` back into along");
    world.drag(Tool::Smooth, &[LEFT, RIGHT], NONE);
    assert_eq!((world.guides(0)[4].mode, world.document.undo_count()), (GuideMode::Smooth, 5));
}

#[test]
fn a_press_without_a_drag_is_no_stroke_but_selects() {
    let mut world = World::new();
    world.click(Tool::Comb, LEFT, NONE);
    assert_eq!((world.document.undo_count(), world.guides(0).len()), (0, 0));
    assert_eq!(world.document.selection().active(), Some(&Item::Region("skin".to_owned())));
}

#[test]
fn mirror_images_are_part_of_the_entry() {
    let mut world = World::new();
    world.options.mirror = [true, false, false];
    let rings = world.hover(Tool::Comb, [370.0, 200.0]).rings;
    assert!(rings.len() == 2 && rings[0].mirrored && !rings[0].hollow && !rings[1].mirrored);
    assert!((rings[0].at_px - DVec2::new(270.0, 200.0)).length() < 1.0, "{}", rings[0].at_px);
    world.drag(Tool::Comb, &[[350.0, 200.0], [400.0, 230.0]], NONE);
    let [own, image] = world.guides(0) else { panic!("{}", world.guides(0).len()) };
    assert_eq!(world.document.undo_count(), 1);
    for (own, image) in own.points.iter().zip(&image.points) {
        let mirrored = DVec3::from(own.at) * DVec3::new(-1.0, 1.0, 1.0);
        assert!((DVec3::from(image.at) - mirrored).length() < 0.01);
    }
    // The plate has no mirror image: opposite to it there is no surface, so the mirrored ring is hollow.
    let rings = world.hover(Tool::Comb, [580.0, 180.0]).rings;
    assert!(rings[0].hollow && rings[0].mirrored && !rings[1].hollow);
}

#[test]
fn an_eraser_cuts_guides_and_takes_away_what_it_covers() {
    let mut world = World::new();
    world.options.radius_px = 12.0;
    world.drag(Tool::Comb, &[LEFT, RIGHT], NONE);
    world.drag(Tool::Comb, &[[310.0, 250.0], [330.0, 250.0]], NONE);
    let before = world.guides(0)[1].points.clone();
    let erased = world.drag(Tool::Erase, &[[320.0, 190.0], [320.0, 210.0]], NONE);
    assert!(erased.commit.is_some());
    assert_eq!(world.document.undo_text(), Some("Erase on skin"));
    let [left, right, other] = world.guides(0) else { panic!("{}", world.guides(0).len()) };
    let shown = |at: [f64; 3]| world.view.project(DVec3::from(at)).unwrap();
    assert!((shown(left.points.last().unwrap().at).x - 308.0).abs() < 1.0);
    assert!((shown(right.points[0].at).x - 332.0).abs() < 1.0);
    assert_eq!(other.points, before, "a guide that the eraser does not touch stays as it is");
    world.drag(Tool::Erase, &[[305.0, 250.0], [335.0, 250.0]], NONE);
    assert_eq!(world.guides(0).len(), 2, "a wholly covered guide is removed");
    let count = world.document.undo_count();
    assert!(world.drag(Tool::Erase, &[[320.0, 270.0], [330.0, 272.0]], NONE).commit.is_none());
    assert_eq!(world.document.undo_count(), count, "an eraser over nothing adds no entry");
    while world.document.undo().is_some() {}
    assert!(world.guides(0).is_empty());
}

#[test]
fn smearing_carries_the_direction_of_the_press() {
    let mut world = World::new();
    world.options.smear = true;
    world.painted.shown = Some(PaintedDirection { angle_rad: 80f64.to_radians(), trust: 1.0 });
    world.drag(Tool::Smooth, &[LEFT, RIGHT], NONE);
    assert_eq!(world.document.undo_text(), Some("Smear skin"));
    for point in &world.guides(0)[0].points {
        assert!((point.turn_deg - 80.0).abs() < 0.5, "{}", point.turn_deg);
    }
    world.painted.shown = None;
    world.drag(Tool::Smooth, &[LEFT, RIGHT], NONE);
    assert!(world.guides(0)[1].points.iter().all(|point| point.turn_deg == 0.0));
}

#[test]
fn the_region_brush_paints_the_selected_region() {
    let mut world = World::new();
    assert_eq!(
        refused(&world.press(Tool::Region, LEFT, NONE)),
        "Select a region to paint it, or choose New region"
    );
    world.select(Item::Region("lid".to_owned()));
    assert_eq!(world.hover(Tool::Region, LEFT).status, "[Drag] add to lid  [Ctrl] take away");
    assert_eq!(
        refused(&world.press(Tool::Region, [580.0, 180.0], NONE)),
        "The region lid is of ball, not of plate: choose New region"
    );
    world.drag(Tool::Region, &[LEFT, RIGHT], NONE);
    world.drag(Tool::Region, &[LEFT, RIGHT], CTRL);
    assert_eq!((world.document.undo_count(), world.document.undo_text()), (2, Some("Paint region lid")));
    let Selector::Several(_, patches) = &world.document.scene().regions[1].on else { panic!() };
    let [_, impasto_scene::document::Patch::Dabs(dabs)] = &patches[..] else { panic!() };
    let taken = dabs.iter().filter(|dab| dab.take_away).count();
    assert!(taken >= 10 && dabs.len() == 2 * taken, "{} dabs, {taken} of them take away", dabs.len());
    world.options.region_does = RegionDoes::New;
    world.options.region_by = RegionBy::Brush;
    world.drag(Tool::Region, &[[560.0, 180.0], [600.0, 180.0]], NONE);
    let made = world.document.scene().regions.last().unwrap();
    assert!(matches!(&made.on, Selector::Dabs(object, _) if object == "plate"));
    assert_eq!(world.document.selection().active(), Some(&Item::Region(made.name.clone())));
}

#[test]
fn a_resting_hand_reads_the_direction() {
    let mut world = World::new();
    world.hover(Tool::Comb, LEFT);
    assert_eq!(world.hover(Tool::Comb, LEFT).label, None);
    world.secs += 0.5;
    assert_eq!(world.hover(Tool::Comb, LEFT).label.as_deref(), Some("10°  trust 0.97"));
    for step in 0..10 {
        world.hover(Tool::Comb, [270.0 + 3.0 * f64::from(step), 200.0]);
    }
    let moving = world.hover(Tool::Comb, [300.0, 200.0]);
    assert!(moving.label.is_none() && moving.needle.is_some_and(|needle| needle.headed));
}

#[test]
fn gestures_of_every_kind_name_themselves() {
    let mut world = World::new();
    world.drag(Tool::Comb, &[LEFT, RIGHT], NONE);
    let smooth = world.drag(Tool::Smooth, &[LEFT, RIGHT], NONE).commit;
    assert!(matches!(smooth, Some(Command::Directions(Directions::Stroke { gesture: Gesture::Smooth, .. }))));
    for (tool, words) in [(Tool::Smooth, "Smoothing skin, radius"), (Tool::Erase, "Erasing on skin, radius")]
    {
        assert!(world.press(tool, LEFT, NONE).status.starts_with(words));
        world.take(tool, ToolEvent::Cancel);
    }
}
