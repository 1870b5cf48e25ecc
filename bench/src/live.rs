//! What an editor waits for: a painting prepared anew after one edit, and a picture of a moving view.

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

/// Particles of all layers of the combed body.
const PARTICLES: u64 = 50_000;

fn shipped(name: &str) -> LoadedScene {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../scenes/{name}.ron"));
    load(&path, &LoadOptions::default()).expect("the shipped scene is good")
}

/// CPU seconds of this process, all threads.
fn cpu_secs() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields: Vec<f64> = stat.rsplit(')').next().unwrap_or("").split_whitespace().map(|f| f.parse().unwrap_or(0.0)).collect();
    fields.get(11).zip(fields.get(12)).map_or(0.0, |(user, system)| (user + system) / 100.0)
}

/// Prepares versions of a scene one after the other; prints the median of each step.
fn edits(what: &str, versions: impl IntoIterator<Item = Arc<LoadedScene>>) {
    let mut preparer = Preparer::default();
    let mut steps: Vec<(&'static str, Vec<f64>)> = Vec::new();
    let mut whole = Vec::new();
    let mut particles = 0;
    let mut cpu = 0.0;
    for (index, version) in versions.into_iter().enumerate() {
        let (start, cpu_start) = (Instant::now(), cpu_secs());
        let painting = preparer.prepare(version).expect("the scene has its meshes");
        particles = painting.particle_total();
        if index == 0 {
            println!("{what}: {particles} particles; the first {:.0} ms", start.elapsed().as_secs_f64() * 1e3);
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
    let median = |seconds: &mut Vec<f64>| {
        seconds.sort_by(f64::total_cmp);
        seconds[seconds.len() / 2] * 1e3
    };
    let cpu = cpu / whole.len() as f64 * 1e3;
    print!("  each further one of {}: {:.1} ms, {cpu:.0} ms of CPU;", whole.len(), median(&mut whole));
    for (name, mut seconds) in steps {
        print!(" {name} {:.1}", median(&mut seconds));
    }
    println!(" ({particles} particles)");
}

/// A body that is combed, one more point a version.
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

/// Versions of a scene, each changed by a number that grows.
fn changed(scene: &str, change: impl Fn(&mut Scene, f64) + 'static) -> impl Iterator<Item = Arc<LoadedScene>> {
    let loaded = shipped(scene);
    (0..8).map(move |step| {
        let mut next = loaded.clone();
        change(&mut next.scene, f64::from(step));
        Arc::new(next)
    })
}

fn preparing() {
    let body = |count: u64| combed(count);
    edits("a comb gesture on an apple", body(PARTICLES / 2));
    edits("a comb gesture on an apple", body(PARTICLES));
    edits("nothing changes, still life", changed("still_life", |_, _| ()));
    edits("a light, still life", changed("still_life", |scene, step| {
        scene.lights[0].direction = Some([0.8, -0.82, -0.26 + 0.01 * step]);
    }));
    edits("the apple's key, still life", changed("still_life", |scene, step| {
        scene.objects[7].keys[0].translation = [0.33 + 0.002 * step, 0.2503, 0.32];
    }));
    edits("a length, still life", changed("still_life", |scene, step| {
        scene.regions[11].strokes.length_px = Some(64.0 - step);
    }));
    edits("an angle, still life", changed("still_life", |scene, step| {
        scene.regions[1].direction = Direction::Angle(3.0 + step);
    }));
    edits("nothing changes, simple objects", changed("simple_objects", |_, _| ()));
    edits("a length, simple objects", changed("simple_objects", |scene, step| {
        scene.strokes.length_px = Some(30.0 - 0.5 * step);
    }));
}

fn pictures() {
    let painting: Painting = Preparer::default().prepare(Arc::new(shipped("still_life"))).expect("the scene has its meshes");
    let camera = motion::camera_at(painting.scene(), 0.0);
    let mut renderer = Renderer::new(open(Driver::Auto, &OpenOptions::default()).expect("a driver")).expect("shaders");
    let sizes = [[475, 325], [333, 228], [950, 650]];
    for (size_px, quality) in sizes.into_iter().flat_map(|size| [(size, Quality::Exact), (size, Quality::Draft)]) {
        let options = FrameOptions { quality, ..FrameOptions::new(size_px) };
        let (mut seen, mut drawn, mut cpu, mut recall) = (Vec::new(), Vec::new(), 0.0, None);
        for turn in 0..12u32 {
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
            renderer.render_with(&mut frame, strokes).expect("it is drawn");
            if quality == Quality::Draft {
                let resolved = renderer.resolved_strokes();
                recall = Some(Recall::of(&painting, &frame, |index| resolved[index].alpha > 0.0, turn));
            }
            drawn.push(start.elapsed().as_secs_f64());
            cpu += cpu_secs() - cpu_start;
        }
        let mut frame = painting.bare(&camera, 0.0, &options);
        frame.lay(painting.strokes(&camera, 0.0, &options, recall.as_ref()));
        renderer.render_timed(&frame).expect("it is drawn");
        let (_, cost) = renderer.render_timed(&frame).expect("it is drawn");
        for seconds in [&mut seen, &mut drawn] {
            seconds.sort_by(f64::total_cmp);
        }
        println!(
            "still life at {size_px:?}, {quality:?}: {} strokes, data {:.1} ms, whole {:.1} ms, {:.0} ms of CPU, overdraw {:.1}",
            frame.strokes.len(), seen[6] * 1e3, drawn[6] * 1e3, cpu / 12.0 * 1e3, cost.overdraw
        );
        for pass in &cost.passes {
            print!("  {} {:.1}", pass.name, pass.seconds * 1e3);
        }
        println!();
        // To be looked at: four bytes a pixel, top row first.
        if let Some(folder) = std::env::args().nth(3) {
            let picture = renderer.render(&frame).expect("it is drawn");
            let file = format!("{folder}/{}x{}_{quality:?}.rgba", size_px[0], size_px[1]);
            std::fs::write(file, picture.rgba8).expect("the folder is there");
        }
        for run in &frame.layers {
            print!("  {} {}", run.kind.name(), run.count);
        }
        println!();
    }
}

/// Runs all of it, or what is named: `edits` or `pictures`.
pub fn run() {
    let named = |what: &str| std::env::args().any(|argument| argument == what);
    if !named("pictures") {
        preparing();
    }
    if !named("edits") {
        pictures();
    }
}
