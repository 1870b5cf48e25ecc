//! Frames of the still life as files: `impasto render` as it is, and on one thread with one thread of the driver.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

/// Frames in a row.
const FRAMES: usize = 120;
const QUICK_FRAMES: usize = 16;

/// What makes everything take its turn.
const ALONE: [(&str, &str); 2] = [("LP_NUM_THREADS", "0"), ("RAYON_NUM_THREADS", "1")];

/// Wall clock seconds, one run each after the other, in turn.
pub struct Sequence {
    /// How many frames.
    pub frames: usize,
    /// As it is, by run.
    pub ours_secs: Vec<f64>,
    /// One after the other, by run.
    pub alone_secs: Vec<f64>,
}

impl Sequence {
    /// How many times faster than alone, of the best runs.
    pub fn times(&self) -> f64 {
        let best = |seconds: &[f64]| seconds.iter().copied().fold(f64::INFINITY, f64::min);
        best(&self.alone_secs) / best(&self.ours_secs)
    }
}

/// Builds the command and tells where it is.
fn command(root: &Path) -> PathBuf {
    let built = Command::new(env!("CARGO"))
        .args(["build", "--release", "--locked", "-p", "impasto-cli", "--message-format=json"])
        .current_dir(root)
        .stderr(Stdio::inherit())
        .output()
        .expect("cargo starts");
    assert!(built.status.success(), "the command is built");
    let text = String::from_utf8_lossy(&built.stdout);
    let file = text.lines().rev().find_map(|line| {
        let (_, rest) = line.split_once("\"executable\":\"")?;
        Some(PathBuf::from(rest.split_once('"')?.0))
    });
    file.expect("cargo tells where the command is")
}

/// Renders the first frames into a folder; seconds of the whole command.
fn render_secs(command: &Path, (root, folder): (&Path, &Path), frames: usize, alone: bool) -> f64 {
    let start = Instant::now();
    let mut run = Command::new(command);
    run.args(["render", "scenes/still_life.ron", "-q", "--frames", &format!("0-{}", frames - 1), "-o"])
        .arg(folder.join("frame_####.png"))
        .current_dir(root);
    if alone {
        run.envs(ALONE);
    }
    assert!(run.status().expect("the command starts").success(), "the frames are written");
    start.elapsed().as_secs_f64()
}

/// Checks that both write the same bytes.
fn assert_same(folders: [&Path; 2], frames: usize) {
    for frame in 0..frames {
        let [ours, alone] = folders
            .map(|folder| std::fs::read(folder.join(format!("frame_{frame:04}.png"))).expect("the frame is there"));
        assert!(ours == alone, "frame {frame} differs");
    }
}

/// Renders in turn, `runs` times.
pub fn measure(frames: usize, runs: usize) -> Sequence {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let command = command(&root);
    let scratch = std::env::temp_dir().join(format!("impasto-sequence-{}", std::process::id()));
    let (ours, alone) = (scratch.join("ours"), scratch.join("alone"));
    let (mut ours_secs, mut alone_secs) = (Vec::new(), Vec::new());
    for _ in 0..runs {
        ours_secs.push(render_secs(&command, (&root, &ours), frames, false));
        alone_secs.push(render_secs(&command, (&root, &alone), frames, true));
    }
    assert_same([&ours, &alone], frames);
    // What is left behind by a run that failed is to be looked at.
    let _ = std::fs::remove_dir_all(&scratch);
    Sequence { frames, ours_secs, alone_secs }
}

/// Prints it.
pub fn run(quick: bool) {
    let (frames, runs) = if quick { (QUICK_FRAMES, 1) } else { (FRAMES, 3) };
    let sequence = measure(frames, runs);
    println!(
        "sequence, {} frames of still life: {:.2?} s, alone {:.2?} s: {:.2} times",
        sequence.frames,
        sequence.ours_secs,
        sequence.alone_secs,
        sequence.times()
    );
}
