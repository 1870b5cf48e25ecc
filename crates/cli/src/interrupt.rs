//! Ends a command on Ctrl-C, and on the other signals that ask it to end, without leaving half-written files.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;

#[cfg(unix)]
const SIGNALS: [i32; 3] = [SIGINT, SIGTERM, signal_hook::consts::SIGHUP];
#[cfg(not(unix))]
const SIGNALS: [i32; 2] = [SIGINT, SIGTERM];

/// Notes signals. While a command reads and prepares, it has written nothing, and a signal ends it at once. From
/// [`Interrupt::hold_off`] on, a signal is only noted, and the command ends once its files are in order.
pub(crate) struct Interrupt {
    came: Arc<AtomicBool>,
    ends_at_once: Arc<AtomicBool>,
}

impl Interrupt {
    pub(crate) fn watch() -> io::Result<Self> {
        let interrupt =
            Self { came: Arc::new(AtomicBool::new(false)), ends_at_once: Arc::new(AtomicBool::new(true)) };
        for signal in SIGNALS {
            flag::register_conditional_default(signal, Arc::clone(&interrupt.ends_at_once))?;
            flag::register(signal, Arc::clone(&interrupt.came))?;
        }
        Ok(interrupt)
    }

    pub(crate) fn hold_off(&self) {
        self.ends_at_once.store(false, Ordering::SeqCst);
    }

    pub(crate) fn came(&self) -> bool {
        self.came.load(Ordering::SeqCst)
    }
}
