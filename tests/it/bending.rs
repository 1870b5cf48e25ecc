//! Tests of bodies that bend: strokes turn as closed forms say, there are enough particles where a body stretches, a
//! frame does not depend on the frames computed before it, and bad skins are reported.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3};
use impasto_core::TriangleMesh;
use impasto_measure::truth::{BodyView, PointMotion, ScreenTurn, SurfacePoint, TrueView};
use impasto_painting::frame::{Frame, LayerKind, Stroke, StrokeSource};
use impasto_painting::{FrameOptions, Painting, Rotation, prepare};
use impasto_scene::document::{
    Direction, Ease, ObjectKey, Region, Rest, Scale, Scene, Selector, Solver, Style,
};
use impasto_scene::load::{LoadOptions, load};
use impasto_scene::mesh_file::MeshFile;
use impasto_scene::motion;
use impasto_tests::shapes;

const SIZE_PX: [u32; 2] = [640, 360];

/// A round bar along X, from −1.2 to 1.2.
fn bar(radius: f64) -> TriangleMesh {
    const ALONG: u32 = 96;
    const AROUND: u32 = 48;
    let mut mesh = TriangleMesh::default();
    for ring in 0..=ALONG {
        for side in 0..=AROUND {
            let turn = std::f64::consts::TAU * f64::from(side % AROUND) / f64::from(AROUND);
            let (sin, cos) = turn.sin_cos();
            let x = 2.4 * f64::from(ring) / f64::from(ALONG) - 1.2;
            mesh.positions.push(DVec3::new(x, radius * sin, radius * cos).as_vec3());
            mesh.normals.push(DVec3::new(0.0, sin, cos).as_vec3());
        }
    }
    for ring in 0..ALONG {
        for side in 0..AROUND {
            let at = |ring: u32, side: u32| ring * (AROUND + 1) + side;
            let [a, b, c, d] =
                [at(ring, side), at(ring + 1, side), at(ring + 1, side + 1), at(ring, side + 1)];
            mesh.triangles.extend([[a, c, b], [a, d, c]]);
        }
    }
    let count = mesh.triangles.len();
    mesh.polygon_of_triangle = (0..count as u32).collect();
    (mesh.group_of_triangle, mesh.material_of_triangle) = (vec![0; count], vec![0; count]);
    mesh
}

/// A scene whose only object morphs over ten frames.
fn morphing_scene(angle_deg: f64) -> Scene {
    let mut scene = shapes::scene(vec![shapes::object("thing", 8000)]);
    scene.strokes.layers = shapes::body_layer_alone();
    scene.strokes.contour = Some(0.0);
    scene.camera.keys[0] = shapes::camera_key(0.0, [0.6, 1.0, 5.0], [0.0, 0.1, 0.0]);
    scene.camera.keys[0].roll_deg = 7.0;
    scene.timeline.last = 10;
    scene.objects[0].morph = Some("target.obj".to_owned());
    scene.objects[0].keys = vec![ObjectKey::at(0.0), ObjectKey { morph: 1.0, ..ObjectKey::at(10.0) }];
    let direction = Direction::Angle(angle_deg);
    scene.regions = vec![Region { direction, ..Region::new("all", Selector::Object("thing".to_owned())) }];
    scene
}

/// The angle, in radians, of each stroke of the body layer that faces the eye, by particle.
fn angles(frame: &Frame, least_facing: f32) -> BTreeMap<u32, f64> {
    let run = frame.layers.iter().find(|run| run.kind == LayerKind::Body).expect("a body layer");
    (run.first as usize..(run.first + run.count) as usize)
        .filter(|&index| frame.sources[index].facing > least_facing)
        .map(|index| (frame.sources[index].particle, f64::from(frame.strokes[index].angle_rad)))
        .collect()
}

fn lines_apart_deg(a: f64, b: f64) -> f64 {
    let off = (a - b).rem_euclid(std::f64::consts::PI);
    off.min(std::f64::consts::PI - off).to_degrees()
}

