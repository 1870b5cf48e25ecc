//! Tests of the panels round the viewport: what they ask for, and how they look. Controls are found by name.

mod curves;
mod page;
mod timeline;

use crate::headless;
use egui::accesskit::Role;
use egui::{Key, Modifiers, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use egui_kittest::{Harness, SnapshotOptions, SnapshotResults};
use impasto_editor::panels::ask_close::{Answer, Question};
use impasto_editor::panels::{Ask, welcome};
use impasto_editor::theme::Theme;
use impasto_editor_model::command::SceneEdit;
use impasto_editor_model::keymap::{Action, Digits, Preset};
use impasto_editor_model::session::{Mode, RegionBy, Tool};
use impasto_editor_model::{Command, Item, Selection};
use impasto_scene::document::LightKind;
use page::{Page, Shows};

const NARROW: (f32, f32) = (1280.0, 500.0);
const WIDE: (f32, f32) = (1920.0, 500.0);

fn harness(page: Page, theme: Theme, (wide, high): (f32, f32)) -> Harness<'static, Page> {
    headless::harness(vec2(wide, high), theme, page, |ui, page| page.ui(ui))
}

fn paint() -> Harness<'static, Page> {
    harness(Page::new().in_mode(Mode::Paint), Theme::Dark, NARROW)
}

/// Takes one picture. All pictures of a test share `results`, so that they can be updated in one run.
fn snapshot(results: &mut SnapshotResults, harness: &mut Harness<'_, Page>, name: &str) {
    harness.run();
    harness.snapshot_options(name, &SnapshotOptions::new().threshold(0.6));
    results.extend_harness(harness);
}

fn click(harness: &mut Harness<'_, Page>, name: &str) {
    harness.get_by_label(name).click();
    harness.run();
}

fn acts(page: &Page) -> Vec<Action> {
    page.asked
        .iter()
        .filter_map(|ask| if let Ask::Act(action) = ask { Some(*action) } else { None })
        .collect()
}

#[test]
fn the_bars_look_as_they_did() {
    let mut results = SnapshotResults::new();
    let page = || Page::new().in_mode(Mode::Paint).edited();
    snapshot(&mut results, &mut harness(page(), Theme::Dark, NARROW), "bars_paint_dark");
    snapshot(&mut results, &mut harness(page(), Theme::Light, WIDE), "bars_paint_light_wide");
    let mut animate = Page::new().in_mode(Mode::Animate).with_tool(Tool::Move);
    animate.session.frame = 37.0;
    animate.document.select(Selection::only(Item::Object("apple".to_owned())));
    snapshot(&mut results, &mut harness(animate, Theme::Dark, NARROW), "bars_animate_dark");
    let nothing = Page { document: page::nothing(), status: page::DROP.to_owned(), ..Page::new() };
    snapshot(&mut results, &mut harness(nothing, Theme::Dark, NARROW), "bars_empty_dark");
}

#[test]
fn the_sheets_look_as_they_did() {
    let mut results = SnapshotResults::new();
    for (shows, theme, size, name) in [
        (Shows::Welcome, Theme::Dark, (724.0, 416.0), "welcome_dark"),
        (Shows::Welcome, Theme::Light, (724.0, 416.0), "welcome_light"),
        (Shows::Keys, Theme::Dark, (640.0, 420.0), "keys_dark"),
        (Shows::Palette, Theme::Dark, (520.0, 460.0), "palette_dark"),
    ] {
        let mut page = Page { shows, document: page::nothing(), ..Page::new() };
        page.choices.theme = theme;
        let mut harness = harness(page, theme, size);
        if shows == Shows::Palette {
            harness.event(egui::Event::Text("view".to_owned()));
        }
        snapshot(&mut results, &mut harness, name);
    }
    let question = Question::SaveChanges { name: "still_life.ron".to_owned(), minutes: 12 };
    let page = Page { shows: Shows::Question(0), questions: vec![question], ..Page::new() };
    snapshot(&mut results, &mut harness(page, Theme::Dark, (520.0, 260.0)), "save_changes_dark");
    let mut menu = harness(Page::new(), Theme::Dark, (520.0, 390.0));
    click(&mut menu, "File");
    snapshot(&mut results, &mut menu, "menu_file_dark");
}

