//! Framebuffers: textures that passes draw into.

use std::rc::Rc;

use glow::{HasContext as _, PixelPackData};

use super::{Format, GlError, Gpu, Texture};

pub(crate) struct Framebuffer {
    gpu: Gpu,
    id: glow::Framebuffer,
    colors: Vec<Rc<Texture>>,
    _depth: Option<Rc<Texture>>,
    size_px: [u32; 2],
}

impl Framebuffer {
    /// The textures must all have the same size.
    pub(crate) fn new(
        gpu: &Gpu,
        colors: &[&Rc<Texture>],
        depth: Option<&Rc<Texture>>,
    ) -> Result<Self, GlError> {
        let gl = gpu.gl();
        let fault = |reason: String| GlError::Resource { what: "a framebuffer".to_owned(), reason };
        // SAFETY: the context is current.
        let id = unsafe { gl.create_framebuffer() }.map_err(fault)?;
        let size_px = colors.first().copied().or(depth).map_or([0, 0], |texture| texture.size_px());
        let framebuffer = Self {
            gpu: gpu.clone(),
            id,
            colors: colors.iter().map(|&texture| Rc::clone(texture)).collect(),
            _depth: depth.cloned(),
            size_px,
        };
        let points: Vec<u32> = (0..colors.len() as u32).map(|i| glow::COLOR_ATTACHMENT0 + i).collect();
        // SAFETY: the context is current and the textures live as long as the framebuffer.
        let status = unsafe {
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(id));
            for (&point, texture) in points.iter().zip(colors) {
                debug_assert!(!texture.format().is_depth());
                gl.framebuffer_texture_2d(glow::FRAMEBUFFER, point, glow::TEXTURE_2D, Some(texture.id()), 0);
            }
            if let Some(depth) = depth {
                let point = glow::DEPTH_ATTACHMENT;
                gl.framebuffer_texture_2d(glow::FRAMEBUFFER, point, glow::TEXTURE_2D, Some(depth.id()), 0);
            }
            if points.is_empty() {
                gl.draw_buffers(&[glow::NONE]);
                gl.read_buffer(glow::NONE);
            } else {
                gl.draw_buffers(&points);
            }
            gl.check_framebuffer_status(glow::FRAMEBUFFER)
        };
        if status == glow::FRAMEBUFFER_COMPLETE {
            Ok(framebuffer)
        } else {
            Err(fault(format!("it is incomplete ({status:#06x})")))
        }
    }

    pub(super) fn id(&self) -> glow::Framebuffer {
        self.id
    }

    pub(crate) fn size_px(&self) -> [u32; 2] {
        self.size_px
    }

    /// Copies the first colour texture into the first one of another framebuffer, of the same size and format.
    pub(crate) fn copy_to(&self, other: &Framebuffer) {
        let gl = self.gpu.gl();
        let [width, height] = self.size_px.map(|side| side as i32);
        let all = glow::COLOR_BUFFER_BIT;
        // SAFETY: the context is current; both framebuffers were made in it.
        unsafe {
            gl.bind_framebuffer(glow::READ_FRAMEBUFFER, Some(self.id));
            gl.read_buffer(glow::COLOR_ATTACHMENT0);
            gl.bind_framebuffer(glow::DRAW_FRAMEBUFFER, Some(other.id));
            gl.blit_framebuffer(0, 0, width, height, 0, 0, width, height, all, glow::NEAREST);
        }
    }

    /// Reads one colour texture as bytes, bottom row first, four channels a pixel.
    pub(crate) fn read_bytes(&self, color: usize) -> Vec<u8> {
        let mut bytes = vec![0; self.pixels() * 4];
        self.read(color, glow::RGBA, glow::UNSIGNED_BYTE, &mut bytes);
        bytes
    }

    /// Reads one colour texture as floats, bottom row first: two channels a pixel in [`Format::Rg32F`], else four.
    pub(crate) fn read_floats(&self, color: usize) -> Vec<f32> {
        let channels = if self.colors[color].format() == Format::Rg32F { 2 } else { 4 };
        let mut values = vec![0.0_f32; self.pixels() * channels];
        let format = if channels == 2 { glow::RG } else { glow::RGBA };
        self.read(color, format, glow::FLOAT, bytemuck::cast_slice_mut(&mut values));
        values
    }

    /// Reads one colour texture as floats, bottom row first, four channels a pixel.
    pub(crate) fn read_colors(&self, color: usize) -> Vec<[f32; 4]> {
        let mut values = vec![[0.0_f32; 4]; self.pixels()];
        self.read(color, glow::RGBA, glow::FLOAT, bytemuck::cast_slice_mut(&mut values));
        values
    }

    /// Reads one colour texture as floats of 16 bits, bottom row first, four channels a pixel.
    pub(crate) fn read_halves(&self, color: usize) -> Vec<[half::f16; 4]> {
        let mut values = vec![[half::f16::ZERO; 4]; self.pixels()];
        self.read(color, glow::RGBA, glow::HALF_FLOAT, bytemuck::cast_slice_mut(&mut values));
        values
    }

    fn pixels(&self) -> usize {
        self.size_px[0] as usize * self.size_px[1] as usize
    }

    fn read(&self, color: usize, format: u32, kind: u32, bytes: &mut [u8]) {
        let gl = self.gpu.gl();
        // SAFETY: the context is current; all callers pass as many bytes as the format takes, rows without padding.
        unsafe {
            gl.bind_framebuffer(glow::READ_FRAMEBUFFER, Some(self.id));
            gl.read_buffer(glow::COLOR_ATTACHMENT0 + color as u32);
            gl.bind_buffer(glow::PIXEL_PACK_BUFFER, None);
            gl.pixel_store_i32(glow::PACK_ALIGNMENT, 1);
            gl.pixel_store_i32(glow::PACK_ROW_LENGTH, 0);
            let [width, height] = self.size_px;
            let data = PixelPackData::Slice(Some(bytes));
            gl.read_pixels(0, 0, width as i32, height as i32, format, kind, data);
        }
    }
}

impl Drop for Framebuffer {
    fn drop(&mut self) {
        if self.gpu.make_current().is_ok() {
            // SAFETY: the context is current and the framebuffer was made in it.
            unsafe { self.gpu.gl().delete_framebuffer(self.id) };
        }
    }
}
