//! The strokes of a frame, in the layout in which they go to the GPU.

use bytemuck::{Pod, Zeroable};
use impasto_core::presence;
use impasto_scene::presets::LayerKind;

use super::Lines;

/// The palette index of strokes that have no palette.
pub const ANY_COLOR: u8 = 255;

/// One brush stroke. Pixels, origin at the lower left, Y up.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Stroke {
    /// Centre in pixels, origin at the lower left corner of the picture.
    pub center_px: [f32; 2],
    /// Depth along the gaze, world units, positive in front.
    pub depth: f32,
    /// Counter-clockwise from +X, radians in (−π, π].
    pub angle_rad: f32,
    /// Length in output pixels.
    pub length_px: f32,
    /// Width in output pixels.
    pub width_px: f32,
    /// Fades strokes out before their surface turns away: 0 edge-on .. 1.
    pub facing_fade: f32,
    /// ln(D/u). u is the rank of the particle. D is the supply: the strokes wanted per pixel, if the layer is wanted in
    /// full, divided by the particles per pixel. Where strokes fade, D is greater, to make up for that. If this number
    /// is 0, half of the stroke is there, before `facing_fade`.
    pub supply_ln: f32,
    /// Random bits of the stroke, the same in every frame.
    pub bits: u32,
    /// Id of the body in the id target (index in `Frame::bodies` plus 1).
    pub body_id: u32,
    /// Albedo at the stroke, sRGB encoded, 8 bits a channel, as 0xAABBGGRR. A is 0 for unlit surfaces. A is
    /// [`Stroke::AS_IT_IS`] if the stroke is painted in exactly this colour.
    pub albedo_srgb8: u32,
    /// Index of the mark in [`super::Frame::brushes`], counted over all brushes; the bit [`Stroke::FLIPPED`] flips it.
    pub mark: u32,
    /// The paint.
    pub paint: Paint,
    /// How the colour is mixed.
    pub mixing: Mixing,
    /// Unit surface normal in world space.
    pub normal_in_world: [f32; 3],
    /// How far the mark is bowed: its ends lie 0.176 × `bow` half widths to the left of its middle, or to the right
    /// where it is flipped.
    pub bow: f32,
    /// How far paint may run past its own body, output pixels; from [`Stroke::FREE`] on without limit.
    pub overrun_px: f32,
    /// Slow drifts over the surface, of hue and of how firm the body's edge is; mean 0, standard deviation 1.
    pub drift: [f32; 2],
    /// How far the stroke's left side is pushed forward against its right side, as a share of its width; 0 for a
    /// billboard.
    pub skew: f32,
    /// −1..=1: the stroke is (1 + taper) times `width_px` wide at its start and (1 − taper) times at its end.
    pub taper: f32,
    /// How far the stroke turns to its left from start to end, radians; its middle lies at `angle_rad`. At most
    /// [`Stroke::most_bend_rad`] either way.
    pub bend_rad: f32,
}

/// What the paint of a stroke is like, a byte each.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct Paint {
    /// Opacity times 255.
    pub opacity: u8,
    /// Thickness times [`Paint::THICKNESS_SCALE`].
    pub thickness: u8,
    /// How much wet paint is picked up, times 255.
    pub pickup: u8,
    /// Share of the mark that is left out, times 255.
    pub dryness: u8,
}

/// How the colour of a stroke is mixed, a byte each.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
pub struct Mixing {
    /// Factor on how much colours differ from stroke to stroke, times [`Mixing::SCALE`].
    pub jitter: u8,
    /// Factor on the temperature, times [`Mixing::SCALE`].
    pub temperature: u8,
    /// How far colours are graded towards a painter's values, times 255.
    pub grading: u8,
    /// Row of [`super::Frame::palettes`], or [`ANY_COLOR`].
    pub palette: u8,
}

impl Paint {
    /// The value of the byte for a thickness of 1.
    pub const THICKNESS_SCALE: f32 = 50.0;
}

impl Mixing {
    /// The value of a byte for a factor of 1.
    pub const SCALE: f32 = 25.5;
}

impl Default for Stroke {
    /// A whole, opaque stroke of the first brush, of no size and mixed without randomness.
    fn default() -> Self {
        Self {
            facing_fade: 1.0,
            supply_ln: 8.0,
            paint: Paint { opacity: 255, ..Paint::default() },
            mixing: Mixing { palette: ANY_COLOR, ..Mixing::zeroed() },
            ..Self::zeroed()
        }
    }
}

impl Stroke {
    /// The bit of [`Stroke::mark`] that flips the mark across.
    pub const FLIPPED: u32 = 1 << 16;

    /// The overrun of strokes that are not clipped to their body.
    pub const FREE: f32 = 1e6;

    /// The A in [`Stroke::albedo_srgb8`] of a stroke that is painted in exactly that colour.
    pub const AS_IT_IS: u8 = 128;

    /// The most that a stroke can bend, radians: half a turn, or less where its inner edge would come near the centre
    /// of the arc.
    pub fn most_bend_rad(&self) -> f32 {
        const CLOSEST: f32 = 0.9;
        let half_quad_px = 0.5 * self.width_px * (1.0 + self.taper.abs()) / impasto_core::brush::FILL;
        (CLOSEST * self.length_px / half_quad_px.max(1e-6)).min(std::f32::consts::PI)
    }

    /// Whether it tapers or bends.
    pub fn is_shaped(&self) -> bool {
        self.taper != 0.0 || self.bend_rad != 0.0
    }

    /// How much of the stroke is there, 0..=1, if its layer is wanted in full and nothing hides it. The resolve shader
    /// computes the same.
    pub fn presence(&self) -> f32 {
        presence::of_supply(self.supply_ln) * self.facing_fade
    }
}

/// Where a stroke comes from, and how far its angle can be trusted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrokeSource {
    /// Index of the particle in the painting order of all particles; `u32::MAX` for a touch.
    pub place: u32,
    /// Index of the particle in the progressive order of its object's layer; of a touch, its index in the scene.
    pub particle: u32,
    /// Index of the region in the scene; `regions.len()` for the implicit one.
    pub region: u32,
    /// κ in 0..=1: how well a rotation describes how the surface has moved in the picture (1 = wholly).
    pub kappa: f32,
    /// Cosine between the surface normal and the direction to the eye.
    pub facing: f32,
    /// Rank in (0, 1]: low ranks stay longest when strokes thin out. 0 for a touch.
    pub rank: f32,
}

/// All strokes of a frame.
#[derive(Clone, Debug, Default)]
pub struct Strokes {
    /// In painting order.
    pub strokes: Vec<Stroke>,
    /// Where each comes from, parallel to `strokes`.
    pub sources: Vec<StrokeSource>,
    /// Runs of `strokes` that belong to one layer, in painting order.
    pub layers: Vec<LayerRun>,
    /// The lines of touches, which are strokes placed by hand.
    pub lines: Lines,
}

/// A run of strokes of one layer of paint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LayerRun {
    /// The `layer` of the strokes' region: lower ones lie below.
    pub order: i32,
    /// Which layer.
    pub kind: LayerKind,
    /// Index of the first stroke.
    pub first: u32,
    /// How many strokes.
    pub count: u32,
}
