//! Keeps results of preparing from one process to the next: the outputs of the heavy steps (counts, particles, traits,
//! lifts, order, marks), as plain arrays. Their key is a hash of all inputs of these steps. Nothing here opens a file:
//! bytes are handed in ([`crate::PrepareOptions::kept`]) and out ([`crate::Painting::to_keep`]).
//!
//! A kept painting equals, to the bit, one that is prepared from nothing. Bytes that do not fit (cut, damaged, of
//! another version or scene) are treated as if nothing were kept.

mod arrays;
mod contents;
mod key_hasher;
mod scene_key;
mod write;

use std::fmt;
use std::io::{self, Read as _};

pub(crate) use contents::{KeptCoat, KeptObject, KeptPainting, Wanted};
pub(crate) use key_hasher::KeyHasher;
pub(crate) use scene_key::SceneKey;
pub use write::ToKeep;

/// The version of the layout of kept bytes. Raise it when what is kept, or its order, changes. (When the way it is
/// *made* changes, nothing needs to be done: the hash of the sources is part of every key.)
pub const FORMAT: u32 = 4;

/// The key under which a prepared painting is kept: a hash of all that it is made from, and of the program itself.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
pub struct KeptKey(pub(crate) [u8; 32]);

/// As hexadecimal digits: the first half, which is enough for the name of a file.
impl fmt::Display for KeptKey {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0[..16].iter().try_for_each(|byte| write!(formatter, "{byte:02x}"))
    }
}

impl fmt::Debug for KeptKey {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "KeptKey({self})")
    }
}

/// Bytes that another process kept, in a file or in memory.
pub trait KeptBytes: Send + Sync {
    /// How many there are.
    fn count(&self) -> u64;

    /// Fills `to` with the bytes from `from` on.
    ///
    /// # Errors
    /// Those of the system, and when fewer bytes are there than `count` said.
    fn read(&self, from: u64, to: &mut [u8]) -> io::Result<()>;
}

impl KeptBytes for Vec<u8> {
    fn count(&self) -> u64 {
        self.len() as u64
    }

    fn read(&self, from: u64, to: &mut [u8]) -> io::Result<()> {
        let rest = usize::try_from(from).ok().and_then(|from| self.get(from..));
        rest.unwrap_or_default().read_exact(to)
    }
}

/// Gives what is kept under a key.
pub type FindKept<'a> = dyn Fn(&KeptKey) -> Option<Box<dyn KeptBytes>> + Sync + 'a;

/// Whether a painting was taken from what another process kept.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Kept {
    /// Nobody asked: the painting was prepared from nothing.
    #[default]
    NotAsked,
    /// Nothing is kept under this key.
    NotThere(KeptKey),
    /// The painting was taken from this many bytes.
    Taken(KeptKey, u64),
    /// What is kept under this key is of no use, and why.
    Unfit(KeptKey, String),
}
