//! Tests of the controls: what they do, and how they look. Controls are found by name.

use crate::headless::Headless;
use crate::page::Page;
use egui::{Key, Role, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use egui_kittest::{Harness, SnapshotOptions, SnapshotResults, try_image_snapshot_options};
use impasto_editor::theme::{self, Theme};
use impasto_editor::widgets::Toast;
use impasto_editor::window::FocusRules;
use impasto_gl_render::context::Driver;

fn harness(theme: Theme) -> Harness<'static, Page> {
    Harness::builder()
        .with_size(vec2(1280.0, 800.0))
        .with_render_cursor(false)
        .with_theme(if theme == Theme::Dark { egui::Theme::Dark } else { egui::Theme::Light })
        .with_context_setup(move |ctx| {
            ctx.add_plugin(FocusRules);
            theme::apply(ctx, theme, 1.0);
        })
        .renderer(Headless::open(Driver::Auto))
        .build_ui_state(|ui, page: &mut Page| page.ui(ui), Page::new(theme))
}

/// A tolerance for drivers that round colours differently. A misplaced or recoloured control exceeds it by far.
fn options() -> SnapshotOptions {
    SnapshotOptions::new().threshold(0.6)
}

/// Compares the left and the right half of the page separately, so that no stored picture is large.
fn halves(harness: &mut Harness<'_, Page>, name: &str, results: &mut SnapshotResults) {
    let page = harness.render().expect("it renders");
    let (width, height) = (page.width() / 2, page.height());
    for (half, left) in [("left", 0), ("right", width)] {
        let half_page = image::imageops::crop_imm(&page, left, 0, width, height).to_image();
        results.add(try_image_snapshot_options(&half_page, format!("{name}_{half}"), &options()));
    }
}

#[test]
fn the_page_looks_as_it_did() {
    let mut results = SnapshotResults::new();
    for (theme, name) in [(Theme::Dark, "widgets_dark"), (Theme::Light, "widgets_light")] {
        let mut harness = harness(theme);
        harness.run();
        halves(&mut harness, name, &mut results);
    }
    results.unwrap();
}

#[test]
fn a_question_and_toasts_look_as_they_did() {
    let mut harness = harness(Theme::Dark);
    harness.state_mut().toasts = vec![
        Toast { words: "Saved still_life.ron".to_owned(), action: String::new(), error: false },
        Toast {
            words: "Deleted region \u{201c}stem\u{201d}".to_owned(),
            action: "Undo".to_owned(),
            error: false,
        },
    ];
    harness.state_mut().asks = true;
    harness.run();
    let mut results = SnapshotResults::new();
    halves(&mut harness, "question_dark", &mut results);
    results.unwrap();
}

#[test]
fn both_drivers_draw_the_same_bytes() {
    let picture = |driver| {
        let mut harness = Harness::builder()
            .with_size(vec2(1280.0, 800.0))
            .with_context_setup(|ctx| theme::apply(ctx, Theme::Dark, 1.0))
            .renderer(Headless::open(driver))
            .build_ui_state(|ui, page: &mut Page| page.ui(ui), Page::new(Theme::Dark));
        harness.run();
        harness.render().expect("a picture")
    };
    assert!(picture(Driver::Egl) == picture(Driver::Osmesa), "EGL and OSMesa differ");
}

#[test]
fn every_control_has_its_name_and_can_be_hit() {
    let mut harness = harness(Theme::Dark);
    harness.run();
    for name in [
        "File",
        "Undo",
        "Redo",
        "Arrange",
        "Paint",
        "Animate",
        "Find a command",
        "Render",
        "Comb",
        "Guide curve",
        "Pick direction",
        "Along",
        "Against",
        "Brush radius",
        "Brush strength",
        "Mirror X",
        "More tool options",
        "View",
        "Shading",
        "Directions",
        "Compare",
        "Axis ball",
        "Search scene",
        "Expand apple",
        "skin, region, 4 guides",
        "Lock table",
        "Hide skin",
        "Region colour",
        "Direction",
        "Base direction",
        "Base angle",
        "Brush oval",
        "Length",
        "Width",
        "Coverage",
        "Reset Coverage",
        "Guides",
        "Play",
        "Loop",
        "Show keys",
        "Don\u{2019}t show this at start",
        "Dark",
        "Light",
        "Auto key",
    ] {
        let nodes = harness.get_all_by_label(name);
        let controls: Vec<_> = nodes.filter(|node| node.accesskit_node().role() != Role::Label).collect();
        assert!(!controls.is_empty(), "{name} is not there");
        for control in controls {
            let size = control.rect().size();
            assert!(size.x >= 24.0 && size.y >= 24.0, "{name} is {size} points");
        }
    }
}

