//! Paints a small picture of the scene with each preset, on a thread of its own, while the list of presets is open.
//!
//! ```text
//! want([(gouache, scene with gouache), …]) ─▶ thread: the first without a picture ─▶ prepare ─▶ draw ─▶ take()
//! ```

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};

use egui::ColorImage;
use impasto_gl_render::context::{self, Driver, OpenOptions};
use impasto_gl_render::{Renderer, ShaderTexts};
use impasto_painting::{FrameOptions, PrepareOptions, Preparer};
use impasto_scene::loaded::LoadedScene;
use impasto_scene::motion;

#[cfg(test)]
mod tests;

/// The longest sides of a picture, in pixels.
const MOST_PX: [u32; 2] = [288, 162];

/// Strokes are this much larger than in the scene's picture, so that they can be told apart in a small one.
const LARGER: u32 = 3;

/// A scene to paint, as it is with a preset.
#[derive(Clone)]
pub struct Wanted {
    /// The name of the picture.
    pub name: String,
    /// The scene.
    pub loaded: Arc<LoadedScene>,
    /// The frame, seen by the shot's camera.
    pub frame: f64,
}

/// Paints the pictures. Dropping this ends its thread.
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
    /// What is not painted yet, the first first.
    wanted: Vec<Wanted>,
    /// They replace the program's own.
    shaders: ShaderTexts,
    painted: Vec<(String, ColorImage)>,
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
        let run = move || {
            // Without pictures, presets are chosen by their names: what goes wrong here is of no matter.
            let _ = catch_unwind(AssertUnwindSafe(|| theirs.run(driver, &wake)));
        };
        std::thread::Builder::new().name("preset pictures".to_owned()).spawn(run)?;
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
        board.ended = true;
        board.wanted.clear();
        drop(board);
        self.shared.changed.notify_all();
    }
}

impl Shared {
    /// Ignores poisoning: no code that holds the lock can panic and leave the board half changed.
    fn board(&self) -> MutexGuard<'_, Board> {
        self.board.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits until something is wanted; false once the window is gone.
    fn waits(&self) -> bool {
        let idle = |board: &mut Board| board.wanted.is_empty() && !board.ended;
        let waited = self.changed.wait_while(self.board(), idle);
        !waited.unwrap_or_else(PoisonError::into_inner).ended
    }

    /// The renderer for the list that is wanted.
    fn renderer(&self, driver: Driver) -> Option<Renderer> {
        let shaders = self.board().shaders.clone();
        let mut renderer = Renderer::new(context::open(driver, &OpenOptions::default()).ok()?).ok()?;
        if !shaders.is_empty() {
            renderer.replace_shaders(&shaders).ok()?;
        }
        Some(renderer)
    }

    /// What is wanted next, and the number of its list.
    fn next(&self) -> Option<(u64, Wanted)> {
        let board = self.board();
        Some((board.list, board.wanted.first()?.clone()))
    }

    /// Takes a picture of the list with this number, or the word that there is none. Returns whether it is wanted still.
    fn put(&self, list: u64, name: String, image: Option<ColorImage>) -> bool {
        let mut board = self.board();
        let is_wanted = board.list == list && !board.wanted.is_empty();
        if is_wanted {
            board.wanted.remove(0);
            board.painted.extend(image.map(|image| (name, image)));
        }
        is_wanted
    }

    fn run(&self, driver: Driver, wake: &dyn Fn()) {
        while self.waits() {
            // Opened for each list and closed after it: a second scene in memory is not kept for nothing.
            let Some(mut renderer) = self.renderer(driver) else {
                self.board().wanted.clear();
                continue;
            };
            let mut preparer = Preparer::default();
            while let Some((list, wanted)) = self.next() {
                let give_up = || self.board().list != list;
                let image = paint(&mut preparer, &mut renderer, &wanted, &give_up);
                if self.put(list, wanted.name, image) {
                    wake();
                }
            }
        }
    }
}

/// Paints one picture; none if that was given up or went wrong.
fn paint(
    preparer: &mut Preparer,
    renderer: &mut Renderer,
    wanted: &Wanted,
    give_up: &(dyn Fn() -> bool + Sync),
) -> Option<ColorImage> {
    let mut loaded = (*wanted.loaded).clone();
    let (width, height) = loaded.scene.size;
    loaded.scene.size = ((width / LARGER).max(1), (height / LARGER).max(1));
    let options = PrepareOptions {
        give_up,
        memory_bytes: impasto_scene::memory::available_bytes(),
        ..PrepareOptions::default()
    };
    let painting = preparer.prepare_with(Arc::new(loaded), &options).ok()?;
    let camera = motion::camera_at(painting.scene(), wanted.frame);
    let options = FrameOptions::new(small_size([width, height]));
    let mut frame = painting.bare(&camera, wanted.frame, &options);
    frame.lay(painting.strokes(&camera, wanted.frame, &options, None));
    let picture = renderer.render_unless(&frame, &mut || give_up()).ok()??;
    let size = picture.size_px.map(|side| side as usize);
    Some(ColorImage::from_rgba_premultiplied(size, &picture.rgba8))
}

/// The size of the picture of a scene of this size, pixels.
fn small_size([width, height]: [u32; 2]) -> [u32; 2] {
    let [width, height] = [width.max(1), height.max(1)].map(f64::from);
    let share = (f64::from(MOST_PX[0]) / width).min(f64::from(MOST_PX[1]) / height);
    [width, height].map(|side| (side * share).round().max(1.0) as u32)
}
