//! Draws strokes of ink: first finds the ink of every stroke, then draws a billboard for each, one layer after the
//! other.

use glam::Vec3;
use impasto_core::{brush, color};
use impasto_painting::frame::{LayerRun, SumiE as Settings};

use super::programs::PainterPrograms;
use super::targets::PainterTargets;
use crate::gl::{Blend, DrawState, GlError, Gpu, Halt, Texture};
use crate::lens::{LensSetup, VIEW_LENS_UNIFORMS};
use crate::palettes::palette_texture;
use crate::stroke_buffers::StrokeBuffers;
use crate::style_renderer::StyleInput;
use crate::watch::Watch;

/// Each time that this many strokes have been drawn, the caller is asked whether to stop.
const PIECE: u32 = 4096;

pub(super) struct InkStrokes {
    gpu: Gpu,
    buffers: StrokeBuffers,
}

impl InkStrokes {
    pub(super) fn new(gpu: &Gpu) -> Result<Self, GlError> {
        Ok(Self { gpu: gpu.clone(), buffers: StrokeBuffers::new(gpu)? })
    }

    /// Lays all strokes of the frame; without strokes the target stays empty. `inked` says which bodies
    /// get ink.
    pub(super) fn draw(
        &mut self,
        input: &StyleInput<'_>,
        settings: &Settings,
        programs: &PainterPrograms,
        targets: &PainterTargets,
        inked: &Texture,
        watch: &mut Watch<'_>,
    ) -> Result<(), Halt> {
        let frame = input.frame;
        let clear = DrawState { clear: Some([0.0; 4]), ..DrawState::default() };
        self.gpu.begin_pass(&targets.strokes_pass, clear);
        if frame.strokes.is_empty() {
            self.buffers.clear();
            return Ok(());
        }
        self.buffers.upload_marks(frame)?;
        self.buffers.upload(frame)?;
        self.resolve(input, settings, programs, targets, inked)?;
        watch.passed("resolve")?;
        for &layer in frame.layers.iter().filter(|layer| layer.count > 0) {
            let most = if watch.may_stop() { PIECE } else { u32::MAX };
            let mut first = layer.first;
            while first < layer.first + layer.count {
                let count = most.min(layer.first + layer.count - first);
                self.paint(input, settings, programs, targets, LayerRun { first, count, ..layer })?;
                watch.passed("ink strokes")?;
                first += count;
            }
        }
        Ok(())
    }

    fn resolve(
        &self,
        input: &StyleInput<'_>,
        settings: &Settings,
        programs: &PainterPrograms,
        targets: &PainterTargets,
        inked: &Texture,
    ) -> Result<(), GlError> {
        let frame = input.frame;
        let pigments = palette_texture(&self.gpu, frame, |linear| linear.map(color::srgb_from_linear))?;
        let lens = LensSetup::new(&frame.view, frame.size_px);
        for &layer in &frame.layers {
            let bound = lens
                .set(programs.resolve.bind(), &VIEW_LENS_UNIFORMS)
                .texture("depth_and_id", &input.reference.depth_and_id)
                .texture("inked", inked)
                .texture("soft", &targets.soft)
                .texture("pigments", &pigments)
                .set("view_from_world", frame.view.view_from_world)
                .set("ink", Vec3::from(settings.ink.0))
                .set("seal", Vec3::from(settings.seal.0))
                .set("kind", layer.kind as i32);
            self.buffers.resolve(bound, layer)?;
        }
        Ok(())
    }

    fn paint(
        &self,
        input: &StyleInput<'_>,
        settings: &Settings,
        programs: &PainterPrograms,
        targets: &PainterTargets,
        run: LayerRun,
    ) -> Result<(), GlError> {
        let Some(marks) = self.buffers.marks() else { return Ok(()) };
        let frame = input.frame;
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
        self.buffers.draw(bound, run, true)
    }

    /// For every stroke of the last frame, eight floats: linear colour, alpha, its centre in pixels, how dark it is,
    /// and one that is unused.
    pub(super) fn read_resolved(&self) -> Vec<[f32; 8]> {
        let mut resolved = self.buffers.read_resolved();
        for stroke in &mut resolved {
            for channel in 0..3 {
                let pigment = stroke[channel];
                stroke[channel] = color::linear_from_srgb(1.0 - (1.0 - pigment) * stroke[6]);
            }
        }
        resolved
    }
}
