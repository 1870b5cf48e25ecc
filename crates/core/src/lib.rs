//! The maths of Impasto. No files, no GL, no clock, and no randomness that it was not handed.
//!
//! ```text
//! mesh ─▶ sampling ─▶ particles (progressive blue-noise order)
//!                         │
//!         neighbours ◀────┤ (only where `horn` asks)
//!                         ▼
//!         direction ─▶ lift: N' per particle ─▶ solve: centre, depth, angle, presence per view
//! ```

pub mod mesh;

pub use mesh::TriangleMesh;
