//! The giant's walk: for each frame, how each joint is turned. The left leg's stride begins when its heel meets the
//! ground. The right leg is half a stride later.

use std::f64::consts::TAU;

use glam::{DMat3, DQuat, DVec3};

use super::rig::{
    CHEST, COUNT, FOOT, FOREARM, HAND, HEAD, HIPS, JOINTS, NECK, SHIN, SHOULDER, SIDE, SPINE, THIGH, TOES,
    UPPER_ARM, offset,
};
use crate::curve::smoothstep;

/// Frames of one stride: two steps.
pub const STRIDE_FRAMES: f64 = 24.0;
/// How far a stride goes.
pub const STRIDE: f64 = 1.06;

/// How long a foot stays on the ground, as a share of the stride.
const STANCE: f64 = 0.62;
/// How far in front of the hips the ankle would be when the heel meets the ground, if the foot were flat.
const REACH: f64 = 0.285;
/// From when to when the whole sole is on the ground, as shares of the stride. After that the heel rises.
const SOLE: [f64; 2] = [0.11, 0.36];
/// How far the toes point up (negative: down) when the heel meets the ground, and when they leave it, degrees.
const PITCH: [f64; 2] = [20.0, -44.0];
/// How far the feet point outwards, degrees.
const OUT: f64 = 7.0;

/// The giant's pose in a frame, in a space that moves evenly with it.
pub struct Pose {
    /// Where the hips are.
    pub hips: DVec3,
    /// How each joint is turned, relative to its parent.
    pub turns: [DQuat; COUNT],
}

/// How the head is turned from the way ahead, degrees: to its left, down, and to its right shoulder.
pub type Look = [f64; 3];

/// The pose in a frame; `look` turns the head.
pub fn pose(frame: f64, look: Look) -> Pose {
    let phase = frame / STRIDE_FRAMES;
    let wave = |shift: f64| (TAU * (phase - shift)).cos();
    let bob = (2.0 * TAU * (phase - 0.31)).cos();
    let hips = DVec3::new(0.024 * wave(0.3), 0.822 + 0.022 * bob, 0.0);
    // Rotations in the space that moves with the giant. At the end they are made relative to the parents.
    let mut turns = [DQuat::IDENTITY; COUNT];
    turns[HIPS] = turn(1.5, -8.0 * wave(0.0), 3.5 * wave(0.2));
    turns[SPINE] = turn(2.0 + 0.8 * bob, 1.0 * wave(0.02), 0.5 * wave(0.2));
    turns[CHEST] = turn(3.5 + 1.2 * bob, 9.0 * wave(0.03) + 0.10 * look[0], -2.5 * wave(0.2));
    let [left, down, tilt] = look;
    let nod = 1.8 * (2.0 * TAU * (phase - 0.40)).cos();
    turns[HEAD] = turn(down + nod, left + 1.5 * wave(0.1), tilt - 2.0 * wave(0.26));
    turns[NECK] = turns[CHEST].slerp(turns[HEAD], 0.45);
    for (first, shift) in [(0, 0.0), (SIDE, 0.5)] {
        arm(&mut turns, first, phase - shift);
        leg(&mut turns, first, phase - shift, hips);
    }
    let seen = |joint: usize| {
        JOINTS[joint]
            .parent
            .map_or(turns[joint], |parent| (turns[parent].inverse() * turns[joint]).normalize())
    };
    Pose { hips, turns: std::array::from_fn(seen) }
}

/// The rotation Y(`left`) X(`down`) Z(`tilt`), angles in degrees; `tilt` is towards the right shoulder.
fn turn(down: f64, left: f64, tilt: f64) -> DQuat {
    DQuat::from_rotation_y(left.to_radians())
        * DQuat::from_rotation_x(down.to_radians())
        * DQuat::from_rotation_z(tilt.to_radians())
}

