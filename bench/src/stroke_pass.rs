//! The pass that lays strokes beside a bare instanced draw of the same strokes: same process, targets, blend, brush texture,
//! instances and quads. The bare renderer has two shaders in place of the program's own: a quad, and one brush sample times
//! the stroke's colour.

use std::sync::Arc;

use impasto_gl_render::context::{Driver, OpenOptions, open};
use impasto_gl_render::{Cost, PassTime, Renderer, ShaderTexts};
use impasto_painting::frame::LayerKind;
use impasto_painting::{Frame, FrameOptions, prepare};
use impasto_scene::load::{LoadOptions, load};

/// What the shaders of a bare draw stand in for.
const BARE: [(&str, &str); 2] = [
    ("rotating_strokes/paint.vert", include_str!("stroke_pass/bare.vert")),
    ("rotating_strokes/paint.frag", include_str!("stroke_pass/bare.frag")),
];

/// The copy that wet paint is picked up from: part of laying strokes, but of no bare draw.
const BELOW: &str = "below";

/// Medians over the rounds, seconds.
pub struct StrokePass {
    /// Who draws.
    pub driver: String,
    /// Strokes that go to the driver.
    pub strokes: usize,
    /// Ours: all layers, and the copy of what lies below them.
    pub ours_secs: Vec<f64>,
    /// The same quads, bare.
    pub bare_secs: Vec<f64>,
    /// Every pass of ours.
    pub passes: Vec<PassTime>,
    /// How many strokes lie on a pixel: our marks, and whole quads.
    pub overdraw: [f64; 2],
}

fn median(seconds: &[f64]) -> f64 {
    let mut sorted = seconds.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted[sorted.len() / 2]
}

impl StrokePass {
    /// Ours over bare, of medians.
    pub fn ratio(&self) -> f64 {
        median(&self.ours_secs) / median(&self.bare_secs)
    }
}

fn renderer() -> Renderer {
    Renderer::new(open(Driver::Auto, &OpenOptions::default()).expect("a driver")).expect("shaders")
}

fn layers_secs(cost: &Cost, also: &str) -> f64 {
    let is_layer = |name: &str| LayerKind::ALL.iter().any(|kind| kind.name() == name) || name == also;
    cost.passes.iter().filter(|pass| is_layer(pass.name)).map(|pass| pass.seconds).sum()
}

/// Draws a frame in turn with the program's own shaders and bare.
pub fn measure(frame: &Frame, rounds: usize) -> StrokePass {
    let (mut ours, mut bare) = (renderer(), renderer());
    let mut texts = ShaderTexts::default();
    for (path, text) in BARE {
        assert!(texts.put(path, text.to_owned()), "{path} is a shader of the program");
    }
    bare.replace_shaders(&texts).expect("the bare shaders compile");
    let (mut ours_secs, mut bare_secs) = (Vec::new(), Vec::new());
    let (mut passes, mut overdraw): (Vec<(&'static str, Vec<f64>)>, _) = (Vec::new(), [0.0; 2]);
    for round in 0..=rounds {
        let (_, own) = ours.render_timed(frame).expect("it is drawn");
        let (_, other) = bare.render_timed(frame).expect("it is drawn");
        // The first picture compiles shaders for their state.
        if round == 0 {
            let same = ours.resolved_strokes() == bare.resolved_strokes();
            assert!(same, "both lay the same strokes");
            continue;
        }
        ours_secs.push(layers_secs(&own, BELOW));
        bare_secs.push(layers_secs(&other, ""));
        overdraw = [own.overdraw, other.overdraw];
        let mut summed: Vec<PassTime> = Vec::new();
        for pass in own.passes {
            match summed.iter_mut().find(|known| known.name == pass.name) {
                Some(known) => known.seconds += pass.seconds,
                None => summed.push(pass),
            }
        }
        for pass in summed {
            match passes.iter_mut().find(|(name, _)| *name == pass.name) {
                Some((_, seconds)) => seconds.push(pass.seconds),
                None => passes.push((pass.name, vec![pass.seconds])),
            }
        }
    }
    let passes = passes.iter().map(|(name, seconds)| PassTime { name, seconds: median(seconds) }).collect();
    let strokes = frame.strokes.len();
    StrokePass { driver: ours.report().renderer.clone(), strokes, ours_secs, bare_secs, passes, overdraw }
}

/// The still life at its own size.
pub fn run(quick: bool) {
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/still_life.ron");
    let loaded = load(&path, &LoadOptions::default()).expect("the shipped scene is good");
    let painting = prepare(Arc::new(loaded)).expect("the scene has its meshes");
    let frame = painting.at(0.0, &FrameOptions::new([1280, 720]));
    let pass = measure(&frame, if quick { 5 } else { 21 });
    println!(
        "stroke pass, still life 1280x720, {} strokes in question, {}: {:.1} ms, bare {:.1} ms, ratio {:.2}; overdraw {:.1}, of quads {:.1}",
        pass.strokes,
        pass.driver,
        median(&pass.ours_secs) * 1e3,
        median(&pass.bare_secs) * 1e3,
        pass.ratio(),
        pass.overdraw[0],
        pass.overdraw[1]
    );
    for PassTime { name, seconds } in &pass.passes {
        println!("  {name:<14}{:>8.1} ms", seconds * 1e3);
    }
}
