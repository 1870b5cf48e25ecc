//! Draws bodies that are coloured by noise, such as fire. Several layers of noise travel over the body. The layers are
//! blended over what is behind the body, and may glow. Such bodies are drawn after the rest of the reference picture,
//! the farthest first.
//!
//! Passes:
//! - for each body, `place` (writes depth and id, and a normal of 0), then `look` (blends the colour, hides highlights
//!   behind it, and writes the target `glow`);
//! - `background`, under these bodies where nothing else is behind them;
//! - if something glows, `gather`, `spread` (twice) and `bloom`. They use two targets of a quarter of the width and
//!   height.
//!
//! Where noise displaces vertices, the vertex buffers already hold the displaced ones.

mod bloom;

use std::rc::Rc;

use glam::{Vec2, Vec3, Vec4};
use impasto_painting::frame::FrameBody;
use impasto_painting::{Frame, NoiseLayers};

use crate::body_program::BodyProgram;
use crate::gl::{
    Blend, Bound, DrawState, Filter, Format, Framebuffer, GlError, Gpu, Halt, Program, ProgramSource,
    ShaderFile, Texture, VertexArray, Vertices,
};
use crate::meshes::DrawnBody;
use crate::noise_tiles::NoiseTiles;
use crate::reference_targets::ReferenceTargets;
use crate::shader_files::{NOISE_DISPLACE, SHARED};
use crate::watch::Watch;
use bloom::Bloom;

pub(crate) struct NoiseDisplace {
    gpu: Gpu,
    screen: VertexArray,
    /// Created when the first body that is coloured by noise is drawn.
    programs: Option<Programs>,
    /// Created when the first such body glows.
    bloom: Option<Bloom>,
    targets: Option<Targets>,
}

struct Programs {
    place: BodyProgram,
    look: BodyProgram,
    background: Program,
}

struct Targets {
    /// Colour of the reference picture that these targets belong to.
    color: Rc<Texture>,
    depth_and_id: Rc<Texture>,
    glow: Rc<Texture>,
    place_pass: Framebuffer,
    look_pass: Framebuffer,
    glow_pass: Framebuffer,
    color_pass: Framebuffer,
}

/// Whether noise colours a body. If so, it is drawn after the rest of the reference picture, and casts no shadow.
pub(crate) fn is_coloured(body: &FrameBody) -> bool {
    layers(body).is_some()
}

fn layers(body: &FrameBody) -> Option<&NoiseLayers> {
    body.noise.as_ref()?.noise.layers.as_ref()
}

impl NoiseDisplace {
    pub(crate) fn new(gpu: &Gpu) -> Result<Self, GlError> {
        Ok(Self {
            gpu: gpu.clone(),
            screen: VertexArray::empty(gpu)?,
            programs: None,
            bloom: None,
            targets: None,
        })
    }

    /// Creates all programs at once, also those that are usually created when first needed.
    pub(crate) fn ready_all(&mut self) -> Result<(), GlError> {
        let mut programs = Programs::new(&self.gpu)?;
        programs.place.ready_all()?;
        programs.look.ready_all()?;
        self.programs = Some(programs);
        self.bloom = Some(Bloom::new(&self.gpu, [1, 1])?);
        Ok(())
    }

    /// Drops the targets, and the bloom with its programs.
    pub(crate) fn let_go(&mut self) {
        (self.targets, self.bloom) = (None, None);
    }

