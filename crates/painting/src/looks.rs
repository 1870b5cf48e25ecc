//! The looks of a coat's particles. A look is the part of a particle's stroke that is the same in every view. It is
//! computed when a picture first asks for it, because most particles of a large floor are never seen.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, AtomicU64, Ordering};

use bytemuck::allocation::zeroed_vec;
use rayon::prelude::*;

/// The part of a particle's stroke that is the same in every view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Look {
    /// The columns of the lift N' (see [`impasto_core::lift`]), model space.
    pub(crate) lift: [[f32; 3]; 2],
    /// Two slow noises: one for hue and value, one for how firm edges are and where scumble lies.
    pub(crate) drift: [f32; 2],
    /// The base angle with jitter in the reference picture, radians. The solver `HornExact` adds its turn to it. 0 with
    /// the solver `Tangent`, where the lift alone gives the angle.
    pub(crate) base_angle_rad: f32,
}

pub(crate) trait FindLooks: Send + Sync {
    /// Computes the looks of these particles, and calls `found` with each particle and its look.
    fn find_looks(&self, particles: &[u32], found: &mut dyn FnMut(usize, Look));

    /// Whether looks have a base angle.
    fn has_angles(&self) -> bool;
}

/// How many 32-bit words a look takes, without and with its base angle.
const WIDTH: usize = 8;
const WIDTH_WITH_ANGLE: usize = 9;

/// How many looks one task finds.
const CHUNK: usize = 512;

const BITS: usize = u64::BITS as usize;

/// The looks of particles in progressive order. Several threads may ask for a look at once: all compute the same bits.
#[derive(Default)]
pub(crate) struct Looks {
    /// One bit for each particle: whether its look is known.
    known: Vec<AtomicU64>,
    /// The bits of each look's numbers, one look after the other. The operating system provides a zeroed page only when
    /// it is first written to, so particles that no picture shows take no memory.
    words: Vec<AtomicU32>,
    count: usize,
    has_angles: bool,
    /// What looks are computed from; `None` where all are known.
    inputs: Option<Arc<dyn FindLooks>>,
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

    /// The looks of `count` particles. Looks that `self` knows are taken over; `self` must come from equal inputs.
    pub(crate) fn resized(&self, inputs: Arc<dyn FindLooks>, count: usize) -> Self {
        let resized = Self::unknown(inputs, count);
        let known = (0..self.count.min(count)).into_par_iter().with_min_len(CHUNK);
        known.filter_map(|particle| Some((particle, self.known(particle)?))).for_each(|(particle, look)| {
            resized.set(particle, look);
        });
        resized
    }

    /// The looks that [`Looks::to_words`] gave; `None` where the words are not a whole number of looks.
    pub(crate) fn of_words(words: Vec<u32>, has_angles: bool) -> Option<Self> {
        let width = width(has_angles);
        let count = words.len() / width;
        let known = (0..count.div_ceil(BITS)).map(|_| AtomicU64::new(u64::MAX)).collect();
        // This collects in place, without new memory for the words.
        let all = words.len() == count * width;
        let words = words.into_iter().map(AtomicU32::new).collect();
        all.then_some(Self { known, words, count, has_angles, inputs: None })
    }

    /// The words of all looks, one look after the other. Finds those that are not known yet.
    pub(crate) fn to_words(&self) -> Vec<u32> {
        let particles = 0..self.count as u32;
        let unknown: Vec<u32> = particles.filter(|&particle| !self.knows(particle as usize)).collect();
        unknown.par_chunks(CHUNK).for_each(|particles| self.find(particles));
        self.words.iter().map(|word| word.load(Ordering::Relaxed)).collect()
    }

    pub(crate) fn words_of(count: usize, has_angles: bool) -> usize {
        count * width(has_angles)
    }

    pub(crate) fn has_angles(&self) -> bool {
        self.has_angles
    }

    /// Memory held if all looks are known, in bytes.
    pub(crate) fn bytes(&self) -> usize {
        size_of_val(&self.known[..]) + size_of_val(&self.words[..])
    }

