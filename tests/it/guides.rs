//! Tests of guides that smooth and guides that turn: what they change, and what they leave alone.

use std::collections::BTreeMap;
use std::f64::consts::PI;

use glam::{DVec2, DVec3};
use impasto_core::TriangleMesh;
use impasto_painting::{FrameOptions, Painting, prepare};
use impasto_scene::document::{Direction, Falloff, Guide, GuideMode, Region, Scene, Selector, Sense};
use impasto_scene::motion::CameraPose;
use impasto_tests::gestures::{camera, drag};
use impasto_tests::shapes;

use crate::directions::{SIZE_PX, Seen, body_strokes};

/// A view straight at the sheet, which is 285 pixels high in a picture of 360.
fn straight_on() -> CameraPose {
    camera([0.0, 0.0, 4.0], [0.0; 3])
}

fn painted(direction: Direction, sense: Sense, guides: Vec<Guide>) -> Painting {
    let mut scene = shapes::scene(vec![shapes::object("thing", 20_000)]);
    scene.strokes.contour = Some(0.0);
    scene.strokes.layers = shapes::body_layer_alone();
    (scene.strokes.length_px, scene.strokes.width_px) = (Some(8.0), Some(2.6));
    let on = Selector::Object("thing".to_owned());
    scene.regions = vec![Region { direction, sense, guides, ..Region::new("combed", on) }];
    prepare(shapes::loaded(scene, [shapes::sheet(20)])).unwrap()
}

fn seen(painting: &Painting) -> BTreeMap<u32, Seen> {
    body_strokes(&painting.seen_by(&straight_on(), 0.0, &FrameOptions::new(SIZE_PX)))
}

/// A gesture on the sheet between two places, model units from its middle.
fn gesture(from: [f64; 2], to: [f64; 2]) -> Guide {
    let px_per_unit = 0.5 * 360.0 / 17.5f64.to_radians().tan() / 4.0;
    let ends = [from, to].map(|at| DVec2::from(at) * px_per_unit);
    drag(&shapes::sheet(20), &straight_on(), 360.0, ends).unwrap()
}

/// Two bands side by side, combed at 0 degrees on the left and at `angle_deg` on the right.
fn two_combs(angle_deg: f64) -> Vec<Guide> {
    let comb = |x: f64, degrees: f64| {
        let half = DVec2::from_angle(degrees.to_radians()) * 0.05;
        let rows = (-8..=8).map(move |row| 0.1 * f64::from(row));
        rows.map(move |y| {
            let guide = gesture([x - half.x, y - half.y], [x + half.x, y + half.y]);
            Guide { radius: 0.45, falloff: Falloff::Flat, ..guide }
        })
    };
    comb(-0.45, 0.0).chain(comb(0.45, angle_deg)).collect()
}

fn smooth(strength: f64, radius: f64) -> Guide {
    Guide { mode: GuideMode::Smooth, strength, radius, ..gesture([0.0, -0.8], [0.0, 0.8]) }
}

/// The mean angle, in degrees, between two strokes that lie within 6 pixels of each other. Only strokes for which
/// `counts` holds are compared.
fn mean_step(strokes: &BTreeMap<u32, Seen>, period_rad: f64, counts: impl Fn(&Seen) -> bool) -> f64 {
    let under: Vec<&Seen> = strokes.values().filter(|seen| counts(seen)).collect();
    let mut steps = Vec::new();
    for (index, a) in under.iter().enumerate() {
        let near = under[index + 1..].iter().filter(|b| a.at_px.distance(b.at_px) < 6.0);
        steps.extend(near.map(|b| apart(a.angle_rad, b.angle_rad, period_rad)));
    }
    assert!(steps.len() > 300, "{} pairs", steps.len());
    steps.iter().sum::<f64>() / steps.len() as f64
}

/// The angle between two directions that repeat every `period_rad`, degrees.
fn apart(a: f64, b: f64, period_rad: f64) -> f64 {
    let off = (a - b).rem_euclid(period_rad);
    off.min(period_rad - off).to_degrees()
}

const PX_PER_UNIT: f64 = 142.7;

