//! Checks that `docs/editor_keys.md` equals the page that is made here from the editor's table of keys.

use std::path::Path;

use impasto_editor_model::keymap::{Keymap, Preset, Scope};

const HEAD: &str = "# Keys\n\nMade from the editor's own table: `IMPASTO_BLESS=1 cargo test -p impasto-tests --test it -- \
                    editor_keys` writes it anew.\n";

fn heading(scope: Option<Scope>) -> &'static str {
    match scope {
        None => "Everywhere",
        Some(Scope::Arrange | Scope::Animate) => "Arrange and Animate",
        Some(Scope::Paint) => "Paint",
        Some(Scope::Lane) => "Keys on a lane",
        Some(Scope::Transform | Scope::Drawing) => "While moving or drawing",
        Some(Scope::Typing) => "In a field",
    }
}

fn page() -> String {
    let of = |preset| -> Vec<_> { Keymap { preset, ..Keymap::default() }.listed().collect() };
    let (blender, maya) = (of(Preset::Blender), of(Preset::Maya));
    let places = [
        "Everywhere",
        "Arrange and Animate",
        "Paint",
        "Keys on a lane",
        "While moving or drawing",
        "In a field",
    ];
    let mut page = HEAD.to_owned();
    for place in places {
        page += &format!("\n## {place}\n\n| what | like Blender | like Maya |\n|---|---|---|\n");
        let mut listed = Vec::new();
        for line in blender.iter().chain(&maya).filter(|line| heading(line.scope) == place) {
            if listed.contains(&line.action) {
                continue;
            }
            listed.push(line.action);
            let keys = |lines: &[impasto_editor_model::keymap::Listed]| {
                let own =
                    lines.iter().find(|other| other.action == line.action && heading(other.scope) == place);
                own.map_or_else(String::new, |own| {
                    let keys = own.keys.split(", ").map(|key| format!("`{}`", key.replace('|', "\\|")));
                    keys.collect::<Vec<_>>().join(", ")
                })
            };
            page += &format!("| {} | {} | {} |\n", line.action.name(), keys(&blender), keys(&maya));
        }
    }
    page
}

#[test]
fn the_page_of_keys_is_the_table() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/editor_keys.md");
    let page = page();
    if std::env::var_os("IMPASTO_BLESS").is_some() {
        std::fs::write(&path, &page).unwrap();
    }
    let committed = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(committed == page, "docs/editor_keys.md is not the table: write it anew with IMPASTO_BLESS=1");
    assert!(page.contains("| Undo | `Ctrl Z`"), "{page}");
}
