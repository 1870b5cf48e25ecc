//! Automation of the repository: `cargo xtask <command>`. Cargo alone builds and starts it; some commands call other
//! programs (apt-get, git, python3, Blender).

#![expect(clippy::print_stdout, reason = "these commands exist to print what they found")]

mod bench;
mod blender;
mod ci;
mod demo;
mod faults;
mod fuzz;
mod gallery;
mod layers;
mod measure;
mod package;
mod packages;
mod same;
mod steps;
mod strange;
mod test;
mod tidy;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::{Context as _, bail};

use crate::packages::Install;

const USAGE: &str = "\
cargo xtask <command>
  ci                          everything that .ci/run checks
  test [--no-install] [-- …]  install what the tests need, run them all (… goes to cargo test)
  demo [--no-install]         install what rendering needs, build, paint a short animation into out/
  layers                      every arrow between crates is one that ARCHITECTURE.md allows
  tidy                        long files, empty names, half a technique, big pictures, unfinished work
  gallery [NAME …]            render the pictures of the README and the docs into docs/pictures/
  measure [--shots] [SCENE …] measure the shipped scenes and write the table of docs/techniques/rotating_strokes.md;
                              with --shots every frame of their shots, for docs/steadiness.md
  same [--keep]               pictures and strokes are, byte for byte, those of the last `same --keep`
  bench [-- …]                the benchmarks of bench/
  blender                     build the Blender extension, install it into real Blenders (fetched where they are not), test it
  package [--no-install]      a .deb, a .tar.zst and a wheel of the program, in target/package/ (docs/install.md)
  fuzz [--minutes N] [TARGET …]
                              throw strange files at all readers, led by coverage; 30 minutes a target
  strange [--minutes N] [--seed S] [--only NUMBER]
                              make strange files, another seed each time, and try the program on them; 10 minutes
  faults [NAME …]             plant each fault of a list in a shader, and see that a test notices it
  meshes                      write the meshes of scenes/meshes/ anew";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match run(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("xtask: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &[String]) -> anyhow::Result<()> {
    let root = repository_root()?;
    let Some((command, rest)) = arguments.split_first() else { bail!("which command?\n{USAGE}") };
    let (own, passed_on) = match rest.iter().position(|argument| argument == "--") {
        Some(at) => (&rest[..at], &rest[at + 1..]),
        None => (rest, &[][..]),
    };
    let mut install = Install::Yes;
    let mut keep = false;
    for flag in own {
        match (command.as_str(), flag.as_str()) {
            ("test" | "demo" | "package", "--no-install") => install = Install::PrintOnly,
            ("same", "--keep") => keep = true,
            ("measure", "--shots") => {}
            ("fuzz" | "strange", _) => {}
            ("gallery" | "measure" | "faults", name) if !name.starts_with('-') => {}
            _ => bail!("`{command}` does not know `{flag}`\n{USAGE}"),
        }
    }
    if !passed_on.is_empty() && !matches!(command.as_str(), "test" | "bench") {
        bail!("`{command}` passes nothing on\n{USAGE}");
    }
    match command.as_str() {
        "ci" => ci::run(&root),
        "test" => test::run(&root, install, passed_on),
        "demo" => demo::run(&root, install),
        "layers" => layers::run(&root),
        "tidy" => tidy::run(&root),
        "gallery" => gallery::run(&root, own),
        "measure" => measure::run(&root, own),
        "same" => same::run(&root, keep),
        "bench" => bench::run(&root, passed_on),
        "blender" => blender::run(&root, blender::Fetch::Yes),
        "package" => package::run(&root, install),
        "fuzz" => fuzz::run(&root, own),
        "strange" => strange::run(&root, own),
        "faults" => faults::run(&root, own),
        "meshes" => steps::run(&root, &steps::cargo(), &["run", "--locked", "--package", "impasto-meshes"]),
        "help" | "--help" | "-h" => {
            println!("{USAGE}");
            Ok(())
        }
        _ => bail!("there is no command `{command}`\n{USAGE}"),
    }
}

/// The folder with the workspace's Cargo.toml: the parent of this package's own.
fn repository_root() -> anyhow::Result<PathBuf> {
    let package = std::env::var_os("CARGO_MANIFEST_DIR")
        .map_or_else(|| PathBuf::from(env!("CARGO_MANIFEST_DIR")), PathBuf::from);
    package.parent().map(Path::to_path_buf).context("the xtask package has no parent folder")
}
