//! A painter: draws whole frames with a renderer of its own, and makes the wanted picture and files of each.

use std::time::Instant;

use impasto_core::color::srgb_from_linear;
use impasto_frame_files::picture_file::{self, DeepPixels, Pixels, Provenance};
use impasto_gl_render::context::{OpenOptions, open};
use impasto_gl_render::{Keeps, PassTime, Picture, Renderer};
use impasto_painting::Frame;
use rayon::prelude::*;

use crate::exr;
use crate::in_order::Worker;
use crate::shot::{Drawn, FrameError, Job, Painted, PngDepth, Sequence};

/// A stroke with less alpha than this is not counted as painted.
const MIN_PAINTED_ALPHA: f32 = 0.004;

pub(crate) struct Painter<'a> {
    sequence: &'a Sequence,
    /// Whether it draws all the frames.
    is_alone: bool,
    renderer: &'a mut Renderer,
}

/// A frame that was drawn. What is left to do needs no renderer.
pub(crate) struct Unencoded {
    drawn: Drawn,
    /// What to note in its PNG file of 8 bits; `None` if there is to be none.
    png: Option<Provenance>,
    is_picture_wanted: bool,
}

/// Encodes the PNG file of 8 bits if there is to be one, and drops the picture unless it is wanted itself.
pub(crate) fn encoded(unencoded: Option<Unencoded>) -> Painted {
    let Some(Unencoded { mut drawn, png, is_picture_wanted }) = unencoded else { return Ok(None) };
    let begun = Instant::now();
    if let (Some(provenance), Some(Picture { size_px, rgba8 })) = (png, &drawn.picture) {
        let mut bytes = Vec::new();
        picture_file::encode(&mut bytes, Pixels { size_px: *size_px, rgba8 }, &provenance)
            .map_err(FrameError::Encode)?;
        drawn.files.insert(0, ("png", bytes));
    }
    drawn.picture = drawn.picture.filter(|_| is_picture_wanted);
    drawn.seconds += begun.elapsed().as_secs_f64();
    Ok(Some(drawn))
}

/// Makes the worker of one more thread; call this on that thread. `None` where it cannot have a renderer like the first
/// (same driver, same shaders).
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
    pub(crate) fn new(sequence: &'a Sequence, renderer: &'a mut Renderer, is_alone: bool) -> Self {
        Self { sequence, is_alone, renderer }
    }

    /// Draws the frame of a job and makes its files. `None` for a frame that need not be drawn, or that is given up
    /// because `stop` says so.
    pub(crate) fn paint(&mut self, job: Job, stop: &dyn Fn() -> bool) -> Painted {
        self.draw(job, stop).and_then(encoded)
    }

    /// As [`Painter::paint`], but leaves to [`encoded`] what needs no renderer.
    pub(crate) fn draw(
        &mut self,
        job: Job,
        stop: &dyn Fn() -> bool,
    ) -> Result<Option<Unencoded>, FrameError> {
        if !job.must_draw {
            return Ok(None);
        }
        let begun = Instant::now();
        let sequence = self.sequence;
        let has = sequence.painting.scene().style.settings().aovs();
        let wanted = sequence.wanted.exr.unwrap_or_default().shared(has);
        self.renderer.gather_paint(wanted.has_any(impasto_aovs::GATHERED));
        let surfaces = wanted.has_any(impasto_aovs::OF_SURFACES);
        self.renderer.keep(Keeps::of_size(sequence.options.size_px, surfaces));
        let frame = sequence.painting.at(job.frame_number as f64, &sequence.options);
        // While this frame is drawn, the bodies are bent for the next one. With several painters, another painter bends
        // them anyway.
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
        let provenance = sequence.provenance(&job.frame_number.to_string(), self.renderer);
        let files = self.read_files(job, (&frame, picture.size_px), &provenance)?;
        let painted_strokes = sequence.counted.then(|| self.painted_strokes());
        let strokes = frame.strokes.len();
        let seconds = begun.elapsed().as_secs_f64();
        Ok(Some(Unencoded {
            png: (sequence.wanted.png == Some(PngDepth::Eight)).then_some(provenance),
            is_picture_wanted: sequence.wanted.picture,
            drawn: Drawn { picture: Some(picture), files, strokes, painted_strokes, cost, seconds },
        }))
    }

    /// The PNG file of 16 bits and the EXR file of the frame that was drawn last, where they are wanted. These files
    /// hold more than the picture of 8 bits, so they need the renderer.
    fn read_files(
        &mut self,
        job: Job,
        (frame, size_px): (&Frame, [u32; 2]),
        provenance: &Provenance,
    ) -> Result<Vec<(&'static str, Vec<u8>)>, FrameError> {
        let sequence = self.sequence;
        let mut files = Vec::new();
        if sequence.wanted.png == Some(PngDepth::Sixteen) {
            let rgba16 = deep(&self.renderer.read_linear(), frame.exposure);
            let mut png = Vec::new();
            picture_file::encode_deep(&mut png, DeepPixels { size_px, rgba16: &rgba16 }, provenance)
                .map_err(FrameError::Encode)?;
            files.push(("png", png));
        }
        if let Some(wanted) = sequence.wanted.exr {
            let drawn = impasto_aovs::Drawn {
                painting: &sequence.painting,
                frame,
                number: job.frame_number as f64,
                options: &sequence.options,
                wanted,
            };
            files.push(("exr", exr::encode(self.renderer, &drawn, provenance, sequence.wanted.packing)?));
        }
        Ok(files)
    }

    fn painted_strokes(&self) -> usize {
        self.renderer.resolved_strokes().iter().filter(|stroke| stroke.alpha > MIN_PAINTED_ALPHA).count()
    }
}

/// Encodes a picture for a display, with 16 bits a channel.
fn deep(linear: &[[f32; 4]], exposure: f32) -> Vec<u16> {
    let word = |value: f32| (value.clamp(0.0, 1.0) * 65535.0).round() as u16;
    let encode = |(words, &[r, g, b, a]): (&mut [u16], &[f32; 4])| {
        let [r, g, b] = [r, g, b].map(|value| word(srgb_from_linear((value * exposure).clamp(0.0, 1.0))));
        words.copy_from_slice(&[r, g, b, word(a)]);
    };
    let mut words = vec![0; linear.len() * 4];
    words.par_chunks_exact_mut(4).zip(linear).for_each(encode);
    words
}
