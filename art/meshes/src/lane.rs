//! Makes the shot of the scene `lane`: a walk towards a cottage at evening, while a striped ball rolls by.

use std::f64::consts::TAU;

use glam::{DQuat, DVec2, DVec3};
use serde_json::json;

use crate::curve::hash;
use crate::glb::{Coat, Glb, Node, linear};
use crate::poly_mesh::{Look, PolyMesh};
use crate::{cottage, tree};

const FPS: f64 = 24.0;
const LAST: usize = 48;
const BALL_RADIUS: f64 = 0.3;

/// The luminous intensity, in candela, that exporters write for a lamp of one watt.
const PER_WATT: f64 = 683.0 / (2.0 * TAU);

/// The bytes of `lane.glb`.
///
/// # Errors
/// A mesh cannot be written.
pub fn lane() -> anyhow::Result<Vec<u8>> {
    let mut shot = Glb::default();
    let paving = paving(&mut shot)?;
    add(&mut shot, "Paving", paving, DVec3::ZERO, 0.0);
    let house = shot.mesh(&cottage::cottage(), &Coat::Palette)?;
    add(&mut shot, "Cottage", house, DVec3::new(0.55, 0.0, -0.9), -14.0);
    let poplar = shot.mesh(&tree::poplar(), &Coat::Palette)?;
    for (name, x, z) in [("Poplar", -1.7, -1.6), ("Poplar.001", -2.6, -2.3), ("Poplar.002", 2.6, -2.1)] {
        add(&mut shot, name, poplar, DVec3::new(x, 0.0, z), 40.0 * x);
    }
    let ball = ball(&mut shot)?;
    let ball = add(&mut shot, "Ball", ball, DVec3::ZERO, 0.0);
    shot.keys(ball, &rolling());
    lights(&mut shot)?;
    let camera = Node { name: "Walker", is: ("camera", json!(0)), place: DVec3::ZERO, turn: DQuat::IDENTITY };
    let camera = shot.node(camera);
    shot.keys(camera, &walking());
    Ok(shot.finish(34f64.to_radians()))
}

fn add(shot: &mut Glb, name: &str, mesh: usize, place: DVec3, turn_deg: f64) -> usize {
    let turn = DQuat::from_rotation_y(turn_deg.to_radians());
    shot.node(Node { name, is: ("mesh", json!(mesh)), place, turn })
}

/// Adds a floor of 14 by 12 units with a texture of flagstones. Returns the index of its mesh.
fn paving(shot: &mut Glb) -> anyhow::Result<usize> {
    const SIDES: [usize; 2] = [28, 24];
    const SIDE_PX: u32 = 64;
    let mut rgb8 = Vec::new();
    for row in 0..SIDE_PX {
        for column in 0..SIDE_PX {
            // Two courses of two stones, the second shifted by half a stone; the joints are dark.
            let course = row / 32;
            let along = (column + 16 * course) % SIDE_PX;
            let is_joint = row % 32 < 2 || along % 32 < 2;
            let stone = course * 2 + along / 32;
            let grain = hash([row, column, 5]) * 10.0;
            let [red, green, blue] = match stone {
                _ if is_joint => [118.0, 104.0, 92.0],
                0 => [205.0, 182.0, 150.0],
                1 => [186.0, 160.0, 132.0],
                2 => [214.0, 196.0, 166.0],
                _ => [176.0, 158.0, 146.0],
            };
            rgb8.extend([red, green, blue].map(|channel: f64| (channel + grain) as u8));
        }
    }
    let texture = shot.texture("flagstones", [SIDE_PX, SIDE_PX], &rgb8)?;
    let material = shot.material("flagstones", [1.0; 3], Some(texture), 0.9);
    let mut floor = PolyMesh::new("paving", "A floor of flagstones.", &[]);
    let at = |column: usize, row: usize| DVec2::new(column as f64 * 0.5 - 7.0, 7.0 - row as f64 * 0.5);
    let place = |column, row| {
        let at = at(column, row);
        DVec3::new(at.x, 0.0, at.y)
    };
    floor.sheet(SIDES, place, |_, _| Look { group: "floor", material: "flagstones" });
    // The texture repeats every 2.4 units.
    let uvs: Vec<DVec2> = floor.positions.iter().map(|point| DVec2::new(point.x, point.z) / 2.4).collect();
    shot.mesh(&floor, &Coat::Texture(material, &uvs))
}

