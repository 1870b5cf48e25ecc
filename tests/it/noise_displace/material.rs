//! Tests of noise that colours surfaces: layers, tint, opacity, bloom.

use glam::Vec2;
use impasto_core::noise_displace::perlin;
use impasto_gl_render::context::Driver;
use impasto_gl_render::{Picture, Renderer};
use impasto_painting::{FrameOptions, prepare};
use impasto_scene::document::{
    Color, Light, LightKind, NoiseAlpha, NoiseDisplace, NoiseForward, NoiseMix, ObjectKey, Scene, Style,
    SurfaceNoise,
};
use impasto_scene::loaded::LoadedScene;
use impasto_tests::pictures::renderer;
use impasto_tests::shapes;

use super::seed::Frag;
use super::{material, with_texture};

const SIDE: u32 = 96;

/// A sheet that fills the picture, coloured by this noise.
fn sheet(surface: SurfaceNoise) -> Scene {
    let mut scene = shapes::scene(vec![shapes::object("sheet", 100)]);
    scene.style = Style::Reference;
    scene.strokes.layers = shapes::body_layer_alone();
    scene.timeline.last = 480;
    scene.camera.lens = impasto_scene::document::Lens::Orthographic { height: 2.0, near: 0.1, far: 20.0 };
    scene.objects[0].material =
        material(NoiseDisplace { vertex: None, surface: Some(surface), period_secs: None });
    scene
}

fn drawn(scene: Scene, frame: f64, renderer: &mut Renderer) -> Picture {
    let painting = prepare(shapes::loaded(scene, [shapes::sheet(4)])).unwrap();
    renderer.render(&painting.at(frame, &FrameOptions::new([SIDE, SIDE]))).unwrap()
}

