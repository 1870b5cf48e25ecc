//! Tests that a surface which no view sees whole is painted as densely as a small one, with particles only where it is
//! seen.

use std::collections::BTreeSet;
use std::sync::Arc;

use glam::{DVec2, DVec3};
use impasto_core::presence;
use impasto_gl_render::context::Driver;
use impasto_painting::{FrameOptions, Painting, PrepareOptions, Preparer, SeenFrom, prepare};
use impasto_scene::document::{
    Color, Lens, Light, LightKind, MaterialOverride, ObjectKey, Reference, Region, Scene, Selector, Style,
};
use impasto_scene::motion::{self, CameraPose};
use impasto_tests::pictures::renderer;
use impasto_tests::shapes;

const SIZE_PX: [u32; 2] = [640, 360];

/// A scene for a level floor. The eye is 1.6 units above it and, along Z, 5 units from its middle. The view reaches
/// `far` units.
fn floor_scene(far: f64) -> Scene {
    let mut scene = shapes::scene(vec![shapes::object("floor", 1)]);
    scene.objects[0].particles = None;
    scene.size = (SIZE_PX[0], SIZE_PX[1]);
    scene.camera.lens = Lens::Perspective { fov_y_deg: 40.0, near: 0.05, far };
    scene.camera.keys = vec![shapes::camera_key(0.0, [0.0, 1.6, 5.0], [0.0, 0.9, 0.0])];
    scene.strokes.layers = shapes::body_layer_alone();
    scene
}

/// A floor of this size cut into 2 `cells`² triangles.
fn floor(size: f64, cells: u32) -> impasto_core::TriangleMesh {
    let half = 0.5 * size as f32;
    shapes::moved(&shapes::sheet(cells), move |at| DVec3::new(at.x, 0.0, -at.y) * f64::from(half))
}

/// The area of all strokes (length times width times presence) in each of four bands of 40 rows, as a multiple of the
/// band's area. The bands are the lowest 160 rows of the picture, from the top down.
fn covered(painting: &Painting, frame: f64) -> [f64; 4] {
    let frame = painting.at(frame, &FrameOptions::new(SIZE_PX));
    let mut covered = [0.0; 4];
    for stroke in frame.strokes.iter() {
        let [x, y] = stroke.center_px;
        // Y runs up. The floor fills the lowest 160 rows in every scene here.
        if !(0.0..640.0).contains(&x) || !(0.0..160.0).contains(&y) {
            continue;
        }
        let band = 3 - (y / 40.0) as usize;
        let there = presence::of_supply(stroke.supply_ln) * stroke.facing_fade;
        covered[band] += f64::from(there * stroke.length_px * stroke.width_px) / (640.0 * 40.0);
    }
    covered
}

#[test]
fn a_floor_is_painted_alike_however_far_it_runs() {
    let of = |size: f64, cells: u32| {
        let painting = prepare(shapes::loaded(floor_scene(5000.0), [floor(size, cells)])).unwrap();
        (covered(&painting, 0.0), painting.particle_total(), painting.is_partial())
    };
    let (small, ..) = of(40.0, 1);
    assert!(small.iter().all(|&covered| covered > 0.5), "{small:?}");
    for (size, cells) in [(300.0, 1), (300.0, 60), (2000.0, 1)] {
        let (large, particles, is_partial) = of(size, cells);
        assert!(is_partial && particles < 200_000, "{size}: {particles} particles");
        for (band, (small, large)) in small.iter().zip(large).enumerate() {
            assert!(
                (large / small - 1.0).abs() < 0.15,
                "{size}, {cells} cells, band {band}: {large}, not {small}"
            );
        }
    }
}

/// While the camera comes nearer and looks aside, strokes grow as the floor does in the picture (`size_follow`), or
/// they are lifted off the floor (`offset`).
#[test]
fn strokes_that_follow_the_size_or_are_lifted_have_particles_where_they_are_seen() {
    // The last number is the frame of the reference. In frames with the camera farther away than in the reference,
    // strokes are smaller.
    for (follow, offset, reference) in
        [(0.6, 0.0, 0), (1.0, 0.0, 0), (0.0, 0.8, 0), (0.6, 0.5, 0), (0.4, 0.0, 9)]
    {
        let mut scene = floor_scene(5000.0);
        scene.reference = Reference::Frame(reference);
        scene.camera.keys.push(shapes::camera_key(9.0, [0.4, 1.0, 2.5], [1.4, 0.7, -1.0]));
        scene.timeline.last = 9;
        (scene.strokes.size_follow, scene.strokes.offset) = (Some(follow), Some(offset));
        let of = |size: f64| {
            let painting = prepare(shapes::loaded(scene.clone(), [floor(size, 1)])).unwrap();
            let covered = [0.0, 5.0, 9.0].map(|frame| covered(&painting, frame));
            (covered, painting.particle_total(), painting.is_partial())
        };
        let (small, ..) = of(40.0);
        let (large, particles, is_partial) = of(1000.0);
        // The limit is a little more than half of what a floor of this size has if its particles lie everywhere.
        assert!(is_partial && particles < 250_000, "{follow}, {offset}: {particles} particles");
        for (small, large) in small.iter().flatten().zip(large.iter().flatten()) {
            assert!(*small > 2.4, "{small}");
            assert!((large / small - 1.0).abs() < 0.1, "{follow}, {offset}: {large}, not {small}");
        }
    }
}