/// Bends a mesh by a map of space. Returns by how many degrees the turn of each stroke differs from the turn that the
/// map gives to the surface's picture there, sorted. Only strokes that face the eye in both frames count. `reference`
/// is the frame in whose picture directions are stated: 0, in which the mesh is straight, or 10, in which it is bent.
fn errors(mesh: &TriangleMesh, map: &dyn Fn(DVec3) -> DVec3, scene: Scene, reference: f64) -> Vec<f64> {
    let target = shapes::moved(mesh, map);
    let painting = prepare(shapes::morphing(scene, [mesh.clone(), target])).expect("the scene is good");
    let views = [reference, 10.0 - reference];
    let shown = |frame: f64, least: f32| angles(&painting.at(frame, &FrameOptions::new(SIZE_PX)), least);
    let (before, after) = (shown(views[0], 0.5), shown(views[1], 0.3));
    let cameras = views.map(|frame| TrueView::new(&motion::camera_at(painting.scene(), frame), SIZE_PX));
    let particles = painting.particles(0);
    let mut errors = Vec::new();
    for (particle, base) in &before {
        let Some(now) = after.get(particle) else { continue };
        let place = particles.at(*particle as usize);
        let (at, normal) = (place.position.as_dvec3(), place.normal.as_dvec3());
        const STEP: f64 = 1e-4;
        let column = |axis: DVec3| (map(at + axis * STEP) - map(at - axis * STEP)) / (2.0 * STEP);
        let gradient = DMat3::from_cols(column(DVec3::X), column(DVec3::Y), column(DVec3::Z));
        let rest = SurfacePoint { position: at, normal };
        let turned = (gradient.inverse().transpose() * normal).normalize();
        let bent = SurfacePoint { position: map(at), normal: turned };
        let moved = if reference == 0.0 {
            PointMotion { before: rest, after: bent, carry: gradient }
        } else {
            PointMotion { before: bent, after: rest, carry: gradient.inverse() }
        };
        let [then, seen] =
            [0, 1].map(|side: usize| BodyView { view: &cameras[side], world_from_model: DAffine3::IDENTITY });
        let Some(truth) = ScreenTurn::between(&moved, then, seen) else { continue };
        errors.push(lines_apart_deg(now - base, truth.polar_rad));
    }
    errors.sort_by(f64::total_cmp);
    assert!(errors.len() > 250, "{} strokes", errors.len());
    errors
}

/// Bent like a bow, about an axis along Z.
fn bowed(at: DVec3) -> DVec3 {
    const RADIUS: f64 = 1.5;
    let (sin, cos) = (at.x / RADIUS).sin_cos();
    DVec3::new((RADIUS + at.y) * sin, (RADIUS + at.y) * cos - RADIUS, at.z)
}

/// Twisted about X, by 137 degrees from end to end.
fn twisted(at: DVec3) -> DVec3 {
    let (sin, cos) = (137f64.to_radians() * at.x / 2.4).sin_cos();
    DVec3::new(at.x, at.y * cos - at.z * sin, at.y * sin + at.z * cos)
}

/// Sheared, and scaled by 1.5 along X, 0.7 along Y and 0.5 along Z.
fn stretched(at: DVec3) -> DVec3 {
    DVec3::new(1.5 * at.x + 0.4 * at.y, 0.7 * at.y, 0.5 * at.z)
}

#[test]
fn strokes_turn_as_closed_forms_of_bending_say() {
    // The last two numbers are the largest errors allowed, in degrees: the 95th percentile, and the maximum.
    for (name, mesh, map, most) in [
        ("a bowed bar", bar(0.45), &bowed as &dyn Fn(DVec3) -> DVec3, [0.035, 0.56]),
        ("a twisted bar", bar(0.5), &twisted, [0.017, 0.18]),
        ("a stretched sheet", shapes::sheet(48), &stretched, [0.001, 0.001]),
        ("a bowed sheet", shapes::sheet(48), &bowed, [0.28, 0.9]),
    ] {
        for angle_deg in [7.0, 30.0, 137.0] {
            // Directions are stated in the picture of the straight shape, then in that of the bent one.
            for reference in [0.0, 10.0] {
                let mut scene = morphing_scene(angle_deg);
                scene.reference = impasto_scene::document::Reference::Frame(reference as i64);
                let errors = errors(&mesh, map, scene, reference);
                let (p95, max) = (errors[errors.len() * 95 / 100], errors[errors.len() - 1]);
                println!("{name}, {angle_deg} from frame {reference}: p95 {p95:.3}, max {max:.3} degrees");
                assert!(p95 <= most[0] && max <= most[1], "{name}, {angle_deg}: p95 {p95}, max {max}");
            }
        }
    }
}

