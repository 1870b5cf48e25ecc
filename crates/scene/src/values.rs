//! How small values are written in a scene file: colours as `"#rrggbb"`, scales as one number or three, brushes as one
//! name or a list.

use std::fmt;

use serde::de::{self, Deserialize, Deserializer, SeqAccess, Visitor};
use serde::ser::{Serialize, Serializer};

use crate::document::{BrushMix, Color, Scale};

impl Color {
    /// Reads `#rgb` or `#rrggbb`; `None` for anything else.
    pub fn from_hex(text: &str) -> Option<Self> {
        let digits = text.strip_prefix('#')?;
        if !digits.bytes().all(|byte| byte.is_ascii_hexdigit()) {
            return None;
        }
        let channel = |from: &str| u8::from_str_radix(from, 16).ok().map(|value| f32::from(value) / 255.0);
        match digits.len() {
            3 => {
                let mut channels = [0.0; 3];
                for (channel_value, digit) in channels.iter_mut().zip(digits.chars()) {
                    *channel_value = channel(&format!("{digit}{digit}"))?;
                }
                Some(Self(channels))
            }
            6 => Some(Self([channel(&digits[0..2])?, channel(&digits[2..4])?, channel(&digits[4..6])?])),
            _ => None,
        }
    }

    /// `#rrggbb`, rounded to 8 bits a channel.
    pub fn to_hex(self) -> String {
        let [r, g, b] = self.0.map(|channel| (channel.clamp(0.0, 1.0) * 255.0).round() as u8);
        format!("#{r:02x}{g:02x}{b:02x}")
    }
}

impl Serialize for Color {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&self.to_hex())
    }
}

impl<'de> Deserialize<'de> for Color {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct HexVisitor;
        impl Visitor<'_> for HexVisitor {
            type Value = Color;
            fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                formatter.write_str("a colour such as \"#b3262a\"")
            }
            fn visit_str<E: de::Error>(self, text: &str) -> Result<Color, E> {
                Color::from_hex(text).ok_or_else(|| E::invalid_value(de::Unexpected::Str(text), &self))
            }
        }
        deserializer.deserialize_str(HexVisitor)
    }
}

impl Serialize for Scale {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let [x, y, z] = self.0;
        if x == y && y == z { x.serialize(serializer) } else { self.0.serialize(serializer) }
    }
}

impl<'de> Deserialize<'de> for Scale {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ScaleVisitor;
        impl<'de> Visitor<'de> for ScaleVisitor {
            type Value = Scale;
            fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                formatter.write_str("one number, or three as (x, y, z)")
            }
            fn visit_f64<E: de::Error>(self, value: f64) -> Result<Scale, E> {
                Ok(Scale([value; 3]))
            }
            fn visit_u64<E: de::Error>(self, value: u64) -> Result<Scale, E> {
                Ok(Scale([value as f64; 3]))
            }
            fn visit_i64<E: de::Error>(self, value: i64) -> Result<Scale, E> {
                Ok(Scale([value as f64; 3]))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut sequence: A) -> Result<Scale, A::Error> {
                let mut values = [0.0; 3];
                for (index, value) in values.iter_mut().enumerate() {
                    *value =
                        sequence.next_element()?.ok_or_else(|| de::Error::invalid_length(index, &self))?;
                }
                Ok(Scale(values))
            }
        }
        deserializer.deserialize_any(ScaleVisitor)
    }
}

impl Serialize for BrushMix {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match &self.0[..] {
            [name] => name.serialize(serializer),
            names => names.serialize(serializer),
        }
    }
}

impl<'de> Deserialize<'de> for BrushMix {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct MixVisitor;
        impl<'de> Visitor<'de> for MixVisitor {
            type Value = BrushMix;
            fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
                formatter.write_str("a brush such as \"filbert\", or a list of brushes")
            }
            fn visit_str<E: de::Error>(self, text: &str) -> Result<BrushMix, E> {
                Ok(BrushMix(vec![text.to_owned()]))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut sequence: A) -> Result<BrushMix, A::Error> {
                let mut names = Vec::new();
                while let Some(name) = sequence.next_element()? {
                    names.push(name);
                }
                Ok(BrushMix(names))
            }
        }
        deserializer.deserialize_any(MixVisitor)
    }
}
