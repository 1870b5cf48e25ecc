//! Tests of noise-displaced materials. Vertices and layers are compared with the shader of the source paper, rewritten
//! line by line in `seed`. Other tests cover what goes beyond the paper.

mod material;
mod normals;
mod pictures;
mod ride;
mod seed;

use std::sync::Arc;

use glam::{DAffine3, DVec3};
use impasto_core::noise_displace::gaussian;
use impasto_gl_render::context::Driver;
use impasto_painting::{FrameOptions, Painting, prepare};
use impasto_scene::document::{
    MaterialOverride, NoiseAlong, NoiseDisplace, NoiseSpace, ObjectKey, Scale, Scene, Style, VertexNoise,
};
use impasto_tests::pictures::renderer;
use impasto_tests::shapes;

use seed::Vert;

fn material(noise: NoiseDisplace) -> Option<MaterialOverride> {
    Some(MaterialOverride { noise_displace: Some(noise), ..Default::default() })
}

/// A material that only moves vertices.
fn moved_by(vertex: VertexNoise) -> NoiseDisplace {
    NoiseDisplace { vertex: Some(vertex), surface: None, period_secs: None }
}

/// A ball of radius 1 with this noise, in the plain render.
fn ball(noise: NoiseDisplace) -> Scene {
    let mut scene = shapes::scene(vec![shapes::object("ball", 2000)]);
    scene.style = Style::Reference;
    scene.strokes.layers = shapes::body_layer_alone();
    scene.timeline.last = 480;
    scene.objects[0].material = material(noise);
    scene
}

fn painted(scene: Scene) -> Painting {
    prepare(shapes::loaded(scene, [shapes::sphere(64, 32)])).unwrap()
}

/// Where the vertices of the first object are at a frame, and where they are at rest.
fn vertices(painting: &Painting, frame: f64) -> (Vec<DVec3>, Vec<DVec3>) {
    let surface = painting.surface(0);
    let moved = surface.positions_at(&painting.shapes_at(frame)[0]);
    let wide = |positions: &[glam::Vec3]| positions.iter().map(|at| at.as_dvec3()).collect();
    (wide(&moved), wide(&surface.mesh.positions))
}

/// How far the vertices have moved at a frame.
fn moves(scene: Scene, frame: f64) -> Vec<DVec3> {
    let (moved, rest) = vertices(&painted(scene), frame);
    moved.iter().zip(&rest).map(|(moved, rest)| *moved - *rest).collect()
}

/// A single key with this translation, turned and enlarged.
fn keys_at(translation: [f64; 3]) -> Vec<ObjectKey> {
    vec![ObjectKey {
        translation,
        rotation_deg: [10.0, 40.0, 20.0],
        scale: Scale::even(1.2),
        ..ObjectKey::at(0.0)
    }]
}

#[test]
fn vertices_move_as_in_the_sources_shader() {
    for space in [NoiseSpace::World, NoiseSpace::Local] {
        let noise = VertexNoise { space, value: [0.37, 0.21], scale: 0.4, ..Default::default() };
        let mut scene = ball(moved_by(noise));
        scene.objects[0].keys = keys_at([3.0, -1.0, 0.5]);
        let painting = painted(scene);
        let pose = impasto_scene::motion::poses_at(painting.scene(), 0.0)[0];
        for frame in [0.0, 7.0, 431.0] {
            let judge = Vert {
                noise_tex: &gaussian(),
                object_to_world: if space == NoiseSpace::World { pose } else { DAffine3::IDENTITY },
                noise_value: [0.37, 0.21],
                noise_scale: 0.4,
                time_x: frame / 24.0 / 20.0,
            };
            let (moved, rest) = vertices(&painting, frame);
            let worst = moved.iter().zip(&rest).map(|(moved, rest)| moved.distance(judge.displaced(*rest)));
            let worst = worst.fold(0.0, f64::max);
            assert!(worst < 1e-6, "{space:?} at {frame}: {worst}");
        }
    }
}

