//! What every part of the benchmark is handed: inputs, peers, the pace, and the table that it adds rows to.

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
    /// All inputs and all peers.
    Full,
    /// Under two minutes.
    Quick,
}

/// What a part works with.
pub struct Bench {
    /// The inputs.
    pub inputs: Inputs,
    /// Programs of others.
    pub peers: Peers,
    /// What was measured so far.
    pub table: Table,
    /// Costs against counts, to be plotted.
    pub curves: Vec<Curve>,
    mode: Mode,
}

impl Bench {
    /// Nothing measured yet.
    pub fn new(root: &Path, mode: Mode, may_fetch: bool) -> Self {
        Self {
            inputs: Inputs::new(root),
            peers: Peers::new(root, may_fetch),
            table: Table::default(),
            curves: Vec::new(),
            mode,
        }
    }

    /// Whether all of it is to take less than two minutes.
    pub fn quick(&self) -> bool {
        self.mode == Mode::Quick
    }

    /// How long a race takes; of what is `slow`, a round or two have to do.
    pub fn pace(&self, slow: bool) -> Pace {
        match (self.mode, slow) {
            (Mode::Quick, false) => Pace { rounds: 5, least_secs: 0.05, most_secs: 2.0 },
            (Mode::Quick, true) => Pace { rounds: 2, least_secs: 0.0, most_secs: 2.0 },
            (Mode::Full, false) => Pace { rounds: 9, least_secs: 0.2, most_secs: 20.0 },
            (Mode::Full, true) => Pace { rounds: 3, least_secs: 0.0, most_secs: 30.0 },
        }
    }

    /// Adds a row, and says so to whoever waits.
    pub fn push(&mut self, row: Row) {
        let value = row
            .ours
            .median()
            .map_or_else(|| "–".to_owned(), |median| crate::table::shown(median, row.ours.unit));
        eprintln!("  {}, {}: {value}", row.what, row.input);
        self.table.rows.push(row);
    }

    /// Whether so much memory is free; otherwise a row says that the largest input was left out.
    pub fn has_memory(&mut self, what: &str, bytes: u64) -> bool {
        let enough = machine::free_bytes().is_none_or(|free| free >= bytes);
        if !enough {
            let why = format!("{} GB of memory would have to be free", bytes >> 30);
            self.push(Row::of_ours(what, "10,000,000", Figure::missing("Impasto", Unit::Seconds, &why)));
        }
        enough
    }
}
