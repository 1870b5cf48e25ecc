//! Data of the stroke that shows most in each pixel, and how much each layer of paint shows.

use std::f32::consts::{PI, TAU};

use impasto_frame_files::exr_file::{Channel, Samples};
use impasto_gl_render::Renderer;
use impasto_painting::frame::LayerKind;
use impasto_scene::aovs::{Aov, AovSet};
use rayon::prelude::*;

use crate::covering::{Covering, kind_of, stroke_names};
use crate::cryptomatte::id_bits;
use crate::drawn::{Drawn, Found};
use crate::planes::in_steps;

/// The share of a pixel in which a layer shows is rounded to a multiple of this.
const ALPHA_STEP: f32 = 1.0 / 512.0;

pub(crate) fn add(
    drawn: &Drawn<'_>,
    wanted: AovSet,
    covering: &Covering,
    renderer: &Renderer,
    found: &mut Found,
) {
    let frame = drawn.frame;
    let pixels = covering.ground.len();
    let most = |pixel: usize| {
        let shares = covering.shares.of(pixel).iter();
        shares.max_by(|left, right| left.amount.total_cmp(&right.amount)).map(|share| share.stroke as usize)
    };
    let mut add = |aov: Aov, of_stroke: &(dyn Fn(usize) -> f32 + Sync)| {
        if wanted.has(aov) {
            let values = (0..pixels).into_par_iter().map(|pixel| most(pixel).map_or(0.0, of_stroke));
            let name = AovSet::from(aov).rows().map(|row| row.channels).collect::<String>();
            let values: Vec<f32> = values.collect();
            let samples =
                if aov == Aov::StrokeAngle { Samples::Float(values) } else { Samples::half(values) };
            found.channels.push(Channel::new(name, samples));
        }
    };
    if wanted.has(Aov::StrokeAngle) {
        let resolved = renderer.resolved_strokes();
        add(Aov::StrokeAngle, &|stroke| {
            let angle = frame.strokes[stroke].angle_rad + resolved[stroke].turned_rad;
            angle - TAU * ((angle + PI) / TAU).floor()
        });
    }
    add(Aov::StrokeKappa, &|stroke| frame.sources[stroke].kappa);
    add(Aov::StrokeRank, &|stroke| frame.sources[stroke].rank);
    add(Aov::StrokeLayer, &|stroke| 1.0 + kind_of(frame, stroke) as u8 as f32);
    if wanted.has(Aov::StrokeId) {
        let bits: Vec<u32> = stroke_names(drawn).par_iter().map(|name| id_bits(name)).collect();
        let ids = (0..pixels).into_par_iter().map(|pixel| most(pixel).map_or(0, |stroke| bits[stroke]));
        found.channels.push(Channel::new("stroke.id.X", Samples::Uint(ids.collect())));
    }
    if wanted.has(Aov::PaintAlpha) {
        let kinds: Vec<LayerKind> =
            frame.strokes.iter().enumerate().map(|(index, _)| kind_of(frame, index)).collect();
        let by_hand = drawn.painting.has_touches().then_some(LayerKind::Touches);
        for kind in LayerKind::ALL.into_iter().chain(by_hand) {
            let shown = (0..pixels).into_par_iter().map(|pixel| {
                let shares = covering.shares.of(pixel).iter();
                shares
                    .filter(|share| kinds[share.stroke as usize] == kind)
                    .map(|share| share.amount)
                    .sum::<f32>()
            });
            let shown: Vec<f32> = shown.map(|shown| in_steps(shown, ALPHA_STEP)).collect();
            found.channels.push(Channel::new(format!("alpha.{}.X", kind.name()), Samples::half(shown)));
        }
        let ground = Samples::half(covering.ground.iter().copied());
        found.channels.push(Channel::new("alpha.ground.X", ground));
    }
}
