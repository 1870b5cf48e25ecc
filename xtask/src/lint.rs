//! Clippy for the price of our own crates alone. `cargo clippy` would check every outside crate once more, which takes
//! longer than all of ours; here cargo compiles as ever, and calls this program in place of rustc for each crate of the
//! workspace (`RUSTC_WORKSPACE_WRAPPER`). It compiles the crate, then lints it with the same arguments.

use std::ffi::{OsStr, OsString};
use std::path::Path;
use std::process::{Command, ExitStatus};

use anyhow::{Context as _, ensure};

/// Set where this program stands in for rustc.
const STANDS_IN: &str = "IMPASTO_LINT";

/// What cargo needs in its environment to have each crate of the workspace linted as it compiles it.
pub fn environment() -> anyhow::Result<[(&'static str, OsString); 2]> {
    let own = std::env::current_exe().context("where is this program?")?;
    Ok([("RUSTC_WORKSPACE_WRAPPER", own.into()), (STANDS_IN, "1".into())])
}

/// Where cargo called this program in place of rustc: compiles and lints; `None` elsewhere. `arguments` are those of this
/// program, without its own name: the path of rustc, then rustc's arguments.
///
/// # Errors
/// If a compiler cannot be started, the crate does not compile, or clippy has a word to say of it.
pub fn in_place_of_rustc(arguments: &[String]) -> Option<anyhow::Result<()>> {
    std::env::var_os(STANDS_IN)?;
    let (rustc, arguments) = arguments.split_first()?;
    let is_rustc = Path::new(rustc).file_stem() == Some(OsStr::new("rustc"));
    is_rustc.then(|| compile_and_lint(rustc, arguments))
}

fn compile_and_lint(rustc: &str, arguments: &[String]) -> anyhow::Result<()> {
    let run = |command: &mut Command| -> anyhow::Result<ExitStatus> {
        command.status().with_context(|| format!("{} cannot be started", command.get_program().display()))
    };
    let compiled = run(Command::new(rustc).args(arguments))?;
    ensure!(compiled.success(), "rustc: {compiled}");
    // Cargo also asks for versions and the like, where nothing is made.
    if !arguments.iter().any(|argument| argument.starts_with("--emit=")) {
        return Ok(());
    }
    let clippy = Path::new(rustc).with_file_name("clippy-driver");
    let mut command = Command::new(clippy);
    command
        .arg(rustc)
        .args(lints(arguments))
        .env("CLIPPY_ARGS", "-D__CLIPPY_HACKERY__warnings__CLIPPY_HACKERY__");
    let linted = run(&mut command)?;
    ensure!(linted.success(), "clippy: {linted}");
    Ok(())
}

/// The arguments with which a crate is checked as it was compiled: no code is made, and cargo hears of no file.
fn lints(arguments: &[String]) -> Vec<String> {
    let mut lints = Vec::with_capacity(arguments.len());
    let mut arguments = arguments.iter();
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--out-dir" => {
                let folder = Path::new(arguments.next().map_or(".", String::as_str)).join("linted");
                lints.extend(["--out-dir".to_owned(), folder.to_string_lossy().into_owned()]);
            }
            emit if emit.starts_with("--emit=") => lints.push("--emit=metadata".to_owned()),
            json if json.starts_with("--json=") => lints.push("--json=diagnostic-rendered-ansi".to_owned()),
            _ => lints.push(argument.clone()),
        }
    }
    lints
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_crate_is_checked_as_it_was_compiled_but_writes_nothing_that_cargo_reads() {
        let compiled =
            ["--crate-name", "a", "--emit=dep-info,metadata,link", "--json=artifacts", "--out-dir", "deps"];
        let compiled = compiled.map(str::to_owned);
        let wanted = ["--crate-name", "a", "--emit=metadata", "--json=diagnostic-rendered-ansi", "--out-dir"];
        let linted = lints(&compiled);
        assert_eq!(linted[..5], wanted.map(str::to_owned));
        assert!(Path::new(&linted[5]).ends_with("deps/linted"));
        assert!(in_place_of_rustc(&compiled).is_none(), "nobody asked for it");
    }
}