/// When a sheet stretches to 1.5 times its size, strokes get 1.5 times as long with a `size_follow` of 1, √1.5 times
/// with 0.5, and keep their length with 0.
#[test]
fn strokes_that_follow_the_size_grow_with_a_body_that_stretches() {
    for (follow, grown) in [(1.0, 1.5), (0.5, 1.5f64.sqrt()), (0.0, 1.0)] {
        let mut scene = morphing_scene(30.0);
        scene.strokes.size_follow = Some(follow);
        // From afar, so that the depth of a place hardly changes.
        scene.camera.keys[0] = shapes::camera_key(0.0, [0.0, 0.0, 40.0], [0.0; 3]);
        let target = shapes::moved(&shapes::sheet(16), |at| at * 1.5);
        let painting = prepare(shapes::morphing(scene, [shapes::sheet(16), target])).expect("good");
        let lengths = |frame: f64| -> BTreeMap<u32, f64> {
            let frame = painting.at(frame, &FrameOptions::new(SIZE_PX));
            let stroke =
                |(source, stroke): (&StrokeSource, &Stroke)| (source.particle, f64::from(stroke.length_px));
            frame.sources.iter().zip(frame.strokes.iter()).map(stroke).collect()
        };
        let (before, after) = (lengths(0.0), lengths(10.0));
        let both: Vec<f64> =
            before.iter().filter_map(|(particle, length)| Some(after.get(particle)? / length)).collect();
        assert!(both.len() > 30, "{}", both.len());
        for ratio in both {
            assert!((ratio / grown - 1.0).abs() < 0.02, "{follow}: {ratio} times, not {grown}");
        }
    }
}

#[test]
fn a_stated_angle_shows_in_the_reference_whatever_the_rest() {
    let target = shapes::moved(&shapes::sheet(32), bowed);
    for rest in [Rest::Bind, Rest::Frame(10), Rest::Frame(4)] {
        let mut scene = morphing_scene(30.0);
        scene.reference = impasto_scene::document::Reference::Frame(10);
        scene.objects[0].rest = rest;
        let painting = prepare(shapes::morphing(scene, [shapes::sheet(32), target.clone()])).expect("good");
        let shown = angles(&painting.at(10.0, &FrameOptions::new(SIZE_PX)), 0.6);
        let worst =
            shown.values().map(|angle| lines_apart_deg(*angle, 30f64.to_radians())).fold(0.0, f64::max);
        println!("{rest:?}: {worst:.5} degrees off what is stated");
        assert!(shown.len() > 200 && worst < 3e-5, "{rest:?}: {worst} degrees of {} strokes", shown.len());
    }
}

