//! Rendered frames as files: lists of frames, their file names, and PNG, written and read. The command line and the editor write the same
//! bytes because both write them here.

mod frame_list;
pub mod frame_reader;
mod pattern;
pub mod picture_file;
mod place;

pub use frame_list::FrameList;
pub use pattern::Pattern;
pub use place::{PlaceError, not_an_input, ready_folder};
