//! Tests of painted amounts: factors for the width, length, density and flatness of strokes, painted on a surface in
//! dabs. A dab changes the strokes that it reaches, and all others stay as they are.

use std::collections::{BTreeMap, BTreeSet};

use glam::Vec3;
use impasto_core::TriangleMesh;
use impasto_core::sampling::Particle;
use impasto_painting::frame::{LayerKind, Stroke};
use impasto_painting::{FrameOptions, Painting, prepare};
use impasto_scene::document::{Amount, AmountDab, PaintedAmount, Region, Scene, Selector};
use impasto_scene::motion::CameraPose;
use impasto_tests::gestures::camera;
use impasto_tests::shapes;

use crate::directions::SIZE_PX;

const RADIUS: f64 = 0.5;

fn straight_on() -> CameraPose {
    camera([0.0, 0.0, 4.0], [0.0; 3])
}

fn dab(at: Vec3, by: f64) -> AmountDab {
    AmountDab { at: at.as_dvec3().to_array(), normal: [0.0, 0.0, 1.0], radius: RADIUS, by }
}

/// One object with these amounts.
fn scene(particles: u64, amounts: Vec<(Amount, AmountDab)>) -> Scene {
    let mut scene = shapes::scene(vec![shapes::object("thing", particles)]);
    scene.strokes.layers = shapes::body_layer_alone();
    (scene.strokes.length_px, scene.strokes.width_px) = (Some(10.0), Some(4.0));
    let on = Selector::Object("thing".to_owned());
    let amounts = amounts.into_iter().map(|(of, dab)| PaintedAmount { of, object: None, dabs: vec![dab] });
    scene.regions = vec![Region { amounts: amounts.collect(), ..Region::new("painted", on) }];
    scene
}

fn painted(scene: Scene, mesh: TriangleMesh) -> Painting {
    prepare(shapes::loaded(scene, [mesh])).unwrap()
}

/// The strokes of a layer, by particle.
fn strokes_of(painting: &Painting, kind: LayerKind, camera: &CameraPose) -> BTreeMap<u32, Stroke> {
    let frame = painting.seen_by(camera, 0.0, &FrameOptions::new(SIZE_PX));
    let runs = frame.layers.iter().filter(|run| run.kind == kind);
    runs.flat_map(|run| run.first as usize..(run.first + run.count) as usize)
        .map(|index| (frame.sources[index].particle, frame.strokes[index]))
        .collect()
}

fn body(painting: &Painting) -> BTreeMap<u32, Stroke> {
    strokes_of(painting, LayerKind::Body, &straight_on())
}

/// How far a particle lies from a place, in radii of a dab.
fn share(painting: &Painting, particle: u32, from: Vec3) -> f64 {
    let at = painting.particles(0).at(particle as usize).position;
    (at - from).as_dvec3().length() / RADIUS
}

