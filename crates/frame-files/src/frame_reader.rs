//! Reads frames from PNG files, whoever wrote them. Memory is taken only for as many pixels as a file of that length
//! can hold.

use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};

use impasto_scene::limits::{MAX_PIXELS, MAX_SIDE_PX};
use png::{BitDepth, ColorType, DecodingError, Reader, Transformations};

/// No PNG has more pixels per byte than this: deflate packs at most 1032 : 1, and a pixel has at least one bit.
const MAX_PIXELS_PER_BYTE: u64 = 8 * 1032;

/// How many bits a channel has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Depth {
    /// One byte a channel.
    Eight,
    /// Two bytes a channel, the high one first.
    Sixteen,
}

/// What a file says about its picture before the pixels come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameInfo {
    /// Width and height in pixels.
    pub size_px: [u32; 2],
    /// 16 bits where the file has them, else 8.
    pub depth: Depth,
    /// Whether pixels can be transparent; all of them may be opaque nevertheless.
    pub has_alpha: bool,
}

/// A picture as it stands in its file, as RGBA with straight alpha.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FramePixels {
    /// Width and height in pixels.
    pub size_px: [u32; 2],
    /// How many bits a channel has.
    pub depth: Depth,
    /// Four channels a pixel, row by row from the top.
    pub rgba: Vec<u8>,
}

/// Why a frame cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum FrameFileError {
    /// There is no such file.
    #[error("{} is not there", .0.display())]
    Missing(PathBuf),
    /// The file cannot be opened or read.
    #[error("{} cannot be read: {error}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system said.
        error: std::io::Error,
    },
    /// The file is no PNG, or a broken one.
    #[error("{} is no whole PNG file: {why}; render or save it again", path.display())]
    Broken {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        why: String,
    },
    /// The picture is larger than Impasto's limit.
    #[error(
        "{} claims {} x {} pixels: the limit is {MAX_SIDE_PX} a side and {MAX_PIXELS} in all; scale it down",
        path.display(), size_px[0], size_px[1]
    )]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// The width and height that it claims, in pixels.
        size_px: [u32; 2],
    },
}

/// What a frame's file says before its pixels.
///
/// # Errors
/// What is wrong with the file.
pub fn info(path: &Path) -> Result<FrameInfo, FrameFileError> {
    open(path).map(|(_, info)| info)
}

/// Reads a frame.
///
/// # Errors
/// What is wrong with the file.
pub fn read(path: &Path) -> Result<FramePixels, FrameFileError> {
    let (mut reader, info) = open(path)?;
    let broken = |why: String| FrameFileError::Broken { path: path.to_owned(), why };
    let bytes = reader.output_buffer_size().ok_or_else(|| broken("it is too large".to_owned()))?;
    let mut pixels = vec![0; bytes];
    let output = reader.next_frame(&mut pixels).map_err(|error| decoding(path, error))?;
    pixels.truncate(output.buffer_size());
    let channel_bytes = match info.depth {
        Depth::Eight => 1,
        Depth::Sixteen => 2,
    };
    let rgba = match output.color_type {
        ColorType::Rgba => pixels,
        ColorType::Rgb => with_alpha(&pixels, 3, channel_bytes),
        ColorType::GrayscaleAlpha => of_grey(&pixels, 2, channel_bytes),
        ColorType::Grayscale => of_grey(&pixels, 1, channel_bytes),
        ColorType::Indexed => return Err(broken("its palette is missing".to_owned())),
    };
    Ok(FramePixels { size_px: info.size_px, depth: info.depth, rgba })
}

/// Opens a file, reads it up to its pixels, and checks that the claimed picture fits the file's length.
fn open(path: &Path) -> Result<(Reader<BufReader<File>>, FrameInfo), FrameFileError> {
    let unreadable = |error: std::io::Error| match error.kind() {
        std::io::ErrorKind::NotFound => FrameFileError::Missing(path.to_owned()),
        _ => FrameFileError::Unreadable { path: path.to_owned(), error },
    };
    let there = std::fs::metadata(path).map_err(unreadable)?;
    let broken = |why: String| FrameFileError::Broken { path: path.to_owned(), why };
    if !there.is_file() {
        return Err(broken("it is a folder or a device".to_owned()));
    }
    let file = File::open(path).map_err(unreadable)?;
    let mut decoder = png::Decoder::new(BufReader::new(file));
    decoder.set_transformations(Transformations::EXPAND | Transformations::ALPHA);
    decoder.set_ignore_text_chunk(true);
    decoder.set_ignore_iccp_chunk(true);
    let header = decoder.read_header_info().map_err(|error| decoding(path, error))?;
    let size_px = [header.width, header.height];
    let pixels = u64::from(size_px[0]) * u64::from(size_px[1]);
    if size_px.iter().any(|&side| side > MAX_SIDE_PX) || pixels > MAX_PIXELS {
        return Err(FrameFileError::TooLarge { path: path.to_owned(), size_px });
    }
    if pixels / MAX_PIXELS_PER_BYTE > there.len() {
        let [width, height] = size_px;
        return Err(broken(format!("it claims {width} x {height} pixels in {} bytes", there.len())));
    }
    let reader = decoder.read_info().map_err(|error| decoding(path, error))?;
    let told = reader.info();
    let info = FrameInfo {
        size_px,
        depth: if told.bit_depth == BitDepth::Sixteen { Depth::Sixteen } else { Depth::Eight },
        has_alpha: matches!(told.color_type, ColorType::Rgba | ColorType::GrayscaleAlpha)
            || told.trns.is_some(),
    };
    Ok((reader, info))
}

