//! Decodes pictures (textures and brushes) within limits, whatever their header claims.

use std::io::Cursor;
use std::path::Path;

use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};

use crate::assets::{AssetFolders, AssetRequest};
use crate::mesh_file::Texture;
use crate::problem::{Problem, Severity};

/// The most pixels a picture may have (8192 x 8192).
pub const MAX_PIXELS: u64 = 1 << 26;

/// The largest picture file that is read, in bytes.
pub const MAX_FILE_BYTES: u64 = 256 << 20;

/// What a decoder may allocate, in bytes.
const MAX_DECODER_BYTES: u64 = 384 << 20;

/// No PNG, BMP, TGA or JPEG has more pixels per byte than this. PNG packs most: at most 8 pixels a byte, which deflate
/// shrinks at most 1032 : 1.
const MAX_PIXELS_PER_BYTE: u64 = 8 * 1032;

/// A picture and the warnings about it.
#[derive(Debug, PartialEq)]
pub struct Decoded {
    /// The picture.
    pub texture: Texture,
    /// What was repaired.
    pub warnings: Vec<Problem>,
}

/// Decodes a PNG, JPEG, BMP, TGA or WebP picture. The content tells the format; only TGA is known by the file's name.
///
/// A picture with a side over [`Texture::MAX_SIDE_PX`] is scaled down, with a warning.
///
/// # Errors
/// A [`Severity::Limit`] problem when the header claims more than [`MAX_PIXELS`], or when decoding would take too much
/// memory: such a picture is not decoded. A [`Severity::Warning`] when the picture cannot be decoded: go on without it.
pub fn decode(path: &Path, bytes: &[u8]) -> Result<Decoded, Problem> {
    let problem = |severity, message: String, mend: &str| Problem {
        severity,
        path: path.to_owned(),
        place: None,
        field_path: Box::default(),
        message,
        mend: mend.to_owned(),
    };
    let broken = |why: String| {
        problem(Severity::Warning, why, "it is left out; save it again as PNG, JPEG, BMP, TGA or WebP")
    };
    if bytes.is_empty() {
        return Err(broken("the picture file is empty".to_owned()));
    }
    let is_svg = [&b"<svg"[..], b"<?xml"].iter().any(|start| bytes.trim_ascii_start().starts_with(start));
    if is_svg {
        return Err(broken("the picture is SVG or XML text, which is not read".to_owned()));
    }
    let format =
        format_of(path, bytes).ok_or_else(|| broken("the format of the picture is unknown".to_owned()))?;
    let decoder_error = |error: image::ImageError| match error {
        image::ImageError::Limits(_) => over_limit(path, None),
        image::ImageError::Decoding(_) | image::ImageError::IoError(_) => {
            broken("the picture can not be decoded: it is damaged or cut short".to_owned())
        }
        other => broken(format!("the picture can not be decoded: {}", one_line(&other.to_string()))),
    };
    if let Some(size_px) = claimed_png_size(bytes)
        && u64::from(size_px[0]) * u64::from(size_px[1]) > MAX_PIXELS
    {
        return Err(over_limit(path, Some(size_px)));
    }
    let mut limits = Limits::no_limits();
    limits.max_alloc = Some(MAX_DECODER_BYTES);
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    reader.limits(limits);
    let decoder = reader.into_decoder().map_err(decoder_error)?;
    let (width, height) = decoder.dimensions();
    let pixels = u64::from(width) * u64::from(height);
    if pixels == 0 {
        return Err(broken(format!("the picture is {width} x {height} pixels")));
    }
    if pixels > MAX_PIXELS {
        return Err(over_limit(path, Some([width, height])));
    }
    let bytes_needed = decoder.total_bytes();
    if bytes_needed > MAX_DECODER_BYTES {
        let (needed, most) = (bytes_needed.div_ceil(1 << 20), MAX_DECODER_BYTES >> 20);
        let message = format!("the picture takes {needed} MiB to decode; the limit is {most} MiB");
        let mend = "save it with 8 bits a channel, or scale it down".to_owned();
        return Err(Problem { message, mend, ..over_limit(path, None) });
    }
    if format != ImageFormat::WebP && pixels / MAX_PIXELS_PER_BYTE > bytes.len() as u64 {
        return Err(broken(format!(
            "the picture claims {width} x {height} pixels, but has only {} bytes",
            bytes.len()
        )));
    }
    let picture = DynamicImage::from_decoder(decoder).map_err(decoder_error)?;
    let mut warnings = Vec::new();
    let picture = fit(picture, |message| {
        warnings.push(problem(Severity::Warning, message, "scale it down yourself to choose the filter"));
    });
    let picture = picture.into_rgba8();
    let size_px = [picture.width(), picture.height()];
    let mut rgba8: Vec<[u8; 4]> =
        picture.as_raw().chunks_exact(4).map(|p| [p[0], p[1], p[2], p[3]]).collect();
    if rgba8.iter().all(|pixel| pixel[3] == 0) {
        rgba8.iter_mut().for_each(|pixel| pixel[3] = 255);
        warnings.push(problem(
            Severity::Warning,
            "every pixel of the picture is fully transparent".to_owned(),
            "its colours are used as if it were opaque; save it without an alpha channel",
        ));
    }
    Ok(Decoded { texture: Texture { size_px, rgba8 }, warnings })
}

