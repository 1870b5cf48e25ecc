//! Blends the transforms of the joints that move a vertex.

use glam::DAffine3;
use impasto_gltf::Influences;

/// The weighted mean of the transforms of the joints that move a vertex.
pub(super) fn blended(joints: &[DAffine3], influences: &Influences, vertex: usize) -> DAffine3 {
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
