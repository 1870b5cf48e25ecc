//! Tests of what the command search finds.

use std::path::Path;

use egui::Context;
use impasto_editor_model::keymap::{Action, Keymap};
use impasto_editor_model::session::Tool;
use impasto_editor_model::{Document, Item, Selection, Session};

use super::*;
use crate::panels::tool_names::face;
use crate::panels::{Preference, menus};
use crate::theme::{self, Theme};

/// Lets `test` look at what the search knows, with this item of the apple's scene selected.
fn with_entries<R>(selected: Option<Item>, test: impl FnOnce(&[Control], Vec<Entry>) -> R) -> R {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/apple.ron");
    let mut document = Document::open(&path, &Default::default()).expect("the apple opens");
    document.select(selected.into_iter().collect::<Selection>());
    let (session, time, keymap) = (Session::default(), Default::default(), Keymap::default());
    let shown = PanelInput::of(&document, &session, &time, &keymap);
    let ctx = Context::default();
    theme::apply(&ctx, Theme::Dark, 1.0);
    let controls = controls(&ctx, &shown);
    let entries = entries(&ctx, &shown, &controls);
    test(&controls, entries)
}

fn object() -> Option<Item> {
    Some(Item::Object("apple".to_owned()))
}

fn names(typed: &str, selected: Option<Item>) -> Vec<String> {
    with_entries(selected, |_, entries| found(typed, entries).into_iter().map(|entry| entry.words).collect())
}

#[test]
fn the_most_likely_command_comes_first() {
    let first = |typed: &str| names(typed, None).first().cloned();
    assert_eq!(first("comb").as_deref(), Some(Action::Comb.name()));
    assert_eq!(first("sel").as_deref(), Some(Action::SelectAll.name()), "menu order among equals");
    assert_eq!(first("frame s").as_deref(), Some(Action::FrameSelected.name()));
    assert_eq!(first("camera").as_deref(), Some(Action::CameraFromView.name()));
    assert_eq!(first("gdcv").as_deref(), Some(Action::GuideCurve.name()), "letters in order are enough");
    assert_eq!(first("zzz"), None);
}

#[test]
fn every_command_that_is_declared_is_found_by_its_name() {
    // A test in `menus` checks that only a few actions are missing from this list, such as those of a running gesture.
    for action in menus::actions().into_iter().filter(|action| *action != Action::Palette) {
        let is_found = with_entries(object(), |_, entries| {
            let mut found = found(action.name(), entries).into_iter();
            found.any(|entry| match entry.ask {
                Ok(Ask::Act(other)) => other == action,
                // What cannot be done now is listed all the same.
                Err(_) => entry.words == action.name(),
                Ok(_) => false,
            })
        });
        assert!(is_found, "{}", action.name());
    }
    let all = names("", object());
    for words in ["Copy render command", "First run sheet", "Add lamp", "Add sky"] {
        assert!(all.iter().any(|name| name == words), "{words}");
    }
}

#[test]
fn every_tool_the_theme_and_the_settings_are_found() {
    let all = names("", None);
    let tools = [
        Tool::Select,
        Tool::Move,
        Tool::Turn,
        Tool::Scale,
        Tool::AddLight,
        Tool::ShotCamera,
        Tool::Comb,
        Tool::GuideCurve,
        Tool::Fill,
        Tool::TurnDirection,
        Tool::Smooth,
        Tool::Erase,
        Tool::Region,
        Tool::Pick,
    ];
    for tool in tools {
        assert!(all.iter().any(|name| name == face(tool).name), "{}", face(tool).name);
    }
    with_entries(None, |_, entries| {
        let mut light = found("light theme", entries).into_iter();
        let light = light.next().expect("it is there");
        assert!(!light.on && matches!(light.ask, Ok(Ask::Prefer(Preference::Theme(Theme::Light)))));
    });
    for words in ["Auto key", "Grid", "Shading: shaded", "Keys like Maya", "Interface size 125 %"] {
        assert!(all.iter().any(|name| name == words), "{words}");
    }
}

#[test]
fn every_control_of_the_inspector_is_found_with_its_section() {
    with_entries(object(), |controls, entries| {
        let is_there = |name: &str, section: &str| {
            let control = Control { name: name.to_owned(), section: section.to_owned() };
            assert!(controls.contains(&control), "{control:?} is not among {controls:?}");
        };
        is_there("Object name", "");
        is_there("Move X", "Transform");
        is_there("Mesh file", "Mesh");
        is_there("Material", "Material");
        is_there("Material colour", "Material");
        is_there("Texture file", "Material");
        is_there("Gloss", "Material");
        for control in controls {
            let is_found = entries.iter().any(|entry| match &entry.ask {
                Ok(Ask::Reach(reached)) => reached == control && entry.words == control.name,
                _ => false,
            });
            assert!(is_found, "{control:?}");
        }
    });
    let region = Some(Item::Region("apple".to_owned()));
    with_entries(region, |controls, _| {
        let sections = |name: &str| -> Vec<&str> {
            let named = controls.iter().filter(|control| control.name == name);
            named.map(|control| control.section.as_str()).collect()
        };
        assert_eq!(sections("Coverage"), ["Strokes", "Strokes over time"], "each control has its section");
        assert_eq!(sections("Swing"), ["Advanced"], "a control in a folded section is listed too");
    });
}
