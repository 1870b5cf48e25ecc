//! Ink on paper: a dark silhouette over an interior of four tones.
//!
//! The style has two ways of drawing, called rules ([`InkRule`]). The first is the rule of its source, the RenderMonkey
//! effect "Sumi-e Drawing" (`docs/techniques/sumi_e.md`). Targets, 8 bits a channel: `silhouette`,
//! `blurred silhouette`, `interior`, `blurred interior`. Passes: those of [`SOURCE_PASSES`].
//!
//! The second is our own rule. Targets: `wash` (silhouette, interior, seal red, body), `soft` and `wide` (the wash
//! blurred a little, and far), `strokes`. Passes: wash, soften (four times), resolve (finds ink, presence and place of
//! each stroke), ink strokes (a billboard each), lay.

mod paper;
mod programs;
mod strokes;
mod targets;

use glam::{Mat3, Vec2, Vec3, Vec4};
use impasto_painting::Frame;
use impasto_painting::frame::{InkDrawing, InkLight, InkRule, Style, SumiE as Settings};

use crate::body_program::BodyProgram;
use crate::encode::Output;
use crate::gl::{Bound, DrawState, Format, Framebuffer, GlError, Gpu, Halt, Texture, VertexArray, Vertices};
use crate::lens::{LensSetup, RAY_UNIFORMS};
use crate::meshes::DrawnBody;
use crate::style_renderer::{StyleInput, StyleRenderer};
use crate::watch::Watch;
use programs::{PainterPrograms, SourcePrograms};
use strokes::InkStrokes;
use targets::{PainterTargets, SourceTargets, WIDE};

/// The passes of the source, in order.
const SOURCE_PASSES: [&str; 5] = ["silhouette", "blurred silhouette", "interior", "blurred interior", "mix"];

/// Texels in the ramp of tones.
const RAMP: u32 = 256;

/// Half the width of the line where a body ends, pixels at the scene's size.
const LINE_PX: f32 = 1.6;

/// How strong the wash is under strokes.
const WASH_UNDER_STROKES: f32 = 0.6;

pub(crate) struct SumiE {
    gpu: Gpu,
    fibres: Texture,
    screen: VertexArray,
    /// The programs of the source's rule. `painter` has those of our own rule. Each set is created when a frame first
    /// uses its rule.
    source: Option<SourcePrograms>,
    painter: Option<PainterPrograms>,
    source_targets: Option<SourceTargets>,
    painter_targets: Option<PainterTargets>,
    strokes: InkStrokes,
}

impl SumiE {
    pub(crate) fn new(gpu: &Gpu) -> Result<Self, GlError> {
        let side = paper::SIDE;
        Ok(Self {
            gpu: gpu.clone(),
            fibres: Texture::with_driver_levels(gpu, Format::Rgba8, [side, side], &paper::tile())?,
            screen: VertexArray::empty(gpu)?,
            source: None,
            painter: None,
            source_targets: None,
            painter_targets: None,
            strokes: InkStrokes::new(gpu)?,
        })
    }

