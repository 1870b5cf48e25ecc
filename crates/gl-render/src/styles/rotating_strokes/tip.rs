//! The brush: marks of a filbert, made by code. A mark is a height field, not a mask: cut off lower or higher it is a wet
//! or a dry stroke, and at last a few hairs.

use impasto_core::hash;
use impasto_core::presence::smoothstep;

/// Texels along and across a mark.
pub(super) const SIZE: [u32; 2] = [256, 96];

/// How many different marks there are.
pub(super) const COUNT: u32 = 12;

/// Hairs across the tip.
const HAIRS: f32 = 18.0;

/// A mark fills this share of its quad's width; the rest is room for ragged ends.
const FILL: f32 = 0.84;

/// Makes the marks, the same on every machine: height (R) and half-mixed paint (G) of every mark, all marks of a level
/// behind each other, finest level first.
///
/// Heights are spread evenly: a share `h` of a mark's texels with any height lies above `1 − h`.
pub(super) fn levels() -> Vec<Vec<u8>> {
    let [width, height] = SIZE.map(|side| side as usize);
    let mut level: Vec<Vec<[f32; 2]>> = (0..COUNT).map(|number| evened(mark(number))).collect();
    let mut size = [width, height];
    let mut levels = Vec::new();
    loop {
        let bytes =
            level.iter().flatten().flatten().map(|&value| (value.clamp(0.0, 1.0) * 255.0).round() as u8);
        levels.push(bytes.collect());
        if size == [1, 1] {
            return levels;
        }
        let half = size.map(|side| (side / 2).max(1));
        level = level.iter().map(|texels| halved(texels, size, half)).collect();
        size = half;
    }
}

/// Replaces each height by its place among all heights of the mark, 0..1.
fn evened(mut texels: Vec<[f32; 2]>) -> Vec<[f32; 2]> {
    let mut inked: Vec<usize> = (0..texels.len()).filter(|&index| texels[index][0] > 0.02).collect();
    inked.sort_by(|&a, &b| texels[a][0].total_cmp(&texels[b][0]).then(a.cmp(&b)));
    for texel in &mut texels {
        if texel[0] <= 0.02 {
            texel[0] = 0.0;
        }
    }
    let count = inked.len() as f32;
    for (place, index) in inked.into_iter().enumerate() {
        texels[index][0] = (place as f32 + 0.5) / count;
    }
    texels
}

/// Box filter to the next level.
fn halved(texels: &[[f32; 2]], size: [usize; 2], half: [usize; 2]) -> Vec<[f32; 2]> {
    let mut smaller = Vec::with_capacity(half[0] * half[1]);
    for y in 0..half[1] {
        for x in 0..half[0] {
            let mut sum = [0.0; 2];
            for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
                let at = [(2 * x + dx).min(size[0] - 1), (2 * y + dy).min(size[1] - 1)];
                let texel = texels[at[1] * size[0] + at[0]];
                sum = [sum[0] + texel[0], sum[1] + texel[1]];
            }
            smaller.push(sum.map(|value| value * 0.25));
        }
    }
    smaller
}

/// One mark: height and half-mixed paint per texel, row by row.
fn mark(number: u32) -> Vec<[f32; 2]> {
    let [width, height] = SIZE;
    let noise = Noise { seed: hash::combine(number, 0xb4) };
    let mut texels = Vec::with_capacity((width * height) as usize);
    for row in 0..height {
        for column in 0..width {
            // u along the stroke from its loaded start, v across in half widths.
            let u = ((column as f32 + 0.5) / width as f32 - 0.5) / FILL + 0.5;
            let v = ((row as f32 + 0.5) / height as f32 * 2.0 - 1.0) / FILL;
            texels.push(noise.texel(u, v));
        }
    }
    texels
}

struct Noise {
    seed: u32,
}

