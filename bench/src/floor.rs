//! Measures the least time that memory allows a task (its floor): the time to read and write as many bytes as the task
//! does, with almost no arithmetic.

use rayon::prelude::*;

use crate::race::Contender;

/// Floats that one thread handles at a time.
const CHUNK: usize = 1 << 15;

/// As many input and output streams as a task has. The inputs are dealt out to the outputs, and each output is the sum
/// of those that it got: of 2 outputs, the first is the sum of inputs 0, 2, 4 …
pub struct Streams {
    inputs: Vec<Vec<f32>>,
    outputs: Vec<Vec<f32>>,
}

impl Streams {
    /// Streams of `count` floats each.
    pub fn new(count: usize, inputs: usize, outputs: usize) -> Self {
        let streams = |number: usize| -> Vec<Vec<f32>> { (0..number).map(|_| vec![1.0; count]).collect() };
        Self { inputs: streams(inputs), outputs: streams(outputs) }
    }

    /// Streams of equal length. The inputs hold about `read` bytes in all, the outputs about `written`.
    pub fn of_bytes(read: usize, written: usize) -> Self {
        let count = (read.max(written) / 4).div_ceil(8).max(1);
        Self::new(count, (read / 4).div_ceil(count), (written / 4).div_ceil(count).max(1))
    }

    /// Reads every input once and writes every output once.
    pub fn pass(&mut self) {
        let inputs = &self.inputs;
        let step = self.outputs.len();
        self.outputs.par_iter_mut().enumerate().for_each(|(output, to)| {
            to.par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, to)| {
                let from: Vec<&[f32]> = inputs
                    .iter()
                    .skip(output)
                    .step_by(step)
                    .map(|input| &input[chunk * CHUNK..chunk * CHUNK + to.len()])
                    .collect();
                wide::sum(to, &from);
            });
        });
    }

    /// Bytes read and written.
    pub fn bytes(&self) -> usize {
        self.inputs.iter().chain(&self.outputs).map(|stream| stream.len() * 4).sum()
    }

    /// The pass as a contender in a race.
    pub fn contender(mut self) -> Contender<'static> {
        let note = format!(
            "{} read and written in {} streams",
            self.shown_bytes(),
            self.inputs.len() + self.outputs.len()
        );
        Contender::here("floor: memory", &note, move || self.pass())
    }

    fn shown_bytes(&self) -> String {
        format!("{:.1} MB", self.bytes() as f64 * 1e-6)
    }
}

/// Memory bandwidth, bytes per second: the best of several passes of a triad (two streams in, one out) over 192 MiB.
pub fn triad_bytes_per_sec() -> f64 {
    let mut streams = Streams::new(16 << 20, 2, 1);
    let bytes = streams.bytes() as f64;
    (0..8)
        .map(|_| {
            let start = std::time::Instant::now();
            streams.pass();
            bytes / start.elapsed().as_secs_f64()
        })
        .fold(0.0, f64::max)
}

/// The sum of streams in the widest vectors that the processor has: the floor must not be slowed down by narrow ones.
mod wide {
    pub(super) fn sum(to: &mut [f32], from: &[&[f32]]) {
        #[cfg(target_arch = "x86_64")]
        {
            if std::arch::is_x86_feature_detected!("avx512f") {
                // SAFETY: AVX-512 was found on this processor.
                return unsafe { sum_avx512(to, from) };
            }
            if std::arch::is_x86_feature_detected!("avx2") {
                // SAFETY: AVX2 was found on this processor.
                return unsafe { sum_avx2(to, from) };
            }
        }
        sum_portable(to, from);
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx512f")]
    fn sum_avx512(to: &mut [f32], from: &[&[f32]]) {
        sum_portable(to, from);
    }

    #[cfg(target_arch = "x86_64")]
    #[target_feature(enable = "avx2")]
    fn sum_avx2(to: &mut [f32], from: &[&[f32]]) {
        sum_portable(to, from);
    }

    #[inline(always)]
    fn sum_portable(to: &mut [f32], from: &[&[f32]]) {
        let length = to.len();
        match from {
            [] => to.fill(2.0),
            [a] => to.copy_from_slice(a),
            [a, b] => {
                let (a, b) = (&a[..length], &b[..length]);
                (0..length).for_each(|i| to[i] = a[i] + b[i]);
            }
            [a, b, c] => {
                let (a, b, c) = (&a[..length], &b[..length], &c[..length]);
                (0..length).for_each(|i| to[i] = a[i] + b[i] + c[i]);
            }
            [a, rest @ ..] => {
                to.copy_from_slice(a);
                for b in rest {
                    let b = &b[..length];
                    (0..length).for_each(|i| to[i] += b[i]);
                }
            }
        }
    }
}