/// Adds a ball that is striped by vertex colours. Returns the index of its mesh.
fn ball(shot: &mut Glb) -> anyhow::Result<usize> {
    const SIDES: [usize; 2] = [24, 48];
    let mut ball = PolyMesh::new("ball", "A striped ball.", &[]);
    let mut colors = Vec::new();
    let stripes = [linear("#c8402f")?, linear("#f0dfb8")?, linear("#2f6d8c")?].map(DVec3::from);
    let point = |row: usize, segment: usize| {
        let (polar, round) = (0.5 * TAU * row as f64 / 24.0, TAU * segment as f64 / 48.0);
        DVec3::new(polar.sin() * round.cos(), polar.cos(), -polar.sin() * round.sin()) * BALL_RADIUS
    };
    ball.lathe(SIDES, point, |_, _| Look { group: "ball", material: "ball" });
    for at in &ball.positions {
        let round = (-at.z).atan2(at.x).rem_euclid(TAU) / TAU;
        colors.push(stripes[(round * 6.0 + 1e-9) as usize % 3]);
    }
    shot.mesh(&ball, &Coat::Colors(&colors))
}

/// Place and turn of the ball: it rolls without slipping along a straight line, and slows down a little.
fn rolling() -> Vec<(f64, DVec3, DQuat)> {
    let (from, to) = (DVec3::new(-2.3, BALL_RADIUS, 0.55), DVec3::new(1.1, BALL_RADIUS, 1.5));
    let way = (to - from).normalize();
    let axle = DVec3::Y.cross(way);
    let start = DQuat::from_rotation_arc(DVec3::Y, axle);
    (0..=LAST / 2)
        .map(|key| {
            let share = 2.0 * key as f64 / LAST as f64;
            let gone = share * (1.25 - 0.25 * share);
            let place = from.lerp(to, gone);
            let turn = DQuat::from_axis_angle(axle, place.distance(from) / BALL_RADIUS);
            (2.0 * key as f64 / FPS, place, turn * start)
        })
        .collect()
}

/// Place and turn of the camera: the view of someone who walks at two steps a second and looks at the door.
fn walking() -> Vec<(f64, DVec3, DQuat)> {
    (0..=LAST / 2)
        .map(|key| {
            let (time_s, share) = (2.0 * key as f64 / FPS, 2.0 * key as f64 / LAST as f64);
            let (bob, sway) = ((TAU * 2.0 * time_s).sin() * 0.025, (TAU * time_s).sin() * 0.02);
            let eye = DVec3::new(-0.75 + 0.6 * share + sway, 1.25 + bob, 5.9 - 1.2 * share);
            let toward = DVec3::new(0.05 + 0.25 * share, 0.95, -0.5);
            (time_s, eye, looking(toward - eye))
        })
        .collect()
}

/// The rotation that points −Z, the way cameras look and lights shine, along `along`, and keeps Y upwards.
fn looking(along: DVec3) -> DQuat {
    let back = -along.normalize();
    let right = DVec3::Y.cross(back).normalize();
    DQuat::from_mat3(&glam::DMat3::from_cols(right, back.cross(right), back))
}

fn lights(shot: &mut Glb) -> anyhow::Result<()> {
    let watts = |watts: f64| watts * PER_WATT;
    let lights = [
        ("Sun", "directional", "#ffdcae", 3.2 * 683.0, DVec3::ZERO, DVec3::new(0.75, -0.55, -0.55)),
        ("Lantern", "point", "#ffb45e", watts(26.0), DVec3::new(0.75, 0.9, 0.05), DVec3::NEG_Z),
        ("Lamp", "spot", "#bcd4ff", watts(150.0), DVec3::new(-2.9, 3.6, 2.2), DVec3::new(0.62, -0.7, -0.42)),
    ];
    for (name, kind, color, intensity, place, along) in lights {
        let mut light =
            json!({ "name": name, "type": kind, "color": linear(color)?, "intensity": intensity });
        if kind == "spot" {
            light["spot"] = json!({ "innerConeAngle": 0.3, "outerConeAngle": 0.5 });
        }
        let light = shot.light(light);
        let is = ("extensions", json!({ "KHR_lights_punctual": { "light": light } }));
        shot.node(Node { name, is, place, turn: looking(along) });
    }
    Ok(())
}