/// The camera looks down at a floor 10,000 units wide and sees three units of it: once in parallel projection, once
/// through a long lens.
#[test]
fn a_small_part_of_a_huge_floor_is_painted() {
    let mut scene = floor_scene(5000.0);
    let eye = [2000.0, 100.0, 1000.0];
    scene.camera.keys = vec![shapes::camera_key(0.0, eye, [2000.0, 0.0, 999.0])];
    let lenses = [
        Lens::Orthographic { height: 3.0, near: 1.0, far: 500.0 },
        Lens::Perspective { fov_y_deg: 1.7, near: 1.0, far: 500.0 },
    ];
    for lens in lenses {
        scene.camera.lens = lens.clone();
        let count = |size: f64| {
            let mesh = shapes::moved(&floor(size, 1), |at| at + DVec3::new(2000.0, 0.0, 1000.0));
            let painting = prepare(shapes::loaded(scene.clone(), [mesh])).unwrap();
            assert!(painting.particle_total() < 100_000);
            covered(&painting, 0.0)
        };
        let [small, huge] = [count(8.0), count(10_000.0)];
        for (small, huge) in small.iter().zip(huge) {
            assert!(*small > 0.5 && (huge / small - 1.0).abs() < 0.2, "{lens:?}: {huge}, not {small}");
        }
    }
}

/// The camera turns so fast that one view for several frames would miss most of what it sweeps over.
#[test]
fn every_frame_of_a_whip_pan_is_painted() {
    let mut scene = floor_scene(500.0);
    scene.timeline.last = 120;
    let eye = [0.0, 1.6, 5.0];
    scene.camera.keys = vec![
        shapes::camera_key(0.0, eye, [0.0, 0.9, 0.0]),
        shapes::camera_key(97.0, eye, [0.0, 0.9, 0.0]),
        shapes::camera_key(99.0, eye, [5.0, 0.9, 5.0]),
        shapes::camera_key(101.0, eye, [0.0, 0.9, 10.0]),
        shapes::camera_key(103.0, eye, [-5.0, 0.9, 5.0]),
    ];
    let whole = prepare(shapes::loaded(scene.clone(), [floor(300.0, 1)])).unwrap();
    assert!(whole.is_partial());
    for frame in [0.0, 99.0, 100.0, 101.0, 102.0] {
        let mut alone = scene.clone();
        let pose = motion::camera_at(&scene, frame);
        alone.camera.keys = vec![shapes::camera_key(0.0, pose.eye.to_array(), pose.target.to_array())];
        alone.timeline.last = 0;
        let alone = prepare(shapes::loaded(alone, [floor(300.0, 1)])).unwrap();
        for (band, (found, wanted)) in covered(&whole, frame).iter().zip(covered(&alone, 0.0)).enumerate() {
            assert!((found / wanted - 1.0).abs() < 0.1, "frame {frame}, band {band}: {found}, not {wanted}");
        }
    }
}

#[test]
fn a_free_camera_finds_particles_where_it_was_announced() {
    let scene = floor_scene(500.0);
    let free = CameraPose {
        eye: DVec3::new(60.0, 1.6, 30.0),
        target: DVec3::new(70.0, 0.9, 33.0),
        roll_rad: 0.0,
        shift: DVec2::ZERO,
        lens: scene.camera.lens.clone(),
    };
    let mut preparer = Preparer::default();
    let loaded = shapes::loaded(scene, [floor(300.0, 1)]);
    let mut strokes = |seen_from: SeenFrom<'_>| {
        let options = PrepareOptions { seen_from, ..PrepareOptions::default() };
        let painting = preparer.prepare_with(Arc::clone(&loaded), &options).unwrap();
        let [shot, there] = [None, Some(&free)].map(|camera| {
            let frame = match camera {
                Some(camera) => painting.seen_by(camera, 0.0, &FrameOptions::new(SIZE_PX)),
                None => painting.at(0.0, &FrameOptions::new(SIZE_PX)),
            };
            frame.strokes.len()
        });
        (shot, there)
    };
    let (shot, without) = strokes(SeenFrom::SHOT);
    let (shot_too, with) = strokes(SeenFrom::Shot { also: &[(free.clone(), 0.0)], margin: SeenFrom::MARGIN });
    assert!(with > 10 * without && with > shot / 2, "{without} strokes, {with} when announced");
    // The free camera hardly changes the picture of the shot. Without that camera, the first picture is back.
    assert!(shot_too.abs_diff(shot) * 50 < shot, "{shot} and {shot_too} strokes");
    assert_eq!(strokes(SeenFrom::AsBefore), (shot_too, with));
    assert_eq!(strokes(SeenFrom::SHOT), (shot, without));
}

