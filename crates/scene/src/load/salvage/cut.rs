//! Saves the readable part of a broken scene: ends its text before an error in the brackets, so that everything before
//! the error can be read.

/// A text that was ended early.
pub(super) struct Cut {
    /// The text before the error, with every bracket closed.
    pub(super) text: String,
    /// Offset in the whole text up to which it was read, bytes.
    pub(super) read_to: usize,
    /// About how many objects are in the text that was cut off.
    pub(super) objects_behind: usize,
}

/// A bracket that is open.
struct Open {
    byte: u8,
    /// Where the item that is read now begins: behind the bracket, or behind the last comma in it.
    item_start: usize,
    /// Whether it holds `name: value` pairs.
    has_fields: bool,
    /// Whether the item that is read now has its colon.
    has_colon: bool,
}

/// Ends a text before the offset `fault`, or earlier where a closing bracket must have been forgotten. If `fault` is at
/// a bracket that is never closed, the text after it may be kept too. `None` if no bracket opens before the cut, or if
/// nothing would be cut or closed.
pub(super) fn before(text: &str, fault: usize) -> Option<Cut> {
    let bytes = text.as_bytes();
    // A bracket that is never closed is reported at its opening; the text behind it may be good to the end.
    let is_unclosed = matches!(bytes.get(fault), Some(b'(' | b'[' | b'{'));
    let end = if is_unclosed { bytes.len() } else { fault };
    let mut open: Vec<Open> = Vec::new();
    let mut at = 0;
    let mut read_to = end;
    while at < end {
        match bytes[at] {
            b'"' => {
                let Some(behind) = behind_text(bytes, at) else {
                    read_to = at;
                    break;
                };
                at = behind;
                continue;
            }
            b'/' if bytes.get(at + 1) == Some(&b'/') => {
                at += text[at..].find('\n').unwrap_or(text.len() - at);
                continue;
            }
            b'/' if bytes.get(at + 1) == Some(&b'*') => {
                let Some(behind) = behind_comment(bytes, at) else {
                    read_to = at;
                    break;
                };
                at = behind;
                continue;
            }
            // An attribute before the scene: `#![enable(…)]`.
            b'#' if open.is_empty() => {
                at += text[at..].find(']').map_or(1, |length| length + 1);
                continue;
            }
            byte @ (b'(' | b'[' | b'{') => {
                if let Some(outer) = open.last()
                    && outer.byte == b'('
                    && outer.has_fields
                    && !outer.has_colon
                {
                    // A value without a name among fields: the bracket before it was meant to be closed.
                    read_to = at;
                    break;
                }
                open.push(Open { byte, item_start: at + 1, has_fields: false, has_colon: false });
            }
            b')' | b']' | b'}' => {
                open.pop();
                if open.is_empty() {
                    // Whatever follows the scene is no part of it.
                    return (at + 1 < text.len()).then(|| Cut {
                        text: text[..=at].to_owned(),
                        read_to: at + 1,
                        objects_behind: objects_in(&text[at + 1..]),
                    });
                }
            }
            b',' => {
                if let Some(open) = open.last_mut() {
                    (open.item_start, open.has_colon) = (at + 1, false);
                }
            }
            b':' => {
                if let Some(open) = open.last_mut() {
                    (open.has_fields, open.has_colon) = (true, true);
                }
            }
            _ => {}
        }
        at += 1;
    }
    let read_to = if text.is_char_boundary(read_to) { read_to } else { at };
    let inner = open.last()?;
    // The last item in the innermost open bracket is dropped, unless it is whole and only the bracket is not closed.
    let is_whole = match inner.byte {
        b'(' => inner.has_colon && !text[..end].trim_end().ends_with(':'),
        _ => true,
    };
    let keep_to = if is_unclosed && read_to == end && is_whole { end } else { inner.item_start };
    let mut kept = text[..keep_to.min(read_to)].to_owned();
    if keep_to == end {
        kept.push('\n');
    }
    kept.extend(open.iter().rev().map(|open| char::from(closing_of(open.byte))));
    (kept.len() < text.len() + open.len() + 2 && kept != text).then(|| Cut {
        text: kept,
        read_to,
        objects_behind: objects_in(&text[keep_to.min(read_to)..]),
    })
}

fn closing_of(opening: u8) -> u8 {
    match opening {
        b'(' => b')',
        b'[' => b']',
        _ => b'}',
    }
}

/// The index behind the block comment that opens at `opened_at` and may hold other comments; `None` if it is never
/// closed.
fn behind_comment(bytes: &[u8], opened_at: usize) -> Option<usize> {
    let (mut open, mut at) = (0usize, opened_at);
    loop {
        match bytes.get(at..at + 2)? {
            b"/*" => (open, at) = (open + 1, at + 2),
            b"*/" => (open, at) = (open - 1, at + 2),
            _ => at += 1,
        }
        if open == 0 {
            return Some(at);
        }
    }
}

/// The offset behind the closing quote of the string (perhaps a raw string) that opens at `quote`. `None` if nothing
/// closes it.
fn behind_text(bytes: &[u8], quote: usize) -> Option<usize> {
    let hashes = bytes[..quote].iter().rev().take_while(|&&byte| byte == b'#').count();
    let is_raw = bytes[..quote - hashes].last() == Some(&b'r');
    let mut at = quote + 1;
    while let Some(&byte) = bytes.get(at) {
        match byte {
            b'\\' if !is_raw => at += 2,
            b'"' => {
                let closes =
                    !is_raw || bytes[at + 1..].iter().take_while(|&&byte| byte == b'#').count() >= hashes;
                at += 1;
                if closes {
                    return Some(at + if is_raw { hashes } else { 0 });
                }
            }
            _ => at += 1,
        }
    }
    None
}

/// How many objects a text describes: each has one `mesh` field.
fn objects_in(text: &str) -> usize {
    text.matches("mesh:").count()
}
