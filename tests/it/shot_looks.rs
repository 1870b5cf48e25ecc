//! Tests of how a shot looks: alpha, texture wrapping, visibility, brightness as in the program that made it, sky,
//! camera and frame rate.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use impasto_core::color::linear_from_srgb;
use impasto_gl_render::context::Driver;
use impasto_painting::{FrameOptions, prepare};
use impasto_scene::document::Light;
use impasto_scene::load::{LoadOptions, load};
use impasto_scene::loaded::LoadedScene;
use impasto_scene::{motion, save};
use impasto_tests::glb::{self, Node};
use impasto_tests::pictures::renderer;
use impasto_tests::shapes;
use serde_json::{Value, json};

fn loaded(path: &Path) -> LoadedScene {
    load(path, &LoadOptions::default()).unwrap_or_else(|report| panic!("{report}"))
}

fn words(loaded: &LoadedScene) -> String {
    loaded.warnings.iter().map(|warning| format!("{warning}\n")).collect()
}

/// A folder with a shot of two balls of one mesh and a box between them.
struct Home(tempfile::TempDir);

impl Home {
    fn new() -> Self {
        let home = Self(tempfile::tempdir().unwrap());
        let (ball, cube) = (shapes::sphere(16, 8), shapes::cube());
        let node = |name, mesh, x| Node { name, mesh, translation: [x, 0.0, 0.0], turn_deg: 0.0 };
        glb::write(
            &home.shot(),
            &[node("Ball", &ball, -1.2), node("Box", &cube, 0.3), node("Far", &ball, 1.2)],
        );
        home
    }

    fn shot(&self) -> PathBuf {
        self.0.path().join("shot.glb")
    }

    fn scene(&self, fields: &str) -> LoadedScene {
        let path = self.0.path().join("s.ron");
        let text = format!("#![enable(implicit_some)]\n(version: 1, shot: \"shot.glb\", {fields})");
        std::fs::write(&path, text).unwrap();
        loaded(&path)
    }
}

/// Intensities of the sun and of the soft light all around, and the mean of the background's channels.
fn light(loaded: &LoadedScene) -> [f64; 3] {
    let intensity = |name: &str| {
        loaded.scene.lights.iter().find(|light| light.name == name).map_or(f64::NAN, |light| light.intensity)
    };
    let background = loaded.scene.background.0.iter().sum::<f32>() / 3.0;
    [intensity("Sun"), intensity("ambient"), f64::from(background)]
}

#[test]
fn a_shot_is_as_bright_as_where_it_was_made_within_limits() {
    let home = Home::new();
    let lit = |lux: f64| {
        glb::edit(&home.shot(), |root, _| {
            root["extensions"]["KHR_lights_punctual"]["lights"][0]["intensity"] = json!(lux);
        });
        light(&loaded(&home.shot()))
    };
    let watts = |watts: f64| lit(watts * 683.0);
    // A usual sun keeps its brightness: a white wall is as bright as in the program that made the shot. The sun's
    // brightness is in proportion to its watts.
    let [usual, around, day] = watts(3.0);
    assert!((usual - 3.0 * 0.455).abs() < 1e-3 && (around / usual - 0.11).abs() < 1e-3, "{usual} {around}");
    assert!((watts(2.0)[0] * 1.5 / usual - 1.0).abs() < 1e-3);
    // A very bright sun is dimmed to the upper limit. Moonlight is raised but stays dim. An intensity that is too small
    // to be in lux counts as relative, and becomes the upper limit.
    let [burning, ..] = watts(1000.0);
    let [moon, _, night] = watts(0.05);
    assert!((burning - 1.7).abs() < 1e-3 && (lit(1.0)[0] - 1.7).abs() < 1e-3, "{burning}");
    assert!(moon > 0.05 * 0.455 * 2.0 && moon < 0.2 * usual, "{moon}");
    assert!(day > 0.7 && night < 0.3, "{day} {night}");
}