impl Noise {
    fn texel(&self, u: f32, v: f32) -> [f32; 2] {
        let across = v * 0.5 + 0.5;
        let hairs = 0.4 * self.line(1, across * HAIRS * 2.0)
            + 0.3 * self.line(2, across * HAIRS)
            + 0.3 * self.line(3, across * HAIRS * 4.0);
        let streaks = 0.6
            * (0.55 * self.value(4, u * 2.2, across * HAIRS * 1.3)
                + 0.30 * self.value(5, u * 5.0, across * HAIRS * 2.2)
                + 0.15 * self.value(6, u * 14.0, across * HAIRS * 2.6))
            + 0.4 * hairs;
        // A filbert is a little narrower at its ends, and its edge wanders.
        let half_width = 1.0 - 0.16 * (2.0 * u - 1.0).abs().powi(4);
        // The same at both ends, so that a mark as a whole lies straight.
        let wander = (0.5 * (self.line(7, u * 3.0) + self.line(7, 3.0 - u * 3.0)) - 0.5) * 0.10;
        let side =
            half_width + (self.line(if v > 0.0 { 8 } else { 9 }, u * 9.0) - 0.5) * 0.10 - (v - wander).abs();
        // Rounded ends, ragged by hair; the lifted end more than the loaded one.
        let cap = 1.0 - (1.0 - (v * v).min(1.0)).sqrt();
        let start = u - 0.10 * cap - 0.045 * self.line(10, across * HAIRS);
        let end =
            1.0 - u - 0.14 * cap - 0.10 * self.line(11, across * HAIRS) - 0.03 * self.line(12, across * 5.0);
        let aspect = 5.0;
        let body = (start * aspect / 0.4).min(end * aspect / 0.68).min(side / 0.16).clamp(0.0, 1.0);
        let dryness = 0.06 + 0.30 * u.clamp(0.0, 1.0).powf(1.6);
        let height = smoothstep(body) * (1.0 - dryness * (1.0 - streaks) * 1.25).max(0.0);
        let mixed = 0.6 * self.value(13, u * 1.2, across * HAIRS / 3.0) + 0.4 * streaks;
        [height, mixed]
    }

    /// Value noise along a line, 0..1, one cycle a unit.
    fn line(&self, which: u32, at: f32) -> f32 {
        self.value(which, at, 0.5)
    }

    /// Value noise, 0..1, one cycle a unit.
    fn value(&self, which: u32, x: f32, y: f32) -> f32 {
        let (column, row) = (x.floor(), y.floor());
        let lattice = |dx: f32, dy: f32| {
            let key = hash::combine((column + dx) as i32 as u32, (row + dy) as i32 as u32);
            hash::unit(hash::combine(hash::combine(self.seed, which), key))
        };
        let (fx, fy) = (smoothstep(x - column), smoothstep(y - row));
        let mix = |a: f32, b: f32, t: f32| a + (b - a) * t;
        mix(mix(lattice(0.0, 0.0), lattice(1.0, 0.0), fx), mix(lattice(0.0, 1.0), lattice(1.0, 1.0), fx), fy)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_differ_and_end_inside_their_quads() {
        let marks: Vec<_> = (0..COUNT).map(mark).collect();
        for (number, texels) in marks.iter().enumerate() {
            assert_ne!(texels, &marks[(number + 1) % marks.len()]);
            let [width, height] = SIZE.map(|side| side as usize);
            let on_border = |index: usize| {
                let (x, y) = (index % width, index / width);
                x == 0 || y == 0 || x == width - 1 || y == height - 1
            };
            for (index, texel) in texels.iter().enumerate() {
                assert!(texel[0].is_finite() && texel[1].is_finite());
                assert!(!on_border(index) || texel[0] < 0.02, "mark {number} is cut off by its quad");
            }
            let inked = texels.iter().filter(|texel| texel[0] > 0.2).count() as f32 / texels.len() as f32;
            assert!((0.4..0.75).contains(&inked), "mark {number} fills {inked} of its quad");
        }
    }

    #[test]
    fn heights_are_spread_evenly() {
        for number in 0..COUNT {
            let heights: Vec<f32> =
                evened(mark(number)).iter().map(|texel| texel[0]).filter(|&h| h > 0.0).collect();
            for share in [0.02, 0.1, 0.5, 0.9] {
                let above = heights.iter().filter(|&&height| height > 1.0 - share).count() as f32;
                assert!((above / heights.len() as f32 - share).abs() < 0.001);
            }
        }
    }
}
