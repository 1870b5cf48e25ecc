//! Surfaces on the GPU: each is uploaded once and stays until no frame uses it any more.

use std::cell::RefCell;
use std::rc::Rc;
use std::sync::{Arc, Weak};

use bytemuck::{Pod, Zeroable};
use glam::{Vec3, Vec4};
use impasto_core::shells::Side;
use impasto_painting::frame::{BodySurface, FrameBody};

use crate::gl::{Attribute, Buffer, BufferUse, Format, GlError, Gpu, Texture, VertexArray, Vertices};

/// A body of a frame, with its surface on the GPU.
pub(crate) struct DrawnBody<'a> {
    pub(crate) body: &'a FrameBody,
    pub(crate) mesh: Rc<MeshOnGpu>,
}

/// One uploaded surface.
pub(crate) struct MeshOnGpu {
    pub(crate) array: VertexArray,
    pub(crate) parts: Vec<Part>,
    vertices: Buffer,
    /// What each vertex takes away of each channel, linear; `None` where the mesh has no colours of its own.
    shades: Option<Buffer>,
    _indices: Buffer,
    /// Created when the first draft is drawn.
    front: RefCell<Option<FrontFaces>>,
    /// Lowest and highest corner of the bounding box, model space.
    pub(crate) bounds: Option<(Vec3, Vec3)>,
}

/// The triangles of a mesh that face the eye, found anew for each draft.
struct FrontFaces {
    array: Rc<VertexArray>,
    indices: Buffer,
}

/// Triangles of one material.
pub(crate) struct Part {
    pub(crate) first_index: u32,
    pub(crate) index_count: u32,
    /// The same triangles, by their index in the mesh.
    triangles: Vec<u32>,
    pub(crate) material: usize,
    pub(crate) texture: Rc<Texture>,
    /// Where the texture's alpha is less than this, there is no surface.
    pub(crate) cutoff: Option<f32>,
    /// Whether it casts a shadow: what light does not fall on, as a painted sky, does not.
    pub(crate) casts_shadow: bool,
}

impl Part {
    /// What to draw of the mesh for this part.
    pub(crate) fn vertices(&self) -> Vertices {
        Vertices::Indexed { first: self.first_index, count: self.index_count }
    }
}

/// All surfaces on the GPU.
pub(crate) struct MeshCache {
    entries: Vec<(Weak<BodySurface>, Rc<MeshOnGpu>)>,
    white: Rc<Texture>,
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Vertex {
    position: [f32; 3],
    normal: [f32; 3],
    uv: [f32; 2],
    /// Where the morph takes the vertex; without a morph, its own position and normal.
    target_position: [f32; 3],
    target_normal: [f32; 3],
}

impl MeshOnGpu {
    /// Whether an eye (as in [`MeshOnGpu::front`]) is clearly outside the mesh's bounding box.
    pub(crate) fn is_outside(&self, eye_in_model: Vec4) -> bool {
        let Some((low, high)) = self.bounds else { return true };
        let margin = (high - low) * 0.05;
        let eye = eye_in_model.truncate();
        eye_in_model.w == 0.0 || eye.cmplt(low - margin).any() || eye.cmpgt(high + margin).any()
    }

