//! Reads frames from their PNG files on a thread of its own, for the viewer of finished frames. However many frames
//! there are, the pictures that it keeps take at most [`MOST_BYTES`], unless the shown one takes more by itself.
//!
//! ```text
//! want([7, 8, 9…], size) ─▶ thread: the first that is not read yet ─▶ decode, reduce ─▶ picture(7)
//! ```

use std::collections::{BTreeMap, BTreeSet};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};

use egui::ColorImage;
use impasto_frame_files::frame_reader::{self, Depth, FrameInfo, FramePixels};

#[cfg(test)]
mod tests;

/// The pictures that are kept take no more memory than this, unless the one that is shown takes more by itself.
pub const MOST_BYTES: usize = 256 << 20;

/// A picture is refused if reading it would take more than the available memory divided by this.
const MEMORY_SHARE: u64 = 4;

/// Reads frames. Dropping this ends its thread after the frame that it is reading.
pub struct FrameReading {
    shared: Arc<Shared>,
}

struct Shared {
    board: Mutex<Board>,
    changed: Condvar,
}

struct Board {
    paths: Vec<PathBuf>,
    /// Indices, the most urgent first.
    wanted: Vec<usize>,
    /// The size of the area that pictures are shown in. Larger pictures are reduced, but stay at least as large as they
    /// are shown.
    size_px: [usize; 2],
    read: BTreeMap<usize, Result<Arc<ColorImage>, String>>,
    /// Frames whose pictures were dropped to make room for others. They are not read again until other frames or
    /// another size are wanted.
    let_go: BTreeSet<usize>,
    most_bytes: usize,
    ended: bool,
}

impl FrameReading {
    /// Starts the thread. It calls `wake` whenever a frame was read.
    ///
    /// # Errors
    /// When the system gives no thread.
    pub fn start(paths: Vec<PathBuf>, wake: impl Fn() + Send + 'static) -> std::io::Result<Self> {
        Self::within(paths, MOST_BYTES, wake)
    }

    fn within(
        paths: Vec<PathBuf>,
        most_bytes: usize,
        wake: impl Fn() + Send + 'static,
    ) -> std::io::Result<Self> {
        let board = Board {
            paths,
            wanted: Vec::new(),
            size_px: [usize::MAX; 2],
            read: BTreeMap::new(),
            let_go: BTreeSet::new(),
            most_bytes,
            ended: false,
        };
        let shared = Arc::new(Shared { board: Mutex::new(board), changed: Condvar::new() });
        let theirs = Arc::clone(&shared);
        std::thread::Builder::new().name("frames".to_owned()).spawn(move || run(&theirs, &wake))?;
        Ok(Self { shared })
    }

    /// Says which frames are needed, the most urgent first, and how large they are shown.
    pub fn want(&self, wanted: Vec<usize>, size_px: [usize; 2]) {
        let mut board = self.shared.board();
        if size_px != board.size_px {
            // Pictures that were reduced for a smaller window would be blurred.
            board.read.clear();
            board.let_go.clear();
            board.size_px = size_px;
        }
        if wanted != board.wanted {
            board.wanted = wanted;
            board.let_go.clear();
        }
        board.make_room();
        drop(board);
        self.shared.changed.notify_all();
    }

    /// Replaces the list of files. Unless the list only got longer, the indices of frames have changed, and all
    /// pictures are dropped. Returns whether the pictures were dropped.
    pub fn replace(&self, paths: Vec<PathBuf>) -> bool {
        let mut board = self.shared.board();
        let moves = !paths.starts_with(&board.paths);
        board.paths = paths;
        if moves {
            board.read.clear();
            board.let_go.clear();
        }
        drop(board);
        self.shared.changed.notify_all();
        moves
    }

    /// The picture of a frame, or why there is none; `None` until it was read.
    pub fn picture(&self, index: usize) -> Option<Result<Arc<ColorImage>, String>> {
        self.shared.board().read.get(&index).cloned()
    }
}

impl Drop for FrameReading {
    fn drop(&mut self) {
        self.shared.board().ended = true;
        self.shared.changed.notify_all();
    }
}

