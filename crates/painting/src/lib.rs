//! Turns a loaded scene into the strokes of any frame: `prepare(scene) -> Painting`, then
//! `painting.at(frame, options) -> Frame`. A frame is plain data; nothing here needs files or OpenGL.
//!
//! ```text
//! LoadedScene ─▶ surfaces ─▶ sampling ─▶ neighbours (Horn only) ─▶ field ─▶ lift ─▶ order ─▶ Painting
//!                a step runs again only when its inputs have changed
//! Painting + frame number + picture size ─▶ Frame
//! ```

mod amounts;
mod at;
mod bake;
mod bent;
mod body;
mod body_bend;
mod body_shape;
mod boil;
mod brushes;
mod cached;
mod candidates;
mod coat;
mod coat_amounts;
mod context;
mod counts;
mod displaced;
mod eye;
mod field;
mod finish;
pub mod frame;
mod frame_options;
mod kept;
mod late_field;
mod lights;
mod looks;
mod made_once;
mod needed;
mod noise_displace;
mod object_cache;
mod order;
mod ordering;
mod own_depths;
mod painting;
mod painting_view;
mod paper;
mod particle_count;
mod particles;
mod parts;
mod prepare;
mod presence_bound;
mod recall;
mod references;
mod regions;
mod seen_part;
mod shadow_bounds;
mod shapes;
mod size_follow;
mod stated;
mod stroke;
mod stroke_directions;
mod stroke_size;
mod surface;
mod touch_lines;
mod touches;
mod traits;
mod view;

pub use body_shape::{BodyNoise, BodyShape, FrameNoise, NoiseLayers};
pub use frame::{Frame, Quality};
pub use frame_options::{FrameOptions, Rotation, StrokeColors};
pub use kept::{FindKept, Kept, KeptBytes, KeptKey, ToKeep};
pub use painting::Painting;
pub use particles::Particles;
pub use prepare::{PrepareError, PrepareOptions, Preparer, SeenFrom, Step, prepare};
pub use recall::Recall;
pub use stroke_directions::{ShownDirection, StrokeDirection, SurfacePlace};
