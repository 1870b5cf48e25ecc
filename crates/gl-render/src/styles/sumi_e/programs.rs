//! The shader programs of the ink style, for each of its two rules.

use crate::body_program::BodyProgram;
use crate::gl::{GlError, Gpu, Program, ProgramSource, ShaderFile};
use crate::lens::{RAY_UNIFORMS, VIEW_LENS_UNIFORMS};
use crate::shader_files::{SHARED, SUMI_E};

/// The files that the style's shaders may include.
const FILES: &[&[ShaderFile]] = &[SHARED, SUMI_E];

/// The programs of `InkRule::Source`, the published way of drawing ink. It has five passes: `low_pass` runs twice.
pub(super) struct SourcePrograms {
    pub(super) silhouette: BodyProgram,
    pub(super) interior: BodyProgram,
    pub(super) low_pass: Program,
    pub(super) mix: Program,
}

/// The programs of `InkRule::Painter`, our own way of drawing ink.
pub(super) struct PainterPrograms {
    pub(super) wash: Program,
    pub(super) soften: Program,
    pub(super) resolve: Program,
    pub(super) paint: Program,
    pub(super) lay: Program,
}

impl SourcePrograms {
    pub(super) fn new(gpu: &Gpu) -> Result<Self, GlError> {
        Ok(Self {
            silhouette: BodyProgram::new(gpu, FILES, SILHOUETTE)?,
            interior: BodyProgram::new(gpu, FILES, INTERIOR)?,
            low_pass: Program::new(gpu, FILES, &LOW_PASS)?,
            mix: Program::new(gpu, FILES, &MIX)?,
        })
    }
}

impl PainterPrograms {
    pub(super) fn new(gpu: &Gpu) -> Result<Self, GlError> {
        Ok(Self {
            wash: Program::new(gpu, FILES, &WASH)?,
            soften: Program::new(gpu, FILES, &SOFTEN)?,
            resolve: Program::new(gpu, FILES, &RESOLVE)?,
            paint: Program::new(gpu, FILES, &PAINT)?,
            lay: Program::new(gpu, FILES, &LAY)?,
        })
    }
}

/// The uniforms of `sumi_e/paper.glsl`.
const PAPER: &[&str] = &["fibres", "paper", "fibre_strength", "paper_axes", "paper_origin"];

const SILHOUETTE: ProgramSource<'static> = ProgramSource::new(
    "sumi_e/surface.vert",
    Some("sumi_e/silhouette.frag"),
    &[&["view_from_world", "clip_from_view", "silhouette"]],
);

const INTERIOR: ProgramSource<'static> = ProgramSource::new(
    "sumi_e/surface.vert",
    Some("sumi_e/interior.frag"),
    &[&["view_from_world", "clip_from_view", "to_light", "tones"]],
);

const LOW_PASS: ProgramSource<'static> = ProgramSource::screen("sumi_e/low_pass.frag", &[&["picture"]]);

const MIX: ProgramSource<'static> =
    ProgramSource::screen("sumi_e/mix.frag", &[PAPER, &["interior", "silhouette", "background"]]);

const WASH: ProgramSource<'static> = ProgramSource::screen(
    "sumi_e/wash.frag",
    &[
        &RAY_UNIFORMS,
        &[
            "tones",
            "inked",
            "normal",
            "depth_and_id",
            "albedo_and_lit",
            "to_light",
            "silhouette",
            "own_tone",
            "seal",
            "line_px",
        ],
    ],
);

const SOFTEN: ProgramSource<'static> =
    ProgramSource::screen("sumi_e/soften.frag", &[&["picture", "axis", "deviation", "target_px"]]);

const RESOLVE: ProgramSource<'static> = ProgramSource {
    captured: &["resolved", "fitted"],
    ..ProgramSource::new(
        "sumi_e/resolve.vert",
        None,
        &[
            &VIEW_LENS_UNIFORMS,
            &["view_from_world", "depth_and_id", "inked", "soft", "pigments", "ink", "seal", "kind"],
        ],
    )
};

const PAINT: ProgramSource<'static> = ProgramSource::new(
    "sumi_e/paint.vert",
    Some("sumi_e/paint.frag"),
    &[&[
        "size_px",
        "mark_rows",
        "dryness",
        "brush_marks",
        "depth_and_id",
        "units_per_px_at_1",
        "orthographic",
    ]],
);

const LAY: ProgramSource<'static> = ProgramSource::screen(
    "sumi_e/lay.frag",
    &[PAPER, &["soft", "wide", "strokes", "background", "ink", "seal", "amounts", "wetness", "size_px"]],
);
