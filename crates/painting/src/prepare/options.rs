//! The options for preparing a scene, its errors, and a record of the time and memory of each step.

use std::time::Instant;

use impasto_scene::document::{Scene, Solver};

use super::seen::SeenFrom;
use crate::kept::FindKept;

/// Why a scene cannot be prepared.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum PrepareError {
    /// An object's mesh was not handed over with the scene.
    #[error("object {object:?}: mesh {mesh:?} was not read")]
    MeshMissing {
        /// Name of the object.
        object: String,
        /// Path of the mesh as written in the scene.
        mesh: String,
    },
    /// [`PrepareOptions::give_up`] returned true.
    #[error("preparing was given up")]
    GivenUp,
    /// The particles need more memory than they may take.
    #[error(
        "{particles} particles take about {} MiB while they are prepared, and {} MiB may be taken: give object {object:?} \
         fewer than its {of_object} (particles), or larger strokes",
        needed_bytes >> 20, budget_bytes >> 20
    )]
    Memory {
        /// All particles of the scene.
        particles: u64,
        /// What they take, bytes.
        needed_bytes: u64,
        /// What they may take, bytes.
        budget_bytes: u64,
        /// The object that has most of them.
        object: String,
        /// How many it has.
        of_object: u64,
    },
}

/// Peak memory of preparing a scene with a direction field, bytes per particle. Drawing takes less: 76 bytes, and 32
/// more for a body that bends.
const PEAK_BYTES: u64 = 240;
/// The same if the solver also needs Horn's lists of neighbours.
const PEAK_BYTES_WITH_LISTS: u64 = 520;

/// How many particles of all coats together can be numbered.
const MOST_PARTICLES: u64 = 1 << 31;

/// Options for preparing a scene.
#[derive(Clone, Copy)]
pub struct PrepareOptions<'a> {
    /// Called between steps and, on any thread, before each object's field is solved. Preparing is given up when it
    /// returns true.
    pub give_up: &'a (dyn Fn() -> bool + Sync),
    /// How much memory the particles may take, bytes; with `None` only their number is limited.
    pub memory_bytes: Option<u64>,
    /// Gives the process's peak memory since the last call, bytes, or `None` where that is not known.
    pub peak_bytes: &'a dyn Fn() -> Option<u64>,
    /// Gives the bytes that another process kept under a key (see [`crate::Painting::to_keep`]), if there are any. It
    /// is called once, after the surfaces have been made. With `None`, nothing is looked for.
    pub kept: Option<&'a FindKept<'a>>,
    /// From where the painting will be seen.
    pub seen_from: SeenFrom<'a>,
    /// Whether to make only what pictures show: a style without strokes then needs no particles. Directions and counts
    /// are missing too, so this is for those who only draw.
    pub only_shown: bool,
}

impl Default for PrepareOptions<'_> {
    /// Never gives up, sets no limit, looks for nothing that was kept, expects the scene's own camera, and makes
    /// particles in any style.
    fn default() -> Self {
        Self {
            give_up: &|| false,
            memory_bytes: None,
            peak_bytes: &|| None,
            kept: None,
            seen_from: SeenFrom::SHOT,
            only_shown: false,
        }
    }
}

/// How long a step of preparing took.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step {
    /// The name of the step.
    pub name: &'static str,
    /// Wall clock seconds.
    pub seconds: f64,
    /// The process's peak memory during the step, bytes; `None` where that is not known.
    pub peak_bytes: Option<u64>,
}

/// Checks that the particles of all objects fit into memory. `counts` has the number of particles of each object.
pub(super) fn fits(
    memory_bytes: Option<u64>,
    scene: &Scene,
    counts: &[u64],
    solver: Solver,
) -> Result<(), PrepareError> {
    let particles: u64 = counts.iter().sum();
    let with_lists = matches!(solver, Solver::Horn | Solver::HornExact);
    let bytes_each = if with_lists { PEAK_BYTES_WITH_LISTS } else { PEAK_BYTES };
    let needed_bytes = particles * bytes_each;
    let budget_bytes = memory_bytes.unwrap_or(u64::MAX).min(MOST_PARTICLES * bytes_each);
    let most = (0..counts.len()).max_by_key(|&index| counts[index]);
    match most {
        Some(most) if needed_bytes > budget_bytes => Err(PrepareError::Memory {
            particles,
            needed_bytes,
            budget_bytes,
            object: scene.objects[most].name.clone(),
            of_object: counts[most],
        }),
        _ => Ok(()),
    }
}

/// Measures the time and the peak memory of each step.
pub(super) struct StepClock<'a> {
    since: Instant,
    peak_bytes: &'a dyn Fn() -> Option<u64>,
    pub(super) steps: Vec<Step>,
}

impl<'a> StepClock<'a> {
    pub(super) fn new(peak_bytes: &'a dyn Fn() -> Option<u64>) -> Self {
        peak_bytes();
        Self { since: Instant::now(), peak_bytes, steps: Vec::new() }
    }

    /// Ends the step that is called `name`.
    pub(super) fn lap(&mut self, name: &'static str) {
        let seconds = self.since.elapsed().as_secs_f64();
        self.steps.push(Step { name, seconds, peak_bytes: (self.peak_bytes)() });
        self.since = Instant::now();
    }
}
