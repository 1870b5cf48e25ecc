//! The table of the benchmark's results. Each row has our figure, the figures of the peers, the floor (the time of
//! minimal work in place of the task), and the goals for ours.

mod shown;

pub use shown::{json, markdown, text};

/// The unit of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// Wall clock.
    Seconds,
    /// Memory.
    Bytes,
    /// A number of things.
    Count,
    /// A share or a ratio.
    Ratio,
}

/// The median of several runs, with the quartiles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// Median.
    pub median: f64,
    /// A quarter of the runs are below.
    pub low: f64,
    /// A quarter of the runs are above.
    pub high: f64,
    /// How many runs; 0 for a number that was not measured here.
    pub runs: usize,
}

impl Spread {
    /// Summarises the numbers of at least one run.
    pub fn of(mut numbers: Vec<f64>) -> Self {
        numbers.sort_by(f64::total_cmp);
        let runs = numbers.len();
        let at = |share: f64| {
            let index = share * (runs - 1) as f64;
            let (below, above) = (numbers[index.floor() as usize], numbers[index.ceil() as usize]);
            below + (above - below) * index.fract()
        };
        Self { median: at(0.5), low: at(0.25), high: at(0.75), runs }
    }

    /// A number of one run, or the same in every run.
    pub fn exact(number: f64) -> Self {
        Self::of(vec![number])
    }

    /// A number from a publication.
    pub fn stated(number: f64) -> Self {
        Self { runs: 0, ..Self::exact(number) }
    }

    /// Half of the distance between the quartiles, over the median.
    pub fn noise(&self) -> f64 {
        if self.median > 0.0 { (self.high - self.low) / 2.0 / self.median } else { 0.0 }
    }
}

/// One number of one contender, or why there is none.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// The contender.
    pub who: String,
    /// The unit.
    pub unit: Unit,
    /// The number, or why there is none on this machine.
    pub value: Result<Spread, String>,
    /// A remark.
    pub note: String,
}

impl Figure {
    /// A number without a remark.
    pub fn new(who: &str, unit: Unit, value: Spread) -> Self {
        Self { who: who.to_owned(), unit, value: Ok(value), note: String::new() }
    }

    /// A figure without a number, because the contender is missing on this machine.
    pub fn missing(who: &str, unit: Unit, why: &str) -> Self {
        Self { who: who.to_owned(), unit, value: Err(why.to_owned()), note: String::new() }
    }

    /// The same figure with a remark.
    pub fn noted(self, note: impl Into<String>) -> Self {
        Self { note: note.into(), ..self }
    }

    /// The median, if there is one.
    pub fn median(&self) -> Option<f64> {
        self.value.as_ref().ok().map(|spread| spread.median)
    }
}

/// A goal of a row.
#[derive(Clone, Debug, PartialEq)]
pub enum Goal {
    /// Ours is at least `times` times faster than every peer whose name begins with `than`.
    Faster {
        /// Beginning of the peers' names.
        than: &'static str,
        /// How many times.
        times: f64,
    },
    /// Ours is at most this many times the floor.
    OverFloor(f64),
    /// Ours is at most this, in its unit.
    AtMost(f64),
}

/// The figures of one task on one input.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The task.
    pub what: String,
    /// What it was done on, and how large that is.
    pub input: String,
    /// Our figure.
    pub ours: Figure,
    /// The figures of others that do the same.
    pub peers: Vec<Figure>,
    /// The time of minimal work in place of the task: its memory traffic (`floor.rs`) or a bare draw (`stroke_pass`).
    pub floor: Option<Figure>,
    /// The goals.
    pub goals: Vec<Goal>,
}

impl Row {
    /// A row of our figure alone.
    pub fn of_ours(what: &str, input: &str, ours: Figure) -> Self {
        Self {
            what: what.to_owned(),
            input: input.to_owned(),
            ours,
            peers: Vec::new(),
            floor: None,
            goals: Vec::new(),
        }
    }

    /// A row of a race: the first figure is ours; the last is the floor if `has_floor`.
    pub fn of_race(what: &str, input: &str, mut figures: Vec<Figure>, has_floor: bool) -> Self {
        let floor = if has_floor { figures.pop() } else { None };
        let ours = figures.remove(0);
        Self { peers: figures, floor, ..Self::of_ours(what, input, ours) }
    }

