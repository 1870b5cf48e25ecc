//! The options of a frame: what may be chosen besides its camera and its time.

use crate::frame::Quality;

/// How a frame of a painting is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FrameOptions {
    /// Width and height of the picture, each at least 1.
    pub size_px: [u32; 2],
    /// Height of the shot in pixels, > 0, if the picture shows more than the shot, as an editor's view does. Strokes
    /// are then as large as in a picture of this height. `None` if the picture is the shot.
    pub shot_height_px: Option<f32>,
    /// Strokes keep their size in pixels, whatever the picture's height.
    pub keep_stroke_px: bool,
    /// No background: where nothing is painted, the picture is transparent.
    pub transparent: bool,
    /// Whether strokes turn.
    pub rotation: Rotation,
    /// What strokes are coloured by.
    pub colors: StrokeColors,
    /// How much care to take.
    pub quality: Quality,
    /// How much brighter a display shows the finished picture, in stops: 1 is twice the light.
    pub exposure_stops: f32,
}

/// What strokes are coloured by.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum StrokeColors {
    /// The scene, lit and mixed.
    #[default]
    Scene,
    /// How far each turn can be trusted (κ): from green, where a rotation describes how the surface has moved in the
    /// picture, through yellow to red, where it does not.
    Trust,
}

/// Whether strokes turn with the surface under them. All but `On` exist for comparison.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Rotation {
    /// They do.
    #[default]
    On,
    /// They keep the angle that they have in the reference pose. The scene then moves behind a fixed pattern (the
    /// shower-door effect).
    Off,
    /// They have random angles, new ones in each frame.
    Random,
    /// They are mapped to the surface like a texture: foreshortened, and smaller with distance (the source paper's
    /// figure 2).
    Mapped,
}

impl FrameOptions {
    /// Height of the shot in the picture, pixels.
    pub(crate) fn shot_height_px(&self) -> f32 {
        self.shot_height_px.unwrap_or(self.size_px[1] as f32)
    }

    /// A picture of this size, with the defaults for all else.
    pub const fn new(size_px: [u32; 2]) -> Self {
        Self {
            size_px,
            shot_height_px: None,
            keep_stroke_px: false,
            transparent: false,
            rotation: Rotation::On,
            colors: StrokeColors::Scene,
            quality: Quality::Exact,
            exposure_stops: 0.0,
        }
    }
}
