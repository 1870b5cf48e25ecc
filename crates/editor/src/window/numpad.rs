//! Passes keys of the number pad to the application: egui does not distinguish them from keys of the main row.

use egui::{Context, Id};
use impasto_editor_model::keymap::{Key, Modifiers};
use winit::event::{ElementState, KeyEvent};
use winit::keyboard::{KeyCode, PhysicalKey};

/// The key of the number pad that was pressed; none for other keys, and for releases.
pub(super) fn numpad_key(event: &KeyEvent) -> Option<Key> {
    let PhysicalKey::Code(code) = event.physical_key else { return None };
    (event.state == ElementState::Pressed).then(|| of_code(code))?
}

fn of_code(code: KeyCode) -> Option<Key> {
    Some(match code {
        KeyCode::Numpad0 => Key::NumPad(0),
        KeyCode::Numpad1 => Key::NumPad(1),
        KeyCode::Numpad2 => Key::NumPad(2),
        KeyCode::Numpad3 => Key::NumPad(3),
        KeyCode::Numpad4 => Key::NumPad(4),
        KeyCode::Numpad5 => Key::NumPad(5),
        KeyCode::Numpad6 => Key::NumPad(6),
        KeyCode::Numpad7 => Key::NumPad(7),
        KeyCode::Numpad8 => Key::NumPad(8),
        KeyCode::Numpad9 => Key::NumPad(9),
        KeyCode::NumpadDecimal | KeyCode::NumpadComma => Key::NumPadPoint,
        _ => return None,
    })
}

fn id() -> Id {
    Id::unique("number pad for the app")
}

/// Keeps keys of the number pad for the next pass.
pub(super) fn keep_numpad(ctx: &Context, keys: Vec<(Key, Modifiers)>) {
    ctx.data_mut(|data| data.get_temp_mut_or_default::<Vec<_>>(id()).extend(keys));
}

/// Takes the keys of the number pad that were pressed while no text field had the focus, each with the modifiers that
/// were held.
pub fn numpad_pressed(ctx: &Context) -> Vec<(Key, Modifiers)> {
    ctx.data_mut(|data| data.remove_temp(id())).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pad_has_keys_of_its_own() {
        assert_eq!(of_code(KeyCode::Numpad7), Some(Key::NumPad(7)));
        assert_eq!(of_code(KeyCode::NumpadDecimal), Some(Key::NumPadPoint));
        assert_eq!(of_code(KeyCode::Digit7), None);
        assert_eq!(of_code(KeyCode::NumpadEnter), None, "the pad's Enter is no key of its own");
    }

    #[test]
    fn a_key_is_taken_once() {
        let ctx = Context::default();
        let held = Modifiers::default();
        keep_numpad(&ctx, vec![(Key::NumPad(1), held)]);
        keep_numpad(&ctx, vec![(Key::NumPadPoint, held)]);
        assert_eq!(numpad_pressed(&ctx), [(Key::NumPad(1), held), (Key::NumPadPoint, held)]);
        assert_eq!(numpad_pressed(&ctx), []);
    }
}
