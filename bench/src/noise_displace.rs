//! Repeats table 9 of Hong and Park: how long spheres take to draw with the noise-displaced material and without, in
//! the plain render at 1024 × 1024. They drew on a graphics card, and here the processor may draw, so only the ratio
//! can be compared with theirs.

use std::sync::Arc;
use std::time::Instant;

use impasto_gl_render::Renderer;
use impasto_gl_render::context::{Driver, OpenOptions, open};
use impasto_painting::{FrameOptions, Painting, prepare};
use impasto_scene::document::{MaterialOverride, NoiseDisplace, ObjectKey, Scale, Scene, Style};
use impasto_tests::shapes;

use crate::bench::Bench;
use crate::table::{Figure, Row, Spread, Unit, one_line, shown};

const SIDE_PX: u32 = 1024;

/// Frames measured after a warm-up, as in the paper.
const FRAMES: u32 = 5;

/// `count` spheres in a square, all of them in the picture.
fn spheres(count: usize, noise: Option<&NoiseDisplace>) -> Painting {
    let columns = (count as f64).sqrt().ceil() as usize;
    let spacing = 2.2 / columns as f64;
    let object = |index: usize| {
        let at = |cell: usize| (cell as f64 - 0.5 * (columns - 1) as f64) * spacing;
        let mut object = shapes::object(&format!("ball {index}"), 1);
        object.mesh = "ball.obj".to_owned();
        object.material = Some(MaterialOverride {
            unlit: true,
            noise_displace: noise.cloned(),
            ..MaterialOverride::default()
        });
        object.keys = vec![ObjectKey {
            translation: [at(index % columns), at(index / columns), 0.0],
            scale: Scale::even(0.4 * spacing),
            ..ObjectKey::at(0.0)
        }];
        object
    };
    let mut scene: Scene = shapes::scene((0..count).map(object).collect());
    scene.style = Style::Reference;
    let loaded = shapes::loaded(scene, (0..count).map(|_| shapes::sphere(32, 16)));
    prepare(Arc::clone(&loaded)).expect("the meshes are there")
}

/// For each frame, the seconds to compute its data and the seconds to draw it.
fn frame_secs(renderer: &mut Renderer, painting: &Painting) -> [Vec<f64>; 2] {
    let options = FrameOptions::new([SIDE_PX; 2]);
    let mut secs = [Vec::new(), Vec::new()];
    for number in 0..FRAMES + 2 {
        let start = Instant::now();
        let frame = painting.at(f64::from(number), &options);
        let described = start.elapsed().as_secs_f64();
        renderer.render(&frame).expect("it is drawn");
        let drawn = start.elapsed().as_secs_f64() - described;
        if number >= 2 {
            secs[0].push(described);
            secs[1].push(drawn);
        }
    }
    secs
}

/// Measures spheres of four counts.
pub fn run(bench: &mut Bench) -> anyhow::Result<()> {
    let context = match open(Driver::Auto, &OpenOptions::default()) {
        Ok(context) => context,
        Err(why) => {
            let figure = Figure::missing("with noise", Unit::Seconds, &one_line(&why.to_string()));
            bench.push(Row::of_ours("noise_displace", "spheres", figure));
            return Ok(());
        }
    };
    let mut renderer = Renderer::new(context)?;
    for count in [1, 25, 100, 400] {
        let noise = NoiseDisplace::default();
        let figures = [("with noise", Some(&noise)), ("without", None)].map(|(who, noise)| {
            let [described, drawn] = frame_secs(&mut renderer, &spheres(count, noise));
            let whole = Spread::of(described.iter().zip(&drawn).map(|(one, other)| one + other).collect());
            let described = shown(Spread::of(described).median, Unit::Seconds);
            Figure::new(who, Unit::Seconds, whole).noted(format!("{described} of it to describe the frame"))
        });
        let input = format!("{count} spheres, {SIDE_PX} × {SIDE_PX}");
        bench.push(Row::of_race("noise_displace", &input, figures.to_vec(), false));
    }
    Ok(())
}
