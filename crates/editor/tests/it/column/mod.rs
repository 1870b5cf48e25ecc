//! The editor's right column (tree and inspector) with a document, for tests that find its controls by name.

mod all_values;
mod guides;
mod ink;
mod inspector;
mod looks;
mod material;
mod menus;
mod missing;
mod paint_layers;
mod tree;

use std::path::Path;

use egui::accesskit::Toggled;
use egui::{Key, Role, Vec2, vec2};
use egui_kittest::kittest::{NodeT as _, Queryable as _};
use egui_kittest::{Harness, HarnessBuilder};
use impasto_editor::files::own_presets::OwnPreset;
use impasto_editor::panels::{self, Ask, Control, Numbers, PanelInput};
use impasto_editor::theme::{self, Theme};
use impasto_editor_model::command::{Command, StrokesOf};
use impasto_editor_model::keymap::{Action, Keymap};
use impasto_editor_model::{Document, Item, Session};
use impasto_scene::document::{Guide, GuidePoint};
use impasto_scene::load::LoadOptions;

/// The column, and a document that carries out what the column asks.
pub struct Column {
    pub document: Document,
    pub session: Session,
    pub keymap: Keymap,
    /// What the column asked, in order, in words: *preview*, *select*; for a command, its words in the history.
    pub log: Vec<String>,
    pub acts: Vec<Action>,
    pub meshes: Vec<String>,
    pub tree_height: f32,
    pub strokes_of: Vec<(String, usize)>,
    pub likely_meshes: Vec<(String, String)>,
    pub own_presets: Vec<OwnPreset>,
    /// What was asked about presets, in words.
    pub asked_presets: Vec<String>,
    /// The item that the menu at the pointer was asked for in this pass; an inner `None` stands for the view.
    pub menu: Option<Option<Item>>,
    /// The control that was asked to have the focus.
    pub reach: Option<Control>,
}

/// *scene*, or the name of the region.
fn name_of(of: &StrokesOf) -> &str {
    match of {
        StrokesOf::Scene => "scene",
        StrokesOf::Region(name) => name,
    }
}

impl Column {
    pub fn open(scene: &str) -> Self {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(scene);
        let document = Document::open(&path, &LoadOptions::default()).expect("the shipped scene opens");
        Self::of(document)
    }

    pub fn of(document: Document) -> Self {
        let session = Session::default();
        let (log, acts, meshes) = (Vec::new(), Vec::new(), Vec::new());
        let (strokes_of, likely_meshes) = (Vec::new(), Vec::new());
        Self {
            document,
            session,
            keymap: Keymap::default(),
            log,
            acts,
            meshes,
            tree_height: 252.0,
            strokes_of,
            likely_meshes,
            asked_presets: Vec::new(),
            own_presets: vec![OwnPreset {
                name: "mine".to_owned(),
                path: "/presets/mine.strokes.ron".into(),
            }],
            menu: None,
            reach: None,
        }
    }

    pub fn ui(&mut self, ui: &mut egui::Ui) {
        let mut asks = Vec::new();
        let time = Default::default();
        let shown = PanelInput {
            numbers: Numbers { strokes_of: &self.strokes_of, ..Numbers::default() },
            likely_meshes: &self.likely_meshes,
            presets: &self.own_presets,
            ..PanelInput::of(&self.document, &self.session, &time, &self.keymap)
        };
        // The harness has margins, the window has none.
        let whole = ui.ctx().content_rect();
        let ui = &mut ui.new_child(egui::UiBuilder::new().max_rect(whole));
        ui.set_clip_rect(whole);
        let none = egui::Frame::new().fill(ui.visuals().panel_fill);
        egui::Panel::top("tree").frame(none).exact_size(self.tree_height).show_separator_line(false).show(
            ui,
            |ui| {
                panels::tree(ui, &shown, &mut asks);
            },
        );
        egui::CentralPanel::default().frame(none).show(ui, |ui| panels::inspector(ui, &shown, &mut asks));
        panels::context_menu(ui, &shown, &mut asks);
        for ask in asks {
            self.answer(ask);
        }
        if let Some(about) = self.menu.take() {
            panels::open_context_menu(ui.ctx(), about);
        }
        if let Some(control) = self.reach.take() {
            panels::reach(ui.ctx(), &control);
        }
    }

