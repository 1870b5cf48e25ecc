//! Tests of the panel of problems in a scene file: what it lists, what it asks for, and how it looks.

use std::path::PathBuf;

use crate::headless;
use egui::{CentralPanel, Key, Modifiers, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use egui_kittest::{Harness, SnapshotOptions};
use impasto_editor::panels::problems::{Settle, Trouble, TroubleOf};
use impasto_editor::panels::{Ask, PanelInput, problems, status_line, top_bar};
use impasto_editor::theme::{self, Theme, Tokens};
use impasto_editor_model::editor::{Editor, Mend, Request};
use impasto_editor_model::keymap::{self, Action, Keymap};
use impasto_editor_model::picking::View;
use impasto_editor_model::{Document, Session};

const TEXT: &str = r#"(
    version: 1,
    camera: (keys: [(frame: 0, eye: (0, 1, 4), target: (0, 0, 0))]),
    objects: [
        (name: "apple", mesh: "meshes/apple.obj"),
        (name: "leaf", mesh: "laef.obj", parent: "apple"),
        (name: "stem", mesh: "stem.obj", parent: "apple"),
    ],
    regions: [
        (name: "skin", on: Object("apple"), strokes: (widht_px: 9, length_px: "long"), guides: [(radius: 0.1, points: [
            (at: (0.2, 0.5, 0.42), normal: (0, 0, 1)), (at: (0.8, 0.5, 0.42), normal: (0, 0, 1)),
        ])]),
    ],
)
"#;

/// The window without its viewport. The editor carries out repairs (`Ask::Mend`). The page records the other requests.
struct Page {
    editor: Editor,
    path: PathBuf,
    chosen: Vec<String>,
    copies: usize,
    is_open: bool,
    has_bars: bool,
    troubles: Vec<Trouble>,
    settled: Vec<(usize, Settle)>,
    brought: Vec<PathBuf>,
    _folder: tempfile::TempDir,
}

impl Page {
    fn new() -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        std::fs::create_dir(folder.path().join("meshes")).expect("made");
        let quad = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
        for name in ["apple.obj", "leaf.obj", "stem.obj"] {
            std::fs::write(folder.path().join("meshes").join(name), quad).expect("written");
        }
        let path = folder.path().join("still_life.ron");
        std::fs::write(&path, TEXT).expect("written");
        let document = Document::open_with_problems(&path, &Default::default()).expect("opens");
        let editor = Editor::new(document);
        Self {
            editor,
            path,
            chosen: Vec::new(),
            copies: 0,
            is_open: true,
            has_bars: true,
            troubles: Vec::new(),
            settled: Vec::new(),
            brought: Vec::new(),
            _folder: folder,
        }
    }

    fn undo(&mut self) {
        let view = View { camera: self.editor.camera(), size_px: glam::DVec2::ONE };
        self.editor.act(Action::Undo, &view);
    }

    fn ui(&mut self, ui: &mut egui::Ui) {
        let whole = ui.ctx().content_rect();
        let ui = &mut ui.new_child(egui::UiBuilder::new().max_rect(whole));
        ui.set_clip_rect(whole);
        let mut asks = Vec::new();
        let (session, keymap) = (Session::default(), Keymap::default());
        let shown = PanelInput {
            troubles: &self.troubles,
            ..PanelInput::of(self.editor.document(), &session, self.editor.time(), &keymap)
        };
        if self.has_bars {
            top_bar::top_bar(ui, &shown, &mut asks);
            status_line::status_line(ui, &shown, &mut asks);
        }
        self.is_open &= self.is_open && problems::problems(ui, &shown, &mut asks);
        CentralPanel::default().frame(egui::Frame::new().fill(Tokens::of(ui).app)).show(ui, |_| {});
        // The window hands keys to the editor before it shows its panels. This page hands over only Ctrl Enter, and
        // does so after the panels.
        let typing = ui.ctx().text_edit_focused();
        if ui.input(|input| input.modifiers.command && input.key_pressed(Key::Enter)) {
            let view = View { camera: self.editor.camera(), size_px: glam::DVec2::ONE };
            let ctrl = keymap::Modifiers { ctrl: true, ..Default::default() };
            self.editor.key(keymap::Key::Enter, ctrl, typing, &view);
        }
        if self.editor.take_requests().contains(&Request::ReadSource)
            && let Some(text) = problems::unread_text(ui.ctx(), self.editor.document())
        {
            asks.push(Ask::Mend(Mend::ReadText(text)));
        }
        for ask in asks {
            match ask {
                Ask::Mend(mend) => {
                    if self.editor.mend(&mend)
                        && let Mend::ReadText(text) = &mend
                    {
                        problems::note_read(ui.ctx(), text);
                    }
                }
                Ask::ChooseMesh(object) => self.chosen.push(object),
                Ask::SaveCopy => self.copies += 1,
                Ask::ShowProblems => self.is_open = !self.is_open,
                Ask::Settle(index, settle) => self.settled.push((index, settle)),
                Ask::BringFile(to) => self.brought.push(to),
                _ => {}
            }
        }
    }
}

