//! Brush strokes that turn with what they lie on.
//!
//! Targets: `surface` (depth and body of each pixel, and how much of the pixel shows something else), `detail` (where
//! small strokes are wanted), `paint` (premultiplied, linear), `height` (of the paint), `below` (the picture before a
//! layer), `soft height`. Passes: coverage (from the samples of the reference pass), detail, spread (twice), resolve
//! (finds colour, presence and place of each stroke), paint (a billboard per stroke, one layer after the other),
//! soften, finish.

mod canvas;
mod coverage;
mod data;
mod programs;
mod targets;

use glam::{Vec2, Vec4};
use impasto_core::brush;
use impasto_core::color::oklab_from_linear;
use impasto_painting::Quality;
use impasto_painting::frame::{LayerKind, LayerRun, LineStrip, Stroke};

use crate::drawn::PaintSurface;
use crate::encode::Output;
use crate::fragments::PaintedLayer;
use crate::gl::{
    Blend, Bound, DrawState, Format, Framebuffer, GlError, Gpu, Halt, Program, Texture, VertexArray, Vertices,
};
use crate::lens::{LENS_UNIFORMS, LensSetup, RAY_UNIFORMS};
use crate::marks::Marks;
use crate::palettes::palette_texture;
use crate::stroke_buffers::StrokeBuffers;
use crate::style_renderer::{StyleInput, StyleRenderer};
use crate::watch::Watch;
use coverage::{Coverage, Covered};
use data::PaintData;
use programs::{DETAIL, FILES, LAYERS, SOFTEN, SPREAD, StrokePrograms};
use targets::{DetailTargets, PaintTargets};

/// How far the toned ground under the paint of a body hides the background.
const WASH: f32 = 0.85;

/// Side of the blocks in which detail is looked for, pixels at the scene's size.
const BLOCK_PX: f32 = 4.0;

/// How far detail is spread over its body: standard deviation of a Gaussian, pixels at the scene's size.
const SPREAD_PX: f32 = 16.0;

/// Each time that strokes covering this many pixels have been drawn, the caller is asked whether to stop.
const PIECE_PX: f32 = 400_000.0;

pub(crate) struct RotatingStrokes {
    gpu: Gpu,
    coverage: Coverage,
    detail: Program,
    spread: Program,
    soften: Program,
    exact: StrokePrograms,
    /// Created when the first draft is drawn.
    draft: Option<StrokePrograms>,
    canvas: Texture,
    strokes: StrokeBuffers,
    screen: VertexArray,
    detail_targets: Option<DetailTargets>,
    targets: Option<PaintTargets>,
    /// Created when layers and surface of the paint are first wanted.
    data: Option<PaintData>,
}

impl RotatingStrokes {
    pub(crate) fn new(gpu: &Gpu) -> Result<Self, GlError> {
        let side = canvas::SIDE;
        Ok(Self {
            gpu: gpu.clone(),
            coverage: Coverage::new(gpu)?,
            detail: Program::new(gpu, FILES, &DETAIL)?,
            spread: Program::new(gpu, FILES, &SPREAD)?,
            soften: Program::new(gpu, FILES, &SOFTEN)?,
            exact: StrokePrograms::new(gpu, Quality::Exact)?,
            draft: None,
            canvas: Texture::with_driver_levels(gpu, Format::Rgba8, [side, side], &canvas::tile())?,
            strokes: StrokeBuffers::new(gpu)?,
            screen: VertexArray::empty(gpu)?,
            detail_targets: None,
            targets: None,
            data: None,
        })
    }

    /// The programs of a quality. Creates those of drafts when they are first asked for.
    fn ready(&mut self, quality: Quality) -> Result<&mut StrokePrograms, GlError> {
        Ok(match (quality, &mut self.draft) {
            (Quality::Exact, _) => &mut self.exact,
            (Quality::Draft, Some(draft)) => draft,
            (Quality::Draft, none) => none.insert(StrokePrograms::new(&self.gpu, quality)?),
        })
    }

    fn programs(&self, quality: Quality) -> &StrokePrograms {
        match quality {
            Quality::Exact => &self.exact,
            Quality::Draft => self.draft.as_ref().unwrap_or(&self.exact),
        }
    }

