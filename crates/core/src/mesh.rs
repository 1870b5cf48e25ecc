//! A triangle mesh in its own (model) space: what sampling and drawing both read.

use glam::{Vec2, Vec3};

/// A triangle mesh in model space.
///
/// A vertex is a position with a normal, uv and colour: corners that differ in any of them are different vertices,
/// so hard edges are split and smooth ones are shared. Triangles should wind counter-clockwise seen from outside;
/// `shells::sides` finds closed shells that do not.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TriangleMesh {
    /// One position per vertex, finite.
    pub positions: Vec<Vec3>,
    /// One unit normal per vertex, finite.
    pub normals: Vec<Vec3>,
    /// One texture coordinate per vertex (V up, as in OBJ), or empty when the file has none.
    pub uvs: Vec<Vec2>,
    /// One colour per vertex, linear Rec. 709, which multiplies that of the material; or empty when the file has none.
    pub colors: Vec<Vec3>,
    /// Vertex indices, three per triangle, each less than `positions.len()`.
    pub triangles: Vec<[u32; 3]>,
    /// For each triangle, the number of the polygon that it was cut from; never decreases. Polygons of a file that give
    /// no triangles have no number.
    pub polygon_of_triangle: Vec<u32>,
    /// For each triangle, an index into the mesh file's group names.
    pub group_of_triangle: Vec<u32>,
    /// For each triangle, an index into the mesh file's materials.
    pub material_of_triangle: Vec<u32>,
}

impl TriangleMesh {
    /// The three corner positions of one triangle, in model space.
    #[inline]
    pub fn corners(&self, triangle: usize) -> [Vec3; 3] {
        of_corners(&self.positions, self.triangles[triangle])
    }

    /// Least and greatest corner of the axis-aligned box round the triangles' vertices, in model space;
    /// `None` for a mesh without triangles. Vertices that no triangle uses do not count.
    pub fn bounds(&self) -> Option<(Vec3, Vec3)> {
        self.bounds_at(&self.positions)
    }

    /// As [`Self::bounds`], with the vertices at these positions.
    pub fn bounds_at(&self, positions: &[Vec3]) -> Option<(Vec3, Vec3)> {
        let mut used = self.triangles.iter().flatten().map(|&vertex| positions[vertex as usize]);
        let first = used.next()?;
        Some(used.fold((first, first), |(low, high), position| (low.min(position), high.max(position))))
    }

    /// The number of the last triangle's polygon, plus one. In the whole mesh of a file, this is how many polygons have
    /// triangles.
    pub fn polygon_count(&self) -> usize {
        self.polygon_of_triangle.last().map_or(0, |&last| last as usize + 1)
    }
}

/// The values of a triangle's vertices. Written out because [`array::map`] is not always inlined.
#[inline(always)]
pub(crate) fn of_corners<T: Copy>(of_vertices: &[T], [a, b, c]: [u32; 3]) -> [T; 3] {
    [of_vertices[a as usize], of_vertices[b as usize], of_vertices[c as usize]]
}
