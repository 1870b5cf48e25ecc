//! Reads the two tables of ARCHITECTURE.md that say which crate may use which; `cargo xtask layers` checks against
//! them.

use std::collections::{BTreeMap, BTreeSet};

use anyhow::{Context as _, bail};

/// Which crate may use which, by package name.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Rules {
    /// For each crate of ours, the crates of ours that it may use.
    pub may_use: BTreeMap<String, BTreeSet<String>>,
    /// For each outside crate that the second table names, the crates of ours that may reach it.
    pub outside: BTreeMap<String, BTreeSet<String>>,
}

impl Rules {
    /// Reads both tables out of the text of ARCHITECTURE.md. Our crates stand there by folder name (`core`).
    pub fn parse(text: &str) -> anyhow::Result<Self> {
        let crates = rows(text, "layers")?;
        let names: Vec<String> = crates.iter().map(|(name, _)| package(name)).collect();
        let resolve = |cell: &str, row: &str| -> anyhow::Result<BTreeSet<String>> {
            let mut used = BTreeSet::new();
            for word in words(cell) {
                match word {
                    "nothing" | "nobody" => {}
                    "all" => used.extend(names.iter().cloned()),
                    _ if names.contains(&package(word)) => {
                        used.insert(package(word));
                    }
                    _ => bail!("the row of `{row}` names `{word}`, which has no row in the layers table"),
                }
            }
            Ok(used)
        };
        let mut rules = Self::default();
        for (name, cell) in &crates {
            rules.may_use.insert(package(name), resolve(cell, name)?);
        }
        for (name, cell) in rows(text, "outside")? {
            rules.outside.insert(name.clone(), resolve(&cell, &name)?);
        }
        Ok(rules)
    }
}

fn package(folder: &str) -> String {
    if folder == "xtask" { folder.to_owned() } else { format!("impasto-{folder}") }
}

fn words(cell: &str) -> impl Iterator<Item = &str> {
    cell.split([',', ' ', '`']).filter(|word| !word.is_empty())
}

/// The rows of a two-column table between `<!-- NAME:begin -->` and `<!-- NAME:end -->`, without its heading lines.
fn rows(text: &str, name: &str) -> anyhow::Result<Vec<(String, String)>> {
    let missing = || format!("ARCHITECTURE.md has no `<!-- {name}:begin -->` … `<!-- {name}:end -->`");
    let (_, rest) = text.split_once(&format!("<!-- {name}:begin -->")).with_context(missing)?;
    let (inside, _) = rest.split_once(&format!("<!-- {name}:end -->")).with_context(missing)?;
    let lines = inside.lines().map(str::trim).filter(|line| line.starts_with('|')).skip(2);
    let rows: Vec<(String, String)> = lines
        .map(|line| {
            let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
            match cells[..] {
                [first, second, ..] => Ok((first.trim_matches('`').to_owned(), second.to_owned())),
                _ => bail!("a row of the {name} table has one cell: {line}"),
            }
        })
        .collect::<anyhow::Result<_>>()?;
    if rows.is_empty() {
        bail!("the {name} table of ARCHITECTURE.md is empty");
    }
    Ok(rows)
}
