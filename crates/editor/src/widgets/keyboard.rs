//! Converts egui's keys to those of the keymap.

use egui::Key as EguiKey;
use impasto_editor_model::keymap::Key;

/// The keymap's key for a key of egui; `None` if the keymap has none.
pub(crate) fn key_of(key: EguiKey) -> Option<Key> {
    let name = key.name();
    let mut characters = name.chars();
    Some(match key {
        EguiKey::Space => Key::Space,
        EguiKey::Tab => Key::Tab,
        EguiKey::Enter => Key::Enter,
        EguiKey::Escape => Key::Escape,
        EguiKey::Backspace => Key::Backspace,
        EguiKey::Delete => Key::Delete,
        EguiKey::Home => Key::Home,
        EguiKey::ArrowLeft => Key::Left,
        EguiKey::ArrowRight => Key::Right,
        EguiKey::ArrowUp => Key::Up,
        EguiKey::ArrowDown => Key::Down,
        EguiKey::OpenBracket => Key::Sign('['),
        EguiKey::CloseBracket => Key::Sign(']'),
        EguiKey::Comma => Key::Sign(','),
        EguiKey::Period => Key::Sign('.'),
        EguiKey::Minus => Key::Sign('-'),
        _ => match (characters.next()?, characters.as_str()) {
            (letter @ 'A'..='Z', "") => Key::Letter(letter),
            (digit @ '0'..='9', "") => Key::Digit(digit as u8 - b'0'),
            ('F', number) => Key::Function(number.parse().ok()?),
            _ => return None,
        },
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_what_is_printed_on_them() {
        assert_eq!(key_of(EguiKey::A), Some(Key::Letter('A')));
        assert_eq!(key_of(EguiKey::Num7), Some(Key::Digit(7)));
        assert_eq!(key_of(EguiKey::F12), Some(Key::Function(12)));
        assert_eq!(key_of(EguiKey::F), Some(Key::Letter('F')));
        assert_eq!(key_of(EguiKey::OpenBracket), Some(Key::Sign('[')));
    }
}
