//! Measures what the user of an editor waits for: a painting prepared again after an edit, and pictures of a moving
//! view.

use std::sync::Arc;
use std::time::Instant;

use glam::DVec2;
use impasto_gl_render::Renderer;
use impasto_gl_render::context::{Driver, OpenOptions, open};
use impasto_painting::{FrameOptions, Painting, Preparer, Quality, Recall};
use impasto_scene::document::{Direction, Guide, Region, Scene, Selector};
use impasto_scene::load::{LoadOptions, load};
use impasto_scene::loaded::LoadedScene;
use impasto_scene::motion;
use impasto_tests::{gestures, shapes};

use crate::bench::Bench;
use crate::table::{Figure, Row, Spread, Unit, one_line, shown, shown_count};

/// Particles of the apple that `combed` combs; `edits` also measures half as many.
const PARTICLES: u64 = 50_000;

/// Number of pictures of a moving view.
const TURNS: u32 = 12;

fn shipped(name: &str) -> LoadedScene {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../scenes/{name}.ron"));
    load(&path, &LoadOptions::default()).expect("the shipped scene is good")
}

/// The CPU seconds that all threads of this process have used so far.
fn cpu_secs() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields: Vec<f64> =
        stat.rsplit(')').next().unwrap_or("").split_whitespace().map(|f| f.parse().unwrap_or(0.0)).collect();
    fields.get(11).zip(fields.get(12)).map_or(0.0, |(user, system)| (user + system) / 100.0)
}

