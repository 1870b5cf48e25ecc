//! The looks of a coat's particles: what the strokes of all views have in common. A look is found when a picture first
//! asks for it, because most particles of a floor are never seen.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};

use bytemuck::allocation::zeroed_vec;
use rayon::prelude::*;

/// How the stroke of a particle looks in every view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Look {
    /// The columns of N', in model space.
    pub(crate) lift: [[f32; 3]; 2],
    /// Two slow noises: one for hue and value, one for how firm edges are and where scumble and contours lie.
    pub(crate) drift: [f32; 2],
    /// The base angle with jitter in the reference picture, radians; `horn-exact` adds its turn to it. 0 with the solver
    /// `Tangent`, where the lift alone gives the angle.
    pub(crate) base_angle_rad: f32,
}

/// Finds the looks of a coat's particles.
pub(crate) trait FindLooks: Send + Sync {
    /// Gives each of these particles and its look to `found`.
    fn find_looks(&self, particles: &[u32], found: &mut dyn FnMut(usize, Look));

    /// Whether looks have a base angle.
    fn has_angles(&self) -> bool;
}

/// Words of a look without its base angle, and with it.
const WIDTH: usize = 8;
const WIDTH_WITH_ANGLE: usize = 9;

/// How many looks one task finds.
const CHUNK: usize = 512;

/// Looks per word of bits.
const BITS: usize = u64::BITS as usize;

/// The looks of particles in progressive order. Several threads may ask at once: they find the same bits.
#[derive(Default)]
pub(crate) struct Looks {
    /// A bit for each particle: whether its look is known.
    known: Vec<AtomicU64>,
    /// The bits of each look's numbers, one look after the other. The system gives zeroed pages when they are first
    /// written to, so looks that are not known take no memory.
    words: Vec<AtomicU32>,
    count: usize,
    has_angles: bool,
    /// What looks are found from; `None` where all are known.
    inputs: Option<Arc<dyn FindLooks>>,
}

/// The numbers of all looks, one array per number.
pub(crate) struct LookArrays {
    /// The columns of N', by component.
    pub(crate) lift: [Vec<f32>; 6],
    pub(crate) drift: Vec<[f32; 2]>,
    /// Empty with the solver `Tangent`.
    pub(crate) base_angle_rad: Vec<f32>,
}

impl Looks {
    fn of_count(count: usize, has_angles: bool, inputs: Option<Arc<dyn FindLooks>>) -> Self {
        Self {
            known: zeroed_vec(count.div_ceil(BITS)),
            words: zeroed_vec(count * width(has_angles)),
            count,
            has_angles,
            inputs,
        }
    }

    /// The looks of `count` particles, none of them known.
    pub(crate) fn unknown(inputs: Arc<dyn FindLooks>, count: usize) -> Self {
        Self::of_count(count, inputs.has_angles(), Some(inputs))
    }

    /// The looks of `count` particles. What `self` knows of them is taken over; it must come from equal inputs.
    pub(crate) fn resized(&self, inputs: Arc<dyn FindLooks>, count: usize) -> Self {
        let resized = Self::unknown(inputs, count);
        let known = (0..self.count.min(count)).into_par_iter().with_min_len(CHUNK);
        known.filter_map(|particle| Some((particle, self.known(particle)?))).for_each(|(particle, look)| {
            resized.set(particle, look);
        });
        resized
    }

    /// Looks that are all known. The arrays are equally long, but for base angles that may be left out.
    pub(crate) fn of_arrays(arrays: &LookArrays) -> Self {
        let LookArrays { lift: [ax, ay, az, bx, by, bz], drift, base_angle_rad } = arrays;
        let looks = Self::of_count(drift.len(), !base_angle_rad.is_empty(), None);
        (0..drift.len()).into_par_iter().with_min_len(CHUNK).for_each(|at| {
            let lift = [[ax[at], ay[at], az[at]], [bx[at], by[at], bz[at]]];
            let base_angle_rad = base_angle_rad.get(at).copied().unwrap_or(0.0);
            looks.set(at, Look { lift, drift: drift[at], base_angle_rad });
        });
        looks
    }

    /// All looks as arrays. Finds those that are not known yet.
    pub(crate) fn to_arrays(&self) -> LookArrays {
        let particles = 0..self.count as u32;
        let unknown: Vec<u32> = particles.filter(|&particle| !self.knows(particle as usize)).collect();
        unknown.par_chunks(CHUNK).for_each(|particles| self.find(particles));
        let of = |number: usize| -> Vec<f32> {
            (0..self.count).map(|particle| f32::from_bits(self.word(particle, number))).collect()
        };
        LookArrays {
            lift: std::array::from_fn(of),
            drift: of(6).into_iter().zip(of(7)).map(|(hue, edge)| [hue, edge]).collect(),
            base_angle_rad: if self.has_angles { of(8) } else { Vec::new() },
        }
    }

