//! Draws the shadow map: the depth of the scene as the first sun sees it.

use std::rc::Rc;
use std::sync::{Arc, Weak};

use glam::{Mat4, Vec3, Vec4};
use impasto_painting::frame::{Bent, BodySurface, FrameBody};

use crate::body_program::BodyProgram;
use crate::gl::{DrawState, Filter, Format, Framebuffer, GlError, Gpu, ProgramSource, Texture};
use crate::materials::noise_displace;
use crate::meshes::DrawnBody;
use crate::shader_files::{REFERENCE, SHARED};

/// Side of the shadow map in texels.
pub(crate) const SIDE: u32 = 2048;

/// The shadow map, drawn again only when something that casts a shadow has changed.
pub(crate) struct ShadowMap {
    gpu: Gpu,
    program: BodyProgram,
    depth: Rc<Texture>,
    pass: Framebuffer,
    /// What the map shows now.
    drawn: Option<Casters>,
}

/// What a shadow map is drawn from.
struct Casters {
    /// Surface, pose and shape of every body. The weak pointers keep addresses from being used again.
    bodies: Vec<(Weak<BodySurface>, Mat4, Option<Weak<Bent>>)>,
    shadow_from_world: Mat4,
}

impl Casters {
    fn new(bodies: &[DrawnBody<'_>], shadow_from_world: Mat4) -> Self {
        let bodies = bodies
            .iter()
            .map(|drawn| drawn.body)
            .filter(|body| casts_shadow(body))
            .map(|body| {
                let bent = body.bent.as_ref().map(Arc::downgrade);
                (Arc::downgrade(&body.surface), body.world_from_model, bent)
            })
            .collect();
        Self { bodies, shadow_from_world }
    }
}

impl PartialEq for Casters {
    fn eq(&self, other: &Self) -> bool {
        let same = |a: Option<&Weak<Bent>>, b: Option<&Weak<Bent>>| match (a, b) {
            (Some(a), Some(b)) => a.ptr_eq(b),
            (a, b) => a.is_none() && b.is_none(),
        };
        self.shadow_from_world == other.shadow_from_world
            && self.bodies.len() == other.bodies.len()
            && self
                .bodies
                .iter()
                .zip(&other.bodies)
                .all(|(a, b)| a.0.ptr_eq(&b.0) && a.1 == b.1 && same(a.2.as_ref(), b.2.as_ref()))
    }
}

fn casts_shadow(body: &FrameBody) -> bool {
    !body.hidden && !noise_displace::is_coloured(body)
}

impl ShadowMap {
    pub(crate) fn new(gpu: &Gpu) -> Result<Self, GlError> {
        let depth = Rc::new(Texture::target(gpu, Format::Depth32F, [SIDE, SIDE], Filter::ShadowCompare)?);
        Ok(Self {
            gpu: gpu.clone(),
            program: BodyProgram::new(gpu, &[SHARED, REFERENCE], SHADOW)?,
            pass: Framebuffer::new(gpu, &[], Some(&depth))?,
            depth,
            drawn: None,
        })
    }

    pub(crate) fn program(&mut self) -> &mut BodyProgram {
        &mut self.program
    }

    pub(crate) fn depth(&self) -> &Rc<Texture> {
        &self.depth
    }

    /// Draws the map, unless it shows these bodies already.
    pub(crate) fn draw(&mut self, bodies: &[DrawnBody<'_>], shadow_from_world: Mat4) -> Result<(), GlError> {
        let casters = Casters::new(bodies, shadow_from_world);
        // `drawn` is empty meanwhile, so that a map whose drawing failed is not taken for a complete one.
        let before = self.drawn.take();
        if before.as_ref() == Some(&casters) {
            self.drawn = before;
            return Ok(());
        }
        let state = DrawState { depth_test: true, casts_shadow: true, ..DrawState::default() };
        self.gpu.begin_pass(&self.pass, state);
        for DrawnBody { body, mesh, array } in bodies.iter().filter(|drawn| casts_shadow(drawn.body)) {
            for part in mesh.parts.iter().filter(|part| part.casts_shadow) {
                let bound = self.program.bind(body, part).set("shadow_from_world", shadow_from_world);
                self.gpu.draw(bound, array, part.vertices())?;
            }
        }
        self.drawn = Some(casters);
        Ok(())
    }
}

/// The parallel projection in which a sun sees a sphere. The whole sphere lies in clip space.
pub(crate) fn shadow_from_world(center: Vec3, radius: f32, to_light: Vec3) -> Mat4 {
    let up = if to_light.y.abs() < 0.9 { Vec3::Y } else { Vec3::Z };
    let right = up.cross(to_light).normalize_or(Vec3::X);
    let above = to_light.cross(right);
    let scale = 1.0 / (radius * 1.02);
    let row = |axis: Vec3| (axis * scale).extend(-axis.dot(center) * scale);
    // Depth grows away from the light.
    Mat4::from_cols(row(right), row(above), row(-to_light), Vec4::W).transpose()
}

const SHADOW: ProgramSource<'static> =
    ProgramSource::new("reference/shadow.vert", Some("reference/shadow.frag"), &[&["shadow_from_world"]]);
