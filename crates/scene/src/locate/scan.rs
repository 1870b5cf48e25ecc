//! Scans the text of a scene file into the tree of positions, in one pass over the bytes. It recurses for nested
//! brackets, at most [`limits::MAX_NESTING`] deep.

use super::{Field, Inside, Node, Refused};
use crate::limits;

/// Scans a file: attributes, then one value, then nothing but white space and comments.
pub(super) fn file(text: &str) -> Result<Node, Refused> {
    let mut scanner = Scanner { text, bytes: text.as_bytes(), at: 0, values: 0 };
    scanner.skip_blank()?;
    while scanner.rest().starts_with(b"#") {
        scanner.at += 1;
        if scanner.rest().starts_with(b"!") {
            scanner.at += 1;
        }
        scanner.skip_blank()?;
        scanner.value(0)?;
        scanner.skip_blank()?;
    }
    if scanner.rest().is_empty() {
        let mend = "start with `(version: 1, camera: (…), objects: […])`";
        return Err(Refused::error(0, "the file holds no scene", mend));
    }
    if scanner.rest()[0] == b'{' {
        let mend = "a scene is written in RON: `(version: 1, …)`, names without quotes, round brackets";
        return Err(Refused::error(scanner.at, "this looks like JSON", mend));
    }
    let root = scanner.value(0)?;
    scanner.skip_blank()?;
    if !scanner.rest().is_empty() {
        let message = "there is more text behind the end of the scene";
        return Err(Refused::error(scanner.at, message, "look for a closing bracket too many before it"));
    }
    Ok(root)
}

struct Scanner<'a> {
    text: &'a str,
    bytes: &'a [u8],
    at: usize,
    values: usize,
}

