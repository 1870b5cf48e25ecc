//! How much memory pictures take while they are drawn and encoded.

use impasto_gl_render::{Keeps, Renderer};
use impasto_painting::frame::samples_that_fit;
use impasto_scene::aovs::Aov;
use impasto_scene::document::Scene;
use impasto_scene::memory;

use crate::shot::Wanted;

/// The most memory that one painter takes while it draws and encodes pictures of this size, bytes. The memory of the
/// prepared scene is not counted. Measured with llvmpipe at 7680 x 4320 and 8192 x 8192.
pub(crate) fn picture_bytes(scene: &Scene, wanted: Wanted, size_px: [u32; 2], renderer: &Renderer) -> u64 {
    let style = scene.style.settings();
    let samples = samples_that_fit(style.preparation().samples, size_px, renderer.max_side_px());
    let aovs = wanted.exr.map(|aovs| aovs.shared(style.aovs()));
    let has_any = |of: &[Aov]| aovs.is_some_and(|aovs| aovs.has_any(of));
    let keeps = Keeps::of_size(size_px, has_any(impasto_aovs::OF_SURFACES));
    let while_drawn = keeps.bytes_per_px(&scene.style, samples);
    let while_read = if has_any(impasto_aovs::GATHERED) {
        OF_PAINT
    } else if has_any(OF_SCENE) {
        while_drawn.max(OF_SCENE_READ)
    } else {
        while_drawn
    };
    size_px.map(u64::from).iter().product::<u64>() * while_read
}

/// Checks that a software driver has the memory for such pictures. Without enough, it would abort the process while
/// drawing.
///
/// # Errors
/// How much the pictures take and how much is left, in words.
pub fn fits_in_memory(
    scene: &Scene,
    wanted: Wanted,
    size_px: [u32; 2],
    renderer: &Renderer,
) -> Result<(), String> {
    let takes = picture_bytes(scene, wanted, size_px, renderer);
    let [width, height] = size_px;
    let is_software = renderer.report().is_software();
    match memory::available_bytes() {
        Some(left) if is_software && takes > left => Err(format!(
            "a picture of {width}x{height} takes about {} MiB while it is drawn, and {} MiB are left",
            takes >> 20,
            left >> 20,
        )),
        _ => Ok(()),
    }
}

/// The AOVs of the scene, without the depth, which takes next to nothing.
const OF_SCENE: &[Aov] = &[
    Aov::Position,
    Aov::ObjectId,
    Aov::Normal,
    Aov::Albedo,
    Aov::Light,
    Aov::Shadow,
    Aov::Occlusion,
    Aov::Motion,
    Aov::Forward,
    Aov::Backward,
];

/// Bytes per pixel while AOVs of the scene are read and encoded.
const OF_SCENE_READ: u64 = 230;

/// Bytes per pixel while AOVs are read and encoded if one of them is of the paint: as much as a file with all AOVs
/// takes.
const OF_PAINT: u64 = 844;
