//! Measures memory: bytes per particle that a painting takes during playback and at the peak of preparing, and the peak
//! bytes of computing a frame. The scene's files, which are loaded before, do not count; the painting's own copies of
//! their meshes do.

use std::sync::Arc;

use impasto_painting::{FrameOptions, prepare};
use impasto_scene::loaded::LoadedScene;

use crate::bench::Bench;
use crate::counted::counted;
use crate::inputs::PAPER_SCENES;
use crate::table::{Figure, Goal, Row, Spread, Unit, shown_count};

/// Particles of the model; the wall behind it has some in addition.
const TEN_MILLIONS: u64 = 10_000_000;

/// A scene with another number of particles on its model.
fn with_particles(scene: &LoadedScene, object: usize, count: u64) -> Arc<LoadedScene> {
    let mut scene = scene.clone();
    scene.scene.objects[object].particles = Some(count);
    Arc::new(scene)
}

/// A scene with only the model, and another number of particles on it.
pub fn alone_with_particles(scene: &LoadedScene, object: usize, count: u64) -> Arc<LoadedScene> {
    let mut scene = scene.clone();
    scene.scene.objects = vec![scene.scene.objects[object].clone()];
    with_particles(&scene, 0, count)
}

/// Measures all scenes.
pub fn run(bench: &mut Bench) -> anyhow::Result<()> {
    // A painting is made first, so that what is made once for all paintings does not count.
    bench.inputs.painting("fish")?.at(0.0, &FrameOptions::new([1280, 720]));
    let scenes = if bench.quick() { &PAPER_SCENES[2..] } else { &PAPER_SCENES[..] };
    for scene in scenes {
        let loaded = bench.inputs.scene(scene.file)?;
        one(bench, scene.file, &loaded)?;
    }
    if !bench.quick() && bench.has_memory("memory", 10 << 30) {
        let largest = &PAPER_SCENES[2];
        let loaded = bench.inputs.scene(largest.file)?;
        let loaded = with_particles(&loaded, largest.object, TEN_MILLIONS);
        one(bench, largest.file, &loaded)?;
    }
    Ok(())
}

fn one(bench: &mut Bench, name: &str, loaded: &Arc<LoadedScene>) -> anyhow::Result<()> {
    let (painting, memory) = counted(|| prepare(Arc::clone(loaded)));
    let painting = painting?;
    let total = painting.particle_total();
    let input = format!("{name}, {} in all layers", shown_count(total));
    let each = |bytes: usize| {
        Figure::new("Impasto", Unit::Bytes, Spread::exact(bytes as f64 / total as f64))
            .noted(format!("{:.0} MB", bytes as f64 * 1e-6))
    };
    bench.push(
        Row::of_ours("memory a particle, playback", &input, each(memory.left)).meant(Goal::AtMost(80.0)),
    );
    bench.push(
        Row::of_ours("memory a particle, peak of preparing", &input, each(memory.peak))
            .meant(Goal::AtMost(400.0)),
    );
    let options = FrameOptions::new([1280, 720]);
    let first = painting.at(0.0, &options);
    let (frame, memory) = counted(|| painting.at(1.0, &options));
    let strokes = frame.strokes.len();
    drop((first, frame));
    let figure = Figure::new("Impasto", Unit::Bytes, Spread::exact(memory.peak as f64))
        .noted(format!("{} strokes of the frame", shown_count(strokes)));
    bench.push(Row::of_ours("memory, set aside for one frame", &input, figure));
    Ok(())
}
