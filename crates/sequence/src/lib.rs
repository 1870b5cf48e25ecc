//! Renders a sequence of frames on several threads and hands them over in order: the one loop behind `impasto render`
//! and `F12` in the editor.
//!
//! ```text
//! Sequence::render, render_files ─▶ in_order ─▶ painters: each draws whole frames, with its own renderer and thread
//!                                           └─▶ on the calling thread: each frame in its turn ─▶ caller, or its file
//! ```
//!
//! A graphics card draws frames one after the other anyway, so there one painter draws, and other threads encode what
//! it has drawn (`finished_beside` in place of `in_order`). The bytes do not depend on how many threads there are.

mod beside;
mod exr;
mod in_order;
mod memory;
pub mod movie;
mod painter;
mod shot;
mod state;

use std::collections::HashSet;
use std::path::PathBuf;

use impasto_frame_files::{FrameList, is_whole};
use impasto_gl_render::Renderer;
use impasto_scene::whole_file;

use beside::{Steps, finished_beside};
use in_order::{Workers, in_order};
use memory::picture_bytes;
use painter::{Painter, encoded};
use shot::{Job, Painted};

pub use memory::fits_in_memory;
pub use shot::{Drawn, FrameError, PngDepth, Sequence, Wanted};
pub use state::state;

/// More painters than this would only wait for each other in the driver.
const MAX_PAINTERS: u64 = 4;

/// With one painter, other threads encode at most this many frames while it draws another.
const MAX_BESIDE: u64 = 7;

/// With a software driver, the most bytes that the pictures being encoded on other threads may take together. The
/// driver draws in the same memory, and [`fits_in_memory`] counts only one picture.
const MAX_BESIDE_BYTES: u64 = 64 << 20;

/// Opening a driver and compiling the shaders once more takes about as long as this many frames.
const FRAMES_PER_PAINTER: u64 = 4;

/// The most bytes that the pictures of all painters may take together. On a graphics card, where one painter draws, it
/// bounds the pictures being encoded on other threads.
const MAX_PICTURE_BYTES: u64 = 1 << 30;

/// What became of a frame's file.
pub enum FileOutcome {
    /// It was written.
    Written(Drawn),
    /// It existed already and was left as it is.
    Kept,
    /// It was not written.
    Failed(FrameError),
}

/// The files of a sequence.
pub struct FrameFiles<'a> {
    /// Which frames, in their order.
    pub frames: &'a FrameList,
    /// The file of each frame. Its ending is replaced by that of each kind of file that is wanted (`png`, `exr`).
    pub path: &'a (dyn Fn(i64) -> PathBuf + Sync),
    /// Whether frames whose files exist already, and are whole, are left as they are.
    pub keep_existing: bool,
}

/// How a sequence ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Ending {
    /// After its last frame. The text tells of point caches that could not be read, whose bodies stayed at rest in some
    /// frames; `None` if there were none.
    Done(Option<String>),
    /// It was stopped; frames that were under way are given up.
    Stopped,
}

/// Why [`Sequence::each`] ended early.
enum Early<E> {
    Stopped,
    Caller(E),
}

impl Sequence {
    /// Draws the frames and hands them to `take_in` in their order, on this thread. Ends at the first frame that fails,
    /// when `take_in` fails, or when `stop`, which is polled, returns true.
    ///
    /// # Errors
    /// The failure at which it ended.
    pub fn render<E: From<FrameError>>(
        &self,
        renderer: &mut Renderer,
        frames: &FrameList,
        stop: &(dyn Fn() -> bool + Sync),
        mut take_in: impl FnMut(Drawn) -> Result<(), E>,
    ) -> Result<Ending, E> {
        self.each(
            renderer,
            frames,
            |_| true,
            stop,
            |_, painted| match painted {
                Ok(Some(drawn)) => take_in(drawn).map_err(Early::Caller),
                Ok(None) => Err(Early::Stopped),
                Err(error) => Err(Early::Caller(error.into())),
            },
        )
    }