    /// Finds where small strokes are wanted. The result is in the first of the two targets.
    fn find_detail(
        &self,
        input: &StyleInput<'_>,
        covered: &Covered,
        watch: &mut Watch<'_>,
    ) -> Result<(), Halt> {
        let Some(targets) = &self.detail_targets else { return Ok(()) };
        self.gpu.begin_pass(&targets.passes[0], DrawState::default());
        let bound = covered
            .set_samples(self.detail.bind())
            .texture("reference_color", &input.reference.color)
            .texture("depth_and_id", &input.reference.depth_and_id)
            .texture("glint", &input.reference.glint)
            .texture("normal", &input.reference.normal)
            .set("view_from_world", input.frame.view.view_from_world)
            .set("px_scale", input.frame.px_scale)
            .set("block_px", targets.block_px as i32);
        self.gpu.draw(bound, &self.screen, Vertices::Screen)?;
        // The blur's taps are half a standard deviation apart.
        let step = (0.5 * SPREAD_PX * input.frame.px_scale / targets.block_px as f32).max(1.0);
        for (from, to, axis) in [(0, 1, Vec2::X), (1, 0, Vec2::Y)] {
            self.gpu.begin_pass(&targets.passes[to], DrawState::default());
            let bound = self.spread.bind().texture("detail", &targets.detail[from]).set("axis", axis * step);
            self.gpu.draw(bound, &self.screen, Vertices::Screen)?;
        }
        watch.passed("detail")
    }

    fn resolve(&mut self, input: &StyleInput<'_>) -> Result<(), GlError> {
        let Some(targets) = &self.detail_targets else { return Ok(()) };
        let frame = input.frame;
        self.strokes.upload(frame)?;
        let palettes = palette_texture(&self.gpu, frame, oklab_from_linear)?;
        let lens = LensSetup::new(&frame.view, frame.size_px);
        for layer in frame.layers.iter().filter(|layer| layer.count > 0) {
            let programs = self.programs(frame.quality);
            let Some(program) = programs.resolve(layer.kind, !frame.palettes.is_empty()) else { continue };
            let bound = input
                .lights
                .set(lens.set(program.bind(), &LENS_UNIFORMS))
                .texture("reference_color", &input.reference.color)
                .texture("highlight", &input.reference.highlight)
                .texture("depth_and_id", &input.reference.depth_and_id)
                .texture("normal", &input.reference.normal)
                .texture("detail", &targets.detail[0])
                .set("block_px", targets.block_px as f32)
                .texture("palettes", &palettes)
                .set("view_from_world", frame.view.view_from_world)
                .set("px_scale", frame.px_scale);
            self.strokes.resolve(bound, *layer)?;
        }
        Ok(())
    }

    /// Copies the picture, if strokes of this layer will pick up wet paint from it. To be called before the layer is
    /// laid.
    fn copy_below(&self, input: &StyleInput<'_>, layer: LayerRun) {
        let Some(targets) = &self.targets else { return };
        let picks_up = strokes_of(input, layer).iter().any(|stroke| stroke.paint.pickup > 0);
        if input.frame.quality == Quality::Exact && picks_up {
            targets.paint_pass.copy_to(&targets.below_pass);
            self.gpu.lap("below");
        }
    }

    /// Lays a layer of paint; in several pieces if the caller may stop or the paint is gathered.
    fn paint(
        &mut self,
        input: &StyleInput<'_>,
        covered: &Covered,
        layer: LayerRun,
        watch: &mut Watch<'_>,
    ) -> Result<(), Halt> {
        if layer.kind == LayerKind::Touches {
            return self.paint_lines(input, covered, layer, watch);
        }
        let strokes = strokes_of(input, layer);
        let shaped = strokes.iter().any(Stroke::is_shaped);
        let mut first = layer.first;
        let most_px = if watch.may_stop() { PIECE_PX } else { f32::INFINITY };
        let most_px = self.data_of(input).map_or(most_px, |data| most_px.min(data.piece_px()));
        for count in pieces(strokes, most_px) {
            self.paint_piece(input, covered, LayerRun { first, count, ..layer }, shaped)?;
            watch.passed(layer.kind.name())?;
            first += count;
        }
        if let Some(data) = self.data.as_mut().filter(|_| input.gathers) {
            data.end_layer(layer, input.frame.size_px);
        }
        Ok(())
    }