/// Finds, reads and decodes a picture that another file names.
///
/// # Errors
/// Those of [`decode`]. Also a warning if the name is refused, the file is not there or it cannot be read, and a limit
/// if the file is too large.
pub fn read(folders: &AssetFolders, request: &AssetRequest<'_>) -> Result<Decoded, Problem> {
    let asset =
        folders.open(request).map_err(|error| error.to_problem(Severity::Warning, request.beside, None))?;
    decode(&asset.path, &asset.bytes)
}

fn format_of(path: &Path, bytes: &[u8]) -> Option<ImageFormat> {
    // TGA has no signature: only the file's name identifies it.
    image::guess_format(bytes)
        .ok()
        .or_else(|| ImageFormat::from_path(path).ok().filter(|&format| format == ImageFormat::Tga))
        .filter(|format| {
            use ImageFormat::{Bmp, Jpeg, Png, Tga, WebP};
            [Bmp, Jpeg, Png, Tga, WebP].contains(format)
        })
}

/// The size in a PNG's header, read by hand so that a file cut off right after it is still refused for the size it
/// claims.
fn claimed_png_size(bytes: &[u8]) -> Option<[u32; 2]> {
    let header = bytes.strip_prefix(b"\x89PNG\r\n\x1a\n")?.get(4..16)?.strip_prefix(b"IHDR")?;
    let number = |from: usize| {
        u32::from_be_bytes([header[from], header[from + 1], header[from + 2], header[from + 3]])
    };
    Some([number(0), number(4)])
}

fn over_limit(path: &Path, size_px: Option<[u32; 2]>) -> Problem {
    let claim = size_px.map_or("too many".to_owned(), |[width, height]| format!("{width} x {height}"));
    Problem {
        severity: Severity::Limit,
        path: path.to_owned(),
        place: None,
        field_path: Box::default(),
        message: format!("the picture claims {claim} pixels; the limit is {MAX_PIXELS} pixels (8192 x 8192)"),
        mend: "scale the picture down".to_owned(),
    }
}

/// Scales a picture down to [`Texture::MAX_SIDE_PX`].
fn fit(picture: DynamicImage, warn: impl FnOnce(String)) -> DynamicImage {
    let (width, height) = (picture.width(), picture.height());
    let longest = width.max(height);
    if longest <= Texture::MAX_SIDE_PX {
        return picture;
    }
    let scaled = |side: u32| {
        let side = u64::from(side) * u64::from(Texture::MAX_SIDE_PX) / u64::from(longest);
        u32::try_from(side).unwrap_or(Texture::MAX_SIDE_PX).max(1)
    };
    let (to_width, to_height) = (scaled(width), scaled(height));
    warn(format!(
        "the picture is {width} x {height} pixels, more than {} on a side; it is scaled to {to_width} x {to_height}",
        Texture::MAX_SIDE_PX
    ));
    picture.thumbnail_exact(to_width, to_height)
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ").trim_end_matches('.').to_owned()
}
