//! Tests of light on displaced surfaces. Noise that is a linear ramp shears a whole sheet, so the picture of that sheet
//! must equal the picture of a sheet that was modelled sheared.

use std::sync::Arc;

use glam::DVec3;
use impasto_core::TriangleMesh;
use impasto_gl_render::context::Driver;
use impasto_gl_render::{Picture, Renderer};
use impasto_painting::{FrameOptions, prepare};
use impasto_scene::document::{
    Color, Lens, Light, LightKind, NoiseNormals, NoiseSpace, ObjectKey, Scene, Style, VertexNoise,
};
use impasto_scene::loaded::LoadedScene;
use impasto_scene::mesh_file::Texture;
use impasto_tests::pictures::renderer;
use impasto_tests::shapes;

use super::{material, moved_by};

const SIDE: u32 = 200;
const TEXELS: u32 = 64;
/// How often the texture repeats per unit, along X and along Y.
const VALUE: [f64; 2] = [0.20, 0.22];
/// How far apart, in units and along each axis, the least noise and the greatest put a vertex.
const SCALE: f64 = 4.0;
/// How many levels of 255 each channel of the noise rises from one texel to the next, along U and along V.
const RISE: [[f64; 3]; 2] = [[2.0, 0.0, 2.0], [0.0, 1.0, -2.0]];
/// The levels, 0..=255, of the channels at the lower left texel, where U and V are least.
const BEGIN: [f64; 3] = [60.0, 60.0, 128.0];

/// The sheet's pose: inside one repeat of the texture, away from the edge where the ramp starts again.
fn key() -> ObjectKey {
    ObjectKey { translation: [2.5, 3.1, 0.0], rotation_deg: [14.0, -22.0, 9.0], ..ObjectKey::at(0.0) }
}

/// A sheet under a red, a green and a blue sun, which show every turn of its normal.
fn scene() -> Scene {
    let mut scene = shapes::scene(vec![shapes::object("sheet", 100)]);
    scene.style = Style::Reference;
    scene.strokes.layers = shapes::body_layer_alone();
    let [x, y, _] = key().translation;
    scene.camera.keys = vec![shapes::camera_key(0.0, [x, y, 6.0], [x, y, 0.0])];
    scene.camera.lens = Lens::Orthographic { height: 3.0, near: 0.1, far: 20.0 };
    scene.objects[0].keys = vec![key()];
    let suns = [[-1.0, 0.0, -1.2], [0.6, -0.9, -1.2], [0.6, 0.9, -1.2]];
    let sun = |(index, travels): (usize, [f64; 3])| {
        let mut color = [0.0; 3];
        color[index] = 1.0;
        Light {
            direction: Some(travels),
            color: Color(color),
            intensity: 3.0,
            ..Light::new(format!("sun {index}"), LightKind::Sun)
        }
    };
    scene.lights = suns.into_iter().enumerate().map(sun).collect();
    scene
}

/// The sheet displaced by the ramp, lit with these normals.
fn displaced(normals: NoiseNormals) -> Arc<LoadedScene> {
    let mut scene = scene();
    let noise = VertexNoise {
        texture: Some("ramp.png".to_owned()),
        space: NoiseSpace::World,
        value: VALUE,
        scale: SCALE,
        normals,
        ..Default::default()
    };
    scene.objects[0].material = material(moved_by(noise));
    let mut loaded = LoadedScene::clone(&shapes::loaded(scene, [shapes::sheet(4)]));
    let texel = |index: u32| {
        // Texels are stored with the top row first, and V goes up.
        let (u, v) = (index % TEXELS, TEXELS - 1 - index / TEXELS);
        let byte = |channel: usize| {
            BEGIN[channel] + RISE[0][channel] * f64::from(u) + RISE[1][channel] * f64::from(v)
        };
        [byte(0) as u8, byte(1) as u8, byte(2) as u8, 255]
    };
    let rgba8 = (0..TEXELS * TEXELS).map(texel).collect();
    let ramp = Texture { size_px: [TEXELS; 2], rgba8 };
    loaded.textures.insert("ramp.png".to_owned(), Arc::new(ramp));
    Arc::new(loaded)
}

/// How the ramp moves the sheet, in the space of the model. `along` is by how much the displacement changes over the
/// length of one texture: along U, and along V. The dot products of `textures` with a step on the sheet tell how many
/// textures the step crosses along U and along V.
#[derive(Clone, Copy)]
struct Ramp {
    along: [DVec3; 2],
    textures: [DVec3; 2],
}

impl Ramp {
    fn of_test() -> Self {
        let model_from_world = impasto_scene::motion::poses_at(&scene(), 0.0)[0].matrix3.transpose();
        let along = RISE.map(|rise| DVec3::from(rise) * (f64::from(TEXELS) / 255.0 * SCALE));
        Self { along, textures: [model_from_world.x_axis * VALUE[0], model_from_world.y_axis * VALUE[1]] }
    }

