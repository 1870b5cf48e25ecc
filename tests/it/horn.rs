//! Tests of `horn`, the solver that bakes the paper's sum over neighbours, weighted by depth, into each particle. It
//! equals the weighted sum computed directly, and is close to the paper's own.

use glam::{DAffine3, DMat4, DQuat, DVec2, DVec3, Vec3};
use impasto_core::hash;
use impasto_core::horn_exact::{ClipView, turn_rad};
use impasto_core::lift::Lift;
use impasto_core::neighbours::Neighbours;
use impasto_core::sampling::{Particle, Surface, progressive};
use impasto_core::screen_map::{PixelLens, ScreenMap};
use impasto_core::solve::{BakedParticles, SolvedParticles, solve};
use impasto_painting::FrameOptions;
use impasto_scene::presets::LayerKind;
use impasto_tests::scenes::painting_with;
use impasto_tests::shapes::sphere;

const SIZE_PX: DVec2 = DVec2::new(1280.0, 720.0);

struct View {
    map: ScreenMap,
    clip: ClipView,
}

/// A camera about `distance` from the origin in a random direction, rolled and shifted sideways at random.
fn view(seed: u32, fov_y_deg: f64, distance: f64) -> View {
    let number = |index: u32| f64::from(hash::unit(hash::combine(seed, index)));
    let rotation = DQuat::from_rotation_z(number(0) * 6.0)
        * DQuat::from_rotation_x((number(1) - 0.5) * 2.0)
        * DQuat::from_rotation_y(number(2) * 6.0);
    let aside = DVec3::new(number(3) - 0.5, number(4) - 0.5, 0.0) * 0.6;
    let view = DMat4::from_rotation_translation(rotation, aside - DVec3::Z * distance);
    let fov_y = fov_y_deg.to_radians();
    let focal_px = 0.5 * SIZE_PX.y / (0.5 * fov_y).tan();
    // OpenGL's projection matrix, written out.
    let (cot, near, far) = (1.0 / (0.5 * fov_y).tan(), 0.01, 1000.0);
    let clip_from_view = DMat4::from_cols_array_2d(&[
        [cot * SIZE_PX.y / SIZE_PX.x, 0.0, 0.0, 0.0],
        [0.0, cot, 0.0, 0.0],
        [0.0, 0.0, (far + near) / (near - far), -1.0],
        [0.0, 0.0, 2.0 * far * near / (near - far), 0.0],
    ]);
    View {
        map: ScreenMap::new(view, DAffine3::IDENTITY, PixelLens::Perspective { focal_px }),
        clip: ClipView { clip_from_model: clip_from_view * view, size_px: SIZE_PX },
    }
}

fn cloud(count: usize) -> Vec<Particle> {
    progressive(&Surface::new(&sphere(48, 24), |_| true), count, 5)
}

/// Neighbour lists with a radius of `share` of the sphere's diameter.
fn lists(particles: &[Particle], share: f32) -> Neighbours {
    let positions: Vec<Vec3> = particles.iter().map(|particle| particle.position).collect();
    let normals: Vec<Vec3> = particles.iter().map(|particle| particle.normal).collect();
    Neighbours::find(&positions, &normals, 2.0 * share)
}

fn degrees_apart(first: f64, second: f64) -> f64 {
    let turn = (first - second).rem_euclid(std::f64::consts::TAU);
    turn.min(std::f64::consts::TAU - turn).to_degrees()
}

/// Depth in a view: w of the clip position.
fn depth(view: &ClipView, at: DVec3) -> f64 {
    (view.clip_from_model * at.extend(1.0)).w
}