    /// Draws the bodies that are coloured by noise into the reference picture: blends their colour, and replaces depth
    /// and id.
    pub(crate) fn draw(
        &mut self,
        frame: &Frame,
        bodies: &[DrawnBody<'_>],
        tiles: &NoiseTiles,
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
        let targets = self.targets.insert(targets);
        let programs = match &mut self.programs {
            Some(programs) => programs,
            none => none.insert(Programs::new(&self.gpu)?),
        };
        programs.place.prepare(frame)?;
        programs.look.prepare(frame)?;
        let clear = DrawState { clear: Some([0.0; 4]), ..DrawState::default() };
        self.gpu.begin_pass(&targets.glow_pass, clear);
        for &index in &order {
            draw_body(&self.gpu, programs, targets, frame, tiles, (index + 1) as f32, &bodies[index])?;
        }
        if frame.background.is_some() {
            let state = DrawState { blend: Blend::Under, ..DrawState::default() };
            self.gpu.begin_pass(&targets.color_pass, state);
            let bound = programs.background.bind().set("background", frame.background_premultiplied());
            let bound = bound.texture("depth_and_id", &targets.depth_and_id);
            self.gpu.draw(bound, &self.screen, Vertices::Screen)?;
        }
        watch.passed("noise")?;
        let glows = |&index: &usize| layers(bodies[index].body).is_some_and(|layers| layers.bloom > 0.0);
        if !order.iter().any(glows) {
            return Ok(());
        }
        let bloom = match self.bloom.take() {
            Some(bloom) if bloom.has_size(frame.size_px) => bloom,
            _ => Bloom::new(&self.gpu, frame.size_px)?,
        };
        let bloom = self.bloom.insert(bloom);
        bloom.draw(&self.gpu, &self.screen, &targets.glow, &targets.color_pass)?;
        watch.passed("bloom")
    }
}

fn draw_body(
    gpu: &Gpu,
    programs: &Programs,
    targets: &Targets,
    frame: &Frame,
    tiles: &NoiseTiles,
    body_id: f32,
    DrawnBody { body, mesh, array }: &DrawnBody<'_>,
) -> Result<(), GlError> {
    let (Some(noise), Some(layers)) = (&body.noise, layers(body)) else { return Ok(()) };
    let in_front = DrawState { depth_test: true, depth_kept: true, ..DrawState::default() };
    gpu.begin_pass(&targets.place_pass, in_front);
    for part in &mesh.parts {
        let bound = set_camera(programs.place.bind(body, part), frame).set("body_id", body_id);
        gpu.draw(bound, array, part.vertices())?;
    }
    gpu.begin_pass(&targets.look_pass, DrawState { blend: Blend::Over, ..in_front });
    for part in &mesh.parts {
        let bound =
            set_layers(set_camera(programs.look.bind(body, part), frame), layers, noise.travelled, tiles);
        gpu.draw(bound, array, part.vertices())?;
    }
    Ok(())
}

/// Sets the camera's uniforms of `noise_displace/look.vert`; [`BodyProgram::bind`] has set those of the body.
fn set_camera<'a>(bound: Bound<'a>, frame: &Frame) -> Bound<'a> {
    bound.set("view_from_world", frame.view.view_from_world).set("clip_from_view", frame.view.clip_from_view)
}

/// Sets the uniforms of `noise_displace/look.frag`.
fn set_layers<'a>(bound: Bound<'a>, layers: &NoiseLayers, travelled: Vec2, tiles: &NoiseTiles) -> Bound<'a> {
    let bound = match tiles.get(&layers.tile) {
        Some(texture) => bound.texture("layer_noise", texture),
        None => bound,
    };
    let [red, green, blue] = layers.tint;
    bound
        .set("layer_count", layers.count as i32)
        .set("tiling", layers.tiling)
        .set("tile_offset", layers.offset)
        .set("travelled", travelled)
        .set("speed", layers.speed)
        .set("first_way", layers.first_way)
        .set("exponent", layers.exponent)
        .set("tint", Vec4::new(red, green, blue, layers.opacity))
        .set("alpha_is_grey", f32::from(layers.alpha_is_grey))
        .set("bloom", layers.bloom)
        .set("threshold", layers.threshold)
}

/// A body that is to be put in drawing order.
struct Placed<'a> {
    index: usize,
    body: &'a FrameBody,
    /// Depth of its centre along the gaze.
    depth: f32,
    /// The box that decides whether it is within another body.
    bounds: Option<(Vec3, Vec3)>,
}

impl<'a> Placed<'a> {
    fn of(index: usize, drawn: &DrawnBody<'a>, frame: &Frame) -> Self {
        let (body, mesh) = (drawn.body, &drawn.mesh);
        let bounds = match &body.bent {
            Some(bent) => body.surface.mesh.bounds_at(&bent.vertices.positions),
            None => mesh.bounds,
        };
        let (low, high) = bounds.unwrap_or_default();
        let center = body.world_from_model.transform_point3((low + high) * 0.5);
        let depth = -frame.view.view_from_world.transform_point3(center).z;
        // Noise moves the vertices to and fro. Whether a body is within another must not change with that, so the
        // surface at rest decides.
        let is_displaced = body.noise.as_ref().is_some_and(|noise| noise.noise.vertex.is_some());
        Self { index, body, depth, bounds: if is_displaced { mesh.bounds } else { bounds } }
    }

