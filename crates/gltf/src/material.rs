//! Materials, textures and pictures, and how they are read.

use crate::bytes::Bytes;
use crate::cursor::Cursor;
use crate::extensions::{EMISSIVE_STRENGTH, TEXTURE_TRANSFORM, UNLIT, WEBP};
use crate::finding::{Checked, Findings};

/// A material.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// The name in the file; empty for none.
    pub name: String,
    /// Its numbers, which may be animated.
    pub values: MaterialValues,
    /// Multiplies the base colour: sRGB encoded, alpha linear.
    pub base_color_texture: Option<TextureUse>,
    /// Roughness in green and metalness in blue, linear.
    pub metallic_roughness_texture: Option<TextureUse>,
    /// Multiplies the emissive colour: sRGB encoded.
    pub emissive_texture: Option<TextureUse>,
    /// What alpha means.
    pub alpha: AlphaMode,
    /// Whether back faces show.
    pub is_double_sided: bool,
    /// Whether the base colour shows as it is, without light (KHR_materials_unlit).
    pub is_unlit: bool,
}

/// The numbers of a material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MaterialValues {
    /// Linear red, green, blue and alpha, 0..=1.
    pub base_color: [f32; 4],
    /// 0..=1.
    pub metallic: f32,
    /// 0 mirror ..= 1 matt.
    pub roughness: f32,
    /// Linear, not negative; multiplied by `emissive_strength`.
    pub emissive_factor: [f32; 3],
    /// Not negative; 1 where the file states none.
    pub emissive_strength: f32,
}

impl MaterialValues {
    /// The light that the surface gives off: linear, may exceed 1.
    pub fn emissive(&self) -> [f32; 3] {
        self.emissive_factor.map(|channel| channel * self.emissive_strength)
    }
}

/// What the alpha of a material means.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AlphaMode {
    /// Nothing.
    Opaque,
    /// Where it is less than this, there is no surface.
    Mask(f32),
    /// How much of the surface there is.
    Blend,
}

/// A texture as a material uses it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureUse {
    /// Index into [`crate::Gltf::textures`].
    pub texture: usize,
    /// Which set of texture coordinates: 0 or 1.
    pub uv_set: usize,
    /// From the set's coordinates to those of the picture.
    pub transform: UvTransform,
}

/// A transform of texture coordinates (V down). They are scaled, then turned about (0, 0), then shifted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UvTransform {
    /// Shift.
    pub offset: [f32; 2],
    /// Turn, radians, counter-clockwise in a picture whose V points down.
    pub rotation_rad: f32,
    /// Scale.
    pub scale: [f32; 2],
}

impl UvTransform {
    /// Changes nothing.
    pub const IDENTITY: Self = Self { offset: [0.0; 2], rotation_rad: 0.0, scale: [1.0; 2] };

    /// The coordinates in the picture.
    pub fn apply(&self, [u, v]: [f32; 2]) -> [f32; 2] {
        let (sin, cos) = self.rotation_rad.sin_cos();
        let (u, v) = (u * self.scale[0], v * self.scale[1]);
        [cos * u + sin * v + self.offset[0], -sin * u + cos * v + self.offset[1]]
    }
}

/// A picture, and how it is sampled.
#[derive(Clone, Debug, PartialEq)]
pub struct Texture {
    /// The name in the file; empty for none.
    pub name: String,
    /// Index into [`crate::Gltf::images`]; `None` where the file has no picture that is read.
    pub image: Option<usize>,
    /// How it is sampled.
    pub sampler: Sampler,
}

/// How a picture is sampled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Sampler {
    /// What lies beyond the left and right border.
    pub wrap_u: Wrap,
    /// What lies beyond the upper and lower border.
    pub wrap_v: Wrap,
    /// Whether pixels show as squares when the picture is enlarged.
    pub is_nearest: bool,
}

/// What lies beyond the border of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Wrap {
    /// The picture again.
    #[default]
    Repeat,
    /// The picture mirrored, then again.
    Mirror,
    /// The pixels of the border.
    Clamp,
}

