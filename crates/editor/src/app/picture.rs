//! The window's side of the painting thread: asks it for pictures and takes its reports.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use egui::{Context, Rect};
use impasto_editor_model::editor::Editor;
use impasto_editor_model::picking::View;
use impasto_gl_render::ShaderTexts;
use impasto_gl_render::context::Driver;
use impasto_scene::motion::{self, CameraPose};

use super::lights;
use crate::files::preferences::DriverChoice;
use crate::viewport::{Framing, Layout, Pictures};
use crate::window::Waker;
use crate::worker::{Job, Later, Report, ViewJob, Worker};

/// Pictures per second are counted over this time, seconds.
const SPAN_S: f64 = 1.0;

/// At most this many frames of the film are asked for at a time. The thread keeps those that it has room for.
const MOST_FRAMES: i64 = 1000;

/// What came from the thread in this pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum News {
    /// Some report.
    Any,
    /// The next picture of the playback.
    NextOfFilm,
}

/// What the thread was asked for last.
#[derive(PartialEq)]
struct Asked {
    /// The version of the scene.
    version: u64,
    views: Vec<ViewJob>,
    /// Whether the film is to be finished: its frames drawn exactly and kept.
    finishes: bool,
}

/// The thread, what it was last asked for, and what it has sent.
pub(super) struct PictureFlow {
    worker: Option<Worker>,
    driver: String,
    pub(super) pictures: Pictures,
    pub(super) trouble: Option<String>,
    asked: Option<Asked>,
    /// The version of the scene that was prepared last.
    prepared: u64,
    /// The version of the scene that is being prepared, and since when.
    preparing: Option<(u64, Instant)>,
    layout: Layout,
    strokes: usize,
    strokes_of: Vec<(String, usize)>,
    /// The frames whose exact pictures are kept, and the version of their scene.
    finished: (Vec<i64>, u64),
    /// When the latest pictures came.
    arrivals: VecDeque<Instant>,
}

