//! Surfaces on the GPU: each is uploaded once and stays until no frame uses it any more. The vertices of a deformed
//! ("bent") body are uploaded for each frame; every pass draws from them.

use std::cell::RefCell;
use std::collections::HashMap;
use std::rc::{Rc, Weak as RcWeak};
use std::sync::{Arc, Weak};

use bytemuck::{Pod, Zeroable};
use glam::{Vec3, Vec4};
use impasto_core::shells::Side;
use impasto_painting::frame::{Bent, BodySurface, FrameBody, Vertices as BodyVertices};

use crate::gl::{Attribute, Buffer, BufferUse, Format, GlError, Gpu, Texture, VertexArray, Vertices};

/// A body of a frame, with its surface on the GPU.
pub(crate) struct DrawnBody<'a> {
    pub(crate) body: &'a FrameBody,
    pub(crate) mesh: Rc<MeshOnGpu>,
    /// Its vertices in this frame.
    pub(crate) array: Rc<VertexArray>,
}

pub(crate) struct MeshOnGpu {
    /// The shader inputs with the vertices at rest.
    array: Rc<VertexArray>,
    pub(crate) parts: Vec<Part>,
    /// Positions and normals of the vertices at rest.
    vertices: Buffer,
    uvs: Buffer,
    /// 1 minus the colour of each vertex, linear; `None` where the mesh has no colours of its own.
    shades: Option<Buffer>,
    indices: Buffer,
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
    /// Whether it casts a shadow; unlit materials, such as a painted sky, do not.
    pub(crate) casts_shadow: bool,
}

impl Part {
    pub(crate) fn vertices(&self) -> Vertices {
        Vertices::Indexed { first: self.first_index, count: self.index_count }
    }
}

pub(crate) struct MeshCache {
    /// Keyed by the address of the surface; the weak pointer keeps the address from being used again.
    entries: HashMap<*const BodySurface, (Weak<BodySurface>, Rc<MeshOnGpu>)>,
    bent: Vec<BentOnGpu>,
    white: Rc<Texture>,
}

/// The vertices of a deformed body.
struct BentOnGpu {
    mesh: RcWeak<MeshOnGpu>,
    /// The bent surface whose vertices the buffer holds.
    bent: Weak<Bent>,
    vertices: Buffer,
    array: Rc<VertexArray>,
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Vertex {
    position: [f32; 3],
    normal: [f32; 3],
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
            // The far side is seen through holes, so parts with holes keep all their triangles.
            let showing = part.triangles.iter().filter(|&&triangle| part.cutoff.is_some() || shows(triangle));
            indices.extend(showing.map(|&triangle| mesh.triangles[triangle as usize]));
            ranges.push([first, indices.len() - first].map(|count| count as u32 * 3));
        }
        let mut front = self.front.borrow_mut();
        let faces = match front.take() {
            Some(faces) => faces,
            None => {
                let indices = Buffer::new(gpu, BufferUse::Streamed)?;
                let array = VertexArray::new(gpu, &self.inputs(&self.vertices), Some(&indices))?;
                FrontFaces { array: Rc::new(array), indices }
            }
        };
        let faces = front.insert(faces);
        faces.indices.upload(bytemuck::cast_slice(&indices))?;
        Ok((Rc::clone(&faces.array), ranges))
    }
}

impl MeshOnGpu {
    /// The shader inputs of the mesh, with these vertices. Where there are no shades, the shader reads zeros.
    fn inputs<'a>(&'a self, vertices: &'a Buffer) -> Vec<Attribute<'a>> {
        let mut inputs = vec![
            attribute(0, vertices, 3, [24, 0]),
            attribute(1, vertices, 3, [24, 12]),
            attribute(2, &self.uvs, 2, [8, 0]),
        ];
        inputs.extend(self.shades.as_ref().map(|shades| attribute(3, shades, 3, [12, 0])));
        inputs
    }
}

impl BentOnGpu {
    fn is_of(&self, bent: &Arc<Bent>) -> bool {
        std::ptr::eq(self.bent.as_ptr(), Arc::as_ptr(bent))
    }
}

fn attribute(
    location: u32,
    buffer: &Buffer,
    components: i32,
    [stride_bytes, offset_bytes]: [i32; 2],
) -> Attribute<'_> {
    Attribute {
        location,
        buffer,
        components,
        integer: false,
        stride_bytes,
        offset_bytes,
        per_instance: false,
    }
}

fn interleaved(positions: &[Vec3], normals: &[Vec3]) -> Vec<Vertex> {
    let vertex = |(position, normal): (&Vec3, &Vec3)| Vertex {
        position: position.to_array(),
        normal: normal.to_array(),
    };
    positions.iter().zip(normals).map(vertex).collect()
}

impl MeshCache {
    pub(crate) fn new(gpu: &Gpu) -> Result<Self, GlError> {
        let white = Texture::with_driver_levels(gpu, Format::SrgbAlpha8, [1, 1], &[255; 4])?;
        Ok(Self { entries: HashMap::new(), bent: Vec::new(), white: Rc::new(white) })
    }

