//! Textures: pictures that shaders read, and targets that passes draw into.

use glow::{HasContext as _, PixelUnpackData};
use impasto_painting::frame::{Sampler, Wrap};

use super::{GlError, Gpu};

/// How texels are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Format {
    Rgba8,
    /// sRGB encoded colour that is decoded when it is read.
    SrgbAlpha8,
    R16F,
    Rg16F,
    /// Colours of 11, 11 and 10 bits, without alpha and without negative values.
    R11G11B10F,
    Rg32F,
    Rgba16F,
    Rgba32F,
    Depth32F,
}

impl Format {
    /// Internal format, format and type of OpenGL.
    fn names(self) -> (u32, u32, u32) {
        match self {
            Format::Rgba8 => (glow::RGBA8, glow::RGBA, glow::UNSIGNED_BYTE),
            Format::SrgbAlpha8 => (glow::SRGB8_ALPHA8, glow::RGBA, glow::UNSIGNED_BYTE),
            Format::R16F => (glow::R16F, glow::RED, glow::HALF_FLOAT),
            Format::R11G11B10F => (glow::R11F_G11F_B10F, glow::RGB, glow::HALF_FLOAT),
            Format::Rg16F => (glow::RG16F, glow::RG, glow::HALF_FLOAT),
            Format::Rg32F => (glow::RG32F, glow::RG, glow::FLOAT),
            Format::Rgba16F => (glow::RGBA16F, glow::RGBA, glow::HALF_FLOAT),
            Format::Rgba32F => (glow::RGBA32F, glow::RGBA, glow::FLOAT),
            Format::Depth32F => (glow::DEPTH_COMPONENT32F, glow::DEPTH_COMPONENT, glow::FLOAT),
        }
    }

    pub(super) fn is_depth(self) -> bool {
        self == Format::Depth32F
    }
}

/// How texels are read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Filter {
    /// The nearest texel, clamped at the edges.
    Nearest,
    /// Four texels of the nearest mipmap level, clamped at the edges.
    LinearInLevel,
    /// Four texels of each of the two nearest mipmap levels, repeated at the edges.
    TrilinearRepeat,
    /// The depths of four texels, each compared with a reference value, clamped at the edges.
    ShadowCompare,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum TextureShape {
    Flat([u32; 2]),
    /// Width, height and number of layers.
    Array([u32; 3]),
}

pub(crate) struct Texture {
    gpu: Gpu,
    id: glow::Texture,
    format: Format,
    shape: TextureShape,
}

impl Texture {
    /// A texture to draw into, with undefined contents.
    pub(crate) fn target(
        gpu: &Gpu,
        format: Format,
        size_px: [u32; 2],
        filter: Filter,
    ) -> Result<Self, GlError> {
        let texture = Self::empty(gpu, format, TextureShape::Flat(size_px))?;
        texture.allocate(0, None)?;
        texture.set_filter(filter, 1);
        Ok(texture)
    }

    /// A 2D texture with these texels and a single mipmap level.
    pub(crate) fn from_texels(
        gpu: &Gpu,
        format: Format,
        size_px: [u32; 2],
        texels: &[u8],
    ) -> Result<Self, GlError> {
        let texture = Self::empty(gpu, format, TextureShape::Flat(size_px))?;
        texture.allocate(0, Some(texels))?;
        texture.set_filter(Filter::Nearest, 1);
        Ok(texture)
    }

    /// A texture that repeats, with mipmap levels computed by the driver.
    pub(crate) fn with_driver_levels(
        gpu: &Gpu,
        format: Format,
        size_px: [u32; 2],
        texels: &[u8],
    ) -> Result<Self, GlError> {
        let texture = Self::empty(gpu, format, TextureShape::Flat(size_px))?;
        texture.allocate(0, Some(texels))?;
        let levels = 32 - size_px[0].max(size_px[1]).max(1).leading_zeros();
        texture.set_filter(Filter::TrilinearRepeat, levels);
        // SAFETY: the context is current and the texture is bound by `set_filter`.
        unsafe { gpu.gl().generate_mipmap(glow::TEXTURE_2D) };
        Ok(texture)
    }

    /// Sets how the texture is read: its edges and its magnification, as a material states them.
    pub(crate) fn set_sampler(&self, sampler: Sampler) {
        let wrap = |wrap| match wrap {
            Wrap::Repeat => glow::REPEAT,
            Wrap::Mirror => glow::MIRRORED_REPEAT,
            Wrap::Clamp => glow::CLAMP_TO_EDGE,
        };
        let [across, up] = [sampler.wrap_u, sampler.wrap_v].map(|way| wrap(way) as i32);
        let kind = self.kind();
        let gl = self.gpu.gl();
        // SAFETY: the context is current; these parameters exist in OpenGL 3.3.
        unsafe {
            gl.bind_texture(kind, Some(self.id));
            gl.tex_parameter_i32(kind, glow::TEXTURE_WRAP_S, across);
            gl.tex_parameter_i32(kind, glow::TEXTURE_WRAP_T, up);
            if sampler.is_nearest {
                gl.tex_parameter_i32(kind, glow::TEXTURE_MAG_FILTER, glow::NEAREST as i32);
            }
        }
    }

