//! Tests that a painting prepared after an edit equals, bit for bit, one prepared from nothing.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, OnceLock};

use impasto_gl_render::context::Driver;
use impasto_painting::{Frame, FrameOptions, Painting, PrepareError, PrepareOptions, Preparer, prepare};
use impasto_scene::document::{
    Amount, AmountDab, Bend, Dab, Direction, Ease, Edges, InkDrawing, InkRule, LayerSettings, Light,
    LightKind, ObjectKey, PaintedAmount, Region, Scale, Scene, Seam, Selector, Solver, Style, SumiE,
};
use impasto_scene::loaded::LoadedScene;
use impasto_scene::presets::LayerKind;
use impasto_tests::gestures::{camera, drag};
use impasto_tests::pictures::renderer;
use impasto_tests::shapes;

const OPTIONS: FrameOptions = FrameOptions::new([320, 240]);

/// An apple and a ball, each with a region; every layer of paint.
fn start() -> Arc<LoadedScene> {
    let mut scene = shapes::scene(vec![shapes::object("apple", 1500), shapes::object("ball", 900)]);
    scene.style = Style::default();
    scene.strokes = Default::default();
    (scene.strokes.length_px, scene.strokes.width_px) = (Some(36.0), Some(12.0));
    // No object states how many particles its body layer has, so the counts of all layers follow from the view.
    scene.objects.iter_mut().for_each(|object| object.particles = None);
    scene.size = (480, 320);
    scene.timeline.last = 10;
    scene.camera.keys[0] = shapes::camera_key(0.0, [0.0, 0.5, 4.0], [0.0, 0.5, 0.0]);
    scene.objects[1].keys = vec![key(0.0, [1.1, 0.4, -0.6])];
    scene.regions = ["apple", "ball"]
        .map(|name| Region { direction: Direction::Auto, ..Region::new(name, Selector::Object(name.into())) })
        .into();
    shapes::loaded(scene, [shapes::apple_skin(), shapes::sphere(24, 12)])
}

fn key(frame: f64, translation: [f64; 3]) -> ObjectKey {
    ObjectKey {
        frame,
        translation,
        rotation_deg: [0.0; 3],
        scale: Scale::default(),
        morph: 0.0,
        ease: Ease::Linear,
    }
}

