//! Draws the shadow map: the depth of the scene as the first sun sees it or, without a sun, the brightest lamp.

use std::rc::Rc;
use std::sync::{Arc, Weak};

use glam::{Mat4, Vec3, Vec4};
use impasto_painting::frame::{Bent, BodySurface, FrameBody, PointLight};

use crate::body_program::BodyProgram;
use crate::gl::{DrawState, Filter, Format, Framebuffer, GlError, Gpu, ProgramSource, Texture};
use crate::materials::noise_displace;
use crate::meshes::DrawnBody;
use crate::shader_files::{REFERENCE, SHARED};

/// Side of the shadow map in texels.
pub(crate) const SIDE: u32 = 2048;

/// The shadow map, drawn again only when its light or something that casts a shadow has changed.
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
    /// Surface, pose and shape of every body that casts a shadow. The weak pointers keep addresses from being used
    /// again.
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

    /// Draws the map, unless it shows these bodies in this projection already.
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
fn shadow_from_world(center: Vec3, radius: f32, to_light: Vec3) -> Mat4 {
    let up = if to_light.y.abs() < 0.9 { Vec3::Y } else { Vec3::Z };
    let right = up.cross(to_light).normalize_or(Vec3::X);
    let above = to_light.cross(right);
    let scale = 1.0 / (radius * 1.02);
    let row = |axis: Vec3| (axis * scale).extend(-axis.dot(center) * scale);
    // Depth grows away from the light.
    Mat4::from_cols(row(right), row(above), row(-to_light), Vec4::W).transpose()
}

/// How a light sees what it lights.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sight {
    /// From world space to the clip space of the map.
    pub shadow_from_world: Mat4,
    /// Side of a texel in world units; for a lamp, at a distance of 1 from it.
    pub texel: f32,
    /// Tolerance of the depth test: if the depth in the map is nearer to the light than a point by no more than this,
    /// the point is lit. A constant, plus a number that is divided by the square of the distance.
    pub bias: [f32; 2],
}

impl Sight {
    /// What a sun sees of a sphere.
    pub(crate) fn of_sun(center: Vec3, radius: f32, to_light: Vec3) -> Self {
        Self {
            shadow_from_world: shadow_from_world(center, radius, to_light),
            texel: 2.0 * radius / SIDE as f32,
            bias: [0.0006, 0.0],
        }
    }

    /// What a lamp sees of a sphere. A lamp outside sees the whole sphere, a lamp inside sees what lies in its cone.
    /// Nothing more than 70 degrees off the axis is seen. What the map does not show counts as lit.
    pub(crate) fn of_lamp(center: Vec3, radius: f32, lamp: &PointLight) -> Self {
        /// Half the widest angle of a map.
        const WIDEST_RAD: f32 = 70.0 * std::f32::consts::PI / 180.0;
        let to_center = center - lamp.position;
        let away = to_center.length();
        let is_outside = away > 1.02 * radius;
        let half_rad = if is_outside {
            (radius / away).asin()
        } else {
            lamp.cone.map_or(WIDEST_RAD, |cone| cone.outer_cosine.clamp(-1.0, 1.0).acos())
        };
        let half_rad = half_rad.clamp(0.02, WIDEST_RAD);
        let axis = lamp.cone.filter(|_| !is_outside).map_or(to_center, |cone| cone.axis);
        let axis = axis.normalize_or(Vec3::NEG_Y);
        let up = if axis.y.abs() < 0.9 { Vec3::Y } else { Vec3::Z };
        let near = if is_outside { (away - radius).max(0.01 * radius) } else { 0.01 * radius };
        let far = away + radius;
        let lamp_from_world = glam::camera::rh::view::look_to_mat4(lamp.position, axis, up);
        let clip_from_lamp = glam::camera::rh::proj::opengl::perspective(2.0 * half_rad, 1.0, near, far);
        // The bias of a sun's map (0.0006 of its depth range of two radii, in world units), converted to depth in this
        // map. At distance z, this map's depth grows by far · near / ((far − near) z²) per world unit; the shader
        // divides by z².
        let bias = 0.0012 * radius * far * near / (far - near);
        Self {
            shadow_from_world: clip_from_lamp * lamp_from_world,
            texel: 2.0 * half_rad.tan() / SIDE as f32,
            bias: [0.0, bias],
        }
    }
}

const SHADOW: ProgramSource<'static> =
    ProgramSource::new("reference/shadow.vert", Some("reference/shadow.frag"), &[&["shadow_from_world"]]);
