//! From where a painting will be seen: large surfaces have particles only where a view needs them.

use std::sync::OnceLock;

use glam::DAffine3;
use impasto_scene::document::Scene;
use impasto_scene::loaded::LoadedScene;
use impasto_scene::motion::{self, CameraPose};

use crate::body_shape::BodyShape;
use crate::frame_options::FrameOptions;
use crate::particle_count::Sighting;
use crate::shapes::BodyShapes;
use crate::view::PictureView;

/// From where a painting will be seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SeenFrom<'a> {
    /// By the scene's camera at every whole frame from the first to the last of its timeline and keys, and in the
    /// scene's reference. Where no view looks, large surfaces have only few particles.
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

    /// What pictures of the scene with these options need. Those that are wider than the scene states show what lies
    /// beside its own pictures. Where strokes keep their size in larger pictures, more of them are needed everywhere.
    pub fn for_options(scene: &Scene, options: &FrameOptions) -> SeenFrom<'static> {
        let aspect = |[width, height]: [u32; 2]| f64::from(width.max(1)) / f64::from(height.max(1));
        let wider = aspect(options.size_px) / aspect([scene.size.0, scene.size.1]);
        if options.keep_stroke_px || wider > Self::MOST_MARGIN {
            return SeenFrom::Anywhere;
        }
        SeenFrom::Shot { also: &[], margin: wider.max(Self::MARGIN) }
    }
}

/// With more than `MOST_FRAMES` frames, or more than `MOST_POSES` poses of objects over all frames, a painting is made
/// to be seen from anywhere.
const MOST_FRAMES: usize = 4096;
const MOST_POSES: usize = 200_000;

/// The most joints and targets, summed over all frames. If the shot states more, particles lie everywhere on every
/// object whose vertices move. If a single object has more, particles lie everywhere on that object.
const MOST_JOINTS: usize = 500_000;

/// A view, with the poses of all objects.
type View = (PictureView, Vec<DAffine3>);

/// All views of a scene, found when they are first asked for.
pub(crate) struct Seen<'a> {
    loaded: &'a LoadedScene,
    from: SeenFrom<'a>,
    cameras: OnceLock<Option<Vec<(CameraPose, f64)>>>,
    views: OnceLock<Option<Vec<View>>>,
    shapes: OnceLock<Option<Vec<BodyShapes>>>,
}

impl<'a> Seen<'a> {
    pub(crate) fn new(loaded: &'a LoadedScene, from: SeenFrom<'a>) -> Self {
        Self { loaded, from, cameras: OnceLock::new(), views: OnceLock::new(), shapes: OnceLock::new() }
    }

    /// The views; `None` if there may be others.
    pub(crate) fn views(&self) -> Option<&[View]> {
        let scene = &self.loaded.scene;
        let size_px = [scene.size.0, scene.size.1];
        let view = |(pose, frame): &(CameraPose, f64)| {
            (PictureView { pose: pose.clone(), size_px }, motion::poses_at(scene, *frame))
        };
        self.views.get_or_init(|| Some(self.cameras()?.iter().map(view).collect())).as_deref()
    }

    /// The camera of each view, with its frame; `None` if there may be others.
    fn cameras(&self) -> Option<&[(CameraPose, f64)]> {
        let find = || {
            let also = self.also()?;
            let scene = &self.loaded.scene;
            let [first, last] = frames(scene);
            let steps = usize::try_from(last.checked_sub(first)?).ok()?;
            if steps >= MOST_FRAMES || steps.saturating_mul(scene.objects.len()) > MOST_POSES {
                return None;
            }
            let along = (0..=steps).map(|step| {
                let frame = first as f64 + step as f64;
                (motion::camera_at(scene, frame), frame)
            });
            let reference = motion::referred_to(scene, &scene.reference);
            Some(std::iter::once(reference).chain(also.iter().cloned()).chain(along).collect())
        };
        self.cameras.get_or_init(find).as_deref()
    }

    /// The cameras besides that of the scene; `None` if the painting may be seen from anywhere.
    fn also(&self) -> Option<&'a [(CameraPose, f64)]> {
        match self.from {
            SeenFrom::Shot { also, .. } => Some(also),
            SeenFrom::AsBefore => Some(&[]),
            SeenFrom::Anywhere => None,
        }
    }

    /// The shape of an object in each of the views, without noise; `None` if there may be others, or if there are more
    /// than [`MOST_JOINTS`].
    pub(crate) fn shapes_of(&self, object: usize) -> Option<Vec<BodyShape>> {
        let find = || {
            let frames = self.cameras()?.iter().map(|(_, frame)| *frame);
            let at = |frame: f64| BodyShapes::at(&self.loaded.scene, frame);
            let first = frames.clone().next().map(at)?;
            let is_much = first.numbers().saturating_mul(frames.len()) > MOST_JOINTS;
            (!is_much).then(|| frames.map(at).collect())
        };
        let shapes: &[BodyShapes] = self.shapes.get_or_init(find).as_deref()?;
        let numbers: usize = shapes.iter().map(|shapes| shapes.numbers_of(self.loaded, object)).sum();
        (numbers <= MOST_JOINTS).then(|| shapes.iter().map(|shapes| shapes.of(self.loaded, object)).collect())
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
            && self.loaded.scene.stage.shot.is_none()
    }

    /// Every view of an object at rest, but of equal views in a row only one; `None` if there may be other views.
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

    /// Every view of an object whose vertices move, but of equal views in a row only one. `None` if there may be other
    /// views: an editor's free camera may stay where it is while the frames change.
    pub(crate) fn sightings_moving(&self, object: usize) -> Option<Vec<Sighting>> {
        if !self.also()?.is_empty() {
            return None;
        }
        let shapes = self.shapes_of(object)?;
        let views = self.views()?.iter().zip(shapes);
        let of_view = |((view, poses), shape): (&View, BodyShape)| Sighting {
            shape,
            ..Sighting::of(view, poses[object])
        };
        let mut sightings: Vec<Sighting> = views.map(of_view).collect();
        sightings.dedup();
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
