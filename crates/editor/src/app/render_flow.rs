//! Rendering to files from the window: the render sheet, its thread, and its questions.

use std::path::{Path, PathBuf};
use std::time::Duration;

use egui::{Context, TextureHandle, TextureOptions};
use impasto_editor_model::render_settings::{
    FileKind, Outcome, RenderPlan, RenderProgress, RenderSettings, shell_words,
};
use impasto_gl_render::ShaderTexts;

use super::EditorApp;
use super::frame_view::FrameView;
use crate::files::file_ask::FileAsk;
use crate::files::incoming::name_of;
use crate::files::show_folder::show_folder;
use crate::panels::ask_close::{self, Answer, Question};
use crate::panels::render_sheet::{RenderAsk, RenderShown, render_sheet};
use crate::panels::work::{Work, WorkKind};
use crate::rendering::Rendering;
use crate::window::Waker;

/// How often the progress is updated while frames are rendered.
const TICK: Duration = Duration::from_millis(500);

pub(super) struct RenderFlow {
    waker: Waker,
    settings: Option<RenderSettings>,
    /// The scene's size when the sheet was last opened.
    size_of_scene: (u32, u32),
    is_open: bool,
    running: Option<Rendering>,
    picture: Option<TextureHandle>,
    asks: Option<About>,
    /// Whether the user was told how the last rendering ended.
    told: bool,
}

/// The question that is open.
enum About {
    /// This many of the plan's frames have a file already.
    Existing(Box<RenderPlan>, u64),
    /// The window would close while frames are rendered.
    Closing,
}

impl RenderFlow {
    pub(super) fn new(waker: Waker) -> Self {
        Self {
            waker,
            settings: None,
            size_of_scene: (0, 0),
            is_open: false,
            running: None,
            picture: None,
            asks: None,
            told: true,
        }
    }

    /// Resets the settings for another document. A rendering under way goes on.
    pub(super) fn forget(&mut self) {
        self.settings = None;
    }

    pub(super) fn is_modal(&self) -> bool {
        self.is_open || self.asks.is_some()
    }

    /// Whether the window must stay open because frames are rendered. If so, opens the question whether to stop.
    pub(super) fn holds_window(&mut self) -> bool {
        let runs = self.running.as_ref().is_some_and(|running| !running.is_over());
        if runs {
            self.asks = Some(About::Closing);
        }
        runs
    }

    /// What the status line shows while the sheet is folded away.
    pub(super) fn work(&self) -> Option<Work> {
        let progress = self.running.as_ref().filter(|_| !self.is_open)?.progress();
        let words = match &progress.outcome {
            None => format!("Rendering {}", progress.count()),
            Some(Outcome::Done) => format!("Rendered {}", progress.count()),
            Some(Outcome::Stopped) => format!("Stopped at {}", progress.count()),
            Some(Outcome::Failed(_)) => format!("Rendering broke off at {}", progress.count()),
        };
        Some(Work { words, share: Some(progress.share() as f32), kind: WorkKind::Rendering })
    }

    /// Shows the sheet of a rendering again.
    pub(super) fn unfold(&mut self) {
        self.is_open = true;
    }

    /// How many frames are finished, and the files of those that can be viewed. `None` if the number is still `before`,
    /// or if there is no rendering.
    pub(super) fn finished_since(&self, before: u64) -> Option<(u64, Vec<(i64, PathBuf)>)> {
        let running = self.running.as_ref()?;
        let done = running.progress().done();
        (done != before).then(|| (done, running.plan().finished(done)))
    }

    fn begin(&mut self, plan: RenderPlan, shaders: ShaderTexts) -> Result<(), String> {
        let waker = self.waker.clone();
        // The previous rendering is over, and its files are written.
        self.running = None;
        self.picture = None;
        let running = Rendering::start(plan, shaders, move || waker.wake());
        self.running = Some(running.map_err(|error| format!("No thread to render with: {error}"))?);
        self.told = false;
        Ok(())
    }
}

