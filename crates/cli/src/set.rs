//! `impasto set`: writes values into a scene file, as a person would: the rest of its text stays as it is.

use std::io::Write as _;

use impasto_scene::load::{edited_text, parse, text_of};
use impasto_scene::whole_file;

use crate::args::SetArguments;
use crate::failure::Failure;

pub(crate) fn run(arguments: &SetArguments) -> Result<(), Failure> {
    let path = &arguments.scene;
    if !path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("ron")) {
        let words = format!("{} is no scene file (.ron)", path.display());
        return Err(Failure::Refused(words));
    }
    let values: Vec<(String, String)> = arguments
        .values
        .iter()
        .map(|text| match text.split_once('=') {
            Some((field, value)) => Ok((field.trim().to_owned(), value.trim().to_owned())),
            None => Err(Failure::Usage(format!("{text}: write it as PATH=VALUE, such as strokes.scale=1.5"))),
        })
        .collect::<Result<_, _>>()?;
    let text = text_of(path)?;
    let edited = edited_text(path, &text, &values)?;
    if edited != text {
        whole_file::write(path, edited.as_bytes()).map_err(|error| Failure::of_file(path, error))?;
    }
    if arguments.json {
        let scene = parse(path, &edited)?;
        let text = serde_json::to_string_pretty(&scene).map_err(|error| Failure::Other(error.to_string()))?;
        writeln!(std::io::stdout(), "{text}")?;
    }
    Ok(())
}
