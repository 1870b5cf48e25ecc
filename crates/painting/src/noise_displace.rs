//! Noise-displaced materials: from the document to what displaces, colours and is drawn.

use std::collections::HashMap;
use std::sync::Arc;

use glam::{DAffine3, DQuat, DVec2, DVec3, Vec2, Vec3};
use impasto_core::TriangleMesh;
use impasto_core::noise_displace::{
    Along, Lookup, Tile, VertexNoise, gaussian, perlin, travelled, vertex_shift,
};
use impasto_scene::document::{
    NoiseAlong, NoiseAlpha, NoiseDisplace, NoiseForward, NoiseMix, NoiseNormals, NoiseSpace, Object,
    SurfaceNoise,
};
use impasto_scene::loaded::LoadedScene;
use impasto_scene::mesh_file::Texture;
use rayon::prelude::*;

use crate::lights::linear;
use crate::surface::Vertices;

/// The noise of one body.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyNoise {
    /// What moves its vertices.
    pub vertex: Option<VertexNoise>,
    /// What colours it.
    pub layers: Option<NoiseLayers>,
    stated: NoiseDisplace,
}

/// Layers of one texture that move against each other, multiplied.
#[derive(Clone, Debug, PartialEq)]
pub struct NoiseLayers {
    /// The texture.
    pub tile: Arc<Tile>,
    /// k, at least 1.
    pub count: u32,
    /// How fast layers move, and how far apart they begin.
    pub speed: f32,
    /// Texture coordinates times this, plus `offset`.
    pub tiling: Vec2,
    /// See `tiling`.
    pub offset: Vec2,
    /// Which way the first layer goes, 1 or −1; each one goes against the one before.
    pub first_way: f32,
    /// What the product is raised to.
    pub exponent: f32,
    /// Linear Rec. 709, intensity multiplied in: may shine brighter than 1.
    pub tint: [f32; 3],
    /// Multiplies alpha.
    pub opacity: f32,
    /// The first channel is the alpha too.
    pub alpha_is_grey: bool,
    /// How much of what is brighter than `threshold` is spread as a glow.
    pub bloom: f32,
    /// See `bloom`.
    pub threshold: f32,
}

/// The noise of a body at one time.
#[derive(Clone, Debug)]
pub struct FrameNoise {
    /// Shared between frames.
    pub noise: Arc<BodyNoise>,
    /// Where its vertices look their noise up.
    pub lookup: Lookup,
    /// How far the layers have gone, speed multiplied in, in lengths of the texture.
    pub travelled: Vec2,
}

/// Whether surfaces stand alike; how they are coloured has no say.
impl PartialEq for FrameNoise {
    fn eq(&self, other: &Self) -> bool {
        match (&self.noise.vertex, &other.noise.vertex) {
            (Some(here), Some(there)) => self.lookup == other.lookup && here == there,
            (here, there) => here.is_none() && there.is_none(),
        }
    }
}

/// How a surface that may change its shape stands.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BodyShape {
    /// How far it has turned into its morph, 0..=1.
    pub morph: f64,
    /// The noise that displaces it.
    pub noise: Option<FrameNoise>,
}

impl From<f64> for BodyShape {
    /// A share of a morph, and no noise.
    fn from(morph: f64) -> Self {
        Self { morph, noise: None }
    }
}

impl BodyShape {
    /// The noise that moves vertices, and where they look it up.
    pub(crate) fn displacing(&self) -> Option<(&VertexNoise, &Lookup)> {
        let noise = self.noise.as_ref()?;
        Some((noise.noise.vertex.as_ref()?, &noise.lookup))
    }
}

impl BodyNoise {
    /// The noise at a time, of a body in a pose.
    pub(crate) fn at(self: &Arc<Self>, seconds: f64, world_from_model: DAffine3) -> FrameNoise {
        let travelled = travelled(seconds, self.stated.period_secs);
        let lookup = match &self.stated.vertex {
            Some(vertex) => {
                let space = (vertex.space == NoiseSpace::World).then_some(world_from_model);
                Lookup::new(vertex.value, space, vertex_shift(travelled))
            }
            None => Lookup::new([0.0; 2], None, DVec2::ZERO),
        };
        let speed = self.stated.surface.as_ref().map_or(0.0, |surface| surface.speed);
        let travelled = travelled * speed;
        // Whole textures are left out, so that late frames are as exact as early ones.
        FrameNoise { noise: Arc::clone(self), lookup, travelled: (travelled - travelled.floor()).as_vec2() }
    }

    /// How far a vertex may be from where it is at rest along each axis, model units.
    pub(crate) fn reach(&self) -> f32 {
        self.vertex.as_ref().map_or(0.0, |vertex| 0.5 * vertex.scale.abs() as f32)
    }
}

/// What a body's noise depends on; while it stays equal, the noise is kept.
#[derive(Clone, Default)]
pub(crate) struct NoiseInputs {
    stated: Option<NoiseDisplace>,
    /// Of the vertices and of the surface.
    pictures: [Option<Arc<Texture>>; 2],
}

impl PartialEq for NoiseInputs {
    fn eq(&self, other: &Self) -> bool {
        let same = |index: usize| match (&self.pictures[index], &other.pictures[index]) {
            (Some(a), Some(b)) => Arc::ptr_eq(a, b),
            (a, b) => a.is_none() && b.is_none(),
        };
        self.stated == other.stated && same(0) && same(1)
    }
}

