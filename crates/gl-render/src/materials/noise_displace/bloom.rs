//! Bloom: light from glowing bodies spreads over what is around them.

use std::rc::Rc;

use glam::Vec2;

use crate::gl::{
    Blend, DrawState, Filter, Format, Framebuffer, GlError, Gpu, Program, ProgramSource, Texture,
    VertexArray, Vertices,
};
use crate::shader_files::{NOISE_DISPLACE, SHARED};

/// Standard deviation of the blur, as a share of the picture's height.
const SPREAD: f32 = 0.02;

/// Pixels of the picture per pixel of the blurred glow, along each side.
const GATHERED: u32 = 4;

pub(super) struct Bloom {
    size_px: [u32; 2],
    gather: Program,
    spread: Program,
    add: Program,
    textures: [Rc<Texture>; 2],
    passes: [Framebuffer; 2],
}

impl Bloom {
    pub(super) fn new(gpu: &Gpu, size_px: [u32; 2]) -> Result<Self, GlError> {
        let program = |fragment: &'static str, uniforms: &[&'static str]| {
            Program::new(gpu, &[SHARED, NOISE_DISPLACE], &ProgramSource::screen(fragment, &[uniforms]))
        };
        let small = size_px.map(|side| side.div_ceil(GATHERED));
        let target = || Texture::target(gpu, Format::Rgba16F, small, Filter::LinearInLevel).map(Rc::new);
        let textures = [target()?, target()?];
        Ok(Self {
            size_px,
            gather: program("noise_displace/gather.frag", &["glow"])?,
            spread: program("noise_displace/spread.frag", &["gathered", "axis", "sigma"])?,
            add: program("noise_displace/bloom.frag", &["gathered"])?,
            passes: [
                Framebuffer::new(gpu, &[&textures[0]], None)?,
                Framebuffer::new(gpu, &[&textures[1]], None)?,
            ],
            textures,
        })
    }

    pub(super) fn has_size(&self, size_px: [u32; 2]) -> bool {
        self.size_px == size_px
    }

    /// Adds the glow to a picture.
    pub(super) fn draw(
        &self,
        gpu: &Gpu,
        screen: &VertexArray,
        glow: &Texture,
        picture: &Framebuffer,
    ) -> Result<(), GlError> {
        gpu.begin_pass(&self.passes[0], DrawState::default());
        gpu.draw(self.gather.bind().texture("glow", glow), screen, Vertices::Screen)?;
        let sigma = (SPREAD * self.size_px[1] as f32 / GATHERED as f32).max(0.3);
        for (from, to, axis) in [(0, 1, Vec2::X), (1, 0, Vec2::Y)] {
            gpu.begin_pass(&self.passes[to], DrawState::default());
            let bound = self.spread.bind().texture("gathered", &self.textures[from]);
            gpu.draw(bound.set("axis", axis).set("sigma", sigma), screen, Vertices::Screen)?;
        }
        gpu.begin_pass(picture, DrawState { blend: Blend::Over, ..DrawState::default() });
        gpu.draw(self.add.bind().texture("gathered", &self.textures[0]), screen, Vertices::Screen)
    }
}
