//! A preview of the strokes under the ring as a comb would turn them.

use glam::DVec2;

use super::Sheet;
use super::ink::{self, Ink};

/// A stroke under the ring, as it lies now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CombPreviewStroke {
    /// Its middle.
    pub at_px: DVec2,
    /// Its angle now: counter-clockwise from +X with Y up, radians.
    pub angle_rad: f32,
    /// Its length on the screen.
    pub length_px: f32,
    /// Whether it has a head. If so, a comb turns it by up to 180 degrees, else by up to 90.
    pub directed: bool,
}

impl CombPreviewStroke {
    /// The angle that a comb would give it: a blend of its own and the comb's. At distance d from the middle of a ring
    /// of radius r, the comb's share is strength · (1 − (d/r)²)²; an even comb's share is its strength. `None` outside
    /// the ring.
    fn combed_rad(&self, comb: &Comb) -> Option<f32> {
        let near = 1.0 - (self.at_px - comb.at_px).length_squared() / (comb.radius_px * comb.radius_px);
        if near <= 0.0 {
            return None;
        }
        let share = if comb.even { 1.0 } else { (near * near) as f32 } * comb.strength;
        // Directions without a head are blended at twice their angle, so that opposite ones are the same.
        let fold = if self.directed { 1.0 } else { 2.0 };
        let unit = |angle_rad: f32| glam::Vec2::from_angle(angle_rad * fold);
        let blend = unit(self.angle_rad) * (1.0 - share) + unit(comb.angle_rad) * share;
        Some(if blend.length_squared() > 1e-8 { blend.to_angle() / fold } else { self.angle_rad })
    }
}

/// A comb at the place of the pointer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Comb {
    /// The centre of the ring.
    pub at_px: DVec2,
    /// Radius of the ring.
    pub radius_px: f64,
    /// The direction that it gives: counter-clockwise from +X with Y up, radians.
    pub angle_rad: f32,
    /// How far strokes at the centre follow it, 0..=1.
    pub strength: f32,
    /// Whether all strokes in the ring follow it alike. If not, they follow it less towards the rim.
    pub even: bool,
}

/// Draws the strokes inside the ring as a comb would turn them. `shown` is the opacity, 0..=1.
pub fn comb_preview(sheet: &Sheet<'_>, strokes: &[CombPreviewStroke], comb: &Comb, shown: f32) {
    if shown <= 0.0 {
        return;
    }
    let ink = Ink::new(1.4, ink::white(0.75 * shown), (3.6, ink::white(0.32 * shown)));
    for stroke in strokes {
        if let Some(angle_rad) = stroke.combed_rad(comb) {
            let half = ink::along(angle_rad) * (stroke.length_px * 0.5);
            let at = sheet.at(stroke.at_px);
            ink.segment(sheet.painter, [at - half, at + half]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const COMB: Comb =
        Comb { at_px: DVec2::ZERO, radius_px: 46.0, angle_rad: 0.0, strength: 1.0, even: false };

    fn stroke(at_px: DVec2, degrees: f32, directed: bool) -> CombPreviewStroke {
        CombPreviewStroke { at_px, angle_rad: degrees.to_radians(), length_px: 20.0, directed }
    }

    #[test]
    fn a_stroke_at_the_dot_lies_along_the_comb_and_one_at_the_rim_as_before() {
        let at = |x: f64| stroke(DVec2::new(x, 0.0), 60.0, true).combed_rad(&COMB).map(f32::to_degrees);
        assert!(at(0.0).unwrap().abs() < 1e-4);
        assert!((at(45.999).unwrap() - 60.0).abs() < 1e-3);
        assert_eq!(at(46.0), None);
    }

    #[test]
    fn an_even_comb_turns_the_rim_as_much_as_the_dot() {
        let even = Comb { even: true, ..COMB };
        assert!(stroke(DVec2::new(45.9, 0.0), 60.0, true).combed_rad(&even).unwrap().abs() < 1e-4);
    }

    #[test]
    fn without_a_head_it_turns_the_short_way() {
        let half = Comb { strength: 0.5, ..COMB };
        let headless = stroke(DVec2::ZERO, 170.0, false).combed_rad(&half).unwrap().to_degrees();
        assert!((headless.rem_euclid(180.0) - 175.0).abs() < 1e-3, "{headless}");
        let headed = stroke(DVec2::ZERO, 100.0, true).combed_rad(&half).unwrap().to_degrees();
        assert!((headed - 50.0).abs() < 1e-3, "{headed}");
    }
}
