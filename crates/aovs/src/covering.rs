//! What shows in each pixel of the finished picture: which strokes, how much of each, and how much of the ground under
//! them.

use std::collections::BTreeSet;

use impasto_gl_render::{PaintSurface, PaintedLayer, PixelShares, ReferencePixels, Share};
use impasto_painting::Frame;
use impasto_painting::frame::LayerKind;
use impasto_scene::aovs::{Aov, AovSet};
use rayon::prelude::*;

use crate::cryptomatte::{Matte, id_bits};
use crate::drawn::{Drawn, Found};

/// A stroke that covers a smaller share of a pixel is dropped there, before shares are averaged at borders.
const LEAST_SHARE: f32 = 1.0 / 1024.0;

/// A stroke is listed by name only if it covers more than this of some pixel.
const LEAST_NAMED: f32 = 1.0 / 255.0;

/// The name, in the region matte, of strokes that are in no region of the scene.
const NO_REGION: &str = "everything else";

/// What shows in each pixel, top row first.
pub(crate) struct Covering {
    /// How much of each pixel each stroke covers.
    pub(crate) shares: PixelShares,
    /// The share of each pixel that shows the toned ground.
    pub(crate) ground: Vec<f32>,
    /// The body that the ground in each pixel belongs to: its index plus 1, or 0 for none.
    body_id: Vec<u32>,
}

impl Covering {
    pub(crate) fn new(
        drawn: &Drawn<'_>,
        layers: Vec<PaintedLayer>,
        surface: &PaintSurface,
        reference: ReferencePixels,
    ) -> Self {
        let width = drawn.frame.size_px[0] as usize;
        let (laid, bare) = all_layers(&layers, width, surface.is_border.len());
        drop(layers);
        let (shares, bare) = mixed_at_borders(laid, &bare, &surface.is_border, width);
        let is_toned = drawn.frame.finish.ground.is_some();
        let body_id = reference.body_id;
        let ground = bare
            .iter()
            .zip(&surface.ground)
            .zip(&body_id)
            .map(|((bare, ground), &id)| if is_toned && id > 0 { bare * f32::from(ground[3]) } else { 0.0 })
            .collect();
        Self { shares, ground, body_id }
    }

    pub(crate) fn add_mattes(&self, drawn: &Drawn<'_>, wanted: AovSet, found: &mut Found) {
        let (frame, scene) = (drawn.frame, drawn.painting.scene());
        let mut add = |matte: &Matte, of_stroke: &[u32], of_ground: &(dyn Fn(usize) -> u32 + Sync)| {
            found.channels.extend(matte.channels(self.ground.len(), |pixel, list| {
                let shares = self.shares.of(pixel).iter();
                list.extend(shares.map(|share| (of_stroke[share.stroke as usize], share.amount)));
                if self.ground[pixel] > 0.0 {
                    list.push((of_ground(pixel), self.ground[pixel]));
                }
            }));
            found.notes.extend(matte.notes());
        };
        let object_of = |id: u32| &scene.objects[id as usize - 1].name;
        // The ground takes its material and its region from a stroke: of the strokes on the same body, the one that
        // shows most in the pixel.
        let near = |pixel: usize, of_stroke: &[u32]| {
            let id = self.body_id[pixel];
            let on_body = |share: &&Share| frame.strokes[share.stroke as usize].body_id == id;
            let shares = self.shares.of(pixel).iter().filter(on_body);
            let most = shares.max_by(|left, right| left.amount.total_cmp(&right.amount));
            most.map(|share| of_stroke[share.stroke as usize])
        };
        if wanted.has(Aov::CryptoObject) {
            let matte = Matte::new("CryptoObject", scene.objects.iter().map(|object| object.name.as_str()));
            let bits: Vec<u32> = scene.objects.iter().map(|object| id_bits(&object.name)).collect();
            let of_stroke: Vec<u32> =
                frame.strokes.iter().map(|stroke| bits[stroke.body_id as usize - 1]).collect();
            add(&matte, &of_stroke, &|pixel| bits[self.body_id[pixel] as usize - 1]);
        }
        if wanted.has(Aov::CryptoMaterial) {
            let materials = materials(drawn);
            let matte = Matte::new("CryptoMaterial", materials.iter().flatten().map(String::as_str));
            let of_stroke: Vec<u32> = (0..frame.strokes.len())
                .into_par_iter()
                .map(|index| {
                    let stroke = &frame.strokes[index];
                    let particle = frame.sources[index].particle as usize;
                    let object = stroke.body_id as usize - 1;
                    id_bits(drawn.painting.material_of(object, kind_of(frame, index), particle))
                })
                .collect();
            let first: Vec<u32> = materials.iter().map(|names| id_bits(&names[0])).collect();
            add(&matte, &of_stroke, &|pixel| {
                near(pixel, &of_stroke).unwrap_or(first[self.body_id[pixel] as usize - 1])
            });
        }
        if wanted.has(Aov::CryptoRegion) {
            let names = scene.regions.iter().map(|region| region.name.as_str()).chain([NO_REGION]);
            let bits: Vec<u32> = names.clone().map(id_bits).collect();
            let of_stroke: Vec<u32> =
                frame.sources.iter().map(|source| bits[source.region as usize]).collect();
            add(&Matte::new("CryptoRegion", names), &of_stroke, &|pixel| {
                near(pixel, &of_stroke).unwrap_or(bits[bits.len() - 1])
            });
        }
        if wanted.has(Aov::CryptoStroke) {
            let names = stroke_names(drawn);
            let mut shown = vec![false; names.len()];
            for share in self.shares.shares.iter().filter(|share| share.amount > LEAST_NAMED) {
                shown[share.stroke as usize] = true;
            }
            let of_ground: Vec<String> =
                scene.objects.iter().map(|object| format!("ground/{}", object.name)).collect();
            let of_shown = names.iter().zip(shown).filter(|(_, shown)| *shown).map(|(name, _)| name);
            let matte = Matte::new("CryptoStroke", of_shown.chain(&of_ground).map(String::as_str));
            let of_stroke: Vec<u32> = names.par_iter().map(|name| id_bits(name)).collect();
            add(&matte, &of_stroke, &|pixel| id_bits(&format!("ground/{}", object_of(self.body_id[pixel]))));
        }
    }
}

