//! Finds the plain lines of an OBJ text on all cores: vertices and faces as nearly every program writes them, comments
//! and blank lines.
//!
//! By itself, a plain line has no problem to report, and tobj reads it unchanged; whether its indices exist is checked
//! later. All other lines are left to [`super::lint`]; they need not be wrong.

use std::ops::Range;

use rayon::prelude::*;

use super::text::{Lines, finite};

/// The largest coordinate. At a few times this size, the length of a cross product would overflow in single precision,
/// since its square grows with the fourth power of the coordinates.
pub(super) const MAX_COORDINATE: f64 = 1e9;

/// Texture coordinates of this size or more count as unusable.
pub(super) const MAX_UV: f64 = 1e30;

/// The smallest size of a piece of text, in bytes: smaller pieces would not make scanning quicker.
const PIECE_BYTES: usize = 1 << 18;

/// The kinds of values in an OBJ file. A face refers to a value by its number; each kind is counted from 1 on its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Position,
    Uv,
    Normal,
}

/// Indices of a corner, counted from 1, by [`Kind`]; 0 where the corner has none.
pub(super) type Indices = [u32; 3];

/// How many values, faces and corners the plain lines of a piece have: all its plain lines, or those before some line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Counts {
    /// Positions, texture coordinates and normals, by [`Kind`].
    pub values: [u32; 3],
    pub faces: u32,
    pub corners: u32,
}

/// Consecutive lines that are not plain.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Rest {
    pub text: Range<usize>,
    /// The counts of the piece's plain lines before these lines.
    pub before: Counts,
}

/// What one piece of the text holds.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Piece {
    pub text: Range<usize>,
    pub counts: Counts,
    /// Where each plain face begins in the text.
    pub faces: Vec<u32>,
    /// Which indices each corner of the plain faces has, see [`gives`].
    pub corners: Vec<u8>,
    /// The highest indices of the plain faces.
    pub highest: Indices,
    pub rest: Vec<Rest>,
}

/// One bit for each [`Kind`] of which a corner has an index.
#[inline]
pub(super) fn gives(corner: Indices) -> u8 {
    (0..3).map(|kind| u8::from(corner[kind] > 0) << kind).sum()
}

/// `numbers` scaled to unit length; `None` if their length is nearly 0 or not finite.
pub(super) fn unit(numbers: [f64; 3]) -> Option<[f32; 3]> {
    let length = numbers.iter().map(|number| number * number).sum::<f64>().sqrt();
    (length > 1e-30 && length.is_finite()).then(|| numbers.map(|number| (number / length) as f32))
}

#[inline]
pub(super) fn raise(highest: &mut Indices, corner: Indices) {
    for (highest, index) in highest.iter_mut().zip(corner) {
        *highest = (*highest).max(index);
    }
}

/// Scans a whole text; the pieces are in the order of the text.
pub(super) fn scan(text: &[u8]) -> Vec<Piece> {
    let most = rayon::current_num_threads() * 4;
    split(text, PIECE_BYTES.max(text.len().div_ceil(most)))
        .into_par_iter()
        .map(|range| Piece::scan(text, range))
        .collect()
}

/// Ranges of about `size` bytes that begin and end between lines.
fn split(text: &[u8], size: usize) -> Vec<Range<usize>> {
    // A line that ends in a backslash goes on in the next.
    let is_joined = |end: usize| matches!(text[..end], [.., b'\\'] | [.., b'\\', b'\r']);
    let mut ranges = Vec::new();
    let mut start = 0;
    while start < text.len() {
        let mut ends = (start + size..text.len()).filter(|&at| text[at] == b'\n' && !is_joined(at));
        let end = ends.next().map_or(text.len(), |end| end + 1);
        ranges.push(start..end);
        start = end;
    }
    ranges
}

impl Piece {
    fn scan(text: &[u8], range: Range<usize>) -> Self {
        let mut piece = Self { text: range.clone(), ..Self::default() };
        let mut words = Vec::new();
        let mut at = range.start;
        while at < range.end {
            at = piece.plain_line(text, at).unwrap_or_else(|| {
                let mut lines = Lines::between(text, at, range.end);
                lines.next_into(&mut words);
                piece.leave(at..lines.at());
                lines.at()
            });
        }
        piece
    }

    /// Leaves lines that are not plain to the linter.
    fn leave(&mut self, text: Range<usize>) {
        let before = self.counts;
        match self.rest.last_mut() {
            Some(last) if last.text.end == text.start => last.text.end = text.end,
            _ => self.rest.push(Rest { text, before }),
        }
    }

    /// Takes the line that begins at `at`, and returns where the next line begins. If the line is not plain, takes
    /// nothing and returns `None`.
    #[inline]
    fn plain_line(&mut self, text: &[u8], at: usize) -> Option<usize> {
        let at = skip_blanks(text, at);
        match text.get(at..at + 3)? {
            [b'v', b' ' | b'\t', _] => {
                let (position, at) = numbers::<3>(text, at + 1)?;
                let is_good = position.iter().all(|value| value.abs() <= MAX_COORDINATE);
                self.value(Kind::Position, is_good, line_end(text, at)?)
            }
            [b'v', b't', b' ' | b'\t'] => {
                let (uv, at) = numbers::<2>(text, at + 2)?;
                let is_good = uv.iter().all(|value| value.abs() < MAX_UV);
                let end = line_end(text, at).or_else(|| line_end(text, numbers::<1>(text, at)?.1))?;
                self.value(Kind::Uv, is_good, end)
            }
            [b'v', b'n', b' ' | b'\t'] => {
                let (normal, at) = numbers::<3>(text, at + 2)?;
                self.value(Kind::Normal, unit(normal).is_some(), line_end(text, at)?)
            }
            [b'f', b' ' | b'\t', _] => self.face(text, at),
            [b'\n', ..] | [b'\r', b'\n', _] => line_end(text, at),
            [b'#', ..] => {
                let length = text[at..].iter().position(|byte| *byte == b'\n')?;
                text[at..at + length].is_ascii().then_some(at + length + 1)
            }
            _ => None,
        }
    }

