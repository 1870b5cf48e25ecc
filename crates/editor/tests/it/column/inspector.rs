//! Tests of the inspector for each kind of item.

use egui::{Key, Modifiers, Role, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use impasto_editor_model::session::Mode;
use impasto_editor_model::{Item, Selection};
use impasto_scene::document::{Direction, Ease, Seam, Sense};

use super::{Column, click, drag, harness, object, pick, region, type_in, with_guides};

/// Turns the wheel over a field by `by` lines, up where positive.
pub fn turn_the_wheel(harness: &mut Harness<'_, Column>, name: &str, by: f32, modifiers: Modifiers) {
    harness.hover_at(harness.get_by_role_and_label(Role::SpinButton, name).rect().center());
    harness.run();
    let event = egui::Event::MouseWheel {
        unit: egui::MouseWheelUnit::Line,
        delta: vec2(0.0, by),
        phase: egui::TouchPhase::Move,
        source: egui::MouseWheelSource::Unknown,
        modifiers,
    };
    harness.event(egui::Event::ModifiersChanged(modifiers));
    harness.event(event);
    harness.run_steps(12);
    harness.event(egui::Event::ModifiersChanged(Modifiers::NONE));
    harness.run();
}

#[test]
fn the_wheel_scrolls_the_column_and_steps_only_a_field_with_the_focus_or_with_ctrl() {
    let mut column = Column::open("still_life.ron");
    column.document.select(region("apple").into_iter().collect());
    let mut harness = super::harness_of(column, impasto_editor::theme::Theme::Dark, super::SIZE);
    let top = |harness: &Harness<'_, Column>| {
        harness.get_by_role_and_label(Role::SpinButton, "Length").rect().top()
    };
    let length = |harness: &Harness<'_, Column>| harness.state().region("apple").strokes.length_px;
    let before = (top(&harness), length(&harness));
    turn_the_wheel(&mut harness, "Length", -1.0, Modifiers::NONE);
    assert!(top(&harness) < before.0 - 10.0, "the wheel does not scroll the column");
    assert_eq!((length(&harness), harness.state().log.len()), (before.1, 0));

    turn_the_wheel(&mut harness, "Length", 1.0, Modifiers::COMMAND);
    let by_ctrl = length(&harness).expect("a step");
    assert_eq!(harness.state().log, ["merged Length 73 px"]);
    harness.get_by_role_and_label(Role::SpinButton, "Length").focus();
    harness.run();
    let place = top(&harness);
    turn_the_wheel(&mut harness, "Length", 1.0, Modifiers::NONE);
    assert!(length(&harness).expect("a step") > by_ctrl);
    assert_eq!(top(&harness), place, "the wheel steps the number and scrolls too");
}

#[test]
fn a_drag_on_length_previews_and_is_one_entry() {
    let mut harness = harness("still_life.ron", region("apple"));
    drag(&mut harness, "Length", 40.0);
    let column = harness.state();
    let log = &column.log;
    assert!(log.iter().filter(|words| *words == "preview").count() >= 2, "{log:?}");
    assert_eq!(column.document.undo_count(), 1, "{log:?}");
    // A drag across the whole width of the field covers its range of 156.
    let wide = harness.get_by_label("Length").rect().width();
    let wanted = (72.0_f64 + 40.0 * 156.0 / f64::from(wide)).round();
    assert_eq!(column.region("apple").strokes.length_px, Some(wanted));
    assert_eq!(column.document.undo_text(), Some(format!("Length {wanted} px").as_str()));
    assert!(
        std::sync::Arc::ptr_eq(column.document.shown(), column.document.loaded()),
        "the preview is still shown"
    );
}

#[test]
fn a_drag_that_goes_back_leaves_nothing() {
    let mut harness = harness("still_life.ron", region("apple"));
    let middle = harness.get_by_label("Length").rect().center();
    harness.drag_at(middle);
    harness.run();
    harness.hover_at(middle + vec2(30.0, 0.0));
    harness.run();
    assert_ne!(harness.state().document.shown().scene.regions, harness.state().document.scene().regions);
    harness.key_press(Key::Escape);
    harness.run();
    harness.drop_at(middle + vec2(30.0, 0.0));
    harness.run();
    let column = harness.state();
    assert_eq!(column.document.undo_count(), 0, "{:?}", column.log);
    assert_eq!(column.log.last().map(String::as_str), Some("end preview"));
    assert_eq!(column.document.shown().scene, *column.document.scene());
}

