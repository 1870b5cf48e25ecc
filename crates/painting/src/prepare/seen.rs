//! From where a painting will be seen: large surfaces have particles only where a view needs them.

use std::sync::OnceLock;

use glam::DAffine3;
use impasto_scene::document::Scene;
use impasto_scene::motion::{self, CameraPose};

use crate::frame_options::FrameOptions;
use crate::particle_count::Sighting;
use crate::view::PictureView;

/// From where a painting will be seen.
#[derive(Clone, Copy, Debug)]
pub enum SeenFrom<'a> {
    /// By the scene's camera, at every whole frame of its timeline and of its keys. Where no view looks, large surfaces
    /// have only few particles.
    Shot {
        /// Further cameras, each at a frame.
        also: &'a [(CameraPose, f64)],
        /// How far from the middle of the picture there are particles, in half sizes of the picture: at least
        /// [`SeenFrom::MARGIN`].
        margin: f64,
    },
    /// For a drag: unchanged surfaces keep their particles, whatever views these were made for; others are made as for
    /// [`SeenFrom::SHOT`].
    AsBefore,
    /// From anywhere.
    Anywhere,
}

impl SeenFrom<'_> {
    /// The usual margin: an editor shows what lies round the shot, and pictures may be wider than the scene states.
    pub const MARGIN: f64 = 1.5;

    /// Greater margins are cut to this.
    pub const MOST_MARGIN: f64 = 8.0;

    /// By the scene's camera alone.
    pub const SHOT: Self = Self::Shot { also: &[], margin: Self::MARGIN };

    /// What pictures of the scene with these options need: those that are much wider than the scene states, or whose
    /// strokes keep their size in larger pictures, need particles where the scene's own pictures do not.
    pub fn for_options(scene: &Scene, options: &FrameOptions) -> Self {
        let aspect = |[width, height]: [u32; 2]| f64::from(width.max(1)) / f64::from(height.max(1));
        let wider = aspect(options.size_px) / aspect([scene.size.0, scene.size.1]);
        if options.keep_stroke_px || wider > Self::MARGIN { Self::Anywhere } else { Self::SHOT }
    }
}

/// With more frames than this, or with more poses of objects at all frames, a painting is made to be seen from
/// anywhere.
const MOST_FRAMES: usize = 4096;
const MOST_POSES: usize = 200_000;

/// A view, with the poses of all objects.
type View = (PictureView, Vec<DAffine3>);

/// All views of a scene, found when they are first asked for.
pub(crate) struct Seen<'a> {
    scene: &'a Scene,
    from: SeenFrom<'a>,
    views: OnceLock<Option<Vec<View>>>,
}

impl<'a> Seen<'a> {
    pub(crate) fn new(scene: &'a Scene, from: SeenFrom<'a>) -> Self {
        Self { scene, from, views: OnceLock::new() }
    }

    /// The views; `None` if there may be others.
    pub(crate) fn views(&self) -> Option<&[View]> {
        let find = || {
            let also: &[(CameraPose, f64)] = match self.from {
                SeenFrom::Shot { also, .. } => also,
                SeenFrom::AsBefore => &[],
                SeenFrom::Anywhere => return None,
            };
            let scene = self.scene;
            let size_px = [scene.size.0, scene.size.1];
            let [first, last] = frames(scene);
            let steps = usize::try_from(last.checked_sub(first)?).ok()?;
            if steps >= MOST_FRAMES || steps.saturating_mul(scene.objects.len()) > MOST_POSES {
                return None;
            }
            let view = |pose: CameraPose, frame: f64| {
                (PictureView { pose, size_px }, motion::poses_at(scene, frame))
            };
            let (referred, frame) = motion::referred_to(scene, &scene.reference);
            let along = (0..=steps).map(|step| {
                let frame = first as f64 + step as f64;
                view(motion::camera_at(scene, frame), frame)
            });
            let also = also.iter().map(|(pose, frame)| view(pose.clone(), *frame));
            Some(std::iter::once(view(referred, frame)).chain(also).chain(along).collect())
        };
        self.views.get_or_init(find).as_deref()
    }

    /// How far from the middle of the picture there are particles, in half sizes of the picture.
    pub(crate) fn margin(&self) -> f64 {
        match self.from {
            SeenFrom::Shot { margin, .. } => margin.clamp(SeenFrom::MARGIN, SeenFrom::MOST_MARGIN),
            SeenFrom::AsBefore | SeenFrom::Anywhere => SeenFrom::MARGIN,
        }
    }

    /// Whether particles stay where they were made before.
    pub(crate) fn is_as_before(&self) -> bool {
        matches!(self.from, SeenFrom::AsBefore)
    }

    /// Whether all views follow from the text of the scene.
    pub(crate) fn follows_from_scene(&self) -> bool {
        matches!(self.from, SeenFrom::Shot { also: [], .. })
            && self.margin() == SeenFrom::MARGIN
            && self.scene.stage.shot.is_none()
    }

    /// Every view of an object, equal ones in a row once; `None` if there may be others.
    pub(crate) fn sightings(&self, object: usize) -> Option<Vec<Sighting>> {
        let mut sightings: Vec<Sighting> = Vec::new();
        for (view, poses) in self.views()? {
            let sighting = Sighting::of(view, poses[object]);
            if sightings.last() != Some(&sighting) {
                sightings.push(sighting);
            }
        }
        Some(sightings)
    }
}

/// The first and the last frame of the timeline and of all keys of the camera and of objects.
fn frames(scene: &Scene) -> [i64; 2] {
    let keys = scene.camera.keys.iter().map(|key| key.frame);
    let keys = keys.chain(scene.objects.iter().flat_map(|object| object.keys.iter().map(|key| key.frame)));
    let of_keys = keys.filter(|frame| frame.is_finite());
    of_keys.fold([scene.timeline.first, scene.timeline.last], |[first, last], frame| {
        [first.min(frame.floor() as i64), last.max(frame.ceil() as i64)]
    })
}
