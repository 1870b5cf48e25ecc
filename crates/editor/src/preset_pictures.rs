//! Paints a small picture of the scene with each preset, on a thread of its own, while the list of presets is open.
//!
//! ```text
//! want([(gouache, scene with gouache), …]) ─▶ thread: the first without a picture ─▶ prepare ─▶ draw ─▶ take()
//! ```

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use egui::ColorImage;
use impasto_gl_render::context::Driver;
use impasto_gl_render::{Renderer, ShaderTexts};
use impasto_painting::{FrameOptions, PrepareOptions, Preparer};
use impasto_scene::loaded::LoadedScene;
use impasto_scene::motion;

use crate::priority::give_way;
use crate::rendering::open_renderer;

#[cfg(test)]
mod tests;

/// The greatest width and height of a picture, in pixels.
const MOST_PX: [u32; 2] = [288, 162];

/// Relative to the picture, strokes are this many times larger than in the scene. Otherwise they could not be told
/// apart in a small picture.
const LARGER: f32 = 3.0;

/// Beside the window's own painting of the scene, which is in memory already, preparing a picture may use the available
/// memory divided by this.
const SHARE: u64 = 4;

/// How long dropping waits for the thread.
const CLOSING: Duration = Duration::from_millis(1500);

/// Makes a scene with a preset; `None` if the preset cannot be applied.
pub type SceneOf = Arc<dyn Fn() -> Option<LoadedScene> + Send + Sync>;

/// A picture to paint.
#[derive(Clone)]
pub struct Wanted {
    /// Its name.
    pub name: String,
    /// Its scene, made on the thread.
    pub scene: SceneOf,
    /// The frame, seen by the shot's camera.
    pub frame: f64,
}

/// Paints the pictures. Dropping this gives up what is under way.
pub struct PresetPictures {
    shared: Arc<Shared>,
}

struct Shared {
    board: Mutex<Board>,
    changed: Condvar,
}

#[derive(Default)]
struct Board {
    /// Counts the lists that were wanted.
    list: u64,
    /// What is not painted yet, in the order of painting.
    wanted: Vec<Wanted>,
    /// Shaders that replace the program's own.
    shaders: ShaderTexts,
    painted: Vec<(String, ColorImage)>,
    closes: bool,
    ended: bool,
}

impl PresetPictures {
    /// Starts the thread. It calls `wake` after each picture.
    ///
    /// # Errors
    /// When the system gives no thread.
    pub fn start(driver: Driver, wake: impl Fn() + Send + 'static) -> std::io::Result<Self> {
        let shared = Arc::new(Shared { board: Mutex::default(), changed: Condvar::new() });
        let theirs = Arc::clone(&shared);
        std::thread::Builder::new().name("preset pictures".to_owned()).spawn(move || {
            give_way();
            while let Some(list) = theirs.wait() {
                // Errors are ignored here. Without pictures, the user can still choose presets by their names.
                match catch_unwind(AssertUnwindSafe(|| theirs.paint_list(list, driver, &wake))) {
                    Ok(Some(())) => {}
                    Ok(None) => theirs.give_list_up(list),
                    // A broken driver may panic; the rest of the list is tried with a new one.
                    Err(_) => drop(theirs.put(list, None)),
                }
            }
            theirs.board().ended = true;
            theirs.changed.notify_all();
        })?;
        Ok(Self { shared })
    }

    /// Paints these from now on, in this order, and nothing else; what is under way is given up. `shaders` replace the
    /// program's own.
    pub fn want(&self, wanted: Vec<Wanted>, shaders: ShaderTexts) {
        let mut board = self.shared.board();
        board.list += 1;
        board.shaders = shaders;
        board.wanted = wanted;
        board.painted.clear();
        drop(board);
        self.shared.changed.notify_all();
    }

    /// The pictures since the last call, by name.
    pub fn take(&self) -> Vec<(String, ColorImage)> {
        std::mem::take(&mut self.shared.board().painted)
    }
}

