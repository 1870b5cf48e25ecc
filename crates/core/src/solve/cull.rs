//! Culling: finds the particles that may show in a view, as one bit for each. Also solves single particles.

use rayon::prelude::*;

use super::{CHUNK, PlacedParticles, Rows, project, slices};
use crate::ScreenMap;
use crate::wide::{Wide, widest};

/// Particles per word of bits.
pub(crate) const WORD: usize = u64::BITS as usize;

/// A screen map in single precision, to cull and solve particles with.
#[derive(Clone, Copy)]
pub struct ParticleView {
    rows: Rows,
}

/// Bounds within which a particle must be to show.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Greatest distance from the picture's centre in x and y, exclusive.
    pub half_px: [f32; 2],
    /// Nearest and farthest depth, exclusive.
    pub near_far: [f32; 2],
    /// A particle's ordinal (its place in the progressive order) must be less than this times its projected area in px²
    /// per unit of surface.
    pub most_per_area: f32,
}

/// One particle of [`super::SolvedParticles`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolvedParticle {
    /// Pixels from the picture's centre.
    pub x_px: f32,
    /// Pixels from the picture's centre, Y up.
    pub y_px: f32,
    /// Along the gaze, world units.
    pub depth: f32,
    /// Counter-clockwise from +X, radians in (−π, π].
    pub angle_rad: f32,
    /// Projected area in px² per unit of surface; positive where it faces the eye.
    pub area_px: f32,
}

/// Where one particle is in a view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeenParticle {
    /// Pixels from the picture's centre.
    pub x_px: f32,
    /// Pixels from the picture's centre, Y up.
    pub y_px: f32,
    /// Along the gaze, world units.
    pub depth: f32,
    /// Projected area in px² per unit of surface; positive where it faces the eye.
    pub area_px: f32,
}

impl ParticleView {
    /// From a screen map.
    pub fn new(map: &ScreenMap) -> Self {
        Self { rows: Rows::new(map) }
    }

    /// Solves a particle with this position, normal and columns of N', with the same bits as [`super::solve`]. `None`
    /// stands for a flatness of 1.
    #[inline]
    pub fn solved_at(
        &self,
        [position, normal, along, across]: [[f32; 3]; 4],
        flatness: Option<f32>,
    ) -> SolvedParticle {
        let seen = project(&self.rows, position, normal);
        let lift = [along, across];
        SolvedParticle {
            x_px: seen.x_px,
            y_px: seen.y_px,
            depth: seen.depth,
            angle_rad: match flatness {
                Some(flatness) => seen.angle_rad::<true>(lift, flatness),
                None => seen.angle_rad::<false>(lift, 1.0),
            },
            area_px: seen.area_px,
        }
    }

    /// Where a particle with this position and normal is.
    #[inline]
    pub fn seen(&self, [position, normal]: [[f32; 3]; 2]) -> SeenParticle {
        let seen = project(&self.rows, position, normal);
        SeenParticle { x_px: seen.x_px, y_px: seen.y_px, depth: seen.depth, area_px: seen.area_px }
    }

    /// Whether a particle with this ordinal faces the eye within the bounds.
    #[inline(always)]
    pub(crate) fn shows(&self, [position, normal]: [[f32; 3]; 2], ordinal: f32, bounds: &Bounds) -> bool {
        let seen = project(&self.rows, position, normal);
        (seen.area_px > 0.0)
            & (seen.area_px * bounds.most_per_area > ordinal)
            & (seen.depth > bounds.near_far[0])
            & (seen.depth < bounds.near_far[1])
            & (seen.x_px.abs() < bounds.half_px[0])
            & (seen.y_px.abs() < bounds.half_px[1])
    }

    /// One bit per particle, set where it faces the eye and is within the bounds; 64 particles per word, the first in
    /// the lowest bit. `ordinals` holds each particle's place in the progressive order. If it is empty, a particle's
    /// index is its place.
    pub fn within(&self, particles: &PlacedParticles, ordinals: &[f32], bounds: &Bounds) -> Vec<u64> {
        let mut words = vec![0; particles.len().div_ceil(WORD)];
        words.par_chunks_mut(CHUNK / WORD).enumerate().for_each(|(chunk, words)| {
            widest(Marking { particles, ordinals, first: chunk * CHUNK, rows: &self.rows, bounds, words });
        });
        words
    }
}

/// Sets the bits of the particles from `first` on that face the eye within the bounds.
struct Marking<'a> {
    particles: &'a PlacedParticles,
    ordinals: &'a [f32],
    first: usize,
    rows: &'a Rows,
    bounds: &'a Bounds,
    words: &'a mut [u64],
}

