//! `--set PATH=VALUE`: values from the command line replace those of the file.
//!
//! A value is inserted into the text, and the text is parsed again. So it may be anything that a file may hold there,
//! and errors of the parser are reported as errors of the command line.

use std::path::{Path, PathBuf};

use super::parse::{self, Parsed};
use super::source::error_in;
use crate::check::{self, Finding};
use crate::locate::{Inside, Located, Node, Step};
use crate::nearest::nearest;
use crate::problem::{Problem, Report};

/// A value that was put into the document.
#[derive(Debug)]
pub(super) struct Applied {
    /// The path of the field, written as in the findings of the checks: `objects[0].particles`.
    field_path: String,
    /// The whole option as the user wrote it, for messages.
    pub(super) option: PathBuf,
}

impl Applied {
    /// Whether a field is the one that was set, lies inside it, or contains it.
    pub(super) fn covers(&self, field_path: &str) -> bool {
        let holds = |outer: &str, inner: &str| {
            inner.strip_prefix(outer).is_some_and(|rest| rest.is_empty() || rest.starts_with(['.', '[']))
        };
        holds(&self.field_path, field_path) || holds(field_path, &self.field_path)
    }
}

pub(super) fn apply(
    mut parsed: Parsed,
    overrides: &[(String, String)],
) -> Result<(Parsed, Vec<Applied>), Report> {
    let mut applied = Vec::new();
    for (field_path, value) in overrides {
        let option = PathBuf::from(format!("--set {field_path}={value}"));
        let (next, field_path) = put_in(&parsed, field_path, value, &option)?;
        parsed = next;
        applied.push(Applied { field_path, option });
    }
    Ok((parsed, applied))
}

/// The text of a scene with values put in; the rest of the text stays as it is. A path that ends in `+` adds the value
/// to a list: at its end, or before the item that the path names, as in `regions[2]+`. An empty value removes the field
/// or the item. `path` is for messages only.
///
/// # Errors
/// The text is no scene, a path leads nowhere, or a value does not fit or brings a new fatal finding.
pub fn edited_text(path: &Path, text: &str, values: &[(String, String)]) -> Result<String, Report> {
    let mut parsed = parse::parse(path, text)?;
    let known: Vec<Finding> = fatal_findings(&parsed);
    for (field_path, value) in values {
        let option = PathBuf::from(format!("{field_path}={value}"));
        let refused = |(message, mend): Fault| Report(vec![error_in(&option, None, message, mend)]);
        let field_path = field_path.trim();
        parsed = if let Some(list) = field_path.strip_suffix('+') {
            let spot = end_of_list(&parsed.located, list.trim()).map_err(refused)?;
            put_at(&parsed, &spot, value, &option)?
        } else if value.trim().is_empty() {
            let Some(without) = without_field(&parsed.located, field_path).map_err(refused)? else {
                continue;
            };
            parse::parse(&option, &without)?
        } else {
            put_in(&parsed, field_path, value, &option)?.0
        };
    }
    // Values that bring a new fatal finding are refused. Fatal findings that the text had before do not count.
    let found = fatal_findings(&parsed).into_iter().find(|finding| !known.contains(finding));
    match found {
        None => Ok(parsed.located.text().to_owned()),
        Some(Finding { field_path, message, mend, .. }) => {
            Err(Report(vec![error_in(path, None, format!("{field_path}: {message}"), mend)]))
        }
    }
}

/// The fatal findings of the checks that need only the document, not its files.
fn fatal_findings(parsed: &Parsed) -> Vec<Finding> {
    check::check(&parsed.scene).into_iter().filter(|finding| finding.severity.is_fatal()).collect()
}

