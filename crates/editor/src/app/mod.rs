//! The application: connects `editor_model::Editor` with the panels, the viewport and the painting thread.
//!
//! ```text
//! keys, pointer ─▶ Editor ─▶ scene as shown ─▶ Worker ─▶ painting, pictures ─▶ viewport
//! panels ─▶ Ask ──────▲                                       └─▶ direction marks, picking
//! ```

mod adopted;
mod asks;
mod comb_preview;
mod file_flow;
mod following;
mod frame_view;
mod keys;
mod last_seen;
mod lights;
mod long_work;
mod marks;
mod motion_marks;
mod picture;
mod picture_view;
mod preferring;
mod preset_flow;
mod render_flow;
mod safe_keeping;
mod shader_flow;
mod telling;
mod troubles;
mod view;

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use egui::{CentralPanel, Context, Ui};
use impasto_editor_model::command::Command;
use impasto_editor_model::document::Document;
use impasto_editor_model::editor::{Editor, Offer, Said, reference_frame};
use impasto_editor_model::keymap::{Digits, Key, Keymap, Modifiers, Preset};
use impasto_gl_render::ShaderTexts;
use impasto_scene::built_in_mesh::is_built_in;
use impasto_scene::problem::Report;

use crate::files::dialogs::FileDialogs;
use crate::files::preferences::{Keys, Loaded, Preferences};
use crate::options::EditOptions;
use crate::panels::problems::{Trouble, TroubleOf};
use crate::panels::{self, Area, Ask, Numbers, PanelInput, area};
use crate::theme;
use crate::widgets::{Toast, toasts};
use crate::window::{self, Opened, numpad_pressed, tab_pressed};
use impasto_gl_render::shader_folder::ShaderFolder;

use file_flow::FileFlow;
use following::Following;
use frame_view::FrameView;
use long_work::LongWork;
use marks::MarkCache;
use picture::{News, PictureFlow};
use preset_flow::PresetFlow;
use render_flow::RenderFlow;
use safe_keeping::SafeKeeping;
use shader_flow::ShaderFlow;
use telling::Telling;

/// How long a message at the bottom stays.
const TOAST: Duration = Duration::from_secs(4);
/// How long a message that reports an error stays.
const ERROR_TOAST: Duration = Duration::from_secs(10);

pub(crate) struct EditorApp {
    ctx: Context,
    editor: Editor,
    picture_flow: PictureFlow,
    marks: MarkCache,
    files: FileFlow,
    safe: SafeKeeping,
    render: RenderFlow,
    /// The finished frames, while they are shown in place of the page.
    frame_view: Option<FrameView>,
    long: LongWork,
    shaders: ShaderFlow,
    following: Following,
    preferences: Preferences,
    sheets: Sheets,
    toasts: Vec<(Toast, Instant, Option<Offer>)>,
    folds: Folds,
    telling: Telling,
    /// What failed and is not settled yet.
    troubles: Vec<Trouble>,
    /// How many losses (parts of the scene that could not be read) the document had in the previous pass.
    losses_told: usize,
    likely_meshes: LikelyMeshes,
    presets: PresetFlow,
}

/// Missing meshes, and for some of them the file in the scene's folder that is likely meant.
#[derive(Default)]
struct LikelyMeshes {
    folder: PathBuf,
    of: Vec<String>,
    found: Vec<(String, String)>,
}

/// Which sheets are open over the window.
#[derive(Default)]
struct Sheets {
    welcome: bool,
    palette: bool,
    shortcuts: bool,
    /// The sheet that changes keys.
    keys: bool,
    recapture: Option<i64>,
    /// A command that takes triangles from other regions, and these triangles in words: *340 triangles of skin*.
    take_faces: Option<(Command, String)>,
    problems: bool,
}

#[derive(Default)]
struct Folds {
    column: bool,
    /// Whether all panels are folded away, so that only the viewport is left.
    everything: bool,
    /// Whether the window had the focus in the previous pass.
    had_focus: bool,
}

