//! Lays out the RON of saved scenes on lines. A value that fits on its line stays there with all that is in it, unless
//! it is itself a list of several items. Everything else is broken at its outermost brackets.

/// A value without a type: only how it is written.
#[derive(Clone, Debug)]
pub(super) enum Value {
    /// Written as it is.
    Word(String),
    /// In brackets.
    Group(Group),
}

/// Values in brackets: `(a, b)`, `[a, b]`, `Name(a, b)`, `(field: a)` or `Name(field: a)`.
#[derive(Clone, Debug)]
pub(super) struct Group {
    /// The name before the bracket; empty for none.
    pub(super) name: &'static str,
    pub(super) brackets: [char; 2],
    /// Each with the name of its field, which is empty where it has none.
    pub(super) items: Vec<(&'static str, Value)>,
}

/// The longest line; a single text that is longer is not broken.
const LINE_CHARS: usize = 110;

const INDENT: &str = "    ";

/// The shortest digits that read back as the same number.
pub(super) fn number(value: f64) -> Value {
    let digits = if value.is_finite() {
        format!("{value:?}")
    } else if value.is_nan() {
        "NaN".to_owned()
    } else {
        format!("{value}")
    };
    // `4` reads back as `4.0`; but `-0` would read as a whole number, which has no negative zero.
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

/// The text of a whole document. The outermost value is always broken into one field a line.
pub(super) fn lay_out(value: &Value) -> String {
    let mut out = String::new();
    write_broken(value, 0, &mut out);
    out
}

fn write_flat(value: &Value, out: &mut String) {
    match value {
        Value::Word(word) => out.push_str(word),
        Value::Group(Group { name, brackets, items }) => {
            out.push_str(name);
            out.push(brackets[0]);
            for (index, (field, item)) in items.iter().enumerate() {
                if index > 0 {
                    out.push_str(", ");
                }
                write_field(field, out);
                write_flat(item, out);
            }
            out.push(brackets[1]);
        }
    }
}

fn write_broken(value: &Value, depth: usize, out: &mut String) {
    let Value::Group(Group { name, brackets, items }) = value else { return write_flat(value, out) };
    out.push_str(name);
    out.push(brackets[0]);
    out.push('\n');
    let indent = INDENT.repeat(depth + 1);
    for (field, item) in items {
        let line_start = out.len();
        out.push_str(&indent);
        write_field(field, out);
        write_fitting(item, (line_start, depth + 1), out);
        out.push_str(",\n");
    }
    out.push_str(&INDENT.repeat(depth));
    out.push(brackets[1]);
}

/// Writes a value on the line that started at `line_start`, if it fits there and is not a list of several items. Breaks
/// it into lines otherwise.
fn write_fitting(value: &Value, (line_start, depth): (usize, usize), out: &mut String) {
    let before = out.len();
    write_flat(value, out);
    let fits = out[line_start..].chars().count() < LINE_CHARS;
    let is_table = matches!(value, Value::Group(group) if group.brackets[0] == '[' && group.items.len() > 1);
    if is_table || !fits {
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
