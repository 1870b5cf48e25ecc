//! Makes the surface of a body from an object of the document, and gives the surface's albedo.

use std::collections::HashMap;
use std::sync::Arc;

use glam::{DMat3, DVec3, Vec3};
use impasto_core::TriangleMesh;
use impasto_core::bending::Vertices;
use impasto_core::color::{linear_from_srgb, srgb_from_linear};
use impasto_core::sampling::Particle;
use impasto_core::shells::sides;
use impasto_scene::document::{Color, MaterialOverride, Rest, Scale, Up};
use impasto_scene::loaded::LoadedScene;
use impasto_scene::mesh_file::{MeshFile, Sampler, Texture};
use impasto_scene::point_cache::PointCache;
use rayon::prelude::*;

use crate::body::{BodyMaterial, BodySurface};
use crate::body_bend::{BodyBend, BodyCache};
use crate::body_shape::BodyShape;
use crate::lights::linear;
use crate::shapes::BodyShapes;

#[derive(Clone, Debug)]
pub(crate) struct SurfaceInputs {
    file: Arc<MeshFile>,
    group: Option<String>,
    scale: Scale,
    up: Up,
    material: Option<MaterialOverride>,
    texture: Option<Arc<Texture>>,
    morph: Option<Arc<MeshFile>>,
    cache: Option<Arc<PointCache>>,
    /// The shape in which strokes are laid. If it has no pose and no frame, it is the shape in the file.
    rest: BodyShape,
}

impl PartialEq for SurfaceInputs {
    fn eq(&self, other: &Self) -> bool {
        fn same<T>(a: Option<&Arc<T>>, b: Option<&Arc<T>>) -> bool {
            match (a, b) {
                (Some(a), Some(b)) => Arc::ptr_eq(a, b),
                (a, b) => a.is_none() && b.is_none(),
            }
        }
        Arc::ptr_eq(&self.file, &other.file)
            && same(self.texture.as_ref(), other.texture.as_ref())
            && same(self.morph.as_ref(), other.morph.as_ref())
            && same(self.cache.as_ref(), other.cache.as_ref())
            && self.rest == other.rest
            && self.group == other.group
            && self.scale == other.scale
            && self.up == other.up
            && self.material == other.material
    }
}

impl SurfaceInputs {
    /// `None` when the mesh was not read.
    pub(crate) fn new(loaded: &LoadedScene, index: usize) -> Option<Self> {
        let object = &loaded.scene.objects[index];
        let texture_name = object.material.as_ref().and_then(|material| material.texture.as_ref());
        Some(Self {
            file: Arc::clone(loaded.meshes.get(&object.mesh)?),
            group: object.group.clone(),
            scale: object.scale,
            up: object.up,
            // Noise moves vertices later; the surface is built and sampled without it.
            material: object.material.clone().map(|over| MaterialOverride { noise_displace: None, ..over }),
            texture: texture_name.and_then(|name| loaded.textures.get(name)).map(Arc::clone),
            morph: object.morph.as_ref().and_then(|name| loaded.meshes.get(name)).map(Arc::clone),
            cache: object.cache.as_ref().and_then(|name| loaded.caches.get(name)).map(Arc::clone),
            rest: match object.rest {
                Rest::Bind => BodyShape::default(),
                Rest::Frame(frame) => BodyShapes::at(&loaded.scene, frame as f64).of(loaded, index),
            },
        })
    }

    /// For each item of `all`, the index of the first item with the same surface, which is mostly its own index. For
    /// each mesh file, only its first `COMPARED` different surfaces are compared.
    pub(crate) fn twins(all: &[Self]) -> Vec<usize> {
        const COMPARED: usize = 16;
        let mut kinds: HashMap<*const MeshFile, Vec<usize>> = HashMap::new();
        let mut twin = |(index, inputs): (usize, &Self)| {
            let kinds = kinds.entry(Arc::as_ptr(&inputs.file)).or_default();
            if let Some(&same) = kinds.iter().find(|&&other| all[other] == *inputs) {
                return same;
            }
            if kinds.len() < COMPARED {
                kinds.push(index);
            }
            index
        };
        all.iter().enumerate().map(&mut twin).collect()
    }

    /// The mesh file; regions refer to its groups and materials by name.
    pub(crate) fn file(&self) -> &MeshFile {
        &self.file
    }

