//! Rendered frames as files: lists of frames, their file names, and PNG and EXR files, written and read. The command
//! line and the editor write the same bytes because both write them here.

pub mod exr_file;
mod exr_header;
mod frame_list;
mod frame_rate;
pub mod frame_reader;
mod pattern;
pub mod picture_file;
mod place;

pub use frame_list::FrameList;
pub use pattern::Pattern;
pub use place::{PlaceError, not_an_input, ready_folder};

/// Whether a frame's file is there and whole. A truncated file is not whole, nor is one that does not match its
/// extension.
pub fn is_whole(path: &std::path::Path) -> bool {
    match path.extension() {
        Some(extension) if extension.eq_ignore_ascii_case("exr") => exr_header::is_whole(path),
        _ => picture_file::is_whole(path),
    }
}

/// The name of the scene file that a frame was painted from, which Impasto notes in the frame's file; `None` without
/// such a note.
pub fn scene_of(path: &std::path::Path) -> Option<String> {
    note(path, "Scene")
}

/// The hash of the scene and the settings that a frame was painted from. Impasto notes it in the frame's file; `None`
/// without such a note.
pub fn state_of(path: &std::path::Path) -> Option<String> {
    note(path, "State").filter(|state| !state.is_empty())
}

fn note(path: &std::path::Path, name: &str) -> Option<String> {
    match path.extension() {
        Some(extension) if extension.eq_ignore_ascii_case("exr") => exr_header::text(path, name),
        _ => picture_file::text(path, name),
    }
}
