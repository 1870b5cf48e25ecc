//! What may lie over a finished picture in a window, and never in a file.

pub(crate) mod light_billboards;
