//! The grammar of scene files, read from `docs/scene_file.md`. The tables of that page are made from the program, so a
//! field that is added to the program also occurs in strange scenes.

use std::collections::BTreeMap;
use std::path::Path;

use anyhow::{Context as _, ensure};

/// The tables of the page, by name, and which of them each heading leads to.
pub struct Page {
    tables: BTreeMap<String, Vec<Row>>,
    headings: BTreeMap<String, String>,
}

/// A field of a group, or one word of a choice.
pub struct Row {
    /// The field's name, or what is written for the choice: `Angle(30)`.
    pub name: String,
    /// What a field takes. Empty for a choice.
    pub takes: String,
    pub must_be_given: bool,
    /// The least and the most of a number, where the page states them.
    pub range: Option<[f64; 2]>,
}

/// Tables whose rows belong to another table, each with the name of that table.
const JOINED: [(&str, &str); 2] = [("stroke numbers", "StrokeSettings"), ("layer numbers", "LayerSettings")];

impl Page {
    /// Reads the page.
    ///
    /// # Errors
    /// Where it cannot be read, or holds no tables.
    pub fn read(root: &Path) -> anyhow::Result<Self> {
        let path = root.join("docs/scene_file.md");
        let text = std::fs::read_to_string(&path).with_context(|| path.display().to_string())?;
        let page = Self::of(&text);
        ensure!(page.tables.contains_key("Scene"), "{} has no table of the scene", path.display());
        Ok(page)
    }

    fn of(text: &str) -> Self {
        let (mut tables, mut headings) = (BTreeMap::<String, Vec<Row>>::new(), BTreeMap::new());
        let (mut heading, mut table, mut columns) = (String::new(), None, Vec::new());
        for line in text.lines() {
            if line.starts_with('#') {
                heading = line.trim_start_matches('#').trim().to_lowercase().replace(' ', "-");
            } else if let Some(rest) = line.strip_prefix("<!-- table: ") {
                let name = rest.trim_end_matches(" -->");
                let name = JOINED.iter().find(|(from, _)| *from == name).map_or(name, |(_, to)| to);
                headings.entry(heading.clone()).or_insert_with(|| name.to_owned());
                table = Some(name.to_owned());
                columns.clear();
            } else if line.starts_with("<!-- end") {
                table = None;
            } else if let (Some(name), true) = (&table, line.starts_with('|')) {
                let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
                if columns.is_empty() {
                    columns = cells.iter().map(|&cell| cell.to_owned()).collect();
                } else if let Some(row) = row(&columns, &cells) {
                    tables.entry(name.clone()).or_default().push(row);
                }
            }
        }
        Self { tables, headings }
    }

    /// The rows of a table.
    pub fn rows(&self, table: &str) -> &[Row] {
        self.tables.get(table).map_or(&[], Vec::as_slice)
    }

    /// The table that a link leads to: `[light key](#light-key)`.
    pub fn linked(&self, takes: &str) -> Option<&str> {
        let anchor = takes.split_once("](#")?.1.split_once(')')?.0;
        self.headings.get(anchor).map(String::as_str)
    }
}

/// One line of a table; `None` for the line below its head.
fn row(columns: &[String], cells: &[&str]) -> Option<Row> {
    let name = cells.first()?.split('`').nth(1)?.to_owned();
    let cell = |wanted: &str| {
        columns.iter().position(|column| column == wanted).and_then(|at| cells.get(at).copied())
    };
    let (takes, range) = match (cell("takes"), cell("range")) {
        (Some(takes), _) => (takes, range_of(takes).or_else(|| range_of(cell("meaning")?))),
        (None, Some(range)) => ("a number", range_of(range)),
        (None, None) => ("", None),
    };
    let must_be_given = cell("default") == Some("must be given");
    Some(Row { name, takes: takes.to_owned(), must_be_given, range })
}

/// The first `A to B` in a text.
fn range_of(text: &str) -> Option<[f64; 2]> {
    let number =
        |word: &str| word.trim_end_matches([',', '.', ':', ';']).replace('−', "-").parse::<f64>().ok();
    let words: Vec<&str> = text.split_whitespace().collect();
    words.windows(3).find_map(|three| match three {
        [from, "to", to] => Some([number(from)?, number(to)?]),
        _ => None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_and_choices_are_read() {
        let page = Page::of(
            "## Light key\n<!-- table: LightKey -->\n| field | takes | default | meaning |\n|---|---|---|---|\n\
             | `frame` | a number | must be given | When. |\n| `intensity` | a number | – | From 0 to 1000000. |\n\
             <!-- end of table -->\n## Up\n<!-- table: Up -->\n| write | meaning |\n|---|---|\n| `NegX` | −X up. |\n\
             <!-- end of table -->\n",
        );
        let rows = page.rows("LightKey");
        assert_eq!(rows.len(), 2);
        assert!(rows[0].must_be_given && !rows[1].must_be_given);
        assert_eq!((rows[0].range, rows[1].range), (None, Some([0.0, 1e6])));
        assert_eq!(page.linked("a list: [light key](#light-key)"), Some("LightKey"));
        assert_eq!(page.rows("Up")[0].name, "NegX");
    }

    #[test]
    fn the_page_of_today_has_every_table_that_it_links_to() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the repository");
        let page = Page::read(root).expect("a page");
        for (table, rows) in &page.tables {
            for row in rows.iter().filter(|row| row.takes.contains("](#")) {
                assert!(page.linked(&row.takes).is_some(), "{table}.{}: {}", row.name, row.takes);
            }
        }
        assert!(page.rows("StrokeSettings").len() > 20, "its numbers belong to it");
    }
}
