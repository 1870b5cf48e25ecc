//! The command line options for picture files: bits per channel, exposure, and the data that goes beside the colour.

use std::fmt::Write as _;

use clap::Args;
use impasto_scene::aovs::{AOVS, AovSet};
use impasto_scene::document::Scene;
use impasto_sequence::PngDepth;

use crate::failure::Failure;

#[derive(Args, Debug)]
pub(crate) struct PictureArguments {
    /// Also write an EXR file beside each PNG file: linear colour of 16 bits, and what --aov names.
    #[arg(long)]
    pub(crate) exr: bool,
    /// What EXR files hold beside the colour: all, none, scene, stroke, paint, crypto, or names, with commas between;
    /// --help lists them. The scene's own `aovs` when left out.
    #[arg(long = "aov", value_name = "NAMES", value_delimiter = ',', long_help = aov_help())]
    pub(crate) aovs: Vec<String>,
    /// Bits of each channel of PNG files.
    #[arg(long, value_name = "8|16", default_value = "8", value_parser = png_depth)]
    pub(crate) bits: PngDepth,
    /// Show the finished picture brighter (or darker), in stops; EXR files stay as they are.
    #[arg(long, value_name = "STOPS", default_value_t = 0.0, allow_hyphen_values = true, value_parser = stops)]
    pub(crate) exposure: f32,
}

impl PictureArguments {
    /// What is wanted in EXR files. Unless `quiet`, a line on stderr names what the style of the scene lacks.
    pub(crate) fn aovs_of(&self, scene: &Scene, quiet: bool) -> Result<AovSet, Failure> {
        let words = if self.aovs.is_empty() { &scene.aovs } else { &self.aovs };
        let wanted = AovSet::of_words(words.iter().map(String::as_str)).map_err(Failure::Usage)?;
        let lacking = wanted.without(scene.style.settings().aovs());
        if !lacking.is_empty() && !quiet {
            let names: Vec<&str> = lacking.rows().map(|row| row.name).collect();
            eprintln!("the style {} has no {}: left out", scene.style.info().name, names.join(", "));
        }
        Ok(wanted)
    }
}

/// The long help of `--aov`: a line for each AOV.
fn aov_help() -> String {
    let mut text = "What EXR files hold beside the colour: all, none, scene, stroke, paint, crypto, or names, with commas \
                    between. The scene's own `aovs` when left out.\n"
        .to_owned();
    for row in AOVS {
        // Writing to a String cannot fail.
        let _ = write!(text, "\n{:<16} {}", row.name, row.summary);
    }
    text
}

fn png_depth(text: &str) -> Result<PngDepth, String> {
    match text {
        "8" => Ok(PngDepth::Eight),
        "16" => Ok(PngDepth::Sixteen),
        _ => Err("a channel has 8 or 16 bits".to_owned()),
    }
}

fn stops(text: &str) -> Result<f32, String> {
    const MOST: f32 = 16.0;
    let stops: f32 = text.parse().map_err(|_| "write a number of stops, such as 0.5".to_owned())?;
    if (-MOST..=MOST).contains(&stops) { Ok(stops) } else { Err(format!("from -{MOST} to {MOST}")) }
}