#[test]
fn a_smooth_guide_relaxes_the_seam_of_two_combs_and_nothing_beyond_its_radius() {
    let radius = 0.4;
    for direction in [Direction::Auto, Direction::Angle(20.0)] {
        for (sense, angle_deg, period_rad) in
            [(Sense::Lines, 60.0, PI), (Sense::Lines, 90.0, PI), (Sense::Arrows, 170.0, 2.0 * PI)]
        {
            let combed = two_combs(angle_deg);
            let smoothed = combed.iter().cloned().chain([smooth(1.0, radius)]).collect();
            let [before, after] =
                [combed, smoothed].map(|guides| seen(&painted(direction.clone(), sense, guides)));
            // From one comb to the other, strokes turn by as much as before, but over a wider band. So steps get
            // smaller only at the old seam.
            let at_seam = |seen: &Seen| {
                seen.at_px.x.abs() < 0.25 * radius * PX_PER_UNIT && seen.at_px.y.abs() < 0.7 * PX_PER_UNIT
            };
            let [rough, soft] = [&before, &after].map(|strokes| mean_step(strokes, period_rad, at_seam));
            println!("{direction:?} {sense:?} {angle_deg}: mean step {rough:.2} before, {soft:.2} after");
            assert!(soft <= 0.5 * rough, "{direction:?} {sense:?} {angle_deg}: {rough} to {soft}");
            let beyond = |seen: &&Seen| {
                let from = DVec2::new(seen.at_px.x, seen.at_px.y - seen.at_px.y.clamp(-114.2, 114.2));
                from.length() > radius * PX_PER_UNIT + 0.5
            };
            let moved = before
                .iter()
                .filter(|(_, seen)| beyond(seen))
                .map(|(particle, seen)| apart(seen.angle_rad, after[particle].angle_rad, period_rad));
            let moved: Vec<f64> = moved.collect();
            let worst = moved.iter().copied().fold(0.0, f64::max);
            assert!(moved.len() > 1000 && worst < 1.0, "{direction:?}: {worst} beyond the radius");
        }
    }
}

#[test]
fn a_smooth_guide_without_strength_changes_no_bit() {
    for direction in [Direction::Auto, Direction::Angle(20.0)] {
        let combed = two_combs(70.0);
        let smoothed = combed.iter().cloned().chain([smooth(0.0, 0.4)]).collect();
        let [before, after] =
            [combed, smoothed].map(|guides| seen(&painted(direction.clone(), Sense::Lines, guides)));
        assert_eq!(before.len(), after.len());
        assert!(
            before
                .iter()
                .all(|(particle, seen)| { seen.angle_rad.to_bits() == after[particle].angle_rad.to_bits() })
        );
    }
}

#[test]
fn a_later_comb_holds_over_a_smooth_guide() {
    let mut guides = two_combs(70.0);
    guides.push(smooth(1.0, 0.5));
    guides.push(gesture([-0.1, -0.17], [0.1, 0.17]));
    let drawn_rad = DVec2::new(0.1, 0.17).to_angle();
    let strokes = seen(&painted(Direction::Auto, Sense::Lines, guides));
    let on_it: Vec<f64> = strokes
        .values()
        .filter(|seen| {
            seen.at_px.length() < 15.0 && seen.at_px.perp_dot(DVec2::from_angle(drawn_rad)).abs() < 1.0
        })
        .map(|seen| apart(seen.angle_rad, drawn_rad, PI))
        .collect();
    assert!(on_it.len() >= 3 && on_it.iter().all(|&off| off < 1.0), "{on_it:?}");
}

#[test]
fn points_turn_strokes_from_the_gestures_own_line() {
    let mesh = shapes::apple_skin();
    for yaw_deg in [0.0f64, 40.0] {
        let yaw = yaw_deg.to_radians();
        let view = camera([4.0 * yaw.sin(), 0.5, 4.0 * yaw.cos()], [0.0, 0.5, 0.0]);
        for (turns_deg, flatness) in
            [([30.0, 30.0], 1.0), ([30.0, 30.0], 0.4), ([-75.0, -75.0], 1.0), ([0.0, 60.0], 1.0)]
        {
            let ends = [DVec2::new(-22.0, -8.0), DVec2::new(24.0, 4.0)];
            let along = (ends[1] - ends[0]).normalize();
            let length_px = ends[0].distance(ends[1]);
            let mut guide = drag(&mesh, &view, 360.0, ends).unwrap();
            let last = guide.points.len() - 1;
            for (index, point) in guide.points.iter_mut().enumerate() {
                let share = index as f64 / last as f64;
                point.turn_deg = turns_deg[0] + (turns_deg[1] - turns_deg[0]) * share;
            }
            let painting = apple(&mesh, flatness, vec![guide]);
            let frame = painting.seen_by(&view, 0.0, &FrameOptions::new(SIZE_PX));
            let errors: Vec<f64> = body_strokes(&frame)
                .values()
                .filter_map(|seen| {
                    let from = seen.at_px - ends[0];
                    let share = from.dot(along) / length_px;
                    let on_it = seen.facing > 0.35
                        && from.perp_dot(along).abs() < 1.0
                        && (0.05..0.95).contains(&share);
                    let turn_deg = turns_deg[0] + (turns_deg[1] - turns_deg[0]) * share;
                    on_it.then(|| apart(seen.angle_rad, along.to_angle() + turn_deg.to_radians(), PI))
                })
                .collect();
            let worst = errors.iter().copied().fold(0.0, f64::max);
            println!("{yaw_deg}, {turns_deg:?}, flatness {flatness}: {worst:.3} over {}", errors.len());
            // Where the turn changes along the guide, `share` is only roughly the stroke's place along the guide.
            let most = if turns_deg[0] == turns_deg[1] { 0.5 } else { 3.0 };
            assert!(errors.len() >= 5 && worst <= most, "{yaw_deg} {turns_deg:?}: {worst}");
        }
    }
}

