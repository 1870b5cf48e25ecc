//! Materials that need passes of their own: one module each.

pub(crate) mod noise_displace;
