//! The shader programs of the style, and those that drafts use instead.

use impasto_painting::Quality;
use impasto_painting::frame::LayerKind;

use crate::gl::{GlError, Gpu, Program, ProgramSource, ShaderFile};
use crate::lens::{LENS_UNIFORMS, RAY_UNIFORMS};
use crate::lighting::LIGHT_UNIFORMS;
use crate::shader_files::{REFERENCE, ROTATING_STROKES, SHARED};

/// The programs that differ between exact pictures and drafts.
pub(super) struct StrokePrograms {
    /// These programs find colour, presence and place of a layer's strokes. For each layer, in the order of their
    /// numbers, there is one program without palettes and one with them. A program is created when it is first needed.
    /// It leaves out what its layer does not need, since software drivers do the work of all branches.
    resolve: [[Option<Program>; 2]; LAYERS.len()],
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

    /// The program that resolves the strokes of a layer, if it is ready.
    pub(super) fn resolve(&self, layer: LayerKind, has_palettes: bool) -> Option<&Program> {
        self.resolve[layer as usize][usize::from(has_palettes)].as_ref()
    }

    /// Creates the program that resolves the strokes of a layer, unless it is there.
    pub(super) fn ready_resolve(
        &mut self,
        (gpu, quality): (&Gpu, Quality),
        layer: LayerKind,
        has_palettes: bool,
    ) -> Result<(), GlError> {
        let program = &mut self.resolve[layer as usize][usize::from(has_palettes)];
        if program.is_none() {
            let mut defined = vec![LAYERS[layer as usize].1];
            defined.extend(has_palettes.then_some("PALETTES"));
            defined.extend((quality == Quality::Draft).then_some("DRAFT"));
            *program = Some(Program::new(gpu, FILES, &ProgramSource { defined: &defined, ..RESOLVE })?);
        }
        Ok(())
    }

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

/// The files that the style's shaders may include.
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

/// The layers in the order of their numbers, each with what is `#define`d for the program that resolves its strokes.
pub(super) const LAYERS: [(LayerKind, &str); 8] = [
    (LayerKind::Underpainting, "LAYER 0"),
    (LayerKind::Body, "LAYER 1"),
    (LayerKind::Form, "LAYER 2"),
    (LayerKind::Scumble, "LAYER 3"),
    (LayerKind::Accents, "LAYER 4"),
    (LayerKind::Contour, "LAYER 5"),
    (LayerKind::Lights, "LAYER 6"),
    (LayerKind::Touches, "LAYER 7"),
];

const RESOLVE: ProgramSource<'static> = ProgramSource {
    captured: &["resolved", "fitted"],
    // Strokes of highlights are not lit themselves, and some layers do not look for detail.
    optional: &[&LENS_UNIFORMS, &LIGHT_UNIFORMS, &["highlight", "detail", "block_px", "palettes"]],
    ..ProgramSource::new(
        "rotating_strokes/resolve.vert",
        None,
        &[&["reference_color", "depth_and_id", "normal", "view_from_world", "px_scale"]],
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
        &["normal"],
        &RAY_UNIFORMS,
    ],
    ..DRAFT_FINISH
};

/// Drafts lay flat paint.
const DRAFT_FINISH: ProgramSource<'static> =
    ProgramSource::screen("rotating_strokes/finish.frag", &[FINISH_UNIFORMS]);
