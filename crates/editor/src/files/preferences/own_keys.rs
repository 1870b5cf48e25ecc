//! Keys of the user's own as the file has them: commands and keys in words. Whatever cannot be read is left out, told,
//! and stays in the file: a newer Impasto may have written it.

use std::collections::BTreeMap;

use impasto_editor_model::keymap::{Chord, CommandId, OwnKeys};
use serde::{Deserialize, Deserializer, Serialize};

/// For each command by its name, its keys: `{"Comb": ["Ctrl K"]}`.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
#[serde(transparent)]
pub struct OwnKeysText(BTreeMap<String, Vec<String>>);

impl OwnKeysText {
    /// What can be read of it.
    pub fn keys(&self) -> OwnKeys {
        let mut own = OwnKeys::default();
        for (name, texts) in &self.0 {
            let chords: Result<Vec<Chord>, _> = texts.iter().map(|text| text.parse()).collect();
            if let (Some(id), Ok(chords)) = (CommandId::named(name), chords) {
                own.note(id, chords);
            }
        }
        own
    }

    /// What cannot be read of it, in words; `None` if all can.
    pub fn fault(&self) -> Option<String> {
        let fault = |(name, texts): (&String, &Vec<String>)| {
            if CommandId::named(name).is_none() {
                return Some(format!("no command is called “{name}”"));
            }
            texts.iter().find_map(|text| text.parse::<Chord>().err()).map(|fault| format!("{name}: {fault}"))
        };
        let mut faults = self.0.iter().filter_map(fault);
        let first = faults.next()?;
        let more = match faults.count() {
            0 => String::new(),
            count => format!(" (and {count} more)"),
        };
        Some(format!("Some of your own keys cannot be read, and are left out: {first}{more}"))
    }

    /// Takes these keys in place of those that can be read.
    pub fn set(&mut self, own: &OwnKeys) {
        let read = self.keys();
        for (id, _) in read.iter() {
            self.0.remove(&id.name());
        }
        for (id, chords) in own.iter() {
            self.0.insert(id.name(), chords.iter().map(Chord::text).collect());
        }
    }
}

impl<'de> Deserialize<'de> for OwnKeysText {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        let mut read = BTreeMap::new();
        // Anything may stand here; what is no map of names to lists of words has no keys.
        if let ron::Value::Map(map) = ron::Value::deserialize(from)? {
            for (name, keys) in map {
                let ron::Value::String(name) = name else { continue };
                let word = |value: ron::Value| match value {
                    ron::Value::String(text) => text,
                    other => format!("{other:?}"),
                };
                let texts = match keys {
                    ron::Value::Seq(texts) => texts.into_iter().map(word).collect(),
                    single => vec![word(single)],
                };
                read.insert(name, texts);
            }
        }
        Ok(Self(read))
    }
}