/// Swings an arm against the leg of its side. `first` is 0 for the left arm, [`SIDE`] for the right one.
fn arm(turns: &mut [DQuat; COUNT], first: usize, phase: f64) {
    let side = if first == 0 { 1.0 } else { -1.0 };
    let swing = |lag: f64| -(TAU * (phase - 0.02 - lag)).cos();
    let about_z = |degrees: f64| DQuat::from_rotation_z((side * degrees).to_radians());
    let forwards = |degrees: f64| DQuat::from_rotation_x(-degrees.to_radians());
    turns[SHOULDER + first] = turns[CHEST] * DQuat::from_rotation_y((-side * 4.0 * swing(0.0)).to_radians());
    // In the rest pose the arm stands out by forty degrees. In the walk it stands out by about twenty degrees less, but
    // a little farther at both ends of its swing.
    let hang = about_z(-20.0 + 3.0 * swing(0.0).abs());
    turns[UPPER_ARM + first] = turns[SHOULDER + first] * forwards(3.0 + 27.0 * swing(0.0)) * hang;
    // The elbow bends in the plane of the arm and the way ahead, and a little inwards.
    let along = offset(FOREARM + first).normalize();
    let hinge = along.cross(DVec3::new(-0.30 * side, 0.0, 1.0)).normalize();
    let bend = 17.0 + 13.0 * swing(0.07);
    turns[FOREARM + first] = turns[UPPER_ARM + first] * DQuat::from_axis_angle(hinge, bend.to_radians());
    turns[HAND + first] =
        turns[FOREARM + first] * DQuat::from_axis_angle(hinge, (8.0 + 9.0 * swing(0.14)).to_radians());
}

/// Places a foot and bends the leg to it.
fn leg(turns: &mut [DQuat; COUNT], first: usize, phase: f64, hips: DVec3) {
    let [thigh, shin] = [offset(SHIN + first), offset(FOOT + first)];
    let foot = step(phase, first);
    let hip = hips + turns[HIPS] * offset(THIGH + first);
    let ahead = (foot.level * DVec3::Z + turns[HIPS] * DVec3::Z).normalize();
    let knee = bent(hip, foot.ankle, [thigh.length(), shin.length()], ahead);
    turns[THIGH + first] = aim([knee - hip, ahead], [thigh, DVec3::Z]);
    turns[SHIN + first] = aim([foot.ankle - knee, ahead], [shin, DVec3::Z]);
    turns[FOOT + first] = foot.sole;
    turns[TOES + first] = foot.toes;
}

/// Where the knee of a leg from `hip` to `ankle` is. It bends towards `ahead`. The bones have the lengths `upper` and
/// `lower`.
fn bent(hip: DVec3, ankle: DVec3, [upper, lower]: [f64; 2], ahead: DVec3) -> DVec3 {
    let reach = (ankle - hip).length().min(0.9995 * (upper + lower));
    let along = (ankle - hip).normalize();
    let across = (ahead - along * along.dot(ahead)).normalize();
    let down = (upper * upper - lower * lower + reach * reach) / (2.0 * reach);
    hip + along * down + across * (upper * upper - down * down).max(0.0).sqrt()
}

/// The rotation that takes a bone from `rest` to `now`. Both state the bone's direction and the direction it faces.
fn aim(now: [DVec3; 2], rest: [DVec3; 2]) -> DQuat {
    let frame = |[along, ahead]: [DVec3; 2]| {
        let y = along.normalize();
        let z = (ahead - y * y.dot(ahead)).normalize();
        DQuat::from_mat3(&DMat3::from_cols(y.cross(z), y, z))
    };
    frame(now) * frame(rest).inverse()
}

/// A foot in a moment of its stride.
struct Foot {
    ankle: DVec3,
    /// How it would be turned if it stood flat.
    level: DQuat,
    sole: DQuat,
    toes: DQuat,
}

fn step(phase: f64, first: usize) -> Foot {
    let phase = phase.rem_euclid(1.0);
    let side = if first == 0 { 1.0 } else { -1.0 };
    let level = DQuat::from_rotation_y((side * OUT).to_radians());
    let (ankle, pitch) = if phase < STANCE { stance(phase, level) } else { swing(phase, level) };
    let sole = level * pitched(pitch);
    // While the heel rises the toes stay on the ground; in the air they straighten.
    let kept = if phase < STANCE { 1.0 } else { 1.0 - smoothstep(STANCE, STANCE + 0.14, phase) };
    let toes = level * pitched(pitch - kept * pitch.min(0.0));
    let across = DVec3::X * (side * 0.092);
    Foot { ankle: ankle + across, level, sole, toes }
}

/// The turn of a foot whose toes point up by this many degrees.
fn pitched(up: f64) -> DQuat {
    DQuat::from_rotation_x(-up.to_radians())
}

