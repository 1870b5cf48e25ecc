//! Vertex arrays of OpenGL: they say in which buffers a draw call finds its vertices.

use glow::HasContext as _;

use super::{Buffer, GlError, Gpu};

/// One input of a vertex shader.
#[derive(Clone, Copy)]
pub(crate) struct Attribute<'a> {
    pub location: u32,
    pub buffer: &'a Buffer,
    /// How many floats, or unsigned integers where `integer` is set.
    pub components: i32,
    pub integer: bool,
    pub stride_bytes: i32,
    pub offset_bytes: i32,
    /// One value per instance instead of one per vertex.
    pub per_instance: bool,
}

/// The inputs of a draw call. The buffers must live as long as anything is drawn with them.
pub(crate) struct VertexArray {
    gpu: Gpu,
    id: glow::VertexArray,
}

impl VertexArray {
    /// A vertex array without inputs: the shader computes each vertex from its number.
    pub(crate) fn empty(gpu: &Gpu) -> Result<Self, GlError> {
        // SAFETY: the context is current.
        let id = unsafe { gpu.gl().create_vertex_array() }
            .map_err(|reason| GlError::Resource { what: "a vertex array".to_owned(), reason })?;
        Ok(Self { gpu: gpu.clone(), id })
    }

    pub(crate) fn new(
        gpu: &Gpu,
        attributes: &[Attribute<'_>],
        indices: Option<&Buffer>,
    ) -> Result<Self, GlError> {
        let array = Self::empty(gpu)?;
        array.set(attributes, indices);
        Ok(array)
    }

    /// Makes the inputs come from other buffers.
    pub(crate) fn set(&self, attributes: &[Attribute<'_>], indices: Option<&Buffer>) {
        let gl = self.gpu.gl();
        // SAFETY: the context is current; offsets and strides are those of the records in the buffers.
        unsafe {
            gl.bind_vertex_array(Some(self.id));
            for input in attributes {
                gl.bind_buffer(glow::ARRAY_BUFFER, Some(input.buffer.id()));
                gl.enable_vertex_attrib_array(input.location);
                if input.integer {
                    gl.vertex_attrib_pointer_i32(
                        input.location,
                        input.components,
                        glow::UNSIGNED_INT,
                        input.stride_bytes,
                        input.offset_bytes,
                    );
                } else {
                    gl.vertex_attrib_pointer_f32(
                        input.location,
                        input.components,
                        glow::FLOAT,
                        false,
                        input.stride_bytes,
                        input.offset_bytes,
                    );
                }
                gl.vertex_attrib_divisor(input.location, input.per_instance.into());
            }
            if let Some(indices) = indices {
                gl.bind_buffer(glow::ELEMENT_ARRAY_BUFFER, Some(indices.id()));
            }
            gl.bind_vertex_array(None);
        }
    }

    pub(super) fn id(&self) -> glow::VertexArray {
        self.id
    }
}

impl Drop for VertexArray {
    fn drop(&mut self) {
        if self.gpu.make_current().is_ok() {
            // SAFETY: the context is current and the array was made in it.
            unsafe { self.gpu.gl().delete_vertex_array(self.id) };
        }
    }
}
