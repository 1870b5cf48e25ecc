//! Renders a sequence into files on a thread of its own, so that the window stays usable. `impasto render` writes the
//! same files.
//!
//! ```text
//! Rendering::start(RenderPlan) ─▶ context ─▶ prepare ─▶ Sequence::render_files ─▶ Rendering::progress
//! ```

use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use egui::ColorImage;
use impasto_editor_model::render_settings::{
    Existing, FileKind, Outcome, RenderDriver, RenderPlan, RenderProgress, Stage,
};
use impasto_gl_render::context::{self, Driver, OpenOptions};
use impasto_gl_render::{Picture, Renderer, ShaderTexts};
use impasto_painting::{FrameOptions, PrepareError, PrepareOptions, Preparer, SeenFrom};
use impasto_sequence::movie::{Depth, Encoding, FrameFormat, Kind, Movie, MovieError};
use impasto_sequence::{Ending, FileOutcome, FrameFiles, PngDepth, Sequence, Wanted, fits_in_memory};

use crate::priority::give_way;
use crate::window::give_back_free_memory;

#[cfg(test)]
mod tests;

/// How long dropping a rendering waits for its thread.
const CLOSING: Duration = Duration::from_millis(1500);

/// Longest side of the small copy of the last frame, in pixels.
const SMALL_PX: u32 = 480;

/// A sequence that is being rendered. Dropping this stops the rendering; frames that were written stay, and are whole.
pub struct Rendering {
    shared: Arc<Shared>,
    plan: RenderPlan,
    thread: Option<JoinHandle<()>>,
}

struct Shared {
    stop: AtomicBool,
    began: Instant,
    board: Mutex<Board>,
    changed: Condvar,
}

/// What the thread tells the window.
#[derive(Default)]
struct Board {
    progress: RenderProgress,
    /// A small copy of the last frame, until it is taken.
    picture: Option<ColorImage>,
}

impl Rendering {
    /// Starts the thread. `shaders` replace the program's own. The thread calls `wake` when drawing begins, after each
    /// frame that it writes, and at the end.
    ///
    /// # Errors
    /// When the system gives no thread.
    pub fn start(
        plan: RenderPlan,
        shaders: ShaderTexts,
        wake: impl Fn() + Send + 'static,
    ) -> std::io::Result<Self> {
        let progress = RenderProgress { total: plan.frames.count(), ..RenderProgress::default() };
        let shared = Arc::new(Shared {
            stop: AtomicBool::new(false),
            began: Instant::now(),
            board: Mutex::new(Board { progress, picture: None }),
            changed: Condvar::new(),
        });
        let (theirs, orders) = (Arc::clone(&shared), plan.clone());
        let thread = std::thread::Builder::new().name("rendering".to_owned()).spawn(move || {
            give_way();
            let outcome = catch_unwind(AssertUnwindSafe(|| run(&theirs, &orders, &shaders, &wake)));
            let outcome = match outcome {
                Ok(Ok(outcome)) => outcome,
                Ok(Err(words)) => Outcome::Failed(words),
                Err(panic) => {
                    Outcome::Failed(format!("Rendering broke off: {}", panic_message(panic.as_ref())))
                }
            };
            give_back_free_memory();
            theirs.note(|board| {
                board.progress.gone_s = theirs.began.elapsed().as_secs_f64();
                board.progress.outcome = Some(outcome);
            });
            wake();
        })?;
        Ok(Self { shared, plan, thread: Some(thread) })
    }

    /// What is rendered.
    pub fn plan(&self) -> &RenderPlan {
        &self.plan
    }

    /// The progress of the rendering.
    pub fn progress(&self) -> RenderProgress {
        let mut progress = self.shared.board().progress.clone();
        if progress.outcome.is_none() {
            progress.gone_s = self.shared.began.elapsed().as_secs_f64();
            progress.stopping = self.shared.is_stopped();
        }
        progress
    }

    /// Whether it has ended, well or not.
    pub fn is_over(&self) -> bool {
        self.shared.board().progress.outcome.is_some()
    }

    /// A small copy of the last frame; each is given once.
    pub fn take_picture(&self) -> Option<ColorImage> {
        self.shared.board().picture.take()
    }

    /// Makes the rendering end soon; frames under way are given up.
    pub fn stop(&self) {
        self.shared.stop.store(true, Ordering::Release);
    }

