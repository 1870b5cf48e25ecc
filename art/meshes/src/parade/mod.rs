//! Makes the shot of the scene `parade`: a carnival giant walks over a sunny square, turns to us, smiles and blinks.

mod body;
mod dress;
mod face;
mod features;
mod flag;
mod rig;
mod skin;
mod square;
mod walk;

use glam::{DQuat, DVec3};
use serde_json::json;

use crate::curve::smoothstep;
use crate::glb::{Bend, Coat, Glb, Node, Target, linear};
use crate::poly_mesh::PolyMesh;

pub use flag::{cache, flag};

use body::Form;
use skin::Mood;

const FPS: f64 = 24.0;
/// Frames of the shot: two strides.
const FRAMES: usize = 48;
/// The direction in which the giant walks: its angle from +Z towards +X, degrees.
const HEADING: f64 = 56.0;

/// The bytes of `parade.glb`.
///
/// # Errors
/// A mesh cannot be written.
pub fn parade() -> anyhow::Result<Vec<u8>> {
    let mut shot = Glb::default();
    let stand =
        |shot: &mut Glb, name: &str, mesh: &PolyMesh, place: DVec3, turn_deg: f64| -> anyhow::Result<()> {
            let mesh = shot.mesh(mesh, &Coat::Palette)?;
            let turn = DQuat::from_rotation_y(turn_deg.to_radians());
            shot.node(Node { name, is: ("mesh", json!(mesh)), place, turn });
            Ok(())
        };
    stand(&mut shot, "Ground", &square::paving(), DVec3::ZERO, 0.0)?;
    let [left, right] = square::houses();
    stand(&mut shot, "House.L", &left, DVec3::new(-5.4, 0.0, -3.9), 6.0)?;
    stand(&mut shot, "House.R", &right, DVec3::new(0.95, 0.0, -3.6), -8.0)?;
    stand(&mut shot, "Wall.Far", &square::far_wall(), DVec3::ZERO, 0.0)?;
    stand(&mut shot, "Garland", &square::garland(), DVec3::ZERO, 0.0)?;
    stand(&mut shot, "Mast", &square::mast(), DVec3::ZERO, 0.0)?;
    giant(&mut shot)?;
    let sun = shot.light(json!({
        "name": "Sun", "type": "directional", "color": linear("#ffe3b4")?, "intensity": 3.2 * 683.0,
    }));
    let is = ("extensions", json!({ "KHR_lights_punctual": { "light": sun } }));
    shot.node(Node { name: "Sun", is, place: DVec3::ZERO, turn: looking(DVec3::new(0.50, -0.62, -0.60)) });
    let camera = Node { name: "Camera", is: ("camera", json!(0)), place: DVec3::ZERO, turn: DQuat::IDENTITY };
    let camera = shot.node(camera);
    shot.keys(camera, &tracking());
    Ok(shot.finish(32f64.to_radians()))
}

fn time_s(frame: usize) -> f64 {
    frame as f64 / FPS
}

/// The rotation from +Z to the way that the giant goes.
fn heading() -> DQuat {
    DQuat::from_rotation_y(HEADING.to_radians())
}

/// Where the giant is in a frame. In the middle of the shot it is at the origin.
fn root(frame: f64) -> DVec3 {
    let gone = (frame - 0.5 * (FRAMES - 1) as f64) / walk::STRIDE_FRAMES * walk::STRIDE;
    heading() * DVec3::Z * gone
}

