//! Programs that draw bodies. They all move a body's vertices by its pose, morph and noise in the same way; the shader
//! code for that is `shared/body.glsl`.

use glam::Vec4;
use impasto_core::noise_displace::{Along, Lookup};
use impasto_painting::Frame;
use impasto_painting::frame::FrameBody;

use crate::gl::{Bound, GlError, Gpu, Program, ProgramSource, ShaderFile};
use crate::meshes::Part;
use crate::noise_tiles::NoiseTiles;

/// The uniforms of `shared/body.glsl` that every program reads.
const POSE: [&str; 2] = ["world_from_model", "morph"];

/// The other uniforms of `shared/body.glsl`, for bodies that noise displaces.
const DISPLACEMENT: [&str; 6] =
    ["vertex_noise", "noise_scale", "along_normal", "lookup_u", "lookup_v", "moves_normals"];

/// The uniforms of `shared/cutout.glsl`.
const CUTOUT: [&str; 2] = ["cut_texture", "cutoff"];

/// A program that draws bodies.
pub(crate) struct BodyProgram {
    gpu: Gpu,
    files: &'static [&'static [ShaderFile]],
    source: ProgramSource<'static>,
    /// For each [`Variant`]; all but the usual one are created when they are first needed.
    variants: [Option<Program>; 4],
}

/// What a program must do to a body beside its pose and morph.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Variant {
    /// Noise moves its vertices.
    is_displaced: bool,
    /// A texture cuts holes into it.
    is_cut: bool,
}

impl Variant {
    const ALL: [Self; 4] = [
        Self { is_displaced: false, is_cut: false },
        Self { is_displaced: true, is_cut: false },
        Self { is_displaced: false, is_cut: true },
        Self { is_displaced: true, is_cut: true },
    ];

    /// Its place in [`Self::ALL`].
    fn index(self) -> usize {
        usize::from(self.is_displaced) + 2 * usize::from(self.is_cut)
    }

    /// What its shaders define.
    fn defined(self) -> &'static [&'static str] {
        match (self.is_displaced, self.is_cut) {
            (false, false) => &[],
            (true, false) => &["NOISE_DISPLACE"],
            (false, true) => &["CUTOUT"],
            (true, true) => &["NOISE_DISPLACE", "CUTOUT"],
        }
    }
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
        let mut made = Self { gpu: gpu.clone(), files, source, variants: [const { None }; 4] };
        made.ready(Variant::ALL[0])?;
        Ok(made)
    }

    /// Creates the variants that a frame's bodies need.
    pub(crate) fn prepare(&mut self, frame: &Frame) -> Result<(), GlError> {
        for body in frame.bodies.iter().filter(|body| !body.hidden) {
            let is_displaced = is_displaced(body);
            for is_cut in body.surface.materials.iter().map(|material| material.cutoff.is_some()) {
                self.ready(Variant { is_displaced, is_cut })?;
            }
        }
        Ok(())
    }

    /// Creates all variants.
    pub(crate) fn ready_all(&mut self) -> Result<(), GlError> {
        Variant::ALL.into_iter().try_for_each(|variant| self.ready(variant))
    }

    /// Creates a variant, unless it exists.
    fn ready(&mut self, variant: Variant) -> Result<(), GlError> {
        let made = &mut self.variants[variant.index()];
        if made.is_none() {
            *made = Some(program(&self.gpu, self.files, &self.source, variant.defined())?);
        }
        Ok(())
    }

    /// Starts to draw a part of a body: sets the uniforms of `shared/body.glsl` and `shared/cutout.glsl`. Noise displaces the body, and
    /// textures cut it out, only after [`BodyProgram::prepare`].
    pub(crate) fn bind<'a>(&'a self, body: &FrameBody, part: &Part, tiles: &NoiseTiles) -> Bound<'a> {
        let wanted = Variant { is_displaced: is_displaced(body), is_cut: part.cutoff.is_some() };
        let usual = || self.variants[0].as_ref().expect("the usual variant is always made");
        let mut bound = self.variants[wanted.index()].as_ref().unwrap_or_else(usual).bind();
        if let Some(cutoff) = part.cutoff {
            bound = bound.texture("cut_texture", &part.texture).set("cutoff", cutoff);
        }
        let noise = body.noise.as_ref();
        if let Some((noise, vertex)) = noise.and_then(|noise| Some((noise, noise.noise.vertex.as_ref()?))) {
            let [u, v] = lookup_rows(&noise.lookup);
            if let Some(texture) = tiles.get(&vertex.tile) {
                bound = bound.texture("vertex_noise", texture);
            }
            bound = bound
                .set("noise_scale", vertex.scale as f32)
                .set("along_normal", f32::from(vertex.along == Along::Normal))
                .set("lookup_u", u)
                .set("lookup_v", v)
                .set("moves_normals", f32::from(vertex.moves_normals));
        }
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
    let optional = [source.optional, &DISPLACEMENT, &CUTOUT].concat();
    let source = ProgramSource { uniforms: &uniforms, optional: &optional, defined, ..*source };
    Program::new(gpu, files, &source)
}
