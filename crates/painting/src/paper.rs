//! Counts strokes by the source paper's own rule: each polygon shows as many of its particles as its projected area
//! asks for.

use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Vec3};
use impasto_core::ScreenMap;
use impasto_core::TriangleMesh;
use impasto_core::hash;
use impasto_core::sampling::{PolygonParticle, Surface};
use impasto_core::screen_map::area_px;

/// The polygons of a body, and which of them each particle belongs to.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PolygonCounts {
    /// For each particle, the index of its polygon side in `sides`, and its number on that side.
    of_particle: Vec<(u32, u32)>,
    sides: Vec<PolygonSide>,
    /// For each face, its triangle, the index of its polygon side in `sides`, and whether it is the triangle's back.
    faces: Vec<(u32, u32, bool)>,
}

/// One side of one polygon.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(crate) struct PolygonSide {
    center: DVec3,
    normal: DVec3,
    area: f64,
    /// How many particles it has.
    count: u32,
    unused: u32,
}

/// [`PolygonCounts`] in the form in which they are stored for another process.
pub(crate) struct KeptPolygons<'a> {
    pub(crate) of_particle: Vec<[u32; 2]>,
    pub(crate) sides: &'a [PolygonSide],
    pub(crate) faces: Vec<[u32; 3]>,
}

impl PolygonCounts {
    /// Restores the counts from their stored form; `None` if an index is out of range.
    pub(crate) fn of_kept(
        of_particle: Vec<[u32; 2]>,
        sides: Vec<PolygonSide>,
        faces: Vec<[u32; 3]>,
        triangles: usize,
    ) -> Option<Self> {
        let is_side = |side: u32| (side as usize) < sides.len();
        let fits = of_particle.iter().all(|&[side, _]| is_side(side))
            && faces.iter().all(|&[triangle, side, flipped]| {
                (triangle as usize) < triangles && is_side(side) && flipped < 2
            });
        fits.then(|| Self {
            of_particle: of_particle.into_iter().map(|[side, number]| (side, number)).collect(),
            faces: faces
                .into_iter()
                .map(|[triangle, side, flipped]| (triangle, side, flipped == 1))
                .collect(),
            sides,
        })
    }

    pub(crate) fn to_keep(&self) -> KeptPolygons<'_> {
        let Self { of_particle, sides, faces } = self;
        KeptPolygons {
            of_particle: of_particle.iter().map(|&(side, number)| [side, number]).collect(),
            sides,
            faces: faces.iter().map(|&(triangle, side, flipped)| [triangle, side, flipped.into()]).collect(),
        }
    }

    pub(crate) fn new(surface: &Surface<'_>, mesh: &TriangleMesh, particles: &[PolygonParticle]) -> Self {
        let mut index_of: std::collections::HashMap<(u32, bool), u32> = std::collections::HashMap::new();
        let (mut sides, mut faces): (Vec<PolygonSide>, _) = (Vec::new(), Vec::new());
        let polygon_of =
            |triangle: u32| mesh.polygon_of_triangle.get(triangle as usize).copied().unwrap_or(triangle);
        for (triangle, flipped, area) in surface.faces() {
            let [a, b, c] = mesh.corners(triangle as usize).map(Vec3::as_dvec3);
            let index = *index_of.entry((polygon_of(triangle), flipped)).or_insert(sides.len() as u32);
            if index as usize == sides.len() {
                sides.push(PolygonSide::zeroed());
            }
            faces.push((triangle, index, flipped));
            let side = &mut sides[index as usize];
            side.center += (a + b + c) / 3.0 * area;
            side.normal += (b - a).cross(c - a) * if flipped { -1.0 } else { 1.0 };
            side.area += area;
        }
        for side in &mut sides {
            side.center /= side.area;
            side.normal = side.normal.normalize_or_zero();
        }
        let of_particle = particles
            .iter()
            .map(|entry| {
                let index = index_of[&(polygon_of(entry.particle.triangle), entry.particle.flipped)];
                sides[index as usize].count = entry.count_in_polygon;
                (index, entry.number_in_polygon)
            })
            .collect();
        Self { of_particle, sides, faces }
    }

    /// How many particles of each polygon side show in a view. Fractions are rounded at a threshold that is random but
    /// fixed for each side, so that the right share of the polygons smaller than a stroke is painted. `moved` are the
    /// mesh and the positions of its vertices now; `None` at rest.
    pub(crate) fn shown(
        &self,
        map: &ScreenMap,
        wanted_per_px: f64,
        moved: Option<(&TriangleMesh, &[Vec3])>,
    ) -> Vec<u32> {
        let moved = moved.map(|(mesh, positions)| self.moved(mesh, positions));
        moved
            .as_ref()
            .unwrap_or(&self.sides)
            .iter()
            .zip(0..)
            .map(|(side, index)| {
                let projected_px = area_px(map.jacobian(side.center), side.normal) * side.area;
                let wanted = projected_px * wanted_per_px;
                let threshold = f64::from(hash::unit(hash::scramble(index)));
                if wanted > 0.0 { ((wanted + threshold) as u32).min(side.count) } else { 0 }
            })
            .collect()
    }

    /// The sides when the vertices are at these positions.
    fn moved(&self, mesh: &TriangleMesh, positions: &[Vec3]) -> Vec<PolygonSide> {
        let still =
            |side: &PolygonSide| PolygonSide { center: DVec3::ZERO, normal: DVec3::ZERO, area: 0.0, ..*side };
        let mut sides: Vec<PolygonSide> = self.sides.iter().map(still).collect();
        for &(triangle, index, flipped) in &self.faces {
            let [a, b, c] =
                mesh.triangles[triangle as usize].map(|vertex| positions[vertex as usize].as_dvec3());
            let across = (b - a).cross(c - a) * if flipped { -1.0 } else { 1.0 };
            let (side, area) = (&mut sides[index as usize], 0.5 * across.length());
            side.center += (a + b + c) / 3.0 * area;
            side.normal += across;
            side.area += area;
        }
        for side in &mut sides {
            side.center /= side.area.max(f64::MIN_POSITIVE);
            side.normal = side.normal.normalize_or_zero();
        }
        sides
    }

    /// Whether a particle is among the `shown` ones of its polygon side.
    pub(crate) fn is_shown(&self, shown: &[u32], particle: usize) -> bool {
        let (side, number) = self.of_particle[particle];
        number < shown[side as usize]
    }
}
