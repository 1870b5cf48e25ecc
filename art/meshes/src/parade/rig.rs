//! The giant's skeleton: its joints at rest, and how much each point of the skin follows each joint. The giant stands
//! on y = 0 and looks to +Z; its left is +X.

use glam::DVec3;

use super::body::Part;
use crate::curve::smoothstep;
use crate::glb::Influence;
use crate::poly_mesh::PolyMesh;

/// A joint at rest.
pub struct Joint {
    pub name: &'static str,
    /// Index of the joint that carries it; the first joint has none.
    pub parent: Option<usize>,
    /// Where it is.
    pub at: DVec3,
}

/// The joints of the trunk.
pub const HIPS: usize = 0;
pub const SPINE: usize = 1;
pub const CHEST: usize = 2;
pub const NECK: usize = 3;
pub const HEAD: usize = 4;
/// The joints of the left arm and leg. Add `SIDE` to get those on the right.
pub const SHOULDER: usize = 5;
pub const UPPER_ARM: usize = 6;
pub const FOREARM: usize = 7;
pub const HAND: usize = 8;
pub const THIGH: usize = 9;
pub const SHIN: usize = 10;
pub const FOOT: usize = 11;
pub const TOES: usize = 12;
pub const SIDE: usize = 8;
/// How many joints there are.
pub const COUNT: usize = 21;

const fn joint(name: &'static str, parent: Option<usize>, at: [f64; 3]) -> Joint {
    Joint { name, parent, at: DVec3::from_array(at) }
}

/// Every joint, its parent before it.
pub const JOINTS: [Joint; COUNT] = [
    joint("Hips", None, [0.0, 0.86, 0.0]),
    joint("Spine", Some(HIPS), [0.0, 0.98, 0.0]),
    joint("Chest", Some(SPINE), [0.0, 1.16, 0.0]),
    joint("Neck", Some(CHEST), [0.0, 1.40, -0.01]),
    joint("Head", Some(NECK), [0.0, 1.48, 0.0]),
    joint("Shoulder.L", Some(CHEST), [0.06, 1.34, -0.01]),
    joint("UpperArm.L", Some(SHOULDER), [0.185, 1.325, -0.01]),
    joint("Forearm.L", Some(UPPER_ARM), [0.365, 1.110, -0.01]),
    joint("Hand.L", Some(FOREARM), [0.525, 0.920, 0.0]),
    joint("Thigh.L", Some(HIPS), [0.10, 0.84, 0.0]),
    joint("Shin.L", Some(THIGH), [0.115, 0.46, 0.015]),
    joint("Foot.L", Some(SHIN), [0.12, 0.085, -0.015]),
    joint("Toes.L", Some(FOOT), [0.125, 0.03, 0.13]),
    joint("Shoulder.R", Some(CHEST), [-0.06, 1.34, -0.01]),
    joint("UpperArm.R", Some(SHOULDER + SIDE), [-0.185, 1.325, -0.01]),
    joint("Forearm.R", Some(UPPER_ARM + SIDE), [-0.365, 1.110, -0.01]),
    joint("Hand.R", Some(FOREARM + SIDE), [-0.525, 0.920, 0.0]),
    joint("Thigh.R", Some(HIPS), [-0.10, 0.84, 0.0]),
    joint("Shin.R", Some(THIGH + SIDE), [-0.115, 0.46, 0.015]),
    joint("Foot.R", Some(SHIN + SIDE), [-0.12, 0.085, -0.015]),
    joint("Toes.R", Some(FOOT + SIDE), [-0.125, 0.03, 0.13]),
];

/// Where a joint rests, relative to its parent.
pub fn offset(joint: usize) -> DVec3 {
    let Joint { parent, at, .. } = JOINTS[joint];
    at - parent.map_or(DVec3::ZERO, |parent| JOINTS[parent].at)
}

/// How much one point follows each joint.
type Shares = [f64; COUNT];

