//! `prepare(scene) -> Painting`, then `painting.at(frame, size) -> Frame`: plain data, no files, no GL.

pub mod frame;

pub use frame::Frame;
