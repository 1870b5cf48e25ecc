//! Tests of strokes that ride a displaced surface: where they lie, how they turn, noise that repeats in a loop, and
//! edits of the noise.

use std::collections::BTreeMap;

use glam::{DAffine3, DVec2, DVec3};
use impasto_core::noise_displace::gaussian;
use impasto_gl_render::context::Driver;
use impasto_measure::popping;
use impasto_measure::strokes::strokes_by_key;
use impasto_painting::frame::LayerKind;
use impasto_painting::{Frame, FrameOptions, Painting, prepare};
use impasto_scene::document::{Direction, NoiseDisplace, NoiseSpace, Region, Scene, Selector, VertexNoise};
use impasto_tests::pictures::renderer;
use impasto_tests::shapes;

use super::material;
use super::seed::Vert;

const SIZE_PX: [u32; 2] = [640, 360];
const OPTIONS: FrameOptions = FrameOptions::new(SIZE_PX);
const VALUE: [f64; 2] = [0.2, 0.16];
const SCALE: f64 = 0.1;

fn scene(period_secs: Option<f64>) -> Scene {
    let mut scene = shapes::scene(vec![shapes::object("ball", 8000)]);
    scene.strokes.contour = Some(0.0);
    scene.timeline.last = 48;
    let vertex = VertexNoise { space: NoiseSpace::Local, value: VALUE, scale: SCALE, ..Default::default() };
    scene.objects[0].material = material(NoiseDisplace { vertex: Some(vertex), surface: None, period_secs });
    scene.regions =
        vec![Region { direction: Direction::Angle(20.0), ..Region::new("ball", Selector::Everything) }];
    scene
}

fn painted(scene: Scene) -> Painting {
    prepare(shapes::loaded(scene, [shapes::sphere(192, 96)])).unwrap()
}

/// The strokes of the body layer by particle: each one's place in pixels from the picture's centre, angle and facing.
fn strokes(frame: &Frame) -> BTreeMap<u32, (DVec2, f64, f32)> {
    let run = *frame.layers.iter().find(|run| run.kind == LayerKind::Body).unwrap();
    (run.first as usize..(run.first + run.count) as usize)
        .map(|index| {
            let (stroke, source) = (&frame.strokes[index], &frame.sources[index]);
            let at = DVec2::from(stroke.center_px.map(f64::from)) - DVec2::new(320.0, 180.0);
            (source.particle, (at, f64::from(stroke.angle_rad), source.facing))
        })
        .collect()
}

/// Where the camera of `shapes::scene` shows a place: pixels from the picture's centre, Y up.
fn pixel(at: DVec3) -> DVec2 {
    let focal_px = 180.0 / (0.5 * 35f64.to_radians()).tan();
    at.truncate() * focal_px / (4.0 - at.z)
}

/// Displaces a place of the surface at this time as the source's shader does, by its rewrite in [`super::seed`].
fn judge(seconds: f64) -> impl Fn(DVec3) -> DVec3 {
    let tile = gaussian();
    move |at| {
        let judge = Vert {
            noise_tex: &tile,
            object_to_world: DAffine3::IDENTITY,
            noise_value: VALUE,
            noise_scale: SCALE,
            time_x: seconds / 20.0,
        };
        judge.displaced(at)
    }
}

