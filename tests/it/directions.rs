//! Tests of painted directions: strokes show as they were combed, keep their angles when more is painted or sampled,
//! and strokes that the reference never saw agree with their neighbours.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use glam::{DVec2, DVec3, Vec3};
use impasto_core::TriangleMesh;
use impasto_painting::frame::LayerKind;
use impasto_painting::{Frame, FrameOptions, Painting, prepare};
use impasto_scene::document::{
    Bend, Dab, Direction, Guide, ObjectKey, Reference, Region, Scale, Scene, Seam, Selector, Sense,
    StrokeSettings,
};
use impasto_scene::motion::CameraPose;
use impasto_tests::gestures::{camera, drag};
use impasto_tests::shapes;

pub(crate) const SIZE_PX: [u32; 2] = [640, 360];

/// A stroke of the body layer. Its centre `at_px` is counted from the middle of the picture, Y up.
#[derive(Clone, Copy)]
pub(crate) struct Seen {
    pub(crate) at_px: DVec2,
    pub(crate) angle_rad: f64,
    pub(crate) facing: f32,
    pub(crate) region: u32,
}

pub(crate) fn body_strokes(frame: &Frame) -> BTreeMap<u32, Seen> {
    let run = frame.layers.iter().find(|run| run.kind == LayerKind::Body).expect("a body layer");
    let half_px = DVec2::new(f64::from(SIZE_PX[0]), f64::from(SIZE_PX[1])) * 0.5;
    (run.first as usize..(run.first + run.count) as usize)
        .map(|index| {
            let (stroke, source) = (&frame.strokes[index], &frame.sources[index]);
            let [x, y] = stroke.center_px.map(f64::from);
            let seen = Seen {
                at_px: DVec2::new(x, y) - half_px,
                angle_rad: f64::from(stroke.angle_rad),
                facing: source.facing,
                region: source.region,
            };
            (source.particle, seen)
        })
        .collect()
}

/// The angle between two undirected lines, degrees.
fn lines_apart(a: f64, b: f64) -> f64 {
    let off = (a - b).rem_euclid(PI);
    off.min(PI - off).to_degrees()
}

fn seen_by(painting: &Painting, camera: &CameraPose) -> BTreeMap<u32, Seen> {
    body_strokes(&painting.seen_by(camera, 0.0, &FrameOptions::new(SIZE_PX)))
}

/// One object without jitter, and one region with this direction and these guides.
fn combed(direction: Direction, guides: Vec<Guide>, particles: u64) -> Scene {
    let mut scene = shapes::scene(vec![shapes::object("thing", particles)]);
    scene.strokes.contour = Some(0.0);
    scene.strokes.layers = shapes::body_layer_alone();
    (scene.strokes.length_px, scene.strokes.width_px) = (Some(8.0), Some(2.6));
    scene.regions =
        vec![Region { direction, guides, ..Region::new("combed", Selector::Object("thing".to_owned())) }];
    scene
}

fn painted(scene: Scene, mesh: TriangleMesh) -> Painting {
    prepare(shapes::loaded(scene, [mesh])).unwrap()
}

/// Views of the point (0, `height`, 0): as the reference sees it, from both sides, and from above. Each comes with
/// roughly the angle by which it is turned from the reference's view, degrees.
fn off_the_reference(height: f64) -> Vec<(f64, CameraPose)> {
    let eye = |yaw: f64, pitch: f64| {
        let (yaw, pitch) = (yaw.to_radians(), pitch.to_radians());
        [4.0 * yaw.sin() * pitch.cos(), height + 4.0 * pitch.sin(), 4.0 * yaw.cos() * pitch.cos()]
    };
    [(0.0, 0.0), (30.0, 0.0), (60.0, 0.0), (-30.0, 0.0), (-60.0, 0.0), (0.0, 30.0), (0.0, 60.0), (45.0, 40.0)]
        .map(|(yaw, pitch)| (f64::hypot(yaw, pitch), camera(eye(yaw, pitch), [0.0, height, 0.0])))
        .into()
}

