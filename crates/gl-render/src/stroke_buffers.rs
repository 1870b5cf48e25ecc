//! The strokes of a frame on the GPU, for any style: their records, their brush marks, and the results of the style's
//! resolve pass. That pass runs on the GPU before strokes are drawn; it finds the colour of each stroke, and its
//! presence (how much of it is there).

use std::mem::offset_of;

use impasto_painting::Frame;
use impasto_painting::frame::{LayerRun, LineStrip, LineVertex, Stroke};

use crate::gl::{Attribute, Bound, Buffer, BufferUse, GlError, Gpu, Records, VertexArray, Vertices};
use crate::marks::Marks;

/// Bytes that the resolve pass stores for a stroke, eight floats: colour and presence; centre in pixels, and two
/// numbers whose meaning depends on the style.
const RESOLVED_BYTES: usize = 32;

pub(crate) struct StrokeBuffers {
    gpu: Gpu,
    marks: Option<Marks>,
    strokes: Buffer,
    resolved: Buffer,
    lines: Buffer,
    count: usize,
    /// A point for each stroke.
    points: VertexArray,
    /// A billboard for each stroke, or the strip of a line: the inputs are set anew for each draw.
    quads: VertexArray,
}

impl StrokeBuffers {
    pub(crate) fn new(gpu: &Gpu) -> Result<Self, GlError> {
        Ok(Self {
            gpu: gpu.clone(),
            marks: None,
            strokes: Buffer::new(gpu, BufferUse::Streamed)?,
            resolved: Buffer::new(gpu, BufferUse::ReadBack)?,
            lines: Buffer::new(gpu, BufferUse::Streamed)?,
            count: 0,
            points: VertexArray::empty(gpu)?,
            quads: VertexArray::empty(gpu)?,
        })
    }

    /// Uploads the marks of a frame's brushes, unless they are there.
    pub(crate) fn upload_marks(&mut self, frame: &Frame) -> Result<(), GlError> {
        self.marks = Some(Marks::of(&self.gpu, self.marks.take(), &frame.brushes)?);
        Ok(())
    }

    /// Uploads a frame's strokes, and makes room for the results of the resolve pass.
    pub(crate) fn upload(&mut self, frame: &Frame) -> Result<(), GlError> {
        self.count = frame.strokes.len();
        self.strokes.upload(bytemuck::cast_slice(&frame.strokes))?;
        self.resolved.reserve((self.count * RESOLVED_BYTES).max(RESOLVED_BYTES))?;
        self.points.set(&stroke_inputs(&self.strokes, 0, false), None);
        if !frame.lines.vertices.is_empty() {
            self.lines.upload(bytemuck::cast_slice(&frame.lines.vertices))?;
        }
        Ok(())
    }

    /// Forgets the strokes of the previous frame.
    pub(crate) fn clear(&mut self) {
        self.count = 0;
    }

    /// Runs a resolve program over the strokes of a layer.
    pub(crate) fn resolve(&self, bound: Bound<'_>, layer: LayerRun) -> Result<(), GlError> {
        let records = Records { first: layer.first, count: layer.count, record_bytes: RESOLVED_BYTES as u32 };
        self.gpu.capture(bound, &self.points, &self.resolved, records)
    }

    /// Draws a billboard for each stroke of a run, in the pass that was begun last.
    pub(crate) fn draw(&self, bound: Bound<'_>, run: LayerRun, with_shape: bool) -> Result<(), GlError> {
        let first = run.first as i32;
        let mut inputs = stroke_inputs(&self.strokes, first, true);
        if with_shape {
            inputs.push(shape_input(&inputs[0], first));
        }
        inputs.extend(resolved_inputs(&self.resolved, first));
        self.quads.set(&inputs, None);
        self.gpu.draw(bound, &self.quads, Vertices::Quads { instances: run.count })
    }

    /// Draws a strip of a line, in the pass that was begun last.
    pub(crate) fn draw_strip(&self, bound: Bound<'_>, strip: LineStrip) -> Result<(), GlError> {
        let stroke = strip.stroke as i32;
        let mut inputs = stroke_inputs(&self.strokes, stroke, true);
        inputs.extend(resolved_inputs(&self.resolved, stroke));
        inputs.extend(line_inputs(&self.lines, strip.first as i32));
        self.quads.set(&inputs, None);
        self.gpu.draw(bound, &self.quads, Vertices::Strip { count: strip.count })
    }

    pub(crate) fn marks(&self) -> Option<&Marks> {
        self.marks.as_ref()
    }

    /// What the resolve pass found for each stroke of the last frame, eight floats each.
    pub(crate) fn read_resolved(&self) -> Vec<[f32; 8]> {
        bytemuck::pod_collect_to_vec(&self.resolved.read(self.count * RESOLVED_BYTES))
    }
}

/// The results of the resolve pass as shader inputs, from stroke `first` on, one for each billboard.
fn resolved_inputs(resolved: &Buffer, first: i32) -> [Attribute<'_>; 2] {
    let stride = RESOLVED_BYTES as i32;
    [(6, 0), (7, 16)].map(|(location, offset)| Attribute {
        location,
        buffer: resolved,
        components: 4,
        integer: false,
        stride_bytes: stride,
        offset_bytes: first * stride + offset,
        per_instance: true,
    })
}

/// The fields of [`LineVertex`] as shader inputs, from vertex `first` on.
fn line_inputs(lines: &Buffer, first: i32) -> [Attribute<'_>; 3] {
    let stride = size_of::<LineVertex>() as i32;
    let fields = [
        (9, 4, offset_of!(LineVertex, at_px)),
        (10, 4, offset_of!(LineVertex, from_middle_px)),
        (11, 3, offset_of!(LineVertex, lean_px)),
    ];
    fields.map(|(location, components, offset)| Attribute {
        location,
        buffer: lines,
        components,
        integer: false,
        stride_bytes: stride,
        offset_bytes: first * stride + offset as i32,
        per_instance: false,
    })
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
        input(0, 4, offset_of!(Stroke, center_px), false),
        input(1, 4, offset_of!(Stroke, length_px), false),
        input(2, 4, offset_of!(Stroke, bits), true),
        input(3, 2, offset_of!(Stroke, paint), true),
        input(4, 4, offset_of!(Stroke, normal_in_world), false),
        input(5, 4, offset_of!(Stroke, overrun_px), false),
    ]
}

/// Taper and bend as a shader input, from stroke `first` on. Its buffer and stride are those of `other`, another input
/// of the strokes.
fn shape_input<'a>(other: &Attribute<'a>, first: i32) -> Attribute<'a> {
    let offset = first * size_of::<Stroke>() as i32 + offset_of!(Stroke, taper) as i32;
    Attribute { location: 8, components: 2, offset_bytes: offset, ..*other }
}
