//! Programs that draw bodies; the shader code that they share is `shared/body.glsl`.

use glam::{Mat3, Vec3};
use impasto_core::screen_map::is_uneven;
use impasto_painting::Frame;
use impasto_painting::frame::FrameBody;

use crate::gl::{Bound, GlError, Gpu, Program, ProgramSource, ShaderFile};
use crate::meshes::Part;

/// The uniform that all programs of bodies read.
const POSE: [&str; 1] = ["world_from_model"];
/// The uniform that only some programs of bodies read.
const NORMALS: [&str; 1] = ["world_from_normal"];

/// The uniforms that [`set_color`] sets.
pub(crate) const COLOR: [&str; 3] = ["albedo", "albedo_texture", "is_lit"];

/// Sets the unlit colour of a part of a body: the uniforms [`COLOR`].
pub(crate) fn set_color<'a>(bound: Bound<'a>, body: &FrameBody, part: &Part) -> Bound<'a> {
    let material = body.surface.materials.get(part.material);
    bound
        .set("albedo", Vec3::from(material.map_or([0.8; 3], |material| material.albedo)))
        .texture("albedo_texture", &part.texture)
        .set("is_lit", f32::from(material.is_none_or(|material| !material.unlit)))
}

/// The uniforms of `shared/cutout.glsl`.
const CUTOUT: [&str; 2] = ["cut_texture", "cutoff"];

pub(crate) struct BodyProgram {
    gpu: Gpu,
    files: &'static [&'static [ShaderFile]],
    source: ProgramSource<'static>,
    /// For bodies without holes, and for bodies into which a texture cuts holes; the second is created when first
    /// needed.
    variants: [Option<Program>; 2],
}

/// A pose scales unevenly if the squared lengths of its axes differ by more than this share, or if the cosine between
/// two axes is larger than this. Rounding to single precision makes a smaller difference.
const UNEVEN: f64 = 1e-4;

/// The matrix that takes normals from model space to the world: the pose itself, or its inverse transpose if the pose
/// scales unevenly.
fn world_from_normal(body: &FrameBody) -> Mat3 {
    let pose = Mat3::from_mat4(body.world_from_model);
    if is_uneven(pose.as_dmat3(), UNEVEN) { pose.inverse().transpose() } else { pose }
}

impl BodyProgram {
    /// A program whose vertex shader includes `shared/body.glsl`. `source` names only the uniforms that
    /// [`BodyProgram::bind`] does not set.
    pub(crate) fn new(
        gpu: &Gpu,
        files: &'static [&'static [ShaderFile]],
        source: ProgramSource<'static>,
    ) -> Result<Self, GlError> {
        let mut made = Self { gpu: gpu.clone(), files, source, variants: [None, None] };
        made.ready(false)?;
        Ok(made)
    }

    /// Creates the variants that a frame's bodies need.
    pub(crate) fn prepare(&mut self, frame: &Frame) -> Result<(), GlError> {
        let shown = frame.bodies.iter().filter(|body| !body.hidden);
        let mut materials = shown.flat_map(|body| &body.surface.materials);
        if materials.any(|material| material.cutoff.is_some()) { self.ready(true) } else { Ok(()) }
    }

    /// Creates all variants.
    pub(crate) fn ready_all(&mut self) -> Result<(), GlError> {
        self.ready(true)
    }

    /// Creates a variant, unless it exists.
    fn ready(&mut self, is_cut: bool) -> Result<(), GlError> {
        let made = &mut self.variants[usize::from(is_cut)];
        if made.is_none() {
            let defined: &[&str] = if is_cut { &["CUTOUT"] } else { &[] };
            *made = Some(program(&self.gpu, self.files, &self.source, defined)?);
        }
        Ok(())
    }

    /// Starts to draw a part of a body: sets the pose, the matrix of its normals, and the uniforms of
    /// `shared/cutout.glsl`. Holes are only sure to be cut if [`BodyProgram::prepare`] was called for the frame.
    pub(crate) fn bind<'a>(&'a self, body: &FrameBody, part: &Part) -> Bound<'a> {
        let usual = || self.variants[0].as_ref().expect("the usual variant is always made");
        let wanted = self.variants[usize::from(part.cutoff.is_some())].as_ref();
        let mut bound = wanted.unwrap_or_else(usual).bind();
        if let Some(cutoff) = part.cutoff {
            bound = bound.texture("cut_texture", &part.texture).set("cutoff", cutoff);
        }
        bound.set("world_from_model", body.world_from_model).set("world_from_normal", world_from_normal(body))
    }
}

fn program(
    gpu: &Gpu,
    files: &[&[ShaderFile]],
    source: &ProgramSource<'static>,
    defined: &[&'static str],
) -> Result<Program, GlError> {
    let uniforms: Vec<&[&'static str]> = source.uniforms.iter().copied().chain([&POSE[..]]).collect();
    let source = ProgramSource { uniforms: &uniforms, optional: &[&NORMALS, &CUTOUT], defined, ..*source };
    Program::new(gpu, files, &source)
}
