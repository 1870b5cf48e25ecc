//! Finds where on a mark there is paint, so that less is drawn. A part of a mark's rectangle is only room for uneven
//! edges, and a dry or faint stroke covers even less. A quad that is cut to the painted box looks the same and covers
//! far fewer pixels.

use impasto_core::brush::SIZE;
use rayon::prelude::*;

use crate::gl::{Format, GlError, Gpu, Texture};

/// A texel of a mark: paint, height, tint, unused.
pub(super) type Texel = [u8; 4];

/// How many thresholds of paint, evenly spaced from 0, have a box of their own; `rotating_strokes/paint.vert` has the
/// same number.
const STEPS: usize = 32;

/// A box: start and end along the mark, then start and end across it, as shares of the mark. Where there is no paint,
/// each start is larger than its end.
type Bounds = [f32; 4];

/// A texture with a row of [`STEPS`] boxes for each mark.
pub(super) fn texture(gpu: &Gpu, marks: &[Vec<Texel>]) -> Result<Texture, GlError> {
    let mut rows: Vec<Bounds> = marks.par_iter().flat_map_iter(|texels| of_mark(texels)).collect();
    // A texture must have at least one row.
    rows.resize(rows.len().max(STEPS), NOWHERE);
    let size_px = [STEPS as u32, (rows.len() / STEPS) as u32];
    Texture::from_texels(gpu, Format::Rgba32F, size_px, bytemuck::cast_slice(&rows))
}

const NOWHERE: Bounds = [1.0, 0.0, 1.0, 0.0];

/// For each threshold of paint, the box around the texels with more paint than that.
fn of_mark(texels: &[Texel]) -> [Bounds; STEPS] {
    let (mut along, mut across) = ([0; SIZE[0]], [0; SIZE[1]]);
    for (y, row) in texels.chunks_exact(SIZE[0]).enumerate() {
        for (x, &[paint, ..]) in row.iter().enumerate() {
            along[x] = paint.max(along[x]);
            across[y] = paint.max(across[y]);
        }
    }
    std::array::from_fn(|step| {
        let more = |&paint: &u8| usize::from(paint) * STEPS > step * 255;
        let span = |most: &[u8]| {
            let first = most.iter().position(more)?;
            let last = most.iter().rposition(more)?;
            Some([first as f32 / most.len() as f32, (last + 1) as f32 / most.len() as f32])
        };
        match (span(&along), span(&across)) {
            (Some([left, right]), Some([low, high])) => [left, right, low, high],
            _ => NOWHERE,
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use impasto_core::brush::marks_of;

    #[test]
    fn all_paint_lies_within_the_bounds_and_some_at_each_of_them() {
        let mark = &marks_of("flat").unwrap()[0];
        let texels: Vec<Texel> = mark.texels.iter().map(|&[a, b, c]| [a, b, c, 0]).collect();
        for (step, [left, right, low, high]) in of_mark(&texels).into_iter().enumerate() {
            let [mut on_left, mut on_right, mut on_low, mut on_high] = [false; 4];
            for (index, &[paint, ..]) in texels.iter().enumerate() {
                if f32::from(paint) / 255.0 <= step as f32 / STEPS as f32 {
                    continue;
                }
                let [u, v] = [(index % SIZE[0], SIZE[0]), (index / SIZE[0], SIZE[1])]
                    .map(|(at, count)| [at as f32 / count as f32, (at + 1) as f32 / count as f32]);
                assert!(u[0] >= left && u[1] <= right && v[0] >= low && v[1] <= high, "step {step}");
                on_left |= u[0] == left;
                on_right |= u[1] == right;
                on_low |= v[0] == low;
                on_high |= v[1] == high;
            }
            let is_empty = left > right;
            assert!(is_empty || (on_left && on_right && on_low && on_high), "step {step}");
        }
        assert_eq!(of_mark(&vec![[0; 4]; SIZE[0] * SIZE[1]])[0], NOWHERE);
    }
}
