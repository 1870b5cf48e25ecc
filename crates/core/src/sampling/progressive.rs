//! Progressive dart throwing: an order in which every beginning is blue noise.

use super::candidates::Candidates;
use super::dart_grid::DartGrid;
use super::{Particle, Surface, hexagonal_spacing};

/// The particle after `n` others keeps this share of the hexagonal spacing of `n + 1` particles from them all. More is
/// smoother and slower: at 0.776 no room is ever left (the density of a maximal Poisson disk set).
const SPACING: f64 = 0.63;

/// After so many failures the best of them is taken: on thin parts, and for the first few particles, there may be no
/// room at all.
const MAX_TRIES: usize = 48;

/// `count` particles in progressive blue-noise order: the first `n` of them are spread evenly, for every `n`, and a
/// greater `count` keeps the particles that a smaller one gives.
///
/// Dart throwing with a spacing that depends on how many there are already, never on how many there will be. Two
/// particles crowd each other only on the same side of the surface, so thin sheets carry their full share on both.
/// The result depends on the mesh, the count and the seed alone. An empty surface gives no particles.
pub fn progressive(surface: &Surface<'_>, count: usize, seed: u32) -> Vec<Particle> {
    if surface.faces.is_empty() || count == 0 {
        return Vec::new();
    }
    let area = surface.area();
    let radius_after = |accepted: usize| (SPACING * hexagonal_spacing(area, accepted + 1)) as f32;
    let mut candidates = Candidates::new(surface, seed);
    let mut grid = DartGrid::new(radius_after(0));
    // Grows as particles are found, so that a count is never taken on trust.
    let mut particles: Vec<Particle> = Vec::new();
    while particles.len() < count {
        let radius = radius_after(particles.len());
        grid.shrink_to(radius);
        let mut best_sq = -1.0;
        let mut best = None;
        for _ in 0..MAX_TRIES {
            let candidate = candidates.next();
            let nearest_sq = grid.nearest_sq(candidate.position, candidate.normal, radius, best_sq);
            if nearest_sq > best_sq {
                best_sq = nearest_sq;
                best = Some(candidate);
                if nearest_sq >= radius * radius {
                    break;
                }
            }
        }
        let Some(accepted) = best else { break };
        grid.insert(accepted.position, accepted.normal);
        particles.push(accepted);
    }
    particles
}
