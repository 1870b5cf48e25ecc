//! Strokes of ink: what each carries, then a billboard each, one layer after the other.

use glam::Vec3;
use impasto_core::{brush, color};
use impasto_painting::Frame;
use impasto_painting::frame::{LayerRun, SumiE as Settings};

use super::programs::PainterPrograms;
use super::targets::PainterTargets;
use crate::gl::{
    Blend, Buffer, BufferUse, DrawState, Format, GlError, Gpu, Halt, Records, Texture, VertexArray, Vertices,
};
use crate::marks::{Marks, RESOLVED_BYTES, resolved_inputs, shape_input, stroke_inputs};
use crate::reference::{LENS_UNIFORMS, LensSetup};
use crate::styles::StyleInput;
use crate::watch::Watch;

/// The most strokes that are laid between two questions whether to stop.
const PIECE: u32 = 4096;

/// Pigments in a row of palettes.
const PALETTE: usize = 16;

/// The strokes of a frame on the GPU.
pub(super) struct InkStrokes {
    gpu: Gpu,
    marks: Option<Marks>,
    strokes: Buffer,
    resolved: Buffer,
    count: usize,
    points: VertexArray,
    quads: VertexArray,
}

impl InkStrokes {
    pub(super) fn new(gpu: &Gpu) -> Result<Self, GlError> {
        Ok(Self {
            gpu: gpu.clone(),
            marks: None,
            strokes: Buffer::new(gpu, BufferUse::Streamed)?,
            resolved: Buffer::new(gpu, BufferUse::ReadBack)?,
            count: 0,
            points: VertexArray::empty(gpu)?,
            quads: VertexArray::empty(gpu)?,
        })
    }

    /// Lays all strokes of the frame; none leave the target empty.
    pub(super) fn draw(
        &mut self,
        input: &StyleInput<'_>,
        (settings, programs): (&Settings, &PainterPrograms),
        targets: &PainterTargets,
        watch: &mut Watch<'_>,
    ) -> Result<(), Halt> {
        let frame = input.frame;
        self.count = frame.strokes.len();
        let clear = DrawState { clear: Some([0.0; 4]), ..DrawState::default() };
        self.gpu.begin_pass(&targets.strokes_pass, clear);
        if self.count == 0 {
            return Ok(());
        }
        self.marks = Some(Marks::of(&self.gpu, self.marks.take(), &frame.brushes)?);
        self.resolve(input, (settings, programs), targets)?;
        watch.passed("resolve")?;
        for &layer in frame.layers.iter().filter(|layer| layer.count > 0) {
            let most = if watch.may_stop() { PIECE } else { u32::MAX };
            let mut first = layer.first;
            while first < layer.first + layer.count {
                let count = most.min(layer.first + layer.count - first);
                self.paint(input, (settings, programs), targets, LayerRun { first, count, ..layer })?;
                watch.passed("ink strokes")?;
                first += count;
            }
        }
        Ok(())
    }

    fn resolve(
        &mut self,
        input: &StyleInput<'_>,
        (settings, programs): (&Settings, &PainterPrograms),
        targets: &PainterTargets,
    ) -> Result<(), GlError> {
        let frame = input.frame;
        self.strokes.upload(bytemuck::cast_slice(&frame.strokes))?;
        self.resolved.reserve((self.count * RESOLVED_BYTES).max(RESOLVED_BYTES))?;
        self.points.set(&stroke_inputs(&self.strokes, 0, false), None);
        let pigments = pigments(&self.gpu, frame)?;
        let shares = super::shares(&self.gpu, frame)?;
        let lens = LensSetup::new(&frame.view, frame.size_px);
        for layer in &frame.layers {
            let bound = lens
                .set(programs.resolve.bind(), &LENS_UNIFORMS[1..])
                .texture("depth_and_id", &input.reference.depth_and_id)
                .texture("shares", &shares)
                .texture("soft", &targets.soft)
                .texture("pigments", &pigments)
                .set("view_from_world", frame.view.view_from_world)
                .set("ink", Vec3::from(settings.ink.0))
                .set("seal", Vec3::from(settings.seal.0))
                .set("kind", layer.kind as i32);
            let records =
                Records { first: layer.first, count: layer.count, record_bytes: RESOLVED_BYTES as u32 };
            self.gpu.capture(bound, &self.points, &self.resolved, records)?;
        }
        Ok(())
    }

    fn paint(
        &self,
        input: &StyleInput<'_>,
        (settings, programs): (&Settings, &PainterPrograms),
        targets: &PainterTargets,
        run: LayerRun,
    ) -> Result<(), GlError> {
        let Some(marks) = &self.marks else { return Ok(()) };
        let frame = input.frame;
        let first = run.first as i32;
        let mut inputs = stroke_inputs(&self.strokes, first, true);
        inputs.push(shape_input(&inputs[0], first));
        inputs.extend(resolved_inputs(&self.resolved, first));
        self.quads.set(&inputs, None);
        let state = DrawState { blend: Blend::Largest, ..DrawState::default() };
        self.gpu.begin_pass(&targets.strokes_pass, state);
        let lens = LensSetup::new(&frame.view, frame.size_px);
        let bound = lens
            .set(programs.paint.bind(), &["size_px", "orthographic"])
            .set("units_per_px_at_1", 1.0 / lens.px_per_unit_at_1)
            .set("mark_rows", brush::SIZE[1] as f32)
            .set("dryness", settings.dryness as f32)
            .texture("brush_marks", &marks.texture)
            .texture("depth_and_id", &input.reference.depth_and_id);
        self.gpu.draw(bound, &self.quads, Vertices::Quads { instances: run.count })
    }

    /// Linear colour and alpha of every stroke of the last frame, then its place and how dark it is, eight floats each.
    pub(super) fn read_resolved(&self) -> Vec<[f32; 8]> {
        let mut resolved: Vec<[f32; 8]> =
            bytemuck::pod_collect_to_vec(&self.resolved.read(self.count * RESOLVED_BYTES));
        for stroke in &mut resolved {
            for channel in 0..3 {
                let pigment = stroke[channel];
                stroke[channel] = color::linear_from_srgb(1.0 - (1.0 - pigment) * stroke[6]);
            }
        }
        resolved
    }
}

/// Palettes as a texture, a row each, display values; one empty row where there are none.
fn pigments(gpu: &Gpu, frame: &Frame) -> Result<Texture, GlError> {
    let mut texels: Vec<[f32; 4]> = Vec::new();
    for palette in frame.palettes.iter() {
        texels.extend(palette.iter().take(PALETTE).map(|linear| {
            let [r, g, b] = linear.map(color::srgb_from_linear);
            [r, g, b, 1.0]
        }));
        texels.resize(texels.len().next_multiple_of(PALETTE), [0.0; 4]);
    }
    texels.resize(texels.len().max(PALETTE), [0.0; 4]);
    let size_px = [PALETTE as u32, (texels.len() / PALETTE) as u32];
    Texture::from_texels(gpu, Format::Rgba32F, size_px, bytemuck::cast_slice(&texels))
}