    pub(crate) fn build(&self) -> BodySurface {
        let mesh = placed(self.chosen(&self.file.mesh), self.scale, self.up);
        let materials = self.file.materials.iter().map(|material| self.material_of(material)).collect();
        let model_from_file = DMat3::from_diagonal(self.scale.0.into()) * self.up.y_up_from_file();
        let mut bending = BodyBend::default();
        if !mesh.triangles.is_empty() {
            let cache = self.cache.as_ref().zip(self.file.points.as_ref()).map(|(cache, points)| BodyCache {
                cache: Arc::clone(cache),
                points: Arc::clone(points),
                model_from_file,
            });
            bending = BodyBend::new(&self.file, self.morph.as_deref(), cache, model_from_file);
        }
        let mut surface = BodySurface { sides: Vec::new(), mesh, bending, materials };
        if surface.bends() && self.rest != BodyShape::default() {
            let Vertices { positions, normals } = surface.vertices_at(&self.rest);
            (surface.mesh.positions, surface.mesh.normals) = (positions, normals);
            // From here on, deformation gradients are relative to this rest.
            surface.bending = surface.bending.resting(self.rest.clone());
        }
        surface.sides = sides(&surface.mesh);
        surface
    }

    /// The whole mesh, or the triangles of the object's group.
    fn chosen(&self, mesh: &TriangleMesh) -> TriangleMesh {
        let mesh = mesh.clone();
        let Some(group) = &self.group else { return mesh };
        let in_group =
            |triangle: usize| self.file.groups[mesh.group_of_triangle[triangle] as usize] == *group;
        let kept: Vec<usize> = (0..mesh.triangles.len()).filter(|&triangle| in_group(triangle)).collect();
        let pick = |array: &[u32]| kept.iter().map(|&triangle| array[triangle]).collect::<Vec<u32>>();
        TriangleMesh {
            triangles: kept.iter().map(|&triangle| mesh.triangles[triangle]).collect(),
            polygon_of_triangle: pick(&mesh.polygon_of_triangle),
            group_of_triangle: pick(&mesh.group_of_triangle),
            material_of_triangle: pick(&mesh.material_of_triangle),
            ..mesh
        }
    }

    fn material_of(&self, from_file: &impasto_scene::mesh_file::Material) -> BodyMaterial {
        let over = self.material.as_ref();
        let gloss = over.and_then(|over| over.gloss).map_or(from_file.gloss, |gloss| gloss as f32);
        let is_unlit = over.is_some_and(|over| over.unlit);
        match over {
            Some(over) if over.color.is_some() || self.texture.is_some() => BodyMaterial {
                name: from_file.name.clone(),
                albedo: linear(over.color.unwrap_or(Color::white())),
                texture: self.texture.clone(),
                sampler: Sampler::default(),
                cutoff: None,
                unlit: is_unlit,
                gloss,
            },
            _ => BodyMaterial {
                name: from_file.name.clone(),
                albedo: linear(Color(from_file.color)),
                texture: from_file.texture.clone(),
                sampler: from_file.sampler,
                cutoff: from_file.cutoff,
                unlit: from_file.unlit || is_unlit,
                gloss,
            },
        }
    }
}

/// Turns the mesh so that its file's up axis becomes Y, and applies the static scale. A scale of zero leaves
/// no triangle: nothing is painted.
fn placed(mut mesh: TriangleMesh, scale: Scale, up: Up) -> TriangleMesh {
    let turn = |v: Vec3| match up {
        Up::Y => v,
        Up::Z => Vec3::new(v.x, v.z, -v.y),
        Up::X => Vec3::new(-v.y, v.x, v.z),
        Up::NegX => Vec3::new(v.y, -v.x, v.z),
        Up::NegY => Vec3::new(v.x, -v.y, -v.z),
        Up::NegZ => Vec3::new(v.x, -v.z, v.y),
    };
    let scale = Vec3::from_array(scale.0.map(|value| value as f32));
    if scale.min_element() <= 0.0 {
        return TriangleMesh::default();
    }
    for position in &mut mesh.positions {
        *position = turn(*position) * scale;
    }
    for normal in &mut mesh.normals {
        *normal = (turn(*normal) / scale).normalize_or(Vec3::Y);
    }
    mesh
}