    /// Waits for the end, at most this long; returns whether it came.
    pub fn wait(&self, most: Duration) -> bool {
        let board = self.shared.board();
        let runs = |board: &mut Board| board.progress.outcome.is_none();
        let waited = self.shared.changed.wait_timeout_while(board, most, runs);
        waited.unwrap_or_else(PoisonError::into_inner).0.progress.outcome.is_some()
    }
}

impl Drop for Rendering {
    fn drop(&mut self) {
        self.stop();
        if self.wait(CLOSING)
            && let Some(thread) = self.thread.take()
        {
            // If it panicked, the outcome says so already.
            let _ = thread.join();
        }
    }
}

impl Shared {
    /// Ignores poisoning: no code that holds the lock can panic and leave the board half changed.
    fn board(&self) -> MutexGuard<'_, Board> {
        self.board.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn is_stopped(&self) -> bool {
        self.stop.load(Ordering::Acquire)
    }

    fn note(&self, change: impl FnOnce(&mut Board)) {
        change(&mut self.board());
        self.changed.notify_all();
    }
}

fn panic_message(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<String>().cloned();
    text.or_else(|| panic.downcast_ref::<&str>().map(|text| (*text).to_owned()))
        .unwrap_or_else(|| "no reason was given".to_owned())
}

/// Renders what the plan says. If a frame cannot be written, the error names the frame and its file.
fn run(
    shared: &Shared,
    plan: &RenderPlan,
    shaders: &ShaderTexts,
    wake: &dyn Fn(),
) -> Result<Outcome, String> {
    plan.ready().map_err(|error| error.to_string())?;
    // Checked before anything is painted: ffmpeg may be missing, or lack what this kind of movie needs.
    let encoding = encoding(plan).map_err(|error| error.to_string())?;
    let driver = match plan.driver {
        RenderDriver::Automatic => Driver::Auto,
        RenderDriver::Egl => Driver::Egl,
        RenderDriver::Osmesa => Driver::Osmesa,
    };
    let mut renderer = open_renderer(driver, shaders)?;
    let stop = || shared.is_stopped();
    if stop() {
        return Ok(Outcome::Stopped);
    }
    fits_in_memory(&plan.loaded.scene, wanted(plan), plan.size_px, &renderer)?;
    let frame_options = FrameOptions { transparent: plan.transparent, ..FrameOptions::new(plan.size_px) };
    let options = PrepareOptions {
        give_up: &stop,
        memory_bytes: impasto_scene::memory::available_bytes(),
        seen_from: SeenFrom::for_options(&plan.loaded.scene, &frame_options),
        only_shown: true,
        ..PrepareOptions::default()
    };
    let prepared = Preparer::default().prepare_with(Arc::clone(&plan.loaded), &options);
    let painting = match prepared {
        Ok(painting) => painting,
        Err(PrepareError::GivenUp) => return Ok(Outcome::Stopped),
        Err(error) => return Err(error.to_string()),
    };
    shared.note(|board| board.progress.stage = Stage::Drawing);
    wake();
    let sequence = Sequence {
        painting,
        options: frame_options,
        scene_name: plan.scene_name(),
        state: impasto_sequence::state(&plan.loaded, &frame_options, &wanted(plan), shaders),
        driver,
        shaders: shaders.clone(),
        wanted: wanted(plan),
        timed: false,
        counted: false,
    };
    if let Some(encoding) = encoding {
        return film(shared, plan, (&sequence, &mut renderer), encoding, wake);
    }
    let files = FrameFiles {
        frames: &plan.frames,
        path: &|frame_number| plan.path(frame_number),
        keep_existing: plan.existing == Existing::Keep,
    };
    let began = Instant::now();
    let ending = sequence.render_files(&mut renderer, &files, &stop, |frame_number, outcome| {
        let path = plan.path(frame_number);
        match outcome {
            FileOutcome::Kept => shared.note(|board| board.progress.kept += 1),
            FileOutcome::Failed(error) => {
                return Err(format!("Frame {frame_number} was not written. {}: {error}", path.display()));
            }
            FileOutcome::Written(drawn) => {
                let small = drawn.picture.as_ref().map(small_copy);
                shared.note(|board| {
                    let progress = &mut board.progress;
                    progress.written += 1;
                    progress.drawing_s = began.elapsed().as_secs_f64();
                    progress.strokes = drawn.strokes;
                    progress.last = Some(path);
                    board.picture = small;
                });
                wake();
            }
        }
        Ok(())
    })?;
    match ending {
        Ending::Done(None) => Ok(Outcome::Done),
        Ending::Done(Some(fault)) => Err(format!("All frames are written, but {fault}")),
        Ending::Stopped => Ok(Outcome::Stopped),
    }
}

