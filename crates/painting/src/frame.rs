//! A frame: one picture as plain data, all that the renderer reads.

use std::sync::Arc;

use glam::{Affine2, DVec3, Mat4, Vec3, Vec4};
use impasto_core::brush::Mark;
use impasto_scene::limits::MAX_PIXELS;

mod line;
mod stroke;

pub use crate::bent::Bent;
pub use crate::body::{BodyMaterial, BodySurface};
pub use crate::body_shape::FrameNoise;
pub use impasto_core::bending::Vertices;
pub use impasto_scene::document::{InkDrawing, InkLight, InkRule, Style, SumiE};
pub use impasto_scene::mesh_file::{Sampler, Wrap};
pub use impasto_scene::presets::LayerKind;
pub use line::{LineStrip, LineVertex, Lines};
pub use stroke::{ANY_COLOR, LayerRun, Mixing, Paint, Stroke, StrokeSource, Strokes};

/// One picture, ready to draw.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Width and height of the picture in pixels.
    pub size_px: [u32; 2],
    /// The height in pixels at which this picture shows what the scene's camera frames, divided by the height that the
    /// scene states. It is 1 if strokes keep their size in pixels. Lengths of strokes and lines are already multiplied
    /// by it, those in `style` are not.
    pub px_scale: f32,
    /// The camera.
    pub view: FrameView,
    /// Linear Rec. 709 colour where nothing is painted; `None` leaves it transparent.
    pub background: Option<[f32; 3]>,
    /// Resolved lights.
    pub lights: FrameLights,
    /// The scene's objects, in the order of the scene file. Body `i` has id `i + 1` in the id target.
    pub bodies: Vec<FrameBody>,
    /// Strokes in painting order: sorted by the layer of their region, then by layer of paint, then by rank from high
    /// to low. Touches come last, in the scene's order.
    pub strokes: Vec<Stroke>,
    /// Where each stroke comes from, parallel to `strokes`.
    pub sources: Vec<StrokeSource>,
    /// Runs of `strokes` that belong to one layer, in painting order.
    pub layers: Vec<LayerRun>,
    /// The lines of touches, which are strokes placed by hand.
    pub lines: Lines,
    /// The marks of the brushes in use; shared between frames.
    pub brushes: Arc<Brushes>,
    /// The palettes that strokes are mixed from.
    pub palettes: Arc<Vec<Palette>>,
    /// Canvas, relief and varnish.
    pub finish: Finish,
    /// How to draw, with the settings of that style.
    pub style: Style,
    /// Whether highlights have strokes of their own, anywhere in the painting.
    pub has_highlight_strokes: bool,
    /// Exact, or a quick draft.
    pub quality: Quality,
    /// A factor on the linear colours of the finished picture, before they are encoded; 1 leaves it as it is.
    pub exposure: f32,
}

/// The pigments that strokes are mixed from.
#[derive(Clone, Debug, PartialEq)]
pub struct Palette {
    /// Linear Rec. 709; at least one, at most 16.
    pub pigments: Vec<[f32; 3]>,
    /// How far colours keep to the pigments, 0..=1.
    pub mix: f32,
}

impl Frame {
    /// The background as a premultiplied colour; transparent where there is none.
    pub fn background_premultiplied(&self) -> Vec4 {
        self.background.map_or(Vec4::ZERO, |[r, g, b]| Vec4::new(r, g, b, 1.0))
    }

    /// How many samples a pixel has along each axis: one in drafts, and where the samples of a very large picture would
    /// take too much memory, or would need a texture with a side above `most_side_px`.
    pub fn samples(&self, most_side_px: u32) -> u32 {
        match self.quality {
            Quality::Exact => samples_that_fit(self.finish.samples, self.size_px, most_side_px),
            Quality::Draft => 1,
        }
    }

    /// Replaces the strokes.
    pub fn lay(&mut self, strokes: Strokes) {
        let Strokes { strokes, sources, layers, lines } = strokes;
        (self.strokes, self.sources, self.layers, self.lines) = (strokes, sources, layers, lines);
    }
}

/// How many samples a pixel of an exact picture of this size has along each axis. That is `wanted`; but it is 1 if so
/// many would take too much memory, or would need a texture with a side above `most_side_px`.
pub fn samples_that_fit(wanted: u32, size_px: [u32; 2], most_side_px: u32) -> u32 {
    let [width, height] = size_px.map(|side| u64::from(side) * u64::from(wanted));
    let fits = width.max(height) <= u64::from(most_side_px) && width * height <= MAX_PIXELS;
    if fits { wanted } else { 1 }
}

/// Exact, or a quick draft.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Quality {
    /// The quality of pictures in files: a frame gives the same bits whatever was drawn before it.
    #[default]
    Exact,
    /// For a view that moves: strokes at the same places, but with flat paint and fewer texture taps. Faint strokes
    /// are left out, and in some paintings the underpainting too.
    Draft,
}

