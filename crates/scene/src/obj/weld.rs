//! Positions that are equal, found in one pass.

use std::hash::{BuildHasher, RandomState};

use glam::Vec3;

/// One place for all positions that are equal, so that seams of the file's vertices do not show as creases; and for each
/// position the number of its place.
pub(super) fn weld(positions: &[[f64; 3]]) -> (Vec<Vec3>, Vec<u32>) {
    // A table of places, at most half full; a slot that is taken sends on to the next.
    const FREE: u32 = u32::MAX;
    let mask = (2 * positions.len()).next_power_of_two() - 1;
    let mut place_at = vec![FREE; mask + 1];
    let mut places: Vec<Vec3> = Vec::with_capacity(positions.len());
    // No file can be written to fill one stretch of the table: it does not know the key.
    let key = RandomState::new();
    let keys = [key.hash_one(0), key.hash_one(1)];
    let place_of_position = positions.iter().map(|position| {
        // Adding 0 makes -0 and 0 the same.
        let at = Vec3::from_array(position.map(|value| value as f32 + 0.0));
        let mut slot = hash(at, keys) as usize & mask;
        while place_at[slot] != FREE && places[place_at[slot] as usize] != at {
            slot = (slot + 1) & mask;
        }
        if place_at[slot] == FREE {
            place_at[slot] = places.len() as u32;
            places.push(at);
        }
        place_at[slot]
    });
    let place_of_position = place_of_position.collect();
    (places, place_of_position)
}

/// Both halves of a product of two words, each behind its key.
fn hash(at: Vec3, keys: [u64; 2]) -> u64 {
    let [x, y, z] = at.to_array().map(|value| u64::from(value.to_bits()));
    let product = u128::from(x << 32 ^ y ^ keys[0]) * u128::from(z ^ keys[1]);
    product as u64 ^ (product >> 64) as u64
}
