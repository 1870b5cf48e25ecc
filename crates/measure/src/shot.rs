//! What a pass over every frame of a shot finds: chatter, steps and flicker, as a whole and frame by frame.

use crate::chatter::Chatter;
use crate::flicker::Flicker;
use crate::steps::Steps;

/// What was found on a whole shot.
#[derive(Clone, Debug, Default)]
pub struct WholeShot {
    /// The result of metric M15.
    pub chatter: Chatter,
    /// The result of metric M16.
    pub steps: Steps,
    /// The result of metric M17.
    pub flicker: Flicker,
    /// Flicker of plain renders without strokes. It comes from moving edges and shadows alone.
    pub plain_flicker: Flicker,
    /// How many frames were drawn.
    pub frames: usize,
    /// Frames, each with the percentage of its strokes that chatter.
    pub chatter_by_frame: Vec<(f64, f64)>,
    /// Frames, each with its number of steps.
    pub steps_by_frame: Vec<(f64, f64)>,
    /// Frames, each with the percentage of its pixels that flicker.
    pub flicker_by_frame: Vec<(f64, f64)>,
}