#[test]
fn an_edit_of_the_strokes_on_a_large_floor_gives_the_bits_of_a_cold_prepare() {
    let mut preparer = Preparer::default();
    let mut loaded = shapes::loaded(floor_scene(500.0), [floor(300.0, 1)]);
    let mut last = preparer.prepare(Arc::clone(&loaded)).unwrap().particle_total();
    let edits: [fn(&mut Scene); 4] = [
        |scene| scene.strokes.length_px = Some(30.0),
        |scene| scene.strokes.coverage = Some(1.1),
        |scene| scene.strokes.offset = Some(0.3),
        |scene| {
            let mut region = Region::new("floor", Selector::Object("floor".to_owned()));
            region.strokes.width_px = Some(30.0);
            scene.regions.push(region);
        },
    ];
    for (index, edit) in edits.into_iter().enumerate() {
        edit(&mut Arc::make_mut(&mut loaded).scene);
        let warm = preparer.prepare(Arc::clone(&loaded)).unwrap();
        let cold = prepare(Arc::clone(&loaded)).unwrap();
        assert!(cold.is_partial() && cold.particle_total() != last, "edit {index} changes nothing");
        last = cold.particle_total();
        assert_eq!(warm.particle_counts(), cold.particle_counts(), "edit {index}");
        let [warm, cold] = [warm, cold].map(|painting| painting.at(0.0, &FrameOptions::new(SIZE_PX)));
        assert!(warm.strokes == cold.strokes && warm.sources == cold.sources, "edit {index}");
    }
}

/// A floor swells into hills while the camera drives over it, so that it bends, grows and turns away.
#[test]
fn a_floor_that_bends_has_the_same_strokes_with_fewer_particles() {
    let mut scene = floor_scene(500.0);
    scene.timeline.last = 10;
    scene.camera.keys = vec![
        shapes::camera_key(0.0, [0.0, 1.6, 5.0], [0.0, 0.9, 0.0]),
        shapes::camera_key(10.0, [7.0, 2.6, 1.0], [11.0, 1.3, -3.0]),
    ];
    scene.objects[0].morph = Some("target.obj".to_owned());
    scene.objects[0].keys = vec![ObjectKey::at(0.0), ObjectKey { morph: 1.0, ..ObjectKey::at(10.0) }];
    let hilly = |at: DVec3| {
        let [along, across] = [0.7 * at.x, 0.9 * at.z + 0.4].map(f64::sin);
        DVec3::new(at.x + 0.4 * across, at.y + 1.1 * along * across, at.z + 0.3 * along)
    };
    // In the second case strokes lie below the floor, so they face the eye for longer when the floor turns away. In the
    // last, faces are so large that some reach past the camera.
    for (lens, offset, faces) in [
        (scene.camera.lens.clone(), None, 54),
        (scene.camera.lens.clone(), Some(-0.3), 54),
        (Lens::Orthographic { height: 4.0, near: 0.05, far: 500.0 }, None, 54),
        (scene.camera.lens.clone(), None, 5),
    ] {
        let flat = floor(36.0, faces);
        let target = shapes::moved(&flat, hilly);
        let mut scene = scene.clone();
        (scene.camera.lens, scene.strokes.offset) = (lens.clone(), offset);
        let loaded = shapes::morphing(scene, [flat.clone(), target.clone()]);
        let painting = |seen_from: SeenFrom<'_>| {
            let options = PrepareOptions { seen_from, ..PrepareOptions::default() };
            Preparer::default().prepare_with(Arc::clone(&loaded), &options).unwrap()
        };
        let [shot, anywhere] = [SeenFrom::SHOT, SeenFrom::Anywhere].map(painting);
        if offset.is_some() {
            let free = [(motion::camera_at(&loaded.scene, 4.0), 4.0)];
            let free = painting(SeenFrom::Shot { also: &free, margin: SeenFrom::MARGIN });
            assert!(!free.is_partial(), "a free camera may see the floor at any frame");
        }
        let totals = [&shot, &anywhere].map(Painting::particle_total);
        assert!(shot.is_partial() && !anywhere.is_partial() && 2 * totals[0] < totals[1], "{totals:?}");
        for frame in [0.0, 3.0, 6.5, 10.0] {
            let strokes = |painting: &Painting| -> BTreeSet<[u32; 2]> {
                let frame = painting.at(frame, &FrameOptions::new(SIZE_PX));
                frame.strokes.iter().map(|stroke| stroke.center_px.map(f32::to_bits)).collect()
            };
            let [few, all] = [&shot, &anywhere].map(strokes);
            // Beside places that get no particles there is more room, so a few particles are placed differently there.
            let missing = all.difference(&few).count();
            println!(
                "{lens:?}, {faces}, frame {frame}: {missing} of {} strokes, {totals:?} particles",
                all.len()
            );
            assert!(all.len() > 2000 && 200 * missing < all.len(), "{lens:?}, frame {frame}: {missing}");
        }
    }
}

