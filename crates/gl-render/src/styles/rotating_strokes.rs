//! Brush strokes that turn with what they lie on.
//!
//! Targets: `paint` (premultiplied, linear). Passes: resolve (a colour and a presence per stroke), paint (a billboard
//! per stroke, one layer after the other), encode.

mod tip;

use std::rc::Rc;

use impasto_painting::Frame;
use impasto_painting::frame::{LayerRun, Stroke};

use super::{Style, StyleInput, ground};
use crate::gl::{
    Attribute, Blend, Buffer, BufferUse, DrawState, Filter, Format, Framebuffer, GlError, Gpu, Program,
    ProgramSource, Records, Texture, VertexArray, Vertices,
};
use crate::reference::{LENS_UNIFORMS, LensSetup, LightSetup};
use crate::shader_files::{REFERENCE, ROTATING_STROKES, SHARED};

/// Paint may run this far past its own body, pixels at the scene's size.
const OVERRUN_PX: f32 = 2.6;

/// How much of a body's own colour its toned ground carries.
const WASH: f32 = 0.85;

/// Bytes of what the resolve pass keeps of a stroke: colour and alpha.
const RESOLVED_BYTES: usize = 16;

/// The style.
pub(crate) struct RotatingStrokes {
    gpu: Gpu,
    resolve: Program,
    paint: Program,
    encode: Program,
    tips: Texture,
    strokes: Buffer,
    resolved: Buffer,
    stroke_count: usize,
    stroke_points: VertexArray,
    stroke_quads: VertexArray,
    screen: VertexArray,
    target: Option<Target>,
}

struct Target {
    paint: Rc<Texture>,
    pass: Framebuffer,
}

impl RotatingStrokes {
    pub(crate) fn new(gpu: &Gpu) -> Result<Self, GlError> {
        let files = &[SHARED, REFERENCE, ROTATING_STROKES];
        let resolve = ProgramSource {
            vertex: "rotating_strokes/resolve.vert",
            fragment: None,
            captured: &["resolved"],
            uniforms: &[
                LENS_UNIFORMS[0],
                LENS_UNIFORMS[1],
                LENS_UNIFORMS[2],
                LENS_UNIFORMS[3],
                LightSetup::UNIFORMS[0],
                LightSetup::UNIFORMS[1],
                LightSetup::UNIFORMS[2],
                LightSetup::UNIFORMS[3],
                LightSetup::UNIFORMS[4],
                LightSetup::UNIFORMS[5],
                LightSetup::UNIFORMS[6],
                LightSetup::UNIFORMS[7],
                "reference_color",
                "depth_and_id",
                "view_from_world",
                "underpainting",
            ],
        };
        let paint = ProgramSource {
            vertex: "rotating_strokes/paint.vert",
            fragment: Some("rotating_strokes/paint.frag"),
            captured: &[],
            uniforms: &[
                "size_px",
                "tip_rows",
                "tip_count",
                "underpainting",
                "tips",
                "depth_and_id",
                "overrun_px",
                "units_per_px_at_1",
                "orthographic",
            ],
        };
        let encode = ProgramSource {
            vertex: "shared/screen.vert",
            fragment: Some("rotating_strokes/encode.frag"),
            captured: &[],
            uniforms: &["picture", "reference_color", "ground", "wash"],
        };
        let size = [tip::SIZE[0], tip::SIZE[1], tip::COUNT];
        Ok(Self {
            gpu: gpu.clone(),
            resolve: Program::new(gpu, files, &resolve)?,
            paint: Program::new(gpu, files, &paint)?,
            encode: Program::new(gpu, files, &encode)?,
            tips: Texture::array_with_levels(gpu, Format::Rg8, size, &tip::levels())?,
            strokes: Buffer::new(gpu, BufferUse::Streamed)?,
            resolved: Buffer::new(gpu, BufferUse::ReadBack)?,
            stroke_count: 0,
            stroke_points: VertexArray::empty(gpu)?,
            stroke_quads: VertexArray::empty(gpu)?,
            screen: VertexArray::empty(gpu)?,
            target: None,
        })
    }

    fn resolve(&mut self, input: &StyleInput<'_>) -> Result<(), GlError> {
        let frame = input.frame;
        self.stroke_count = frame.strokes.len();
        self.strokes.upload(bytemuck::cast_slice(&frame.strokes))?;
        self.resolved.reserve((self.stroke_count * RESOLVED_BYTES).max(RESOLVED_BYTES))?;
        self.stroke_points.set(&stroke_inputs(&self.strokes, 0, false), None);
        let lens = LensSetup::new(&frame.view, frame.size_px);
        for layer in &frame.layers {
            let bound = input
                .lights
                .set(lens.set(self.resolve.bind(), &LENS_UNIFORMS))
                .texture("reference_color", &input.reference.color)
                .texture("depth_and_id", &input.reference.depth_and_id)
                .set("view_from_world", frame.view.view_from_world)
                .set("underpainting", f32::from(layer.underpainting));
            let records =
                Records { first: layer.first, count: layer.count, record_bytes: RESOLVED_BYTES as u32 };
            self.gpu.capture(bound, &self.stroke_points, &self.resolved, records)?;
        }
        Ok(())
    }

