//! Checks that the neighbour searches that are timed give the same answer: equal sets except for ties, and equal sums
//! of distances.

use std::path::Path;

use anyhow::{bail, ensure};
use glam::Vec3;
use impasto_core::hash;
use impasto_core::neighbours::MAX_NEIGHBOURS;

use super::trees::Lists;
use crate::peers::files;

/// Searches may differ for this many of a million particles, where rounding decides which particle is within the
/// radius, or which is the fiftieth.
const TIES_PER_MILLION: usize = 50;

/// How many particles are checked by brute force.
const SAMPLES: u32 = 60;

/// For each particle, the number of its neighbours and the sum of their indices.
pub struct Answer {
    counts: Vec<u32>,
    sums: Vec<u32>,
    /// The particles that are checked by brute force, each with its list of neighbours.
    lists: Vec<(usize, Vec<u32>)>,
    /// Sum of the distances from each particle to each of its neighbours; `None` for a peer that does not give it.
    distance_sum: Option<f64>,
}

impl Answer {
    /// From a function that gives the list of each particle.
    pub fn of<'a>(positions: &[Vec3], list: impl Fn(usize) -> &'a [u32]) -> Self {
        let sampled: Vec<usize> =
            (0..SAMPLES).map(|sample| hash::scramble(sample) as usize % positions.len()).collect();
        let mut answer = Self { counts: Vec::new(), sums: Vec::new(), lists: Vec::new(), distance_sum: None };
        let mut distance_sum = 0.0;
        for (particle, position) in positions.iter().enumerate() {
            let list = list(particle);
            answer.counts.push(list.len() as u32);
            answer.sums.push(list.iter().fold(0, |sum: u32, &other| sum.wrapping_add(other)));
            let distance = |&other: &u32| position.as_dvec3().distance(positions[other as usize].as_dvec3());
            distance_sum += list.iter().map(distance).sum::<f64>();
            if sampled.contains(&particle) {
                answer.lists.push((particle, list.to_vec()));
            }
        }
        answer.distance_sum = Some(distance_sum);
        answer
    }

    /// From a tree's lists, which are in an order of their own.
    pub fn of_lists(positions: &[Vec3], lists: &Lists) -> Self {
        let mut list_of = vec![0; positions.len()];
        for (list, &particle) in lists.order.iter().enumerate() {
            list_of[particle as usize] = list;
        }
        Self::of(positions, |particle| {
            let list = list_of[particle];
            &lists.indices[lists.starts[list] as usize..lists.starts[list + 1] as usize]
        })
    }

    /// From a peer's file: the counts of all particles, then the sums.
    pub fn read(path: &Path) -> anyhow::Result<Self> {
        let words = files::read_words(path)?;
        let (counts, sums) = words.split_at(words.len() / 2);
        Ok(Self { counts: counts.to_vec(), sums: sums.to_vec(), lists: Vec::new(), distance_sum: None })
    }

    /// How many indices all lists hold.
    pub fn pairs(&self) -> usize {
        self.counts.iter().map(|&count| count as usize).sum()
    }

    /// Checks for some particles, by brute force, that their lists hold the nearest within the radius.
    pub fn check_by_brute_force(&self, positions: &[Vec3], radius: f32) -> anyhow::Result<()> {
        for (particle, list) in &self.lists {
            let near = |other: usize| positions[*particle].distance_squared(positions[other]);
            let mut all: Vec<f32> = (0..positions.len())
                .filter(|&other| other != *particle && near(other) <= radius * radius)
                .map(near)
                .collect();
            all.sort_by(f32::total_cmp);
            all.truncate(MAX_NEIGHBOURS);
            let mut listed: Vec<f32> = list.iter().map(|&other| near(other as usize)).collect();
            listed.sort_by(f32::total_cmp);
            ensure!(all == listed, "the neighbours of particle {particle} are not the nearest");
        }
        Ok(())
    }

    /// Checks that another search found the same.
    pub fn check(&self, other: &Self) -> anyhow::Result<()> {
        ensure!(
            self.counts.len() == other.counts.len(),
            "{} lists and {} lists",
            self.counts.len(),
            other.counts.len()
        );
        let pairs = self.counts.iter().zip(&self.sums).zip(other.counts.iter().zip(&other.sums));
        let different = pairs.filter(|(mine, theirs)| mine != theirs).count();
        let ties = self.counts.len() * TIES_PER_MILLION / 1_000_000 + 2;
        if different > ties {
            bail!("{different} of {} lists differ, where ties explain {ties}", self.counts.len());
        }
        if let (Some(mine), Some(theirs)) = (self.distance_sum, other.distance_sum) {
            ensure!((mine / theirs - 1.0).abs() < 1e-6, "sums of distances {mine} and {theirs}");
        }
        Ok(())
    }
}
