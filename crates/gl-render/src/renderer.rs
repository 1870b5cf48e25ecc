//! The renderer: created once, then given one frame after the other.

mod data;

use std::cell::Cell;
use std::collections::HashMap;
use std::collections::hash_map::Entry;

use impasto_painting::Frame;
use impasto_painting::frame::{FrameView, Strokes, Style};

use crate::context::{Context, ContextReport};
use crate::drawn::{Cost, PassTime, Picture};
use crate::encode::{Encoder, Output, Painted, byte_target};
use crate::gl::{Framebuffer, GlError, Halt, ShaderTexts};
use crate::keeps::Keeps;
use crate::lighting::LightSetup;
use crate::motion::MotionPass;
use crate::overlays::light_billboards::{LightBillboard, LightBillboards};
use crate::reference::ReferencePass;
use crate::reference_targets::ReferenceTargets;
use crate::style_renderer::{StyleInput, StyleRenderer};
use crate::styles;
use crate::watch::Watch;

/// Why a frame was not drawn.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RenderError {
    /// The picture is larger than the driver can draw.
    #[error("a picture of {} x {} pixels: this driver's limit is {limit_px} a side; use a smaller --size", size_px[0], size_px[1])]
    TooLarge {
        /// The size that was asked for.
        size_px: [u32; 2],
        /// The longest side that works.
        limit_px: u32,
    },
    /// The picture has no pixels.
    #[error("a picture of no pixels")]
    Empty,
    /// The driver refused, or a shader is broken.
    #[error(transparent)]
    Gl(#[from] GlError),
}

/// The camera of a picture, and its exposure.
#[derive(Clone, Copy)]
struct Seen {
    view: FrameView,
    exposure: f32,
}

/// Draws frames. Belongs to the thread that made it.
pub struct Renderer {
    // Fields are dropped in this order: whatever was created in the context goes before the context.
    /// By the style's name; each is created when the first frame is drawn in it.
    styles: HashMap<&'static str, Box<dyn StyleRenderer>>,
    reference: ReferencePass,
    motion: Option<MotionPass>,
    targets: Option<ReferenceTargets>,
    encoder: Encoder,
    /// The last picture before it was encoded.
    painted: Option<Painted>,
    /// How the picture in `painted` is seen. `None` until that picture is finished, and after the shaders were
    /// replaced.
    last: Option<Seen>,
    billboards: Vec<LightBillboard>,
    /// Created when the first billboard is drawn.
    billboards_pass: Option<LightBillboards>,
    /// The picture with billboards over it.
    with_billboards: Option<Framebuffer>,
    /// Whether paint is gathered too: see [`Renderer::gather_paint`].
    gathers: bool,
    keeps: Keeps,
    last_style: Option<&'static str>,
    context: Context,
}

impl Renderer {
    /// Compiles what every frame needs.
    ///
    /// # Errors
    /// When the driver refuses a shader or a texture.
    pub fn new(context: Context) -> Result<Self, RenderError> {
        let gpu = context.gpu();
        gpu.make_current()?;
        Ok(Self {
            styles: HashMap::new(),
            reference: ReferencePass::new(gpu)?,
            motion: None,
            targets: None,
            encoder: Encoder::new(gpu)?,
            painted: None,
            last: None,
            billboards: Vec::new(),
            billboards_pass: None,
            with_billboards: None,
            gathers: false,
            keeps: Keeps::default(),
            last_style: None,
            context,
        })
    }

    /// From now on, draws with these shader texts instead of the program's own. If one of them is broken, nothing
    /// changes.
    ///
    /// # Errors
    /// The driver's message, with the file and the line.
    pub fn replace_shaders(&mut self, texts: &ShaderTexts) -> Result<(), RenderError> {
        let gpu = self.context.gpu().clone();
        gpu.make_current()?;
        let before = gpu.set_shaders(texts.clone());
        let made = (|| {
            let mut reference = ReferencePass::new(&gpu)?;
            reference.ready_all()?;
            let mut motion = MotionPass::new(&gpu)?;
            motion.ready_all()?;
            let mut renderers = HashMap::new();
            for style in Style::all() {
                let mut renderer = styles::open(&gpu, &style)?;
                renderer.ready_all()?;
                renderers.insert(style.info().name, renderer);
            }
            let last = (Encoder::new(&gpu)?, LightBillboards::new(&gpu)?);
            Ok::<_, GlError>((reference, motion, renderers, last))
        })();
        match made {
            Ok((reference, motion, renderers, (encoder, billboards))) => {
                (self.reference, self.styles, self.motion) = (reference, renderers, Some(motion));
                (self.encoder, self.billboards_pass, self.last) = (encoder, Some(billboards), None);
                Ok(())
            }
            Err(error) => {
                gpu.set_shaders(before);
                Err(error.into())
            }
        }
    }