    fn paint(&self, input: &StyleInput<'_>, layer: LayerRun) -> Result<(), GlError> {
        let frame = input.frame;
        let first = layer.first as i32;
        let mut inputs = stroke_inputs(&self.strokes, first, true);
        inputs.push(Attribute {
            location: 4,
            buffer: &self.resolved,
            components: 4,
            integer: false,
            stride_bytes: RESOLVED_BYTES as i32,
            offset_bytes: first * RESOLVED_BYTES as i32,
            per_instance: true,
        });
        self.stroke_quads.set(&inputs, None);
        let lens = LensSetup::new(&frame.view, frame.size_px);
        let bound = lens
            .set(self.paint.bind(), &["size_px", "orthographic"])
            .set("units_per_px_at_1", 1.0 / lens.px_per_unit_at_1)
            .set("tip_rows", tip::SIZE[1] as f32)
            .set("tip_count", tip::COUNT as f32)
            .set("underpainting", f32::from(layer.underpainting))
            .texture("tips", &self.tips)
            .texture("depth_and_id", &input.reference.depth_and_id)
            .set("overrun_px", OVERRUN_PX * frame.px_scale);
        self.gpu.draw(bound, &self.stroke_quads, Vertices::Quads { instances: layer.count })
    }

    fn target(&mut self, frame: &Frame) -> Result<(), GlError> {
        if self.target.as_ref().is_none_or(|target| target.pass.size_px() != frame.size_px) {
            let paint = Rc::new(Texture::target(&self.gpu, Format::Rgba16F, frame.size_px, Filter::Nearest)?);
            let pass = Framebuffer::new(&self.gpu, &[&paint], None)?;
            self.target = Some(Target { paint, pass });
        }
        Ok(())
    }

    /// Colour and alpha of every stroke of the last frame, four floats each.
    pub(crate) fn read_resolved(&self) -> Vec<[f32; 4]> {
        bytemuck::pod_collect_to_vec(&self.resolved.read(self.stroke_count * RESOLVED_BYTES))
    }

    /// The paint of the last frame, premultiplied and linear, without ground; bottom row first.
    pub(crate) fn read_paint(&self) -> Vec<[f32; 4]> {
        let target = self.target.as_ref();
        target.map_or_else(Vec::new, |target| bytemuck::pod_collect_to_vec(&target.pass.read_floats(0)))
    }
}

impl Style for RotatingStrokes {
    fn draw(&mut self, input: &StyleInput<'_>, output: &Framebuffer) -> Result<(), GlError> {
        self.target(input.frame)?;
        self.resolve(input)?;
        let Some(target) = &self.target else { return Ok(()) };
        self.gpu.begin_pass(
            &target.pass,
            DrawState { blend: Blend::Over, clear: Some([0.0; 4]), ..DrawState::default() },
        );
        for &layer in input.frame.layers.iter().filter(|layer| layer.count > 0) {
            self.paint(input, layer)?;
        }
        self.gpu.begin_pass(output, DrawState::default());
        let toned = input.frame.layers.iter().any(|layer| layer.underpainting);
        let bound = self
            .encode
            .bind()
            .texture("picture", &target.paint)
            .texture("reference_color", &input.reference.color)
            .set("ground", ground(input.frame))
            .set("wash", if toned { WASH } else { 0.0 });
        self.gpu.draw(bound, &self.screen, Vertices::Screen)
    }

    fn as_strokes(&self) -> Option<&RotatingStrokes> {
        Some(self)
    }
}

/// The fields of [`Stroke`] as shader inputs, from stroke `first` on.
fn stroke_inputs(buffer: &Buffer, first: i32, per_instance: bool) -> Vec<Attribute<'_>> {
    let stride = size_of::<Stroke>() as i32;
    let input = |location: u32, components: i32, offset: usize, integer: bool| Attribute {
        location,
        buffer,
        components,
        integer,
        stride_bytes: stride,
        offset_bytes: first * stride + offset as i32,
        per_instance,
    };
    vec![
        input(0, 4, std::mem::offset_of!(Stroke, center_px), false),
        input(1, 3, std::mem::offset_of!(Stroke, length_px), false),
        input(2, 3, std::mem::offset_of!(Stroke, bits), true),
        input(3, 3, std::mem::offset_of!(Stroke, normal_in_world), false),
    ]
}
