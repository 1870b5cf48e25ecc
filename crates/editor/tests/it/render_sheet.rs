//! Tests of the render sheet: what it asks for, what it refuses, and how it looks. Controls are found by name.

use std::path::{Path, PathBuf};

use crate::headless;
use egui::accesskit::Toggled;
use egui::{Color32, ColorImage, Key, Modifiers, TextureHandle, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use egui_kittest::{Harness, SnapshotOptions, SnapshotResults};
use impasto_editor::panels::render_sheet::{RenderAsk, RenderShown, render_sheet};
use impasto_editor::panels::work::{Work, WorkKind};
use impasto_editor::panels::{Ask, Numbers, PanelInput, status_line};
use impasto_editor::theme::{self, Theme};
use impasto_editor_model::command::{Command, SceneEdit};
use impasto_editor_model::keymap::{Action, Keymap};
use impasto_editor_model::render_settings::{
    AovChoice, FileKind, Outcome, RenderDriver, RenderProgress, RenderSettings, Stage, Which,
};
use impasto_editor_model::timeline::TimeHand;
use impasto_editor_model::{Document, Session};
use impasto_scene::aovs::AovSet;
use impasto_scene::document::Style;

struct Page {
    document: Document,
    settings: RenderSettings,
    progress: Option<RenderProgress>,
    picture: Option<TextureHandle>,
    asked: Vec<RenderAsk>,
    _folder: Option<tempfile::TempDir>,
}

impl Page {
    /// A document without a file, in a folder that need not exist.
    fn unsaved() -> Self {
        let document = Document::empty(Path::new("/pictures/pears"));
        let settings = RenderSettings::of(document.scene());
        Self { document, settings, progress: None, picture: None, asked: Vec::new(), _folder: None }
    }

    fn saved() -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        let mut document = Document::empty(folder.path());
        document.save_as(&folder.path().join("pears.ron")).expect("saved");
        Self { document, _folder: Some(folder), ..Self::unsaved() }
    }

    fn running(self) -> Self {
        let progress = RenderProgress {
            stage: Stage::Drawing,
            total: 120,
            written: 47,
            gone_s: 115.0,
            drawing_s: 112.8,
            strokes: 5774,
            last: Some(PathBuf::from("/pictures/pears/out/frame_0046.png")),
            ..RenderProgress::default()
        };
        Self { progress: Some(progress), ..self }
    }

    fn ui(&mut self, ui: &egui::Ui) {
        let ctx = ui.ctx().clone();
        if self.progress.is_some() && self.picture.is_none() {
            let pixel = |index: usize| Color32::from_rgb(60 + (index % 16) as u8 * 8, 90, 140);
            let image = ColorImage::new([16, 9], (0..16 * 9).map(pixel).collect());
            self.picture = Some(ctx.load_texture("last", image, egui::TextureOptions::LINEAR));
        }
        let shown = RenderShown {
            document: &self.document,
            frame: 7.0,
            driver: "llvmpipe",
            progress: self.progress.as_ref(),
            picture: self.picture.as_ref(),
            viewable: self.progress.as_ref().is_some_and(|progress| progress.outcome.is_some()),
        };
        self.asked.extend(render_sheet(&ctx, &shown, &mut self.settings));
    }
}

fn harness(page: Page) -> Harness<'static, Page> {
    headless::harness(vec2(1280.0, 560.0), Theme::Dark, page, |ui, page| page.ui(ui))
}

fn click(harness: &mut Harness<'_, Page>, name: &str) {
    harness.get_by_label(name).click();
    harness.run();
}

/// Replaces the contents of a field by typing.
fn fill(harness: &mut Harness<'_, Page>, name: &str, text: &str) {
    harness.get_by_label(name).focus();
    harness.run();
    harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    harness.run();
    harness.get_by_label(name).type_text(text);
    harness.run();
}

fn asked(harness: &mut Harness<'_, Page>) -> Vec<RenderAsk> {
    std::mem::take(&mut harness.state_mut().asked)
}

fn is_enabled(harness: &Harness<'_, Page>, name: &str) -> bool {
    !harness.get_by_label(name).accesskit_node().is_disabled()
}

#[test]
fn the_sheet_looks_as_it_did() {
    let mut results = SnapshotResults::new();
    for (page, name) in [(Page::unsaved(), "render_dark"), (Page::unsaved().running(), "render_running_dark")]
    {
        let mut harness = harness(page);
        assert!(harness.query_by_label("Render settings").is_some());
        harness.snapshot_options(name, &SnapshotOptions::new().threshold(0.6));
        results.extend_harness(&mut harness);
    }
}