    fn draw_source(
        &mut self,
        input: &StyleInput<'_>,
        settings: &Settings,
        output: &mut Output<'_>,
        watch: &mut Watch<'_>,
    ) -> Result<(), Halt> {
        let frame = input.frame;
        let programs = match &mut self.source {
            Some(programs) => programs,
            none => none.insert(SourcePrograms::new(&self.gpu)?),
        };
        let same_size = self.source_targets.take().filter(|targets| targets.size_px() == frame.size_px);
        let targets = self.source_targets.insert(match same_size {
            Some(targets) => targets,
            None => SourceTargets::new(&self.gpu, frame.size_px)?,
        });
        programs.silhouette.prepare(frame)?;
        programs.interior.prepare(frame)?;
        let gpu = &self.gpu;
        let tones = ramp(gpu, settings)?;
        // The light moves with the eye, so that the highlight keeps its place in the picture.
        let to_light = Vec3::from(settings.to_light.map(|axis| axis as f32));
        let range = silhouette_range(settings);
        draw_bodies(gpu, input, &programs.silhouette, &targets.silhouette_pass, |bound| {
            bound.set("silhouette", range)
        })?;
        watch.passed(SOURCE_PASSES[0])?;
        gpu.begin_pass(&targets.blurred_silhouette_pass, DrawState::default());
        let bound = programs.low_pass.bind().texture("picture", &targets.silhouette);
        gpu.draw(bound, &self.screen, Vertices::Screen)?;
        watch.passed(SOURCE_PASSES[1])?;
        draw_bodies(gpu, input, &programs.interior, &targets.interior_pass, |bound| {
            bound.set("to_light", to_light.normalize_or(Vec3::Z)).texture("tones", &tones)
        })?;
        watch.passed(SOURCE_PASSES[2])?;
        gpu.begin_pass(&targets.blurred_interior_pass, DrawState::default());
        let bound = programs.low_pass.bind().texture("picture", &targets.interior);
        gpu.draw(bound, &self.screen, Vertices::Screen)?;
        watch.passed(SOURCE_PASSES[3])?;
        gpu.begin_pass(output.pass()?, DrawState::default());
        let bound = paper(programs.mix.bind(), frame, settings)
            .texture("fibres", &self.fibres)
            .texture("interior", &targets.blurred_interior)
            .texture("silhouette", &targets.blurred_silhouette)
            .set("background", frame.background_premultiplied());
        gpu.draw(bound, &self.screen, Vertices::Screen)?;
        watch.passed(SOURCE_PASSES[4])
    }

