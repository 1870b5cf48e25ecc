//! A page for tests that shows the window's bars round an empty middle, and keeps what they ask for.

use std::path::{Path, PathBuf};

use impasto_editor::panels::ask_close::{self, Answer, Question};
use impasto_editor::panels::{
    Ask, Numbers, PanelInput, empty, options_bar, palette, rail, shortcuts, status_line, strip, top_bar,
    welcome,
};
use impasto_editor::theme::{Theme, Tokens};
use impasto_editor_model::command::SceneEdit;
use impasto_editor_model::keymap::{Keymap, Preset};
use impasto_editor_model::session::{Mode, Tool};
use impasto_editor_model::timeline::{TimeHand, TimelineEvent, lanes};
use impasto_editor_model::{Command, Document, Session};

pub const COMBING: &str = "[Drag] comb  [Shift] smooth  [Ctrl] against  [F] radius  [Middle] orbit";
pub const DROP: &str = "Drop a mesh or a scene anywhere in the window";

/// What is shown over the bars.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shows {
    Bars,
    Welcome,
    Keys,
    Palette,
    /// The question with this index in `questions`.
    Question(usize),
}

pub struct Page {
    pub document: Document,
    pub session: Session,
    pub time: TimeHand,
    pub keymap: Keymap,
    pub status: String,
    pub recent: Vec<PathBuf>,
    pub shows: Shows,
    pub choices: welcome::Choices,
    pub questions: Vec<Question>,
    /// What the bars asked for, except changes of the session or the frame: the page makes those itself. Events on
    /// animation keys are here as the commands that they led to.
    pub asked: Vec<Ask>,
    pub left: Option<welcome::Left>,
    pub answer: Option<Answer>,
    /// Whether the page carries out commands and previews that the bars ask for, in place of keeping them in `asked`.
    pub applies: bool,
}

fn scenes() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes")
}

pub fn nothing() -> Document {
    Document::empty(&scenes())
}

/// An apple before a wall.
pub fn apple() -> Document {
    Document::open(&scenes().join("apple.ron"), &Default::default()).expect("the apple opens")
}

/// A document whose name is too long for the top bar.
pub fn with_a_long_name() -> Document {
    let folder = tempfile::tempdir().expect("a folder");
    let mut document = Document::empty(folder.path());
    let name = "a_still_life_with_an_apple_a_lemon_and_everything_else.ron";
    document.save_as(&folder.path().join(name)).expect("saved");
    document
}

impl Page {
    pub fn new() -> Self {
        let scene = scenes().join("still_life.ron");
        Self {
            document: Document::open(&scene, &Default::default()).expect("the still life opens"),
            session: Session::default(),
            time: TimeHand::default(),
            keymap: Keymap::default(),
            status: COMBING.to_owned(),
            recent: vec![scene, PathBuf::from("/pictures/pears.ron")],
            shows: Shows::Bars,
            choices: welcome::Choices {
                keys: Preset::Blender,
                theme: Theme::Dark,
                scale: 1.0,
                at_start: true,
            },
            questions: Vec::new(),
            asked: Vec::new(),
            left: None,
            answer: None,
            applies: false,
        }
    }

    pub fn in_mode(mut self, mode: Mode) -> Self {
        self.session.mode = mode;
        self
    }

    pub fn with_tool(mut self, tool: Tool) -> Self {
        self.session.set_tool(tool);
        self
    }

    pub fn edited(mut self) -> Self {
        self.document.apply(&Command::Scene(SceneEdit::SetSeed(77))).expect("a seed");
        self
    }

    pub fn ui(&mut self, ui: &mut egui::Ui) {
        // The test harness leaves a margin round its contents; the window has none.
        let whole = ui.ctx().content_rect();
        let ui = &mut ui.new_child(egui::UiBuilder::new().max_rect(whole));
        ui.set_clip_rect(whole);
        let mut asks = Vec::new();
        let shown = PanelInput {
            status: &self.status,
            numbers: Numbers {
                strokes: 5774,
                pictures_per_second: Some(41.2),
                driver: "llvmpipe",
                ..Numbers::default()
            },
            recent: &self.recent,
            ..PanelInput::of(&self.document, &self.session, &self.time, &self.keymap)
        };
        top_bar::top_bar(ui, &shown, &mut asks);
        status_line::status_line(ui, &shown, &mut asks);
        strip::strip(ui, &shown, &mut asks);
        options_bar::options_bar(ui, &shown, &mut asks);
        rail::rail(ui, &shown, &mut asks);
        let middle = egui::Frame::new().fill(Tokens::of(ui).app);
        egui::CentralPanel::default().frame(middle).show(ui, |ui| empty::empty(ui, &shown, &mut asks));
        let ctx = ui.ctx().clone();
        let closed = match self.shows {
            Shows::Bars => false,
            Shows::Keys => shortcuts::shortcuts(&ctx, &shown, &mut asks),
            Shows::Palette => palette::palette(&ctx, &shown, &mut asks),
            Shows::Welcome => {
                let left = welcome::welcome(&ctx, &mut self.choices);
                self.left = left.or(self.left);
                left.is_some()
            }
            Shows::Question(index) => {
                self.answer = ask_close::ask(&ctx, &self.questions[index]);
                self.answer.is_some()
            }
        };
        if closed {
            self.shows = Shows::Bars;
        }
        for ask in asks {
            match ask {
                Ask::Session(session) => self.session = *session,
                Ask::Timeline(TimelineEvent::Scrub(frame) | TimelineEvent::GoTo(frame)) => {
                    self.session.frame = frame;
                }
                Ask::Timeline(TimelineEvent::EndScrub) => {}
                Ask::Timeline(TimelineEvent::Keys(event)) => {
                    let lanes = lanes(self.document.scene());
                    let command = self.time.keys.take(event, &lanes);
                    self.asked.extend(command.map(Ask::Do));
                }
                Ask::Do(command) if self.applies => drop(self.document.apply(&command).expect("done")),
                Ask::DoMerged(command, of) if self.applies => {
                    drop(self.document.apply_merged(&command, &of, 0.0).expect("done"));
                }
                Ask::Preview(command) if self.applies => self.document.preview(&command).expect("shown"),
                Ask::EndPreview if self.applies => self.document.end_preview(),
                other => self.asked.push(other),
            }
        }
    }
}
