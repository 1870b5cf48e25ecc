//! The data of a sequence of frames: what is to be rendered, a frame that a painter has drawn, and what may go wrong.

use std::io;

use impasto_frame_files::exr_file::Packing;
use impasto_frame_files::picture_file::Provenance;
use impasto_gl_render::context::Driver;
use impasto_gl_render::{Cost, Picture, RenderError, Renderer, ShaderTexts};
use impasto_painting::{FrameOptions, Painting};
use impasto_scene::aovs::AovSet;

/// Which outputs are made from each frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Wanted {
    /// Its pixels.
    pub picture: bool,
    /// A PNG file.
    pub png: Option<PngDepth>,
    /// An EXR file with these AOVs beside the colour, as far as the style has them.
    pub exr: Option<AovSet>,
    /// Whether EXR files are compressed.
    pub packing: Packing,
}

impl Wanted {
    /// A PNG file of 8 bits.
    pub const PNG: Self =
        Self { picture: false, png: Some(PngDepth::Eight), exr: None, packing: Packing::Small };

    /// The pixels alone.
    pub const PICTURE: Self = Self { picture: true, png: None, exr: None, packing: Packing::Small };

    /// The ending of each file's name.
    pub(crate) fn endings(self) -> impl Iterator<Item = &'static str> {
        [self.png.map(|_| "png"), self.exr.map(|_| "exr")].into_iter().flatten()
    }
}

/// Bits of a channel of a PNG file.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum PngDepth {
    /// 8, enough to look at.
    #[default]
    Eight,
    /// 16, for editing the picture further.
    Sixteen,
}

/// What is rendered, and how.
pub struct Sequence {
    /// The scene as prepared.
    pub painting: Painting,
    /// Size of the frames, and how they are painted.
    pub options: FrameOptions,
    /// The scene's file name, which is noted in each file.
    pub scene_name: String,
    /// A hash of all that the frames are made from ([`crate::state`]), noted in each file; empty to note nothing.
    pub state: String,
    /// The driver that each further painter opens, on its own thread. The first painter draws with the caller's
    /// renderer.
    pub driver: Driver,
    /// Shaders that stand in for the program's own; empty to use those.
    pub shaders: ShaderTexts,
    /// Which outputs are made from each frame.
    pub wanted: Wanted,
    /// Whether each pass is timed. That slows frames down, and only one painter works.
    pub timed: bool,
    /// Whether the strokes that were painted are counted.
    pub counted: bool,
}

/// A frame that was drawn.
pub struct Drawn {
    /// Its pixels, where they are wanted.
    pub picture: Option<Picture>,
    /// The bytes of its files, with the ending of each name.
    pub files: Vec<(&'static str, Vec<u8>)>,
    /// How many strokes the frame has, including those too faint to be painted.
    pub strokes: usize,
    /// How many strokes were painted, where they are counted.
    pub painted_strokes: Option<usize>,
    /// What each pass took, where that is timed.
    pub cost: Option<Cost>,
    /// How long the frame took, in seconds.
    pub seconds: f64,
}

/// Why a frame was not rendered.
#[derive(Debug, thiserror::Error)]
pub enum FrameError {
    /// It was not drawn.
    #[error(transparent)]
    Render(#[from] RenderError),
    /// Its file could not be made.
    #[error("the file cannot be made: {0}")]
    Encode(anyhow::Error),
    /// Its file was not written.
    #[error(transparent)]
    Write(#[from] io::Error),
}

/// A frame of the list.
#[derive(Clone, Copy)]
pub(crate) struct Job {
    pub(crate) frame_number: i64,
    /// False where its file exists and is left as it is.
    pub(crate) must_draw: bool,
    /// The frame that comes after it.
    pub(crate) next: Option<i64>,
}

/// What a painter makes of a job; `None` if the frame need not be drawn, or drawing it was given up.
pub(crate) type Painted = Result<Option<Drawn>, FrameError>;

impl Sequence {
    /// The note for a file. `frame` is the number of its frame, or a word for a file that is not one frame, such as
    /// `sheet`.
    pub fn provenance(&self, frame: &str, renderer: &Renderer) -> Provenance {
        let driver = renderer.report().renderer.clone();
        let (scene, state) = (self.scene_name.clone(), self.state.clone());
        Provenance { scene, state, frame: frame.to_owned(), driver }
    }
}
