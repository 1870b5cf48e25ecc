//! The thread that prepares scenes and draws pictures, so that the window never waits: the window hands it what to show
//! and polls for results.
//!
//! ```text
//! Worker::show(Job) ─▶ mailbox (the latest job) ─▶ prepare ─▶ draft ─▶ wait ─▶ exact ─▶ film ─▶ tray ─▶ Worker::poll
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
use impasto_scene::document::Lens;
use impasto_scene::loaded::LoadedScene;
use impasto_scene::motion::CameraPose;

mod ahead;
mod draft;
mod editor_views;
mod film;
mod film_file;
mod mailbox;
mod paint_worker;
#[cfg(test)]
mod tests;
mod view_frame;

use mailbox::Mailbox;

/// How long closing waits for the thread; after that it is left to end by itself.
const CLOSING: Duration = Duration::from_millis(1500);

/// A scene and the views of it to draw.
#[derive(Clone, Debug)]
pub struct Job {
    /// The scene.
    pub loaded: Arc<LoadedScene>,
    /// The version of the scene. While it stays the same, the scene is prepared again only for views in which large
    /// surfaces may lack particles.
    pub serial: u64,
    /// The views, each drawn as one picture.
    pub views: Vec<ViewJob>,
}

/// What will likely be asked for after a job.
#[derive(Clone, Debug, Default)]
pub struct Later {
    /// During playback, the same views at the next frame: computed while those of the job are drawn.
    pub ahead: Vec<ViewJob>,
    /// At rest, the views of the film's frames, in the order in which they would be played from now on. They are drawn
    /// exactly and kept, once the views of the job are exact.
    pub film: Vec<ViewJob>,
}

/// One picture of a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct ViewJob {
    /// The camera. Its lens has already been widened from the shot to the whole picture.
    pub camera: CameraPose,
    /// The frame, which need not be whole.
    pub frame: f64,
    /// Width and height of the exact picture, in pixels.
    pub size_px: [u32; 2],
    /// Height of the shot within the picture, in pixels, > 0; strokes are sized for it.
    pub shot_height_px: f32,
    /// How the scene is shown: painted, shaded, or coloured by trust.
    pub shading: Shading,
    /// Icons of lights over the picture. A size of [`BillboardSize::Pixels`] counts pixels of the exact picture.
    pub lights: Vec<LightBillboard>,
    /// Whether the next view will follow at once (a drag or playback is under way): then a draft is enough.
    pub moving: bool,
}

impl ViewJob {
    /// The camera with the lens of the shot, before it was widened to the whole picture.
    pub(crate) fn shot_camera(&self) -> CameraPose {
        let more = f64::from(self.size_px[1].max(1)) / f64::from(self.shot_height_px.max(1.0));
        let lens = match self.camera.lens {
            Lens::Perspective { fov_y_deg, near, far } => {
                let slope = (0.5 * fov_y_deg.to_radians()).tan() / more;
                Lens::Perspective { fov_y_deg: 2.0 * slope.atan().to_degrees(), near, far }
            }
            Lens::Orthographic { height, near, far } => {
                Lens::Orthographic { height: height / more, near, far }
            }
        };
        CameraPose { lens, shift: self.camera.shift * more, ..self.camera.clone() }
    }

    /// Whether both views look the same; `moving` does not count.
    pub fn looks_like(&self, other: &Self) -> bool {
        *self == Self { moving: self.moving, ..other.clone() }
    }

    /// Whether both views look the same but for the icons of lights; `moving` does not count.
    pub(crate) fn differs_in_lights_alone(&self, other: &Self) -> bool {
        *self == Self { moving: self.moving, lights: self.lights.clone(), ..other.clone() }
    }

    /// The icons of lights, sized for a draft of `size_px` pixels.
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

/// What the thread reports.
pub enum Report {
    /// OpenGL is open, with this driver.
    Opened(ContextReport),
    /// A scene is prepared: its painting and picker, and its serial.
    Prepared(Box<(Painting, Picker)>, u64),
    /// A picture.
    Picture(Picture),
    /// The frames of the film whose exact pictures are kept, in order, and the scene's serial.
    Finished(Vec<i64>, u64),
    /// What went wrong, in words for the user. The thread goes on.
    Failed(String),
}

/// A picture of one of a job's views.
pub struct Picture {
    /// Index of the view in its job.
    pub index: usize,
    /// The view that was drawn. During playback it may be one frame earlier than the job's.
    pub view: ViewJob,
    /// The serial of its scene.
    pub serial: u64,
    /// The pixels. A draft may have fewer than the view asked for.
    pub image: Arc<ColorImage>,
    /// Whether it is drawn as for a file. False for a draft, and for a picture of the film that is shown until the
    /// icons of lights are drawn.
    pub exact: bool,
    /// How many strokes it has.
    pub strokes: usize,
    /// How many of them each region has, in the order of the scene's regions; the last number is of strokes in no
    /// region.
    pub strokes_of: Vec<usize>,
    /// How long it took to draw, seconds.
    pub seconds: f64,
}

/// A thread that prepares and draws. Dropping it ends the thread.
pub struct Worker {
    mailbox: Arc<Mailbox>,
    thread: Option<JoinHandle<()>>,
}

impl Worker {
    /// Starts the thread. `wake` is called on it whenever there is something to poll.
    ///
    /// # Errors
    /// When the system gives no thread.
    pub fn new(driver: Driver, wake: impl Fn() + Send + 'static) -> std::io::Result<Self> {
        let mailbox = Arc::new(Mailbox::default());
        let theirs = Arc::clone(&mailbox);
        let thread = std::thread::Builder::new()
            .name("painting".to_owned())
            .spawn(move || paint_worker::run(&theirs, driver, &wake))?;
        Ok(Self { mailbox, thread: Some(thread) })
    }

    /// Shows this job from now on. An earlier job that has not begun is dropped. One that is under way gives up its
    /// film, and exact pictures that take long to draw.
    pub fn show(&self, job: Job) {
        self.mailbox.put(job, Later::default());
    }

    /// As [`Worker::show`], with what will likely be asked for after that.
    pub fn show_before(&self, job: Job, later: Later) {
        self.mailbox.put(job, later);
    }

    /// Draws everything with these shaders from the next job on. If one of them is broken, that is reported and the
    /// previous shaders stay in use.
    pub fn replace_shaders(&self, texts: ShaderTexts) {
        self.mailbox.put_shaders(texts);
    }

    /// Gives up preparing the last job: its scene is not painted, and the pictures shown so far stay until another job
    /// comes.
    pub fn stop_preparing(&self) {
        self.mailbox.stop_preparing();
    }

    /// The reports since the last call: the newest picture of each view, the first few failures, and of every other
    /// kind the newest report.
    pub fn poll(&self) -> Vec<Report> {
        self.mailbox.collect()
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        self.mailbox.close();
        if self.mailbox.wait_for_end(CLOSING)
            && let Some(thread) = self.thread.take()
        {
            // Its panics have been reported already.
            let _ = thread.join();
        }
    }
}
