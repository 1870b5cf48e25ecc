//! Tests of the window's own file dialog, which find its controls by their names.

use std::fs;

use egui::{Key, Modifiers, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT as _, Queryable as _};

use super::*;
use crate::theme::{self, Theme};
use crate::window::FocusRules;

struct Page {
    sheet: PathSheet,
    picked: Option<Picked>,
    passes: usize,
}

/// A sheet over a folder with two scenes, a mesh, a text, an EXR file, a hidden file and a folder with a scene.
fn sheet(ask: FileAsk, start: &str) -> (Harness<'static, Page>, tempfile::TempDir) {
    let home = tempfile::tempdir().expect("a temporary folder");
    for name in [
        "still_life.ron",
        "still_water.ron",
        "Apple.OBJ",
        "diary.txt",
        "f_1.exr",
        ".hidden.ron",
        "shots/roll.ron",
    ] {
        let path = home.path().join(name);
        fs::create_dir_all(path.parent().expect("a parent")).expect("made");
        fs::write(path, "").expect("written");
    }
    let page = Page { sheet: PathSheet::new(ask, &home.path().join(start)), picked: None, passes: 0 };
    let mut harness = Harness::builder()
        .with_size(vec2(1280.0, 800.0))
        .with_context_setup(|ctx| {
            ctx.add_plugin(FocusRules);
            theme::apply(ctx, Theme::Dark, 1.0);
        })
        .build_ui_state(
            |ui, page: &mut Page| {
                page.passes += 1;
                if page.picked.is_none() {
                    page.picked = page.sheet.show(ui.ctx());
                }
            },
            page,
        );
    harness.run();
    (harness, home)
}

fn type_in(harness: &mut Harness<'_, Page>, text: &str) {
    harness.get_by_label("File name").type_text(text);
    harness.run();
}

fn press(harness: &mut Harness<'_, Page>, key: Key) {
    harness.key_press(key);
    harness.run();
}

fn field(harness: &Harness<'_, Page>) -> String {
    harness.get_by_label("File name").accesskit_node().value().unwrap_or_default()
}

#[test]
fn folders_stand_first_then_files_that_can_be_opened() {
    let (harness, home) = sheet(FileAsk::Open, "");
    let rows = &harness.state().sheet.listing.rows;
    let names: Vec<&str> = rows.iter().map(ListedFile::name).collect();
    assert_eq!(names, ["..", "shots", "Apple.OBJ", "still_life.ron", "still_water.ron"]);
    for name in names {
        harness.get_by_label(name);
    }
    let folder = harness.get_by_label("Folder").accesskit_node().value();
    assert_eq!(folder.as_deref(), home.path().to_str());
    let (harness, _home) = sheet(FileAsk::ImportMesh, "");
    assert!(harness.query_by_label("still_life.ron").is_none());
}

#[test]
fn a_file_is_picked_by_clicks() {
    let (mut harness, home) = sheet(FileAsk::Open, "");
    harness.get_by_label("shots").click();
    harness.run();
    harness.get_by_label("roll.ron").click();
    harness.run();
    assert_eq!(harness.state().picked, None);
    harness.get_by_label("Open").click();
    harness.run();
    assert_eq!(harness.state().picked, Some(Picked::File(home.path().join("shots/roll.ron"))));
}

#[test]
fn a_file_is_picked_by_the_keyboard_alone() {
    let (mut harness, home) = sheet(FileAsk::Open, "");
    type_in(&mut harness, "sti");
    press(&mut harness, Key::Tab);
    assert_eq!(field(&harness), "still_", "Tab must complete what both names begin with, and no more");
    type_in(&mut harness, "w");
    press(&mut harness, Key::Tab);
    assert_eq!(field(&harness), "still_water.ron");
    press(&mut harness, Key::Enter);
    assert_eq!(harness.state().picked, Some(Picked::File(home.path().join("still_water.ron"))));

    let (mut harness, home) = sheet(FileAsk::Open, "");
    type_in(&mut harness, "sh");
    press(&mut harness, Key::Tab);
    type_in(&mut harness, "r");
    press(&mut harness, Key::Tab);
    assert_eq!(field(&harness), "shots/roll.ron");
    press(&mut harness, Key::Enter);
    assert_eq!(harness.state().picked, Some(Picked::File(home.path().join("shots/roll.ron"))));
}

#[test]
fn tab_goes_on_where_nothing_can_be_completed() {
    let (mut harness, _home) = sheet(FileAsk::Open, "");
    let is_in_field =
        |harness: &Harness<'_, Page>| harness.get_by_label("File name").accesskit_node().is_focused();
    assert!(is_in_field(&harness));
    type_in(&mut harness, "zzz");
    press(&mut harness, Key::Tab);
    assert!(!is_in_field(&harness), "the focus stays in the field after Tab");
    harness.get_by_label("File name").focus();
    harness.run();
    harness.key_press_modifiers(Modifiers::SHIFT, Key::Tab);
    harness.run();
    assert!(!is_in_field(&harness), "the focus stays in the field after Shift Tab");
}

