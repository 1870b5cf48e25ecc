//! Tests the poses that [`Animator`] gives at a time, against closed forms.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::{DAffine3, DQuat, DVec3};
use serde_json::{Value, json};

use crate::build::{Buffer, good, lines};
use impasto_gltf::{Animator, Gltf, Lens, Playing, Posed};

/// A shot in the making: the tracks of one animation, and the rest of the document.
struct Shot {
    buffer: Buffer,
    samplers: Vec<Value>,
    channels: Vec<Value>,
    rest: Value,
}

impl Shot {
    fn new(rest: Value) -> Self {
        Self { buffer: Buffer::default(), samplers: Vec::new(), channels: Vec::new(), rest }
    }

    fn track(
        mut self,
        target: Value,
        (kind, interpolation): (&str, &str),
        times: &[f32],
        values: &[f32],
    ) -> Self {
        let input = self.buffer.floats("SCALAR", times);
        let output = self.buffer.floats(kind, values);
        self.channels.push(json!({ "sampler": self.samplers.len(), "target": target }));
        self.samplers.push(json!({ "input": input, "output": output, "interpolation": interpolation }));
        self
    }

    fn read(self) -> Gltf {
        let mut document = self.buffer.finish(self.rest);
        document["animations"] =
            json!([{ "name": "A", "samplers": self.samplers, "channels": self.channels }]);
        good(&document).0
    }

    fn at(self, time_s: f64) -> Posed {
        at(&self.read(), time_s)
    }
}

fn at(gltf: &Gltf, time_s: f64) -> Posed {
    let (animator, warnings) = Animator::new(gltf, Playing::All).expect("all may play");
    assert!(warnings.is_empty(), "{}", lines(&warnings));
    animator.pose(time_s)
}

fn node(path: &str) -> Value {
    json!({ "node": 0, "path": path })
}

fn one_node() -> Value {
    json!({ "nodes": [{}] })
}

const THREE: [f32; 9] = [0., 0., 0., 2., 4., 8., 0., 4., 0.];

#[test]
fn steps_hold_and_lines_go_straight() {
    for (interpolation, time_s, expected) in [
        ("STEP", -5.0, [0., 0., 0.]),
        ("STEP", 0.999, [0., 0., 0.]),
        ("STEP", 1.0, [2., 4., 8.]),
        ("STEP", 2.999, [2., 4., 8.]),
        ("STEP", 99.0, [0., 4., 0.]),
        ("LINEAR", -5.0, [0., 0., 0.]),
        ("LINEAR", 0.25, [0.5, 1., 2.]),
        ("LINEAR", 1.0, [2., 4., 8.]),
        ("LINEAR", 2.0, [1., 4., 4.]),
        ("LINEAR", 99.0, [0., 4., 0.]),
        ("LINEAR", f64::NAN, [0., 0., 0.]),
    ] {
        let shot =
            Shot::new(one_node()).track(node("translation"), ("VEC3", interpolation), &[0., 1., 3.], &THREE);
        let world = shot.at(time_s).world_from_node[0];
        assert!(
            world.translation.abs_diff_eq(DVec3::from(expected), 1e-12),
            "{interpolation} at {time_s}: {world}"
        );
    }
}

/// A spline whose keys and tangents are those of a cubic is that cubic.
#[test]
fn splines_give_a_cubic_again() {
    let place = |t: f64| 0.5 * t * t * t - t * t + 2.0 * t - 1.0;
    let slope = |t: f64| 1.5 * t * t - 2.0 * t + 2.0;
    let times = [0.0_f32, 0.5, 2.0, 2.25];
    let values: Vec<f32> = times
        .iter()
        .flat_map(|&time| {
            let time = f64::from(time);
            [slope(time), place(time), slope(time)]
                .into_iter()
                .flat_map(|number| [number as f32, 0.0, -number as f32])
        })
        .collect();
    let gltf =
        Shot::new(one_node()).track(node("translation"), ("VEC3", "CUBICSPLINE"), &times, &values).read();
    for step in 0..=90 {
        let time_s = f64::from(step) * 0.025;
        let expected = DVec3::new(place(time_s), 0.0, -place(time_s));
        let found = at(&gltf, time_s).world_from_node[0].translation;
        assert!(found.abs_diff_eq(expected, 1e-12), "{time_s}: {found} for {expected}");
    }
}

