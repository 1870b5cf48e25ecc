//! What one picture is made of, as plain data: the only thing that the renderer reads.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Vec3};
use impasto_core::TriangleMesh;
use impasto_scene::mesh_file::Texture;

/// One picture, ready to draw.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Width and height of the picture in pixels.
    pub size_px: [u32; 2],
    /// Output height over the scene's own height: what pixel lengths have been multiplied by.
    pub px_scale: f32,
    /// The camera.
    pub view: FrameView,
    /// Linear Rec. 709 colour where nothing is painted; `None` leaves it transparent.
    pub background: Option<[f32; 3]>,
    /// Resolved lights.
    pub lights: FrameLights,
    /// What stands in the scene, in the order of the scene file. Body `i` has id `i + 1` in the id target.
    pub bodies: Vec<FrameBody>,
    /// Strokes in painting order: layer, then rank from high to low.
    pub strokes: Vec<Stroke>,
    /// Where each stroke comes from, parallel to `strokes`.
    pub sources: Vec<StrokeSource>,
    /// Runs of `strokes` that belong to one layer, in painting order.
    pub layers: Vec<LayerRun>,
    /// How to draw.
    pub style: FrameStyle,
}

/// The style, with what it needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum FrameStyle {
    /// Brush strokes over a ground.
    RotatingStrokes,
    /// The lit reference picture itself.
    Reference,
}

/// The camera of a frame.
#[derive(Clone, Copy, Debug)]
pub struct FrameView {
    /// Right-handed, looks down −Z.
    pub view_from_world: Mat4,
    /// OpenGL clip space, depth −1..1.
    pub clip_from_view: Mat4,
    /// Eye in world space; for an orthographic lens still the key's eye.
    pub eye_in_world: Vec3,
    /// Whether rays are parallel.
    pub orthographic: bool,
    /// Nearest and farthest visible depth along the gaze, world units.
    pub near_far: [f32; 2],
}

/// Lights of a frame, linear Rec. 709, intensity multiplied in.
#[derive(Clone, Debug, Default)]
pub struct FrameLights {
    /// Parallel lights; the first one casts shadows.
    pub suns: Vec<SunLight>,
    /// Point lights, inverse square, no shadows.
    pub points: Vec<PointLight>,
    /// Ambient light on a surface that faces up.
    pub ambient_above: Vec3,
    /// Ambient light on a surface that faces down.
    pub ambient_below: Vec3,
    /// A sphere (centre, radius) round everything over the whole timeline, so that the shadow map never slides.
    pub shadow_bounds: (Vec3, f32),
}

/// A parallel light.
#[derive(Clone, Copy, Debug)]
pub struct SunLight {
    /// Unit vector towards the light, world space.
    pub to_light: Vec3,
    /// Linear colour times intensity.
    pub radiance: Vec3,
}

/// A point light.
#[derive(Clone, Copy, Debug)]
pub struct PointLight {
    /// World space.
    pub position: Vec3,
    /// Linear colour times intensity at distance 1.
    pub radiance: Vec3,
}

/// One object at one time.
#[derive(Clone, Debug)]
pub struct FrameBody {
    /// The surface; shared between frames, so that a renderer may cache what it uploads by the `Arc`'s address.
    pub surface: Arc<BodySurface>,
    /// Rigid pose.
    pub world_from_model: Mat4,
}

/// A surface with its materials, in model space (static scale applied).
#[derive(Debug)]
pub struct BodySurface {
    /// The object's name.
    pub name: String,
    /// The triangles.
    pub mesh: TriangleMesh,
    /// Indexed by `mesh.material_of_triangle`.
    pub materials: Vec<BodyMaterial>,
}

/// A resolved material.
#[derive(Clone, Debug)]
pub struct BodyMaterial {
    /// Linear Rec. 709 albedo.
    pub albedo: [f32; 3],
    /// Multiplies `albedo`; sRGB bytes.
    pub texture: Option<Arc<Texture>>,
    /// Shown as it is, without light or shadow.
    pub unlit: bool,
}

/// One brush stroke, as it goes to the GPU. Pixels, origin at the lower left, Y up.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Stroke {
    /// Centre in pixels, origin at the lower left corner of the picture.
    pub center_px: [f32; 2],
    /// Depth along the gaze, world units, positive in front.
    pub depth: f32,
    /// Counter-clockwise from +X, radians in (−π, π].
    pub angle_rad: f32,
    /// Length in output pixels.
    pub length_px: f32,
    /// Width in output pixels.
    pub width_px: f32,
    /// 0 absent .. 1 whole: erodes the brush mask.
    pub presence: f32,
    /// Random bits that belong to the stroke for ever: brush variant, flip, dryness.
    pub bits: u32,
    /// Id of the body in the id target (index in `Frame::bodies` plus 1).
    pub body_id: u32,
    /// Linear albedo at the stroke, 8 bits a channel, sRGB encoded, as 0xAABBGGRR; A is 0 where unlit.
    pub albedo_srgb8: u32,
    /// Unit surface normal in world space.
    pub normal_in_world: [f32; 3],
}

/// What a stroke is and how far it can be trusted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrokeSource {
    /// Index of the particle in its body's progressive order.
    pub particle: u32,
    /// Index of the region in the scene; `regions.len()` for the implicit one.
    pub region: u32,
    /// κ in 0..=1: how well a turn describes what the picture of the surface has done (1 = wholly).
    pub kappa: f32,
    /// Cosine between the surface normal and the direction to the eye.
    pub facing: f32,
    /// Rank in (0, 1): low ranks stay longest when strokes thin out.
    pub rank: f32,
}

/// A run of strokes of one layer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LayerRun {
    /// The underpainting is drawn thinner and takes its colour from a wider neighbourhood.
    pub underpainting: bool,
    /// First stroke.
    pub first: u32,
    /// How many.
    pub count: u32,
}
