//! Reads glTF 2.0 (`.gltf`, `.glb`), and tells where everything in it is at any time.
//!
//! The crate opens no file: [`read`] is given bytes and a function that gives more. It trusts no number of the file:
//! sizes are checked against the bytes, and indices against their lists (exceptions: [`Gltf`]). Complaints name their
//! place ([`Finding::pointer`]).
//!
//! Space and units are those of glTF: right-handed, Y up, metres, radians, seconds; colours are linear; texture
//! coordinates have V pointing down. Matrices multiply column vectors.
//!
//! ```text
//! bytes ─▶ container ─▶ json ─▶ source (buffers, views) ─▶ accessor ─▶ decode ─▶ read_mesh, read_node, read_animation
//!                                                                                      │
//!                                            Posed ◀─ Animator ◀─ Gltf (plain data) ◀──┘
//! ```

mod accessor;
mod animation;
mod bytes;
mod camera_light;
mod container;
mod cursor;
mod decode;
mod evaluate;
mod extensions;
mod finding;
mod images;
mod json;
mod keys;
mod material;
mod mesh;
mod node;
mod pointer;
mod read;
mod read_animation;
mod read_mesh;
mod read_node;
mod source;
mod uri;

use std::sync::Arc;

pub use animation::{
    Animation, CameraProperty, Interpolation, LightProperty, MaterialProperty, NodeProperty, Target, Track,
};
pub use bytes::Bytes;
pub use camera_light::{Camera, Lens, Light, LightKind, LightValues};
pub use evaluate::{Animator, Playing, Posed};
pub use finding::{Finding, Severity};
pub use material::{
    AlphaMode, Image, Material, MaterialValues, Sampler, Texture, TextureUse, UvTransform, Wrap,
};
pub use mesh::{Influences, Mesh, MorphTarget, Primitive};
pub use node::{LocalTransform, Node, Skin, Trs};
pub use read::read;
pub use source::{MAX_FILE_BYTES, MAX_TOTAL_BYTES, Open, SPARE_BYTES};

/// A shot: everything of a glTF file that is read. Every index in it is within its list, except those of joints with
/// weight 0 and those of groups ([`Primitive::groups`]).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Gltf {
    /// All nodes of the file, also those of scenes that are not shown. They make trees.
    pub nodes: Vec<Node>,
    /// The roots of the scene that is shown: the one that the file states, else the first, else all roots.
    pub roots: Vec<usize>,
    /// Meshes; several nodes may show one.
    pub meshes: Vec<Arc<Mesh>>,
    /// Materials.
    pub materials: Vec<Material>,
    /// Textures.
    pub textures: Vec<Texture>,
    /// Pictures.
    pub images: Vec<Image>,
    /// Cameras.
    pub cameras: Vec<Camera>,
    /// Lights.
    pub lights: Vec<Light>,
    /// Skins.
    pub skins: Vec<Skin>,
    /// Animations.
    pub animations: Vec<Animation>,
    /// Names of the variants of materials. The first is the one that is read.
    pub variants: Vec<String>,
}
