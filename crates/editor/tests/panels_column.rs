//! The right column, driven by name on scenes of the house, and how it looks.

mod column;
mod headless;