#[test]
fn steps_of_a_number_are_one_entry_and_reset_brings_the_scene_back() {
    let mut harness = harness("still_life.ron", region("apple"));
    harness.get_by_label("Width").focus();
    harness.run();
    for _ in 0..3 {
        harness.key_press(Key::ArrowRight);
        harness.run();
    }
    assert_eq!(harness.state().region("apple").strokes.width_px, Some(20.0));
    assert_eq!(harness.state().document.undo_count(), 1);
    click(&mut harness, "Reset Width");
    assert_eq!(harness.state().region("apple").strokes.width_px, None);
    assert_eq!(harness.state().document.undo_text(), Some("Reset width"));
    assert!(harness.query_by_label("Reset Width").is_none());
}

#[test]
fn typing_may_go_beyond_a_drag_and_what_cannot_be_is_marked() {
    let mut harness = harness("still_life.ron", region("apple"));
    type_in(&mut harness, "Length", "300 px");
    assert_eq!(harness.state().region("apple").strokes.length_px, Some(300.0));
    type_in(&mut harness, "Length", "99999");
    assert_eq!(harness.state().region("apple").strokes.length_px, Some(300.0));
    assert!(harness.query_by_label_contains("to 4096").is_some(), "the range is not shown");
}

#[test]
fn every_base_direction_can_be_chosen_and_set() {
    let mut harness = harness("apple.ron", region("apple"));
    let direction = |harness: &Harness<'_, Column>| harness.state().region("apple").direction.clone();
    pick(&mut harness, "Base direction", "Angle");
    type_in(&mut harness, "Base angle", "35");
    assert_eq!(direction(&harness), Direction::Angle(35.0));
    pick(&mut harness, "Base direction", "Crossing");
    type_in(&mut harness, "Second angle", "20");
    assert_eq!(direction(&harness), Direction::Crossing(-45.0, 20.0));
    pick(&mut harness, "Base direction", "Around");
    type_in(&mut harness, "Axis X", "0.5");
    assert_eq!(direction(&harness), Direction::Around([0.5, 1.0, 0.0]));
    pick(&mut harness, "Base direction", "Toward");
    type_in(&mut harness, "Point Z", "\u{2212}1,25");
    assert_eq!(direction(&harness), Direction::Toward([0.0, 0.0, -1.25]));
    pick(&mut harness, "Base direction", "Curvature");
    click(&mut harness, "Bend most");
    assert_eq!(direction(&harness), Direction::Curvature(impasto_scene::document::Bend::Max));
    pick(&mut harness, "Base direction", "Automatic");
    assert_eq!(direction(&harness), Direction::Auto);
    click(&mut harness, "Sense arrows");
    click(&mut harness, "Seam soft");
    type_in(&mut harness, "Seam distance", "0.25");
    type_in(&mut harness, "Turn", "30");
    let region = harness.state().region("apple");
    assert_eq!((region.sense, region.seam, region.turn_deg), (Sense::Arrows, Seam::Soft(0.25), 30.0));
    click(&mut harness, "Reset Turn");
    assert_eq!(harness.state().region("apple").turn_deg, 0.0);
}

#[test]
fn brushes_are_picked_and_mixed() {
    let mut harness = harness("apple.ron", region("apple"));
    click(&mut harness, "Brush knife");
    let brush = |harness: &Harness<'_, Column>| {
        harness.state().region("apple").strokes.brush.clone().map(|mix| mix.0)
    };
    assert_eq!(brush(&harness), Some(vec!["knife".to_owned()]));
    harness.get_by_label("Brush dry").click_modifiers(Modifiers::COMMAND);
    harness.run();
    assert_eq!(brush(&harness), Some(vec!["knife".to_owned(), "dry".to_owned()]));
    assert!(harness.query_by_label("Mixed: knife 1, dry 1").is_some());
    click(&mut harness, "Reset Brush");
    assert_eq!(brush(&harness), None);
}

