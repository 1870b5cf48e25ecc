//! What every part of the benchmark (see `parts.rs`) works with: the inputs, the peers (programs of others that do the
//! same task), how long to time them, and the table that it adds rows to.

use std::path::Path;

use crate::inputs::Inputs;
use crate::machine;
use crate::peers::Peers;
use crate::plots::Curve;
use crate::race::Pace;
use crate::table::{Figure, Row, Table, Unit};

/// How much is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// Inputs of all sizes, and many rounds.
    Full,
    /// Smaller inputs, and fewer rounds: less than two minutes in all.
    Quick,
}

/// What a part of the benchmark works with.
pub struct Bench {
    /// The inputs.
    pub inputs: Inputs,
    /// Builds and starts the peers that run as processes of their own.
    pub peers: Peers,
    /// The rows measured so far.
    pub table: Table,
    /// Curves of cost against the number of particles, to be plotted.
    pub curves: Vec<Curve>,
    mode: Mode,
}

impl Bench {
    /// A benchmark with nothing measured yet.
    pub fn new(root: &Path, mode: Mode, may_fetch: bool) -> Self {
        Self {
            inputs: Inputs::new(root),
            peers: Peers::new(root, may_fetch),
            table: Table::default(),
            curves: Vec::new(),
            mode,
        }
    }

    /// Whether this is [`Mode::Quick`].
    pub fn quick(&self) -> bool {
        self.mode == Mode::Quick
    }

    /// How many rounds a race has, and how long it may take. In a race, Impasto and its peers do one task in turn (see
    /// `race.rs`). A `slow` task gets two or three rounds at most.
    pub fn pace(&self, slow: bool) -> Pace {
        match (self.mode, slow) {
            (Mode::Quick, false) => Pace { rounds: 5, least_secs: 0.05, most_secs: 2.0 },
            (Mode::Quick, true) => Pace { rounds: 2, least_secs: 0.0, most_secs: 2.0 },
            (Mode::Full, false) => Pace { rounds: 9, least_secs: 0.2, most_secs: 20.0 },
            (Mode::Full, true) => Pace { rounds: 3, least_secs: 0.0, most_secs: 30.0 },
        }
    }

    /// Adds a row to the table, and reports our figure on stderr.
    pub fn push(&mut self, row: Row) {
        let value = row
            .ours
            .median()
            .map_or_else(|| "–".to_owned(), |median| crate::table::shown(median, row.ours.unit));
        eprintln!("  {}, {}: {value}", row.what, row.input);
        self.table.rows.push(row);
    }

    /// Returns whether `bytes` of memory are free for the largest input, 10,000,000 particles. If not, adds a row to
    /// the table that says why the task `what` was not measured at that size. Free memory of unknown size counts as
    /// enough.
    pub fn has_memory(&mut self, what: &str, bytes: u64) -> bool {
        let enough = machine::free_bytes().is_none_or(|free| free >= bytes);
        if !enough {
            let why = format!("{} GB of memory would have to be free", bytes >> 30);
            self.push(Row::of_ours(what, "10,000,000", Figure::missing("Impasto", Unit::Seconds, &why)));
        }
        enough
    }
}
