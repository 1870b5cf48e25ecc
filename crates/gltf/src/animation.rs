//! Animations as the file has them: keys at times, and what they drive.

use std::sync::Arc;

/// An animation: tracks that belong together.
#[derive(Clone, Debug, PartialEq)]
pub struct Animation {
    /// The name in the file; empty for none.
    pub name: String,
    /// What it drives, in the order of the file.
    pub tracks: Vec<Track>,
}

impl Animation {
    /// The first and the last time of its keys, seconds; `None` without tracks.
    pub fn span_s(&self) -> Option<[f32; 2]> {
        let spans =
            self.tracks.iter().filter_map(|track| Some([*track.times_s.first()?, *track.times_s.last()?]));
        spans.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
    }
}

/// The keys of one property. Tracks that read the same accessor share one list in memory.
#[derive(Clone, Debug, PartialEq)]
pub struct Track {
    /// What it drives.
    pub target: Target,
    /// Index of its channel in the file's list of the animation's channels.
    pub channel: usize,
    /// Times of the keys, seconds: finite, increasing, at least one.
    pub times_s: Arc<Vec<f32>>,
    /// The values, all finite: `width` numbers for each key. Cubic splines have three times as many for each key: the
    /// tangent into the key, the value, and the tangent out of it. Tangents are per second.
    pub values: Arc<Vec<f32>>,
    /// How many numbers a value has.
    pub width: usize,
    /// What happens between keys.
    pub interpolation: Interpolation,
}

/// What happens between keys. Before the first and after the last key nothing moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interpolation {
    /// The value of the previous key stays.
    Step,
    /// In a straight line; rotations along the shortest arc at even speed.
    Linear,
    /// Hermite splines by the tangents of the keys.
    CubicSpline,
}

/// What a track drives.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Target {
    /// A property of a node.
    Node(usize, NodeProperty),
    /// A property of a camera.
    Camera(usize, CameraProperty),
    /// A property of a light.
    Light(usize, LightProperty),
    /// A property of a material.
    Material(usize, MaterialProperty),
}

/// The property of a node that a track drives.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum NodeProperty {
    /// Three numbers.
    Translation,
    /// A quaternion: x, y, z, w.
    Rotation,
    /// Three numbers.
    Scale,
    /// One number for each morph target.
    Weights,
    /// One number: 0 hides.
    Visible,
}

/// The property of a camera that a track drives: one number each.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CameraProperty {
    /// Vertical field of view, radians.
    Yfov,
    /// Half the width.
    Xmag,
    /// Half the height.
    Ymag,
    /// Nearest distance.
    Znear,
    /// Farthest distance.
    Zfar,
}

/// The property of a light that a track drives: three numbers for the colour, else one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LightProperty {
    /// Linear colour.
    Color,
    /// Lux or candela.
    Intensity,
    /// Metres.
    Range,
    /// Radians.
    InnerConeAngle,
    /// Radians.
    OuterConeAngle,
}

/// The property of a material that a track drives.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum MaterialProperty {
    /// Four numbers.
    BaseColor,
    /// One number.
    Metallic,
    /// One number.
    Roughness,
    /// Three numbers.
    EmissiveFactor,
    /// One number.
    EmissiveStrength,
}
