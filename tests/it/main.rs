//! The integration tests of Impasto.

mod progressive_order;
mod roll_and_lateral;
