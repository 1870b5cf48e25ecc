//! Between passes: how long each took, and whether the picture is still wanted.

use crate::gl::{Gpu, Halt};

/// Is told of every pass that was drawn.
pub(crate) struct Watch<'a> {
    gpu: Gpu,
    stop: Option<&'a mut dyn FnMut() -> bool>,
}

impl<'a> Watch<'a> {
    /// Asks `stop`, where there is one, whether to give up.
    pub(crate) fn new(gpu: &Gpu, stop: Option<&'a mut dyn FnMut() -> bool>) -> Self {
        Self { gpu: gpu.clone(), stop }
    }

    /// Whether anybody may ask to give up.
    pub(crate) fn may_stop(&self) -> bool {
        self.stop.is_some()
    }

    /// A pass was drawn.
    pub(crate) fn passed(&mut self, pass: &'static str) -> Result<(), Halt> {
        self.gpu.lap(pass);
        match &mut self.stop {
            Some(stop) => {
                // Else the question would come long before the work.
                self.gpu.finish();
                if stop() { Err(Halt::GivenUp) } else { Ok(()) }
            }
            None => Ok(()),
        }
    }
}