    /// Renders frames into files, each whole or not at all. Calls `report` on this thread for each frame, in their
    /// order. It goes on after a frame that failed. It ends early when `report` fails, or when `stop`, which is polled,
    /// returns true.
    ///
    /// # Errors
    /// The error of `report`.
    pub fn render_files<E>(
        &self,
        renderer: &mut Renderer,
        files: &FrameFiles<'_>,
        stop: &(dyn Fn() -> bool + Sync),
        mut report: impl FnMut(i64, FileOutcome) -> Result<(), E>,
    ) -> Result<Ending, E> {
        // If existing files are kept, a frame that the list names twice is drawn once: its file exists the second time.
        let mut seen = HashSet::new();
        let is_done = |frame_number: i64| {
            let path = (files.path)(frame_number);
            let mut all = self.wanted.endings().map(|ending| path.with_extension(ending));
            files.keep_existing && all.all(|path| is_whole(&path))
        };
        let must_draw =
            |frame_number: i64| !files.keep_existing || (seen.insert(frame_number) && !is_done(frame_number));
        self.each(renderer, files.frames, must_draw, stop, |job, painted| {
            // Another process may have painted it meanwhile.
            if matches!(painted, Ok(Some(_))) && is_done(job.frame_number) {
                return report(job.frame_number, FileOutcome::Kept).map_err(Early::Caller);
            }
            let written = painted.and_then(|drawn| {
                for (ending, bytes) in drawn.iter().flat_map(|drawn| &drawn.files) {
                    whole_file::write(&(files.path)(job.frame_number).with_extension(ending), bytes)?;
                }
                Ok(drawn)
            });
            let outcome = match written {
                Ok(Some(drawn)) => FileOutcome::Written(drawn),
                Ok(None) if job.must_draw => return Err(Early::Stopped),
                Ok(None) => FileOutcome::Kept,
                Err(error) => FileOutcome::Failed(error),
            };
            report(job.frame_number, outcome).map_err(Early::Caller)
        })
    }

    /// Draws the frames that must be drawn, on as many threads as pay off, and hands all frames to `take_in` in their
    /// order.
    fn each<E>(
        &self,
        renderer: &mut Renderer,
        frames: &FrameList,
        mut must_draw: impl FnMut(i64) -> bool + Send,
        stop: &(dyn Fn() -> bool + Sync),
        take_in: impl FnMut(Job, Painted) -> Result<(), Early<E>>,
    ) -> Result<Ending, E> {
        let driver = renderer.report().renderer.clone();
        let mut stopped = false;
        let mut numbers = frames.iter().peekable();
        let jobs = std::iter::from_fn(|| {
            let frame_number = numbers.next()?;
            stopped = stop();
            let next = numbers.peek().copied();
            (!stopped).then(|| Job { frame_number, must_draw: must_draw(frame_number), next })
        });
        let further = self.further_painters(renderer, frames.count());
        let most_beside = self.most_beside(renderer);
        let mut painter = Painter::new(self, renderer, further == 0);
        let done = if further == 0 {
            let work = move |job| painter.draw(job, stop);
            let finish = |drawn: Result<_, FrameError>| drawn.and_then(encoded);
            finished_beside(jobs, Steps { work, finish, most_beside }, take_in)
        } else {
            let workers = Workers {
                own: Box::new(move |job| painter.paint(job, stop)),
                further,
                open: &|| painter::further(self, &driver, stop),
            };
            in_order(jobs, workers, take_in)
        };
        match done {
            Ok(()) if stopped => Ok(Ending::Stopped),
            Ok(()) => Ok(Ending::Done(self.painting.fault_words())),
            Err(Early::Stopped) => Ok(Ending::Stopped),
            Err(Early::Caller(error)) => Err(error),
        }
    }

    /// How many frames other threads may encode while this one draws.
    fn most_beside(&self, renderer: &Renderer) -> usize {
        if self.timed {
            return 0;
        }
        let most_bytes = if renderer.report().is_software() { MAX_BESIDE_BYTES } else { MAX_PICTURE_BYTES };
        // The picture, and about as much again while it is encoded.
        let bytes = 8 * self.options.size_px.map(u64::from).iter().product::<u64>();
        let other_threads = rayon::current_num_threads() as u64 - 1;
        other_threads.min(MAX_BESIDE).min(most_bytes / bytes.max(1)) as usize
    }

    /// How many painters beside the one on this thread are worth a renderer of their own. On a graphics card none is:
    /// contexts wait for each other there.
    fn further_painters(&self, renderer: &Renderer, frames: u64) -> usize {
        if self.timed || !renderer.report().is_software() {
            return 0;
        }
        let bytes = picture_bytes(self.painting.scene(), self.wanted, self.options.size_px, renderer);
        let painters = (rayon::current_num_threads() as u64)
            .min(MAX_PAINTERS)
            .min(frames / FRAMES_PER_PAINTER)
            .min(MAX_PICTURE_BYTES / bytes.max(1));
        painters.saturating_sub(1) as usize
    }
}
