//! Tests that the table in `docs/compositing.md` of what EXR files can hold agrees with the source. `IMPASTO_BLESS=1`
//! rewrites the table.

use std::fmt::Write;

use impasto_scene::aovs::AOVS;

const BEGIN: &str = "<!-- aovs:begin -->\n";
const END: &str = "<!-- aovs:end -->";

#[test]
fn the_page_lists_every_aov_as_the_source_does() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/compositing.md");
    let page = std::fs::read_to_string(path).unwrap();
    let mut table = String::from("| `--aov` | channels | type | what |\n|---|---|---|---|\n");
    for row in AOVS {
        writeln!(table, "| `{}` | `{}` | {} | {} |", row.name, row.channels, row.samples, row.summary)
            .unwrap();
    }
    let (before, rest) = page.split_once(BEGIN).unwrap();
    let (_, after) = rest.split_once(END).unwrap();
    let wanted = format!("{before}{BEGIN}{table}{END}{after}");
    if std::env::var_os("IMPASTO_BLESS").is_some() {
        std::fs::write(path, &wanted).unwrap();
    }
    assert!(page == wanted || std::env::var_os("IMPASTO_BLESS").is_some(), "run with IMPASTO_BLESS=1");
}
