//! Where measuring happens: versions of the scene, a renderer, and frames that have been drawn.

use std::collections::HashMap;
use std::rc::Rc;
use std::sync::Arc;

use impasto_gl_render::context::{OpenOptions, open};
use impasto_gl_render::{MotionPixels, Picture, ReferencePixels, Renderer};
use impasto_painting::{Frame, FrameOptions, Painting, Preparer, Rotation};
use impasto_scene::loaded::LoadedScene;
use impasto_scene::motion::{self, CameraPose};

use crate::looks::Look;
use crate::options::{MeasureError, MeasureOptions};
use crate::plane::Plane;
use crate::strokes::{SeenStrokes, seen};

/// A frame that was drawn, with what was read back of it.
pub struct Shown {
    /// What was drawn.
    pub frame: Frame,
    /// The picture's luma.
    pub luma: Plane,
    /// Its strokes, as drawn.
    pub strokes: SeenStrokes,
    /// What is where.
    pub reference: ReferencePixels,
    /// Alpha of the paint.
    pub paint_alpha: Vec<f32>,
}

/// A scene on the bench.
pub struct Studio<'a> {
    /// The scene as it is.
    pub loaded: &'a Arc<LoadedScene>,
    /// Width and height of the pictures.
    pub size_px: [u32; 2],
    /// How many pairs of frames are looked at.
    pub pairs_wanted: usize,
    /// What a person should know.
    pub warnings: Vec<String>,
    /// Draws.
    pub renderer: Renderer,
    preparer: Preparer,
    paintings: HashMap<Look, Rc<Painting>>,
    shown: HashMap<(Look, RotationKey, u64), Rc<Shown>>,
}

/// [`Rotation`] as a key.
type RotationKey = u8;

fn rotation_key(rotation: Rotation) -> RotationKey {
    match rotation {
        Rotation::On => 0,
        Rotation::Off => 1,
        Rotation::Random => 2,
        Rotation::Mapped => 3,
    }
}

impl<'a> Studio<'a> {
    /// Opens a renderer for a scene.
    ///
    /// # Errors
    /// Where there is no driver.
    pub fn open(loaded: &'a Arc<LoadedScene>, options: &MeasureOptions) -> Result<Self, MeasureError> {
        let renderer = Renderer::new(open(options.driver, &OpenOptions::default())?)?;
        let (width, height) = loaded.scene.size;
        let half = [width, height].map(|side| (side / 4 * 2).max(2));
        Ok(Self {
            loaded,
            size_px: options.size_px.unwrap_or(half),
            pairs_wanted: options.pairs.max(1),
            warnings: Vec::new(),
            renderer,
            preparer: Preparer::default(),
            paintings: HashMap::new(),
            shown: HashMap::new(),
        })
    }

    /// The scene in this version, prepared.
    ///
    /// # Errors
    /// Where that fails.
    pub fn painting(&mut self, look: Look) -> Result<Rc<Painting>, MeasureError> {
        if let Some(painting) = self.paintings.get(&look) {
            return Ok(Rc::clone(painting));
        }
        let counts = match look {
            Look::SteadyTwice => self.painting(Look::Steady)?.particle_counts(),
            _ => Vec::new(),
        };
        let version = Arc::new(look.of(self.loaded, &counts));
        let painting = Rc::new(self.preparer.prepare(version)?);
        self.paintings.insert(look, Rc::clone(&painting));
        Ok(painting)
    }

    /// The reference frame.
    pub fn reference_frame(&self) -> f64 {
        motion::referred_to(&self.loaded.scene, &self.loaded.scene.reference).1
    }

    /// The camera at the reference frame.
    pub fn reference_camera(&self) -> CameraPose {
        motion::referred_to(&self.loaded.scene, &self.loaded.scene.reference).0
    }

    /// How frames are seen.
    pub fn frame_options(&self, rotation: Rotation) -> FrameOptions {
        FrameOptions { rotation, ..FrameOptions::new(self.size_px) }
    }

    /// Pairs of neighbouring frames, evenly over the shot; none where it has one frame.
    pub fn pairs(&self) -> Vec<[f64; 2]> {
        let timeline = &self.loaded.scene.timeline;
        let starts = timeline.last.saturating_sub(timeline.first).max(0);
        let count = (starts as usize).min(self.pairs_wanted);
        let start = |index: usize| {
            let share = if count > 1 { index as f64 / (count - 1) as f64 } else { 0.0 };
            timeline.first as f64 + (share * (starts - 1) as f64).round()
        };
        (0..count).map(start).map(|first| [first, first + 1.0]).collect()
    }

    /// The first frames of the pairs; the only frame of a shot that has one.
    pub fn frames(&self) -> Vec<f64> {
        let pairs = self.pairs();
        if pairs.is_empty() {
            vec![self.loaded.scene.timeline.first as f64]
        } else {
            pairs.iter().map(|pair| pair[0]).collect()
        }
    }

    /// A frame of the shot in this version, drawn; kept until [`Studio::forget`].
    ///
    /// # Errors
    /// Where it cannot be prepared or drawn.
    pub fn show(&mut self, look: Look, frame: f64, rotation: Rotation) -> Result<Rc<Shown>, MeasureError> {
        let key = (look, rotation_key(rotation), frame.to_bits());
        if let Some(shown) = self.shown.get(&key) {
            return Ok(Rc::clone(shown));
        }
        let painting = self.painting(look)?;
        let shown = Rc::new(self.draw(painting.at(frame, &self.frame_options(rotation)))?);
        self.shown.insert(key, Rc::clone(&shown));
        Ok(shown)
    }

    /// The reference pose in this version, seen by another camera and drawn.
    ///
    /// # Errors
    /// As [`Studio::show`].
    pub fn show_from(&mut self, look: Look, camera: &CameraPose) -> Result<Shown, MeasureError> {
        let painting = self.painting(look)?;
        let options = self.frame_options(Rotation::On);
        self.draw(painting.seen_by(camera, self.reference_frame(), &options))
    }

    /// Draws a frame.
    ///
    /// # Errors
    /// Where the driver refuses.
    pub fn draw(&mut self, frame: Frame) -> Result<Shown, MeasureError> {
        let picture = self.renderer.render(&frame)?;
        let strokes = seen(&frame, &self.renderer.resolved_strokes());
        Ok(Shown {
            luma: Plane::luma(&picture),
            strokes,
            reference: self.renderer.read_reference(),
            paint_alpha: self.renderer.read_paint().iter().map(|paint| paint[3]).collect(),
            frame,
        })
    }

    /// The bytes of a frame.
    ///
    /// # Errors
    /// Where the driver refuses.
    pub fn picture(&mut self, frame: &Frame) -> Result<Picture, MeasureError> {
        Ok(self.renderer.render(frame)?)
    }

    /// Where the surface points of one frame are in another.
    ///
    /// # Errors
    /// Where the driver refuses.
    pub fn motion(&mut self, now: &Frame, then: &Frame) -> Result<MotionPixels, MeasureError> {
        Ok(self.renderer.motion(now, then)?)
    }

    /// Lets go of drawn frames, except those of the shot on a board, which several metrics use.
    pub fn forget(&mut self) {
        self.shown.retain(|(look, rotation, _), _| *look == Look::Board && *rotation == 0);
    }
}
