//! Fixes for losses, the parts of a scene file that could not be read. A fix is the text of a button, and edits of the
//! file's text.

use std::ops::Range;

use crate::locate::{Field, Inside, Located, Node};

/// The most letters in which a mistyped name may differ from the one that was meant.
const NEAR: usize = 2;

/// A change of the text that mends a loss.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fix {
    /// The text of the button: *Rename*, *Use leaf.obj*.
    pub verb: String,
    /// Whether the fix is certainly what was meant, and not a guess.
    pub is_certain: bool,
    /// The ranges to replace, with the new text.
    pub(super) edits: Vec<(Range<usize>, String)>,
}

/// A text with fixes applied. An edit is skipped if its range is not in the text (the fix was found in another text),
/// or if it overlaps an edit further on in the text.
pub fn mended(text: &str, fixes: &[&Fix]) -> String {
    let mut edits: Vec<&(Range<usize>, String)> = fixes.iter().flat_map(|fix| &fix.edits).collect();
    edits.sort_by_key(|(range, _)| std::cmp::Reverse(range.start));
    let mut mended = text.to_owned();
    let mut last = usize::MAX;
    for (range, written) in edits {
        if range.end <= last && mended.get(range.clone()).is_some() {
            mended.replace_range(range.clone(), written);
            last = range.start;
        }
    }
    mended
}

/// A fix that renames an unknown field to the one known name near it; `None` where there is no such name, or several,
/// or where a field of that name is given already.
pub(super) fn renamed(located: &Located, field: &Field, error: &ron::Error) -> Option<Fix> {
    let ron::Error::NoSuchStructField { expected, found, .. } = error else { return None };
    let near: Vec<&str> = expected.iter().copied().filter(|known| is_near(known, found)).collect();
    let holder = holder_of(located.root(), field)?;
    let is_given = |name: &str| holder.iter().any(|other| located.text_of(&other.key) == name);
    let [meant] = near[..] else { return None };
    (!is_given(meant)).then(|| Fix {
        verb: "Rename".to_owned(),
        is_certain: true,
        edits: vec![(field.key.start as usize..field.key.end as usize, meant.to_owned())],
    })
}

/// Whether one of two names may be the other one, mistyped.
pub(super) fn is_near(name: &str, other: &str) -> bool {
    name.len() <= 64 && other.len() <= 64 && strsim::damerau_levenshtein(name, other) <= NEAR
}

/// All fields of the value that a field belongs to.
fn holder_of<'a>(root: &'a Node, field: &Field) -> Option<&'a [Field]> {
    let holds = |node: &Node| (node.start..node.end).contains(&field.key.start);
    let mut node = root;
    loop {
        match &node.inside {
            Inside::Nothing => return None,
            Inside::Items(items) => node = items.iter().find(|item| holds(item))?,
            Inside::Fields(fields) => {
                if fields.iter().any(|other| other.key.start == field.key.start) {
                    return Some(fields);
                }
                node = &fields.iter().find(|other| holds(&other.value))?.value;
            }
        }
    }
}
