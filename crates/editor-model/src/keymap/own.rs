//! Keys that the user chose. Only these are stored, and they win over the keys of the preset. So a choice applies with
//! either preset, and undoing it returns the key to the command that had it.

use std::collections::BTreeMap;

use super::table::BINDINGS;
use super::{Action, Chord, Key, Keymap, Scope, Where};

/// A command in the list of keys. It is one row of `BINDINGS`: an action, and the scopes in which its keys work.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct CommandId(usize);

/// A command with its keys.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CommandKeys {
    /// Which command it is.
    pub id: CommandId,
    /// Its keys now.
    pub chords: Vec<Chord>,
    /// Whether these keys differ from the preset's.
    pub is_changed: bool,
}

/// The keys that the user chose, by command. An empty list means that the command has no key.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct OwnKeys(BTreeMap<CommandId, Vec<Chord>>);

impl CommandId {
    /// The command of this name, as [`Self::name`] gives it.
    pub fn named(name: &str) -> Option<Self> {
        (0..BINDINGS.len()).map(Self).find(|id| id.name() == name)
    }

    /// What its keys do.
    pub fn action(self) -> Action {
        BINDINGS[self.0].action
    }

    /// Its name, which no other command has: if an action has more than one row of `BINDINGS`, the name also says where
    /// the keys work.
    pub fn name(self) -> String {
        let Self(index) = self;
        let name = BINDINGS[index].name;
        let is_alone = BINDINGS.iter().filter(|other| other.name == name).count() == 1;
        match self.place() {
            Some(place) if !is_alone => format!("{name} ({place})"),
            _ => name.to_owned(),
        }
    }

    /// Where its keys work, in words; `None` for everywhere.
    pub fn place(self) -> Option<&'static str> {
        let holds = BINDINGS[self.0].holds;
        if holds.contains(&Where::Everywhere) {
            return None;
        }
        holds.first().map(|place| match place {
            Where::Everywhere => "Everywhere",
            Where::In(Scope::Arrange | Scope::Animate) => "Arrange and Animate",
            Where::In(Scope::Paint) => "Paint",
            Where::In(Scope::Lane) => "keys on a lane",
            Where::In(Scope::Transform | Scope::Drawing) => "while moving or drawing",
            Where::In(Scope::Typing) => "in a field",
        })
    }

    /// Whether its keys may be changed. `Esc` always cancels.
    pub fn is_free(self) -> bool {
        self.action() != Action::Cancel
    }

    /// Why it cannot have this key, in words; `None` if it can.
    pub fn refusal(self, chord: Chord) -> Option<&'static str> {
        let holds = BINDINGS[self.0].holds;
        let is_plain = !chord.held.ctrl && !chord.held.alt;
        let is_number = matches!(
            chord.key,
            Key::Digit(_) | Key::NumPad(_) | Key::NumPadPoint | Key::Sign('.' | ',' | '-')
        );
        if chord.key == Key::Escape || !self.is_free() {
            Some("Esc always cancels")
        } else if holds.contains(&Where::In(Scope::Transform)) && is_plain && is_number {
            Some("numbers are typed while moving")
        } else if holds == [Where::In(Scope::Typing)]
            && !chord.held.ctrl
            && !matches!(chord.key, Key::Function(_))
        {
            Some("in a field it is text; hold Ctrl, or take F1 to F35")
        } else {
            None
        }
    }

    /// Whether the two commands cannot share a key: they work in the same scope, or one works everywhere and the other
    /// in a mode. (Modal tools, fields and lanes may take a key that otherwise works everywhere.)
    fn meets(self, other: Self) -> bool {
        let is_mode = |place: &Where| {
            matches!(place, Where::In(Scope::Arrange | Scope::Paint | Scope::Animate) | Where::Everywhere)
        };
        let [own, others] = [self, other].map(|id| BINDINGS[id.0].holds);
        let covers =
            |one: &[Where], two: &[Where]| one.contains(&Where::Everywhere) && two.iter().any(is_mode);
        self != other
            && (own.iter().any(|place| others.contains(place)) || covers(own, others) || covers(others, own))
    }
}

