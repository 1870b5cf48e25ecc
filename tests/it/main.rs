//! The integration tests of Impasto.

mod progressive_order;
