//! JSON as a tree that borrows its texts from the file, with a bound on how many values it may hold.

use std::borrow::Cow;
use std::cell::{Cell, RefCell};
use std::fmt;

use serde::de::{DeserializeSeed, Error as _, MapAccess, SeqAccess, Visitor};

use crate::finding::{Checked, EXPORT_ANEW, Finding, Severity};

/// The most values of one file's JSON. A value may take only two bytes in the file, as in `[0,0,0]`, but up to 64 bytes
/// in memory: at most 256 MiB for all.
pub(crate) const MOST_VALUES: usize = 4_000_000;

/// A JSON value. Numbers are kept as `f64`: whole ones are exact up to 2^53, far beyond any length that is accepted.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Json<'t> {
    Null,
    Bool(bool),
    Number(f64),
    Text(Cow<'t, str>),
    Array(Vec<Json<'t>>),
    /// In the order of the file; of members with the same name, the last counts.
    Object(Vec<(Cow<'t, str>, Json<'t>)>),
}

impl Json<'_> {
    /// What kind of value it is, in words for users.
    pub fn kind(&self) -> &'static str {
        match self {
            Json::Null => "null",
            Json::Bool(_) => "true or false",
            Json::Number(_) => "a number",
            Json::Text(_) => "a text",
            Json::Array(_) => "an array",
            Json::Object(_) => "an object",
        }
    }
}

/// Parses a whole JSON text.
///
/// # Errors
/// Bad syntax, deeper nesting than serde_json's own bound (128), a number beyond `f64`: with the pointer of the value
/// at which reading stopped. Too many values: [`Severity::Limit`].
pub(crate) fn parse(text: &[u8]) -> Checked<Json<'_>> {
    let state = State { values: Cell::new(0), path: RefCell::default() };
    let mut deserializer = serde_json::Deserializer::from_slice(text);
    let parsed = Seed(&state).deserialize(&mut deserializer).and_then(|json| {
        deserializer.end()?;
        Ok(json)
    });
    parsed.map_err(|error| {
        let is_limit = state.values.get() > MOST_VALUES;
        let mut pointer = String::new();
        for step in &*state.path.borrow() {
            step.write(&mut pointer);
        }
        Box::new(Finding {
            severity: if is_limit { Severity::Limit } else { Severity::Error },
            pointer,
            message: if is_limit {
                format!("the JSON holds more than {MOST_VALUES} values")
            } else {
                format!("the JSON cannot be read: {error}")
            },
            mend: Cow::Borrowed(if is_limit { "split the file" } else { EXPORT_ANEW }),
        })
    })
}

/// One step of a JSON pointer.
#[derive(Clone, Debug)]
pub(crate) enum Step<'t> {
    Member(Cow<'t, str>),
    Item(usize),
}

impl Step<'_> {
    /// Appends the step to a pointer. Very long names are cut.
    pub fn write(&self, pointer: &mut String) {
        use fmt::Write;
        match self {
            Step::Member(name) => {
                pointer.push('/');
                for character in name.chars().take(200) {
                    match character {
                        '~' => pointer.push_str("~0"),
                        '/' => pointer.push_str("~1"),
                        _ => pointer.push(character),
                    }
                }
            }
            // Writing into a text cannot fail.
            Step::Item(index) => write!(pointer, "/{index}").unwrap_or_default(),
        }
    }
}

struct State<'t> {
    values: Cell<usize>,
    /// Where the parser is; after an error, where it stopped.
    path: RefCell<Vec<Step<'t>>>,
}

struct Seed<'s, 't>(&'s State<'t>);

impl<'t> DeserializeSeed<'t> for Seed<'_, 't> {
    type Value = Json<'t>;

    fn deserialize<D: serde::Deserializer<'t>>(self, deserializer: D) -> Result<Json<'t>, D::Error> {
        let count = self.0.values.get() + 1;
        self.0.values.set(count);
        if count > MOST_VALUES {
            return Err(D::Error::custom("too many values"));
        }
        deserializer.deserialize_any(self)
    }
}

impl<'t> Visitor<'t> for Seed<'_, 't> {
    type Value = Json<'t>;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("a JSON value")
    }

    fn visit_unit<E>(self) -> Result<Json<'t>, E> {
        Ok(Json::Null)
    }

    fn visit_bool<E>(self, value: bool) -> Result<Json<'t>, E> {
        Ok(Json::Bool(value))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Json<'t>, E> {
        Ok(Json::Number(value as f64))
    }

    fn visit_u64<E>(self, value: u64) -> Result<Json<'t>, E> {
        Ok(Json::Number(value as f64))
    }

    fn visit_f64<E>(self, value: f64) -> Result<Json<'t>, E> {
        Ok(Json::Number(value))
    }

    fn visit_borrowed_str<E>(self, value: &'t str) -> Result<Json<'t>, E> {
        Ok(Json::Text(Cow::Borrowed(value)))
    }

    fn visit_str<E>(self, value: &str) -> Result<Json<'t>, E> {
        Ok(Json::Text(Cow::Owned(value.to_owned())))
    }

    fn visit_seq<A: SeqAccess<'t>>(self, mut items: A) -> Result<Json<'t>, A::Error> {
        let mut list = Vec::new();
        loop {
            self.0.path.borrow_mut().push(Step::Item(list.len()));
            let Some(item) = items.next_element_seed(Seed(self.0))? else { break };
            self.0.path.borrow_mut().pop();
            list.push(item);
        }
        self.0.path.borrow_mut().pop();
        list.shrink_to_fit();
        Ok(Json::Array(list))
    }

    fn visit_map<A: MapAccess<'t>>(self, mut members: A) -> Result<Json<'t>, A::Error> {
        let mut list = Vec::new();
        while let Some(name) = members.next_key_seed(Name)? {
            self.0.path.borrow_mut().push(Step::Member(name.clone()));
            let value = members.next_value_seed(Seed(self.0))?;
            self.0.path.borrow_mut().pop();
            list.push((name, value));
        }
        list.shrink_to_fit();
        Ok(Json::Object(list))
    }
}

/// Reads a member's name, borrowed where it has no escapes.
struct Name;

impl<'t> DeserializeSeed<'t> for Name {
    type Value = Cow<'t, str>;

    fn deserialize<D: serde::Deserializer<'t>>(self, deserializer: D) -> Result<Cow<'t, str>, D::Error> {
        deserializer.deserialize_str(self)
    }
}

impl<'t> Visitor<'t> for Name {
    type Value = Cow<'t, str>;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("a name")
    }

    fn visit_borrowed_str<E>(self, value: &'t str) -> Result<Cow<'t, str>, E> {
        Ok(Cow::Borrowed(value))
    }

    fn visit_str<E>(self, value: &str) -> Result<Cow<'t, str>, E> {
        Ok(Cow::Owned(value.to_owned()))
    }
}