#[test]
fn a_stroke_in_the_middle_of_a_dab_is_as_much_wider_and_those_outside_stay_to_the_bit() {
    let plain = painted(scene(20_000, Vec::new()), shapes::sheet(20));
    let before = body(&plain);
    // The dab lies on a particle, so that the stroke there shows the whole factor. The first particle near the middle
    // is taken: its rank is low, so its stroke stays when strokes are wider and therefore fewer.
    let half = SIZE_PX.map(|side| side as f32 * 0.5);
    let off = |stroke: &Stroke| (stroke.center_px[0] - half[0]).hypot(stroke.center_px[1] - half[1]);
    let middle = *before.iter().find(|(_, stroke)| off(stroke) < 30.0).unwrap().0;
    let at = plain.particles(0).at(middle as usize).position;
    for by in [0.25, 0.5, 2.0, 3.0, 4.0] {
        for of in [Amount::Width, Amount::Length] {
            let painting = painted(scene(20_000, vec![(of, dab(at, by))]), shapes::sheet(20));
            let sides = |stroke: &Stroke| match of {
                Amount::Width => [stroke.width_px, stroke.length_px],
                _ => [stroke.length_px, stroke.width_px],
            };
            let after = body(&painting);
            let mut factors = Vec::new();
            for (particle, now) in &after {
                let r = share(&painting, *particle, at);
                let Some(was) = before.get(particle) else {
                    assert!(by < 1.0 && r < 1.0, "a new stroke with {by} at {r}");
                    continue;
                };
                if r >= 1.0 {
                    assert_eq!(now, was, "{of:?} by {by} at {r}");
                    continue;
                }
                let ([grown, kept], [side, other]) = (sides(now), sides(was));
                assert_eq!(kept, other, "{of:?} by {by} changes the other side");
                let wanted = 1.0 + (by - 1.0) * (1.0 - r * r).powi(2);
                let factor = f64::from(grown / side);
                assert!(
                    (factor - wanted).abs() < 1e-5 * wanted,
                    "{of:?} by {by} at {r}: {factor}, not {wanted}"
                );
                factors.push((r, (factor - 1.0) / (by - 1.0)));
            }
            let outside = |strokes: &BTreeMap<u32, Stroke>| {
                strokes.keys().filter(|&&particle| share(&painting, particle, at) >= 1.0).count()
            };
            assert_eq!(outside(&before), outside(&after));
            let factor = f64::from(sides(&after[&middle])[0] / sides(&before[&middle])[0]);
            assert!(
                (factor / by - 1.0).abs() <= f64::from(f32::EPSILON),
                "{factor} in the middle of the dab"
            );
            factors.sort_by(|a, b| a.0.total_cmp(&b.0));
            assert!(factors.len() > 60 && factors.windows(2).all(|pair| pair[1].1 <= pair[0].1 + 1e-5));
        }
    }
}

#[test]
fn sizes_follow_the_coverage_and_less_density_is_a_part_of_more() {
    let at = Vec3::ZERO;
    let of = |amount: Amount, by: f64| {
        body(&painted(scene(40_000, vec![(amount, dab(at, by))]), shapes::sheet(20)))
    };
    let plain = of(Amount::Width, 1.0);
    // Where strokes are twice as wide, half as many are wanted, so their supply is half as large.
    let wide = of(Amount::Width, 2.0);
    for (particle, stroke) in &wide {
        let was = &plain[particle];
        let wanted = (was.width_px / stroke.width_px).ln();
        assert!((stroke.supply_ln - was.supply_ln - wanted).abs() < 1e-4);
    }
    let mut more: Option<BTreeMap<u32, Stroke>> = None;
    for by in [4.0, 2.0, 1.0, 0.5, 0.25, 0.0] {
        let strokes = of(Amount::Density, by);
        if by == 1.0 {
            assert_eq!(strokes, plain);
        }
        if let Some(more) = &more {
            let [few, many]: [BTreeSet<u32>; 2] =
                [&strokes, more].map(|strokes| strokes.keys().copied().collect());
            assert!(few.is_subset(&many), "{by}: a stroke is there that was not with more density");
            assert!(few.len() < many.len(), "{by}");
            for (particle, stroke) in &strokes {
                // A stroke that stays keeps its place and size; only its supply may fall.
                let was = &more[particle];
                assert!(stroke.supply_ln <= was.supply_ln);
                assert_eq!(Stroke { supply_ln: was.supply_ln, ..*stroke }, *was);
            }
        }
        more = Some(strokes);
    }
    let none = more.unwrap();
    let painting = painted(scene(40_000, Vec::new()), shapes::sheet(20));
    assert!(
        none.keys().all(|&particle| share(&painting, particle, at) > 0.02),
        "density 0 leaves strokes in the middle"
    );
    assert!(none.keys().any(|&particle| share(&painting, particle, at) > 1.0));
}