/// The camera of a frame.
#[derive(Clone, Copy, Debug)]
pub struct FrameView {
    /// The point of the scene's world space that is the origin of the frame's world space. Single precision is finest
    /// there. It is 0, except in scenes that lie far from the world's own origin. It is the same in all frames of a
    /// painting.
    pub origin_in_world: DVec3,
    /// Right-handed, looks down −Z.
    pub view_from_world: Mat4,
    /// OpenGL clip space, depth −1..1.
    pub clip_from_view: Mat4,
    /// Eye in world space. With an orthographic lens it is still the eye of the camera's pose.
    pub eye_in_world: Vec3,
    /// Whether rays are parallel.
    pub orthographic: bool,
    /// Nearest and farthest visible depth along the gaze, world units.
    pub near_far: [f32; 2],
}

/// Lights of a frame. Colours are linear Rec. 709, already multiplied by the intensity and the scene's exposure.
#[derive(Clone, Debug, Default)]
pub struct FrameLights {
    /// Parallel lights; the first one casts shadows.
    pub suns: Vec<SunLight>,
    /// Point lights, inverse square.
    pub points: Vec<PointLight>,
    /// Index of the point light that casts shadows; `None` where a sun casts them, or where there is no point light.
    pub shadow_lamp: Option<usize>,
    /// Ambient light on a surface that faces up.
    pub ambient_above: Vec3,
    /// Ambient light on a surface that faces down.
    pub ambient_below: Vec3,
    /// The sphere (centre, radius) that the shadow map covers, the same in every frame. Usually it holds all
    /// bodies at sampled frames of the timeline. Where a much smaller sphere holds nearly all that the camera sees,
    /// that smaller one is used.
    pub shadow_bounds: (Vec3, f32),
}

/// A parallel light.
#[derive(Clone, Copy, Debug)]
pub struct SunLight {
    /// Unit vector towards the light, world space.
    pub to_light: Vec3,
    /// Linear colour times intensity.
    pub radiance: Vec3,
}

/// A point light.
#[derive(Clone, Copy, Debug)]
pub struct PointLight {
    /// World space.
    pub position: Vec3,
    /// Linear colour times intensity at distance 1.
    pub radiance: Vec3,
    /// The cone that it shines into; `None`: to all sides.
    pub cone: Option<Cone>,
}

/// The cone of a spot, with a soft edge.
#[derive(Clone, Copy, Debug)]
pub struct Cone {
    /// The direction in which its middle shines, world space, unit length.
    pub axis: Vec3,
    /// Cosine of the angle from the axis to where the light begins to fade.
    pub inner_cosine: f32,
    /// Cosine of the angle from the axis to where the light ends.
    pub outer_cosine: f32,
}

/// One object at one time.
#[derive(Clone, Debug)]
pub struct FrameBody {
    /// A hidden body is not drawn and casts no shadow, but keeps its id.
    pub hidden: bool,
    /// Whether it is a built-in backdrop or patch of floor: the ink style leaves the paper bare there.
    pub is_backdrop: bool,
    /// The surface. It is shared between frames, so that a renderer may cache what it uploads by the address of the
    /// `Arc`.
    pub surface: Arc<BodySurface>,
    /// Pose.
    pub world_from_model: Mat4,
    /// Where its vertices are; `None` at rest.
    pub bent: Option<Arc<Bent>>,
    /// Its noise, which may colour it. If it moves vertices, `bent` holds their positions with the noise applied.
    pub noise: Option<FrameNoise>,
}

impl FrameBody {
    /// Whether it is drawn: neither hidden, nor coloured by noise that is wholly transparent.
    pub fn shows(&self) -> bool {
        let layers = self.noise.as_ref().and_then(|noise| noise.noise.layers.as_ref());
        !self.hidden && layers.is_none_or(|layers| layers.opacity > 0.0)
    }
}

/// The marks of the brushes in use.
#[derive(Debug, Default, PartialEq)]
pub struct Brushes {
    /// Names, as the scene has them.
    pub names: Vec<String>,
    /// [`impasto_core::brush::VARIANTS`] marks for each.
    pub marks: Vec<Arc<Vec<Mark>>>,
}

/// The ground and the canvas under the paint, and the paint's relief and varnish.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Finish {
    /// The tone under the first layer of paint where a body is; `None` if nothing lies under the paint there.
    pub ground: Option<Ground>,
    /// How much the weave of the canvas shows where paint is thin; 0 for a board.
    pub weave: f32,
    /// From positions in the picture to pixels of the canvas. Positions are counted from the picture's middle, in
    /// pixels divided by [`Frame::px_scale`].
    pub canvas_from_px: Affine2,
    /// How many samples a pixel of an exact picture should have along each axis: see [`Frame::samples`].
    pub samples: u32,
    /// Height of the paint; 1 is oil.
    pub relief: f32,
    /// Unit vector towards the light on the relief, in the picture's space (X right, Y up, Z towards the eye). The same
    /// in every frame, as if the picture hung in a room.
    pub to_relief_light: [f32; 3],
    /// Strength of the varnish.
    pub varnish: f32,
}

/// The ground: the tone under the paint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ground {
    /// Linear Rec. 709.
    pub color: [f32; 3],
    /// How far the tone covers the wash of each body's own colour, 0..=1.
    pub hides: f32,
}

impl Default for Finish {
    /// Flat paint on a bare board.
    fn default() -> Self {
        Self {
            ground: None,
            weave: 0.0,
            canvas_from_px: Affine2::IDENTITY,
            samples: 1,
            relief: 0.0,
            to_relief_light: [0.0, 0.0, 1.0],
            varnish: 0.0,
        }
    }
}
