//! The points of an OBJ file (its `v` lines), and the point that each corner of a face names.

use std::io::BufRead as _;

use super::cleaned::Cleaned;

/// The `v` lines of a text.
pub(super) struct NamedPoints {
    /// How many there are.
    pub count: usize,
    /// For each corner of each face, in order, the `v` line that it names, counted from 0.
    pub of_corner: Vec<u32>,
}

/// Reads the points from a text that the linter has cleaned, so that every index is in range.
pub(super) fn of(cleaned: Cleaned<'_>) -> NamedPoints {
    let mut named = NamedPoints { count: 0, of_corner: Vec::new() };
    for line in cleaned.split(b'\n').map_while(Result::ok) {
        let line = line.trim_ascii();
        if line.starts_with(b"v ") || line.starts_with(b"v\t") {
            named.count += 1;
        } else if let Some(corners) = line.strip_prefix(b"f") {
            let words = corners.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
            named.of_corner.extend(words.map(|word| index(word, named.count)));
        }
    }
    named
}

/// The first index of a corner, counted from 0. In the text, indices count from 1, negative ones back from the last
/// point so far.
fn index(word: &[u8], count: usize) -> u32 {
    let text = word.split(|&byte| byte == b'/').next().and_then(|first| std::str::from_utf8(first).ok());
    let index: i64 = text.and_then(|text| text.parse().ok()).unwrap_or(1);
    let from_0 = if index < 0 { count as i64 + index } else { index - 1 };
    from_0.clamp(0, i64::from(u32::MAX)) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_name_points_from_the_front_and_from_the_back() {
        let text = b"v 0 0 0\nv 1 0 0\nvt 0 0\nv 0 1 0\nf 1/1/ 2 3//\nf -3 -2/1 -1\nv 0 0 1\nf 1 2 -1\n";
        let mut cleaned = Cleaned::new(text);
        cleaned.keep(0..text.len());
        let named = of(cleaned);
        assert_eq!((named.count, named.of_corner), (4, vec![0, 1, 2, 0, 1, 2, 0, 1, 3]));
    }
}
