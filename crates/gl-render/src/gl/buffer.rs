//! Buffers on the GPU that grow as needed.

use glow::HasContext as _;

use super::{GlError, Gpu};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum BufferUse {
    /// Written once.
    Fixed,
    /// Written anew each frame.
    Streamed,
    /// Written by the GPU, read back by the CPU.
    ReadBack,
}

pub(crate) struct Buffer {
    gpu: Gpu,
    id: glow::Buffer,
    usage: u32,
    capacity: usize,
}

/// The largest allowed buffer: `glow` takes sizes of buffers as `i32`, and no frame needs this much.
const MAX_BYTES: usize = 1 << 30;

impl Buffer {
    pub(crate) fn new(gpu: &Gpu, buffer_use: BufferUse) -> Result<Self, GlError> {
        let usage = match buffer_use {
            BufferUse::Fixed => glow::STATIC_DRAW,
            BufferUse::Streamed => glow::STREAM_DRAW,
            BufferUse::ReadBack => glow::DYNAMIC_READ,
        };
        // SAFETY: the context is current.
        let id = unsafe { gpu.gl().create_buffer() }
            .map_err(|reason| GlError::Resource { what: "a buffer".to_owned(), reason })?;
        Ok(Self { gpu: gpu.clone(), id, usage, capacity: 0 })
    }

    pub(super) fn id(&self) -> glow::Buffer {
        self.id
    }

    /// Makes room for this many bytes. The contents are lost when the buffer grows.
    pub(crate) fn reserve(&mut self, bytes: usize) -> Result<(), GlError> {
        if bytes <= self.capacity {
            return Ok(());
        }
        let what = format!("a buffer of {bytes} bytes");
        if bytes > MAX_BYTES {
            return Err(GlError::Resource { what, reason: format!("the limit is {MAX_BYTES} bytes") });
        }
        let capacity = if self.usage == glow::STATIC_DRAW { bytes } else { bytes.next_power_of_two() };
        let gl = self.gpu.gl();
        // SAFETY: the context is current; the size fits an i32.
        unsafe {
            gl.bind_buffer(glow::COPY_WRITE_BUFFER, Some(self.id));
            gl.buffer_data_size(glow::COPY_WRITE_BUFFER, capacity as i32, self.usage);
        }
        self.gpu.check_memory(&what)?;
        self.capacity = capacity;
        Ok(())
    }

    /// Replaces the contents.
    pub(crate) fn upload(&mut self, bytes: &[u8]) -> Result<(), GlError> {
        self.reserve(bytes.len())?;
        let gl = self.gpu.gl();
        // SAFETY: the context is current; `reserve` made room.
        unsafe {
            gl.bind_buffer(glow::COPY_WRITE_BUFFER, Some(self.id));
            gl.buffer_sub_data_u8_slice(glow::COPY_WRITE_BUFFER, 0, bytes);
        }
        Ok(())
    }

    /// Binds it as storage buffer 0, so that shaders can write into it, and sets its first 4 bytes to 0.
    pub(crate) fn begin_storing(&self) {
        let gl = self.gpu.gl();
        // SAFETY: the context is current and has storage buffers; the caller has reserved more than 4 bytes.
        unsafe {
            gl.bind_buffer(glow::COPY_WRITE_BUFFER, Some(self.id));
            gl.buffer_sub_data_u8_slice(glow::COPY_WRITE_BUFFER, 0, &[0; 4]);
            gl.bind_buffer_base(glow::SHADER_STORAGE_BUFFER, 0, Some(self.id));
        }
    }

    /// Ends what [`Buffer::begin_storing`] began. Afterwards, what shaders have written can be read.
    pub(crate) fn end_storing(&self) {
        let gl = self.gpu.gl();
        // SAFETY: the context is current and has storage buffers.
        unsafe {
            gl.memory_barrier(glow::BUFFER_UPDATE_BARRIER_BIT);
            gl.bind_buffer_base(glow::SHADER_STORAGE_BUFFER, 0, None);
        }
    }

    /// Reads back the first `bytes` bytes, or the whole buffer if it is smaller.
    pub(crate) fn read(&self, bytes: usize) -> Vec<u8> {
        let mut contents = vec![0; bytes.min(self.capacity)];
        let gl = self.gpu.gl();
        // SAFETY: the context is current; the slice is no longer than the buffer.
        unsafe {
            gl.bind_buffer(glow::COPY_READ_BUFFER, Some(self.id));
            gl.get_buffer_sub_data(glow::COPY_READ_BUFFER, 0, &mut contents);
        }
        contents
    }
}

impl Drop for Buffer {
    fn drop(&mut self) {
        if self.gpu.make_current().is_ok() {
            // SAFETY: the context is current and the buffer was made in it.
            unsafe { self.gpu.gl().delete_buffer(self.id) };
        }
    }
}
