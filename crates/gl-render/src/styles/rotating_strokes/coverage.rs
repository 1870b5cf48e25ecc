//! Draws depth and body with several samples in each pixel, so that paint can end within a pixel, and bodies thinner
//! than a pixel do not come and go.

use std::rc::Rc;

use crate::body_program::BodyProgram;
use crate::gl::{
    Bound, DrawState, Filter, Format, Framebuffer, GlError, Gpu, Halt, Program, ProgramSource, Texture,
    VertexArray, Vertices,
};
use crate::style_renderer::StyleInput;
use crate::watch::Watch;

use super::programs::FILES;

/// Draws depth and body of every sample.
pub(super) struct Coverage {
    gpu: Gpu,
    place: BodyProgram,
    borders: Program,
    screen: VertexArray,
    /// The target that has a texel for each sample.
    fine: Option<Target>,
    /// The target that has a texel for each pixel.
    surface: Option<Target>,
}

/// A texture, and the pass that draws into it.
struct Target {
    texture: Rc<Texture>,
    pass: Framebuffer,
}

/// Textures of depth and body id.
#[derive(Clone)]
pub(super) struct Covered {
    /// Of every sample.
    fine: Rc<Texture>,
    /// Of every pixel; half the share of the pixel that shows something else is added to the id.
    surface: Rc<Texture>,
    /// How many samples a pixel has along each axis.
    samples: u32,
}

impl Covered {
    /// Sets the uniforms `fine` and `samples`.
    pub(super) fn set_samples<'a>(&self, bound: Bound<'a>) -> Bound<'a> {
        bound.texture("fine", &self.fine).set("samples", self.samples as i32)
    }

    /// Lets the samples go: from now on pixels stand for them.
    pub(super) fn let_samples_go(&mut self) {
        self.fine = Rc::clone(&self.surface);
        self.samples = 1;
    }

    /// Sets the uniform `surface`.
    pub(super) fn set_surface<'a>(&self, bound: Bound<'a>) -> Bound<'a> {
        bound.texture("surface", &self.surface)
    }
}

impl Coverage {
    pub(super) fn new(gpu: &Gpu) -> Result<Self, GlError> {
        Ok(Self {
            gpu: gpu.clone(),
            place: BodyProgram::new(gpu, FILES, PLACE)?,
            borders: Program::new(gpu, FILES, &BORDERS)?,
            screen: VertexArray::empty(gpu)?,
            fine: None,
            surface: None,
        })
    }

    /// Creates at once every program that is otherwise created when it is first needed.
    pub(super) fn ready_all(&mut self) -> Result<(), GlError> {
        self.place.ready_all()
    }

    /// Lets its targets go.
    pub(super) fn let_go(&mut self) {
        (self.fine, self.surface) = (None, None);
    }

    /// Draws `samples` x `samples` samples for each pixel. If `samples` is 1, the reference picture has them already.
    pub(super) fn draw(
        &mut self,
        input: &StyleInput<'_>,
        samples: u32,
        watch: &mut Watch<'_>,
    ) -> Result<Covered, Halt> {
        let coarse = &input.reference.depth_and_id;
        if samples == 1 {
            return Ok(Covered { fine: Rc::clone(coarse), surface: Rc::clone(coarse), samples });
        }
        let size_px = input.frame.size_px;
        let fine_px = size_px.map(|side| side * samples);
        let fine = match self.fine.take() {
            Some(target) if target.pass.size_px() == fine_px => target,
            _ => Target::new(&self.gpu, fine_px, true)?,
        };
        self.place.prepare(input.frame)?;
        let state = DrawState { depth_test: true, clear: Some([0.0; 4]), ..DrawState::default() };
        self.gpu.begin_pass(&fine.pass, state);
        let view = &input.frame.view;
        let visible = input.bodies.iter().enumerate().filter(|(_, drawn)| !drawn.body.hidden);
        for (index, drawn) in visible {
            for part in &drawn.mesh.parts {
                let bound = self
                    .place
                    .bind(drawn.body, part)
                    .set("view_from_world", view.view_from_world)
                    .set("clip_from_view", view.clip_from_view)
                    .set("body_id", (index + 1) as f32);
                self.gpu.draw(bound, &drawn.array, part.vertices())?;
            }
        }
        let samples_of = Rc::clone(&fine.texture);
        self.fine = if input.keeps.lets_go() {
            // Frees the depth of the samples, which no later pass reads.
            self.gpu.finish();
            drop(fine);
            None
        } else {
            Some(fine)
        };
        let surface = match self.surface.take() {
            Some(target) if target.pass.size_px() == size_px => target,
            _ => Target::new(&self.gpu, size_px, false)?,
        };
        let surface = self.surface.insert(surface);
        self.gpu.begin_pass(&surface.pass, DrawState::default());
        let covered = Covered { fine: samples_of, surface: Rc::clone(&surface.texture), samples };
        let bound = covered.set_samples(self.borders.bind().texture("depth_and_id", coarse));
        self.gpu.draw(bound, &self.screen, Vertices::Screen)?;
        watch.passed("coverage")?;
        Ok(covered)
    }
}

impl Target {
    fn new(gpu: &Gpu, size_px: [u32; 2], with_depth: bool) -> Result<Self, GlError> {
        let target = |format: Format| Texture::target(gpu, format, size_px, Filter::Nearest).map(Rc::new);
        let texture = target(Format::Rg32F)?;
        let depth = if with_depth { Some(target(Format::Depth32F)?) } else { None };
        Ok(Self { pass: Framebuffer::new(gpu, &[&texture], depth.as_ref())?, texture })
    }
}

const PLACE: ProgramSource<'static> = ProgramSource::new(
    "reference/surface.vert",
    Some("shared/place.frag"),
    &[&["view_from_world", "clip_from_view", "body_id"]],
);

const BORDERS: ProgramSource<'static> =
    ProgramSource::screen("rotating_strokes/borders.frag", &[&["depth_and_id", "fine", "samples"]]);
