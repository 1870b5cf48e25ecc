//! What the protocols work with: the scene and its prepared versions, a renderer, and frames already drawn.

use std::collections::{BTreeSet, HashMap};
use std::rc::Rc;
use std::sync::Arc;

use impasto_gl_render::context::{OpenOptions, open};
use impasto_gl_render::{MotionPixels, Picture, ReferencePixels, Renderer};
use impasto_painting::{
    Frame, FrameOptions, Painting, PrepareError, PrepareOptions, Preparer, Rotation, SeenFrom,
};
use impasto_scene::document::Style;
use impasto_scene::loaded::LoadedScene;
use impasto_scene::motion::{self, CameraPose};

use crate::options::{MeasureError, MeasureOptions};
use crate::plane::Plane;
use crate::shot::WholeShot;
use crate::strokes::{StrokesByKey, strokes_by_key};
use crate::versions::SceneVersion;

/// Prepares for views from anywhere: some protocols look from where the scene's own camera never is.
const ANYWHERE: PrepareOptions<'static> = PrepareOptions {
    give_up: &|| false,
    memory_bytes: None,
    peak_bytes: &|| None,
    kept: None,
    seen_from: SeenFrom::Anywhere,
    only_shown: false,
};

/// Prepares a scene to be seen from anywhere.
///
/// # Errors
/// When preparing fails.
pub fn prepare_anywhere(loaded: Arc<LoadedScene>) -> Result<Painting, PrepareError> {
    Preparer::default().prepare_with(loaded, &ANYWHERE)
}

/// A drawn frame with what was read back from the renderer.
pub struct DrawnFrame {
    /// The frame.
    pub frame: Frame,
    /// The picture's luma.
    pub luma: Plane,
    /// Its strokes, as drawn.
    pub strokes: StrokesByKey,
    /// Body and depth per pixel.
    pub reference: ReferencePixels,
    /// Alpha of the paint per pixel.
    pub paint_alpha: Vec<f32>,
}

/// A scene that is being measured.
pub struct MeasureContext<'a> {
    /// The scene as it is.
    pub loaded: &'a Arc<LoadedScene>,
    /// Width and height of the pictures.
    pub size_px: [u32; 2],
    /// How many pairs of frames are measured, at most.
    pub pairs_wanted: usize,
    /// Warnings about the scene.
    pub warnings: Vec<String>,
    /// The renderer that draws the frames.
    pub renderer: Renderer,
    preparer: Preparer,
    paintings: HashMap<SceneVersion, Rc<Painting>>,
    drawn: HashMap<(SceneVersion, RotationKey, u64), Rc<DrawnFrame>>,
    /// What a pass over every frame of the shot found; `None` before such a pass.
    pub whole_shot: Option<Rc<WholeShot>>,
}

/// A [`Rotation`] as a number, for the keys of cached frames.
type RotationKey = u8;

fn rotation_key(rotation: Rotation) -> RotationKey {
    match rotation {
        Rotation::On => 0,
        Rotation::Off => 1,
        Rotation::Random => 2,
        Rotation::Mapped => 3,
    }
}