    /// Whether this body's box lies within the box of `outer`, after the outer box is grown by 5 % on each side.
    fn is_within(&self, outer: &Self) -> bool {
        let (Some((low, high)), Some((outer_low, outer_high))) = (self.bounds, outer.bounds) else {
            return false;
        };
        let outer_from_inner = outer.body.world_from_model.inverse() * self.body.world_from_model;
        let slack = (outer_high - outer_low) * 0.05;
        (0..8).all(|corner| {
            let pick = |axis: usize| if corner >> axis & 1 == 0 { low[axis] } else { high[axis] };
            let at = outer_from_inner.transform_point3(Vec3::new(pick(0), pick(1), pick(2)));
            at.cmpge(outer_low - slack).all() && at.cmple(outer_high + slack).all()
        })
    }
}

/// Indices of the bodies to draw, in drawing order: the farthest centre first, except that a body inside another is
/// drawn before that other. Fully transparent bodies are left out.
fn farthest_first(frame: &Frame, bodies: &[DrawnBody<'_>]) -> Vec<usize> {
    let shows = |body: &FrameBody| body.shows() && is_coloured(body);
    let mut order: Vec<Placed<'_>> = bodies
        .iter()
        .enumerate()
        .filter(|(_, drawn)| shows(drawn.body))
        .map(|(index, drawn)| Placed::of(index, drawn, frame))
        .collect();
    order.sort_by(|a, b| b.depth.total_cmp(&a.depth));
    let mut sorted: Vec<Placed<'_>> = Vec::with_capacity(order.len());
    for placed in order {
        let outer = sorted.iter().position(|other| placed.is_within(other));
        sorted.insert(outer.unwrap_or(sorted.len()), placed);
    }
    sorted.into_iter().map(|placed| placed.index).collect()
}

impl Programs {
    fn new(gpu: &Gpu) -> Result<Self, GlError> {
        Ok(Self {
            place: BodyProgram::new(gpu, FILES, PLACE)?,
            look: BodyProgram::new(gpu, FILES, LOOK)?,
            background: Program::new(gpu, FILES, &BACKGROUND)?,
        })
    }
}

const FILES: &[&[ShaderFile]] = &[SHARED, NOISE_DISPLACE];

const PLACE: ProgramSource<'static> = ProgramSource::new(
    "noise_displace/look.vert",
    Some("shared/place.frag"),
    &[&["view_from_world", "clip_from_view", "body_id"]],
);

const LOOK: ProgramSource<'static> = ProgramSource::new(
    "noise_displace/look.vert",
    Some("noise_displace/look.frag"),
    &[&[
        "view_from_world",
        "clip_from_view",
        "layer_noise",
        "layer_count",
        "tiling",
        "tile_offset",
        "travelled",
        "speed",
        "first_way",
        "exponent",
        "tint",
        "alpha_is_grey",
        "bloom",
        "threshold",
    ]],
);

const BACKGROUND: ProgramSource<'static> =
    ProgramSource::screen("noise_displace/background.frag", &[&["background", "depth_and_id"]]);

impl Targets {
    fn new(gpu: &Gpu, reference: &ReferenceTargets) -> Result<Self, GlError> {
        let color = Rc::clone(&reference.color);
        let glow = Rc::new(Texture::target(gpu, Format::Rgba16F, color.size_px(), Filter::Nearest)?);
        let (depth, depth_and_id) = (&reference.unlit()?.depth, &reference.depth_and_id);
        Ok(Self {
            place_pass: Framebuffer::new(gpu, &[depth_and_id, &reference.normal], Some(depth))?,
            look_pass: Framebuffer::new(
                gpu,
                &[&color, &reference.glint, &reference.highlight, &glow],
                Some(depth),
            )?,
            glow_pass: Framebuffer::new(gpu, &[&glow], None)?,
            color_pass: Framebuffer::new(gpu, &[&color], None)?,
            depth_and_id: Rc::clone(depth_and_id),
            glow,
            color,
        })
    }
}
