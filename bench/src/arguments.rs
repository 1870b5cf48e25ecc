//! The command line of the benchmark.

use std::path::PathBuf;

use anyhow::bail;

use crate::parts::{PARTS, Part};

/// What the command line asks for.
#[derive(Debug, Default)]
pub struct Arguments {
    /// Names of parts. If empty, all parts run, or with `quick` those that [`Part::quick`] marks.
    named: Vec<String>,
    /// Smaller inputs and fewer rounds: under two minutes.
    pub quick: bool,
    /// JSON in place of text.
    pub json: bool,
    /// A file of results to compare with.
    pub against: Option<PathBuf>,
    /// Whether to save the results of this machine.
    pub keep: bool,
    /// Whether to write the table into the docs.
    pub write_docs: bool,
    /// Whether to install the Debian packages that the peers (the programs that Impasto is compared with) need.
    pub install: bool,
    /// Whether Python packages may be fetched.
    pub may_fetch: bool,
}

impl Arguments {
    /// Reads the words of the command line; `None` if they ask for help.
    ///
    /// # Errors
    /// If a word is unknown, or `--against` names no file.
    pub fn parse(words: &[String]) -> anyhow::Result<Option<Self>> {
        let mut arguments = Self { may_fetch: true, ..Self::default() };
        let mut words = words.iter();
        while let Some(word) = words.next() {
            match word.as_str() {
                "--help" | "-h" | "help" => return Ok(None),
                "--quick" => arguments.quick = true,
                "--json" => arguments.json = true,
                "--keep" => arguments.keep = true,
                "--write-docs" => arguments.write_docs = true,
                "--install" => arguments.install = true,
                "--no-fetch" => arguments.may_fetch = false,
                "--against" => match words.next() {
                    Some(file) => arguments.against = Some(PathBuf::from(file)),
                    None => bail!("--against which file?"),
                },
                name if PARTS.iter().any(|part| part.name == name) => arguments.named.push(name.to_owned()),
                _ => bail!("`{word}` is neither a part nor an option\n{}", usage()),
            }
        }
        Ok(Some(arguments))
    }

    /// The parts that are asked for, in the order of [`PARTS`].
    pub fn parts(&self) -> impl Iterator<Item = &'static Part> {
        PARTS.iter().filter(|part| match self.named.as_slice() {
            [] => part.quick || !self.quick,
            named => named.iter().any(|name| name == part.name),
        })
    }
}

/// The help text.
pub fn usage() -> String {
    let parts: String = PARTS.iter().map(|part| format!("  {:<16}{}\n", part.name, part.about)).collect();
    format!(
        "\
cargo xtask bench -- [PART …] [OPTION …]
parts, all unless some are named:
{parts}options:
  --quick         smaller inputs and fewer rounds: under two minutes
  --json          JSON on stdout in place of text
  --against FILE  what changed beyond the noise since FILE of bench/results/
  --keep          save the results in bench/results/, one file per machine
  --write-docs    write the table into docs/performance.md
  --install       install Debian's packages for the peers first
  --no-fetch      fetch no Python packages: peers that need them are listed as missing"
    )
}
