//! The orders to `impasto serve`: lines of standard input, read on a thread of their own, so that a stop is noticed
//! while a frame is painted.

use std::io::BufRead as _;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, channel};
use std::sync::{Arc, Condvar, Mutex, PoisonError};

use serde::Deserialize;

/// The longest line that is read, in bytes.
const LONGEST_LINE: u64 = 1 << 20;

#[derive(Debug, Deserialize)]
#[serde(tag = "command", rename_all = "snake_case")]
enum Line {
    Prepare {
        #[serde(default)]
        id: u64,
    },
    Render(RenderOrder),
    /// A frame's file was read: another may be made.
    Taken,
    /// Give up what is being rendered.
    Stop,
    Quit,
    /// Stands for a line that is too long to be read.
    #[serde(skip)]
    TooLong,
}

#[derive(Clone, Debug, Deserialize)]
pub(super) struct RenderOrder {
    /// Repeated in every answer.
    #[serde(default)]
    pub id: u64,
    /// Which frames, as `-f` takes them.
    pub frames: String,
    /// Where the EXR files go, as `-o` takes it.
    pub output: String,
    /// Width and height, pixels; left out, the scene's.
    #[serde(default)]
    pub size: Option<[u32; 2]>,
    /// What goes beside the colour, as `--aov` takes it.
    #[serde(default)]
    pub aovs: Vec<String>,
    /// Whether the background is transparent.
    #[serde(default)]
    pub alpha: bool,
    /// Whether files are written without compression.
    #[serde(default)]
    pub plain: bool,
    /// How many written files may wait for their `taken` line; 0 for any number.
    #[serde(default)]
    pub ahead: usize,
}

/// Something to do. Orders are carried out one after the other.
pub(super) enum Order {
    Prepare {
        id: u64,
    },
    Render(RenderOrder),
    /// A line that cannot be read, in words that say why.
    Unread(String),
}

/// What changes while an order is carried out.
#[derive(Default)]
pub(super) struct Current {
    is_stopped: AtomicBool,
    taken: Mutex<usize>,
    changed: Condvar,
}

impl Current {
    pub fn is_stopped(&self) -> bool {
        self.is_stopped.load(Ordering::SeqCst)
    }

    /// Waits while `ahead` or more of the `written` files are not taken yet, unless the order is given up.
    pub fn wait_until_taken(&self, written: usize, ahead: usize) {
        if ahead == 0 {
            return;
        }
        let mut taken = self.taken.lock().unwrap_or_else(PoisonError::into_inner);
        while written - (*taken).min(written) >= ahead && !self.is_stopped() {
            taken = self.changed.wait(taken).unwrap_or_else(PoisonError::into_inner);
        }
    }

    fn stop(&self) {
        self.is_stopped.store(true, Ordering::SeqCst);
        let _held = self.taken.lock().unwrap_or_else(PoisonError::into_inner);
        self.changed.notify_all();
    }
}

pub(super) struct Orders {
    coming: Receiver<(Order, Arc<Current>)>,
}

impl Orders {
    /// Begins to read. At the end of the input, or at `quit`, rendering is stopped, because nobody waits for its
    /// frames.
    pub fn from_stdin() -> Self {
        let (send, coming) = channel();
        std::thread::spawn(move || {
            let mut input = std::io::stdin().lock();
            let mut last = Arc::<Current>::default();
            loop {
                let mut line = Vec::new();
                let read = std::io::Read::take(&mut input, LONGEST_LINE).read_until(b'\n', &mut line);
                if !matches!(read, Ok(count) if count > 0) {
                    break;
                }
                let is_cut = line.len() as u64 == LONGEST_LINE && !line.ends_with(b"\n");
                if is_cut && input.skip_until(b'\n').is_err() {
                    break;
                }
                if !is_cut && line.trim_ascii().is_empty() {
                    continue;
                }
                let read = if is_cut { Ok(Line::TooLong) } else { serde_json::from_slice(&line) };
                let order = match read {
                    Ok(Line::TooLong) => Order::Unread(format!(
                        "a line is longer than {LONGEST_LINE} bytes: it is passed over"
                    )),
                    Ok(Line::Prepare { id }) => Order::Prepare { id },
                    Ok(Line::Render(order)) => Order::Render(order),
                    Ok(Line::Taken) => {
                        *last.taken.lock().unwrap_or_else(PoisonError::into_inner) += 1;
                        last.changed.notify_all();
                        continue;
                    }
                    Ok(Line::Stop) => {
                        last.stop();
                        continue;
                    }
                    Ok(Line::Quit) => break,
                    Err(error) => Order::Unread(format!("a line is not understood: {error}")),
                };
                if matches!(order, Order::Render(_)) {
                    // A new render order stops the one before it.
                    last.stop();
                    last = Arc::default();
                }
                if send.send((order, Arc::clone(&last))).is_err() {
                    break;
                }
            }
            last.stop();
        });
        Self { coming }
    }

    /// The next order and its [`Current`]; `None` when there are no more.
    pub fn next(&self) -> Option<(Order, Arc<Current>)> {
        self.coming.recv().ok()
    }
}