#[test]
fn what_is_combed_is_what_is_seen() {
    let mesh = shapes::apple_skin();
    let mut rows = Vec::new();
    for (off_deg, view) in off_the_reference(0.5) {
        for angle_deg in [-77.0f64, 7.0, 30.0, 137.0] {
            for (direction, flatness) in [(Direction::Auto, 1.0), (Direction::Angle(20.0), 0.4)] {
                let half = DVec2::from_angle(angle_deg.to_radians()) * 26.0;
                let ends = [DVec2::new(4.0, -6.0) - half, DVec2::new(4.0, -6.0) + half];
                let guide = drag(&mesh, &view, 360.0, ends).expect("the gesture lies on the apple");
                let mut scene = combed(direction, vec![guide], 40_000);
                scene.camera.keys[0] = shapes::camera_key(0.0, [0.0, 0.5, 4.0], [0.0, 0.5, 0.0]);
                scene.strokes.flatness = Some(flatness);
                let painting = painted(scene, mesh.clone());
                // Strokes whose centre lies within a pixel of the gesture.
                let along = (ends[1] - ends[0]).normalize();
                let errors: Vec<f64> = seen_by(&painting, &view)
                    .values()
                    .filter(|seen| {
                        let from = seen.at_px - ends[0];
                        // Strokes on the far wall of the dimple are left out.
                        seen.facing > 0.35
                            && from.perp_dot(along).abs() < 1.0
                            && (4.0..48.0).contains(&from.dot(along))
                    })
                    .map(|seen| lines_apart(seen.angle_rad, angle_deg.to_radians()))
                    .collect();
                rows.push((off_deg, errors));
            }
        }
    }
    let mut worst = 0.0f64;
    let mut count = 0;
    for (off_deg, errors) in &rows {
        assert!(errors.len() >= 5, "{} strokes on a gesture at {off_deg}", errors.len());
        count += errors.len();
        worst = worst.max(errors.iter().copied().fold(0.0, f64::max));
    }
    println!("painted against shown over {count} strokes and {} gestures: at most {worst:.3}", rows.len());
    assert!(count >= 500 && worst <= 0.5, "{worst} degrees over {count} strokes");
}

#[test]
fn a_guide_baked_against_the_wrong_view_would_show() {
    let mesh = shapes::apple_skin();
    let view = camera([4.0 * 60f64.to_radians().sin(), 0.5, 2.0], [0.0, 0.5, 0.0]);
    let ends = [DVec2::new(-16.0, -16.0), DVec2::new(16.0, 16.0)];
    let mut guide = drag(&mesh, &view, 360.0, ends).unwrap();
    guide.view = None;
    let mut scene = combed(Direction::Auto, vec![guide], 40_000);
    scene.camera.keys[0] = shapes::camera_key(0.0, [0.0, 0.5, 4.0], [0.0, 0.5, 0.0]);
    let errors: Vec<f64> = seen_by(&painted(scene, mesh), &view)
        .values()
        .filter(|seen| (seen.at_px.x - seen.at_px.y).abs() < 1.4 && seen.at_px.length() < 18.0)
        .map(|seen| lines_apart(seen.angle_rad, PI / 4.0))
        .collect();
    let mean = errors.iter().sum::<f64>() / errors.len() as f64;
    assert!(errors.len() >= 5 && mean > 2.0, "{mean} degrees: the wrong view is not noticed");
}

#[test]
fn twice_the_particles_are_combed_alike() {
    let mesh = shapes::apple_skin();
    let view = camera([0.0, 0.5, 4.0], [0.0, 0.5, 0.0]);
    let guides = || {
        [[-20.0, 10.0, 20.0, 24.0], [-10.0, -24.0, 24.0, -12.0]].map(|[ax, ay, bx, by]| {
            drag(&mesh, &view, 360.0, [DVec2::new(ax, ay), DVec2::new(bx, by)]).unwrap()
        })
    };
    let angles = |particles| {
        let mut scene = combed(Direction::Auto, guides().into(), particles);
        scene.camera.keys[0] = shapes::camera_key(0.0, [0.0, 0.5, 4.0], [0.0, 0.5, 0.0]);
        let painting = painted(scene, mesh.clone());
        let places: Vec<Vec3> = painting.particles(0).iter().map(|particle| particle.position).collect();
        (seen_by(&painting, &view), places)
    };
    let ((once, _), (twice, places)) = (angles(10_000), angles(20_000));
    let apart: Vec<f64> = once
        .iter()
        .filter_map(|(particle, seen)| Some(lines_apart(seen.angle_rad, twice.get(particle)?.angle_rad)))
        .collect();
    let mean = apart.iter().sum::<f64>() / apart.len() as f64;
    // New strokes lie between the old ones: compare each with the nearest old one on the surface.
    let to_nearest: Vec<f64> = twice
        .iter()
        .filter(|(particle, seen)| **particle >= 10_000 && seen.facing > 0.3)
        .filter_map(|(particle, seen)| {
            let here = places[*particle as usize];
            let distance = |other: &u32| here.distance(places[*other as usize]);
            let nearest = once.keys().min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
            Some(lines_apart(seen.angle_rad, once[nearest].angle_rad))
        })
        .collect();
    let mean_between = to_nearest.iter().sum::<f64>() / to_nearest.len() as f64;
    println!(
        "twice the density: mean {mean:.4} over {} strokes, to the nearest old one {mean_between:.2} over {}",
        apart.len(),
        to_nearest.len()
    );
    assert!(apart.len() >= 500 && mean <= 0.01, "{mean}");
    assert!(to_nearest.len() >= 500 && mean_between <= 3.0, "{mean_between}");
}