/// Strokes that are raised above the surface have the stated angle and length, even if the body is bent in the
/// reference.
#[test]
fn raised_strokes_show_as_stated_in_a_bent_reference() {
    let target = shapes::moved(&shapes::sheet(32), stretched);
    let painting = |follow: f64| {
        let mut scene = morphing_scene(30.0);
        scene.reference = impasto_scene::document::Reference::Frame(10);
        scene.strokes.offset = Some(0.6);
        scene.strokes.size_follow = Some(follow);
        prepare(shapes::morphing(scene, [shapes::sheet(32), target.clone()])).expect("good")
    };
    let (stated, following) = (painting(0.0), painting(1.0));
    let options = FrameOptions::new(SIZE_PX);
    let turned = angles(&stated.at(10.0, &options), 0.6);
    let unturned = angles(&stated.at(10.0, &FrameOptions { rotation: Rotation::Off, ..options }), 0.6);
    assert!(turned.len() > 200, "{}", turned.len());
    let apart = turned.iter().map(|(particle, angle)| lines_apart_deg(*angle, unturned[particle]));
    let worst = apart.fold(0.0, f64::max);
    println!("raised, in the reference: at most {worst:.6} degrees off");
    assert!(worst < 1.5e-5, "{worst} degrees");
    let lengths = |painting: &Painting| -> BTreeMap<u32, f32> {
        let frame = painting.at(10.0, &options);
        let of = frame.sources.iter().zip(&frame.strokes);
        of.map(|(source, stroke)| (source.particle, stroke.length_px)).collect()
    };
    let (own, followed) = (lengths(&stated), lengths(&following));
    let grown = turned.keys().map(|particle| (followed[particle] / own[particle] - 1.0).abs());
    println!("raised, in the reference: at most {:e} longer or shorter", grown.fold(0.0, f32::max));
    for particle in turned.keys() {
        let ratio = followed[particle] / own[particle];
        assert!(
            (ratio - 1.0).abs() < 1e-6,
            "{particle}: size_follow makes it {ratio} times as long, even in the reference"
        );
    }
}

#[test]
fn the_paper_s_sum_agrees_on_a_bent_body() {
    let mut scene = morphing_scene(30.0);
    scene.objects[0].particles = Some(20_000);
    let angles_of = |solver: Solver| {
        let mut scene = scene.clone();
        let Style::RotatingStrokes(style) = &mut scene.style else { panic!("the usual style") };
        style.solver = solver;
        let target = shapes::moved(&shapes::sheet(32), twisted);
        let painting = prepare(shapes::morphing(scene, [shapes::sheet(32), target])).expect("good");
        angles(&painting.at(10.0, &FrameOptions::new(SIZE_PX)), 0.6)
    };
    let (tangent, exact) = (angles_of(Solver::Tangent), angles_of(Solver::HornExact));
    let mut apart: Vec<f64> = tangent
        .iter()
        .filter_map(|(particle, angle)| Some(lines_apart_deg(*angle, *exact.get(particle)?)))
        .collect();
    apart.sort_by(f64::total_cmp);
    let (p50, p95) = (apart[apart.len() / 2], apart[apart.len() * 95 / 100]);
    println!("tangent against the paper's sum: p50 {p50:.3}, p95 {p95:.3} degrees over {}", apart.len());
    assert!(apart.len() > 200 && p50 <= 0.37 && p95 <= 1.95, "{p50} {p95}");
}

/// A body that stretches threefold has as many strokes per pixel as at rest.
#[test]
fn a_stretched_body_has_no_fewer_strokes_a_pixel() {
    let wide = |at: DVec3| DVec3::new(3.0 * at.x, at.y, at.z);
    let mut scene = morphing_scene(7.0);
    scene.objects[0].particles = None;
    // The camera is far enough away to see all of the stretched sheet, and looks straight at it.
    scene.camera.keys = vec![shapes::camera_key(0.0, [0.0, 0.0, 12.0], [0.0; 3])];
    let target = shapes::moved(&shapes::sheet(32), wide);
    let (mut rest, mut wide) = (0.0, 0.0);
    // Chance decides how many of the first particles lie on the visible side, so the counts of several seeds are added.
    for seed in 1..=6 {
        scene.seed = seed;
        let morphing = shapes::morphing(scene.clone(), [shapes::sheet(32), target.clone()]);
        let painting = prepare(morphing).expect("good");
        let present = |frame: f64| {
            let frame = painting.at(frame, &FrameOptions::new(SIZE_PX));
            frame.strokes.iter().filter(|stroke| stroke.supply_ln > 0.0).count() as f64
        };
        let counts = [present(0.0), present(10.0)];
        println!("{counts:?}");
        (rest, wide) = (rest + counts[0], wide + counts[1]);
    }
    println!("{rest} strokes at rest, {wide} on three times the area");
    assert!(rest > 600.0 && (wide / rest / 3.0 - 1.0).abs() < 0.015, "{rest} {wide}");
}