/// The turn arg Σ w p̄ c. As complex numbers, p and c are a neighbour's offset from the stroke in the reference
/// picture and in the picture now; w is the neighbour's depth now over the stroke's. All by plain 4×4 matrices.
fn weighted_sum_rad(center: DVec3, neighbours: &[DVec3], reference: &ClipView, now: &ClipView) -> f64 {
    let (mut dot, mut cross) = (0.0, 0.0);
    for &neighbour in neighbours {
        let p = reference.pixel(neighbour) - reference.pixel(center);
        let c = now.pixel(neighbour) - now.pixel(center);
        let weight = depth(now, neighbour) / depth(now, center);
        dot += weight * p.dot(c);
        cross += weight * p.perp_dot(c);
    }
    cross.atan2(dot)
}

struct Case {
    center: DVec3,
    neighbours: Vec<DVec3>,
}

fn cases(particles: &[Particle], lists: &Neighbours) -> Vec<Case> {
    let at = |index: usize| particles[index].position.as_dvec3();
    (0..particles.len())
        .filter(|&index| lists.of(index).len() >= 3)
        .map(|index| Case {
            center: at(index),
            neighbours: lists.of(index).iter().map(|&other| at(other as usize)).collect(),
        })
        .collect()
}

fn horn(case: &Case, reference: &ScreenMap) -> Option<Lift> {
    let center_px = reference.project(case.center);
    Lift::horn(case.neighbours.iter().map(|&at| (at - case.center, reference.project(at) - center_px)))
}

#[test]
fn horn_is_the_depth_weighted_sum_in_every_pose() {
    let particles = cloud(1500);
    let cases = cases(&particles, &lists(&particles, 0.08));
    let (mut worst, mut count, mut worst_single, mut count_single) = (0.0f64, 0, 0.0f64, 0);
    for seed in 0..24 {
        let fov = 20.0 + 80.0 * f64::from(hash::unit(hash::scramble(seed)));
        let (reference, now) = (view(seed * 2, fov, 4.0), view(seed * 2 + 1, fov, 3.0));
        let mut baked = BakedParticles::default();
        let mut expected = Vec::new();
        for case in &cases {
            let Some(lift) = horn(case, &reference.map) else { continue };
            let sum = weighted_sum_rad(case.center, &case.neighbours, &reference.clip, &now.clip);
            let map = lift.map(now.map.jacobian(case.center));
            worst = worst.max(degrees_apart(map.angle_rad(), sum));
            count += 1;
            baked.push(case.center, case.center.normalize(), lift);
            expected.push((sum, map.kappa()));
        }
        let mut solved = SolvedParticles::default();
        solve(&baked, &now.map, &mut solved);
        for (angle, (sum, kappa)) in solved.angle_rad.iter().zip(expected) {
            if kappa >= 0.2 {
                worst_single = worst_single.max(degrees_apart(f64::from(*angle), sum));
                count_single += 1;
            }
        }
    }
    println!(
        "f64: {count} cases, worst {worst:.2e} degrees; f32, κ ≥ 0.2: {count_single} cases, worst {worst_single:.2e}"
    );
    assert!(count >= 10_000 && count_single >= 10_000);
    assert!(worst <= 1e-3, "in f64 off by {worst} degrees");
    assert!(worst_single <= 1e-3, "in f32 off by {worst_single} degrees");
}

#[test]
fn horn_is_close_to_the_papers_unweighted_sum() {
    let particles = cloud(30_000);
    let lists = lists(&particles, 0.02);
    let cases = cases(&particles, &lists);
    assert!(cases.len() > 25_000, "{} strokes with neighbours", cases.len());
    let mut errors: Vec<f64> = Vec::new();
    for (index, fov) in [20.0, 40.0, 60.0, 80.0, 100.0].into_iter().enumerate() {
        // The sphere fills most of the picture's height.
        let distance = 1.15 / (0.5 * fov * std::f64::consts::PI / 180.0).sin();
        let seed = 100 + 2 * index as u32;
        let (reference, now) = (view(seed, fov, distance), view(seed + 1, fov, distance));
        let faces = |view: &View, case: &Case| {
            impasto_core::screen_map::facing(view.map.jacobian(case.center), case.center.normalize()) > 0.0
        };
        for case in cases.iter().filter(|case| faces(&reference, case) && faces(&now, case)) {
            let Some(lift) = horn(case, &reference.map) else { continue };
            let baked = lift.map(now.map.jacobian(case.center)).angle_rad();
            let exact = turn_rad(
                [case.center; 2],
                case.neighbours.iter().map(|&neighbour| [neighbour; 2]),
                &reference.clip,
                &now.clip,
            );
            errors.push(degrees_apart(baked, exact));
        }
    }
    errors.sort_by(f64::total_cmp);
    let (median, p99) = (errors[errors.len() / 2], errors[errors.len() * 99 / 100]);
    println!("{} cases: p50 {median:.4}, p99 {p99:.3} degrees", errors.len());
    assert!(errors.len() >= 5000);
    assert!(median <= 0.02, "p50 {median}");
    assert!(p99 <= 0.5, "p99 {p99}");
}

