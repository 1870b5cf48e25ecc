//! Parses text into the document, and explains errors of the RON parser in terms of the scene.

use std::ops::Range;
use std::path::Path;

use ron::error::{Position, SpannedError};
use ron::extensions::Extensions;

use super::field_words::what_goes_into;
use super::source::{self, error_in};
use crate::document::Scene;
use crate::limits;
use crate::locate::{Field, Inside, Located, Node};
use crate::nearest::nearest;
use crate::problem::{Problem, Report, TextPosition};

/// The most bytes parsed in all passes over one text together; the first pass is always made.
const MOST_PARSED_BYTES: usize = 32 << 20;

/// A document and where everything in it stands.
#[derive(Debug)]
pub(super) struct Parsed {
    pub(super) scene: Scene,
    pub(super) located: Located,
}

/// Parses a text without byte order mark. Reports the unknown fields up to the first fault of another kind, and that
/// fault.
pub(super) fn parse(path: &Path, text: &str) -> Result<Parsed, Report> {
    parse_with(path, text, from_ron).map(|(scene, located)| Parsed { scene, located })
}

/// As [`parse`], for whatever `from_ron` reads.
pub(super) fn parse_with<T>(
    path: &Path,
    text: &str,
    from_ron: impl Fn(&Located, &str) -> Result<T, SpannedError>,
) -> Result<(T, Located), Report> {
    let located = source::scan(path, text).map_err(|problem| Report(vec![problem]))?;
    check_version(path, &located).map_err(|problem| Report(vec![problem]))?;
    let mut problems = Vec::new();
    let mut left = text.to_owned();
    // Each unknown field costs one more pass, so a very long text gets fewer of them.
    let most_problems = (MOST_PARSED_BYTES / text.len().max(1)).clamp(1, limits::MAX_PROBLEMS);
    loop {
        let error = match from_ron(&located, &left) {
            Ok(read) if problems.is_empty() => return Ok((read, located)),
            Ok(_) => break,
            Err(error) => error,
        };
        if is_mistyped(&error, &problems) {
            break;
        }
        let offset = |at: Position| located.offset_in(&left, at.line, at.col);
        let span = (offset(error.span.start), offset(error.span.end));
        let unknown = match &error.code {
            ron::Error::NoSuchStructField { found, .. } => field_before(&located, &left, found, span.1),
            _ => None,
        };
        problems.push(explain(path, &located, &error.code, span, unknown));
        // An unknown field is blanked out, so that the parser goes on to the next fault and all positions stay valid.
        match unknown {
            Some(field) if problems.len() < most_problems => blank_out(&mut left, field),
            _ => break,
        }
    }
    Err(Report(problems))
}

/// Whether a field is missing only because its name was mistyped. The mistyped name is reported already.
fn is_mistyped(error: &SpannedError, problems: &[Problem]) -> bool {
    let ron::Error::MissingStructField { field, .. } = &error.code else { return false };
    let suggestion = did_you_mean(field);
    problems.iter().any(|problem| problem.mend.starts_with(&suggestion))
}

/// Checks the version. This check comes before all others, since a newer file may have any fields.
pub(super) fn check_version(path: &Path, located: &Located) -> Result<(), Problem> {
    let Inside::Fields(_) = &located.root().inside else { return Ok(()) };
    let place = |node: &Node| Some(located.place(node.start as usize));
    let current = Scene::VERSION;
    let Some(field) = version_field(located) else {
        let mend = format!("write `version: {current},` as the first field");
        return Err(error_in(path, place(located.root()), "the scene does not say its version", mend));
    };
    let digits = located.text_of(&field.value);
    match digits.parse::<u64>() {
        Ok(version) if version == u64::from(current) => Ok(()),
        Ok(0) => {
            let mend = format!("write `version: {current}`");
            Err(error_in(path, place(&field.value), "there is no version 0 of the scene file", mend))
        }
        Ok(version) => {
            let message = format!("this scene has version {version}, but this build reads {current}");
            Err(error_in(path, place(&field.value), message, "open it with a newer Impasto"))
        }
        Err(_) => {
            let message = format!("`{}` is no version", shorten(digits));
            Err(error_in(path, place(&field.value), message, format!("write `version: {current}`")))
        }
    }
}

