//! Strange scenes, made up field by field from the tables in `docs/scene_file.md`.

use super::chance::Chance;
use super::page::{Page, Row};

/// Few names, so that a name to which a field refers usually exists in the scene.
const NAMES: [&str; 4] = ["apple", "ball", "leaf", "wall"];
const FIRST_NAMES: [&str; 4] = ["apple", "apple", "apple", "ball"];
const GROUPS: [&str; 4] = ["body", "stem", "leaf", "floor"];
const BRUSHES: [&str; 7] = ["flat", "round", "knife", "filbert", "fan", "dry", "rigger"];
const PRESETS: [&str; 6] = ["oil study", "impressionist", "dry brush", "gouache", "ink", "paper"];
const LAYERS: [&str; 7] = ["underpainting", "body", "form", "scumble", "accents", "contour", "lights"];

/// From this depth of nesting on, a group has few fields besides those that must be there.
const DEEPEST: usize = 7;

/// A scene that reads `m.obj`, `s.glb`, `c.pc2`, `t.png` beside it.
pub fn scene(chance: &mut Chance, page: &Page) -> Vec<u8> {
    let mut text = String::from("#![enable(implicit_some)]\n");
    let mut writer = Writer { page, text: &mut text, objects: 0, names: 0, has_shot: chance.happens(0.2) };
    writer.group(chance, "Scene", 0);
    text.push('\n');
    text.into_bytes()
}

struct Writer<'a> {
    page: &'a Page,
    text: &'a mut String,
    /// How many objects and how many other names there are so far.
    objects: usize,
    names: usize,
    has_shot: bool,
}

