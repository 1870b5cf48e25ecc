//! Watches the drawing of a picture: after each pass, or part of one, notes how long it took (if passes are timed), and
//! asks whether the picture is still wanted.

use crate::gl::{Gpu, Halt};

pub(crate) struct Watch<'a> {
    gpu: Gpu,
    stop: Option<&'a mut dyn FnMut() -> bool>,
}

impl<'a> Watch<'a> {
    /// A watch that calls `stop`, if there is one, after every pass; true means to stop.
    pub(crate) fn new(gpu: &Gpu, stop: Option<&'a mut dyn FnMut() -> bool>) -> Self {
        Self { gpu: gpu.clone(), stop }
    }

    /// Whether there is a `stop` to call. If so, long passes are drawn in parts, so that it is called often.
    pub(crate) fn may_stop(&self) -> bool {
        self.stop.is_some()
    }

    /// To be called after each pass, with its name.
    ///
    /// # Errors
    /// [`Halt::GivenUp`] when `stop` returns true.
    pub(crate) fn passed(&mut self, pass: &'static str) -> Result<(), Halt> {
        self.gpu.lap(pass);
        match &mut self.stop {
            Some(stop) => {
                // The driver works in the background: without waiting, `stop` would be called long before the pass is
                // done.
                self.gpu.finish();
                if stop() { Err(Halt::GivenUp) } else { Ok(()) }
            }
            None => Ok(()),
        }
    }
}