#[test]
fn a_drag_on_a_number_is_one_step() {
    let mut harness = harness(Theme::Dark);
    harness.run();
    let middle = harness.get_by_label("Length").rect().center();
    harness.drag_at(middle);
    harness.run();
    for step in 1..=4 {
        harness.hover_at(middle + vec2(10.0 * step as f32, 0.0));
        harness.run();
    }
    harness.drop_at(middle + vec2(40.0, 0.0));
    harness.run();
    // A drag over 132 points covers the whole range of 99.
    assert_eq!(harness.state().length_px, 34.0 + 40.0 * 99.0 / 132.0);
    let edits = &harness.state().edits;
    assert_eq!(edits.iter().filter(|edit| **edit == "began").count(), 1, "{edits:?}");
    assert_eq!(edits.iter().filter(|edit| **edit == "ended").count(), 1, "{edits:?}");
    assert_eq!(edits.last(), Some(&"ended"), "{edits:?}");
}

#[test]
fn a_dragged_number_goes_back_on_escape() {
    let mut harness = harness(Theme::Dark);
    harness.run();
    let middle = harness.get_by_label("Length").rect().center();
    harness.drag_at(middle);
    harness.run();
    harness.hover_at(middle + vec2(30.0, 0.0));
    harness.run();
    assert_ne!(harness.state().length_px, 34.0);
    harness.key_press(Key::Escape);
    harness.run();
    harness.hover_at(middle + vec2(60.0, 0.0));
    harness.run();
    harness.drop_at(middle + vec2(60.0, 0.0));
    harness.run();
    assert_eq!(harness.state().length_px, 34.0);
}

#[test]
fn a_number_can_be_typed() {
    let mut harness = harness(Theme::Dark);
    harness.run();
    harness.get_by_label("Length").focus();
    harness.run();
    harness.key_press(Key::Enter);
    harness.run();
    harness.event(egui::Event::Text("62,4 px".to_owned()));
    harness.run();
    harness.key_press(Key::Enter);
    harness.run();
    assert_eq!(harness.state().length_px, 62.0, "no decimals are shown, so none are kept");
    assert_eq!(harness.state().edits, ["began", "changed", "ended"]);
}

#[test]
fn what_is_typed_in_the_pass_of_the_click_is_not_lost() {
    let mut harness = harness(Theme::Dark);
    harness.run();
    let at = harness.get_by_label("Length").rect().center();
    harness.drag_at(at);
    harness.step();
    let release = egui::Event::PointerButton {
        pos: at,
        button: egui::PointerButton::Primary,
        pressed: false,
        modifiers: egui::Modifiers::NONE,
    };
    harness.input_mut().events.extend([release, egui::Event::Text("62".to_owned())]);
    harness.step();
    let typed = harness.get_by_role(Role::TextInput).value();
    assert_eq!(typed.as_deref(), Some("62"));
    harness.key_press(Key::Enter);
    harness.run();
    assert_eq!(harness.state().length_px, 62.0);
}

#[test]
fn what_is_no_number_or_beyond_the_limits_is_marked_and_not_taken() {
    for (typed, mended) in [("four", Key::Escape), ("1000", Key::Escape), ("80", Key::Escape)] {
        let mut harness = harness(Theme::Dark);
        harness.run();
        harness.get_by_label("Length").focus();
        harness.run();
        harness.key_press(Key::Enter);
        harness.run();
        harness.event(egui::Event::Text(typed.to_owned()));
        harness.run();
        let is_wrong = typed != "80";
        assert_eq!(harness.query_by_label_contains("100px").is_some(), is_wrong, "{typed}");
        if is_wrong {
            harness.key_press(Key::Enter);
            harness.run();
            assert!(harness.query_by_role(Role::TextInput).is_some(), "{typed}: gone without a word");
        }
        harness.key_press(mended);
        harness.run();
        assert_eq!(harness.state().length_px, 34.0, "{typed}");
        assert!(harness.query_by_role(Role::TextInput).is_none(), "{typed}: still typing");
    }
}

#[test]
fn a_click_types_and_a_double_click_brings_the_default_back() {
    let mut harness = harness(Theme::Dark);
    harness.run();
    harness.state_mut().coverage = 5.0;
    // The test's clock moves in large steps, so the delay has to be long.
    harness.ctx.options_mut(|options| options.input_options.max_double_click_delay = 2.0);
    harness.run();
    let middle = harness.get_by_label("Coverage").rect().center();
    let click = |harness: &mut Harness<'_, _>| {
        harness.drag_at(middle);
        harness.step();
        harness.drop_at(middle);
        harness.step();
        harness.step();
    };
    click(&mut harness);
    assert!(harness.query_by_role(Role::TextInput).is_some(), "no field to type in");
    click(&mut harness);
    assert!(harness.query_by_role(Role::TextInput).is_none());
    assert_eq!(harness.state().coverage, 2.5, "the default of the page");
}

