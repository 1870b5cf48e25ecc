//! Finds values in the text of a scene file: a tolerant scan of RON into a tree of positions.
//!
//! The scan knows brackets, names, strings and comments, but no types. It has three uses: problems get a line and a
//! column; text that would harm the real parser is refused beforehand (endless nesting, numbers of a million digits);
//! and `--set` finds the text that it replaces.

use crate::limits;
use crate::problem::TextPosition;

mod scan;

/// The tree of one scene file and the text that it was read from, without byte order mark.
#[derive(Clone, Debug)]
pub struct Located {
    text: String,
    /// Byte offset of the start of each line.
    line_starts: Vec<usize>,
    root: Node,
}

/// One value: its range in the text, and its contents. Offsets are in bytes.
#[derive(Clone, Debug)]
pub(crate) struct Node {
    pub(crate) start: u32,
    pub(crate) end: u32,
    /// Length in bytes of the name in front of the bracket, as in `Frame(0)`, or of a name or number that has no
    /// bracket; else 0.
    pub(crate) name_bytes: u32,
    pub(crate) inside: Inside,
}

#[derive(Clone, Debug)]
pub(crate) enum Inside {
    /// A number, a text, a name.
    Nothing,
    /// Values without names, in `[…]`, `(…)` or `{…}`.
    Items(Vec<Node>),
    /// `name: value` pairs.
    Fields(Vec<Field>),
}

/// One `name: value` pair.
#[derive(Clone, Debug)]
pub(crate) struct Field {
    pub(crate) key: Node,
    pub(crate) value: Node,
}

/// Why the scan refuses a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Refused {
    pub(crate) offset: usize,
    pub(crate) message: String,
    pub(crate) mend: String,
    pub(crate) is_limit: bool,
}

impl Located {
    /// The values of a text; `None` if it is too long or cannot be scanned.
    pub fn of(text: &str) -> Option<Self> {
        (text.len() as u64 <= limits::MAX_SCENE_BYTES).then(|| Self::scan(text).ok())?
    }

    /// Scans a whole file. The text must not be longer than [`limits::MAX_SCENE_BYTES`].
    pub(crate) fn scan(text: &str) -> Result<Self, Refused> {
        let root = scan::file(text)?;
        Ok(Self { text: text.to_owned(), line_starts: line_starts(text), root })
    }

    pub(crate) fn text(&self) -> &str {
        &self.text
    }

    pub(crate) fn root(&self) -> &Node {
        &self.root
    }

    pub(crate) fn text_of(&self, node: &Node) -> &str {
        &self.text[node.start as usize..node.end as usize]
    }

    /// The name that a value starts with, as in `Frame(0)`; empty without one.
    pub(crate) fn name_of(&self, node: &Node) -> &str {
        let start = node.start as usize;
        &self.text[start..start + node.name_bytes as usize]
    }

    /// Line and column of a byte offset.
    pub(crate) fn place(&self, offset: usize) -> TextPosition {
        place_in(&self.text, &self.line_starts, offset)
    }

    /// The byte offset in `text` of a line and a column, both counted from 1. The lines of `text` must begin at the
    /// same bytes as those of the scanned text. A place beyond the end of `text` gives its end.
    pub(crate) fn offset_in(&self, text: &str, line: usize, column: usize) -> usize {
        let Some(&start) = self.line_starts.get(line.saturating_sub(1)) else { return text.len() };
        let rest = &text[start..];
        rest.char_indices().nth(column.saturating_sub(1)).map_or(text.len(), |(at, _)| start + at)
    }

    /// The position of a field such as `objects[2].keys[1].frame`. If the file leaves the field out, gives the position
    /// of the innermost value around it that the file has.
    pub fn place_of(&self, field_path: &str) -> TextPosition {
        let mut node = &self.root;
        for step in Step::split(field_path) {
            match self.child(node, step) {
                Some(child) => node = child,
                None => break,
            }
        }
        self.place(node.start as usize)
    }

    /// The value of a field; `None` where the file leaves it out.
    pub(crate) fn node_at(&self, field_path: &str) -> Option<&Node> {
        Step::split(field_path).try_fold(&self.root, |node, step| self.child(node, step))
    }

