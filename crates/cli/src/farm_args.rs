//! The arguments of the commands for farms: `farm` and `pack`.

use std::path::PathBuf;

use clap::{Args, Subcommand};

#[derive(Debug, Subcommand)]
pub(crate) enum FarmCommand {
    /// An Open Job Description template, for AWS Deadline Cloud and the openjd command.
    Openjd(FarmArguments),
    /// An array script for Slurm.
    Slurm(SlurmArguments),
}

#[derive(Args, Debug)]
pub(crate) struct FarmArguments {
    /// A scene (.ron), a model (.obj) or a shot (.glb, .gltf), as the machines of the farm find it.
    pub(crate) scene: PathBuf,
    /// A further folder that meshes and textures may come from; can be repeated. impasto pack makes it needless.
    #[arg(long = "asset-dir", value_name = "DIR")]
    pub(crate) asset_dirs: Vec<PathBuf>,
    /// Where frames go, as the machines find it: #### stands for the frame number.
    #[arg(short, long, default_value = "out/frame_####.png")]
    pub(crate) output: String,
    /// Which frames: a, a-b or a..b, with xN or :N behind for every Nth; commas between several. Left out, the scene's
    /// own.
    #[arg(short, long, allow_hyphen_values = true)]
    pub(crate) frames: Option<String>,
    /// Then make this movie of the frames: .mp4, .mkv, .mov or .webm.
    #[arg(long, value_name = "MOVIE")]
    pub(crate) movie: Option<String>,
    /// Write the job into this file; left out, it goes to standard output.
    #[arg(long, value_name = "FILE")]
    pub(crate) job: Option<PathBuf>,
    /// Further arguments of impasto render, after --, such as -- --size 1920x1080 --cache /share/cache.
    #[arg(last = true, value_name = "RENDER ARGUMENTS")]
    pub(crate) more: Vec<String>,
}

#[derive(Args, Debug)]
pub(crate) struct SlurmArguments {
    #[command(flatten)]
    pub(crate) farm: FarmArguments,
    /// How many frames a task paints; left out, 10, or more where that would make over 1000 tasks.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    pub(crate) chunk: Option<u32>,
}

#[derive(Args, Debug)]
pub(crate) struct PackArguments {
    /// A scene (.ron), a model (.obj) or a shot (.glb, .gltf); with --check, a folder that was packed.
    pub(crate) scene: PathBuf,
    /// A further folder that meshes and textures may come from; can be repeated. What is used of it goes into the pack.
    #[arg(long = "asset-dir", value_name = "DIR")]
    pub(crate) asset_dirs: Vec<PathBuf>,
    /// The pack: a .tar file, or a new folder.
    #[arg(short, long, required_unless_present = "check")]
    pub(crate) output: Option<PathBuf>,
    /// Check that a packed folder is as it was packed, by this version of impasto; nothing is written.
    #[arg(long, conflicts_with_all = ["output", "asset_dirs"])]
    pub(crate) check: bool,
    /// Say nothing but errors.
    #[arg(short, long)]
    pub(crate) quiet: bool,
}
