//! The integration tests of Impasto.

mod corpus;
mod horn;
mod hostile_scenes;
mod progressive_order;
mod roll_and_lateral;
mod rotating_strokes;
mod steadiness;
