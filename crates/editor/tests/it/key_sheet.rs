//! Tests of the sheet that changes keys, with real events: the page takes over the keymap that the sheet asks for.

use egui::{Event, Modifiers, Role, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use egui_kittest::{Harness, SnapshotOptions, SnapshotResults};
use impasto_editor::panels::key_sheet::key_sheet;
use impasto_editor::panels::{Ask, PanelInput, shortcuts};
use impasto_editor::theme::Theme;
use impasto_editor_model::keymap::{Action, Key, Keymap, Modifiers as Held, Preset, Scope};
use impasto_editor_model::{Document, Session};

use crate::headless;

/// Which sheet is open.
#[derive(Clone, Copy, PartialEq)]
enum Open {
    Keys,
    List,
    Nothing,
}

struct Page {
    keymap: Keymap,
    open: Open,
    document: Document,
    numpad: Vec<(Key, Held)>,
}

impl Page {
    fn ui(&mut self, ui: &mut egui::Ui) {
        let (session, time) = (Session::default(), Default::default());
        let keymap = self.keymap.clone();
        let shown = PanelInput::of(&self.document, &session, &time, &keymap);
        let numpad = std::mem::take(&mut self.numpad);
        let mut asks = Vec::new();
        let closed = match self.open {
            Open::Keys => key_sheet(ui.ctx(), &shown, &numpad, &mut asks),
            Open::List => shortcuts::shortcuts(ui.ctx(), &shown, &mut asks),
            Open::Nothing => false,
        };
        if closed {
            self.open = Open::Nothing;
        }
        for ask in asks {
            match ask {
                Ask::OwnKeys(own) => self.keymap.own = own,
                Ask::KeySheet => self.open = Open::Keys,
                _ => {}
            }
        }
    }
}

fn harness_in(theme: Theme, preset: Preset) -> Harness<'static, Page> {
    let page = Page {
        keymap: Keymap { preset, ..Keymap::default() },
        open: Open::Keys,
        document: Document::empty(std::path::Path::new(".")),
        numpad: Vec::new(),
    };
    headless::harness(vec2(800.0, 640.0), theme, page, |ui, page: &mut Page| page.ui(ui))
}

fn harness() -> Harness<'static, Page> {
    harness_in(Theme::Dark, Preset::Blender)
}

fn click(harness: &mut Harness<'_, Page>, name: &str) {
    harness.get_by_label(name).click();
    harness.run();
}

fn press(harness: &mut Harness<'_, Page>, held: Modifiers, key: egui::Key) {
    harness.key_press_modifiers(held, key);
    harness.run();
}

/// Types into the search of the sheet, so that the row looked for is in view.
fn find(harness: &mut Harness<'_, Page>, words: &str) {
    harness.event(Event::Text(words.to_owned()));
    harness.run();
}

fn does(harness: &Harness<'_, Page>, text: &str, scope: Scope) -> Option<Action> {
    let chord: impasto_editor_model::keymap::Chord = text.parse().expect("a chord");
    harness.state().keymap.action_for(chord.key, chord.held, scope)
}

#[test]
fn a_click_and_new_keys_change_a_command() {
    let mut harness = harness();
    find(&mut harness, "comb");
    click(&mut harness, "Comb");
    press(&mut harness, Modifiers::COMMAND, egui::Key::L);
    assert_eq!(does(&harness, "Ctrl L", Scope::Paint), Some(Action::Comb));
    assert_eq!(does(&harness, "C", Scope::Paint), None);
    assert!(harness.query_by_label("Take it over").is_none());
    // The list of keys is another sheet.
    harness.state_mut().open = Open::List;
    harness.run();
    assert_eq!(harness.query_all_by_label("Ctrl L").count(), 1, "the list of keys shows the new keys");
    harness.get_by_label("like Blender, some changed");
    harness.state_mut().open = Open::Keys;
    harness.run();
    click(&mut harness, "Reset the keys of Comb");
    assert_eq!(harness.state().keymap, Keymap::default());
}

