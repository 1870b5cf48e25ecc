//! The maths of Impasto, from particles on a mesh to strokes in a view. It uses no files, no GL and no clock, and all
//! of its random numbers come from seeds.
//!
//! ```text
//! mesh ─▶ shells ─▶ sampling ─▶ particles (progressive blue-noise order)
//!                                  │
//!                  neighbours ◀────┤ (only for Horn's solvers)
//!                                  ▼
//!         direction ─▶ lift: N' per particle ─▶ solve: centre, depth, angle, projected area per view
//!                                                   └▶ presence
//! ```

pub mod angle;
pub mod bending;
pub mod brush;
pub mod cofactors;
pub mod color;
pub mod direction;
pub mod flood;
pub mod form_size;
pub mod hash;
pub mod horn_exact;
pub mod inverse_bilinear;
pub mod lift;
pub mod mesh;
pub mod nearest;
pub mod neighbours;
pub mod noise;
pub mod noise_displace;
pub mod parts;
pub mod presence;
pub mod sampling;
pub mod screen_map;
pub mod shells;
pub mod smooth_path;
pub mod solve;
mod wide;

pub use mesh::TriangleMesh;
pub use screen_map::ScreenMap;