#[test]
fn a_bad_choice_is_explained_under_the_field() {
    for (ask, typed, words) in [
        (FileAsk::Open, "", "Choose a file"),
        (FileAsk::Open, "gone.ron", "There is no file gone.ron"),
        (FileAsk::Open, "nowhere/gone.ron", "There is no folder"),
        (FileAsk::Open, "diary.txt", "no scene"),
        (FileAsk::Open, "f_1.exr", "f_1.exr is a rendered picture"),
        (FileAsk::LocateMesh, "f_1.exr", "does not read them"),
        (FileAsk::ImportMesh, "still_life.ron", "not what is asked for"),
        (FileAsk::SaveAs, "nowhere/new", "There is no folder"),
    ] {
        let (mut harness, _home) = sheet(ask, "");
        type_in(&mut harness, typed);
        press(&mut harness, Key::Enter);
        harness.get_by_label_contains(words);
        assert_eq!(harness.state().picked, None);
        type_in(&mut harness, "x");
        assert!(harness.query_by_label_contains(words).is_none(), "{words} is still shown");
    }
}

#[test]
fn a_folder_that_is_typed_is_entered() {
    let (mut harness, home) = sheet(FileAsk::Open, "");
    type_in(&mut harness, "shots/");
    press(&mut harness, Key::Enter);
    harness.get_by_label("roll.ron");
    assert_eq!(field(&harness), "");
    harness.get_by_label("..").click();
    harness.run();
    assert_eq!(harness.state().sheet.listing.folder, home.path());
    press(&mut harness, Key::Escape);
    assert_eq!(harness.state().picked, Some(Picked::Cancelled));
}

#[test]
fn a_save_asks_before_it_replaces() {
    let (mut harness, home) = sheet(FileAsk::SaveAs, "still_life.ron");
    assert_eq!(field(&harness), "still_life.ron");
    harness.get_by_label("Save").click();
    harness.run();
    assert_eq!(harness.state().picked, None);
    harness.get_by_label("Keep it").click();
    harness.run();
    assert_eq!(harness.state().picked, None, "nothing is picked: the sheet must be open again");
    harness.get_by_label("Save").click();
    harness.run();
    harness.get_by_label("Replace").click();
    harness.run();
    assert_eq!(harness.state().picked, Some(Picked::File(home.path().join("still_life.ron"))));
}

#[test]
fn the_proposed_name_is_selected_without_its_ending() {
    let (mut harness, _home) = sheet(FileAsk::SaveAs, "still_life.ron");
    harness.event(egui::Event::Text("pears".to_owned()));
    harness.run();
    assert_eq!(field(&harness), "pears.ron");
}

#[test]
fn the_whole_ending_of_a_preset_stays_when_its_name_is_typed() {
    let (mut harness, home) = sheet(FileAsk::SavePreset, "still_life.strokes.ron");
    harness.event(egui::Event::Text("pears".to_owned()));
    harness.run();
    assert_eq!(field(&harness), "pears.strokes.ron");
    press(&mut harness, Key::Enter);
    assert_eq!(harness.state().picked, Some(Picked::File(home.path().join("pears.strokes.ron"))));
}

#[test]
fn a_preset_gets_what_its_ending_lacks_and_asks_before_it_replaces() {
    for typed in ["thick", "thick.ron", "thick.RON", "thick.strokes", "thick.strokes.ron"] {
        let (mut harness, home) = sheet(FileAsk::SavePreset, "");
        type_in(&mut harness, typed);
        press(&mut harness, Key::Enter);
        let whole = home.path().join("thick.strokes.ron");
        assert_eq!(harness.state().picked, Some(Picked::File(whole.clone())), "{typed}");

        let (mut harness, home) = sheet(FileAsk::SavePreset, "");
        fs::write(home.path().join("thick.strokes.ron"), "").expect("written");
        type_in(&mut harness, typed);
        press(&mut harness, Key::Enter);
        harness.get_by_label("Replace");
        assert_eq!(harness.state().picked, None, "{typed}");
    }
}

#[test]
fn a_folder_is_made_to_save_in() {
    let (mut harness, home) = sheet(FileAsk::SaveAs, "still_life.ron");
    harness.get_by_label("New folder").click();
    harness.run();
    harness.get_by_label("Folder name").type_text("pears");
    harness.run();
    press(&mut harness, Key::Enter);
    assert!(home.path().join("pears").is_dir());
    assert_eq!(harness.state().sheet.listing.folder, home.path().join("pears"));
    assert_eq!(field(&harness), "still_life.ron", "the name stays");
    harness.get_by_label("Save").click();
    harness.run();
    assert_eq!(harness.state().picked, Some(Picked::File(home.path().join("pears/still_life.ron"))));
}

#[test]
fn a_save_gives_the_name_its_ending() {
    let (mut harness, home) = sheet(FileAsk::SaveCopy, "apple.v2");
    harness.get_by_label("Save").click();
    harness.run();
    assert_eq!(harness.state().picked, Some(Picked::File(home.path().join("apple.v2.ron"))));

    let (mut harness, _home) = sheet(FileAsk::SaveCopy, "still_life");
    harness.get_by_label("Save").click();
    harness.run();
    harness.get_by_label("Replace");
}

#[test]
fn frames_keep_the_ending_that_is_typed_and_get_the_usual_one_otherwise() {
    let ask = FileAsk::RenderOutput { ending: "exr" };
    for (start, file) in [("f_##", "f_##.exr"), ("f_##.exr", "f_##.exr"), ("f_##.png", "f_##.png")] {
        let (mut harness, home) = sheet(ask, start);
        harness.get_by_label("f_1.exr");
        harness.get_by_label("Save").click();
        harness.run();
        assert_eq!(harness.state().picked, Some(Picked::File(home.path().join(file))));
    }
}

#[test]
fn the_sheet_draws_only_when_something_changes() {
    let (mut harness, _home) = sheet(FileAsk::Open, "");
    let before = harness.state().passes;
    harness.run();
    assert!(harness.state().passes - before <= 2, "the sheet draws although nothing changes");
}