#[test]
fn more_density_finds_more_particles_and_keeps_the_first_ones() {
    let found = |amounts: Vec<(Amount, AmountDab)>| {
        let mut scene = scene(0, amounts);
        scene.objects[0].particles = None;
        painted(scene, shapes::sheet(20))
    };
    let plain = found(Vec::new());
    let dense = found(vec![(Amount::Density, dab(Vec3::ZERO, 4.0))]);
    let [few, many] = [&plain, &dense].map(|painting| painting.particles(0));
    assert_eq!(many.len(), 4 * few.len());
    assert!((0..few.len()).all(|index| few.at(index).position == many.at(index).position));
    let near = |painting: &Painting| {
        let present = body(painting).into_iter().filter(|(_, stroke)| stroke.supply_ln > 0.0);
        present.filter(|(particle, _)| share(painting, *particle, Vec3::ZERO) < 0.2).count()
    };
    let [before, after] = [near(&plain), near(&dense)];
    assert!(after as f64 > 3.3 * before as f64 && before > 5, "{before} and {after}");
    let thin = found(vec![(Amount::Density, dab(Vec3::ZERO, 0.0)), (Amount::Width, dab(Vec3::ZERO, 4.0))]);
    assert_eq!(thin.particles(0).len(), few.len(), "less density changed the particles");
}

#[test]
fn no_view_changes_a_painted_size_and_the_underpainting_stays() {
    let amounts = vec![
        (Amount::Width, dab(Vec3::new(0.3, 0.0, 0.0), 2.5)),
        (Amount::Length, dab(Vec3::new(0.0, 0.3, 0.0), 0.5)),
        (Amount::Density, dab(Vec3::new(-0.3, 0.0, 0.0), 0.2)),
    ];
    let with_layers = |amounts| {
        let mut scene = scene(6_000, amounts);
        scene.strokes.layers.retain(|layer| layer.name != LayerKind::Underpainting.name());
        painted(scene, shapes::sheet(20))
    };
    let (plain, painting) = (with_layers(Vec::new()), with_layers(amounts));
    let views = [
        straight_on(),
        camera([1.5, 0.4, 3.4], [0.0; 3]),
        camera([-2.5, -0.6, 2.6], [0.1, 0.0, 0.0]),
        camera([0.2, 0.1, 2.2], [0.0; 3]),
    ];
    let mut sizes: BTreeMap<u32, [f32; 2]> = BTreeMap::new();
    let mut again = 0;
    for view in &views {
        for (particle, stroke) in strokes_of(&painting, LayerKind::Body, view) {
            let size = [stroke.length_px, stroke.width_px];
            again += usize::from(sizes.insert(particle, size).is_some_and(|before| {
                assert_eq!(before, size, "a view changes the size of stroke {particle}");
                true
            }));
        }
        let under = |painting: &Painting| strokes_of(painting, LayerKind::Underpainting, view);
        assert!(!under(&plain).is_empty());
        assert_eq!(under(&plain), under(&painting));
    }
    assert!(again > 2000, "{again}");
}