#[test]
fn guides_rule_the_whole_of_an_automatic_region_and_only_their_reach_elsewhere() {
    let mesh = shapes::sheet(20);
    let view = camera([0.0, 0.0, 4.0], [0.0; 3]);
    let guide = || drag(&mesh, &view, 360.0, [DVec2::new(-40.0, 0.0), DVec2::new(0.0, 60.0)]).unwrap();
    let drawn_rad = DVec2::new(40.0, 60.0).to_angle();
    let far = |direction: Direction| -> Vec<f64> {
        let painting = painted(combed(direction, vec![guide()], 8000), mesh.clone());
        let strokes = seen_by(&painting, &view);
        let far = |seen: &&Seen| seen.at_px.x > 60.0;
        strokes.values().filter(far).map(|seen| seen.angle_rad).collect()
    };
    let automatic = far(Direction::Auto);
    assert!(automatic.len() >= 500);
    // A plane has no curvature, so everywhere on it the guide's direction is the same, as seen straight on.
    let worst = automatic.iter().map(|&angle| lines_apart(angle, drawn_rad)).fold(0.0, f64::max);
    assert!(worst < 0.5, "{worst}");
    let stated = far(Direction::Angle(20.0));
    let worst = stated.iter().map(|&angle| lines_apart(angle, 20f64.to_radians())).fold(0.0, f64::max);
    assert!(worst < 1e-3, "{worst}");
}

#[test]
fn a_later_gesture_goes_over_an_earlier_one() {
    let mesh = shapes::sheet(20);
    let view = camera([0.0, 0.0, 4.0], [0.0; 3]);
    let at = |degrees: f64| {
        let half = DVec2::from_angle(degrees.to_radians()) * 60.0;
        drag(&mesh, &view, 360.0, [-half, half]).unwrap()
    };
    let painting = painted(combed(Direction::Angle(0.0), vec![at(30.0), at(100.0)], 20_000), mesh.clone());
    let middle: Vec<f64> = seen_by(&painting, &view)
        .values()
        .filter(|seen| seen.at_px.length() < 3.0)
        .map(|seen| lines_apart(seen.angle_rad, 100f64.to_radians()))
        .collect();
    assert!(middle.len() >= 3 && middle.iter().all(|&error| error < 1.0), "{middle:?}");
}

/// The largest angle, in degrees, between strokes less than 3 pixels apart, on a sheet whose right half is covered by
/// dabs of another region.
fn step_over_a_seam(seam: Seam) -> f64 {
    let dabs: Vec<Dab> = (0..40)
        .map(|index| Dab {
            at: [0.25 + 0.25 * f64::from(index % 4), -1.0 + 0.22 * f64::from(index / 4), 0.0],
            normal: [0.0, 0.0, 1.0],
            radius: 0.3,
            take_away: false,
        })
        .collect();
    let mut scene = combed(Direction::Angle(0.0), Vec::new(), 20_000);
    scene.regions.push(Region {
        direction: Direction::Angle(70.0),
        seam,
        ..Region::new("dabbed", Selector::Dabs("thing".to_owned(), dabs))
    });
    let painting = painted(scene, shapes::sheet(20));
    let strokes: Vec<Seen> = seen_by(&painting, &camera([0.0, 0.0, 4.0], [0.0; 3])).into_values().collect();
    assert!(strokes.iter().any(|seen| seen.region == 1 && seen.at_px.x > 80.0));
    assert!(strokes.iter().all(|seen| seen.region == 0 || seen.at_px.x > -14.0), "dabs reach too far left");
    let far = |seen: &&Seen| seen.at_px.x > 100.0;
    let worst = strokes
        .iter()
        .filter(far)
        .map(|seen| lines_apart(seen.angle_rad, 70f64.to_radians()))
        .fold(0.0, f64::max);
    assert!(worst < 0.6, "far from the seam the stated direction holds: {worst}");
    strokes
        .iter()
        .step_by(7)
        .flat_map(|a| {
            let near = |b: &&Seen| a.at_px.distance(b.at_px) < 3.0;
            strokes.iter().filter(near).map(|b| lines_apart(a.angle_rad, b.angle_rad))
        })
        .fold(0.0, f64::max)
}