#[test]
fn only_noise_of_the_world_changes_as_the_body_moves() {
    for (space, changes) in [(NoiseSpace::World, true), (NoiseSpace::Local, false)] {
        let scene = || ball(moved_by(VertexNoise { space, ..Default::default() }));
        let mut there = scene();
        there.objects[0].keys = keys_at([2.0, 0.0, 0.0]);
        assert_eq!(moves(scene(), 0.0) != moves(there, 0.0), changes, "{space:?}");
    }
}

#[test]
fn time_scrolls_the_texture() {
    // 24 frames scroll by 1/20 of the texture, as if every place were 0.05 / `value` farther along X and Y.
    let noise = VertexNoise { space: NoiseSpace::World, value: [0.1, 0.2], ..Default::default() };
    let scene = || ball(moved_by(noise.clone()));
    let mut there = scene();
    there.objects[0].keys =
        vec![ObjectKey { translation: [0.05 / 0.1, 0.05 / 0.2, 0.0], ..ObjectKey::at(0.0) }];
    let (later, shifted) = (moves(scene(), 24.0), moves(there, 0.0));
    let worst = later.iter().zip(&shifted).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
    assert!(worst < 1e-6, "{worst}");
    assert_ne!(later, moves(scene(), 0.0));
}

#[test]
fn subtracting_a_half_leaves_no_drift() {
    // A sheet that covers the texture once.
    let noise = VertexNoise { space: NoiseSpace::Local, value: [0.5, 0.5], scale: 0.4, ..Default::default() };
    let mut scene = ball(moved_by(noise));
    scene.objects[0].name = "sheet".to_owned();
    let painting = prepare(shapes::loaded(scene, [shapes::sheet(128)])).unwrap();
    let (moved, rest) = vertices(&painting, 0.0);
    let moves: Vec<DVec3> = moved.iter().zip(&rest).map(|(moved, rest)| *moved - *rest).collect();
    let mean = moves.iter().sum::<DVec3>() / moves.len() as f64;
    assert!(mean.abs().max_element() <= 0.01 * 0.4, "{mean}");
    let most = moves.iter().map(|by| by.abs().max_element()).fold(0.0, f64::max);
    assert!(most <= 0.5 * 0.4 + 1e-6 && most > 0.3 * 0.4, "{most}");
}

#[test]
fn a_greater_value_is_a_busier_motion() {
    // How much the displacements of successive vertices differ on average, divided by the mean displacement.
    let busy = |value: f64| {
        let moves = moves(ball(moved_by(VertexNoise { value: [value; 2], ..Default::default() })), 0.0);
        let steps: f64 = moves.windows(2).map(|pair| pair[0].distance(pair[1])).sum();
        steps / moves.iter().map(|by| by.length()).sum::<f64>()
    };
    assert!(busy(1.0) > 3.0 * busy(0.1), "{} against {}", busy(1.0), busy(0.1));
}

#[test]
fn the_scale_is_the_amplitude() {
    let of = |scale: f64| moves(ball(moved_by(VertexNoise { scale, ..Default::default() })), 5.0);
    let (small, large) = (of(0.1), of(0.25));
    let worst = small.iter().zip(&large).map(|(a, b)| (*a * 2.5).distance(*b)).fold(0.0, f64::max);
    assert!(worst < 1e-6, "{worst}");
    assert!(of(0.0).iter().all(|by| *by == DVec3::ZERO), "vertices move at scale 0");
}

#[test]
fn along_the_normal_the_first_channel_moves() {
    let noise = VertexNoise { along: NoiseAlong::Normal, scale: 0.3, ..Default::default() };
    let channels = VertexNoise { along: NoiseAlong::Channels, ..noise.clone() };
    let painting = painted(ball(moved_by(noise)));
    let (moved, rest) = vertices(&painting, 3.0);
    let by_channels = moves(ball(moved_by(channels)), 3.0);
    for ((moved, rest), by) in moved.iter().zip(&rest).zip(by_channels) {
        let expected = *rest + rest.normalize() * by.x;
        assert!(moved.distance(expected) < 1e-6, "{moved} where {expected}");
    }
}

