//! What the OpenGL wrapper needs from whatever library opened the context.

use std::ffi::{CStr, c_void};

/// The part of a context that the windowing library owns. Dropping it destroys the context.
pub(crate) trait Platform {
    /// Makes the context current on this thread.
    fn make_current(&self) -> Result<(), String>;
    /// Makes no context current on this thread, if the library would otherwise skip [`Platform::make_current`]. EGL
    /// skips it where this is the context that EGL last made current, even if OSMesa has made another one current
    /// since.
    fn make_none_current(&self) -> Result<(), String> {
        Ok(())
    }
    /// The address of an OpenGL function, null where there is none.
    fn function_address(&self, name: &CStr) -> *const c_void;
}