pub(super) fn version_field(located: &Located) -> Option<&Field> {
    let Inside::Fields(fields) = &located.root().inside else { return None };
    fields.iter().find(|field| located.text_of(&field.key) == "version")
}

/// Whether a scene says that it is of a newer version than this build reads.
pub(super) fn is_newer(located: &Located) -> bool {
    let digits = version_field(located).map(|field| located.text_of(&field.value));
    digits.and_then(|digits| digits.parse::<u64>().ok()).is_some_and(|said| said > u64::from(Scene::VERSION))
}

/// Parses the document in `text`. `located` is the scan of this text before parts of it were blanked out.
pub(super) fn from_ron(located: &Located, text: &str) -> Result<Scene, SpannedError> {
    let scene: Scene = options().from_str(text)?;
    match left_to_shot(located, text).filter(|_| scene.shot.is_none()) {
        Some((field, at)) => {
            let TextPosition { line, column } = located.place(at);
            let at = Position { line, col: column };
            let code = ron::Error::MissingStructField { field, outer: None };
            Err(SpannedError { code, span: ron::error::Span { start: at, end: at } })
        }
        None => Ok(scene),
    }
}

/// How Impasto's files are written in RON.
pub(super) fn options() -> ron::Options {
    ron::Options::default()
        .with_default_extension(Extensions::IMPLICIT_SOME)
        .with_recursion_limit(2 * limits::MAX_NESTING)
}

/// The first missing field that only a scene with a shot may leave out: its name, and the offset at which it could be
/// added. Whether the scene has a shot is not checked here. A field that was blanked out counts as missing.
fn left_to_shot(located: &Located, text: &str) -> Option<(&'static str, usize)> {
    fn field<'a>(located: &'a Located, text: &str, node: &'a Node, name: &str) -> Option<&'a Node> {
        let Inside::Fields(fields) = &node.inside else { return None };
        let is_it = |field: &&Field| {
            located.text_of(&field.key) == name && !text[field.key.start as usize..].starts_with(' ')
        };
        fields.iter().find(is_it).map(|field| located.through_some(&field.value))
    }
    let lacks = |node: &Node, name: &'static str| {
        let is_struct = matches!(node.inside, Inside::Fields(_) | Inside::Nothing);
        let is_there = !is_struct || field(located, text, node, name).is_some();
        (!is_there).then_some((name, node.end.saturating_sub(1) as usize))
    };
    let root = located.root();
    if let Some(camera) = field(located, text, root, "camera")
        && let Some(lacking) = lacks(camera, "keys")
    {
        return Some(lacking);
    }
    if let Some(Node { inside: Inside::Items(objects), .. }) = field(located, text, root, "objects")
        && let Some(lacking) = objects.iter().find_map(|object| {
            let is_left = !text[object.start as usize..].starts_with(' ');
            is_left.then(|| lacks(object, "mesh")).flatten()
        })
    {
        return Some(lacking);
    }
    lacks(root, "camera").or_else(|| lacks(root, "objects"))
}

/// The last field named `found` that is not blanked out and begins before `end`, where the parser stopped.
pub(super) fn field_before<'a>(
    located: &'a Located,
    left: &str,
    found: &str,
    end: usize,
) -> Option<&'a Field> {
    let is_left = |field: &&Field| !left[field.key.start as usize..].starts_with(' ');
    let mut best: Option<&Field> = None;
    let mut open = vec![located.root()];
    while let Some(node) = open.pop() {
        match &node.inside {
            Inside::Nothing => {}
            Inside::Items(items) => open.extend(items.iter().filter(|item| reaches(item, end))),
            Inside::Fields(fields) => {
                open.extend(fields.iter().map(|field| &field.value).filter(|value| reaches(value, end)));
                let named = fields.iter().filter(|field| located.text_of(&field.key) == found);
                let before = named.filter(|field| field.key.start as usize <= end).filter(is_left);
                best = before.chain(best).max_by_key(|field| field.key.start);
            }
        }
    }
    best
}

