//! Tests of the editor's right column (tree and inspector) on shipped scenes: what it does, and how it looks.

mod column;
mod headless;
