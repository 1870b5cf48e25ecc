//! A place in the JSON: typed access to members, with a JSON pointer for every complaint.

use std::borrow::Cow;

use crate::finding::{Checked, EXPORT_ANEW, Finding, Severity};
use crate::json::{Json, Step};

/// A value and how it was reached. `'p` is the lifetime of the chain of parents, which are on the stack of the readers;
/// `'t` is that of the JSON tree.
#[derive(Clone)]
pub(crate) struct Cursor<'p, 't> {
    value: &'t Json<'t>,
    parent: Option<&'p Cursor<'p, 't>>,
    step: Step<'t>,
}

/// The greatest whole number that is accepted anywhere: `f64` is exact up to here.
const GREATEST: f64 = 9_007_199_254_740_992.0;

impl<'p, 't> Cursor<'p, 't> {
    pub fn root(value: &'t Json<'t>) -> Self {
        Self { value, parent: None, step: Step::Item(0) }
    }

    pub fn pointer(&self) -> String {
        let mut pointer = self.parent.map_or_else(String::new, Cursor::pointer);
        if self.parent.is_some() {
            self.step.write(&mut pointer);
        }
        pointer
    }

    pub fn finding(&self, severity: Severity, message: impl Into<String>, mend: &'static str) -> Finding {
        Finding { severity, pointer: self.pointer(), message: message.into(), mend: Cow::Borrowed(mend) }
    }

    /// An error about this value, with the usual mend.
    pub fn error(&self, message: impl Into<String>) -> Box<Finding> {
        Box::new(self.finding(Severity::Error, message, EXPORT_ANEW))
    }

    pub fn warning(&self, message: impl Into<String>, mend: &'static str) -> Finding {
        self.finding(Severity::Warning, message, mend)
    }

    pub fn json(&self) -> &'t Json<'t> {
        self.value
    }

