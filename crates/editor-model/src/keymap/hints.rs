//! Words that name keys, as the status line has them, in the keys that are in use.

use super::{Action, Keymap, Preset};

/// The usual keys, as hints are written, and what they do.
const USUAL: [(&str, &[Action]); 6] = [
    ("F", &[Action::SizeRadius]),
    ("G R S", &[Action::Move, Action::Turn, Action::Scale]),
    ("Shift A", &[Action::Add]),
    ("I", &[Action::SetKey]),
    ("Space", &[Action::Play]),
    ("NumPad 0", &[Action::LookThrough]),
];

impl Keymap {
    /// Hints such as `[F] radius  [Middle] orbit`, with the keys in use in place of the usual ones. A hint for what has
    /// no key is left out.
    pub fn in_own_keys(&self, hints: &str) -> String {
        let mut pieces = hints.split('[');
        let mut words = pieces.next().unwrap_or_default().to_owned();
        for piece in pieces {
            let Some((key, explained)) = piece.split_once(']') else {
                words.push_str(&format!("[{piece}"));
                continue;
            };
            if let Some(key) = self.own_key(key) {
                words.push_str(&format!("[{key}]{explained}"));
            }
        }
        words.trim_end().to_owned()
    }

    fn own_key(&self, usual: &str) -> Option<String> {
        if usual == "Middle" && self.preset == Preset::Maya {
            return Some("Alt Drag".to_owned());
        }
        let Some((_, actions)) = USUAL.iter().find(|(key, _)| *key == usual) else {
            return Some(usual.to_owned());
        };
        let keys: Option<Vec<String>> = actions.iter().map(|&action| self.shortcut_text(action)).collect();
        keys.map(|keys| keys.join(" "))
    }
}