    pub(crate) fn drawn<'a>(&mut self, gpu: &Gpu, body: &'a FrameBody) -> Result<DrawnBody<'a>, GlError> {
        let mesh = self.get(gpu, &body.surface)?;
        let array = match body.bent.as_ref().filter(|_| !body.hidden) {
            Some(bent) => Rc::clone(&self.bent(gpu, &mesh, bent)?.array),
            None => Rc::clone(&mesh.array),
        };
        Ok(DrawnBody { body, mesh, array })
    }

    /// A vertex array of a body in two frames: the inputs of `now`, and the positions of `then` as one more input.
    pub(crate) fn with_then(
        &mut self,
        gpu: &Gpu,
        now: &FrameBody,
        then: &FrameBody,
    ) -> Result<VertexArray, GlError> {
        let mesh = self.get(gpu, &now.surface)?;
        // Held, so that the second upload does not take the buffer of the first.
        let mut held = Vec::new();
        for bent in now.bent.iter().chain(&then.bent) {
            held.push(Rc::clone(&self.bent(gpu, &mesh, bent)?.array));
        }
        let vertices = |body: &FrameBody| {
            let known = body.bent.as_ref().and_then(|bent| self.bent.iter().find(|known| known.is_of(bent)));
            known.map_or(&mesh.vertices, |known| &known.vertices)
        };
        let mut inputs = mesh.inputs(vertices(now));
        inputs.push(attribute(4, vertices(then), 3, [24, 0]));
        VertexArray::new(gpu, &inputs, Some(&mesh.indices))
    }

    /// The vertices of a deformed body. If they are new, uploads them into a buffer that no drawn body uses.
    fn bent(&mut self, gpu: &Gpu, mesh: &Rc<MeshOnGpu>, bent: &Arc<Bent>) -> Result<&BentOnGpu, GlError> {
        if let Some(known) = self.bent.iter().position(|known| known.is_of(bent)) {
            return Ok(&self.bent[known]);
        }
        self.bent.retain(|known| known.mesh.strong_count() > 0);
        let is_free = |known: &BentOnGpu| {
            std::ptr::eq(known.mesh.as_ptr(), Rc::as_ptr(mesh)) && Rc::strong_count(&known.array) == 1
        };
        let index = match self.bent.iter().position(is_free) {
            Some(index) => index,
            None => {
                let vertices = Buffer::new(gpu, BufferUse::Streamed)?;
                let array = Rc::new(VertexArray::new(gpu, &mesh.inputs(&vertices), Some(&mesh.indices))?);
                self.bent.push(BentOnGpu { mesh: Rc::downgrade(mesh), bent: Weak::new(), vertices, array });
                self.bent.len() - 1
            }
        };
        let entry = &mut self.bent[index];
        // Empty during the upload, so that the leftovers of a failed upload are not mistaken for these vertices.
        entry.bent = Weak::new();
        let BodyVertices { positions, normals } = &bent.vertices;
        entry.vertices.upload(bytemuck::cast_slice(&interleaved(positions, normals)))?;
        entry.bent = Arc::downgrade(bent);
        Ok(entry)
    }

    /// Frees surfaces that no frame uses any more.
    pub(crate) fn free_unused(&mut self) {
        self.entries.retain(|_, (surface, _)| surface.strong_count() > 0);
    }

    /// The surface on the GPU. Uploads it the first time.
    fn get(&mut self, gpu: &Gpu, surface: &Arc<BodySurface>) -> Result<Rc<MeshOnGpu>, GlError> {
        if let Some((_, mesh)) = self.entries.get(&Arc::as_ptr(surface)) {
            return Ok(Rc::clone(mesh));
        }
        let mesh = Rc::new(self.upload(gpu, surface)?);
        self.entries.insert(Arc::as_ptr(surface), (Arc::downgrade(surface), Rc::clone(&mesh)));
        Ok(mesh)
    }

    fn upload(&self, gpu: &Gpu, surface: &BodySurface) -> Result<MeshOnGpu, GlError> {
        let mesh = &surface.mesh;
        let vertices = interleaved(&mesh.positions, &mesh.normals);
        // A mesh without texture coordinates gets X and Y instead. In such a mesh only noise reads them.
        let uv_of = |index: usize| mesh.uvs.get(index).copied().unwrap_or(mesh.positions[index].truncate());
        let uvs: Vec<[f32; 2]> = (0..mesh.positions.len()).map(|index| uv_of(index).to_array()).collect();
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
        let mut uv_buffer = Buffer::new(gpu, BufferUse::Fixed)?;
        uv_buffer.upload(bytemuck::cast_slice(&uvs))?;
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
        let mut on_gpu = MeshOnGpu {
            array: Rc::new(VertexArray::empty(gpu)?),
            parts,
            vertices: vertex_buffer,
            uvs: uv_buffer,
            shades,
            indices: index_buffer,
            front: RefCell::new(None),
            bounds: mesh.bounds(),
        };
        let array = VertexArray::new(gpu, &on_gpu.inputs(&on_gpu.vertices), Some(&on_gpu.indices))?;
        on_gpu.array = Rc::new(array);
        Ok(on_gpu)
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

/// Gives fully transparent texels the mean colour of all others. Otherwise their hidden colours would fringe the
/// borders of the holes.
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