/// The bounds of shadows contain the body in every frame, also between the frames at which its motion is sampled.
#[test]
fn shadows_reach_as_far_as_a_morph_goes() {
    let mut scene = morphing_scene(7.0);
    scene.timeline.last = 160;
    let key = |frame: f64, morph: f64| ObjectKey { morph, ..ObjectKey::at(frame) };
    scene.objects[0].keys = vec![key(0.0, 0.0), key(5.0, 1.0), key(9.0, 0.0)];
    let target = shapes::moved(&shapes::sheet(4), |at| at + DVec3::Y * 3.0);
    let painting = prepare(shapes::morphing(scene, [shapes::sheet(4), target])).expect("good");
    let (center, radius) = painting.at(5.0, &FrameOptions::new(SIZE_PX)).lights.shadow_bounds;
    let bent = painting.bent_at(5.0)[0].clone().expect("it is bent");
    for at in &bent.vertices.positions {
        assert!(at.distance(center) <= radius, "{at} is outside of {radius} round {center}");
    }
}

#[test]
fn a_collapsed_or_mirrored_body_paints_numbers() {
    for map in [
        &(|_| DVec3::ZERO) as &dyn Fn(DVec3) -> DVec3,
        &|at| DVec3::new(-at.x, at.y, at.z),
        &|at| DVec3::new(at.x.abs(), at.y, at.z),
        &|at| DVec3::new(at.x, 0.0, 0.0),
    ] {
        let target = shapes::moved(&shapes::sheet(12), map);
        let painting =
            prepare(shapes::morphing(morphing_scene(30.0), [shapes::sheet(12), target])).expect("good");
        for frame in [3.0, 5.0, 9.5, 10.0] {
            let frame = painting.at(frame, &FrameOptions::new(SIZE_PX));
            for (stroke, source) in frame.strokes.iter().zip(&frame.sources) {
                let numbers =
                    [stroke.angle_rad, stroke.length_px, stroke.width_px, stroke.supply_ln, source.kappa];
                assert!(numbers.iter().all(|number| number.is_finite()), "{stroke:?}");
                let normal = stroke.normal_in_world;
                assert!(normal.iter().all(|number| number.is_finite()), "{stroke:?}");
            }
        }
    }
}

#[test]
fn an_uneven_scale_turns_strokes_as_its_map_says() {
    // A sheet that the scale of its keys stretches must have the same angles as one whose mesh is stretched.
    let scales = [1.5, 0.6, 1.0];
    let mut keyed = morphing_scene(30.0);
    keyed.objects[0].morph = None;
    keyed.objects[0].keys = vec![
        ObjectKey { ease: Ease::Linear, ..ObjectKey::at(0.0) },
        ObjectKey { scale: Scale(scales), ..ObjectKey::at(10.0) },
    ];
    let mut morphed = morphing_scene(30.0);
    let stretch = |at: DVec3| at * DVec3::from(scales);
    let of = |painting: &Painting| angles(&painting.at(10.0, &FrameOptions::new(SIZE_PX)), 0.3);
    keyed.strokes.flatness = Some(0.5);
    morphed.strokes.flatness = Some(0.5);
    let by_keys = of(&prepare(shapes::loaded(keyed, [shapes::sheet(16)])).expect("good"));
    let target = shapes::moved(&shapes::sheet(16), stretch);
    let by_morph = of(&prepare(shapes::morphing(morphed, [shapes::sheet(16), target])).expect("good"));
    let both = by_keys.iter().filter_map(|(particle, angle)| Some((angle, by_morph.get(particle)?)));
    let apart: Vec<f64> = both.map(|(angle, other)| lines_apart_deg(*angle, *other)).collect();
    let worst = apart.iter().copied().fold(0.0, f64::max);
    println!("keyed against modelled: at most {worst:.5} degrees");
    assert!(apart.len() > 300 && worst < 3e-5, "{worst} degrees of {}", apart.len());
}

