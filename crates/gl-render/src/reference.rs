//! The reference picture: a plain render with shadows, from which strokes take colour, depth and body.

use std::rc::Rc;
use std::sync::{Arc, Weak};

use glam::{Mat4, Vec3, Vec4};
use impasto_painting::frame::{BodySurface, FrameBody, FrameView};
use impasto_painting::{Frame, FrameNoise, Quality};

use crate::gl::{
    Bound, DrawState, Filter, Format, Framebuffer, GlError, Gpu, Halt, Program, ProgramSource, Texture,
    VertexArray, Vertices,
};
use crate::materials::noise_displace::{self, NoiseDisplace, Stage};
use crate::meshes::{MeshCache, MeshOnGpu};
use crate::shader_files::{REFERENCE, SHARED};
use crate::watch::Watch;

/// Side of the shadow map in texels.
const SHADOW_SIDE: u32 = 2048;

/// The uniforms of `shared/lens.glsl`.
pub(crate) const LENS_UNIFORMS: [&str; 4] =
    ["world_from_view", "size_px", "px_per_unit_at_1", "orthographic"];

/// What the reference pass leaves behind for the styles.
pub(crate) struct ReferenceTargets {
    size_px: [u32; 2],
    pub(crate) color: Rc<Texture>,
    pub(crate) normal: Rc<Texture>,
    pub(crate) depth_and_id: Rc<Texture>,
    pub(crate) glint: Rc<Texture>,
    pub(crate) depth: Rc<Texture>,
    pub(crate) albedo: Rc<Texture>,
    openness: Rc<Texture>,
    surface_pass: Framebuffer,
    openness_pass: Framebuffer,
    pub(crate) light_pass: Framebuffer,
}

/// The passes: shadow, surface, openness, light.
pub(crate) struct ReferencePass {
    gpu: Gpu,
    shadow: Program,
    surface: Program,
    openness: Program,
    light: Program,
    /// Made when the first draft is drawn.
    draft_light: Option<Program>,
    screen: VertexArray,
    shadow_depth: Rc<Texture>,
    shadow_pass: Framebuffer,
    /// What the shadow map shows.
    shadow_of: Option<Casters>,
    meshes: MeshCache,
    pub(crate) noise: NoiseDisplace,
}

/// What a shadow map is drawn from.
struct Casters {
    /// Surface, pose and shape of every body. A surface's address is not used again while somebody remembers it.
    bodies: Vec<(Weak<BodySurface>, Mat4, f32, Option<FrameNoise>)>,
    shadow_from_world: Mat4,
}

impl Casters {
    fn new(bodies: &[(&FrameBody, Rc<MeshOnGpu>)], shadow_from_world: Mat4) -> Self {
        let bodies = bodies
            .iter()
            .filter(|(body, _)| casts_shadow(body))
            .map(|(body, _)| {
                (Arc::downgrade(&body.surface), body.world_from_model, body.morph, body.noise.clone())
            })
            .collect();
        Self { bodies, shadow_from_world }
    }
}

impl PartialEq for Casters {
    fn eq(&self, other: &Self) -> bool {
        self.shadow_from_world == other.shadow_from_world
            && self.bodies.len() == other.bodies.len()
            && self
                .bodies
                .iter()
                .zip(&other.bodies)
                .all(|(a, b)| a.0.ptr_eq(&b.0) && (a.1, a.2, &a.3) == (b.1, b.2, &b.3))
    }
}

fn casts_shadow(body: &FrameBody) -> bool {
    !body.hidden && !noise_displace::is_coloured(body)
}

/// The lights of a frame as shaders read them.
pub(crate) struct LightSetup {
    lights: Texture,
    light_count: i32,
    shadowed_light: i32,
    shadow_depth: Rc<Texture>,
    shadow_from_world: Mat4,
    shadow_texel: f32,
    ambient_above: Vec3,
    ambient_below: Vec3,
}