#[test]
fn every_control_of_the_bars_has_its_name_and_can_be_hit() {
    let bars = [
        "File",
        "Edit",
        "View",
        "Help",
        "Undo",
        "Redo",
        "Document",
        "Arrange",
        "Paint",
        "Animate",
        "Find a command",
        "Render",
        "More tool options",
        "First frame",
        "Previous frame",
        "Play",
        "Next frame",
        "Last frame",
        "Current frame",
        "Ruler",
        "Loop",
        "Show keys",
    ];
    let tools = [
        "Comb",
        "Guide curve",
        "Fill direction",
        "Turn direction",
        "Smooth",
        "Erase to automatic",
        "Region",
        "Pick direction",
    ];
    let options = ["Along", "Against", "Brush radius", "Brush strength", "Mirror X", "Mirror Y", "Mirror Z"];
    let seen = |harness: &Harness<'_, Page>, names: &[&str]| {
        for name in names {
            // The name of the current tool is also on the options bar.
            let controls: Vec<_> = harness
                .get_all_by_label(name)
                .filter(|node| node.accesskit_node().role() != Role::Label)
                .map(|node| node.rect())
                .collect();
            assert_eq!(controls.len(), 1, "{name}");
            let size = controls[0].size();
            assert!(size.x >= 24.0 && size.y >= 20.0, "{name} is {size} points");
        }
    };
    let paint = paint();
    seen(&paint, &bars);
    seen(&paint, &tools);
    seen(&paint, &options);
    assert_eq!(paint.get_all_by_label("Status").count(), 1);
    let wide = harness(Page::new().in_mode(Mode::Paint), Theme::Dark, WIDE);
    seen(&wide, &bars);
    seen(&wide, &["Soft falloff", "Even falloff", "Steady", "Front faces only"]);
    let posing = harness(Page::new(), Theme::Dark, NARROW);
    seen(&posing, &["Select", "Move", "Turn", "Scale", "Add light", "Shot camera tool"]);
    seen(&posing, &["World axes", "Local axes", "View axes"]);
    assert!(posing.query_by_label("Snap").is_none(), "Snap shows for a tool that only selects");
    let moving = harness(Page::new().with_tool(Tool::Move), Theme::Dark, NARROW);
    seen(&moving, &["World axes", "Local axes", "View axes", "Snap"]);
}

#[test]
fn menus_ask_for_commands_and_show_their_keys() {
    let mut harness = paint();
    for (menu, row, action) in [
        ("File", "Save as", Action::SaveAs),
        ("File", "Save a copy", Action::SaveCopy),
        ("File", "Read again", Action::Revert),
        ("Edit", "Show all", Action::ShowAll),
        ("View", "Look through the shot camera", Action::LookThrough),
        ("Help", "Shortcuts", Action::Shortcuts),
    ] {
        click(&mut harness, menu);
        click(&mut harness, row);
        assert_eq!(acts(harness.state()).last(), Some(&action));
        assert!(harness.query_by_label(row).is_none(), "{menu} stays open");
    }
    click(&mut harness, "Help");
    click(&mut harness, "First run sheet");
    assert!(matches!(harness.state().asked.last(), Some(Ask::Welcome)));
}

#[test]
fn what_cannot_be_done_is_not_asked_for() {
    let mut harness = paint();
    click(&mut harness, "Edit");
    for name in ["Duplicate", "Rename", "Delete"] {
        assert!(harness.get_by_label(name).accesskit_node().is_disabled(), "{name} needs no selection");
    }
    click(&mut harness, "Duplicate");
    for name in ["Undo", "Redo"] {
        let node = harness.get_by_label(name);
        assert!(node.accesskit_node().is_disabled(), "{name}");
        node.click();
        harness.run();
    }
    assert!(harness.state().asked.is_empty(), "{:?}", harness.state().asked);
    click(&mut harness, "Render");
    assert!(matches!(harness.state().asked[..], [Ask::Act(Action::Render)]));
    harness.state_mut().document = page::nothing();
    harness.run();
    harness.get_by_label("Render").hover();
    harness.run_steps(60);
    assert!(harness.query_by_label("The scene is empty").is_some());
}

