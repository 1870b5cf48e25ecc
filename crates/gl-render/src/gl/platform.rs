//! What the OpenGL wrapper needs from whatever library opened the context.

use std::ffi::{CStr, c_void};

/// The part of a context that the windowing library owns. Dropping it destroys the context.
pub(crate) trait Platform {
    fn make_current(&self) -> Result<(), String>;
    /// Leaves this thread without a current context. EGL needs this: it skips the next [`Platform::make_current`] if it
    /// made this same context current last, even if OSMesa has made another one current since.
    fn make_none_current(&self) -> Result<(), String> {
        Ok(())
    }
    /// The address of an OpenGL function, null where there is none.
    fn function_address(&self, name: &CStr) -> *const c_void;
}