/// A picture, not decoded.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// The name that the glTF file gives, else the name of the picture's own file; empty for neither.
    pub name: String,
    /// The bytes of the encoded picture. `None` if they could not be read (there was a warning), or if they lie in a
    /// file of their own and no base colour or emissive texture uses them.
    pub bytes: Option<Bytes>,
    /// Media type such as `image/png`: recognised by the first bytes, else as stated in the file; else empty.
    pub media_type: String,
}

/// Reads `samplers` and `textures`.
pub(crate) fn textures(
    root: &Cursor<'_, '_>,
    images: usize,
    findings: &mut Findings,
) -> Checked<Vec<Texture>> {
    let mut samplers = Vec::new();
    for cursor in root.list("samplers")?.iter() {
        samplers.extend(findings.take(sampler(&cursor)));
    }
    let list = root.list("textures")?;
    let mut textures = Vec::new();
    for cursor in list.iter() {
        let texture = texture(&cursor, images, &samplers, findings);
        textures.extend(findings.take(texture));
        if findings.is_full() {
            break;
        }
    }
    Ok(textures)
}

fn sampler(cursor: &Cursor<'_, '_>) -> Checked<Sampler> {
    let wrap = |name| {
        let Some(member) = cursor.member(name) else { return Ok(Wrap::Repeat) };
        match member.whole()? {
            10497 => Ok(Wrap::Repeat),
            33648 => Ok(Wrap::Mirror),
            33071 => Ok(Wrap::Clamp),
            code => Err(member.error(format!("{code} is no way to wrap (10497, 33648, 33071)"))),
        }
    };
    let filter = |name, least, most| {
        let Some(member) = cursor.member(name) else { return Ok(None) };
        match member.whole()? {
            code @ (9728 | 9729) => Ok(Some(code)),
            code if (least..=most).contains(&code) => Ok(Some(code)),
            code => Err(member.error(format!("{code} is no filter"))),
        }
    };
    filter("minFilter", 9984, 9987)?;
    let is_nearest = filter("magFilter", 9728, 9729)? == Some(9728);
    Ok(Sampler { wrap_u: wrap("wrapS")?, wrap_v: wrap("wrapT")?, is_nearest })
}

fn texture(
    cursor: &Cursor<'_, '_>,
    images: usize,
    samplers: &[Sampler],
    findings: &mut Findings,
) -> Checked<Texture> {
    let plain = cursor.optional_index("source", images, "image")?;
    let extensions = cursor.object("extensions")?;
    let webp = match extensions.as_ref().map(|extensions| extensions.object(WEBP)).transpose()?.flatten() {
        Some(webp) => webp.optional_index("source", images, "image")?,
        None => None,
    };
    let image = webp.or(plain);
    if image.is_none() {
        findings.add(cursor.warning("the texture has no picture that is read: its factor is used alone", ""));
    }
    let sampler = cursor.optional_index("sampler", samplers.len(), "sampler")?;
    let name = cursor.optional_text("name")?.unwrap_or_default().to_owned();
    Ok(Texture { name, image, sampler: sampler.map_or(Sampler::default(), |sampler| samplers[sampler]) })
}

pub(crate) fn materials(
    root: &Cursor<'_, '_>,
    textures: usize,
    findings: &mut Findings,
) -> Checked<Vec<Material>> {
    let list = root.list("materials")?;
    let mut materials = Vec::new();
    for cursor in list.iter() {
        let material = material(&cursor, textures, findings);
        materials.extend(findings.take(material));
        if findings.is_full() {
            break;
        }
    }
    Ok(materials)
}