    fn asked(&mut self, words: String) -> String {
        self.asked_presets.push(words);
        "of a preset".to_owned()
    }

    pub fn answer(&mut self, ask: Ask) {
        let words = |step: impasto_editor_model::document::Step| step.text;
        let refused = |refusal: impasto_editor_model::Refusal| format!("refused: {refusal}");
        let words = match ask {
            Ask::Do(command) => self.document.apply(&command).map_or_else(refused, words),
            Ask::DoMerged(command, key) => {
                let step = self.document.apply_merged(&command, &key, 0.0);
                format!("merged {}", step.map_or_else(refused, words))
            }
            Ask::Preview(command) => match self.document.preview(&command) {
                Ok(()) => "preview".to_owned(),
                Err(refusal) => refused(refusal),
            },
            Ask::EndPreview => {
                self.document.end_preview();
                "end preview".to_owned()
            }
            Ask::Select(selection) => {
                self.document.select(selection);
                "select".to_owned()
            }
            Ask::ChooseMesh(object) => {
                self.meshes.push(object);
                "choose a mesh".to_owned()
            }
            Ask::Act(action) => {
                self.acts.push(action);
                "act".to_owned()
            }
            Ask::Recapture(frame) => format!("ask about frame {frame}"),
            Ask::Timeline(_)
            | Ask::Open(_)
            | Ask::Copy(_)
            | Ask::Welcome
            | Ask::KeySheet
            | Ask::OwnKeys(_)
            | Ask::Mend(_)
            | Ask::SaveCopy
            | Ask::BringFile(_)
            | Ask::ShowProblems
            | Ask::Settle(..)
            | Ask::TakeUp(_)
            | Ask::Prefer(_)
            | Ask::StopWork(_) => "of another panel".to_owned(),
            Ask::ListPresets | Ask::PicturePresets(_) => return,
            Ask::SavePreset(of) => self.asked(format!("save for {}", name_of(&of))),
            Ask::LoadPreset(of) => self.asked(format!("load for {}", name_of(&of))),
            Ask::UsePreset(of, path) => self.asked(format!("use {} for {}", path.display(), name_of(&of))),
            Ask::ChoosePicture(of) => format!("choose {}", of.words()),
            Ask::NamePicture(of, name) => {
                let command = of.command(self.document.scene(), name).expect("it is there");
                self.document.apply(&command).map_or_else(refused, words)
            }
            Ask::Menu(item) => {
                self.menu = Some(item);
                "menu".to_owned()
            }
            Ask::Reach(control) => {
                let words = format!("reach {}", control.name);
                self.reach = Some(control);
                words
            }
            Ask::Session(session) => {
                self.session = *session;
                "session".to_owned()
            }
        };
        self.log.push(words);
    }

    pub fn apply(&mut self, command: Command) {
        self.document.apply(&command).expect("it is no bad command");
    }

    pub fn region(&self, name: &str) -> &impasto_scene::document::Region {
        let mut regions = self.document.scene().regions.iter();
        regions.find(|region| region.name == name).expect("the region is there")
    }
}

pub const SIZE: Vec2 = Vec2::new(280.0, 692.0);

/// A harness without a renderer, so it can take no pictures.
pub fn harness_of(column: Column, theme: Theme, size: Vec2) -> Harness<'static, Column> {
    build(builder(theme, size), column)
}

pub fn builder(theme: Theme, size: Vec2) -> HarnessBuilder<Column> {
    Harness::builder()
        .with_size(size)
        .with_theme(if theme == Theme::Dark { egui::Theme::Dark } else { egui::Theme::Light })
        .with_render_cursor(false)
        .with_context_setup(move |ctx| theme::apply(ctx, theme, 1.0))
}

