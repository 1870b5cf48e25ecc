//! Compares how strokes have turned since the reference picture with the exact turns of their surface. M3, M7 and M10
//! use this.

use std::collections::BTreeMap;

use impasto_core::bending::Vertices;
use impasto_painting::frame::LayerKind;
use impasto_painting::{FrameOptions, Painting};
use impasto_scene::motion::{self, CameraPose};

use crate::strokes::{StrokeKey, StrokesByKey, degrees_apart, of_layer, strokes_by_key};
use crate::truth::{BodyView, PointMotion, ScreenTurn, TrueView};

/// Strokes are left out if, in the reference view, the cosine between their surface's normal and the direction to the
/// eye is smaller than this: the reference view decides their direction only in part.
const FACED: f64 = 0.5;

/// The turn of one stroke, drawn and expected.
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
    /// The difference between its angle and the expected one, degrees.
    pub fn error_deg(&self) -> f64 {
        degrees_apart(self.angle_rad, self.expected_rad())
    }

    /// The expected angle.
    pub fn expected_rad(&self) -> f64 {
        self.base_rad + self.truth.polar_rad
    }

    /// The difference between the stroke's angle now and that of a line painted on the surface, degrees. In the
    /// reference picture, the line had the stroke's angle.
    pub fn material_error_deg(&self) -> f64 {
        degrees_apart(self.angle_rad, self.truth.material_rad(self.base_rad))
    }
}

/// The strokes of a painting's reference picture.
pub struct Reference {
    camera: CameraPose,
    frame: f64,
    strokes: StrokesByKey,
}

impl Reference {
    /// The strokes of a painting's reference picture in this size.
    pub fn of(painting: &Painting, size_px: [u32; 2]) -> Self {
        let (camera, frame) = motion::referred_to(painting.scene(), &painting.scene().reference);
        let then = painting.seen_by(&camera, frame, &FrameOptions::new(size_px));
        Self { camera, frame, strokes: strokes_by_key(&then, &[]) }
    }

    /// The turns of the body layer's strokes `now`, as `camera` sees them at `frame`. Regions that have their own
    /// reference are left out.
    pub fn turns(
        &self,
        painting: &Painting,
        now: &StrokesByKey,
        camera: &CameraPose,
        frame: f64,
        size_px: [u32; 2],
    ) -> BTreeMap<StrokeKey, Turn> {
        let views = [TrueView::new(&self.camera, size_px), TrueView::new(camera, size_px)];
        let scene = painting.scene();
        let poses = [self.frame, frame].map(|frame| motion::poses_at(scene, frame));
        let bent = [self.frame, frame].map(|frame| painting.bent_at(frame));
        let at_rest: Vec<Vertices> = (0..scene.objects.len())
            .map(|object| {
                let mesh = &painting.surface(object).mesh;
                Vertices { positions: mesh.positions.clone(), normals: mesh.normals.clone() }
            })
            .collect();
        let vertices = |object: usize| {
            bent.each_ref().map(|bent| bent[object].as_ref().map_or(&at_rest[object], |bent| &bent.vertices))
        };
        // A region with its own reference states its directions in another picture.
        let is_of_scene =
            |region: u32| scene.regions.get(region as usize).is_none_or(|region| region.reference.is_none());
        let turn = |key: &StrokeKey, angle_rad: f64| {
            let base = self.strokes.get(key)?;
            let object = key.body_id as usize - 1;
            let particle = painting.particles(object).get(key.particle as usize)?;
            let point_motion = PointMotion::of(&painting.surface(object).mesh, &particle, vertices(object));
            let [then, now] = [0, 1]
                .map(|side: usize| BodyView { view: &views[side], world_from_model: poses[side][object] });
            if then.facing(point_motion.before) < FACED || !is_of_scene(base.region) {
                return None;
            }
            let truth = ScreenTurn::between(&point_motion, then, now)?;
            Some(Turn { base_rad: base.angle_rad, angle_rad, truth })
        };
        of_layer(now, LayerKind::Body)
            .filter_map(|(key, stroke)| Some((*key, turn(key, stroke.angle_rad)?)))
            .collect()
    }
}
