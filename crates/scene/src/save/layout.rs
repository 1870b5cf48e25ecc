//! How RON is laid out on lines: what fits on one stays on one, everything else is broken at its outermost brackets.

/// A value that knows no types, only how it is written.
#[derive(Clone, Debug)]
pub(super) enum Value {
    /// Written as it is.
    Word(String),
    /// `(a, b)`.
    Tuple(Vec<Value>),
    /// `[a, b]`.
    List(Vec<Value>),
    /// `Name(a, b)`.
    Named(&'static str, Vec<Value>),
    /// `Name(a: b)`; without a name `(a: b)`.
    Fields(&'static str, Vec<(&'static str, Value)>),
}

/// Lines are broken where they would be longer; a text that is longer by itself stays whole.
const LINE_CHARS: usize = 110;

const INDENT: &str = "    ";

/// Collects fields in the order in which they are written.
#[derive(Debug)]
pub(super) struct Fields(Vec<(&'static str, Value)>);

impl Fields {
    pub(super) fn new() -> Self {
        Self(Vec::new())
    }

    pub(super) fn with(mut self, name: &'static str, value: Value) -> Self {
        self.0.push((name, value));
        self
    }

    pub(super) fn unless(self, is_default: bool, name: &'static str, value: impl FnOnce() -> Value) -> Self {
        if is_default { self } else { self.with(name, value()) }
    }

    pub(super) fn maybe(self, name: &'static str, value: Option<Value>) -> Self {
        match value {
            Some(value) => self.with(name, value),
            None => self,
        }
    }

    pub(super) fn done(self) -> Value {
        Value::Fields("", self.0)
    }

    pub(super) fn named(self, name: &'static str) -> Value {
        Value::Fields(name, self.0)
    }
}

/// The shortest digits that give the number back.
pub(super) fn number(value: f64) -> Value {
    let digits = if value.is_finite() {
        format!("{value:?}")
    } else if value.is_nan() {
        "NaN".to_owned()
    } else {
        format!("{value}")
    };
    // `4` is a number as good as `4.0`; `-0` would be a whole number, which has no sign at zero.
    let whole = digits.strip_suffix(".0").filter(|whole| *whole != "-0");
    Value::Word(whole.map_or(digits.clone(), str::to_owned))
}

/// Text in quotes.
pub(super) fn text(text: &str) -> Value {
    let mut quoted = String::with_capacity(text.len() + 2);
    quoted.push('"');
    for character in text.chars() {
        match character {
            '"' => quoted.push_str("\\\""),
            '\\' => quoted.push_str("\\\\"),
            '\n' => quoted.push_str("\\n"),
            '\t' => quoted.push_str("\\t"),
            '\r' => quoted.push_str("\\r"),
            other if other.is_control() || other == '\u{feff}' => {
                quoted.push_str(&format!("\\u{{{:x}}}", u32::from(other)));
            }
            other => quoted.push(other),
        }
    }
    quoted.push('"');
    Value::Word(quoted)
}

/// The outermost value is always broken: one field a line.
pub(super) fn lay_out(value: &Value) -> String {
    let mut out = String::new();
    write_broken(value, 0, &mut out);
    out
}

fn write_flat(value: &Value, out: &mut String) {
    match value {
        Value::Word(word) => out.push_str(word),
        _ => {
            let (name, opening, closing) = brackets(value);
            out.push_str(name);
            out.push(opening);
            for (index, (field, item)) in items(value).enumerate() {
                if index > 0 {
                    out.push_str(", ");
                }
                write_field(field, out);
                write_flat(item, out);
            }
            out.push(closing);
        }
    }
}

fn write_broken(value: &Value, depth: usize, out: &mut String) {
    if let Value::Word(word) = value {
        out.push_str(word);
        return;
    }
    let (name, opening, closing) = brackets(value);
    out.push_str(name);
    out.push(opening);
    out.push('\n');
    let indent = INDENT.repeat(depth + 1);
    for (field, item) in items(value) {
        let line_start = out.len();
        out.push_str(&indent);
        write_field(field, out);
        write_fitting(item, (line_start, depth + 1), out);
        out.push_str(",\n");
    }
    out.push_str(&INDENT.repeat(depth));
    out.push(closing);
}

/// Flat where it fits on the line that started at `line_start`, and is no list of more than one thing with fields.
fn write_fitting(value: &Value, (line_start, depth): (usize, usize), out: &mut String) {
    let before = out.len();
    write_flat(value, out);
    let fits = out[line_start..].chars().count() < LINE_CHARS;
    let is_table = matches!(value, Value::List(items) if items.len() > 1);
    if fits && !is_table {
        return;
    }
    if !matches!(value, Value::Word(_)) {
        out.truncate(before);
        write_broken(value, depth, out);
    }
}

fn write_field(field: &str, out: &mut String) {
    if !field.is_empty() {
        out.push_str(field);
        out.push_str(": ");
    }
}

fn brackets(value: &Value) -> (&'static str, char, char) {
    match value {
        Value::List(_) => ("", '[', ']'),
        Value::Named(name, _) | Value::Fields(name, _) => (name, '(', ')'),
        Value::Tuple(_) | Value::Word(_) => ("", '(', ')'),
    }
}

fn items(value: &Value) -> Box<dyn Iterator<Item = (&'static str, &Value)> + '_> {
    match value {
        Value::Word(_) => Box::new(std::iter::empty()),
        Value::Tuple(items) | Value::List(items) | Value::Named(_, items) => {
            Box::new(items.iter().map(|item| ("", item)))
        }
        Value::Fields(_, fields) => Box::new(fields.iter().map(|(name, value)| (*name, value))),
    }
}