    /// The value one step inside another. If the outer value is `Some(…)`, the step starts inside that.
    pub(crate) fn child<'a>(&'a self, node: &'a Node, step: Step<'_>) -> Option<&'a Node> {
        match (&self.through_some(node).inside, step) {
            (Inside::Fields(fields), Step::Field(name)) => {
                fields.iter().find(|field| self.text_of(&field.key) == name).map(|field| &field.value)
            }
            (Inside::Items(items), Step::Index(index)) => items.get(index),
            _ => None,
        }
    }

    /// The value inside `Some(…)`; any other value is returned as it is.
    pub(crate) fn through_some<'a>(&'a self, node: &'a Node) -> &'a Node {
        match &node.inside {
            Inside::Items(items) if items.len() == 1 && self.name_of(node) == "Some" => &items[0],
            _ => node,
        }
    }

    /// The innermost value round a byte offset, and the path to it. An offset just behind a value counts as inside.
    pub(crate) fn innermost(&self, offset: usize) -> (String, &Node) {
        let mut path = String::new();
        let mut node = &self.root;
        let holds = |node: &Node| (node.start as usize..=node.end as usize).contains(&offset);
        loop {
            let next = match &node.inside {
                Inside::Nothing => None,
                Inside::Items(items) => {
                    // The first value that ends at the offset or behind it. It may even start behind the offset.
                    let index = items.partition_point(|item| (item.end as usize) < offset);
                    items.get(index).filter(|item| holds(item)).inspect(|_| {
                        // In field paths, a value inside a variant such as `Frame(0)` has no index.
                        let is_variant = node.name_bytes > 0;
                        if !is_variant {
                            path.push_str(&format!("[{index}]"));
                        }
                    })
                }
                Inside::Fields(fields) => {
                    let index = fields.partition_point(|field| (field.value.end as usize) < offset);
                    fields.get(index).filter(|field| holds(&field.value)).map(|field| {
                        if !path.is_empty() {
                            path.push('.');
                        }
                        path.push_str(self.text_of(&field.key));
                        &field.value
                    })
                }
            };
            match next {
                Some(inner) => node = inner,
                None => return (path, node),
            }
        }
    }
}

/// One step of a field path.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Step<'a> {
    Field(&'a str),
    Index(usize),
}

impl<'a> Step<'a> {
    /// The steps of a path: `objects[2].name` is the field `objects`, the item 2, the field `name`. The steps end
    /// before an index that is not a number.
    pub(crate) fn split(field_path: &'a str) -> impl Iterator<Item = Step<'a>> {
        field_path.split(['.', '[']).filter(|part| !part.is_empty()).map_while(|part| {
            match part.strip_suffix(']') {
                Some(index) => index.parse().ok().map(Step::Index),
                None => Some(Step::Field(part)),
            }
        })
    }
}

/// Byte offset of the start of each line.
pub(crate) fn line_starts(text: &str) -> Vec<usize> {
    std::iter::once(0).chain(text.match_indices('\n').map(|(at, _)| at + 1)).collect()
}

/// Line and column of a byte offset.
pub(crate) fn place_in(text: &str, line_starts: &[usize], offset: usize) -> TextPosition {
    let mut offset = offset.min(text.len());
    while !text.is_char_boundary(offset) {
        offset -= 1;
    }
    let line = line_starts.partition_point(|&start| start <= offset).max(1);
    TextPosition { line, column: 1 + text[line_starts[line - 1]..offset].chars().count() }
}

impl Refused {
    fn error(offset: usize, message: impl Into<String>, mend: impl Into<String>) -> Self {
        Self { offset, message: message.into(), mend: mend.into(), is_limit: false }
    }

    fn limit(offset: usize, message: impl Into<String>, mend: impl Into<String>) -> Self {
        Self { is_limit: true, ..Self::error(offset, message, mend) }
    }

    fn too_deep(offset: usize, what: &str) -> Self {
        let message = format!("{what} lie more than {} deep inside each other", limits::MAX_NESTING);
        Self::error(offset, message, "no scene needs that; look for a bracket that is never closed")
    }
}
