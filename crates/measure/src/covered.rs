//! Finds where the paint of a body in front may hide what lies behind, since paint may run past the border of its body.

use std::collections::BTreeMap;

use impasto_gl_render::ReferencePixels;
use impasto_painting::frame::Stroke;

use crate::plane::Plane;

/// How far the paint of each body may run past its border, in pixels, keyed by body id.
pub fn overruns_px(strokes: &[Stroke]) -> BTreeMap<u32, f32> {
    let mut overruns_px = BTreeMap::new();
    for stroke in strokes {
        let limit = if stroke.overrun_px < Stroke::FREE { stroke.overrun_px } else { 0.5 * stroke.length_px };
        let most = overruns_px.entry(stroke.body_id).or_insert(0.0f32);
        *most = most.max(limit);
    }
    overruns_px
}

/// 1 at each pixel of a body that the paint of a nearer body may cover, 0 elsewhere. `overruns_px` comes from the
/// function of this name.
pub fn covered(size_px: [usize; 2], reference: &ReferencePixels, overruns_px: &BTreeMap<u32, f32>) -> Plane {
    let [width, height] = size_px.map(|side| side as i64);
    let mut covered = Plane::filled(size_px, 0.0);
    let at = |x: i64, y: i64| {
        let inside = (0..width).contains(&x) && (0..height).contains(&y);
        inside.then_some((y * width + x) as usize)
    };
    for (pixel, (&id, &depth)) in reference.body_id.iter().zip(&reference.depth).enumerate() {
        let reach = overruns_px.get(&id).map_or(0, |overrun_px| overrun_px.ceil() as i64);
        if reach == 0 {
            continue;
        }
        // Where there is no body, the depth is 0, although the background lies behind all bodies.
        let lies_behind = |other: usize| {
            let other_id = reference.body_id[other];
            other_id != id && (other_id == 0 || reference.depth[other] > depth)
        };
        let (x, y) = (pixel as i64 % width, pixel as i64 / width);
        let beside = [(1, 0), (-1, 0), (0, 1), (0, -1)];
        if !beside.iter().filter_map(|(dx, dy)| at(x + dx, y + dy)).any(lies_behind) {
            continue;
        }
        for dy in -reach..=reach {
            for dx in -reach..=reach {
                if dx * dx + dy * dy > reach * reach {
                    continue;
                }
                let other = at(x + dx, y + dy).filter(|&other| reference.body_id[other] != 0);
                if let Some(other) = other.filter(|&other| lies_behind(other)) {
                    covered.values[other] = 1.0;
                }
            }
        }
    }
    covered
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_lies_behind_a_border_is_covered_as_far_as_paint_runs() {
        // A wall, with a body before it in the columns from 10 on.
        let reference = ReferencePixels {
            body_id: (0..60).map(|at| 1 + u32::from(at % 20 >= 10)).collect(),
            depth: (0..60).map(|at| if at % 20 >= 10 { 2.0 } else { 5.0 }).collect(),
        };
        let row = |overruns_px: [(u32, f32); 2]| {
            let covered = covered([20, 3], &reference, &BTreeMap::from(overruns_px));
            (0..20).filter(|&x| covered.at(x, 1) > 0.0).collect::<Vec<_>>()
        };
        // The wall's own paint covers nothing in front of it.
        assert_eq!(row([(1, 6.0), (2, 0.0)]), Vec::<usize>::new());
        assert_eq!(row([(1, 6.0), (2, 2.4)]), [7, 8, 9]);
    }
}