fn reaches(node: &Node, offset: usize) -> bool {
    (node.start as usize..=node.end as usize).contains(&offset)
}

/// Overwrites a field, and the comma behind it, with spaces. Line ends and byte offsets stay.
pub(super) fn blank_out(text: &mut String, field: &Field) {
    let range = with_comma(text, field.key.start as usize..field.value.end as usize);
    blank_range(text, range);
}

/// A part of a text, together with the comma behind it if there is one.
pub(super) fn with_comma(text: &str, range: Range<usize>) -> Range<usize> {
    let behind = text[range.end..].trim_start();
    let end = if behind.starts_with(',') { text.len() - behind.len() + 1 } else { range.end };
    range.start..end
}

pub(super) fn blank_range(text: &mut String, range: Range<usize>) {
    let blank = |character: char| match character {
        '\n' => "\n".to_owned(),
        // As many bytes as before, so that byte offsets stay valid.
        character => " ".repeat(character.len_utf8()),
    };
    let blanked: String = text[range.clone()].chars().map(blank).collect();
    text.replace_range(range, &blanked);
}

/// The problem to report for an error of the parser between two offsets; `unknown` is the field that the parser does
/// not know.
pub(super) fn explain(
    path: &Path,
    located: &Located,
    error: &ron::Error,
    (start, end): (usize, usize),
    unknown: Option<&Field>,
) -> Problem {
    use ron::Error as E;
    let at = |offset: usize| Some(located.place(offset));
    match error {
        E::NoSuchStructField { expected, found, .. } => {
            let place = unknown.map_or(end, |field| field.key.start as usize);
            error_in(path, at(place), format!("unknown field `{}`", shorten(found)), one_of(found, expected))
        }
        E::NoSuchEnumVariant { expected, found, .. } => {
            let (field_path, place) = enclosing(located, start, end);
            let message = format!("{field_path} cannot be `{}`", shorten(found));
            error_in(path, at(place), message, one_of(found, expected))
        }
        E::MissingStructField { field, .. } => {
            let (field_path, place) = enclosing_struct(located, end);
            let mend = format!("add `{field}: …`, {}", what_goes_into(field).unwrap_or("it has no default"));
            error_in(path, at(place), format!("{field_path} has no `{field}`"), mend)
        }
        E::DuplicateStructField { field, .. } => {
            error_in(path, at(end), format!("the field `{field}` is given twice"), "keep one of them")
        }
        E::TrailingCharacters => {
            error_in(path, at(end), "there is more text behind the end of the scene", "remove it")
        }
        E::NoSuchExtension(name) => {
            let mend = "remove the line; only `#![enable(implicit_some)]` is of use here";
            error_in(path, at(end), format!("there is no RON extension `{}`", shorten(name)), mend)
        }
        E::ExpectedComma if !is_inside_value(located, end) => {
            error_in(path, at(end), "a comma is missing before this", "add `,` between the two values")
        }
        other => does_not_fit(path, located, (start, end), other),
    }
}

/// The problem to report for a value of the wrong kind, or for text that is not RON.
fn does_not_fit(path: &Path, located: &Located, span: (usize, usize), error: &ron::Error) -> Problem {
    let is_count = matches!(
        error,
        ron::Error::ExpectedDifferentLength { .. }
            | ron::Error::ExpectedStructLikeEnd
            | ron::Error::ExpectedArrayEnd
    );
    let (field_path, offset) = enclosing(located, span.0, span.1);
    let item_path = field_path.trim_matches('`');
    // Too many or too few values are a fault of their list, not of the last value.
    let holder = item_path.strip_suffix(']').filter(|_| is_count).and_then(|path| path.rsplit_once('['));
    let (field_path, node) = match holder.and_then(|(path, _)| Some((path, located.node_at(path)?))) {
        Some((path, node)) => (named(path), node),
        None => (field_path, located.innermost(offset).1),
    };
    let value: String = located.text_of(node).chars().take(1000).collect();
    let value = shorten(&value.split_whitespace().collect::<Vec<_>>().join(" "));
    let said = shorten(&lower_first(&error.to_string()));
    let field = field_path.trim_matches('`').rsplit('.').next().unwrap_or("");
    let field = field.split('[').next().unwrap_or("");
    let mend = what_goes_into(field).map_or_else(
        || "compare with a scene written by `impasto new`".to_owned(),
        |kind| format!("it takes {kind}"),
    );
    let message = format!("`{value}` does not fit {field_path} ({said})");
    error_in(path, Some(located.place(node.start as usize)), message, mend)
}