#[test]
fn what_exr_files_hold_is_ticked_in_a_menu() {
    let mut results = SnapshotResults::new();
    let mut harness = harness(Page::saved());
    assert!(harness.query_by_label("AOVs").is_none(), "PNG files hold none");
    click(&mut harness, "PNG 16 bit");
    assert_eq!(harness.state().settings.kind, FileKind::Png16);
    click(&mut harness, "EXR");
    let settings = &harness.state().settings;
    assert_eq!((settings.kind, settings.output.as_str()), (FileKind::Exr, "out/frame_####.exr"));
    let value = |harness: &Harness<'_, Page>| harness.get_by_label("AOVs").accesskit_node().value();
    assert_eq!(value(&harness).as_deref(), Some("No AOVs"));

    click(&mut harness, "AOVs");
    assert!(!is_enabled(&harness, "AOVs of the scene"), "the scene names none");
    for name in ["depth", "stroke.id", "layers", "crypto.object", "stroke.id"] {
        click(&mut harness, name);
    }
    let three = AovSet::of_words(["depth", "layers", "crypto.object"]).expect("names");
    assert_eq!(harness.state().settings.aovs, AovChoice::These(three));
    assert_eq!(value(&harness).as_deref(), Some("3 AOVs"));
    harness.snapshot_options("render_aovs_dark", &SnapshotOptions::new().threshold(0.6));
    results.extend_harness(&mut harness);

    click(&mut harness, "All AOVs");
    assert_eq!(harness.state().settings.aovs, AovChoice::All);
    click(&mut harness, "No AOVs");
    assert_eq!(harness.state().settings.aovs, AovChoice::NONE);
    harness.key_press(Key::Escape);
    harness.run();
    assert!(harness.query_by_label("depth").is_none(), "Esc closes the menu");
    assert_eq!(asked(&mut harness), [], "Esc does more than close the menu");
    fill(&mut harness, "Output files", "f_##.png");
    assert_eq!(harness.state().settings.kind, FileKind::Png8, "the kind follows the name");
}

#[test]
fn what_the_style_lacks_cannot_be_ticked() {
    let mut page = Page::saved();
    let style = Style::named("reference").expect("a style");
    let edit = SceneEdit::SetStyle(style, "Plain".to_owned());
    page.document.apply(&Command::Scene(edit)).expect("applied");
    page.settings.choose_kind(FileKind::PngAndExr);
    page.settings.aovs = AovChoice::All;
    let mut harness = harness(page);
    click(&mut harness, "AOVs");
    assert!(is_enabled(&harness, "depth") && !is_enabled(&harness, "stroke.id"));
    let is_on = |name: &str| harness.get_by_label(name).accesskit_node().toggled() == Some(Toggled::True);
    assert!(is_on("depth") && !is_on("stroke.id"));
}

#[test]
fn every_setting_is_reached_by_name() {
    let mut harness = harness(Page::saved());
    let scene = harness.state().document.scene().clone();
    click(&mut harness, "This frame");
    assert_eq!(harness.state().settings.which, Which::This);
    fill(&mut harness, "Frames", "3-9x2");
    let settings = &harness.state().settings;
    assert_eq!((settings.which, settings.list.as_str()), (Which::Listed, "3-9x2"));
    click(&mut harness, "Size 50 %");
    assert_eq!(harness.state().settings.size_px, [scene.size.0 / 2, scene.size.1 / 2]);
    harness.get_by_label("Width px").focus();
    harness.run();
    harness.key_press(Key::ArrowRight);
    harness.run();
    harness.get_by_label("Height px").focus();
    harness.run();
    harness.key_press(Key::ArrowLeft);
    harness.run();
    assert_eq!(harness.state().settings.size_px, [scene.size.0 / 2 + 1, scene.size.1 / 2 - 1]);
    fill(&mut harness, "Output files", "best/f_##.png");
    assert_eq!(harness.state().settings.output, "best/f_##.png");
    click(&mut harness, "Driver");
    click(&mut harness, "OSMesa, in software");
    click(&mut harness, "Transparent background");
    let settings = &harness.state().settings;
    assert!(settings.driver == RenderDriver::Osmesa && settings.transparent);
    assert_eq!(asked(&mut harness), []);
    click(&mut harness, "Copy as command");
    click(&mut harness, "Browse for output files");
    click(&mut harness, "Start rendering");
    click(&mut harness, "Close render settings");
    let all = [RenderAsk::CopyCommand, RenderAsk::Browse, RenderAsk::Render, RenderAsk::Close];
    assert_eq!(asked(&mut harness), all);
}

#[test]
fn enter_in_a_field_belongs_to_the_field() {
    let mut harness = harness(Page::saved());
    fill(&mut harness, "Frames", "3-5");
    harness.key_press(Key::Enter);
    harness.run();
    assert_eq!(asked(&mut harness), [], "Enter in the field started the render");
    harness.key_press(Key::Enter);
    harness.run();
    assert_eq!(asked(&mut harness), [RenderAsk::Render]);
}

