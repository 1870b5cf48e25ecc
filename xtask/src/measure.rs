//! `cargo xtask measure`: measures the shipped scenes and writes the table of docs/techniques/rotating_strokes.md anew;
//! with `--shots`, measures every frame of their shots and writes the table of docs/steadiness.md. If scenes are named,
//! only those are measured; for the others the last reports (in `out/measure` and `out/shots`) are used.

use std::fmt::Write as _;
use std::path::Path;
use std::process::{Command, Stdio};

use anyhow::{Context as _, bail};
use serde_json::Value;

use crate::steps::{Profile, build, step};

/// A page with a table of what was measured.
struct Page {
    path: &'static str,
    /// The folder of the reports.
    folder: &'static str,
    metrics: &'static str,
    columns: &'static [Column],
}

const METRICS: Page = Page {
    path: "docs/techniques/rotating_strokes.md",
    folder: "out/measure",
    metrics: "M1,M2,M3,M4,M5,M6,M7,M8,M9,M10,M11,M12,M13,M14",
    columns: &COLUMNS,
};

const SHOTS: Page =
    Page { path: "docs/steadiness.md", folder: "out/shots", metrics: "M15,M16,M17", columns: &OF_SHOTS };

const BEGIN: &str = "<!-- measured:begin -->";
const END: &str = "<!-- measured:end -->";

/// A column of the table. It shows figures of one metric for Impasto and, in brackets behind them, one for a baseline.
struct Column {
    head: &'static str,
    /// The id of the metric in the report of `impasto measure`.
    metric: &'static str,
    ours: &'static [Cell],
    baseline: Option<Cell>,
}

/// Shows a figure, such as `max`, of the first reading whose name begins with `begins`.
struct Cell {
    begins: &'static str,
    figure: &'static str,
}

const fn cell(begins: &'static str, figure: &'static str) -> Cell {
    Cell { begins, figure }
}

const COLUMNS: [Column; 13] = [
    Column {
        head: "M1 roll, mean of 255",
        metric: "M1",
        ours: &[cell("quarter turns", "value")],
        baseline: Some(cell("fixed angle: mean", "value")),
    },
    Column {
        head: "M2 max °",
        metric: "M2",
        ours: &[cell("error", "max")],
        baseline: Some(cell("fixed", "mean")),
    },
    Column {
        head: "M3 max ° (horn, mean)",
        metric: "M3",
        ours: &[cell("against φ(A)", "max")],
        baseline: Some(cell("horn", "mean")),
    },
    Column {
        head: "M4 shot, worst %",
        metric: "M4",
        ours: &[cell("shot: strokes", "max")],
        baseline: Some(cell("the paper's rule on the shot", "max")),
    },
    Column {
        head: "M4 turntable, zoom %",
        metric: "M4",
        ours: &[cell("turntable: strokes", "max"), cell("zoom: strokes", "max")],
        baseline: Some(cell("the paper's rule on turntable", "max")),
    },
    Column {
        head: "M5 W over the paper's, over random's",
        metric: "M5",
        ours: &[cell("of the paper's", "value"), cell("of random's", "value")],
        baseline: None,
    },
    Column {
        head: "M6 at 90°, median p95 °",
        metric: "M6",
        ours: &[cell("90 deg: to", "median"), cell("90 deg: to", "p95")],
        baseline: Some(cell("the paper's rule, 90 deg", "p95")),
    },
    Column {
        head: "M6 at 180°, median p95 °",
        metric: "M6",
        ours: &[cell("180 deg: to", "median"), cell("180 deg: to", "p95")],
        baseline: Some(cell("the paper's rule, 180 deg", "p95")),
    },
    Column {
        head: "M7 S, arg L °",
        metric: "M7",
        ours: &[cell("S,", "value"), cell("arg L", "value")],
        baseline: Some(cell("fixed angle: arg L", "value")),
    },
    Column {
        head: "M8 variation",
        metric: "M8",
        ours: &[cell("variation", "max")],
        baseline: Some(cell("as a texture", "mean")),
    },
    Column {
        head: "M9 holes, body alone, bleed %",
        metric: "M9",
        ours: &[cell("holes, all", "value"), cell("holes, body", "value"), cell("bleed", "value")],
        baseline: Some(cell("the paper's rule: holes", "value")),
    },
    Column {
        head: "M11 at guides max °, twice the density mean °",
        metric: "M11",
        ours: &[cell("painted against", "max"), cell("change of angles", "mean")],
        baseline: None,
    },
    Column { head: "M13 bytes", metric: "M13", ours: &[cell("bytes that differ", "value")], baseline: None },
];

const OF_SHOTS: [Column; 6] = [
    Column {
        head: "M15 chatter of all strokes %",
        metric: "M15",
        ours: &[cell("all strokes", "value")],
        baseline: None,
    },
    Column { head: "worst layer %", metric: "M15", ours: &[cell("worst layer", "value")], baseline: None },
    Column { head: "M16 steps", metric: "M16", ours: &[cell("strokes that step", "value")], baseline: None },
    Column {
        head: "of highlights %, frames they live",
        metric: "M16",
        ours: &[cell("steps of highlights", "value"), cell("frames that", "median")],
        baseline: None,
    },
    Column {
        head: "M17 flicker, p99.9 (plain render)",
        metric: "M17",
        ours: &[cell("99.9 %", "value")],
        baseline: Some(cell("plain render: 99.9 %", "value")),
    },
    Column {
        head: "pixels above 6 %",
        metric: "M17",
        ours: &[cell("pixels above", "value")],
        baseline: Some(cell("plain render: pixels above", "value")),
    },
];

