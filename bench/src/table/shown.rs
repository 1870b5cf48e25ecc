//! Writes a table as text for a terminal, as Markdown, and as JSON.

use serde_json::{Value, json};

use super::{Figure, Row, Table, Unit};

const COLUMNS: [&str; 8] =
    ["what", "input", "who", "figure", "spread", "times ours", "ours / floor", "remarks"];

/// A number with its unit: times and bytes to about three digits, counts in full, ratios with three decimals.
pub fn number(number: f64, unit: Unit) -> String {
    let digits = |number: f64| {
        let places = 2 - (number.abs().max(1e-9).log10().floor() as i32).clamp(0, 2);
        format!("{number:.*}", places as usize)
    };
    match unit {
        Unit::Seconds if number < 1e-6 => format!("{} ns", digits(number * 1e9)),
        Unit::Seconds if number < 1e-3 => format!("{} µs", digits(number * 1e6)),
        Unit::Seconds if number < 1.0 => format!("{} ms", digits(number * 1e3)),
        Unit::Seconds => format!("{} s", digits(number)),
        Unit::Bytes if number >= 1e9 => format!("{} GB", digits(number * 1e-9)),
        Unit::Bytes if number >= 1e6 => format!("{} MB", digits(number * 1e-6)),
        Unit::Bytes => format!("{} B", digits(number)),
        Unit::Count => thousands(number),
        Unit::Ratio => format!("{number:.3}"),
    }
}

/// A whole number with commas.
pub fn thousands(number: f64) -> String {
    let digits = format!("{number:.0}");
    let mut shown = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            shown.push(',');
        }
        shown.push(digit);
    }
    shown
}

/// The cells of a figure: its name, number and spread.
fn cells(figure: &Figure) -> [String; 3] {
    let [shown, spread] = match &figure.value {
        Ok(value) => [
            number(value.median, figure.unit),
            if value.runs > 1 { format!("±{:.0} %", 100.0 * value.noise()) } else { String::new() },
        ],
        Err(_) => ["–".to_owned(), String::new()],
    };
    [figure.who.clone(), shown, spread]
}

fn remark(figure: &Figure) -> String {
    match &figure.value {
        Ok(value) if value.runs == 1 && figure.unit == Unit::Seconds => [figure.note.as_str(), "one run"]
            .into_iter()
            .filter(|part| !part.is_empty())
            .collect::<Vec<_>>()
            .join("; "),
        Ok(_) => figure.note.clone(),
        Err(why) => format!("missing here: {why}"),
    }
}

/// Every line of the table, cell by cell.
fn lines(table: &Table) -> Vec<[String; 8]> {
    let mut lines = Vec::new();
    for row in &table.rows {
        let [who, shown, spread] = cells(&row.ours);
        let over = row.over_floor().map_or_else(String::new, |ratio| format!("{ratio:.2}"));
        let mut remarks: Vec<String> =
            Some(remark(&row.ours)).into_iter().filter(|words| !words.is_empty()).collect();
        for goal in &row.goals {
            let (goal, held) = row.judged(goal);
            let verdict = match held {
                Some(true) => "held",
                Some(false) => "MISSED",
                None => "undecided here",
            };
            remarks.push(format!("goal {goal}: {verdict}"));
        }
        lines.push([
            row.what.clone(),
            row.input.clone(),
            who,
            shown,
            spread,
            String::new(),
            over,
            remarks.join("; "),
        ]);
        for figure in row.peers.iter().chain(&row.floor) {
            let [who, shown, spread] = cells(figure);
            let ratio = row.ratio(figure).map_or_else(String::new, |ratio| {
                if ratio >= 10.0 { format!("{ratio:.0}") } else { format!("{ratio:.2}") }
            });
            lines.push([
                String::new(),
                String::new(),
                who,
                shown,
                spread,
                ratio,
                String::new(),
                remark(figure),
            ]);
        }
    }
    lines
}

/// As text for a terminal, in aligned columns.
pub fn text(table: &Table) -> String {
    let lines = lines(table);
    let mut widths = COLUMNS.map(|name| name.chars().count());
    for line in &lines {
        for (width, cell) in widths.iter_mut().zip(line) {
            *width = (*width).max(cell.chars().count());
        }
    }
    let mut text = String::new();
    for (name, value) in &table.head {
        text += &format!("{name:<9} {value}\n");
    }
    text.push('\n');
    let mut push = |line: &[String; 8]| {
        let mut shown = String::new();
        for (column, (cell, width)) in line.iter().zip(widths).enumerate() {
            let room = width - cell.chars().count();
            // Numbers are aligned right.
            let (before, after) = if (3..=6).contains(&column) { (room, 0) } else { (0, room) };
            shown += &format!("{}{cell}{}  ", " ".repeat(before), " ".repeat(after));
        }
        text += shown.trim_end();
        text.push('\n');
    };
    push(&COLUMNS.map(str::to_owned));
    for line in &lines {
        push(line);
    }
    text
}

/// As Markdown for the docs.
pub fn markdown(table: &Table) -> String {
    let mut page = String::new();
    for (name, value) in &table.head {
        page += &format!("- {name}: {value}\n");
    }
    page += &format!("\n| {} |\n|---|---|---|--:|--:|--:|--:|---|\n", COLUMNS.join(" | "));
    for line in lines(table) {
        page += &format!("| {} |\n", line.join(" | "));
    }
    page
}

/// As JSON.
pub fn json(table: &Table) -> Value {
    let figure = |figure: &Figure| match &figure.value {
        Ok(value) => json!({
            "who": figure.who, "unit": format!("{:?}", figure.unit).to_lowercase(), "median": value.median,
            "low": value.low, "high": value.high, "runs": value.runs, "note": figure.note,
        }),
        Err(why) => json!({ "who": figure.who, "missing": why }),
    };
    let row = |row: &Row| {
        let goals: Vec<Value> = row
            .goals
            .iter()
            .map(|goal| {
                let (goal, held) = row.judged(goal);
                json!({ "goal": goal, "held": held })
            })
            .collect();
        let peers: Vec<Value> = row
            .peers
            .iter()
            .map(|peer| {
                let mut value = figure(peer);
                value["times_ours"] = json!(row.ratio(peer));
                value
            })
            .collect();
        json!({
            "what": row.what, "input": row.input, "ours": figure(&row.ours), "peers": peers,
            "floor": row.floor.as_ref().map(figure), "ours_over_floor": row.over_floor(), "goals": goals,
        })
    };
    let head: serde_json::Map<String, Value> =
        table.head.iter().map(|(name, value)| (name.clone(), json!(value))).collect();
    json!({ "machine": head, "rows": table.rows.iter().map(row).collect::<Vec<_>>() })
}
