//! Encodes the EXR file of a frame: its channels, and what the file notes about the frame.

use glam::Mat4;
use impasto_aovs::Drawn;
use impasto_frame_files::exr_file::{self, ExrPicture, Note, Packing};
use impasto_frame_files::picture_file::Provenance;
use impasto_gl_render::Renderer;

use crate::shot::FrameError;

/// The file of the picture that a renderer drew last.
pub(crate) fn encode(
    renderer: &mut Renderer,
    drawn: &Drawn<'_>,
    provenance: &Provenance,
    packing: Packing,
) -> Result<Vec<u8>, FrameError> {
    let found = impasto_aovs::read(renderer, drawn)?;
    let scene = drawn.painting.scene();
    let view = &drawn.frame.view;
    let mut notes = found.notes;
    let finish = &drawn.frame.finish;
    notes.extend(
        [
            ("Frame", Note::Number(drawn.number as i32)),
            ("Seed", Note::Text(scene.seed.to_string())),
            ("Style", Note::Text(scene.style.info().name.to_owned())),
            // The view transform: for display, the linear colours are only encoded as sRGB, without tone mapping.
            ("View", Note::Text("sRGB".to_owned())),
            ("paint.toLight", Note::Vector(finish.to_relief_light)),
            ("paint.relief", Note::Float(finish.relief)),
        ]
        .map(|(name, note)| (name.to_owned(), note)),
    );
    let view_from_world = view.view_from_world * Mat4::from_translation(-view.origin_in_world.as_vec3());
    let picture = ExrPicture {
        size_px: drawn.frame.size_px,
        channels: found.channels,
        fps: scene.timeline.fps,
        // EXR files hold matrices for row vectors, row by row: their rows are the columns of ours.
        from_world: [view_from_world, view.clip_from_view * view_from_world]
            .map(|matrix| matrix.to_cols_array()),
        notes,
    };
    exr_file::encode(picture, provenance, packing).map_err(FrameError::Encode)
}