#[test]
fn a_conflict_names_the_other_command_and_is_taken_over_or_left() {
    let mut harness = harness();
    find(&mut harness, "comb");
    click(&mut harness, "Comb");
    press(&mut harness, Modifiers::NONE, egui::Key::K);
    assert_eq!(harness.state().keymap, Keymap::default(), "nothing is taken unasked");
    harness.get_by_label_contains("K belongs to \u{201c}Compare with the reference\u{201d}");
    click(&mut harness, "Cancel the change");
    assert_eq!(harness.state().keymap, Keymap::default());
    click(&mut harness, "Comb");
    press(&mut harness, Modifiers::NONE, egui::Key::K);
    click(&mut harness, "Take it over");
    assert_eq!(does(&harness, "K", Scope::Paint), Some(Action::Comb));
    assert_eq!(does(&harness, "K", Scope::Arrange), None);
    click(&mut harness, "Reset all keys");
    assert_ne!(harness.state().keymap, Keymap::default(), "no key is reset before a question is answered");
    click(&mut harness, "Cancel the change");
    assert_eq!(does(&harness, "K", Scope::Paint), Some(Action::Comb));
    click(&mut harness, "Reset all keys");
    click(&mut harness, "Reset them");
    assert_eq!(harness.state().keymap, Keymap::default());
}

#[test]
fn arrows_and_enter_choose_a_command() {
    let mut harness = harness();
    find(&mut harness, "import a");
    press(&mut harness, Modifiers::NONE, egui::Key::Enter);
    press(&mut harness, Modifiers::COMMAND, egui::Key::L);
    assert_eq!(does(&harness, "Ctrl L", Scope::Paint), Some(Action::ImportMesh));
    let mut harness = self::harness();
    find(&mut harness, "along");
    press(&mut harness, Modifiers::NONE, egui::Key::ArrowDown);
    press(&mut harness, Modifiers::NONE, egui::Key::Enter);
    harness.get_by_label_contains("Along Y: press the new keys");
}

#[test]
fn keys_that_cannot_work_are_refused_with_words() {
    for (search, name, key, words) in [
        ("along x", "Along X", egui::Key::Num7, "7 cannot be given: numbers are typed while moving"),
        ("read the", "Read the source again", egui::Key::K, "K cannot be given: in a field it is text"),
        ("along x", "Along X", egui::Key::Plus, "This key cannot be given"),
    ] {
        let mut harness = harness();
        find(&mut harness, search);
        click(&mut harness, name);
        press(&mut harness, Modifiers::NONE, key);
        harness.get_by_label_contains(words);
        assert_eq!(harness.state().keymap, Keymap::default());
        // The sheet still waits for keys.
        press(&mut harness, Modifiers::NONE, egui::Key::F9);
        assert_ne!(harness.state().keymap, Keymap::default(), "{name}");
    }
    // Esc ends the wait for keys, whatever is held with it.
    let mut harness = harness();
    find(&mut harness, "comb");
    click(&mut harness, "Comb");
    press(&mut harness, Modifiers::COMMAND, egui::Key::Escape);
    harness.get_by_label("Click a command to change its keys.");
    assert!(harness.state().keymap == Keymap::default() && harness.state().open == Open::Keys);
}

#[test]
fn a_lane_key_says_what_it_hides() {
    let mut harness = harness();
    find(&mut harness, "delete (keys");
    click(&mut harness, "Delete (keys on a lane)");
    press(&mut harness, Modifiers::NONE, egui::Key::K);
    harness.get_by_label_contains("K would no longer do \u{201c}Compare with the reference\u{201d}");
    click(&mut harness, "Take it over");
    assert_eq!(does(&harness, "K", Scope::Lane), Some(Action::Delete));
    assert_eq!(does(&harness, "K", Scope::Animate), Some(Action::Compare));
}

