//! Finds the structs and enums that the sources of `scene::document` declare: a test compares docs/scene_file.md with
//! them. The sources are read line by line, which is enough as long as each declaration has a line of its own.

use std::path::{Path, PathBuf};

/// A struct or an enum of the scene file.
#[derive(Debug)]
pub struct Declared {
    /// The name in the source; `Lens::Perspective` for the fields of a variant.
    pub name: String,
    /// Whether it is an enum: then a scene file names one of `fields`, with values in brackets if the variant has any.
    pub is_choice: bool,
    /// The fields of a struct, or the variants of an enum.
    pub fields: Vec<Field>,
}

/// A field of a struct, or a variant of an enum.
#[derive(Debug)]
pub struct Field {
    /// The name in a scene file.
    pub name: String,
    /// The type of a field. For a variant: the types in its brackets, or `{` if it has named fields.
    pub kind: String,
    /// The default of a field, as a scene file would write it. An empty text: the field can be left out (some only if
    /// there is a shot), and there is no default to write. `None`: the field must be given. (A variant has no default:
    /// always `None`.)
    pub usual: Option<String>,
    /// Whether a variant is the default of its enum.
    pub is_usual: bool,
    /// Its doc comment.
    pub about: String,
}

/// Types that a scene file writes as one value; the page has no tables of them.
const VALUES: [&str; 3] = ["Color", "Scale", "BrushMix"];

/// Types that no scene file holds.
const NOT_IN_FILES: [&str; 14] = [
    "Stage",
    "Lost",
    "Seen",
    "Number",
    "LayerNumber",
    "ResolvedLayer",
    "ResolvedStrokes",
    "StrokeNumber",
    "Shown",
    "InspectorPlace",
    "PatchRef",
    "Preparation",
    "SettingRule",
    "StyleInfo",
];

fn sources() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/document");
    let mut sources = vec![folder.with_extension("rs")];
    let mut folders = vec![folder];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() { folders.push(path) } else { sources.push(path) }
        }
    }
    sources
}

/// All structs and enums of which the page has a table, in no particular order.
pub fn declared() -> Vec<Declared> {
    let texts: Vec<String> = sources().iter().map(|path| std::fs::read_to_string(path).unwrap()).collect();
    let mut found = Vec::new();
    for text in &texts {
        read(text, &texts, &mut found);
    }
    found.retain(|declared| {
        let name = declared.name.split("::").next().unwrap_or_default();
        !VALUES.contains(&name) && !NOT_IN_FILES.contains(&name)
    });
    let defaults: Vec<(String, String)> = found
        .iter()
        .filter_map(|declared| {
            let usual = declared.fields.iter().find(|field| declared.is_choice && field.is_usual)?;
            Some((declared.name.clone(), usual.name.clone()))
        })
        .collect();
    for field in found.iter_mut().flat_map(|declared| &mut declared.fields) {
        if field.usual.as_deref() == Some(DEFAULT) {
            let of_choice = defaults.iter().find(|(name, _)| *name == field.kind);
            field.usual = Some(of_choice.map_or_else(|| default_of(&field.kind), |(_, word)| word.clone()));
        }
    }
    found
}

/// Placeholder for the default of a field's type. It is replaced once all types are known.
const DEFAULT: &str = "Default::default()";

fn default_of(kind: &str) -> String {
    match kind {
        "f64" | "u32" | "u64" | "i32" | "i64" => "0",
        "bool" => "false",
        "[f64; 3]" => "(0, 0, 0)",
        "Color" => "\"#e4dccb\"",
        "Scale" => "1",
        "Reference" => "Frame(0)",
        "Lens" => "Perspective()",
        "Style" => "RotatingStrokes()",
        "Timeline" | "StrokeSettings" => "()",
        // `Scene::camera` and `Object::mesh`: if they are left out, they come from the shot.
        "Camera" | "String" => "",
        kind if kind.starts_with("Option<") || kind.starts_with("Vec<") => "",
        kind => panic!("what is the default of {kind}?"),
    }
    .to_owned()
}

/// A Rust expression as a scene file would write it; empty for no value. `Some(…)` counts as a struct of defaults. Of
/// the path of an enum variant, only the variant's name is kept.
fn in_file(expression: &str) -> String {
    let expression = expression.trim();
    if expression == "None" || expression == "Vec::new()" {
        return String::new();
    }
    if expression == "Color::white()" || expression == "Color::white" {
        return "\"#ffffff\"".to_owned();
    }
    if let Some(bytes) = expression.strip_prefix("Color::from_bytes([") {
        let hex: String = bytes.trim_end_matches("])").split(", ").map(|byte| &byte[2..]).collect();
        return format!("\"#{hex}\"");
    }
    if expression.starts_with("Some(") {
        return "()".to_owned();
    }
    if let Some((value, count)) = expression.strip_prefix('[').and_then(|rest| rest.split_once("; ")) {
        let value = in_file(value);
        let count: usize = count.trim_end_matches(']').parse().unwrap();
        return format!("({})", vec![value; count].join(", "));
    }
    if let Some(values) = expression.strip_prefix('[') {
        let values: Vec<String> = values.trim_end_matches(']').split(", ").map(in_file).collect();
        return format!("({})", values.join(", "));
    }
    let word = expression.rsplit("::").next().unwrap_or(expression);
    word.strip_suffix(".0").unwrap_or(word).to_owned()
}

