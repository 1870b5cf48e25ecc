//! The AOVs of the paint as a surface: its colour before its relief is lit, its height, its normal, how wet it is.

use half::f16;
use impasto_frame_files::exr_file::{Channel, Samples};
use impasto_gl_render::PaintSurface;
use impasto_scene::aovs::{Aov, AovSet};

use crate::drawn::Found;

pub(crate) fn add(wanted: AovSet, surface: &PaintSurface, found: &mut Found) {
    let plane =
        |pixels: &[[f16; 4]], at: usize| Samples::Half(pixels.iter().map(|pixel| pixel[at]).collect());
    let mut add = |name: &str, samples: Samples| found.channels.push(Channel::new(name, samples));
    if wanted.has(Aov::PaintColor) {
        for (at, name) in ["R", "G", "B", "A"].into_iter().enumerate() {
            add(&format!("paint.color.{name}"), plane(&surface.flat, at));
        }
    }
    if wanted.has(Aov::PaintHeight) {
        add("paint.height.X", plane(&surface.normal_and_height, 3));
    }
    if wanted.has(Aov::PaintNormal) {
        for (at, name) in ["paint.normal.X", "paint.normal.Y", "paint.normal.Z"].into_iter().enumerate() {
            add(name, plane(&surface.normal_and_height, at));
        }
    }
    if wanted.has(Aov::PaintWetness) {
        add("paint.wetness.X", Samples::half(surface.wetness.iter().copied()));
    }
}
