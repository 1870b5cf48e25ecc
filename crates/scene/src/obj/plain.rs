//! Plain lines, read in bulk and on all cores: vertices and faces as nearly every program writes them.
//!
//! Whatever is not plain (names, errors, oddities, indices counted backwards) stays text, for [`super::lint`] to take in
//! its turn. So this reader tells nothing and knows no rule: a line that it does not take is not thereby wrong.

use std::ops::Range;

use rayon::prelude::*;

use super::text::Lines;
use super::{lint, number};

/// An index that a corner does not have.
pub(super) const NONE: u32 = u32::MAX;

/// The least text that is worth a piece of its own, in bytes.
pub(super) const PIECE_BYTES: usize = 1 << 18;

/// One corner of a face: indices from 0 of position, texture coordinate and normal ([`NONE`] where there is none).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Corner {
    pub position: u32,
    pub uv: u32,
    pub normal: u32,
    /// Where its word begins in the text.
    pub offset: u32,
}

/// How much has been read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Counts {
    pub positions: u32,
    pub uvs: u32,
    pub normals: u32,
    pub faces: u32,
}

/// Lines that are not plain, one after the other.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Rest {
    pub text: Range<u32>,
    /// What the piece held before them.
    pub before: Counts,
}

/// A face of at least three corners, of which no two neighbours are one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct PlainFace {
    /// Where its corners end in [`Piece::corners`].
    pub end: u32,
    /// Where its keyword stands in the text.
    pub offset: u32,
}

/// What one piece of the text says.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Piece {
    pub positions: Vec<[f64; 3]>,
    pub uvs: Vec<[f32; 2]>,
    /// Of unit length.
    pub normals: Vec<[f32; 3]>,
    pub corners: Vec<Corner>,
    pub faces: Vec<PlainFace>,
    pub rest: Vec<Rest>,
}

/// Reads a whole text in pieces of at least `piece_bytes`; they come in the order of the text.
pub(super) fn read(text: &[u8], piece_bytes: usize) -> Vec<Piece> {
    let most = rayon::current_num_threads() * 4;
    let size = piece_bytes.max(text.len().div_ceil(most));
    let mut starts = vec![0];
    while let Some(start) = starts.last().and_then(|last| line_start_after(text, last + size)) {
        starts.push(start);
    }
    let ends = starts.iter().skip(1).copied().chain([text.len()]);
    let ranges: Vec<Range<usize>> = starts.iter().copied().zip(ends).map(|(start, end)| start..end).collect();
    match &ranges[..] {
        [one] => vec![Piece::read(text, one.clone())],
        many => many.par_iter().map(|range| Piece::read(text, range.clone())).collect(),
    }
}

/// Where a line begins that is surely no continuation of the one before, at `at` or later.
fn line_start_after(text: &[u8], at: usize) -> Option<usize> {
    let is_joined = |end: usize| matches!(text[..end], [.., b'\\'] | [.., b'\\', b'\r']);
    let ends = text.get(at..)?.iter().enumerate().filter(|&(_, &byte)| byte == b'\n');
    ends.map(|(step, _)| at + step)
        .find(|&end| !is_joined(end))
        .map(|end| end + 1)
        .filter(|&start| start < text.len())
}

impl Piece {
    fn read(text: &[u8], range: Range<usize>) -> Self {
        let mut piece = Self::default();
        let mut words = Vec::new();
        let mut at = range.start;
        while at < range.end {
            let start = at;
            at = match piece.line(text, start) {
                Some(end) => end,
                None => {
                    let mut lines = Lines::between(text, start, range.end);
                    lines.next_into(&mut words);
                    piece.leave(start..lines.at());
                    lines.at()
                }
            };
        }
        piece
    }

    fn leave(&mut self, text: Range<usize>) {
        let before = self.counts();
        let text = text.start as u32..text.end as u32;
        match self.rest.last_mut() {
            Some(last) if last.before == before => last.text.end = text.end,
            _ => self.rest.push(Rest { text, before }),
        }
    }

    /// How much the whole piece holds.
    pub fn counts(&self) -> Counts {
        Counts {
            positions: self.positions.len() as u32,
            uvs: self.uvs.len() as u32,
            normals: self.normals.len() as u32,
            faces: self.faces.len() as u32,
        }
    }

