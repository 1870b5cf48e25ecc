//! The integration tests of Impasto.
