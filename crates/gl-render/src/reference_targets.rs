//! The results of the reference pass: the plain picture, and the surface that each of its pixels shows.

use std::rc::Rc;

use half::f16;

use crate::gl::{Bound, Filter, Format, Framebuffer, GlError, Gpu, Texture};

/// The textures from which the light is computed, as shaders name them.
pub(crate) const SURFACE_TEXTURES: [&str; 4] = ["albedo_and_lit", "normal", "depth_and_id", "openness"];

/// The textures of the reference pass. All have the picture's size, except `openness`.
pub(crate) struct ReferenceTargets {
    size_px: [u32; 2],
    /// The lit picture, display-linear. Where highlights have strokes of their own, a part of strong ones is left out.
    pub(crate) color: Rc<Texture>,
    pub(crate) normal: Rc<Texture>,
    /// Depth along the gaze, and the body's index plus 1; 0 where nothing is.
    pub(crate) depth_and_id: Rc<Texture>,
    /// How strong the highlight is: 0 for a faint sheen, up to 1.
    pub(crate) glint: Rc<Texture>,
    /// What `color` leaves out of the highlights, display-linear.
    pub(crate) highlight: Rc<Texture>,
    /// `None` after they were let go.
    unlit: Option<UnlitTargets>,
    pub(crate) light_pass: Framebuffer,
    /// `depth_and_id` alone, to read it back.
    place_pass: Framebuffer,
}

/// What the reference pass knows before light falls on the surfaces. Outside that pass only the ink style and AOVs read
/// these targets.
pub(crate) struct UnlitTargets {
    pub(crate) depth: Rc<Texture>,
    /// Colour without light; alpha is 1 where the surface is lit, 0 where it is unlit.
    pub(crate) albedo: Rc<Texture>,
    /// Ambient occlusion, 0 enclosed to 1 open; half the picture's size.
    openness: Rc<Texture>,
    pub(crate) surface_pass: Framebuffer,
    pub(crate) openness_pass: Framebuffer,
}

impl ReferenceTargets {
    fn new(gpu: &Gpu, size_px: [u32; 2]) -> Result<Self, GlError> {
        let target = |format: Format, size_px: [u32; 2], filter: Filter| {
            Texture::target(gpu, format, size_px, filter).map(Rc::new)
        };
        let half = size_px.map(|side| side.div_ceil(2));
        let color = target(Format::Rgba16F, size_px, Filter::Nearest)?;
        let glint = target(Format::R16F, size_px, Filter::Nearest)?;
        let highlight = target(Format::R11G11B10F, size_px, Filter::Nearest)?;
        let albedo = target(Format::Rgba16F, size_px, Filter::Nearest)?;
        let normal = target(Format::Rgba16F, size_px, Filter::Nearest)?;
        let depth_and_id = target(Format::Rg32F, size_px, Filter::Nearest)?;
        let openness = target(Format::Rgba8, half, Filter::LinearInLevel)?;
        let depth = target(Format::Depth32F, size_px, Filter::Nearest)?;
        let unlit = UnlitTargets {
            surface_pass: Framebuffer::new(gpu, &[&albedo, &normal, &depth_and_id], Some(&depth))?,
            openness_pass: Framebuffer::new(gpu, &[&openness], None)?,
            depth,
            albedo,
            openness,
        };
        Ok(Self {
            size_px,
            light_pass: Framebuffer::new(gpu, &[&color, &glint, &highlight], None)?,
            place_pass: Framebuffer::new(gpu, &[&depth_and_id], None)?,
            color,
            glint,
            highlight,
            normal,
            depth_and_id,
            unlit: Some(unlit),
        })
    }

    /// The targets from before, if they have this size and are complete; else new ones.
    pub(crate) fn of_size(gpu: &Gpu, before: Option<Self>, size_px: [u32; 2]) -> Result<Self, GlError> {
        match before {
            Some(targets) if targets.size_px == size_px && targets.unlit.is_some() => Ok(targets),
            _ => Self::new(gpu, size_px),
        }
    }

    /// The unlit targets of the reference pass; fails after they were let go.
    pub(crate) fn unlit(&self) -> Result<&UnlitTargets, GlError> {
        self.unlit.as_ref().ok_or_else(|| GlError::Resource {
            what: "the surfaces of the last picture".to_owned(),
            reason: "they were let go, because nobody said that they would be asked for".to_owned(),
        })
    }

    /// Lets go of the unlit targets of the reference pass. To be called after the last pass that reads them.
    pub(crate) fn let_unlit_go(&mut self) {
        self.unlit = None;
    }

    /// Sets the textures from which the light is computed.
    pub(crate) fn set<'a>(&self, bound: Bound<'a>) -> Result<Bound<'a>, GlError> {
        let unlit = self.unlit()?;
        Ok(bound
            .texture("albedo_and_lit", &unlit.albedo)
            .texture("normal", &self.normal)
            .texture("depth_and_id", &self.depth_and_id)
            .texture("openness", &unlit.openness))
    }

    /// Unlit colour, and normal, of every pixel, bottom row first.
    pub(crate) fn read_albedo_and_normal(&self) -> Result<[Vec<[f16; 4]>; 2], GlError> {
        let pass = &self.unlit()?.surface_pass;
        Ok([pass.read_halves(0), pass.read_halves(1)])
    }

    /// Depth along the gaze and body id of every pixel, bottom row first.
    pub(crate) fn read_depth_and_id(&self) -> Vec<f32> {
        self.place_pass.read_floats(0)
    }
}
