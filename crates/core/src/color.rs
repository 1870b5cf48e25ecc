//! Converts colours: between sRGB and linear, one channel at a time (IEC 61966-2-1), and from linear to Oklab.

/// From sRGB to linear.
pub fn linear_from_srgb(encoded: f32) -> f32 {
    if encoded <= 0.040_45 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// From linear to sRGB; the input is clamped to 0..=1.
pub fn srgb_from_linear(linear: f32) -> f32 {
    let linear = linear.clamp(0.0, 1.0);
    if linear <= 0.003_130_8 { linear * 12.92 } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// Oklab (L, a, b) of a linear Rec. 709 colour (Ottosson 2020).
pub fn oklab_from_linear([r, g, b]: [f32; 3]) -> [f32; 3] {
    let cone = [
        0.412_221_46 * r + 0.536_332_55 * g + 0.051_445_995 * b,
        0.211_903_5 * r + 0.680_699_5 * g + 0.107_396_96 * b,
        0.088_302_46 * r + 0.281_718_85 * g + 0.629_978_7 * b,
    ];
    let [l, m, s] = cone.map(|value| value.max(0.0).cbrt());
    [
        0.210_454_26 * l + 0.793_617_8 * m - 0.004_072_047 * s,
        1.977_998_5 * l - 2.428_592_2 * m + 0.450_593_7 * s,
        0.025_904_037 * l + 0.782_771_77 * m - 0.808_675_77 * s,
    ]
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

    #[test]
    fn oklab_of_known_colours() {
        let near = |color: [f32; 3], lab: [f32; 3]| {
            let found = oklab_from_linear(color);
            assert!(found.iter().zip(lab).all(|(a, b)| (a - b).abs() < 1e-3), "{color:?}: {found:?}");
        };
        near([1.0, 1.0, 1.0], [1.0, 0.0, 0.0]);
        near([1.0, 0.0, 0.0], [0.628, 0.225, 0.126]);
        near([0.0, 0.0, 1.0], [0.452, -0.032, -0.312]);
        near([0.0, 0.0, 0.0], [0.0, 0.0, 0.0]);
    }
}
