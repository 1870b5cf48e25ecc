//! Stores results in a text file, one per machine, so that later runs can be compared with them. The file holds the
//! head of the table, then a line for each figure.
//!
//! ```text
//! # processor: …
//! what<TAB>input<TAB>who<TAB>unit<TAB>median<TAB>low<TAB>high
//! ```

use std::path::Path;

use anyhow::{Context as _, bail};

use crate::table::{Figure, Table, Unit, shown};

/// Changes from run to run by less than this share are noise, whatever the spread within each run.
const NOISE: f64 = 0.1;

/// One figure of a row.
#[derive(Clone, Debug, PartialEq)]
struct Entry {
    what: String,
    input: String,
    who: String,
    unit: Unit,
    median: f64,
    low: f64,
    high: f64,
}

/// The figures of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Results {
    head: Vec<(String, String)>,
    entries: Vec<Entry>,
}

fn unit_of(name: &str) -> Option<Unit> {
    [Unit::Seconds, Unit::Bytes, Unit::Count, Unit::Ratio].into_iter().find(|unit| name_of(*unit) == name)
}

fn name_of(unit: Unit) -> &'static str {
    match unit {
        Unit::Seconds => "s",
        Unit::Bytes => "bytes",
        Unit::Count => "count",
        Unit::Ratio => "ratio",
    }
}

impl Results {
    /// The figures of a table that have a value: ours, those of the peers (others that do the same task), and the
    /// floors (the times of minimal work in place of the task).
    pub fn of(table: &Table) -> Self {
        let mut entries = Vec::new();
        for row in &table.rows {
            let figures = std::iter::once(&row.ours).chain(&row.peers).chain(&row.floor);
            entries.extend(figures.filter_map(|figure: &Figure| {
                let value = figure.value.as_ref().ok()?;
                Some(Entry {
                    what: row.what.clone(),
                    input: row.input.clone(),
                    who: figure.who.clone(),
                    unit: figure.unit,
                    median: value.median,
                    low: value.low,
                    high: value.high,
                })
            }));
        }
        Self { head: table.head.clone(), entries }
    }

    fn text(&self) -> String {
        let mut text = String::new();
        for (name, value) in &self.head {
            text += &format!("# {name}: {value}\n");
        }
        for Entry { what, input, who, unit, median, low, high } in &self.entries {
            let unit = name_of(*unit);
            text += &format!("{what}\t{input}\t{who}\t{unit}\t{median:.6e}\t{low:.6e}\t{high:.6e}\n");
        }
        text
    }

    /// Writes the file. Lines that were not measured this time stay.
    ///
    /// # Errors
    /// Where the file cannot be read or written.
    pub fn write(mut self, path: &Path) -> anyhow::Result<()> {
        if path.is_file() {
            let before = read(path)?;
            let is_new = |old: &Entry| !self.entries.iter().any(|new| same(old, new));
            let mut entries: Vec<Entry> = before.entries.into_iter().filter(is_new).collect();
            entries.append(&mut self.entries);
            self.entries = entries;
        }
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder)?;
        }
        std::fs::write(path, self.text()).with_context(|| format!("{} cannot be written", path.display()))
    }

    fn machine(&self) -> &str {
        self.head.iter().find(|(name, _)| name == "processor").map_or("", |(_, value)| value)
    }

    fn date(&self) -> &str {
        self.head.iter().find(|(name, _)| name == "date").map_or("no date", |(_, value)| value)
    }

    /// Says which figures of a later run have changed. Times of two different machines cannot be compared. In their
    /// place it compares ratios: each peer's and each floor's time, divided by our time on the same machine.
    pub fn moved(&self, later: &Self) -> String {
        let same_machine = self.machine() == later.machine();
        let mut text = format!(
            "against {} of {}",
            if same_machine { "this machine" } else { self.machine() },
            self.date()
        );
        if !same_machine {
            text += "; another machine, so the others' times over ours are compared";
        }
        text.push('\n');
        let mut moved = 0;
        for new in &later.entries {
            let Some(old) = self.entries.iter().find(|old| same(old, new)) else { continue };
            let (old, new) = if same_machine || new.unit != Unit::Seconds {
                (old.clone(), new.clone())
            } else {
                match (self.over_ours(old), later.over_ours(new)) {
                    (Some(old), Some(new)) => (old, new),
                    _ => continue,
                }
            };
            let apart = new.low > old.high || new.high < old.low;
            let ratio = new.median / old.median;
            if apart && ratio.is_finite() && (ratio.ln().abs() > (1.0 + NOISE).ln()) {
                moved += 1;
                let Entry { what, input, who, unit, .. } = &new;
                let (before, now) = (shown(old.median, *unit), shown(new.median, *unit));
                text += &format!("  {what}, {input}, {who}: {before} → {now} (×{ratio:.2})\n");
            }
        }
        let compared =
            later.entries.iter().filter(|new| self.entries.iter().any(|old| same(old, new))).count();
        text += &format!("{moved} of {compared} figures moved beyond the noise\n");
        text
    }

    /// The ratio of another's time (a peer's or a floor's) to ours; `None` if the entry is ours or has another unit.
    fn over_ours(&self, entry: &Entry) -> Option<Entry> {
        let ours =
            self.entries.iter().find(|other| other.what == entry.what && other.input == entry.input)?;
        (ours.who != entry.who && ours.unit == entry.unit).then(|| Entry {
            who: format!("{} over {}", entry.who, ours.who),
            unit: Unit::Ratio,
            median: entry.median / ours.median,
            low: entry.low / ours.high,
            high: entry.high / ours.low,
            ..entry.clone()
        })
    }
}

