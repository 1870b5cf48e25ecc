//! The parts of a body: the largest stroke that each can carry, and its automatic direction.

use glam::{DVec3, Vec3};
use impasto_core::TriangleMesh;
use impasto_core::form_size::FormSize;
use impasto_core::parts::{Part, parts};
use impasto_core::presence::smoothstep;
use impasto_core::sampling::Surface;
use impasto_scene::document::Direction;
use impasto_scene::presets::LayerKind;

use crate::references::BodyReference;

/// A stroke is at most `WIDTH_SHARE` of its part's second extent wide, and `LENGTH_SHARE` of its longest one long.
const WIDTH_SHARE: f64 = 0.42;
const LENGTH_SHARE: f64 = 0.6;

/// The least cap, pixels at the scene's size.
const LEAST_CAP_PX: f64 = 3.0;

/// A stroke that fits the form is at most `FORM_SHARE` of the form's size wide. A stroke that is wider than that before
/// it is fitted gets a lower limit, the lower the wider it is, but not below `LEAST_FITTED_PX`.
const FORM_SHARE: f32 = 0.13;
const LEAST_FITTED_PX: f32 = 10.0;

/// The seed of the samples that measure the form: the same for all bodies, so that equal meshes have equal strokes.
const FORM_SEED: u32 = 0x0f02_2a1e;

/// A cap leaves strokes at least this many times as long as wide, unless they are stated to be shorter.
const LEAST_ASPECT: f32 = 1.2;

/// A part is long when its longest extent is more than this many times its second.
const LONG: f64 = 1.12;

/// A part is a backdrop when it spans this share of both sides of the picture, is at most this thick relative to its
/// second extent, and faces the eye with at least this cosine.
const BACKDROP_SHARE: f64 = 0.9;
const BACKDROP_THICKNESS: f64 = 0.2;
const BACKDROP_FACING: f64 = 0.6;

/// The angle of the strokes on a backdrop, degrees: almost level, so that they do not draw attention.
const BACKDROP_DEG: f64 = 8.0;

#[derive(Debug)]
pub(crate) struct BodyParts {
    pub(crate) parts: Vec<Part>,
    pub(crate) of_triangle: Vec<u32>,
    /// How large the form is at each place of the body.
    pub(crate) form: FormSize,
}

/// The largest strokes that a part carries, pixels at the scene's size. They are found in the reference pose, since a
/// stroke keeps its size in pixels however far away its part is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Cap {
    length_px: f32,
    width_px: f32,
    /// Pixels per model unit.
    px_per_unit: f32,
}

impl BodyParts {
    pub(crate) fn of(surface: &Surface<'_>) -> Self {
        let (parts, of_triangle) = parts(surface.mesh());
        Self { parts, of_triangle, form: FormSize::of(surface, FORM_SEED) }
    }

    /// The caps, from the reference view at the scene's own size.
    pub(crate) fn caps(&self, reference: &BodyReference) -> Vec<Cap> {
        let of_part = |(index, part): (usize, &Part)| {
            let scale = px_per_unit(reference, index, part);
            let cap = |share: f64, extent: f64| (share * extent * scale).max(LEAST_CAP_PX) as f32;
            Cap {
                length_px: cap(LENGTH_SHARE, part.extents[0]),
                width_px: cap(WIDTH_SHARE, part.extents[1]),
                px_per_unit: scale as f32,
            }
        };
        self.parts.iter().enumerate().map(of_part).collect()
    }

    /// Where the middles of the parts are when the vertices of this mesh are at these positions.
    pub(crate) fn centers(&self, mesh: &TriangleMesh, positions: &[Vec3]) -> Vec<DVec3> {
        let mut sums = vec![(DVec3::ZERO, 0.0); self.parts.len()];
        let middle = |positions: &[Vec3], corners: &[u32; 3]| {
            corners.iter().map(|&vertex| positions[vertex as usize].as_dvec3()).sum::<DVec3>() / 3.0
        };
        for (corners, &part) in mesh.triangles.iter().zip(&self.of_triangle) {
            // A part moves by the mean of how far its triangles move, weighted by their areas at rest.
            let [a, b, c] = corners.map(|vertex| mesh.positions[vertex as usize].as_dvec3());
            let area = (b - a).cross(c - a).length();
            let sum = &mut sums[part as usize];
            sum.0 += (middle(positions, corners) - middle(&mesh.positions, corners)) * area;
            sum.1 += area;
        }
        let moved =
            |(part, (sum, area)): (&Part, &(DVec3, f64))| part.center + *sum / area.max(f64::MIN_POSITIVE);
        self.parts.iter().zip(&sums).map(moved).collect()
    }

    pub(crate) fn directions(&self, reference: &BodyReference) -> Vec<Direction> {
        let of_part = |(index, part)| direction_of(index, part, reference);
        self.parts.iter().enumerate().map(of_part).collect()
    }
}

impl Cap {
    /// This size of a stroke, limited to what the part carries.
    pub(crate) fn apply(self, length_px: f32, width_px: f32) -> [f32; 2] {
        let width = width_px.min(self.width_px);
        // A stroke that is stated to be broader than long stays so.
        let aspect = LEAST_ASPECT.min(length_px / width_px.max(f32::MIN_POSITIVE));
        [length_px.min(self.length_px).max(width * aspect), width]
    }

