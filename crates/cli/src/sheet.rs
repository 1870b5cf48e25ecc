//! A contact sheet: small copies of all frames in rows.

use impasto_gl_render::Picture;

/// The longest side of a small copy and the gap between two copies, in pixels.
const SMALL_PX: u32 = 240;
const GAP_PX: u32 = 6;

/// What is seen between the copies.
const GROUND: [u8; 4] = [24, 24, 24, 255];

/// The most frames on one sheet. Of more frames, only every second, third, … is shown.
const MAX_COPIES: u64 = 144;

pub(crate) struct Sheet {
    stride: u64,
    seen: u64,
    columns: u32,
    small_px: [u32; 2],
    copies: Vec<Vec<[u8; 4]>>,
}

impl Sheet {
    pub(crate) fn new(frames: u64, size_px: [u32; 2]) -> Self {
        let stride = frames.div_ceil(MAX_COPIES).max(1);
        let shown = frames.div_ceil(stride).max(1);
        let scale = f64::from(SMALL_PX) / f64::from(size_px[0].max(size_px[1]));
        let small_px = size_px.map(|side| ((f64::from(side) * scale.min(1.0)).round() as u32).max(1));
        Self { stride, seen: 0, columns: (shown as f64).sqrt().ceil() as u32, small_px, copies: Vec::new() }
    }

    pub(crate) fn add(&mut self, picture: &Picture) {
        if self.shows_next() {
            self.copies.push(reduced(picture, self.small_px));
        }
        self.seen += 1;
    }

    pub(crate) fn shows_next(&self) -> bool {
        self.seen.is_multiple_of(self.stride)
    }

    /// Leaves the place of the next frame empty, if it has one.
    pub(crate) fn leave_out(&mut self) {
        if self.shows_next() {
            self.copies.push(vec![GROUND; self.small_px[0] as usize * self.small_px[1] as usize]);
        }
        self.seen += 1;
    }

    pub(crate) fn picture(&self) -> Picture {
        let [width, height] = self.small_px;
        let rows = (self.copies.len() as u32).div_ceil(self.columns).max(1);
        let size_px = [self.columns * (width + GAP_PX) + GAP_PX, rows * (height + GAP_PX) + GAP_PX];
        let mut pixels = vec![GROUND; size_px[0] as usize * size_px[1] as usize];
        for (index, copy) in self.copies.iter().enumerate() {
            let (column, row) = (index as u32 % self.columns, index as u32 / self.columns);
            let (left, top) = (GAP_PX + column * (width + GAP_PX), GAP_PX + row * (height + GAP_PX));
            for (y, line) in copy.chunks(width as usize).enumerate() {
                let at = (top as usize + y) * size_px[0] as usize + left as usize;
                pixels[at..at + line.len()].copy_from_slice(line);
            }
        }
        Picture { size_px, rgba8: pixels.concat() }
    }
}

/// A small copy: each of its pixels is the mean of the pixels that it covers, colours weighted by their alpha.
fn reduced(picture: &Picture, small_px: [u32; 2]) -> Vec<[u8; 4]> {
    let [width, height] = picture.size_px;
    let span = |at: u32, small: u32, whole: u32| {
        let first = u64::from(at) * u64::from(whole) / u64::from(small);
        let last = (u64::from(at + 1) * u64::from(whole) / u64::from(small)).max(first + 1);
        first as u32..(last as u32).min(whole)
    };
    let mut small = Vec::with_capacity(small_px[0] as usize * small_px[1] as usize);
    for y in 0..small_px[1] {
        for x in 0..small_px[0] {
            let (mut colour, mut alpha, mut count) = ([0u32; 3], 0, 0);
            for py in span(y, small_px[1], height) {
                for px in span(x, small_px[0], width) {
                    let at = (py as usize * width as usize + px as usize) * 4;
                    let [r, g, b, a] = std::array::from_fn(|channel| u32::from(picture.rgba8[at + channel]));
                    for (sum, byte) in colour.iter_mut().zip([r, g, b]) {
                        *sum += byte * a;
                    }
                    (alpha, count) = (alpha + a, count + 1);
                }
            }
            let [r, g, b] = colour.map(|sum| (sum / alpha.max(1)) as u8);
            small.push([r, g, b, (alpha / count.max(1)) as u8]);
        }
    }
    small
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_clear_does_not_darken_its_neighbours() {
        let half = Picture { size_px: [2, 1], rgba8: vec![255, 255, 255, 255, 255, 0, 0, 0] };
        assert_eq!(reduced(&half, [1, 1]), [[255, 255, 255, 127]]);
    }

    #[test]
    fn a_frame_that_is_left_out_keeps_its_place() {
        let grey = |value: u8| Picture { size_px: [1, 1], rgba8: vec![value, value, value, 255] };
        let mut sheet = Sheet::new(3, [1, 1]);
        sheet.add(&grey(100));
        sheet.leave_out();
        sheet.add(&grey(200));
        let picture = sheet.picture();
        let at = |column: u32, row: u32| {
            let [x, y] = [column, row].map(|place| GAP_PX + place * (1 + GAP_PX));
            picture.rgba8[((y * picture.size_px[0] + x) * 4) as usize]
        };
        assert_eq!([at(0, 0), at(1, 0), at(0, 1)], [100, GROUND[0], 200]);
    }
}