impl NoiseInputs {
    pub(crate) fn new(loaded: &LoadedScene, object: &Object) -> Self {
        let Some(stated) = object.material.as_ref().and_then(|material| material.noise_displace.clone())
        else {
            return Self::default();
        };
        let of_vertex = stated.vertex.as_ref().and_then(|vertex| vertex.texture.as_ref());
        let of_surface = stated.surface.as_ref().and_then(|surface| surface.texture.as_ref());
        let pictures = [of_vertex, of_surface].map(|name| loaded.textures.get(name?).map(Arc::clone));
        Self { stated: Some(stated), pictures }
    }

    /// The noise; textures of `kept` are taken over where they are the same.
    pub(crate) fn build(&self, kept: Option<&(Self, Option<Arc<BodyNoise>>)>) -> Option<Arc<BodyNoise>> {
        let stated = self.stated.clone()?;
        let before = |index: usize| {
            let (inputs, noise) = kept?;
            let (Some(was), Some(is)) = (&inputs.pictures[index], &self.pictures[index]) else { return None };
            let noise = noise.as_ref().filter(|_| Arc::ptr_eq(was, is))?;
            match index {
                0 => noise.vertex.as_ref().map(|vertex| Arc::clone(&vertex.tile)),
                _ => noise.layers.as_ref().map(|layers| Arc::clone(&layers.tile)),
            }
        };
        let tile = |index: usize, of_house: fn() -> Arc<Tile>| match &self.pictures[index] {
            Some(picture) => {
                before(index).unwrap_or_else(|| Arc::new(Tile::of_picture(picture.size_px, &picture.rgba8)))
            }
            None => of_house(),
        };
        let vertex = stated.vertex.as_ref().map(|vertex| VertexNoise {
            tile: tile(0, gaussian),
            scale: vertex.scale,
            along: match vertex.along {
                NoiseAlong::Channels => Along::Channels,
                NoiseAlong::Normal => Along::Normal,
            },
            moves_normals: vertex.normals == NoiseNormals::Displaced,
        });
        let layers = stated.surface.as_ref().map(|surface| layers(surface, tile(1, perlin)));
        Some(Arc::new(BodyNoise { vertex, layers, stated }))
    }
}

fn layers(surface: &SurfaceNoise, tile: Arc<Tile>) -> NoiseLayers {
    let count = surface.layer_count.max(1);
    // One layer has no look at the texture, and nothing to be raised.
    let looks = match surface.mix {
        NoiseMix::Root => f64::from(count),
        NoiseMix::Mean => f64::from(2 * (count - 1).max(1)),
    };
    NoiseLayers {
        tile,
        count,
        speed: surface.speed as f32,
        tiling: DVec2::from(surface.tiling).as_vec2(),
        offset: DVec2::from(surface.tile_offset).as_vec2(),
        first_way: if surface.forward == NoiseForward::Odd { 1.0 } else { -1.0 },
        exponent: (1.0 / looks) as f32,
        tint: linear(surface.tint).map(|channel| channel * surface.intensity as f32),
        opacity: surface.opacity as f32,
        alpha_is_grey: surface.alpha == NoiseAlpha::Grey,
        bloom: surface.bloom as f32,
        threshold: surface.threshold as f32,
    }
}

/// The vertices of a mesh where noise has moved them, with the normals of the surface as it is then: each is turned as the
/// faces round it have turned.
pub(crate) fn displaced(
    mesh: &TriangleMesh,
    (positions, normals): Vertices,
    (noise, lookup): (&VertexNoise, &Lookup),
) -> Vertices {
    let moved =
        positions.par_iter().zip(&normals).with_min_len(1024).map(|(position, normal)| {
            noise.displaced(position.as_dvec3(), normal.as_dvec3(), lookup).as_vec3()
        });
    let moved: Vec<Vec3> = moved.collect();
    // Where texture coordinates part, a vertex is there twice; where the surface is hard, its normals differ.
    let bits = |index: usize| [positions[index], normals[index]].map(|v| v.to_array().map(f32::to_bits));
    let mut groups = HashMap::with_capacity(positions.len());
    let group_of: Vec<usize> = (0..positions.len())
        .map(|index| {
            let next = groups.len();
            *groups.entry(bits(index)).or_insert(next)
        })
        .collect();
    let mut faces = vec![[DVec3::ZERO; 2]; groups.len()];
    for corners in &mesh.triangles {
        let across = |positions: &[Vec3]| {
            let [a, b, c] = corners.map(|vertex| positions[vertex as usize].as_dvec3());
            (b - a).cross(c - a)
        };
        let (before, now) = (across(&positions), across(&moved));
        for vertex in corners {
            let sum = &mut faces[group_of[*vertex as usize]];
            *sum = [sum[0] + before, sum[1] + now];
        }
    }
    let turned = |(index, normal): (usize, &Vec3)| {
        let [before, now] = faces[group_of[index]].map(|sum| sum.try_normalize());
        let turn = before.zip(now).map(|(before, now)| DQuat::from_rotation_arc(before, now));
        turn.map_or(*normal, |turn| (turn * normal.as_dvec3()).as_vec3())
    };
    let turned = normals.iter().enumerate().map(turned).collect();
    (moved, turned)
}
