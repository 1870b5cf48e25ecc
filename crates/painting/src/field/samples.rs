//! The samples of a body: the few points at which its direction field is solved.

use glam::Vec3;
use impasto_core::direction::carry::{SampleIndex, Stencils};
use impasto_core::direction::field::MAX_SAMPLES;
use impasto_core::neighbours::Points;
use impasto_core::sampling::{self, Particle, Surface};

#[derive(Debug)]
pub(crate) struct FieldSamples {
    pub(super) particles: Vec<Particle>,
    pub(super) positions: Vec<Vec3>,
    pub(super) normals: Vec<Vec3>,
    /// How far apart they are, model units.
    pub(super) spacing: f64,
    index: SampleIndex,
}

/// No samples.
impl Default for FieldSamples {
    fn default() -> Self {
        Self::of(Vec::new(), 1.0)
    }
}

impl FieldSamples {
    pub(crate) fn new(surface: &Surface<'_>, name_hash: u32) -> Self {
        let particles = sampling::samples(surface, MAX_SAMPLES, name_hash);
        let spacing = sampling::hexagonal_spacing(surface.area(), particles.len().max(1));
        Self::of(particles, spacing)
    }

    fn of(particles: Vec<Particle>, spacing: f64) -> Self {
        let positions: Vec<Vec3> = particles.iter().map(|particle| particle.position).collect();
        let normals: Vec<Vec3> = particles.iter().map(|particle| particle.normal).collect();
        let index = SampleIndex::new(Points { positions: &positions, normals: &normals }, spacing);
        Self { particles, positions, normals, spacing, index }
    }

    /// Which samples each of these particles takes its direction from.
    pub(crate) fn stencils(&self, particles: Points<'_>) -> Stencils {
        Stencils::new(particles, &self.index)
    }
}