    /// Whether base angles are known by themselves.
    pub(crate) fn has_angles(&self) -> bool {
        self.has_angles
    }

    /// Memory held if all looks are known, in bytes.
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(&self.known[..]) + size_of_val(&self.words[..])
    }

    /// Whether a look is known.
    #[inline]
    pub(crate) fn knows(&self, particle: usize) -> bool {
        self.known[particle / BITS].load(Ordering::Acquire) >> (particle % BITS) & 1 != 0
    }

    /// Finds the looks of these particles.
    pub(crate) fn find(&self, particles: &[u32]) {
        let Some(inputs) = &self.inputs else { return };
        inputs.find_looks(particles, &mut |particle, look| self.set(particle, look));
    }

    /// The look of a particle, if it is known.
    #[inline]
    pub(crate) fn known(&self, particle: usize) -> Option<Look> {
        self.knows(particle).then(|| self.look(particle))
    }

    /// The look of a particle.
    #[inline]
    pub(crate) fn at(&self, particle: usize) -> Look {
        if !self.knows(particle) {
            self.find(&[particle as u32]);
        }
        self.look(particle)
    }

    /// A look that is known.
    #[inline]
    fn look(&self, particle: usize) -> Look {
        let width = width(self.has_angles);
        let words = &self.words[particle * width..][..width];
        let number = |number: usize| f32::from_bits(words[number].load(Ordering::Relaxed));
        Look {
            lift: [[0, 1, 2], [3, 4, 5]].map(|column| column.map(number)),
            drift: [number(6), number(7)],
            base_angle_rad: if self.has_angles { number(8) } else { 0.0 },
        }
    }

    /// A word of a look that is known.
    fn word(&self, particle: usize, number: usize) -> u32 {
        self.words[particle * width(self.has_angles) + number].load(Ordering::Relaxed)
    }

    fn set(&self, particle: usize, look: Look) {
        let Look { lift: [[ax, ay, az], [bx, by, bz]], drift: [hue, edge], base_angle_rad } = look;
        let numbers = [ax, ay, az, bx, by, bz, hue, edge, base_angle_rad];
        let width = width(self.has_angles);
        for (word, number) in self.words[particle * width..][..width].iter().zip(numbers) {
            word.store(number.to_bits(), Ordering::Relaxed);
        }
        // Whoever sees the bit sees the words too.
        self.known[particle / BITS].fetch_or(1 << (particle % BITS), Ordering::Release);
    }
}

fn width(has_angles: bool) -> usize {
    if has_angles { WIDTH_WITH_ANGLE } else { WIDTH }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use impasto_scene::load::{LoadOptions, load};

    use super::*;
    use crate::frame_options::FrameOptions;
    use crate::painting::Painting;
    use crate::prepare::prepare;

    fn painting() -> Painting {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/touching_cubes.ron");
        prepare(Arc::new(load(&path, &LoadOptions::default()).unwrap())).unwrap()
    }

    fn bits(arrays: &LookArrays) -> Vec<u32> {
        let drift = arrays.drift.as_flattened();
        arrays.lift.iter().flatten().chain(drift).map(|number| number.to_bits()).collect()
    }

    #[test]
    fn a_picture_finds_the_looks_that_it_needs_and_they_are_the_same_in_any_company() {
        let (seen, unseen) = (painting(), painting());
        let known = |painting: &Painting| -> Vec<usize> {
            let looks = painting.coats.iter().map(|coat| &coat.baked.looks);
            looks.map(|looks| (0..looks.count).filter(|&particle| looks.knows(particle)).count()).collect()
        };
        assert!(known(&seen).iter().all(|&known| known == 0), "preparing finds none");
        let strokes = seen.at(3.0, &FrameOptions::new([320, 180])).strokes.len();
        let found = known(&seen).iter().sum::<usize>();
        let particles: usize = seen.coats.iter().map(|coat| coat.baked.looks.count).sum();
        assert!(
            strokes > 200 && found >= strokes && found < 4 * strokes,
            "{found} looks of {strokes} strokes"
        );
        assert!(found < particles / 2, "{found} of {particles}");
        for (seen, unseen) in seen.coats.iter().zip(&unseen.coats) {
            // One by one from the last, a few that were found together for the picture, and all others at once.
            let (one, all) = (&unseen.baked.looks, &seen.baked.looks);
            for particle in (0..one.count).rev().step_by(7) {
                one.at(particle);
            }
            let arrays = all.to_arrays();
            assert_eq!(bits(&arrays), bits(&one.to_arrays()));
            assert_eq!(bits(&arrays), bits(&Looks::of_arrays(&arrays).to_arrays()));
        }
    }
}