#[test]
fn the_cone_of_a_lamp_moves_as_the_shot_moves_it() {
    let home = Home::new();
    glb::edit(&home.shot(), |root, bin| {
        let light = &mut root["extensions"]["KHR_lights_punctual"]["lights"][0];
        light["type"] = json!("spot");
        light["spot"] = json!({ "innerConeAngle": 0.1, "outerConeAngle": 0.3 });
        root["extensionsUsed"].as_array_mut().unwrap().push(json!("KHR_animation_pointer"));
        let mut add = |of: &str, item: Value| {
            if !root[of].is_array() {
                root[of] = json!([]);
            }
            let all = root[of].as_array_mut().unwrap();
            all.push(item);
            all.len() - 1
        };
        let mut numbers = |numbers: [f32; 2]| {
            bin.resize(bin.len().next_multiple_of(4), 0);
            let at = bin.len();
            bin.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
            let view = add("bufferViews", json!({ "buffer": 0, "byteOffset": at, "byteLength": 8 }));
            let accessor = json!({ "bufferView": view, "componentType": 5126, "count": 2, "type": "SCALAR",
                "min": [numbers[0]], "max": [numbers[1]] });
            add("accessors", accessor)
        };
        let [times, angles] = [[0.0, 1.0], [0.3, 0.6]].map(&mut numbers);
        let pointer = "/extensions/KHR_lights_punctual/lights/0/spot/outerConeAngle";
        let target =
            json!({ "path": "pointer", "extensions": { "KHR_animation_pointer": { "pointer": pointer } } });
        let animation = json!({ "name": "Iris", "samplers": [{ "input": times, "output": angles }],
            "channels": [{ "sampler": 0, "target": target }] });
        add("animations", animation);
        root["buffers"][0]["byteLength"] = json!(bin.len());
    });
    let shot = loaded(&home.shot());
    let sun = shot.scene.lights.iter().find(|light| light.name == "Sun").unwrap();
    let cone = |light: &Light, seconds: f64| {
        let frame = seconds * shot.scene.timeline.fps;
        motion::light_at(&shot.scene, light, frame).cone_deg.unwrap().map(|angle| angle.to_radians())
    };
    for (seconds, outer_rad) in [(0.0, 0.3), (0.5, 0.45), (1.0, 0.6)] {
        let [inner, outer] = cone(sun, seconds);
        assert!((outer - outer_rad).abs() < 1e-6 && (inner - 0.1).abs() < 1e-6, "{inner} {outer}");
    }
    // What the document states stays.
    let stated = Light { cone_deg: Some([5.0, 50.0]), ..sun.clone() };
    assert!((cone(&stated, 1.0)[1] - 50f64.to_radians()).abs() < 1e-12);
}

#[test]
fn the_world_lights_and_shows_as_its_sidecar_tells() {
    let home = Home::new();
    glb::edit(&home.shot(), |root, _| {
        root["extensions"]["KHR_lights_punctual"]["lights"][0]["intensity"] = json!(3.0 * 683.0);
    });
    let world = [0.1, 0.2, 0.4];
    let with_world = |world: [f64; 3]| {
        let text = json!({"version": 1, "world": world}).to_string();
        std::fs::write(home.shot().with_extension("impasto.json"), text).unwrap();
        loaded(&home.shot())
    };
    let lit = with_world(world);
    let ambient = lit.scene.lights.iter().find(|light| light.name == "ambient").unwrap();
    let sun = 3.0 * 0.455;
    for (channel, tint) in [0xcfu8, 0xdc, 0xf2].into_iter().enumerate() {
        let linear = |encoded: f32| f64::from(linear_from_srgb(encoded));
        // The light that surfaces reflect onto each other, plus the light of the world over a hemisphere.
        let wanted =
            0.11 * sun * linear(f32::from(tint) / 255.0) + world[channel] * std::f64::consts::PI * 0.455;
        let found = ambient.intensity * linear(ambient.color.0[channel]);
        assert!((found / wanted - 1.0).abs() < 1e-4, "{channel}: {found} {wanted}");
        let shown = linear(lit.scene.background.0[channel]);
        assert!((shown - world[channel]).abs() < 0.005, "{channel}: {shown}");
    }
    assert!((light(&lit)[0] - sun).abs() < 1e-3, "the world has changed the sun");
    // With a black world, only the light that surfaces reflect onto each other is left. A very bright world dims the
    // sun.
    let [_, dark, sky] = light(&with_world([0.0; 3]));
    assert!((dark / sun - 0.11 * linear_peak()).abs() < 1e-3 && sky == 0.0, "{dark} {sky}");
    let [dimmed, ..] = light(&with_world([100.0; 3]));
    assert!(dimmed < 0.02 * sun, "{dimmed}");
}

/// The largest channel, linear, of the tint of the light that surfaces reflect onto each other.
fn linear_peak() -> f64 {
    f64::from(linear_from_srgb(242.0 / 255.0))
}

#[test]
fn a_scene_that_states_none_has_the_sky_of_its_shot_and_does_not_save_it() {
    let home = Home::new();
    let scene = home.scene("");
    assert_eq!(scene.scene.background, loaded(&home.shot()).scene.background);
    assert!(!save::to_ron(&scene.scene).contains("background"));
    let own = home.scene("background: \"#102030\"");
    assert!(save::to_ron(&own.scene).contains("#102030"));
}