impl Drop for PresetPictures {
    fn drop(&mut self) {
        let mut board = self.shared.board();
        board.closes = true;
        board.list += 1;
        drop(board);
        self.shared.changed.notify_all();
        // The program must not end while the thread is inside the driver.
        let runs = |board: &mut Board| !board.ended;
        drop(self.shared.changed.wait_timeout_while(self.shared.board(), CLOSING, runs));
    }
}

impl Shared {
    /// Ignores poisoning: no code that holds the lock can panic and leave the board half changed.
    fn board(&self) -> MutexGuard<'_, Board> {
        self.board.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits until something is wanted. Returns the number of the list; none once the window closes.
    fn wait(&self) -> Option<u64> {
        let idle = |board: &mut Board| board.wanted.is_empty() && !board.closes;
        let board = self.changed.wait_while(self.board(), idle).unwrap_or_else(PoisonError::into_inner);
        (!board.closes).then_some(board.list)
    }

    /// The next picture of the list with this number; none if nothing is left of the list or another list replaced it.
    fn next(&self, list: u64) -> Option<Wanted> {
        let board = self.board();
        board.wanted.first().filter(|_| board.list == list).cloned()
    }

    /// Stores the picture that was next in the list with this number; `image` is `None` if it could not be painted.
    /// Returns whether the list is still wanted.
    fn put(&self, list: u64, image: Option<ColorImage>) -> bool {
        let mut board = self.board();
        if board.list != list || board.wanted.is_empty() {
            return false;
        }
        let name = board.wanted.remove(0).name;
        board.painted.extend(image.map(|image| (name, image)));
        true
    }

    /// Leaves the rest of a list without pictures, if it is wanted still.
    fn give_list_up(&self, list: u64) {
        let mut board = self.board();
        if board.list == list {
            board.wanted.clear();
        }
    }

    /// Paints a list. The driver is opened for the list and closed after it, so that the scene is not in memory twice
    /// (here and for the window) without need. None if there is no driver, or a shader is broken.
    fn paint_list(&self, list: u64, driver: Driver, wake: &dyn Fn()) -> Option<()> {
        let shaders = self.board().shaders.clone();
        let mut renderer = open_renderer(driver, &shaders).ok()?;
        let mut preparer = Preparer::default();
        while let Some(wanted) = self.next(list) {
            let give_up = || self.board().list != list;
            let image = paint(&mut preparer, &mut renderer, &wanted, &give_up);
            if self.put(list, image) {
                wake();
            }
        }
        Some(())
    }
}

/// Paints one picture; none if that was given up or went wrong.
fn paint(
    preparer: &mut Preparer,
    renderer: &mut Renderer,
    wanted: &Wanted,
    give_up: &(dyn Fn() -> bool + Sync),
) -> Option<ColorImage> {
    let options = PrepareOptions {
        give_up,
        memory_bytes: impasto_scene::memory::available_bytes().map(|bytes| bytes / SHARE),
        only_shown: true,
        ..PrepareOptions::default()
    };
    let painting = preparer.prepare_with(Arc::new((wanted.scene)()?), &options).ok()?;
    let scene = painting.scene();
    let camera = motion::camera_at(scene, wanted.frame);
    let size_px = small_size([scene.size.0, scene.size.1]);
    let options =
        FrameOptions { shot_height_px: Some(LARGER * size_px[1] as f32), ..FrameOptions::new(size_px) };
    let mut frame = painting.bare(&camera, wanted.frame, &options);
    frame.lay(painting.strokes(&camera, wanted.frame, &options, None));
    let picture = renderer.render_unless(&frame, &mut || give_up()).ok()??;
    let size = picture.size_px.map(|side| side as usize);
    Some(ColorImage::from_rgba_unmultiplied(size, &picture.rgba8))
}

/// The size of the small picture for a scene of this size, pixels.
fn small_size([width, height]: [u32; 2]) -> [u32; 2] {
    let [width, height] = [width.max(1), height.max(1)].map(f64::from);
    let share = (f64::from(MOST_PX[0]) / width).min(f64::from(MOST_PX[1]) / height);
    [width, height].map(|side| (side * share).round().max(1.0) as u32)
}