#[test]
fn recent_files_open_again_and_the_render_command_can_be_copied() {
    let mut harness = paint();
    click(&mut harness, "File");
    click(&mut harness, "Open recent");
    click(&mut harness, "pears.ron");
    assert!(matches!(harness.state().asked.last(), Some(Ask::Open(path)) if path.ends_with("pears.ron")));
    click(&mut harness, "File");
    click(&mut harness, "Copy render command");
    let Some(Ask::Copy(words)) = harness.state().asked.last() else { panic!("{:?}", harness.state().asked) };
    assert!(words.starts_with("impasto render \"") && words.ends_with("scenes/still_life.ron\""), "{words}");
}

#[test]
fn undo_says_what_it_takes_back() {
    let mut harness = harness(Page::new().edited(), Theme::Dark, NARROW);
    let undo = harness.get_by_label("Undo");
    assert_eq!(undo.accesskit_node().description().as_deref(), harness.state().document.undo_text());
    assert!(harness.state().document.undo_text().is_some_and(|text| !text.is_empty()));
    let name = harness.get_by_label("Document").accesskit_node().value();
    assert_eq!(name.as_deref(), Some("still_life.ron, edited"));
    click(&mut harness, "Undo");
    assert_eq!(acts(harness.state()), [Action::Undo]);
}

#[test]
fn the_modes_stay_where_they_are_whatever_the_document_is_called() {
    let at = |page| harness(page, Theme::Dark, NARROW).get_by_label("Arrange").rect();
    let named = at(Page::new().edited());
    assert_eq!(named, at(Page { document: page::nothing(), ..Page::new() }));
    let mut long = harness(Page { document: page::with_a_long_name(), ..Page::new() }, Theme::Dark, NARROW);
    assert_eq!(named, long.get_by_label("Arrange").rect());
    assert!(long.get_by_label("Document").rect().right() < named.left());
    click(&mut long, "Animate");
    assert_eq!(acts(long.state()), [Action::Animate]);
}

#[test]
fn tools_are_taken_up_and_keep_their_settings() {
    let mut harness = paint();
    for (name, tool) in [("Fill direction", Tool::Fill), ("Region", Tool::Region), ("Smooth", Tool::Smooth)] {
        click(&mut harness, name);
        assert_eq!(harness.state().session.paint_tool, tool);
    }
    click(&mut harness, "Smear");
    click(&mut harness, "Mirror Y");
    let options = &harness.state().session.options;
    assert!(options.smear && options.mirror == [false, true, false]);
    click(&mut harness, "Region");
    assert!(harness.query_by_label("Flood angle").is_none());
    click(&mut harness, "Region by flood");
    assert_eq!(harness.state().session.options.region_by, RegionBy::Flood);
    assert!(harness.query_by_label("Flood angle").is_some());
    harness.state_mut().session.mode = Mode::Arrange;
    harness.run();
    click(&mut harness, "Add light");
    assert_eq!(harness.state().session.object_tool, Tool::AddLight);
    let kinds = [
        ("Sun", LightKind::Sun),
        ("Spot", LightKind::Spot),
        ("Lamp", LightKind::Point),
        ("Sky", LightKind::Ambient),
    ];
    for (name, kind) in kinds {
        click(&mut harness, name);
        assert_eq!(harness.state().session.options.light, kind);
    }
}

#[test]
fn settings_without_room_are_behind_the_button() {
    let mut harness = paint();
    assert!(harness.query_by_label("Even falloff").is_none());
    click(&mut harness, "More tool options");
    click(&mut harness, "Even falloff");
    click(&mut harness, "Front faces only");
    let options = &harness.state().session.options;
    assert!(options.even && !options.front_only);
    let steady = harness.query_by_role_and_label(Role::SpinButton, "Steady");
    assert!(steady.is_some(), "the settings close when one is changed");
}

