//! Interpolates the direction field from its samples to the particles.

use glam::{DVec2, DVec3, Vec3};

use super::{Symmetry, transport_rad};
use crate::neighbours::{Neighbours, PointIndex, Points};

/// A particle is interpolated from at most this many samples.
const MAX_SAMPLES: usize = 6;

/// Samples farther away than this many spacings do not count.
const REACH_SPACINGS: f64 = 1.6;
/// Standard deviation of the Gaussian weight, in spacings.
const DEVIATION_SPACINGS: f64 = 0.55;

/// The samples of a field, ready to be found from any particle.
#[derive(Clone, Debug)]
pub struct SampleIndex {
    points: PointIndex,
    spacing: f64,
}

impl SampleIndex {
    /// From samples that are about `spacing` apart.
    pub fn new(samples: Points<'_>, spacing: f64) -> Self {
        Self { points: PointIndex::new(samples, (REACH_SPACINGS * spacing) as f32), spacing }
    }
}

/// For each of some particles, the samples near it. Depends on positions and normals, not on directions.
#[derive(Clone, Debug)]
pub struct Stencils {
    lists: Neighbours,
    spacing: f64,
}

/// A sample with its direction before and after the solve, as unit complex numbers in the tangent axes of its normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolvedSample {
    /// Position, model space.
    pub position: Vec3,
    /// Unit normal, model space.
    pub normal: DVec3,
    /// The direction that the solve found.
    pub solved: DVec2,
    /// The direction that was stated, before the solve.
    pub stated: DVec2,
    /// How firmly the sample is held to its stated direction, 0..=1; interpolated like the direction.
    pub anchor: f64,
}

impl Stencils {
    /// Finds the samples near each of `particles`.
    pub fn new(particles: Points<'_>, samples: &SampleIndex) -> Self {
        // Nearest first, and twice as many as are used, since `carry` skips samples for which `sample` gives `None`.
        Self { lists: samples.points.nearest(particles, 2 * MAX_SAMPLES), spacing: samples.spacing }
    }

    /// The direction and the anchor of one of the particles, from those samples near it that `sample` does not skip.
    ///
    /// The solve has turned each sample away from its stated direction. The particle's own `stated` direction is
    /// turned by the mean of these turns. Around a singular point of the stated directions, though, the turns agree
    /// less than the solved directions do. There the solved directions are transported to the particle, and their
    /// mean is used. `None` where no sample counts, or where the directions cancel.
    pub fn carry(
        &self,
        particle: usize,
        position: Vec3,
        normal: DVec3,
        stated: DVec2,
        symmetry: Symmetry,
        sample: impl Fn(usize) -> Option<SolvedSample>,
    ) -> Option<(DVec2, f64)> {
        let deviation_sq = (DEVIATION_SPACINGS * self.spacing).powi(2);
        let (mut turned, mut transported, mut anchor, mut weights) = (DVec2::ZERO, DVec2::ZERO, 0.0, 0.0);
        let near =
            self.lists.of(particle).iter().filter_map(|&index| sample(index as usize)).take(MAX_SAMPLES);
        for SolvedSample {
            position: at,
            normal: there,
            solved,
            stated: stated_there,
            anchor: anchor_there,
        } in near
        {
            let distance_sq = f64::from(position.distance_squared(at));
            let weight = normal.dot(there).max(0.0) * (-0.5 * distance_sq / deviation_sq).exp();
            // The quotient solved / stated of unit complex numbers: the sample's turn.
            turned += DVec2::new(stated_there.x, -stated_there.y).rotate(solved) * weight;
            transported += symmetry.turn(transport_rad(there, normal)).rotate(solved) * weight;
            anchor += anchor_there * weight;
            weights += weight;
        }
        if weights < 1e-12 {
            return None;
        }
        let (turn_coherence, coherence) = (turned.length() / weights, transported.length() / weights);
        // 1 where the turns agree about as well as the directions do, or better.
        let trust = ((turn_coherence - coherence + 0.06) / 0.05).clamp(0.0, 1.0);
        let by_turn = turned.normalize_or_zero().rotate(stated);
        let mixed = by_turn * trust + transported.normalize_or_zero() * (1.0 - trust);
        Some((mixed.try_normalize()?, anchor / weights))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::direction::field::spiral_sphere;
    use crate::direction::{angle_between, tangent_axes, towards};

    #[test]
    fn a_turn_that_all_samples_share_reaches_every_particle_exactly() {
        let (samples, spacing) = spiral_sphere(2000);
        let (particles, _) = spiral_sphere(3001);
        let symmetry = Symmetry::Lines;
        let up = |normal: DVec3| symmetry.encode(towards(DVec3::Y, normal), tangent_axes(normal));
        let points = |positions| Points { positions, normals: positions };
        let stencils = Stencils::new(points(&particles), &SampleIndex::new(points(&samples), spacing));
        // Everything turned by 20 degrees from what was stated.
        let turn = symmetry.turn(20f64.to_radians());
        let mut worst = 0.0f64;
        for (index, &particle) in particles.iter().enumerate() {
            let normal = particle.as_dvec3();
            let found = stencils.carry(index, particle, normal, up(normal), symmetry, |sample| {
                let there = samples[sample].as_dvec3();
                let stated = up(there);
                let solved = turn.rotate(stated);
                Some(SolvedSample { position: samples[sample], normal: there, solved, stated, anchor: 0.5 })
            });
            let (u, anchor) = found.unwrap();
            assert!((anchor - 0.5).abs() < 1e-9);
            let axes = tangent_axes(normal);
            let wanted = symmetry.decode(turn.rotate(up(normal)), axes);
            if normal.y.abs() < 0.98 {
                worst = worst.max(angle_between(symmetry, symmetry.decode(u, axes), wanted).to_degrees());
            }
        }
        assert!(worst < 1e-5, "{worst}");
        let nothing = stencils.carry(0, particles[0], DVec3::Y, DVec2::X, symmetry, |_| None);
        assert_eq!(nothing, None);
    }
}
