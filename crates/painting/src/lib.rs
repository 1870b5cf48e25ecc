//! `prepare(scene) -> Painting`, then `painting.at(frame, options) -> Frame`: plain data, no files, no GL.
//!
//! ```text
//! LoadedScene ─▶ surfaces ─▶ sampling ─▶ neighbours (horn only) ─▶ lift ─▶ order ─▶ Painting
//!                each step is kept as long as its inputs stay the same
//! Painting + frame number + picture size ─▶ Frame
//! ```

mod at;
mod bake;
mod brushes;
mod candidates;
mod coat;
mod counts;
mod deform;
mod field;
mod finish;
pub mod frame;
mod gate;
mod hairs;
mod lights;
mod noise_displace;
mod order;
mod paper;
mod particle_count;
mod particles;
mod parts;
mod prepare;
mod recall;
mod references;
mod regions;
mod seats;
mod smooth;
mod stated;
mod stroke;
mod surface;
mod view;

pub use at::{FrameOptions, Rotation, StrokeColors};
pub use frame::{Frame, Quality};
pub use hairs::{Hair, ShownDirection, SurfacePlace};
pub use noise_displace::{BodyNoise, BodyShape, FrameNoise, NoiseLayers};
pub use particles::Particles;
pub use prepare::{Painting, PrepareError, PrepareOptions, Preparer, Step, prepare};
pub use recall::Recall;