impl Shared {
    /// Ignores poisoning: no code that holds the lock can panic and leave the board half changed.
    fn board(&self) -> MutexGuard<'_, Board> {
        self.board.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Board {
    fn bytes(&self) -> usize {
        self.read.values().flatten().map(|picture| bytes_of(picture)).sum()
    }

    /// Drops pictures until the rest fit: first those of frames that are not wanted, then the least urgent.
    fn make_room(&mut self) {
        while self.bytes() > self.most_bytes {
            let urgency = |index: &usize| {
                self.wanted.iter().position(|wanted| wanted == index).map_or(usize::MAX, |place| place)
            };
            match self.read.keys().copied().max_by_key(urgency) {
                Some(index) if self.wanted.first() != Some(&index) => {
                    self.read.remove(&index);
                    self.let_go.insert(index);
                }
                _ => return,
            }
        }
    }

    /// The frame to read next: the first wanted one that is not read yet, as long as there is room for it.
    fn next(&self) -> Option<usize> {
        let is_due = |index: &&usize| {
            **index < self.paths.len() && !self.read.contains_key(*index) && !self.let_go.contains(*index)
        };
        let next = *self.wanted.iter().find(is_due)?;
        let largest = self.read.values().flatten().map(|picture| bytes_of(picture)).max().unwrap_or(0);
        let urgent: usize = self
            .wanted
            .iter()
            .take_while(|index| **index != next)
            .filter_map(|index| self.read.get(index)?.as_ref().ok())
            .map(|picture| bytes_of(picture))
            .sum();
        let is_first = self.wanted.first() == Some(&next);
        (is_first || urgent + largest <= self.most_bytes).then_some(next)
    }
}

fn bytes_of(picture: &ColorImage) -> usize {
    size_of_val(picture.pixels.as_slice())
}

fn run(shared: &Shared, wake: &dyn Fn()) {
    loop {
        let waiting = |board: &mut Board| !board.ended && board.next().is_none();
        let board = shared.changed.wait_while(shared.board(), waiting);
        let board = board.unwrap_or_else(PoisonError::into_inner);
        let Some(index) = board.next().filter(|_| !board.ended) else { return };
        let (path, size_px) = (board.paths.get(index).cloned().unwrap_or_default(), board.size_px);
        drop(board);
        let picture = catch_unwind(AssertUnwindSafe(|| read(&path, size_px)))
            .unwrap_or_else(|_| Err(format!("{} cannot be read: decoding it broke off", path.display())))
            .map(Arc::new);
        let mut board = shared.board();
        if board.size_px == size_px && board.paths.get(index) == Some(&path) {
            board.read.insert(index, picture);
            board.make_room();
        }
        drop(board);
        wake();
    }
}

fn read(path: &Path, size_px: [usize; 2]) -> Result<ColorImage, String> {
    let info = frame_reader::info(path).map_err(|error| error.to_string())?;
    fits(path, &info, impasto_scene::memory::available_bytes())?;
    let pixels = frame_reader::read(path).map_err(|error| error.to_string())?;
    Ok(reduced(&pixels.at_depth(Depth::Eight), size_px))
}

/// Refuses a picture that would take more than its share ([`MEMORY_SHARE`]) of the available memory.
fn fits(path: &Path, info: &FrameInfo, available_bytes: Option<u64>) -> Result<(), String> {
    let [width, height] = info.size_px;
    let channel_bytes = if info.depth == Depth::Sixteen { 2 } else { 1 };
    // Four channels a pixel, three times over: as decoded, as RGBA, and as RGBA of 8 bits.
    let needed = u64::from(width) * u64::from(height) * 4 * (channel_bytes * 2 + 1);
    match available_bytes {
        Some(available) if needed > available / MEMORY_SHARE => Err(format!(
            "{} has {width} x {height} pixels: there is not enough memory to show it",
            path.display()
        )),
        _ => Ok(()),
    }
}

/// Reduces a picture: each new pixel is the mean of a square block. The blocks are the largest that leave the picture
/// at least as large as it is shown.
fn reduced(picture: &FramePixels, size_px: [usize; 2]) -> ColorImage {
    let [width, height] = picture.size_px.map(|side| side as usize);
    // The whole picture is shown, so the side that has less room decides the scale.
    let step = (width / size_px[0].max(1)).max(height / size_px[1].max(1)).max(1);
    let size = [width.div_ceil(step), height.div_ceil(step)];
    let mut pixels = Vec::with_capacity(size[0] * size[1]);
    for top in (0..height).step_by(step) {
        for left in (0..width).step_by(step) {
            pixels.push(mean(picture, [left, top], step));
        }
    }
    ColorImage::new(size, pixels)
}

fn mean(picture: &FramePixels, [left, top]: [usize; 2], step: usize) -> egui::Color32 {
    let [width, height] = picture.size_px.map(|side| side as usize);
    let (mut sum, mut count) = ([0_u32; 4], 0_u32);
    for y in top..(top + step).min(height) {
        for x in left..(left + step).min(width) {
            let at = (y * width + x) * 4;
            let Some(&[r, g, b, a]) = picture.rgba.get(at..at + 4) else {
                continue;
            };
            let color = egui::Color32::from_rgba_unmultiplied(r, g, b, a);
            for (sum, value) in sum.iter_mut().zip(color.to_array()) {
                *sum += u32::from(value);
            }
            count += 1;
        }
    }
    let [r, g, b, a] = sum.map(|sum| ((sum + count / 2) / count.max(1)) as u8);
    egui::Color32::from_rgba_premultiplied(r, g, b, a)
}
