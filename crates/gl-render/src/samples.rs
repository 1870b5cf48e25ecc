//! Draws depth, body and colour of surfaces with several samples in each pixel, so that paint can end within a pixel,
//! bodies thinner than a pixel do not come and go, and borders between two colours of a body move smoothly.

use std::rc::Rc;

use impasto_painting::Frame;

use crate::body_program::{BodyProgram, COLOR, set_color};
use crate::gl::{DrawState, Filter, Format, Framebuffer, GlError, Gpu, ProgramSource, ShaderFile, Texture};
use crate::meshes::DrawnBody;
use crate::shader_files::{REFERENCE, SHARED};

/// The samples of a picture.
#[derive(Clone)]
pub(crate) struct Samples {
    /// Depth along the gaze and body id of every sample.
    pub(crate) depth_and_id: Rc<Texture>,
    /// Of every sample, the square root of the unlit colour; alpha is 1 where the surface is lit, 0 where it is unlit.
    /// `None` where it was not wanted.
    pub(crate) root_albedo: Option<Rc<Texture>>,
    /// How many a pixel has along each axis; at least 2.
    pub(crate) per_side: u32,
}

pub(crate) struct SamplePass {
    gpu: Gpu,
    program: BodyProgram,
    targets: Option<SampleTargets>,
}

struct SampleTargets {
    depth_and_id: Rc<Texture>,
    root_albedo: Option<Rc<Texture>>,
    pass: Framebuffer,
}

impl SamplePass {
    pub(crate) fn new(gpu: &Gpu) -> Result<Self, GlError> {
        Ok(Self { gpu: gpu.clone(), program: BodyProgram::new(gpu, FILES, SAMPLE)?, targets: None })
    }

    /// Creates all programs at once, also those that are usually created when first needed.
    pub(crate) fn ready_all(&mut self) -> Result<(), GlError> {
        self.program.ready_all()
    }

    pub(crate) fn let_go(&mut self) {
        self.targets = None;
    }

    /// Draws `per_side` x `per_side` samples for each pixel, and their colours, if these are wanted.
    pub(crate) fn draw(
        &mut self,
        frame: &Frame,
        bodies: &[DrawnBody<'_>],
        (per_side, with_colors): (u32, bool),
    ) -> Result<Samples, GlError> {
        let fine_px = frame.size_px.map(|side| side * per_side);
        let targets = match self.targets.take() {
            Some(targets)
                if targets.pass.size_px() == fine_px && targets.root_albedo.is_some() == with_colors =>
            {
                targets
            }
            _ => SampleTargets::new(&self.gpu, fine_px, with_colors)?,
        };
        let targets = self.targets.insert(targets);
        self.program.prepare(frame)?;
        let state = DrawState { depth_test: true, clear: Some([0.0; 4]), ..DrawState::default() };
        self.gpu.begin_pass(&targets.pass, state);
        let visible = bodies.iter().enumerate().filter(|(_, drawn)| drawn.body.shows());
        for (index, drawn) in visible {
            for part in &drawn.mesh.parts {
                let bound = set_color(self.program.bind(drawn.body, part), drawn.body, part)
                    .set("view_from_world", frame.view.view_from_world)
                    .set("clip_from_view", frame.view.clip_from_view)
                    .set("body_id", (index + 1) as f32);
                self.gpu.draw(bound, &drawn.array, part.vertices())?;
            }
        }
        Ok(Samples {
            depth_and_id: Rc::clone(&targets.depth_and_id),
            root_albedo: targets.root_albedo.clone(),
            per_side,
        })
    }
}

impl SampleTargets {
    fn new(gpu: &Gpu, size_px: [u32; 2], with_colors: bool) -> Result<Self, GlError> {
        let target = |format: Format| Texture::target(gpu, format, size_px, Filter::Nearest).map(Rc::new);
        let depth_and_id = target(Format::Rg32F)?;
        let root_albedo = if with_colors { Some(target(Format::Rgba8)?) } else { None };
        let colors: Vec<_> = [Some(&depth_and_id), root_albedo.as_ref()].into_iter().flatten().collect();
        let pass = Framebuffer::new(gpu, &colors, Some(&target(Format::Depth32F)?))?;
        Ok(Self { depth_and_id, root_albedo, pass })
    }
}

const FILES: &[&[ShaderFile]] = &[SHARED, REFERENCE];

const SAMPLE: ProgramSource<'static> = ProgramSource::new(
    "reference/surface.vert",
    Some("reference/sample.frag"),
    &[&["view_from_world", "clip_from_view", "body_id"], &COLOR],
);