/// The apple's skin with these guides, and only the body layer of paint.
fn apple_scene(flatness: f64, guides: Vec<Guide>) -> Scene {
    let mut scene: Scene = shapes::scene(vec![shapes::object("thing", 40_000)]);
    scene.strokes.layers = shapes::body_layer_alone();
    scene.strokes.contour = Some(0.0);
    (scene.strokes.length_px, scene.strokes.width_px) = (Some(8.0), Some(2.6));
    scene.strokes.flatness = Some(flatness);
    scene.camera.keys[0] = shapes::camera_key(0.0, [0.0, 0.5, 4.0], [0.0, 0.5, 0.0]);
    scene.regions = vec![Region { guides, ..Region::new("combed", Selector::Object("thing".to_owned())) }];
    scene
}

fn apple(mesh: &TriangleMesh, flatness: f64, guides: Vec<Guide>) -> Painting {
    prepare(shapes::loaded(apple_scene(flatness, guides), [mesh.clone()])).unwrap()
}

#[test]
fn a_region_turns_all_its_directions_as_seen_in_the_reference() {
    let mesh = shapes::apple_skin();
    let view = camera([0.0, 0.5, 4.0], [0.0, 0.5, 0.0]);
    let guide = || drag(&mesh, &view, 360.0, [DVec2::new(-20.0, 4.0), DVec2::new(20.0, 12.0)]).unwrap();
    for direction in [
        Direction::Auto,
        Direction::Angle(20.0),
        Direction::Around([0.0, 1.0, 0.0]),
        Direction::Crossing(-58.0, 4.0),
    ] {
        let angles = |turn_deg: f64| {
            let mut scene = apple_scene(1.0, vec![guide()]);
            scene.regions[0].direction = direction.clone();
            scene.regions[0].turn_deg = turn_deg;
            let painting = prepare(shapes::loaded(scene, [mesh.clone()])).unwrap();
            body_strokes(&painting.at(0.0, &FrameOptions::new(SIZE_PX)))
        };
        let before = angles(0.0);
        for turn_deg in [7.0, -137.0] {
            let after = angles(turn_deg);
            assert_eq!(before.keys().collect::<Vec<_>>(), after.keys().collect::<Vec<_>>());
            let off = |(particle, seen): (&u32, &Seen)| {
                apart(after[particle].angle_rad, seen.angle_rad + turn_deg.to_radians(), 2.0 * PI)
            };
            // The turn is exact where `facing` is at least 0.5 in the reference. Nearer to the outline, the reference's
            // view is blended with that of a camera that looks straight at the surface.
            let faced = before.iter().filter(|(_, seen)| seen.facing > 0.5).map(off);
            let worst = faced.fold(0.0, f64::max);
            println!("{direction:?} turned by {turn_deg}: {worst:.4} off");
            assert!(before.len() > 500 && worst < 0.01, "{direction:?} {turn_deg}: {worst}");
        }
    }
}

#[test]
fn a_turn_reads_as_it_is_seen_in_the_file_too() {
    // Counter-clockwise with Y up: a stroke along +X turned by 90 degrees points to +Y.
    let painted = |turn_deg: f64| {
        let mut guide = gesture([-0.5, 0.0], [0.5, 0.0]);
        guide.points.iter_mut().for_each(|point| point.turn_deg = turn_deg);
        seen(&painted(Direction::Auto, Sense::Arrows, vec![guide]))
    };
    let mean = |strokes: BTreeMap<u32, Seen>| {
        let sum: DVec2 = strokes.values().map(|seen| DVec2::from_angle(seen.angle_rad)).sum();
        sum.normalize().extend(0.0)
    };
    assert!((mean(painted(0.0)) - DVec3::X).length() < 0.01);
    assert!((mean(painted(90.0)) - DVec3::Y).length() < 0.01);
}
