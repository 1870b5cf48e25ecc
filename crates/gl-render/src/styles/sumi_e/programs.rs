//! The shader programs of the style.

use crate::gl::{GlError, Gpu, Program, ProgramSource, ShaderFile};
use crate::shader_files::{SHARED, SUMI_E};

/// What their files may include.
const FILES: &[&[ShaderFile]] = &[SHARED, SUMI_E];

/// Those of the source's five passes.
pub(super) struct SourcePrograms {
    pub(super) silhouette: Program,
    pub(super) interior: Program,
    pub(super) low_pass: Program,
    pub(super) mix: Program,
}

/// Those of our own rule.
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
            silhouette: Program::new(gpu, FILES, &SILHOUETTE)?,
            interior: Program::new(gpu, FILES, &INTERIOR)?,
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

const SILHOUETTE: ProgramSource = ProgramSource {
    vertex: "sumi_e/surface.vert",
    fragment: Some("sumi_e/silhouette.frag"),
    captured: &[],
    uniforms: &["world_from_model", "morph", "view_from_world", "clip_from_view", "silhouette"],
    defined: &[],
};

const INTERIOR: ProgramSource = ProgramSource {
    vertex: "sumi_e/surface.vert",
    fragment: Some("sumi_e/interior.frag"),
    captured: &[],
    uniforms: &["world_from_model", "morph", "view_from_world", "clip_from_view", "to_light", "tones"],
    defined: &[],
};

const LOW_PASS: ProgramSource = ProgramSource {
    vertex: "shared/screen.vert",
    fragment: Some("sumi_e/low_pass.frag"),
    captured: &[],
    uniforms: &["picture"],
    defined: &[],
};

const MIX: ProgramSource = ProgramSource {
    vertex: "shared/screen.vert",
    fragment: Some("sumi_e/mix.frag"),
    captured: &[],
    uniforms: &[
        "fibres",
        "paper",
        "fibre_strength",
        "paper_axes",
        "paper_origin",
        "interior",
        "silhouette",
        "ground",
    ],
    defined: &[],
};

const WASH: ProgramSource = ProgramSource {
    vertex: "shared/screen.vert",
    fragment: Some("sumi_e/wash.frag"),
    captured: &[],
    uniforms: &[
        "world_from_view",
        "size_px",
        "px_per_unit_at_1",
        "orthographic",
        "tones",
        "shares",
        "normal",
        "depth_and_id",
        "albedo_and_lit",
        "to_light",
        "silhouette",
        "own_tone",
        "seal",
        "line_px",
    ],
    defined: &[],
};

const SOFTEN: ProgramSource = ProgramSource {
    vertex: "shared/screen.vert",
    fragment: Some("sumi_e/soften.frag"),
    captured: &[],
    uniforms: &["picture", "axis", "deviation", "target_px"],
    defined: &[],
};

const RESOLVE: ProgramSource = ProgramSource {
    vertex: "sumi_e/resolve.vert",
    fragment: None,
    captured: &["resolved", "fitted"],
    uniforms: &[
        "size_px",
        "px_per_unit_at_1",
        "orthographic",
        "view_from_world",
        "depth_and_id",
        "shares",
        "soft",
        "pigments",
        "ink",
        "seal",
        "kind",
    ],
    defined: &[],
};

const PAINT: ProgramSource = ProgramSource {
    vertex: "sumi_e/paint.vert",
    fragment: Some("sumi_e/paint.frag"),
    captured: &[],
    uniforms: &[
        "size_px",
        "mark_rows",
        "dryness",
        "brush_marks",
        "depth_and_id",
        "units_per_px_at_1",
        "orthographic",
    ],
    defined: &[],
};

const LAY: ProgramSource = ProgramSource {
    vertex: "shared/screen.vert",
    fragment: Some("sumi_e/lay.frag"),
    captured: &[],
    uniforms: &[
        "fibres",
        "paper",
        "fibre_strength",
        "paper_axes",
        "paper_origin",
        "soft",
        "wide",
        "strokes",
        "ground",
        "ink",
        "seal",
        "amounts",
        "wetness",
        "size_px",
    ],
    defined: &[],
};