#[test]
fn a_number_on_the_bar_changes_the_tool() {
    let mut harness = paint();
    harness.get_by_label("Brush strength").focus();
    harness.run();
    harness.key_press(Key::ArrowLeft);
    harness.run();
    assert!((harness.state().session.options.strength - 0.79).abs() < 1e-12);
}

#[test]
fn the_ruler_scrubs() {
    let mut harness = paint();
    let rect = harness.get_by_label("Ruler").rect().shrink2(vec2(8.0, 0.0));
    harness.drag_at(rect.left_center());
    harness.run();
    assert_eq!(harness.state().session.frame, 0.0);
    let frames = [0.25, 0.5, 2.0].map(|part| {
        harness.hover_at(rect.left_center() + vec2(part * rect.width(), 0.0));
        harness.run();
        harness.state().session.frame
    });
    assert_eq!(frames, [30.0, 60.0, 119.0], "whole frames within the range");
    harness.drop_at(rect.left_center());
    harness.run();
    click(&mut harness, "Play");
    click(&mut harness, "Last frame");
    assert_eq!(acts(harness.state()), [Action::Play, Action::LastFrame]);
    click(&mut harness, "Loop");
    assert!(!harness.state().session.looped);
}

#[test]
fn the_status_line_is_read_out() {
    let harness = paint();
    let status = harness.get_by_label("Status");
    assert_eq!(status.accesskit_node().value().as_deref(), Some(page::COMBING));
    assert_eq!(status.accesskit_node().live(), egui::accesskit::Live::Polite);
    for words in ["Shift", "smooth", "5,774 strokes", "41 fps", "llvmpipe"] {
        assert!(harness.query_by_label(words).is_some(), "{words}");
    }
}

#[test]
fn a_command_is_found_and_run() {
    let mut harness = harness(Page { shows: Shows::Palette, ..Page::new() }, Theme::Dark, (1280.0, 800.0));
    harness.event(egui::Event::Text("view".to_owned()));
    harness.run();
    harness.key_press(Key::ArrowDown);
    harness.run();
    harness.key_press(Key::Enter);
    harness.run();
    assert_eq!(acts(harness.state()), [Action::ViewRight]);
    assert_eq!(harness.state().shows, Shows::Bars);

    harness.state_mut().shows = Shows::Palette;
    harness.run();
    harness.event(egui::Event::Text("no such thing".to_owned()));
    harness.run();
    assert!(harness.query_by_label("No command has that name.").is_some());
    harness.key_press(Key::Enter);
    harness.run();
    assert_eq!(harness.state().shows, Shows::Palette);
    harness.key_press(Key::Escape);
    harness.run();
    assert_eq!((harness.state().shows, acts(harness.state()).len()), (Shows::Bars, 1));
}

#[test]
fn the_first_run_sheet_takes_choices() {
    let page = Page { shows: Shows::Welcome, ..Page::new() };
    let mut harness = harness(page, Theme::Dark, (1280.0, 800.0));
    for name in ["Keys like Maya", "Light", "Interface size 125 %", "Don't show this at start"] {
        click(&mut harness, name);
    }
    let wanted = welcome::Choices { keys: Preset::Maya, theme: Theme::Light, scale: 1.25, at_start: false };
    assert_eq!(harness.state().choices, wanted);
    for (name, left) in [
        ("Open a mesh", welcome::Left::OpenMesh),
        ("Try the still life", welcome::Left::StillLife),
        ("Open a scene", welcome::Left::OpenScene),
        ("Close welcome", welcome::Left::Closed),
    ] {
        harness.state_mut().shows = Shows::Welcome;
        harness.run();
        harness.get_by_role_and_label(Role::Button, name).click();
        harness.run();
        assert_eq!(harness.state().left, Some(left), "{name}");
    }
    // The key that the first card shows works here, too.
    harness.state_mut().shows = Shows::Welcome;
    harness.run();
    harness.key_press_modifiers(Modifiers::COMMAND, Key::O);
    harness.run();
    assert_eq!(harness.state().left, Some(welcome::Left::OpenScene));
}

