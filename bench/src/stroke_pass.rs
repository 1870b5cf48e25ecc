//! Times our stroke pass beside a bare instanced draw of the same strokes, in the same process and with the same
//! targets, blending, brush texture and instances. The bare draw has two simple shaders in place of ours. They place
//! whole quads; ours cut each quad to the painted part of the mark. They colour each pixel with one brush sample times
//! the stroke's colour.

use std::sync::Arc;

use anyhow::ensure;
use impasto_gl_render::context::{Driver, OpenOptions, open};
use impasto_gl_render::{Cost, PassTime, Renderer, ShaderTexts};
use impasto_painting::frame::LayerKind;
use impasto_painting::{Frame, FrameOptions, prepare};
use impasto_scene::load::{LoadOptions, load};

use crate::bench::Bench;
use crate::table::{Figure, Goal, Row, Spread, Unit, one_line, shown, shown_count};

/// The shaders of the bare draw, by the names of those that they replace.
const BARE: [(&str, &str); 2] = [
    ("rotating_strokes/paint.vert", include_str!("stroke_pass/bare.vert")),
    ("rotating_strokes/paint.frag", include_str!("stroke_pass/bare.frag")),
];

/// The pass that copies the paint that strokes may pick up. It is part of our stroke pass, but not of a bare draw.
const BELOW: &str = "below";

/// What was measured: the seconds of each round, and the overdraw.
struct StrokePass {
    /// Ours: all layers, and the copy of what lies below them.
    ours_secs: Vec<f64>,
    bare_secs: Vec<f64>,
    /// Every pass of our renderer.
    passes: Vec<(&'static str, Vec<f64>)>,
    /// Strokes per pixel: ours, and bare.
    overdraw: [f64; 2],
}

fn layers_secs(cost: &Cost, also: &str) -> f64 {
    let is_layer = |name: &str| LayerKind::ALL.iter().any(|kind| kind.name() == name) || name == also;
    cost.passes.iter().filter(|pass| is_layer(pass.name)).map(|pass| pass.seconds).sum()
}

/// Draws a frame in turn with our shaders and with the bare ones.
fn measure([ours, bare]: [&mut Renderer; 2], frame: &Frame, rounds: usize) -> anyhow::Result<StrokePass> {
    let mut pass =
        StrokePass { ours_secs: Vec::new(), bare_secs: Vec::new(), passes: Vec::new(), overdraw: [0.0; 2] };
    for round in 0..=rounds {
        let (_, own) = ours.render_timed(frame)?;
        let (_, other) = bare.render_timed(frame)?;
        // The first picture is a warm-up: drivers compile shaders when they are first used.
        if round == 0 {
            ensure!(ours.resolved_strokes() == bare.resolved_strokes(), "the bare draw lays other strokes");
            continue;
        }
        pass.ours_secs.push(layers_secs(&own, BELOW));
        pass.bare_secs.push(layers_secs(&other, ""));
        pass.overdraw = [own.overdraw, other.overdraw];
        for PassTime { name, seconds } in own.passes {
            match pass.passes.iter_mut().find(|(known, _)| *known == name) {
                // The seconds of a pass that runs several times in a picture are added up.
                Some((_, all)) if all.len() > pass.ours_secs.len() - 1 => {
                    if let Some(last) = all.last_mut() {
                        *last += seconds;
                    }
                }
                Some((_, all)) => all.push(seconds),
                None => pass.passes.push((name, vec![seconds])),
            }
        }
    }
    Ok(pass)
}

/// Measures the still life at its own size.
pub fn run(bench: &mut Bench) -> anyhow::Result<()> {
    let input = "still_life, 1280 × 720";
    let open_renderer =
        || -> anyhow::Result<Renderer> { Ok(Renderer::new(open(Driver::Auto, &OpenOptions::default())?)?) };
    let (mut ours, mut bare) = match (open_renderer(), open_renderer()) {
        (Ok(ours), Ok(bare)) => (ours, bare),
        (Err(why), _) | (_, Err(why)) => {
            let figure = Figure::missing("Impasto", Unit::Seconds, &one_line(&why.to_string()));
            bench.push(Row::of_ours("stroke pass", input, figure));
            return Ok(());
        }
    };
    let mut texts = ShaderTexts::default();
    for (path, text) in BARE {
        ensure!(texts.put(path, text.to_owned()), "{path} is no shader of the program");
    }
    bare.replace_shaders(&texts)?;
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/still_life.ron");
    let painting = prepare(Arc::new(load(&path, &LoadOptions::default())?))?;
    let frame = painting.at(0.0, &FrameOptions::new([1280, 720]));
    let pass = measure([&mut ours, &mut bare], &frame, if bench.quick() { 7 } else { 31 })?;
    let mut note = format!(
        "{} candidate strokes, {}; overdraw {:.1}, bare {:.1}; all passes:",
        shown_count(frame.strokes.len()),
        ours.report().renderer,
        pass.overdraw[0],
        pass.overdraw[1]
    );
    for (name, seconds) in pass.passes {
        note += &format!(" {name} {}", shown(Spread::of(seconds).median, Unit::Seconds));
    }
    let figures = vec![
        Figure::new("Impasto", Unit::Seconds, Spread::of(pass.ours_secs)).noted(note),
        Figure::new("a bare instanced draw", Unit::Seconds, Spread::of(pass.bare_secs))
            .noted("same targets, blend, brush, strokes"),
    ];
    bench.push(Row::of_race("stroke pass", input, figures, true).meant(Goal::OverFloor(1.3)));
    Ok(())
}