    /// Where the paint's layers are gathered, if they are wanted.
    fn data_of(&self, input: &StyleInput<'_>) -> Option<&PaintData> {
        self.data.as_ref().filter(|_| input.gathers)
    }

    fn paint_piece(
        &mut self,
        input: &StyleInput<'_>,
        covered: &Covered,
        layer: LayerRun,
        has_shape: bool,
    ) -> Result<(), GlError> {
        let (Some(targets), Some(marks)) = (&self.targets, self.strokes.marks()) else { return Ok(()) };
        let frame = input.frame;
        let programs = self.programs(frame.quality);
        let data = self.data_of(input);
        // Layers without tapered or bent strokes use the cheaper program.
        let (program, with_shape) = match (data, &programs.shaped_paint) {
            (Some(data), _) => (data.paint(has_shape), has_shape),
            (None, Some(shaped)) if has_shape => (shaped, true),
            _ => (&programs.paint, false),
        };
        let pass = targets.strokes_pass(frame.quality);
        self.gpu.begin_pass(pass, DrawState { blend: Blend::Over, ..DrawState::default() });
        let mut bound = paint_inputs(program, (input, covered), (targets, marks))
            .set("view_from_world", frame.view.view_from_world)
            .set("kind", layer.kind as i32);
        bound = LensSetup::new(&frame.view, frame.size_px).set(bound, &["gaze_px", "px_per_unit_at_1"]);
        if let Some(data) = data {
            bound = bound.set("first_stroke", layer.first as i32);
            data.begin_noting();
        }
        self.strokes.draw(bound, layer, with_shape)?;
        self.data.as_mut().filter(|_| input.gathers).map_or(Ok(()), PaintData::end_noting)
    }

    /// Lays all lines of the frame, one after the other. A frame has at most one layer of lines.
    fn paint_lines(
        &mut self,
        input: &StyleInput<'_>,
        covered: &Covered,
        layer: LayerRun,
        watch: &mut Watch<'_>,
    ) -> Result<(), Halt> {
        for &strip in &input.frame.lines.strips {
            self.paint_line(input, covered, strip)?;
            watch.passed(layer.kind.name())?;
        }
        if let Some(data) = self.data.as_mut().filter(|_| input.gathers) {
            data.end_layer(layer, input.frame.size_px);
        }
        Ok(())
    }

    fn paint_line(
        &mut self,
        input: &StyleInput<'_>,
        covered: &Covered,
        strip: LineStrip,
    ) -> Result<(), GlError> {
        let (Some(targets), Some(marks)) = (&self.targets, self.strokes.marks()) else { return Ok(()) };
        let quality = input.frame.quality;
        let data = self.data_of(input);
        let program = data.map(PaintData::line_paint).or(self.programs(quality).line_paint.as_ref());
        let Some(program) = program else { return Ok(()) };
        let pass = targets.strokes_pass(quality);
        self.gpu.begin_pass(pass, DrawState { blend: Blend::Over, ..DrawState::default() });
        let mut bound = paint_inputs(program, (input, covered), (targets, marks));
        if let Some(data) = data {
            bound = bound.set("first_stroke", strip.stroke as i32);
            data.begin_noting();
        }
        self.strokes.draw_strip(bound, strip)?;
        self.data.as_mut().filter(|_| input.gathers).map_or(Ok(()), PaintData::end_noting)
    }

    fn finish(
        &self,
        input: &StyleInput<'_>,
        covered: &Covered,
        output: &Framebuffer,
        watch: &mut Watch<'_>,
    ) -> Result<(), Halt> {
        let Some(targets) = &self.targets else { return Ok(()) };
        let frame = input.frame;
        if frame.quality == Quality::Exact {
            self.gpu.begin_pass(&targets.soften_pass, DrawState::default());
            let bound =
                self.soften.bind().texture("height", &targets.height).set("step_px", frame.px_scale.max(0.5));
            self.gpu.draw(bound, &self.screen, Vertices::Screen)?;
            watch.passed("soften")?;
        }

        self.gpu.begin_pass(output, DrawState::default());
        let bound = self.bind_finish(self.programs(frame.quality).finish.bind(), input, covered);
        self.gpu.draw(bound, &self.screen, Vertices::Screen)?;
        watch.passed("finish")
    }

