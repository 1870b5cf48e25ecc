//! The text of an OBJ file as tobj gets it: plain lines (vertices, faces, comments, empty lines) unchanged, other
//! vertices and faces rewritten, and nothing else.

use std::collections::VecDeque;
use std::io::{self, BufRead, Read};
use std::ops::Range;

/// Stretches of the file's text and of rewritten lines, in order.
#[derive(Clone, Debug)]
pub(super) struct Cleaned<'a> {
    file: &'a [u8],
    written: Vec<u8>,
    /// For each stretch, whether it lies in `written` rather than in `file`, and its range there.
    stretches: VecDeque<(bool, Range<usize>)>,
}

impl<'a> Cleaned<'a> {
    pub fn new(file: &'a [u8]) -> Self {
        Self { file, written: Vec::new(), stretches: VecDeque::new() }
    }

    /// Appends whole lines of the file.
    pub fn keep(&mut self, lines: Range<usize>) {
        self.stretches.push_back((false, lines));
    }

    /// Appends a line of these words.
    pub fn write<'w>(&mut self, words: impl IntoIterator<Item = &'w [u8]>) {
        let start = self.written.len();
        for word in words {
            self.written.extend_from_slice(word);
            self.written.push(b' ');
        }
        self.written.push(b'\n');
        match self.stretches.back_mut() {
            Some((true, last)) => last.end = self.written.len(),
            _ => self.stretches.push_back((true, start..self.written.len())),
        }
    }
}

impl Read for Cleaned<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.fill_buf()?.read(buffer)?;
        self.consume(count);
        Ok(count)
    }
}

impl BufRead for Cleaned<'_> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        while self.stretches.front().is_some_and(|(_, stretch)| stretch.is_empty()) {
            self.stretches.pop_front();
        }
        let Some((is_written, stretch)) = self.stretches.front() else { return Ok(&[]) };
        let source = if *is_written { self.written.as_slice() } else { self.file };
        Ok(&source[stretch.clone()])
    }

    fn consume(&mut self, amount: usize) {
        if let Some((_, stretch)) = self.stretches.front_mut() {
            stretch.start += amount;
        }
    }
}
