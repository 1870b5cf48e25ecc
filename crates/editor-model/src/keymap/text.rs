//! Keys as text: written as menus show them, and read back.

use std::str::FromStr;

use super::{Chord, Key, Modifiers};

impl Key {
    fn text(self) -> String {
        match self {
            Self::Letter(letter) => letter.to_string(),
            Self::Sign(sign) => sign.to_string(),
            Self::Digit(digit) => digit.to_string(),
            Self::NumPad(digit) => format!("NumPad {digit}"),
            Self::NumPadPoint => "NumPad .".to_owned(),
            Self::Function(number) => format!("F{number}"),
            Self::Escape => "Esc".to_owned(),
            Self::Left => "←".to_owned(),
            Self::Right => "→".to_owned(),
            Self::Up => "↑".to_owned(),
            Self::Down => "↓".to_owned(),
            named => format!("{named:?}"),
        }
    }

    fn of_text(text: &str) -> Option<Self> {
        let named = [
            Self::Space,
            Self::Tab,
            Self::Enter,
            Self::Escape,
            Self::Backspace,
            Self::Delete,
            Self::Home,
            Self::Left,
            Self::Right,
            Self::Up,
            Self::Down,
            Self::NumPadPoint,
        ];
        if let Some(key) = named.into_iter().find(|key| key.text() == text) {
            return Some(key);
        }
        if let Some(digit) = text.strip_prefix("NumPad ") {
            return digit.parse().ok().filter(|digit| *digit < 10).map(Self::NumPad);
        }
        let mut letters = text.chars();
        match (letters.next()?, letters.as_str()) {
            (letter, "") if letter.is_ascii_alphabetic() => Some(Self::Letter(letter.to_ascii_uppercase())),
            (digit, "") if digit.is_ascii_digit() => digit.to_digit(10).map(|digit| Self::Digit(digit as u8)),
            (sign, "") if "[],.-".contains(sign) => Some(Self::Sign(sign)),
            ('F', number) => {
                number.parse().ok().filter(|number| (1..=35).contains(number)).map(Self::Function)
            }
            _ => None,
        }
    }
}

impl Chord {
    /// As menus write it: `Ctrl Shift S`.
    pub fn text(&self) -> String {
        let Modifiers { ctrl, shift, alt } = self.held;
        let held = [(ctrl, "Ctrl "), (alt, "Alt "), (shift, "Shift ")];
        let held: String = held.iter().filter(|(on, _)| *on).map(|(_, text)| *text).collect();
        held + &self.key.text()
    }
}

/// A text that is no chord.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` is no key: one reads like `Ctrl Shift S`, `F5` or `NumPad 1`")]
pub struct NoChord(String);

impl FromStr for Chord {
    type Err = NoChord;

    fn from_str(text: &str) -> Result<Self, NoChord> {
        let mut held = Modifiers::default();
        let mut rest = text.trim();
        while let Some((first, more)) = rest.split_once(' ') {
            match first {
                "Ctrl" => held.ctrl = true,
                "Alt" => held.alt = true,
                "Shift" => held.shift = true,
                _ => break,
            }
            rest = more.trim_start();
        }
        let key = Key::of_text(rest).ok_or_else(|| NoChord(text.to_owned()))?;
        Ok(Self { key, held })
    }
}
