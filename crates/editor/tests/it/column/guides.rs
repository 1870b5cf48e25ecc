//! Tests of the list of guides and of the other facts that a region's inspector shows.

use egui_kittest::kittest::{NodeT as _, Queryable as _};
use impasto_editor_model::command::{Amounts, Command, RegionTarget, Touches};
use impasto_editor_model::keymap::{CommandId, Keymap};
use impasto_editor_model::session::Mode;
use impasto_scene::document::{Amount, AmountDab, Color, Touch, TouchPoint};

use super::{Column, click, harness, region, type_in, with_guides};

fn description(harness: &egui_kittest::Harness<'_, Column>, name: &str) -> Option<String> {
    harness.get_by_label(name).accesskit_node().description()
}

#[test]
fn a_curve_is_told_from_a_comb_and_a_drag_changes_the_order() {
    let mut harness = harness("apple.ron", region("apple"));
    with_guides(harness.state_mut());
    harness.run();
    if harness.query_by_label("Guide g1").is_none() {
        click(&mut harness, "Guides");
    }
    assert_eq!(description(&harness, "Guide g1").as_deref(), Some("comb, 9 points"));
    assert_eq!(description(&harness, "Guide g2").as_deref(), Some("curve, 5 points"));

    let [first, second] = ["Guide g1", "Guide g2"].map(|name| harness.get_by_label(name).rect().center());
    let down = egui::vec2(0.0, 6.0);
    harness.drag_at(first);
    harness.run();
    for at in [first + down, second, second + down] {
        harness.hover_at(at);
        harness.run();
    }
    harness.drop_at(second + down);
    harness.run();
    assert_eq!(description(&harness, "Guide g1").as_deref(), Some("curve, 5 points"));
    let guides = &harness.state().region("apple").guides;
    assert_eq!(guides.iter().map(|guide| guide.points.len()).collect::<Vec<_>>(), [5, 9]);
    assert!(guides[0].curve && !guides[1].curve);

    // A drag to the same place leaves nothing to undo.
    let count = harness.state().document.undo_count();
    harness.drag_at(first);
    harness.run();
    harness.hover_at(first + down);
    harness.run();
    harness.drop_at(first + down);
    harness.run();
    assert_eq!(harness.state().document.undo_count(), count);
}

#[test]
fn notes_name_the_keys_that_are_in_use() {
    let mut harness = harness("still_life.ron", region("lemon"));
    harness.state_mut().session.mode = Mode::Paint;
    harness.run();
    for section in ["Guides", "Painted amounts"] {
        click(&mut harness, section);
    }
    let curve = CommandId::named("Guide curve").expect("a command");
    let says = |harness: &mut egui_kittest::Harness<'_, Column>, words: &str| {
        harness.run();
        harness.query_by_label(words).is_some()
    };
    assert!(says(&mut harness, "No guides. Comb over the region, or draw a curve (V)."));
    assert!(says(&mut harness, "Nothing is painted. Paint width, length, density or flatness (P)."));
    harness.state_mut().keymap = Keymap::default().with(curve, vec!["Ctrl 7".parse().expect("a key")]);
    assert!(says(&mut harness, "No guides. Comb over the region, or draw a curve (Ctrl 7)."));
    harness.state_mut().keymap = Keymap::default().with(curve, Vec::new());
    assert!(says(&mut harness, "No guides. Comb over the region, or draw a curve."));
}

#[test]
fn a_region_tells_how_many_strokes_show() {
    let mut harness = harness("apple.ron", region("apple"));
    assert_eq!(description(&harness, "Strokes"), None, "before the first picture");
    harness.state_mut().strokes_of = vec![("apple stem".to_owned(), 12), ("apple".to_owned(), 1312)];
    harness.run();
    assert_eq!(description(&harness, "Strokes").as_deref(), Some("1,312 shown"));
}

#[test]
fn recapture_asks_first() {
    let mut harness = harness("apple.ron", None);
    harness.state_mut().session.frame = 12.0;
    harness.run();
    if harness.query_by_label("Recapture").is_none() {
        click(&mut harness, "Reference");
    }
    let before = harness.state().document.scene().reference.clone();
    click(&mut harness, "Recapture");
    assert_eq!(harness.state().log.last().map(String::as_str), Some("ask about frame 12"));
    assert_eq!(harness.state().document.scene().reference, before);
}