#[test]
fn arrows_and_readers_step_a_number_and_its_reset_brings_it_back() {
    let mut harness = harness(Theme::Dark);
    harness.run();
    harness.get_by_label("Coverage").focus();
    harness.run();
    harness.key_press(Key::ArrowRight);
    harness.run();
    assert!((harness.state().coverage - 3.1).abs() < 1e-9);
    harness.get_by_label("Reset Coverage").click();
    harness.run();
    assert!((harness.state().coverage - 2.5).abs() < 1e-9);
    assert!(harness.query_by_label("Reset Coverage").is_none());
    assert_eq!(harness.get_by_label("Coverage").accesskit_node().value().as_deref(), Some("2.5\u{d7}"));
}

#[test]
fn an_explanation_is_shown_under_a_wrong_number() {
    let mut harness = harness(Theme::Dark);
    harness.run();
    let before = harness.get_by_label("Coverage").rect().top();
    harness.state_mut().length_px = 4.0;
    harness.run();
    assert_eq!(harness.get_by_label("Coverage").rect().top(), before + 18.0);
}

#[test]
fn groups_switch_by_click_and_by_key() {
    let mut harness = harness(Theme::Dark);
    harness.run();
    harness.get_by_label("Animate").click();
    harness.get_by_label("Against").click();
    harness.get_by_label("Guide curve").click();
    harness.get_by_label("Brush dry").click();
    harness.get_by_label("Trust").click();
    harness.get_by_label("leaf, object").click();
    harness.run();
    let page = harness.state();
    assert_eq!((page.mode, page.sense, page.tool, page.brush, page.selected), (2, 1, 1, 2, 5));
    assert!(page.overlays[1]);
    harness.get_by_label("Arrange").focus();
    harness.run();
    harness.key_press(Key::Space);
    harness.run();
    assert_eq!(harness.state().mode, 0);
}

#[test]
fn a_combo_picks_from_its_menu() {
    let mut harness = harness(Theme::Dark);
    harness.run();
    harness.get_by_label("Base direction").click();
    harness.run();
    harness.get_by_label("Around").click();
    harness.run();
    assert_eq!(harness.state().base, 1);
    assert!(harness.query_by_label("Automatic").is_none(), "the menu has closed");
}

#[test]
fn enter_takes_the_safe_answer_and_escape_cancels() {
    for (key, answer) in [(Key::Enter, 2), (Key::Escape, 1)] {
        let mut harness = harness(Theme::Dark);
        harness.state_mut().asks = true;
        harness.run();
        harness.key_press(key);
        harness.run();
        assert_eq!(harness.state().answer, Some(answer));
    }
}

#[test]
fn a_toast_is_answered_by_its_verb() {
    let mut harness = harness(Theme::Dark);
    let toast = |words: &str| Toast { words: words.to_owned(), action: "Undo".to_owned(), error: false };
    harness.state_mut().toasts = ["one", "two", "three", "four"].map(toast).to_vec();
    harness.run();
    assert!(harness.query_by_label("one").is_none(), "the newest three are shown");
    let last =
        harness.get_all_by_label("Undo").map(|node| node.rect()).max_by(|a, b| a.top().total_cmp(&b.top()));
    let at = last.expect("verbs are shown").center();
    harness.drag_at(at);
    harness.drop_at(at);
    harness.run();
    let left: Vec<_> = harness.state().toasts.iter().map(|toast| toast.words.as_str()).collect();
    assert_eq!(left, ["one", "two", "three"]);
}

#[test]
fn tab_is_the_apps_until_something_has_the_focus() {
    let mut harness = harness(Theme::Dark);
    harness.run();
    harness.key_press(Key::Tab);
    harness.run();
    assert_eq!(harness.state().tabs, 1);
    assert_eq!(harness.ctx.memory(|memory| memory.focused()), None);
    harness.get_by_label("Length").focus();
    harness.run();
    let first = harness.ctx.memory(|memory| memory.focused());
    harness.key_press(Key::Tab);
    harness.run();
    assert_eq!(harness.state().tabs, 1, "Tab is still the app's");
    let second = harness.ctx.memory(|memory| memory.focused());
    assert!(second.is_some() && second != first, "the focus stays where it was");
}

#[test]
fn space_does_not_press_a_button_after_a_click() {
    let mut harness = harness(Theme::Dark);
    harness.run();
    let at = harness.get_by_label("Loop").rect().center();
    harness.drag_at(at);
    harness.drop_at(at);
    harness.run();
    assert!(!harness.state().looped);
    harness.key_press(Key::Space);
    harness.run();
    assert!(!harness.state().looped);
}
