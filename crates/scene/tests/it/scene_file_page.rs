//! Tests that `docs/scene_file.md` agrees with the source. Its tables must equal those that are made here from the
//! structs, enums and number tables of `scene::document`, with their doc comments. Its examples must load.
//! `IMPASTO_BLESS=1` rewrites the tables.

#![expect(clippy::unwrap_used, reason = "a test fails by it")]

mod declared;

use std::collections::BTreeMap;
use std::fmt::Write;
use std::ops::RangeInclusive;
use std::path::Path;

use declared::{Declared, declared};
use impasto_scene::document::{
    LayerSettings, RotatingStrokes, STROKE_NUMBERS, Scene, SumiE, SurfaceNoise, VertexNoise,
};
use impasto_scene::problem::Severity;
use impasto_scene::{check, load, new_scene, presets};

fn page_path() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/scene_file.md"))
}

/// A number as a person would write it.
fn number(value: f64) -> String {
    if value.abs() >= 1e7 { format!("{value:e}") } else { format!("{}", (value * 1e6).round() / 1e6) }
}

fn range(limits: &RangeInclusive<f64>) -> String {
    format!("{} to {}", number(*limits.start()), number(*limits.end()))
}

/// The range of a number field, if one of the document's tables of numbers declares it.
fn range_in_tables(of: &str, field: &str) -> Option<String> {
    macro_rules! within {
        ($type:ty) => {
            <$type>::numbers().find(|number| number.field == field).map(|number| range(&number.limits))
        };
    }
    match of {
        "RotatingStrokes" => within!(RotatingStrokes),
        "SumiE" => within!(SumiE),
        "VertexNoise" => within!(VertexNoise),
        "SurfaceNoise" => within!(SurfaceNoise),
        _ => None,
    }
}

/// What the page is made from: all declarations, and for each the heading under which the page describes it.
struct Page<'a> {
    declared: &'a [Declared],
    headings: BTreeMap<String, String>,
}

impl Page<'_> {
    fn find(&self, name: &str) -> Option<&Declared> {
        self.declared.iter().find(|declared| declared.name == name)
    }

    /// The values that a field of this type takes, in words.
    fn takes(&self, kind: &str) -> String {
        if let Some(inner) = kind.strip_prefix("Option<").and_then(|rest| rest.strip_suffix('>')) {
            return self.takes(inner);
        }
        if let Some(inner) = kind.strip_prefix("Vec<").and_then(|rest| rest.strip_suffix('>')) {
            return format!("a list: {}", self.takes(inner));
        }
        let words = match kind {
            "f64" => "a number",
            "u32" | "u64" | "i32" | "i64" => "a whole number",
            "(u32, u32)" => "`(width, height)`",
            "[f64; 2]" => "`(x, y)`",
            "[f64; 3]" => "`(x, y, z)`",
            "[f64; 4]" => "`(a, b, c, d)`",
            "bool" => "`true` or `false`",
            "String" => "text",
            "Color" => "a colour",
            "Scale" => "a number or `(x, y, z)`",
            "BrushMix" => "a brush, or a list of them",
            _ => "",
        };
        if !words.is_empty() {
            return words.to_owned();
        }
        let known = self.find(kind).unwrap_or_else(|| panic!("{kind} is not declared in the document"));
        if known.is_choice && known.fields.iter().all(|variant| variant.kind.is_empty()) {
            let words: Vec<String> = known.fields.iter().map(|word| format!("`{}`", word.name)).collect();
            return words.join(", ");
        }
        let heading = self.headings.get(kind).unwrap_or_else(|| panic!("{kind} has no table in the page"));
        let anchor = heading.to_lowercase().replace(' ', "-");
        format!("[{}](#{})", heading.to_lowercase(), anchor.replace(['`', ','], ""))
    }

    /// The table of a struct's fields, or of an enum's variants.
    fn table(&self, name: &str) -> String {
        let declared = self.find(name).unwrap_or_else(|| panic!("there is no {name}"));
        let mut table = String::new();
        if declared.is_choice {
            table += "| write | meaning |\n|---|---|\n";
            for variant in &declared.fields {
                let usual = if variant.is_usual { " (the default)" } else { "" };
                let arguments = match variant.kind.as_str() {
                    "" => String::new(),
                    "{" => "(…)".to_owned(),
                    kind if self.find(kind).is_some_and(|known| !known.is_choice) => "(…)".to_owned(),
                    kind => format!("({})", self.arguments(kind)),
                };
                writeln!(table, "| `{}{arguments}`{usual} | {} |", variant.name, variant.about).unwrap();
            }
            return table;
        }
        table += "| field | takes | default | meaning |\n|---|---|---|---|\n";
        for field in &declared.fields {
            let within =
                range_in_tables(name, &field.name).map_or(String::new(), |range| format!(", {range}"));
            let default = match &field.usual {
                None => "must be given".to_owned(),
                Some(usual) if usual.is_empty() => "–".to_owned(),
                Some(usual) => format!("`{usual}`"),
            };
            let takes = self.takes(&field.kind);
            writeln!(table, "| `{}` | {takes}{within} | {default} | {} |", field.name, field.about).unwrap();
        }
        table
    }

    /// An example of the arguments in the brackets of a variant.
    fn arguments(&self, kinds: &str) -> String {
        let example = |kind: &str| match kind {
            "f64" | "i64" => "30".to_owned(),
            "[f64; 2]" => "(x, y)".to_owned(),
            "[f64; 3]" => "(0, 1, 0)".to_owned(),
            "String" => "\"name\"".to_owned(),
            kind if kind.starts_with("Vec<") => "[…]".to_owned(),
            kind if self.find(kind).is_some_and(|known| known.is_choice) => {
                self.find(kind).map_or_else(String::new, |known| known.fields[0].name.clone())
            }
            _ => "(…)".to_owned(),
        };
        kinds.split(", ").map(example).collect::<Vec<_>>().join(", ")
    }
}