/// Reads a changed copy of the parade's shot. Returns whether it was read, and its warnings or errors.
fn changed_parade(change: impl FnOnce(&mut serde_json::Value, &mut Vec<u8>)) -> (bool, String) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("parade.glb");
    let shot = impasto_tests::command::root().join("scenes/meshes/parade.glb");
    std::fs::copy(shot, &path).expect("copied");
    impasto_tests::glb::edit(&path, change);
    match load(&path, &LoadOptions::default()) {
        Ok(loaded) => {
            let painting = prepare(Arc::new(loaded)).expect("prepared");
            painting.at(13.0, &FrameOptions::new([64, 36]));
            let warnings: Vec<String> =
                painting.loaded().warnings.iter().map(|warning| warning.to_string()).collect();
            (true, warnings.join("\n"))
        }
        Err(report) => (false, report.to_string()),
    }
}

/// glTF places a skinned mesh by its joints alone and ignores the transform of the mesh's own node.
#[test]
fn the_place_of_a_skinned_node_is_passed_over() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("parade.glb");
    let shot = impasto_tests::command::root().join("scenes/meshes/parade.glb");
    std::fs::copy(shot, &path).expect("copied");
    let scene = folder.path().join("still.ron");
    std::fs::write(&scene, "(version: 1, objects: [(name: \"all\", mesh: \"parade.glb\")], camera: (keys: [(frame: 0, eye: (0, 1, 9), target: (0, 1, 0))]))").expect("written");
    let positions = || {
        let loaded = load(&scene, &LoadOptions::default()).unwrap_or_else(|report| panic!("{report}"));
        loaded.meshes["parade.glb"].mesh.positions.clone()
    };
    let before = positions();
    let mut count = 0;
    impasto_tests::glb::edit(&path, |root, _| {
        for node in root["nodes"].as_array_mut().expect("nodes") {
            if node["skin"].is_number() {
                (node["translation"], node["scale"]) =
                    (serde_json::json!([5, 1, 0]), serde_json::json!([0.01, 0.01, 0.01]));
                count += 1;
            }
        }
    });
    assert!(count > 0 && positions() == before);
}

/// In a skinned mesh, a primitive without joints moves with the first joint. At rest, the mesh as it was read and the
/// mesh as joints bend it are the same.
#[test]
fn a_primitive_without_joints_moves_with_the_first() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("parade.glb");
    std::fs::copy(impasto_tests::command::root().join("scenes/meshes/parade.glb"), &path).expect("copied");
    let scene = folder.path().join("s.ron");
    std::fs::write(&scene, "(version: 1, shot: \"parade.glb\")").expect("written");
    let giant = || {
        let loaded = load(&scene, &LoadOptions::default()).unwrap_or_else(|report| panic!("{report}"));
        let is_skinned = |file: &&Arc<MeshFile>| file.bend.as_ref().is_some_and(|bend| bend.skin.is_some());
        let mut skinned = loaded.meshes.values().filter(is_skinned);
        let giant = Arc::clone(skinned.next().expect("the giant has joints"));
        assert!(skinned.next().is_none());
        giant
    };
    let before = giant();
    impasto_tests::glb::edit(&path, |root, _| {
        let meshes = root["meshes"].as_array_mut().expect("meshes");
        let body = meshes.iter_mut().find(|mesh| mesh["name"] == "body").expect("the giant's");
        let attributes = body["primitives"][0]["attributes"].as_object_mut().expect("attributes");
        assert!(attributes.remove("JOINTS_0").is_some() && attributes.remove("WEIGHTS_0").is_some());
    });
    let after = giant();
    let bend = after.bend.as_ref().expect("it still bends");
    let bent = bend.at(&bend.rest);
    assert_eq!(after.mesh.positions.len(), bent.positions.len());
    for (vertex, (at, bent)) in after.mesh.positions.iter().zip(&bent.positions).enumerate() {
        assert!(at.distance(*bent) < 1e-5, "vertex {vertex} is read at {at} and bent to {bent}");
    }
    // At rest the primitive is where it was when it had joints of its own: none of it is left behind.
    let far = |(a, b): (&glam::Vec3, &glam::Vec3)| a.distance(*b) > 0.3;
    assert_eq!(before.mesh.positions.len(), after.mesh.positions.len());
    assert!(!before.mesh.positions.iter().zip(&after.mesh.positions).any(far));
}

