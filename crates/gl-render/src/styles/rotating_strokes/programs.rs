//! The shader programs of the style, and those that drafts use instead.

use impasto_painting::Quality;
use impasto_painting::frame::LayerKind;

use crate::gl::{GlError, Gpu, Program, ProgramSource, ShaderFile};
use crate::lens::LENS_UNIFORMS;
use crate::lighting::LIGHT_UNIFORMS;
use crate::shader_files::{REFERENCE, ROTATING_STROKES, SHARED};

/// The programs that differ between exact pictures and drafts.
pub(super) struct StrokePrograms {
    /// For each layer, in the order of their numbers; created when the layer is first painted. What a layer does not need is
    /// left out of its program: some drivers do all work of all branches.
    pub(super) resolve: [Option<Program>; 8],
    pub(super) paint: Program,
    /// For tapered and bent strokes; created when the first of them is painted.
    pub(super) shaped_paint: Option<Program>,
    /// For lines; created when the first of them is painted.
    pub(super) line_paint: Option<Program>,
    pub(super) finish: Program,
}

impl StrokePrograms {
    pub(super) fn new(gpu: &Gpu, quality: Quality) -> Result<Self, GlError> {
        let [paint, finish] = match quality {
            Quality::Exact => [PAINT, FINISH],
            Quality::Draft => [
                ProgramSource { defined: &["DRAFT"], ..DRAFT_PAINT },
                ProgramSource { defined: &["DRAFT"], ..DRAFT_FINISH },
            ],
        }
        .map(|source| Program::new(gpu, FILES, &source));
        Ok(Self {
            resolve: Default::default(),
            paint: paint?,
            shaped_paint: None,
            line_paint: None,
            finish: finish?,
        })
    }

    /// Creates the program that finds where the strokes of a layer lie, unless it is there.
    pub(super) fn ready_resolve(&mut self, gpu: &Gpu, quality: Quality, layer: LayerKind) -> Result<(), GlError> {
        let program = &mut self.resolve[layer as usize];
        if program.is_none() {
            let defined = [ONLY[layer as usize], "DRAFT"];
            let defined = if quality == Quality::Draft { &defined[..] } else { &defined[..1] };
            *program = Some(Program::new(gpu, FILES, &ProgramSource { defined, ..RESOLVE })?);
        }
        Ok(())
    }

    /// Creates the program for tapered and bent strokes, unless it is there.
    pub(super) fn ready_shaped(&mut self, gpu: &Gpu, quality: Quality) -> Result<(), GlError> {
        if self.shaped_paint.is_none() {
            let source = match quality {
                Quality::Exact => ProgramSource { defined: &["SHAPED"], ..PAINT },
                Quality::Draft => ProgramSource { defined: &["SHAPED", "DRAFT"], ..DRAFT_PAINT },
            };
            self.shaped_paint = Some(Program::new(gpu, FILES, &source)?);
        }
        Ok(())
    }

    /// Creates the program for lines, unless it is there.
    pub(super) fn ready_line(&mut self, gpu: &Gpu, quality: Quality) -> Result<(), GlError> {
        if self.line_paint.is_none() {
            let source = match quality {
                Quality::Exact => LINE_PAINT,
                Quality::Draft => {
                    ProgramSource { uniforms: &[PAINT_UNIFORMS], defined: &["LINE", "DRAFT"], ..DRAFT_PAINT }
                }
            };
            self.line_paint = Some(Program::new(gpu, FILES, &source)?);
        }
        Ok(())
    }
}

/// The programs of a picture whose paint is gathered.
pub(super) struct DataPrograms {
    /// As [`StrokePrograms::paint`], and notes every fragment.
    pub(super) paint: Program,
    pub(super) shaped_paint: Program,
    pub(super) line_paint: Program,
    /// As [`StrokePrograms::finish`], and writes the paint's surface.
    pub(super) finish: Program,
}