#[test]
fn strokes_lie_where_the_surface_has_gone_and_turn_as_it_does() {
    let painting = painted(scene(None));
    let before = strokes(&painting.at(0.0, &OPTIONS));
    let (particles, mesh) = (painting.particles(0), &painting.surface(0).mesh);
    for frame in [6.0, 24.0, 48.0] {
        let (mut off_px, mut off_deg, mut turned_deg) = (Vec::new(), Vec::new(), 0.0_f64);
        let displaced = [0.0, frame / 24.0].map(judge);
        for (index, (at, angle, facing)) in strokes(&painting.at(frame, &OPTIONS)) {
            let Some((_, base, base_facing)) = before.get(&index) else { continue };
            if facing < 0.5 || *base_facing < 0.5 {
                continue;
            }
            let particle = &particles.at(index as usize);
            // The particle moves with its triangle's corners.
            let [v, w] = particle.barycentric.map(f64::from);
            let on_screen = |side: usize, v: f64, w: f64| {
                let corners = mesh.corners(particle.triangle as usize);
                let [a, b, c] = corners.map(|corner| displaced[side](corner.as_dvec3()));
                pixel(a * (1.0 - v - w) + b * v + c * w)
            };
            off_px.push(on_screen(1, v, w).distance(at));
            // How the surface's picture has turned there, by finite differences.
            const STEP: f64 = 1e-4;
            let [reference, now] = [0, 1].map(|side: usize| {
                let along =
                    |dv: f64, dw: f64| on_screen(side, v + dv, w + dw) - on_screen(side, v - dv, w - dw);
                [along(STEP, 0.0), along(0.0, STEP)]
            });
            let [a, b] = reference;
            let [c, d] = now;
            let columns =
                [c * b.y - d * a.y, d * a.x - c * b.x].map(|column| column / (a.x * b.y - b.x * a.y));
            let turn = (columns[0].y - columns[1].x).atan2(columns[0].x + columns[1].y);
            turned_deg = turned_deg.max(turn.abs().to_degrees());
            let off = (angle - base - turn).rem_euclid(std::f64::consts::PI);
            off_deg.push(off.min(std::f64::consts::PI - off).to_degrees());
        }
        let p95 = |values: &mut Vec<f64>| {
            values.sort_by(f64::total_cmp);
            values[values.len() * 95 / 100]
        };
        let (count, off_px, off_deg) = (off_px.len(), p95(&mut off_px), p95(&mut off_deg));
        println!(
            "frame {frame}: {count} strokes, p95 {off_px:.3} px and {off_deg:.3} degrees, turned by up to {turned_deg:.0}"
        );
        assert!(count > 300 && turned_deg > 2.0, "{count} strokes turned by up to {turned_deg}");
        assert!(off_px < 0.01, "frame {frame}: {off_px} px off the surface");
        assert!(off_deg <= 1.0, "frame {frame}: {off_deg} degrees off the surface's own turn");
    }
}

#[test]
fn nothing_pops_over_a_loop_and_it_closes_to_the_bit() {
    let painting = painted(scene(Some(2.0)));
    let mut before = painting.at(0.0, &OPTIONS);
    let (first, mut largest) = (before.strokes.clone(), 0.0_f64);
    for frame in 1..=48 {
        let after = painting.at(f64::from(frame), &OPTIONS);
        let found = popping::popping(&strokes_by_key(&before, &[]), &strokes_by_key(&after, &[]), SIZE_PX);
        assert!(found.strokes > 500, "{found:?}");
        assert_eq!(found.share, 0.0, "frame {frame}: {found:?}");
        largest = largest.max(found.largest_step);
        before = after;
    }
    println!("largest step of presence over the loop: {largest:.3}");
    assert!(first == before.strokes, "the loop does not close");
    assert!(first != painting.at(24.0, &OPTIONS).strokes, "nothing moves");
}

#[test]
fn what_is_prepared_after_an_edit_is_what_is_prepared_from_nothing() {
    let with_scale = |scale: f64| {
        let mut scene = scene(None);
        let noise = scene.objects[0].material.as_mut().and_then(|material| material.noise_displace.as_mut());
        if let Some(vertex) = noise.and_then(|noise| noise.vertex.as_mut()) {
            vertex.scale = scale;
        }
        scene
    };
    let first = shapes::loaded(with_scale(0.1), [shapes::sphere(48, 24)]);
    let second = impasto_scene::loaded::LoadedScene { scene: with_scale(0.3), ..(*first).clone() };
    let mut preparer = impasto_painting::Preparer::default();
    let before = preparer.prepare(first).unwrap().at(9.0, &OPTIONS).strokes;
    let warm = preparer.prepare(second.clone().into()).unwrap().at(9.0, &OPTIONS).strokes;
    assert!(warm == prepare(second.into()).unwrap().at(9.0, &OPTIONS).strokes);
    assert!(warm != before);
}

#[test]
fn painted_strokes_are_seen_on_the_displaced_surface() {
    let painting = painted(scene(Some(2.0)));
    for driver in [Driver::Egl, Driver::Osmesa] {
        let mut renderer = renderer(driver);
        for frame in [0.0, 17.0] {
            let frame = painting.at(frame, &OPTIONS);
            renderer.render(&frame).unwrap();
            let resolved = renderer.resolved_strokes();
            // Strokes that face the eye must not count as hidden by their own body.
            let body = frame.layers.iter().find(|run| run.kind == LayerKind::Body).unwrap();
            let range = body.first as usize..(body.first + body.count) as usize;
            let open = range
                .filter(|&index| frame.sources[index].facing > 0.7 && frame.strokes[index].presence() > 0.9);
            let (mut shown, mut all) = (0, 0);
            for index in open {
                all += 1;
                shown += usize::from(resolved[index].alpha > 0.5);
            }
            assert!(all > 100 && shown * 100 >= all * 90, "{driver:?}: {shown} of {all} are seen");
        }
    }
}