    /// Our own rule.
    fn draw_painter(
        &mut self,
        input: &StyleInput<'_>,
        settings: &Settings,
        output: &mut Output<'_>,
        watch: &mut Watch<'_>,
    ) -> Result<(), Halt> {
        let frame = input.frame;
        let programs = match &mut self.painter {
            Some(programs) => programs,
            none => none.insert(PainterPrograms::new(&self.gpu)?),
        };
        let same_size = self.painter_targets.take().filter(|targets| targets.size_px() == frame.size_px);
        let targets = self.painter_targets.insert(match same_size {
            Some(targets) => targets,
            None => PainterTargets::new(&self.gpu, frame.size_px)?,
        });
        let gpu = &self.gpu;
        let tones = ramp(gpu, settings)?;
        let inked = inked(gpu, frame)?;
        let lens = LensSetup::new(&frame.view, frame.size_px);
        let [lightness, a, b] = impasto_core::color::oklab_from_linear(
            settings.seal.0.map(impasto_core::color::linear_from_srgb),
        );
        gpu.begin_pass(&targets.wash_pass, DrawState::default());
        let bound = lens
            .set(programs.wash.bind(), &RAY_UNIFORMS)
            .texture("tones", &tones)
            .texture("inked", &inked)
            .texture("normal", &input.reference.normal)
            .texture("depth_and_id", &input.reference.depth_and_id)
            .texture("albedo_and_lit", &input.reference.unlit()?.albedo)
            .set("to_light", to_light(frame, settings))
            .set("silhouette", silhouette_range(settings))
            .set("own_tone", settings.own_tone as f32)
            .set("seal", Vec4::new(lightness, a, b, settings.accent as f32))
            .set("line_px", (LINE_PX * frame.px_scale).max(0.8));
        gpu.draw(bound, &self.screen, Vertices::Screen)?;
        watch.passed("wash")?;

        let size_px = glam::UVec2::from(frame.size_px).as_vec2();
        let wide_px = glam::UVec2::from(targets.wide_passes[0].size_px()).as_vec2();
        let near = settings.blur_px as f32 * frame.px_scale;
        let far = settings.bleed_px as f32 * frame.px_scale / WIDE as f32;
        let [wash, between, soft] = [&targets.wash, &targets.between, &targets.soft];
        let runs = [
            (wash, &targets.between_pass, Vec2::X / size_px, near),
            (between, &targets.soft_pass, Vec2::Y / size_px, near),
            (soft, &targets.wide_passes[0], Vec2::X / wide_px, far),
            (&targets.wide[0], &targets.wide_passes[1], Vec2::Y / wide_px, far),
        ];
        for (from, to, axis, deviation) in runs {
            gpu.begin_pass(to, DrawState::default());
            // A blur that would reach farther than the shader's 24 taps has its taps farther apart.
            let apart = (deviation * 2.6 / 24.0).max(1.0);
            let bound = programs
                .soften
                .bind()
                .texture("picture", from)
                .set("axis", axis * apart)
                .set("deviation", (deviation / apart).max(0.05))
                .set("target_px", glam::UVec2::from(to.size_px()).as_vec2());
            gpu.draw(bound, &self.screen, Vertices::Screen)?;
        }
        watch.passed("soften")?;

        self.strokes.draw(input, settings, programs, targets, &inked, watch)?;

        gpu.begin_pass(output.pass()?, DrawState::default());
        let [of_wash, of_strokes] = match settings.drawing {
            InkDrawing::Both => [WASH_UNDER_STROKES, 1.0],
            InkDrawing::Wash => [1.0, 0.0],
            InkDrawing::Strokes => [0.0, 1.0],
        };
        let [density, silhouette] = [settings.density, settings.silhouette].map(|value| value as f32);
        let [bleed, dryness] = [settings.bleed, settings.dryness].map(|value| value as f32);
        let bound = paper(programs.lay.bind(), frame, settings)
            .texture("fibres", &self.fibres)
            .texture("soft", &targets.soft)
            .texture("wide", &targets.wide[1])
            .texture("strokes", &targets.strokes)
            .set("background", frame.background_premultiplied())
            .set("ink", Vec3::from(settings.ink.0))
            .set("seal", Vec3::from(settings.seal.0))
            .set("amounts", Vec4::new(of_wash, of_strokes, density, silhouette))
            .set(
                "wetness",
                Vec4::new(bleed, settings.bleed_px as f32 * frame.px_scale, dryness, frame.px_scale),
            )
            .set("size_px", size_px);
        gpu.draw(bound, &self.screen, Vertices::Screen)?;
        watch.passed("lay")
    }
}

impl StyleRenderer for SumiE {
    fn ready_all(&mut self) -> Result<(), GlError> {
        let mut source = SourcePrograms::new(&self.gpu)?;
        source.silhouette.ready_all()?;
        source.interior.ready_all()?;
        self.source = Some(source);
        self.painter = Some(PainterPrograms::new(&self.gpu)?);
        Ok(())
    }

    fn draw(
        &mut self,
        input: &StyleInput<'_>,
        output: &mut Output<'_>,
        watch: &mut Watch<'_>,
    ) -> Result<(), Halt> {
        let Style::SumiE(settings) = &input.frame.style else { return Ok(()) };
        let drawn = match settings.rule {
            InkRule::Source => self.draw_source(input, settings, output, watch),
            InkRule::Painter => self.draw_painter(input, settings, output, watch),
        };
        if input.keeps.lets_go() {
            (self.source_targets, self.painter_targets) = (None, None);
        }
        drawn
    }

    fn reads_unlit(&self) -> bool {
        true
    }

    fn read_resolved(&self) -> Vec<[f32; 8]> {
        self.strokes.read_resolved()
    }
}