impl EditorApp {
    /// Opens the sheet, or unfolds it.
    pub(super) fn open_render_sheet(&mut self) {
        if self.editor.document().scene().objects.is_empty() {
            return self.toast("There is nothing to render: the scene is empty", None, true);
        }
        let size = self.editor.document().scene().size;
        let flow = &mut self.render;
        let settings =
            flow.settings.get_or_insert_with(|| RenderSettings::of(self.editor.document().scene()));
        // As long as no other size was chosen, follow the scene's.
        if settings.size_px == [flow.size_of_scene.0, flow.size_of_scene.1] {
            settings.size_px = [size.0, size.1];
        }
        flow.size_of_scene = size;
        flow.is_open = true;
        if flow.running.as_ref().is_some_and(Rendering::is_over) && flow.told {
            (flow.running, flow.picture) = (None, None);
        }
    }

    pub(super) fn open_movie_sheet(&mut self) {
        self.open_render_sheet();
        if let Some(settings) = self.render.settings.as_mut().filter(|_| self.render.is_open) {
            settings.choose_kind(FileKind::Movie);
        }
    }

    pub(super) fn render_sheets(&mut self, ctx: &Context) {
        self.follow_rendering(ctx);
        if self.render.asks.is_some() {
            self.ask_about_rendering(ctx);
        } else if self.render.is_open && !self.files.is_asking() {
            self.show_render_sheet(ctx);
        }
    }

    fn follow_rendering(&mut self, ctx: &Context) {
        let flow = &mut self.render;
        let Some(running) = &flow.running else { return };
        if let Some(picture) = running.take_picture() {
            flow.picture = Some(ctx.load_texture("last frame", picture, TextureOptions::LINEAR));
        }
        let progress = running.progress();
        let Some(outcome) = progress.outcome.clone() else {
            return ctx.request_repaint_after(TICK);
        };
        if std::mem::replace(&mut flow.told, true) || flow.is_open {
            return;
        }
        let folder = running.plan().folder().display().to_string();
        let failed = matches!(outcome, Outcome::Failed(_));
        let words = progress.state_words();
        self.toast(if failed { words } else { format!("{words}, in {folder}") }, None, failed);
    }

    fn show_render_sheet(&mut self, ctx: &Context) {
        let Some(mut settings) = self.render.settings.take() else { return };
        let progress: Option<RenderProgress> = self.render.running.as_ref().map(Rendering::progress);
        let shown = RenderShown {
            document: self.editor.document(),
            frame: self.editor.session.frame,
            driver: self.picture_flow.driver(),
            progress: progress.as_ref(),
            picture: self.render.picture.as_ref(),
            viewable: progress.as_ref().is_some_and(|progress| progress.done() > 0)
                && self.render.running.as_ref().is_some_and(|running| running.plan().kind.has_png()),
        };
        let ask = render_sheet(ctx, &shown, &mut settings);
        self.render.settings = Some(settings);
        match ask {
            None => {}
            Some(RenderAsk::Render) => self.start_rendering(),
            Some(RenderAsk::Stop) => {
                if let Some(running) = &self.render.running {
                    running.stop();
                }
            }
            Some(RenderAsk::WorkOn) => self.render.is_open = false,
            Some(RenderAsk::Close) => {
                (self.render.is_open, self.render.running, self.render.picture) = (false, None, None);
            }
            Some(RenderAsk::OpenFolder) => {
                let folder = self.render.running.as_ref().map(|running| running.plan().folder().to_owned());
                if let Some(Err(words)) = folder.as_deref().map(show_folder) {
                    self.toast(words, None, true);
                }
            }
            Some(RenderAsk::View) => self.view_frames(),
            Some(RenderAsk::CopyCommand) => self.copy_render_command(ctx),
            Some(RenderAsk::Browse) => {
                let ending = self.render.settings.as_ref().map_or("png", RenderSettings::ending);
                let start = match self.render_plan() {
                    Some(Ok(plan)) => plan.output().to_owned(),
                    _ => self.editor.document().folder().join(format!("frame_####.{ending}")),
                };
                self.files.dialogs.open(ctx, FileAsk::RenderOutput { ending }, &start);
            }
        }
    }

