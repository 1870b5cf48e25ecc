//! Tests of the brush that paints amounts.

use impasto_scene::document::{Amount, AmountDab, PaintedAmount};

use super::*;
use crate::command::Amounts;

const LEFT: [f64; 2] = [270.0, 200.0];
const RIGHT: [f64; 2] = [370.0, 200.0];
const OFF: [f64; 2] = [4.0, 4.0];

fn amounts(world: &World) -> &[PaintedAmount] {
    &world.document.scene().regions[0].amounts
}

#[test]
fn a_drag_paints_dabs_along_the_surface_as_one_entry() {
    let mut world = World::new();
    let aimed = world.hover(Tool::Amount, LEFT);
    assert_eq!(
        aimed.status,
        "[Drag] raise the width  [Ctrl] lower  [Shift] erase  [F] radius  [Middle] orbit"
    );
    assert!(!aimed.rings[0].hollow && aimed.needle.is_none() && aimed.comb_preview.is_none());
    let pressed = world.press(Tool::Amount, LEFT, NONE);
    assert_eq!(pressed.status, "Raising the width on skin, radius 30 px   [Esc] take it back");
    assert!(pressed.preview.is_some(), "a press alone previews no dab");
    let moved = world.drag_to(Tool::Amount, RIGHT, NONE);
    assert!(moved.needle.is_none());
    assert_eq!(world.document.shown().scene.regions[0].amounts.len(), 1, "nothing shows during the drag");
    assert!(amounts(&world).is_empty());
    world.release(Tool::Amount);
    assert_eq!((world.document.undo_count(), world.document.undo_text()), (1, Some("Paint width on skin")));
    assert_eq!(world.document.selection().active(), Some(&Item::Region("skin".to_owned())));
    let [PaintedAmount { of: Amount::Width, object: None, dabs }] = amounts(&world) else { panic!() };
    // A drag of 100 px with a brush of radius 30 px, whose dabs lie half a radius apart.
    assert!((7..=9).contains(&dabs.len()), "{}", dabs.len());
    for dab in dabs {
        let at = DVec3::from(dab.at);
        assert!(
            (at.length() - 1.0).abs() < 0.01 && at.normalize().dot(dab.normal.into()) > 0.99,
            "a dab is not on the ball"
        );
        assert!((world.view.project(at).unwrap().y - 200.0).abs() < 1.0);
        assert!(dab.by > 1.2 && dab.by < 1.4, "{}", dab.by);
    }
    world.document.undo().unwrap();
    assert!(amounts(&world).is_empty());
    world.document.redo().unwrap();
    assert!(!amounts(&world).is_empty());
}

#[test]
fn ctrl_lowers_and_drags_on_one_amount_share_a_list() {
    let mut world = World::new();
    world.drag(Tool::Amount, &[LEFT, RIGHT], NONE);
    let first = amounts(&world)[0].dabs.len();
    world.drag(Tool::Amount, &[LEFT, RIGHT], CTRL);
    assert_eq!(amounts(&world).len(), 1);
    let dabs = &amounts(&world)[0].dabs;
    assert!(dabs.len() == 2 * first && dabs[first..].iter().all(|dab| dab.by < 1.0));
    world.options.lowers = true;
    (world.options.amount, world.options.strength) = (Amount::Density, 1.0);
    world.drag(Tool::Amount, &[LEFT, RIGHT], NONE);
    world.drag(Tool::Amount, &[LEFT, RIGHT], CTRL);
    let [_, PaintedAmount { of: Amount::Density, dabs, .. }] = amounts(&world) else { panic!() };
    assert!(dabs[0].by == 0.0 && dabs.last().unwrap().by > 1.0);
    assert_eq!(world.document.undo_count(), 4);
    let saved = world.document.scene().clone();
    while world.document.undo().is_some() {}
    assert!(amounts(&world).is_empty());
    while world.document.redo().is_some() {}
    assert_eq!(world.document.scene(), &saved);
}

#[test]
fn shift_erases_the_dabs_of_this_amount_under_the_ring() {
    let mut world = World::new();
    world.drag(Tool::Amount, &[LEFT, RIGHT], NONE);
    world.options.amount = Amount::Length;
    world.drag(Tool::Amount, &[LEFT, RIGHT], NONE);
    let whole = amounts(&world)[1].dabs.len();
    let erased = world.drag(Tool::Amount, &[[310.0, 200.0], [330.0, 200.0]], SHIFT);
    assert!(erased.commit.is_some());
    assert_eq!(world.document.undo_text(), Some("Erase length on skin"));
    assert_eq!(amounts(&world)[0].dabs.len(), whole, "erasing the length erases width");
    assert!(amounts(&world)[1].dabs.len() < whole && amounts(&world)[1].dabs.len() > 1);
    world.drag(Tool::Amount, &[LEFT, RIGHT], SHIFT);
    assert_eq!(amounts(&world).len(), 1, "a list without dabs is still there");
    let count = world.document.undo_count();
    assert!(world.drag(Tool::Amount, &[LEFT, RIGHT], SHIFT).commit.is_none());
    assert_eq!(world.document.undo_count(), count, "an eraser over nothing adds an entry");
}

#[test]
fn nothing_is_painted_off_the_surface_nor_on_what_is_locked() {
    let mut world = World::new();
    let refused = world.press(Tool::Amount, OFF, NONE);
    assert!(refused.refusal.is_some_and(|refusal| refusal.0.starts_with("Nothing to paint here")));
    assert!(world.release(Tool::Amount).commit.is_none());
    world.options.strength = 0.0;
    assert!(world.drag(Tool::Amount, &[LEFT, RIGHT], NONE).commit.is_none(), "strength 0 paints something");
    world.options.strength = 1.0;
    world.run(Command::Edit(Edit::SetLocked(vec![Item::Region("skin".to_owned())], true)));
    let refused = world.press(Tool::Amount, LEFT, NONE);
    assert!(refused.refusal.is_some_and(|refusal| refusal.0 == "skin is locked"));
}

#[test]
fn commands_clear_amounts_and_names_are_followed() {
    let mut world = World::new();
    let dab = AmountDab { at: [0.0, 0.0, 1.0], normal: [0.0, 0.0, 1.0], radius: 0.2, by: 2.0 };
    let paint = |of: Amount| {
        Command::Amounts(Amounts::Paint {
            region: RegionTarget::Named("skin".to_owned()),
            of,
            object: None,
            dabs: vec![dab.clone()],
        })
    };
    world.run(paint(Amount::Width));
    world.run(paint(Amount::Flatness));
    world.run(Command::Amounts(Amounts::Clear("skin".to_owned(), 0)));
    assert_eq!(world.document.undo_text(), Some("Clear width of skin"));
    assert_eq!(amounts(&world)[0].of, Amount::Flatness);
    world.run(Command::Amounts(Amounts::ClearAll("skin".to_owned())));
    assert!(amounts(&world).is_empty());
    let nothing = world.document.apply(&Command::Amounts(Amounts::ClearAll("skin".to_owned())));
    assert!(nothing.is_err());
}