#[test]
fn a_shot_without_lights_says_so() {
    let home = Home::new();
    let no_lights = |root: &mut Value, _: &mut Vec<u8>| {
        let nodes = root["nodes"].as_array_mut().unwrap();
        nodes.iter_mut().for_each(|node| drop(node.as_object_mut().unwrap().remove("extensions")));
    };
    glb::edit(&home.shot(), no_lights);
    assert!(words(&home.scene("")).contains("there are no lights"));
}

#[test]
fn of_several_cameras_the_one_that_sees_most_is_looked_through() {
    let home = Home::new();
    glb::edit(&home.shot(), |root, _| {
        // The first camera is turned away from the objects; another one sees all.
        let nodes = root["nodes"].as_array_mut().unwrap();
        let camera = nodes.iter().position(|node| node["name"] == "Cam").unwrap();
        nodes[camera]["rotation"] = json!([0.0, 1.0, 0.0, 0.0]);
        nodes.push(json!({ "name": "Other", "camera": 0, "translation": [0.0, 0.0, 9.0] }));
        let last = nodes.len() - 1;
        root["scenes"][0]["nodes"].as_array_mut().unwrap().push(json!(last));
    });
    let shot = loaded(&home.shot());
    assert!((motion::camera_at(&shot.scene, 0.0).eye.z - 9.0).abs() < 1e-9);
    assert!(words(&shot).contains("\"Other\" is looked through"), "{}", words(&shot));
}

#[test]
fn keys_of_another_rate_are_played_at_theirs_unless_the_scene_says_otherwise() {
    let home = Home::new();
    glb::edit(&home.shot(), |root, bin| {
        let mut add = |numbers: Vec<f32>, kind: &str| {
            let views = root["bufferViews"].as_array_mut().unwrap();
            views.push(json!({ "buffer": 0, "byteOffset": bin.len(), "byteLength": numbers.len() * 4 }));
            bin.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
            let view = views.len() - 1;
            let accessors = root["accessors"].as_array_mut().unwrap();
            accessors.push(json!({ "bufferView": view, "componentType": 5126, "count": 7, "type": kind }));
            accessors.len() - 1
        };
        let input = add((0..=6).map(|frame| frame as f32 / 30.0).collect(), "SCALAR");
        let output = add([0.0, 0.0, 0.0, 1.0].repeat(7), "VEC4");
        root["accessors"][input]["min"] = json!([0.0]);
        root["accessors"][input]["max"] = json!([6.0f32 / 30.0]);
        let channel = json!({ "sampler": 0, "target": { "node": 0, "path": "rotation" } });
        root["animations"][0]["samplers"] = json!([{ "input": input, "output": output }]);
        root["animations"][0]["channels"] = json!([channel]);
    });
    let of = |loaded: &LoadedScene| {
        let timeline = &loaded.scene.timeline;
        (timeline.fps, timeline.first, timeline.last)
    };
    assert_eq!(of(&loaded(&home.shot())), (30.0, 0, 6));
    let unstated = home.scene("");
    assert_eq!(of(&unstated), (30.0, 0, 6));
    assert!(!save::to_ron(&unstated.scene).contains("timeline"));
    let stated = home.scene("timeline: (fps: 12)");
    assert_eq!(of(&stated), (12.0, 0, 3));
    assert!(words(&stated).contains("30 to a second"), "{}", words(&stated));
}

#[test]
fn a_material_that_the_shot_lost_is_a_warning() {
    let home = Home::new();
    let scene = home.scene("regions: [(name: \"r\", on: Material(\"Ball\", \"Brass\"))]");
    assert!(words(&scene).contains("there is no material \"Brass\""), "{}", words(&scene));
}

#[test]
fn instances_share_one_surface() {
    let home = Home::new();
    let painting = prepare(Arc::new(loaded(&home.shot()))).unwrap();
    let frame = painting.at(0.0, &FrameOptions::new([64, 36]));
    let [ball, cube, far] = [0, 1, 2].map(|index| &frame.bodies[index].surface);
    assert!(Arc::ptr_eq(ball, far) && !Arc::ptr_eq(ball, cube));
}