fn bytes_of<'a>(root: &serde_json::Value, bin: &'a mut [u8], accessor: &serde_json::Value) -> &'a mut [u8] {
    let accessor = &root["accessors"][accessor.as_u64().expect("an index") as usize];
    let view = &root["bufferViews"][accessor["bufferView"].as_u64().expect("a view") as usize];
    let number = |value: &serde_json::Value| value.as_u64().unwrap_or(0) as usize;
    let start = number(&view["byteOffset"]) + number(&accessor["byteOffset"]);
    &mut bin[start..start + number(&view["byteLength"])]
}

#[test]
fn bad_skins_are_told_and_never_hang() {
    let skinned = |root: &serde_json::Value, attribute: &str| {
        let meshes = root["meshes"].as_array().expect("meshes");
        let mut primitives =
            meshes.iter().flat_map(|mesh| mesh["primitives"].as_array().expect("primitives"));
        primitives
            .find_map(|primitive| primitive["attributes"].get(attribute))
            .expect("a skinned primitive")
            .clone()
    };
    let (is_read, said) = changed_parade(|root, bin| {
        let joints = skinned(root, "JOINTS_0");
        bytes_of(root, bin, &joints).fill(200);
    });
    assert!(!is_read && ["/skins/", "JOINTS_0", "joint"].iter().any(|part| said.contains(part)), "{said}");
    let (is_read, said) = changed_parade(|root, bin| {
        let weights = skinned(root, "WEIGHTS_0");
        bytes_of(root, bin, &weights).fill(0);
    });
    assert!(is_read && said.contains("no joint weights"), "{said}");
    let (is_read, said) = changed_parade(|root, bin| {
        let matrices = root["skins"][0]["inverseBindMatrices"].clone();
        bytes_of(root, bin, &matrices)[..64].fill(0xff);
    });
    assert!(!is_read && said.contains("not finite"), "{said}");
    let (is_read, said) = changed_parade(|root, _| {
        // A joint becomes the parent of its own parent.
        let nodes = root["nodes"].as_array_mut().expect("nodes");
        let parent = nodes.iter().position(|node| node["children"].is_array()).expect("a parent");
        let child = nodes[parent]["children"][0].as_u64().expect("an index") as usize;
        nodes[child]["children"] = serde_json::json!([parent]);
    });
    assert!(!is_read && said.contains("/nodes/"), "{said}");
}

/// Frames of the parade, in any order, alone and with other numbers of threads, are the same to the bit.
#[test]
fn any_frame_alone_is_the_frame_of_the_sequence() {
    let path = impasto_tests::command::root().join("scenes/parade.ron");
    let loaded = Arc::new(load(&path, &LoadOptions::default()).unwrap_or_else(|report| panic!("{report}")));
    let options = FrameOptions::new([320, 180]);
    let painting = prepare(Arc::clone(&loaded)).expect("good");
    let sums = |painting: &Painting, frame: f64| {
        let frame = painting.at(frame, &options);
        let bodies: Vec<_> =
            frame.bodies.iter().map(|body| body.bent.as_ref().map(|bent| bent.vertices.clone())).collect();
        (frame.strokes, bodies)
    };
    let frames = [0.0, 13.0, 24.0, 30.5];
    let in_order: Vec<_> = frames.iter().map(|frame| sums(&painting, *frame)).collect();
    for (index, frame) in frames.iter().enumerate().rev() {
        assert!(sums(&painting, *frame) == in_order[index], "frame {frame} again");
    }
    for threads in [1, 2, 7] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("a pool");
        let alone = pool.install(|| sums(&prepare(Arc::clone(&loaded)).expect("good"), 13.0));
        assert!(alone == in_order[1], "{threads} threads");
    }
    assert!(in_order[0] != in_order[1]);
}
