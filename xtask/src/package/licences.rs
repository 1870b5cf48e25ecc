//! Collects the licences of the libraries that are linked into the program, since they must be shipped with it.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use anyhow::{Context as _, ensure};
use serde_json::Value;

use crate::steps::{cargo, output};

/// Beginnings of the names of files that hold a licence or a notice.
const NAMES: [&str; 6] = ["LICENSE", "LICENCE", "COPYING", "NOTICE", "COPYRIGHT", "UNLICENSE"];

/// One text: all libraries with version and licence, then each licence text once, with the libraries it belongs to.
pub fn of_dependencies(root: &Path) -> anyhow::Result<String> {
    let packages = in_the_program(root)?;
    ensure!(packages.len() > 100, "only {} libraries were found in the program", packages.len());
    let mut said = String::from("Impasto holds these Rust libraries:\n\n");
    let mut texts: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for package in &packages {
        let word = |key: &str| package[key].as_str().unwrap_or("not stated");
        let name = format!("{} {}", word("name"), word("version"));
        said += &format!("{name}: {}\n", word("license"));
        let manifest = Path::new(package["manifest_path"].as_str().context("a package has a manifest")?);
        let mut files = Vec::new();
        let folder = manifest.parent().context("a manifest lies in a folder")?;
        for inside in [folder.to_path_buf(), folder.join("fonts")] {
            files.extend(std::fs::read_dir(inside).into_iter().flatten().flatten().map(|entry| entry.path()));
        }
        files.sort();
        for file in files {
            let name_of_file = file.file_name().unwrap_or_default().to_string_lossy().to_uppercase();
            let of_font = file.parent().is_some_and(|folder| folder.ends_with("fonts"));
            let is_licence = NAMES.iter().any(|start| name_of_file.starts_with(start))
                || (of_font && name_of_file.ends_with(".TXT"));
            if is_licence && file.is_file() {
                let text = String::from_utf8_lossy(&std::fs::read(&file)?).replace("\r\n", "\n");
                let users = texts.entry(text.trim().to_owned()).or_default();
                if users.last() != Some(&name) {
                    users.push(name.clone());
                }
            }
        }
    }
    for (text, users) in texts {
        said += &format!("\n{}\nOf {}:\n\n{text}\n", "=".repeat(80), users.join(", "));
    }
    Ok(said)
}

/// Cargo's metadata of each outside library that `impasto` uses on this system: what is linked into it, and procedural
/// macros, but no build dependencies.
fn in_the_program(root: &Path) -> anyhow::Result<Vec<Value>> {
    let host = output(root, "rustc", &["--print", "host-tuple"])?;
    let listed = ["tree", "--package", "impasto-cli", "--edges", "normal", "--prefix", "none", "--locked"];
    let tree =
        output(root, &cargo(), &[&listed[..], &["--target", host.trim(), "--format", "{p}"]].concat())?;
    let linked: BTreeSet<String> = tree
        .lines()
        .filter_map(|line| {
            let mut words = line.split_whitespace();
            Some(format!("{} {}", words.next()?, words.next()?.trim_start_matches('v')))
        })
        .collect();
    let listed = ["metadata", "--format-version", "1", "--locked", "--filter-platform", host.trim()];
    let metadata: Value = serde_json::from_str(&output(root, &cargo(), &listed)?)?;
    let packages = metadata["packages"].as_array().context("cargo metadata lists packages")?;
    let is_linked = |package: &&Value| {
        let word = |key: &str| package[key].as_str().unwrap_or_default();
        package["source"].is_string() && linked.contains(&format!("{} {}", word("name"), word("version")))
    };
    Ok(packages.iter().filter(is_linked).cloned().collect())
}