/// A renderer beside the window's own OpenGL. `shaders` replace the program's own.
pub(crate) fn open_renderer(driver: Driver, shaders: &ShaderTexts) -> Result<Renderer, String> {
    let context = context::open(driver, &OpenOptions::default()).map_err(|error| error.to_string())?;
    let mut renderer = Renderer::new(context).map_err(|error| error.to_string())?;
    if !shaders.is_empty() {
        renderer.replace_shaders(shaders).map_err(|error| error.to_string())?;
    }
    Ok(renderer)
}

/// How the movie of a plan is encoded; `None` if the plan makes no movie.
fn encoding(plan: &RenderPlan) -> Result<Option<&'static Encoding>, MovieError> {
    let Some(kind) = Kind::of(plan.output()).filter(|_| plan.kind == FileKind::Movie) else {
        return Ok(None);
    };
    let encoding = kind.encoding(plan.transparent)?;
    encoding.ready(plan.output())?;
    Ok(Some(encoding))
}

/// Renders all frames into one movie, which is there only once it is whole.
fn film(
    shared: &Shared,
    plan: &RenderPlan,
    (sequence, renderer): (&Sequence, &mut Renderer),
    encoding: &Encoding,
    wake: &dyn Fn(),
) -> Result<Outcome, String> {
    let format = FrameFormat {
        size_px: plan.size_px,
        depth: Depth::Eight,
        fps: sequence.painting.scene().timeline.fps,
    };
    let said = |error: MovieError| error.to_string();
    let mut movie = Movie::start(plan.output(), encoding, format).map_err(said)?;
    let began = Instant::now();
    let ending = sequence.render(renderer, &plan.frames, &|| shared.is_stopped(), |drawn| {
        if let Some(picture) = &drawn.picture {
            movie.add(&picture.rgba8)?;
            shared.note(|board| {
                let progress = &mut board.progress;
                progress.written += 1;
                progress.drawing_s = began.elapsed().as_secs_f64();
                progress.strokes = drawn.strokes;
                board.picture = Some(small_copy(picture));
            });
            wake();
        }
        Ok::<(), MovieError>(())
    });
    let fault = match ending.map_err(said)? {
        Ending::Stopped => return Ok(Outcome::Stopped),
        Ending::Done(fault) => fault,
    };
    movie.finish().map_err(said)?;
    shared.note(|board| board.progress.last = Some(plan.output().to_owned()));
    fault.map_or(Ok(Outcome::Done), |fault| Err(format!("The movie is written, but {fault}")))
}

/// What to make of each frame: its files, and its pixels for the small copy in the window.
fn wanted(plan: &RenderPlan) -> Wanted {
    let png = match plan.kind {
        FileKind::Png8 | FileKind::PngAndExr => Some(PngDepth::Eight),
        FileKind::Png16 => Some(PngDepth::Sixteen),
        FileKind::Exr | FileKind::Movie => None,
    };
    Wanted { picture: true, png, exr: plan.aovs(), ..Wanted::default() }
}

/// Every n-th pixel of every n-th row, so that no side is longer than [`SMALL_PX`].
fn small_copy(picture: &Picture) -> ColorImage {
    let [width, height] = picture.size_px;
    let step = width.max(height).div_ceil(SMALL_PX).max(1);
    let small = [width.div_ceil(step), height.div_ceil(step)];
    let pixel = |index: u32| {
        let (x, y) = (index % small[0] * step, index / small[0] * step);
        let at = (y as usize * width as usize + x as usize) * 4;
        let [r, g, b, a] = [0, 1, 2, 3].map(|channel| picture.rgba8[at + channel]);
        egui::Color32::from_rgba_unmultiplied(r, g, b, a)
    };
    let pixels = (0..small[0] * small[1]).map(pixel).collect();
    ColorImage::new(small.map(|side| side as usize), pixels)
}