fn harness() -> Harness<'static, Page> {
    headless::harness(vec2(1000.0, 300.0), Theme::Dark, Page::new(), |ui, page| page.ui(ui))
}

fn click(harness: &mut Harness<'_, Page>, name: &str) {
    harness.get_by_label(name).click();
    harness.run_steps(SETTLED);
}

/// The number of passes after which a list has finished scrolling.
const SETTLED: usize = 12;

fn document_value(harness: &Harness<'_, Page>) -> String {
    harness.get_by_label("Document").accesskit_node().value().unwrap_or_default()
}

#[test]
fn the_panel_looks_as_it_did() {
    let mut harness = harness();
    harness.state_mut().has_bars = false;
    harness.set_size(vec2(880.0, 240.0));
    harness.run();
    harness.get_by_label_contains("line 6 column 30").click();
    harness.run();
    harness.hover_at(egui::pos2(600.0, 4.0));
    harness.run();
    harness.snapshot_options("problems_dark", &SnapshotOptions::new().threshold(0.6));
}

/// Replaces the source by typing another text.
fn type_instead(harness: &mut Harness<'_, Page>, text: &str) {
    harness.get_by_label("Source").focus();
    harness.run_steps(SETTLED);
    harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
    harness.run_steps(SETTLED);
    harness.get_by_label("Source").type_text(text);
    harness.run_steps(SETTLED);
}

#[test]
fn edited_text_is_read_by_its_button_and_by_ctrl_enter_and_is_known_until_then() {
    for by_key in [false, true] {
        let mut harness = harness();
        let unread = |harness: &Harness<'_, Page>| {
            problems::unread_text(&harness.ctx, harness.state().editor.document())
        };
        assert!(harness.query_by_label("Read this text").is_none() && unread(&harness).is_none());
        let source = harness.state().editor.document().source().expect("a source").text.clone();
        let edited = source.replace("widht_px", "width_px");
        type_instead(&mut harness, &edited);
        assert_eq!(unread(&harness), Some(edited));
        let count = harness.state().editor.document().loss_count();
        if by_key {
            harness.key_press_modifiers(Modifiers::COMMAND, Key::Enter);
            harness.run_steps(SETTLED);
        } else {
            click(&mut harness, "Read this text");
        }
        let document = harness.state().editor.document();
        assert_eq!((document.loss_count(), document.undo_text()), (count - 1, Some("Read the source again")));
        assert_eq!(document.scene().regions[0].strokes.width_px, Some(9.0));
        assert!(harness.query_by_label("Read this text").is_none() && unread(&harness).is_none());
    }
}

#[test]
fn what_is_wrong_is_mended_by_name_until_saving_is_on_again() {
    let mut harness = harness();
    assert_eq!(document_value(&harness), "still_life.ron, saving over it is off");
    assert!(harness.query_by_label_contains("line 6 column 30, error, ").is_some());
    assert!(harness.query_by_label("Close problems").is_none(), "the panel can be closed");
    click(&mut harness, "Save a copy");
    assert_eq!(harness.state().copies, 1);
    harness.get_all_by_label("Locate").next().expect("a button").click();
    harness.run_steps(SETTLED);
    assert_eq!(harness.state().chosen, ["leaf"]);
    click(&mut harness, "Use leaf.obj");
    click(&mut harness, "Fix all that are certain");
    let document = harness.state().editor.document();
    assert_eq!((document.loss_count(), document.undo_text()), (1, Some("Fix 2 problems")));
    assert!(harness.query_by_label("Fix all that are certain").is_none());
    // The last problem is fixed by hand, in the text.
    let source = harness.state().editor.document().source().expect("a source").text.clone();
    type_instead(&mut harness, &source.replace("\"long\"", "40"));
    assert_eq!(harness.state().editor.document().loss_count(), 1, "the text was read unasked");
    harness.key_press_modifiers(Modifiers::COMMAND, Key::Enter);
    harness.run_steps(SETTLED);
    assert_eq!(harness.state().editor.document().scene().regions[0].strokes.length_px, Some(40.0));
    assert_eq!(document_value(&harness), "still_life.ron, edited");
    let said = harness.state_mut().editor.take_said();
    assert!(said.iter().any(|said| said.words == "No problems left. Saving is on again."), "{said:?}");
    assert!(harness.query_by_label("Close problems").is_some());
    click(&mut harness, "Snap to surface");
    assert!(!harness.state().is_open, "the panel is open with nothing to list");
    let page = harness.state();
    assert_eq!(std::fs::read_to_string(&page.path).expect("there"), TEXT, "the file was touched");
}

