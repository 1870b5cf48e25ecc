//! Measures table 2 of the source paper again: its three scenes with as many particles, beside the paper's own figures.

use std::hint::black_box;
use std::sync::Arc;

use impasto_core::solve::{SolvedParticles, solve};
use impasto_gl_render::Renderer;
use impasto_gl_render::context::{Driver, OpenOptions, open};
use impasto_painting::{FrameOptions, prepare};

use crate::bench::Bench;
use crate::floor::Streams;
use crate::inputs::{PAPER_SCENES, PaperScene};
use crate::memory::alone_with_particles;
use crate::race::{Contender, race};
use crate::solving;
use crate::table::{Figure, Goal, Row, Spread, Unit, one_line};

const SIZE_PX: [u32; 2] = [1280, 720];

/// The name of the paper's figures in the table.
const PAPER: &str = "the paper, on its machine";

/// The goal for preparing, seconds.
fn most_secs(scene: &PaperScene) -> Option<f64> {
    match scene.file {
        "apple" => Some(0.06),
        "simple_objects" => Some(0.6),
        _ => None,
    }
}

/// Measures the three scenes.
pub fn run(bench: &mut Bench) -> anyhow::Result<()> {
    let context = open(Driver::Auto, &OpenOptions::default());
    let mut renderer = match context {
        Ok(context) => Ok(Renderer::new(context)?),
        Err(why) => Err(one_line(&why.to_string())),
    };
    for scene in &PAPER_SCENES {
        one(bench, scene, &mut renderer)?;
    }
    Ok(())
}

fn paper(unit: Unit, number: f64) -> Figure {
    Figure::new(PAPER, unit, Spread::stated(number)).noted("as printed there")
}

fn one(bench: &mut Bench, scene: &PaperScene, renderer: &mut Result<Renderer, String>) -> anyhow::Result<()> {
    let cloud = bench.inputs.paper_cloud(scene)?;
    let loaded = bench.inputs.scene(scene.file)?;
    let pace = bench.pace(false);
    let input = &cloud.name;

    let contenders = vec![Contender::here("Impasto", "", || prepare(loaded.clone()))];
    let mut row = Row::of_race("table 2, prepare", input, race(&pace, contenders)?, false);
    let painting = bench.inputs.painting(scene.file)?;
    row.ours.note =
        format!("{} particles in all layers", crate::table::shown_count(painting.particle_total()));
    row.peers.push(paper(Unit::Seconds, scene.prepare_secs));
    row.goals.extend(most_secs(scene).map(Goal::AtMost));
    bench.push(row);

    // The model without the rest of our scene: the paper's scenes hold the model only.
    let model = alone_with_particles(&loaded, scene.object, scene.particles as u64);
    let total = prepare(Arc::clone(&model))?.particle_total();
    let contenders = vec![Contender::here("Impasto", "", || prepare(Arc::clone(&model)))];
    let mut row = Row::of_race("table 2, prepare the model alone", input, race(&pace, contenders)?, false);
    row.ours.note = format!("{} particles in all layers", crate::table::shown_count(total));
    row.peers.push(paper(Unit::Seconds, scene.prepare_secs));
    row.goals.extend(most_secs(scene).map(Goal::AtMost));
    bench.push(row);

    let (baked, now) = solving::input(bench, &cloud)?;
    let mut solved = SolvedParticles::default();
    let contenders = vec![
        Contender::here("Impasto", "all particles", || solve(&baked, &now, &mut solved)),
        Streams::new(baked.len(), solving::READ, solving::WRITTEN).contender(),
    ];
    let mut row = Row::of_race("table 2, solve", input, race(&pace, contenders)?, true);
    row.peers.push(paper(Unit::Seconds, scene.solve_secs));
    bench.push(row);

    let options = FrameOptions::new(SIZE_PX);
    let contenders = vec![Contender::here("Impasto", "strokes as data", || painting.at(0.0, &options))];
    bench.push(Row::of_race("table 2, frame as data", input, race(&pace, contenders)?, false));

    let drawn = match renderer {
        Ok(renderer) => {
            renderer.render(&painting.at(0.0, &options))?;
            let visible = renderer.resolved_strokes().iter().filter(|stroke| stroke.alpha > 0.0).count();
            let driver = renderer.report().renderer.clone();
            let contender = Contender::here("Impasto", "", || {
                black_box(renderer.render(&painting.at(0.0, &options))).map(|picture| picture.size_px)
            });
            let mut figures = race(&pace, vec![contender])?;
            figures[0].note = format!("{} × {}, read back; {}", SIZE_PX[0], SIZE_PX[1], driver);
            (Figure::new("Impasto", Unit::Count, Spread::exact(visible as f64)), figures.remove(0))
        }
        Err(why) => {
            let missing = |unit| Figure::missing("Impasto", unit, why);
            (missing(Unit::Count), missing(Unit::Seconds))
        }
    };
    let mut row = Row::of_ours("table 2, frame drawn", input, drawn.1);
    row.peers.push(paper(Unit::Seconds, 1.0 / scene.frames_per_sec));
    bench.push(row);
    let mut row = Row::of_ours("table 2, visible strokes", input, drawn.0);
    row.peers.push(paper(Unit::Count, scene.visible as f64));
    bench.push(row);
    Ok(())
}
