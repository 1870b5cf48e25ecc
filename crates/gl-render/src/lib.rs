//! The only crate that draws: Frame -> pixels.
