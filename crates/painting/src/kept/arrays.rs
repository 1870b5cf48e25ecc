//! The layout of kept bytes: a header with the version and the key, a table of arrays, and the arrays.
//!
//! | bytes | what |
//! |---|---|
//! | 16 | `impasto prepared` |
//! | 4 | the number of the layout |
//! | 4 | the byte-order mark 0x04030201 |
//! | 32 | the key |
//! | 8 | how many arrays there are |
//! | 8 | how many bytes there are in all |
//! | 4 | CRC-32 of the header, with this field as 0, and of the table |
//! | 4 | zero |
//! | 16 for each array | its length in bytes, its CRC-32, the size of one element in bytes |
//! | | the arrays, one after the other |

use std::borrow::Cow;
use std::io::{self, Write};
use std::marker::PhantomData;

use bytemuck::{NoUninit, Pod, Zeroable};

use super::{FORMAT, KeptBytes, KeptKey};

const MAGIC: [u8; 16] = *b"impasto prepared";
const ORDER: u32 = 0x0403_0201;

/// How many bytes are read at once: few enough to still be in the processor's cache when their checksum is taken.
const CHUNK: usize = 1 << 18;

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
    #[error("it could not be read")]
    Unread,
}

impl From<io::Error> for Unfit {
    fn from(_: io::Error) -> Self {
        Self::Unread
    }
}

/// Arrays to be written.
#[derive(Default)]
pub(super) struct ArraysToWrite<'a>(Vec<(Cow<'a, [u8]>, u32)>);

impl<'a> ArraysToWrite<'a> {
    /// Adds an array whose bytes are written just as they are in memory.
    pub(super) fn push<T: NoUninit>(&mut self, array: &'a [T]) {
        self.0.push((Cow::Borrowed(bytemuck::cast_slice(array)), size_of::<T>() as u32));
    }

    /// Adds a copy of an array. It is for arrays that were made only to be written, and do not live as long as this
    /// list.
    pub(super) fn push_made<T: NoUninit>(&mut self, array: &[T]) {
        self.0.push((Cow::Owned(bytemuck::cast_slice(array).to_vec()), size_of::<T>() as u32));
    }

    pub(super) fn bytes(&self) -> u64 {
        let table = self.0.len() * size_of::<Row>();
        (size_of::<Header>() + table + self.0.iter().map(|(array, _)| array.len()).sum::<usize>()) as u64
    }

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
        self.0.iter().try_for_each(|(array, _)| out.write_all(array))
    }
}

/// The CRC of the header and the table. The header's field for the CRC counts as 0.
fn crc_of(header: &Header, table: &[u8]) -> u32 {
    let mut hasher = crc32fast::Hasher::new();
    hasher.update(bytemuck::bytes_of(&Header { crc: 0, ..*header }));
    hasher.update(table);
    hasher.finalize()
}

/// Kept bytes whose header was checked: the arrays, one after the other.
pub(super) struct Arrays<'a> {
    bytes: &'a dyn KeptBytes,
    rows: std::vec::IntoIter<Row>,
    /// Where the next array begins.
    at: u64,
}

impl<'a> Arrays<'a> {
    /// Checks the header against the key and its checksum. Every number in it is checked against the number of bytes
    /// before it is used.
    pub(super) fn open(bytes: &'a dyn KeptBytes, key: &KeptKey) -> Result<Self, Unfit> {
        let mut header = Header::zeroed();
        if bytes.count() < size_of::<Header>() as u64 {
            return Err(Unfit::Foreign);
        }
        bytes.read(0, bytemuck::bytes_of_mut(&mut header))?;
        if header.magic != MAGIC {
            return Err(Unfit::Foreign);
        }
        if (header.format, header.order) != (FORMAT, ORDER) {
            return Err(Unfit::OtherVersion);
        }
        if header.key != key.0 {
            return Err(Unfit::OtherKey);
        }
        let begin = size_of::<Header>() as u64;
        let table_bytes = header.arrays.checked_mul(size_of::<Row>() as u64);
        let at = table_bytes.and_then(|bytes| bytes.checked_add(begin)).ok_or(Unfit::Damaged)?;
        if header.bytes != bytes.count() || at > bytes.count() {
            return Err(Unfit::Damaged);
        }
        let mut table = vec![Row::zeroed(); usize::try_from(header.arrays).map_err(|_| Unfit::Damaged)?];
        bytes.read(begin, bytemuck::cast_slice_mut(&mut table))?;
        let end = table.iter().try_fold(at, |end, row| end.checked_add(row.bytes));
        if header.crc != crc_of(&header, bytemuck::cast_slice(&table)) || end != Some(bytes.count()) {
            return Err(Unfit::Damaged);
        }
        Ok(Self { bytes, rows: table.into_iter(), at })
    }

    pub(super) fn next<T>(&mut self) -> Result<Array<'a, T>, Unfit> {
        let row = self.rows.next().ok_or(Unfit::Damaged)?;
        let array = Array { bytes: self.bytes, at: self.at, row, of: PhantomData };
        self.at += row.bytes;
        let is_whole = row.size as usize == size_of::<T>() && row.bytes.is_multiple_of(row.size.into());
        if is_whole { Ok(array) } else { Err(Unfit::Damaged) }
    }

    /// Fails where arrays are left.
    pub(super) fn end(mut self) -> Result<(), Unfit> {
        if self.rows.next().is_none() { Ok(()) } else { Err(Unfit::Damaged) }
    }
}

/// An array that was not read yet.
#[derive(Clone, Copy)]
pub(super) struct Array<'a, T> {
    bytes: &'a dyn KeptBytes,
    at: u64,
    row: Row,
    of: PhantomData<fn() -> T>,
}

impl<T: Pod> Array<'_, T> {
    pub(super) fn len(&self) -> usize {
        self.row.bytes as usize / size_of::<T>()
    }

    /// Reads it, and checks its checksum. [`Arrays::open`] has checked that this many bytes are there.
    pub(super) fn read(self) -> Result<Vec<T>, Unfit> {
        let mut numbers = vec![T::zeroed(); self.len()];
        let (mut hasher, mut at) = (crc32fast::Hasher::new(), self.at);
        for chunk in bytemuck::cast_slice_mut(&mut numbers).chunks_mut(CHUNK) {
            self.bytes.read(at, chunk)?;
            hasher.update(chunk);
            at += chunk.len() as u64;
        }
        if hasher.finalize() == self.row.crc { Ok(numbers) } else { Err(Unfit::Damaged) }
    }

    /// Reads it, if it has this many numbers.
    pub(super) fn of_len(self, len: usize) -> Result<Vec<T>, Unfit> {
        if self.len() == len { self.read() } else { Err(Unfit::Damaged) }
    }

    /// Reads it, if it has this many numbers or none.
    pub(super) fn of_len_or_empty(self, len: usize) -> Result<Vec<T>, Unfit> {
        self.of_len(if self.len() == 0 { 0 } else { len })
    }
}
