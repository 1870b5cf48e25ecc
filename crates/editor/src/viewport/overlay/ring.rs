use egui::{Color32, Pos2};
use glam::{DVec2, DVec3};

use super::Sheet;
use super::ink::{self, Ink};

const PIECES: usize = 72;
/// Where the falloff k = (1 − (d/r)²)² is one half.
const HALF_STRENGTH: f64 = 0.541_196_1;

/// The brush on a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ring {
    /// Where it lies, world space.
    pub centre_in_world: DVec3,
    /// Of the surface there, unit.
    pub normal_in_world: DVec3,
    /// As it would be on a surface that faces the eye.
    pub radius_px: f64,
    /// Which ring it is.
    pub manner: RingManner,
}

/// Which ring it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RingManner {
    /// Under the hand.
    Own,
    /// Its mirror image.
    Mirrored,
    /// Its mirror image, where there is no surface.
    MirroredNowhere,
}

impl Ring {
    /// The circle of a share of the radius in the tangent plane, as it shows; empty where a part of it is behind the eye.
    fn circle(&self, sheet: &Sheet<'_>, share: f64) -> Vec<Pos2> {
        let radius = self.radius_px * share / sheet.view.px_per_unit(self.centre_in_world);
        let (right, up) = self.normal_in_world.any_orthonormal_pair();
        let point = |piece: usize| {
            let (sin, cos) = (piece as f64 * std::f64::consts::TAU / PIECES as f64).sin_cos();
            sheet.project(self.centre_in_world + (right * cos + up * sin) * radius)
        };
        (0..PIECES).map(point).collect::<Option<_>>().unwrap_or_default()
    }
}

/// Draws a ring on a surface: an ellipse where that is seen at an angle. Returns its outline.
pub fn ring(sheet: &Sheet<'_>, ring: &Ring) -> Vec<Pos2> {
    let outline = ring.circle(sheet, 1.0);
    let Some(centre) = sheet.project(ring.centre_in_world) else { return Vec::new() };
    if outline.is_empty() {
        return outline;
    }
    let share = if ring.manner == RingManner::Own { 1.0 } else { 0.6 };
    let ink = Ink::new(1.8, ink::white(share), (4.0, ink::black(0.5 * share)));
    if ring.manner == RingManner::MirroredNowhere {
        let mut closed = outline.clone();
        closed.extend(outline.first());
        ink.dashed(sheet.painter, &closed, (5.0, 5.0));
        return outline;
    }
    ink.closed(sheet.painter, &outline);
    let mut inner = ring.circle(sheet, HALF_STRENGTH);
    inner.extend(inner.first().copied());
    let ink = Ink::new(1.0, ink::white(0.55 * share), (2.0, ink::black(0.25 * share)));
    ink.dashed(sheet.painter, &inner, (4.0, 5.0));
    sheet.painter.circle_filled(centre, 3.4, ink::black(0.5 * share));
    sheet.painter.circle_filled(centre, 2.2, ink::white(share));
    outline
}

/// The ring off every surface: grey, hollow, of constant size.
pub fn hollow_ring(sheet: &Sheet<'_>, at_px: DVec2, radius_px: f64) {
    let at = sheet.at(at_px);
    sheet.painter.circle_stroke(at, radius_px as f32, (3.0, ink::black(0.35)));
    sheet.painter.circle_stroke(at, radius_px as f32, (1.4, Color32::from_gray(165)));
}