/// The lens of a frame as shaders read it.
#[derive(Clone, Copy)]
pub(crate) struct LensSetup {
    world_from_view: Mat4,
    size_px: glam::Vec2,
    pub(crate) px_per_unit_at_1: f32,
    pub(crate) orthographic: f32,
}

impl LensSetup {
    pub(crate) fn new(view: &FrameView, size_px: [u32; 2]) -> Self {
        Self {
            world_from_view: view.view_from_world.inverse(),
            size_px: glam::UVec2::from(size_px).as_vec2(),
            px_per_unit_at_1: view.clip_from_view.y_axis.y * 0.5 * size_px[1] as f32,
            orthographic: f32::from(view.orthographic),
        }
    }

    /// Sets the uniforms of `shared/lens.glsl` that are named.
    pub(crate) fn set<'a>(&self, mut bound: Bound<'a>, names: &[&str]) -> Bound<'a> {
        for &name in names {
            bound = match name {
                "world_from_view" => bound.set(name, self.world_from_view),
                "size_px" => bound.set(name, self.size_px),
                "px_per_unit_at_1" => bound.set(name, self.px_per_unit_at_1),
                _ => bound.set(name, self.orthographic),
            };
        }
        bound
    }
}

impl LightSetup {
    /// The uniforms of `reference/lighting.glsl`.
    pub(crate) const UNIFORMS: [&str; 8] = [
        "lights",
        "light_count",
        "shadowed_light",
        "shadow_depth",
        "shadow_from_world",
        "shadow_texel",
        "ambient_above",
        "ambient_below",
    ];

    pub(crate) fn set<'a>(&self, bound: Bound<'a>) -> Bound<'a> {
        bound
            .texture("lights", &self.lights)
            .set("light_count", self.light_count)
            .set("shadowed_light", self.shadowed_light)
            .texture("shadow_depth", &self.shadow_depth)
            .set("shadow_from_world", self.shadow_from_world)
            .set("shadow_texel", self.shadow_texel)
            .set("ambient_above", self.ambient_above)
            .set("ambient_below", self.ambient_below)
    }
}

impl ReferenceTargets {
    fn new(gpu: &Gpu, size_px: [u32; 2]) -> Result<Self, GlError> {
        let target = |format: Format, size_px: [u32; 2], filter: Filter| {
            Texture::target(gpu, format, size_px, filter).map(Rc::new)
        };
        let half = size_px.map(|side| side.div_ceil(2));
        let color = target(Format::Rgba16F, size_px, Filter::Nearest)?;
        let glint = target(Format::R16F, size_px, Filter::Nearest)?;
        let albedo = target(Format::Rgba16F, size_px, Filter::Nearest)?;
        let normal = target(Format::Rgba16F, size_px, Filter::Nearest)?;
        let depth_and_id = target(Format::Rg32F, size_px, Filter::Nearest)?;
        let openness = target(Format::Rgba8, half, Filter::LinearInLevel)?;
        let depth = target(Format::Depth32F, size_px, Filter::Nearest)?;
        Ok(Self {
            size_px,
            surface_pass: Framebuffer::new(gpu, &[&albedo, &normal, &depth_and_id], Some(&depth))?,
            openness_pass: Framebuffer::new(gpu, &[&openness], None)?,
            light_pass: Framebuffer::new(gpu, &[&color, &glint], None)?,
            color,
            glint,
            depth,
            normal,
            depth_and_id,
            albedo,
            openness,
        })
    }

    /// Depth along the gaze and body id of every pixel, bottom row first.
    pub(crate) fn read_depth_and_id(&self) -> Vec<f32> {
        self.surface_pass.read_floats(2)
    }
}

/// Makes the targets anew when the size of the picture changes.
pub(crate) fn targets_of_size(
    gpu: &Gpu,
    kept: Option<ReferenceTargets>,
    size_px: [u32; 2],
) -> Result<ReferenceTargets, GlError> {
    match kept {
        Some(targets) if targets.size_px == size_px => Ok(targets),
        _ => ReferenceTargets::new(gpu, size_px),
    }
}