#[test]
fn strokes_are_copied_from_one_region_to_another() {
    let mut harness = harness("still_life.ron", region("jug rim"));
    click(&mut harness, "Advanced");
    click(&mut harness, "Copy strokes");
    click(&mut harness, "lemon, region");
    click(&mut harness, "Paste strokes");
    let column = harness.state();
    assert_eq!(column.region("lemon").strokes, column.region("jug rim").strokes);
    assert_eq!(column.document.undo_text(), Some("Paste strokes to lemon"));
}

#[test]
fn fields_shift_the_motion_in_arrange_and_key_it_in_animate() {
    let mut harness = harness("still_life.ron", object("apple"));
    let keys = |harness: &Harness<'_, Column>| {
        let mut objects = harness.state().document.scene().objects.iter();
        objects.find(|object| object.name == "apple").map(|object| object.keys.clone()).unwrap_or_default()
    };
    let before = keys(&harness);
    type_in(&mut harness, "Move X", "1.33");
    let after = keys(&harness);
    assert!(before.iter().zip(&after).all(|(a, b)| (b.translation[0] - a.translation[0] - 1.0).abs() < 1e-9));
    harness.state_mut().session.mode = Mode::Animate;
    harness.state_mut().session.frame = 41.0;
    harness.run();
    type_in(&mut harness, "Turn Z", "12");
    assert_eq!(keys(&harness).len(), before.len() + 1);
    assert_eq!(harness.get_by_label("Key frame").accesskit_node().value().as_deref(), Some("41"));
    let ease = |harness: &Harness<'_, Column>| {
        let key = keys(harness).into_iter().find(|key| key.frame == 41.0);
        key.map(|key| key.ease).expect("the key is there")
    };
    for (name, chosen) in [("Ease in", Ease::In), ("Ease out", Ease::Out), ("Ease bounce", Ease::Bounce)] {
        click(&mut harness, name);
        assert_eq!(ease(&harness), chosen);
    }
    click(&mut harness, "Ease curve");
    assert_eq!(ease(&harness), Ease::USUAL_CURVE);
    harness.state_mut().document.undo();
    assert_eq!(ease(&harness), Ease::Bounce);
    click(&mut harness, "Ease hold");
    type_in(&mut harness, "Key frame", "42");
    let moved = keys(&harness).into_iter().find(|key| key.frame == 42.0).expect("the key has moved");
    assert_eq!((moved.rotation_deg[2], moved.ease), (12.0, Ease::Step));
    assert_eq!(harness.state().session.frame, 42.0);
    // A step of the wheel takes the frame along too, so that the key stays in sight.
    turn_the_wheel(&mut harness, "Key frame", 1.0, Modifiers::COMMAND);
    assert_eq!(harness.state().session.frame, 43.0);
    assert!(keys(&harness).iter().any(|key| key.frame == 43.0));
    let field = harness.get_by_role_and_label(Role::SpinButton, "Key frame");
    assert_eq!(field.accesskit_node().value().as_deref(), Some("43"));
}

fn double_click(harness: &mut Harness<'_, Column>, name: &str) {
    // The test's clock moves in large steps, so the delay has to be long.
    harness.ctx.options_mut(|options| options.input_options.max_double_click_delay = 2.0);
    // Waits, so that these clicks and earlier ones do not make a triple click.
    harness.run_steps(20);
    let middle = harness.get_by_role_and_label(Role::SpinButton, name).rect().center();
    for _ in 0..2 {
        harness.drag_at(middle);
        harness.step();
        harness.drop_at(middle);
        harness.step();
        harness.step();
    }
}

#[test]
fn a_double_click_resets_a_pose_and_selects_the_whole_of_a_number_without_a_default() {
    let mut harness = harness("still_life.ron", object("apple"));
    let place = |harness: &Harness<'_, Column>| {
        let mut objects = harness.state().document.scene().objects.iter();
        objects.find(|object| object.name == "apple").expect("it is there").keys[0].translation[1]
    };
    assert!(place(&harness) != 0.0);
    double_click(&mut harness, "Move Y");
    harness.run();
    assert!(harness.query_by_role_and_label(Role::TextInput, "Move Y").is_none(), "the field waits for text");
    assert!(place(&harness).abs() < 1e-9, "{}", place(&harness));
    harness.state_mut().document.select(Selection::only(Item::Camera));
    harness.run();
    double_click(&mut harness, "Eye X");
    harness.event(egui::Event::Text("7".to_owned()));
    harness.run();
    harness.key_press(Key::Enter);
    harness.run();
    assert_eq!(harness.state().document.scene().camera.keys[0].eye[0], 7.0, "the old number is still there");
}

