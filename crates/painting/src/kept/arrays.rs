//! The layout of kept bytes: a header with the version and the key, a table of arrays, and the arrays.
//!
//! | bytes | what |
//! |---|---|
//! | 16 | `impasto prepared` |
//! | 4 | the number of the layout |
//! | 4 | tells the order of bytes in a number |
//! | 32 | the key |
//! | 8 | how many arrays there are |
//! | 8 | how many bytes there are in all |
//! | 4 | CRC-32 of the header so far and of the table |
//! | 4 | zero |
//! | 16 for each array | its length in bytes, its CRC-32, the size of its numbers |
//! | | the arrays, each from a multiple of 64 bytes on |

use std::borrow::Cow;
use std::io::{self, Write};
use std::marker::PhantomData;

use bytemuck::{AnyBitPattern, NoUninit, Pod, Zeroable};
use rayon::prelude::*;

use super::{FORMAT, KeptKey};

const MAGIC: [u8; 16] = *b"impasto prepared";
const ORDER: u32 = 0x0403_0201;
const ALIGNMENT: u64 = 64;

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Header {
    magic: [u8; 16],
    format: u32,
    order: u32,
    key: [u8; 32],
    arrays: u64,
    bytes: u64,
    crc: u32,
    zero: u32,
}

#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
struct Row {
    bytes: u64,
    crc: u32,
    size: u32,
}

/// Why kept bytes are of no use.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub(crate) enum Unfit {
    #[error("it is no file of prepared particles")]
    Foreign,
    #[error("it is of another version")]
    OtherVersion,
    #[error("it is of another scene")]
    OtherKey,
    #[error("it is cut short or damaged")]
    Damaged,
}

/// Arrays to be written.
#[derive(Default)]
pub(super) struct ArraysToWrite<'a>(Vec<(Cow<'a, [u8]>, u32)>);

impl<'a> ArraysToWrite<'a> {
    /// Adds an array that lies in memory as it is written.
    pub(super) fn push<T: NoUninit>(&mut self, array: &'a [T]) {
        self.0.push((Cow::Borrowed(bytemuck::cast_slice(array)), size_of::<T>() as u32));
    }

    /// Adds an array that was made to be written.
    pub(super) fn push_made<T: NoUninit>(&mut self, array: &[T]) {
        self.0.push((Cow::Owned(bytemuck::cast_slice(array).to_vec()), size_of::<T>() as u32));
    }

    fn begin(&self) -> u64 {
        (size_of::<Header>() + self.0.len() * size_of::<Row>()) as u64
    }

    /// How many bytes are written.
    pub(super) fn bytes(&self) -> u64 {
        let end =
            |at: u64, array: &(Cow<'_, [u8]>, u32)| at.next_multiple_of(ALIGNMENT) + array.0.len() as u64;
        self.0.iter().fold(self.begin(), end)
    }

    /// Writes them under a key.
    pub(super) fn write(&self, key: &KeptKey, out: &mut dyn Write) -> io::Result<()> {
        let row = |(array, size): &(Cow<'_, [u8]>, u32)| Row {
            bytes: array.len() as u64,
            crc: crc32fast::hash(array),
            size: *size,
        };
        let table: Vec<Row> = self.0.iter().map(row).collect();
        let mut header = Header {
            magic: MAGIC,
            format: FORMAT,
            order: ORDER,
            key: key.0,
            arrays: table.len() as u64,
            bytes: self.bytes(),
            crc: 0,
            zero: 0,
        };
        header.crc = crc_of(&header, bytemuck::cast_slice(&table));
        out.write_all(bytemuck::bytes_of(&header))?;
        out.write_all(bytemuck::cast_slice(&table))?;
        let mut at = self.begin();
        for (array, _) in &self.0 {
            let begin = at.next_multiple_of(ALIGNMENT);
            out.write_all(&[0; ALIGNMENT as usize][..(begin - at) as usize])?;
            out.write_all(array)?;
            at = begin + array.len() as u64;
        }
        Ok(())
    }
}

/// Of the header, its own CRC left out, and of the table.
fn crc_of(header: &Header, table: &[u8]) -> u32 {
    let mut hasher = crc32fast::Hasher::new();
    hasher.update(bytemuck::bytes_of(&Header { crc: 0, ..*header }));
    hasher.update(table);
    hasher.finalize()
}

/// Kept bytes that were checked: the arrays, one after the other.
pub(super) struct Arrays<'a>(std::vec::IntoIter<(&'a [u8], u32)>);

