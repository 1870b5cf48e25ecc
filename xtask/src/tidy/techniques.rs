//! Checks that every technique has all its parts (shader folder, style, page, tests) under the same name.

use std::collections::BTreeMap;

use super::finding::Finding;

/// A part that every technique has: what it is, the folders that may hold it, and how its file name ends (`/` for a
/// folder).
type Place = (&'static str, &'static [&'static str], &'static str);
const PLACES: &[Place] = &[
    ("a shader folder", &["crates/gl-render/shaders/"], "/"),
    ("a style", STYLES, ".rs"),
    ("a page", &["docs/techniques/"], ".md"),
];
/// Where a technique is drawn: a style, a material, or what lies over a picture in a window.
const STYLES: &[&str] =
    &["crates/gl-render/src/styles/", "crates/gl-render/src/materials/", "crates/gl-render/src/overlays/"];
const TESTS: Place = ("a test module", &["tests/it/"], ".rs");

/// Names in those places that are no techniques.
const NO_TECHNIQUES: &[&str] =
    &["shared", "mod", "README", "reference", "paint", "inverse_bilinear", "bending", "amounts", "touches"];

/// Techniques that lack one of their parts.
pub fn check(files: &[String]) -> Vec<Finding> {
    let mut words: BTreeMap<String, &String> = BTreeMap::new();
    for file in files {
        let found = PLACES.iter().find_map(|(_, folders, end)| word_in(file, folders, end));
        if let Some(word) = found.filter(|word| !NO_TECHNIQUES.contains(word)) {
            words.entry(word.to_owned()).or_insert(file);
        }
    }
    let mut findings = Vec::new();
    for (technique, first_seen) in words {
        for (what, folders, end) in PLACES.iter().chain([&TESTS]) {
            let there = files.iter().any(|file| word_in(file, folders, end) == Some(technique.as_str()));
            if !there {
                let what = format!("the technique `{technique}` has no {}", what.trim_start_matches("a "));
                let what = format!("{what}: {}{technique}{}", folders[0], end.trim_end_matches('/'));
                let mend = "write it, or call every part of the technique by the same word";
                findings.push(Finding::of_file(first_seen, what, mend));
            }
        }
    }
    findings
}

/// As [`word`], in any of these folders.
fn word_in<'a>(file: &'a str, folders: &[&str], end: &str) -> Option<&'a str> {
    folders.iter().find_map(|folder| word(file, folder, end))
}

/// The technique that a file in `folder` belongs to: WORD of `shaders/WORD/…`, `docs/techniques/WORD.md`, and of both
/// `styles/WORD.rs` and `styles/WORD/…`. `None` for a file elsewhere or with another ending.
fn word<'a>(file: &'a str, folder: &str, end: &str) -> Option<&'a str> {
    let rest = file.strip_prefix(folder)?;
    match rest.split_once('/') {
        Some((word, _)) if end != ".md" => Some(word),
        Some(_) => None,
        None if end == "/" => None,
        None => rest.strip_suffix(end),
    }
}