fn decoding(path: &Path, error: DecodingError) -> FrameFileError {
    match error {
        DecodingError::IoError(error) if error.kind() != std::io::ErrorKind::UnexpectedEof => {
            FrameFileError::Unreadable { path: path.to_owned(), error }
        }
        DecodingError::IoError(_) => {
            FrameFileError::Broken { path: path.to_owned(), why: "it ends too early".to_owned() }
        }
        other => {
            let why = other.to_string().split_whitespace().collect::<Vec<_>>().join(" ");
            FrameFileError::Broken { path: path.to_owned(), why: why.trim_end_matches('.').to_owned() }
        }
    }
}

/// Appends an opaque alpha to each pixel.
fn with_alpha(pixels: &[u8], channels: usize, channel_bytes: usize) -> Vec<u8> {
    let mut rgba = Vec::with_capacity(pixels.len() / channels * 4);
    for pixel in pixels.chunks_exact(channels * channel_bytes) {
        rgba.extend_from_slice(pixel);
        rgba.extend_from_slice(&[255; 2][..channel_bytes]);
    }
    rgba
}

/// Makes RGBA of grey pixels. If they have two channels, the second is alpha.
fn of_grey(pixels: &[u8], channels: usize, channel_bytes: usize) -> Vec<u8> {
    let mut rgba = Vec::with_capacity(pixels.len() / channels * 4);
    for pixel in pixels.chunks_exact(channels * channel_bytes) {
        let (grey, alpha) = pixel.split_at(channel_bytes);
        for _ in 0..3 {
            rgba.extend_from_slice(grey);
        }
        rgba.extend_from_slice(if channels == 2 { alpha } else { &[255; 2][..channel_bytes] });
    }
    rgba
}

impl FramePixels {
    /// Whether every pixel is fully opaque.
    pub fn is_opaque(&self) -> bool {
        match self.depth {
            Depth::Eight => self.rgba.chunks_exact(4).all(|pixel| pixel[3] == u8::MAX),
            Depth::Sixteen => self.rgba.chunks_exact(8).all(|pixel| pixel[6..] == [u8::MAX; 2]),
        }
    }

    /// The same picture at another depth, each value rounded to the nearest.
    #[must_use]
    pub fn at_depth(self, depth: Depth) -> Self {
        let rgba = match (self.depth, depth) {
            (Depth::Eight, Depth::Sixteen) => self.rgba.iter().flat_map(|&value| [value; 2]).collect(),
            (Depth::Sixteen, Depth::Eight) => {
                let value = |pair: &[u8]| u32::from(pair[0]) << 8 | u32::from(pair[1]);
                self.rgba.chunks_exact(2).map(|pair| ((value(pair) + 128) / 257) as u8).collect()
            }
            _ => self.rgba,
        };
        Self { rgba, depth, ..self }
    }

    /// Makes the picture opaque by laying it over black. Blends sRGB values, as most programs do.
    pub fn lay_over_black(&mut self) {
        match self.depth {
            Depth::Eight => {
                for pixel in self.rgba.chunks_exact_mut(4) {
                    let alpha = u32::from(pixel[3]);
                    for value in &mut pixel[..3] {
                        *value = ((u32::from(*value) * alpha + 127) / 255) as u8;
                    }
                    pixel[3] = u8::MAX;
                }
            }
            Depth::Sixteen => {
                for pixel in self.rgba.chunks_exact_mut(8) {
                    let alpha = u64::from(u16::from_be_bytes([pixel[6], pixel[7]]));
                    for pair in pixel[..6].chunks_exact_mut(2) {
                        let value = u64::from(u16::from_be_bytes([pair[0], pair[1]]));
                        pair.copy_from_slice(&(((value * alpha + 32_767) / 65_535) as u16).to_be_bytes());
                    }
                    pixel[6..].fill(u8::MAX);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests;
