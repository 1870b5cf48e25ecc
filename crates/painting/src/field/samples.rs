//! The samples of a body: the few points at which its direction field is solved.

use glam::Vec3;
use impasto_core::direction::carry::Stencils;
use impasto_core::direction::field::MAX_SAMPLES;
use impasto_core::neighbours::Points;
use impasto_core::sampling::{self, Particle, Surface};

use crate::particles::Particles;

/// The samples of a body.
#[derive(Debug, Default)]
pub(crate) struct FieldSamples {
    pub(super) particles: Vec<Particle>,
    pub(super) positions: Vec<Vec3>,
    pub(super) normals: Vec<Vec3>,
    /// How far apart they are, model units.
    pub(super) spacing: f64,
}

impl FieldSamples {
    pub(crate) fn new(surface: &Surface<'_>, name_hash: u32) -> Self {
        let particles = sampling::progressive(surface, MAX_SAMPLES, name_hash);
        Self {
            positions: particles.iter().map(|particle| particle.position).collect(),
            normals: particles.iter().map(|particle| particle.normal).collect(),
            spacing: sampling::hexagonal_spacing(surface.area(), particles.len().max(1)),
            particles,
        }
    }

    fn points(&self) -> Points<'_> {
        Points { positions: &self.positions, normals: &self.normals }
    }

    /// Which samples each of these particles takes its direction from.
    pub(crate) fn stencils(&self, particles: &Particles) -> Stencils {
        let (positions, normals) = particles.points();
        Stencils::new(Points { positions: &positions, normals: &normals }, self.points(), self.spacing)
    }
}