fn srgb(linear: f64) -> f64 {
    let linear = linear.clamp(0.0, 1.0);
    255.0 * if linear <= 0.003_130_8 { linear * 12.92 } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

fn linear(byte: u8) -> f64 {
    let encoded = f64::from(byte) / 255.0;
    if encoded <= 0.040_45 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// Mean and standard deviation of the first channel, linear.
fn moments(picture: &Picture) -> [f64; 2] {
    let values: Vec<f64> = picture.rgba8.chunks_exact(4).map(|pixel| linear(pixel[0])).collect();
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let square = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / values.len() as f64;
    [mean, square.sqrt()]
}

#[test]
fn layers_are_those_of_the_sources_shader_on_either_driver() {
    let tint = Color([1.0, 0.75, 0.4]);
    let tint_linear = [255u8, 191, 102].map(linear);
    let mut renderers = [Driver::Egl, Driver::Osmesa].map(|driver| (driver, renderer(driver)));
    // Tilings below 1 enlarge the texture, so that no driver reads a smaller mipmap level.
    let tiling = [0.22, 0.17];
    for (layer_count, forward) in [
        (1, NoiseForward::Odd),
        (2, NoiseForward::Odd),
        (7, NoiseForward::Odd),
        (7, NoiseForward::Even),
        (22, NoiseForward::Odd),
    ] {
        let surface = SurfaceNoise {
            layer_count,
            forward,
            speed: 1.3,
            tiling,
            tile_offset: [0.3, 0.1],
            tint: Color([1.0, 191.0 / 255.0, 102.0 / 255.0]),
            ..Default::default()
        };
        assert!((tint.0[1] - 0.75).abs() < 0.01);
        let judge = Frag {
            noise_tex2: &perlin(),
            max_index: layer_count,
            speed: 1.3,
            time_x: 31.0 / 24.0 / 20.0,
            reverse_factor: if forward == NoiseForward::Odd { -1.0 } else { 1.0 },
        };
        for (driver, renderer) in &mut renderers {
            let picture = drawn(sheet(surface.clone()), 31.0, renderer);
            let mut worst = 0.0_f64;
            for (index, pixel) in picture.rgba8.chunks_exact(4).enumerate() {
                let (x, y) = (index as u32 % SIDE, index as u32 / SIDE);
                let uv = Vec2::new(x as f32 + 0.5, (SIDE - y) as f32 - 0.5) / SIDE as f32;
                let at = [f64::from(uv.x) * tiling[0] + 0.3, f64::from(uv.y) * tiling[1] + 0.1];
                let tex = judge.tex(at);
                for channel in 0..3 {
                    let expected = srgb(tex[channel] * tint_linear[channel]);
                    worst = worst.max((f64::from(pixel[channel]) - expected).abs());
                }
            }
            println!("k {layer_count} {forward:?} {driver:?}: off by at most {worst:.2} of 255");
            assert!(worst <= 2.0, "k {layer_count} {forward:?} {driver:?}: off by {worst}");
        }
    }
}

#[test]
fn forward_even_and_time_change_the_layers() {
    let mut renderer = renderer(Driver::Egl);
    let mut of = |forward, frame| {
        drawn(sheet(SurfaceNoise { forward, layer_count: 3, ..Default::default() }), frame, &mut renderer)
    };
    assert!(of(NoiseForward::Odd, 24.0) != of(NoiseForward::Even, 24.0));
    assert!(of(NoiseForward::Odd, 24.0) != of(NoiseForward::Odd, 0.0), "the layers do not move with time");
}

#[test]
fn one_layer_is_the_tint_alone_and_light_changes_nothing() {
    let mut renderer = renderer(Driver::Egl);
    let surface = SurfaceNoise { layer_count: 1, tint: Color([0.8, 0.4, 0.2]), ..Default::default() };
    let flat = drawn(sheet(surface.clone()), 5.0, &mut renderer);
    assert!(flat.rgba8.chunks_exact(4).all(|pixel| pixel == [204, 102, 51, 255]), "{:?}", &flat.rgba8[..4]);
    let mut dark = sheet(SurfaceNoise { layer_count: 4, ..surface.clone() });
    dark.lights =
        vec![Light { color: Color([0.1; 3]), intensity: 0.1, ..Light::new("moon", LightKind::Ambient) }];
    let lit = drawn(sheet(SurfaceNoise { layer_count: 4, ..surface }), 5.0, &mut renderer);
    assert!(lit == drawn(dark, 5.0, &mut renderer), "light falls on what shines by itself");
}

#[test]
fn what_is_behind_is_seen_through_as_much_as_alpha_says() {
    let mut scene = sheet(SurfaceNoise {
        layer_count: 1,
        tint: Color([1.0, 0.0, 0.0]),
        opacity: 0.25,
        ..Default::default()
    });
    let mut behind = shapes::object("behind", 100);
    behind.keys = vec![ObjectKey { translation: [1.0, 0.0, -1.0], ..ObjectKey::at(0.0) }];
    behind.material = Some(impasto_scene::document::MaterialOverride {
        color: Some(Color([0.0, 0.0, 1.0])),
        unlit: true,
        ..Default::default()
    });
    scene.objects.push(behind);
    scene.background = Color([0.0, 1.0, 0.0]);
    let painting = prepare(shapes::loaded(scene, [shapes::sheet(4), shapes::sheet(4)])).unwrap();
    let mut renderer = renderer(Driver::Egl);
    let picture = renderer.render(&painting.at(0.0, &FrameOptions::new([SIDE, SIDE]))).unwrap();
    let reference = renderer.read_reference();
    for (x, other) in [(10u32, 1usize), (80, 2)] {
        let at = (40 * SIDE + x) as usize;
        let pixel = &picture.rgba8[at * 4..at * 4 + 3];
        assert!((linear(pixel[0]) - 0.25).abs() < 0.01, "{pixel:?}");
        assert!((linear(pixel[other]) - 0.75).abs() < 0.01, "{pixel:?}");
        assert_eq!(reference.body_id[at], 1, "the reference lacks the body in front");
        assert!((reference.depth[at] - 4.0).abs() < 1e-4);
    }
}

#[test]
fn the_order_of_the_file_does_not_matter_to_what_is_seen_through() {
    let glass = |name: &str, z: f64, tint: [f32; 3]| {
        let mut object = shapes::object(name, 100);
        object.keys = vec![ObjectKey { translation: [0.0, 0.0, z], ..ObjectKey::at(0.0) }];
        let surface = SurfaceNoise { layer_count: 1, tint: Color(tint), opacity: 0.5, ..Default::default() };
        object.material = material(NoiseDisplace { vertex: None, surface: Some(surface), period_secs: None });
        object
    };
    let picture = |turned: bool| {
        let mut scene = sheet(SurfaceNoise::default());
        scene.objects = vec![glass("near", 0.5, [1.0, 0.0, 0.0]), glass("far", -0.5, [0.0, 0.0, 1.0])];
        if turned {
            scene.objects.reverse();
        }
        let painting = prepare(shapes::loaded(scene, [shapes::sheet(2), shapes::sheet(2)])).unwrap();
        renderer(Driver::Egl).render(&painting.at(0.0, &FrameOptions::new([SIDE, SIDE]))).unwrap()
    };
    assert!(picture(false) == picture(true));
}

#[test]
fn what_is_within_another_body_is_seen_through_it() {
    let ball = |name: &str, scale: f64, tint: [f32; 3], opacity: f64| {
        let mut object = shapes::object(name, 100);
        // The inner ball's middle is nearer to the eye, so bodies cannot be ordered by their middles.
        object.keys = vec![ObjectKey {
            translation: [0.0, 0.0, 0.1 - 0.1 * scale],
            scale: impasto_scene::document::Scale::even(scale),
            ..ObjectKey::at(0.0)
        }];
        let surface = SurfaceNoise { layer_count: 1, tint: Color(tint), opacity, ..Default::default() };
        object.material = material(NoiseDisplace { vertex: None, surface: Some(surface), period_secs: None });
        object
    };
    let mut scene = sheet(SurfaceNoise::default());
    scene.objects = vec![ball("outer", 0.9, [1.0, 0.0, 0.0], 0.5), ball("inner", 0.5, [0.0, 0.0, 1.0], 1.0)];
    let painting = prepare(shapes::loaded(scene, [shapes::sphere(24, 12), shapes::sphere(24, 12)])).unwrap();
    let picture = renderer(Driver::Egl).render(&painting.at(0.0, &FrameOptions::new([SIDE, SIDE]))).unwrap();
    let pixel = &picture.rgba8[((48 * SIDE + 48) * 4) as usize..][..3];
    assert!((linear(pixel[0]) - 0.5).abs() < 0.01 && (linear(pixel[2]) - 0.5).abs() < 0.01, "{pixel:?}");
}

#[test]
fn what_has_bent_into_another_body_is_seen_through_it() {
    let ball = |name: &str, scale: f64, tint: [f32; 3], opacity: f64| {
        let mut object = shapes::object(name, 100);
        // The inner ball's middle is nearer to the eye.
        object.keys = vec![ObjectKey {
            translation: [0.0, 0.0, 0.1 - 0.1 * scale],
            scale: impasto_scene::document::Scale::even(scale),
            ..ObjectKey::at(0.0)
        }];
        let surface = SurfaceNoise { layer_count: 1, tint: Color(tint), opacity, ..Default::default() };
        object.material = material(NoiseDisplace { vertex: None, surface: Some(surface), period_secs: None });
        object
    };
    let mut scene = sheet(SurfaceNoise::default());
    let mut inner = ball("inner", 0.5, [0.0, 0.0, 1.0], 1.0);
    inner.morph = Some("target.obj".to_owned());
    inner.keys[0].morph = 1.0;
    scene.objects = vec![inner, ball("outer", 0.9, [1.0, 0.0, 0.0], 0.5)];
    // At rest the inner ball is beside the outer one.
    let round = shapes::sphere(24, 12);
    let beside = shapes::moved(&round, |at| at + glam::DVec3::X * 8.0);
    let mut loaded = LoadedScene::clone(&shapes::morphing(scene.clone(), [beside, round.clone()]));
    let both = shapes::loaded(scene, [round.clone(), round]);
    let outer = &both.scene.objects[1].mesh;
    loaded.meshes.insert(outer.clone(), both.meshes[outer].clone());
    let painting = prepare(std::sync::Arc::new(loaded)).unwrap();
    let picture = renderer(Driver::Egl).render(&painting.at(0.0, &FrameOptions::new([SIDE, SIDE]))).unwrap();
    let pixel = &picture.rgba8[((48 * SIDE + 48) * 4) as usize..][..3];
    assert!((linear(pixel[0]) - 0.5).abs() < 0.01 && (linear(pixel[2]) - 0.5).abs() < 0.01, "{pixel:?}");
}

/// The sheet with a texture of one grey.
fn grey(surface: SurfaceNoise, grey: u8, renderer: &mut Renderer) -> Picture {
    let scene = sheet(SurfaceNoise { texture: Some("grey.png".to_owned()), ..surface });
    let loaded = shapes::loaded(scene, [shapes::sheet(4)]);
    let loaded = with_texture(LoadedScene::clone(&loaded), "grey.png", [grey, grey, grey, 255]);
    let painting = prepare(loaded).unwrap();
    renderer.render(&painting.at(0.0, &FrameOptions::new([SIDE, SIDE]))).unwrap()
}

#[test]
fn more_layers_are_darker_unless_the_mean_is_kept() {
    let mut renderer = renderer(Driver::Egl);
    let g = 128.0 / 255.0_f64;
    for layer_count in [2, 4, 10, 22] {
        let mut of = |mix| {
            moments(&grey(SurfaceNoise { layer_count, mix, ..Default::default() }, 128, &mut renderer))[0]
        };
        let k = f64::from(layer_count);
        let (root, mean) = (of(NoiseMix::Root), of(NoiseMix::Mean));
        assert!((root - g.powf(2.0 * (k - 1.0) / k)).abs() < 0.01, "k {layer_count}: {root}");
        assert!((mean - g).abs() < 0.2 * g, "k {layer_count}: {mean}");
    }
    // With as many layers as are allowed, their product would underflow 32 bits before its root is taken.
    let most = moments(&grey(SurfaceNoise { layer_count: 64, ..Default::default() }, 60, &mut renderer))[0];
    assert!((most - (60.0 / 255.0_f64).powf(126.0 / 64.0)).abs() < 0.01, "{most}");
    // The same on noise, whose mean is a half.
    let mut of = |mix| {
        let surface = SurfaceNoise { layer_count: 10, mix, tiling: [0.8; 2], ..Default::default() };
        moments(&drawn(sheet(surface), 0.0, &mut renderer))[0]
    };
    let (root, mean) = (of(NoiseMix::Root), of(NoiseMix::Mean));
    assert!((mean - 0.5).abs() < 0.1, "{mean}");
    assert!(root < 0.7 * mean, "{root} against {mean}");
}

#[test]
fn other_layer_counts_give_other_patterns() {
    let mut renderer = renderer(Driver::Egl);
    let contrast = |layer_count: u32| {
        let surface = SurfaceNoise { layer_count, tiling: [0.8; 2], ..Default::default() };
        let picture = drawn(sheet(surface), 0.0, &mut renderer);
        let [mean, deviation] = moments(&picture);
        (deviation / mean, picture)
    };
    let all = [2, 4, 22].map(contrast);
    assert!(all[0].1 != all[1].1 && all[1].1 != all[2].1);
    // More layers give their product more contrast. The root takes back much of it.
    println!("contrast at k = 2, 4, 22: {:.3} {:.3} {:.3}", all[0].0, all[1].0, all[2].0);
    assert!(all.iter().all(|(contrast, _)| *contrast > 0.02));
}

#[test]
fn alpha_may_come_from_the_noise() {
    let mut renderer = renderer(Driver::Egl);
    let mut see_through = |alpha| {
        let mut scene =
            sheet(SurfaceNoise { alpha, layer_count: 2, tint: Color([0.0; 3]), ..Default::default() });
        scene.background = Color([1.0; 3]);
        moments(&drawn(scene, 0.0, &mut renderer))
    };
    assert!(see_through(NoiseAlpha::Texture)[0] < 0.01, "an opaque texture is seen through");
    let [mean, deviation] = see_through(NoiseAlpha::Grey);
    assert!((0.3..0.7).contains(&mean) && deviation > 0.03, "{mean} {deviation}");
}

#[test]
fn what_shines_glows_round_about() {
    let mut renderer = renderer(Driver::Egl);
    let mut picture = |bloom: f64| {
        let surface = SurfaceNoise { layer_count: 1, intensity: 4.0, bloom, ..Default::default() };
        let mut scene = sheet(surface);
        scene.background = Color([0.0; 3]);
        scene.objects[0].keys =
            vec![ObjectKey { scale: impasto_scene::document::Scale::even(0.3), ..ObjectKey::at(0.0) }];
        drawn(scene, 0.0, &mut renderer)
    };
    let beside = |picture: &Picture| picture.rgba8[((48 * SIDE + 31) * 4) as usize];
    let far = |picture: &Picture| picture.rgba8[((48 * SIDE + 2) * 4) as usize];
    let (none, some) = (picture(0.0), picture(1.0));
    assert_eq!((beside(&none), far(&none)), (0, 0));
    assert!(beside(&some) > 40 && far(&some) == 0, "{} {}", beside(&some), far(&some));
    let dull = SurfaceNoise { layer_count: 1, intensity: 0.9, bloom: 1.0, ..Default::default() };
    let mut scene = sheet(dull);
    scene.background = Color([0.0; 3]);
    scene.objects[0].keys =
        vec![ObjectKey { scale: impasto_scene::document::Scale::even(0.3), ..ObjectKey::at(0.0) }];
    assert_eq!(beside(&drawn(scene, 0.0, &mut renderer)), 0, "a surface below the threshold glows");
}