    /// Sets the uniforms of `finish.frag`.
    fn bind_finish<'a>(&self, bound: Bound<'a>, input: &StyleInput<'_>, covered: &Covered) -> Bound<'a> {
        let Some(targets) = &self.targets else { return bound };
        let frame = input.frame;
        let finish = &frame.finish;
        let (tone, wash) = match finish.ground {
            Some(ground) => (Vec4::from((glam::Vec3::from(ground.color), ground.hides)), WASH),
            None => (Vec4::ZERO, 0.0),
        };
        // From pixels of the picture to pixels at the scene's size, counted from the middle, then to tiles of the
        // canvas.
        let scale = 1.0 / frame.px_scale;
        let tiles = 1.0 / canvas::SIDE as f32;
        let half_px = glam::UVec2::from(frame.size_px).as_vec2() * 0.5;
        let axes = finish.canvas_from_px.matrix2;
        let origin: Vec2 = finish.canvas_from_px.transform_point2(-half_px * scale) * tiles;
        let axes = Vec4::from((axes.x_axis, axes.y_axis)) * (scale * tiles);
        let bound = bound
            .texture("picture", &targets.paint)
            .texture("reference_color", &input.reference.color)
            .set("background", frame.background_premultiplied())
            .set("wash", wash)
            .set("finish", Vec4::new(finish.relief, finish.weave, finish.varnish, frame.px_scale));
        if frame.quality == Quality::Draft {
            return bound;
        }
        let lens = LensSetup::new(&frame.view, frame.size_px);
        covered
            .set_surface(lens.set(bound, &RAY_UNIFORMS))
            .texture("normal", &input.reference.normal)
            .set("tone", tone)
            .texture("height", &targets.height)
            .texture("soft_height", &targets.soft_height)
            .texture("canvas", &self.canvas)
            .set("to_light", glam::Vec3::from(finish.to_relief_light))
            .set("canvas_axes", axes)
            .set("canvas_origin", origin)
    }

    /// Draws the surface of the paint, where it is wanted.
    fn draw_surface(&mut self, input: &StyleInput<'_>, covered: &Covered) -> Result<(), GlError> {
        let Some(mut data) = self.data.take() else { return Ok(()) };
        let drawn = if input.gathers {
            data.draw_surface(input.frame.size_px, &self.screen, |program| {
                self.bind_finish(program.bind(), input, covered)
            })
        } else {
            Ok(())
        };
        self.data = Some(data);
        drawn
    }
}

impl StyleRenderer for RotatingStrokes {
    fn ready_all(&mut self) -> Result<(), GlError> {
        let gpu = self.gpu.clone();
        for quality in [Quality::Exact, Quality::Draft] {
            for (layer, has_palettes) in LAYERS.iter().flat_map(|&(layer, _)| [(layer, false), (layer, true)])
            {
                self.ready(quality)?.ready_resolve((&gpu, quality), layer, has_palettes)?;
            }
            self.ready(quality)?.ready_shaped(&gpu, quality)?;
            self.ready(quality)?.ready_line(&gpu, quality)?;
        }
        if self.data.is_none() && gpu.limits().has_storage {
            self.data = Some(PaintData::new(&gpu)?);
        }
        Ok(())
    }

