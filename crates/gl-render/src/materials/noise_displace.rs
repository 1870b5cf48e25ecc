//! Bodies that noise displaces and colours.
//!
//! Displaced vertices go through the reference pass's own programs with another vertex stage. Coloured bodies are drawn behind
//! it, the farthest first. Targets: `glow`, two of a quarter of its size. Passes: for each body place (depth and id) and look
//! (colour, blended); ground (the background where nothing else is behind); where something glows, gather, spread (twice),
//! bloom.

mod bloom;
mod programs;

use std::rc::Rc;
use std::sync::{Arc, Weak};

use glam::{Vec2, Vec3, Vec4};
use impasto_core::noise_displace::{Along, Lookup, Tile, gaussian};
use impasto_painting::Frame;
use impasto_painting::frame::FrameBody;
use impasto_painting::{FrameNoise, NoiseLayers};

use crate::gl::{
    Blend, Bound, DrawState, Filter, Format, Framebuffer, GlError, Gpu, Halt, Program, Texture, VertexArray,
    Vertices,
};
use crate::meshes::MeshOnGpu;
use crate::reference::ReferenceTargets;
use crate::styles::ground;
use crate::watch::Watch;
use bloom::Bloom;
use programs::{Programs, Variants};

/// A program of the reference pass.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Stage {
    Surface,
    Shadow,
    Motion,
}

/// All that such bodies need on the GPU; made when the first one is drawn.
pub(crate) struct NoiseDisplace {
    gpu: Gpu,
    screen: VertexArray,
    variants: Option<Variants>,
    programs: Option<Programs>,
    bloom: Option<Bloom>,
    tiles: Vec<(Weak<Tile>, Rc<Texture>)>,
    targets: Option<Targets>,
}

struct Targets {
    /// Of the reference picture that these go with.
    color: Rc<Texture>,
    place: Rc<Texture>,
    glow: Rc<Texture>,
    place_pass: Framebuffer,
    look_pass: Framebuffer,
    glow_pass: Framebuffer,
    color_pass: Framebuffer,
}

/// Whether a body is coloured by noise: it is drawn behind the reference pass, and casts no shadow.
pub(crate) fn is_coloured(body: &FrameBody) -> bool {
    layers(body).is_some()
}

/// Whether noise moves a body's vertices.
pub(crate) fn is_displaced(body: &FrameBody) -> bool {
    body.noise.as_ref().is_some_and(|noise| noise.noise.vertex.is_some())
}

fn layers(body: &FrameBody) -> Option<&NoiseLayers> {
    body.noise.as_ref()?.noise.layers.as_ref()
}

impl NoiseDisplace {
    pub(crate) fn new(gpu: &Gpu) -> Result<Self, GlError> {
        Ok(Self {
            gpu: gpu.clone(),
            screen: VertexArray::empty(gpu)?,
            variants: None,
            programs: None,
            bloom: None,
            tiles: Vec::new(),
            targets: None,
        })
    }

    /// Makes ready what a frame needs; nothing where no body has noise.
    pub(crate) fn prepare(&mut self, frame: &Frame) -> Result<(), GlError> {
        let noises = frame.bodies.iter().filter(|body| !body.hidden).filter_map(|body| body.noise.as_ref());
        for FrameNoise { noise, .. } in noises {
            if self.variants.is_none() {
                self.variants = Some(Variants::new(&self.gpu)?);
            }
            self.upload(noise.vertex.as_ref().map_or_else(gaussian, |vertex| Arc::clone(&vertex.tile)))?;
            if let Some(layers) = &noise.layers {
                self.upload(Arc::clone(&layers.tile))?;
                if self.programs.is_none() {
                    self.programs = Some(Programs::new(&self.gpu)?);
                }
            }
        }
        Ok(())
    }

    /// Makes at once every program that otherwise waits until it is needed.
    pub(crate) fn ready_all(&mut self) -> Result<(), GlError> {
        self.variants = Some(Variants::new(&self.gpu)?);
        self.programs = Some(Programs::new(&self.gpu)?);
        self.bloom = Some(Bloom::new(&self.gpu, [1, 1])?);
        Ok(())
    }

    fn upload(&mut self, tile: Arc<Tile>) -> Result<(), GlError> {
        if self.tile(&tile).is_some() {
            return Ok(());
        }
        self.tiles.retain(|(tile, _)| tile.strong_count() > 0);
        let size = tile.size().map(|side| side as u32);
        let texels = bytemuck::cast_slice(tile.texels());
        let texture = Texture::with_driver_levels(&self.gpu, Format::Rgba32F, size, texels)?;
        self.tiles.push((Arc::downgrade(&tile), Rc::new(texture)));
        Ok(())
    }

    fn tile(&self, tile: &Arc<Tile>) -> Option<&Texture> {
        let here = |weak: &Weak<Tile>| std::ptr::eq(weak.as_ptr(), Arc::as_ptr(tile));
        self.tiles.iter().find(|(weak, _)| here(weak)).map(|(_, texture)| &**texture)
    }

