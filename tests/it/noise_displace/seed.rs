//! The source's shader (its tables 4 and 5), rewritten line by line to judge ours. `time_x`, Unity's `_Time.x`, is
//! seconds / 20.

use glam::{DAffine3, DVec3};
use impasto_core::noise_displace::Tile;

/// `tex2D` of a repeating texture: bilinear, with texels weighted by how near their centres are.
pub fn tex2d(tile: &Tile, u: f64, v: f64) -> [f64; 4] {
    let [columns, rows] = tile.size().map(|side| side as i64);
    let (x, y) = (u * columns as f64 - 0.5, v * rows as f64 - 0.5);
    let mut sum = [0.0; 4];
    for row in y.floor() as i64..=y.floor() as i64 + 1 {
        for column in x.floor() as i64..=x.floor() as i64 + 1 {
            let weight = (1.0 - (x - column as f64).abs()).max(0.0) * (1.0 - (y - row as f64).abs()).max(0.0);
            let index = row.rem_euclid(rows) * columns + column.rem_euclid(columns);
            for (sum, value) in sum.iter_mut().zip(tile.texels()[index as usize]) {
                *sum += weight * f64::from(value);
            }
        }
    }
    sum
}

/// The inputs of the vertex shader.
pub struct Vert<'a> {
    pub noise_tex: &'a Tile,
    /// `unity_ObjectToWorld`; the identity for the source's equation 1.
    pub object_to_world: DAffine3,
    pub noise_value: [f64; 2],
    pub noise_scale: f64,
    pub time_x: f64,
}

impl Vert<'_> {
    /// Where a vertex is moved: the source's table 4.
    pub fn displaced(&self, v: DVec3) -> DVec3 {
        let vertex = self.object_to_world.transform_point3(v);
        let at = [0, 1].map(|axis: usize| vertex[axis] * self.noise_value[axis] + self.time_x);
        let noise_move = tex2d(self.noise_tex, at[0], at[1]);
        let by = [0, 1, 2].map(|axis: usize| (noise_move[axis].clamp(0.0, 1.0) - 0.5) * self.noise_scale);
        v + DVec3::from(by)
    }
}

/// The inputs of the fragment shader.
pub struct Frag<'a> {
    pub noise_tex2: &'a Tile,
    pub max_index: u32,
    pub speed: f64,
    pub time_x: f64,
    /// −1 as in the source's code; 1 as in its text, where even layers go forward.
    pub reverse_factor: f64,
}

impl Frag<'_> {
    /// The colour at a texture coordinate, before the tint: the source's table 5.
    pub fn tex(&self, texcoord: [f64; 2]) -> [f64; 4] {
        let mut tex = [1.0; 4];
        let mut reverse_factor = self.reverse_factor;
        let max_index = f64::from(self.max_index);
        let mut i = 1.0;
        while i < max_index {
            let move_factor = i / max_index;
            reverse_factor *= -1.0;
            let time_factor = (self.time_x + move_factor) * reverse_factor;
            for shift in [[time_factor, 0.0], [0.0, time_factor]] {
                let [u, v] =
                    [0, 1].map(|axis: usize| texcoord[axis] + move_factor + self.speed * shift[axis]);
                for (tex, value) in tex.iter_mut().zip(tex2d(self.noise_tex2, u, v)) {
                    *tex *= value;
                }
            }
            i += 1.0;
        }
        tex.map(|value| value.powf(1.0 / max_index).clamp(0.0, 1.0))
    }
}