/// A name for each stroke of a frame, the same in every frame of the scene: layer, object, number.
pub(crate) fn stroke_names(drawn: &Drawn<'_>) -> Vec<String> {
    let scene = drawn.painting.scene();
    let name = |index: usize| {
        let object = &scene.objects[drawn.frame.strokes[index].body_id as usize - 1].name;
        let kind = kind_of(drawn.frame, index).name();
        format!("{kind}/{object}/{}", drawn.frame.sources[index].particle)
    };
    (0..drawn.frame.strokes.len()).into_par_iter().map(name).collect()
}

/// The layer of paint of a stroke.
pub(crate) fn kind_of(frame: &Frame, stroke: usize) -> LayerKind {
    let after = frame.layers.partition_point(|run| run.first as usize <= stroke);
    frame.layers[after.max(1) - 1].kind
}

/// The names of the materials of each object; at least one.
fn materials(drawn: &Drawn<'_>) -> Vec<Vec<String>> {
    let scene = drawn.painting.scene();
    let of_object = |index: usize| {
        let own = &scene.objects[index].name;
        let materials = &drawn.painting.surface(index).materials;
        let names =
            materials.iter().map(|material| if material.name.is_empty() { own } else { &material.name });
        let names: BTreeSet<&String> = names.collect();
        if names.is_empty() { vec![own.clone()] } else { names.into_iter().cloned().collect() }
    };
    (0..scene.objects.len()).map(of_object).collect()
}

/// Lays all layers over each other. Returns what shows of each stroke, and how much of each pixel no paint covers.
fn all_layers(layers: &[PaintedLayer], width: usize, pixels: usize) -> (PixelShares, Vec<f32>) {
    let rows = (0..pixels / width).into_par_iter().map(|row| {
        let (mut counts, mut shares, mut bare) = (Vec::with_capacity(width), Vec::new(), Vec::new());
        for pixel in row * width..(row + 1) * width {
            let before = shares.len();
            let mut through = 1.0;
            for layer in layers.iter().rev() {
                let seen = layer
                    .shares
                    .of(pixel)
                    .iter()
                    .map(|share| Share { amount: share.amount * through, ..*share });
                shares.extend(seen.filter(|share| share.amount >= LEAST_SHARE));
                through *= 1.0 - f32::from(layer.rgba[pixel][3]);
            }
            counts.push((shares.len() - before) as u32);
            bare.push(through);
        }
        ((counts, shares), bare)
    });
    let (rows, bare): (Vec<_>, Vec<Vec<f32>>) = rows.unzip();
    (PixelShares::from_rows(rows), bare.concat())
}

/// Averages the shares over 3 × 3 pixels at the borders of bodies, as the finished picture averages its colours there.
fn mixed_at_borders(
    laid: PixelShares,
    bare: &[f32],
    is_border: &[bool],
    width: usize,
) -> (PixelShares, Vec<f32>) {
    let height = is_border.len() / width;
    let rows = (0..height).into_par_iter().map(|row| {
        let (mut counts, mut shares, mut left) = (Vec::with_capacity(width), Vec::new(), Vec::new());
        let mut mixed: Vec<Share> = Vec::new();
        for column in 0..width {
            let pixel = row * width + column;
            if !is_border[pixel] {
                shares.extend_from_slice(laid.of(pixel));
                counts.push(laid.of(pixel).len() as u32);
                left.push(bare[pixel]);
                continue;
            }
            mixed.clear();
            let mut open = 0.0;
            for tap in 0..9usize {
                let step = |at: usize, by: usize, sides: usize| (at + by).saturating_sub(1).min(sides - 1);
                let there = step(row, tap / 3, height) * width + step(column, tap % 3, width);
                let weight = [1.0, 2.0, 1.0][tap / 3] * [1.0, 2.0, 1.0][tap % 3] / 16.0;
                open += bare[there] * weight;
                let of_tap = laid.of(there).iter();
                mixed.extend(of_tap.map(|share| Share { amount: share.amount * weight, ..*share }));
            }
            mixed.sort_by_key(|share| std::cmp::Reverse(share.stroke));
            mixed.dedup_by(|next, kept| {
                let same = next.stroke == kept.stroke;
                if same {
                    kept.amount += next.amount;
                }
                same
            });
            shares.extend_from_slice(&mixed);
            counts.push(mixed.len() as u32);
            left.push(open);
        }
        ((counts, shares), left)
    });
    let (rows, left): (Vec<_>, Vec<Vec<f32>>) = rows.unzip();
    (PixelShares::from_rows(rows), left.concat())
}