impl OwnKeys {
    /// Whether the user chose no keys.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// The commands whose keys the user chose, each with these keys.
    pub fn iter(&self) -> impl Iterator<Item = (CommandId, &[Chord])> {
        self.0.iter().map(|(id, chords)| (*id, chords.as_slice()))
    }

    /// Stores keys as they were read from a file. `Esc` is left out, since it always cancels.
    pub fn note(&mut self, id: CommandId, mut chords: Vec<Chord>) {
        chords.retain(|chord| chord.key != Key::Escape);
        if id.is_free() {
            self.0.insert(id, chords);
        }
    }

    /// Another command for which the user chose one of these keys, and which cannot share it with the command `id`.
    pub fn owner(&self, id: CommandId, chords: &[Chord]) -> Option<CommandId> {
        let has = |(other, own): (CommandId, &[Chord])| {
            (other.meets(id) && own.iter().any(|chord| chords.contains(chord))).then_some(other)
        };
        self.iter().find_map(has)
    }

    pub(super) fn of(&self, index: usize) -> Option<&[Chord]> {
        self.0.get(&CommandId(index)).map(Vec::as_slice)
    }

    /// Whether the command at `index` lost this key, because the user gave it to another command.
    pub(super) fn takes(&self, index: usize, chord: Chord) -> bool {
        self.0.iter().any(|(id, chords)| chords.contains(&chord) && id.meets(CommandId(index)))
    }
}

impl Keymap {
    /// Every command with its keys, in the order of the menus.
    pub fn commands(&self) -> impl Iterator<Item = CommandKeys> {
        self.bindings().enumerate().map(|(index, (binding, chords))| {
            let is_changed = chords != self.preset_chords(binding);
            CommandKeys { id: CommandId(index), chords, is_changed }
        })
    }

    /// The commands that would lose a key if the command `id` got these keys.
    pub fn losers(&self, id: CommandId, chords: &[Chord]) -> Vec<CommandId> {
        let loses = |other: &CommandKeys| {
            other.id.meets(id) && other.chords.iter().any(|chord| chords.contains(chord))
        };
        self.commands().filter(loses).map(|other| other.id).collect()
    }

    /// The commands that a focused lane would hide if its command `id` had these keys: they have one of these keys, and
    /// work in Animate or everywhere. Empty if `id` is not a command of lanes.
    pub fn hidden(&self, id: CommandId, chords: &[Chord]) -> Vec<CommandId> {
        if BINDINGS[id.0].holds != [Where::In(Scope::Lane)] {
            return Vec::new();
        }
        let holds_there = |other: &CommandKeys| {
            let holds = BINDINGS[other.id.0].holds;
            holds.contains(&Where::Everywhere) || holds.contains(&Where::In(Scope::Animate))
        };
        let hides = |other: &CommandKeys| {
            other.id != id && holds_there(other) && other.chords.iter().any(|chord| chords.contains(chord))
        };
        self.commands().filter(hides).map(|other| other.id).collect()
    }

    /// The keys of a command in the preset, without changes by the user.
    pub fn usual(&self, id: CommandId) -> Vec<Chord> {
        self.preset_chords(&BINDINGS[id.0])
    }

    /// The keymap with these keys for a command. Commands that cannot share a key with it lose that key.
    ///
    /// If the command cannot have one of the keys, nothing changes.
    pub fn with(&self, id: CommandId, chords: Vec<Chord>) -> Self {
        let mut keymap = self.clone();
        if chords.iter().any(|chord| id.refusal(*chord).is_some()) && chords != self.usual(id) {
            return keymap;
        }
        for (other, own) in &mut keymap.own.0 {
            if other.meets(id) {
                own.retain(|chord| !chords.contains(chord));
            }
        }
        if chords == self.usual(id) {
            keymap.own.0.remove(&id);
        } else {
            keymap.own.note(id, chords);
        }
        keymap
    }
}