#[test]
fn seams_are_hard_or_soft_as_the_region_says() {
    let (hard, soft) = (step_over_a_seam(Seam::Hard), step_over_a_seam(Seam::Soft(0.3)));
    println!("largest step between neighbours: hard seam {hard:.1}, soft {soft:.1} degrees");
    assert!((hard - 70.0).abs() < 1e-3, "{hard}");
    assert!(soft < 12.0, "{soft}");
}

#[test]
fn arrows_and_lines_on_one_body_meet_where_they_agree() {
    // Both halves state the same 50 degrees, one as arrows. A soft seam has nothing to turn.
    let mut scene = combed(Direction::Angle(50.0), Vec::new(), 8000);
    let right = (0..40).map(|index| Dab {
        at: [0.25 + 0.25 * f64::from(index % 4), -1.0 + 0.22 * f64::from(index / 4), 0.0],
        normal: [0.0, 0.0, 1.0],
        radius: 0.3,
        take_away: false,
    });
    scene.regions.push(Region {
        direction: Direction::Angle(50.0),
        seam: Seam::Soft(0.4),
        sense: Sense::Arrows,
        ..Region::new("dabbed", Selector::Dabs("thing".to_owned(), right.collect()))
    });
    let painting = painted(scene, shapes::sheet(20));
    let strokes = seen_by(&painting, &camera([0.0, 0.0, 4.0], [0.0; 3]));
    let worst =
        strokes.values().map(|seen| lines_apart(seen.angle_rad, 50f64.to_radians())).fold(0.0, f64::max);
    assert!(strokes.values().any(|seen| seen.region == 1) && worst < 0.6, "{worst} degrees off");
}

/// A tube round Y, open at both ends.
fn tube() -> TriangleMesh {
    let mut mesh = shapes::sphere(64, 24);
    // The grid of a sphere, with its rows spread along a straight tube.
    for (position, normal) in mesh.positions.iter_mut().zip(&mut mesh.normals) {
        let round = Vec3::new(normal.x, 0.0, normal.z).normalize_or(Vec3::Z);
        *position = round * 0.4 + Vec3::Y * normal.y.asin();
        *normal = round;
    }
    mesh.triangles
        .retain(|corners| corners.iter().all(|&vertex| mesh.positions[vertex as usize].y.abs() < 1.4));
    let kept = mesh.triangles.len();
    mesh.polygon_of_triangle = (0..kept as u32).collect();
    mesh.group_of_triangle.truncate(kept);
    mesh.material_of_triangle.truncate(kept);
    mesh
}

#[test]
fn the_bend_of_a_tube_is_along_it_and_round_it() {
    for (bend, wanted_deg) in [(Bend::Min, 90.0f64), (Bend::Max, 0.0)] {
        let painting = painted(combed(Direction::Curvature(bend), Vec::new(), 8000), tube());
        let errors: Vec<f64> = seen_by(&painting, &camera([0.0, 0.0, 4.0], [0.0; 3]))
            .values()
            .filter(|seen| seen.facing > 0.8 && seen.at_px.y.abs() < 80.0)
            .map(|seen| lines_apart(seen.angle_rad, wanted_deg.to_radians()))
            .collect();
        let mean = errors.iter().sum::<f64>() / errors.len() as f64;
        println!("{bend:?}: {mean:.2} degrees off over {} strokes", errors.len());
        assert!(errors.len() >= 300 && mean < 5.0, "{bend:?}: {mean}");
    }
}

#[test]
fn toward_a_point_runs_there() {
    let painting = painted(combed(Direction::Toward([0.3, 0.2, 0.0]), Vec::new(), 4000), shapes::sheet(8));
    let strokes = seen_by(&painting, &camera([0.0, 0.0, 4.0], [0.0; 3]));
    let px_per_unit = 0.5 * 360.0 / 17.5f64.to_radians().tan() / 4.0;
    let target_px = DVec2::new(0.3, 0.2) * px_per_unit;
    let errors = strokes.values().filter(|seen| seen.at_px.distance(target_px) > 8.0);
    let worst = errors
        .map(|seen| lines_apart(seen.angle_rad, (target_px - seen.at_px).to_angle()))
        .fold(0.0, f64::max);
    assert!(strokes.len() >= 500 && worst < 0.05, "{worst}");
}