/// Where a new item goes: at the end of a list, or before the item that `field_path` names.
fn end_of_list(located: &Located, field_path: &str) -> Result<Spot, Fault> {
    let spot = find_spot(located, field_path)?;
    if spot.start == spot.end {
        // The file leaves the list out.
        return Ok(Spot { before: spot.before + "[", after: format!("]{}", spot.after), ..spot });
    }
    let text = &located.text()[spot.start..spot.end];
    if spot.field_path.ends_with(']') && !text.starts_with('[') {
        return Ok(before_item(located, spot));
    }
    let Some(inside) = text.strip_prefix('[').and_then(|rest| rest.strip_suffix(']')) else {
        return Err((format!("`{field_path}` is no list"), "set it as a whole, without `+`".to_owned()));
    };
    // The new item goes right behind the last one, which a comma and a comment may follow.
    let last = match located.node_at(&spot.field_path).map(|node| &located.through_some(node).inside) {
        Some(Inside::Items(items)) => items.last().map(|item| item.end as usize),
        _ => None,
    };
    let Some(last) = last else {
        return Ok(Spot { start: spot.start + 1, end: spot.end - 1, ..spot });
    };
    Ok(Spot { start: last, end: last, before: format!(",{}", gap_in(inside)), ..spot })
}

/// Where a new item goes before the one at `spot`.
fn before_item(located: &Located, spot: Spot) -> Spot {
    let head = &located.text()[..spot.start];
    let blank = &head[head.trim_end().len()..];
    let gap = if blank.contains('\n') { gap_in(blank) } else { " ".to_owned() };
    Spot { end: spot.start, after: format!(",{gap}"), ..spot }
}

/// What to write between two items or fields of a value. `inside` begins with the blanks in front of an item or field.
/// If these blanks hold a line end, returns a line end and the same indent; else a space.
fn gap_in(inside: &str) -> String {
    let lead = inside.trim_start_matches([' ', '\t', '\r', '\n']);
    let blank = &inside[..inside.len() - lead.len()];
    blank.rsplit_once('\n').map_or_else(|| " ".to_owned(), |(_, indent)| format!("\n{indent}"))
}

/// The text without a field or an item of a list; `None` if the text does not state it.
fn without_field(located: &Located, field_path: &str) -> Result<Option<String>, Fault> {
    let spot = find_spot(located, field_path)?;
    if spot.start == spot.end {
        return Ok(None);
    }
    let text = located.text();
    let head = text[..spot.start].trim_end();
    let start = match head.strip_suffix(':') {
        Some(head) => head.trim_end_matches(|letter: char| letter.is_alphanumeric() || letter == '_').len(),
        // An item of a list.
        None if spot.field_path.ends_with(']') => spot.start,
        None => {
            return Err((format!("`{field_path}` is no field"), "name the field to take out".to_owned()));
        }
    };
    let (mut start, mut end) = (start, spot.end);
    let behind = &text[end..];
    if let Some(rest) = behind.trim_start().strip_prefix(',') {
        end = text.len() - rest.len();
        // If the field fills a line, the whole line goes.
        let line = text[..start].trim_end_matches([' ', '\t']);
        if line.ends_with('\n') && rest.trim_start_matches([' ', '\t', '\r']).starts_with('\n') {
            start = line.len();
            end = text.len() - rest.len() + rest.find('\n').map_or(0, |at| at + 1);
        } else {
            end += rest.len() - rest.trim_start_matches(' ').len();
        }
    } else if let Some(before) = text[..start].trim_end().strip_suffix(',') {
        start = before.len();
    }
    Ok(Some(format!("{}{}", &text[..start], &text[end..])))
}

fn put_in(parsed: &Parsed, field_path: &str, value: &str, option: &Path) -> Result<(Parsed, String), Report> {
    let refused = |(message, mend): Fault| Report(vec![error_in(option, None, message, mend)]);
    let spot = find_spot(&parsed.located, field_path.trim()).map_err(refused)?;
    Ok((put_at(parsed, &spot, value, option)?, spot.field_path))
}

fn put_at(parsed: &Parsed, spot: &Spot, value: &str, option: &Path) -> Result<Parsed, Report> {
    let mut first_report = None;
    for candidate in candidates(value) {
        let text = spot.with(parsed.located.text(), &candidate);
        match parse::parse(option, &text) {
            Ok(parsed) => return Ok(parsed),
            Err(report) => {
                first_report.get_or_insert(report);
            }
        }
    }
    let problems = first_report.map_or_else(Vec::new, |report| report.0);
    // A line and a column make no sense for the command line.
    Err(Report(problems.into_iter().map(|problem| Problem { place: None, ..problem }).collect()))
}

