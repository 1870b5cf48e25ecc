//! A material whose vertices and colours a noise texture moves, as a scene file states it.

use serde::Deserialize;

use super::color::Color;

/// Noise that moves the vertices of an object, and noise that it is coloured by.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct NoiseDisplace {
    /// What moves the vertices; `None` leaves them at rest.
    pub vertex: Option<VertexNoise>,
    /// What colours the surface; `None` leaves it as the object's own material says.
    pub surface: Option<SurfaceNoise>,
    /// Seconds after which everything is as it was, > 0; left out, the noise travels on.
    pub period_secs: Option<f64>,
}

/// Noise that moves vertices.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct VertexNoise {
    /// Picture file, relative to the scene file; left out, the coloured Gaussian noise of the house.
    pub texture: Option<String>,
    /// Where vertices look their noise up.
    pub space: NoiseSpace,
    /// How fast the noise changes from place to place along X and Y, textures per unit.
    pub value: [f64; 2],
    /// How far the vertices move, from the least noise to the greatest, units of the object's own space.
    pub scale: f64,
    /// What they are moved along.
    pub along: NoiseAlong,
    /// Which normals light falls on.
    pub normals: NoiseNormals,
}

/// Where vertices look their noise up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub enum NoiseSpace {
    /// By their place in the object: the noise goes with it.
    Local,
    /// By their place in the world: an object that moves goes through the noise.
    #[default]
    World,
}

/// What vertices are moved along.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub enum NoiseAlong {
    /// Each axis by a channel of the noise, as the source has it.
    #[default]
    Channels,
    /// Their normals, by the first channel.
    Normal,
}

/// Which normals light falls on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub enum NoiseNormals {
    /// Those of the surface at rest, as the source has it.
    #[default]
    Kept,
    /// Those of the surface as it is moved.
    Displaced,
}

/// Noise that colours a surface: layers of one texture that move against each other, multiplied.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SurfaceNoise {
    /// Picture file, relative to the scene file; left out, the grey Perlin noise of the house.
    pub texture: Option<String>,
    /// k: two looks at the texture for each layer but the first; 1 shows the tint alone.
    pub layer_count: u32,
    /// How fast layers move.
    pub speed: f64,
    /// How often the texture is repeated along U and V.
    pub tiling: [f64; 2],
    /// Where the texture begins, in lengths of it.
    pub tile_offset: [f64; 2],
    /// Which layers move forward; the others move back.
    pub forward: NoiseForward,
    /// How the product is made light again.
    pub mix: NoiseMix,
    /// Colour that the layers are multiplied by.
    pub tint: Color,
    /// Multiplies the tint; more than 1 shines.
    pub intensity: f64,
    /// Multiplies the alpha of the layers.
    pub opacity: f64,
    /// Where the alpha of the layers comes from.
    pub alpha: NoiseAlpha,
    /// How much of what is brighter than `threshold` is spread as a glow round it; 0 none.
    pub bloom: f64,
    /// The brightness from which on it glows.
    pub threshold: f64,
}

/// Which layers move forward.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub enum NoiseForward {
    /// The first, the third …: as the source's code has it.
    #[default]
    Odd,
    /// The second, the fourth …: as the source's text has it.
    Even,
}

/// How the product of the layers is made light again.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub enum NoiseMix {
    /// By the power 1/k, as the source has it: darker the more layers there are.
    #[default]
    Root,
    /// By the power 1/(2(k − 1)), the number of looks: about as light as the texture, whatever k.
    Mean,
}

/// Where the alpha of the layers comes from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
pub enum NoiseAlpha {
    /// The texture's alpha channel, as the source has it.
    #[default]
    Texture,
    /// Its first channel: dark noise is seen through.
    Grey,
}

impl Default for NoiseDisplace {
    fn default() -> Self {
        let (vertex, surface) = (Some(VertexNoise::default()), Some(SurfaceNoise::default()));
        Self { vertex, surface, period_secs: None }
    }
}

impl Default for VertexNoise {
    fn default() -> Self {
        Self {
            texture: None,
            space: NoiseSpace::default(),
            value: [0.1; 2],
            scale: 0.1,
            along: NoiseAlong::default(),
            normals: NoiseNormals::default(),
        }
    }
}

impl Default for SurfaceNoise {
    fn default() -> Self {
        Self {
            texture: None,
            layer_count: 4,
            speed: 1.0,
            tiling: [1.0; 2],
            tile_offset: [0.0; 2],
            forward: NoiseForward::default(),
            mix: NoiseMix::default(),
            tint: Color::white(),
            intensity: 1.0,
            opacity: 1.0,
            alpha: NoiseAlpha::default(),
            bloom: 0.0,
            threshold: 1.0,
        }
    }
}

impl NoiseDisplace {
    /// The picture files that it names, each with the field that names it.
    pub fn textures(&self) -> impl Iterator<Item = (&String, &'static str)> {
        let vertex = self.vertex.as_ref().and_then(|vertex| vertex.texture.as_ref());
        let surface = self.surface.as_ref().and_then(|surface| surface.texture.as_ref());
        let vertex = vertex.map(|name| (name, "noise_displace.vertex.texture"));
        vertex.into_iter().chain(surface.map(|name| (name, "noise_displace.surface.texture")))
    }
}