impl BodySurface {
    /// Whether any of its materials in use is lit.
    pub(crate) fn is_lit(&self) -> bool {
        let is_lit = |triangle| {
            let material = self.materials.get(self.material_of_triangle(triangle));
            material.is_none_or(|material| !material.unlit)
        };
        (0..self.mesh.triangles.len()).any(is_lit)
    }

    /// Centre and length of the diagonal of the mesh's own bounds, model space.
    pub(crate) fn extent(&self) -> (DVec3, f64) {
        let (low, high) = self.mesh.bounds().unwrap_or_default();
        (((low + high) * 0.5).as_dvec3(), f64::from((high - low).length()))
    }

    /// Whether the albedo may differ from place to place within one material.
    pub(crate) fn has_colors(&self) -> bool {
        !self.mesh.colors.is_empty() || self.materials.iter().any(|material| material.texture.is_some())
    }

    /// The sRGB albedo of each of `particles` if a material has a texture or the mesh has colours of its own. Otherwise
    /// the sRGB albedo of each material.
    pub(crate) fn albedo(&self, particles: impl IndexedParallelIterator<Item = Particle>) -> Albedo {
        if self.has_colors() {
            return Albedo::OfParticle(particles.map(|particle| self.albedo_srgb8(&particle)).collect());
        }
        Albedo::OfMaterial(self.materials.iter().map(|material| srgb8(material, material.albedo)).collect())
    }

    pub(crate) fn material_of_triangle(&self, triangle: usize) -> usize {
        self.mesh.material_of_triangle.get(triangle).copied().unwrap_or(0) as usize
    }

    /// sRGB albedo at a particle, 8 bits a channel, as 0xAABBGGRR; A is 0 where unlit, else 255. [`HOLE`] where a
    /// texture cuts a hole.
    pub(crate) fn albedo_srgb8(&self, particle: &Particle) -> u32 {
        let material = self.material_of_triangle(particle.triangle as usize);
        let Some(material) = self.materials.get(material) else { return NO_MATERIAL };
        let mut albedo = material.albedo;
        if let (Some(texture), Some(uv)) = (&material.texture, particle.uv(&self.mesh)) {
            let [red, green, blue, alpha] = texture.pixel(material.sampler, uv.to_array());
            if material.cutoff.is_some_and(|cutoff| f32::from(alpha) / 255.0 < cutoff) {
                return HOLE;
            }
            for (channel, byte) in albedo.iter_mut().zip([red, green, blue]) {
                *channel *= linear_from_srgb(f32::from(byte) / 255.0);
            }
        }
        if let Some(color) = particle.color(&self.mesh) {
            albedo.iter_mut().zip(color.to_array()).for_each(|(channel, own)| *channel *= own);
        }
        srgb8(material, albedo)
    }
}

/// Stands for the albedo where a texture cuts a hole: no stroke lies there. Real albedos have an A of 0 or 255.
pub(crate) const HOLE: u32 = 0x0100_0000;

/// The albedo of triangles without a material.
const NO_MATERIAL: u32 = 0xffcc_cccc;

/// A linear albedo in the form that [`BodySurface::albedo_srgb8`] gives.
fn srgb8(material: &BodyMaterial, albedo: [f32; 3]) -> u32 {
    if material.cutoff.is_some_and(|cutoff| cutoff > 1.0) {
        return HOLE;
    }
    let [r, g, b] = albedo.map(|channel| (srgb_from_linear(channel) * 255.0).round() as u32);
    let lit = if material.unlit { 0 } else { 255 };
    lit << 24 | b << 16 | g << 8 | r
}

/// sRGB albedo of particles, 8 bits a channel, as 0xAABBGGRR; A is 0 where unlit.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Albedo {
    /// One albedo per material: no material has a texture, and the mesh has no colours of its own.
    OfMaterial(Vec<u32>),
    /// One albedo per particle.
    OfParticle(Vec<u32>),
}

impl Albedo {
    /// The albedo of a particle, which lies on this triangle of the surface.
    pub(crate) fn of(&self, surface: &BodySurface, particle: usize, triangle: usize) -> u32 {
        match self {
            Self::OfMaterial(all) => {
                all.get(surface.material_of_triangle(triangle)).copied().unwrap_or(NO_MATERIAL)
            }
            Self::OfParticle(all) => all[particle],
        }
    }
}
