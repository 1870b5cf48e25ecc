//! Hands key presses, and turns of the mouse wheel with `Alt`, from egui to the editor.

use egui::{Event, Key as EguiKey, MouseWheelUnit, Ui};
use impasto_editor_model::editor::Editor;
use impasto_editor_model::keymap::{Key, Modifiers};
use impasto_editor_model::picking::View;
use impasto_editor_model::timeline::TimelineEvent;

/// Hands the keys that were just pressed to the editor, those of the number pad first. Keys that the editor uses do not
/// reach the panels.
pub(super) fn hand_on(ui: &mut Ui, editor: &mut Editor, view: &View, numpad: Vec<(Key, Modifiers)>) {
    let typing = ui.ctx().text_edit_focused();
    // A control with the keyboard focus uses Space, Enter and the arrows itself.
    let control_focused = !typing && ui.memory(|memory| memory.focused().is_some());
    for (key, held) in numpad {
        editor.key(key, held, typing, view);
    }
    let events = ui.input(|input| input.events.clone());
    let mut taken = Vec::new();
    for (index, event) in events.iter().enumerate() {
        let Event::Key { key, pressed: true, modifiers, .. } = event else { continue };
        let held = Modifiers { ctrl: modifiers.command, shift: modifiers.shift, alt: modifiers.alt };
        let Some(key) = key_of(*key) else { continue };
        let used_by_controls = matches!(
            key,
            Key::Space | Key::Enter | Key::Left | Key::Right | Key::Up | Key::Down | Key::Escape | Key::Tab
        );
        if control_focused && used_by_controls {
            continue;
        }
        if key != Key::Tab && editor.key(key, held, typing, view) {
            taken.push(index);
        }
    }
    if taken.is_empty() {
        return;
    }
    ui.input_mut(|input| {
        let mut index = 0;
        input.events.retain(|event| {
            // The editor used a key, so its letter must not be typed as well.
            let is_taken = taken.contains(&index) || !typing && matches!(event, Event::Text(_));
            index += 1;
            !is_taken
        });
    });
}

/// With `Alt`, the wheel steps through frames, wherever the pointer is.
pub(super) fn wheel(ui: &mut Ui, editor: &mut Editor) {
    if !ui.input(|input| input.modifiers.alt) {
        return;
    }
    let mut steps = 0.0;
    ui.input_mut(|input| {
        input.events.retain(|event| {
            let Event::MouseWheel { unit, delta, .. } = event else { return true };
            let turned = if delta.y == 0.0 { delta.x } else { delta.y };
            steps -= match unit {
                MouseWheelUnit::Point => turned / 50.0,
                MouseWheelUnit::Line | MouseWheelUnit::Page => turned,
            };
            false
        });
        input.smooth_scroll_delta = egui::Vec2::ZERO;
    });
    let id = egui::Id::unique("frames by the wheel");
    let whole = ui.data_mut(|data| {
        let turned = data.get_temp_mut_or_default::<f32>(id);
        *turned += steps;
        let whole = turned.trunc();
        *turned -= whole;
        whole
    });
    if whole != 0.0 {
        let frame = editor.session.frame.round() + f64::from(whole);
        editor.timeline(TimelineEvent::GoTo(frame));
    }
}

fn key_of(key: EguiKey) -> Option<Key> {
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
