//! The integration tests of Impasto.

mod horn;
mod progressive_order;
mod roll_and_lateral;
mod steadiness;