impl EditorApp {
    /// Opens what the command line names, or an empty scene.
    pub(crate) fn new(
        options: &EditOptions,
        loaded: Loaded,
        shaders: Option<(ShaderFolder, ShaderTexts)>,
        opened: &Opened,
    ) -> Self {
        let preferences = loaded.preferences;
        let here = std::env::current_dir().unwrap_or_else(|_| PathBuf::from("."));
        let driver = options.driver.unwrap_or(preferences.driver);
        let mut app = Self {
            ctx: opened.ctx.clone(),
            editor: Editor::new(Document::empty(&here)),
            picture_flow: PictureFlow::new(driver, opened.waker.clone()),
            marks: MarkCache::default(),
            files: FileFlow::new(FileDialogs::new(options.dialogs)),
            safe: SafeKeeping::new(),
            render: RenderFlow::new(opened.waker.clone()),
            frame_view: None,
            long: LongWork::new(opened.waker.clone()),
            shaders: ShaderFlow::default(),
            following: if options.follow {
                Following::stdin(opened.waker.clone())
            } else {
                Following::default()
            },
            sheets: Sheets {
                welcome: preferences.show_welcome && options.path.is_none(),
                ..Sheets::default()
            },
            preferences,
            toasts: Vec::new(),
            folds: Folds::default(),
            telling: Telling::new(options.tell),
            troubles: Vec::new(),
            losses_told: 0,
            likely_meshes: LikelyMeshes::default(),
            presets: PresetFlow::new(picture::driver_of(driver), opened.waker.clone()),
        };
        app.keymap();
        app.use_shaders(shaders);
        opened.ctx.add_plugin(window::FocusRules);
        theme::apply(&opened.ctx, app.preferences.theme, app.preferences.scale);
        for note in loaded.note.into_iter().chain(app.preferences.own_keys.fault()) {
            app.toast(note, None, true);
        }
        if let Some(path) = &options.path {
            app.open(path);
        } else {
            app.offer_copies(None);
        }
        app
    }

    /// Applies the preferences for keys, comb preview and pen pressure.
    fn keymap(&mut self) {
        self.editor.keymap = Keymap {
            preset: match self.preferences.keys {
                Keys::Blender => Preset::Blender,
                Keys::Maya => Preset::Maya,
            },
            digits: if self.preferences.digits_as_numpad { Digits::NumPad } else { Digits::Modes },
            own: self.preferences.own_keys.keys(),
        };
        self.editor.session.options.foresee =
            self.preferences.foresee_strokes && !self.preferences.reduced_motion;
        self.editor.session.options.pressure = self.preferences.pressure;
    }

    fn opened(&mut self, path: &Path, opened: Result<Document, Report>) {
        match opened {
            Ok(document) => {
                self.note_last_seen();
                self.settled(&TroubleOf::Open(path.to_owned()));
                self.forget_document();
                let scene = document.scene();
                let regions = scene.regions.len();
                let own = document.loaded().meshes.iter().filter(|(name, _)| !is_built_in(name));
                let triangles: usize = own.map(|(_, file)| file.mesh.triangles.len()).sum();
                let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
                let warnings = document.loaded().warnings.len();
                let losses = document.loss_count();
                self.editor.open(document);
                self.keymap();
                self.sheets.welcome = false;
                self.sheets.problems = losses > 0;
                self.toast(format!("{name}: {triangles} triangles, {regions} regions"), None, false);
                if warnings > 0 && losses == 0 {
                    let words =
                        if warnings == 1 { "1 warning".to_owned() } else { format!("{warnings} warnings") };
                    self.toast(
                        format!("{words}: see the list of problems, at the bottom right"),
                        None,
                        false,
                    );
                }
                self.go_to_last_seen(path);
                self.preferences.note_recent(path);
                self.keep_preferences();
                self.offer_copies(Some(path));
            }
            Err(report) => {
                let fatal = report.0.iter().filter(|problem| problem.severity.is_fatal()).take(3);
                let words: Vec<String> = fatal.map(ToString::to_string).collect();
                self.trouble(TroubleOf::Open(path.to_owned()), words.join("; "));
            }
        }
    }

    /// Drops what belongs to the document that is shown, before another takes its place.
    fn forget_document(&mut self) {
        self.picture_flow.forget();
        self.render.forget();
        self.frame_view = None;
        panels::problems::forget_text(&self.ctx);
        self.troubles.retain(|trouble| matches!(trouble.of, TroubleOf::Open(_)));
    }

    fn keep_preferences(&mut self) {
        if let Err(words) = file_flow::keep(&self.preferences) {
            self.toast(words, None, true);
        }
    }

    fn toast(&mut self, words: impl Into<String>, offers: Option<Offer>, error: bool) {
        let action = if offers.is_some() { "Undo".to_owned() } else { String::new() };
        let toast = Toast { words: words.into(), action, error };
        self.toasts.retain(|(other, ..)| other.words != toast.words);
        self.toasts.push((toast, Instant::now(), offers));
    }