/// Writes a shot of one quad that fills the picture. Its texture of 2 by 1 pixels is green and opaque at the left and
/// transparent at the right. The animation "Blink" hides the quad from second 1 to second 2. "Slide" moves it in that
/// time.
fn write_card(path: &Path, alpha_mode: &str, wrap_code: u32) {
    let mut bin = Vec::new();
    let corners = [[-1.0f32, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    bin.extend(corners.iter().flat_map(|[x, y]| [*x, *y, 0.0]).flat_map(f32::to_le_bytes));
    // The right half of the quad lies beyond the texture.
    bin.extend(
        [[0.0f32, 1.0], [2.0, 1.0], [2.0, 0.0], [0.0, 0.0]].iter().flatten().flat_map(|c| c.to_le_bytes()),
    );
    bin.extend([0u16, 1, 2, 0, 2, 3].iter().flat_map(|corner| corner.to_le_bytes()));
    bin.extend([0.0f32, 1.0, 2.0].iter().flat_map(|time| time.to_le_bytes()));
    bin.extend([1u8, 0, 1, 0]);
    bin.extend(
        [0.0f32, 0.0, 0.0, 9.0, 0.0, 0.0, 0.0, 0.0, 0.0].iter().flat_map(|number| number.to_le_bytes()),
    );
    let mut png = Vec::new();
    let pixels = [0u8, 200, 0, 255, 0, 0, 255, 0];
    let mut encoder = png::Encoder::new(&mut png, 2, 1);
    encoder.set_color(png::ColorType::Rgba);
    encoder.write_header().unwrap().write_image_data(&pixels).unwrap();
    let picture = bin.len();
    bin.extend(&png);
    let root = serde_json::json!({
        "asset": { "version": "2.0" }, "scene": 0, "scenes": [{ "nodes": [0, 1] }],
        "nodes": [{ "name": "Card", "mesh": 0 }, { "name": "Cam", "camera": 0, "translation": [0, 0, 2.1] }],
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0, "TEXCOORD_0": 1 }, "indices": 2, "material": 0 }] }],
        "materials": [{ "name": "Leaf", "alphaMode": alpha_mode, "extensions": { "KHR_materials_unlit": {} },
            "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } }],
        "textures": [{ "source": 0, "sampler": 0 }], "samplers": [{ "wrapS": wrap_code, "magFilter": 9728 }],
        "images": [{ "bufferView": 6, "mimeType": "image/png" }],
        "extensionsUsed": ["KHR_materials_unlit", "KHR_animation_pointer", "KHR_node_visibility"],
        "animations": [
            { "name": "Blink", "samplers": [{ "input": 3, "output": 4, "interpolation": "STEP" }],
              "channels": [{ "sampler": 0, "target": { "path": "pointer", "extensions": { "KHR_animation_pointer": {
                "pointer": "/nodes/0/extensions/KHR_node_visibility/visible" } } } }] },
            { "name": "Slide", "samplers": [{ "input": 3, "output": 5, "interpolation": "STEP" }],
              "channels": [{ "sampler": 0, "target": { "node": 0, "path": "translation" } }] },
        ],
        "accessors": [
            { "bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 0] },
            { "bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2" },
            { "bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR" },
            { "bufferView": 3, "componentType": 5126, "count": 3, "type": "SCALAR", "min": [0], "max": [2] },
            { "bufferView": 4, "componentType": 5121, "count": 3, "type": "SCALAR" },
            { "bufferView": 5, "componentType": 5126, "count": 3, "type": "VEC3" },
        ],
        "bufferViews": [
            { "buffer": 0, "byteOffset": 0, "byteLength": 48 }, { "buffer": 0, "byteOffset": 48, "byteLength": 32 },
            { "buffer": 0, "byteOffset": 80, "byteLength": 12 }, { "buffer": 0, "byteOffset": 92, "byteLength": 12 },
            { "buffer": 0, "byteOffset": 104, "byteLength": 3 }, { "buffer": 0, "byteOffset": 108, "byteLength": 36 },
            { "buffer": 0, "byteOffset": picture, "byteLength": png.len() },
        ],
        "buffers": [{ "byteLength": bin.len() }],
        "cameras": [{ "type": "perspective", "perspective": { "yfov": 0.5, "znear": 0.1, "zfar": 10.0 } }],
    });
    std::fs::write(path, glb::bytes(&root, bin)).unwrap();
}

