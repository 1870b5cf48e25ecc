//! The shader programs of noise-displaced bodies.

use crate::gl::{GlError, Gpu, Program, ProgramSource};
use crate::motion;
use crate::reference::{SHADOW, SURFACE};
use crate::shader_files::{NOISE_DISPLACE, REFERENCE, SHARED};

/// The reference pass's programs for bodies that are displaced.
pub(super) struct Variants {
    pub(super) surface: Program,
    pub(super) shadow: Program,
    pub(super) motion: Program,
}

/// The programs of bodies that noise colours.
pub(super) struct Programs {
    pub(super) place: Program,
    pub(super) look: Program,
    pub(super) ground: Program,
}

/// The uniforms of `noise_displace/displace.glsl`, and where vertices look.
const DISPLACE: [&str; 5] = ["vertex_noise", "noise_scale", "along_normal", "lookup_u", "lookup_v"];

/// The other uniforms of `noise_displace/look.vert`.
const STAND: [&str; 4] = ["world_from_model", "morph", "view_from_world", "clip_from_view"];

const LAYERS: [&str; 12] = [
    "layer_noise",
    "layer_count",
    "tiling",
    "tile_offset",
    "travelled",
    "speed",
    "first_way",
    "exponent",
    "tint",
    "alpha_is_grey",
    "bloom",
    "threshold",
];

impl Variants {
    pub(super) fn new(gpu: &Gpu) -> Result<Self, GlError> {
        let variant = |usual: ProgramSource, more: &[&'static str]| {
            let uniforms: Vec<&'static str> = [usual.uniforms, &DISPLACE, more].concat();
            let source = ProgramSource { defined: &["NOISE_DISPLACE"], uniforms: &uniforms, ..usual };
            Program::new(gpu, &[SHARED, REFERENCE], &source)
        };
        Ok(Self {
            surface: variant(SURFACE, &["moves_normals"])?,
            shadow: variant(SHADOW, &[])?,
            motion: variant(motion::SOURCE, &["lookup_u_then", "lookup_v_then"])?,
        })
    }
}

impl Programs {
    pub(super) fn new(gpu: &Gpu) -> Result<Self, GlError> {
        let program = |vertex: &'static str, fragment: &'static str, uniforms: &[&'static str]| {
            let source =
                ProgramSource { vertex, fragment: Some(fragment), captured: &[], uniforms, defined: &[] };
            Program::new(gpu, &[SHARED, REFERENCE, NOISE_DISPLACE], &source)
        };
        let vertex = "noise_displace/look.vert";
        let place: Vec<&'static str> = [&DISPLACE[..], &STAND, &["body_id"]].concat();
        let look: Vec<&'static str> = [&DISPLACE[..], &STAND, &LAYERS].concat();
        Ok(Self {
            place: program(vertex, "noise_displace/place.frag", &place)?,
            look: program(vertex, "noise_displace/look.frag", &look)?,
            ground: program("shared/screen.vert", "noise_displace/ground.frag", &["ground", "depth_and_id"])?,
        })
    }
}