impl ReferencePass {
    pub(crate) fn new(gpu: &Gpu) -> Result<Self, GlError> {
        let program = |source: &ProgramSource<'_>| Program::new(gpu, &[SHARED, REFERENCE], source);
        let shadow_depth = Rc::new(Texture::target(
            gpu,
            Format::Depth32F,
            [SHADOW_SIDE, SHADOW_SIDE],
            Filter::ShadowCompare,
        )?);
        Ok(Self {
            gpu: gpu.clone(),
            shadow: program(&SHADOW)?,
            surface: program(&SURFACE)?,
            openness: program(&OPENNESS)?,
            light: program(&LIGHT)?,
            draft_light: None,
            screen: VertexArray::empty(gpu)?,
            shadow_pass: Framebuffer::new(gpu, &[], Some(&shadow_depth))?,
            shadow_depth,
            shadow_of: None,
            meshes: MeshCache::new(gpu)?,
            noise: NoiseDisplace::new(gpu)?,
        })
    }

    /// Draws the reference picture into `targets`; what it returns lights strokes the same way.
    pub(crate) fn draw(
        &mut self,
        frame: &Frame,
        targets: &ReferenceTargets,
        watch: &mut Watch<'_>,
    ) -> Result<LightSetup, Halt> {
        let lens = LensSetup::new(&frame.view, frame.size_px);
        let bodies = self.bodies(frame)?;
        let lights = self.lights(frame)?;
        self.noise.prepare(frame)?;
        self.draw_shadow(&bodies, &lights)?;
        watch.passed("shadow")?;
        self.draw_surfaces(frame, &bodies, targets)?;
        watch.passed("surface")?;

        self.gpu.begin_pass(&targets.openness_pass, DrawState::default());
        let bound = lens
            .set(self.openness.bind(), &LENS_UNIFORMS[1..])
            .texture("normal", &targets.normal)
            .texture("depth_and_id", &targets.depth_and_id)
            .set("view_from_world", frame.view.view_from_world);
        self.gpu.draw(bound, &self.screen, Vertices::Screen)?;
        watch.passed("openness")?;

        self.gpu.begin_pass(&targets.light_pass, DrawState::default());
        if frame.quality == Quality::Draft {
            self.ready_drafts()?;
        }
        let light = match (frame.quality, &self.draft_light) {
            (Quality::Draft, Some(light)) => light,
            _ => &self.light,
        };
        let bound = lights
            .set(lens.set(light.bind(), &LENS_UNIFORMS))
            .texture("albedo_and_lit", &targets.albedo)
            .texture("normal", &targets.normal)
            .texture("depth_and_id", &targets.depth_and_id)
            .texture("openness", &targets.openness);
        self.gpu.draw(bound, &self.screen, Vertices::Screen)?;
        watch.passed("light")?;
        self.noise.draw(frame, &bodies, targets, watch)?;
        Ok(lights)
    }

    /// Makes at once every program that otherwise waits until it is needed.
    pub(crate) fn ready_all(&mut self) -> Result<(), GlError> {
        self.ready_drafts()?;
        self.noise.ready_all()
    }

    /// Makes what drafts need, unless it is there.
    fn ready_drafts(&mut self) -> Result<(), GlError> {
        if self.draft_light.is_none() {
            let source = ProgramSource { defined: &["DRAFT"], ..LIGHT };
            self.draft_light = Some(Program::new(&self.gpu, &[SHARED, REFERENCE], &source)?);
        }
        Ok(())
    }