    fn is_modal(&self) -> bool {
        self.has_sheet() || self.frame_view.is_some()
    }

    /// Whether a sheet or a question is open over the page, or over the viewer of frames.
    fn has_sheet(&self) -> bool {
        let Sheets { welcome, palette, shortcuts, keys, recapture, take_faces, problems: _ } = &self.sheets;
        let asks = self.files.is_asking() || self.safe.is_asking() || self.render.is_modal();
        *welcome || *palette || *shortcuts || *keys || recapture.is_some() || take_faces.is_some() || asks
    }

    fn page(&mut self, ui: &mut Ui, numpad: &[(Key, Modifiers)]) {
        let status = self.editor.status();
        let driver = self.picture_flow.driver().to_owned();
        let recent: Vec<PathBuf> = self.preferences.recent_there().into_iter().map(Path::to_owned).collect();
        let mut asks: Vec<Ask> = Vec::new();
        self.likely_meshes.follow(self.editor.document());
        let works = self.works(ui.ctx());
        // Losses that come back, for instance after an undo, open the list of problems again.
        let losses = self.editor.document().loss_count();
        self.sheets.problems |= losses > self.losses_told;
        self.losses_told = losses;
        let shown = PanelInput {
            document: self.editor.document(),
            session: &self.editor.session,
            has_column: !self.folds.column && !self.folds.everything,
            time: self.editor.time(),
            painting: self.editor.painting(),
            keymap: &self.editor.keymap,
            status: &status,
            numbers: Numbers {
                strokes: self.picture_flow.strokes(),
                strokes_of: self.picture_flow.strokes_of(),
                pictures_per_second: self.picture_flow.pictures_per_second(),
                driver: &driver,
                finished: self.picture_flow.finished(),
                works: &works,
            },
            recent: &recent,
            troubles: &self.troubles,
            likely_meshes: &self.likely_meshes.found,
            presets: &self.presets.own,
            preset_pictures: self.presets.pictures(),
        };
        if !self.folds.everything {
            area(ui, Area::TopBar, |ui| panels::top_bar::top_bar(ui, &shown, &mut asks));
            panels::status_line::status_line(ui, &shown, &mut asks);
            area(ui, Area::Strip, |ui| panels::strip::strip(ui, &shown, &mut asks));
            self.sheets.problems &= self.sheets.problems && panels::problems::problems(ui, &shown, &mut asks);
            if !self.folds.column && panels::column_fits(ui, &shown) {
                panels::column(ui, &shown, &mut asks);
            }
            area(ui, Area::Options, |ui| panels::options_bar::options_bar(ui, &shown, &mut asks));
            area(ui, Area::Rail, |ui| panels::rail::rail(ui, &shown, &mut asks));
        }
        let palette_closed = self.sheets.palette && panels::palette::palette(ui.ctx(), &shown, &mut asks);
        let shortcuts_closed =
            self.sheets.shortcuts && panels::shortcuts::shortcuts(ui.ctx(), &shown, &mut asks);
        let keys_closed =
            self.sheets.keys && panels::key_sheet::key_sheet(ui.ctx(), &shown, numpad, &mut asks);
        panels::context_menu(ui, &shown, &mut asks);
        self.sheets.palette &= !palette_closed;
        self.sheets.shortcuts &= !shortcuts_closed;
        self.sheets.keys &= !keys_closed;
        CentralPanel::default()
            .frame(egui::Frame::NONE)
            .show(ui, |ui| area(ui, Area::Viewport, |ui| self.viewport(ui, &mut asks)));
        let view = self.picture_flow.view(&self.editor);
        for ask in asks {
            self.answer(ask, ui.ctx(), &view);
        }
    }

    fn show_toasts(&mut self, ctx: &Context) {
        for Said { words, offers, is_refusal } in self.editor.take_said() {
            self.toast(words, offers, is_refusal);
        }
        let stays = |toast: &Toast| if toast.error { ERROR_TOAST } else { TOAST };
        self.toasts.retain(|(toast, since, _)| since.elapsed() < stays(toast));
        let shown: Vec<Toast> = self.toasts.iter().map(|(toast, ..)| toast.clone()).collect();
        let clear = if self.folds.everything {
            12.0
        } else {
            let wide = ctx.content_rect().width();
            panels::timeline::height(&self.editor.session, wide) + theme::measure::STATUS_LINE
        };
        if let Some(clicked) = toasts(ctx, &shown, clear) {
            let (_, _, offers) = self.toasts.remove(clicked);
            match offers {
                Some(Offer::Undo) => {
                    let view = self.picture_flow.view(&self.editor);
                    self.editor.act(impasto_editor_model::keymap::Action::Undo, &view);
                }
                Some(Offer::PoseAgain) => self.editor.pose_again(),
                None => {}
            }
        }
        if !self.toasts.is_empty() {
            ctx.request_repaint_after(Duration::from_millis(500));
        }
    }
}