/// The default that a function of the document returns, as a scene file would write it.
fn returned_by(function: &str, texts: &[String]) -> String {
    if function == "Color::white" {
        return in_file(function);
    }
    let head = format!("fn {function}()");
    let text = texts.iter().find(|text| text.contains(&head)).unwrap_or_else(|| panic!("no {function}"));
    let body = text[text.find(&head).unwrap()..].lines().nth(1).unwrap();
    in_file(body)
}

/// Adds to `found` what one source declares. `texts` are all sources.
fn read(text: &str, texts: &[String], found: &mut Vec<Declared>) {
    let mut about = String::new();
    let mut usual: Option<String> = None;
    let mut is_usual = false;
    let mut is_skipped = false;
    // Whether the last `serde(deny_unknown_fields …)` said `default`: then fields may be left out.
    let mut has_defaults = false;
    // The type around the current line, and inside it perhaps a variant with named fields. Each is given as its index
    // in `found` and the indent of its first line.
    let mut open: Vec<(usize, usize)> = Vec::new();
    for line in text.lines() {
        let indent = line.len() - line.trim_start().len();
        let line = line.trim();
        if let Some(words) = line.strip_prefix("///") {
            about += words;
            continue;
        }
        if let Some(attribute) = line.strip_prefix("#[") {
            is_usual |= attribute == "default]";
            is_skipped |= attribute == "serde(skip)]";
            if attribute.starts_with("serde(deny_unknown_fields") {
                has_defaults = attribute.contains("default");
            }
            if attribute.starts_with("serde(default = ") {
                usual = Some(returned_by(attribute.split('"').nth(1).unwrap(), texts));
            } else if attribute.starts_with("serde(default") {
                usual = Some(DEFAULT.to_owned());
            }
            continue;
        }
        let about = std::mem::take(&mut about).trim().replace("[`", "`").replace("`]", "`");
        let usual = usual.take();
        let is_usual = std::mem::take(&mut is_usual);
        if std::mem::take(&mut is_skipped) {
            continue;
        }
        if open.last().is_some_and(|(_, of)| *of == indent) && line.starts_with('}') {
            open.pop();
        } else if let Some(name) = line.strip_prefix("pub struct ").or_else(|| line.strip_prefix("pub enum "))
        {
            if let Some(name) = name.strip_suffix(" {").filter(|name| !name.starts_with('$')) {
                let name = name.split('<').next().unwrap().to_owned();
                found.push(Declared { name, is_choice: line.starts_with("pub enum"), fields: Vec::new() });
                open.push((found.len() - 1, indent));
            }
        } else if let Some(&(at, _)) = open.last().filter(|(_, of)| indent == of + 4) {
            let line = line.trim_end_matches(',');
            if found[at].is_choice {
                let split = line.find(['(', ' ']).unwrap_or(line.len());
                let (name, rest) = (line[..split].to_owned(), line[split..].trim());
                let kind = rest.strip_prefix('(').and_then(|rest| rest.strip_suffix(')')).unwrap_or(rest);
                if kind == "{" {
                    let of_variant = format!("{}::{name}", found[at].name);
                    found.push(Declared { name: of_variant, is_choice: false, fields: Vec::new() });
                    open.push((found.len() - 1, indent));
                }
                let kind = kind.to_owned();
                found[at].fields.push(Field { name, kind, usual: None, is_usual, about });
            } else if let Some((name, kind)) = line.split_once(": ") {
                let name = name.trim_start_matches("pub ").to_owned();
                if name.starts_with(['$', '#']) {
                    continue;
                }
                let (kind, stated) = match kind.split_once(" = ") {
                    Some((kind, stated)) => {
                        let stated =
                            stated.split("; within").next().unwrap().trim_end_matches("; saved always");
                        (kind, Some(in_file(stated)))
                    }
                    None => (kind, None),
                };
                let usual = stated.or(usual).or(kind.starts_with("Option<").then(String::new));
                let usual = usual.or(has_defaults.then(|| DEFAULT.to_owned()));
                found[at].fields.push(Field { name, kind: kind.to_owned(), usual, is_usual, about });
            }
        }
    }
}