/// A preset's settings in a picture 720 pixels high.
fn resolved(preset: &str) -> presets::ResolvedStrokes {
    let mut scene = new_scene::empty();
    scene.size = (1280, 720);
    scene.strokes.preset = Some(preset.to_owned());
    presets::resolve(&scene, None)
}

fn stroke_numbers() -> String {
    let mut table = "| field | unit | range | default | meaning |\n|---|---|---|---|---|\n".to_owned();
    let usual = resolved(presets::DEFAULT_PRESET);
    for row in STROKE_NUMBERS {
        let unit = match row.shown.unit {
            "px" => "pixels",
            "°" => "degrees",
            "%" => "share: 1 is 100 %",
            "×" => "factor",
            "u" => "units of the object",
            "frames" => "frames",
            _ => "share",
        };
        let (field, range) = (row.number.field, range(&row.number.limits));
        let default = number((row.resolved)(&usual));
        writeln!(table, "| `{field}` | {unit} | {range} | `{default}` | {} |", row.number.effect).unwrap();
    }
    table
}

fn stroke_presets() -> String {
    let names: Vec<&str> = presets::names().collect();
    let quoted: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
    let mut table = format!("| field | {} |\n|---|{}\n", quoted.join(" | "), "---|".repeat(names.len()));
    for row in STROKE_NUMBERS {
        let values: Vec<String> = names.iter().map(|name| number((row.resolved)(&resolved(name)))).collect();
        if values.iter().any(|value| *value != values[0]) {
            writeln!(table, "| `{}` | {} |", row.number.field, values.join(" | ")).unwrap();
        }
    }
    table
}

fn layer_numbers() -> String {
    let mut table = "| field | range | meaning |\n|---|---|---|\n".to_owned();
    for row in LayerSettings::NUMBERS {
        let (field, range) = (row.number.field, range(&row.number.limits));
        writeln!(table, "| `{field}` | {range} | {} |", row.number.effect).unwrap();
    }
    table
}

const BEGIN: &str = "<!-- table: ";
const END: &str = "<!-- end of table -->";

