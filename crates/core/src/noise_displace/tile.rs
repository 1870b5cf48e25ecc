//! The tile: a repeating texture that noise is read from. Its values are raw and interpolated bilinearly.

use glam::DVec2;

/// The longest side of a tile: larger pictures are reduced.
const MAX_SIDE: usize = 1024;

/// A repeating texture. Values are taken as they are stored, never decoded from sRGB: noise is not a colour.
#[derive(Clone, Debug, PartialEq)]
pub struct Tile {
    size: [usize; 2],
    /// Red, green, blue and alpha of each texel, the bottom row first.
    texels: Vec<[f32; 4]>,
}

impl Tile {
    /// From texels, bottom row first. There are `size[0] * size[1]` of them, and at least one.
    pub fn new(size: [usize; 2], texels: Vec<[f32; 4]>) -> Self {
        assert!(!texels.is_empty() && texels.len() == size[0] * size[1], "a tile of {size:?}");
        Self { size, texels }
    }

    /// From a picture whose top row comes first. It is halved until no side has more than 1024 texels.
    pub fn of_picture(size_px: [u32; 2], rgba8: &[[u8; 4]]) -> Self {
        let size = size_px.map(|side| side as usize);
        let texels = rgba8.chunks_exact(size[0]).rev().flatten();
        let texels = texels.map(|texel| texel.map(|byte| f32::from(byte) / 255.0)).collect();
        let mut tile = Self::new(size, texels);
        while tile.size.iter().any(|&side| side > MAX_SIDE) {
            tile = tile.halved();
        }
        tile
    }

    fn halved(&self) -> Self {
        let size = self.size.map(|side| side.div_ceil(2));
        let texel = |index: usize| {
            let (x, y) = (index % size[0] * 2, index / size[0] * 2);
            let near = [(x, y), (x + 1, y), (x, y + 1), (x + 1, y + 1)];
            let near = near.map(|(x, y)| self.texels[y % self.size[1] * self.size[0] + x % self.size[0]]);
            std::array::from_fn(|channel| near.iter().map(|texel| texel[channel]).sum::<f32>() * 0.25)
        };
        Self { size, texels: (0..size[0] * size[1]).map(texel).collect() }
    }

    /// Columns and rows.
    pub fn size(&self) -> [usize; 2] {
        self.size
    }

    /// All texels, bottom row first.
    pub fn texels(&self) -> &[[f32; 4]] {
        &self.texels
    }

    /// Width and height of a texel, where the whole texture is 1 by 1.
    pub fn texel(&self) -> DVec2 {
        1.0 / DVec2::new(self.size[0] as f64, self.size[1] as f64)
    }

    /// The value at a point, interpolated bilinearly. The texture is 1 by 1 and repeats; V points up.
    pub fn sample(&self, at: DVec2) -> [f64; 4] {
        let [columns, rows] = self.size;
        let at = (at - at.floor()) * DVec2::new(columns as f64, rows as f64) - 0.5;
        let corner = at.floor();
        let part = at - corner;
        let [x, y] = [(corner.x, columns), (corner.y, rows)]
            .map(|(corner, side)| [0, 1].map(|next| (corner as i64 + next).rem_euclid(side as i64) as usize));
        let texel = |x: usize, y: usize| self.texels[y * columns + x];
        let corners = [texel(x[0], y[0]), texel(x[1], y[0]), texel(x[0], y[1]), texel(x[1], y[1])];
        std::array::from_fn(|channel| {
            let [a, b, c, d] = corners.map(|texel| f64::from(texel[channel]));
            let (low, high) = (a + (b - a) * part.x, c + (d - c) * part.x);
            low + (high - low) * part.y
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texels_lie_where_their_centres_are_and_repeat() {
        let texels: Vec<[f32; 4]> = (0..12).map(|index| [index as f32, 0.0, 0.0, 1.0]).collect();
        let tile = Tile::new([4, 3], texels);
        let at = |x: f64, y: f64| tile.sample(DVec2::new((x + 0.5) / 4.0, (y + 0.5) / 3.0))[0];
        assert!((at(2.0, 1.0) - 6.0).abs() < 1e-12);
        assert!((at(2.5, 1.0) - 6.5).abs() < 1e-12);
        assert!((at(-1.0, -3.0) - 3.0).abs() < 1e-12);
        assert!((at(3.5, 0.0) - 1.5).abs() < 1e-12, "the last texel meets the first");
    }

    #[test]
    fn pictures_are_flipped_to_bottom_up_and_reduced() {
        let tile = Tile::of_picture([1, 2], &[[255; 4], [0; 4]]);
        assert_eq!(tile.texels(), [[0.0; 4], [1.0; 4]]);
        let wide = Tile::of_picture([2050, 1], &[[51; 4]; 2050]);
        assert_eq!(wide.size(), [513, 1]);
        assert!(wide.texels().iter().flatten().all(|value| (value - 0.2).abs() < 1e-6));
    }
}
