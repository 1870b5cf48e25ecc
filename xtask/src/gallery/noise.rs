//! The list of the gallery's pictures of noise-displaced materials. Most show one parameter at several values, side by
//! side.

use super::list::{Picture, View};

/// The part of the picture that has the ball.
const BALL: [usize; 4] = [200, 150, 380, 370];

const fn sweep(
    name: &'static str,
    columns: usize,
    panels: &'static [&'static [(&'static str, &'static str)]],
) -> Picture {
    let view = View::Scene { scene: "noise_displace", frame: 0, crop: Some(BALL) };
    Picture { name, view, own_size: false, columns, panels }
}

const fn whole(
    name: &'static str,
    scene: &'static str,
    panels: &'static [&'static [(&'static str, &'static str)]],
) -> Picture {
    let view = View::Scene { scene, frame: 0, crop: None };
    Picture { name, view, own_size: false, columns: panels.len(), panels }
}

const VALUE: &str = "objects.ball.material.noise_displace.vertex.value";
const SCALE: &str = "objects.ball.material.noise_displace.vertex.scale";
const VERTEX: &str = "objects.ball.material.noise_displace.vertex";
const NOISE: &str = "objects.ball.material.noise_displace";
const LAYERS: &str = "objects.ball.material.noise_displace.surface.layer_count";
const SURFACE: &str = "objects.ball.material.noise_displace.surface";
const SPEED: &str = "objects.ball.material.noise_displace.surface.speed";
const TILING: &str = "objects.ball.material.noise_displace.surface.tiling";
const TINT: &str = "objects.ball.material.noise_displace.surface.tint";
const INTENSITY: &str = "objects.ball.material.noise_displace.surface.intensity";
const OPACITY: &str = "objects.ball.material.noise_displace.surface.opacity";
const BLOOM: &str = "objects.ball.material.noise_displace.surface.bloom";
const THRESHOLD: &str = "objects.ball.material.noise_displace.surface.threshold";
const OFFSET: &str = "objects.ball.material.noise_displace.surface.tile_offset";
const FORWARD: &str = "objects.ball.material.noise_displace.surface.forward";
const PLACE: &str = "objects.ball.keys";

pub(super) const PICTURES: &[Picture] = &[
    whole("noise_displace", "noise_displace", &[&[]]),
    whole("explosion", "explosion", &[&[]]),
    whole(
        "explosion_moves",
        "explosion",
        &[&[("--frames", "0")], &[("--frames", "20")], &[("--frames", "40")]],
    ),
    sweep("noise_value", 4, &[&[(VALUE, "(0.1, 0.1)")], &[], &[(VALUE, "(0.6, 0.6)")], &[(VALUE, "(1, 1)")]]),
    sweep("noise_scale", 4, &[&[(SCALE, "0")], &[(SCALE, "0.1")], &[(SCALE, "0.25")], &[(SCALE, "0.6")]]),
    sweep(
        "noise_space",
        4,
        &[
            &[],
            &[(PLACE, "[(frame: 0, translation: (-0.95, 0.85, 0.3))]")],
            &[(VERTEX, "(space: Local, value: (0.35, 0.35), scale: 0.3)")],
            &[
                (VERTEX, "(space: Local, value: (0.35, 0.35), scale: 0.3)"),
                (PLACE, "[(frame: 0, translation: (-0.95, 0.85, 0.3))]"),
            ],
        ],
    ),
    sweep(
        "noise_along",
        3,
        &[
            &[(NOISE, "(vertex: (value: (0.5, 0.5), scale: 0.35), surface: None)")],
            &[(NOISE, "(vertex: (value: (0.5, 0.5), scale: 0.35, along: Normal), surface: None)")],
            &[(
                NOISE,
                "(vertex: (value: (0.5, 0.5), scale: 0.35, along: Normal, normals: Displaced), surface: None)",
            )],
        ],
    ),
    sweep(
        "noise_layers",
        3,
        &[&[(LAYERS, "1")], &[(LAYERS, "2")], &[], &[(LAYERS, "10")], &[(LAYERS, "22")], &[(LAYERS, "64")]],
    ),
    sweep("noise_speed", 3, &[&[(SPEED, "0")], &[(SPEED, "1")], &[(SPEED, "10")]]),
    sweep("noise_tile_offset", 3, &[&[], &[(OFFSET, "(0.25, 0)")], &[(OFFSET, "(0.25, 0.25)")]]),
    sweep(
        "noise_forward",
        4,
        &[&[], &[("--frames", "6")], &[(FORWARD, "Even")], &[(FORWARD, "Even"), ("--frames", "6")]],
    ),
    sweep("noise_threshold", 3, &[&[(THRESHOLD, "0")], &[(THRESHOLD, "0.8")], &[(THRESHOLD, "2")]]),
    sweep("noise_period", 3, &[&[], &[("--frames", "24")], &[("--frames", "48")]]),
    sweep("noise_tiling", 4, &[&[(TILING, "(0.5, 0.5)")], &[(TILING, "(1, 1)")], &[], &[(TILING, "(8, 8)")]]),
    sweep(
        "noise_mix",
        4,
        &[
            &[(SURFACE, "(layer_count: 4, tiling: (3, 2), tint: \"#3fa8ff\")")],
            &[(SURFACE, "(layer_count: 22, tiling: (3, 2), tint: \"#3fa8ff\")")],
            &[(SURFACE, "(layer_count: 4, tiling: (3, 2), tint: \"#3fa8ff\", mix: Mean)")],
            &[(SURFACE, "(layer_count: 22, tiling: (3, 2), tint: \"#3fa8ff\", mix: Mean)")],
        ],
    ),
    sweep("noise_tint", 3, &[&[(TINT, "\"#ff5a2e\"")], &[(TINT, "\"#ffc640\"")], &[(TINT, "\"#9a6bff\"")]]),
    sweep("noise_intensity", 4, &[&[(INTENSITY, "0.5")], &[(INTENSITY, "1")], &[], &[(INTENSITY, "8")]]),
    sweep("noise_opacity", 3, &[&[(OPACITY, "0.25")], &[(OPACITY, "0.6")], &[(OPACITY, "1")]]),
    sweep(
        "noise_alpha",
        3,
        &[
            &[(SURFACE, "(layer_count: 3, tiling: (3, 2), tint: \"#ffffff\")")],
            &[(SURFACE, "(layer_count: 3, tiling: (3, 2), tint: \"#ffffff\", alpha: Grey)")],
            &[(SURFACE, "(layer_count: 9, tiling: (3, 2), tint: \"#ffffff\", alpha: Grey)")],
        ],
    ),
    sweep("noise_bloom", 3, &[&[(BLOOM, "0")], &[], &[(BLOOM, "3")]]),
];
