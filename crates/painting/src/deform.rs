//! Moves baked particles along with a surface that changes its shape.

use glam::{DMat3, DVec3};
use impasto_core::lift::Lift;
use impasto_core::solve::BakedParticles;
use rayon::prelude::*;

use crate::body::Vertices;
use crate::coat::Coat;

impl Coat {
    /// The baked particles after the surface's vertices have moved from `before`, where they were at the baking, to
    /// `now`. Each particle stays on its triangle, and its lift is carried by the triangle's deformation gradient F:
    /// `N'' = F N'`.
    pub(crate) fn deformed(&self, before: &Vertices, now: &Vertices) -> BakedParticles {
        let mesh = &self.surface.mesh;
        let places = self.sampled.particles.places();
        let moved: Vec<(DVec3, DVec3, Lift)> = (0..self.sampled.particles.len())
            .into_par_iter()
            .with_min_len(1024)
            .map(|index| {
                let place = places[index];
                let was = place.on_moved(mesh, &before.positions, &before.normals);
                let is = place.on_moved(mesh, &now.positions, &now.normals);
                let frame = |positions: &[glam::Vec3], normal: glam::Vec3| {
                    let corners = mesh.triangles[place.triangle()];
                    let [a, b, c] = corners.map(|vertex| positions[vertex as usize].as_dvec3());
                    DMat3::from_cols(b - a, c - a, normal.as_dvec3())
                };
                let (from, to) = (frame(&before.positions, was.normal), frame(&now.positions, is.normal));
                let lift = self.baked.baked.lift_of(index);
                let carried = |v: DVec3| {
                    let there = to * (from.inverse() * v);
                    if there.is_finite() { there } else { v }
                };
                let lift = Lift { along: carried(lift.along), across: carried(lift.across) };
                let off = self.baked.baked.position_of(index) - was.position.as_dvec3();
                let height = off.dot(was.normal.as_dvec3());
                let normal = is.normal.as_dvec3();
                (is.position.as_dvec3() + normal * height, normal, lift)
            })
            .collect();
        let mut baked = BakedParticles { flatness: self.baked.baked.flatness.clone(), ..Default::default() };
        for (position, normal, lift) in moved {
            baked.push(position, normal, lift);
        }
        baked
    }
}
