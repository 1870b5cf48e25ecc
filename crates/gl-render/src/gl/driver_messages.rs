//! Errors that the driver itself reports (KHR_debug).

use std::sync::{Arc, Mutex};

use glow::HasContext as _;

/// What the driver has reported since it was last asked.
///
/// A panic inside the driver's callback would be swallowed, so messages are collected and looked at after each frame.
#[derive(Clone, Debug, Default)]
pub(crate) struct DriverMessages {
    pending: Arc<Mutex<Vec<String>>>,
}

impl DriverMessages {
    /// Starts to collect; `None` where the driver has no debug output.
    pub(crate) fn install(gl: &mut glow::Context) -> Option<Self> {
        if !gl.supports_debug() {
            return None;
        }
        let messages = Self::default();
        let sink = messages.clone();
        // SAFETY: the context is current; the callback owns what it touches and never panics.
        unsafe {
            gl.enable(glow::DEBUG_OUTPUT);
            gl.enable(glow::DEBUG_OUTPUT_SYNCHRONOUS);
            gl.debug_message_callback(move |_source, kind, _id, severity, text| {
                if is_fault(kind, severity) {
                    sink.push(text);
                }
            });
        }
        Some(messages)
    }

    fn push(&self, text: &str) {
        let mut pending = self.pending.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        // Without a limit, an error that repeats would fill the memory.
        if pending.len() < 64 {
            pending.push(text.trim_end().to_owned());
        }
    }

    pub(crate) fn take(&self) -> Vec<String> {
        std::mem::take(&mut *self.pending.lock().unwrap_or_else(std::sync::PoisonError::into_inner))
    }
}

fn is_fault(kind: u32, severity: u32) -> bool {
    kind == glow::DEBUG_TYPE_ERROR
        || kind == glow::DEBUG_TYPE_UNDEFINED_BEHAVIOR
        || severity == glow::DEBUG_SEVERITY_HIGH
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_are_faults_and_notifications_are_not() {
        assert!(is_fault(glow::DEBUG_TYPE_ERROR, glow::DEBUG_SEVERITY_LOW));
        assert!(is_fault(glow::DEBUG_TYPE_OTHER, glow::DEBUG_SEVERITY_HIGH));
        assert!(!is_fault(glow::DEBUG_TYPE_OTHER, glow::DEBUG_SEVERITY_NOTIFICATION));
        assert!(!is_fault(glow::DEBUG_TYPE_PERFORMANCE, glow::DEBUG_SEVERITY_MEDIUM));
    }
}