impl Wide for Marking<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { particles, ordinals, rows, bounds, .. } = self;
        for (number, word) in self.words.iter_mut().enumerate() {
            let first = self.first + number * WORD;
            let rest = (particles.len() - first).min(WORD);
            let mut ordinals_here = [0.0; WORD];
            match ordinals.get(first..first + rest) {
                Some(here) => ordinals_here[..rest].copy_from_slice(here),
                None => {
                    (ordinals_here.iter_mut().zip(first as i32..)).for_each(|(at, index)| *at = index as f32)
                }
            }
            let mut flags = [0; WORD];
            match rest {
                // The length is known here, so the compiler vectorises the loop.
                WORD => mark_word((particles, &ordinals_here), first, rows, bounds, &mut flags),
                rest => mark_word((particles, &ordinals_here), first, rows, bounds, &mut flags[..rest]),
            }
            *word = packed(&flags);
        }
    }
}

#[inline(always)]
fn mark_word(
    (particles, ordinals): (&PlacedParticles, &[f32; WORD]),
    first: usize,
    rows: &Rows,
    bounds: &Bounds,
    flags: &mut [u8],
) {
    let count = flags.len();
    let [px, py, pz] = slices(&particles.position, first, count);
    let [nx, ny, nz] = slices(&particles.normal, first, count);
    for (i, flag) in flags.iter_mut().enumerate() {
        let seen = project(rows, [px[i], py[i], pz[i]], [nx[i], ny[i], nz[i]]);
        // `&`, not `&&`: making all tests is cheaper than branching.
        *flag = u8::from(
            (seen.area_px > 0.0)
                & (seen.area_px * bounds.most_per_area > ordinals[i])
                & (seen.depth > bounds.near_far[0])
                & (seen.depth < bounds.near_far[1])
                & (seen.x_px.abs() < bounds.half_px[0])
                & (seen.y_px.abs() < bounds.half_px[1]),
        );
    }
}

/// Packs bytes of 0 or 1 into bits.
#[inline(always)]
fn packed(flags: &[u8; WORD]) -> u64 {
    let mut word = 0;
    for (index, bytes) in flags.chunks_exact(8).enumerate() {
        let mut eight = [0; 8];
        eight.copy_from_slice(bytes);
        // The product gathers the lowest bits of all eight bytes in the top byte.
        let bits = u64::from_le_bytes(eight).wrapping_mul(0x0102_0408_1020_4080) >> 56;
        word |= bits << (index * 8);
    }
    word
}

#[cfg(test)]
mod tests {
    use super::super::{BakedParticles, SolvedParticles, components, solve};
    use super::*;
    use crate::angle::wrap_pi;
    use crate::hash;
    use crate::lift::Lift;
    use crate::screen_map::PixelLens;
    use glam::{DAffine3, DMat4, DVec3};

    /// Particles all round the eye, some behind it, facing every way.
    fn crowd(count: u32, wrapped: bool) -> BakedParticles {
        let vector = |particle: u32, which: u32| {
            DVec3::from_array(
                [0, 1, 2].map(|axis| f64::from(hash::normal(hash::combine(particle, 8 * which + axis)))),
            )
        };
        let mut particles = BakedParticles::default();
        for particle in 0..count {
            let lift = Lift { along: vector(particle, 3), across: vector(particle, 4) };
            particles.push(3.0 * vector(particle, 1), vector(particle, 2).normalize(), lift);
        }
        if wrapped {
            particles.flatness = (0..count).map(|particle| hash::unit(hash::combine(particle, 50))).collect();
        }
        particles
    }

    fn view() -> ScreenMap {
        let view = DMat4::from_translation(DVec3::new(0.3, -0.2, -4.0));
        ScreenMap::new(view, DAffine3::from_rotation_y(0.4), PixelLens::Perspective { focal_px: 900.0 })
    }

    #[test]
    fn one_particle_is_solved_as_all_are() {
        for wrapped in [false, true] {
            let (particles, map) = (crowd(1000, wrapped), view());
            let mut solved = SolvedParticles::default();
            solve(&particles, &map, &mut solved);
            let view = ParticleView::new(&map);
            for index in 0..particles.len() {
                let [position, normal] = particles.placed.vectors_of(index);
                let [along, across] =
                    [&particles.along, &particles.across].map(|axes| components(axes, index));
                let flatness = particles.flatness.get(index).copied();
                let one = view.solved_at([position, normal, along, across], flatness);
                let seen = view.seen([position, normal]);
                assert_eq!([seen.x_px, seen.y_px, seen.depth], [one.x_px, one.y_px, one.depth]);
                assert_eq!(seen.area_px, one.area_px);
                let bits = [one.x_px, one.y_px, one.depth, one.angle_rad, one.area_px].map(f32::to_bits);
                let all = [&solved.x_px, &solved.y_px, &solved.depth, &solved.angle_rad, &solved.area_px];
                assert_eq!(bits, all.map(|array| array[index].to_bits()), "particle {index}");
            }
        }
    }

