//! The integration tests of Impasto.

#![expect(
    clippy::unwrap_used,
    clippy::print_stdout,
    reason = "a failed step is a failed test, and tests print what they measure"
)]

mod cli;
mod corpus;
mod horn;
mod hostile_scenes;
mod progressive_order;
mod roll_and_lateral;
mod rotating_strokes;
mod scenes_in_motion;
mod shipped_scenes;
mod steadiness;
