//! Materials that the reference pass alone does not know: each in a file of its own.

pub(crate) mod noise_displace;
