//! Materials that need passes of their own: one file each.

pub(crate) mod noise_displace;
