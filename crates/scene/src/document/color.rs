//! Colours as a scene file states them.

/// An sRGB colour, each channel in 0..=1; in the file `"#rrggbb"`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Color(pub [f32; 3]);

impl Color {
    /// White.
    pub fn white() -> Self {
        Self([1.0; 3])
    }
}

impl Default for Color {
    /// Warm grey paper.
    fn default() -> Self {
        Self([0xe4 as f32 / 255.0, 0xdc as f32 / 255.0, 0xcb as f32 / 255.0])
    }
}
