//! The motion pass: how far each visible surface point moves from one picture to another. Measures and AOVs need it,
//! painting does not.

use std::rc::Rc;

use glam::UVec2;
use impasto_painting::Frame;

use crate::body_program::BodyProgram;
use crate::gl::{DrawState, Filter, Format, Framebuffer, GlError, Gpu, ProgramSource, Texture};
use crate::meshes::DrawnBody;
use crate::reference::ReferencePass;
use crate::shader_files::{REFERENCE, SHARED};

/// For each pixel of one picture: where the surface point that it shows is in another picture. Top row first.
#[derive(Clone, Debug, PartialEq)]
pub struct MotionPixels {
    /// Width and height in pixels.
    pub size_px: [u32; 2],
    /// From a pixel's centre to where the same surface point projects in the other picture: columns to the right, rows
    /// **down**. 0 where no body shows, or where the point is behind the other camera's eye (in perspective).
    pub offset_px: Vec<[f32; 2]>,
    /// Depth of that point along the other camera's gaze, in world units; 0 where no body shows. Behind the other
    /// camera's eye it is 0 in perspective, and below 0 with parallel rays.
    pub depth_then: Vec<f32>,
    /// Index of the body plus 1; 0 where nothing is.
    pub body_id: Vec<u32>,
}

/// The program, and the target that it was last used with.
pub(crate) struct MotionPass {
    gpu: Gpu,
    program: BodyProgram,
    target: Option<Framebuffer>,
}

impl MotionPass {
    pub(crate) fn new(gpu: &Gpu) -> Result<Self, GlError> {
        Ok(Self {
            gpu: gpu.clone(),
            program: BodyProgram::new(gpu, &[SHARED, REFERENCE], MOTION)?,
            target: None,
        })
    }

    /// Creates all programs at once, also those that are usually created when first needed.
    pub(crate) fn ready_all(&mut self) -> Result<(), GlError> {
        self.program.ready_all()
    }

    /// Draws the bodies of `now`, and finds where they are in `then`. Bodies are matched by index, so both frames must
    /// have them in the same order. If `then` has fewer, the rest count as not moved.
    pub(crate) fn draw(
        &mut self,
        reference: &mut ReferencePass,
        now: &Frame,
        then: &Frame,
    ) -> Result<MotionPixels, GlError> {
        let target = match self.target.take() {
            Some(target) if target.size_px() == now.size_px => target,
            _ => {
                let texture = |format: Format| {
                    Texture::target(&self.gpu, format, now.size_px, Filter::Nearest).map(Rc::new)
                };
                let depth = texture(Format::Depth32F)?;
                Framebuffer::new(&self.gpu, &[&texture(Format::Rgba32F)?], Some(&depth))?
            }
        };
        let bodies = reference.bodies(now)?;
        self.program.prepare(now)?;
        let state = DrawState { depth_test: true, clear: Some([0.0; 4]), ..DrawState::default() };
        self.gpu.begin_pass(&target, state);
        for (index, DrawnBody { body, mesh, .. }) in bodies.iter().enumerate() {
            if !body.shows() {
                continue;
            }
            let body_then = then.bodies.get(index).unwrap_or(body);
            let array = reference.with_then(body, body_then)?;
            for part in &mesh.parts {
                let bound = self
                    .program
                    .bind(body, part)
                    .set("world_from_model_then", body_then.world_from_model)
                    .set("view_from_world", now.view.view_from_world)
                    .set("view_from_world_then", then.view.view_from_world)
                    .set("clip_from_view", now.view.clip_from_view)
                    .set("clip_from_view_then", then.view.clip_from_view)
                    .set("size_px", UVec2::from(now.size_px).as_vec2())
                    .set("body_id", (index + 1) as f32);
                self.gpu.draw(bound, &array, part.vertices())?;
            }
        }
        let values = target.read_floats(0);
        self.target = Some(target);
        Ok(motion_pixels(now.size_px, &values))
    }
}

/// Converts four floats a pixel, bottom row first and Y up.
fn motion_pixels(size_px: [u32; 2], values: &[f32]) -> MotionPixels {
    let pixels = values.len() / 4;
    let mut motion = MotionPixels {
        size_px,
        offset_px: Vec::with_capacity(pixels),
        depth_then: Vec::with_capacity(pixels),
        body_id: Vec::with_capacity(pixels),
    };
    for row in values.chunks_exact(size_px[0] as usize * 4).rev() {
        for pixel in row.chunks_exact(4) {
            motion.offset_px.push([pixel[0], -pixel[1]]);
            motion.depth_then.push(pixel[2]);
            motion.body_id.push(pixel[3] as u32);
        }
    }
    motion
}

const MOTION: ProgramSource<'static> = ProgramSource {
    ..ProgramSource::new(
        "reference/motion.vert",
        Some("reference/motion.frag"),
        &[&[
            "world_from_model_then",
            "view_from_world",
            "view_from_world_then",
            "clip_from_view",
            "clip_from_view_then",
            "size_px",
            "body_id",
        ]],
    )
};
