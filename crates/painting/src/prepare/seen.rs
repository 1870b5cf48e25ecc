//! From where a painting will be seen: large surfaces have particles only where a view needs them.

use std::sync::OnceLock;

use glam::DAffine3;
use impasto_scene::document::Scene;
use impasto_scene::motion::{self, CameraPose};

use crate::frame_options::FrameOptions;
use crate::needed::MARGIN;
use crate::particle_count::Sighting;
use crate::view::PictureView;

/// From where a painting will be seen.
#[derive(Clone, Copy, Debug)]
pub enum SeenFrom<'a> {
    /// By the scene's camera, at every frame of its timeline; and by these cameras, each at a frame. Where none of them
    /// looks, large surfaces have only few particles.
    Shot(&'a [(CameraPose, f64)]),
    /// From anywhere.
    Anywhere,
}

impl SeenFrom<'_> {
    /// What pictures of the scene with these options need: those that are much wider than the scene states, or whose
    /// strokes keep their size in larger pictures, need particles where the scene's own pictures do not.
    pub fn for_options(scene: &Scene, options: &FrameOptions) -> Self {
        let aspect = |[width, height]: [u32; 2]| f64::from(width.max(1)) / f64::from(height.max(1));
        let wider = aspect(options.size_px) / aspect([scene.size.0, scene.size.1]);
        if options.keep_stroke_px || wider > MARGIN { Self::Anywhere } else { Self::Shot(&[]) }
    }
}

/// More frames than this are not looked at one by one.
const MOST_FRAMES: usize = 4096;

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
            let SeenFrom::Shot(also) = self.from else { return None };
            let scene = self.scene;
            let size_px = [scene.size.0, scene.size.1];
            let (first, last) = (scene.timeline.first, scene.timeline.last.max(scene.timeline.first));
            let frames =
                usize::try_from(last.checked_sub(first)?).ok().filter(|&count| count < MOST_FRAMES)?;
            let view = |pose: CameraPose, frame: f64| {
                (PictureView { pose, size_px }, motion::poses_at(scene, frame))
            };
            let (referred, frame) = motion::referred_to(scene, &scene.reference);
            let along = (0..=frames).map(|step| {
                let frame = first as f64 + step as f64;
                view(motion::camera_at(scene, frame), frame)
            });
            let also = also.iter().map(|(pose, frame)| view(pose.clone(), *frame));
            Some(std::iter::once(view(referred, frame)).chain(also).chain(along).collect())
        };
        self.views.get_or_init(find).as_deref()
    }

    /// Whether the text of the scene tells all views.
    pub(crate) fn follows_from_scene(&self) -> bool {
        matches!(self.from, SeenFrom::Shot([])) && self.scene.stage.shot.is_none()
    }

    /// Every view of an object, each once while it does not change; `None` if there may be others.
    pub(crate) fn sightings(&self, object: usize) -> Option<Vec<Sighting>> {
        let mut sightings: Vec<Sighting> =
            self.views()?.iter().map(|(view, poses)| Sighting::of(view, poses[object])).collect();
        sightings.dedup();
        Some(sightings)
    }
}
