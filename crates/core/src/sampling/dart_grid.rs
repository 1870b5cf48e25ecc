//! Tells whether a place is free of accepted particles on the same side of the surface, in a hashed grid whose cells
//! shrink with the spacing.

use glam::Vec3;

/// Marks the end of a chain.
const NONE: u32 = u32::MAX;

/// Accepted particles, chained by grid cell. A cell is at least twice the search radius wide, so that a search reads
/// the eight cells round the nearest grid corner and no others.
pub(super) struct DartGrid {
    cell: f32,
    heads: Vec<u32>,
    entries: Vec<Entry>,
}

struct Entry {
    position: Vec3,
    next: u32,
    normal: Vec3,
}

impl DartGrid {
    pub(super) fn new() -> Self {
        Self { cell: f32::MAX, heads: vec![NONE; 64], entries: Vec::new() }
    }

    /// Makes the grid finer when `radius` has shrunk enough to be worth it.
    pub(super) fn shrink_to(&mut self, radius: f32) {
        if radius * 2.0 < self.cell * 0.66 {
            self.cell = radius * 2.0;
            self.rebuild();
        }
    }

    pub(super) fn insert(&mut self, position: Vec3, normal: Vec3) {
        self.entries.push(Entry { position, normal, next: NONE });
        if self.entries.len() * 2 > self.heads.len() {
            self.rebuild();
        } else {
            self.chain(self.entries.len() - 1);
        }
    }

    /// Whether no accepted particle on the same side is nearer than `radius`.
    pub(super) fn has_room(&self, position: Vec3, normal: Vec3, radius: f32) -> bool {
        let corner = (position / self.cell - 0.5).floor().as_ivec3();
        for offset in 0..8 {
            let key = [corner.x + (offset & 1), corner.y + (offset >> 1 & 1), corner.z + (offset >> 2)];
            let mut at = self.heads[self.slot(key)];
            while at != NONE {
                let entry = &self.entries[at as usize];
                let crowded = entry.position.distance_squared(position) < radius * radius;
                if crowded && entry.normal.dot(normal) > 0.0 {
                    return false;
                }
                at = entry.next;
            }
        }
        true
    }

    fn slot(&self, key: [i32; 3]) -> usize {
        let [x, y, z] = key.map(|value| value as u32);
        let hash = x.wrapping_mul(0x8da6_b343) ^ y.wrapping_mul(0xd816_3841) ^ z.wrapping_mul(0xcb1a_b31f);
        (hash ^ hash >> 15) as usize & (self.heads.len() - 1)
    }

    fn chain(&mut self, index: usize) {
        let key = (self.entries[index].position / self.cell).floor().as_ivec3().to_array();
        let slot = self.slot(key);
        self.entries[index].next = self.heads[slot];
        self.heads[slot] = index as u32;
    }

    fn rebuild(&mut self) {
        self.heads.clear();
        self.heads.resize((self.entries.len() * 4).next_power_of_two().max(64), NONE);
        for index in 0..self.entries.len() {
            self.chain(index);
        }
    }
}