/// The texts to try for a value, in order: the value as it is, if it is a single RON value, then the value between
/// quotes, so that a user can write text without quoting it for RON.
fn candidates(value: &str) -> Vec<String> {
    let value = value.trim();
    let as_it_is = Located::scan(value).ok().map(|located| located.text_of(located.root()).to_owned());
    let quoted = format!("\"{}\"", value.replace('\\', "\\\\").replace('"', "\\\"").replace('\n', "\\n"));
    as_it_is.into_iter().chain([quoted]).collect()
}

/// An error message, and what to do about the error.
type Fault = (String, String);

/// Where a value goes: the bytes that it replaces, and what is written around it.
#[derive(Debug, Default)]
struct Spot {
    start: usize,
    end: usize,
    before: String,
    after: String,
    field_path: String,
}

impl Spot {
    fn with(&self, text: &str, value: &str) -> String {
        let (head, tail) = (&text[..self.start], &text[self.end..]);
        format!("{head}{}{value}{}{tail}", self.before, self.after)
    }
}

/// Where the value of a field goes: in place of its old value, or into a new field if the file leaves the field out.
fn find_spot(located: &Located, field_path: &str) -> Result<Spot, Fault> {
    let mut node = located.root();
    let mut rest = field_path;
    let mut known = String::new();
    if rest.is_empty() {
        return Err(("no field is named".to_owned(), "write it as in strokes.width_px=12".to_owned()));
    }
    loop {
        node = located.through_some(node);
        rest = rest.trim_start_matches('.');
        if rest.is_empty() {
            let (start, end) = (node.start as usize, node.end as usize);
            return Ok(Spot { start, end, field_path: known, ..Spot::default() });
        }
        let (segment, behind) = first_segment(rest);
        let name = located.name_of(node);
        if is_variant(segment) && !name.is_empty() {
            if name != segment {
                let mend = format!("set {known}={segment}(…) as a whole");
                return Err((format!("`{known}` is {name}, not {segment}"), mend));
            }
            rest = behind;
            continue;
        }
        match &node.inside {
            Inside::Items(items) if is_list(located, node) => {
                let (index, behind) = item(located, items, rest).map_err(|mend| {
                    (format!("`{known}` has no item `{}`", segment.trim_matches(['[', ']'])), mend)
                })?;
                known.push_str(&format!("[{index}]"));
                (node, rest) = (&items[index], behind);
            }
            Inside::Nothing => {
                let mend = "name the field that holds the value".to_owned();
                return Err((format!("`{known}` has no field `{segment}`"), mend));
            }
            Inside::Items(_) | Inside::Fields(_) => {
                if !known.is_empty() {
                    known.push('.');
                }
                known.push_str(segment);
                match located.child(node, Step::Field(segment)) {
                    Some(child) => (node, rest) = (child, behind),
                    None => return new_field(located, node, rest, known),
                }
            }
        }
    }
}

/// The spot for a field that the file leaves out. If the file leaves out fields around it too, they are added with it.
fn new_field(located: &Located, node: &Node, field_path: &str, known: String) -> Result<Spot, Fault> {
    let name_end = (node.start + node.name_bytes) as usize;
    let Some(bracket) = located.text()[name_end..node.end as usize].find('(') else {
        return Err((format!("`{known}` cannot be added"), "write it into the scene file".to_owned()));
    };
    let at = name_end + bracket + 1;
    let mut spot = match &node.inside {
        Inside::Fields(fields) if !fields.is_empty() => after_last(located, node, at),
        _ => Spot { start: at, end: at, ..Spot::default() },
    };
    spot.field_path = known;
    let mut is_first = true;
    let mut rest = field_path;
    while !rest.is_empty() {
        let (segment, behind) = first_segment(rest);
        if segment.is_empty() || segment.starts_with('[') {
            let message = format!("`{field_path}` is a list that the file leaves out");
            return Err((message, "write it into the scene file".to_owned()));
        }
        if is_variant(segment) {
            spot.before.push_str(segment);
        } else {
            let is_inside = !is_first;
            if is_inside {
                spot.field_path.push('.');
                spot.field_path.push_str(segment);
                spot.before.push('(');
                spot.after.insert(0, ')');
            }
            spot.before.push_str(segment);
            spot.before.push_str(": ");
        }
        is_first = false;
        if let Some((_, variant)) = DEFAULT_VARIANTS.iter().find(|(field, _)| *field == segment) {
            let is_stated = is_variant(behind.trim_start_matches('.')) || behind.is_empty();
            spot.before.push_str(if is_stated { "" } else { variant });
        }
        rest = behind.trim_start_matches('.');
    }
    Ok(spot)
}