    /// The bodies of a frame with their surfaces on the GPU.
    pub(crate) fn bodies<'a>(
        &mut self,
        frame: &'a Frame,
    ) -> Result<Vec<(&'a FrameBody, Rc<MeshOnGpu>)>, GlError> {
        let gpu = self.gpu.clone();
        frame.bodies.iter().map(|body| Ok((body, self.meshes.get(&gpu, &body.surface)?))).collect()
    }

    fn lights(&self, frame: &Frame) -> Result<LightSetup, GlError> {
        let lights = &frame.lights;
        let suns = lights.suns.iter().map(|sun| (sun.to_light.extend(0.0), sun.radiance));
        let points = lights.points.iter().map(|point| (point.position.extend(1.0), point.radiance));
        let (places, radiances): (Vec<Vec4>, Vec<Vec3>) = suns.chain(points).unzip();
        let count = places.len();
        let mut texels: Vec<[f32; 4]> = places.iter().map(Vec4::to_array).collect();
        texels.resize(count.max(1), [0.0; 4]);
        texels.extend(radiances.iter().map(|radiance| radiance.extend(0.0).to_array()));
        texels.resize(2 * count.max(1), [0.0; 4]);
        let texture = Texture::from_texels(
            &self.gpu,
            Format::Rgba32F,
            [count.max(1) as u32, 2],
            bytemuck::cast_slice(&texels),
        )?;
        let (center, radius) = lights.shadow_bounds;
        let to_light = lights.suns.first().map_or(Vec3::Y, |sun| sun.to_light);
        Ok(LightSetup {
            lights: texture,
            light_count: count as i32,
            shadowed_light: if lights.suns.is_empty() { -1 } else { 0 },
            shadow_depth: Rc::clone(&self.shadow_depth),
            shadow_from_world: shadow_from_world(center, radius, to_light),
            shadow_texel: 2.0 * radius / SHADOW_SIDE as f32,
            ambient_above: lights.ambient_above,
            ambient_below: lights.ambient_below,
        })
    }

    /// Draws the shadow map, unless it is there from the frame before.
    fn draw_shadow(
        &mut self,
        bodies: &[(&FrameBody, Rc<MeshOnGpu>)],
        lights: &LightSetup,
    ) -> Result<(), GlError> {
        if lights.shadowed_light < 0 {
            return Ok(());
        }
        let casters = Casters::new(bodies, lights.shadow_from_world);
        // Taken away while it is drawn anew.
        let before = self.shadow_of.take();
        if before.as_ref() == Some(&casters) {
            self.shadow_of = before;
            return Ok(());
        }
        let state = DrawState { depth_test: true, depth_offset: true, ..DrawState::default() };
        self.gpu.begin_pass(&self.shadow_pass, state);
        for (body, mesh) in bodies.iter().filter(|(body, _)| casts_shadow(body)) {
            for part in &mesh.parts {
                let bound = self
                    .noise
                    .bind(&self.shadow, Stage::Shadow, body)
                    .set("world_from_model", body.world_from_model)
                    .set("morph", body.morph)
                    .set("shadow_from_world", lights.shadow_from_world);
                let vertices = Vertices::Indexed { first: part.first_index, count: part.index_count };
                self.gpu.draw(bound, &mesh.array, vertices)?;
            }
        }
        self.shadow_of = Some(casters);
        Ok(())
    }

    fn draw_surfaces(
        &self,
        frame: &Frame,
        bodies: &[(&FrameBody, Rc<MeshOnGpu>)],
        targets: &ReferenceTargets,
    ) -> Result<(), GlError> {
        let state = DrawState { depth_test: true, clear: Some([0.0; 4]), ..DrawState::default() };
        self.gpu.begin_pass(&targets.surface_pass, state);
        let view = &frame.view;
        let eye = if view.orthographic {
            view.view_from_world.inverse().z_axis.truncate().extend(0.0)
        } else {
            view.eye_in_world.extend(1.0)
        };
        let is_here = |body: &FrameBody| !body.hidden && !noise_displace::is_coloured(body);
        for (index, (body, mesh)) in bodies.iter().enumerate().filter(|(_, (body, _))| is_here(body)) {
            // In a draft half the triangles are enough; where the eye may be inside, or the surface is no more as its mesh has
            // it, all of them.
            let front = match frame.quality {
                Quality::Draft if body.morph == 0.0 && !noise_displace::is_displaced(body) => {
                    let eye = body.world_from_model.inverse() * eye;
                    let is_outside = mesh.is_outside(eye);
                    is_outside.then(|| mesh.front(&self.gpu, &body.surface, eye)).transpose()?
                }
                _ => None,
            };
            for (number, part) in mesh.parts.iter().enumerate() {
                let material = body.surface.materials.get(part.material);
                let albedo = material.map_or([0.8; 3], |material| material.albedo);
                let is_lit = material.is_none_or(|material| !material.unlit);
                let bound = self
                    .noise
                    .bind(&self.surface, Stage::Surface, body)
                    .set("world_from_model", body.world_from_model)
                    .set("morph", body.morph)
                    .set("view_from_world", view.view_from_world)
                    .set("clip_from_view", view.clip_from_view)
                    .set("albedo", Vec3::from(albedo))
                    .texture("albedo_texture", &part.texture)
                    .set("is_lit", f32::from(is_lit))
                    .set("body_id", (index + 1) as f32)
                    .set("gloss", material.map_or(0.0, |material| material.gloss))
                    .set("eye", eye);
                let (array, [first, count]) = match &front {
                    Some((array, ranges)) => (&**array, ranges[number]),
                    None => (&mesh.array, [part.first_index, part.index_count]),
                };
                self.gpu.draw(bound, array, Vertices::Indexed { first, count })?;
            }
        }
        Ok(())
    }
}

