//! A piece of a file. The file is in memory only once, however many parts of the shot use it.

use std::fmt;
use std::ops::{Deref, Range};
use std::sync::Arc;

/// A range of bytes of a file. Clones share the file's memory.
#[derive(Clone, Default)]
pub struct Bytes {
    whole: Arc<Vec<u8>>,
    range: Range<usize>,
}

impl Bytes {
    /// All of a file.
    pub fn new(whole: Vec<u8>) -> Self {
        let range = 0..whole.len();
        Self { whole: Arc::new(whole), range }
    }

    /// A part, counted from the start of this one; `None` where it does not lie inside.
    pub fn slice(&self, start: u64, len: u64) -> Option<Self> {
        let end = start.checked_add(len)?;
        if end > self.range.len() as u64 {
            return None;
        }
        let range = self.range.start + start as usize..self.range.start + end as usize;
        Some(Self { whole: self.whole.clone(), range })
    }
}

impl Deref for Bytes {
    type Target = [u8];

    fn deref(&self) -> &[u8] {
        &self.whole[self.range.clone()]
    }
}

impl PartialEq for Bytes {
    fn eq(&self, other: &Self) -> bool {
        **self == **other
    }
}

impl fmt::Debug for Bytes {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{} bytes", self.range.len())
    }
}
