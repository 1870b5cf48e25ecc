//! Tests of the tools that work by clicks: fill, turn, pick, regions, resizing.

use impasto_scene::document::{Bend, Direction, Patch, Selector};

use super::*;
use crate::session::{RegionBy, RegionDoes};

const HERE: [f64; 2] = [330.0, 200.0];

fn direction(world: &World) -> &Direction {
    &world.document.scene().regions[0].direction
}

#[test]
fn a_click_fills_with_what_the_options_say() {
    let mut world = World::new();
    for (fill, wanted) in [
        (FillKind::Automatic, Direction::Auto),
        (FillKind::Curvature, Direction::Curvature(Bend::Min)),
        (FillKind::Up, Direction::Up),
        (FillKind::Angle, Direction::Angle(35.0)),
    ] {
        world.options.fill = fill;
        let [pressed, _] = world.click(Tool::Fill, HERE, NONE);
        assert!(pressed.preview.is_some(), "the fill is previewed before the release");
        assert_eq!(direction(&world), &wanted);
    }
    assert_eq!((world.document.undo_count(), world.document.undo_text()), (4, Some("Fill skin: 35°")));
    world.options.fill = FillKind::Around;
    world.click(Tool::Fill, HERE, NONE);
    // The ball's skin lies below y = 0.5, so X and Z are its longest sides.
    assert!(matches!(direction(&world), Direction::Around(axis) if axis[1] == 0.0));
    world.click(Tool::Fill, [580.0, 180.0], NONE);
    let plate = &world.document.scene().regions[0];
    assert_eq!((plate.name.as_str(), &plate.direction), ("plate", &Direction::Around([0.0, 1.0, 0.0])));
}

#[test]
fn a_needle_is_dragged_to_an_angle() {
    let mut world = World::new();
    world.options.fill = FillKind::Angle;
    world.press(Tool::Fill, HERE, NONE);
    let dragged = world.drag_to(Tool::Fill, [330.0 + 30.0, 200.0 - 30.0], NONE);
    assert_eq!(dragged.status, "Filling skin, 45°   [Esc] take it back");
    assert!(dragged.needle.is_some());
    let released = world.release(Tool::Fill);
    assert_eq!(direction(&world), &Direction::Angle(45.0));
    assert_eq!(
        released.options.map(|options| options.fill_angle_deg),
        Some(45.0),
        "the bar shows another angle"
    );
    // A camera rolled by 30 degrees shows everything turned by −30.
    world.view.camera.roll_rad = 30f64.to_radians();
    let hit = [320.0, 180.0];
    world.drag(Tool::Fill, &[hit, [360.0, 180.0]], NONE);
    let Direction::Angle(angle) = direction(&world) else { panic!() };
    assert!((angle - 30.0).abs() < 0.11, "{angle}");
}

#[test]
fn clicks_flip_and_drags_turn_directions() {
    let mut world = World::new();
    assert_eq!(world.hover(Tool::TurnDirection, HERE).status, "[Click] flip skin  [Middle] orbit");
    world.click(Tool::TurnDirection, HERE, NONE);
    assert_eq!((world.document.undo_count(), world.document.undo_text()), (1, Some("Flip skin")));
    world.options.flip = false;
    world.press(Tool::TurnDirection, HERE, NONE);
    let dragged = world.drag_to(Tool::TurnDirection, [HERE[0] + 31.0, HERE[1]], NONE);
    assert!(dragged.preview.is_some() && dragged.status.starts_with("Turning skin, 15.5°"));
    assert!(world.drag_to(Tool::TurnDirection, [HERE[0] + 31.0, HERE[1]], CTRL).status.contains(" 15°"));
    world.release(Tool::TurnDirection);
    assert_eq!(world.document.undo_text(), Some("Turn skin 15°"));
    world.click(Tool::TurnDirection, HERE, NONE);
    assert_eq!(world.document.undo_count(), 2, "a click turns nothing");
    world.hover(Tool::Comb, HERE);
    let flipped = world.take(Tool::Comb, ToolEvent::Key(Action::FlipUnderCursor));
    assert!(flipped.commit.is_some());
    world.hover(Tool::Comb, [20.0, 20.0]);
    assert!(refused(&world.take(Tool::Comb, ToolEvent::Key(Action::FlipUnderCursor))).starts_with("Nothing"));
}