    /// As [`Cap::apply`], then made to suit a form of this size (model units), as far as `fit` says, 0..=1.
    pub(crate) fn fitted(self, size_px: [f32; 2], form: f32, fit: f32) -> [f32; 2] {
        let capped = self.apply(size_px[0], size_px[1]);
        let suited_px = FORM_SHARE * form * self.px_per_unit;
        let most_px = (suited_px * (suited_px / capped[1]).min(1.0).sqrt()).max(LEAST_FITTED_PX);
        // A soft minimum: sizes do not change abruptly over the surface.
        let share = (1.0 + (capped[1] / most_px).powi(4)).powf(-0.25);
        capped.map(|side| side * (1.0 - fit * (1.0 - share)))
    }
}

/// How far the strokes of a layer fit the form. Underpainting and scumble stay broad, contour lines and touches as they
/// are.
pub(crate) fn fit_of(kind: LayerKind, fit: f32) -> f32 {
    match kind {
        LayerKind::Underpainting | LayerKind::Scumble | LayerKind::Contour | LayerKind::Touches => 0.0,
        LayerKind::Body | LayerKind::Form | LayerKind::Accents | LayerKind::Lights => fit,
    }
}

/// A factor, 0..=1, on the coverage of a layer where the form has shrunk its strokes to this share of their size.
/// There, many small strokes of the body layer would hide what lies below, and the layers of small strokes over it
/// would add nothing.
pub(crate) fn wanted_where_small(kind: LayerKind, share: f32) -> f32 {
    match kind {
        LayerKind::Body => 1.0 - 0.4 * (1.0 - share).clamp(0.0, 1.0),
        LayerKind::Form | LayerKind::Accents => smoothstep((share - 0.5) / 0.4).max(0.02),
        _ => 1.0,
    }
}

/// Pixels per model unit at a part's middle, which counts as at least a quarter of the part's length away from the eye.
pub(crate) fn px_per_unit(reference: &BodyReference, index: usize, part: &Part) -> f64 {
    let map = &reference.map;
    let focal = (map.row_x.truncate().length() * map.row_y.truncate().length()).sqrt();
    let parallel = map.row_w.truncate() == DVec3::ZERO;
    let depth =
        if parallel { 1.0 } else { map.depth(reference.center(index, part)).max(0.25 * part.extents[0]) };
    let scale = focal / depth;
    if scale.is_finite() && scale > 0.0 { scale } else { 1.0 }
}

fn direction_of(index: usize, part: &Part, reference: &BodyReference) -> Direction {
    let size_px = reference.size_px;
    let scale = px_per_unit(reference, index, part);
    let gaze = reference.map.row_depth.truncate();
    let [longest, second, least] = part.extents;
    let fills = longest * scale >= BACKDROP_SHARE * f64::from(size_px[0].max(size_px[1]))
        && second * scale >= BACKDROP_SHARE * f64::from(size_px[0].min(size_px[1]));
    let faces = part.axes[2].dot(gaze.normalize_or_zero()).abs() > BACKDROP_FACING;
    if fills && faces && least < BACKDROP_THICKNESS * second {
        return Direction::Angle(BACKDROP_DEG);
    }
    if longest > LONG * second { Direction::Along(part.axes[0].to_array()) } else { Direction::Up }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cap_keeps_strokes_longer_than_wide() {
        let cap = Cap { length_px: 30.0, width_px: 20.0, px_per_unit: 10.0 };
        assert_eq!(cap.apply(78.0, 25.0), [30.0, 20.0]);
        assert_eq!(cap.apply(10.0, 5.0), [10.0, 5.0]);
        let stubby = Cap { length_px: 12.0, width_px: 20.0, px_per_unit: 10.0 };
        assert_eq!(stubby.apply(78.0, 25.0), [24.0, 20.0]);
        assert_eq!(stubby.apply(10.0, 20.0), [10.0, 20.0]);
    }

    #[test]
    fn a_stroke_fits_the_form_and_keeps_its_proportion() {
        let cap = Cap { length_px: 300.0, width_px: 200.0, px_per_unit: 10.0 };
        let close = |found: [f32; 2], length: f32| {
            assert!((found[0] - length).abs() < 0.02 * length, "{found:?}, not {length}");
            assert!((found[0] / found[1] - 3.0).abs() < 1e-4, "{found:?}");
        };
        // A form 100 units large suits strokes far wider than these (25 px). One of 15 units suits 19.5 px: the limit
        // is 19.5 √(19.5 / 25) px, and the width is a soft minimum of that and 25 px.
        close(cap.fitted([75.0, 25.0], 100.0, 1.0), 75.0);
        close(cap.fitted([75.0, 25.0], 15.0, 1.0), 49.1);
        close(cap.fitted([75.0, 25.0], 15.0, 0.5), 62.05);
        assert_eq!(cap.fitted([75.0, 25.0], 5.0, 0.0), [75.0, 25.0]);
        assert_eq!(cap.fitted([75.0, 25.0], f32::INFINITY, 1.0), [75.0, 25.0]);
        close(
            cap.fitted([75.0, 25.0], 1e-9, 1.0),
            3.0 * LEAST_FITTED_PX * (1.0f32 + 0.4f32.powi(4)).powf(-0.25),
        );
    }
}
