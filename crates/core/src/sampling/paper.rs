//! The source paper's sampling: the same number of particles at random points of every polygon.

use rayon::prelude::*;

use super::{Particle, Surface, barycentric};
use crate::hash;

/// A particle with its number among those on the same side of the same polygon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PolygonParticle {
    /// The particle.
    pub particle: Particle,
    /// 0 for the first on this side of its polygon.
    pub number_in_polygon: u32,
    /// How many there are on this side of its polygon.
    pub count_in_polygon: u32,
}

/// Samples `count` particles at random points, the same number on each visible side of each polygon (source paper,
/// 2.1). If `count` does not divide evenly, the first sides get one more.
pub fn per_polygon(surface: &Surface<'_>, count: usize, seed: u32) -> Vec<PolygonParticle> {
    let polygons = polygons(surface);
    let counts: Vec<usize> = (0..polygons.len())
        .map(|polygon| count / polygons.len() + usize::from(polygon < count % polygons.len()))
        .collect();
    polygons
        .into_par_iter()
        .zip(counts)
        .enumerate()
        .flat_map_iter(|(polygon, (faces, count))| {
            let seed = hash::combine(seed, polygon as u32);
            (0..count as u32).map(move |number| {
                let seed = hash::combine(seed, number);
                let area: f64 = faces.iter().map(|&(_, area)| area).sum();
                let mut target = f64::from(hash::unit(hash::combine(seed, 0))) * area;
                let mut face = faces[0].0;
                for &(candidate, area) in &faces {
                    face = candidate;
                    if target < area {
                        break;
                    }
                    target -= area;
                }
                let at = barycentric(hash::unit(hash::combine(seed, 1)), hash::unit(hash::combine(seed, 2)));
                PolygonParticle {
                    particle: surface.particle(face, at),
                    number_in_polygon: number,
                    count_in_polygon: count as u32,
                }
            })
        })
        .collect()
}

/// For each visible side of each polygon, its faces with their areas.
fn polygons(surface: &Surface<'_>) -> Vec<Vec<(usize, f64)>> {
    let mut polygons: Vec<Vec<(usize, f64)>> = Vec::new();
    let mut keys: std::collections::HashMap<(u32, bool), usize> = std::collections::HashMap::new();
    for (index, (triangle, flipped, area)) in surface.faces().enumerate() {
        let polygon = surface.mesh.polygon_of_triangle.get(triangle as usize).copied().unwrap_or(triangle);
        let slot = *keys.entry((polygon, flipped)).or_insert_with(|| {
            polygons.push(Vec::new());
            polygons.len() - 1
        });
        polygons[slot].push((index, area));
    }
    polygons
}