impl<'a> Scanner<'a> {
    fn rest(&self) -> &'a [u8] {
        &self.bytes[self.at..]
    }

    /// Scans one value. The scanner must be at the value's first character, and then stands behind its last one.
    fn value(&mut self, depth: usize) -> Result<Node, Refused> {
        self.values += 1;
        if self.values > limits::MAX_VALUES {
            let message = format!("the file holds more than {} values", limits::MAX_VALUES);
            return Err(Refused::limit(self.at, message, "split the scene, or leave keys out"));
        }
        let start = self.at;
        if let Some(string_end) = self.string_end()? {
            self.at = string_end;
            return Ok(node(start, string_end, 0, Inside::Nothing));
        }
        let name_bytes = self.skip_word()?;
        let after_word = self.at;
        if name_bytes > 0 {
            self.skip_blank()?;
        }
        let opening = self.rest().first().copied();
        let may_open = name_bytes == 0 || opening == Some(b'(');
        match opening {
            Some(b'(' | b'[' | b'{') if may_open => {
                let inside = self.bracketed(depth)?;
                Ok(node(start, self.at, name_bytes, inside))
            }
            _ if name_bytes > 0 => {
                self.at = after_word;
                Ok(node(start, after_word, name_bytes, Inside::Nothing))
            }
            _ => {
                let stray = self.text[start..].chars().next().unwrap_or('\0');
                Err(stray_character(start, stray))
            }
        }
    }

    /// Scans what brackets hold. The scanner must be at the opening bracket, and then stands behind the closing one.
    fn bracketed(&mut self, depth: usize) -> Result<Inside, Refused> {
        let opened_at = self.at;
        if depth >= limits::MAX_NESTING {
            return Err(Refused::too_deep(opened_at, "brackets"));
        }
        let opening = self.bytes[opened_at];
        let closing = closing_of(opening);
        self.at += 1;
        let mut items: Vec<Node> = Vec::new();
        let mut fields: Vec<Field> = Vec::new();
        loop {
            self.skip_blank()?;
            let Some(&byte) = self.rest().first() else {
                let message = format!("this `{}` is never closed", char::from(opening));
                let mend = format!("add the missing `{}`", char::from(closing));
                return Err(Refused::error(opened_at, message, mend));
            };
            if byte == closing {
                self.at += 1;
                break;
            }
            if matches!(byte, b')' | b']' | b'}') {
                return Err(wrong_closing(self.at, opening, byte));
            }
            if byte == b',' || byte == b':' {
                self.at += 1;
                continue;
            }
            let key = self.value(depth + 1)?;
            self.skip_blank()?;
            if self.rest().first() == Some(&b':') {
                self.at += 1;
                self.skip_blank()?;
                match self.rest().first() {
                    Some(b')' | b']' | b'}' | b',') | None => items.push(key),
                    Some(_) => fields.push(Field { value: self.value(depth + 1)?, key }),
                }
            } else {
                items.push(key);
            }
        }
        // Brackets that hold both fields and unnamed values are not valid RON; the parser reports them. Only the fields
        // are kept here.
        Ok(if fields.is_empty() { Inside::Items(items) } else { Inside::Fields(fields) })
    }

    /// Skips a number or a name; returns its length in bytes, 0 where there is none.
    fn skip_word(&mut self) -> Result<u32, Refused> {
        let start = self.at;
        for &byte in self.rest() {
            let is_part = byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b'+' | b'-' | b'.' | b'#');
            if !is_part && byte < 0x80 {
                break;
            }
            self.at += 1;
        }
        let length = self.at - start;
        let is_number = self.bytes[start..].first().is_some_and(|&byte| b"+-.0123456789".contains(&byte));
        if is_number && length > limits::MAX_NUMBER_CHARS {
            let message = format!("this number has {length} characters");
            let mend = format!("write it with at most {} characters", limits::MAX_NUMBER_CHARS);
            return Err(Refused::error(start, message, mend));
        }
        Ok(length as u32)
    }

    /// The offset behind the string or character that starts here, if one does.
    fn string_end(&self) -> Result<Option<usize>, Refused> {
        let rest = self.rest();
        let prefix = rest.iter().take(2).take_while(|byte| matches!(byte, b'b' | b'r')).count();
        let hashes = if rest[..prefix].contains(&b'r') {
            rest[prefix..].iter().take_while(|&&byte| byte == b'#').count()
        } else {
            0
        };
        let body = prefix + hashes + 1;
        match rest.get(prefix + hashes) {
            Some(b'"') if rest[..prefix].contains(&b'r') => {
                let end_mark = format!("\"{}", "#".repeat(hashes));
                let found = self.text[self.at + body..].find(&end_mark);
                found
                    .map(|at| Some(self.at + body + at + end_mark.len()))
                    .ok_or_else(|| self.unclosed_string())
            }
            Some(b'"') => {
                let end = end_of_escaped(rest, body, b'"').ok_or_else(|| self.unclosed_string())?;
                Ok(Some(self.at + end))
            }
            Some(b'\'') if hashes == 0 => {
                // If this quote begins no character literal, only the quote is skipped. The parser reports the error.
                let is_character = |end: &usize| *end - body <= "\\u{10FFFF}'".len();
                let end = end_of_escaped(rest, body, b'\'').filter(is_character).unwrap_or(body);
                Ok(Some(self.at + end))
            }
            _ => Ok(None),
        }
    }

    fn unclosed_string(&self) -> Refused {
        Refused::error(self.at, "this text is never closed", "add the missing `\"`")
    }

    /// Skips white space and comments.
    fn skip_blank(&mut self) -> Result<(), Refused> {
        loop {
            let rest = self.rest();
            if rest.starts_with(b"//") {
                self.at += rest.iter().position(|&byte| byte == b'\n').unwrap_or(rest.len());
            } else if rest.starts_with(b"/*") {
                self.skip_block_comment()?;
            } else {
                match self.text[self.at..].chars().next() {
                    Some(character) if character.is_whitespace() => self.at += character.len_utf8(),
                    _ => return Ok(()),
                }
            }
        }
    }

    /// Skips a comment with the comments inside it.
    fn skip_block_comment(&mut self) -> Result<(), Refused> {
        let opened_at = self.at;
        let mut open = 0_usize;
        loop {
            let rest = self.rest();
            if rest.starts_with(b"/*") {
                open += 1;
                if open > limits::MAX_NESTING {
                    return Err(Refused::too_deep(opened_at, "comments"));
                }
                self.at += 2;
            } else if rest.starts_with(b"*/") {
                open -= 1;
                self.at += 2;
                if open == 0 {
                    return Ok(());
                }
            } else if rest.is_empty() {
                let mend = "add the missing `*/`; comments nest, so each `/*` needs its own";
                return Err(Refused::error(opened_at, "this comment is never closed", mend));
            } else {
                self.at += 1;
            }
        }
    }
}

fn node(start: usize, end: usize, name_bytes: u32, inside: Inside) -> Node {
    Node { start: start as u32, end: end as u32, name_bytes, inside }
}

fn closing_of(opening: u8) -> u8 {
    match opening {
        b'(' => b')',
        b'[' => b']',
        _ => b'}',
    }
}

/// The offset behind the closing quote; a `\` escapes the byte after it.
fn end_of_escaped(bytes: &[u8], body: usize, quote: u8) -> Option<usize> {
    let mut at = body;
    while let Some(&byte) = bytes.get(at) {
        match byte {
            b'\\' => at += 2,
            byte if byte == quote => return Some(at + 1),
            _ => at += 1,
        }
    }
    None
}

fn stray_character(offset: usize, stray: char) -> Refused {
    let message = format!("the character {stray:?} has no meaning here");
    Refused::error(offset, message, "remove it, or close the text before it")
}

fn wrong_closing(offset: usize, opening: u8, closing: u8) -> Refused {
    let (opening, wanted, closing) =
        (char::from(opening), char::from(closing_of(opening)), char::from(closing));
    let message = format!("`{closing}` closes what `{opening}` opened");
    Refused::error(offset, message, format!("write `{wanted}`, or look for a bracket that is missing"))
}