#[test]
fn a_number_out_of_range_is_marked_where_it_is_typed() {
    let mut harness = harness("apple.ron", region("apple"));
    let count = harness.state().document.undo_count();
    type_in(&mut harness, "Length", "9000");
    assert!(harness.query_by_label_contains("to 4096").is_some(), "what may be typed");
    assert_eq!(harness.state().document.undo_count(), count);
    assert!(harness.state().log.iter().all(|ask| !ask.starts_with("refused")), "{:?}", harness.state().log);
    harness.key_press(egui::Key::Escape);
    harness.run();
    type_in(&mut harness, "Length", "90");
    assert!(harness.query_by_label_contains("to 4096").is_none());
    assert_eq!(harness.state().region("apple").strokes.length_px, Some(90.0));
}

#[test]
fn painted_amounts_are_listed_and_cleared() {
    let mut harness = harness("apple.ron", region("apple"));
    assert!(harness.query_by_label("Clear width").is_none());
    let dab = AmountDab { at: [0.0, 0.5, 0.5], normal: [0.0, 0.0, 1.0], radius: 0.2, by: 2.0 };
    for (of, count) in [(Amount::Width, 3), (Amount::Density, 1)] {
        harness.state_mut().apply(Command::Amounts(Amounts::Paint {
            region: RegionTarget::Named("apple".to_owned()),
            of,
            object: None,
            dabs: vec![dab.clone(); count],
        }));
    }
    harness.run();
    if harness.query_by_label("Clear width").is_none() {
        click(&mut harness, "Painted amounts");
    }
    assert_eq!(description(&harness, "Painted amounts").as_deref(), Some("2"));
    assert!(harness.query_by_label("3 dabs").is_some() && harness.query_by_label("1 dab").is_some());
    click(&mut harness, "Clear width");
    let left = &harness.state().region("apple").amounts;
    assert_eq!(left.iter().map(|amount| amount.of).collect::<Vec<_>>(), [Amount::Density]);
    assert!(harness.query_by_label("Clear all amounts").is_none(), "one is cleared by its own button");
    harness.state_mut().document.undo().expect("one step");
    harness.run();
    click(&mut harness, "Clear all amounts");
    assert!(harness.state().region("apple").amounts.is_empty());
}

#[test]
fn a_touch_is_listed_under_its_object_and_set_in_the_inspector() {
    let mut harness = harness("apple.ron", region("apple"));
    let point = TouchPoint { at: [0.0, 0.5, 0.5], normal: [0.0, 0.0, 1.0] };
    let touch = Touch { color: Some(Color([1.0; 3])), ..Touch::new("glint", "apple", vec![point]) };
    harness.state_mut().apply(Command::Touches(Touches::Lay(vec![touch.clone(), touch])));
    harness.run();
    for name in ["glint, touch", "glint 2, touch"] {
        assert!(harness.query_by_label(name).is_some(), "{name} has no row");
    }
    fn last(harness: &egui_kittest::Harness<'_, Column>) -> Touch {
        harness.state().document.scene().touches[1].clone()
    }
    assert_eq!(last(&harness).name, "glint 2");
    type_in(&mut harness, "Touch width", "22");
    type_in(&mut harness, "Touch length", "90");
    type_in(&mut harness, "Touch taper", "0.5");
    let now = last(&harness);
    assert_eq!((now.width_px, now.length_px, now.taper), (22.0, 90.0, 0.5));
    click(&mut harness, "Reset Touch colour");
    assert_eq!(last(&harness).color, None);
    click(&mut harness, "Hide touch");
    assert!(last(&harness).hidden);
    click(&mut harness, "Delete touch");
    assert_eq!(harness.state().document.scene().touches.len(), 1);
    for _ in 0..6 {
        harness.state_mut().document.undo().expect("each was one step");
    }
    let first = harness.state().document.scene().touches[0].clone();
    assert_eq!(last(&harness), Touch { name: "glint 2".to_owned(), ..first });
}