/// The names of the tables in a page, each with the heading that it stands under.
fn headings(page: &str) -> BTreeMap<String, String> {
    let mut heading = "";
    let mut found = BTreeMap::new();
    for line in page.lines() {
        if line.starts_with('#') {
            heading = line.trim_start_matches(['#', ' ']);
        } else if let Some(name) = line.strip_prefix(BEGIN) {
            found.insert(name.trim_end_matches(" -->").to_owned(), heading.to_owned());
        }
    }
    found
}

/// The page with all its tables rewritten.
fn written_anew(page: &str, declared: &[Declared]) -> String {
    let tables = Page { declared, headings: headings(page) };
    let mut anew = String::new();
    let mut lines = page.lines();
    while let Some(line) = lines.next() {
        anew += line;
        anew.push('\n');
        let Some(name) = line.strip_prefix(BEGIN).map(|rest| rest.trim_end_matches(" -->")) else { continue };
        anew += &match name {
            "stroke numbers" => stroke_numbers(),
            "stroke presets" => stroke_presets(),
            "layer numbers" => layer_numbers(),
            name => tables.table(name),
        };
        anew += END;
        anew.push('\n');
        lines.find(|line| *line == END).unwrap_or_else(|| panic!("the table {name} has no end"));
    }
    anew
}

#[test]
fn the_page_of_the_scene_file_is_what_is_declared() {
    let declared = declared();
    let there = std::fs::read_to_string(page_path()).unwrap();
    let anew = written_anew(&there, &declared);
    if std::env::var_os("IMPASTO_BLESS").is_some() {
        std::fs::write(page_path(), &anew).unwrap();
    } else {
        let at = there.lines().zip(anew.lines()).find(|(there, anew)| there != anew);
        assert!(
            there == anew,
            "docs/scene_file.md is not what is declared ({at:?}): write it anew with IMPASTO_BLESS=1"
        );
    }
    let headings = headings(&anew);
    for known in &declared {
        assert!(headings.contains_key(&known.name), "docs/scene_file.md has no table of {}", known.name);
    }
}

/// Where each struct is in a scene file: the text before its fields, its required fields, and the text after them.
const PLACES: [(&str, [&str; 3]); 19] = [
    ("Timeline", ["timeline: (", "", ")"]),
    ("CameraKey", ["camera: (keys: [(", "frame: 0, eye: (0, 0, 1), target: (0, 0, 0), ", ")])"]),
    ("Lens::Perspective", ["camera: (keys: [], lens: Perspective(", "", "))"]),
    ("BackgroundKey", ["background_keys: [(", "frame: 0, color: \"#fff\", ", ")]"]),
    ("LightKey", ["lights: [(name: \"a\", kind: Sun, keys: [(", "frame: 0, ", ")])]"]),
    ("StrokesKey", ["strokes: (keys: [(", "frame: 0, ", ")])"]),
    ("Light", ["lights: [(", "name: \"a\", kind: Sun, ", ")]"]),
    ("Object", ["objects: [(", "name: \"a\", mesh: \"a.obj\", ", ")]"]),
    ("ObjectKey", ["objects: [(name: \"a\", mesh: \"a.obj\", keys: [(", "frame: 0, ", ")])]"]),
    ("MaterialOverride", ["objects: [(name: \"a\", mesh: \"a.obj\", material: (", "", "))]"]),
    ("NoiseDisplace", ["objects: [(name: \"a\", mesh: \"a\", material: (noise_displace: (", "", ")))]"]),
    (
        "VertexNoise",
        ["objects: [(name: \"a\", mesh: \"a\", material: (noise_displace: (vertex: (", "", "))))]"],
    ),
    (
        "SurfaceNoise",
        ["objects: [(name: \"a\", mesh: \"a\", material: (noise_displace: (surface: (", "", "))))]"],
    ),
    ("Region", ["regions: [(", "name: \"a\", on: Everything, ", ")]"]),
    ("Guide", ["regions: [(name: \"a\", on: Everything, guides: [(", "points: [], radius: 1, ", ")])]"]),
    ("Touch", ["touches: [(", "name: \"a\", on: \"b\", points: [], ", ")]"]),
    ("Reference::View", ["reference: View(", "eye: (0, 0, 1), target: (0, 0, 0), ", ")"]),
    ("RotatingStrokes", ["style: RotatingStrokes(", "", ")"]),
    ("SumiE", ["style: SumiE(", "", ")"]),
];

