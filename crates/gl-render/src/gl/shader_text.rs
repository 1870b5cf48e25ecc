//! Shader texts: expands `#include`, and makes driver messages name our files and lines.

use std::collections::BTreeMap;
use std::fmt::Write as _;

/// A shader file that is part of the program.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShaderFile {
    /// Path below `shaders/`.
    pub path: &'static str,
    pub text: &'static str,
}

/// Texts that replace some of the program's own shader files, for people who work on a look of their own.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ShaderTexts(pub(crate) BTreeMap<&'static str, String>);

impl ShaderTexts {
    /// Whether nothing is replaced.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The text that replaces the file at this path.
    pub(crate) fn get(&self, path: &str) -> Option<&str> {
        self.0.get(path).map(String::as_str)
    }
}

/// The text of a shader with all its includes in place.
#[derive(Debug)]
pub(super) struct Expanded {
    pub text: String,
    /// Paths of the files. The index of a path is its number in the `#line` directives.
    paths: Vec<&'static str>,
}

/// Files, and texts that replace some of them.
#[derive(Clone, Copy)]
pub(super) struct Sources<'a> {
    pub files: &'a [&'a [ShaderFile]],
    pub replaced: &'a ShaderTexts,
}

/// The name that is defined for shaders that write into a storage buffer. They need GLSL 4.30, all others 3.30.
pub(super) const STORES: &str = "STORES";

/// `#define`s these names, then replaces every `#include "path"` by the text of that file; a file that is included
/// again adds nothing. Paths start at `shaders/`.
pub(super) fn expand(sources: Sources<'_>, path: &str, defined: &[&str]) -> Result<Expanded, String> {
    let version = if defined.contains(&STORES) { 430 } else { 330 };
    let mut expanded = Expanded { text: format!("#version {version} core\n"), paths: Vec::new() };
    for name in defined {
        // Writing to a String cannot fail.
        let _ = writeln!(expanded.text, "#define {name}");
    }
    append(sources, path, &mut expanded)?;
    Ok(expanded)
}

fn append(sources: Sources<'_>, path: &str, into: &mut Expanded) -> Result<(), String> {
    let file = sources
        .files
        .iter()
        .flat_map(|group| group.iter())
        .find(|file| file.path == path)
        .ok_or_else(|| format!("there is no shader file {path}"))?;
    if into.paths.contains(&file.path) {
        return Ok(());
    }
    let number = into.paths.len();
    into.paths.push(file.path);
    let mark = |into: &mut Expanded, line: usize| {
        // Writing to a String cannot fail.
        let _ = writeln!(into.text, "#line {line} {number}");
    };
    mark(into, 1);
    let text = sources.replaced.get(path).unwrap_or(file.text);
    for (index, line) in text.lines().enumerate() {
        match included(line) {
            Some(inner) => {
                append(sources, inner, into).map_err(|fault| format!("{path}:{}: {fault}", index + 1))?;
                mark(into, index + 2);
            }
            None => {
                into.text.push_str(line);
                into.text.push('\n');
            }
        }
    }
    Ok(())
}

fn included(line: &str) -> Option<&str> {
    line.trim().strip_prefix("#include")?.trim().strip_prefix('"')?.strip_suffix('"')
}

impl Expanded {
    /// Puts our file names into the compiler's messages: `1:12` (as in `1:12(5)` and `ERROR: 1:12`) and `1(12)` become
    /// `path:12`.
    pub(super) fn name_places(&self, log: &str) -> String {
        log.lines().map(|line| self.name_place(line)).collect::<Vec<_>>().join("\n").trim().to_owned()
    }

    fn name_place(&self, line: &str) -> String {
        let start = line.find(|c: char| c.is_ascii_digit()).unwrap_or(line.len());
        let (before, rest) = line.split_at(start);
        let after_file = rest.trim_start_matches(|c: char| c.is_ascii_digit());
        let file = &rest[..rest.len() - after_file.len()];
        let number = after_file.strip_prefix([':', '(']).unwrap_or_default();
        let after_line = number.trim_start_matches(|c: char| c.is_ascii_digit());
        let row = &number[..number.len() - after_line.len()];
        match file.parse::<usize>().ok().and_then(|file| self.paths.get(file)) {
            Some(path) if !row.is_empty() => {
                let tail = after_line.strip_prefix(')').unwrap_or(after_line);
                format!("{before}{path}:{row}{tail}")
            }
            _ => line.to_owned(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const FILES: &[ShaderFile] = &[
        ShaderFile { path: "a.frag", text: "one\n#include \"b.glsl\"\n#include \"b.glsl\"\nfour\n" },
        ShaderFile { path: "b.glsl", text: "inner\n" },
        ShaderFile { path: "lost.frag", text: "\n#include \"nowhere.glsl\"\n" },
    ];

    fn expand(files: &[&[ShaderFile]], path: &str, defined: &[&str]) -> Result<Expanded, String> {
        super::expand(Sources { files, replaced: &ShaderTexts::default() }, path, defined)
    }

    #[test]
    fn a_file_is_included_once_and_line_numbers_stay_right() {
        let expanded = expand(&[FILES], "a.frag", &[]).unwrap();
        let wanted = "#version 330 core\n#line 1 0\none\n#line 1 1\ninner\n#line 3 0\n#line 4 0\nfour\n";
        assert_eq!(expanded.text, wanted);
    }

    #[test]
    fn a_missing_include_names_the_line() {
        let fault = expand(&[FILES], "lost.frag", &[]).unwrap_err();
        assert_eq!(fault, "lost.frag:2: there is no shader file nowhere.glsl");
    }

    #[test]
    fn messages_of_three_compilers_get_our_names() {
        let expanded = expand(&[FILES], "a.frag", &[]).unwrap();
        assert_eq!(expanded.name_places("1:12(5): error: x"), "b.glsl:12(5): error: x");
        assert_eq!(expanded.name_places("1(12) : error C0000"), "b.glsl:12 : error C0000");
        assert_eq!(expanded.name_places("ERROR: 0:7: 'y'"), "ERROR: a.frag:7: 'y'");
        assert_eq!(expanded.name_places("linking failed"), "linking failed");
    }
}