/// The ankle, and how far the toes point up in degrees, while the foot is on the ground: it rolls over the heel,
/// stands, and rolls over the ball. The ground under it moves back evenly.
fn stance(phase: f64, level: DQuat) -> (DVec3, f64) {
    const HEEL: DVec3 = DVec3::new(0.0, -0.085, -0.060);
    let ball = offset(TOES) * DVec3::new(0.0, 1.0, 1.0);
    let flat = DVec3::new(0.0, JOINTS[FOOT].at.y, REACH - STRIDE * phase);
    let pitch = if phase < SOLE[1] {
        PITCH[0] * (1.0 - smoothstep(0.0, SOLE[0], phase))
    } else {
        PITCH[1] * ((phase - SOLE[1]) / (STANCE - SOLE[1])).powf(1.6)
    };
    let pivot = if phase < SOLE[1] { HEEL } else { ball };
    (flat + level * pivot - level * (pitched(pitch) * pivot), pitch)
}

/// The ankle, and how far the toes point up in degrees, while the foot is in the air, from where it left the ground to
/// where it meets it again.
fn swing(phase: f64, level: DQuat) -> (DVec3, f64) {
    const STEP: f64 = 1e-3;
    let share = (phase - STANCE) / (1.0 - STANCE);
    let (from, _) = stance(STANCE, level);
    let (to, _) = stance(0.0, level);
    // The ankle leaves the ground and lands with the velocity that it has on the ground.
    let rate = (1.0 - STANCE) / STEP;
    let leaving = (from - stance(STANCE - STEP, level).0) * rate;
    let landing = (stance(STEP, level).0 - to) * rate;
    let (s2, s3) = (share * share, share * share * share);
    let ankle = from * (2.0 * s3 - 3.0 * s2 + 1.0)
        + leaving * (s3 - 2.0 * s2 + share)
        + to * (3.0 * s2 - 2.0 * s3)
        + landing * (s3 - s2);
    let lift = 0.035 * (0.5 - 0.5 * (TAU * share).cos());
    let pitch = PITCH[1] + (PITCH[0] - PITCH[1]) * smoothstep(0.0, 0.85, share);
    (ankle + DVec3::Y * lift, pitch)
}

/// Where each joint is in a pose, and how it is turned, in the space that moves with the giant.
#[cfg(test)]
pub fn placed(pose: &Pose) -> [(DVec3, DQuat); COUNT] {
    let mut placed = [(pose.hips, pose.turns[HIPS]); COUNT];
    for joint in 1..COUNT {
        if let Some(parent) = JOINTS[joint].parent {
            let (at, turn) = placed[parent];
            placed[joint] = (at + turn * offset(joint), turn * pose.turns[joint]);
        }
    }
    placed
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A foot on the ground stays where it is while the giant moves on over it.
    #[test]
    fn feet_do_not_slide() {
        for first in [0, SIDE] {
            for (from, to, joint) in [(0.11, 0.36, FOOT), (0.11, 0.61, TOES)] {
                let mut stood: Option<DVec3> = None;
                for step in 0..=100 {
                    let phase = from + (to - from) * f64::from(step) / 100.0;
                    let phase = if first == 0 { phase } else { phase + 0.5 };
                    let placed = placed(&pose(phase * STRIDE_FRAMES, [0.0; 3]));
                    let at = placed[joint + first].0 + DVec3::Z * (STRIDE * phase);
                    assert!(at.distance(*stood.get_or_insert(at)) < 0.002, "{phase}: {at}");
                }
            }
        }
    }

    /// No toe or heel is ever under the ground, and the stride closes.
    #[test]
    fn feet_stay_above_the_ground() {
        for step in 0..240 {
            let pose = pose(f64::from(step) / 10.0, [0.0; 3]);
            let placed = placed(&pose);
            for first in [0, SIDE] {
                let (ankle, turn) = placed[FOOT + first];
                let heel = ankle + turn * DVec3::new(0.0, -0.085, -0.06);
                let (ball, turn) = placed[TOES + first];
                let tip = ball + turn * DVec3::new(0.0, -0.03, 0.08);
                assert!(heel.y > -0.004 && tip.y > -0.004, "frame {}: {heel} {tip}", f64::from(step) / 10.0);
            }
        }
        let ends = [0.0, STRIDE_FRAMES].map(|frame| placed(&pose(frame, [0.0; 3])));
        for (from, to) in ends[0].iter().zip(&ends[1]) {
            assert!(from.0.distance(to.0) < 1e-9);
        }
    }
}
