//! Checks that the names of files and folders say what is in them.

use super::finding::Finding;

/// Starts of names that say nothing about what is inside.
const EMPTY_NAMES: &[&str] = &["util", "misc", "helper", "common", "manager"];

/// A finding for each part of a path that says nothing.
pub fn check(file: &str) -> Vec<Finding> {
    let empty = |part: &&str| EMPTY_NAMES.iter().any(|name| part.to_lowercase().starts_with(name));
    file.split('/')
        .filter(empty)
        .map(|part| {
            let mend = "name the noun that is inside (`strip`, `angle`), and split what has none in common";
            Finding::of_file(file, format!("`{part}` says nothing about what is in it"), mend)
        })
        .collect()
}