/// An editor's view shows what lies round the picture, so paint goes on past each border, by a quarter of the picture's
/// width or height.
#[test]
fn round_the_picture_the_floor_is_painted_too() {
    let scene = floor_scene(500.0);
    let painting = prepare(shapes::loaded(scene.clone(), [floor(300.0, 1)])).unwrap();
    let wider = FrameOptions { shot_height_px: Some(360.0), ..FrameOptions::new([900, 360]) };
    let frame = painting.at(0.0, &wider);
    let near = |from: f32, to: f32| {
        let inside = |stroke: &&impasto_painting::frame::Stroke| {
            let [x, y] = stroke.center_px;
            (from..to).contains(&x) && (20.0..100.0).contains(&y)
        };
        frame.strokes.iter().filter(inside).count()
    };
    let (beside, middle) = (near(0.0, 120.0), near(390.0, 510.0));
    assert!(beside * 10 > middle * 8, "{beside} strokes beside the picture, {middle} in its middle");
}

/// A picture may be much wider than the scene states. It is painted to its borders all the same, as if the scene stated
/// that size.
#[test]
fn a_wide_picture_of_a_tall_scene_is_painted_to_its_borders() {
    let bands = |width_px: u32| {
        let mut scene = floor_scene(500.0);
        scene.size = (width_px, SIZE_PX[1]);
        let seen_from = SeenFrom::for_options(&scene, &FrameOptions::new(SIZE_PX));
        let options = PrepareOptions { seen_from, ..PrepareOptions::default() };
        let loaded = shapes::loaded(scene, [floor(300.0, 1)]);
        let painting = Preparer::default().prepare_with(loaded, &options).unwrap();
        assert!(painting.is_partial() && painting.particle_total() < 200_000, "{width_px} pixels wide");
        let frame = painting.at(0.0, &FrameOptions::new(SIZE_PX));
        // Eight parts of the lowest 160 rows, from the left to the right.
        let mut strokes = [0; 8];
        for [x, y] in frame.strokes.iter().map(|stroke| stroke.center_px) {
            if (0.0..640.0).contains(&x) && (0.0..160.0).contains(&y) {
                strokes[(x / 80.0) as usize] += 1;
            }
        }
        strokes
    };
    let stated = bands(SIZE_PX[0]);
    for width_px in [400, 160, 90] {
        for (found, wanted) in bands(width_px).into_iter().zip(stated) {
            assert!(wanted > 300, "{stated:?}");
            assert!(found * 10 > wanted * 9, "{width_px} pixels wide: {found} strokes, not {wanted}");
        }
    }
}

/// Strokes fade where the ground is seen at a grazing angle. There its own colour shows, not the tone under all paint.
#[test]
fn to_the_horizon_the_ground_keeps_its_colour() {
    let mut scene = floor_scene(5000.0);
    scene.background = Color([0.2, 0.3, 0.9]);
    scene.objects[0].material =
        Some(MaterialOverride { color: Some(Color([0.45, 0.6, 0.25])), ..MaterialOverride::default() });
    scene.lights = vec![Light { intensity: 1.0, ..Light::new("sky", LightKind::Ambient) }];
    let painting = prepare(shapes::loaded(scene, [floor(2000.0, 1)])).unwrap();
    let mut renderer = renderer(Driver::Egl);
    let mut mean = |painting: &Painting| {
        let picture = renderer.render(&painting.at(0.0, &FrameOptions::new(SIZE_PX))).unwrap();
        // The horizon is 110.8 rows down.
        let strip = &picture.rgba8[112 * 640 * 4..118 * 640 * 4];
        let sum =
            |channel: usize| -> f64 { strip.iter().skip(channel).step_by(4).map(|&of| f64::from(of)).sum() };
        [0, 1, 2].map(|channel| sum(channel) / (6.0 * 640.0))
    };
    let [painted, plain] = [mean(&painting), mean(&painting.in_style(Style::Reference))];
    for (painted, plain) in painted.iter().zip(plain) {
        // Varnish makes colours more saturated, by up to 8 of 255.
        assert!((painted - plain).abs() < 10.0, "{painted}, not {plain}");
    }
}
