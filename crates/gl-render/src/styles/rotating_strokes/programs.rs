//! The shader programs of the style, and those that a draft has in their place.

use impasto_painting::Quality;

use crate::gl::{GlError, Gpu, Program, ProgramSource, ShaderFile};
use crate::reference::{LENS_UNIFORMS, LightSetup};
use crate::shader_files::{REFERENCE, ROTATING_STROKES, SHARED};

/// The programs that a draft has of its own.
pub(super) struct StrokePrograms {
    pub(super) resolve: Program,
    pub(super) paint: Program,
    /// For tapered and bent strokes; made when the first of them is painted.
    pub(super) shaped_paint: Option<Program>,
    pub(super) encode: Program,
}

impl StrokePrograms {
    pub(super) fn new(gpu: &Gpu, quality: Quality) -> Result<Self, GlError> {
        let [resolve, paint, encode] = match quality {
            Quality::Exact => [RESOLVE, PAINT, ENCODE],
            Quality::Draft => [
                ProgramSource { defined: DRAFT, ..RESOLVE },
                ProgramSource { defined: DRAFT, uniforms: DRAFT_PAINT_UNIFORMS, ..PAINT },
                ProgramSource { defined: DRAFT, uniforms: DRAFT_ENCODE_UNIFORMS, ..ENCODE },
            ],
        }
        .map(|source| Program::new(gpu, FILES, &source));
        Ok(Self { resolve: resolve?, paint: paint?, shaped_paint: None, encode: encode? })
    }

    /// Makes what tapered and bent strokes need.
    pub(super) fn make_shaped(&mut self, gpu: &Gpu, quality: Quality) -> Result<(), GlError> {
        if self.shaped_paint.is_none() {
            let source = match quality {
                Quality::Exact => ProgramSource { defined: SHAPED, ..PAINT },
                Quality::Draft => {
                    ProgramSource { defined: SHAPED_DRAFT, uniforms: DRAFT_PAINT_UNIFORMS, ..PAINT }
                }
            };
            self.shaped_paint = Some(Program::new(gpu, FILES, &source)?);
        }
        Ok(())
    }
}

/// What their files may include.
pub(super) const FILES: &[&[ShaderFile]] = &[SHARED, REFERENCE, ROTATING_STROKES];

/// What the shaders of a draft find defined.
const DRAFT: &[&str] = &["DRAFT"];
const SHAPED: &[&str] = &["SHAPED"];
const SHAPED_DRAFT: &[&str] = &["SHAPED", "DRAFT"];

const DRAFT_PAINT_UNIFORMS: &[&str] = &[
    "size_px",
    "mark_rows",
    "mark_bounds",
    "brush_marks",
    "depth_and_id",
    "units_per_px_at_1",
    "orthographic",
];

const DRAFT_ENCODE_UNIFORMS: &[&str] = &["picture", "reference_color", "ground", "wash", "finish"];

const RESOLVE: ProgramSource<'static> = ProgramSource {
    vertex: "rotating_strokes/resolve.vert",
    fragment: None,
    captured: &["resolved", "fitted"],
    uniforms: &[
        LENS_UNIFORMS[0],
        LENS_UNIFORMS[1],
        LENS_UNIFORMS[2],
        LENS_UNIFORMS[3],
        LightSetup::UNIFORMS[0],
        LightSetup::UNIFORMS[1],
        LightSetup::UNIFORMS[2],
        LightSetup::UNIFORMS[3],
        LightSetup::UNIFORMS[4],
        LightSetup::UNIFORMS[5],
        LightSetup::UNIFORMS[6],
        LightSetup::UNIFORMS[7],
        "reference_color",
        "depth_and_id",
        "detail",
        "block_px",
        "palettes",
        "view_from_world",
        "px_scale",
        "kind",
    ],
    defined: &[],
};

pub(super) const DETAIL: ProgramSource<'static> = ProgramSource {
    vertex: "shared/screen.vert",
    fragment: Some("rotating_strokes/detail.frag"),
    captured: &[],
    uniforms: &["reference_color", "depth_and_id", "glint", "px_scale", "block_px"],
    defined: &[],
};

pub(super) const SPREAD: ProgramSource<'static> = ProgramSource {
    vertex: "shared/screen.vert",
    fragment: Some("rotating_strokes/spread.frag"),
    captured: &[],
    uniforms: &["detail", "axis"],
    defined: &[],
};

const PAINT: ProgramSource<'static> = ProgramSource {
    vertex: "rotating_strokes/paint.vert",
    fragment: Some("rotating_strokes/paint.frag"),
    captured: &[],
    uniforms: &[
        "size_px",
        "mark_rows",
        "mark_bounds",
        "below",
        "brush_marks",
        "depth_and_id",
        "units_per_px_at_1",
        "orthographic",
    ],
    defined: &[],
};

pub(super) const SOFTEN: ProgramSource<'static> = ProgramSource {
    vertex: "shared/screen.vert",
    fragment: Some("rotating_strokes/soften.frag"),
    captured: &[],
    uniforms: &["height", "step_px"],
    defined: &[],
};

const ENCODE: ProgramSource<'static> = ProgramSource {
    vertex: "shared/screen.vert",
    fragment: Some("rotating_strokes/encode.frag"),
    captured: &[],
    uniforms: &[
        "picture",
        "reference_color",
        "height",
        "soft_height",
        "canvas",
        "ground",
        "tone",
        "wash",
        "to_light",
        "finish",
        "canvas_axes",
        "canvas_origin",
    ],
    defined: &[],
};
