//! Draws the icons of lights by code. In the texture, the first channel is an icon's ink, the second the disc under
//! it.

use glam::Vec2;

/// Texels along a side.
pub(super) const SIDE: usize = 64;

pub(super) const COUNT: u32 = 3;

/// Half the width of a line, in halves of the icon's side.
const LINE: f32 = 0.055;

/// Radius of the disc, in halves of the icon's side.
const DISC: f32 = 0.94;

/// Distance of a point to the drawn shape; negative inside. Points are in −1..1 both ways, Y up.
type Outline = fn(Vec2) -> f32;

const ICONS: [Outline; COUNT as usize] = [sun, bulb, dome];

/// The mipmap levels, finest first. Each holds the texels of all icons one after the other, rows from the bottom.
pub(super) fn levels() -> Vec<Vec<u8>> {
    let mut side = SIDE;
    let mut levels = Vec::new();
    while side > 0 {
        let texels = ICONS.iter().flat_map(|outline| {
            (0..side * side).flat_map(move |index| texel(*outline, [index % side, index / side], side))
        });
        levels.push(texels.collect());
        side /= 2;
    }
    levels
}

/// One texel of an icon; edges are one texel of the level wide.
fn texel(outline: Outline, [x, y]: [usize; 2], side: usize) -> [u8; 4] {
    let texel = 2.0 / side as f32;
    let at = (Vec2::new(x as f32, y as f32) + 0.5) * texel - 1.0;
    let covered = |outside: f32| (255.0 * (0.5 - outside / texel).clamp(0.0, 1.0)).round() as u8;
    [covered(outline(at)), covered(at.length() - DISC), 0, 255]
}

fn line(at: Vec2, from: Vec2, to: Vec2) -> f32 {
    let t = ((at - from).dot(to - from) / (to - from).length_squared()).clamp(0.0, 1.0);
    at.distance(from.lerp(to, t)) - LINE
}

/// A disc and eight rays.
fn sun(at: Vec2) -> f32 {
    let eighth = std::f32::consts::FRAC_PI_4;
    let nearest = (at.to_angle() / eighth).round() * eighth;
    let ray = Vec2::from_angle(nearest);
    (at.length() - 0.26).min(line(at, ray * 0.44, ray * 0.66))
}

/// A bulb over its thread.
fn bulb(at: Vec2) -> f32 {
    let glass = (at - Vec2::new(0.0, 0.16)).length() - 0.36;
    let neck = (at - Vec2::new(0.0, -0.16)).abs() - Vec2::new(0.15, 0.14);
    let neck = neck.max_element();
    let thread = |y: f32| line(at, Vec2::new(-0.13, y), Vec2::new(0.13, y));
    glass.min(neck).min(thread(-0.44)).min(thread(-0.6))
}

/// Half a disc over the line of the ground.
fn dome(at: Vec2) -> f32 {
    let half = (at - Vec2::new(0.0, -0.12)).length() - 0.48;
    let half = half.max(-0.06 - at.y);
    half.min(line(at, Vec2::new(-0.6, -0.3), Vec2::new(0.6, -0.3)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn icons_differ_lie_on_their_disc_and_every_level_has_ink() {
        let levels = levels();
        assert_eq!(levels.len(), 7);
        assert_eq!(levels[0].len(), SIDE * SIDE * 4 * ICONS.len());
        let icons: Vec<&[u8]> = levels[0].chunks(SIDE * SIDE * 4).collect();
        assert!(icons[0] != icons[1] && icons[1] != icons[2] && icons[2] != icons[0]);
        for icon in icons {
            assert!(icon.chunks(4).all(|texel| texel[0] == 0 || texel[1] == 255), "ink off its disc");
            let share = icon.chunks(4).filter(|texel| texel[0] > 127).count() as f32 / (SIDE * SIDE) as f32;
            assert!((0.08..0.4).contains(&share), "{share}");
        }
        assert!(levels.iter().take(5).all(|level| level.chunks(4).any(|texel| texel[0] > 100)));
    }
}
