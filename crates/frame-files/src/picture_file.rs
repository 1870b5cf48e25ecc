//! PNG files: still and animated, of 8 and of 16 bits, each with a note of where it comes from.

use std::fs::File;
use std::io::{self, BufReader, Read as _, Seek as _, SeekFrom, Write};
use std::path::Path;

use impasto_scene::whole_file::WholeFile;

use crate::frame_rate::fraction;

/// Where a picture comes from; noted in the file.
#[derive(Clone, Debug)]
pub struct Provenance {
    /// The scene's file name.
    pub scene: String,
    /// A hash of the scene, the files that it reads and the settings; empty if it is not known.
    pub state: String,
    /// The frame's number, or what the picture shows instead.
    pub frame: String,
    /// The OpenGL driver that drew it.
    pub driver: String,
}

/// A picture: sRGB with straight alpha.
#[derive(Clone, Copy, Debug)]
pub struct Pixels<'a> {
    /// Width and height in pixels.
    pub size_px: [u32; 2],
    /// Four bytes a pixel, row by row from the top.
    pub rgba8: &'a [u8],
}

/// As [`Pixels`], with 16 bits a channel.
#[derive(Clone, Copy, Debug)]
pub struct DeepPixels<'a> {
    /// Width and height in pixels.
    pub size_px: [u32; 2],
    /// Four numbers a pixel, row by row from the top.
    pub rgba16: &'a [u16],
}

/// Writes a picture to a PNG file, whole or not at all.
///
/// # Errors
/// What the disk or the encoder said.
pub fn write(path: &Path, pixels: Pixels<'_>, provenance: &Provenance) -> anyhow::Result<()> {
    let mut file = WholeFile::create(path)?;
    encode(&mut file, pixels, provenance)?;
    Ok(file.finish()?)
}

/// Encodes a picture as PNG.
///
/// # Errors
/// What the disk or the encoder said.
pub fn encode(file: &mut dyn Write, pixels: Pixels<'_>, provenance: &Provenance) -> anyhow::Result<()> {
    let mut writer = encoder(file, pixels.size_px, provenance)?.write_header()?;
    writer.write_image_data(pixels.rgba8)?;
    writer.finish()?;
    Ok(())
}

/// Encodes a picture as PNG of 16 bits a channel.
///
/// # Errors
/// What the disk or the encoder said.
pub fn encode_deep(
    file: &mut dyn Write,
    pixels: DeepPixels<'_>,
    provenance: &Provenance,
) -> anyhow::Result<()> {
    let mut encoder = encoder(file, pixels.size_px, provenance)?;
    encoder.set_depth(png::BitDepth::Sixteen);
    let bytes: Vec<u8> = pixels.rgba16.iter().flat_map(|value| value.to_be_bytes()).collect();
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&bytes)?;
    writer.finish()?;
    Ok(())
}

/// Whether a file ends as a PNG file must. A truncated file does not.
pub(crate) fn is_whole(path: &Path) -> bool {
    const END: &[u8] = b"\0\0\0\0IEND\xae\x42\x60\x82";
    let last = || {
        let mut file = File::open(path)?;
        file.seek(SeekFrom::End(-(END.len() as i64)))?;
        let mut bytes = [0; END.len()];
        io::Result::Ok(file.read_exact(&mut bytes).is_ok() && bytes == END)
    };
    last().unwrap_or(false)
}

/// Begins an animated PNG. The caller must then write exactly `pictures` pictures to it, one after the other.
///
/// # Errors
/// What the disk or the encoder said.
pub fn begin_animation<'a>(
    file: &'a mut dyn Write,
    size_px: [u32; 2],
    pictures: u32,
    fps: f64,
    provenance: &Provenance,
) -> anyhow::Result<png::Writer<&'a mut dyn Write>> {
    let mut encoder = encoder(file, size_px, provenance)?;
    encoder.set_animated(pictures, 0)?;
    // PNG stores the delay as a fraction of two 16-bit numbers.
    let delay_s = match fraction(fps).map(u16::try_from) {
        [Ok(over), Ok(under)] => [under, over],
        _ => [(1000.0 / fps).round().clamp(1.0, 65535.0) as u16, 1000],
    };
    encoder.set_frame_delay(delay_s[0], delay_s[1])?;
    Ok(encoder.write_header()?)
}