    /// A member of an object; `None` where it is missing, or this is no object.
    pub fn member<'s>(&'s self, name: &'static str) -> Option<Cursor<'s, 't>> {
        let Json::Object(members) = self.value else { return None };
        let (name, value) = members.iter().rev().find(|(own, _)| own == name)?;
        Some(Cursor { value, parent: Some(self), step: Step::Member(Cow::Borrowed(name)) })
    }

    pub fn required<'s>(&'s self, name: &'static str) -> Checked<Cursor<'s, 't>> {
        if !matches!(self.value, Json::Object(_)) {
            return Err(self.error(format!("{} stands where an object is expected", self.value.kind())));
        }
        self.member(name).ok_or_else(|| {
            let mut finding = self.error(format!("{name:?} is missing"));
            finding.pointer = format!("{}/{name}", finding.pointer);
            finding
        })
    }

    /// A member that is an object, if it is there.
    pub fn object<'s>(&'s self, name: &'static str) -> Checked<Option<Cursor<'s, 't>>> {
        self.member(name).map(|member| member.checked_object()).transpose()
    }

    /// This, if it is an object.
    pub fn checked_object(self) -> Checked<Self> {
        match self.value {
            Json::Object(_) => Ok(self),
            other => Err(self.error(format!("{} stands where an object is expected", other.kind()))),
        }
    }

    /// An object's members, in the order of the file.
    pub fn members<'s>(&'s self) -> impl Iterator<Item = (&'t str, Cursor<'s, 't>)> + use<'s, 'p, 't> {
        let members = match self.value {
            Json::Object(members) => members.as_slice(),
            _ => &[],
        };
        members.iter().map(move |(name, value)| {
            let step = Step::Member(Cow::Borrowed(name.as_ref()));
            (name.as_ref(), Cursor { value, parent: Some(self), step })
        })
    }

    /// An array member; an empty list where it is missing.
    ///
    /// # Errors
    /// It is no array.
    pub fn list<'s>(&'s self, name: &'static str) -> Checked<List<'s, 't>> {
        match self.member(name) {
            None => Ok(List { cursor: None, items: &[] }),
            Some(cursor) => cursor.checked_list(),
        }
    }

    /// The items of this array.
    pub fn checked_list(self) -> Checked<List<'p, 't>> {
        match self.value {
            Json::Array(items) => Ok(List { cursor: Some(self), items }),
            other => Err(self.error(format!("{} stands where an array is expected", other.kind()))),
        }
    }

    /// This whole number, written `3` or `3.0`, from 0 to 2^53.
    pub fn whole(&self) -> Checked<u64> {
        match *self.value {
            Json::Number(number) if (0.0..=GREATEST).contains(&number) && number.fract() == 0.0 => {
                Ok(number as u64)
            }
            Json::Number(number) => Err(self.error(format!("{number} is not a whole number from 0 to 2^53"))),
            ref other => Err(self.error(format!("{} stands where a whole number is expected", other.kind()))),
        }
    }

    /// This index into a list of `count` things; `what` names them in a message.
    pub fn index(&self, count: usize, what: &str) -> Checked<usize> {
        let index = self.whole()?;
        usize::try_from(index).ok().filter(|&index| index < count).ok_or_else(|| {
            self.error(format!("{what} {index} is named, but the file has {count} of them, counted from 0"))
        })
    }

    pub fn optional_index(&self, name: &'static str, count: usize, what: &str) -> Checked<Option<usize>> {
        self.member(name).map(|member| member.index(count, what)).transpose()
    }

    pub fn whole_or(&self, name: &'static str, default: u64) -> Checked<u64> {
        self.member(name).map_or(Ok(default), |member| member.whole())
    }

    /// This number, which must be finite as an `f32` too.
    pub fn number(&self) -> Checked<f64> {
        match *self.value {
            Json::Number(number) if (number as f32).is_finite() => Ok(number),
            Json::Number(number) => Err(self.error(format!("{number:e} is beyond what 32 bits hold"))),
            ref other => Err(self.error(format!("{} stands where a number is expected", other.kind()))),
        }
    }

    pub fn number_or(&self, name: &'static str, default: f64) -> Checked<f64> {
        self.member(name).map_or(Ok(default), |member| member.number())
    }

    /// Exactly `N` numbers.
    pub fn numbers<const N: usize>(&self) -> Checked<[f64; N]> {
        let list = self.clone().checked_list()?;
        if list.len() != N {
            return Err(self.error(format!("{} numbers stand where {N} are expected", list.len())));
        }
        let mut numbers = [0.0; N];
        for (number, item) in numbers.iter_mut().zip(list.iter()) {
            *number = item.number()?;
        }
        Ok(numbers)
    }

    pub fn numbers_or<const N: usize>(&self, name: &'static str, default: [f64; N]) -> Checked<[f64; N]> {
        self.member(name).map_or(Ok(default), |member| member.numbers())
    }

    pub fn text(&self) -> Checked<&'t str> {
        match self.value {
            Json::Text(text) => Ok(text),
            other => Err(self.error(format!("{} stands where a text is expected", other.kind()))),
        }
    }

    pub fn optional_text(&self, name: &'static str) -> Checked<Option<&'t str>> {
        self.member(name).map(|member| member.text()).transpose()
    }

    pub fn truth(&self) -> Checked<bool> {
        match *self.value {
            Json::Bool(value) => Ok(value),
            ref other => Err(self.error(format!("{} stands where true or false is expected", other.kind()))),
        }
    }

    pub fn truth_or(&self, name: &'static str, default: bool) -> Checked<bool> {
        self.member(name).map_or(Ok(default), |member| member.truth())
    }
}

/// An array. A missing one counts as empty.
pub(crate) struct List<'p, 't> {
    cursor: Option<Cursor<'p, 't>>,
    items: &'t [Json<'t>],
}

impl<'p, 't> List<'p, 't> {
    pub fn len(&self) -> usize {
        self.items.len()
    }

    pub fn iter<'s>(&'s self) -> impl Iterator<Item = Cursor<'s, 't>> + use<'s, 'p, 't> {
        let parent = self.cursor.as_ref();
        self.items.iter().enumerate().map(move |(index, value)| Cursor {
            value,
            parent,
            step: Step::Item(index),
        })
    }

    pub fn get<'s>(&'s self, index: usize) -> Option<Cursor<'s, 't>> {
        let value = self.items.get(index)?;
        Some(Cursor { value, parent: self.cursor.as_ref(), step: Step::Item(index) })
    }
}