    /// The normal of the sheared sheet.
    fn normal(&self) -> DVec3 {
        let edge = |axis: DVec3| {
            axis + self.along[0] * self.textures[0].dot(axis) + self.along[1] * self.textures[1].dot(axis)
        };
        edge(DVec3::X).cross(edge(DVec3::Y)).normalize()
    }
}

/// The sheet of [`modelled`], but with this normal.
fn modelled_with(normal: DVec3) -> Arc<LoadedScene> {
    let mut sheet = LoadedScene::clone(&modelled());
    for file in sheet.meshes.values_mut() {
        let mesh = &mut Arc::make_mut(file).mesh;
        mesh.normals.fill(normal.as_vec3());
    }
    Arc::new(sheet)
}

/// A sheet that was modelled as the ramp shears it.
fn modelled() -> Arc<LoadedScene> {
    let scene = scene();
    let world_from_model = impasto_scene::motion::poses_at(&scene, 0.0)[0];
    // The noise at a place of the model, in bytes.
    let byte = |at: DVec3| {
        let world = world_from_model.transform_point3(at);
        let texels = [world.x * VALUE[0], world.y * VALUE[1]].map(|length| length * f64::from(TEXELS) - 0.5);
        DVec3::from(BEGIN) + DVec3::from(RISE[0]) * texels[0] + DVec3::from(RISE[1]) * texels[1]
    };
    let moved = |at: DVec3| at + (byte(at) / 255.0 - 0.5) * SCALE;
    let edge = |axis: DVec3| moved(axis) - moved(DVec3::ZERO);
    let normal = edge(DVec3::X).cross(edge(DVec3::Y)).normalize().as_vec3();
    let mut mesh: TriangleMesh = shapes::sheet(4);
    for (position, own) in mesh.positions.iter_mut().zip(&mut mesh.normals) {
        (*position, *own) = (moved(position.as_dvec3()).as_vec3(), normal);
    }
    shapes::loaded(scene, [mesh])
}

fn drawn(renderer: &mut Renderer, loaded: Arc<LoadedScene>) -> (Picture, Vec<u32>) {
    let painting = prepare(loaded).unwrap();
    let picture = renderer.render(&painting.at(0.0, &FrameOptions::new([SIDE; 2]))).unwrap();
    (picture, renderer.read_reference().body_id)
}

/// The largest difference in any channel where both pictures show the sheet.
fn largest_difference((a, a_ids): &(Picture, Vec<u32>), (b, b_ids): &(Picture, Vec<u32>)) -> u8 {
    let both: Vec<usize> = (0..a_ids.len()).filter(|&pixel| a_ids[pixel] == 1 && b_ids[pixel] == 1).collect();
    assert!(both.len() > 4000, "{} pixels of the sheet", both.len());
    let channels = both.iter().flat_map(|pixel| (0..3).map(move |channel| 4 * pixel + channel));
    channels.map(|index| a.rgba8[index].abs_diff(b.rgba8[index])).max().unwrap_or(0)
}

#[test]
fn light_falls_on_a_displaced_sheet_as_on_one_that_was_modelled_so() {
    for driver in [Driver::Egl, Driver::Osmesa] {
        let mut renderer = renderer(driver);
        let found = drawn(&mut renderer, displaced(NoiseNormals::Displaced));
        let modelled = drawn(&mut renderer, modelled());
        let off = largest_difference(&found, &modelled);
        assert!(off <= 2, "{driver:?}: displaced normals are wrong: light differs by {off} of 255");
        let at_rest = drawn(&mut renderer, displaced(NoiseNormals::Kept));
        let off = largest_difference(&at_rest, &modelled);
        assert!(off > 10, "the test does not notice normals at rest: {off} of 255");
    }
}

/// In the planted faults, the ramp's slope along U or along V is a third too small: for steps in all directions of the
/// model, or only for steps along one of its axes.
#[test]
fn a_fault_of_displaced_normals_is_seen_in_the_light() {
    let mut renderer = renderer(Driver::Egl);
    let modelled = drawn(&mut renderer, modelled());
    let mut off_with =
        |ramp: &Ramp| largest_difference(&drawn(&mut renderer, modelled_with(ramp.normal())), &modelled);
    let right = Ramp::of_test();
    assert!(off_with(&right) <= 2, "without a fault, the light is wrong already");
    let third = |axis: usize, fault: DVec3| {
        let mut ramp = right;
        ramp.textures[axis] *= fault;
        ramp
    };
    for (what, ramp) in [
        ("U", third(0, DVec3::splat(0.667))),
        ("V", third(1, DVec3::splat(0.667))),
        ("U along the model's X", third(0, DVec3::new(0.667, 1.0, 1.0))),
        ("V along the model's Y", third(1, DVec3::new(1.0, 0.667, 1.0))),
    ] {
        let off = off_with(&ramp);
        assert!(off > 3, "the test does not notice a slope of {what} that is too small: {off} of 255");
    }
}
