//! Which vertices with the same place at rest stay together when the surface bends.

use std::cmp::Ordering;

use glam::Vec3;

use super::Bend;

/// Says which vertices with the same place at rest stay together.
#[derive(Clone, Copy, Debug)]
pub enum Bonds<'a> {
    /// All of them.
    All,
    /// Those that follow the same point of a point cache. The list holds, for each vertex, the index of its point.
    Points(&'a [u32]),
    /// Those that targets and joints move alike.
    Bend(&'a Bend),
}

impl Bonds<'_> {
    /// Equal where two vertices stay together.
    pub(super) fn compare(&self, a: u32, b: u32) -> Ordering {
        match self {
            Self::All => Ordering::Equal,
            Self::Points(points) => points[a as usize].cmp(&points[b as usize]),
            Self::Bend(bend) => bend.compare(a, b),
        }
    }
}

impl Bend {
    fn compare(&self, a: u32, b: u32) -> Ordering {
        let bound = |vertex: u32| ordered(self.bound.positions[vertex as usize]);
        let steps = |vertex: u32| {
            self.targets.iter().map(move |target| match target.vertices.binary_search(&vertex) {
                Ok(entry) => ordered(target.positions[entry]),
                Err(_) => ordered(Vec3::ZERO),
            })
        };
        let joints = |vertex: u32| {
            self.skin.iter().flat_map(move |skin| {
                let range = vertex as usize * skin.per_vertex..(vertex as usize + 1) * skin.per_vertex;
                let all = skin.joints[range.clone()].iter().zip(&skin.weights[range]);
                all.filter(|(_, weight)| **weight > 0.0).map(|(joint, weight)| (*joint, weight.to_bits()))
            })
        };
        bound(a).cmp(&bound(b)).then_with(|| joints(a).cmp(joints(b))).then_with(|| steps(a).cmp(steps(b)))
    }
}

/// Numbers that can be compared; −0 and 0 are the same.
fn ordered(vector: Vec3) -> [u32; 3] {
    vector.to_array().map(|value| (value + 0.0).to_bits())
}