impl PictureFlow {
    pub(super) fn new(driver: DriverChoice, waker: Waker) -> Self {
        let (worker, trouble) = match Worker::new(driver_of(driver), move || waker.wake()) {
            Ok(worker) => (Some(worker), None),
            Err(error) => (None, Some(format!("No thread to draw with: {error}"))),
        };
        Self {
            worker,
            driver: String::new(),
            pictures: Pictures::default(),
            trouble,
            asked: None,
            prepared: 0,
            preparing: None,
            layout: Layout::single(
                Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(950.0, 650.0)),
                (16, 9),
                1.0,
            ),
            strokes: 0,
            strokes_of: Vec::new(),
            finished: (Vec::new(), 0),
            arrivals: VecDeque::new(),
        }
    }

    /// Drops all pictures, as when another document is opened or the scene has become empty.
    pub(super) fn forget(&mut self) {
        self.pictures.clear();
        (self.strokes, self.strokes_of) = (0, Vec::new());
        self.asked = None;
        self.preparing = None;
    }

    pub(super) fn driver(&self) -> &str {
        &self.driver
    }

    pub(super) fn strokes(&self) -> usize {
        self.strokes
    }

    /// Strokes of each region in the last exact picture, by name.
    pub(super) fn strokes_of(&self) -> &[(String, usize)] {
        &self.strokes_of
    }

    pub(super) fn prepared(&self) -> u64 {
        self.prepared
    }

    /// The frames whose exact pictures are kept, in order; none if these are of another version of the scene.
    pub(super) fn finished(&self) -> &[i64] {
        let (frames, version) = &self.finished;
        let is_shown = self.asked.as_ref().is_some_and(|asked| asked.version == *version);
        if is_shown { frames } else { &[] }
    }

    pub(super) fn pictures_per_second(&self) -> Option<f64> {
        let newest = self.arrivals.back()?;
        let recent =
            self.arrivals.iter().filter(|at| newest.duration_since(**at).as_secs_f64() < SPAN_S).count();
        (newest.elapsed().as_secs_f64() < SPAN_S && recent > 1).then_some(recent as f64)
    }

    /// For how long a scene has been in preparation; none if no scene is.
    pub(super) fn preparing_for(&self) -> Option<Duration> {
        self.preparing.map(|(_, since)| since.elapsed())
    }

    pub(super) fn replace_shaders(&mut self, texts: ShaderTexts) {
        if let Some(worker) = &self.worker {
            worker.replace_shaders(texts);
        }
        self.asked = None;
    }

    /// Gives up preparing; the pictures that are shown stay.
    pub(super) fn stop_preparing(&mut self) {
        self.preparing = None;
        if let Some(worker) = &self.worker {
            worker.stop_preparing();
        }
    }

    /// The view for picking and tools: the viewport's camera in the framing of the first picture. (In a comparison, the
    /// first picture itself is drawn with the reference's camera.)
    pub(super) fn view(&self, editor: &Editor) -> View {
        self.layout.framings()[0].view(&self.camera(editor))
    }

    pub(super) fn camera(&self, editor: &Editor) -> CameraPose {
        editor.camera()
    }

    pub(super) fn layout(&self) -> &Layout {
        &self.layout
    }

    pub(super) fn set_layout(&mut self, layout: Layout) {
        self.layout = layout;
    }

    /// Takes the reports of the thread.
    pub(super) fn poll(&mut self, ctx: &Context, editor: &mut Editor) -> Option<News> {
        let mut news = None;
        let worker = self.worker.as_ref()?;
        for report in worker.poll() {
            news = news.max(Some(News::Any));
            match report {
                Report::Opened(report) => {
                    let name = report.renderer.split(" (").next().unwrap_or(&report.renderer);
                    name.clone_into(&mut self.driver);
                }
                Report::Prepared(prepared, serial) => {
                    let (painting, picker) = *prepared;
                    self.prepared = serial;
                    self.preparing = self.preparing.filter(|(awaited, _)| *awaited != serial);
                    editor.prepared_with(painting, picker);
                }
                Report::Picture(picture) => {
                    self.trouble = None;
                    self.arrivals.push_back(Instant::now());
                    while self.arrivals.len() > 120 {
                        self.arrivals.pop_front();
                    }
                    if picture.exact {
                        self.strokes = picture.strokes;
                        let painting = editor.painting().filter(|_| self.prepared == picture.serial);
                        if let Some(painting) = painting {
                            let names = painting.scene().regions.iter().map(|region| region.name.clone());
                            self.strokes_of = names.zip(picture.strokes_of.iter().copied()).collect();
                        }
                    }
                    let is_last = picture.index + 1 == self.layout.framings().len();
                    if is_last && editor.shown_frame(picture.view.frame) {
                        news = Some(News::NextOfFilm);
                    }
                    self.pictures.take(ctx, picture);
                }
                Report::Finished(frames, serial) => self.finished = (frames, serial),
                Report::Failed(words) => {
                    self.preparing = None;
                    self.trouble = Some(words);
                }
            }
        }
        news
    }

    /// Whether a picture that was asked for has not come yet.
    pub(super) fn is_awaited(&self) -> bool {
        let shows = |(index, view): (usize, &ViewJob)| {
            self.pictures.of(index).is_some_and(|(_, shown, _)| shown.looks_like(view))
        };
        let asked = self.asked.as_ref();
        asked.is_some_and(|asked| !asked.views.iter().enumerate().all(shows)) && self.trouble.is_none()
    }

    /// The version of the scene, if all views that were asked for show it exactly and at rest; otherwise none.
    pub(super) fn at_rest(&self) -> Option<u64> {
        let Asked { version, views, .. } = self.asked.as_ref()?;
        let is_done =
            |(index, view): (usize, &ViewJob)| !view.moving && self.pictures.is_exact(index, view, *version);
        views.iter().enumerate().all(is_done).then_some(*version)
    }

    /// Asks for the pictures to show now, unless they were asked for already.
    pub(super) fn ask(&mut self, editor: &Editor) {
        let (loaded, version) = editor.shown();
        if loaded.scene.objects.is_empty() {
            self.forget();
            return;
        }
        let views = self.views(editor, editor.frame_to_draw());
        let finishes = finishes(editor, &views);
        let asked = Asked { version, views, finishes };
        if self.asked.as_ref() == Some(&asked) {
            return;
        }
        if let Some(worker) = &self.worker {
            let loaded = std::sync::Arc::clone(loaded);
            let ahead = editor.time().playback.upcoming().map(|next| self.views(editor, next));
            let film = if finishes { self.film(editor) } else { Vec::new() };
            let later = Later { ahead: ahead.unwrap_or_default(), film };
            let views = asked.views.clone();
            if version != self.prepared && self.preparing.is_none_or(|(awaited, _)| awaited != version) {
                self.preparing = Some((version, Instant::now()));
            }
            worker.show_before(Job { loaded, serial: version, views }, later);
        }
        self.asked = Some(asked);
    }

    /// The views of the film in the order of playback, beginning with the present frame.
    fn film(&self, editor: &Editor) -> Vec<ViewJob> {
        let course = editor.course();
        let from = (editor.session.frame.floor() as i64).clamp(course.first, course.last);
        let frames = (0..course.count().min(MOST_FRAMES))
            .map(|index| course.first + (from - course.first + index).rem_euclid(course.count()));
        let views = frames.flat_map(|frame| self.views(editor, frame as f64));
        views.map(|view| ViewJob { lights: Vec::new(), ..view }).collect()
    }

    fn views(&self, editor: &Editor, frame: f64) -> Vec<ViewJob> {
        let scene = &editor.shown().0.scene;
        let shading = editor.session.shading;
        let now = (editor.camera_at(frame), frame);
        let seen = if editor.session.compare {
            vec![motion::referred_to(scene, &scene.reference), now]
        } else {
            vec![now]
        };
        let plays = editor.time().playback.is_playing();
        let moving = editor.is_moving() || plays;
        let view = |(framing, (camera, frame)): (&Framing, (CameraPose, f64))| ViewJob {
            camera: framing.widened(&camera),
            frame,
            size_px: framing.size_px(),
            shot_height_px: framing.shot_height_px(),
            shading,
            // Playback shows the film, which has no icons of lights.
            lights: if plays { Vec::new() } else { lights::billboards(editor, framing) },
            moving,
        };
        self.layout.framings().iter().zip(seen).map(view).collect()
    }
}

/// The driver that draws the pictures, independent of the window's own OpenGL.
pub(super) fn driver_of(choice: DriverChoice) -> Driver {
    match choice {
        DriverChoice::Auto => Driver::Auto,
        DriverChoice::Egl => Driver::Egl,
        DriverChoice::Osmesa | DriverChoice::Software => Driver::Osmesa,
    }
}

/// Whether to finish the film while nothing else is drawn. True if the session asks for it, the film was played before,
/// and a single picture is shown at rest.
fn finishes(editor: &Editor, views: &[ViewJob]) -> bool {
    let [view] = views else { return false };
    !view.moving && editor.session.finishes && editor.time().has_played()
}