#[test]
fn a_text_that_was_read_is_no_unread_edit_once_it_is_taken_back() {
    let mut harness = harness();
    click(&mut harness, "Use leaf.obj");
    click(&mut harness, "Fix all that are certain");
    let source = harness.state().editor.document().source().expect("a source").text.clone();
    type_instead(&mut harness, &source.replace("\"long\"", "40"));
    click(&mut harness, "Read this text");
    assert_eq!(harness.state().editor.document().loss_count(), 0);
    harness.state_mut().undo();
    harness.run_steps(SETTLED);
    assert_eq!(harness.state().editor.document().loss_count(), 1);
    assert_eq!(problems::unread_text(&harness.ctx, harness.state().editor.document()), None);
    assert!(harness.query_by_label("Read this text").is_none());
}

#[test]
fn edited_text_outlives_what_changes_the_source() {
    let mut harness = harness();
    let unread =
        |harness: &Harness<'_, Page>| problems::unread_text(&harness.ctx, harness.state().editor.document());
    let source = harness.state().editor.document().source().expect("a source").text.clone();
    let edited = source.replace("long", "longer");
    type_instead(&mut harness, &edited);
    // While the text has unread edits, no repair that would change the text is offered.
    assert!(harness.query_by_label("Fix all that are certain").is_none());
    assert!(harness.query_by_label("Use leaf.obj").is_none());
    // Another program writes the file, and it is read.
    let path = harness.state().path.clone();
    std::fs::write(&path, TEXT.replace("0.42", "0.43")).expect("written");
    click(&mut harness, "Read again");
    assert_eq!(unread(&harness), Some(edited));
    click(&mut harness, "Drop the edited text");
    assert_eq!(unread(&harness), None);
    assert!(harness.query_by_label("Fix all that are certain").is_some());
}

#[test]
fn a_failed_save_is_listed_with_what_settles_it() {
    let mut page = Page::new();
    page.is_open = false;
    page.troubles = vec![Trouble {
        of: TroubleOf::Save(None),
        words: format!("{} was not saved: the disk is full", "a long name ".repeat(10)),
        mend: "Your work is still here, and not in the file".to_owned(),
        settles: &[Settle::SaveAs, Settle::Retry],
    }];
    let mut harness = Harness::builder()
        .with_size(vec2(1000.0, 600.0))
        .with_context_setup(|ctx| theme::apply(ctx, Theme::Dark, 1.0))
        .build_ui_state(|ui, page: &mut Page| page.ui(ui), page);
    harness.run();
    click(&mut harness, "Show problems");
    let row = harness.get_by_label_contains("the disk is full").rect();
    assert!(row.height() > 50.0 && row.right() <= 1000.0, "the row does not show all its words: {row}");
    click(&mut harness, "Save as");
    click(&mut harness, "Retry");
    assert_eq!(harness.state().settled, [(0, Settle::SaveAs), (0, Settle::Retry)]);
    harness.state_mut().troubles.clear();
    harness.run_steps(SETTLED);
    assert!(harness.query_by_label_contains("the disk is full").is_none());
}

#[test]
fn a_missing_texture_can_be_located_and_looked_for_again() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("written");
    write("leaf.obj", "mtllib leaf.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    write("leaf.mtl", "newmtl m\nmap_Kd maps/skin.tga\n");
    write(
        "s.ron",
        "(version: 1, camera: (keys: [(frame: 0, eye: (0, 1, 4), target: (0, 0, 0))]), \
         objects: [(name: \"leaf\", mesh: \"leaf.obj\")])",
    );
    let document = Document::open(&folder.path().join("s.ron"), &Default::default()).expect("opens");
    let page = Page { editor: Editor::new(document), ..Page::new() };
    let mut harness = Harness::builder()
        .with_size(vec2(1000.0, 600.0))
        .with_context_setup(|ctx| theme::apply(ctx, Theme::Dark, 1.0))
        .build_ui_state(|ui, page: &mut Page| page.ui(ui), page);
    harness.run();
    click(&mut harness, "Locate skin.tga");
    let to = std::fs::canonicalize(folder.path()).expect("a folder").join("maps/skin.tga");
    let brought = harness.state().brought.clone();
    assert_eq!(brought.len(), 1);
    assert!(brought[0].ends_with("maps/skin.tga"), "{brought:?}");
    std::fs::create_dir(to.parent().expect("a folder")).expect("made");
    let mut pixel = vec![0_u8; 18];
    (pixel[2], pixel[12], pixel[14], pixel[16]) = (2, 1, 1, 24);
    pixel.extend([0, 0, 200]);
    std::fs::write(&to, pixel).expect("written");
    click(&mut harness, "Retry skin.tga");
    assert_eq!(harness.state().editor.document().problem_count(), 0);
    assert!(harness.query_by_label("Show problems").is_none(), "problems are offered, but there are none");
}
