//! Brushes made from the user's own pictures.

use super::marks::Streaks;
use super::{Mark, SIZE, Texel, VARIANTS};
use crate::hash;

/// How many hairs draw the streaks over the picture. Each mark has streaks of its own, so that no two are alike.
const HAIRS: f32 = 16.0;

/// A picture whose emptiest and fullest texels differ by less than this (of 255) holds no mark.
const LEAST_CONTRAST: f32 = 8.0;

/// Whether a picture holds a mark, that is, has enough contrast in lightness times opacity. `rgba8` holds
/// `size_px[0] * size_px[1]` texels with straight alpha, top row first.
pub fn has_mark(size_px: [u32; 2], rgba8: &[[u8; 4]]) -> bool {
    let texels = size_px[0] as usize * size_px[1] as usize;
    let grey = rgba8.iter().take(texels).map(paint_of);
    let (least, most) =
        grey.fold((f32::MAX, 0.0f32), |(least, most), grey| (least.min(grey), most.max(grey)));
    most - least >= LEAST_CONTRAST / 255.0
}

/// The marks of a brush that is a picture. A texel holds as much paint as its lightness times its opacity; a dark mark
/// on a light background is inverted. The picture is stretched over the stroke, its left edge at the stroke's start.
/// Empty if `rgba8` has fewer texels than the size says, or if a side is 0.
pub fn marks_of_picture(size_px: [u32; 2], rgba8: &[[u8; 4]]) -> Vec<Mark> {
    let [width, height] = size_px.map(|side| side as usize);
    let grey: Vec<f32> = rgba8.iter().map(paint_of).collect();
    if grey.len() < width * height || width * height == 0 {
        return Vec::new();
    }
    let on_border = |index: &usize| {
        let (x, y) = (index % width, index / width);
        x == 0 || y == 0 || x == width - 1 || y == height - 1
    };
    let mean = |values: &mut dyn Iterator<Item = f32>| {
        let (sum, count) =
            values.fold((0.0f64, 0u32), |(sum, count), value| (sum + f64::from(value), count + 1));
        sum / f64::from(count.max(1))
    };
    let border = mean(&mut (0..grey.len()).filter(on_border).map(|index| grey[index]));
    let is_dark_on_light = border > 0.5 && border > mean(&mut grey.iter().copied());
    let (least, most) = grey.iter().fold((1.0f32, 0.0f32), |(low, high), &g| (low.min(g), high.max(g)));
    let paint_at = |u: f32, v: f32| {
        if !(0.0..1.0).contains(&u) || !(-1.0..1.0).contains(&v) {
            return 0.0;
        }
        // The texels of the picture under one texel of the mark, roughly: a large picture is averaged.
        let span = |at: f32, ours: f32, theirs: usize| {
            let first = ((at - 0.5 / ours).max(0.0) * theirs as f32) as usize;
            let last = ((at + 0.5 / ours) * theirs as f32).ceil() as usize;
            first.min(theirs - 1)..last.clamp(first.min(theirs - 1) + 1, theirs)
        };
        let (columns, rows) = (span(u, SIZE[0] as f32, width), span(0.5 - 0.5 * v, SIZE[1] as f32, height));
        let texels = rows.flat_map(|row| columns.clone().map(move |column| row * width + column));
        let grey = mean(&mut texels.map(|index| grey[index])) as f32;
        let even = (grey - least) / (most - least).max(1e-6);
        if is_dark_on_light { 1.0 - even } else { even }
    };
    let uvs: Vec<[f32; 2]> = (0..SIZE[0] * SIZE[1]).map(Mark::uv).collect();
    let paint: Vec<f32> = uvs.iter().map(|&[u, v]| paint_at(u, v)).collect();
    (0..VARIANTS)
        .map(|variant| {
            let streaks = Streaks::new(hash::combine(0x9c, variant), HAIRS);
            let texels: Vec<Texel> = uvs
                .iter()
                .zip(&paint)
                .map(|(&[u, v], &paint)| {
                    let (hairs, mixed) = streaks.at(u, v * 0.5 + 0.5);
                    let paint = paint * (0.75 + 0.25 * hairs);
                    let tint = 0.6 * mixed + 0.4 * (hairs * 2.0 - 1.0);
                    Texel { paint, height: paint * (0.4 + 0.4 * hairs), tint }
                })
                .collect();
            Mark::store(&texels)
        })
        .collect()
}

/// How much paint a texel stands for, 0..1.
fn paint_of(rgba: &[u8; 4]) -> f32 {
    let [r, g, b, a] = rgba.map(f32::from);
    (0.2126 * r + 0.7152 * g + 0.0722 * b) * a / (255.0 * 255.0)
}
