//! Reads a drawn picture as channels of an EXR file: its colour and its AOVs, which are data of the scene, data of the
//! paint, layers and mattes.
//!
//! ```text
//! a renderer's last picture ─▶ of_scene: depth, normals, motion, light   (any style)
//!                           └▶ covering: which strokes show in each pixel ─▶ of_strokes, cryptomatte
//!                           └▶ of_paint: colour, height, normal and wetness of the paint
//!                           └▶ layers: each layer of paint as a picture     (styles of strokes)
//! ```

mod covering;
pub mod cryptomatte;
mod drawn;
mod layers;
mod of_paint;
mod of_scene;
mod of_strokes;
mod planes;

use impasto_frame_files::exr_file::{Channel, Samples};
use impasto_gl_render::{RenderError, Renderer};
use impasto_painting::Quality;
use impasto_scene::aovs::Aov;

use covering::Covering;

pub use drawn::{Drawn, Found};
pub use of_scene::OF_SURFACES;

/// The AOVs that need the paint's fragments: the renderer must gather paint (`Renderer::gather_paint`) while it draws
/// the picture.
pub const GATHERED: &[Aov] = &[
    Aov::StrokeId,
    Aov::StrokeAngle,
    Aov::StrokeKappa,
    Aov::StrokeRank,
    Aov::StrokeLayer,
    Aov::PaintColor,
    Aov::PaintHeight,
    Aov::PaintNormal,
    Aov::PaintWetness,
    Aov::PaintAlpha,
    Aov::Layers,
    Aov::CryptoObject,
    Aov::CryptoMaterial,
    Aov::CryptoRegion,
    Aov::CryptoStroke,
];

/// Reads the colour of a renderer's last picture, which must be of this frame, and the AOVs that are wanted. Those of
/// [`GATHERED`] are left out if the frame's quality is not exact.
///
/// # Errors
/// When the driver complains.
pub fn read(renderer: &mut Renderer, drawn: &Drawn<'_>) -> Result<Found, RenderError> {
    let has = drawn.painting.scene().style.settings().aovs();
    let wanted = drawn.wanted.shared(has);
    let mut found = Found::default();
    let linear = renderer.read_linear();
    color("", linear.iter().map(|&[r, g, b, a]| [r * a, g * a, b * a, a]), &mut found.channels);
    if wanted.has_any(GATHERED) && drawn.frame.quality == Quality::Exact {
        let layers = renderer.take_layers();
        let surface = renderer.read_paint_surface();
        if let Some(surface) = &surface {
            of_paint::add(wanted, surface, &mut found);
            if wanted.has(Aov::Layers) {
                layers::add(drawn, &layers, surface, &linear, &mut found);
            }
            let covering = Covering::new(drawn, layers, surface, renderer.read_reference());
            of_strokes::add(drawn, wanted, &covering, renderer, &mut found);
            covering.add_mattes(drawn, wanted, &mut found);
        }
    }
    drop(linear);
    of_scene::add(renderer, drawn, wanted, &mut found)?;
    Ok(found)
}

/// Adds the channels R, G, B and A. Their names begin with `layer`, which is empty for the picture itself.
fn color(layer: &str, pixels: impl Iterator<Item = [f32; 4]>, channels: &mut Vec<Channel>) {
    let mut planes: [Vec<half::f16>; 4] = Default::default();
    for pixel in pixels {
        for (plane, value) in planes.iter_mut().zip(pixel) {
            plane.push(half::f16::from_f32(value));
        }
    }
    for (letter, plane) in ["R", "G", "B", "A"].iter().zip(planes) {
        channels.push(Channel::new(format!("{layer}{letter}"), Samples::Half(plane)));
    }
}