#[test]
fn painted_flatness_lets_strokes_follow_the_surface_where_it_is_painted() {
    let from_the_side = camera([2.6, 1.2, 2.8], [0.0; 3]);
    let seen = |painting: &Painting| strokes_of(painting, LayerKind::Body, &from_the_side);
    let of = |amounts, flatness| {
        let mut scene = scene(8_000, amounts);
        scene.strokes.flatness = Some(flatness);
        painted(scene, shapes::sphere(40, 20))
    };
    let (flat, following) = (of(Vec::new(), 1.0), of(Vec::new(), 0.0));
    // The dab lies on a stroke, so that some stroke is in its middle.
    let places = seen(&flat).into_keys().map(|particle| flat.particles(0).at(particle as usize).position);
    let at = places.min_by(|one, other| one.distance(Vec3::Z).total_cmp(&other.distance(Vec3::Z))).unwrap();
    let painting = of(vec![(Amount::Flatness, dab(at, 0.0))], 1.0);
    let (flat, following, now) = (seen(&flat), seen(&following), seen(&painting));
    let (mut near, mut turned) = (0, 0);
    for (particle, stroke) in &now {
        let r = share(&painting, *particle, at);
        if r >= 1.0 {
            // If some strokes of a body may follow the surface, the angles of all are rounded differently.
            let (angle_rad, was) = (flat[particle].angle_rad, flat[particle]);
            assert!((stroke.angle_rad - angle_rad).abs() < 1e-6);
            assert_eq!(Stroke { angle_rad, ..*stroke }, was);
        } else if r < 0.05 {
            let off = (stroke.angle_rad - following[particle].angle_rad).abs();
            assert!(off < 0.02, "{off} off a stroke that follows the surface");
            near += 1;
        } else {
            turned += usize::from(stroke.angle_rad != flat[particle].angle_rad);
        }
    }
    assert!(near > 0 && turned > 50, "{near} {turned}");
    // Strokes cannot be flatter than 1.
    let flatter = of(vec![(Amount::Flatness, dab(at, 4.0))], 1.0);
    assert_eq!(seen(&flatter), flat);
}

#[test]
fn amounts_hold_on_a_mesh_that_was_exported_again_and_on_any_number_of_threads() {
    let amounts = || vec![(Amount::Width, dab(Vec3::ZERO, 3.0)), (Amount::Density, dab(Vec3::X * 0.2, 0.5))];
    let place = |x: f32| Particle {
        triangle: 0,
        barycentric: [1.0 / 3.0; 2],
        flipped: false,
        position: Vec3::X * x,
        normal: Vec3::Z,
    };
    let [coarse, fine] = [9, 33].map(|cells| painted(scene(3_000, amounts()), shapes::sheet(cells)));
    for of in Amount::ALL {
        for x in [0.0, 0.1, 0.3, 0.6, 0.9] {
            assert_eq!(
                coarse.painted_at(0, &place(x), of),
                fine.painted_at(0, &place(x), of),
                "{of:?} at {x}"
            );
        }
    }
    assert_eq!(fine.painted_at(0, &place(0.0), Amount::Width), 3.0);
    assert_eq!(fine.painted_at(0, &place(0.9), Amount::Width), 1.0);
    let bits = |painting: &Painting| {
        let frame = painting.seen_by(&straight_on(), 0.0, &FrameOptions::new(SIZE_PX));
        bytemuck::cast_slice::<_, u8>(&frame.strokes).to_vec()
    };
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| bits(&painted(scene(3_000, amounts()), shapes::sheet(33))))
    };
    assert_eq!(on(1), bits(&fine));
    assert_eq!(on(3), bits(&fine));
}

#[test]
fn an_amount_belongs_to_its_region_and_its_object() {
    let mut scene = shapes::scene(vec![shapes::object("left", 2_000), shapes::object("right", 2_000)]);
    scene.regions[0].amounts = vec![PaintedAmount {
        of: Amount::Width,
        object: Some("right".to_owned()),
        dabs: vec![dab(Vec3::ZERO, 2.0)],
    }];
    let on = Selector::Group("right".to_owned(), "whole".to_owned());
    let both = |scene: Scene| prepare(shapes::loaded(scene, [shapes::sheet(4), shapes::sheet(4)])).unwrap();
    let place = Particle {
        triangle: 0,
        barycentric: [1.0 / 3.0; 2],
        flipped: false,
        position: Vec3::ZERO,
        normal: Vec3::Z,
    };
    let at = |painting: &Painting| [0, 1].map(|object| painting.painted_at(object, &place, Amount::Width));
    assert_eq!(at(&both(scene.clone())), [1.0, 2.0]);
    // A later region takes over the surface. It has no amounts.
    scene.regions.push(Region::new("over", on));
    assert_eq!(at(&both(scene)), [1.0, 1.0]);
}