#[test]
fn what_cannot_be_rendered_is_told_where_it_is_typed() {
    let mut harness = harness(Page::saved());
    fill(&mut harness, "Frames", "3-");
    assert!(harness.query_by_label_contains("is no frame list").is_some());
    assert!(!is_enabled(&harness, "Start rendering") && !is_enabled(&harness, "Copy as command"));
    fill(&mut harness, "Frames", "3");
    assert!(is_enabled(&harness, "Start rendering") && is_enabled(&harness, "Copy as command"));
    fill(&mut harness, "Output files", "film.avi");
    assert!(harness.query_by_label_contains("let the name end in .png").is_some());
    fill(&mut harness, "Output files", "/elsewhere/f_##.png");
    assert!(harness.query_by_label_contains("outside the scene").is_some());
    assert!(!is_enabled(&harness, "Open folder"), "a folder that is not there yet can be opened");
    let unsaved = self::harness(Page::unsaved());
    assert!(!is_enabled(&unsaved, "Copy as command") && is_enabled(&unsaved, "Start rendering"));
}

#[test]
fn while_frames_come_they_can_be_stopped_or_left_alone() {
    let mut harness = harness(Page::saved().running());
    let progress = harness.get_by_label("Progress").accesskit_node();
    assert_eq!(progress.value().as_deref(), Some("47 of 120, 1 min 55 s gone, about 2 min 55 s left"));
    assert!(!is_enabled(&harness, "Output files") && !is_enabled(&harness, "Transparent background"));
    click(&mut harness, "Work on while it renders");
    click(&mut harness, "Open folder");
    click(&mut harness, "Stop");
    harness.key_press(Key::Escape);
    harness.run();
    let all = [RenderAsk::WorkOn, RenderAsk::OpenFolder, RenderAsk::Stop, RenderAsk::WorkOn];
    assert_eq!(asked(&mut harness), all);
    harness.state_mut().progress.as_mut().expect("it runs").stopping = true;
    harness.run();
    assert!(!is_enabled(&harness, "Stop"), "Stop can be clicked twice");
    let words = "Frame 47 was not written. /pictures/pears/out/frame_0047.png: No space left on device";
    harness.state_mut().progress.as_mut().expect("it ran").outcome = Some(Outcome::Failed(words.to_owned()));
    harness.run();
    assert_eq!(harness.get_by_label("Rendering state").accesskit_node().value().as_deref(), Some(words));
    assert!(harness.query_by_label("Stop").is_none() && is_enabled(&harness, "Open folder"));
    click(&mut harness, "Start rendering");
    assert_eq!(asked(&mut harness), [RenderAsk::Render]);
}

/// The status line, and the background work that it shows.
struct Line {
    document: Document,
    works: Vec<Work>,
    asked: Vec<Ask>,
}

#[test]
fn long_work_is_shown_in_the_status_line_and_can_be_stopped() {
    let work = |words: &str, share, kind| Work { words: words.to_owned(), share, kind };
    let line = Line {
        document: Document::empty(Path::new("/pictures/pears")),
        works: vec![
            work("Rendering 47 of 120", Some(0.39), WorkKind::Rendering),
            work("Importing bunny.obj\u{2026}", None, WorkKind::Reading),
            work("Preparing bunny\u{2026}", None, WorkKind::Preparing),
        ],
        asked: Vec::new(),
    };
    let page = |ui: &mut egui::Ui, line: &mut Line| {
        let (session, time, keymap) = (Session::default(), TimeHand::default(), Keymap::default());
        let shown = PanelInput {
            status: "[Drag] comb",
            numbers: Numbers { strokes: 5774, works: &line.works, ..Numbers::default() },
            ..PanelInput::of(&line.document, &session, &time, &keymap)
        };
        status_line::status_line(ui, &shown, &mut line.asked);
    };
    let mut harness = Harness::builder()
        .with_size(vec2(1280.0, 60.0))
        .with_context_setup(|ctx| theme::apply(ctx, Theme::Dark, 1.0))
        .build_ui_state(page, line);
    // A moving progress bar redraws for ever, so run a fixed number of steps.
    harness.run_steps(4);
    for name in ["Rendering 47 of 120", "Stop: importing bunny.obj", "Stop: preparing bunny"] {
        harness.get_by_label(name).click();
        harness.run_steps(4);
    }
    let asked = &harness.state().asked;
    assert!(
        matches!(
            asked[..],
            [Ask::Act(Action::Render), Ask::StopWork(WorkKind::Reading), Ask::StopWork(WorkKind::Preparing)]
        ),
        "{asked:?}"
    );
}

#[test]
fn finished_frames_are_viewed_from_the_sheet() {
    let mut harness = harness(Page::unsaved().running());
    assert!(harness.query_by_label("View frames").is_none());
    if let Some(progress) = &mut harness.state_mut().progress {
        progress.outcome = Some(Outcome::Done);
    }
    harness.run();
    click(&mut harness, "View frames");
    assert_eq!(asked(&mut harness), [RenderAsk::View]);
}