    /// Starts a draw of a body in a pass of the reference: with the pass's usual program, or with one that displaces it.
    pub(crate) fn bind<'a>(&'a self, usual: &'a Program, stage: Stage, body: &FrameBody) -> Bound<'a> {
        let noise = body.noise.as_ref().filter(|_| is_displaced(body));
        let Some((noise, variants)) = noise.zip(self.variants.as_ref()) else { return usual.bind() };
        let moves_normals = noise.noise.vertex.as_ref().is_some_and(|vertex| vertex.moves_normals);
        match stage {
            Stage::Surface => {
                self.displace(variants.surface.bind(), noise).set("moves_normals", f32::from(moves_normals))
            }
            Stage::Shadow => self.displace(variants.shadow.bind(), noise),
            Stage::Motion => self.displace(variants.motion.bind(), noise),
        }
    }

    /// As [`NoiseDisplace::bind`] of the motion pass, with where the body's vertices looked in the other picture.
    pub(crate) fn bind_motion<'a>(&'a self, usual: &'a Program, [now, then]: [&FrameBody; 2]) -> Bound<'a> {
        let bound = self.bind(usual, Stage::Motion, now);
        match now.noise.as_ref().filter(|_| is_displaced(now)) {
            Some(noise) => {
                let [u, v] = rows(&then.noise.as_ref().unwrap_or(noise).lookup);
                bound.set("lookup_u_then", u).set("lookup_v_then", v)
            }
            None => bound,
        }
    }

    /// Sets the uniforms of `noise_displace/displace.glsl`, and where vertices look.
    fn displace<'a>(&self, bound: Bound<'a>, noise: &FrameNoise) -> Bound<'a> {
        let [u, v] = rows(&noise.lookup);
        let vertex = noise.noise.vertex.as_ref();
        let tile = vertex.map_or_else(gaussian, |vertex| Arc::clone(&vertex.tile));
        let is_along_normal = vertex.is_some_and(|vertex| vertex.along == Along::Normal);
        let bound = match self.tile(&tile) {
            Some(texture) => bound.texture("vertex_noise", texture),
            None => bound,
        };
        bound
            .set("lookup_u", u)
            .set("lookup_v", v)
            .set("noise_scale", vertex.map_or(0.0, |vertex| vertex.scale as f32))
            .set("along_normal", f32::from(is_along_normal))
    }

    /// Draws the bodies that noise colours into the reference picture: colour over what is there, depth and id in its place.
    pub(crate) fn draw(
        &mut self,
        frame: &Frame,
        bodies: &[(&FrameBody, Rc<MeshOnGpu>)],
        reference: &ReferenceTargets,
        watch: &mut Watch<'_>,
    ) -> Result<(), Halt> {
        let order = farthest_first(frame, bodies);
        if order.is_empty() {
            return Ok(());
        }
        let targets = match self.targets.take() {
            Some(targets) if Rc::ptr_eq(&targets.color, &reference.color) => targets,
            _ => Targets::new(&self.gpu, reference)?,
        };
        self.targets = Some(targets);
        self.draw_bodies(frame, bodies, &order)?;
        watch.passed("noise")?;
        let glows = |&index: &usize| layers(bodies[index].0).is_some_and(|layers| layers.bloom > 0.0);
        if !order.iter().any(glows) {
            return Ok(());
        }
        let bloom = match self.bloom.take() {
            Some(bloom) if bloom.is_of(frame.size_px) => bloom,
            _ => Bloom::new(&self.gpu, frame.size_px)?,
        };
        let bloom = &*self.bloom.insert(bloom);
        if let Some(targets) = &self.targets {
            bloom.draw(&self.gpu, &self.screen, (&targets.glow, &targets.color_pass))?;
        }
        watch.passed("bloom")
    }

    fn draw_bodies(
        &self,
        frame: &Frame,
        bodies: &[(&FrameBody, Rc<MeshOnGpu>)],
        order: &[usize],
    ) -> Result<(), GlError> {
        let (Some(targets), Some(programs)) = (&self.targets, &self.programs) else { return Ok(()) };
        let clear = DrawState { clear: Some([0.0; 4]), ..DrawState::default() };
        self.gpu.begin_pass(&targets.glow_pass, clear);
        let kept = DrawState { depth_test: true, depth_kept: true, ..DrawState::default() };
        for &index in order {
            let (body, mesh) = &bodies[index];
            let (Some(noise), Some(layers)) = (&body.noise, layers(body)) else { continue };
            self.gpu.begin_pass(&targets.place_pass, kept);
            for part in &mesh.parts {
                let bound = self.stand(programs.place.bind(), (frame, body), noise);
                let bound = bound.set("body_id", (index + 1) as f32);
                let vertices = Vertices::Indexed { first: part.first_index, count: part.index_count };
                self.gpu.draw(bound, &mesh.array, vertices)?;
            }
            self.gpu.begin_pass(&targets.look_pass, DrawState { blend: Blend::Over, ..kept });
            for part in &mesh.parts {
                let bound = self.stand(programs.look.bind(), (frame, body), noise);
                let bound = self.layer(bound, layers, noise.travelled);
                let vertices = Vertices::Indexed { first: part.first_index, count: part.index_count };
                self.gpu.draw(bound, &mesh.array, vertices)?;
            }
        }
        if frame.background.is_some() {
            self.gpu
                .begin_pass(&targets.color_pass, DrawState { blend: Blend::Under, ..DrawState::default() });
            let bound = programs.ground.bind().set("ground", ground(frame));
            let bound = bound.texture("depth_and_id", &targets.place);
            self.gpu.draw(bound, &self.screen, Vertices::Screen)?;
        }
        Ok(())
    }

    /// Sets the uniforms of `noise_displace/look.vert`.
    fn stand<'a>(
        &self,
        bound: Bound<'a>,
        (frame, body): (&Frame, &FrameBody),
        noise: &FrameNoise,
    ) -> Bound<'a> {
        self.displace(bound, noise)
            .set("world_from_model", body.world_from_model)
            .set("morph", body.morph)
            .set("view_from_world", frame.view.view_from_world)
            .set("clip_from_view", frame.view.clip_from_view)
    }

    /// Sets the uniforms of `noise_displace/look.frag`.
    fn layer<'a>(&self, bound: Bound<'a>, layers: &NoiseLayers, travelled: Vec2) -> Bound<'a> {
        let bound = match self.tile(&layers.tile) {
            Some(texture) => bound.texture("layer_noise", texture),
            None => bound,
        };
        bound
            .set("layer_count", layers.count as i32)
            .set("tiling", layers.tiling)
            .set("tile_offset", layers.offset)
            .set("travelled", travelled)
            .set("speed", layers.speed)
            .set("first_way", layers.first_way)
            .set("exponent", layers.exponent)
            .set("tint", Vec4::from_array([layers.tint[0], layers.tint[1], layers.tint[2], layers.opacity]))
            .set("alpha_is_grey", f32::from(layers.alpha_is_grey))
            .set("bloom", layers.bloom)
            .set("threshold", layers.threshold)
    }
}

