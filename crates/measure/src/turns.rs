//! What strokes did between the reference picture and another, and what they should have done: M3, and what M7 and M10
//! compare with.

use std::collections::BTreeMap;

use impasto_painting::frame::LayerKind;
use impasto_painting::{FrameOptions, Painting};
use impasto_scene::motion::{self, CameraPose};

use crate::strokes::{SeenStrokes, StrokeKey, degrees_apart, of_layer, seen};
use crate::truth::{BodyView, Ride, ScreenTurn, TrueView};

/// The reference must face a stroke by this cosine: then its lift is the reference's own.
const FACED: f64 = 0.5;

/// What a stroke did, and what it should have done.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn {
    /// Its angle in the reference picture.
    pub base_rad: f64,
    /// Its angle now.
    pub angle_rad: f64,
    /// The analytic turn.
    pub truth: ScreenTurn,
}

impl Turn {
    /// How far the stroke has turned too far, degrees.
    pub fn error_deg(&self) -> f64 {
        degrees_apart(self.angle_rad, self.expected_rad())
    }

    /// Its angle as it should be.
    pub fn expected_rad(&self) -> f64 {
        self.base_rad + self.truth.polar_rad
    }

    /// How far the stroke is from where a line on the surface has gone, degrees.
    pub fn material_error_deg(&self) -> f64 {
        degrees_apart(self.angle_rad, self.truth.material_rad(self.base_rad))
    }
}

/// The reference picture of a painting: what its strokes are compared with.
pub struct Reference {
    camera: CameraPose,
    frame: f64,
    strokes: SeenStrokes,
}

impl Reference {
    /// That of a painting, in pictures of this size.
    pub fn of(painting: &Painting, size_px: [u32; 2]) -> Self {
        let (camera, frame) = motion::referred_to(painting.scene(), &painting.scene().reference);
        let then = painting.seen_by(&camera, frame, &FrameOptions::new(size_px));
        Self { camera, frame, strokes: seen(&then, &[]) }
    }

    /// The turns of the body layer's strokes `now`, seen by `camera` at `frame`. Regions with a reference of their own are
    /// left out.
    pub fn turns(
        &self,
        painting: &Painting,
        now: &SeenStrokes,
        (camera, frame): (&CameraPose, f64),
        size_px: [u32; 2],
    ) -> BTreeMap<StrokeKey, Turn> {
        let views = [TrueView::new(&self.camera, size_px), TrueView::new(camera, size_px)];
        let scene = painting.scene();
        let poses = [self.frame, frame].map(|frame| motion::poses_at(scene, frame));
        let morphs = [self.frame, frame].map(|frame| motion::morphs_at(scene, frame));
        // A region with a reference of its own states its directions in another picture.
        let is_own =
            |region: u32| scene.regions.get(region as usize).is_none_or(|region| region.reference.is_none());
        let turn = |key: &StrokeKey, angle_rad: f64| {
            let base = self.strokes.get(key)?;
            let object = key.body_id as usize - 1;
            let particle = painting.particles(object).get(key.particle as usize)?;
            let shares = [0, 1].map(|side: usize| morphs[side][object]);
            let ride = Ride::of(painting.surface(object), &particle, shares);
            let [then, now] = [0, 1]
                .map(|side: usize| BodyView { view: &views[side], world_from_model: poses[side][object] });
            if then.facing(ride.before) < FACED || !is_own(base.region) {
                return None;
            }
            let truth = ScreenTurn::between(&ride, then, now)?;
            Some(Turn { base_rad: base.angle_rad, angle_rad, truth })
        };
        of_layer(now, LayerKind::Body)
            .filter_map(|(key, stroke)| Some((*key, turn(key, stroke.angle_rad)?)))
            .collect()
    }
}
