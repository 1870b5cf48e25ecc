//! Makes Debian's changelog from two sections of CHANGELOG.md: `Unreleased`, and the version of the program.

use std::path::Path;

use anyhow::ensure;

use super::{Moment, version};

/// How long a line may be.
const COLUMNS: usize = 78;

const MAINTAINER: &str = "The Impasto authors <impasto@localhost>";

/// Writes the changelog.
pub fn write(root: &Path, to: &Path, when: &Moment) -> anyhow::Result<()> {
    let text = entry(&std::fs::read_to_string(root.join("CHANGELOG.md"))?, version());
    ensure!(text.contains('*'), "CHANGELOG.md says nothing of version {}", version());
    let written = format!(
        "impasto ({}-1) unstable; urgency=medium\n\n{text}\n -- {MAINTAINER}  {}\n",
        version(),
        when.in_words
    );
    Ok(std::fs::write(to, written)?)
}

/// The points of the sections `Unreleased` and `version`, as Debian lays them out.
fn entry(changelog: &str, version: &str) -> String {
    let mut points: Vec<String> = Vec::new();
    let mut counts = false;
    for line in changelog.lines() {
        if let Some(title) = line.strip_prefix("## ") {
            counts = title == "Unreleased" || title == version;
        } else if counts && !line.trim().is_empty() {
            let begins = line.split_once(". ").filter(|(number, _)| number.parse::<u32>().is_ok());
            match (begins, points.last_mut()) {
                (Some((_, words)), _) => points.push(words.to_owned()),
                (None, Some(point)) => *point = format!("{point} {}", line.trim()),
                (None, None) => {}
            }
        }
    }
    points.iter().map(|point| laid_out(&plain(point))).collect()
}

/// A Markdown text without its marks; a link is replaced by its words.
fn plain(text: &str) -> String {
    let mut plain = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once("](") {
        let target_ends = after.find(')').map_or(after.len(), |at| at + 1);
        plain += before;
        rest = &after[target_ends..];
        let words_begin = plain.rfind('[').unwrap_or(plain.len());
        plain.replace_range(words_begin..(words_begin + 1).min(plain.len()), "");
    }
    plain += rest;
    plain.replace("**", "").replace('`', "'")
}

/// A point, with a star, in lines of limited length.
fn laid_out(point: &str) -> String {
    let mut lines = String::new();
    let mut line = String::from("  *");
    for word in point.split_whitespace() {
        if line.chars().count() + 1 + word.chars().count() > COLUMNS {
            lines += &line;
            lines.push('\n');
            line = String::from("   ");
        }
        line.push(' ');
        line += word;
    }
    lines + &line + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_is_new_is_told_without_marks_in_short_lines() {
        let text = "# Changelog\n\nWords.\n\n## Unreleased\n\n1. **New**: a `word`\n   and [a page](docs/a.md), [two](b.md).\n\n\
                    ## 0.2.0\n\n1. Old.\n\n## 0.1.0\n\n1. Older.\n";
        assert_eq!(entry(text, "0.2.0"), "  * New: a 'word' and a page, two.\n  * Old.\n");
        let long = format!("## Unreleased\n\n1. {}\n", "word ".repeat(40));
        let laid = entry(&long, "0.2.0");
        assert!(laid.lines().all(|line| line.len() <= COLUMNS && line.starts_with("  ")), "{laid}");
        assert_eq!(laid.matches("word").count(), 40);
    }
}