/// Looks at a sphere from where the sun is, with the whole of it in clip space.
fn shadow_from_world(center: Vec3, radius: f32, to_light: Vec3) -> Mat4 {
    let up = if to_light.y.abs() < 0.9 { Vec3::Y } else { Vec3::Z };
    let right = up.cross(to_light).normalize_or(Vec3::X);
    let above = to_light.cross(right);
    let scale = 1.0 / (radius * 1.02);
    let row = |axis: Vec3| (axis * scale).extend(-axis.dot(center) * scale);
    // Depth grows away from the light.
    Mat4::from_cols(row(right), row(above), row(-to_light), Vec4::W).transpose()
}

pub(crate) const SHADOW: ProgramSource<'static> = ProgramSource {
    vertex: "reference/shadow.vert",
    fragment: Some("reference/shadow.frag"),
    captured: &[],
    uniforms: &["world_from_model", "morph", "shadow_from_world"],
    defined: &[],
};

pub(crate) const SURFACE: ProgramSource<'static> = ProgramSource {
    vertex: "reference/surface.vert",
    fragment: Some("reference/surface.frag"),
    captured: &[],
    uniforms: &[
        "world_from_model",
        "morph",
        "view_from_world",
        "clip_from_view",
        "albedo",
        "albedo_texture",
        "is_lit",
        "body_id",
        "gloss",
        "eye",
    ],
    defined: &[],
};

const OPENNESS: ProgramSource<'static> = ProgramSource {
    vertex: "shared/screen.vert",
    fragment: Some("reference/openness.frag"),
    captured: &[],
    uniforms: &["size_px", "px_per_unit_at_1", "orthographic", "normal", "depth_and_id", "view_from_world"],
    defined: &[],
};

const LIGHT: ProgramSource<'static> = ProgramSource {
    vertex: "shared/screen.vert",
    fragment: Some("reference/light.frag"),
    captured: &[],
    uniforms: &[
        "world_from_view",
        "size_px",
        "px_per_unit_at_1",
        "orthographic",
        "lights",
        "light_count",
        "shadowed_light",
        "shadow_depth",
        "shadow_from_world",
        "shadow_texel",
        "ambient_above",
        "ambient_below",
        "albedo_and_lit",
        "normal",
        "depth_and_id",
        "openness",
    ],
    defined: &[],
};
