//! The `impasto` command: paints scenes without a window, inspects them, and opens the editor.

mod args;
mod brushes;
mod cache;
mod check;
mod doctor;
#[cfg(feature = "editor")]
mod edit;
mod failure;
mod farm;
mod farm_args;
mod info;
mod interrupt;
mod manual;
mod measure;
mod memory_size;
mod movie;
mod new;
mod picture_args;
mod progress;
mod relight;
mod render;
mod scene_args;
mod serve;
mod session;
mod set;
mod sheet;
mod strokes;
mod talk;
#[cfg(feature = "editor")]
mod window_libraries;

use std::io::Write as _;
use std::process::ExitCode;

use clap::{CommandFactory as _, Parser as _};

use args::{Arguments, Command};
use failure::Failure;

/// The answer to `impasto --version --json`. Other programs ask for it before they use this one. `None` for any other
/// command line.
fn version_as_json() -> Option<String> {
    let words: Vec<_> = std::env::args_os().skip(1).collect();
    let is = |wanted: &[&str]| words.iter().any(|word| wanted.iter().any(|wanted| word == wanted));
    let asked = words.len() == 2 && is(&["--version", "-V"]) && is(&["--json"]);
    asked.then(|| {
        let version = env!("CARGO_PKG_VERSION");
        serde_json::json!({ "name": "impasto", "version": version, "serve": serve::VERSION }).to_string()
    })
}

fn main() -> ExitCode {
    if let Some(line) = version_as_json() {
        let written = writeln!(std::io::stdout(), "{line}");
        return if written.is_ok() { ExitCode::SUCCESS } else { ExitCode::FAILURE };
    }
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => {
            // Asking for help or the version is not an error.
            let code = if error.use_stderr() { failure::USAGE } else { 0 };
            let _ = error.print();
            return ExitCode::from(code);
        }
    };
    let result = match arguments.command {
        #[cfg(feature = "editor")]
        Command::Edit(arguments) => edit::run(&arguments),
        Command::Render(arguments) => render::run(&arguments),
        Command::Movie(arguments) => movie::run(&arguments),
        Command::New(arguments) => new::run(&arguments),
        Command::Farm(command) => farm::farm(&command),
        Command::Pack(arguments) => farm::pack(&arguments),
        Command::Set(arguments) => set::run(&arguments),
        Command::Serve(arguments) => serve::run(&arguments),
        Command::Check(arguments) => check::run(&arguments),
        Command::Info(arguments) => info::run(&arguments),
        Command::Strokes(arguments) => strokes::run(&arguments),
        Command::Measure(arguments) => measure::run(&arguments),
        Command::Brushes(arguments) => brushes::run(&arguments),
        Command::Relight(arguments) => relight::run(&arguments),
        Command::Doctor(arguments) => doctor::run(&arguments),
        Command::Completions { shell } => {
            // Into memory first: `generate` would panic if standard output were closed.
            let mut text = Vec::new();
            clap_complete::generate(shell, &mut Arguments::command(), "impasto", &mut text);
            std::io::stdout().write_all(&text).map_err(Failure::from)
        }
        Command::Man { folder } => manual::write(&folder),
    };
    let _ = std::io::stdout().flush();
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            if let Some(words) = failure.words() {
                eprintln!("{words}");
            }
            ExitCode::from(failure.code())
        }
    }
}

impl From<std::io::Error> for Failure {
    fn from(error: std::io::Error) -> Self {
        // Whoever reads our output may stop reading (`| head`): that is not an error.
        if error.kind() == std::io::ErrorKind::BrokenPipe {
            Self::Quiet(0)
        } else {
            Self::Other(error.to_string())
        }
    }
}