#[test]
fn a_neighbour_list_of_another_particle_is_noticed() {
    let particles = cloud(3000);
    let lists = lists(&particles, 0.05);
    let (reference, now) = (view(1, 40.0, 4.0), view(2, 40.0, 4.0));
    let at = |index: usize| particles[index].position.as_dvec3();
    let mut errors = 0;
    for index in 0..1000 {
        // The planted fault: the neighbour list of another particle.
        let wrong: Vec<DVec3> =
            lists.of((index + 1500) % 3000).iter().map(|&other| at(other as usize)).collect();
        let right: Vec<DVec3> = lists.of(index).iter().map(|&other| at(other as usize)).collect();
        let turn = |list: &[DVec3]| {
            let pairs = list.iter().map(|&neighbour| [neighbour; 2]);
            turn_rad([at(index); 2], pairs, &reference.clip, &now.clip)
        };
        let (exact, fault) = (turn(&right), turn(&wrong));
        errors += u32::from(degrees_apart(exact, fault) > 1e-3);
    }
    assert!(errors > 950, "only {errors} of 1000 planted faults show");
}

/// At the frame of the reference nothing has turned, so a stroke lies as its region states, whichever solver finds the
/// turn.
#[test]
fn at_the_reference_strokes_lie_as_their_region_states() {
    for solver in ["Tangent", "Horn", "HornExact"] {
        let painting = painting_with(
            "touching_cubes",
            &[
                ("style.solver", solver),
                ("regions.still.direction", "Angle(50)"),
                ("regions.still.strokes.angle_jitter_deg", "0"),
                ("regions.still.strokes.swing_deg", "0"),
            ],
        );
        let still = painting.scene().regions.iter().position(|region| region.name == "still").unwrap();
        let frame = painting.at(0.0, &FrameOptions::new([640, 360]));
        let body = frame.layers.iter().find(|run| run.kind == LayerKind::Body).unwrap();
        let strokes = body.first as usize..(body.first + body.count) as usize;
        let off: Vec<(f64, f32)> = strokes
            .filter(|&index| frame.sources[index].region as usize == still)
            // Angles are doubled before they are compared, so that half a turn, which leaves a line as it is, counts
            // as 0.
            .map(|index| {
                let angle_rad = f64::from(frame.strokes[index].angle_rad);
                let off_deg = 0.5 * degrees_apart(2.0 * angle_rad, 2.0 * 50f64.to_radians());
                (off_deg, frame.sources[index].facing)
            })
            .collect();
        // Where the reference sees a face at a slant, its view decides the angles of strokes only in part.
        let seen_well = || off.iter().filter(|(_, facing)| *facing >= 0.5).map(|(off_deg, _)| *off_deg);
        let is_as_stated = seen_well().all(|off_deg| off_deg < 0.2);
        assert!(seen_well().count() > 200 && is_as_stated, "{solver}: {off:?}");
        let near = off.iter().filter(|(off_deg, _)| *off_deg < 8.0).count();
        assert!(near * 4 > off.len() * 3, "{solver}: {near} of {}", off.len());
    }
}
