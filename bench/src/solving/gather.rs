//! The plain solve that ours is compared with: the source paper's sum (eq. 1–2), written directly. All particles are
//! projected, then each gathers its neighbours.

use rayon::prelude::*;

use super::scene::{K, SolveScene};

/// Particles that one thread handles at a time.
const CHUNK: usize = 4096;

/// The places of all particles in this frame's picture, and the angles of their strokes.
pub struct Gathered {
    now_px: Vec<[f32; 2]>,
    /// Counter-clockwise, radians.
    pub angles_rad: Vec<f32>,
}

impl Gathered {
    /// Room for `count` particles.
    pub fn new(count: usize) -> Self {
        Self { now_px: vec![[0.0; 2]; count], angles_rad: vec![0.0; count] }
    }

    /// Projects and turns all particles.
    pub fn solve(&mut self, scene: &SolveScene) {
        let [rx, ry, rw] = scene.rows();
        let project = |now: &mut [[f32; 2]], first: usize| {
            for (now, position) in now.iter_mut().zip(&scene.positions[first..]) {
                let [x, y, z] = position.to_array();
                let over_w = 1.0 / (rw[0] * x + rw[1] * y + rw[2] * z + rw[3]);
                *now = [
                    (rx[0] * x + rx[1] * y + rx[2] * z + rx[3]) * over_w,
                    (ry[0] * x + ry[1] * y + ry[2] * z + ry[3]) * over_w,
                ];
            }
        };
        self.now_px.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, now)| project(now, chunk * CHUNK));
        let (now, reference) = (self.now_px.as_slice(), scene.reference_px.as_slice());
        self.angles_rad.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, angles_rad)| {
            for (offset, angle_rad) in angles_rad.iter_mut().enumerate() {
                let particle = chunk * CHUNK + offset;
                let ([px, py], [cx, cy]) = (reference[particle], now[particle]);
                let (mut dot, mut cross) = (0.0, 0.0);
                for &other in &scene.lists[K * particle..][..K] {
                    let (p, c) = (reference[other as usize], now[other as usize]);
                    let (p, c) = ([p[0] - px, p[1] - py], [c[0] - cx, c[1] - cy]);
                    dot += p[0] * c[0] + p[1] * c[1];
                    cross += p[0] * c[1] - p[1] * c[0];
                }
                *angle_rad = cross.atan2(dot);
            }
        });
    }
}