    /// The triangles that face the eye, and for each part its first index and number of indices. On a closed shell,
    /// these triangles hide all others. The eye is in model space; for parallel rays its w is 0 and it is a direction.
    pub(crate) fn front(
        &self,
        gpu: &Gpu,
        surface: &BodySurface,
        eye_in_model: Vec4,
    ) -> Result<(Rc<VertexArray>, Vec<[u32; 2]>), GlError> {
        let mesh = &surface.mesh;
        let (eye, w) = (eye_in_model.truncate(), eye_in_model.w);
        let shows = |triangle: u32| {
            let [a, b, c] = mesh.corners(triangle as usize);
            let facing = (b - a).cross(c - a).dot(eye - a * w);
            match surface.sides[triangle as usize] {
                Side::Front => facing > 0.0,
                Side::Back => facing < 0.0,
                Side::Both => true,
            }
        };
        let mut indices: Vec<[u32; 3]> = Vec::with_capacity(mesh.triangles.len());
        let mut ranges = Vec::with_capacity(self.parts.len());
        for part in &self.parts {
            let first = indices.len();
            // Through holes the far side is seen too.
            let showing = part.triangles.iter().filter(|&&triangle| part.cutoff.is_some() || shows(triangle));
            indices.extend(showing.map(|&triangle| mesh.triangles[triangle as usize]));
            ranges.push([first, indices.len() - first].map(|count| count as u32 * 3));
        }
        let mut front = self.front.borrow_mut();
        let faces = match front.take() {
            Some(faces) => faces,
            None => {
                let indices = Buffer::new(gpu, BufferUse::Streamed)?;
                let array =
                    VertexArray::new(gpu, &inputs(&self.vertices, self.shades.as_ref()), Some(&indices))?;
                FrontFaces { array: Rc::new(array), indices }
            }
        };
        let faces = front.insert(faces);
        faces.indices.upload(bytemuck::cast_slice(&indices))?;
        Ok((Rc::clone(&faces.array), ranges))
    }
}

/// The fields of [`Vertex`] as shader inputs, and the shades. Where there are none, the shader reads zeros.
fn inputs<'a>(vertices: &'a Buffer, shades: Option<&'a Buffer>) -> Vec<Attribute<'a>> {
    let of = |location: usize,
              buffer: &'a Buffer,
              components: i32,
              [stride_bytes, offset_bytes]: [i32; 2]| Attribute {
        location: location as u32,
        buffer,
        components,
        integer: false,
        stride_bytes,
        offset_bytes,
        per_instance: false,
    };
    let fields = [(3, 0), (3, 12), (2, 24), (3, 32), (3, 44)];
    let stride_bytes = size_of::<Vertex>() as i32;
    let of_vertex = fields.into_iter().enumerate().map(|(location, (components, offset_bytes))| {
        of(location, vertices, components, [stride_bytes, offset_bytes])
    });
    of_vertex.chain(shades.map(|shades| of(fields.len(), shades, 3, [12, 0]))).collect()
}

impl MeshCache {
    pub(crate) fn new(gpu: &Gpu) -> Result<Self, GlError> {
        let white = Texture::with_driver_levels(gpu, Format::SrgbAlpha8, [1, 1], &[255; 4])?;
        Ok(Self { entries: Vec::new(), white: Rc::new(white) })
    }

    /// The surface on the GPU. Uploads it the first time, and frees surfaces that no frame uses any more.
    pub(crate) fn get(&mut self, gpu: &Gpu, surface: &Arc<BodySurface>) -> Result<Rc<MeshOnGpu>, GlError> {
        let here = |weak: &Weak<BodySurface>| std::ptr::eq(weak.as_ptr(), Arc::as_ptr(surface));
        if let Some((_, mesh)) = self.entries.iter().find(|(weak, _)| here(weak)) {
            return Ok(Rc::clone(mesh));
        }
        self.entries.retain(|(weak, _)| weak.strong_count() > 0);
        let mesh = Rc::new(self.upload(gpu, surface)?);
        self.entries.push((Arc::downgrade(surface), Rc::clone(&mesh)));
        Ok(mesh)
    }

