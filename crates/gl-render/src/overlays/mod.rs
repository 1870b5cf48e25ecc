//! Overlays: drawn over a picture in a window, never into a file.

pub(crate) mod light_billboards;
