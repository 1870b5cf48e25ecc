//! The sRGB transfer function (IEC 61966-2-1), one channel at a time.

/// sRGB encoded to linear.
pub fn linear_from_srgb(encoded: f32) -> f32 {
    if encoded <= 0.040_45 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// Linear to sRGB encoded; the input is clamped to 0..=1.
pub fn srgb_from_linear(linear: f32) -> f32 {
    let linear = linear.clamp(0.0, 1.0);
    if linear <= 0.003_130_8 { linear * 12.92 } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn srgb_goes_there_and_back() {
        for step in 0..=255u8 {
            let encoded = f32::from(step) / 255.0;
            assert!((srgb_from_linear(linear_from_srgb(encoded)) - encoded).abs() < 1e-6);
        }
        assert!((linear_from_srgb(0.5) - 0.214_041).abs() < 1e-5);
    }
}