/// The joints that each point of the skin follows. First a point follows the joints that `own` gives for the part that
/// it lies on. Then the shares are smoothed along the skin, so that the skin bends in curves.
pub fn influences(mesh: &PolyMesh, part: impl Fn(DVec3) -> Part) -> Vec<Influence> {
    const ROUNDS: usize = 12;
    let mut neighbours = vec![Vec::new(); mesh.positions.len()];
    for face in &mesh.faces {
        for (index, &from) in face.corners.iter().enumerate() {
            neighbours[from].push(face.corners[(index + 1) % face.corners.len()]);
        }
    }
    let mut shares: Vec<Shares> = mesh.positions.iter().map(|&at| own(at, part(at))).collect();
    for _ in 0..ROUNDS {
        let before = shares.clone();
        for ((shares, around), at) in shares.iter_mut().zip(&neighbours).zip(&mesh.positions) {
            // The faster shares even out, the softer the skin bends: soft above the skirt's hem, sharp at the feet.
            let speed = if at.y < 0.14 { 0.18 } else { 0.25 + 0.30 * smoothstep(0.5, 0.7, at.y) };
            for (joint, share) in shares.iter_mut().enumerate() {
                let mean = around.iter().map(|&to| before[to][joint]).sum::<f64>() / around.len() as f64;
                *share += speed * (mean - *share);
            }
        }
    }
    shares.iter().map(greatest).collect()
}

/// The four greatest shares, the greatest first, scaled so that they sum to one.
fn greatest(shares: &Shares) -> Influence {
    let mut order: Vec<usize> = (0..COUNT).collect();
    order.sort_by(|&a, &b| shares[b].total_cmp(&shares[a]));
    let four: [usize; 4] = std::array::from_fn(|index| order[index]);
    // Shares up to 0.005 make no difference that can be seen.
    let four = four.map(|joint| (joint, if shares[joint] > 0.005 { shares[joint] } else { 0.0 }));
    let sum: f64 = four.iter().map(|(_, share)| share).sum();
    four.map(|(joint, share)| if share > 0.0 { (joint, share / sum) } else { (0, 0.0) })
}

/// The shares of a point that lies on `part`, before they are smoothed.
fn own(at: DVec3, part: Part) -> Shares {
    let mut shares = [0.0; COUNT];
    let side = if at.x < 0.0 { SIDE } else { 0 };
    match part {
        Part::Neck => shares[NECK] = 1.0,
        Part::Trunk if at.y > JOINTS[CHEST].at.y => {
            let outwards = smoothstep(0.10, 0.16, at.x.abs()) * smoothstep(1.24, 1.32, at.y);
            shares[SHOULDER + side] = outwards;
            shares[CHEST] = 1.0 - outwards;
        }
        Part::Trunk if at.y > JOINTS[SPINE].at.y => shares[SPINE] = 1.0,
        Part::Trunk => {
            // The skirt follows the hips, and more and more the legs towards its hem.
            let legs = 0.75 * smoothstep(0.90, 0.66, at.y);
            let left = smoothstep(-0.10, 0.10, at.x);
            shares[HIPS] = 1.0 - legs;
            shares[THIGH] = legs * left;
            shares[THIGH + SIDE] = legs * (1.0 - left);
        }
        Part::Arm => {
            let along = |joint: usize| {
                let at = DVec3::new(at.x.abs(), at.y, at.z);
                let (from, to) = (JOINTS[joint].at, JOINTS[joint + 1].at);
                (at - from).dot(to - from) / (to - from).length_squared()
            };
            let joint = if along(UPPER_ARM) < 0.0 {
                SHOULDER
            } else if along(FOREARM) < 0.0 {
                UPPER_ARM
            } else if along(FOREARM) < 1.0 {
                FOREARM
            } else {
                HAND
            };
            shares[joint + side] = 1.0;
        }
        Part::Hand => shares[HAND + side] = 1.0,
        Part::Leg => {
            let joint = if at.y > JOINTS[SHIN].at.y { THIGH } else { SHIN };
            shares[joint + side] = 1.0;
        }
        Part::Shoe => {
            let joint = if at.z > JOINTS[TOES].at.z { TOES } else { FOOT };
            shares[joint + side] = 1.0;
        }
    }
    shares
}
