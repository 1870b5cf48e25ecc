//! The report: a row per metric with values, target, verdict and the counts behind them; as text and as JSON.

use std::fmt::Write as _;

use serde::Serialize;

use crate::figures::Spread;
use crate::metric::Metric;

/// A row with fewer strokes (or pixels) than this is no evidence.
pub const LEAST_STROKES: usize = 500;

/// Everything that was measured on a scene.
#[derive(Clone, Debug, Serialize)]
pub struct MeasureReport {
    /// The scene or mesh file.
    pub scene: String,
    /// The driver that drew.
    pub driver: String,
    /// Width and height of the pictures.
    pub size_px: [u32; 2],
    /// Wall clock seconds of the whole measurement.
    pub seconds: f64,
    /// One per metric.
    pub rows: Vec<Row>,
    /// Values over the frames of the shot.
    pub series: Vec<Series>,
    /// Warnings about the scene.
    pub warnings: Vec<String>,
}

/// The row of one metric.
#[derive(Clone, Debug, Serialize)]
pub struct Row {
    /// The metric.
    pub id: Metric,
    /// What it measures.
    pub title: &'static str,
    /// The frames and views measured, and the version of the scene.
    pub taken_on: String,
    /// The values found.
    pub values: Vec<Reading>,
    /// The values of other ways of painting, to compare with.
    pub baselines: Vec<Reading>,
    /// What the values should be.
    pub target: String,
    /// Whether the values meet the target.
    pub verdict: Verdict,
    /// How much was measured.
    pub counts: Counts,
    /// Remarks.
    pub notes: Vec<String>,
    /// Wall clock seconds that it took.
    pub seconds: f64,
}

/// Whether a metric meets its target.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub enum Verdict {
    /// It meets its target.
    Holds,
    /// It misses its target.
    Misses,
    /// The scene has nothing to measure it on, for this reason.
    NotApplicable(String),
    /// Too little was measured to be evidence; counts as a failure.
    TooFew(String),
}

/// How much was measured for a row.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Counts {
    /// Strokes; most metrics count each once per view.
    pub strokes: usize,
    /// Pixels, each counted once per view.
    pub pixels: usize,
    /// Frames or views.
    pub frames: usize,
}

/// A value with its name and unit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Reading {
    /// What was measured.
    pub what: String,
    /// Unit; empty for a plain number.
    pub unit: &'static str,
    /// The numbers.
    #[serde(flatten)]
    pub figures: Figures,
}

/// One number, or the summary of many.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Figures {
    /// One number.
    One {
        /// The number.
        value: f64,
    },
    /// A summary of many numbers.
    Many(Spread),
}

/// Values over frames.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Series {
    /// The metric that they belong to.
    pub metric: Metric,
    /// What the values are.
    pub title: &'static str,
    /// The largest value allowed.
    pub target: f64,
    /// Their unit.
    pub unit: &'static str,
    /// Frames with values, in order.
    pub points: Vec<(f64, f64)>,
}

impl Reading {
    /// A single number.
    pub fn one(what: impl Into<String>, unit: &'static str, value: f64) -> Self {
        Self { what: what.into(), unit, figures: Figures::One { value } }
    }

    /// A summary of many numbers.
    pub fn many(what: impl Into<String>, unit: &'static str, spread: Spread) -> Self {
        Self { what: what.into(), unit, figures: Figures::Many(spread) }
    }

    fn words(&self) -> String {
        let unit = if self.unit.is_empty() { String::new() } else { format!(" {}", self.unit) };
        match self.figures {
            Figures::One { value } => format!("{} {}{unit}", self.what, short(value)),
            Figures::Many(spread) if spread.count == 0 => format!("{}: nothing to measure", self.what),
            Figures::Many(spread) => format!(
                "{} mean {}, median {}, p95 {}, max {}{unit} (of {})",
                self.what,
                short(spread.mean),
                short(spread.median),
                short(spread.p95),
                short(spread.max),
                spread.count
            ),
        }
    }
}

/// A number with three significant digits, or with all digits before the point if there are more. Below 0.001 and from
/// 100000 on, it has two significant digits and an exponent.
fn short(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 {
        "0".to_owned()
    } else if !(1e-3..1e5).contains(&size) {
        format!("{value:.1e}")
    } else {
        let digits = (2.0 - size.log10().floor()).clamp(0.0, 5.0) as usize;
        format!("{value:.digits$}")
    }
}

