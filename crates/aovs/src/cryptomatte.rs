//! Cryptomatte 1.2 (Friedman and Jones, 2015): mattes by name. Each pixel has the names that show in it, as numbers,
//! and how much of the pixel each of them covers, the largest first.

use std::collections::BTreeMap;

use crate::planes::{in_steps, planes};
use impasto_frame_files::exr_file::{Channel, Note, Samples};

/// How many names a pixel keeps.
const RANKS: usize = 6;

/// Coverage is rounded to a multiple of this.
const COVERAGE_STEP: f32 = 1.0 / 1024.0;

/// MurmurHash3, 32 bits, seed 0 (Appleby, 2011), of a text in UTF-8.
pub fn hash(text: &str) -> u32 {
    let mixed = |word: u32| word.wrapping_mul(0xcc9e_2d51).rotate_left(15).wrapping_mul(0x1b87_3593);
    let bytes = text.as_bytes();
    let words = bytes.chunks_exact(4);
    let tail = words.remainder();
    let mut state = words.fold(0u32, |state, word| {
        let word = u32::from_le_bytes([word[0], word[1], word[2], word[3]]);
        (state ^ mixed(word)).rotate_left(13).wrapping_mul(5).wrapping_add(0xe654_6b64)
    });
    if !tail.is_empty() {
        state ^= mixed(tail.iter().rev().fold(0, |word, &byte| word << 8 | u32::from(byte)));
    }
    state ^= bytes.len() as u32;
    state = (state ^ state >> 16).wrapping_mul(0x85eb_ca6b);
    state = (state ^ state >> 13).wrapping_mul(0xc2b2_ae35);
    state ^ state >> 16
}

/// The bits of the float that stands for a name. They are the hash, with one bit of the exponent flipped where the
/// float would be infinite, NaN, zero or denormal.
pub fn id_bits(name: &str) -> u32 {
    let hash = hash(name);
    let exponent = hash >> 23 & 255;
    if exponent == 0 || exponent == 255 { hash ^ 1 << 23 } else { hash }
}

/// The mattes of one kind.
pub(crate) struct Matte {
    /// Its name, such as `CryptoObject`.
    pub(crate) kind: &'static str,
    /// The names that the file lists, by their [`id_bits`].
    pub(crate) names: BTreeMap<u32, String>,
}

impl Matte {
    pub(crate) fn new<'a>(kind: &'static str, names: impl IntoIterator<Item = &'a str>) -> Self {
        Self { kind, names: names.into_iter().map(|name| (id_bits(name), name.to_owned())).collect() }
    }

    /// The channels. `found` lists what a pixel shows: pairs of [`id_bits`] and share; an id may come several times.
    pub(crate) fn channels(
        &self,
        pixels: usize,
        found: impl Fn(usize, &mut Vec<(u32, f32)>) + Sync,
    ) -> Vec<Channel> {
        let planes = planes(pixels, 2 * RANKS, |pixel, values: &mut [f32]| {
            let mut of_pixel: Vec<(u32, f32)> = Vec::new();
            found(pixel, &mut of_pixel);
            for (pair, &(bits, amount)) in values.chunks_exact_mut(2).zip(ranked(&mut of_pixel)) {
                pair.copy_from_slice(&[f32::from_bits(bits), in_steps(amount, COVERAGE_STEP)]);
            }
        });
        let letters = ["R", "G", "B", "A"];
        let name = |plane: usize| format!("{}{:02}.{}", self.kind, plane / 4, letters[plane % 4]);
        planes
            .into_iter()
            .enumerate()
            .map(|(plane, values)| Channel::new(name(plane), Samples::Float(values)))
            .collect()
    }

    /// The metadata that tells other programs where the mattes are in the file, and which names they hold.
    pub(crate) fn notes(&self) -> Vec<(String, Note)> {
        let key = &format!("{:08x}", hash(self.kind))[..7];
        let manifest: BTreeMap<&str, String> =
            self.names.iter().map(|(bits, name)| (name.as_str(), format!("{bits:08x}"))).collect();
        let manifest = serde_json::to_string(&manifest).unwrap_or_default();
        [
            ("name", self.kind.to_owned()),
            ("hash", "MurmurHash3_32".to_owned()),
            ("conversion", "uint32_to_float32".to_owned()),
            ("manifest", manifest),
        ]
        .map(|(field, words)| (format!("cryptomatte/{key}/{field}"), Note::Text(words)))
        .to_vec()
    }
}

/// Sums the shares of each id, and sorts: the largest sum first, of equal sums the lower id.
fn ranked(found: &mut Vec<(u32, f32)>) -> &[(u32, f32)] {
    found.sort_unstable_by_key(|&(bits, _)| bits);
    found.dedup_by(|next, kept| {
        let same = next.0 == kept.0;
        if same {
            kept.1 += next.1;
        }
        same
    });
    found.sort_by(|left, right| right.1.total_cmp(&left.1));
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The numbers that Blender writes.
    #[test]
    fn names_have_the_numbers_that_others_give_them() {
        assert_eq!(hash("Cube"), 0xa8fc_e865);
        assert_eq!(hash("Ball"), 0x74d3_ebe9);
        assert_eq!(hash("Arm"), 0xb0ae_e05f);
        assert_eq!(hash("ViewLayer.CryptoObject") >> 4, 0x0542_cafa);
        assert_eq!(hash(""), 0);
    }

    #[test]
    fn a_number_is_never_odd_as_a_float() {
        for index in 0..100_000 {
            let number = f32::from_bits(id_bits(&format!("name {index}")));
            assert!(number.is_normal(), "name {index}");
        }
    }

    #[test]
    fn names_are_ranked_by_what_they_cover_together() {
        let matte = Matte::new("CryptoObject", ["a", "b"]);
        let [a, b] = ["a", "b"].map(id_bits);
        let channels = matte.channels(2, |pixel, found| {
            if pixel == 1 {
                found.extend([(a, 0.25), (b, 0.375), (a, 0.25)]);
            }
        });
        let value = |name: &str| {
            let channel = channels.iter().find(|channel| channel.name == name).unwrap();
            let Samples::Float(values) = &channel.samples else { panic!("{name}") };
            assert_eq!(values[0], 0.0);
            values[1]
        };
        assert_eq!(channels.len(), 12);
        assert_eq!(value("CryptoObject00.R").to_bits(), a);
        assert_eq!(value("CryptoObject00.G"), 0.5);
        assert_eq!(value("CryptoObject00.B").to_bits(), b);
        assert_eq!(value("CryptoObject00.A"), 0.375);
        assert_eq!(value("CryptoObject02.A"), 0.0);
    }
}