#[test]
fn guides_are_listed_selected_set_reordered_and_deleted() {
    let mut harness = harness("apple.ron", region("apple"));
    with_guides(harness.state_mut());
    harness.run();
    assert!(harness.query_by_label("apple, region, 2 guides").is_some());
    click(&mut harness, "Guides");
    click(&mut harness, "Guide g2");
    assert_eq!(harness.state().document.selection(), &Selection::only(Item::Guide("apple".to_owned(), 1)));
    type_in(&mut harness, "Guide radius", "0.35");
    click(&mut harness, "Reset Guide strength");
    click(&mut harness, "Guide up");
    let guides = &harness.state().region("apple").guides;
    assert_eq!((guides[0].points.len(), guides[0].radius, guides[0].strength), (5, 0.35, 1.0));
    click(&mut harness, "Delete guide");
    let guides = &harness.state().region("apple").guides;
    assert_eq!(guides.iter().map(|guide| guide.points.len()).collect::<Vec<_>>(), [9]);
}

#[test]
fn noise_of_a_material_is_set_and_reset() {
    let mut harness = harness("still_life.ron", object("apple"));
    let noise = |harness: &Harness<'_, Column>| {
        let objects = &harness.state().document.scene().objects;
        let apple = objects.iter().find(|object| object.name == "apple").expect("it is there");
        apple.material.as_ref().and_then(|material| material.noise_displace.clone())
    };
    assert_eq!(noise(&harness), None);
    click(&mut harness, "Noise");
    // Until a part of the noise is chosen, nothing moves and the texture stays.
    assert_eq!(noise(&harness).map(|noise| (noise.vertex, noise.surface)), Some((None, None)));
    click(&mut harness, "Noise moves the vertices");
    click(&mut harness, "Noise colours the surface");
    assert_eq!(noise(&harness), Some(Default::default()));
    click(&mut harness, "Browse for Surface noise file");
    assert_eq!(harness.state().log.last().map(String::as_str), Some("choose the noise of apple"));
    type_in(&mut harness, "Noise scale", "0.3");
    type_in(&mut harness, "Noise rate Y", "0.75");
    type_in(&mut harness, "Noise layers", "9");
    type_in(&mut harness, "Noise intensity", "2.5");
    pick(&mut harness, "Noise along", "Normals");
    pick(&mut harness, "Noise mix", "Mean");
    click(&mut harness, "Noise comes back");
    type_in(&mut harness, "Noise period", "1.5");
    let now = noise(&harness).expect("it is on");
    let (vertex, surface) = (now.vertex.clone().expect("moves"), now.surface.clone().expect("colours"));
    assert_eq!((vertex.scale, vertex.value, now.period_secs), (0.3, [0.1, 0.75], Some(1.5)));
    assert_eq!((surface.layer_count, surface.intensity), (9, 2.5));
    assert_eq!(vertex.along, impasto_scene::document::NoiseAlong::Normal);
    assert_eq!(surface.mix, impasto_scene::document::NoiseMix::Mean);
    type_in(&mut harness, "Noise layers", "900");
    assert_eq!(noise(&harness).and_then(|noise| noise.surface).map(|surface| surface.layer_count), Some(9));
    harness.key_press(Key::Escape);
    harness.run();
    click(&mut harness, "Reset Noise scale");
    assert_eq!(noise(&harness).and_then(|noise| noise.vertex).map(|vertex| vertex.scale), Some(0.1));
    click(&mut harness, "Noise colours the surface");
    assert_eq!(noise(&harness).map(|noise| noise.surface), Some(None));
    assert!(harness.query_by_label("Noise layers").is_none());
    click(&mut harness, "Noise");
    assert_eq!(noise(&harness), None);
}
