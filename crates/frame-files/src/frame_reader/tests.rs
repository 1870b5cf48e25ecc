//! Tests that every kind of PNG gives the pixels that were put into it, and that what a file claims is checked.

use super::*;

/// Writes a picture of two pixels and reads it again.
fn two_pixels(color: ColorType, depth: BitDepth, pixels: &[u8], trns: Option<&[u8]>) -> FramePixels {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    let mut encoder = png::Encoder::new(File::create(&path).unwrap(), 2, 1);
    encoder.set_color(color);
    encoder.set_depth(depth);
    if color == ColorType::Indexed {
        encoder.set_palette(vec![1, 2, 3, 200, 100, 50]);
    }
    if let Some(trns) = trns {
        encoder.set_trns(trns.to_vec());
    }
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(pixels).unwrap();
    writer.finish().unwrap();
    let (told, read) = (info(&path).unwrap(), read(&path).unwrap());
    assert_eq!((told.size_px, told.depth), (read.size_px, read.depth));
    let can_be_transparent = matches!(color, ColorType::Rgba | ColorType::GrayscaleAlpha) || trns.is_some();
    assert_eq!(told.has_alpha, can_be_transparent);
    read
}

#[test]
fn every_kind_of_png_is_rgba() {
    use BitDepth::{Eight, One, Sixteen};
    use ColorType::{Grayscale, GrayscaleAlpha, Indexed, Rgb, Rgba};
    for (color, depth, pixels, trns, wanted) in [
        (Rgba, Eight, &[1, 2, 3, 4, 5, 6, 7, 8][..], None, [1, 2, 3, 4, 5, 6, 7, 8]),
        (Rgb, Eight, &[1, 2, 3, 5, 6, 7], None, [1, 2, 3, 255, 5, 6, 7, 255]),
        // The second pixel has the colour that counts as transparent.
        (Rgb, Eight, &[1, 2, 3, 5, 6, 7], Some(&[0, 5, 0, 6, 0, 7][..]), [1, 2, 3, 255, 5, 6, 7, 0]),
        (Grayscale, Eight, &[9, 8], None, [9, 9, 9, 255, 8, 8, 8, 255]),
        (Grayscale, One, &[0b0100_0000], None, [0, 0, 0, 255, 255, 255, 255, 255]),
        (GrayscaleAlpha, Eight, &[9, 1, 8, 2], None, [9, 9, 9, 1, 8, 8, 8, 2]),
        (Indexed, Eight, &[1, 0], None, [200, 100, 50, 255, 1, 2, 3, 255]),
        (Indexed, Eight, &[1, 0], Some(&[7]), [200, 100, 50, 255, 1, 2, 3, 7]),
    ] {
        let read = two_pixels(color, depth, pixels, trns);
        assert_eq!((read.size_px, read.depth), ([2, 1], Depth::Eight));
        assert_eq!(read.rgba, wanted, "{color:?} {depth:?} {trns:?}");
        assert_eq!(read.is_opaque(), wanted[3] == 255 && wanted[7] == 255);
    }
    let deep = two_pixels(Rgb, Sixteen, &[1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12], None);
    assert_eq!(deep.rgba, [1, 2, 3, 4, 5, 6, 255, 255, 7, 8, 9, 10, 11, 12, 255, 255]);
    let deep = two_pixels(GrayscaleAlpha, Sixteen, &[1, 2, 255, 254, 5, 6, 255, 255], None);
    assert_eq!(deep.rgba, [1, 2, 1, 2, 1, 2, 255, 254, 5, 6, 5, 6, 5, 6, 255, 255]);
    assert!(!deep.is_opaque());
}

#[test]
fn depths_are_changed_to_the_nearest_value() {
    for value in 0..=u16::MAX {
        let [high, low] = value.to_be_bytes();
        let deep = FramePixels { size_px: [1, 1], depth: Depth::Sixteen, rgba: [high, low].repeat(4) };
        let nearest = (f64::from(value) * 255.0 / 65_535.0).round() as u8;
        assert_eq!(deep.at_depth(Depth::Eight).rgba, [nearest; 4], "{value}");
    }
    for value in 0..=u8::MAX {
        let plain = FramePixels { size_px: [1, 1], depth: Depth::Eight, rgba: vec![value; 4] };
        let there = plain.clone().at_depth(Depth::Sixteen);
        assert_eq!(there.rgba[..2], (u16::from(value) * 257).to_be_bytes());
        assert_eq!(there.at_depth(Depth::Eight), plain);
    }
}

#[test]
fn over_black_a_colour_is_as_bright_as_its_alpha() {
    for alpha in [0u8, 1, 64, 128, 254, 255] {
        let mut plain = FramePixels { size_px: [1, 1], depth: Depth::Eight, rgba: vec![255, 200, 0, alpha] };
        let mut deep = plain.clone().at_depth(Depth::Sixteen);
        plain.lay_over_black();
        deep.lay_over_black();
        let second = (200.0 * f64::from(alpha) / 255.0).round() as u8;
        assert_eq!(plain.rgba, [alpha, second, 0, 255]);
        assert!(plain.is_opaque() && deep.is_opaque());
        assert_eq!(deep.at_depth(Depth::Eight), plain);
    }
}

/// A PNG's signature and header, which claims this size in 16-bit RGBA.
fn header(width: u32, height: u32) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(ColorType::Rgba);
    encoder.set_depth(BitDepth::Sixteen);
    drop(encoder.write_header().unwrap());
    // The signature (8 bytes) and one chunk: 12 bytes of length, type and checksum, and 13 bytes of data.
    bytes.truncate(8 + 12 + 13);
    bytes
}

#[test]
fn what_a_header_claims_is_held_against_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    let refused = |bytes: &[u8]| {
        std::fs::write(&path, bytes).unwrap();
        let words = read(&path).unwrap_err().to_string();
        assert!(info(&path).is_err() && !words.contains('\n'), "{words}");
        words
    };
    assert!(refused(&header(20_000, 10)).contains("claims 20000 x 10 pixels: the limit is"));
    assert!(refused(&header(16_384, 16_384)).contains("the limit is"));
    assert!(refused(&header(8192, 8192)).contains("it claims 8192 x 8192 pixels in 33 bytes"));
    assert!(refused(&header(4, 4)).contains("it ends too early"));
    assert!(refused(b"").contains("a.png is no whole PNG file"));
    assert!(refused(b"#!/bin/sh\n").contains("a.png is no whole PNG file"));
    assert!(matches!(read(folder.path()), Err(FrameFileError::Broken { .. })));
    assert!(matches!(read(&folder.path().join("b.png")), Err(FrameFileError::Missing(_))));
}

#[test]
fn a_frame_that_is_cut_off_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 64, 64);
    encoder.set_color(ColorType::Rgb);
    let noise: Vec<u8> =
        (0..64 * 64 * 3u32).map(|index| (index.wrapping_mul(2_654_435_761) >> 24) as u8).collect();
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(&noise).unwrap();
    writer.finish().unwrap();
    std::fs::write(&path, &bytes).unwrap();
    let whole = read(&path).unwrap();
    assert!(whole.rgba.chunks_exact(4).map(|pixel| &pixel[..3]).eq(noise.chunks_exact(3)));
    std::fs::write(&path, &bytes[..bytes.len() / 2]).unwrap();
    assert!(read(&path).unwrap_err().to_string().contains("a.png is no whole PNG file"));
}