type Edit = (&'static str, Box<dyn Fn(&mut Scene)>);

fn edits() -> Vec<Edit> {
    fn edit(name: &'static str, change: impl Fn(&mut Scene) + 'static) -> Edit {
        (name, Box::new(change))
    }
    let view = camera([0.0, 0.5, 4.0], [0.0, 0.5, 0.0]);
    let ends = [[-20.0, -9.0], [16.0, 11.0]].map(glam::DVec2::from);
    let guide = drag(&shapes::apple_skin(), &view, 240.0, ends).unwrap();
    let comb = move |points: usize| {
        let guide = guide.clone();
        move |scene: &mut Scene| {
            let mut guide = guide.clone();
            guide.points.truncate(points);
            scene.regions[0].guides = vec![guide];
        }
    };
    let dab = |x: f64| Dab { at: [x, 0.5, 0.45], normal: [0.0, 0.0, 1.0], radius: 0.2, take_away: false };
    let painted = |of: Amount, by: f64| {
        let dab = AmountDab { at: [0.1, 0.5, 0.45], normal: [0.0, 0.0, 1.0], radius: 0.3, by };
        PaintedAmount { of, object: None, dabs: vec![dab] }
    };
    vec![
        edit("guide added", comb(4)),
        edit("guide grown", comb(5)),
        edit("guide grown far", comb(24)),
        edit("nothing", |_| ()),
        edit("angle", |scene| scene.regions[1].direction = Direction::Angle(20.0)),
        edit("angle of the combed", |scene| scene.regions[0].direction = Direction::Angle(-50.0)),
        edit("crossing", |scene| scene.regions[1].direction = Direction::Crossing(-58.0, 4.0)),
        edit("bend", |scene| scene.regions[1].direction = Direction::Curvature(Bend::Max)),
        edit("shorter", |scene| scene.regions[0].strokes.length_px = Some(26.0)),
        edit("longer", |scene| scene.regions[0].strokes.length_px = Some(43.0)),
        edit("jitter", |scene| scene.regions[0].strokes.angle_jitter_deg = Some(15.0)),
        edit("flatness", |scene| scene.regions[0].strokes.flatness = Some(0.4)),
        edit("offset", |scene| scene.regions[1].strokes.offset = Some(0.02)),
        edit("edges", |scene| scene.regions[1].strokes.edges = Some(Edges::Free)),
        edit("layer", |scene| scene.regions[1].strokes.layer = Some(-1)),
        edit("order of layers", |scene| {
            let mut order = LayerKind::ALL;
            order.rotate_left(2);
            scene.strokes.order = order.map(|kind| kind.name().to_owned()).to_vec();
        }),
        edit("layer hidden", |scene| {
            let name = LayerKind::Accents.name().to_owned();
            let hidden = LayerSettings { name, hidden: Some(true), ..LayerSettings::default() };
            scene.regions[0].strokes.layers.push(hidden);
        }),
        edit("dab", move |scene| {
            let on = Selector::Dabs("apple".into(), vec![dab(0.0)]);
            let region = Region { direction: Direction::Angle(70.0), ..Region::new("spot", on) };
            scene.regions.push(region);
        }),
        edit("dab added", move |scene| {
            scene.regions[2].on = Selector::Dabs("apple".into(), vec![dab(0.0), dab(0.15)]);
        }),
        edit("width painted", move |scene| scene.regions[0].amounts.push(painted(Amount::Width, 2.0))),
        edit("width painted over", move |scene| {
            scene.regions[0].amounts[0].dabs.extend(painted(Amount::Width, 0.4).dabs);
        }),
        edit("density painted", move |scene| scene.regions[0].amounts.push(painted(Amount::Density, 3.0))),
        edit("flatness painted", move |scene| scene.regions[0].amounts.push(painted(Amount::Flatness, 0.2))),
        edit("painted elsewhere", |scene| scene.regions[0].amounts[2].dabs[0].at[0] += 0.1),
        edit("amounts erased", |scene| scene.regions[0].amounts.retain(|one| one.of == Amount::Density)),
        edit("soft seam", |scene| scene.regions[2].seam = Seam::Soft(0.2)),
        edit("object moved later", |scene| scene.objects[1].keys.push(key(8.0, [1.0, 0.5, 0.3]))),
        edit("object moved", |scene| scene.objects[1].keys[0].translation = [1.05, 0.3, -0.3]),
        edit("camera", |scene| scene.camera.keys[0].eye = [0.4, 0.7, 3.6]),
        edit("camera later", |scene| {
            scene.camera.keys.push(shapes::camera_key(10.0, [1.0, 0.7, 2.6], [0.0, 0.5, 0.0]));
        }),
        edit("light", |scene| {
            scene.lights.push(Light {
                direction: Some([0.3, -1.0, -0.2]),
                intensity: 2.0,
                ..Light::new("sun", LightKind::Sun)
            });
        }),
        edit("finish", |scene| {
            if let Style::RotatingStrokes(settings) = &mut scene.style {
                (settings.relief, settings.varnish) = (0.3, 0.1);
            }
        }),
        edit("seed", |scene| scene.seed += 1),
        edit("guide removed", |scene| scene.regions[0].guides.clear()),
        edit("region removed", |scene| drop(scene.regions.remove(2))),
        edit("horn", |scene| {
            if let Style::RotatingStrokes(settings) = &mut scene.style {
                settings.solver = Solver::Horn;
            }
        }),
        edit("shorter by horn", |scene| scene.strokes.length_px = Some(30.0)),
        edit("object removed", |scene| {
            scene.objects.remove(1);
            scene.regions.retain(|region| region.on.object() != Some("ball"));
        }),
        edit("paper", |scene| scene.strokes.preset = Some("paper".into())),
    ]
}

/// An edited scene, and the painting prepared from it alone.
pub(crate) struct Version {
    pub(crate) name: &'static str,
    pub(crate) loaded: Arc<LoadedScene>,
    pub(crate) cold: Painting,
}

/// The scene after each edit, with all edits before it, prepared once for all tests.
pub(crate) fn versions() -> &'static [Version] {
    static VERSIONS: OnceLock<Vec<Version>> = OnceLock::new();
    VERSIONS.get_or_init(|| {
        let mut loaded = start();
        let edited = |(name, edit): Edit| {
            let mut next = (*loaded).clone();
            edit(&mut next.scene);
            loaded = Arc::new(next);
            Version { name, loaded: Arc::clone(&loaded), cold: prepare(Arc::clone(&loaded)).unwrap() }
        };
        edits().into_iter().map(edited).collect()
    })
}