fn material(cursor: &Cursor<'_, '_>, textures: usize, findings: &mut Findings) -> Checked<Material> {
    let cursor = cursor.clone().checked_object()?;
    let cursor = &cursor;
    let mut values = MaterialValues {
        base_color: [1.0; 4],
        metallic: 1.0,
        roughness: 1.0,
        emissive_factor: [0.0; 3],
        emissive_strength: 1.0,
    };
    let (mut base_color_texture, mut metallic_roughness_texture) = (None, None);
    if let Some(pbr) = cursor.object("pbrMetallicRoughness")? {
        values.base_color = factors(&pbr, "baseColorFactor", values.base_color, findings)?;
        [values.metallic] = factors(&pbr, "metallicFactor", [1.0], findings)?;
        [values.roughness] = factors(&pbr, "roughnessFactor", [1.0], findings)?;
        base_color_texture = texture_use(&pbr, "baseColorTexture", textures, findings)?;
        metallic_roughness_texture = texture_use(&pbr, "metallicRoughnessTexture", textures, findings)?;
    }
    // These two textures are not used, but an index out of range shows that the file is broken.
    texture_use(cursor, "normalTexture", textures, findings)?;
    texture_use(cursor, "occlusionTexture", textures, findings)?;
    let emissive_texture = texture_use(cursor, "emissiveTexture", textures, findings)?;
    values.emissive_factor = factors(cursor, "emissiveFactor", [0.0; 3], findings)?;
    let extensions = cursor.object("extensions")?;
    let extension = |name| extensions.as_ref().map_or(Ok(None), |extensions| extensions.object(name));
    if let Some(strength) = extension(EMISSIVE_STRENGTH)? {
        values.emissive_strength = strength.number_or("emissiveStrength", 1.0)? as f32;
        if values.emissive_strength < 0.0 {
            findings.add(strength.warning("a negative strength is taken as 0", ""));
            values.emissive_strength = 0.0;
        }
    }
    let cutoff = cursor.number_or("alphaCutoff", 0.5)? as f32;
    let alpha = match cursor.optional_text("alphaMode")? {
        None | Some("OPAQUE") => AlphaMode::Opaque,
        Some("MASK") => AlphaMode::Mask(cutoff),
        Some("BLEND") => AlphaMode::Blend,
        Some(_) => return Err(cursor.error("\"alphaMode\" is none of OPAQUE, MASK, BLEND")),
    };
    if alpha == AlphaMode::Opaque && cursor.member("alphaCutoff").is_some() {
        findings.add(cursor.warning("\"alphaCutoff\" means nothing without the mode MASK", ""));
    }
    Ok(Material {
        name: cursor.optional_text("name")?.unwrap_or_default().to_owned(),
        values,
        base_color_texture,
        metallic_roughness_texture,
        emissive_texture,
        alpha,
        is_double_sided: cursor.truth_or("doubleSided", false)?,
        is_unlit: extension(UNLIT)?.is_some(),
    })
}

/// Numbers from 0 to 1; others are clamped, with a warning.
fn factors<const N: usize>(
    cursor: &Cursor<'_, '_>,
    name: &'static str,
    default: [f32; N],
    findings: &mut Findings,
) -> Checked<[f32; N]> {
    let Some(member) = cursor.member(name) else { return Ok(default) };
    let numbers = if N == 1 { [member.number()?; N] } else { member.numbers::<N>()? };
    if numbers.iter().any(|number| !(0.0..=1.0).contains(number)) {
        findings.add(member.warning("a factor is from 0 to 1, and is clamped", ""));
    }
    Ok(numbers.map(|number| number.clamp(0.0, 1.0) as f32))
}

fn texture_use(
    cursor: &Cursor<'_, '_>,
    name: &'static str,
    textures: usize,
    findings: &mut Findings,
) -> Checked<Option<TextureUse>> {
    let Some(info) = cursor.object(name)? else { return Ok(None) };
    let texture = info.required("index")?.index(textures, "texture")?;
    let mut uv_set = info.whole_or("texCoord", 0)?;
    let mut transform = UvTransform::IDENTITY;
    let extensions = info.object("extensions")?;
    if let Some(moved) =
        extensions.as_ref().map_or(Ok(None), |extensions| extensions.object(TEXTURE_TRANSFORM))?
    {
        transform = UvTransform {
            offset: moved.numbers_or("offset", [0.0; 2])?.map(|axis| axis as f32),
            rotation_rad: moved.number_or("rotation", 0.0)? as f32,
            scale: moved.numbers_or("scale", [1.0; 2])?.map(|axis| axis as f32),
        };
        uv_set = moved.whole_or("texCoord", uv_set)?;
    }
    if uv_set > 1 {
        let message = format!("texture coordinates {uv_set} are not read: the first set is used");
        findings.add(info.warning(message, "use the first two sets"));
        uv_set = 0;
    }
    Ok(Some(TextureUse { texture, uv_set: uv_set as usize, transform }))
}
