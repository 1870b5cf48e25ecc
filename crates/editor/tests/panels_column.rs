//! Tests of the right column on shipped scenes: what it does, and how it looks.

mod column;
mod headless;