fn same(one: &Entry, other: &Entry) -> bool {
    (&one.what, &one.input, &one.who, one.unit) == (&other.what, &other.input, &other.who, other.unit)
}

/// Reads a file of results.
///
/// # Errors
/// Where the file cannot be read or has another form.
pub fn read(path: &Path) -> anyhow::Result<Results> {
    let text = std::fs::read_to_string(path).with_context(|| format!("{} cannot be read", path.display()))?;
    parse(&text).with_context(|| format!("{} is no file of results", path.display()))
}

fn parse(text: &str) -> anyhow::Result<Results> {
    let mut results = Results::default();
    for (index, line) in text.lines().enumerate() {
        if let Some(head) = line.strip_prefix("# ") {
            let (name, value) = head.split_once(": ").unwrap_or((head, ""));
            results.head.push((name.to_owned(), value.to_owned()));
            continue;
        }
        let fields: Vec<&str> = line.split('\t').collect();
        let [what, input, who, unit, median, low, high] = fields[..] else {
            bail!("line {} has {} fields, not 7", index + 1, fields.len());
        };
        let number = |text: &str| text.parse::<f64>().with_context(|| format!("line {}: {text}", index + 1));
        results.entries.push(Entry {
            what: what.to_owned(),
            input: input.to_owned(),
            who: who.to_owned(),
            unit: unit_of(unit).with_context(|| format!("line {}: a unit {unit}", index + 1))?,
            median: number(median)?,
            low: number(low)?,
            high: number(high)?,
        });
    }
    Ok(results)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::table::{Row, Spread};

    fn run(processor: &str, secs: &[(&str, f64)]) -> Results {
        let head =
            vec![("processor".to_owned(), processor.to_owned()), ("date".to_owned(), "today".to_owned())];
        let figure = |&(who, secs): &(&str, f64)| {
            Figure::new(who, Unit::Seconds, Spread::of(vec![0.99 * secs, secs, 1.01 * secs]))
        };
        let row = Row::of_race("task", "1,000", secs.iter().map(figure).collect(), false);
        Results::of(&Table { head, rows: vec![row] })
    }

    #[test]
    fn written_results_are_read_back() {
        let results = run("a chip", &[("Impasto", 0.5), ("tree", 2.0)]);
        assert_eq!(parse(&results.text()).unwrap(), results);
        assert!(parse("what\tinput\n").is_err());
        assert!(parse("a\tb\tc\tparsecs\t1\t1\t1\n").is_err());
    }

    #[test]
    fn only_changes_are_reported_and_between_machines_only_ratios() {
        let before = run("a chip", &[("Impasto", 0.5), ("tree", 2.0)]);
        let slower = run("a chip", &[("Impasto", 0.8), ("tree", 2.01)]);
        let report = before.moved(&slower);
        assert!(report.contains("Impasto: 500 ms → 800 ms (×1.60)"), "{report}");
        assert!(!report.contains("tree:"), "{report}");
        let elsewhere = run("another chip", &[("Impasto", 5.0), ("tree", 20.0)]);
        assert!(before.moved(&elsewhere).contains("0 of 2"), "{}", before.moved(&elsewhere));
        let elsewhere = run("another chip", &[("Impasto", 5.0), ("tree", 5.0)]);
        let report = before.moved(&elsewhere);
        assert!(report.contains("tree over Impasto: 4.000 → 1.000"), "{report}");
    }
}