impl Verdict {
    /// `Holds` or `Misses`; `TooFew` where fewer than [`LEAST_STROKES`] strokes were measured.
    pub fn of(holds: bool, counts: Counts) -> Self {
        if counts.strokes < LEAST_STROKES {
            return Self::TooFew(format!("{} strokes; {LEAST_STROKES} are needed", counts.strokes));
        }
        if holds { Self::Holds } else { Self::Misses }
    }

    /// `Holds` or `Misses`; `TooFew` where fewer than [`LEAST_STROKES`] pixels were measured.
    pub fn of_pixels(holds: bool, counts: Counts) -> Self {
        if counts.pixels < LEAST_STROKES {
            return Self::TooFew(format!("{} pixels; {LEAST_STROKES} are needed", counts.pixels));
        }
        if holds { Self::Holds } else { Self::Misses }
    }

    /// Whether the metric holds or does not apply.
    pub fn is_fine(&self) -> bool {
        matches!(self, Self::Holds | Self::NotApplicable(_))
    }

    fn words(&self) -> String {
        match self {
            Self::Holds => "holds".to_owned(),
            Self::Misses => "MISSES".to_owned(),
            Self::NotApplicable(reason) => format!("not applicable: {reason}"),
            Self::TooFew(reason) => format!("TOO FEW: {reason}"),
        }
    }
}

impl Row {
    /// A row that has no values yet; its verdict is `Holds`.
    pub fn new(id: Metric, taken_on: impl Into<String>, target: impl Into<String>) -> Self {
        Self {
            id,
            title: id.title(),
            taken_on: taken_on.into(),
            values: Vec::new(),
            baselines: Vec::new(),
            target: target.into(),
            verdict: Verdict::Holds,
            counts: Counts::default(),
            notes: Vec::new(),
            seconds: 0.0,
        }
    }

    /// The row of a metric that does not apply to this scene.
    #[must_use]
    pub fn not_applicable(mut self, reason: impl Into<String>) -> Self {
        self.verdict = Verdict::NotApplicable(reason.into());
        self
    }
}

impl MeasureReport {
    /// Whether every row holds or is not applicable.
    pub fn holds(&self) -> bool {
        self.rows.iter().all(|row| row.verdict.is_fine())
    }

    /// The report as text.
    pub fn table(&self) -> String {
        let mut text = String::new();
        let [width, height] = self.size_px;
        // Writing to a String cannot fail.
        let _ = writeln!(text, "{}: {width} x {height}, {}, {:.0} s", self.scene, self.driver, self.seconds);
        for row in &self.rows {
            let _ = writeln!(
                text,
                "{:<4}{:<20}{} ({:.1} s)",
                row.id.to_string(),
                row.title,
                row.verdict.words(),
                row.seconds
            );
            if !row.values.is_empty() {
                let Counts { strokes, pixels, frames } = row.counts;
                let parts = [(strokes, "strokes"), (pixels, "pixels"), (frames, "frames")];
                let counts: Vec<String> = parts
                    .iter()
                    .filter(|(count, _)| *count > 0)
                    .map(|(count, what)| format!("{count} {what}"))
                    .collect();
                let _ = writeln!(text, "    on       {} ({})", row.taken_on, counts.join(", "));
            }
            for value in &row.values {
                let _ = writeln!(text, "             {}", value.words());
            }
            for value in &row.baselines {
                let _ = writeln!(text, "    beside   {}", value.words());
            }
            let _ = writeln!(text, "    target   {}", row.target);
            for note in &row.notes {
                let _ = writeln!(text, "    note     {note}");
            }
        }
        for warning in &self.warnings {
            let _ = writeln!(text, "warning: {warning}");
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_empty_mask_is_a_failure() {
        assert!(!Verdict::of(true, Counts::default()).is_fine());
        assert!(!Verdict::of_pixels(true, Counts { strokes: 900, ..Counts::default() }).is_fine());
        assert!(Verdict::of(true, Counts { strokes: 500, ..Counts::default() }).is_fine());
    }

    #[test]
    fn numbers_are_short() {
        for (value, words) in
            [(0.0, "0"), (12.345, "12.3"), (0.01234, "0.0123"), (1e-7, "1.0e-7"), (345.6, "346")]
        {
            assert_eq!(short(value), words);
        }
    }
}