/// The text stored under this keyword before the pixels of a PNG file; `None` if there is none, or if the file is no
/// PNG.
pub(crate) fn text(path: &Path, keyword: &str) -> Option<String> {
    let limits = png::Limits { bytes: 1 << 20 };
    let file = BufReader::new(File::open(path).ok()?);
    let reader = png::Decoder::new_with_limits(file, limits).read_info().ok()?;
    let texts = &reader.info().utf8_text;
    texts.iter().find(|text| text.keyword == keyword)?.get_text().ok()
}

/// A PNG encoder, with the settings and the notes that all our files share.
fn encoder<'a>(
    file: &'a mut dyn Write,
    size_px: [u32; 2],
    provenance: &Provenance,
) -> anyhow::Result<png::Encoder<'static, &'a mut dyn Write>> {
    let mut encoder = png::Encoder::new(file, size_px[0], size_px[1]);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Fast);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    let software = concat!("Impasto ", env!("CARGO_PKG_VERSION"));
    for (keyword, text) in [
        ("Software", software),
        ("Scene", &provenance.scene),
        ("Frame", &provenance.frame),
        ("Driver", &provenance.driver),
        ("State", &provenance.state),
    ] {
        if text.is_empty() {
            continue;
        }
        encoder.add_itxt_chunk(keyword.to_owned(), text.to_owned())?;
    }
    Ok(encoder)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn provenance() -> Provenance {
        Provenance {
            scene: "a.ron".to_owned(),
            state: String::new(),
            frame: "1".to_owned(),
            driver: "a driver".to_owned(),
        }
    }

    #[test]
    fn an_animation_keeps_the_rate_of_film() {
        for (fps, delay) in [(24.0, (1, 24)), (23.976, (1001, 24000)), (12.5, (2, 25))] {
            let mut bytes = Vec::new();
            let mut writer = begin_animation(&mut bytes, [1, 1], 2, fps, &provenance()).unwrap();
            writer.write_image_data(&[0; 4]).unwrap();
            writer.write_image_data(&[0; 4]).unwrap();
            writer.finish().unwrap();
            let reader = png::Decoder::new(io::Cursor::new(&bytes)).read_info().unwrap();
            let control = reader.info().frame_control().unwrap();
            assert_eq!((control.delay_num, control.delay_den), delay, "{fps}");
        }
    }

    #[test]
    fn sixteen_bits_come_back_and_a_cut_file_is_not_whole() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let rgba16: Vec<u16> = (0..6 * 4).map(|index| index * 2731).collect();
        let mut bytes = Vec::new();
        encode_deep(&mut bytes, DeepPixels { size_px: [3, 2], rgba16: &rgba16 }, &provenance()).unwrap();
        let mut reader = png::Decoder::new(io::Cursor::new(&bytes)).read_info().unwrap();
        let mut read = vec![0; reader.output_buffer_size().unwrap()];
        assert_eq!(reader.next_frame(&mut read).unwrap().bit_depth, png::BitDepth::Sixteen);
        let read: Vec<u16> =
            read.chunks_exact(2).map(|pair| u16::from_be_bytes([pair[0], pair[1]])).collect();
        assert_eq!(read, rgba16);
        std::fs::write(&path, &bytes).unwrap();
        assert!(is_whole(&path));
        for kept in [0, 5, bytes.len() - 1] {
            std::fs::write(&path, &bytes[..kept]).unwrap();
            assert!(!is_whole(&path), "{kept}");
        }
    }
}