    /// Reads one line that begins at `at`, and gives where the next begins; `None`, and nothing kept, where it is not plain.
    #[inline]
    fn line(&mut self, text: &[u8], at: usize) -> Option<usize> {
        let at = skip_blanks(text, at);
        match text.get(at..at + 3)? {
            [b'v', b' ' | b'\t', _] => {
                let (position, at) = numbers::<3>(text, at + 1)?;
                if position.iter().any(|value| value.abs() > lint::MAX_COORDINATE) {
                    return None;
                }
                let at = line_end(text, at)?;
                self.positions.push(position);
                Some(at)
            }
            [b'v', b't', b' ' | b'\t'] => {
                let ([u, v], at) = numbers::<2>(text, at + 2)?;
                if u.abs() >= lint::MAX_UV || v.abs() >= lint::MAX_UV {
                    return None;
                }
                let at = line_end(text, at).or_else(|| line_end(text, numbers::<1>(text, at)?.1))?;
                self.uvs.push([u as f32, v as f32]);
                Some(at)
            }
            [b'v', b'n', b' ' | b'\t'] => {
                let (normal, at) = numbers::<3>(text, at + 2)?;
                let at = line_end(text, at)?;
                self.normals.push(lint::unit(normal)?);
                Some(at)
            }
            [b'f', b' ' | b'\t', _] => self.face(text, at),
            [b'#', ..] => {
                let length = text[at..].iter().position(|byte| matches!(byte, b'\n' | b'\r'))?;
                Some(at + length + 1)
            }
            [b'\n' | b'\r', ..] => Some(at + 1),
            _ => None,
        }
    }

    fn face(&mut self, text: &[u8], keyword: usize) -> Option<usize> {
        let first = self.corners.len();
        let end = corners(text, keyword + 1, &mut self.corners);
        let own = &self.corners[first..];
        let is_whole = |pair: &[Corner]| pair[0].position != pair[1].position;
        let is_plain = own.len() >= 3
            && own.windows(2).all(is_whole)
            && own.first().map(|corner| corner.position) != own.last().map(|corner| corner.position);
        if end.is_none() || !is_plain {
            self.corners.truncate(first);
            return None;
        }
        self.faces.push(PlainFace { end: self.corners.len() as u32, offset: keyword as u32 });
        end
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
    let at = skip_blanks(text, at);
    matches!(text.get(at)?, b'\n' | b'\r').then_some(at + 1)
}

/// Finite numbers, each after its blank, and where the last one ends.
#[inline]
fn numbers<const COUNT: usize>(text: &[u8], mut at: usize) -> Option<([f64; COUNT], usize)> {
    let mut values = [0.0; COUNT];
    for value in &mut values {
        (*value, at) = number::next(text, skip_blanks(text, at))?;
    }
    Some((values, at))
}

/// The corners of a face to the end of its line; gives where the next line begins.
fn corners(text: &[u8], mut at: usize, corners: &mut Vec<Corner>) -> Option<usize> {
    loop {
        at = skip_blanks(text, at);
        if matches!(text.get(at)?, b'\n' | b'\r') {
            return Some(at + 1);
        }
        let mut corner = Corner { position: 0, uv: NONE, normal: NONE, offset: at as u32 };
        (corner.position, at) = index(text, at)?;
        if text.get(at)? == &b'/' {
            at += 1;
            if text.get(at)? != &b'/' {
                (corner.uv, at) = index(text, at)?;
            }
            if text.get(at)? == &b'/' {
                (corner.normal, at) = index(text, at + 1)?;
            }
        }
        if !matches!(text.get(at)?, b' ' | b'\t' | b'\n' | b'\r') {
            return None;
        }
        corners.push(corner);
    }
}

/// An index written from 1 in at most nine digits, as one from 0, and where it ends.
#[inline]
fn index(text: &[u8], start: usize) -> Option<(u32, usize)> {
    let mut at = start;
    let mut size = 0u32;
    loop {
        let digit = text.get(at)?.wrapping_sub(b'0');
        if digit > 9 {
            break;
        }
        size = size.wrapping_mul(10).wrapping_add(u32::from(digit));
        at += 1;
    }
    (at - start <= 9).then_some((size.checked_sub(1)?, at))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_say_together_what_one_says() {
        let text = b"v 1 2 3\nv -.5 1e-3 7. \\\n\nv\\\r\n1 2 3\r\nvt 0 1 0\n# f 1 2 3 \\\nvn 0 0 2\n\nf 1 2/1 3/1/1\r\
            f -1 -2 -3\nf 1//1 2//1 3//1 2\ng name # of it\nf 1 2 1\nv 0 0 0";
        let whole = Piece::read(text, 0..text.len());
        assert_eq!((whole.positions.len(), whole.uvs.len(), whole.normals.len()), (1, 1, 1));
        assert_eq!(whole.faces.iter().map(|face| face.end).collect::<Vec<_>>(), [3, 7]);
        for size in 1..text.len() {
            let pieces = read(text, size);
            assert!(size > 20 || pieces.len() > 2, "{size}");
            let corners: Vec<Corner> = pieces.iter().flat_map(|piece| piece.corners.clone()).collect();
            assert_eq!(corners, whole.corners, "{size}");
            let rest = |pieces: &[Piece]| -> Vec<u8> {
                let ranges = pieces.iter().flat_map(|piece| piece.rest.clone());
                ranges
                    .flat_map(|rest| text[rest.text.start as usize..rest.text.end as usize].to_vec())
                    .collect()
            };
            assert_eq!(rest(&pieces), rest(std::slice::from_ref(&whole)), "{size}");
        }
    }
}