/// Whether the parser stopped within a number, a text or a name, as in `10.5` where a whole number belongs.
fn is_inside_value(located: &Located, offset: usize) -> bool {
    let (_, node) = located.innermost(offset);
    let own_end = match node.inside {
        Inside::Nothing => node.end as usize,
        // The name of a variant, up to its bracket.
        Inside::Items(_) | Inside::Fields(_) if node.name_bytes > 0 => {
            (node.start + node.name_bytes) as usize + 1
        }
        Inside::Items(_) | Inside::Fields(_) => return false,
    };
    (node.start as usize + 1..own_end).contains(&offset)
}

/// The value at which the parser failed: its path for a message, and its offset.
fn enclosing(located: &Located, start: usize, end: usize) -> (String, usize) {
    let (field_path, offset) = enclosing_path(located, start, end);
    (named(&field_path), offset)
}

/// The value at which the parser failed: its path, empty for the scene, and its offset.
pub(super) fn enclosing_path(located: &Located, start: usize, end: usize) -> (String, usize) {
    let behind = &located.text()[start.min(end)..];
    let blank = behind.len() - behind.trim_start().len();
    let first = (start.min(end) + blank).min(start.max(end));
    let (mut field_path, mut node) = located.innermost(first);
    if !matches!(node.inside, Inside::Nothing) {
        let (later_path, later) = located.innermost(end);
        if matches!(later.inside, Inside::Nothing) || later_path.len() > field_path.len() {
            (field_path, node) = (later_path, later);
        }
    }
    (field_path, node.start as usize)
}

/// The struct in whose brackets the parser stood: its path for a message, and its offset.
fn enclosing_struct(located: &Located, offset: usize) -> (String, usize) {
    let field_path = enclosing_struct_path(located, offset);
    let node = located.node_at(&field_path).unwrap_or(located.root());
    (named(&field_path), node.start as usize)
}

/// The path of the struct in whose brackets the parser stood, empty for the scene.
pub(super) fn enclosing_struct_path(located: &Located, offset: usize) -> String {
    let (mut field_path, mut node) = located.innermost(offset);
    let is_open = |node: &Node| {
        let is_bracketed = !matches!(node.inside, Inside::Nothing) && located.text_of(node).ends_with(')');
        is_bracketed && offset < node.end as usize
    };
    while !is_open(node) {
        let Some(cut) = field_path.rfind(['.', '[']).or((!field_path.is_empty()).then_some(0)) else { break };
        field_path.truncate(cut);
        node = located.node_at(&field_path).unwrap_or(located.root());
    }
    field_path
}

fn named(field_path: &str) -> String {
    if field_path.is_empty() { "the scene".to_owned() } else { format!("`{field_path}`") }
}

fn one_of(found: &str, expected: &[&str]) -> String {
    let known = expected.join(", ");
    match nearest(found, expected.iter().copied()) {
        Some(near) => format!("{} Known here: {known}", did_you_mean(near)),
        None => format!("known here: {known}"),
    }
}

fn did_you_mean(name: &str) -> String {
    format!("did you mean `{name}`?")
}

fn lower_first(text: &str) -> String {
    let mut characters = text.chars();
    characters.next().map_or_else(String::new, |first| first.to_lowercase().chain(characters).collect())
}

/// At most 80 characters of a text of any length, on one line.
fn shorten(text: &str) -> String {
    let mut short: String = text.chars().take(80).map(|c| if c.is_control() { ' ' } else { c }).collect();
    if short.len() < text.len() {
        short.push('…');
    }
    short
}