    /// The driver in use.
    pub fn report(&self) -> &ContextReport {
        self.context.report()
    }

    /// The longest side of a picture in pixels.
    pub fn max_side_px(&self) -> u32 {
        self.context.report().max_side_px
    }

    /// Draws a frame and reads it back.
    ///
    /// # Errors
    /// When the picture is too large for the driver, memory runs out, or (in a debug context) the driver complains.
    pub fn render(&mut self, frame: &Frame) -> Result<Picture, RenderError> {
        self.check_size(frame.size_px)?;
        let gpu = self.context.gpu().clone();
        gpu.make_current()?;
        let mut watch = Watch::new(&gpu, None);
        let lights = self.draw_reference(frame, &mut watch);
        finished(lights.and_then(|lights| self.draw_style(frame, &lights, &mut watch)))
    }

    /// As [`Renderer::render`], for a frame that has no strokes yet: `strokes` computes them while the driver draws the
    /// reference picture, and they are put into the frame.
    ///
    /// # Errors
    /// As [`Renderer::render`].
    pub fn render_with(
        &mut self,
        frame: &mut Frame,
        strokes: impl FnOnce() -> Strokes,
    ) -> Result<Picture, RenderError> {
        self.check_size(frame.size_px)?;
        let gpu = self.context.gpu().clone();
        gpu.make_current()?;
        let mut watch = Watch::new(&gpu, None);
        let lights = self.draw_reference(frame, &mut watch);
        gpu.flush();
        frame.lay(strokes());
        finished(lights.and_then(|lights| self.draw_style(frame, &lights, &mut watch)))
    }

    /// As [`Renderer::render`], but calls `stop` after every pass, and several times in long ones. When `stop` returns
    /// true, there is no picture: the frame stays unfinished, and the next one is drawn as if this one had never
    /// begun.
    ///
    /// # Errors
    /// As [`Renderer::render`].
    pub fn render_unless(
        &mut self,
        frame: &Frame,
        stop: &mut dyn FnMut() -> bool,
    ) -> Result<Option<Picture>, RenderError> {
        self.check_size(frame.size_px)?;
        let gpu = self.context.gpu().clone();
        gpu.make_current()?;
        let mut watch = Watch::new(&gpu, Some(stop));
        let lights = self.draw_reference(frame, &mut watch);
        match lights.and_then(|lights| self.draw_style(frame, &lights, &mut watch)) {
            Err(Halt::GivenUp) => Ok(None),
            drawn => finished(drawn).map(Some),
        }
    }

    /// Sets the light icons that are drawn over every picture from now on. They are for windows, not for files. A new
    /// renderer has none.
    pub fn set_billboards(&mut self, billboards: &[LightBillboard]) {
        self.billboards.clear();
        self.billboards.extend_from_slice(billboards);
    }

    /// The last picture again, with the light icons that are set now; `None` where no picture is finished,
    /// or the shaders were replaced since.
    ///
    /// # Errors
    /// As [`Renderer::render`].
    pub fn with_other_billboards(&mut self) -> Result<Option<Picture>, RenderError> {
        self.context.gpu().make_current()?;
        let Some(last) = self.last else { return Ok(None) };
        Ok(Some(self.read_output(last)?))
    }

    /// Encodes the finished picture and reads it, with billboards over it.
    fn read_output(&mut self, seen: Seen) -> Result<Picture, GlError> {
        let gpu = self.context.gpu().clone();
        let painted = self.painted.as_ref().expect("a picture was drawn before");
        let output = self.encoder.encode(painted, seen.exposure)?;
        let size_px = output.size_px();
        let mut shown = output;
        if !self.billboards.is_empty() {
            let over = match self.with_billboards.take() {
                Some(over) if over.size_px() == size_px => over,
                _ => byte_target(&gpu, size_px)?,
            };
            let over = self.with_billboards.insert(over);
            output.copy_to(over);
            let pass = match self.billboards_pass.take() {
                Some(pass) => pass,
                None => LightBillboards::new(&gpu)?,
            };
            let pass = self.billboards_pass.insert(pass);
            let reference = self.targets.as_ref().expect("the reference picture was drawn before");
            pass.draw(&self.billboards, &seen.view, over, &reference.depth_and_id)?;
            gpu.lap("billboards");
            shown = over;
        }
        let rgba8 = top_row_first(shown.read_bytes(0), size_px[0] as usize * 4);
        gpu.lap("read back");
        gpu.complaints()?;
        Ok(Picture { size_px, rgba8 })
    }

