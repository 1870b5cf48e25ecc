//! `impasto check`: lists every problem of scenes, with its line and column.

use std::io::Write as _;

use impasto_scene::assets::AssetFolders;
use impasto_scene::load::{LoadOptions, load};
use impasto_scene::problem::{Problem, Severity};

use crate::args::CheckArguments;
use crate::failure::Failure;

pub(crate) fn run(arguments: &CheckArguments) -> Result<(), Failure> {
    let options =
        LoadOptions { folders: AssetFolders::with(arguments.asset_dirs.clone()), ..LoadOptions::default() };
    let mut wrong = 0;
    for path in &arguments.scenes {
        let problems = match load(path, &options) {
            Ok(loaded) => loaded.warnings,
            Err(report) => report.0,
        };
        wrong += u32::from(problems.iter().any(|problem| problem.severity.is_fatal()));
        for problem in &problems {
            if arguments.json {
                writeln!(std::io::stdout(), "{}", as_json(problem))?;
            } else {
                eprintln!("{problem}");
            }
        }
        if !arguments.json {
            let count =
                |fatal: bool| problems.iter().filter(|problem| problem.severity.is_fatal() == fatal).count();
            let (errors, warnings) = (count(true), count(false));
            let verdict = if errors > 0 { "bad" } else { "good" };
            writeln!(
                std::io::stdout(),
                "{}: {verdict}, {}, {}",
                path.display(),
                counted(errors, "error"),
                counted(warnings, "warning"),
            )?;
        }
    }
    if wrong > 0 { Err(Failure::Quiet(3)) } else { Ok(()) }
}

fn as_json(problem: &Problem) -> serde_json::Value {
    serde_json::json!({
        "version": 1,
        "path": problem.path,
        "line": problem.place.map(|place| place.line),
        "column": problem.place.map(|place| place.column),
        "severity": match problem.severity {
            Severity::Warning => "warning",
            Severity::Error => "error",
            Severity::Limit => "limit",
        },
        "message": problem.message,
        "mend": problem.mend,
    })
}

/// A count with its noun: `1 problem`, `3 problems`.
fn counted(count: usize, thing: &str) -> String {
    if count == 1 { format!("1 {thing}") } else { format!("{count} {thing}s") }
}
