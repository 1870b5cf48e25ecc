//! Checks the insides of text files: length, spaces, unfinished work, lint exceptions, absolute paths.

use super::finding::Finding;
use super::tree::{extension, name};

/// Longest file of code, in lines without its tests.
pub const LONGEST_FILE_LINES: usize = 500;

/// Marks of unfinished work, cut in two so that this file does not hold them.
const UNFINISHED: &[&str] =
    &[concat!("TO", "DO"), concat!("FIX", "ME"), concat!("XX", "X:"), concat!("unimple", "mented!")];

/// Everything that is untidy in a text file.
pub fn check(file: &str, content: &str) -> Vec<Finding> {
    if !matches!(
        extension(file),
        "rs" | "glsl" | "vert" | "frag" | "ron" | "md" | "toml" | "csv" | "txt" | "sh" | "obj" | "mtl"
    ) {
        return Vec::new();
    }
    let mut findings: Vec<Finding> = length(file, content).into_iter().collect();
    findings.extend(spaces(file, content));
    // Legal texts and tables may hold marks of unfinished work.
    if matches!(extension(file), "rs" | "glsl" | "vert" | "frag" | "ron" | "md" | "toml") {
        findings.extend(unfinished(file, content));
    }
    match extension(file) {
        "rs" => findings.extend(lint_exceptions(file, content)),
        "ron" => findings.extend(absolute_paths(file, content)),
        _ => {}
    }
    findings
}

/// Code files stay readable in one sitting; tests and tables may be longer.
fn length(file: &str, content: &str) -> Option<Finding> {
    let is_code = matches!(extension(file), "rs" | "glsl" | "vert" | "frag");
    let is_test = file.split('/').any(|part| matches!(part, "tests" | "tests.rs"));
    let is_table = name(file).contains("table");
    if !is_code || is_test || is_table {
        return None;
    }
    let lines = lines_without_tests(content);
    let mend = "split it by what its parts are about";
    let what = format!("{lines} lines, where at most {LONGEST_FILE_LINES} are read in one sitting");
    (lines > LONGEST_FILE_LINES).then(|| Finding::at(file, LONGEST_FILE_LINES + 1, what, mend))
}

/// The lines of a file without its tests. After each `#[cfg(test)]` one item is left out: a module in braces, or a
/// statement such as `mod tests;`.
fn lines_without_tests(content: &str) -> usize {
    let mut count = 0;
    let mut lines = content.lines();
    while let Some(line) = lines.next() {
        if line != "#[cfg(test)]" {
            count += 1;
            continue;
        }
        // An item in braces ends with a brace at the beginning of a line; another one with its semicolon.
        let is_over = |line: &str| line == "}" || line.ends_with(';') && !line.starts_with(' ');
        lines.by_ref().find(|line| is_over(line));
    }
    count
}

fn spaces(file: &str, content: &str) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (index, line) in content.split('\n').enumerate() {
        if line.ends_with('\r') {
            findings.push(Finding::at(file, index + 1, "a carriage return", "end lines with \\n alone"));
        } else if line.ends_with([' ', '\t']) {
            findings.push(Finding::at(file, index + 1, "spaces at the end of the line", "drop them"));
        }
    }
    if !content.is_empty() && !content.ends_with('\n') {
        let last = content.lines().count();
        findings.push(Finding::at(file, last, "no newline at the end", "add one"));
    }
    findings
}

fn unfinished(file: &str, content: &str) -> Vec<Finding> {
    lines_with(content, |line| UNFINISHED.iter().copied().find(|mark| line.contains(mark)))
        .map(|(line, mark)| Finding::at(file, line, format!("`{mark}`"), "finish it, or open an issue"))
        .collect()
}

/// `allow` only hides a lint, `expect` fails when it is no longer needed; so only `expect` may be used, with a reason.
fn lint_exceptions(file: &str, content: &str) -> Vec<Finding> {
    let opens = |kind: &str| [format!("#[{kind}("), format!("#![{kind}(")];
    let [allows, expects] = ["allow", "expect"].map(opens);
    let mut findings = Vec::new();
    for (index, line) in content.lines().enumerate() {
        let start = line.trim_start();
        if allows.iter().any(|open| start.starts_with(open)) {
            let mend = "write #[expect(…, reason = \"…\")], which fails once it is not needed";
            findings.push(Finding::at(file, index + 1, "a lint is allowed", mend));
        } else if expects.iter().any(|open| start.starts_with(open)) {
            let rest = content.lines().skip(index);
            let mut attribute = String::new();
            for part in rest {
                attribute.push_str(part);
                if part.trim_end().ends_with(")]") {
                    break;
                }
            }
            if !attribute.contains("reason =") {
                findings.push(Finding::at(file, index + 1, "a lint exception without a reason", "say why"));
            }
        }
    }
    findings
}

/// Scenes are moved and copied, so the paths that they name must be relative to them.
fn absolute_paths(file: &str, content: &str) -> Vec<Finding> {
    let is_absolute = |text: &str| {
        let drive =
            text.as_bytes().first().is_some_and(u8::is_ascii_alphabetic) && text[1..].starts_with(':');
        text.starts_with(['/', '~', '\\']) || (drive && text[2..].starts_with(['/', '\\']))
    };
    lines_with(content, |line| line.split('"').skip(1).step_by(2).find(|text| is_absolute(text)))
        .map(|(line, path)| {
            Finding::at(file, line, format!("\"{path}\" is absolute"), "name it relative to the scene file")
        })
        .collect()
}

fn lines_with<'a, T>(
    content: &'a str,
    find: impl Fn(&'a str) -> Option<T>,
) -> impl Iterator<Item = (usize, T)> {
    content.lines().enumerate().filter_map(move |(index, line)| find(line).map(|found| (index + 1, found)))
}