/// The giant: a node that moves evenly, the skeleton under it, the body's skin, and what hangs on its joints.
fn giant(shot: &mut Glb) -> anyhow::Result<()> {
    let form = Form::new();
    let body = body::body(&form);
    let influences = rig::influences(&body, |at| form.part(at));
    let body = shot.smooth_mesh(&body, &Coat::Palette, &Bend::Joints(&influences))?;
    let is = ("children", json!([]));
    let root_node = shot.node(Node { name: "Rig", is, place: root(0.0), turn: heading() });
    let mut nodes: Vec<usize> = Vec::new();
    for (index, joint) in rig::JOINTS.iter().enumerate() {
        let parent = joint.parent.map_or(root_node, |parent| nodes[parent]);
        let node = json!({ "name": joint.name, "translation": rig::offset(index).to_array() });
        nodes.push(shot.child(parent, node));
    }
    let joints: Vec<(usize, DVec3)> =
        nodes.iter().zip(&rig::JOINTS).map(|(&node, joint)| (node, joint.at)).collect();
    shot.skinned("Giant", body, &joints);
    for (name, mesh, joint) in [
        ("Eye.L", features::eye(1.0), rig::HEAD),
        ("Eye.R", features::eye(-1.0), rig::HEAD),
        ("Hair", dress::hair(), rig::HEAD),
        ("Crown", dress::crown(), rig::HEAD),
        ("Ruff", dress::ruff(), rig::NECK),
    ] {
        let mesh = shot.smooth_mesh(&mesh, &Coat::Palette, &Bend::Never)?;
        shot.child(nodes[joint], json!({ "name": name, "mesh": mesh }));
    }
    let face = face(shot)?;
    let face = shot.child(nodes[rig::HEAD], json!({ "name": "Face", "mesh": face }));
    moves(shot, root_node, &nodes, face);
    Ok(())
}

/// Adds the face's mesh with its targets. Returns the mesh's index.
fn face(shot: &mut Glb) -> anyhow::Result<usize> {
    let rest = face::face(Mood::default());
    let targets: Vec<Target<'_>> = skin::MOODS
        .iter()
        .enumerate()
        .map(|(index, name)| {
            let full = |mood: usize| f64::from(u8::from(mood == index));
            let mood = Mood { smile: full(0), blink: full(1), brows: full(2) };
            Target { name, positions: face::face(mood).positions }
        })
        .collect();
    shot.smooth_mesh(&rest, &Coat::Tinted(&face::paint(&rest)?), &Bend::Targets(&targets))
}

/// Adds keys of the giant, of its joints and of its face, one for each frame.
fn moves(shot: &mut Glb, root_node: usize, nodes: &[usize], face: usize) {
    let way: Vec<(f64, DVec3, DQuat)> =
        (0..FRAMES).map(|frame| (time_s(frame), root(frame as f64), heading())).collect();
    shot.keys(root_node, &way);
    let poses: Vec<walk::Pose> = (0..FRAMES).map(|frame| walk::pose(frame as f64, glance(frame))).collect();
    let hips: Vec<(f64, DVec3, DQuat)> = poses
        .iter()
        .enumerate()
        .map(|(frame, pose)| (time_s(frame), pose.hips, pose.turns[rig::HIPS]))
        .collect();
    shot.keys(nodes[rig::HIPS], &hips);
    let turns = |joint: usize| poses.iter().map(|pose| pose.turns[joint]).collect();
    let turns: Vec<(usize, Vec<DQuat>)> =
        (rig::SPINE..rig::COUNT).map(|joint| (nodes[joint], turns(joint))).collect();
    let times: Vec<f64> = (0..FRAMES).map(time_s).collect();
    shot.turns(&times, &turns);
    let moods: Vec<(f64, [f64; 3])> = (0..FRAMES).map(|frame| (time_s(frame), mood(frame as f64))).collect();
    shot.weights(face, &moods);
}

/// 0 up to frame `from`, 1 from `full` to `ebbs`, and 0 again from `over` on; smooth between.
fn held([from, full, ebbs, over]: [f64; 4], frame: f64) -> f64 {
    smoothstep(from, full, frame) * (1.0 - smoothstep(ebbs, over, frame))
}

/// Where the giant looks: ahead, then to us, then ahead again.
fn glance(frame: usize) -> walk::Look {
    let frame = frame as f64;
    let to_us = held([4.0, 17.0, 36.0, 48.0], frame);
    [-54.0 * to_us, 2.0 + 2.0 * to_us, 5.0 * held([10.0, 22.0, 34.0, 46.0], frame)]
}

/// Weights of the face's shapes.
fn mood(frame: f64) -> [f64; 3] {
    let smile = 0.22 + 0.78 * held([11.0, 21.0, 37.0, 48.0], frame);
    let blink = held([25.0, 27.0, 28.0, 31.0], frame);
    let brows = 0.9 * held([12.0, 18.0, 30.0, 42.0], frame) - 0.9 * 0.4 * blink;
    [smile, blink, brows.max(0.0)]
}

