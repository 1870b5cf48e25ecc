//! A number while it is being typed.

#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Typed {
    digits: String,
    negative: bool,
}

/// The most characters that are taken: digits and the point, but not the sign.
const MOST: usize = 12;

impl Typed {
    /// Takes a digit or a point (`.` or `,`); `-` changes the sign wherever it is typed. Anything else is ignored.
    pub(super) fn push(&mut self, character: char) {
        match character {
            '-' | '−' => self.negative = !self.negative,
            '.' | ',' if !self.digits.contains('.') && self.digits.len() < MOST => self.digits.push('.'),
            digit if digit.is_ascii_digit() && self.digits.len() < MOST => self.digits.push(digit),
            _ => {}
        }
    }

    /// Removes the last character; the sign is removed last.
    pub(super) fn pop(&mut self) {
        if self.digits.pop().is_none() {
            self.negative = false;
        }
    }

    /// The number; `None` until a digit was typed.
    pub(super) fn value(&self) -> Option<f64> {
        let value: f64 = self.digits.parse().ok()?;
        Some(if self.negative { -value } else { value })
    }

    /// The text to show; `None` if nothing was typed.
    pub(super) fn text(&self) -> Option<String> {
        let anything = self.negative || !self.digits.is_empty();
        anything.then(|| format!("{}{}", if self.negative { "-" } else { "" }, self.digits))
    }
}
