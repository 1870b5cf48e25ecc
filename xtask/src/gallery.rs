//! `cargo xtask gallery`: the pictures of the README and the docs, rendered anew.

use std::path::Path;

use anyhow::bail;

use crate::steps::{self, build_release, step};
use crate::tidy::pictures::DOCS_LIMIT_BYTES;

/// A picture of the docs: its file name, the scene, and the frame.
struct Picture {
    name: &'static str,
    scene: &'static str,
    frame: i64,
}

const PICTURES: &[Picture] = &[
    Picture { name: "apple", scene: "apple", frame: 0 },
    Picture { name: "fish", scene: "fish", frame: 0 },
    Picture { name: "simple_objects", scene: "simple_objects", frame: 0 },
    Picture { name: "roll_0", scene: "roll", frame: 0 },
    Picture { name: "roll_30", scene: "roll", frame: 30 },
    Picture { name: "turntable", scene: "turntable", frame: 30 },
    Picture { name: "falling_log", scene: "falling_log", frame: 12 },
];

/// Sizes to try, largest first: the first whose file is within the docs' limit is kept.
const SIZES: &[&str] = &["960x540", "800x450", "640x360", "480x270"];

/// Renders every picture into `docs/pictures/`.
pub fn run(root: &Path) -> anyhow::Result<()> {
    let impasto = step("build", || build_release(root))?;
    let impasto = impasto.to_string_lossy().into_owned();
    for picture in PICTURES {
        step(picture.name, || render(root, &impasto, picture))?;
    }
    Ok(())
}

fn render(root: &Path, impasto: &str, picture: &Picture) -> anyhow::Result<()> {
    let scene = format!("scenes/{}.ron", picture.scene);
    if !root.join(&scene).is_file() {
        bail!("{scene} is not there; mend the list in xtask/src/gallery.rs");
    }
    let target = format!("docs/pictures/{}.png", picture.name);
    let frame = picture.frame.to_string();
    for size in SIZES {
        steps::run(root, impasto, &["render", &scene, "--frames", &frame, "--size", size, "-o", &target])?;
        let bytes = std::fs::metadata(root.join(&target))?.len();
        if bytes <= DOCS_LIMIT_BYTES {
            println!("{target}: {size}, {} KB", bytes / 1024);
            return Ok(());
        }
    }
    bail!("{target} is over {} KB even at {}", DOCS_LIMIT_BYTES / 1024, SIZES[SIZES.len() - 1])
}
