//! The layers of paint as pictures that, laid over each other, are the finished picture.
//!
//! The picture is more than its layers: light falls on the paint, wet paint runs together, outlines are softened,
//! varnish deepens. All of that is put into the layers as a factor on each pixel and channel: with C the layers laid
//! over each other and F the finished picture, each layer is multiplied by F / C. What no factor can give (light on
//! black paint) becomes one more layer, `finish`, which adds light. Alphas stay as they are, and `finish` has none,
//! except where an outline was softened.

use half::f16;
use impasto_frame_files::exr_file::{Channel, Samples};
use impasto_gl_render::{PaintSurface, PaintedLayer};
use impasto_painting::frame::LayerKind;

use crate::drawn::{Drawn, Found};
use crate::planes::planes;

/// The largest factor on a layer.
const MOST_GAIN: f32 = 4.0;

/// `finish` makes up for a difference only if the difference exceeds both `LEAST_LIGHT` and `HALF_ULP` times the wanted
/// light. `HALF_ULP` is about the last bit of a 16-bit float, relative to the float.
const LEAST_LIGHT: f32 = 4e-4;
const HALF_ULP: f32 = 1.0 / 1024.0;

/// Alphas that differ by less than this count as equal.
const LEAST_ALPHA: f32 = 4e-4;

pub(crate) fn add(
    drawn: &Drawn<'_>,
    layers: &[PaintedLayer],
    surface: &PaintSurface,
    linear: &[[f32; 4]],
    found: &mut Found,
) {
    let possible = drawn.painting.paint_layers();
    let lowest = possible.first().map_or(0, |(order, _)| *order);
    let slots: Vec<Option<&PaintedLayer>> = possible
        .iter()
        .map(|&(order, kind)| layers.iter().find(|layer| (layer.order, layer.kind) == (order, kind)))
        .collect();
    let count = 4 * (slots.len() + 2);
    let mut planes = planes(linear.len(), count, |pixel, values: &mut [f16]| {
        let ground = surface.ground[pixel].map(f32::from);
        let of_slot =
            slots.iter().map(|slot| slot.map_or([0.0; 4], |layer| layer.rgba[pixel].map(f32::from)));
        let [r, g, b, a] = linear[pixel];
        let layers = finished(std::iter::once(ground).chain(of_slot).collect(), [r * a, g * a, b * a, a]);
        for (value, wanted) in values.iter_mut().zip(layers.as_flattened()) {
            *value = f16::from_f32(*wanted);
        }
    })
    .into_iter();
    let name = |&(order, kind): &(i32, LayerKind)| {
        let name = kind.name();
        if order == lowest { format!("layer.{name}.") } else { format!("layer.{name}_{order}.") }
    };
    let names = ["layer.ground.".to_owned()].into_iter();
    let names = names.chain(possible.iter().map(name)).chain(["layer.finish.".to_owned()]);
    for name in names {
        for (letter, plane) in ["R", "G", "B", "A"].iter().zip(planes.by_ref()) {
            found.channels.push(Channel::new(format!("{name}{letter}"), Samples::Half(plane)));
        }
    }
}

/// Changes the layers of a pixel (from the ground up, premultiplied) and adds `finish` on top, so that laid over each
/// other they give `wanted` (premultiplied).
fn finished(mut layers: Vec<[f32; 4]>, wanted: [f32; 4]) -> Vec<[f32; 4]> {
    // In a softened outline, the finished picture may have less alpha than the layers together: then all layers get
    // thinner.
    let clear = |alpha: f32| 1.0 - alpha.min(1.0 - 1e-6);
    let through: f32 = layers.iter().map(|layer| clear(layer[3])).product();
    let wanted_through = 1.0 - wanted[3];
    if wanted_through > through + LEAST_ALPHA {
        let power = wanted_through.ln() / through.ln();
        for layer in &mut layers {
            let alpha = 1.0 - clear(layer[3]).powf(power);
            let share = if layer[3] > 0.0 { alpha / layer[3] } else { 1.0 };
            *layer = [layer[0] * share, layer[1] * share, layer[2] * share, alpha];
        }
    }
    let laid = over(&layers);
    for channel in 0..3 {
        let gain = if laid[channel] > 1e-4 { (wanted[channel] / laid[channel]).min(MOST_GAIN) } else { 1.0 };
        // Rounded as in the file, so that `finish` makes up for the rounding.
        for layer in &mut layers {
            layer[channel] = f16::from_f32(layer[channel] * gain).to_f32();
        }
    }
    for layer in &mut layers {
        layer[3] = f16::from_f32(layer[3]).to_f32();
    }
    // In a softened outline, the picture may also have more alpha than the layers: then `finish` covers a little.
    let through: f32 = layers.iter().map(|layer| 1.0 - layer[3]).product();
    let mut top = [0.0; 4];
    if wanted_through < through - LEAST_ALPHA {
        top[3] = f16::from_f32(1.0 - wanted_through / through).to_f32();
    }
    let laid = over(&layers);
    for channel in 0..3 {
        let lacking = wanted[channel] - (1.0 - top[3]) * laid[channel];
        top[channel] =
            if lacking.abs() > LEAST_LIGHT.max(wanted[channel] * HALF_ULP) { lacking } else { 0.0 };
    }
    layers.push(top);
    layers
}

/// Layers laid over each other, from the first up.
fn over(layers: &[[f32; 4]]) -> [f32; 4] {
    layers.iter().fold([0.0; 4], |below, layer| {
        [0, 1, 2, 3].map(|channel| layer[channel] + (1.0 - layer[3]) * below[channel])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layers_give_the_finished_picture_whatever_was_done_to_it() {
        let layers = vec![[0.2, 0.1, 0.0, 1.0], [0.25, 0.0, 0.0, 0.5], [0.0, 0.2, 0.3, 0.75]];
        let clear = vec![[0.0; 4], [0.2, 0.1, 0.3, 0.4], [0.0, 0.2, 0.3, 0.75]];
        for (layers, wanted) in [
            (layers.clone(), [0.4, 0.3, 0.2, 1.0]),
            (layers, [0.0, 1.0, 0.9, 1.0]),
            (clear.clone(), [0.3, 0.2, 0.1, 0.95]),
            (clear.clone(), [0.1, 0.2, 0.1, 0.4]),
            (vec![[0.0, 0.0, 0.0, 1.0], [0.5, 0.5, 0.5, 1.0]], [0.4, 0.4, 0.4, 0.99]),
            (clear, [0.0; 4]),
        ] {
            let found = finished(layers.clone(), wanted);
            assert_eq!(found.len(), layers.len() + 1);
            let laid = over(&found);
            for (laid, wanted) in laid.iter().zip(wanted) {
                assert!((laid - wanted).abs() < 1e-3, "{laid} for {wanted}");
            }
        }
    }
}
