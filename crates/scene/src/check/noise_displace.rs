//! Checks noise-displaced materials: that texture names are valid and numbers lie in their ranges.

use super::Findings;
use crate::document::{NoiseDisplace, SurfaceNoise, VertexNoise};
use crate::limits;

/// `field_path` is the path of the material.
pub(super) fn check(field_path: &str, noise: &NoiseDisplace, findings: &mut Findings) {
    let field_path = format!("{field_path}.noise_displace");
    for (name, field) in noise.textures() {
        let field = field.trim_start_matches("noise_displace");
        findings.name(&format!("{field_path}{field}"), name);
    }
    if let Some(period_secs) = noise.period_secs {
        findings.number(&format!("{field_path}.period_secs"), period_secs, limits::NOISE_PERIOD_SECS);
    }
    if let Some(vertex) = &noise.vertex {
        check_vertex(&format!("{field_path}.vertex"), vertex, findings);
    }
    if let Some(surface) = &noise.surface {
        check_surface(&format!("{field_path}.surface"), surface, findings);
    }
}

fn check_vertex(field_path: &str, vertex: &VertexNoise, findings: &mut Findings) {
    for value in vertex.value {
        findings.number(&format!("{field_path}.value"), value, limits::NOISE_RATE);
    }
    findings.numbers(field_path, vertex, VertexNoise::numbers());
}

fn check_surface(field_path: &str, surface: &SurfaceNoise, findings: &mut Findings) {
    let layers = limits::NOISE_LAYERS;
    findings.number(&format!("{field_path}.layer_count"), f64::from(surface.layer_count), layers);
    for (field, values) in [("tiling", surface.tiling), ("tile_offset", surface.tile_offset)] {
        for value in values {
            findings.number(&format!("{field_path}.{field}"), value, limits::NOISE_RATE);
        }
    }
    findings.numbers(field_path, surface, SurfaceNoise::numbers());
}
