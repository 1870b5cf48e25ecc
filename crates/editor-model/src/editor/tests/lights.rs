//! Tests of lights under the pointer: picking, dragging and turning them.

use glam::DVec3;
use impasto_scene::document::Light;

use super::*;

/// An editor in Arrange with a lamp beside the apple and nothing selected. No painting is prepared.
fn with_lamp() -> Editor {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/apple.ron");
    let mut editor =
        Editor::new(Document::open(&path, &LoadOptions::default()).expect("a shipped scene opens"));
    act(&mut editor, Action::Arrange);
    let at = DVec3::new(-0.8, 0.9, 0.4);
    let lamp = Arrange::AddLight { kind: LightKind::Point, at, toward: DVec3::ZERO };
    assert!(editor.run(&Command::Arrange(lamp)));
    editor.select(Selection::default());
    editor
}

fn light<'a>(editor: &'a Editor, name: &str) -> &'a Light {
    editor.document().scene().lights.iter().find(|light| light.name == name).expect("it is there")
}

fn icon(editor: &Editor, name: &str) -> DVec2 {
    let places = editor.light_places();
    let place = places.iter().find(|place| place.light.name == name).expect("it has a place");
    view(editor).project(place.position).expect("it shows")
}

fn selected(editor: &Editor) -> Option<&str> {
    match editor.document().selection().active() {
        Some(Item::Light(name)) => Some(name),
        _ => None,
    }
}

#[test]
fn a_click_on_an_icon_selects_its_light_and_one_beside_it_does_not() {
    let mut editor = with_lamp();
    let at_px = icon(&editor, "lamp");
    click(&mut editor, at_px + DVec2::new(0.0, 30.0));
    assert_eq!(selected(&editor), None);
    click(&mut editor, at_px + DVec2::new(5.0, -8.0));
    assert_eq!(selected(&editor), Some("lamp"));
    assert!(editor.gizmo(&view(&editor)).is_some_and(|gizmo| !gizmo.handles().is_empty()));
    assert!(editor.status().starts_with("[Drag] move lamp "), "{}", editor.status());
}

#[test]
fn a_drag_moves_a_lamp_across_the_gaze_and_is_one_entry() {
    let mut editor = with_lamp();
    let before = light(&editor, "lamp").clone();
    let from_px = icon(&editor, "lamp");
    let to_px = from_px + DVec2::new(60.0, 45.0);
    drag(&mut editor, Button::Left, [from_px, to_px], Modifiers::default());
    let gone = icon(&editor, "lamp").distance(to_px);
    assert!(gone < 0.5, "the icon is {gone} px beside the pointer");
    let [was, is] = [&before, light(&editor, "lamp")].map(|light| DVec3::from(light.position.unwrap()));
    let view = view(&editor);
    assert!((view.depth(is) - view.depth(was)).abs() < 1e-4, "{was} {is}");
    act(&mut editor, Action::Undo);
    assert_eq!(*light(&editor, "lamp"), before);
}

#[test]
fn a_suns_icon_is_dragged_round_the_scene() {
    let mut editor = with_lamp();
    editor.looking.free(&editor.shot()).zoom(-6.0, DVec3::ZERO);
    let before = light(&editor, "window").clone();
    editor.select(Selection::only(Item::Light("window".to_owned())));
    let from_px = icon(&editor, "window");
    drag(&mut editor, Button::Left, [from_px, from_px + DVec2::new(80.0, 20.0)], Modifiers::default());
    let after = light(&editor, "window").clone();
    let [was, is] = [&before, &after].map(|light| DVec3::from(light.direction.unwrap()).normalize());
    assert!(was.angle_between(is).to_degrees() > 3.0, "{was} {is}");
    let right = view(&editor).axes()[0];
    assert!(is.dot(right) < was.dot(right), "dragged right, it shines no farther to the left");
    assert_eq!(Light { direction: before.direction, ..after }, before, "more than the direction changed");
}

#[test]
fn impossible_operations_on_a_light_are_refused_with_a_message() {
    let mut editor = with_lamp();
    for (name, action, words) in [
        ("lamp", Action::Scale, "A light has no size: its intensity is in the inspector"),
        ("lamp", Action::Turn, "A lamp shines all round: it can only be moved"),
        ("room", Action::Move, "A sky comes from all around: it has no place"),
    ] {
        editor.select(Selection::only(Item::Light(name.to_owned())));
        event(&mut editor, PointerKind::Move, DVec2::new(400.0, 300.0), Modifiers::default());
        editor.take_said();
        act(&mut editor, action);
        assert_eq!(editor.take_said().iter().map(|said| said.words.as_str()).collect::<Vec<_>>(), [words]);
        assert!(!editor.is_moving());
    }
    editor.select(Selection::only(Item::Light("room".to_owned())));
    assert!(editor.gizmo(&view(&editor)).is_none());
}

#[test]
fn icons_show_in_arrange_only() {
    let mut editor = with_lamp();
    let at_px = icon(&editor, "lamp");
    act(&mut editor, Action::Animate);
    assert!(editor.light_places().is_empty());
    click(&mut editor, at_px);
    assert_eq!(selected(&editor), None);
    editor.select(Selection::only(Item::Light("lamp".to_owned())));
    assert!(editor.gizmo(&view(&editor)).is_none());
}

#[test]
fn a_sun_turns_about_an_axis() {
    let mut editor = with_lamp();
    let before = DVec3::from(light(&editor, "window").direction.unwrap()).normalize();
    editor.select(Selection::only(Item::Light("window".to_owned())));
    event(&mut editor, PointerKind::Move, DVec2::new(400.0, 300.0), Modifiers::default());
    act(&mut editor, Action::Turn);
    for typed in [Key::Letter('Y'), Key::Digit(9), Key::Digit(0), Key::Enter] {
        key(&mut editor, typed);
    }
    let after = DVec3::from(light(&editor, "window").direction.unwrap());
    let wanted = glam::DQuat::from_rotation_y(std::f64::consts::FRAC_PI_2) * before;
    assert!(after.distance(wanted) < 1e-5, "{after}, not {wanted}");
}

#[test]
fn the_tool_adds_a_light_of_the_kind_that_is_chosen() {
    for kind in [LightKind::Sun, LightKind::Point, LightKind::Ambient] {
        let mut editor = with_lamp();
        let count = editor.document().scene().lights.len();
        editor.session.options.light = kind;
        editor.session.set_tool(Tool::AddLight);
        click(&mut editor, DVec2::new(200.0, 120.0));
        let lights = &editor.document().scene().lights;
        assert_eq!((lights.len(), lights[count].kind), (count + 1, kind));
    }
}