    fn upload(&self, gpu: &Gpu, surface: &BodySurface) -> Result<MeshOnGpu, GlError> {
        let mesh = &surface.mesh;
        let (target_positions, target_normals) = match &surface.morph {
            Some(target) => (&target.positions, &target.normals),
            None => (&mesh.positions, &mesh.normals),
        };
        let vertices: Vec<Vertex> = (0..mesh.positions.len())
            .map(|index| Vertex {
                position: mesh.positions[index].to_array(),
                normal: mesh.normals[index].to_array(),
                // A mesh without texture coordinates gets X and Y instead. In such a mesh only noise reads them.
                uv: mesh.uvs.get(index).copied().unwrap_or(mesh.positions[index].truncate()).to_array(),
                target_position: target_positions[index].to_array(),
                target_normal: target_normals[index].to_array(),
            })
            .collect();
        let material_of =
            |triangle: usize| mesh.material_of_triangle.get(triangle).map_or(0, |&m| m as usize);
        let mut by_material: Vec<usize> = (0..mesh.triangles.len()).collect();
        by_material.sort_by_key(|&triangle| material_of(triangle));
        let indices: Vec<u32> = by_material.iter().flat_map(|&triangle| mesh.triangles[triangle]).collect();
        let mut parts: Vec<Part> = Vec::new();
        for run in by_material.chunk_by(|&a, &b| material_of(a) == material_of(b)) {
            let material = material_of(run[0]);
            let first_index = parts.last().map_or(0, |part| part.first_index + part.index_count);
            let texture = self.texture(gpu, surface, material)?;
            let triangles = run.iter().map(|&triangle| triangle as u32).collect();
            let stated = surface.materials.get(material);
            let cutoff = stated.and_then(|material| material.cutoff);
            let casts_shadow = stated.is_none_or(|material| !material.unlit);
            let index_count = run.len() as u32 * 3;
            parts.push(Part { first_index, index_count, triangles, material, texture, cutoff, casts_shadow });
        }
        let mut vertex_buffer = Buffer::new(gpu, BufferUse::Fixed)?;
        vertex_buffer.upload(bytemuck::cast_slice(&vertices))?;
        let mut index_buffer = Buffer::new(gpu, BufferUse::Fixed)?;
        index_buffer.upload(bytemuck::cast_slice(&indices))?;
        let shades: Vec<[f32; 3]> = mesh.colors.iter().map(|color| (Vec3::ONE - *color).to_array()).collect();
        let shades = match shades.is_empty() {
            true => None,
            false => {
                let mut buffer = Buffer::new(gpu, BufferUse::Fixed)?;
                buffer.upload(bytemuck::cast_slice(&shades))?;
                Some(buffer)
            }
        };
        let array = VertexArray::new(gpu, &inputs(&vertex_buffer, shades.as_ref()), Some(&index_buffer))?;
        let front = RefCell::new(None);
        Ok(MeshOnGpu {
            array,
            parts,
            vertices: vertex_buffer,
            shades,
            _indices: index_buffer,
            front,
            bounds: mesh.bounds(),
        })
    }

    fn texture(&self, gpu: &Gpu, surface: &BodySurface, material: usize) -> Result<Rc<Texture>, GlError> {
        let material = surface.materials.get(material).filter(|_| !surface.mesh.uvs.is_empty());
        let Some((material, picture)) =
            material.and_then(|material| Some((material, material.texture.as_ref()?)))
        else {
            return Ok(Rc::clone(&self.white));
        };
        // OBJ counts V from the bottom; the first row of a picture is its top.
        let width = picture.size_px[0] as usize;
        let mut texels: Vec<[u8; 4]> = picture.rgba8.chunks(width).rev().flatten().copied().collect();
        if material.cutoff.is_some() {
            color_of_holes(&mut texels);
        }
        let limit = gpu.limits().max_side_px;
        if picture.size_px.iter().any(|&side| side > limit) {
            return Err(GlError::Resource {
                what: format!("a texture of {} x {} pixels", picture.size_px[0], picture.size_px[1]),
                reason: format!("this driver's limit is {limit}"),
            });
        }
        let bytes = bytemuck::cast_slice(&texels);
        let texture = Texture::with_driver_levels(gpu, Format::SrgbAlpha8, picture.size_px, bytes)?;
        texture.set_sampler(material.sampler);
        Ok(Rc::new(texture))
    }
}

/// Gives texels without alpha the mean colour of the others, so that what a file hides there does not fringe the borders.
fn color_of_holes(texels: &mut [[u8; 4]]) {
    let mut sum = [0u64; 3];
    let mut count = 0;
    for texel in texels.iter().filter(|texel| texel[3] > 0) {
        (0..3).for_each(|channel| sum[channel] += u64::from(texel[channel]));
        count += 1;
    }
    let [red, green, blue] = sum.map(|sum| (sum / count.max(1)) as u8);
    texels.iter_mut().filter(|texel| texel[3] == 0).for_each(|texel| *texel = [red, green, blue, 0]);
}
