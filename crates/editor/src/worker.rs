//! The thread that prepares and draws. The window hands it what to show and takes what has been done since; it never waits.
//!
//! ```text
//! Worker::show(Job) ─▶ desk (one job, the latest) ─▶ prepare ─▶ draft ─▶ rest ─▶ exact ─▶ tray ─▶ Worker::poll
//! ```

use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::Duration;

use egui::ColorImage;
use impasto_editor_model::picking::Picker;
use impasto_editor_model::session::Shading;
use impasto_gl_render::ShaderTexts;
use impasto_gl_render::context::{ContextReport, Driver};
use impasto_gl_render::{BillboardSize, LightBillboard};
use impasto_painting::Painting;
use impasto_scene::loaded::LoadedScene;
use impasto_scene::motion::CameraPose;

mod ahead;
mod desk;
mod draft;
mod paint_worker;
#[cfg(test)]
mod tests;
mod view_frame;

use desk::Desk;

/// How long closing waits for the thread; after that it is left to end by itself.
const CLOSING: Duration = Duration::from_millis(1500);

/// What is to be seen.
#[derive(Clone, Debug)]
pub struct Job {
    /// The scene.
    pub loaded: Arc<LoadedScene>,
    /// Counts the scene's versions: where it is as it was, nothing is prepared anew.
    pub serial: u64,
    /// One picture each.
    pub views: Vec<ViewJob>,
}

/// One picture of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewJob {
    /// Where from; its lens takes in the whole picture.
    pub camera: CameraPose,
    /// The frame, which need not be whole.
    pub frame: f64,
    /// Width and height of the exact picture, in pixels.
    pub size_px: [u32; 2],
    /// How high the shot is in the picture, in pixels, > 0; strokes are sized for it.
    pub shot_height_px: f32,
    /// What is shown of the scene.
    pub shading: Shading,
    /// Lights that are shown over the picture; sizes in pixels are those of the exact picture.
    pub lights: Vec<LightBillboard>,
    /// Whether more of its kind will follow at once (a hand is on it): then a draft is enough.
    pub moving: bool,
}

impl ViewJob {
    /// Whether both look the same: a hand that is on it changes nothing that is seen.
    pub fn looks_like(&self, other: &Self) -> bool {
        *self == Self { moving: self.moving, ..other.clone() }
    }

    /// Whether both look the same but for the lights over them.
    pub(crate) fn differs_in_lights_alone(&self, other: &Self) -> bool {
        *self == Self { moving: self.moving, lights: self.lights.clone(), ..other.clone() }
    }

    /// The lights in a picture of fewer pixels.
    pub(crate) fn lights_in(&self, size_px: [u32; 2]) -> Vec<LightBillboard> {
        let share = size_px[1] as f32 / self.size_px[1].max(1) as f32;
        let sized = |light: &LightBillboard| match light.size {
            BillboardSize::Pixels(half_px) => {
                LightBillboard { size: BillboardSize::Pixels(half_px * share), ..*light }
            }
            BillboardSize::World(_) => *light,
        };
        self.lights.iter().map(sized).collect()
    }
}

/// What the thread has to tell.
pub enum Report {
    /// The driver that draws.
    Opened(ContextReport),
    /// A scene is prepared: direction marks and picking may use it, with what picking needs of it. With its serial.
    Prepared(Box<(Painting, Picker)>, u64),
    /// A picture.
    Picture(Picture),
    /// What went wrong, in words for people. The thread goes on.
    Failed(String),
}

/// A picture of one of a job's views.
pub struct Picture {
    /// Index of the view in its job.
    pub index: usize,
    /// The view.
    pub view: ViewJob,
    /// The serial of its scene.
    pub serial: u64,
    /// The pixels; fewer than the view asked for in a draft.
    pub image: Arc<ColorImage>,
    /// Whether it is what a file would get, not a draft.
    pub exact: bool,
    /// How many strokes it has.
    pub strokes: usize,
    /// How many of them each region has, by its place in the scene; the last are those of no region.
    pub strokes_of: Vec<usize>,
    /// How long it took to draw, seconds.
    pub seconds: f64,
}

/// A thread that prepares and draws. Dropping it ends the thread.
pub struct Worker {
    desk: Arc<Desk>,
    thread: Option<JoinHandle<()>>,
}

impl Worker {
    /// Starts the thread. `wake` is called on it whenever there is something to poll.
    ///
    /// # Errors
    /// When the system gives no thread.
    pub fn new(driver: Driver, wake: impl Fn() + Send + 'static) -> std::io::Result<Self> {
        let desk = Arc::new(Desk::default());
        let theirs = Arc::clone(&desk);
        let thread = std::thread::Builder::new()
            .name("painting".to_owned())
            .spawn(move || paint_worker::run(&theirs, driver, &wake))?;
        Ok(Self { desk, thread: Some(thread) })
    }

    /// Shows this from now on. A job that was not begun is dropped; of the one that is being worked on, the exact pictures are
    /// given up.
    pub fn show(&self, job: Job) {
        self.desk.put(job, Vec::new());
    }

    /// As [`Worker::show`], of a film that plays: `ahead` are the same views as they will likely be asked for next.
    pub fn play(&self, job: Job, ahead: Vec<ViewJob>) {
        self.desk.put(job, ahead);
    }

    /// From the next job on, everything is drawn with these shaders; where one of them is broken that is told, and what there was
    /// goes on.
    pub fn replace_shaders(&self, texts: ShaderTexts) {
        self.desk.put_shaders(texts);
    }

    /// Gives up preparing what is to be shown now: what was shown before stays, until something else is to be shown.
    pub fn stop_preparing(&self) {
        self.desk.stop_preparing();
    }

    /// Everything that has come since the last call; of several pictures of one view, the newest.
    pub fn poll(&self) -> Vec<Report> {
        self.desk.collect()
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        self.desk.close();
        if self.desk.wait_for_end(CLOSING)
            && let Some(thread) = self.thread.take()
        {
            // Its panics have been told already.
            let _ = thread.join();
        }
    }
}