pub fn build(builder: HarnessBuilder<Column>, column: Column) -> Harness<'static, Column> {
    let mut harness = builder.build_ui_state(|ui, column: &mut Column| column.ui(ui), column);
    harness.run();
    harness
}

/// A harness in a window that is high enough for every row, with the rows of the tree expanded. The inspector's
/// sections stay as they are at first.
pub fn harness(scene: &str, selected: Option<Item>) -> Harness<'static, Column> {
    let mut column = Column::open(scene);
    column.document.select(selected.into_iter().collect());
    column.tree_height = 800.0;
    let mut harness = harness_of(column, Theme::Dark, vec2(280.0, 2400.0));
    let folded: Vec<String> = harness
        .query_all_by_label_contains("Expand ")
        .filter(|node| node.accesskit_node().toggled() == Some(Toggled::False))
        .filter_map(|node| node.accesskit_node().label())
        .collect();
    for name in folded {
        click(&mut harness, &name);
    }
    harness
}

pub fn region(name: &str) -> Option<Item> {
    Some(Item::Region(name.to_owned()))
}

pub fn object(name: &str) -> Option<Item> {
    Some(Item::Object(name.to_owned()))
}

pub fn click(harness: &mut Harness<'_, Column>, name: &str) {
    harness.get_by_label(name).click();
    harness.run();
}

pub fn pick(harness: &mut Harness<'_, Column>, combo: &str, choice: &str) {
    click(harness, combo);
    // The combo shows the chosen word as well; only the rows of its menu are menu items.
    let row =
        harness.get_all_by_label(choice).find(|node| node.accesskit_node().role() == Role::MenuItemRadio);
    row.expect("the menu has it").click();
    harness.run();
}

pub fn drag(harness: &mut Harness<'_, Column>, name: &str, by: f32) {
    let middle = harness.get_by_label(name).rect().center();
    harness.drag_at(middle);
    harness.run();
    for part in 1..=4 {
        harness.hover_at(middle + vec2(by * part as f32 / 4.0, 0.0));
        harness.run();
    }
    harness.drop_at(middle + vec2(by, 0.0));
    harness.run();
}

pub fn right_click(harness: &mut Harness<'_, Column>, name: &str) {
    let pos = harness.get_by_label(name).rect().center();
    harness.event(egui::Event::PointerMoved(pos));
    for pressed in [true, false] {
        let (button, modifiers) = (egui::PointerButton::Secondary, egui::Modifiers::NONE);
        harness.event(egui::Event::PointerButton { pos, button, pressed, modifiers });
        harness.run();
    }
}

pub fn type_in(harness: &mut Harness<'_, Column>, name: &str, text: &str) {
    harness.get_by_label(name).focus();
    harness.run();
    harness.key_press(Key::Enter);
    harness.run();
    harness.event(egui::Event::Text(text.to_owned()));
    harness.run();
    harness.key_press(Key::Enter);
    harness.run();
}

pub fn assert_named(harness: &Harness<'_, Column>, names: &[&str]) {
    for name in names {
        let found: Vec<_> = harness.get_all_by_label(name).collect();
        assert!(!found.is_empty(), "{name} is not there");
        for control in found.iter().filter(|node| node.accesskit_node().role() != Role::Label) {
            let size = control.rect().size();
            assert!(size.x >= 24.0 && size.y >= 23.0, "{name} is {size} points");
        }
    }
}

/// Two guides on a region of the apple.
pub fn with_guides(column: &mut Column) {
    let point = |x: f64| GuidePoint { at: [x, 0.5, 0.5], normal: [0.0, 0.0, 1.0], turn_deg: 0.0 };
    let guide = |count: usize| Guide {
        mode: Default::default(),
        curve: count == 5,
        object: None,
        view: None,
        points: (0..count).map(|index| point(0.05 * index as f64)).collect(),
        radius: 0.2,
        strength: 0.8,
        falloff: Default::default(),
    };
    column.apply(Command::Directions(impasto_editor_model::command::Directions::Erase {
        region: "apple".to_owned(),
        guides: vec![guide(9), guide(5)],
    }));
}
