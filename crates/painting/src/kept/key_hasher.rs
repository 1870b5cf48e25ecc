//! Makes a key: a cryptographic hash of lists of numbers and of texts. The length of each list is hashed too, so that
//! the hash changes when numbers move from one list to the next.

use std::fmt::{Debug, Write as _};

use bytemuck::NoUninit;

/// From this many bytes on, hashing runs on all threads.
const MANY: usize = 1 << 20;

/// Hashes whatever it is fed, in order.
#[derive(Default)]
pub(crate) struct KeyHasher {
    hasher: blake3::Hasher,
    /// The text of a value while it is hashed. It is kept, so that its memory is used again.
    text: String,
}

impl KeyHasher {
    /// Feeds plain numbers, by their bits.
    pub(crate) fn numbers<T: NoUninit>(&mut self, numbers: &[T]) {
        let bytes: &[u8] = bytemuck::cast_slice(numbers);
        self.hasher.update(&(bytes.len() as u64).to_le_bytes());
        if bytes.len() < MANY {
            self.hasher.update(bytes);
        } else {
            self.hasher.update_rayon(bytes);
        }
    }

    pub(crate) fn words(&mut self, words: &str) {
        self.numbers(words.as_bytes());
    }

    /// Feeds a value as its derived `Debug` writes it: every field by name, every float so that it is read back to the
    /// bit. Use it for settings, never for long arrays or for types whose `Debug` is written by hand.
    pub(crate) fn value(&mut self, value: &impl Debug) {
        let mut text = std::mem::take(&mut self.text);
        text.clear();
        // Writing to a text cannot fail.
        let _ = write!(text, "{value:?}");
        self.words(&text);
        self.text = text;
    }

    pub(crate) fn finish(&self) -> [u8; 32] {
        *self.hasher.finalize().as_bytes()
    }
}

#[cfg(test)]
mod tests {
    use super::KeyHasher;

    fn key(feed: impl FnOnce(&mut KeyHasher)) -> [u8; 32] {
        let mut hasher = KeyHasher::default();
        feed(&mut hasher);
        hasher.finish()
    }

    #[test]
    fn lists_do_not_run_into_each_other_and_every_bit_counts() {
        let both = |a: &'static [u8], b: &'static [u8]| {
            key(move |key| {
                key.numbers(a);
                key.numbers(b);
            })
        };
        assert_eq!(both(b"ab", b"c"), both(b"ab", b"c"));
        assert_ne!(both(b"ab", b"c"), both(b"a", b"bc"));
        assert_ne!(both(b"", b"abc"), both(b"abc", b""));
        assert_ne!(key(|key| key.numbers(&[0.0f64])), key(|key| key.numbers(&[-0.0f64])));
        assert_ne!(key(|key| key.value(&0.0f64)), key(|key| key.value(&-0.0f64)));
        let next = f64::from_bits(1.1f64.to_bits() + 1);
        assert_ne!(key(|key| key.value(&1.1f64)), key(|key| key.value(&next)));
    }

    #[test]
    fn many_numbers_hash_as_few_do() {
        let many: Vec<u32> = (0..super::MANY as u32).collect();
        let mut slowly = blake3::Hasher::new();
        slowly.update(&(many.len() as u64 * 4).to_le_bytes());
        many.iter().for_each(|number| {
            slowly.update(&number.to_le_bytes());
        });
        assert_eq!(key(|key| key.numbers(&many)), *slowly.finalize().as_bytes());
    }
}