/// Prepares versions of a scene one after the other. Adds one row to the results, with the times of all versions but
/// the first.
fn edits_of(
    bench: &mut Bench,
    what: &str,
    versions: impl IntoIterator<Item = Arc<LoadedScene>>,
) -> anyhow::Result<()> {
    let mut preparer = Preparer::default();
    let mut steps: Vec<(&'static str, Vec<f64>)> = Vec::new();
    let mut whole = Vec::new();
    let (mut particles, mut cpu, mut first_secs) = (0, 0.0, 0.0);
    for (index, version) in versions.into_iter().enumerate() {
        let (start, cpu_start) = (Instant::now(), cpu_secs());
        let painting = preparer.prepare(version)?;
        particles = painting.particle_total();
        if index == 0 {
            first_secs = start.elapsed().as_secs_f64();
            continue;
        }
        whole.push(start.elapsed().as_secs_f64());
        cpu += cpu_secs() - cpu_start;
        for step in painting.steps() {
            match steps.iter_mut().find(|(name, _)| *name == step.name) {
                Some((_, seconds)) => seconds.push(step.seconds),
                None => steps.push((step.name, vec![step.seconds])),
            }
        }
    }
    let cpu = cpu / whole.len() as f64;
    let mut note = format!(
        "the first {}; {} of CPU; steps:",
        shown(first_secs, Unit::Seconds),
        shown(cpu, Unit::Seconds)
    );
    for (name, seconds) in steps {
        note += &format!(" {name} {}", shown(Spread::of(seconds).median, Unit::Seconds));
    }
    let input = format!("{what}, {}", shown_count(particles));
    let figure = Figure::new("Impasto", Unit::Seconds, Spread::of(whole)).noted(note);
    bench.push(Row::of_ours("edit", &input, figure));
    Ok(())
}

/// Versions of a scene in which one gesture combs an apple: the first without the gesture, the second with its first
/// two points, each later one with one point more.
fn combed(particles: u64) -> impl Iterator<Item = Arc<LoadedScene>> {
    let mesh = shapes::apple_skin();
    let view = gestures::camera([0.0, 0.5, 4.0], [0.0, 0.5, 0.0]);
    let ends = [DVec2::new(-30.0, -16.0), DVec2::new(34.0, 6.0)];
    let guide = gestures::drag(&mesh, &view, 360.0, ends).expect("the gesture lies on the apple");
    let mut scene = shapes::scene(vec![shapes::object("apple", particles)]);
    scene.style = Default::default();
    scene.camera.keys[0] = shapes::camera_key(0.0, [0.0, 0.5, 4.0], [0.0, 0.5, 0.0]);
    scene.regions = vec![Region {
        direction: Direction::Auto,
        ..Region::new("combed", Selector::Object("apple".to_owned()))
    }];
    let first = shapes::loaded(scene, [mesh]);
    let grown = first.clone();
    std::iter::once(first).chain((2..24).map(move |points| {
        let mut next = (*grown).clone();
        next.scene.regions[0].guides =
            vec![Guide { points: guide.points[..points].to_vec(), ..guide.clone() }];
        Arc::new(next)
    }))
}

/// Versions of a scene, each changed a little further.
fn changed(
    scene: &str,
    change: impl Fn(&mut Scene, f64) + 'static,
) -> impl Iterator<Item = Arc<LoadedScene>> {
    let loaded = shipped(scene);
    (0..8).map(move |step| {
        let mut next = loaded.clone();
        change(&mut next.scene, f64::from(step));
        Arc::new(next)
    })
}

/// An edit: its name, and a function that makes the edit in a scene. The number says how far the edit goes.
type Edit = (&'static str, fn(&mut Scene, f64));

/// Measures preparing after one edit of each kind.
pub fn edits(bench: &mut Bench) -> anyhow::Result<()> {
    for count in [PARTICLES / 2, PARTICLES] {
        edits_of(bench, "a comb gesture on an apple", combed(count))?;
    }
    let still_life: [Edit; 5] = [
        ("nothing", |_, _| ()),
        ("a light", |scene, step| scene.lights[0].direction = Some([0.8, -0.82, -0.26 + 0.01 * step])),
        ("the apple's key", |scene, step| {
            scene.objects[7].keys[0].translation = [0.33 + 0.002 * step, 0.2503, 0.32];
        }),
        ("a length", |scene, step| scene.regions[11].strokes.length_px = Some(64.0 - step)),
        ("an angle", |scene, step| scene.regions[1].direction = Direction::Angle(3.0 + step)),
    ];
    for (what, change) in still_life {
        edits_of(bench, &format!("{what}, still_life"), changed("still_life", change))?;
    }
    let simple_objects: [Edit; 2] = [
        ("nothing", |_, _| ()),
        ("a length", |scene, step| scene.strokes.length_px = Some(30.0 - 0.5 * step)),
    ];
    for (what, change) in simple_objects {
        edits_of(bench, &format!("{what}, simple_objects"), changed("simple_objects", change))?;
    }
    Ok(())
}

/// Measures how long pictures of `still_life` take while its camera moves, at usual sizes of a viewport.
pub fn pictures(bench: &mut Bench) -> anyhow::Result<()> {
    let painting: Painting = Preparer::default().prepare(Arc::new(shipped("still_life")))?;
    let camera = motion::camera_at(painting.scene(), 0.0);
    let context = match open(Driver::Auto, &OpenOptions::default()) {
        Ok(context) => context,
        Err(why) => {
            let figure = Figure::missing("Impasto", Unit::Seconds, &one_line(&why.to_string()));
            bench.push(Row::of_ours("picture", "still_life", figure));
            return Ok(());
        }
    };
    let mut renderer = Renderer::new(context)?;
    let sizes = [[475, 325], [333, 228], [950, 650]];
    for (size_px, quality) in
        sizes.into_iter().flat_map(|size| [(size, Quality::Exact), (size, Quality::Draft)])
    {
        let options = FrameOptions { quality, ..FrameOptions::new(size_px) };
        let (mut seen, mut drawn, mut cpu, mut recall) = (Vec::new(), Vec::new(), 0.0, None);
        for turn in 0..TURNS {
            let mut camera = camera.clone();
            camera.eye.x += 0.01 * f64::from(turn);
            let (start, cpu_start) = (Instant::now(), cpu_secs());
            let mut frame = painting.bare(&camera, 0.0, &options);
            let strokes = || {
                let start = Instant::now();
                let strokes = painting.strokes(&camera, 0.0, &options, recall.as_ref());
                seen.push(start.elapsed().as_secs_f64());
                strokes
            };
            renderer.render_with(&mut frame, strokes)?;
            if quality == Quality::Draft {
                let resolved = renderer.resolved_strokes();
                recall = Some(Recall::of(&painting, &frame, |index| resolved[index].alpha > 0.0, turn));
            }
            drawn.push(start.elapsed().as_secs_f64());
            cpu += cpu_secs() - cpu_start;
        }
        let mut frame = painting.bare(&camera, 0.0, &options);
        frame.lay(painting.strokes(&camera, 0.0, &options, recall.as_ref()));
        renderer.render_timed(&frame)?;
        let (_, cost) = renderer.render_timed(&frame)?;
        let secs = |secs: f64| shown(secs, Unit::Seconds);
        let mut note = format!(
            "{} strokes; as data {}; {} of CPU; overdraw {:.1}; passes:",
            shown_count(frame.strokes.len()),
            secs(Spread::of(seen).median),
            secs(cpu / f64::from(TURNS)),
            cost.overdraw
        );
        for pass in &cost.passes {
            note += &format!(" {} {}", pass.name, secs(pass.seconds));
        }
        let input = format!("still_life, {} × {}, {quality:?}", size_px[0], size_px[1]).to_lowercase();
        let figure = Figure::new("Impasto", Unit::Seconds, Spread::of(drawn)).noted(note);
        bench.push(Row::of_ours("picture", &input, figure));
    }
    Ok(())
}