/// The depth of the nearest triangle at each pixel's centre, seen from z = 4 along −Z without perspective. Infinite
/// where there is none.
fn nearest_depths(triangles: &[[DVec3; 3]], size: usize, units_per_px: f64) -> Vec<f64> {
    let mut nearest = vec![f64::INFINITY; size * size];
    let to_px = |at: DVec3| {
        let half = size as f64 * 0.5;
        (at.x / units_per_px + half, half - at.y / units_per_px)
    };
    for corners in triangles {
        let [(ax, ay), (bx, by), (cx, cy)] = corners.map(to_px);
        let area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
        let columns = ax.min(bx).min(cx).floor().max(0.0) as usize..=ax.max(bx).max(cx).ceil() as usize;
        for x in columns.filter(|x| *x < size) {
            let rows = ay.min(by).min(cy).floor().max(0.0) as usize..=ay.max(by).max(cy).ceil() as usize;
            for y in rows.filter(|y| *y < size) {
                let (px, py) = (x as f64 + 0.5, y as f64 + 0.5);
                let u = ((bx - px) * (cy - py) - (by - py) * (cx - px)) / area;
                let v = ((cx - px) * (ay - py) - (cy - py) * (ax - px)) / area;
                let w = 1.0 - u - v;
                if u >= 0.0 && v >= 0.0 && w >= 0.0 {
                    let depth = 4.0 - (corners[0].z * u + corners[1].z * v + corners[2].z * w);
                    let held = &mut nearest[y * size + x];
                    *held = held.min(depth);
                }
            }
        }
    }
    nearest
}

#[test]
fn drivers_put_vertices_where_the_source_does() {
    const SIZE: usize = 160;
    let noise = VertexNoise { value: [0.41, 0.33], scale: 0.5, ..Default::default() };
    let mut scene = ball(moved_by(noise));
    scene.camera.lens = impasto_scene::document::Lens::Orthographic { height: 3.2, near: 0.1, far: 20.0 };
    let painting = painted(scene);
    let judge = Vert {
        noise_tex: &gaussian(),
        object_to_world: DAffine3::IDENTITY,
        noise_value: [0.41, 0.33],
        noise_scale: 0.5,
        time_x: 50.0 / 24.0 / 20.0,
    };
    let mesh = &painting.surface(0).mesh;
    let corners = |index: usize| mesh.corners(index).map(|corner| judge.displaced(corner.as_dvec3()));
    let triangles: Vec<[DVec3; 3]> = (0..mesh.triangles.len()).map(corners).collect();
    let expected = nearest_depths(&triangles, SIZE, 3.2 / SIZE as f64);
    for driver in [Driver::Egl, Driver::Osmesa] {
        let mut renderer = renderer(driver);
        renderer.render(&painting.at(50.0, &FrameOptions::new([SIZE as u32; 2]))).unwrap();
        let depth = renderer.read_reference().depth;
        let (mut compared, mut off) = (0, Vec::new());
        for (found, expected) in depth.iter().zip(&expected) {
            if *found > 0.0 && expected.is_finite() {
                compared += 1;
                off.push((f64::from(*found) - expected).abs());
            }
        }
        off.sort_by(f64::total_cmp);
        assert!(compared > 7000, "{compared} pixels");
        // A pixel on an edge may show the next triangle, so the worst percent is left out.
        let worst = off[off.len() * 99 / 100];
        println!("{driver:?}: depth is off by at most {worst:.2e} in 99 % of {compared} pixels");
        assert!(worst <= 1e-4 * 2.0, "{driver:?}: off by {worst}");
    }
}