#[test]
fn turns_take_the_shortest_way_at_even_speed() {
    let turn = |angle: f64| DQuat::from_rotation_z(angle).as_quat().to_array();
    let (from, to) = (turn(0.2), turn(1.4));
    for sign in [1.0, -1.0] {
        let values: Vec<f32> = from.into_iter().chain(to.map(|number| number * sign)).collect();
        let gltf =
            Shot::new(one_node()).track(node("rotation"), ("VEC4", "LINEAR"), &[0., 1.], &values).read();
        for step in 0..=10 {
            let fraction = f64::from(step) / 10.0;
            let expected = DQuat::from_rotation_z(0.2 + 1.2 * fraction) * DVec3::X;
            let found = at(&gltf, fraction).world_from_node[0].transform_vector3(DVec3::X);
            // Keys are f32.
            assert!(found.abs_diff_eq(expected, 2e-7), "{fraction}: {found} for {expected}");
        }
    }
}

#[test]
fn splines_of_turns_are_of_unit_length() {
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let zero = [0.0; 4];
    let values: Vec<f32> = [zero, [0., 0., 0., 1.], zero, zero, [0., 0., half, half], zero].concat();
    let gltf =
        Shot::new(one_node()).track(node("rotation"), ("VEC4", "CUBICSPLINE"), &[0., 1.], &values).read();
    let world = at(&gltf, 0.5).world_from_node[0];
    // With flat tangents the middle is the normalised mean, here half the angle.
    let expected = DAffine3::from_rotation_z(FRAC_PI_2 / 2.0);
    assert!(world.abs_diff_eq(expected, 1e-7), "{world}");
}

/// A parent's scale that differs between axes shears a child that is turned.
#[test]
fn parents_with_scale_of_three_axes_and_mirrors() {
    let rest = json!({ "nodes": [
        { "children": [1], "scale": [1.0, 3.0, -2.0], "translation": [0.0, 0.0, 5.0] },
        { "children": [2], "rotation": DQuat::from_rotation_z(0.5).to_array() },
        { "translation": [1.0, 1.0, 1.0] }] });
    let shot =
        Shot::new(rest).track(node("translation"), ("VEC3", "LINEAR"), &[0., 1.], &[0., 0., 5., 2., 0., 5.]);
    let world = shot.at(0.5).world_from_node;
    let expected = DAffine3::from_translation(DVec3::new(1.0, 0.0, 5.0))
        * DAffine3::from_scale(DVec3::new(1.0, 3.0, -2.0))
        * DAffine3::from_rotation_z(0.5)
        * DAffine3::from_translation(DVec3::ONE);
    assert!(world[2].abs_diff_eq(expected, 1e-12), "{} for {expected}", world[2]);
    assert!(world[2].matrix3.determinant() < 0.0);
}

#[test]
fn pointers_drive_the_lens_the_light_and_the_material() {
    let rest = json!({
        "nodes": [{ "camera": 0 }],
        "cameras": [{ "type": "perspective", "perspective": { "yfov": 0.5, "znear": 0.1 } }],
        "materials": [{}],
        "extensionsUsed": ["KHR_lights_punctual", "KHR_animation_pointer"],
        "extensions": { "KHR_lights_punctual": { "lights": [{ "type": "point" }] } },
    });
    let pointer = |text: &str| json!({ "path": "pointer", "extensions": { "KHR_animation_pointer": { "pointer": text } } });
    let posed = Shot::new(rest)
        .track(pointer("/cameras/0/perspective/yfov"), ("SCALAR", "LINEAR"), &[0., 2.], &[0.5, 1.5])
        .track(
            pointer("/extensions/KHR_lights_punctual/lights/0/color"),
            ("VEC3", "STEP"),
            &[0.],
            &[1., 0.5, 0.],
        )
        .track(
            pointer("/extensions/KHR_lights_punctual/lights/0/intensity"),
            ("SCALAR", "LINEAR"),
            &[0., 1.],
            &[0., 8.],
        )
        .track(
            pointer("/materials/0/pbrMetallicRoughness/baseColorFactor"),
            ("VEC4", "LINEAR"),
            &[0., 1.],
            &[0., 0., 0., 1., 1., 0.5, 0., 1.],
        )
        .at(0.5);
    let Lens::Perspective { yfov_rad, .. } = posed.lenses[0] else { panic!("{:?}", posed.lenses) };
    assert!((yfov_rad - 0.75).abs() < 1e-12);
    assert_eq!(posed.lights[0].color, [1.0, 0.5, 0.0]);
    assert_eq!(posed.lights[0].intensity, 4.0);
    assert_eq!(posed.materials[0].base_color, [0.5, 0.25, 0.0, 1.0]);
}