/// Measures and writes a table.
pub fn run(root: &Path, arguments: &[String]) -> anyhow::Result<()> {
    let (flags, only): (Vec<String>, Vec<String>) =
        arguments.iter().cloned().partition(|argument| argument == "--shots");
    let shown = if flags.is_empty() { &METRICS } else { &SHOTS };
    let mut scenes: Vec<String> = std::fs::read_dir(root.join("scenes"))?
        .filter_map(|entry| entry.ok()?.file_name().to_str()?.strip_suffix(".ron").map(str::to_owned))
        .collect();
    scenes.sort();
    if let Some(unknown) = only.iter().find(|name| !scenes.contains(name)) {
        bail!("there is no scene `{unknown}`; known are {}", scenes.join(", "));
    }
    let impasto = step("build", || build(root, Profile::Release))?;
    let folder = root.join(shown.folder);
    std::fs::create_dir_all(&folder)?;
    for scene in scenes.iter().filter(|scene| only.is_empty() || only.contains(scene)) {
        step(scene, || {
            let output = Command::new(&impasto)
                .current_dir(root)
                .args(["measure", "--json", "--only", shown.metrics, &format!("scenes/{scene}.ron")])
                .stderr(Stdio::null())
                .output()
                .context("impasto measure")?;
            // Exit code 1: a metric misses its bound, which the table shows.
            if !matches!(output.status.code(), Some(0 | 1)) || output.stdout.is_empty() {
                bail!("impasto measure ended with {}", output.status);
            }
            Ok(std::fs::write(folder.join(format!("{scene}.json")), output.stdout)?)
        })?;
    }
    let mut reports = Vec::new();
    for scene in &scenes {
        if let Ok(text) = std::fs::read_to_string(folder.join(format!("{scene}.json"))) {
            reports.push((scene.as_str(), serde_json::from_str(&text)?));
        }
    }
    let page = root.join(shown.path);
    let text = std::fs::read_to_string(&page)?;
    let table = table(&reports, shown.columns)?;
    std::fs::write(&page, replaced(&text, &table).with_context(|| format!("in {}", shown.path))?)?;
    println!("{}: {} scenes", shown.path, reports.len());
    Ok(())
}

fn replaced(page: &str, table: &str) -> anyhow::Result<String> {
    let missing = || format!("there is no {BEGIN} … {END}");
    let (before, rest) = page.split_once(BEGIN).with_context(missing)?;
    let (_, after) = rest.split_once(END).with_context(missing)?;
    Ok(format!("{before}{BEGIN}\n{table}{END}{after}"))
}

fn table(reports: &[(&str, Value)], columns: &[Column]) -> anyhow::Result<String> {
    let mut text = String::from("| scene |");
    for column in columns {
        write!(text, " {} |", column.head)?;
    }
    text.push_str("\n|---|");
    text.push_str(&"---|".repeat(columns.len()));
    text.push('\n');
    for (scene, report) in reports {
        write!(text, "| {scene} |")?;
        for column in columns {
            write!(text, " {} |", column.of(report))?;
        }
        text.push('\n');
    }
    Ok(text)
}

impl Column {
    /// `ours (baseline)`, bold where the metric misses its bound; a dash where the report has no value.
    fn of(&self, report: &Value) -> String {
        let rows = report["rows"].as_array().map_or(&[][..], Vec::as_slice);
        let Some(row) = rows.iter().find(|row| row["id"] == self.metric) else { return "–".to_owned() };
        let ours: Vec<String> = self.ours.iter().filter_map(|cell| cell.of(&row["values"])).collect();
        if ours.is_empty() {
            return "–".to_owned();
        }
        let mut shown = ours.join(", ");
        if row["verdict"] == "Misses" {
            shown = format!("**{shown}**");
        }
        match self.baseline.as_ref().and_then(|cell| cell.of(&row["baselines"])) {
            Some(baseline) => format!("{shown} ({baseline})"),
            None => shown,
        }
    }
}

impl Cell {
    fn of(&self, readings: &Value) -> Option<String> {
        let readings = readings.as_array()?;
        let reading = readings
            .iter()
            .find(|reading| reading["what"].as_str().is_some_and(|what| what.starts_with(self.begins)))?;
        short(reading[self.figure].as_f64()?)
    }
}

/// About three digits, with at most three decimals; numbers from 1000 on in full. `None` for one that is not finite.
fn short(value: f64) -> Option<String> {
    let size = value.abs();
    Some(match size {
        _ if !size.is_finite() => return None,
        _ if size == 0.0 => "0".to_owned(),
        _ if size < 0.0005 => "<0.001".to_owned(),
        _ if size < 1.0 => format!("{value:.3}"),
        _ if size < 10.0 => format!("{value:.2}"),
        _ if size < 100.0 => format!("{value:.1}"),
        _ => format!("{value:.0}"),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_shows_ours_and_the_baseline_and_what_misses() {
        let report = serde_json::json!({ "rows": [
            { "id": "M2", "verdict": "Holds", "values": [{ "what": "error", "max": 0.00002 }],
              "baselines": [{ "what": "fixed angle at 30:", "mean": 33.12 }] },
            { "id": "M9", "verdict": "Misses", "baselines": [],
              "values": [{ "what": "holes, all layers", "value": 0.61 }, { "what": "bleed", "value": 0.0 }] },
        ]});
        assert_eq!(COLUMNS[1].of(&report), "<0.001 (33.1)");
        assert_eq!(COLUMNS[10].of(&report), "**0.610, 0**");
        assert_eq!(COLUMNS[0].of(&report), "–");
        let page = replaced(&format!("a\n{BEGIN}\nold\n{END}\nb"), "new\n").expect("both marks are there");
        assert_eq!(page, format!("a\n{BEGIN}\nnew\n{END}\nb"));
        assert!(replaced("nothing", "").is_err());
    }
}