impl Writer<'_> {
    /// Writes a group of fields: those that must be there, and some of the others.
    fn group(&mut self, chance: &mut Chance, table: &str, depth: usize) {
        let page = self.page;
        let often = [0.9, 0.5, 0.3, 0.25, 0.15, 0.1, 0.05, 0.0][depth.min(DEEPEST)];
        self.text.push('(');
        for row in page.rows(table) {
            if self.is_left_out(chance, table, row, often) {
                continue;
            }
            let name = if chance.is_odd() {
                chance.of(&["x", "name", "keys", &row.name]).to_owned()
            } else {
                row.name.clone()
            };
            let times = if chance.is_odd() { chance.below(3) } else { 1 };
            for _ in 0..times {
                self.text.push_str(&name);
                self.text.push_str(": ");
                self.value(chance, table, row, depth + 1);
                self.text.push_str(", ");
            }
        }
        self.text.push(')');
    }

    fn is_left_out(&self, chance: &mut Chance, table: &str, row: &Row, often: f64) -> bool {
        match (table, &*row.name) {
            _ if chance.is_odd() => chance.happens(0.5),
            ("Scene", "shot") => !self.has_shot,
            // These make painting slow, so they are rare.
            ("Scene", "aovs") | ("RotatingStrokes", "solver" | "samples") => !chance.happens(0.1),
            ("Scene", "camera" | "objects") | ("Camera", "keys") => false,
            ("Object", "mesh") => self.has_shot && chance.happens(0.5),
            ("Object", "parent" | "morph" | "cache" | "group") => !chance.happens(0.08),
            ("ObjectKey", "morph") | ("StrokeSettings", "order") | ("LayerSettings", "color") => {
                !chance.happens(0.02)
            }
            ("Guide" | "PaintedAmount", "object") => false,
            ("Light", "direction" | "position") | ("Timeline", "last") => false,
            ("SumiE", "tones") => !chance.happens(0.02),
            _ => !row.must_be_given && !chance.happens(often),
        }
    }

    fn value(&mut self, chance: &mut Chance, table: &str, row: &Row, depth: usize) {
        if chance.is_odd() {
            let odd = chance.of(&[
                "None",
                "Some(1)",
                "()",
                "[]",
                "(1, 2, 3)",
                "\"\"",
                "-1",
                "true",
                "'a'",
                "r#\"a\"#",
                "{}",
                "\"\\u{110000}\"",
            ]);
            self.text.push_str(odd);
            return;
        }
        if let Some(item) = row.takes.strip_prefix("a list: ") {
            return self.list(chance, table, row, item, depth);
        }
        if let Some(linked) = self.page.linked(&row.takes) {
            return self.choice_or_group(chance, linked, depth);
        }
        let takes = row.takes.split(',').next().unwrap_or_default();
        match takes {
            "a number" => self.number(chance, usual_range(table, row), false),
            "a whole number" => self.number(chance, usual_range(table, row), true),
            "a number or `(x" if chance.happens(0.5) => self.number(chance, usual_range(table, row), false),
            "text" | "a brush" => self.word(chance, table, &row.name),
            "a colour" => self.color(chance),
            "`true` or `false`" => {
                // Hidden things show nothing, so they are rare.
                let is_true = chance.happens(if row.name == "hidden" { 0.05 } else { 0.5 });
                self.text.push_str(if is_true { "true" } else { "false" });
            }
            _ if row.takes.contains("width, height") => {
                self.text.push_str(chance.of(&[
                    "(96, 64)",
                    "(64, 96)",
                    "(1280, 720)",
                    "(200, 10)",
                    "(7, 5)",
                ]));
            }
            _ if row.takes.contains('(') => {
                let inside = row.takes.split(['(', ')']).nth(1).unwrap_or_default();
                let range = usual_range(table, row);
                self.vector(chance, inside.matches(',').count() + 1, range);
            }
            _ => {
                let words: Vec<&str> = row.takes.split('`').skip(1).step_by(2).collect();
                assert!(!words.is_empty(), "{}: {}", row.name, row.takes);
                self.text.push_str(chance.of(&words));
            }
        }
    }

    fn list(&mut self, chance: &mut Chance, table: &str, row: &Row, item: &str, depth: usize) {
        let most = if depth > 3 { 4 } else { 6 };
        let least = match &*row.name {
            "points" | "objects" => 2,
            "keys" => 1,
            _ => usize::from(row.must_be_given),
        };
        let count = if chance.is_odd() { chance.count(300) } else { (least + chance.below(most)).max(least) };
        let linked = self.page.linked(item).map(str::to_owned);
        let item =
            Row { name: row.name.clone(), takes: item.to_owned(), must_be_given: true, range: row.range };
        self.text.push('[');
        let mut frame = chance.below(20) as i64 - 10;
        for _ in 0..count {
            match &linked {
                Some(linked) if self.page.rows(linked).iter().any(|row| row.name == "frame") => {
                    let start = self.text.len();
                    self.choice_or_group(chance, linked, depth);
                    self.put_frame(chance, start, frame);
                    frame += chance.count(30) as i64;
                }
                Some(linked) => self.choice_or_group(chance, linked, depth),
                None => self.value(chance, table, &item, depth),
            }
            self.text.push_str(", ");
        }
        self.text.push(']');
    }

    /// Writes `frame` into the key whose text begins at `start`, so that keys are in the order of their frames.
    fn put_frame(&mut self, chance: &mut Chance, start: usize, frame: i64) {
        let Some(at) = self.text[start..].find("frame: ").map(|at| start + at + 7) else { return };
        let Some(end) = self.text[at..].find(',').map(|end| at + end) else { return };
        if !chance.is_odd() {
            self.text.replace_range(at..end, &frame.to_string());
        }
    }

    fn choice_or_group(&mut self, chance: &mut Chance, table: &str, depth: usize) {
        let page = self.page;
        let rows = page.rows(table);
        if rows.iter().all(|row| !row.takes.is_empty()) {
            return self.group(chance, table, depth);
        }
        let Some(row) = rows.get(chance.below(rows.len())) else { return };
        let Some((word, arguments)) = row.name.split_once('(') else {
            return self.text.push_str(&row.name);
        };
        self.text.push_str(word);
        let own = format!("{table}::{word}");
        let fields = [own.as_str(), word].into_iter().find(|name| !page.rows(name).is_empty());
        match (arguments, fields) {
            ("…)", Some(fields)) => self.group(chance, fields, depth),
            _ => self.arguments(chance, word, arguments, depth),
        }
    }

    /// Writes what stands in brackets after a word, in the form of the page's sample: `"name", […])`.
    fn arguments(&mut self, chance: &mut Chance, word: &str, sample: &str, depth: usize) {
        self.text.push('(');
        let mut rest = sample;
        let mut is_first = true;
        while let Some(first) = rest.chars().next() {
            let length = if let Some(end) = rest.strip_prefix("\"name\"") {
                let names = if is_first && word != "Material" && word != "EachMaterial" {
                    &FIRST_NAMES
                } else {
                    &GROUPS
                };
                let name = chance.name(names);
                self.quoted(&name);
                rest.len() - end.len()
            } else if rest.starts_with("[…]") {
                let table = if word == "Several" { "Patch" } else { "Dab" };
                self.text.push('[');
                for _ in 0..chance.count(5) {
                    self.choice_or_group(chance, table, depth + 1);
                    self.text.push_str(", ");
                }
                self.text.push(']');
                "[…]".len()
            } else if rest.starts_with("(…)") {
                self.group(chance, "Seed", depth + 1);
                "(…)".len()
            } else if first == '(' {
                let end = rest.find(')').unwrap_or(rest.len() - 1);
                let range = if word == "Curve" { [0.0, 1.0] } else { [-4.0, 4.0] };
                self.vector(chance, rest[..end].matches(',').count() + 1, range);
                end + 1
            } else if first.is_ascii_digit() {
                self.number(chance, [0.0, 90.0], word == "Frame");
                rest.len() - rest.trim_start_matches(|letter: char| letter.is_ascii_digit()).len()
            } else if first.is_alphabetic() {
                self.text.push_str(chance.of(&["Min", "Max"]));
                rest.len() - rest.trim_start_matches(char::is_alphabetic).len()
            } else {
                self.text.push(first);
                first.len_utf8()
            };
            rest = &rest[length..];
            is_first = false;
        }
    }

    fn number(&mut self, chance: &mut Chance, [least, most]: [f64; 2], is_whole: bool) {
        // Usually a common value, now and then any allowed one.
        let usual = if chance.happens(0.8) {
            chance.between(least.max(-2.0), most.min(60.0))
        } else {
            chance.between(least, most)
        };
        let usual = if is_whole { usual.round() } else { usual };
        let number = chance.number(usual);
        self.text.push_str(&number);
    }

    fn vector(&mut self, chance: &mut Chance, count: usize, [least, most]: [f64; 2]) {
        let numbers: Vec<String> = (0..count)
            .map(|_| {
                let usual =
                    if chance.happens(0.2) { least.max(0.0) } else { chance.between(least, most.min(90.0)) };
                chance.number(usual)
            })
            .collect();
        self.text.push('(');
        self.text.push_str(&numbers.join(", "));
        self.text.push(')');
    }

    fn color(&mut self, chance: &mut Chance) {
        let color = match chance.is_odd() {
            true => chance.of(&["#", "#12", "#gggggg", "red", "#1234567890", "\u{1f58c}"]).to_owned(),
            false => format!("#{:06x}", chance.below(1 << 24)),
        };
        self.quoted(&color);
    }

    fn word(&mut self, chance: &mut Chance, table: &str, field: &str) {
        let name = match (table, field) {
            (_, "mesh") => chance.name(&["m.obj", "m.obj", "m.obj", "s.glb"]),
            ("Scene", "shot") => chance.name(&["s.glb"]),
            (_, "morph") => chance.name(&["m.obj"]),
            (_, "cache") => chance.name(&["c.pc2"]),
            (_, "texture") => chance.name(&["t.png"]),
            (_, "brush") => chance.name(&BRUSHES),
            (_, "preset") => chance.name(&PRESETS),
            (_, "group") => chance.name(&GROUPS),
            (_, "parent" | "on" | "object" | "of_shot" | "animation") => chance.name(&FIRST_NAMES),
            ("LayerSettings", "name") | (_, "order") => {
                self.names += 1;
                let own = LAYERS[self.names % LAYERS.len()];
                chance.name(&[own])
            }
            ("Object", "name") => {
                self.objects += 1;
                match NAMES.get(self.objects - 1) {
                    Some(name) => chance.name(&[name]),
                    None => format!("body {}", self.objects),
                }
            }
            (_, "aovs") => chance.name(&["all", "depth", "motion", "crypto.object"]),
            (_, "name") => {
                self.names += 1;
                let own = format!("{} {}", chance.name(&NAMES), self.names);
                chance.name(&[&own])
            }
            _ => chance.name(&NAMES),
        };
        self.quoted(&name);
    }

    fn quoted(&mut self, name: &str) {
        self.text.push('"');
        for letter in name.chars() {
            match letter {
                '"' | '\\' => self.text.extend(['\\', letter]),
                _ => self.text.push(letter),
            }
        }
        self.text.push('"');
    }
}

/// The range from which a field's numbers are usually drawn: the page's, or one that keeps the scene sound and small.
fn usual_range(table: &str, row: &Row) -> [f64; 2] {
    match (table, &*row.name) {
        (_, "version") => [1.0, 1.0],
        (_, "particles") => [0.0, 3000.0],
        ("Timeline", "first") => [0.0, 5.0],
        ("Timeline", "last") => [5.0, 40.0],
        (_, "samples") => [1.0, 2.0],
        (_, "near") => [0.01, 0.5],
        (_, "far") => [50.0, 100.0],
        (_, "fps") => [1.0, 60.0],
        (_, "radius") => [0.1, 2.0],
        (_, "height") => [2.0, 8.0],
        ("AmountDab", "by") => [0.25, 4.0],
        ("Object" | "ObjectKey", "scale") => [0.3, 2.0],
        (_, "cone_deg") => [20.0, 40.0],
        _ if row.takes.starts_with('`') => row.range.unwrap_or([-4.0, 4.0]),
        _ => row.range.unwrap_or([0.0, 1.0]),
    }
}
