//! Measures rendering frames of the still life to files: `impasto render` as it is, beside the same command with one
//! thread in all. The driver then has no threads of its own.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

use anyhow::{Context as _, ensure};

use crate::bench::Bench;
use crate::table::{Figure, Goal, Row, Spread, Unit};

/// Frames of the sequence, in a full and in a quick benchmark.
const FRAMES: usize = 120;
const QUICK_FRAMES: usize = 16;

/// The environment that leaves one thread to Impasto and none to llvmpipe.
const ALONE: [(&str, &str); 2] = [("LP_NUM_THREADS", "0"), ("RAYON_NUM_THREADS", "1")];

/// Builds the `impasto` command; returns its path.
fn command(root: &Path) -> anyhow::Result<PathBuf> {
    let built = Command::new(env!("CARGO"))
        .args(["build", "--release", "--locked", "-p", "impasto-cli", "--message-format=json"])
        .current_dir(root)
        .stderr(Stdio::inherit())
        .output()?;
    ensure!(built.status.success(), "the command could not be built");
    let text = String::from_utf8_lossy(&built.stdout);
    let file = text.lines().rev().find_map(|line| {
        let (_, rest) = line.split_once("\"executable\":\"")?;
        Some(PathBuf::from(rest.split_once('"')?.0))
    });
    file.context("cargo did not report the path of the command")
}

/// Renders the first frames into a folder; returns the seconds of the whole command.
fn render_secs(
    command: &Path,
    root: &Path,
    folder: &Path,
    frames: usize,
    alone: bool,
) -> anyhow::Result<f64> {
    let start = Instant::now();
    let mut run = Command::new(command);
    run.args(["render", "scenes/still_life.ron", "-q", "--frames", &format!("0-{}", frames - 1), "-o"])
        .arg(folder.join("frame_####.png"))
        .current_dir(root);
    if alone {
        run.envs(ALONE);
    }
    ensure!(run.status()?.success(), "the frames were not written");
    Ok(start.elapsed().as_secs_f64())
}

fn check_same(folders: [&Path; 2], frames: usize) -> anyhow::Result<()> {
    for frame in 0..frames {
        let [ours, alone] = folders.map(|folder| std::fs::read(folder.join(format!("frame_{frame:04}.png"))));
        ensure!(ours? == alone?, "frame {frame} differs with one thread");
    }
    Ok(())
}

/// Measures both runs, one after the other.
pub fn run(bench: &mut Bench) -> anyhow::Result<()> {
    let frames = if bench.quick() { QUICK_FRAMES } else { FRAMES };
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let command = command(&root)?;
    let scratch = std::env::temp_dir().join(format!("impasto-sequence-{}", std::process::id()));
    let (ours, alone) = (scratch.join("ours"), scratch.join("alone"));
    // One run each: they are long enough.
    let ours_secs = render_secs(&command, &root, &ours, frames, false)?;
    let alone_secs = render_secs(&command, &root, &alone, frames, true)?;
    check_same([&ours, &alone], frames)?;
    // Removed only after success: the files of a failed run may tell why.
    let _ = std::fs::remove_dir_all(&scratch);
    let figures = vec![
        Figure::new("Impasto", Unit::Seconds, Spread::exact(ours_secs))
            .noted("the whole command, preparing too"),
        Figure::new("one thread", Unit::Seconds, Spread::exact(alone_secs))
            .noted("of ours, and of the driver"),
    ];
    let row = Row::of_race("sequence", &format!("still_life, {frames} frames"), figures, false);
    bench.push(row.meant(Goal::Faster { than: "one thread", times: 1.7 }));
    Ok(())
}
