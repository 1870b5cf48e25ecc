//! The results of drawing: pictures, strokes as they were painted, data of every pixel, and what the drawing cost.

use half::f16;

/// A finished picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Width and height in pixels.
    pub size_px: [u32; 2],
    /// sRGB bytes with straight alpha, four a pixel, top row first.
    pub rgba8: Vec<u8>,
}

/// A stroke as it was painted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ResolvedStroke {
    /// Display-linear colour.
    pub color_linear: [f32; 3],
    /// How much of the stroke is there, 0..=1; less where bodies hide it.
    pub alpha: f32,
    /// Centre in pixels, origin at the lower left, as painted. Strokes were moved along themselves onto their bodies,
    /// unless their edges are free. A contour stroke was also moved to its body's outline, a highlight stroke towards
    /// the highlight's peak, and a stroke on a thin part to the middle of that part.
    pub center_px: [f32; 2],
    /// What was added to the stroke's angle, radians: a contour stroke is turned to run along its body's outline.
    pub turned_rad: f32,
}

/// What a picture cost to draw.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Cost {
    /// The passes, in order. A layer of paint that is laid in several runs is listed several times.
    pub passes: Vec<PassTime>,
    /// How many strokes laid paint on a pixel, on average.
    pub overdraw: f64,
}

/// How long a pass took.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PassTime {
    /// The pass, or the layer of paint.
    pub name: &'static str,
    /// Wall clock seconds.
    pub seconds: f64,
}

/// The reference picture as numbers, top row first.
#[derive(Clone, Debug, PartialEq)]
pub struct ReferencePixels {
    /// Depth along the gaze in world units; 0 where nothing is.
    pub depth: Vec<f32>,
    /// Index of the body plus 1; 0 where nothing is.
    pub body_id: Vec<u32>,
}

/// The surfaces that the last picture shows, top row first.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfacePixels {
    /// Colour without light, linear Rec. 709; the last number is 1 where the surface is lit, 0 where it is unlit.
    pub albedo: Vec<[f16; 4]>,
    /// Unit normal in world space, towards the eye; 0 on bodies whose colour a noise-displaced material makes. The last
    /// number is the gloss.
    pub normal: Vec<[f16; 4]>,
    /// Light that falls on the surface. The last number is the share of the shadow-casting light that is not in shadow,
    /// 0..=1.
    pub light: Vec<[f16; 4]>,
    /// Ambient occlusion: how open the place is, 0..=1.
    pub openness: Vec<f16>,
}

/// The paint's own surface in the last picture, top row first.
#[derive(Clone, Debug, PartialEq)]
pub struct PaintSurface {
    /// Paint and ground before the light of the room falls on them, premultiplied, display-linear.
    pub flat: Vec<[f16; 4]>,
    /// Unit normal (X right, Y up, Z towards the eye), and height in brush thicknesses.
    pub normal_and_height: Vec<[f16; 4]>,
    /// How far the paint runs together with its neighbours, 0..=1.
    pub wetness: Vec<f32>,
    /// Whether a pixel is a mean over its neighbours, because a body ends there.
    pub is_border: Vec<bool>,
    /// What lies under the paint, premultiplied, display-linear.
    pub ground: Vec<[f16; 4]>,
}
