//! `impasto man`: manual pages of the program and of each subcommand, made from the help texts of the command line.

use std::path::Path;

use clap::CommandFactory as _;
use clap_mangen::Man;
use impasto_scene::whole_file;

use crate::args::Arguments;
use crate::failure::Failure;

/// Writes `impasto.1`, `impasto-render.1` and so on into this folder.
pub(crate) fn write(folder: &Path) -> Result<(), Failure> {
    std::fs::create_dir_all(folder).map_err(|error| Failure::of_file(folder, error))?;
    for (name, text) in pages()? {
        let path = folder.join(name);
        whole_file::write(&path, &text).map_err(|error| Failure::of_file(&path, error))?;
    }
    Ok(())
}

/// The pages: their file names, and their texts in roff.
fn pages() -> Result<Vec<(String, Vec<u8>)>, std::io::Error> {
    let mut program = Arguments::command().disable_help_subcommand(true);
    program.build();
    let parts = program.get_subcommands().filter(|part| !part.is_hide_set()).cloned();
    let commands: Vec<clap::Command> = std::iter::once(program.clone()).chain(parts).collect();
    let source = format!("impasto {}", env!("CARGO_PKG_VERSION"));
    let page = |command: clap::Command| {
        let title = command.get_display_name().unwrap_or_else(|| command.get_name()).to_uppercase();
        let page = Man::new(command).title(title).source(&source).manual("Impasto");
        let mut text = Vec::new();
        page.render(&mut text)?;
        Ok((page.get_filename(), text))
    };
    commands.into_iter().map(page).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_subcommand_that_help_names_has_a_page_and_no_other() {
        let pages = pages().unwrap();
        let names: Vec<&str> = pages.iter().map(|(name, _)| name.as_str()).collect();
        for wanted in ["impasto.1", "impasto-render.1", "impasto-doctor.1", "impasto-completions.1"] {
            assert!(names.contains(&wanted), "{wanted} in {names:?}");
        }
        assert!(!names.contains(&"impasto-man.1"), "the hidden command man has a page");
        let (_, render) = pages.iter().find(|(name, _)| name == "impasto-render.1").unwrap();
        let render = String::from_utf8_lossy(render);
        assert!(render.contains("impasto render") && render.contains("skip\\-existing"), "{render}");
        assert!(pages.iter().all(|(_, text)| !text.is_empty()));
    }
}