/// Compares each stroke whose surface faces away from the reference with its ten nearest neighbours. Returns the median
/// and the 95th percentile of the angles between them, degrees, and the number of such strokes. (A simple form of M6
/// of `impasto measure`.)
fn coherence(painting: &Painting, now: &CameraPose, reference: DVec3) -> (f64, f64, usize) {
    let strokes = seen_by(painting, now);
    let particles = painting.particles(0);
    let shown: Vec<(u32, Seen)> = strokes.into_iter().filter(|(_, seen)| seen.facing > 0.2).collect();
    let mut apart = Vec::new();
    let mut count = 0;
    for (particle, seen) in &shown {
        let there = &particles.at(*particle as usize);
        if there.normal.as_dvec3().dot(reference - there.position.as_dvec3()) > 0.0 {
            continue;
        }
        count += 1;
        let mut near: Vec<(f64, f64)> = shown
            .iter()
            .filter(|(other, _)| other != particle)
            .map(|(_, other)| (seen.at_px.distance(other.at_px), other.angle_rad))
            .collect();
        near.sort_by(|a, b| a.0.total_cmp(&b.0));
        apart.extend(near.iter().take(10).map(|(_, angle)| lines_apart(*angle, seen.angle_rad)));
    }
    apart.sort_by(f64::total_cmp);
    (apart[apart.len() / 2], apart[apart.len() * 95 / 100], count)
}

#[test]
fn revealed_strokes_join_the_painted_ones() {
    let reference = DVec3::new(0.6, 1.4, 3.7);
    for angle_deg in [0.0, 35.0, 90.0] {
        let mut scene = combed(Direction::Angle(angle_deg), Vec::new(), 12_000);
        scene.camera.keys[0] = shapes::camera_key(0.0, reference.to_array(), [0.0; 3]);
        let painting = painted(scene, shapes::sphere(48, 24));
        for (yaw_deg, median_most, p95_most) in [(90.0f64, 3.0, 12.0), (180.0, 6.0, 25.0)] {
            let turned = glam::DMat3::from_rotation_y(yaw_deg.to_radians()) * reference;
            let (median, p95, count) = coherence(&painting, &camera(turned.to_array(), [0.0; 3]), reference);
            println!(
                "{angle_deg} degrees, turned {yaw_deg}: median {median:.2}, p95 {p95:.2} over {count} strokes"
            );
            assert!(count >= 500, "{count} strokes");
            assert!(median <= median_most && p95 <= p95_most, "median {median}, p95 {p95}");
        }
    }
}

#[test]
fn a_further_reference_states_what_the_first_does_not_see() {
    let back =
        Reference::View { eye: [0.0, 0.0, -4.0], target: [0.0; 3], roll_deg: 0.0, fov_y_deg: None, frame: 0 };
    let angles = |edit: &dyn Fn(&mut Scene)| {
        let mut scene = combed(Direction::Angle(25.0), Vec::new(), 6000);
        edit(&mut scene);
        let painting = painted(scene, shapes::sphere(48, 24));
        let of = |z: f64| -> Vec<f64> {
            seen_by(&painting, &camera([0.0, 0.0, z], [0.0; 3]))
                .values()
                .filter(|seen| seen.facing > 0.6)
                .map(|seen| lines_apart(seen.angle_rad, 25f64.to_radians()))
                .collect()
        };
        [4.0, -4.0].map(|z| {
            let found = of(z);
            assert!(found.len() >= 300);
            found.into_iter().fold(0.0, f64::max)
        })
    };
    let [front, behind] = angles(&|_| {});
    assert!(front < 0.01 && behind > 5.0, "{front} {behind}");
    let [front, behind] = angles(&|scene| scene.further_references = vec![back.clone()]);
    assert!(front < 0.01 && behind < 0.01, "{front} {behind}");
    let [front, behind] = angles(&|scene| scene.regions[0].reference = Some(back.clone()));
    assert!(front > 5.0 && behind < 0.01, "{front} {behind}");
}