    /// Adds a goal.
    pub fn meant(mut self, goal: Goal) -> Self {
        self.goals.push(goal);
        self
    }

    /// A peer's figure over ours; `None` if one is missing or the units differ.
    pub fn ratio(&self, peer: &Figure) -> Option<f64> {
        (peer.unit == self.ours.unit).then_some(())?;
        Some(peer.median()? / self.ours.median()?)
    }

    /// Our figure over the floor; `None` if one is missing.
    pub fn over_floor(&self) -> Option<f64> {
        Some(self.ours.median()? / self.floor.as_ref()?.median()?)
    }

    /// A goal in words, and whether it is reached; `None` where a figure for it is missing on this machine.
    fn judged(&self, goal: &Goal) -> (String, Option<bool>) {
        match goal {
            Goal::Faster { than, times } => {
                let ratios = self.peers.iter().filter(|peer| peer.who.starts_with(than));
                let least = ratios.filter_map(|peer| self.ratio(peer)).min_by(f64::total_cmp);
                (format!("{times} times faster than {than}"), least.map(|ratio| ratio >= *times))
            }
            Goal::OverFloor(times) => {
                (format!("within {times} times the floor"), self.over_floor().map(|ratio| ratio <= *times))
            }
            Goal::AtMost(most) => (
                format!("at most {}", shown::number(*most, self.ours.unit)),
                self.ours.median().map(|ours| ours <= *most),
            ),
        }
    }
}

/// All rows, with a head that describes the machine.
#[derive(Clone, Debug, Default)]
pub struct Table {
    /// Name and value of each line of the head.
    pub head: Vec<(String, String)>,
    /// In the order of measuring.
    pub rows: Vec<Row>,
}

/// A number with its unit, rounded for display.
pub fn shown(number: f64, unit: Unit) -> String {
    shown::number(number, unit)
}

/// A whole number with commas.
pub fn shown_count(count: usize) -> String {
    shown::thousands(count as f64)
}

/// Joins several lines into one.
pub fn one_line(words: &str) -> String {
    words.lines().map(str::trim).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(ours: f64, tree: f64, floor: f64) -> Row {
        let figure = |who: &str, secs: f64| Figure::new(who, Unit::Seconds, Spread::exact(secs));
        let figures = vec![figure("Impasto", ours), figure("tree 1.0", tree), figure("floor", floor)];
        Row::of_race("task", "1,000", figures, true)
    }

    #[test]
    fn quartiles_are_interpolated_and_robust_to_one_bad_run() {
        let spread = Spread::of(vec![5.0, 1.0, 2.0, 4.0, 3.0]);
        assert_eq!((spread.low, spread.median, spread.high), (2.0, 3.0, 4.0));
        assert_eq!(
            Spread::of(vec![1.0, 2.0, 3.0, 4.0, 900.0]).noise(),
            Spread::of(vec![1.0, 2.0, 3.0, 4.0, 5.0]).noise()
        );
        assert_eq!(Spread::of(vec![1.0, 2.0]).median, 1.5);
    }

    #[test]
    fn goals_are_held_missed_or_undecided() {
        let row = row(2.0, 7.0, 1.0);
        let held = |goal: Goal| row.judged(&goal).1;
        assert_eq!(held(Goal::Faster { than: "tree", times: 3.0 }), Some(true));
        assert_eq!(held(Goal::Faster { than: "tree", times: 4.0 }), Some(false));
        assert_eq!(held(Goal::Faster { than: "grid", times: 4.0 }), None);
        assert_eq!(held(Goal::OverFloor(1.5)), Some(false));
        assert_eq!(held(Goal::AtMost(2.5)), Some(true));
    }

    #[test]
    fn a_missing_contender_has_a_line_that_says_why() {
        let mut row = row(2.0, 7.0, 1.0);
        row.peers.push(Figure::missing("grid", Unit::Seconds, "no compiler"));
        let text = text(&Table { head: Vec::new(), rows: vec![row] });
        assert!(text.contains("missing here: no compiler"), "{text}");
        assert!(text.contains("3.50") && text.contains("2.00 s"), "{text}");
    }
}
