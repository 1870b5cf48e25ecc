//! Hints that name keys, as in the status line. They are written with the usual keys, and shown with the keys in use.

use super::{Action, Keymap, Preset};

/// The usual keys, as hints name them, and what these keys do.
const USUAL: [(&str, &[Action]); 6] = [
    ("F", &[Action::SizeRadius]),
    ("G R S", &[Action::Move, Action::Turn, Action::Scale]),
    ("Shift A", &[Action::Add]),
    ("I", &[Action::SetKey]),
    ("Space", &[Action::Play]),
    ("NumPad 0", &[Action::LookThrough]),
];

impl Keymap {
    /// Hints such as `[F] radius  [Middle] orbit`, with the keys in use in place of the usual ones. If an action has no
    /// key, its hint is left out.
    pub fn in_own_keys(&self, hints: &str) -> String {
        // A bracket begins a hint only after two spaces. Elsewhere it belongs to a name.
        let apart = format!("  {hints}");
        let mut pieces = apart.split("  [");
        let mut words = pieces.next().unwrap_or_default().trim_start().to_owned();
        for piece in pieces {
            let hint = match piece.split_once(']') {
                Some((key, explained)) => self.own_key(key).map(|key| format!("[{key}]{explained}")),
                None => Some(format!("[{piece}")),
            };
            let Some(hint) = hint else { continue };
            if !words.is_empty() {
                words.push_str("  ");
            }
            words.push_str(&hint);
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