impl LikelyMeshes {
    /// Searches the scene's folder if the folder or the missing meshes have changed.
    fn follow(&mut self, document: &Document) {
        let loaded = document.shown();
        let is_missing = |mesh: &&str| document.lacks_mesh(mesh);
        let missing = loaded.scene.objects.iter().map(|object| object.mesh.as_str()).filter(is_missing);
        if self.folder != document.folder() || !missing.clone().eq(self.of.iter().map(String::as_str)) {
            let missing: Vec<&str> = missing.collect();
            self.found = crate::files::nearby::meshes_like(document.folder(), &missing);
            self.of = missing.into_iter().map(str::to_owned).collect();
            self.folder = document.folder().to_owned();
        }
    }
}

impl window::App for EditorApp {
    fn ui(&mut self, ui: &mut Ui, frame: &mut window::Frame<'_>) {
        let ctx = ui.ctx().clone();
        let window = ctx.content_rect().size() * ctx.zoom_factor();
        let scale = theme::fitting_scale(self.preferences.scale, window);
        if scale != ctx.zoom_factor() {
            ctx.set_zoom_factor(scale);
        }
        self.editor.tick(ui.input(|input| input.time));
        self.follow_reading(&ctx);
        self.follow();
        self.presets.follow(&ctx);
        let news = self.picture_flow.poll(&ctx, &mut self.editor);
        if news == Some(News::NextOfFilm) {
            self.tell_played();
        }
        // While the view moves, the window is redrawn only with a new picture, so that the marks fit it.
        if news.is_none() && self.editor.is_navigating() && self.picture_flow.is_awaited() {
            frame.hold();
        }
        let view = self.picture_flow.view(&self.editor);
        let focused = ui.input(|input| input.focused);
        if self.folds.had_focus && !focused {
            self.editor.focus_lost(&view);
        }
        if focused && !self.folds.had_focus {
            self.safe.look_now();
            self.list_presets();
        }
        self.folds.had_focus = focused;
        let numpad = numpad_pressed(&ctx);
        // While a menu is open, keys belong to it.
        if !self.is_modal() && !egui::Popup::is_any_open(&ctx) {
            if let Some(held) = tab_pressed(&ctx) {
                self.editor.key(Key::Tab, keys::held(held), false, &view);
            }
            keys::wheel(ui, &mut self.editor);
            keys::hand_on(ui, &mut self.editor, &view, &numpad);
        }
        match self.frame_view.is_some() {
            true => self.show_frames(ui, &numpad),
            false => self.page(ui, &numpad),
        }
        let now = ui.input(|input| input.time);
        if let Some(wait) = self.editor.time().playback.wait_secs(now) {
            ctx.request_repaint_after(Duration::from_secs_f64(wait.min(1.0)));
        }
        self.requests(&ctx);
        if self.file_sheets(&ctx, ui) {
            self.safe.give_up();
            frame.close();
        }
        self.render_sheets(&ctx);
        self.keep_safe(&ctx);
        self.look_at_shaders(&ctx);
        self.show_toasts(&ctx);
        self.tell_rest(&ctx);
    }

    fn title(&self) -> String {
        let document = self.editor.document();
        let edited = if document.is_edited() { " (edited)" } else { "" };
        format!("{}{edited} - Impasto", document.name())
    }

    fn on_close_request(&mut self) -> bool {
        self.may_close()
    }

    fn wants_controls(&self) -> bool {
        self.telling.is_on()
    }

    fn controls(&mut self, controls: &egui::accesskit::TreeUpdate) {
        self.telling.tell_controls(&self.ctx, controls);
    }
}

/// The badge in the viewport: reference, another frame, or a free view.
fn badge(editor: &Editor) -> crate::viewport::Badge {
    use crate::viewport::Badge;
    let reference = reference_frame(editor.document().scene());
    let frame = editor.session.frame;
    if editor.looking != impasto_editor_model::camera_rig::Looking::Shot {
        Badge::Free(frame)
    } else if frame == reference {
        Badge::Reference(frame)
    } else {
        Badge::Turned { frame, reference }
    }
}