#[test]
fn escape_leaves_one_thing_at_a_time() {
    let mut harness = harness();
    find(&mut harness, "smooth");
    click(&mut harness, "Smooth");
    press(&mut harness, Modifiers::NONE, egui::Key::Escape);
    assert!(harness.state().open == Open::Keys && harness.state().keymap == Keymap::default());
    press(&mut harness, Modifiers::NONE, egui::Key::Escape);
    assert!(harness.state().open == Open::Nothing);
}

#[test]
fn any_key_can_be_given() {
    for (key, text) in [
        (egui::Key::Tab, "Tab"),
        (egui::Key::Space, "Space"),
        (egui::Key::Enter, "Enter"),
        (egui::Key::ArrowUp, "↑"),
        (egui::Key::F9, "F9"),
        (egui::Key::Backspace, "Backspace"),
    ] {
        let mut harness = harness();
        find(&mut harness, "import a");
        click(&mut harness, "Import a mesh");
        press(&mut harness, Modifiers::NONE, key);
        if harness.query_by_label("Take it over").is_some() {
            click(&mut harness, "Take it over");
        }
        assert_eq!(does(&harness, text, Scope::Arrange), Some(Action::ImportMesh), "{text}");
        assert!(harness.state().open == Open::Keys, "{text}");
    }
    let mut harness = harness();
    find(&mut harness, "import a");
    click(&mut harness, "Import a mesh");
    harness.state_mut().numpad.push((Key::NumPad(9), Held::default()));
    harness.run();
    assert_eq!(does(&harness, "NumPad 9", Scope::Paint), Some(Action::ImportMesh));
    click(&mut harness, "Import a mesh");
    click(&mut harness, "No key");
    assert_eq!(harness.state().keymap.shortcut_text(Action::ImportMesh), None);
    // egui reports Ctrl C as `Event::Copy`, never as a key press, so no command can be given these keys.
    click(&mut harness, "Import a mesh");
    harness.event(Event::Copy);
    harness.run();
    harness.get_by_label_contains("stay with text");
    assert_eq!(harness.state().keymap.shortcut_text(Action::ImportMesh), None);
}

#[test]
fn commands_are_found_by_name_place_and_key() {
    let rows = |typed: &str| {
        let mut harness = harness();
        find(&mut harness, typed);
        let rows: Vec<String> =
            harness.get_all_by_role(Role::MenuItem).filter_map(|row| row.accesskit_node().label()).collect();
        rows
    };
    assert_eq!(rows("ctrl shift z"), ["Redo"]);
    assert!(rows("lane").contains(&"Delete (keys on a lane)".to_owned()));
    assert!(rows("erase").contains(&"Erase to automatic".to_owned()));
}

#[test]
fn the_sheet_fits_into_the_smallest_window() {
    let mut harness = harness();
    harness.set_size(vec2(640.0, 440.0));
    harness.run();
    harness.run();
    let [top, bottom] =
        ["Close the change of keys", "Reset all keys"].map(|name| harness.get_by_label(name).rect());
    assert!(top.top() >= 0.0 && bottom.bottom() <= 440.0, "{top:?} {bottom:?}");
}

#[test]
fn how_it_looks() {
    let mut results = SnapshotResults::new();
    let mut keep = |harness: &mut Harness<'_, Page>, name: &str| {
        harness.snapshot_options(name, &SnapshotOptions::new().threshold(0.6));
        results.extend_harness(harness);
    };
    let mut dark = harness();
    find(&mut dark, "di");
    click(&mut dark, "Fill direction");
    press(&mut dark, Modifiers::NONE, egui::Key::K);
    keep(&mut dark, "key_sheet_dark");
    let mut light = harness_in(Theme::Light, Preset::Maya);
    find(&mut light, "fr");
    click(&mut light, "Frame all");
    keep(&mut light, "key_sheet_light");
}