    #[inline]
    pub(crate) fn knows(&self, particle: usize) -> bool {
        self.known[particle / BITS].load(Ordering::Acquire) >> (particle % BITS) & 1 != 0
    }

    pub(crate) fn find(&self, particles: &[u32]) {
        let Some(inputs) = &self.inputs else { return };
        inputs.find_looks(particles, &mut |particle, look| self.set(particle, look));
    }

    #[inline]
    pub(crate) fn known(&self, particle: usize) -> Option<Look> {
        self.knows(particle).then(|| self.look(particle))
    }

    /// The look of a particle. It is computed if it is not known yet.
    #[inline]
    pub(crate) fn at(&self, particle: usize) -> Look {
        if !self.knows(particle) {
            self.find(&[particle as u32]);
        }
        self.look(particle)
    }

    /// The look of a particle whose look is known.
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

    fn set(&self, particle: usize, look: Look) {
        let Look { lift: [[ax, ay, az], [bx, by, bz]], drift: [hue, edge], base_angle_rad } = look;
        let numbers = [ax, ay, az, bx, by, bz, hue, edge, base_angle_rad];
        let width = width(self.has_angles);
        for (word, number) in self.words[particle * width..][..width].iter().zip(numbers) {
            word.store(number.to_bits(), Ordering::Relaxed);
        }
        // A thread that sees the bit sees the words too.
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

    fn painting(set: &[(&str, &str)]) -> Painting {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/touching_cubes.ron");
        let overrides = set.iter().map(|&(path, value)| (path.to_owned(), value.to_owned())).collect();
        let options = LoadOptions { overrides, ..LoadOptions::default() };
        prepare(Arc::new(load(&path, &options).unwrap())).unwrap()
    }

    fn known(looks: &Looks) -> usize {
        (0..looks.count).filter(|&particle| looks.knows(particle)).count()
    }

    #[test]
    fn a_picture_finds_only_the_looks_that_it_needs() {
        let painting = painting(&[]);
        let looks = || painting.coats.iter().map(|coat| &coat.baked.looks);
        assert!(looks().all(|looks| known(looks) == 0), "preparing finds none");
        let strokes = painting.at(3.0, &FrameOptions::new([320, 180])).strokes.len();
        let (found, all) =
            (looks().map(known).sum::<usize>(), looks().map(|looks| looks.count).sum::<usize>());
        assert!(
            strokes > 200 && found >= strokes && found < 4 * strokes,
            "{found} looks of {strokes} strokes"
        );
        assert!(found < all / 2, "{found} of {all}");
    }

    /// Finds looks in three ways: one by one on several threads; a few for a picture, then the others at once; all at
    /// once.
    #[test]
    fn a_look_is_the_same_in_any_company() {
        // With `HornExact`, looks have base angles.
        for set in [&[][..], &[("style", "RotatingStrokes(solver: HornExact)"), ("strokes.scale", "4")]] {
            let [seen, asked, bulk] = [(); 3].map(|()| painting(set));
            assert!(!seen.at(3.0, &FrameOptions::new([320, 180])).strokes.is_empty());
            for ((seen, asked), bulk) in seen.coats.iter().zip(&asked.coats).zip(&bulk.coats) {
                let [seen, asked, bulk] = [seen, asked, bulk].map(|coat| &coat.baked.looks);
                assert_eq!(bulk.has_angles, !set.is_empty());
                std::thread::scope(|scope| {
                    for thread in 0..4 {
                        // Each thread asks for every seventh look, beginning at another place.
                        let order = (0..asked.count).rev().cycle().skip(thread * asked.count / 4);
                        scope.spawn(move || {
                            order.take(asked.count).step_by(7).for_each(|at| {
                                asked.at(at);
                            })
                        });
                    }
                });
                let words = bulk.to_words();
                assert!(words == seen.to_words() && words == asked.to_words());
                let again = Looks::of_words(words.clone(), bulk.has_angles).unwrap();
                assert!(known(&again) == bulk.count && words == again.to_words());
                assert!((0..bulk.count).all(|at| again.at(at) == bulk.at(at)));
            }
        }
    }
}
