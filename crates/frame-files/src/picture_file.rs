//! PNG files, written whole or not at all.

use std::io::Write;
use std::path::Path;

/// What a file tells about where it comes from.
#[derive(Clone, Debug)]
pub struct Provenance {
    /// The scene's file name.
    pub scene: String,
    /// Which frame, or what else it is.
    pub frame: String,
    /// Who drew it.
    pub driver: String,
}

/// Width and height in pixels, and the pixels: sRGB with straight alpha, row by row from the top.
pub type Pixels<'a> = ([u32; 2], &'a [u8]);

/// Writes a picture to a file of that name, or nothing.
///
/// # Errors
/// What the disk or the encoder said.
pub fn write(path: &Path, pixels: Pixels<'_>, provenance: &Provenance) -> anyhow::Result<()> {
    whole(path, |file| encode(file, pixels, provenance))
}

/// Fills a temporary file beside `path`, then gives it its name: a killed command leaves no half file.
///
/// # Errors
/// What the disk or the encoder said.
pub fn whole(path: &Path, fill: impl FnOnce(&mut dyn Write) -> anyhow::Result<()>) -> anyhow::Result<()> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut file = tempfile::Builder::new().prefix(".impasto-").suffix(".part").tempfile_in(folder)?;
    {
        let mut buffered = std::io::BufWriter::new(file.as_file_mut());
        fill(&mut buffered)?;
        buffered.flush()?;
    }
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        // A temporary file is private; a picture is what the user's other files are.
        file.as_file().set_permissions(std::fs::Permissions::from_mode(0o644))?;
    }
    file.persist(path)?;
    Ok(())
}

/// Writes one picture as PNG: sRGB, straight alpha.
///
/// # Errors
/// What the disk or the encoder said.
pub fn encode(file: &mut dyn Write, pixels: Pixels<'_>, provenance: &Provenance) -> anyhow::Result<()> {
    let mut encoder = encoder(file, pixels.0, provenance)?;
    encoder.set_compression(png::Compression::Fast);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels.1)?;
    writer.finish()?;
    Ok(())
}

/// An encoder with what all our files have in common.
///
/// # Errors
/// What the disk or the encoder said.
pub fn encoder<'a>(
    file: &'a mut dyn Write,
    size_px: [u32; 2],
    provenance: &Provenance,
) -> anyhow::Result<png::Encoder<'static, &'a mut dyn Write>> {
    let mut encoder = png::Encoder::new(file, size_px[0], size_px[1]);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual);
    encoder
        .add_itxt_chunk("Software".to_owned(), concat!("Impasto ", env!("CARGO_PKG_VERSION")).to_owned())?;
    encoder.add_itxt_chunk("Scene".to_owned(), provenance.scene.clone())?;
    encoder.add_itxt_chunk("Frame".to_owned(), provenance.frame.clone())?;
    encoder.add_itxt_chunk("Driver".to_owned(), provenance.driver.clone())?;
    Ok(encoder)
}
