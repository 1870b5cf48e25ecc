//! A painter: draws whole frames with a renderer of its own, and makes the wanted picture or PNG file of each.

use std::time::Instant;

use impasto_frame_files::picture_file::{self, Pixels};
use impasto_gl_render::context::{OpenOptions, open};
use impasto_gl_render::{PassTime, Renderer};

use crate::in_order::Worker;
use crate::shot::{Drawn, FrameError, Job, Painted, Sequence, Wanted};

/// A stroke with less alpha than this is not counted as painted.
const MIN_PAINTED_ALPHA: f32 = 0.004;

pub(crate) struct Painter<'a> {
    sequence: &'a Sequence,
    /// Whether it draws all the frames.
    is_alone: bool,
    renderer: &'a mut Renderer,
}

/// The worker of a further thread; call this on that thread. `None` where the same driver cannot be opened once more.
pub(crate) fn further<'a>(
    sequence: &'a Sequence,
    driver: &str,
    stop: &'a (dyn Fn() -> bool + Sync),
) -> Option<Worker<'a, Job, Painted>> {
    let context = open(sequence.driver, &OpenOptions::default()).ok()?;
    let mut renderer = Renderer::new(context).ok()?;
    if renderer.report().renderer != driver {
        return None;
    }
    if !sequence.shaders.is_empty() {
        renderer.replace_shaders(&sequence.shaders).ok()?;
    }
    Some(Box::new(move |job| Painter::new(sequence, &mut renderer, false).paint(job, stop)))
}

impl<'a> Painter<'a> {
    /// A painter of a sequence; `is_alone` where it draws all the frames.
    pub(crate) fn new(sequence: &'a Sequence, renderer: &'a mut Renderer, is_alone: bool) -> Self {
        Self { sequence, is_alone, renderer }
    }

    /// Draws the frame of a job. `None` for a frame that need not be drawn, or that is given up because `stop` says so.
    pub(crate) fn paint(&mut self, job: Job, stop: &dyn Fn() -> bool) -> Painted {
        if !job.must_draw {
            return Ok(None);
        }
        let begun = Instant::now();
        let sequence = self.sequence;
        let frame = sequence.painting.at(job.frame_number as f64, &sequence.options);
        // Bodies bend for the next frame while this one is drawn, unless another painter bends them already.
        if let Some(next) = job.next.filter(|_| self.is_alone) {
            sequence.painting.foresee(next as f64);
        }
        let (picture, cost) = if sequence.timed {
            let seconds = begun.elapsed().as_secs_f64();
            let (picture, mut cost) = self.renderer.render_timed(&frame)?;
            cost.passes.insert(0, PassTime { name: "solve", seconds });
            (picture, Some(cost))
        } else {
            match self.renderer.render_unless(&frame, &mut || stop())? {
                Some(picture) => (picture, None),
                None => return Ok(None),
            }
        };
        let mut png = Vec::new();
        if sequence.wanted != Wanted::Picture {
            let provenance = sequence.provenance(&job.frame_number.to_string(), self.renderer);
            let pixels = Pixels { size_px: picture.size_px, rgba8: &picture.rgba8 };
            picture_file::encode(&mut png, pixels, &provenance).map_err(FrameError::Encode)?;
        }
        let seconds = begun.elapsed().as_secs_f64();
        Ok(Some(Drawn {
            picture: (sequence.wanted != Wanted::Png).then_some(picture),
            png,
            strokes: frame.strokes.len(),
            painted_strokes: sequence.counted.then(|| self.painted_strokes()),
            cost,
            seconds,
        }))
    }

    /// How many strokes of the last frame were painted.
    fn painted_strokes(&self) -> usize {
        self.renderer.resolved_strokes().iter().filter(|stroke| stroke.alpha > MIN_PAINTED_ALPHA).count()
    }
}
