//! A material whose vertices and colours move with a noise texture, as a scene file states it. *The source* below is
//! the paper that it follows: see docs/techniques/noise_displace.md.

use serde::{Deserialize, Serialize};

use super::Color;
use super::numbers::usual_fields;
use crate::limits::{MAX_NOISE_INTENSITY, MAX_STRENGTH, NOISE_RATE};

usual_fields! {
    /// Noise that moves the vertices of an object, and noise that colours it.
    pub struct NoiseDisplace {
        /// What moves the vertices; `None` leaves them at rest.
        pub vertex: Option<VertexNoise> = Some(VertexNoise::default()),
        /// What colours the surface; `None` leaves it as the object's own material says.
        pub surface: Option<SurfaceNoise> = Some(SurfaceNoise::default()),
        /// Seconds after which the noise repeats, from 0.01 to 1000000; left out, the noise travels on.
        pub period_secs: Option<f64> = None,
    }
}

usual_fields! {
    /// Noise that moves vertices.
    pub struct VertexNoise {
        /// Picture file, relative to the scene file; left out, the built-in coloured Gaussian noise.
        pub texture: Option<String> = None,
        /// Where vertices look their noise up.
        pub space: NoiseSpace = NoiseSpace::World,
        /// How many times the texture repeats in one unit along X and along Y, from -1000 to 1000.
        pub value: [f64; 2] = [0.1; 2],
        /// How far apart the least and the greatest noise put a vertex on each axis, units of the object's own space.
        pub scale: f64 = 0.1; within NOISE_RATE,
        /// What the vertices are moved along.
        pub along: NoiseAlong = NoiseAlong::Channels,
        /// Which normals light falls on.
        pub normals: NoiseNormals = NoiseNormals::Kept,
    }
}

/// Where vertices look their noise up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
pub enum NoiseSpace {
    /// By their place in the object: the noise goes with it.
    Local,
    /// By their place in the world: an object that moves goes through the noise.
    #[default]
    World,
}

/// What vertices are moved along.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
pub enum NoiseAlong {
    /// The three axes, each by one channel of the noise, as in the source (Hong and Park 2021).
    #[default]
    Channels,
    /// Their normals, by the first channel of the noise.
    Normal,
}

/// Which normals light falls on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
pub enum NoiseNormals {
    /// Those of the surface at rest, as the source has it.
    #[default]
    Kept,
    /// Those of the surface as it is moved.
    Displaced,
}

usual_fields! {
    /// Noise that colours a surface: layers of one texture that move against each other, multiplied.
    pub struct SurfaceNoise {
        /// Picture file, relative to the scene file; left out, the built-in grey Perlin noise.
        pub texture: Option<String> = None,
        /// One more than the number of layers that are multiplied, from 1 to 64; 1 shows the tint alone.
        pub layer_count: u32 = 4,
        /// How fast layers move, in twentieths of the texture's length per second.
        pub speed: f64 = 1.0; within NOISE_RATE,
        /// How often the texture is repeated along U and V, from -1000 to 1000.
        pub tiling: [f64; 2] = [1.0; 2],
        /// Where the texture begins, in lengths of it, from -1000 to 1000.
        pub tile_offset: [f64; 2] = [0.0; 2],
        /// Which layers move forward; the others move back.
        pub forward: NoiseForward = NoiseForward::Odd,
        /// How the product is made light again.
        pub mix: NoiseMix = NoiseMix::Root,
        /// Colour that the layers are multiplied by.
        pub tint: Color = Color::white(),
        /// Multiplies the tint; more than 1 shines.
        pub intensity: f64 = 1.0; within 0.0..=MAX_NOISE_INTENSITY,
        /// Multiplies the alpha of the layers.
        pub opacity: f64 = 1.0; within 0.0..=1.0,
        /// Where the alpha of the layers comes from.
        pub alpha: NoiseAlpha = NoiseAlpha::Texture,
        /// How much of what is brighter than `threshold` is spread as a glow round it; 0 none.
        pub bloom: f64 = 0.0; within 0.0..=MAX_STRENGTH,
        /// The brightness above which the surface glows.
        pub threshold: f64 = 1.0; within 0.0..=MAX_NOISE_INTENSITY,
    }
}

/// Which layers move forward.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
pub enum NoiseForward {
    /// The first, the third …: as the source's code has it.
    #[default]
    Odd,
    /// The second, the fourth …: as the source's text has it.
    Even,
}

/// How the product of the layers is brightened again.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
pub enum NoiseMix {
    /// By the power 1/k, where k is `layer_count`, as the source has it: darker the more layers there are.
    #[default]
    Root,
    /// By the power 1/(2(k − 1)), where 2(k − 1) is the number of texture lookups: about as light as the texture for
    /// any k.
    Mean,
}

/// Where the alpha of the layers comes from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, Serialize)]
pub enum NoiseAlpha {
    /// The texture's alpha channel, as the source has it.
    #[default]
    Texture,
    /// Its first channel: dark noise is seen through.
    Grey,
}

impl NoiseDisplace {
    /// The picture files that it names, each with the path of its field inside the object's material.
    pub fn textures(&self) -> impl Iterator<Item = (&String, &'static str)> {
        let vertex = self.vertex.as_ref().and_then(|vertex| vertex.texture.as_ref());
        let surface = self.surface.as_ref().and_then(|surface| surface.texture.as_ref());
        let vertex = vertex.map(|name| (name, "noise_displace.vertex.texture"));
        vertex.into_iter().chain(surface.map(|name| (name, "noise_displace.surface.texture")))
    }
}
