//! Tests of the viewer of finished frames: its keys, its buttons, the line of frames, and how it looks.

use std::path::PathBuf;

use egui::{Color32, ColorImage, Event, Key, Modifiers, PointerButton, TextureHandle, pos2, vec2};
use egui_kittest::kittest::Queryable as _;
use egui_kittest::{Harness, SnapshotOptions, SnapshotResults};
use impasto_editor::panels::frame_viewer::{ViewerAsk, ViewerShown, frame_viewer};
use impasto_editor::theme::Theme;
use impasto_editor_model::finished_frames::FinishedFrames;
use impasto_editor_model::keymap::{self, Action, CommandId, Keymap, Preset};

use crate::headless;

struct Page {
    frames: FinishedFrames,
    keymap: Keymap,
    picture: Option<TextureHandle>,
    fault: Option<&'static str>,
    asked: Vec<ViewerAsk>,
    numpad: Vec<(keymap::Key, keymap::Modifiers)>,
    is_covered: bool,
}

impl Page {
    fn new() -> Self {
        let frames = (0..48).map(|frame| (frame, PathBuf::from(format!("/pears/out/frame_{frame:04}.png"))));
        Self {
            frames: FinishedFrames::new(frames.collect(), 24.0).expect("some"),
            keymap: Keymap::default(),
            picture: None,
            fault: None,
            asked: Vec::new(),
            numpad: Vec::new(),
            is_covered: false,
        }
    }

    fn ui(&mut self, ui: &mut egui::Ui) {
        if self.picture.is_none() && self.fault.is_none() {
            let pixel = |index: usize| Color32::from_rgb(60 + (index % 160) as u8, 90, 140);
            let image = ColorImage::new([160, 90], (0..160 * 90).map(pixel).collect());
            self.picture = Some(ui.ctx().load_texture("frame", image, egui::TextureOptions::LINEAR));
        }
        let numpad = std::mem::take(&mut self.numpad);
        let shown = ViewerShown {
            frames: &self.frames,
            picture: self.picture.as_ref().filter(|_| self.fault.is_none()),
            shown: Some(self.frames.at()),
            fault: self.fault,
            keymap: &self.keymap,
            numpad: &numpad,
            is_covered: self.is_covered,
        };
        if let Some(ask) = frame_viewer(ui, &shown) {
            self.asked.push(ask);
            match ask {
                ViewerAsk::GoTo(index) => self.frames.go_to(index),
                ViewerAsk::Step(by) => self.frames.step(by),
                ViewerAsk::Loop(looped) => self.frames.looped = looped,
                ViewerAsk::PlayOrStop | ViewerAsk::Close => {}
            }
        }
    }
}

fn harness(page: Page, theme: Theme, wide: f32) -> Harness<'static, Page> {
    headless::harness(vec2(wide, 240.0), theme, page, |ui, page| page.ui(ui))
}

fn asked(harness: &mut Harness<'_, Page>) -> Vec<ViewerAsk> {
    harness.run();
    std::mem::take(&mut harness.state_mut().asked)
}

#[test]
fn keys_play_step_and_go_back_to_work() {
    let mut harness = harness(Page::new(), Theme::Dark, 1000.0);
    for (held, key, ask) in [
        (Modifiers::NONE, Key::Space, ViewerAsk::PlayOrStop),
        (Modifiers::NONE, Key::ArrowRight, ViewerAsk::Step(1)),
        (Modifiers::NONE, Key::ArrowLeft, ViewerAsk::Step(-1)),
        (Modifiers::SHIFT, Key::ArrowRight, ViewerAsk::GoTo(i64::MAX)),
        (Modifiers::SHIFT, Key::ArrowLeft, ViewerAsk::GoTo(0)),
        (Modifiers::NONE, Key::Escape, ViewerAsk::Close),
    ] {
        harness.key_press_modifiers(held, key);
        assert_eq!(asked(&mut harness), [ask]);
    }
    // Keys that edit do nothing here.
    for key in [Key::X, Key::Delete, Key::G, Key::Num2] {
        harness.key_press(key);
        assert_eq!(asked(&mut harness), []);
    }
    // The user's own keys play, too.
    let id = CommandId::named("Play").expect("a command");
    let keymap = Keymap { preset: Preset::Maya, ..Keymap::default() };
    harness.state_mut().keymap = keymap.with(id, vec!["L".parse().expect("a key")]);
    harness.key_press(Key::L);
    assert_eq!(asked(&mut harness), [ViewerAsk::PlayOrStop]);
}