#[test]
fn strokes_ride_a_morph_and_turn_with_it() {
    // A sheet that is sheared, stretched and turned in its own plane: its screen map is known in closed form.
    let base = shapes::sheet(12);
    let affine = glam::Mat2::from_cols_array(&[0.9, 0.5, -0.6, 0.7]);
    let mut target = base.clone();
    for position in &mut target.positions {
        *position = (affine * position.truncate()).extend(0.0);
    }
    let mut scene = combed(Direction::Angle(20.0), Vec::new(), 6000);
    scene.timeline.last = 10;
    scene.objects[0].morph = Some("target.obj".to_owned());
    scene.objects[0].keys = vec![ObjectKey::at(0.0), ObjectKey { morph: 1.0, ..ObjectKey::at(10.0) }];
    let mut loaded = impasto_scene::loaded::LoadedScene::clone(&shapes::loaded(scene, [base]));
    let mut file = impasto_scene::mesh_file::MeshFile::clone(loaded.meshes.values().next().unwrap());
    file.mesh = target;
    loaded.meshes.insert("target.obj".to_owned(), file.into());
    let painting = prepare(loaded.into()).unwrap();
    let at = |frame: f64| body_strokes(&painting.at(frame, &FrameOptions::new(SIZE_PX)));
    let before = at(0.0);
    for frame in [3.0, 10.0] {
        let share = frame as f32 / 10.0;
        let map = glam::Mat2::IDENTITY * (1.0 - share) + affine * share;
        let polar = f64::from(map.x_axis.y - map.y_axis.x).atan2(f64::from(map.x_axis.x + map.y_axis.y));
        let after = at(frame);
        let mut compared = 0;
        for (particle, seen) in &before {
            let Some(now) = after.get(particle) else { continue };
            let expected = map.as_dmat2() * seen.at_px;
            assert!((now.at_px - expected).length() < 0.05, "particle {particle} at {frame}");
            let turned = lines_apart(now.angle_rad, seen.angle_rad + polar);
            assert!(turned < 0.01, "particle {particle} at {frame}: {turned}");
            compared += 1;
        }
        assert!(compared >= 500, "{compared} strokes");
    }
}

#[test]
fn sizes_follow_the_surface_as_far_as_size_follow_says() {
    let sizes = |follow: f64| {
        let mut scene = combed(Direction::Up, Vec::new(), 6000);
        scene.strokes = StrokeSettings { size_follow: Some(follow), ..scene.strokes };
        scene.timeline.last = 1;
        scene.objects[0].keys =
            vec![ObjectKey::at(0.0), ObjectKey { scale: Scale::even(1.7), ..ObjectKey::at(1.0) }];
        let painting = painted(scene, shapes::sheet(8));
        [0.0, 1.0].map(|frame| -> BTreeMap<u32, (f32, f32)> {
            let frame = painting.at(frame, &FrameOptions::new(SIZE_PX));
            let run = *frame.layers.iter().find(|run| run.kind == LayerKind::Body).unwrap();
            (run.first as usize..(run.first + run.count) as usize)
                .map(|index| {
                    let stroke = &frame.strokes[index];
                    (frame.sources[index].particle, (stroke.length_px, stroke.width_px))
                })
                .collect()
        })
    };
    for follow in [0.0, 0.5, 1.0] {
        let [before, after] = sizes(follow);
        let expected = 1.7f32.powf(follow as f32);
        let mut compared = 0;
        for (particle, (length, width)) in &before {
            let Some((now, wide)) = after.get(particle) else { continue };
            assert!((now / length - expected).abs() < 1e-4 && (wide / width - expected).abs() < 1e-4);
            compared += 1;
        }
        assert!(compared >= 100, "{compared} strokes at {follow}");
    }
}

/// The poles of a ball are two caps, where the stated axis comes out of it. Together they are a tenth of its surface.
#[test]
fn poles_are_where_the_stated_axis_leaves_the_surface() {
    for (direction, axis) in [(Direction::Up, Vec3::Y), (Direction::Around([1.0, 0.0, 0.0]), Vec3::X)] {
        let mut scene = shapes::scene(vec![shapes::object("ball", 4000)]);
        scene.regions = vec![Region { direction, ..Region::new("all", Selector::Object("ball".to_owned())) }];
        let painting = prepare(shapes::loaded(scene, [shapes::sphere(48, 24)])).unwrap();
        let (poles, particles) = (painting.poles(0), painting.particles(0));
        for (index, &is_pole) in poles.iter().enumerate() {
            assert_eq!(is_pole, particles.at(index).normal.dot(axis).abs() > 0.9, "{axis}, particle {index}");
        }
        let share = poles.iter().filter(|&&is_pole| is_pole).count() as f64 / poles.len() as f64;
        assert!((share - 0.1).abs() < 0.02, "{axis}: {share}");
    }
}
