//! Blends the transforms of the joints that move a vertex.

use glam::DAffine3;
use impasto_gltf::{Influences, Primitive};

/// The transform by which joints move a vertex of a skinned mesh. A primitive without joints moves with the first one.
pub(super) fn moved_by(joints: &[DAffine3], primitive: &Primitive, vertex: usize) -> DAffine3 {
    match &primitive.influences {
        Some(influences) => blended(joints, influences, vertex),
        None => joints.first().copied().unwrap_or(DAffine3::IDENTITY),
    }
}

/// The weighted mean of the transforms of the joints that move a vertex.
fn blended(joints: &[DAffine3], influences: &Influences, vertex: usize) -> DAffine3 {
    let of_vertex = vertex * influences.per_vertex..(vertex + 1) * influences.per_vertex;
    let mut sum = DAffine3::ZERO;
    for at in of_vertex {
        let weight = f64::from(influences.weights[at]);
        let Some(joint) = joints.get(usize::from(influences.joints[at])).filter(|_| weight > 0.0) else {
            continue;
        };
        sum.matrix3 += joint.matrix3 * weight;
        sum.translation += joint.translation * weight;
    }
    sum
}
