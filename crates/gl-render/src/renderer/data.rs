//! What can be read from a renderer about its last picture, besides the colour.

use impasto_painting::Frame;

use super::{RenderError, Renderer, top_row_first};
use crate::drawn::{PaintSurface, ReferencePixels, ResolvedStroke, SurfacePixels};
use crate::fragments::PaintedLayer;
use crate::keeps::Keeps;
use crate::lighting::LightSetup;
use crate::motion::{MotionPass, MotionPixels};

impl Renderer {
    /// Says whether the pictures drawn from now on also gather what [`Renderer::take_layers`] and
    /// [`Renderer::read_paint_surface`] return. This changes no picture, and takes time and memory. While paint is
    /// gathered, a draft in brush strokes is an error.
    pub fn gather_paint(&mut self, gathers: bool) {
        self.gathers = gathers;
    }

    /// What is kept of the pictures drawn from now on. A new renderer keeps everything.
    pub fn keep(&mut self, keeps: Keeps) {
        self.keeps = keeps;
    }

    /// For every pixel of `now` where a body shows, where the same surface point is in `then`. Both frames have the
    /// same size, and the same bodies in the same order. The last picture stays as it is.
    ///
    /// # Errors
    /// As [`Renderer::render`].
    pub fn motion(&mut self, now: &Frame, then: &Frame) -> Result<MotionPixels, RenderError> {
        self.check_size(now.size_px)?;
        let gpu = self.context.gpu().clone();
        gpu.make_current()?;
        let mut pass = match self.motion.take() {
            Some(pass) => pass,
            None => MotionPass::new(&gpu)?,
        };
        let motion = pass.draw(&mut self.reference, now, then)?;
        self.motion = Some(pass);
        gpu.complaints()?;
        Ok(motion)
    }

    /// The surfaces of the last picture, which must be of this frame.
    ///
    /// # Errors
    /// As [`Renderer::render`], and where they were not kept ([`Renderer::keep`]).
    pub fn read_surfaces(&mut self, frame: &Frame) -> Result<SurfacePixels, RenderError> {
        let gpu = self.context.gpu().clone();
        gpu.make_current()?;
        let width = frame.size_px[0] as usize;
        let targets = self.targets.as_ref().expect("the reference picture was drawn before");
        let [albedo, normal] = targets.read_albedo_and_normal()?.map(|rows| top_row_first(rows, width));
        let lights = LightSetup::new(&gpu, &frame.lights, self.reference.shadow())?;
        let [light, openness] = self.reference.draw_light_parts(frame, &lights, targets)?;
        gpu.complaints()?;
        Ok(SurfacePixels {
            albedo,
            normal,
            light: top_row_first(light, width),
            openness: top_row_first(openness, width).iter().map(|open| open[0]).collect(),
        })
    }

    /// The layers of paint of the last picture, from the lowest; its paint must have been gathered. They can be taken
    /// once.
    pub fn take_layers(&mut self) -> Vec<PaintedLayer> {
        let style = self.last_style.and_then(|name| self.styles.get_mut(name));
        style.map_or_else(Vec::new, |style| style.take_layers())
    }

    /// The paint's own surface in the last picture, whose paint must have been gathered; `None` where the style
    /// has none.
    pub fn read_paint_surface(&self) -> Option<PaintSurface> {
        let width = self.painted.as_ref()?.pass.size_px()[0] as usize;
        let found = self.last_renderer()?.read_paint_surface()?;
        Some(PaintSurface {
            flat: top_row_first(found.flat, width),
            normal_and_height: top_row_first(found.normal_and_height, width),
            wetness: top_row_first(found.wetness, width),
            is_border: top_row_first(found.is_border, width),
            ground: top_row_first(found.ground, width),
        })
    }

    /// The strokes of the last frame as they were painted, in the frame's order; read back from the GPU.
    pub fn resolved_strokes(&self) -> Vec<ResolvedStroke> {
        let resolved = self.last_renderer().map_or_else(Vec::new, |style| style.read_resolved());
        resolved
            .into_iter()
            .map(|[r, g, b, alpha, x, y, _, turned_rad]| ResolvedStroke {
                color_linear: [r, g, b],
                alpha,
                center_px: [x, y],
                turned_rad,
            })
            .collect()
    }

    /// Depth and body of every pixel of the last frame.
    pub fn read_reference(&self) -> ReferencePixels {
        let targets = self.targets.as_ref().filter(|_| self.context.gpu().make_current().is_ok());
        let Some(targets) = targets else {
            return ReferencePixels { depth: Vec::new(), body_id: Vec::new() };
        };
        let values = targets.read_depth_and_id();
        let width = targets.depth_and_id.size_px()[0] as usize;
        let rows = top_row_first(values, width * 2);
        let (depth, body_id) = rows.chunks_exact(2).map(|pixel| (pixel[0], pixel[1] as u32)).unzip();
        ReferencePixels { depth, body_id }
    }

    /// The paint of the last frame without background: premultiplied, display-linear, top row first. Empty in styles
    /// other than brush strokes, and unless everything is kept ([`Renderer::keep`]).
    pub fn read_paint(&self) -> Vec<[f32; 4]> {
        let (Some(style), Some(painted)) = (self.last_renderer(), &self.painted) else { return Vec::new() };
        top_row_first(style.read_paint(), painted.pass.size_px()[0] as usize)
    }

    /// The last picture before it was encoded: display-linear with straight alpha, top row first, whatever the
    /// exposure.
    pub fn read_linear(&self) -> Vec<[f32; 4]> {
        let Some(painted) = self.painted.as_ref().filter(|_| self.context.gpu().make_current().is_ok())
        else {
            return Vec::new();
        };
        top_row_first(painted.pass.read_colors(0), painted.pass.size_px()[0] as usize)
    }
}