    /// Compares with the same formulas in double precision, for particles well in front of the eye.
    #[test]
    fn what_is_solved_is_the_projection_and_the_angle_of_the_lift() {
        for wrapped in [false, true] {
            // Turned about a slanted axis, so that every number of the map counts.
            let pose = DAffine3::from_axis_angle(DVec3::new(0.5, 0.7, -0.3).normalize(), 0.9);
            let view = DMat4::from_translation(DVec3::new(0.3, -0.2, -4.0));
            let map = ScreenMap::new(view, pose, PixelLens::Perspective { focal_px: 900.0 });
            let particles = crowd(1000, wrapped);
            let mut solved = SolvedParticles::default();
            solve(&particles, &map, &mut solved);
            let (mut compared, mut angles) = (0, 0);
            for index in 0..particles.len() {
                let at = particles.placed.position_of(index);
                let (px, jacobian) = (map.project(at), map.jacobian(at));
                let area_px = particles.placed.normal_of(index).dot(jacobian[0].cross(jacobian[1]));
                let on_screen = particles.lift_of(index).map(jacobian);
                let depth = f64::from(solved.depth[index]);
                if depth < 1.0 {
                    continue;
                }
                compared += 1;
                let found = [solved.x_px[index], solved.y_px[index], solved.area_px[index]].map(f64::from);
                let size_px = jacobian[0].length() * jacobian[1].length();
                let off =
                    [(found[0] - px.x) / 900.0, (found[1] - px.y) / 900.0, (found[2] - area_px) / size_px];
                assert!(off.iter().all(|off| off.abs() < 1e-4), "particle {index}: {off:?}");
                let flatness = particles.flatness.get(index).map_or(1.0, |&flatness| f64::from(flatness));
                let wanted = on_screen.shown_rad(flatness);
                // Where the sums that give the angle nearly cancel, single precision is too coarse.
                let beside = wrap_pi(on_screen.shown_rad(flatness - 1e-3) - wanted);
                if on_screen.kappa() > 0.05 && beside.abs() < 0.01 {
                    let off = wrap_pi(f64::from(solved.angle_rad[index]) - wanted);
                    assert!(off.abs() < 1e-3, "particle {index}: the angle is off by {off}");
                    angles += 1;
                }
            }
            assert!(compared > 500 && angles > 400, "{compared} particles, {angles} angles");
        }
    }

    #[test]
    fn bits_are_set_where_every_bound_holds() {
        // More than one task, and not a whole number of words.
        let (particles, map) = (crowd(CHUNK as u32 + 1000, false), view());
        let mut solved = SolvedParticles::default();
        solve(&particles, &map, &mut solved);
        let bounds = Bounds { half_px: [640.0, 360.0], near_far: [2.0, 6.0], most_per_area: 0.15 };
        let view = ParticleView::new(&map);
        let words = view.within(&particles.placed, &[], &bounds);
        let indices: Vec<f32> = (0..particles.len()).map(|index| index as f32).collect();
        assert_eq!(words, view.within(&particles.placed, &indices, &bounds));
        let halves: Vec<f32> = indices.iter().map(|index| 0.5 * index).collect();
        let twice = Bounds { most_per_area: 2.0 * bounds.most_per_area, ..bounds };
        assert_ne!(words, view.within(&particles.placed, &halves, &bounds));
        assert_eq!(
            view.within(&particles.placed, &[], &twice),
            view.within(&particles.placed, &halves, &bounds)
        );
        let mut portable = vec![0; words.len()];
        let (rows, words_of) = (Rows::new(&map), &mut portable);
        let (particles_of, ordinals) = (&particles.placed, &[][..]);
        Marking {
            particles: particles_of,
            ordinals,
            first: 0,
            rows: &rows,
            bounds: &bounds,
            words: words_of,
        }
        .run();
        assert_eq!(words, portable);
        // How often each bound alone keeps a particle out.
        let mut alone = [0; 6];
        for index in 0..particles.len() {
            let (area_px, depth) = (solved.area_px[index], solved.depth[index]);
            let holds = [
                area_px > 0.0,
                area_px.abs() * bounds.most_per_area > index as f32,
                depth > 2.0,
                depth < 6.0,
                solved.x_px[index].abs() < 640.0,
                solved.y_px[index].abs() < 360.0,
            ];
            let bit = words[index / WORD] >> (index % WORD) & 1;
            assert_eq!(bit == 1, holds.iter().all(|&holds| holds), "particle {index}");
            let vectors = particles.placed.vectors_of(index);
            assert_eq!(view.shows(vectors, index as f32, &bounds), bit == 1, "particle {index} alone");
            if let [out] = [0, 1, 2, 3, 4, 5].iter().filter(|&&bound| !holds[bound]).collect::<Vec<_>>()[..] {
                alone[*out] += 1;
            }
        }
        assert!(alone.iter().all(|&count| count > 0), "{alone:?}");
        assert!(words.iter().map(|word| word.count_ones()).sum::<u32>() > 100);
        assert_eq!(words.last().map(|word| word >> (particles.len() % WORD)), Some(0));
    }
}
