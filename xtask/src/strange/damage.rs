//! Damages existing files: bytes, lines, numbers and branches of JSON are changed, dropped, repeated or taken from
//! elsewhere.

use serde_json::Value;

use super::chance::Chance;

/// The most bytes that a damaged file has.
const MOST_BYTES: usize = 4 << 20;

/// Damages bytes at random places.
pub fn bytes(chance: &mut Chance, mut bytes: Vec<u8>, other: &[u8]) -> Vec<u8> {
    for _ in 0..chance.count(20) {
        let at = chance.below(bytes.len() + 1);
        let length = chance.count(64).min(bytes.len() - at);
        match chance.below(7) {
            0 => {
                if let Some(byte) = bytes.get_mut(at) {
                    *byte ^= 1 << chance.below(8);
                }
            }
            1 => drop(bytes.drain(at..at + length)),
            2 => bytes.insert(at, chance.byte()),
            3 => {
                let piece = bytes[at..at + length].to_vec();
                let piece = piece.repeat(chance.count(1000));
                bytes.splice(at..at, piece);
            }
            4 => {
                let from = chance.below(other.len());
                let to = (from + chance.count(400)).min(other.len());
                bytes.splice(at..at, other[from..to].iter().copied());
            }
            5 if chance.happens(0.2) => bytes.truncate(at),
            _ => {
                let number =
                    chance.of(&[0u32, 1, 0x7fff_ffff, 0x8000_0000, 0xffff_ffff, 0x7fc0_0000, 0x7f80_0000]);
                let end = (at + 4).min(bytes.len());
                bytes[at..end].copy_from_slice(&number.to_le_bytes()[..end - at]);
            }
        }
        bytes.truncate(MOST_BYTES);
    }
    bytes
}

/// Damages a text line by line and number by number, so that most of it stays what it was.
pub fn text(chance: &mut Chance, bytes: &[u8], other: &[u8]) -> Vec<u8> {
    let text = String::from_utf8_lossy(bytes);
    let mut lines: Vec<String> = text.split('\n').map(str::to_owned).collect();
    let others = String::from_utf8_lossy(other);
    let others: Vec<&str> = others.split('\n').collect();
    for _ in 0..chance.count(12) {
        let at = chance.below(lines.len());
        let Some(line) = lines.get(at).cloned() else { break };
        match chance.below(8) {
            0 => drop(lines.remove(at)),
            1 => {
                let times = chance.count(2000).min(MOST_BYTES / (line.len() + 1) / 4);
                lines.splice(at..at, std::iter::repeat_n(line, times));
            }
            2 => {
                let to = chance.below(lines.len());
                lines.swap(at, to);
            }
            3 => lines.insert(at, chance.of(&others).to_owned()),
            4 => lines[at] = odd_word(chance, &line, |byte| byte == b'"'),
            _ => {
                lines[at] =
                    odd_word(chance, &line, |byte| !(byte.is_ascii_digit() || b".-+eE".contains(&byte)))
            }
        }
    }
    let end = chance.of(&["\n", "\n", "\n", "\r\n", "\r"]);
    let mut bytes = lines.join(end).into_bytes();
    bytes.truncate(MOST_BYTES);
    bytes
}

/// Replaces one word of a line by something odd. Words lie between separators.
fn odd_word(chance: &mut Chance, line: &str, is_separator: impl Fn(u8) -> bool) -> String {
    let words: Vec<std::ops::Range<usize>> = line
        .as_bytes()
        .split(|&byte| is_separator(byte))
        .filter(|word| !word.is_empty())
        .map(|word| {
            let from = word.as_ptr() as usize - line.as_ptr() as usize;
            from..from + word.len()
        })
        .filter(|word| line.is_char_boundary(word.start) && line.is_char_boundary(word.end))
        .collect();
    let Some(word) = words.get(chance.below(words.len())) else { return line.to_owned() };
    let odd = if is_separator(b'"') && !is_separator(b' ') {
        chance.odd_name()
    } else {
        chance.odd_number().to_owned()
    };
    format!("{}{odd}{}", &line[..word.start], &line[word.end..])
}

/// Damages branches of JSON: a value is replaced by another of the tree or by an odd one, repeated in its list, or
/// removed.
pub fn json(chance: &mut Chance, root: &mut Value) {
    for _ in 0..chance.count(8) {
        let elsewhere = branch(chance, &mut root.clone(), |value| value.clone());
        let odd = match chance.below(5) {
            0 => Value::from(chance.odd_number().parse::<f64>().unwrap_or(-1.0)),
            1 => Value::from(chance.below(6)),
            2 => Value::from(chance.odd_name()),
            3 => chance.of(&[&Value::Null, &Value::Bool(true), &Value::Array(Vec::new())]).clone(),
            _ => elsewhere,
        };
        let choice = chance.below(4);
        let at = chance.below(1 << 16);
        branch(chance, root, |value| match (choice, &mut *value) {
            (0, Value::Array(list)) if !list.is_empty() => drop(list.remove(at % list.len())),
            (1, Value::Array(list)) if !list.is_empty() => list.push(list[at % list.len()].clone()),
            (0, Value::Object(map)) if !map.is_empty() => {
                let key = map.keys().nth(at % map.len()).cloned();
                drop(key.and_then(|key| map.remove(&key)));
            }
            _ => *value = odd.clone(),
        });
    }
}

/// Walks down to a random branch, and calls `act` with it.
fn branch<T>(chance: &mut Chance, mut value: &mut Value, act: impl FnOnce(&mut Value) -> T) -> T {
    let mut depth = 1 + chance.below(7);
    loop {
        let count = match &*value {
            Value::Array(list) => list.len(),
            Value::Object(map) => map.len(),
            _ => 0,
        };
        if count == 0 || depth == 0 {
            return act(value);
        }
        depth -= 1;
        let at = chance.below(count);
        value = match value {
            Value::Array(list) => &mut list[at],
            Value::Object(map) => match map.values_mut().nth(at) {
                Some(inner) => inner,
                None => unreachable!("there are `count` values"),
            },
            _ => unreachable!("only these have branches"),
        };
    }
}