#[test]
fn questions_are_answered_by_their_verbs_and_keys() {
    let scene = || "still_life.ron".to_owned();
    let cases = [
        (
            Question::SaveChanges { name: scene(), minutes: 12 },
            "Don\u{2019}t save",
            Answer::Discard,
            Answer::Save,
            Answer::Cancel,
        ),
        (
            Question::Recapture { frame: 37 },
            "Recapture",
            Answer::Recapture,
            Answer::Recapture,
            Answer::Cancel,
        ),
        (
            Question::ChangedOutside { name: scene() },
            "Read it, drop my edits",
            Answer::ReadAgain,
            Answer::KeepWorking,
            Answer::KeepWorking,
        ),
        (
            Question::Recovered {
                name: scene(),
                age: "5 minutes ago".to_owned(),
                changes: 9,
                has_text: false,
                of_another: true,
            },
            "Discard",
            Answer::Discard,
            Answer::OpenCopy,
            Answer::Cancel,
        ),
        (
            Question::SaveOver { name: scene() },
            "Save over it",
            Answer::SaveOver,
            Answer::SaveAs,
            Answer::Cancel,
        ),
        (
            Question::Problems { count: 1, line: 38 },
            "Show the problem",
            Answer::ShowProblem,
            Answer::SaveCopy,
            Answer::Cancel,
        ),
    ];
    let questions = cases.iter().map(|case| case.0.clone()).collect();
    let mut harness = harness(Page { questions, ..Page::new() }, Theme::Dark, NARROW);
    for (index, (question, verb, answer, enter, escape)) in cases.into_iter().enumerate() {
        for (key, answer) in [(None, answer), (Some(Key::Enter), enter), (Some(Key::Escape), escape)] {
            harness.state_mut().shows = Shows::Question(index);
            harness.run();
            match key {
                Some(key) => harness.key_press(key),
                None => harness.get_by_label(verb).click(),
            }
            harness.run();
            assert_eq!(harness.state_mut().answer.take(), Some(answer), "{question:?} {key:?}");
        }
    }
}

#[test]
fn an_empty_scene_says_how_to_begin() {
    let mut harness = harness(Page { document: page::nothing(), ..Page::new() }, Theme::Dark, NARROW);
    click(&mut harness, "Open a mesh");
    click(&mut harness, "Open a scene");
    assert_eq!(acts(harness.state()), [Action::ImportMesh, Action::OpenScene]);
    let full = paint();
    assert!(full.query_by_label("Open a mesh").is_none());
}

#[test]
fn the_keys_are_listed_as_the_preset_has_them() {
    let mut harness = harness(Page { shows: Shows::Keys, ..Page::new() }, Theme::Dark, (1280.0, 800.0));
    assert!(harness.query_by_label("NumPad ., F").is_none() && harness.query_by_label("Ctrl Z, Z").is_none());
    harness.state_mut().keymap.preset = Preset::Maya;
    harness.run();
    assert!(harness.query_by_label("Ctrl Z, Z").is_some());
    click(&mut harness, "Close keys");
    assert_eq!(harness.state().shows, Shows::Bars);
}

#[test]
fn the_keys_are_listed_with_digits_as_the_user_has_them() {
    let mut harness = harness(Page { shows: Shows::Keys, ..Page::new() }, Theme::Dark, (1280.0, 800.0));
    assert!(harness.query_by_label("NumPad 7, 7").is_none());
    harness.state_mut().keymap.digits = Digits::NumPad;
    harness.run();
    assert!(harness.query_by_label("NumPad 7, 7").is_some(), "digits are not listed as keys of views");
}

#[test]
fn edits_are_marked() {
    let command = Command::Scene(SceneEdit::SetSeed(77));
    let mut page = Page::new();
    page.document.apply(&command).expect("a seed");
    let harness = harness(page, Theme::Dark, NARROW);
    assert_eq!(
        harness.get_by_label("Document").accesskit_node().value().as_deref(),
        Some("still_life.ron, edited")
    );
}