impl<'a> Arrays<'a> {
    /// Checks the bytes against their key and their checksums. No number of theirs is believed before it is held against their length.
    pub(super) fn open(bytes: &'a [u8], key: &KeptKey) -> Result<Self, Unfit> {
        let (first, rest) = bytes.split_at_checked(size_of::<Header>()).ok_or(Unfit::Foreign)?;
        let header: Header = bytemuck::pod_read_unaligned(first);
        if header.magic != MAGIC {
            return Err(Unfit::Foreign);
        }
        if (header.format, header.order) != (FORMAT, ORDER) {
            return Err(Unfit::OtherVersion);
        }
        if header.key != key.0 {
            return Err(Unfit::OtherKey);
        }
        let table_bytes = usize::try_from(header.arrays).ok().and_then(|n| n.checked_mul(size_of::<Row>()));
        let (table, _) = table_bytes.and_then(|n| rest.split_at_checked(n)).ok_or(Unfit::Damaged)?;
        if header.bytes != bytes.len() as u64 || header.zero != 0 || header.crc != crc_of(&header, table) {
            return Err(Unfit::Damaged);
        }
        let mut at = size_of::<Header>() + table.len();
        let mut arrays = Vec::with_capacity(table.len() / size_of::<Row>());
        for row in table.chunks_exact(size_of::<Row>()) {
            let row: Row = bytemuck::pod_read_unaligned(row);
            let begin = at.next_multiple_of(ALIGNMENT as usize);
            let end = usize::try_from(row.bytes).ok().and_then(|length| begin.checked_add(length));
            let array = end.and_then(|end| bytes.get(begin..end)).ok_or(Unfit::Damaged)?;
            // What lies between two arrays is zero.
            if bytes[at..begin].iter().any(|&byte| byte != 0) {
                return Err(Unfit::Damaged);
            }
            at = begin + array.len();
            arrays.push((array, row));
        }
        let is_whole = |(array, row): &(&[u8], Row)| crc32fast::hash(array) == row.crc;
        if at != bytes.len() || !arrays.par_iter().with_max_len(1).all(is_whole) {
            return Err(Unfit::Damaged);
        }
        let arrays: Vec<_> = arrays.into_iter().map(|(array, row)| (array, row.size)).collect();
        Ok(Self(arrays.into_iter()))
    }

    /// The next array.
    pub(super) fn next<T: AnyBitPattern + NoUninit>(&mut self) -> Result<Array<'a, T>, Unfit> {
        let (bytes, size) = self.0.next().ok_or(Unfit::Damaged)?;
        let is_whole = size as usize == size_of::<T>() && bytes.len().is_multiple_of(size_of::<T>());
        if is_whole { Ok(Array { bytes, of: PhantomData }) } else { Err(Unfit::Damaged) }
    }

    /// Fails where arrays are left.
    pub(super) fn end(mut self) -> Result<(), Unfit> {
        if self.0.next().is_none() { Ok(()) } else { Err(Unfit::Damaged) }
    }
}

/// An array as it lies in the bytes.
#[derive(Clone, Copy)]
pub(super) struct Array<'a, T> {
    bytes: &'a [u8],
    of: PhantomData<T>,
}

impl<T: AnyBitPattern + NoUninit> Array<'_, T> {
    /// How many numbers it has.
    pub(super) fn len(&self) -> usize {
        self.bytes.len() / size_of::<T>()
    }

    /// A copy; numbers in the bytes are not where the processor wants them.
    pub(super) fn to_vec(self) -> Vec<T> {
        bytemuck::pod_collect_to_vec(self.bytes)
    }

    /// A copy, if it has this many numbers.
    pub(super) fn of_len(self, len: usize) -> Result<Vec<T>, Unfit> {
        if self.len() == len { Ok(self.to_vec()) } else { Err(Unfit::Damaged) }
    }

    /// A copy, if it has this many numbers or none.
    pub(super) fn of_len_or_empty(self, len: usize) -> Result<Vec<T>, Unfit> {
        if self.len() == 0 { Ok(Vec::new()) } else { self.of_len(len) }
    }
}