impl DataPrograms {
    pub(super) fn new(gpu: &Gpu) -> Result<Self, GlError> {
        let paint = ProgramSource {
            uniforms: &[PAINT_UNIFORMS, OF_BILLBOARDS, OF_EXACT, &["first_stroke"]],
            ..PAINT
        };
        let line_paint =
            ProgramSource { uniforms: &[PAINT_UNIFORMS, OF_EXACT, &["first_stroke"]], ..LINE_PAINT };
        let [paint, shaped_paint, line_paint, finish] = [
            ProgramSource { defined: &["STORES"], ..paint },
            ProgramSource { defined: &["SHAPED", "STORES"], ..paint },
            ProgramSource { defined: &["LINE", "STORES"], ..line_paint },
            ProgramSource { defined: &["DATA"], ..FINISH },
        ]
        .map(|source| Program::new(gpu, FILES, &source));
        Ok(Self { paint: paint?, shaped_paint: shaped_paint?, line_paint: line_paint?, finish: finish? })
    }
}

/// The shader files that the style's own may include.
pub(super) const FILES: &[&[ShaderFile]] = &[SHARED, REFERENCE, ROTATING_STROKES];

pub(super) const DETAIL: ProgramSource<'static> = ProgramSource::screen(
    "rotating_strokes/detail.frag",
    &[&[
        "reference_color",
        "depth_and_id",
        "fine",
        "samples",
        "glint",
        "normal",
        "px_scale",
        "view_from_world",
        "block_px",
    ]],
);

pub(super) const SPREAD: ProgramSource<'static> =
    ProgramSource::screen("rotating_strokes/spread.frag", &[&["detail", "axis"]]);

const ONLY: [&str; 8] =
    ["ONLY 0", "ONLY 1", "ONLY 2", "ONLY 3", "ONLY 4", "ONLY 5", "ONLY 6", "ONLY 7"];

const RESOLVE: ProgramSource<'static> = ProgramSource {
    captured: &["resolved", "fitted"],
    // Strokes of highlights are not lit themselves, and some layers do not look for detail.
    optional: &[&LENS_UNIFORMS, &LIGHT_UNIFORMS, &["highlight", "detail", "block_px"]],
    ..ProgramSource::new(
        "rotating_strokes/resolve.vert",
        None,
        &[&["reference_color", "depth_and_id", "normal", "palettes", "view_from_world", "px_scale"]],
    )
};

const PAINT_UNIFORMS: &[&str] =
    &["size_px", "mark_rows", "mark_bounds", "brush_marks", "surface", "units_per_px_at_1", "orthographic"];

/// What a billboard needs, and a line does not.
const OF_BILLBOARDS: &[&str] = &["view_from_world", "kind", "gaze_px", "px_per_unit_at_1"];

const OF_EXACT: &[&str] = &["below", "depth_and_id"];

const PAINT: ProgramSource<'static> =
    ProgramSource { uniforms: &[PAINT_UNIFORMS, OF_BILLBOARDS, OF_EXACT], ..DRAFT_PAINT };

const LINE_PAINT: ProgramSource<'static> =
    ProgramSource { uniforms: &[PAINT_UNIFORMS, OF_EXACT], defined: &["LINE"], ..DRAFT_PAINT };

/// Drafts pick up no paint.
const DRAFT_PAINT: ProgramSource<'static> = ProgramSource::new(
    "rotating_strokes/paint.vert",
    Some("rotating_strokes/paint.frag"),
    &[PAINT_UNIFORMS, OF_BILLBOARDS],
);

pub(super) const SOFTEN: ProgramSource<'static> =
    ProgramSource::screen("rotating_strokes/soften.frag", &[&["height", "step_px"]]);

const FINISH_UNIFORMS: &[&str] = &["picture", "reference_color", "background", "wash", "finish"];

const FINISH: ProgramSource<'static> = ProgramSource {
    uniforms: &[
        FINISH_UNIFORMS,
        &["surface", "height", "soft_height", "canvas", "tone", "to_light", "canvas_axes", "canvas_origin"],
    ],
    ..DRAFT_FINISH
};

/// Drafts lay flat paint.
const DRAFT_FINISH: ProgramSource<'static> =
    ProgramSource::screen("rotating_strokes/finish.frag", &[FINISH_UNIFORMS]);
