//! Materials of a glTF file as Impasto has them: a colour, a picture, a gloss, and whether light falls on it.

use std::path::Path;
use std::sync::Arc;

use impasto_core::color::srgb_from_linear;
use impasto_gltf::{AlphaMode, Gltf, Material as Stated, Sampler, TextureUse};

use crate::mesh_file::{Material, Texture};
use crate::problem::{Problem, Severity};
use crate::texture;

/// The colour (sRGB) of whatever has no material, as in OBJ files.
const GREY: [f32; 3] = [0.8; 3];

/// Fully smooth metal is darkened by this share of its colour.
const METAL_DARK: f32 = 0.2;

/// A surface glows if its emission is brighter than its colour times this. It is then drawn by its emission alone.
const GLOWS: f32 = 1.0;

/// The file's materials, and last the one for primitives that name none. Pictures that cannot be used are left out with
/// a warning.
pub(super) fn of(path: &Path, gltf: &Gltf, warnings: &mut Vec<Problem>) -> Vec<Material> {
    let mut pictures: Vec<Option<Option<Arc<Texture>>>> = vec![None; gltf.images.len()];
    let mut picture = |index: usize, warnings: &mut Vec<Problem>| -> Option<Arc<Texture>> {
        pictures[index].get_or_insert_with(|| decoded(path, gltf, index, warnings)).clone()
    };
    let mut materials: Vec<Material> = Vec::with_capacity(gltf.materials.len() + 1);
    for stated in &gltf.materials {
        let glows = glows(stated);
        let used = shown_picture(stated).map(|used| &gltf.textures[used.texture]);
        let texture = used.and_then(|used| used.image).and_then(|image| picture(image, warnings));
        let sampler = used.map_or(Sampler::default(), |used| used.sampler);
        // Alpha is in the base colour's picture, which a glowing surface does not show. Only a cutoff that hides
        // everything still counts.
        let cutoff = cutoff(stated).filter(|cutoff| !glows || *cutoff > 1.0);
        if stated.alpha == AlphaMode::Blend && cutoff.is_some_and(|cutoff| cutoff > 1.0) {
            warnings.push(unseen(path, materials.len(), &stated.name));
        }
        materials.push(Material { texture, sampler, cutoff, ..plain(stated, glows) });
    }
    materials.push(Material::plain(String::new(), GREY));
    materials
}

/// The alpha of the picture below which there is no surface; `None` for an opaque material. A stroke cannot be half
/// there, so a blended material is cut off where it is half transparent.
fn cutoff(stated: &Stated) -> Option<f32> {
    const HALF: f32 = 0.5;
    let of_all = match stated.alpha {
        AlphaMode::Opaque => return None,
        AlphaMode::Mask(cutoff) => cutoff,
        AlphaMode::Blend => HALF,
    };
    Some(of_all / stated.values.base_color[3].max(1e-6))
}

fn unseen(path: &Path, index: usize, name: &str) -> Problem {
    Problem {
        severity: Severity::Warning,
        path: path.to_owned(),
        place: None,
        field_path: Box::default(),
        message: format!(
            "/materials/{index}: {name:?} is more than half clear, as glass is: it is not painted"
        ),
        mend: "to paint it, make its alpha at least 0.5, or give its object a colour in the scene".to_owned(),
    }
}

/// The picture that the surface shows: that of its emission if it glows, else that of its colour.
pub(super) fn shown_picture(stated: &Stated) -> Option<TextureUse> {
    if glows(stated) { stated.emissive_texture } else { stated.base_color_texture }
}

fn glows(stated: &Stated) -> bool {
    let most = |color: [f32; 3]| color.into_iter().fold(0.0f32, f32::max);
    let [r, g, b, _] = stated.values.base_color;
    most(stated.values.emissive()) > GLOWS * most([r, g, b])
}

fn plain(stated: &Stated, glows: bool) -> Material {
    let [r, g, b, _] = stated.values.base_color;
    let linear = if glows {
        let emissive = stated.values.emissive();
        let most = emissive.into_iter().fold(1.0f32, f32::max);
        emissive.map(|channel| channel / most)
    } else {
        [r, g, b]
    };
    // Roughness 0.5, which exporters write for a plain surface, gives a gloss of 0.25, as with OBJ files. Metal is
    // darker, since its colour is that of its highlights. If a picture says where the surface is metallic, the factor
    // is ignored.
    let smooth = 1.0 - stated.values.roughness.clamp(0.0, 1.0);
    let is_metal = !glows && stated.metallic_roughness_texture.is_none();
    let metallic = if is_metal { stated.values.metallic.clamp(0.0, 1.0) } else { 0.0 };
    let of_metal = smooth.sqrt();
    let gloss = smooth * smooth * (1.0 - metallic) + of_metal * metallic;
    let linear = linear.map(|channel| channel * (1.0 - METAL_DARK * metallic * of_metal));
    Material {
        gloss,
        unlit: stated.is_unlit || glows,
        ..Material::plain(stated.name.as_str(), linear.map(srgb_from_linear))
    }
}

fn decoded(path: &Path, gltf: &Gltf, index: usize, warnings: &mut Vec<Problem>) -> Option<Arc<Texture>> {
    let image = &gltf.images[index];
    let told = |problem: Problem| Problem {
        severity: Severity::Warning,
        message: format!("/images/{index}: {}", problem.message),
        ..problem
    };
    match texture::decode(path, image.bytes.as_ref()?) {
        Ok(decoded) => {
            warnings.extend(decoded.warnings.into_iter().map(told));
            Some(Arc::new(decoded.texture))
        }
        Err(problem) => {
            warnings.push(told(problem));
            None
        }
    }
}
