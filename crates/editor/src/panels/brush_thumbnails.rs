//! Thumbnails of brushes: one stroke of each, white on transparent, so that a control can tint it.

use std::collections::BTreeMap;
use std::sync::Arc;

use egui::{Color32, ColorImage, Context, Id, TextureHandle, TextureOptions};
use impasto_core::brush::{self, Mark, SIZE};
use impasto_scene::loaded::LoadedScene;
use impasto_scene::mesh_file::Texture;

/// The size of a thumbnail in texels, two per point.
const WIDTH: usize = 80;
const HEIGHT: usize = 60;
/// How far the stroke is turned, in radians, and its length as a share of the thumbnail's width.
const TURN_RAD: f32 = -0.3;
const LENGTH: f32 = 0.9;
/// Texels with no more paint than this stay empty: the stroke then has holes, as from a brush that is not quite full.
const LEAST_PAINT: u8 = 24;

/// For each brush, its picture if it is read from a file, and its thumbnail.
type Known = BTreeMap<String, (Option<Arc<Texture>>, TextureHandle)>;

/// The thumbnail of a brush, by its name in a scene; cached. None if the brush is neither built in nor in the scene.
pub fn thumbnail(ctx: &Context, name: &str, loaded: &LoadedScene) -> Option<TextureHandle> {
    let known: Arc<Known> = ctx.data_mut(|data| data.get_temp(key())).unwrap_or_default();
    let picture = loaded.brushes.get(name);
    // A file that is read again gives a new `Texture`, at another address.
    let is_same = |of: &Option<Arc<Texture>>| of.as_ref().map(Arc::as_ptr) == picture.map(Arc::as_ptr);
    if let Some((_, handle)) = known.get(name).filter(|(of, _)| is_same(of)) {
        return Some(handle.clone());
    }
    let mark = match picture {
        Some(picture) => mark_of(picture)?,
        None => brush::marks_of(name)?.into_iter().next()?,
    };
    let handle = ctx.load_texture(format!("brush {name}"), image(&mark), TextureOptions::LINEAR);
    let mut known = (*known).clone();
    known.retain(|name, (of, _)| of.is_none() || loaded.brushes.contains_key(name));
    known.insert(name.to_owned(), (picture.cloned(), handle.clone()));
    ctx.data_mut(|data| data.insert_temp(key(), Arc::new(known)));
    Some(handle)
}

/// Shares the thumbnails of one context with another, which lays controls out but is never drawn.
pub(super) fn share(from: &Context, with: &Context) {
    if let Some(known) = from.data(|data| data.get_temp::<Arc<Known>>(key())) {
        with.data_mut(|data| data.insert_temp(key(), known));
    }
}

fn key() -> Id {
    Id::unique("brush thumbnails")
}

fn mark_of(picture: &Texture) -> Option<Mark> {
    brush::marks_of_picture(picture.size_px, &picture.rgba8).into_iter().next()
}

/// Draws the mark as a stroke across the thumbnail; ridges of paint are lighter than furrows.
fn image(mark: &Mark) -> ColorImage {
    const SAMPLES: usize = 3;
    let (sin, cos) = TURN_RAD.sin_cos();
    let texels_per_texel = SIZE[0] as f32 / (WIDTH as f32 * LENGTH);
    let texel_at = |x: f32, y: f32| {
        let (x, y) = (x - WIDTH as f32 / 2.0, y - HEIGHT as f32 / 2.0);
        let along = (x * cos + y * sin) * texels_per_texel + SIZE[0] as f32 / 2.0;
        let across = (y * cos - x * sin) * texels_per_texel + SIZE[1] as f32 / 2.0;
        let inside = along >= 0.0 && across >= 0.0 && along < SIZE[0] as f32 && across < SIZE[1] as f32;
        inside.then(|| mark.texels[across as usize * SIZE[0] + along as usize])
    };
    let mut pixels = Vec::with_capacity(WIDTH * HEIGHT);
    for row in 0..HEIGHT {
        for column in 0..WIDTH {
            let (mut covered, mut light) = (0.0f32, 0.0f32);
            for sample in 0..SAMPLES * SAMPLES {
                let at = |index: usize| (index as f32 + 0.5) / SAMPLES as f32;
                let x = column as f32 + at(sample % SAMPLES);
                let y = row as f32 + at(sample / SAMPLES);
                if let Some([paint, height, _]) = texel_at(x, y)
                    && paint > LEAST_PAINT
                {
                    covered += 1.0;
                    light += 0.72 + 0.28 * f32::from(height) / 255.0 * brush::HEIGHT_SCALE.min(1.5);
                }
            }
            let alpha = covered / (SAMPLES * SAMPLES) as f32;
            let light = if covered > 0.0 { (light / covered).min(1.0) } else { 0.0 };
            let grey = (light * 255.0).round() as u8;
            pixels.push(Color32::from_rgba_unmultiplied(grey, grey, grey, (alpha * 255.0).round() as u8));
        }
    }
    ColorImage::new([WIDTH, HEIGHT], pixels)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_built_in_brush_shows_a_stroke_of_its_own() {
        let mut seen: Vec<ColorImage> = Vec::new();
        for name in brush::NAMES {
            let mark = brush::marks_of(name).expect("a built-in brush").swap_remove(0);
            let image = image(&mark);
            let inked = image.pixels.iter().filter(|pixel| pixel.a() > 128).count();
            let share = inked as f32 / image.pixels.len() as f32;
            assert!((0.05..0.6).contains(&share), "{name} inks {share} of its thumbnail");
            assert!(seen.iter().all(|other| other.pixels != image.pixels), "{name} looks like another");
            seen.push(image);
        }
    }
}
