//! A picture of the gallery in memory: to be read, cropped, put beside others, reduced, and written with 256 colours.

use std::path::Path;

use anyhow::{Context as _, ensure};
use color_quant::NeuQuant;

/// Free pixels between two panels.
const GAP_PX: usize = 6;

/// How thoroughly 256 colours are looked for: 1 is best, 30 quickest.
const EFFORT: i32 = 3;

/// An opaque picture, four bytes a pixel, top row first.
#[derive(Clone, Debug)]
pub(super) struct Panel {
    pub(super) size_px: [usize; 2],
    rgba8: Vec<[u8; 4]>,
}

impl Panel {
    pub(super) fn read(path: &Path) -> anyhow::Result<Self> {
        let file = std::io::BufReader::new(std::fs::File::open(path)?);
        let mut reader = png::Decoder::new(file).read_info()?;
        let mut bytes = vec![0; reader.output_buffer_size().context("the picture is too large")?];
        let info = reader.next_frame(&mut bytes)?;
        ensure!(info.color_type == png::ColorType::Rgba, "{:?} is no RGBA", info.color_type);
        let rgba8 = bytes.chunks_exact(4).map(|pixel| [pixel[0], pixel[1], pixel[2], 255]).collect();
        Ok(Self { size_px: [info.width as usize, info.height as usize], rgba8 })
    }

    /// The part that begins at `corner`.
    pub(super) fn cropped(&self, corner: [usize; 2], size_px: [usize; 2]) -> anyhow::Result<Self> {
        let fits = (0..2).all(|axis| corner[axis] + size_px[axis] <= self.size_px[axis]);
        ensure!(fits, "a crop of {size_px:?} at {corner:?} lies outside {:?}", self.size_px);
        let rows = (corner[1]..corner[1] + size_px[1]).map(|y| y * self.size_px[0] + corner[0]);
        let rgba8 = rows.flat_map(|first| self.rgba8[first..first + size_px[0]].iter().copied()).collect();
        Ok(Self { size_px, rgba8 })
    }

    /// Panels of one size in rows, on white.
    pub(super) fn side_by_side(panels: &[Self], columns: usize) -> anyhow::Result<Self> {
        let [width, height] = panels.first().context("a picture without a panel")?.size_px;
        ensure!(panels.iter().all(|panel| panel.size_px == [width, height]), "panels of different sizes");
        let rows = panels.len().div_ceil(columns);
        let size_px = [columns * (width + GAP_PX) - GAP_PX, rows * (height + GAP_PX) - GAP_PX];
        let mut rgba8 = vec![[255; 4]; size_px[0] * size_px[1]];
        for (index, panel) in panels.iter().enumerate() {
            let (left, top) = ((index % columns) * (width + GAP_PX), (index / columns) * (height + GAP_PX));
            for (y, row) in panel.rgba8.chunks(width).enumerate() {
                let at = (top + y) * size_px[0] + left;
                rgba8[at..at + width].copy_from_slice(row);
            }
        }
        Ok(Self { size_px, rgba8 })
    }

    /// The same picture at a share of its size: each pixel is the mean of those that it replaces.
    pub(super) fn reduced(&self, percent: usize) -> Self {
        let size_px = self.size_px.map(|side| (side * percent / 100).max(1));
        let span = |at: usize, axis: usize| {
            let first = at * self.size_px[axis] / size_px[axis];
            first..((at + 1) * self.size_px[axis]).div_ceil(size_px[axis]).max(first + 1)
        };
        let pixel = |x: usize, y: usize| {
            let (mut sum, mut count) = ([0u32; 4], 0);
            for py in span(y, 1) {
                for px in span(x, 0) {
                    for (sum, byte) in sum.iter_mut().zip(self.rgba8[py * self.size_px[0] + px]) {
                        *sum += u32::from(byte);
                    }
                    count += 1;
                }
            }
            sum.map(|sum| (sum / count) as u8)
        };
        let rgba8 = (0..size_px[0] * size_px[1]).map(|i| pixel(i % size_px[0], i / size_px[0])).collect();
        Self { size_px, rgba8 }
    }

    pub(super) fn write(&self, path: &Path) -> anyhow::Result<()> {
        let colors = NeuQuant::new(EFFORT, 256, self.rgba8.as_flattened());
        let indices: Vec<u8> = self.rgba8.iter().map(|pixel| colors.index_of(pixel) as u8).collect();
        let file = std::io::BufWriter::new(std::fs::File::create(path)?);
        let mut encoder = png::Encoder::new(file, self.size_px[0] as u32, self.size_px[1] as u32);
        encoder.set_color(png::ColorType::Indexed);
        encoder.set_palette(colors.color_map_rgb());
        encoder.set_compression(png::Compression::High);
        let mut writer = encoder.write_header()?;
        writer.write_image_data(&indices)?;
        writer.finish()?;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A picture whose pixels tell where they are.
    fn numbered(width: usize, height: usize) -> Panel {
        let pixel = |index: usize| [(index % width) as u8, (index / width) as u8, 7, 255];
        Panel { size_px: [width, height], rgba8: (0..width * height).map(pixel).collect() }
    }

    #[test]
    fn crops_and_rows_of_panels_lie_where_they_should() {
        let crop = numbered(20, 10).cropped([5, 3], [4, 2]).unwrap();
        assert_eq!((crop.rgba8[0], crop.rgba8[7]), ([5, 3, 7, 255], [8, 4, 7, 255]));
        assert!(numbered(20, 10).cropped([18, 3], [4, 2]).is_err());
        let sheet = Panel::side_by_side(&[crop.clone(), crop.clone(), crop], 2).unwrap();
        assert_eq!(sheet.size_px, [4 + GAP_PX + 4, 2 + GAP_PX + 2]);
        assert_eq!(sheet.rgba8[4 + GAP_PX], [5, 3, 7, 255]);
        assert_eq!(sheet.rgba8[sheet.size_px[0] * (2 + GAP_PX)], [5, 3, 7, 255]);
        assert_eq!(sheet.rgba8[sheet.rgba8.len() - 1], [255; 4]);
    }

    #[test]
    fn a_reduced_picture_is_the_mean_and_a_written_one_reads_back_near() {
        let half = numbered(8, 4).reduced(50);
        assert_eq!((half.size_px, half.rgba8[0]), ([4, 2], [0, 0, 7, 255]));
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("x.png");
        let picture = numbered(40, 30);
        picture.write(&path).unwrap();
        let mut decoder = png::Decoder::new(std::io::BufReader::new(std::fs::File::open(&path).unwrap()));
        decoder.set_transformations(png::Transformations::EXPAND);
        let mut reader = decoder.read_info().unwrap();
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut bytes).unwrap();
        let differences =
            bytes.chunks_exact(3).zip(&picture.rgba8).flat_map(|(a, b)| (0..3).map(|i| a[i].abs_diff(b[i])));
        let mean = differences.map(f64::from).sum::<f64>() / bytes.len() as f64;
        assert!(mean < 3.0, "256 colours are off by {mean} on average");
    }
}