#[test]
fn pick_takes_the_direction_into_fill_and_selects() {
    let mut world = World::new();
    let [picked, _] = world.click(Tool::Pick, HERE, NONE);
    assert_eq!(picked.status, "Picked 10°, trust 0.97");
    assert_eq!((world.options.fill, world.options.fill_angle_deg), (FillKind::Angle, 10.0));
    assert_eq!(world.document.selection().active(), Some(&Item::Region("skin".to_owned())));
    assert_eq!(world.document.undo_count(), 0);
    assert!(refused(&world.click(Tool::Pick, [20.0, 20.0], NONE)[0]).starts_with("Nothing to pick"));
}

#[test]
fn a_click_makes_regions_of_floods_groups_and_materials() {
    let mut world = World::new();
    world.options.region_does = RegionDoes::New;
    for (by, wanted) in [
        (RegionBy::Group, Selector::Group("ball".to_owned(), "lower".to_owned())),
        (RegionBy::Material, Selector::Material("ball".to_owned(), "lower_paint".to_owned())),
    ] {
        world.options.region_by = by;
        world.click(Tool::Region, HERE, NONE);
        assert_eq!(world.document.scene().regions.last().unwrap().on, wanted);
    }
    world.options.region_by = RegionBy::Flood;
    // The flood takes triangles of the lid, so the user is asked, and agrees here.
    let [asked, _] = world.click(Tool::Region, HERE, NONE);
    world.run(asked.ask.expect("it is asked about").0);
    let made = world.document.scene().regions.last().unwrap();
    assert!(matches!(&made.on, Selector::Flood(object, _, sharp) if object == "ball" && *sharp == 30.0));
    world.options.region_does = RegionDoes::Add;
    world.select(Item::Region("lid".to_owned()));
    world.options.region_by = RegionBy::Group;
    assert_eq!(world.hover(Tool::Region, HERE).status, "[Click] take a group into lid");
    world.click(Tool::Region, HERE, NONE);
    let groups = ["upper", "lower"].map(|group| Patch::Group(group.to_owned()));
    assert_eq!(world.document.scene().regions[1].on, Selector::Several("ball".to_owned(), groups.into()));
    assert_eq!(refused(&world.click(Tool::Region, [580.0, 180.0], NONE)[0]), "lid does not lie on plate");
    world.options.region_does = RegionDoes::TakeAway;
    assert!(refused(&world.click(Tool::Region, HERE, NONE)[0]).starts_with("Only the brush"));
    assert!(refused(&world.click(Tool::Region, [20.0, 20.0], NONE)[0]).starts_with("Nothing to paint"));
}

#[test]
fn a_click_that_takes_from_a_region_of_parts_is_asked_about_first() {
    let mut world = World::new();
    // The user is asked before the lid loses triangles, because somebody chose this group. The skin is the whole ball,
    // which is there to be divided, so it may lose triangles without a question.
    world.options.region_does = RegionDoes::New;
    let on_lid = [320.0, 80.0];
    // Triangles belong to the region in which their middles lie.
    let mesh = world.document.loaded().meshes["ball.obj"].mesh.clone();
    let middle_y = |triangle: usize| mesh.corners(triangle).iter().map(|corner| corner.y).sum::<f32>() / 3.0;
    let of_lid = (0..mesh.triangles.len()).filter(|&triangle| middle_y(triangle) > 0.5).count();
    for by in [RegionBy::Flood, RegionBy::Group, RegionBy::Material] {
        world.options.region_by = by;
        let count = world.document.undo_count();
        let [asked, _] = world.click(Tool::Region, on_lid, NONE);
        let (command, taken) = asked.ask.expect("it is asked about");
        assert_eq!(taken, format!("{of_lid} triangles of lid"), "{by:?}");
        assert_eq!(world.document.undo_count(), count, "nothing is taken yet");
        world.document.apply(&command).unwrap();
        assert_eq!(world.document.undo_count(), count + 1);
        world.document.undo();
    }
    world.options.region_by = RegionBy::Group;
    let [made, _] = world.click(Tool::Region, HERE, NONE);
    assert!(made.commit.is_some() && made.ask.is_none(), "taking from the skin is not asked about");
    world.document.undo();
    // Triangles that the region already has are taken from no other region, so there is no question.
    world.options.region_does = RegionDoes::Add;
    world.select(Item::Region("lid".to_owned()));
    assert!(world.click(Tool::Region, on_lid, NONE)[0].commit.is_some());
}

