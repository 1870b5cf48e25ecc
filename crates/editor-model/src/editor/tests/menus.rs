//! Tests of the right button over the viewport, and of tools that are taken up from menus.

use impasto_scene::new_scene::Ground;

use super::*;
use crate::command::SceneEdit;

fn right_click(editor: &mut Editor, at_px: DVec2) -> Vec<Request> {
    event(editor, PointerKind::Move, at_px, HERE);
    event(editor, PointerKind::Press(Button::Right), at_px, HERE);
    event(editor, PointerKind::Release(Button::Right), at_px, HERE);
    editor.take_requests()
}

#[test]
fn a_right_click_selects_what_is_there_and_asks_for_its_menu() {
    let mut editor = with_apple();
    let at = middle_of_the_apple(&editor);
    let apple = Item::Object("apple".to_owned());
    assert_eq!(right_click(&mut editor, at), [Request::Menu(Some(apple.clone()))]);
    assert_eq!(editor.document().selection(), &Selection::only(apple.clone()));
    // A click on a selected thing leaves the selection as it is: the menu is for everything that is selected.
    let both: Selection = [apple.clone(), Item::Object("wall".to_owned())].into_iter().collect();
    editor.select(both.clone());
    assert_eq!(right_click(&mut editor, at), [Request::Menu(Some(apple))]);
    assert_eq!(editor.document().selection(), &both);
    assert_eq!((editor.document().undo_count(), editor.is_moving()), (0, false));
}

#[test]
fn in_paint_the_menu_is_that_of_the_region() {
    let mut editor = with_apple();
    act(&mut editor, Action::Paint);
    let at = middle_of_the_apple(&editor);
    let requests = right_click(&mut editor, at);
    let [Request::Menu(Some(Item::Region(region)))] = &requests[..] else { panic!("{requests:?}") };
    assert_eq!(editor.document().selection(), &Selection::only(Item::Region(region.clone())));
    assert_eq!(editor.document().undo_count(), 0, "nothing was combed");
}

#[test]
fn a_right_press_that_cancels_or_drags_asks_for_no_menu() {
    let mut editor = with_apple();
    let at = middle_of_the_apple(&editor);
    editor.select(Selection::only(Item::Object("apple".to_owned())));
    event(&mut editor, PointerKind::Move, at, HERE);
    key(&mut editor, Key::Letter('G'));
    assert!(editor.is_moving());
    assert_eq!(right_click(&mut editor, at), [], "the right press only takes the move back");
    assert!(!editor.is_moving());
    drag(&mut editor, Button::Right, [at, at + DVec2::new(60.0, 0.0)], HERE);
    assert_eq!(editor.take_requests(), []);
    // A right press drops the combing under way. The release of the left button then paints nothing.
    act(&mut editor, Action::Paint);
    event(&mut editor, PointerKind::Press(Button::Left), at, HERE);
    event(&mut editor, PointerKind::Move, at + DVec2::new(60.0, 0.0), HERE);
    assert_eq!(right_click(&mut editor, at), []);
    event(&mut editor, PointerKind::Release(Button::Left), at, HERE);
    assert_eq!(editor.document().undo_count(), 0);
}

#[test]
fn a_tool_of_another_mode_brings_its_mode() {
    let mut editor = with_apple();
    act(&mut editor, Action::Animate);
    act(&mut editor, Action::Smooth);
    assert_eq!((editor.session.mode, editor.session.tool()), (Mode::Paint, Tool::Smooth));
    act(&mut editor, Action::Turn);
    assert_eq!((editor.session.mode, editor.session.tool()), (Mode::Animate, Tool::Turn));
    act(&mut editor, Action::Arrange);
    act(&mut editor, Action::Scale);
    assert_eq!((editor.session.mode, editor.session.tool()), (Mode::Arrange, Tool::Scale));
}

#[test]
fn delete_takes_the_point_under_the_pointer_and_elsewhere_the_whole_guide() {
    let mut editor = with_apple();
    act(&mut editor, Action::Paint);
    act(&mut editor, Action::GuideCurve);
    let middle = middle_of_the_apple(&editor);
    let before: usize = editor.document().scene().regions.iter().map(|region| region.guides.len()).sum();
    for step in 0..3 {
        let at = middle + DVec2::new(30.0 * f64::from(step), 0.0);
        event(&mut editor, PointerKind::Move, at, HERE);
        event(&mut editor, PointerKind::Press(Button::Left), at, HERE);
        event(&mut editor, PointerKind::Release(Button::Left), at, HERE);
    }
    act(&mut editor, Action::Confirm);
    let Some(Item::Guide(region, index)) = editor.document().selection().active().cloned() else {
        panic!("the new curve is selected");
    };
    let guides = |editor: &Editor| {
        let scene = editor.document().scene();
        let of_region = scene.regions.iter().find(|other| other.name == region).expect("the region is there");
        of_region.guides.clone()
    };
    let points = guides(&editor)[index].points.len();
    event(&mut editor, PointerKind::Move, middle + DVec2::new(60.0, 0.0), HERE);
    act(&mut editor, Action::Delete);
    assert_eq!(guides(&editor)[index].points.len(), points - 1);
    // When Delete comes from a menu, the pointer has left the viewport. It deletes the selection, though the pointer
    // was last over a point.
    event(&mut editor, PointerKind::Move, middle, HERE);
    event(&mut editor, PointerKind::Leave, middle, HERE);
    act(&mut editor, Action::Delete);
    let after: usize = editor.document().scene().regions.iter().map(|region| region.guides.len()).sum();
    assert_eq!(after, before, "the curve that is selected went");
}

#[test]
fn the_hint_of_the_ground_promises_no_drag() {
    let mut editor = with_apple();
    act(&mut editor, Action::Arrange);
    assert!(editor.run(&Command::Scene(SceneEdit::SetGround(Ground::Vignette))));
    for object in editor.document().scene().objects.clone() {
        editor.select(Selection::only(Item::Object(object.name.clone())));
        let is_ground = Ground::of_object(&object).is_some();
        assert_eq!(editor.status().contains("[Drag]"), !is_ground, "{}: {}", object.name, editor.status());
    }
    assert_eq!(Ground::of_scene(editor.document().scene()), Ground::Vignette);
}