impl<'a> MeasureContext<'a> {
    /// Opens a renderer for a scene.
    ///
    /// # Errors
    /// When no driver can be opened.
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
            drawn: HashMap::new(),
            whole_shot: None,
        })
    }

    /// The scene in this version, prepared.
    ///
    /// # Errors
    /// When preparing fails.
    pub fn painting(&mut self, version: SceneVersion) -> Result<Rc<Painting>, MeasureError> {
        if let Some(painting) = self.paintings.get(&version) {
            return Ok(Rc::clone(painting));
        }
        let counts = match version {
            SceneVersion::NoAngleChanceTwice => self.painting(SceneVersion::NoAngleChance)?.particle_counts(),
            _ => Vec::new(),
        };
        let scene = Arc::new(version.of(self.loaded, &counts));
        let painting = Rc::new(self.preparer.prepare_with(scene, &ANYWHERE)?);
        self.paintings.insert(version, Rc::clone(&painting));
        Ok(painting)
    }

    /// The frame of the scene's reference view: this view shows the objects as they stand in that frame.
    pub fn reference_frame(&self) -> f64 {
        motion::referred_to(&self.loaded.scene, &self.loaded.scene.reference).1
    }

    /// The camera of the scene's reference view.
    pub fn reference_camera(&self) -> CameraPose {
        motion::referred_to(&self.loaded.scene, &self.loaded.scene.reference).0
    }

    /// Options for frames of the size that is measured.
    pub fn frame_options(&self, rotation: Rotation) -> FrameOptions {
        FrameOptions { rotation, ..FrameOptions::new(self.size_px) }
    }

    /// Pairs of neighbouring frames, spread evenly over the shot; none if the shot has only one frame.
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

    /// The first frame of each pair; if the shot has only one frame, that one.
    pub fn frames(&self) -> Vec<f64> {
        let pairs = self.pairs();
        if pairs.is_empty() {
            vec![self.loaded.scene.timeline.first as f64]
        } else {
            pairs.iter().map(|pair| pair[0]).collect()
        }
    }

    /// A drawn frame of the shot in this version; cached until [`MeasureContext::forget`].
    ///
    /// # Errors
    /// When it cannot be prepared or drawn.
    pub fn drawn_frame(
        &mut self,
        version: SceneVersion,
        frame: f64,
        rotation: Rotation,
    ) -> Result<Rc<DrawnFrame>, MeasureError> {
        let drawn = self.drawn_once(version, frame, rotation)?;
        self.drawn.insert((version, rotation_key(rotation), frame.to_bits()), Rc::clone(&drawn));
        Ok(drawn)
    }

    /// As [`MeasureContext::drawn_frame`], but the frame is not added to the cache: all frames of a shot would not fit.
    ///
    /// # Errors
    /// As [`MeasureContext::drawn_frame`].
    pub fn drawn_once(
        &mut self,
        version: SceneVersion,
        frame: f64,
        rotation: Rotation,
    ) -> Result<Rc<DrawnFrame>, MeasureError> {
        if let Some(drawn) = self.drawn.get(&(version, rotation_key(rotation), frame.to_bits())) {
            return Ok(Rc::clone(drawn));
        }
        let painting = self.painting(version)?;
        Ok(Rc::new(self.draw(painting.at(frame, &self.frame_options(rotation)))?))
    }

    /// The reference pose in this version, drawn as another camera sees it.
    ///
    /// # Errors
    /// As [`MeasureContext::drawn_frame`].
    pub fn drawn_view(
        &mut self,
        version: SceneVersion,
        camera: &CameraPose,
    ) -> Result<DrawnFrame, MeasureError> {
        let painting = self.painting(version)?;
        let options = self.frame_options(Rotation::On);
        self.draw(painting.seen_by(camera, self.reference_frame(), &options))
    }

    /// What [`Painting::fault_words`] tells of each version that was prepared (point caches that could not be read);
    /// each text once.
    pub fn faults(&self) -> BTreeSet<String> {
        self.paintings.values().filter_map(|painting| painting.fault_words()).collect()
    }

    /// Draws a frame.
    ///
    /// # Errors
    /// When drawing fails.
    pub fn draw(&mut self, frame: Frame) -> Result<DrawnFrame, MeasureError> {
        let picture = self.renderer.render(&frame)?;
        let strokes = strokes_by_key(&frame, &self.renderer.resolved_strokes());
        Ok(DrawnFrame {
            luma: Plane::luma(&picture),
            strokes,
            reference: self.renderer.read_reference(),
            paint_alpha: self.renderer.read_paint().iter().map(|paint| paint[3]).collect(),
            frame,
        })
    }

    /// The picture of a frame.
    ///
    /// # Errors
    /// When drawing fails.
    pub fn picture(&mut self, frame: &Frame) -> Result<Picture, MeasureError> {
        Ok(self.renderer.render(frame)?)
    }

    /// Luma of a frame's plain render ([`Style::Reference`]), from which strokes take their colours.
    ///
    /// # Errors
    /// When drawing fails.
    pub fn plain_luma(&mut self, frame: &Frame) -> Result<Plane, MeasureError> {
        let plain = Frame { style: Style::Reference, ..frame.clone() };
        Ok(Plane::luma(&self.picture(&plain)?))
    }

    /// For each pixel of the frame `now`, the offset to where its surface point is in the frame `then`.
    ///
    /// # Errors
    /// When drawing fails.
    pub fn motion(&mut self, now: &Frame, then: &Frame) -> Result<MotionPixels, MeasureError> {
        Ok(self.renderer.motion(now, then)?)
    }

    /// Drops the cached frames, except those of [`SceneVersion::Board`] whose strokes turn ([`Rotation::On`]): several
    /// metrics use these.
    pub fn forget(&mut self) {
        self.drawn.retain(|(version, rotation, _), _| *version == SceneVersion::Board && *rotation == 0);
    }
}
