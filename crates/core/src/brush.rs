//! Brush marks, made by code: what one stroke of a brush leaves on the canvas.
//!
//! A mark is three fields over a rectangle. `u` runs along the stroke from its loaded start, `v` runs across it.
//!
//! * **paint**: where there is paint. It shows where this value is above a threshold: a low threshold gives a wet
//!   stroke, a higher one a dry stroke, the highest a few hairs. Values are equalised, so a threshold of `1 − s` leaves
//!   the share `s` of the paint.
//! * **height**: how thick the paint lies: furrows, paint pushed aside along the edges, a ridge where the brush lifts.
//! * **tint**: streaks where another colour is half mixed in. The middle value changes nothing; values above and below
//!   it change the colour in opposite ways.

mod lattice;
mod marks;
mod picture;

pub use picture::{has_mark, marks_of_picture};

/// The brushes, by name.
pub const NAMES: [&str; 7] = ["flat", "filbert", "round", "fan", "dry", "knife", "rigger"];

/// Texels along and across a mark.
pub const SIZE: [usize; 2] = [256, 96];

/// How many different marks a brush makes.
pub const VARIANTS: u32 = 12;

/// A mark fills this share of its rectangle each way; the rest is room for uneven edges and for a fan's curved end.
pub const FILL: f32 = 0.84;

/// Height of the paint, in brush thicknesses, where a texel's height byte is 255.
pub const HEIGHT_SCALE: f32 = 1.5;

/// One mark: paint, height and tint of every texel, row by row.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mark {
    /// `SIZE[0] × SIZE[1]` texels: paint 0..=255, height in `HEIGHT_SCALE`/255 brush thicknesses, tint around 128.
    pub texels: Vec<[u8; 3]>,
}

/// All marks of a brush by name, the same at every call; `None` for a name that is not in [`NAMES`].
pub fn marks_of(name: &str) -> Option<Vec<Mark>> {
    let index = NAMES.iter().position(|known| *known == name)?;
    Some((0..VARIANTS).map(|variant| mark_of(index, variant)).collect())
}

/// Mark number `variant` (of [`VARIANTS`]) of the brush number `brush` in [`NAMES`].
pub fn mark_of(brush: usize, variant: u32) -> Mark {
    marks::of_brush(brush, variant)
}

/// One texel before it is stored.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Texel {
    paint: f32,
    /// In brush thicknesses.
    height: f32,
    /// −1..1.
    tint: f32,
}

impl Mark {
    /// Where a texel lies: u is 0..1 along the mark, v −1..1 across it; texels near the border lie a little outside.
    fn uv(index: usize) -> [f32; 2] {
        let (column, row) = (index % SIZE[0], index / SIZE[0]);
        let u = ((column as f32 + 0.5) / SIZE[0] as f32 - 0.5) / FILL + 0.5;
        let v = ((row as f32 + 0.5) / SIZE[1] as f32 * 2.0 - 1.0) / FILL;
        [u, v]
    }

    /// Packs texels into bytes. Paint is equalised: each value becomes its rank among all paint of the mark, 0..1.
    fn store(texels: &[Texel]) -> Self {
        // The bits of positive floats sort like their values. Equal paint is sorted by index.
        let key = |(index, texel): (usize, &Texel)| u64::from(texel.paint.to_bits()) << 32 | index as u64;
        let mut inked: Vec<u64> =
            texels.iter().enumerate().filter(|(_, texel)| texel.paint > 0.02).map(key).collect();
        inked.sort_unstable();
        let mut paint = vec![0.0f32; texels.len()];
        let count = inked.len() as f32;
        for (rank, key) in inked.into_iter().enumerate() {
            paint[key as u32 as usize] = (rank as f32 + 0.5) / count;
        }
        let byte = |value: f32| (value.clamp(0.0, 1.0) * 255.0).round() as u8;
        let stored = texels
            .iter()
            .zip(paint)
            .map(|(texel, paint)| {
                [byte(paint), byte(texel.height / HEIGHT_SCALE), byte(texel.tint * 0.5 + 0.5)]
            })
            .collect();
        Self { texels: stored }
    }
}

#[cfg(test)]
mod tests;
