//! Answers what the tools ask about the painting: regions and stroke directions under the pointer.

use impasto_core::bending::CarriedPlace;
use impasto_painting::{Painting, SurfacePlace};
use impasto_scene::document::Amount;
use impasto_scene::motion::CameraPose;

use super::Editor;
use crate::picking::{Hit, Picker};
use crate::tools::{Painted, PaintedDirection};

impl Editor {
    /// Like [`Editor::prepared`]; also takes what a picker on another thread has built for the painting.
    pub fn prepared_with(&mut self, painting: Painting, picker: Picker) {
        self.picker.learn(picker);
        self.prepared(painting);
    }
}

/// The painting as a camera sees it. There is no painting before the first one is prepared.
pub(super) struct PaintedView<'a> {
    pub(super) painting: Option<&'a Painting>,
    pub(super) camera: &'a CameraPose,
    pub(super) frame: f64,
}

impl Painted for PaintedView<'_> {
    fn region_at(&self, hit: &Hit) -> Option<usize> {
        let painting = self.painting?;
        let is_there = hit.object < painting.scene().objects.len();
        let region = is_there.then(|| painting.region_at(hit.object, &hit.particle()))?;
        (region < painting.scene().regions.len()).then_some(region)
    }

    fn factor_at(&self, hit: &Hit, of: Amount) -> Option<f64> {
        let painting = self.painting.filter(|painting| hit.object < painting.scene().objects.len())?;
        Some(f64::from(painting.painted_at(hit.object, &hit.particle(), of)))
    }

    fn carried(&self, hit: &Hit, frame: f64) -> Option<CarriedPlace> {
        let painting = self.painting.filter(|painting| hit.object < painting.scene().objects.len())?;
        painting.carried(hit.object, &hit.particle(), frame)
    }

    fn shown_at(&self, hit: &Hit) -> Option<PaintedDirection> {
        let painting = self.painting?;
        if hit.object >= painting.scene().objects.len() {
            return None;
        }
        let surface = painting.surface(hit.object);
        let (low, high) = surface.mesh.bounds()?;
        let place = SurfacePlace {
            object: hit.object,
            position: hit.position_in_model,
            normal: hit.normal_in_model,
            radius: f64::from((high - low).length()) * 0.2,
        };
        let shown = painting.angle_at(&place, self.camera, self.frame)?;
        Some(PaintedDirection { angle_rad: f64::from(shown.angle_rad), trust: f64::from(shown.kappa) })
    }
}
