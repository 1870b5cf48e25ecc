//! Noise-displaced materials, written with what differs from the usual ones.

use super::layout::{Fields, Value, number, text};
use super::{color, word};
use crate::document::{NoiseDisplace, SurfaceNoise, VertexNoise};

pub(super) fn noise_displace(noise: &NoiseDisplace) -> Value {
    let or_none = |value: Option<Value>| value.unwrap_or(Value::Word("None".to_owned()));
    Fields::new()
        .unless(noise.vertex == Some(VertexNoise::default()), "vertex", || {
            or_none(noise.vertex.as_ref().map(vertex))
        })
        .unless(noise.surface == Some(SurfaceNoise::default()), "surface", || {
            or_none(noise.surface.as_ref().map(surface))
        })
        .maybe("period_secs", noise.period_secs.map(number))
        .done()
}

fn pair(values: [f64; 2]) -> Value {
    Value::Tuple(values.map(number).to_vec())
}

fn vertex(vertex: &VertexNoise) -> Value {
    let usual = VertexNoise::default();
    Fields::new()
        .maybe("texture", vertex.texture.as_deref().map(text))
        .unless(vertex.space == usual.space, "space", || word(vertex.space))
        .unless(vertex.value == usual.value, "value", || pair(vertex.value))
        .unless(vertex.scale == usual.scale, "scale", || number(vertex.scale))
        .unless(vertex.along == usual.along, "along", || word(vertex.along))
        .unless(vertex.normals == usual.normals, "normals", || word(vertex.normals))
        .done()
}

fn surface(surface: &SurfaceNoise) -> Value {
    let usual = SurfaceNoise::default();
    let count = || Value::Word(surface.layer_count.to_string());
    Fields::new()
        .maybe("texture", surface.texture.as_deref().map(text))
        .unless(surface.layer_count == usual.layer_count, "layer_count", count)
        .unless(surface.speed == usual.speed, "speed", || number(surface.speed))
        .unless(surface.tiling == usual.tiling, "tiling", || pair(surface.tiling))
        .unless(surface.tile_offset == usual.tile_offset, "tile_offset", || pair(surface.tile_offset))
        .unless(surface.forward == usual.forward, "forward", || word(surface.forward))
        .unless(surface.mix == usual.mix, "mix", || word(surface.mix))
        .unless(surface.tint == usual.tint, "tint", || color(surface.tint))
        .unless(surface.intensity == usual.intensity, "intensity", || number(surface.intensity))
        .unless(surface.opacity == usual.opacity, "opacity", || number(surface.opacity))
        .unless(surface.alpha == usual.alpha, "alpha", || word(surface.alpha))
        .unless(surface.bloom == usual.bloom, "bloom", || number(surface.bloom))
        .unless(surface.threshold == usual.threshold, "threshold", || number(surface.threshold))
        .done()
}