#[test]
fn the_turn_tool_shows_which_way_strokes_run() {
    let mut world = World::new();
    let needle = world.hover(Tool::TurnDirection, HERE).needle.expect("a needle");
    assert!(needle.headed && (needle.along - DVec2::from_angle(-10f64.to_radians())).length() < 1e-9);
    assert!(world.hover(Tool::TurnDirection, [20.0, 20.0]).needle.is_none());
}

#[test]
fn f_sizes_the_brush_until_a_press() {
    let mut world = World::new();
    let key = |world: &mut World, action| world.take(Tool::Comb, ToolEvent::Key(action));
    world.hover(Tool::Comb, HERE);
    key(&mut world, Action::SizeRadius);
    assert!(world.hand.is_busy());
    let sized = world.hover(Tool::Comb, [HERE[0] + 25.0, HERE[1]]);
    assert_eq!(
        (world.options.radius_px, sized.status.as_str()),
        (55.0, "Radius 55 px   [Click] keep  [Esc] back")
    );
    // The ring stays where F was pressed, and shows the new radius.
    let [ring] = &sized.rings[..] else { panic!("{} rings", sized.rings.len()) };
    assert!(ring.at_px.distance(DVec2::from(HERE)) < 1.0, "{}", ring.at_px);
    let reach_px = ring.points_px.iter().map(|at| at.distance(ring.at_px)).fold(0.0, f64::max);
    assert!((45.0..70.0).contains(&reach_px), "{reach_px}");
    world.press(Tool::Comb, HERE, NONE);
    assert!(!world.hand.is_busy(), "the press keeps the radius, and begins no comb");
    world.drag_to(Tool::Comb, [HERE[0] + 60.0, HERE[1]], NONE);
    assert!(world.release(Tool::Comb).commit.is_none());
    assert_eq!((world.options.radius_px, world.document.undo_count()), (55.0, 0));
    for end in [ToolEvent::Cancel, ToolEvent::FocusLost, ToolEvent::Key(Action::Cancel)] {
        key(&mut world, Action::SizeRadius);
        world.hover(Tool::Comb, [HERE[0] - 900.0, HERE[1]]);
        assert_eq!(world.options.radius_px, 2.0);
        world.take(Tool::Comb, end);
        assert_eq!((world.options.radius_px, world.hand.is_busy()), (55.0, false));
        world.hover(Tool::Comb, HERE);
    }
    key(&mut world, Action::SizeStrength);
    world.hover(Tool::Comb, [HERE[0] - 40.0, HERE[1]]);
    key(&mut world, Action::Confirm);
    assert!((world.options.strength - 0.6).abs() < 1e-9);
    key(&mut world, Action::LargerRadius);
    assert!((world.options.radius_px - 60.5).abs() < 1e-9);
    key(&mut world, Action::SmallerRadius);
    assert!((world.options.radius_px - 55.0).abs() < 1e-9);
    world.drag(Tool::Comb, &[[270.0, 200.0], [370.0, 200.0]], NONE);
    assert_eq!(world.document.undo_count(), 1, "the next drag combs again");
}