/// The mean alpha, 0..1, of each of four columns of a picture of this shot.
fn painted(path: &Path, settings: &[(&str, &str)], frame_at: f64) -> [f64; 4] {
    let overrides = settings.iter().map(|(name, value)| ((*name).to_owned(), (*value).to_owned())).collect();
    let options = LoadOptions { overrides, ..LoadOptions::default() };
    let painting =
        prepare(Arc::new(load(path, &options).unwrap_or_else(|report| panic!("{report}")))).unwrap();
    let frame = FrameOptions { transparent: true, ..FrameOptions::new([160, 90]) };
    let picture = renderer(Driver::Egl).render(&painting.at(frame_at, &frame)).unwrap();
    std::array::from_fn(|column| {
        let columns = column * 40 + 4..column * 40 + 36;
        let pixels = (10..80).flat_map(|row| columns.clone().map(move |at| row * 160 + at));
        let count = pixels.clone().count() as f64;
        pixels.map(|pixel| f64::from(picture.rgba8[4 * pixel + 3]) / 255.0).sum::<f64>() / count
    })
}

#[test]
fn alpha_cuts_holes_and_wrapping_goes_on_beyond_the_texture() {
    let home = tempfile::tempdir().unwrap();
    let path = home.path().join("card.glb");
    let (repeat, mirror, clamp) = (10497, 33648, 33071);
    let (full, none) = (0.97, 0.03);
    for (mode, wrap, wanted) in [
        ("OPAQUE", repeat, [true, true, true, true]),
        ("MASK", repeat, [true, false, true, false]),
        ("BLEND", mirror, [true, false, false, true]),
        ("MASK", clamp, [true, false, false, false]),
    ] {
        write_card(&path, mode, wrap);
        for style in ["Reference", "RotatingStrokes()"] {
            let shares = painted(&path, &[("style", style)], 0.0);
            for (share, wanted) in shares.into_iter().zip(wanted) {
                assert!(
                    if wanted { share > full } else { share < none },
                    "{mode} {wrap} {style}: {shares:?}"
                );
            }
        }
    }
}

#[test]
fn the_picture_of_a_glowing_surface_lies_where_its_own_transform_says() {
    let home = tempfile::tempdir().unwrap();
    let path = home.path().join("card.glb");
    write_card(&path, "OPAQUE", 10497);
    let across = |path: &Path| {
        let card = loaded(path);
        let mesh = &card.meshes[&card.scene.objects[0].mesh].mesh;
        let us = mesh.uvs.iter().map(|uv| uv.x);
        us.fold((f32::MAX, f32::MIN), |(least, most), u| (least.min(u), most.max(u)))
    };
    assert_eq!(across(&path), (0.0, 2.0));
    let moved =
        |by: f64| json!({ "index": 0, "extensions": { "KHR_texture_transform": { "offset": [by, 0] } } });
    for (emission, wanted) in [(1.0, (0.25, 2.25)), (0.1, (0.5, 2.5))] {
        glb::edit(&path, |root: &mut Value, _: &mut Vec<u8>| {
            root["extensionsUsed"] =
                json!(["KHR_texture_transform", "KHR_animation_pointer", "KHR_node_visibility"]);
            root["materials"][0] = json!({
                "name": "Lamp", "emissiveFactor": [emission, emission, emission], "emissiveTexture": moved(0.25),
                "pbrMetallicRoughness": {
                    "baseColorFactor": [0.2, 0.2, 0.2, 1], "baseColorTexture": moved(0.5),
                },
            });
        });
        assert_eq!(across(&path), wanted, "emission {emission}");
    }
}

#[test]
fn one_animation_of_several_plays_and_what_hides_is_hidden() {
    let home = tempfile::tempdir().unwrap();
    let path = home.path().join("card.glb");
    write_card(&path, "OPAQUE", 10497);
    let of_both: f64 = painted(&path, &[], 24.0).iter().sum();
    assert!(of_both < 0.05, "the card shows in the second in which it is hidden: {of_both}");
    let scene = home.path().join("s.ron");
    let text = |animation: &str| {
        format!(
            "#![enable(implicit_some)]\n(version: 1, shot: \"card.glb\", timeline: (animation: \"{animation}\"))"
        )
    };
    std::fs::write(&scene, text("Slide")).unwrap();
    let slid: f64 = painted(&scene, &[], 24.0).iter().sum();
    let [still, hidden, shown] = {
        std::fs::write(&scene, text("Blink")).unwrap();
        [0.0, 24.0, 48.0].map(|frame| painted(&scene, &[], frame).iter().sum::<f64>())
    };
    // 9 units to the side, the card is outside the picture. "Blink" does not move it.
    assert!(slid < 0.05 && still > 3.8 && hidden < 0.05 && shown > 3.8, "{slid} {still} {hidden} {shown}");
    std::fs::write(&scene, text("Blnk")).unwrap();
    let told = loaded(&scene).warnings.iter().map(ToString::to_string).collect::<String>();
    assert!(
        told.contains("there is no animation \"Blnk\"") && told.contains("did you mean \"Blink\"?"),
        "{told}"
    );
}