/// The bodies that are drawn here, by the depth of their middles, and what is within another before that; one that is wholly
/// clear is not there.
fn farthest_first(frame: &Frame, bodies: &[(&FrameBody, Rc<MeshOnGpu>)]) -> Vec<usize> {
    let depth = |(body, mesh): &(&FrameBody, Rc<MeshOnGpu>)| {
        let (low, high) = mesh.bounds.unwrap_or_default();
        let middle = body.world_from_model.transform_point3((low + high) * 0.5);
        -frame.view.view_from_world.transform_point3(middle).z
    };
    let is_there = |body: &FrameBody| !body.hidden && layers(body).is_some_and(|layers| layers.opacity > 0.0);
    let mut order: Vec<(usize, f32)> = bodies
        .iter()
        .enumerate()
        .filter(|(_, (body, _))| is_there(body))
        .map(|(index, body)| (index, depth(body)))
        .collect();
    order.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut sorted: Vec<usize> = Vec::with_capacity(order.len());
    for (index, _) in order {
        let outer = sorted.iter().position(|&other| is_within(&bodies[index], &bodies[other]));
        sorted.insert(outer.unwrap_or(sorted.len()), index);
    }
    sorted
}

/// Whether the box round a body lies in that of another, as that stands.
fn is_within(inner: &(&FrameBody, Rc<MeshOnGpu>), outer: &(&FrameBody, Rc<MeshOnGpu>)) -> bool {
    let (Some((low, high)), Some(room)) = (inner.1.bounds, outer.1.bounds) else { return false };
    let outer_from_inner = outer.0.world_from_model.inverse() * inner.0.world_from_model;
    let slack = (room.1 - room.0) * 0.05;
    (0..8).all(|corner| {
        let pick = |axis: usize| if corner >> axis & 1 == 0 { low[axis] } else { high[axis] };
        let at = outer_from_inner.transform_point3(Vec3::new(pick(0), pick(1), pick(2)));
        at.cmpge(room.0 - slack).all() && at.cmple(room.1 + slack).all()
    })
}

fn rows(lookup: &Lookup) -> [Vec4; 2] {
    lookup.rows.map(|row| row.as_vec4())
}

impl Targets {
    fn new(gpu: &Gpu, reference: &ReferenceTargets) -> Result<Self, GlError> {
        let color = Rc::clone(&reference.color);
        let glow = Rc::new(Texture::target(gpu, Format::Rgba16F, color.size_px(), Filter::Nearest)?);
        let (depth, place) = (&reference.depth, &reference.depth_and_id);
        Ok(Self {
            place_pass: Framebuffer::new(gpu, &[place], Some(depth))?,
            look_pass: Framebuffer::new(gpu, &[&color, &reference.glint, &glow], Some(depth))?,
            glow_pass: Framebuffer::new(gpu, &[&glow], None)?,
            color_pass: Framebuffer::new(gpu, &[&color], None)?,
            place: Rc::clone(place),
            glow,
            color,
        })
    }
}