#[test]
fn light_falls_on_displaced_normals_where_that_is_asked_for() {
    use impasto_scene::document::NoiseNormals;
    let scene = |normals| {
        let along = NoiseAlong::Normal;
        ball(moved_by(VertexNoise { value: [0.5, 0.5], scale: 0.35, along, normals, ..Default::default() }))
    };
    let spread = |normals| {
        let picture =
            renderer(Driver::Egl).render(&painted(scene(normals)).at(0.0, &FrameOptions::new([160, 90])));
        let grey = impasto_tests::pictures::Grey::of(&picture.unwrap());
        // How much neighbouring pixels of the ball differ.
        let steps = |y: usize| (60..100).map(move |x| (x, y));
        (30..60).flat_map(steps).map(|(x, y)| (grey.at(x, y) - grey.at(x + 1, y)).abs()).sum::<f64>()
    };
    let (kept, displaced) = (spread(NoiseNormals::Kept), spread(NoiseNormals::Displaced));
    assert!(
        displaced > 1.5 * kept,
        "{displaced} with the normals of the displaced surface, {kept} with those at rest"
    );
}

#[test]
fn noise_that_moves_nothing_changes_no_pixel() {
    let noise = moved_by(VertexNoise { scale: 0.0, ..Default::default() });
    let plain = || {
        let mut scene = shapes::scene(vec![shapes::object("ball", 3000), shapes::object("cube", 3000)]);
        scene.objects[1].keys =
            vec![ObjectKey { translation: [1.0, 0.2, 0.5], scale: Scale::even(0.5), ..ObjectKey::at(0.0) }];
        scene
    };
    let mut beside = plain();
    beside.objects[1].material = material(noise);
    let picture = |scene: Scene| {
        let painting = prepare(shapes::loaded(scene, [shapes::sphere(32, 16), shapes::cube()])).unwrap();
        renderer(Driver::Egl).render(&painting.at(0.0, &FrameOptions::new([320, 180]))).unwrap()
    };
    assert!(picture(plain()) == picture(beside), "noise that moves nothing is seen");
}

#[test]
fn the_shadow_of_a_displaced_body_is_displaced() {
    let picture = |scale: f64| {
        let mut scene = shapes::scene(vec![shapes::object("ball", 500), shapes::object("sheet", 500)]);
        scene.style = Style::Reference;
        scene.strokes.layers = shapes::body_layer_alone();
        scene.objects[0].material =
            material(moved_by(VertexNoise { value: [0.4, 0.4], scale, ..Default::default() }));
        scene.objects[0].keys =
            vec![ObjectKey { translation: [-0.3, 0.4, 1.6], scale: Scale::even(0.4), ..ObjectKey::at(0.0) }];
        scene.objects[1].keys = vec![ObjectKey { scale: Scale::even(2.0), ..ObjectKey::at(0.0) }];
        let painting = prepare(shapes::loaded(scene, [shapes::sphere(48, 24), shapes::sheet(4)])).unwrap();
        let mut renderer = renderer(Driver::Egl);
        let picture = renderer.render(&painting.at(0.0, &FrameOptions::new([320, 180]))).unwrap();
        (picture, renderer.read_reference().body_id)
    };
    let ((still, ids), (moved, ids_moved)) = (picture(0.0), picture(0.9));
    // The sheet does not move, so pixels that change on it are in the shadow.
    let on_sheet = (0..320 * 180).filter(|&index| ids[index] == 2 && ids_moved[index] == 2);
    let changed =
        on_sheet.filter(|index| still.rgba8[index * 4].abs_diff(moved.rgba8[index * 4]) > 20).count();
    assert!(changed > 100, "only {changed} pixels of the shadow change");
}

/// Adds a texture of one grey under this name.
fn with_texture(
    mut loaded: impasto_scene::loaded::LoadedScene,
    name: &str,
    grey: [u8; 4],
) -> Arc<impasto_scene::loaded::LoadedScene> {
    let texture = impasto_scene::mesh_file::Texture { size_px: [4, 4], rgba8: vec![grey; 16] };
    loaded.textures.insert(name.to_owned(), Arc::new(texture));
    Arc::new(loaded)
}
