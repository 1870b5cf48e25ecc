//! Programs that draw bodies. They all move a body's vertices by its pose, morph and noise in the same way; the shader
//! code for that is `shared/body.glsl`.

use glam::Vec4;
use impasto_core::noise_displace::{Along, Lookup};
use impasto_painting::Frame;
use impasto_painting::frame::FrameBody;

use crate::gl::{Bound, GlError, Gpu, Program, ProgramSource, ShaderFile};
use crate::noise_tiles::NoiseTiles;

/// The uniforms of `shared/body.glsl` that every program reads.
const POSE: [&str; 2] = ["world_from_model", "morph"];

/// The other uniforms of `shared/body.glsl`, for bodies that noise displaces.
const DISPLACEMENT: [&str; 6] =
    ["vertex_noise", "noise_scale", "along_normal", "lookup_u", "lookup_v", "moves_normals"];

/// A program that draws bodies.
pub(crate) struct BodyProgram {
    gpu: Gpu,
    files: &'static [&'static [ShaderFile]],
    source: ProgramSource<'static>,
    usual: Program,
    /// For bodies that noise displaces; created when the first of them is drawn.
    displaced: Option<Program>,
}

/// Whether noise moves a body's vertices.
pub(crate) fn is_displaced(body: &FrameBody) -> bool {
    body.noise.as_ref().is_some_and(|noise| noise.noise.vertex.is_some())
}

/// The two rows of the matrix that turns a position into coordinates in the noise texture.
pub(crate) fn lookup_rows(lookup: &Lookup) -> [Vec4; 2] {
    lookup.rows.map(|row| row.as_vec4())
}

impl BodyProgram {
    /// A program whose vertex shader includes `shared/body.glsl`. `source` names only the uniforms that are not in that
    /// file.
    pub(crate) fn new(
        gpu: &Gpu,
        files: &'static [&'static [ShaderFile]],
        source: ProgramSource<'static>,
    ) -> Result<Self, GlError> {
        let usual = program(gpu, files, &source, &[])?;
        Ok(Self { gpu: gpu.clone(), files, source, usual, displaced: None })
    }

    /// Creates the program for displaced bodies, if a frame has any.
    pub(crate) fn prepare(&mut self, frame: &Frame) -> Result<(), GlError> {
        if frame.bodies.iter().any(|body| !body.hidden && is_displaced(body)) {
            self.ready_all()?;
        }
        Ok(())
    }

    /// Creates the program for displaced bodies, unless it exists.
    pub(crate) fn ready_all(&mut self) -> Result<(), GlError> {
        if self.displaced.is_none() {
            self.displaced = Some(program(&self.gpu, self.files, &self.source, &["NOISE_DISPLACE"])?);
        }
        Ok(())
    }

    /// Starts to draw a body: sets the uniforms of `shared/body.glsl`. Noise displaces the body only after
    /// [`BodyProgram::prepare`].
    pub(crate) fn bind<'a>(&'a self, body: &FrameBody, tiles: &NoiseTiles) -> Bound<'a> {
        let noise = body.noise.as_ref();
        let vertex = noise.and_then(|noise| Some((noise, noise.noise.vertex.as_ref()?)));
        let bound = match (&self.displaced, vertex) {
            (Some(displaced), Some((noise, vertex))) => {
                let [u, v] = lookup_rows(&noise.lookup);
                let bound = displaced.bind();
                let bound = match tiles.get(&vertex.tile) {
                    Some(texture) => bound.texture("vertex_noise", texture),
                    None => bound,
                };
                bound
                    .set("noise_scale", vertex.scale as f32)
                    .set("along_normal", f32::from(vertex.along == Along::Normal))
                    .set("lookup_u", u)
                    .set("lookup_v", v)
                    .set("moves_normals", f32::from(vertex.moves_normals))
            }
            _ => self.usual.bind(),
        };
        bound.set("world_from_model", body.world_from_model).set("morph", body.morph)
    }
}

fn program(
    gpu: &Gpu,
    files: &[&[ShaderFile]],
    source: &ProgramSource<'static>,
    defined: &[&'static str],
) -> Result<Program, GlError> {
    let uniforms: Vec<&[&'static str]> = source.uniforms.iter().copied().chain([&POSE[..]]).collect();
    let optional = [source.optional, &DISPLACEMENT].concat();
    let source = ProgramSource { uniforms: &uniforms, optional: &optional, defined, ..*source };
    Program::new(gpu, files, &source)
}
