//! Colours as a scene file states them.

/// An sRGB colour, each channel in 0..=1; in the file `"#rrggbb"` or `"#rgb"`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Color(pub [f32; 3]);

impl Color {
    /// From 8 bits a channel.
    pub const fn from_bytes([r, g, b]: [u8; 3]) -> Self {
        Self([r as f32 / 255.0, g as f32 / 255.0, b as f32 / 255.0])
    }

    /// White.
    pub fn white() -> Self {
        Self([1.0; 3])
    }

    pub(super) fn is_white(&self) -> bool {
        *self == Self::white()
    }
}

impl Default for Color {
    /// Warm grey paper.
    fn default() -> Self {
        Self::from_bytes([0xe4, 0xdc, 0xcb])
    }
}
