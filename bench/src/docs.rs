//! Writes the table of results into a page of the docs, between the two comments that mark its place.

use std::path::Path;

use anyhow::Context as _;

use crate::table::{Table, markdown};

const BEGIN: &str = "<!-- bench:begin -->";
const END: &str = "<!-- bench:end -->";

/// Puts the table between the two comments of a page.
///
/// # Errors
/// Where the page cannot be read or written, or has no such comments.
pub fn write(page: &Path, table: &Table) -> anyhow::Result<()> {
    let text = std::fs::read_to_string(page).with_context(|| format!("{} cannot be read", page.display()))?;
    let written = replaced(&text, &markdown(table))
        .with_context(|| format!("{} has no {BEGIN} … {END}", page.display()))?;
    std::fs::write(page, written).with_context(|| format!("{} cannot be written", page.display()))
}

fn replaced(page: &str, table: &str) -> Option<String> {
    let (before, rest) = page.split_once(BEGIN)?;
    let (_, after) = rest.split_once(END)?;
    Some(format!("{before}{BEGIN}\n{table}{END}{after}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_the_text_between_the_marks_is_replaced() {
        let page = format!("above\n{BEGIN}\nold\n{END}\nbelow\n");
        let written = replaced(&page, "new\n").unwrap();
        assert_eq!(written, format!("above\n{BEGIN}\nnew\n{END}\nbelow\n"));
        assert_eq!(replaced(&written, "new\n").unwrap(), written);
        assert!(replaced("no marks", "new").is_none());
    }
}