    fn draw(
        &mut self,
        input: &StyleInput<'_>,
        output: &mut Output<'_>,
        watch: &mut Watch<'_>,
    ) -> Result<(), Halt> {
        let frame = input.frame;
        let coarser = if frame.quality == Quality::Draft { 3.0 } else { 1.0 };
        let block_px = (BLOCK_PX * coarser * frame.px_scale).round().clamp(1.0, 8.0) as u32;
        if !self.detail_targets.as_ref().is_some_and(|targets| targets.fit(frame.size_px, block_px)) {
            self.detail_targets = Some(DetailTargets::new(&self.gpu, frame.size_px, block_px)?);
        }
        let gpu = self.gpu.clone();
        let programs = self.ready(frame.quality)?;
        for layer in frame.layers.iter().filter(|layer| layer.count > 0) {
            programs.ready_resolve((&gpu, frame.quality), layer.kind, !frame.palettes.is_empty())?;
        }
        if frame.strokes.iter().any(Stroke::is_shaped) {
            programs.ready_shaped(&gpu, frame.quality)?;
        }
        if !frame.lines.strips.is_empty() {
            programs.ready_line(&gpu, frame.quality)?;
        }
        if input.gathers {
            let data = match self.data.take() {
                Some(data) => data,
                None => PaintData::new(&gpu)?,
            };
            self.data.insert(data).begin(frame)?;
        }
        self.strokes.upload_marks(frame)?;
        let mut covered = self.coverage.draw(input, watch)?;
        self.find_detail(input, &covered, watch)?;
        if input.keeps.lets_go() {
            self.gpu.finish();
            covered.let_samples_go();
        }
        self.resolve(input)?;
        watch.passed("resolve")?;
        let targets = match self.targets.take() {
            Some(targets) if targets.paint_pass.size_px() == frame.size_px => targets,
            _ => PaintTargets::new(&self.gpu, frame.size_px)?,
        };
        let targets = self.targets.insert(targets);
        let clear = DrawState { clear: Some([0.0; 4]), ..DrawState::default() };
        self.gpu.begin_pass(&targets.below_pass, clear);
        self.gpu.begin_pass(targets.strokes_pass(frame.quality), clear);
        for (index, &layer) in frame.layers.iter().filter(|layer| layer.count > 0).enumerate() {
            // There is nothing below the first layer.
            if index > 0 {
                self.copy_below(input, layer);
            }
            self.paint(input, &covered, layer, watch)?;
        }
        self.finish(input, &covered, output.pass()?, watch)?;
        self.draw_surface(input, &covered)?;
        if input.keeps.lets_go() {
            self.gpu.finish();
            (self.detail_targets, self.targets) = (None, None);
            self.coverage.let_go();
        }
        Ok(())
    }

    fn read_resolved(&self) -> Vec<[f32; 8]> {
        self.strokes.read_resolved()
    }

    fn take_layers(&mut self) -> Vec<PaintedLayer> {
        self.data.as_mut().map_or_else(Vec::new, PaintData::take_layers)
    }

    fn read_paint_surface(&self) -> Option<PaintSurface> {
        self.data.as_ref()?.read_surface()
    }

    fn read_paint(&self) -> Vec<[f32; 4]> {
        self.targets.as_ref().map_or_else(Vec::new, |targets| targets.paint_pass.read_colors(0))
    }
}

/// Sets what all programs that lay paint need.
fn paint_inputs<'a>(
    program: &'a Program,
    (input, covered): (&StyleInput<'_>, &Covered),
    (targets, marks): (&PaintTargets, &Marks),
) -> Bound<'a> {
    let frame = input.frame;
    let lens = LensSetup::new(&frame.view, frame.size_px);
    let mut bound = lens
        .set(program.bind(), &["size_px", "orthographic"])
        .set("units_per_px_at_1", 1.0 / lens.px_per_unit_at_1)
        .set("mark_rows", brush::SIZE[1] as f32)
        .texture("brush_marks", &marks.texture)
        .texture("mark_bounds", &marks.bounds);
    if frame.quality == Quality::Exact {
        bound = bound.texture("below", &targets.below).texture("depth_and_id", &input.reference.depth_and_id);
    }
    covered.set_surface(bound)
}

fn strokes_of<'a>(input: &'a StyleInput<'_>, layer: LayerRun) -> &'a [Stroke] {
    &input.frame.strokes[layer.first as usize..][..layer.count as usize]
}

/// Splits strokes into runs that cover `most_px` pixels at most (length times width; a larger stroke is a run of its
/// own). Returns how many strokes each run has.
fn pieces(strokes: &[Stroke], most_px: f32) -> Vec<u32> {
    let mut pieces = vec![0];
    let mut covered_px = 0.0;
    for stroke in strokes {
        let px = stroke.length_px * stroke.width_px;
        if covered_px + px > most_px && covered_px > 0.0 {
            pieces.push(0);
            covered_px = 0.0;
        }
        covered_px += px;
        if let Some(count) = pieces.last_mut() {
            *count += 1;
        }
    }
    pieces
}