    /// Counts a line of values, and returns its end. If they are not good, counts nothing and returns `None`.
    fn value(&mut self, kind: Kind, is_good: bool, end: usize) -> Option<usize> {
        self.counts.values[kind as usize] += u32::from(is_good);
        is_good.then_some(end)
    }

    /// Takes the face whose keyword is at `keyword`, and returns where the next line begins. `None` if the face is not
    /// plain: for example, an index counts backwards, there are fewer than three corners, or two neighbouring corners
    /// have the same position.
    fn face(&mut self, text: &[u8], keyword: usize) -> Option<usize> {
        let before = self.corners.len();
        let end = self.face_corners(text, keyword + 1);
        if end.is_some() {
            self.faces.push(keyword as u32);
            self.counts.faces += 1;
        } else {
            self.corners.truncate(before);
        }
        self.counts.corners = self.corners.len() as u32;
        end
    }

    #[inline]
    fn face_corners(&mut self, text: &[u8], mut at: usize) -> Option<usize> {
        let (mut first, mut last, mut count) = (0, 0, 0);
        let mut highest = self.highest;
        loop {
            at = skip_blanks(text, at);
            if let Some(end) = line_end(text, at) {
                if count < 3 || first == last {
                    return None;
                }
                self.highest = highest;
                return Some(end);
            }
            let mut corner = Indices::default();
            (corner[0], at) = index(text, at)?;
            if text.get(at)? == &b'/' {
                at += 1;
                if text.get(at)? != &b'/' {
                    (corner[1], at) = index(text, at)?;
                }
                if text.get(at)? == &b'/' {
                    (corner[2], at) = index(text, at + 1)?;
                }
            }
            if corner[0] == last || !matches!(text.get(at)?, b' ' | b'\t' | b'\n' | b'\r') {
                return None;
            }
            first = if count == 0 { corner[0] } else { first };
            (last, count) = (corner[0], count + 1);
            raise(&mut highest, corner);
            self.corners.push(gives(corner));
        }
    }
}

fn skip_blanks(text: &[u8], mut at: usize) -> usize {
    while let Some(b' ' | b'\t') = text.get(at) {
        at += 1;
    }
    at
}

/// Where the next line begins, if nothing but blanks stands before it.
#[inline]
fn line_end(text: &[u8], at: usize) -> Option<usize> {
    match text[skip_blanks(text, at)..] {
        [b'\n', ..] => Some(skip_blanks(text, at) + 1),
        [b'\r', b'\n', ..] => Some(skip_blanks(text, at) + 2),
        _ => None,
    }
}

/// Reads `COUNT` finite numbers, each after blanks. Returns them, and where the last one ends.
#[inline]
fn numbers<const COUNT: usize>(text: &[u8], mut at: usize) -> Option<([f64; COUNT], usize)> {
    let mut values = [0.0; COUNT];
    for value in &mut values {
        at = skip_blanks(text, at);
        let start = at;
        while !text.get(at)?.is_ascii_whitespace() {
            at += 1;
        }
        *value = finite(&text[start..at])?;
    }
    Some((values, at))
}

/// Reads an index of at least 1 and at most nine digits. Returns it, and where it ends.
#[inline]
fn index(text: &[u8], start: usize) -> Option<(u32, usize)> {
    let mut at = start;
    let mut index = 0u32;
    while let digit @ 0..=9 = text.get(at)?.wrapping_sub(b'0') {
        index = index.wrapping_mul(10).wrapping_add(u32::from(digit));
        at += 1;
    }
    (at - start <= 9 && index > 0).then_some((index, at))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_together_hold_what_the_whole_text_holds() {
        let text = b"v 1 2 3\nv -.5 1e-3 7. \\\n\nv\\\r\n1 2 3\r\nvt 0 1 0\n# f 1 2 3 \\\nvn 0 0 2\n\nf 1 2/1 3/1/1\n\
            f -1 -2 -3\nf 1//1 2//1 3//1 2\ng name # of it\nf 1 2 1\nv 0 0 0";
        let whole = Piece::scan(text, 0..text.len());
        assert_eq!(whole.counts, Counts { values: [1, 1, 1], faces: 2, corners: 7 });
        assert_eq!((whole.corners.as_slice(), whole.highest), ([1, 3, 7, 5, 5, 5, 1].as_slice(), [3, 1, 1]));
        for size in 1..text.len() {
            let pieces: Vec<Piece> =
                split(text, size).into_iter().map(|range| Piece::scan(text, range)).collect();
            assert!(size > 20 || pieces.len() > 2, "{size}");
            let faces: Vec<u32> = pieces.iter().flat_map(|piece| piece.faces.clone()).collect();
            assert_eq!(faces, whole.faces, "{size}");
            let rest = |pieces: &[Piece]| -> Vec<u8> {
                let ranges = pieces.iter().flat_map(|piece| &piece.rest);
                ranges.flat_map(|rest| text[rest.text.clone()].to_vec()).collect()
            };
            assert_eq!(rest(&pieces), rest(std::slice::from_ref(&whole)), "{size}");
        }
    }
}
