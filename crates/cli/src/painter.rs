//! Frames, one after the other: solved, drawn, and made into what is asked for. There may be several painters, each on a
//! thread of its own with a renderer of its own; what they make does not depend on how many there are.

use std::fmt::Write as _;
use std::time::Instant;

use impasto_frame_files::picture_file::{self, Provenance};
use impasto_gl_render::{Cost, PassTime, Picture, Renderer, ShaderTexts};
use impasto_painting::{Frame, FrameOptions, Painting};
use impasto_scene::memory;

use crate::args::DriverChoice;
use crate::failure::Failure;
use crate::in_order::Worker;
use crate::session;

/// Strokes that are less than this there are not painted.
const LEAST_ALPHA: f32 = 0.004;

/// The most painters: past this they wait for one another in the driver.
const MOST_PAINTERS: u64 = 4;

/// Opening a driver and compiling shaders once more costs about as much as this many frames.
const FRAMES_A_PAINTER: u64 = 4;

/// What the targets of one more painter take, bytes a pixel, and what those of all may take.
const PIXEL_BYTES: u64 = 128;
const MOST_BYTES: u64 = 1 << 30;

/// What is made of each frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Wanted {
    /// Its pixels.
    Picture,
    /// The bytes of its file.
    File,
    /// Both.
    FileAndPicture,
}

/// What all painters share.
pub(crate) struct Shot {
    pub(crate) painting: Painting,
    pub(crate) options: FrameOptions,
    pub(crate) scene_name: String,
    pub(crate) driver: DriverChoice,
    /// Stand in for the program's own.
    pub(crate) shaders: Option<ShaderTexts>,
    /// Measures the passes, which makes a frame slower; only one painter is at work then.
    pub(crate) verbose: bool,
    /// Counts the strokes that were painted.
    pub(crate) counted: bool,
}

/// A frame as it is wanted.
pub(crate) struct Drawn {
    pub(crate) picture: Option<Picture>,
    /// Its file.
    pub(crate) png: Vec<u8>,
    /// How many strokes were painted, where they are counted.
    pub(crate) strokes: usize,
    /// What it was made of, where that is measured.
    pub(crate) told: String,
    pub(crate) seconds: f64,
}

/// Draws frames of a shot.
pub(crate) struct Painter<'a> {
    shot: &'a Shot,
    pub(crate) renderer: &'a mut Renderer,
    /// Who draws, as files tell it.
    driver: String,
}

impl Shot {
    /// How many threads beside this one are worth a renderer of their own.
    pub(crate) fn helpers(&self, frames: u64) -> usize {
        if self.verbose {
            return 0;
        }
        let [width, height] = self.options.size_px.map(u64::from);
        let painters = (rayon::current_num_threads() as u64)
            .min(MOST_PAINTERS)
            .min(frames / FRAMES_A_PAINTER)
            .min(MOST_BYTES / (width * height * PIXEL_BYTES).max(1));
        painters.saturating_sub(1) as usize
    }

    /// One more painter, where there is another context of the same driver; for the thread that asks.
    pub(crate) fn helper(&self, driver: &str, wanted: Wanted) -> Option<Worker<'_, Result<Drawn, Failure>>> {
        let mut renderer = session::open_renderer(self.driver, false).ok()?;
        if renderer.report().renderer != driver {
            return None;
        }
        if let Some(shaders) = &self.shaders {
            renderer.replace_shaders(shaders).ok()?;
        }
        Some(Box::new(move |frame_number| Painter::new(self, &mut renderer).draw(frame_number, wanted)))
    }

    /// What a file tells of itself.
    pub(crate) fn provenance(&self, frame: &str, driver: &str) -> Provenance {
        Provenance { scene: self.scene_name.clone(), frame: frame.to_owned(), driver: driver.to_owned() }
    }
}

impl<'a> Painter<'a> {
    pub(crate) fn new(shot: &'a Shot, renderer: &'a mut Renderer) -> Self {
        let driver = renderer.report().renderer.clone();
        Self { shot, renderer, driver }
    }

    pub(crate) fn draw(&mut self, frame_number: i64, wanted: Wanted) -> Result<Drawn, Failure> {
        let begun = Instant::now();
        let shot = self.shot;
        let frame = shot.painting.at(frame_number as f64, &shot.options);
        let (picture, cost) = if shot.verbose {
            let solved = begun.elapsed().as_secs_f64();
            let (picture, mut cost) = self.renderer.render_timed(&frame)?;
            cost.passes.insert(0, PassTime { name: "solve", seconds: solved });
            (picture, Some(cost))
        } else {
            (self.renderer.render(&frame)?, None)
        };
        let mut png = Vec::new();
        if wanted != Wanted::Picture {
            let provenance = shot.provenance(&frame_number.to_string(), &self.driver);
            picture_file::encode(&mut png, pixels(&picture), &provenance)
                .map_err(|error| Failure::Other(error.to_string()))?;
        }
        let seconds = begun.elapsed().as_secs_f64();
        let strokes = if shot.counted { self.painted() } else { 0 };
        let told = cost.map_or_else(String::new, |cost| told(&frame, strokes, &cost));
        Ok(Drawn { picture: (wanted != Wanted::File).then_some(picture), png, strokes, told, seconds })
    }

    /// How many strokes of the last frame were painted.
    fn painted(&self) -> usize {
        self.renderer.resolved_strokes().iter().filter(|stroke| stroke.alpha > LEAST_ALPHA).count()
    }
}

/// What a frame was made of: strokes, overdraw, memory, seconds of each pass.
fn told(frame: &Frame, strokes: usize, cost: &Cost) -> String {
    let overdraw = cost.overdraw;
    let memory = memory::peak_bytes()
        .map_or_else(String::new, |bytes| format!(", {} MiB at most so far", bytes >> 20));
    let mut text =
        format!("  {strokes} strokes of {} in question, overdraw {overdraw:.1}{memory}", frame.strokes.len());
    let mut passes: Vec<PassTime> = Vec::new();
    for pass in &cost.passes {
        match passes.iter_mut().find(|known| known.name == pass.name) {
            Some(known) => known.seconds += pass.seconds,
            None => passes.push(*pass),
        }
    }
    for pass in passes {
        // Writing to a String cannot fail.
        let _ = write!(text, "\n  {:<14}{:>8.1} ms", pass.name, pass.seconds * 1e3);
    }
    text
}

pub(crate) fn pixels(picture: &Picture) -> picture_file::Pixels<'_> {
    (picture.size_px, &picture.rgba8)
}