/// Clears a target to white and draws into it all bodies but hidden ones and backdrops; `set_own` sets the program's
/// own uniforms.
fn draw_bodies(
    gpu: &Gpu,
    input: &StyleInput<'_>,
    program: &BodyProgram,
    pass: &Framebuffer,
    set_own: impl Fn(Bound<'_>) -> Bound<'_>,
) -> Result<(), GlError> {
    gpu.begin_pass(pass, DrawState { depth_test: true, clear: Some([1.0; 4]), ..DrawState::default() });
    let view = &input.frame.view;
    for DrawnBody { body, mesh, array } in input.bodies {
        if !body.shows() || body.is_backdrop {
            continue;
        }
        for part in &mesh.parts {
            let bound = program
                .bind(body, part)
                .set("view_from_world", view.view_from_world)
                .set("clip_from_view", view.clip_from_view);
            gpu.draw(set_own(bound), array, part.vertices())?;
        }
    }
    Ok(())
}

/// Towards the light, world space, unit.
fn to_light(frame: &Frame, settings: &Settings) -> Vec3 {
    let stated = Vec3::from(settings.to_light.map(|axis| axis as f32));
    let light = match (settings.light, frame.lights.suns.first()) {
        (InkLight::Scene, Some(sun)) => sun.to_light,
        (InkLight::Scene, None) => stated,
        (InkLight::Eye, _) => Mat3::from_mat4(frame.view.view_from_world).transpose() * stated,
    };
    light.normalize_or(Vec3::Y)
}

/// The cosines between which the silhouette fades; never equal.
fn silhouette_range(settings: &Settings) -> Vec2 {
    let from = settings.silhouette_from as f32;
    Vec2::new(from, (settings.silhouette_to as f32).max(from + 1e-4))
}

/// A texture with a texel for each body, row by row, that says whether it gets ink: a backdrop gets none.
fn inked(gpu: &Gpu, frame: &Frame) -> Result<Texture, GlError> {
    const ROW: usize = 1024;
    let rows = frame.bodies.len().div_ceil(ROW).max(1);
    let mut texels: Vec<u8> =
        frame.bodies.iter().flat_map(|body| [if body.is_backdrop { 0 } else { 255 }; 4]).collect();
    texels.resize(rows * ROW * 4, 255);
    Texture::from_texels(gpu, Format::Rgba8, [ROW as u32, rows as u32], &texels)
}

/// Sets the uniforms of `sumi_e/paper.glsl`.
fn paper<'a>(bound: Bound<'a>, frame: &Frame, settings: &Settings) -> Bound<'a> {
    // From pixels of the picture to pixels at the scene's size, counted from the middle, then to tiles of the paper.
    let scale = 1.0 / frame.px_scale;
    let tiles = 1.0 / paper::SIDE as f32;
    let half_px = glam::UVec2::from(frame.size_px).as_vec2() * 0.5;
    let to_paper = frame.finish.canvas_from_px;
    let origin: Vec2 = to_paper.transform_point2(-half_px * scale) * tiles;
    let axes = Vec4::from((to_paper.matrix2.x_axis, to_paper.matrix2.y_axis)) * (scale * tiles);
    bound
        .set("paper", Vec3::from(settings.paper.0))
        .set("fibre_strength", settings.fibres as f32)
        .set("paper_axes", axes)
        .set("paper_origin", origin)
}

/// The ramp of tones as a texture: steps at every quarter, each as soft as stated.
fn ramp(gpu: &Gpu, settings: &Settings) -> Result<Texture, GlError> {
    let softness = settings.softness as f32;
    let tones = settings.tones.map(|tone| tone as f32);
    let tone = |light: f32| {
        let step = |index: usize| {
            let from = 0.25 * (index + 1) as f32 - softness;
            let t = ((light - from) / (2.0 * softness).max(1e-6)).clamp(0.0, 1.0);
            (tones[index + 1] - tones[index]) * t * t * (3.0 - 2.0 * t)
        };
        tones[0] + (0..3).map(step).sum::<f32>()
    };
    let texels: Vec<u8> = (0..RAMP)
        .flat_map(|index| {
            let byte = (tone((index as f32 + 0.5) / RAMP as f32).clamp(0.0, 1.0) * 255.0).round() as u8;
            [byte, byte, byte, 255]
        })
        .collect();
    Texture::from_texels(gpu, Format::Rgba8, [RAMP, 1], &texels)
}
