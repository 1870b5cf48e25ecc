//! M9, coverage and bleed: is the surface painted, and with its own colour?

use std::collections::BTreeMap;

/// How many pixels of a mask are less than half covered by paint.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Holes {
    /// Pixels of the mask with an alpha below a half.
    pub holes: usize,
    /// Pixels of the mask.
    pub pixels: usize,
}

impl Holes {
    /// Counts the holes where bodies are, from each pixel's alpha of paint and its body id (0 where no body is).
    pub fn of(alpha: &[f32], body_ids: &[u32]) -> Self {
        Self::by_body(alpha, body_ids).into_values().fold(Self::default(), Self::and)
    }

    /// The holes of each body, by its id.
    pub fn by_body(alpha: &[f32], body_ids: &[u32]) -> BTreeMap<u32, Self> {
        let mut found: BTreeMap<u32, Self> = BTreeMap::new();
        for (alpha, &id) in alpha.iter().zip(body_ids).filter(|(_, id)| **id > 0) {
            let of_body = found.entry(id).or_default();
            of_body.pixels += 1;
            of_body.holes += usize::from(*alpha < 0.5);
        }
        found
    }

    /// The sum of these counts and those of another mask.
    pub fn and(self, other: Self) -> Self {
        Self { holes: self.holes + other.holes, pixels: self.pixels + other.pixels }
    }

    /// Holes as a share of the mask.
    pub fn share(&self) -> f64 {
        self.holes as f64 / self.pixels.max(1) as f64
    }
}

/// The bodies of one picture, pixel by pixel.
#[derive(Clone, Copy, Debug)]
pub struct Bodies<'a> {
    /// Width and height in pixels.
    pub size_px: [usize; 2],
    /// Index of the body plus 1, per pixel; 0 where none is.
    pub ids: &'a [u32],
}

impl Bodies<'_> {
    /// Whether all pixels within `reach_px` columns and rows of a pixel show the same body as that pixel.
    pub fn is_inside(&self, index: usize, reach_px: usize) -> bool {
        let [width, height] = self.size_px;
        let (x, y) = (index % width, index / width);
        let id = self.ids[index];
        let columns = x.saturating_sub(reach_px)..=(x + reach_px).min(width - 1);
        columns.into_iter().all(|column| {
            let rows = y.saturating_sub(reach_px)..=(y + reach_px).min(height - 1);
            rows.into_iter().all(|row| self.ids[row * width + column] == id)
        })
    }
}

/// How far paint may run over the border of its body, pixels.
const BORDER_PX: usize = 2;

/// Looks at the painted pixels of bodies, away from the bodies' borders. Returns how many of them have a colour nearer
/// to another body's than to their own body's, and how many there are in all. `paint` is premultiplied;
/// `colors[id - 1]` is the colour of the body `id`.
pub fn bleed(bodies: &Bodies<'_>, paint: &[[f32; 4]], colors: &[[f32; 3]]) -> (usize, usize) {
    let (mut bled, mut pixels) = (0, 0);
    for (index, &[r, g, b, alpha]) in paint.iter().enumerate() {
        let id = bodies.ids[index];
        if id == 0 || alpha < 0.5 || !bodies.is_inside(index, BORDER_PX) {
            continue;
        }
        let color = [r / alpha, g / alpha, b / alpha];
        let away = |other: &[f32; 3]| -> f32 { other.iter().zip(color).map(|(a, b)| (a - b).powi(2)).sum() };
        let own = away(&colors[id as usize - 1]);
        pixels += 1;
        bled += usize::from(colors.iter().any(|other| away(other) < own));
    }
    (bled, pixels)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn holes_are_bare_pixels_of_bodies() {
        let found = Holes::of(&[1.0, 0.4, 0.0, 0.9], &[1, 1, 0, 2]);
        assert_eq!((found.holes, found.pixels), (1, 3));
        assert_eq!(Holes::of(&[], &[]).pixels, 0);
    }

    #[test]
    fn another_bodys_colour_is_bleed_except_at_the_border() {
        let size = 20;
        let ids: Vec<u32> = (0..size * size).map(|index| if index % size < 10 { 1 } else { 2 }).collect();
        let colors = [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
        let bodies = Bodies { size_px: [size, size], ids: &ids };
        let own = |ids: &[u32]| -> Vec<[f32; 4]> {
            ids.iter()
                .map(|&id| {
                    let [r, g, b] = colors[id as usize - 1];
                    [r, g, b, 1.0]
                })
                .collect()
        };
        assert_eq!(bleed(&bodies, &own(&ids), &colors), (0, 16 * size));
        let swapped: Vec<u32> = ids.iter().map(|id| 3 - id).collect();
        let (bled, pixels) = bleed(&bodies, &own(&swapped), &colors);
        assert_eq!(bled, pixels);
    }
}