    /// An array of textures with all mipmap levels given, finest first.
    pub(crate) fn array_with_levels(
        gpu: &Gpu,
        format: Format,
        size: [u32; 3],
        levels: &[Vec<u8>],
    ) -> Result<Self, GlError> {
        let texture = Self::empty(gpu, format, TextureShape::Array(size))?;
        for (level, texels) in levels.iter().enumerate() {
            texture.allocate(level as u32, Some(texels))?;
        }
        texture.set_filter(Filter::LinearInLevel, levels.len() as u32);
        Ok(texture)
    }

    fn empty(gpu: &Gpu, format: Format, shape: TextureShape) -> Result<Self, GlError> {
        // SAFETY: the context is current.
        let id = unsafe { gpu.gl().create_texture() }
            .map_err(|reason| GlError::Resource { what: "a texture".to_owned(), reason })?;
        Ok(Self { gpu: gpu.clone(), id, format, shape })
    }

    pub(super) fn id(&self) -> glow::Texture {
        self.id
    }

    pub(crate) fn format(&self) -> Format {
        self.format
    }

    pub(crate) fn size_px(&self) -> [u32; 2] {
        match self.shape {
            TextureShape::Flat(size) => size,
            TextureShape::Array([width, height, _]) => [width, height],
        }
    }

    pub(super) fn kind(&self) -> u32 {
        match self.shape {
            TextureShape::Flat(_) => glow::TEXTURE_2D,
            TextureShape::Array(_) => glow::TEXTURE_2D_ARRAY,
        }
    }

    fn allocate(&self, level: u32, texels: Option<&[u8]>) -> Result<(), GlError> {
        let (internal, format, kind) = self.format.names();
        let gl = self.gpu.gl();
        let side = |pixels: u32| (pixels >> level).max(1) as i32;
        // SAFETY: the context is current; glow checks nothing, but each caller passes as many texels as the shape
        // has, rows without padding.
        unsafe {
            gl.bind_buffer(glow::PIXEL_UNPACK_BUFFER, None);
            gl.pixel_store_i32(glow::UNPACK_ALIGNMENT, 1);
            gl.pixel_store_i32(glow::UNPACK_ROW_LENGTH, 0);
            gl.bind_texture(self.kind(), Some(self.id));
            let (level, internal) = (level as i32, internal as i32);
            let data = PixelUnpackData::Slice(texels);
            match self.shape {
                TextureShape::Flat([w, h]) => {
                    gl.tex_image_2d(
                        glow::TEXTURE_2D,
                        level,
                        internal,
                        side(w),
                        side(h),
                        0,
                        format,
                        kind,
                        data,
                    );
                }
                TextureShape::Array([w, h, layers]) => {
                    let layers = layers as i32;
                    let target = glow::TEXTURE_2D_ARRAY;
                    gl.tex_image_3d(target, level, internal, side(w), side(h), layers, 0, format, kind, data);
                }
            }
        }
        let [width, height] = self.size_px();
        self.gpu.check_memory(&format!("a texture of {width} x {height} pixels"))
    }

    fn set_filter(&self, filter: Filter, levels: u32) {
        let (shrunk, enlarged, wrap) = match filter {
            Filter::Nearest => (glow::NEAREST, glow::NEAREST, glow::CLAMP_TO_EDGE),
            Filter::LinearInLevel if levels > 1 => {
                (glow::LINEAR_MIPMAP_NEAREST, glow::LINEAR, glow::CLAMP_TO_EDGE)
            }
            Filter::LinearInLevel | Filter::ShadowCompare => {
                (glow::LINEAR, glow::LINEAR, glow::CLAMP_TO_EDGE)
            }
            Filter::TrilinearRepeat => (glow::LINEAR_MIPMAP_LINEAR, glow::LINEAR, glow::REPEAT),
        };
        let kind = self.kind();
        let gl = self.gpu.gl();
        // SAFETY: the context is current; these parameters exist in OpenGL 3.3.
        unsafe {
            gl.bind_texture(kind, Some(self.id));
            gl.tex_parameter_i32(kind, glow::TEXTURE_MIN_FILTER, shrunk as i32);
            gl.tex_parameter_i32(kind, glow::TEXTURE_MAG_FILTER, enlarged as i32);
            gl.tex_parameter_i32(kind, glow::TEXTURE_WRAP_S, wrap as i32);
            gl.tex_parameter_i32(kind, glow::TEXTURE_WRAP_T, wrap as i32);
            gl.tex_parameter_i32(kind, glow::TEXTURE_MAX_LEVEL, levels as i32 - 1);
            if filter == Filter::ShadowCompare {
                gl.tex_parameter_i32(kind, glow::TEXTURE_COMPARE_MODE, glow::COMPARE_REF_TO_TEXTURE as i32);
                gl.tex_parameter_i32(kind, glow::TEXTURE_COMPARE_FUNC, glow::LEQUAL as i32);
            }
        }
    }
}

impl Drop for Texture {
    fn drop(&mut self) {
        if self.gpu.make_current().is_ok() {
            // SAFETY: the context is current and the texture was made in it.
            unsafe { self.gpu.gl().delete_texture(self.id) };
        }
    }
}