/// The spot behind the last field of a struct; `inside` is the offset behind its opening bracket.
fn after_last(located: &Located, node: &Node, inside: usize) -> Spot {
    let text = located.text();
    let gap = gap_in(&text[inside..node.end as usize]);
    let Inside::Fields(fields) = &node.inside else { return Spot::default() };
    let last = fields.iter().map(|field| field.value.end as usize).max().unwrap_or(inside);
    // A comment at the end of the last field's line belongs to that field, so the new field goes behind the comment.
    let tail = &text[last..node.end as usize];
    let line = tail.split('\n').next().unwrap_or_default();
    if tail.trim_start().starts_with(',') && line.contains("//") && gap.starts_with('\n') {
        let at = last + line.trim_end().len();
        return Spot { start: at, end: at, before: gap, after: ",".to_owned(), ..Spot::default() };
    }
    Spot { start: last, end: last, before: format!(",{gap}"), ..Spot::default() }
}

/// Fields that hold a variant and may be left out, each with the variant that is then meant. If a field inside the
/// variant is set while the file leaves the variant out, the variant is written around that field.
const DEFAULT_VARIANTS: [(&str, &str); 2] = [("style", "RotatingStrokes"), ("lens", "Perspective")];

/// Whether a segment names a variant: it begins with a capital, like `RotatingStrokes` in
/// `style.RotatingStrokes.solver`.
fn is_variant(segment: &str) -> bool {
    segment.starts_with(|first: char| first.is_ascii_uppercase())
}

/// Whether a value has items that an index can name: it is a list, a tuple or what a variant holds, but not `()`, which
/// is a struct with all its fields left out.
fn is_list(located: &Located, node: &Node) -> bool {
    let is_empty = matches!(&node.inside, Inside::Items(items) if items.is_empty());
    !(is_empty && located.text_of(node).ends_with(')'))
}

/// The first segment of a path, which ends before the next `.` or `[`, and the rest. An index keeps its brackets.
fn first_segment(field_path: &str) -> (&str, &str) {
    let from = usize::from(field_path.starts_with('['));
    let end = field_path[from..].find(['.', '[']).map_or(field_path.len(), |at| from + at);
    field_path.split_at(end)
}

/// The item that a path starts with, by index or by name, and the path behind it. A name may hold dots.
fn item<'a>(located: &Located, items: &[Node], field_path: &'a str) -> Result<(usize, &'a str), String> {
    if let Some((index, behind)) = field_path.strip_prefix('[').and_then(|rest| rest.split_once(']')) {
        return match index.trim().parse::<usize>() {
            Ok(index) if index < items.len() => Ok((index, behind)),
            _ => Err(format!("it has {}, counted from 0", items.len())),
        };
    }
    let names: Vec<String> = items
        .iter()
        .map(|item| {
            let name = located.child(item, Step::Field("name")).map(|name| located.text_of(name));
            name.and_then(|quoted| ron::from_str(quoted).ok()).unwrap_or_default()
        })
        .collect();
    let behind = |name: &str| {
        let rest = field_path.strip_prefix(name)?;
        (rest.is_empty() || rest.starts_with(['.', '['])).then_some(rest)
    };
    let named = names.iter().enumerate().filter(|(_, name)| !name.is_empty());
    let found = named.filter_map(|(index, name)| Some((index, behind(name)?)));
    found.min_by_key(|(_, rest)| rest.len()).ok_or_else(|| {
        let (segment, _) = first_segment(field_path);
        match nearest(segment, names.iter().map(String::as_str)) {
            Some(near) => format!("did you mean `{near}`?"),
            None => "name one of its items, or give an index as in [0]".to_owned(),
        }
    })
}