#[test]
fn a_warm_prepare_gives_the_bits_of_a_cold_one() {
    let mut preparer = Preparer::default();
    let mut counts = Vec::new();
    preparer.prepare(start()).unwrap();
    for Version { name, loaded, cold } in versions() {
        let warm = preparer.prepare(Arc::clone(loaded)).unwrap();
        assert_eq!(warm.particle_counts(), cold.particle_counts(), "{name}");
        for frame in [0.0, 7.5] {
            let [a, b]: [Frame; 2] = [&warm, cold].map(|painting| painting.at(frame, &OPTIONS));
            assert!(a.strokes.len() > 100, "{name} at {frame}: only {} strokes", a.strokes.len());
            assert!(a.strokes == b.strokes, "{name} at {frame}: strokes differ");
            assert!(a.sources == b.sources && a.layers == b.layers, "{name} at {frame}: sources differ");
            assert_eq!(format!("{:?}", a.lights), format!("{:?}", b.lights), "{name} at {frame}");
            assert_eq!((a.finish, &a.palettes), (b.finish, &b.palettes), "{name} at {frame}");
        }
        counts.push(warm.particle_total());
    }
    // The edits had an effect: many of them changed the number of particles.
    assert!(counts.windows(2).filter(|pair| pair[0] != pair[1]).count() > 6, "{counts:?}");
}

#[test]
fn preparing_again_after_giving_up_gives_the_same_bits() {
    let mut preparer = Preparer::default();
    preparer.prepare(start()).unwrap();
    let mut given_up = 0;
    for (index, Version { name, loaded, cold }) in versions().iter().enumerate() {
        // Preparing asks `give_up` several times. The first yes comes at the 1st, 2nd, 3rd, 4th or 5th time, in turn
        // from edit to edit.
        let asked = AtomicUsize::new(0);
        let give_up = || asked.fetch_add(1, Ordering::Relaxed) >= index % 5;
        let options = PrepareOptions { give_up: &give_up, ..PrepareOptions::default() };
        let result = preparer.prepare_with(Arc::clone(loaded), &options);
        given_up += usize::from(result.err() == Some(PrepareError::GivenUp));
        let warm = preparer.prepare(Arc::clone(loaded)).unwrap();
        let [a, b]: [Frame; 2] = [&warm, cold].map(|painting| painting.at(7.5, &OPTIONS));
        assert!(a.strokes == b.strokes && a.sources == b.sources, "{name}: strokes differ");
    }
    assert!(given_up > 15, "only {given_up} were given up");
}

/// A style without strokes gives the same picture without particles. The same preparer then makes the strokes of other
/// styles.
#[test]
fn what_only_draws_makes_no_particles_where_none_show() {
    let ink = |rule: InkRule, drawing: InkDrawing| Style::SumiE(SumiE { rule, drawing, ..SumiE::default() });
    let styles = [
        (Style::Reference, false),
        (ink(InkRule::Painter, InkDrawing::Wash), false),
        (ink(InkRule::Source, InkDrawing::default()), false),
        (ink(InkRule::Painter, InkDrawing::default()), true),
        (Style::default(), true),
    ];
    let mut renderer = renderer(Driver::Egl);
    let mut preparer = Preparer::default();
    let only_shown = PrepareOptions { only_shown: true, ..PrepareOptions::default() };
    for (style, has_strokes) in styles {
        let mut loaded = (*start()).clone();
        loaded.scene.style = style.clone();
        let loaded = Arc::new(loaded);
        let whole = prepare(Arc::clone(&loaded)).unwrap();
        let drawn = preparer.prepare_with(loaded, &only_shown).unwrap();
        let made = if has_strokes { whole.particle_total() } else { 0 };
        assert!(whole.particle_total() > 1000);
        assert_eq!(drawn.particle_total(), made, "{style:?}");
        let [a, b] = [&whole, &drawn].map(|painting| {
            renderer.render(&painting.at(7.5, &OPTIONS)).unwrap();
            renderer.read_linear()
        });
        assert!(a == b, "{style:?}: pictures differ");
    }
}
