//! `cargo xtask demo`: from a bare machine to a short painted animation.

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;

use anyhow::{Context as _, bail};
use serde_json::Value;

use crate::packages::{self, Install};
use crate::steps::{Profile, build, step};

const SCENE: &str = "scenes/still_life.ron";
const FRAMES: usize = 24;

/// Installs what rendering needs, builds in release, paints [`FRAMES`] frames into `out/`, and says what came out.
pub fn run(root: &Path, install: Install) -> anyhow::Result<()> {
    packages::ensure(root, &[packages::RENDERING], install)?;
    let impasto = step("build", || build(root, Profile::Release))?;
    let start = Instant::now();
    let events = step("paint", || paint(root, &impasto))?;
    let named =
        |wanted: &str| events.iter().filter(move |event| event["event"] == wanted).collect::<Vec<_>>();
    let frames = named("frame");
    if frames.len() != FRAMES {
        bail!("{} of {FRAMES} frames were painted", frames.len());
    }
    let strokes: Vec<u64> = frames.iter().filter_map(|frame| frame["strokes"].as_u64()).collect();
    let context = named("context");
    let driver = context.first().and_then(|event| event["driver"].as_str()).unwrap_or("an unnamed driver");
    println!();
    println!("{FRAMES} frames of {SCENE} lie in {}", root.join("out").display());
    println!("  driver   {driver}");
    println!(
        "  strokes  {} to {} a frame",
        strokes.iter().min().context("no frame says how many strokes it has")?,
        strokes.iter().max().copied().unwrap_or_default()
    );
    println!("  seconds  {:.1}", start.elapsed().as_secs_f64());
    println!("  moving   {}", root.join("out/still_life.png").display());
    println!("  sheet    {}", root.join("out/still_life_sheet.png").display());
    Ok(())
}

/// Renders the scene's shot in equal steps, as frames and once more as one moving picture. Returns the events that
/// `impasto` reported for the frames, one per JSON line.
fn paint(root: &Path, impasto: &Path) -> anyhow::Result<Vec<Value>> {
    let frames = format!("0-{}x5", (FRAMES - 1) * 5);
    let render = |more: &[&str]| -> anyhow::Result<String> {
        let output = Command::new(impasto)
            .args(["render", SCENE, "--frames", &frames, "--size", "640x360", "--quiet"])
            .args(more)
            .current_dir(root)
            .stderr(Stdio::inherit())
            .output()
            .with_context(|| format!("{} cannot be started", impasto.display()))?;
        if !output.status.success() {
            bail!("rendering failed: {}; `impasto doctor` says more", output.status);
        }
        Ok(String::from_utf8(output.stdout)?)
    };
    let text = render(&["-o", "out/still_life_####.png", "--contact-sheet", "--json"])?;
    render(&["-o", "out/still_life.png", "--apng"])?;
    text.lines().map(|line| serde_json::from_str(line).with_context(|| format!("no JSON: {line}"))).collect()
}