#[test]
fn hidden_nodes_hide_what_is_under_them() {
    let pointer = "/nodes/0/extensions/KHR_node_visibility/visible";
    let mut buffer = Buffer::default();
    let input = buffer.floats("SCALAR", &[0., 1.]);
    let view = buffer.view(&[1, 0]);
    let output =
        buffer.accessor(json!({ "bufferView": view, "componentType": 5121, "count": 2, "type": "SCALAR" }));
    let document = buffer.finish(json!({
        "scene": 0, "scenes": [{ "nodes": [0] }],
        "extensionsUsed": ["KHR_node_visibility", "KHR_animation_pointer"],
        "nodes": [{ "children": [1] }, {}, {}],
        "animations": [{ "samplers": [{ "input": input, "output": output, "interpolation": "STEP" }],
            "channels": [{ "sampler": 0, "target": { "path": "pointer",
                "extensions": { "KHR_animation_pointer": { "pointer": pointer } } } }] }],
    }));
    let (gltf, warnings) = good(&document);
    assert!(warnings.is_empty(), "{}", lines(&warnings));
    // Node 2 is in no scene.
    assert_eq!(at(&gltf, 0.5).is_visible, [true, true, false]);
    assert_eq!(at(&gltf, 1.5).is_visible, [false, false, false]);
}

#[test]
fn the_first_of_two_animations_wins() {
    let mut buffer = Buffer::default();
    let input = buffer.floats("SCALAR", &[0., 1.]);
    let outputs = [1.0_f32, 2.0].map(|value| buffer.floats("VEC3", &[value; 6]));
    let animation = |index: usize| {
        json!({ "name": format!("Take{index}"), "samplers": [{ "input": input, "output": outputs[index] }],
            "channels": [{ "sampler": 0, "target": { "node": 0, "path": "scale" } }] })
    };
    let animations = [animation(0), animation(1)];
    let (gltf, _) = good(&buffer.finish(json!({ "nodes": [{}], "animations": animations })));
    let (animator, warnings) = Animator::new(&gltf, Playing::All).expect("all may play");
    assert_eq!(animator.pose(0.0).world_from_node[0], DAffine3::from_scale(DVec3::splat(1.0)));
    assert_eq!(warnings.len(), 1);
    assert_eq!(warnings[0].pointer, "/animations/1/channels/0");
    let (animator, warnings) = Animator::new(&gltf, Playing::Named("Take1")).expect("it is there");
    assert_eq!(animator.pose(0.0).world_from_node[0], DAffine3::from_scale(DVec3::splat(2.0)));
    assert!(warnings.is_empty());
    assert_eq!(Animator::new(&gltf, Playing::Named("x")).expect_err("not there"), ["Take0", "Take1"]);
}

#[test]
fn morph_weights_come_from_node_mesh_and_track() {
    let mut buffer = Buffer::default();
    let positions = buffer.floats("VEC3", &[0., 0., 0., 1., 0., 0., 0., 1., 0.]);
    let times = buffer.floats("SCALAR", &[0., 1.]);
    let weights = buffer.floats("SCALAR", &[0., 1., 1., 0.5]);
    let target = json!({ "POSITION": positions });
    let document = buffer.finish(json!({
        "nodes": [{ "mesh": 0 }, { "mesh": 0, "weights": [0.5, 0.25] }, { "mesh": 0 }],
        "meshes": [{ "weights": [0.75, 0.0], "primitives": [
            { "attributes": { "POSITION": positions }, "targets": [target, target] }] }],
        "animations": [{ "samplers": [{ "input": times, "output": weights }],
            "channels": [{ "sampler": 0, "target": { "node": 2, "path": "weights" } }] }],
    }));
    let posed = at(&good(&document).0, 0.5);
    assert_eq!(posed.weights, [[0.75, 0.0], [0.5, 0.25], [0.5, 0.75]]);
}

/// A skinned mesh stands where its joints are, wherever its node is.
#[test]
fn skins_ignore_the_place_of_their_node() {
    let (_, document) = crate::build::rich();
    let (gltf, _) = good(&document);
    let posed = at(&gltf, 2.0);
    let joints = posed.world_from_bound(&gltf.skins[0]);
    assert_eq!(joints[0], posed.world_from_node[0]);
    assert_eq!(joints[1].translation, DVec3::new(1.0, 1.0, 5.0));
    let turned = posed.world_from_node[1].transform_vector3(DVec3::X);
    assert!(turned.abs_diff_eq(DVec3::from_array([PI.cos(), 0.0, 0.0]), 1e-12));
}

#[test]
fn views_have_no_scale() {
    let rest = json!({ "nodes": [{ "scale": [2.0, 3.0, 4.0], "translation": [1.0, 2.0, 3.0] }] });
    let (gltf, _) = good(&Buffer::default().finish(rest).as_object().map_or(Value::Null, |document| {
        let mut document = document.clone();
        document.remove("buffers");
        json!(document)
    }));
    let view = at(&gltf, 0.0).world_from_view(0);
    assert!(view.abs_diff_eq(glam::DMat4::from_translation(DVec3::new(1.0, 2.0, 3.0)), 1e-12), "{view}");
}
