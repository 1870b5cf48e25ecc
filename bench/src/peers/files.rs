//! Writes and reads the files through which the benchmarks and their peers exchange arrays: little-endian numbers of
//! four bytes, without a header.

use std::path::Path;

use anyhow::Context as _;
use glam::Vec3;

fn write(path: &Path, words: impl Iterator<Item = [u8; 4]>) -> anyhow::Result<()> {
    let bytes: Vec<u8> = words.flatten().collect();
    std::fs::write(path, bytes).with_context(|| format!("{} cannot be written", path.display()))
}

/// Writes floats.
pub fn write_floats(path: &Path, floats: impl Iterator<Item = f32>) -> anyhow::Result<()> {
    write(path, floats.map(f32::to_le_bytes))
}

/// Writes whole numbers.
pub fn write_words(path: &Path, words: impl Iterator<Item = u32>) -> anyhow::Result<()> {
    write(path, words.map(u32::to_le_bytes))
}

fn read(path: &Path) -> anyhow::Result<Vec<[u8; 4]>> {
    let bytes = std::fs::read(path).with_context(|| format!("{} cannot be read", path.display()))?;
    Ok(bytes.chunks_exact(4).map(|word| [word[0], word[1], word[2], word[3]]).collect())
}

/// Reads floats.
pub fn read_floats(path: &Path) -> anyhow::Result<Vec<f32>> {
    Ok(read(path)?.into_iter().map(f32::from_le_bytes).collect())
}

/// Reads whole numbers.
pub fn read_words(path: &Path) -> anyhow::Result<Vec<u32>> {
    Ok(read(path)?.into_iter().map(u32::from_le_bytes).collect())
}

/// Reads points: x, y, z of each.
pub fn read_points(path: &Path) -> anyhow::Result<Vec<Vec3>> {
    Ok(read_floats(path)?.chunks_exact(3).map(Vec3::from_slice).collect())
}
