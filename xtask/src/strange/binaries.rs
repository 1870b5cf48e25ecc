//! Strange pictures and point caches: files whose headers claim what the rest does not hold.

use super::chance::Chance;

/// A picture of this kind, `bmp` or `tga`; for any other kind a PNG. By chance it is of another kind, has a header that
/// lies, or is cut short.
pub fn picture(chance: &mut Chance, kind: &str) -> Vec<u8> {
    let [width, height] = [(); 2].map(|()| chance.count(64) as u32);
    let mut bytes = match if chance.is_odd() { chance.of(&["png", "bmp", "tga"]) } else { kind } {
        "bmp" => bmp(chance, width, height),
        "tga" => tga(chance, width, height),
        _ => png(chance, width, height),
    };
    if chance.is_odd() {
        bytes.truncate(chance.below(bytes.len()));
    }
    bytes
}

/// A number that a header claims, such as the length of a side: the true one, or an odd one.
fn side(chance: &mut Chance, true_px: u32) -> u32 {
    if !chance.is_odd() {
        return true_px;
    }
    chance.of(&[0, 1, 65_535, 100_000, 0x7fff_ffff, 0xffff_ffff])
}

fn noise(chance: &mut Chance, count: usize) -> Vec<u8> {
    (0..count).map(|_| chance.byte()).collect()
}

fn png(chance: &mut Chance, width: u32, height: u32) -> Vec<u8> {
    let color = chance.of(&[
        png::ColorType::Rgb,
        png::ColorType::Rgba,
        png::ColorType::Grayscale,
        png::ColorType::GrayscaleAlpha,
    ]);
    let depth = chance.of(&[png::BitDepth::Eight, png::BitDepth::Sixteen]);
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(color);
    encoder.set_depth(depth);
    let per_pixel = color.samples() * if depth == png::BitDepth::Sixteen { 2 } else { 1 };
    let pixels = noise(chance, (width * height) as usize * per_pixel);
    if let Ok(mut writer) = encoder.write_header() {
        let _ = writer.write_image_data(&pixels);
    }
    // The name of the header's chunk is at byte 12. The sides, the depth and the kind follow, then the checksum of all
    // these.
    let claims = [side(chance, width), side(chance, height)];
    if bytes.len() > 33 && claims != [width, height] {
        bytes[16..20].copy_from_slice(&claims[0].to_be_bytes());
        bytes[20..24].copy_from_slice(&claims[1].to_be_bytes());
        let sum = crc32fast::hash(&bytes[12..29]);
        bytes[29..33].copy_from_slice(&sum.to_be_bytes());
    }
    bytes
}

fn bmp(chance: &mut Chance, width: u32, height: u32) -> Vec<u8> {
    let bits: u16 = chance.of(&[24, 32, 8, 1, 16]);
    let row = (width as usize * usize::from(bits)).div_ceil(32) * 4;
    let pixels = noise(chance, row * height as usize);
    let mut bytes = b"BM".to_vec();
    bytes.extend((54 + pixels.len() as u32).to_le_bytes());
    bytes.extend([0; 4]);
    bytes.extend(side(chance, 54).to_le_bytes());
    bytes.extend(40u32.to_le_bytes());
    bytes.extend(side(chance, width).to_le_bytes());
    let upright = side(chance, height);
    bytes.extend(if chance.happens(0.3) { upright.wrapping_neg() } else { upright }.to_le_bytes());
    bytes.extend(1u16.to_le_bytes());
    bytes.extend(bits.to_le_bytes());
    bytes.extend(side(chance, 0).to_le_bytes());
    bytes.extend([0; 12]);
    bytes.extend(side(chance, 0).to_le_bytes());
    bytes.extend([0; 4]);
    bytes.extend(pixels);
    bytes
}

fn tga(chance: &mut Chance, width: u32, height: u32) -> Vec<u8> {
    let (kind, bits): (u8, u8) = chance.of(&[(2, 24), (2, 32), (3, 8), (10, 24), (11, 8), (1, 8), (9, 16)]);
    let mut bytes = vec![0, u8::from(kind == 1 || kind == 9), kind, 0, 0];
    bytes.extend((side(chance, 4) as u16).to_le_bytes());
    bytes.extend([24, 0, 0, 0, 0]);
    bytes.extend((side(chance, width) as u16).to_le_bytes());
    bytes.extend((side(chance, height) as u16).to_le_bytes());
    bytes.extend([bits, chance.byte() & 0x30]);
    bytes.extend(noise(chance, 12 + (width * height) as usize * usize::from(bits / 8)));
    bytes
}

/// A PC2 file of points at random places. By chance its header lies, its numbers are odd, or it is cut short.
pub fn cache(chance: &mut Chance, points: u32) -> Vec<u8> {
    let samples = chance.count(12) as u32;
    let mut bytes = b"POINTCACHE2\0".to_vec();
    bytes.extend(side(chance, 1).to_le_bytes());
    let claimed = if chance.is_odd() { chance.count(50) as u32 } else { points };
    bytes.extend(side(chance, claimed).to_le_bytes());
    for usual in [0.0, 1.0] {
        bytes.extend((float(chance, usual) as f32).to_le_bytes());
    }
    bytes.extend(side(chance, samples).to_le_bytes());
    for _ in 0..samples * points * 3 {
        let usual = chance.between(-1.0, 1.0);
        bytes.extend((float(chance, usual) as f32).to_le_bytes());
    }
    if chance.is_odd() {
        bytes.truncate(chance.below(bytes.len()));
    }
    bytes
}

/// The usual number, or an odd one. Odd numbers that cannot be parsed give the usual one.
pub fn float(chance: &mut Chance, usual: f64) -> f64 {
    chance.number(usual).parse().unwrap_or(usual)
}
