//! Tests of the menu that a right click opens, and of controls that are reached by their names.

use egui::{Key, PointerButton, pos2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use impasto_editor::panels::Control;
use impasto_editor::theme::Theme;
use impasto_editor_model::keymap::Action;
use impasto_editor_model::{Item, Selection};

use super::{Column, SIZE, click, harness, harness_of, object, region, right_click};

fn selection<'a>(harness: &'a Harness<'_, Column>) -> &'a Selection {
    harness.state().document.selection()
}

#[test]
fn a_right_click_on_a_row_selects_it_and_offers_what_can_be_done() {
    let mut harness = harness("still_life.ron", object("jug"));
    right_click(&mut harness, "lemon, object");
    assert_eq!(selection(&harness), &Selection::from_iter(object("lemon")));
    for row in ["Comb", "Move", "Duplicate", "Rename", "Delete", "Hide", "Lock", "Frame selected", "Set key"]
    {
        assert!(harness.query_by_label(row).is_some(), "{row}");
    }
    click(&mut harness, "Duplicate");
    assert_eq!(harness.state().acts, [Action::Duplicate]);
    assert!(harness.query_by_label("Duplicate").is_none(), "the menu is closed");

    right_click(&mut harness, "jug rim, region, around");
    assert_eq!(selection(&harness), &Selection::from_iter(region("jug rim")));
    assert!(harness.query_by_label("Fill direction").is_some() && harness.query_by_label("Move").is_none());
    harness.key_press(Key::Escape);
    harness.run();
    assert!(harness.query_by_label("Fill direction").is_none(), "Esc closes the menu");

    right_click(&mut harness, "shot, camera");
    assert_eq!(selection(&harness), &Selection::only(Item::Camera));
    assert!(harness.query_by_label("Look through the shot camera").is_some());
    harness.key_press(Key::Escape);
    harness.run();
    assert_eq!(harness.state().acts.len(), 1);
}

#[test]
fn several_rows_stay_selected_and_a_click_elsewhere_closes_the_menu() {
    let mut harness = harness("still_life.ron", None);
    let both: Selection = object("jug").into_iter().chain(object("lemon")).collect();
    harness.state_mut().document.select(both.clone());
    harness.run();
    right_click(&mut harness, "jug, object");
    assert_eq!(selection(&harness), &both);
    assert!(harness.query_by_label("2 things").is_some());
    let before = harness.state().log.len();
    let at = pos2(140.0, 2390.0);
    for pressed in [true, false] {
        let (button, modifiers) = (PointerButton::Primary, egui::Modifiers::NONE);
        harness.event(egui::Event::PointerButton { pos: at, button, pressed, modifiers });
        harness.run();
    }
    assert!(harness.query_by_label("Duplicate").is_none());
    assert_eq!((harness.state().log.len(), selection(&harness)), (before, &both));
}

#[test]
fn below_the_rows_the_menu_is_that_of_the_view() {
    let mut harness = harness("apple.ron", object("apple"));
    right_click(&mut harness, "canvas, background");
    for row in ["Add", "Select all", "Frame all", "View from above", "Parallel view"] {
        assert!(harness.query_by_label(row).is_some(), "{row}");
    }
    click(&mut harness, "Add");
    click(&mut harness, "Lamp");
    assert_eq!(harness.state().log.last().map(String::as_str), Some("Add lamp"));
}

#[test]
fn a_control_of_a_folded_section_is_unfolded_scrolled_to_and_focused() {
    let mut column = Column::open("still_life.ron");
    column.document.select(region("apple").into_iter().collect());
    let mut harness = harness_of(column, Theme::Dark, SIZE);
    assert!(harness.query_by_label("Seed").is_none(), "its section is folded at first");
    let control = Control { name: "Seed".to_owned(), section: "Advanced".to_owned() };
    harness.state_mut().reach = Some(control);
    harness.run();
    harness.run();
    let seed = harness.get_by_label("Seed");
    assert!(seed.accesskit_node().is_focused());
    assert!(seed.rect().bottom() < SIZE.y && seed.rect().top() > 252.0, "{:?}", seed.rect());
    // Two controls have this name: the one in the given section gets the focus.
    let control = Control { name: "Coverage".to_owned(), section: "Strokes over time".to_owned() };
    harness.state_mut().reach = Some(control);
    harness.run();
    harness.run();
    let both: Vec<bool> =
        harness.get_all_by_label("Coverage").map(|node| node.accesskit_node().is_focused()).collect();
    assert_eq!(both, [false, true]);
}
