//! Rendered frames as files: lists of frames, their file names, PNG and EXR, written and read. The command line and the editor write the same
//! bytes because both write them here.

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

/// Whether a frame's file is there and whole. A file that was cut, or that is none of its kind, is to be written again.
pub fn is_whole(path: &std::path::Path) -> bool {
    match path.extension() {
        Some(extension) if extension.eq_ignore_ascii_case("exr") => exr_header::is_whole(path),
        _ => picture_file::is_whole(path),
    }
}

/// The scene that a frame of ours was painted from, as its file says; `None` where it does not.
pub fn scene_of(path: &std::path::Path) -> Option<String> {
    note(path, "Scene")
}

/// The state of its scene and settings that a frame of ours was painted from, as its file says; `None` where it does not.
pub fn state_of(path: &std::path::Path) -> Option<String> {
    note(path, "State").filter(|state| !state.is_empty())
}

fn note(path: &std::path::Path, name: &str) -> Option<String> {
    match path.extension() {
        Some(extension) if extension.eq_ignore_ascii_case("exr") => exr_header::text(path, name),
        _ => picture_file::text(path, name),
    }
}
