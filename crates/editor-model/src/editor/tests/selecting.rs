//! Tests of what is selected, shown and hidden, and of what the pointer leaves behind.

use super::*;

fn objects(editor: &Editor) -> Vec<String> {
    editor.document().scene().objects.iter().map(|object| object.name.clone()).collect()
}

#[test]
fn a_second_toggle_takes_the_active_thing_away_and_one_of_another_makes_that_active() {
    let item = |name: &str| Item::Object(name.to_owned());
    let mut selection = Selection::only(item("a"));
    selection.toggle(item("b"));
    assert_eq!((selection.active(), selection.objects().count()), (Some(&item("b")), 2));
    // What is selected but not active becomes active.
    selection.toggle(item("a"));
    assert_eq!((selection.active(), selection.objects().count()), (Some(&item("a")), 2));
    selection.toggle(item("a"));
    assert_eq!((selection.active(), selection.objects().count()), (Some(&item("b")), 1));
}

#[test]
fn the_ring_goes_when_the_pointer_leaves_the_picture_but_not_during_a_drag() {
    let mut editor = with_apple();
    act(&mut editor, Action::Paint);
    let at = middle_of_the_apple(&editor);
    event(&mut editor, PointerKind::Move, at, HERE);
    assert!(!editor.tool_output().rings.is_empty());
    event(&mut editor, PointerKind::Leave, at, HERE);
    assert!(editor.tool_output().rings.is_empty());
    event(&mut editor, PointerKind::Move, at, HERE);
    event(&mut editor, PointerKind::Press(Button::Left), at, HERE);
    event(&mut editor, PointerKind::Move, at + DVec2::new(30.0, 0.0), HERE);
    event(&mut editor, PointerKind::Leave, at, HERE);
    assert!(!editor.tool_output().rings.is_empty());
}

#[test]
fn show_all_shows_what_is_hidden_and_makes_no_entry_where_nothing_is() {
    let mut editor = with_apple();
    let count = editor.document().undo_count();
    act(&mut editor, Action::ShowAll);
    assert_eq!(editor.document().undo_count(), count);
    let items: Vec<Item> = objects(&editor).into_iter().map(Item::Object).collect();
    assert!(editor.run(&Command::Edit(Edit::SetHidden(items, true))));
    act(&mut editor, Action::ShowAll);
    assert!(editor.document().scene().objects.iter().all(|object| !object.hidden));
}
