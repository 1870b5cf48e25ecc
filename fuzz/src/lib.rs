//! What the fuzz targets share.

use std::path::{Path, PathBuf};

use impasto_painting::{FrameOptions, Painting};

/// A small mesh with two groups, as an OBJ file.
pub const MESH: &str = "v -1 -1 0\nv 1 -1 0\nv 1 1 0.3\nv -1 1 0\nv 0 0 1\ng a\nf 1 2 3 4\ng b\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\n";

/// A folder for this process and target, on the RAM disk `/dev/shm` where the system has one.
///
/// # Panics
/// Where it cannot be made.
pub fn folder(target: &str) -> PathBuf {
    let memory = Path::new("/dev/shm");
    let parent = if memory.is_dir() { memory.to_owned() } else { std::env::temp_dir() };
    let folder = parent.join(format!("impasto_fuzz_{target}_{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder of its own");
    folder
}

/// Asserts that all strokes of a painting are finite, at frames near and far.
///
/// # Panics
/// Where one is not.
pub fn assert_finite_strokes(painting: &Painting) {
    for frame in [-1e6, 0.0, 0.37, 7.0, 1e6] {
        let painted = painting.at(frame, &FrameOptions::new([64, 48]));
        for stroke in &painted.strokes {
            let [x, y] = stroke.center_px;
            let [length, width] = [stroke.length_px, stroke.width_px];
            let numbers =
                [x, y, stroke.angle_rad, length, width, stroke.facing_fade, stroke.bow, stroke.skew];
            assert!(numbers.iter().all(|number| number.is_finite()), "at {frame}: {stroke:?}");
        }
    }
}