    fn draw_reference(&mut self, frame: &Frame, watch: &mut Watch<'_>) -> Result<LightSetup, Halt> {
        self.last = None;
        if self.keeps.lets_go() {
            // Frees what the last picture left.
            self.encoder.let_go();
            (self.painted, self.with_billboards, self.targets) = (None, None, None);
        }
        let targets = ReferenceTargets::of_size(self.context.gpu(), self.targets.take(), frame.size_px)?;
        let targets = self.targets.insert(targets);
        let lights = self.reference.draw(frame, targets, watch)?;
        if self.keeps.lets_go() {
            self.context.gpu().finish();
            self.reference.let_go();
        }
        Ok(lights)
    }

    /// Draws the style from the reference picture, and reads the result.
    fn draw_style(
        &mut self,
        frame: &Frame,
        lights: &LightSetup,
        watch: &mut Watch<'_>,
    ) -> Result<Picture, Halt> {
        let gpu = &self.context.gpu().clone();
        let bodies = self.reference.bodies(frame)?;
        let reference = self.targets.as_mut().expect("the reference picture was drawn before");
        let name = frame.style.info().name;
        self.last_style = Some(name);
        let style = match self.styles.entry(name) {
            Entry::Occupied(entry) => entry.into_mut(),
            Entry::Vacant(entry) => entry.insert(styles::open(gpu, &frame.style)?),
        };
        if self.keeps == Keeps::Picture && !style.reads_unlit() {
            reference.let_unlit_go();
        }
        let samples = self.reference.take_samples(frame, &bodies)?;
        if self.keeps.lets_go() {
            // Frees the depth of the samples.
            gpu.finish();
            self.reference.let_go();
        }
        let (gathers, keeps) = (self.gathers, self.keeps);
        let input = StyleInput {
            frame,
            reference,
            lights,
            samples: Cell::new(samples),
            bodies: &bodies,
            gathers,
            keeps,
        };
        let mut output = Output { gpu, size_px: frame.size_px, painted: &mut self.painted };
        style.draw(&input, &mut output, watch)?;
        let seen = Seen { view: frame.view, exposure: frame.exposure };
        self.last = Some(seen);
        Ok(self.read_output(seen)?)
    }

    /// As [`Renderer::render`], with the time of each pass. Waits for the driver after every pass, so it is slower.
    ///
    /// # Errors
    /// As [`Renderer::render`].
    pub fn render_timed(&mut self, frame: &Frame) -> Result<(Picture, Cost), RenderError> {
        self.context.gpu().start_clock();
        let picture = self.render(frame);
        let (laps, fragments) = self.context.gpu().stop_clock();
        let passes = laps.into_iter().map(|(name, seconds)| PassTime { name, seconds }).collect();
        let pixels = frame.size_px.map(f64::from);
        Ok((picture?, Cost { passes, overdraw: fragments as f64 / (pixels[0] * pixels[1]) }))
    }

    fn check_size(&self, size_px: [u32; 2]) -> Result<(), RenderError> {
        if size_px.contains(&0) {
            return Err(RenderError::Empty);
        }
        let limit_px = self.max_side_px();
        if size_px[0].max(size_px[1]) > limit_px {
            return Err(RenderError::TooLarge { size_px, limit_px });
        }
        Ok(())
    }

    /// The renderer of the last frame's style, ready to be read from.
    fn last_renderer(&self) -> Option<&dyn StyleRenderer> {
        self.context.gpu().make_current().ok()?;
        self.styles.get(self.last_style?).map(Box::as_ref)
    }
}

/// The result of a drawing that was not given up.
fn finished(drawn: Result<Picture, Halt>) -> Result<Picture, RenderError> {
    drawn.map_err(|halt| match halt {
        Halt::Gl(error) => error.into(),
        Halt::GivenUp => unreachable!("only a watch with `stop` gives up"),
    })
}

/// Reverses the order of rows in place; a row has `row` values.
fn top_row_first<T>(mut values: Vec<T>, row: usize) -> Vec<T> {
    let rows = values.len() / row;
    let (above, below) = values.split_at_mut(rows / 2 * row);
    above.chunks_exact_mut(row).zip(below.rchunks_exact_mut(row)).for_each(|(a, b)| a.swap_with_slice(b));
    values
}