#[test]
fn buttons_and_the_line_go_through_the_frames() {
    let mut harness = harness(Page::new(), Theme::Dark, 1000.0);
    for (name, ask) in [
        ("Play", ViewerAsk::PlayOrStop),
        ("Next frame", ViewerAsk::Step(1)),
        ("Last frame", ViewerAsk::GoTo(i64::MAX)),
        ("Loop", ViewerAsk::Loop(false)),
        ("Back to work", ViewerAsk::Close),
    ] {
        harness.get_by_label(name).click();
        assert_eq!(asked(&mut harness), [ask]);
    }
    assert_eq!(harness.state().frames.at(), 47);
    let line = harness.get_by_label("Frames").rect();
    let button = |at, pressed| Event::PointerButton {
        pos: at,
        button: PointerButton::Primary,
        pressed,
        modifiers: Modifiers::NONE,
    };
    let at = |share: f32| pos2(line.left() + line.width() * share, line.center().y);
    harness.event(Event::PointerMoved(at(0.5)));
    harness.event(button(at(0.5), true));
    harness.event(Event::PointerMoved(at(0.25)));
    harness.event(Event::PointerMoved(at(0.0)));
    harness.event(button(at(0.0), false));
    let asked = asked(&mut harness);
    assert!(asked.contains(&ViewerAsk::GoTo(12)) && asked.last() == Some(&ViewerAsk::GoTo(0)), "{asked:?}");
}

#[test]
fn the_file_is_named_and_what_is_wrong_with_it_is_told() {
    let mut page = Page::new();
    page.frames.go_to(7);
    let mut harness = harness(page, Theme::Dark, 1000.0);
    harness.get_by_label("frame_0007.png");
    harness.get_by_label("frame 7, 8 of 48");
    harness.state_mut().fault = Some("frame_0007.png is not there");
    harness.run();
    harness.get_by_value("frame_0007.png is not there");
}

#[test]
fn how_it_looks() {
    let mut results = SnapshotResults::new();
    for (theme, wide, name) in
        [(Theme::Dark, 1280.0, "frame_viewer_dark"), (Theme::Light, 640.0, "frame_viewer_light")]
    {
        let mut page = Page::new();
        page.frames.go_to(30);
        let mut harness = harness(page, theme, wide);
        harness.snapshot_options(name, &SnapshotOptions::new().threshold(0.6));
        results.extend_harness(&mut harness);
    }
}

#[test]
fn a_question_over_it_has_the_keys_and_any_key_can_play() {
    let mut harness = harness(Page::new(), Theme::Dark, 1000.0);
    harness.state_mut().is_covered = true;
    harness.key_press(Key::Escape);
    harness.key_press(Key::Space);
    assert_eq!(asked(&mut harness), []);
    let page = harness.state_mut();
    page.is_covered = false;
    let play = CommandId::named(Action::Play.name()).expect("a command");
    let chords = vec!["Tab".parse().expect("a key"), "NumPad 9".parse().expect("a key")];
    page.keymap = page.keymap.with(play, chords);
    page.numpad.push((keymap::Key::NumPad(9), keymap::Modifiers::default()));
    assert_eq!(asked(&mut harness), [ViewerAsk::PlayOrStop]);
    harness.key_press(Key::Tab);
    assert_eq!(asked(&mut harness), [ViewerAsk::PlayOrStop]);
}
