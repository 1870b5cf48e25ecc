//! The lines of a frame's touches, in the layout in which they go to the GPU.

use bytemuck::{Pod, Zeroable};

/// The lines of all touches of a frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lines {
    /// The vertices of all strips.
    pub vertices: Vec<LineVertex>,
    /// A strip of triangles for each piece of a touch that can be seen, in painting order.
    pub strips: Vec<LineStrip>,
}

/// A strip of triangles: vertices on the right and the left of a line in turn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LineStrip {
    /// Index of the touch in the frame's strokes.
    pub stroke: u32,
    /// Index of the first vertex.
    pub first: u32,
    /// How many vertices.
    pub count: u32,
}

/// A vertex of a strip. Pixels, origin at the lower left, Y up.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct LineVertex {
    /// Where it is, pixels.
    pub at_px: [f32; 2],
    /// Where it is on the brush mark, 0..=1: along and across.
    pub on_mark: [f32; 2],
    /// From the centre line to the vertex, straight across, pixels.
    pub from_middle_px: [f32; 2],
    /// Depth of the centre line beside the vertex, world units.
    pub depth: f32,
    /// How much of the paint is there, 0..=1; 0 where the surface is seen edge-on.
    pub presence: f32,
    /// Depth of the surface's tangent plane under the vertex, less that of the centre line beside it, pixels.
    pub lean_px: f32,
    /// How far in depth the surface may lie from that plane before the paint ends, pixels.
    pub leave_px: f32,
    /// How far the brush has run dry: how much more paint a texel of the mark must have to show here than at the line's
    /// beginning, as a share of full paint.
    pub run_dry: f32,
}
