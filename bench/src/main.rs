//! `cargo xtask bench`: Impasto's times beside those of others, on the same inputs and in the same run, in one table.
//!
//! ```text
//! arguments ─▶ parts ─▶ each: inputs ─▶ equal answers? ─▶ race: rounds in which all take turns ─▶ rows
//!                                                            │ (a peer that is a separate program waits for its turn)
//! rows ─▶ table on stdout (text or JSON), plots under out/bench/, results of this machine, docs/performance.md
//! ```

mod arguments;
mod bench;
mod bending;
mod counted;
mod docs;
mod floor;
mod gltf_loading;
mod growth;
mod inputs;
mod live;
mod loading;
mod machine;
mod memory;
mod morton;
mod neighbours;
mod noise_displace;
mod paper_scenes;
mod parts;
mod peers;
mod plots;
mod race;
mod results;
mod sampling;
mod sequence;
mod solving;
mod stroke_pass;
mod table;

use std::path::Path;
use std::process::ExitCode;

use anyhow::Context as _;

use arguments::Arguments;
use bench::{Bench, Mode};

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let done = match Arguments::parse(&words) {
        Ok(Some(arguments)) => run(&arguments),
        Ok(None) => {
            println!("{}", arguments::usage());
            Ok(())
        }
        Err(error) => Err(error),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("bench: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &Arguments) -> anyhow::Result<()> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().context("the repository's folder")?;
    // Read first: an error in it should show before minutes of measuring.
    let before = arguments.against.as_deref().map(results::read).transpose()?;
    if arguments.install {
        peers::toolchain::install()?;
    }
    let mode = if arguments.quick { Mode::Quick } else { Mode::Full };
    let mut bench = Bench::new(root, mode, arguments.may_fetch);
    bench.table.head = machine::head(if arguments.quick { "quick" } else { "full" });
    for part in arguments.parts() {
        eprintln!("{}: {}", part.name, part.about);
        (part.run)(&mut bench).with_context(|| format!("part `{}`", part.name))?;
    }
    let table = &bench.table;
    if arguments.json {
        println!("{:#}", table::json(table));
    } else {
        print!("{}", table::text(table));
    }
    let folder = root.join("out/bench");
    std::fs::create_dir_all(&folder)?;
    for file in plots::draw(&folder, &bench.curves)? {
        eprintln!("plotted: {}", file.display());
    }
    if let Some(before) = before {
        print!("\n{}", before.moved(&results::Results::of(table)));
    }
    if arguments.keep {
        let file = root.join(format!("bench/results/{}.txt", machine::slug()));
        results::Results::of(table).write(&file)?;
        eprintln!("saved: {}", file.display());
    }
    if arguments.write_docs {
        let page = root.join("docs/performance.md");
        docs::write(&page, table)?;
        eprintln!("written: {}", page.display());
    }
    Ok(())
}
