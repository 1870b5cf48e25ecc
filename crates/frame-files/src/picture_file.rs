//! PNG files: still and animated, each with a note of where it comes from.

use std::io::Write;
use std::path::Path;

use impasto_scene::whole_file::WholeFile;

/// Where a picture comes from; noted in the file.
#[derive(Clone, Debug)]
pub struct Provenance {
    /// The scene's file name.
    pub scene: String,
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

/// Begins an animated PNG of this many pictures, to be written to it one after the other.
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
    // In whole milliseconds, so 24 frames a second become 23.8.
    encoder.set_frame_delay((1000.0 / fps).round().clamp(1.0, 65535.0) as u16, 1000)?;
    Ok(encoder.write_header()?)
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
    ] {
        encoder.add_itxt_chunk(keyword.to_owned(), text.to_owned())?;
    }
    Ok(encoder)
}