/// The camera: low, it goes slowly along with the giant.
fn tracking() -> Vec<(f64, DVec3, DQuat)> {
    (0..FRAMES)
        .map(|frame| {
            let share = frame as f64 / (FRAMES - 1) as f64 - 0.5;
            let eye = DVec3::new(-0.06 + 0.20 * share, 0.62, 5.15 + 0.25 * share);
            let toward = DVec3::new(0.0 + 0.22 * share, 1.22, 0.0);
            (time_s(frame), eye, looking(toward - eye))
        })
        .collect()
}

/// The rotation that points −Z, the way cameras look and lights shine, along `along`, and keeps Y upwards.
fn looking(along: DVec3) -> DQuat {
    let back = -along.normalize();
    let right = DVec3::Y.cross(back).normalize();
    DQuat::from_mat3(&glam::DMat3::from_cols(right, back.cross(right), back))
}

#[cfg(test)]
mod tests {
    use body::Part;
    use glam::DMat4;

    use super::*;
    use crate::surface_net;

    /// For each joint, the transform that moves a point from rest into a pose.
    fn takes(pose: &walk::Pose) -> Vec<DMat4> {
        let placed = walk::placed(pose);
        let take = |(&(at, turn), joint): (&(DVec3, DQuat), &rig::Joint)| {
            DMat4::from_rotation_translation(turn, at) * DMat4::from_translation(-joint.at)
        };
        placed.iter().zip(&rig::JOINTS).map(take).collect()
    }

    /// The shares of each point sum to one, the skin does not fold up at a joint, and no arm goes through the tunic.
    #[test]
    fn the_body_bends_well() {
        let form = Form::new();
        let body = body::body(&form);
        let influences = rig::influences(&body, |at| form.part(at));
        assert!(
            influences
                .iter()
                .all(|four| (four.iter().map(|(_, share)| share).sum::<f64>() - 1.0).abs() < 1e-9)
        );
        let bends =
            [rig::UPPER_ARM, rig::FOREARM, rig::THIGH, rig::SHIN].map(|joint| [joint, joint + rig::SIDE]);
        let (mut deepest, mut thinnest) = (f64::INFINITY, f64::INFINITY);
        for frame in 0..FRAMES {
            let pose = walk::pose(frame as f64, glance(frame));
            let takes = takes(&pose);
            let placed = walk::placed(&pose);
            for (at, four) in body.positions.iter().zip(&influences) {
                let now: DVec3 =
                    four.iter().map(|&(joint, share)| takes[joint].transform_point3(*at) * share).sum();
                for joint in bends.as_flattened() {
                    let rest = at.distance(rig::JOINTS[*joint].at);
                    if rest < 0.10 {
                        thinnest = thinnest.min(now.distance(placed[*joint].0) / rest);
                    }
                }
                let arm = |side: usize| {
                    four.iter()
                        .filter(move |(joint, _)| (rig::FOREARM + side..=rig::HAND + side).contains(joint))
                };
                let share: f64 = arm(0).chain(arm(rig::SIDE)).map(|(_, share)| share).sum();
                if share > 0.95 {
                    for joint in [rig::HIPS, rig::SPINE] {
                        let back = takes[joint].inverse().transform_point3(now);
                        let trunk = form.parts(back).into_iter().find(|(part, _)| *part == Part::Trunk);
                        deepest = deepest.min(trunk.map_or(f64::INFINITY, |(_, distance)| distance));
                    }
                }
            }
        }
        assert!(deepest > 0.0, "an arm is {deepest} in the tunic");
        assert!(thinnest > 0.6, "the skin shrinks to {thinnest} at a joint");
    }

    /// The faces of the body wind outwards, except a few small ones between the legs.
    #[test]
    fn the_body_winds_outwards() {
        let form = Form::new();
        let body = body::body(&form);
        let (mut whole, mut wrong) = (0.0, 0.0);
        for face in &body.faces {
            let at: Vec<DVec3> = face.corners.iter().map(|&corner| body.positions[corner]).collect();
            for corner in 2..at.len() {
                let area = (at[corner - 1] - at[0]).cross(at[corner] - at[0]);
                let middle = (at[0] + at[corner - 1] + at[corner]) / 3.0;
                let slope = surface_net::slope(middle, form.distance(middle), &|at| form.distance(at));
                whole += area.length();
                if area.dot(slope) <= 0.0 {
                    wrong += area.length();
                }
            }
        }
        assert!(wrong < 1e-3 * whole, "{wrong} of {whole}");
    }
}
