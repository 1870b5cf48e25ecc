//! `cargo xtask layers`: checks that crates use each other only as ARCHITECTURE.md allows, and that no files of one
//! crate use each other in a circle.
//!
//! It reads two tables of that file. The table between `<!-- layers:begin -->` and `<!-- layers:end -->` says which of
//! our crates may use which. The table between `<!-- outside:begin -->` and `<!-- outside:end -->` names outside
//! crates, each with the only crates of ours that may use it.

mod circles;
mod graph;
mod modules;
mod table;

use std::path::Path;

use anyhow::{Context as _, bail};

use crate::steps::{cargo, output};
use circles::circles;
use graph::Graph;
use table::Rules;

/// Fails, naming every offending path, unless the workspace at `root` keeps to the tables of its ARCHITECTURE.md and
/// has no circles between files.
pub fn run(root: &Path) -> anyhow::Result<()> {
    let rustc = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".to_owned());
    let version = output(root, &rustc, &["-vV"])?;
    let host = version.lines().find_map(|line| line.strip_prefix("host: ")).context("rustc names no host")?;
    let metadata = output(root, &cargo(), &["metadata", "--format-version", "1", "--filter-platform", host])?;
    let graph = Graph::from_metadata(&serde_json::from_str(&metadata)?)?;
    let architecture = std::fs::read_to_string(root.join("ARCHITECTURE.md"))
        .context("ARCHITECTURE.md holds the table of allowed arrows")?;
    let rules = Rules::parse(&architecture)?;
    let mut findings = findings(&graph, &rules);
    let workspace = root.canonicalize()?;
    for root in graph.roots() {
        findings.extend(circles(&workspace, root)?);
    }
    if !findings.is_empty() {
        bail!("{}", findings.join("\n"));
    }
    println!(
        "{} crates keep to the arrows of ARCHITECTURE.md, without circles between files",
        graph.ours().count()
    );
    Ok(())
}

/// Every use of one crate by another that the rules do not allow, every crate of ours without a row in the layers
/// table, and every row without a crate of ours. Each is a sentence.
fn findings(graph: &Graph, rules: &Rules) -> Vec<String> {
    let mut findings = Vec::new();
    for name in graph.ours() {
        let Some(allowed) = rules.may_use.get(name) else {
            findings.push(format!("{name} has no row in the layers table; say there what it may use"));
            continue;
        };
        for used in graph.direct(name).filter(|used| graph.is_ours(used)) {
            if !allowed.contains(used) {
                findings.push(format!(
                    "{name} -> {used} is not allowed; drop it from {}, or allow it in ARCHITECTURE.md if the \
                     house is to change",
                    graph.manifest(name)
                ));
            }
        }
        for (outside, owners) in &rules.outside {
            if owners.contains(name) {
                continue;
            }
            if let Some(path) = graph.path_outside(name, outside) {
                findings.push(format!(
                    "{} is not allowed; {outside} belongs under {} alone",
                    path.join(" -> "),
                    if owners.is_empty() { "nobody" } else { "its owner" }
                ));
            }
        }
    }
    let known: Vec<&str> = graph.ours().collect();
    for name in rules.may_use.keys().filter(|name| !known.contains(&name.as_str())) {
        findings.push(format!("the layers table has a row for {name}, which is no crate here; drop the row"));
    }
    findings
}

#[cfg(test)]
mod tests;
