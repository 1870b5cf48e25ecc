//! The user's own keys as the preferences file has them: names of commands and of keys. An entry that cannot be read is
//! not used, is reported ([`OwnKeysText::fault`]), and stays in the file: a newer Impasto may have written it.

use impasto_editor_model::keymap::{Chord, CommandId, OwnKeys};
use ron::Value;
use serde::{Deserialize, Serialize};

/// For each command by its name, its keys: `{"Comb": ["Ctrl K"]}`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct OwnKeysText(Value);

impl Default for OwnKeysText {
    fn default() -> Self {
        Self(Value::Map(ron::Map::new()))
    }
}

impl OwnKeysText {
    /// The keys that can be read.
    pub fn keys(&self) -> OwnKeys {
        self.read().0
    }

    /// What is wrong with the first entry that cannot be used, and how many more there are; `None` if all can be used.
    pub fn fault(&self) -> Option<String> {
        let (_, faults) = self.read();
        let first = faults.first()?;
        let more = match faults.len() - 1 {
            0 => String::new(),
            count => format!(" (and {count} more)"),
        };
        Some(format!("Some of your own keys cannot be read, and are left out: {first}{more}"))
    }

    /// Puts `own` in place of all keys that can be read. Other entries stay, except those for commands of `own`, and
    /// those that could be used now because the keys that they name have become free.
    pub fn set(&mut self, own: &OwnKeys) {
        let read = self.keys();
        let mut map = match std::mem::replace(&mut self.0, Value::Unit) {
            Value::Map(map) => map,
            // A value that is no map is kept in the new map, under `()`, which is the name of no command.
            other => std::iter::once((Value::Unit, other)).collect(),
        };
        let name_of = |id: CommandId| Value::String(id.name());
        for (id, _) in read.iter() {
            map.remove(&name_of(id));
        }
        for (id, chords) in own.iter() {
            let texts = chords.iter().map(|chord| Value::String(chord.text())).collect();
            map.insert(name_of(id), Value::Seq(texts));
        }
        self.0 = Value::Map(map);
        // An entry may have been refused only because another command had its keys. If that command now has different
        // keys, the entry would take effect unasked, so it is removed.
        loop {
            let is_extra = |id: &CommandId| own.iter().all(|(other, _)| other != *id);
            let extra = self.keys().iter().map(|(id, _)| id).find(is_extra);
            let (Some(id), Value::Map(map)) = (extra, &mut self.0) else { break };
            map.remove(&name_of(id));
        }
    }

    /// What can be read, and what is wrong with the rest.
    fn read(&self) -> (OwnKeys, Vec<String>) {
        let (mut own, mut faults) = (OwnKeys::default(), Vec::new());
        let Value::Map(map) = &self.0 else {
            return (own, vec!["they are no list of commands with their keys".to_owned()]);
        };
        for (name, keys) in map.iter() {
            let entry = entry(name, keys).and_then(|(id, chords)| match own.owner(id, &chords) {
                Some(owner) => Err(format!("“{}” has the keys of “{}”", id.name(), owner.name())),
                None => Ok((id, chords)),
            });
            match entry {
                Ok((id, chords)) => own.note(id, chords),
                Err(fault) => faults.push(fault),
            }
        }
        (own, faults)
    }
}

/// A command with its keys, read from an entry; the error says in words why the entry cannot be used.
fn entry(name: &Value, keys: &Value) -> Result<(CommandId, Vec<Chord>), String> {
    let Value::String(name) = name else {
        return Err("the name of a command must be a text".to_owned());
    };
    let id = CommandId::named(name).ok_or_else(|| format!("no command is called “{name}”"))?;
    if !id.is_free() {
        return Err(format!("{name}: Esc always cancels"));
    }
    let texts = match keys {
        Value::Seq(texts) => texts.as_slice(),
        single => std::slice::from_ref(single),
    };
    let chord = |text: &Value| {
        let Value::String(text) = text else {
            return Err(format!("{name}: a key must be a text"));
        };
        let chord: Chord = text.parse().map_err(|fault| format!("{name}: {fault}"))?;
        match id.refusal(chord) {
            Some(reason) => Err(format!("{name}: {text} cannot be given: {reason}")),
            None => Ok(chord),
        }
    };
    Ok((id, texts.iter().map(chord).collect::<Result<_, _>>()?))
}