    /// Shows the finished frames of the rendering in place of the page; the sheet closes, and rendering goes on.
    fn view_frames(&mut self) {
        let Some(running) = &self.render.running else { return };
        let finished = self.render.finished_since(0).unwrap_or_default();
        match FrameView::open(finished, running.plan().loaded.scene.timeline.fps, self.render.waker.clone()) {
            Ok(view) => {
                (self.frame_view, self.render.is_open) = (Some(view), false);
                self.editor.stop_playing();
            }
            Err(words) => self.toast(words, None, true),
        }
    }

    fn render_plan(&self) -> Option<Result<RenderPlan, String>> {
        let plan = self.render.settings.as_ref()?.plan(self.editor.document(), self.editor.session.frame);
        Some(plan.map_err(|fault| fault.words))
    }

    fn start_rendering(&mut self) {
        match self.render_plan() {
            None => {}
            Some(Err(words)) => self.toast(words, None, true),
            Some(Ok(plan)) => match plan.existing_count() as u64 {
                0 => self.begin_rendering(plan),
                there => self.render.asks = Some(About::Existing(Box::new(plan), there)),
            },
        }
    }

    fn begin_rendering(&mut self, plan: RenderPlan) {
        if let Err(words) = self.render.begin(plan, self.shaders.texts()) {
            self.toast(words, None, true);
        }
    }

    fn ask_about_rendering(&mut self, ctx: &Context) {
        let question = match &self.render.asks {
            None => return,
            Some(About::Existing(plan, _)) if plan.kind == FileKind::Movie => {
                Question::MovieThere { name: name_of(plan.output()) }
            }
            Some(About::Existing(plan, there)) => {
                Question::FramesThere { there: *there, total: plan.frames.count() }
            }
            Some(About::Closing) => {
                let progress = self.render.running.as_ref().map(Rendering::progress).unwrap_or_default();
                let plan = self.render.running.as_ref().map(Rendering::plan);
                let stays = plan.is_some_and(|plan| plan.kind != FileKind::Movie);
                Question::StopRendering { count: progress.count(), stays }
            }
        };
        let Some(answer) = ask_close::ask(ctx, &question) else { return };
        match (self.render.asks.take(), answer) {
            (Some(About::Existing(plan, _)), Answer::ReplaceFrames) => self.begin_rendering(*plan),
            (Some(About::Existing(plan, _)), Answer::KeepFrames) => {
                self.begin_rendering(plan.keeping());
            }
            (Some(About::Closing), Answer::StopRendering) => {
                if let Some(running) = &self.render.running {
                    running.stop();
                }
                (self.render.running, self.render.told) = (None, true);
                self.quit_asking();
            }
            _ => {}
        }
    }

    fn copy_render_command(&mut self, ctx: &Context) {
        let document = self.editor.document();
        let command = self.render_plan().map(|plan| plan.and_then(|plan| plan.command(document)));
        match command {
            None => {}
            Some(Err(words)) => self.toast(words, None, true),
            Some(Ok(mut words)) => {
                words.extend(self.shaders.arguments());
                ctx.copy_text(shell_words("impasto", &words));
                let note = if self.editor.document().is_edited() {
                    "Copied. It renders the file as it was saved last, without what was edited since"
                } else {
                    "Copied: it renders the same files in a terminal"
                };
                self.toast(note, None, false);
            }
        }
    }

    /// Sets the output to files named like this one.
    pub(super) fn render_to(&mut self, file: &Path) {
        let folder = self.editor.document().folder();
        let folder = std::path::absolute(folder).unwrap_or_else(|_| folder.to_owned());
        if let Some(settings) = &mut self.render.settings {
            let shown = file.strip_prefix(&folder).unwrap_or(file);
            settings.choose_output(shown.to_string_lossy().into_owned());
        }
    }
}
