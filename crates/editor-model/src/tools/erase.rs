//! Cuts guides along the path of an eraser.

use glam::DVec3;
use impasto_scene::document::{Guide, GuidePoint};

use crate::path::PathPoint;

/// What is left of a guide after an eraser of this radius (model units) touched these points: the whole guide, pieces
/// of it, or nothing. Only parts that face the same way as the touched points are erased.
pub(super) fn cut(guide: &Guide, touched: &[PathPoint], radius: f64) -> Vec<Guide> {
    let mut pieces: Vec<Vec<GuidePoint>> = vec![Vec::new()];
    let mut was_cut = false;
    for pair in guide.points.windows(2) {
        let (from, to) = (&pair[0], &pair[1]);
        let erased = erased_spans(from, to, touched, radius);
        was_cut |= !erased.is_empty();
        let mut at = 0.0;
        for [begins, ends] in erased {
            if begins > at {
                push(&mut pieces, mixed(from, to, at));
                push(&mut pieces, mixed(from, to, begins));
            }
            pieces.push(Vec::new());
            at = ends;
        }
        if at < 1.0 {
            push(&mut pieces, mixed(from, to, at));
            push(&mut pieces, to.clone());
        }
    }
    if !was_cut {
        return vec![guide.clone()];
    }
    let whole = pieces.into_iter().filter(|points| points.len() >= 2);
    whole.map(|points| Guide { points, ..guide.clone() }).collect()
}

/// Appends a point to the last piece, unless it ends with that point already.
fn push(pieces: &mut [Vec<GuidePoint>], point: GuidePoint) {
    if let Some(piece) = pieces.last_mut()
        && piece.last().is_none_or(|last| last.at != point.at)
    {
        piece.push(point);
    }
}

/// The erased intervals of a line segment, as shares of it, sorted and disjoint.
fn erased_spans(from: &GuidePoint, to: &GuidePoint, touched: &[PathPoint], radius: f64) -> Vec<[f64; 2]> {
    let (start, way) = (DVec3::from(from.at), DVec3::from(to.at) - DVec3::from(from.at));
    let normal = DVec3::from(from.normal) + DVec3::from(to.normal);
    let mut erased: Vec<[f64; 2]> = touched
        .iter()
        .filter(|stamp| stamp.normal.dot(normal) > 0.0)
        .filter_map(|stamp| {
            // Solves |start + t·way − stamp| = radius for t. Without a solution both values of t are NaN, and nothing
            // is erased.
            let off = start - stamp.position;
            let (a, b, c) = (way.length_squared(), way.dot(off), off.length_squared() - radius * radius);
            let root = (b * b - a * c).sqrt();
            let [begins, ends] = [(-b - root) / a, (-b + root) / a].map(|t| t.clamp(0.0, 1.0));
            (begins < ends).then_some([begins, ends])
        })
        .collect();
    erased.sort_by(|a, b| a[0].total_cmp(&b[0]));
    erased.into_iter().fold(Vec::new(), |mut joined: Vec<[f64; 2]>, span| {
        match joined.last_mut() {
            Some(last) if span[0] <= last[1] => last[1] = last[1].max(span[1]),
            _ => joined.push(span),
        }
        joined
    })
}

fn mixed(from: &GuidePoint, to: &GuidePoint, share: f64) -> GuidePoint {
    if share <= 0.0 {
        return from.clone();
    }
    if share >= 1.0 {
        return to.clone();
    }
    let mix = |a: [f64; 3], b: [f64; 3]| DVec3::from(a).lerp(DVec3::from(b), share);
    let normal = mix(from.normal, to.normal).normalize_or(DVec3::from(from.normal));
    GuidePoint {
        at: mix(from.at, to.at).to_array(),
        normal: normal.to_array(),
        turn_deg: from.turn_deg + (to.turn_deg - from.turn_deg) * share,
    }
}
