//! A pass: draws into one framebuffer with one fixed state.

use glow::HasContext as _;

use super::program::Bound;
use super::{Buffer, Framebuffer, GlError, Gpu, VertexArray};

/// How a new colour combines with the old one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Blend {
    /// The new colour replaces the old one.
    #[default]
    Off,
    /// The new colour is laid over the old one; both are premultiplied.
    Over,
    /// The larger value of each colour channel stays; alpha as in `Over`.
    Largest,
    /// The new colour is laid under the old one; both are premultiplied.
    Under,
}

/// The state of a pass. All other state is reset at each pass, because other code may use the context too.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct DrawState {
    pub depth_test: bool,
    /// Keeps the depth of earlier passes; surfaces at equal depth are then drawn too.
    pub depth_kept: bool,
    pub blend: Blend,
    /// Clears every colour target to this colour; `None` keeps what they hold.
    pub clear: Option<[f32; 4]>,
    /// For shadow maps: pushes surfaces away from the light a little, so that they cast no shadow on themselves, and
    /// clamps depth, so that surfaces between the light and the near plane cast shadows too.
    pub casts_shadow: bool,
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum Vertices {
    /// One triangle that covers the picture, made from the vertex number.
    Screen,
    /// Indexed triangles: first index and number of indices.
    Indexed { first: u32, count: u32 },
    /// A strip of four corners for each instance.
    Quads { instances: u32 },
    /// One strip of `count` corners.
    Strip { count: u32 },
}

impl Gpu {
    /// Begins a pass: binds the target, sets the state, clears.
    pub(crate) fn begin_pass(&self, target: &Framebuffer, state: DrawState) {
        let gl = self.gl();
        let [width, height] = target.size_px();
        let switch = |capability: u32, on: bool| {
            // SAFETY: the context is current; the capabilities exist in OpenGL 3.3.
            unsafe { if on { gl.enable(capability) } else { gl.disable(capability) } }
        };
        for off in [
            glow::CULL_FACE,
            glow::SCISSOR_TEST,
            glow::STENCIL_TEST,
            glow::DITHER,
            glow::RASTERIZER_DISCARD,
            glow::FRAMEBUFFER_SRGB,
            glow::COLOR_LOGIC_OP,
            glow::SAMPLE_ALPHA_TO_COVERAGE,
        ] {
            switch(off, false);
        }
        switch(glow::DEPTH_TEST, state.depth_test);
        switch(glow::BLEND, state.blend != Blend::Off);
        switch(glow::POLYGON_OFFSET_FILL, state.casts_shadow);
        switch(glow::DEPTH_CLAMP, state.casts_shadow);
        // SAFETY: the context is current; the framebuffer was made in it.
        unsafe {
            gl.bind_framebuffer(glow::FRAMEBUFFER, Some(target.id()));
            gl.viewport(0, 0, width as i32, height as i32);
            gl.polygon_mode(glow::FRONT_AND_BACK, glow::FILL);
            gl.polygon_offset(1.0, 2.0);
            gl.color_mask(true, true, true, true);
            gl.depth_mask(true);
            gl.depth_func(if state.depth_kept { glow::LEQUAL } else { glow::LESS });
            let of_color = if state.blend == Blend::Largest { glow::MAX } else { glow::FUNC_ADD };
            gl.blend_equation_separate(of_color, glow::FUNC_ADD);
            match state.blend {
                Blend::Under => gl.blend_func(glow::ONE_MINUS_DST_ALPHA, glow::ONE),
                Blend::Off | Blend::Over | Blend::Largest => {
                    gl.blend_func(glow::ONE, glow::ONE_MINUS_SRC_ALPHA)
                }
            }
            if state.depth_test && !state.depth_kept {
                gl.clear_depth_f32(1.0);
                gl.clear(glow::DEPTH_BUFFER_BIT);
            }
            if let Some([r, g, b, a]) = state.clear {
                gl.clear_color(r, g, b, a);
                gl.clear(glow::COLOR_BUFFER_BIT);
            }
        }
    }

    /// Draws in the pass that was begun last.
    pub(crate) fn draw(
        &self,
        bound: Bound<'_>,
        array: &VertexArray,
        vertices: Vertices,
    ) -> Result<(), GlError> {
        bound.finish()?;
        let gl = self.gl();
        // SAFETY: the context is current.
        unsafe { gl.bind_vertex_array(Some(array.id())) };
        match vertices {
            // SAFETY: the context is current; no buffer is read.
            Vertices::Screen => unsafe { gl.draw_arrays(glow::TRIANGLES, 0, 3) },
            // SAFETY: the context is current; the array's buffers hold at least what the caller asks to draw.
            Vertices::Indexed { first, count } => unsafe {
                gl.draw_elements(glow::TRIANGLES, count as i32, glow::UNSIGNED_INT, first as i32 * 4);
            },
            // SAFETY: as for indexed triangles.
            Vertices::Quads { instances } => self.counting_fragments(|| unsafe {
                gl.draw_arrays_instanced(glow::TRIANGLE_STRIP, 0, 4, instances as i32);
            }),
            // SAFETY: as for indexed triangles.
            Vertices::Strip { count } => self.counting_fragments(|| unsafe {
                gl.draw_arrays_instanced(glow::TRIANGLE_STRIP, 0, count as i32, 1);
            }),
        }
        // SAFETY: the context is current.
        unsafe { gl.bind_vertex_array(None) };
        Ok(())
    }

    /// Runs a vertex shader over points and writes the shader's outputs into `output`, one record for each point.
    /// Nothing is drawn.
    pub(crate) fn capture(
        &self,
        bound: Bound<'_>,
        array: &VertexArray,
        output: &Buffer,
        records: Records,
    ) -> Result<(), GlError> {
        bound.finish()?;
        if records.count == 0 {
            return Ok(());
        }
        let gl = self.gl();
        let bytes = |count: u32| (count * records.record_bytes) as i32;
        // SAFETY: the context is current; the buffer has room for the range, as every caller reserves it.
        unsafe {
            gl.enable(glow::RASTERIZER_DISCARD);
            gl.bind_vertex_array(Some(array.id()));
            gl.bind_buffer_range(
                glow::TRANSFORM_FEEDBACK_BUFFER,
                0,
                Some(output.id()),
                bytes(records.first),
                bytes(records.count),
            );
            gl.begin_transform_feedback(glow::POINTS);
            gl.draw_arrays(glow::POINTS, records.first as i32, records.count as i32);
            gl.end_transform_feedback();
            gl.bind_buffer_base(glow::TRANSFORM_FEEDBACK_BUFFER, 0, None);
            gl.bind_vertex_array(None);
            gl.disable(glow::RASTERIZER_DISCARD);
        }
        Ok(())
    }
}

/// Which records a capture reads and writes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Records {
    pub first: u32,
    pub count: u32,
    pub record_bytes: u32,
}