fn parsed(fragment: &str) -> Scene {
    let text = scene_of(fragment);
    load::parse(Path::new("s.ron"), &text).unwrap_or_else(|report| panic!("{report}\n{text}"))
}

/// The fields that serde knows at a place of a scene file, sorted.
fn known_at([before, _, after]: [&str; 3]) -> Vec<String> {
    let text = scene_of(&format!("{before}x: 1{after}"));
    let report = load::parse(Path::new("s.ron"), &text).unwrap_err().to_string();
    let (_, known) = report.split_once("nown here: ").unwrap_or_else(|| panic!("{report}"));
    let mut known: Vec<String> = known.lines().next().unwrap().split(", ").map(str::to_owned).collect();
    known.sort();
    known
}

/// The fields that serde accepts are those that were found in the source, so no field is missing from the page.
#[test]
fn every_field_that_is_read_was_found() {
    let declared = declared();
    let found = |name: &str, numbers: &[&str]| {
        let known = declared.iter().find(|declared| declared.name == name).unwrap();
        let fields = known.fields.iter().map(|field| field.name.clone());
        let mut fields: Vec<String> = fields.chain(numbers.iter().map(|&field| field.to_owned())).collect();
        fields.sort();
        fields
    };
    for (name, place) in PLACES {
        assert_eq!(found(name, &[]), known_at(place), "{name}");
    }
    let numbers: Vec<&str> = STROKE_NUMBERS.iter().map(|row| row.number.field).collect();
    assert_eq!(found("StrokeSettings", &numbers), known_at(["strokes: (", "", ")"]));
    let numbers: Vec<&str> = LayerSettings::NUMBERS.iter().map(|row| row.number.field).collect();
    assert_eq!(found("LayerSettings", &numbers), known_at(["strokes: (layers: [(", "", ")])"]));
}

/// A field with its default written out must give the same scene as the field left out.
#[test]
fn every_default_of_the_page_is_the_default() {
    let declared = declared();
    for (name, [before, given, after]) in PLACES {
        let known = declared.iter().find(|declared| declared.name == name).unwrap();
        let left_out = parsed(&format!("{before}{given}{after}"));
        for field in &known.fields {
            let Some(usual) = field.usual.as_ref().filter(|usual| !usual.is_empty()) else { continue };
            let stated = parsed(&format!("{before}{given}{}: {usual}{after}", field.name));
            assert_eq!(stated, left_out, "{name}.{}", field.name);
        }
    }
}

/// A part of a scene file, completed to a whole scene.
fn scene_of(fragment: &str) -> String {
    let mut text = "(version: 1, ".to_owned();
    if !fragment.contains("camera:") {
        text += "camera: (keys: [(frame: 0, eye: (0, 1, 4), target: (0, 0, 0))]), ";
    }
    if !fragment.contains("objects:") {
        text += "objects: [(name: \"apple\", mesh: \"apple.obj\"), (name: \"cloth\", mesh: \"cloth.obj\")], ";
    }
    format!("{text}\n{fragment})")
}

#[test]
fn every_example_of_the_page_is_read_without_a_complaint() {
    let page = std::fs::read_to_string(page_path()).unwrap();
    let mut examples = 0;
    for part in page.split("```ron\n").skip(1) {
        let (example, _) = part.split_once("```").unwrap();
        let text = if example.contains("version:") { example.to_owned() } else { scene_of(example) };
        let scene =
            load::parse(Path::new("s.ron"), &text).unwrap_or_else(|report| panic!("{report}\n{text}"));
        let findings = check::check(&scene);
        assert!(findings.iter().all(|finding| finding.severity == Severity::Warning), "{findings:?}\n{text}");
        examples += 1;
    }
    assert!(examples >= 10, "{examples}");
}
