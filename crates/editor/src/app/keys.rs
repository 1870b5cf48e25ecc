//! Hands key presses, and turns of the mouse wheel with `Alt`, from egui to the editor.

use egui::{Event, MouseWheelUnit, Ui};
use impasto_editor_model::editor::Editor;
use impasto_editor_model::keymap::{Key, Modifiers};
use impasto_editor_model::picking::View;
use impasto_editor_model::timeline::TimelineEvent;

use crate::widgets::{key_of, leaves_space};

pub(super) fn held(held: egui::Modifiers) -> Modifiers {
    Modifiers { ctrl: held.command, shift: held.shift, alt: held.alt }
}

/// Hands the keys that were just pressed to the editor, those of the number pad first. Keys that the editor uses do not
/// reach the panels.
pub(super) fn hand_on(ui: &mut Ui, editor: &mut Editor, view: &View, numpad: &[(Key, Modifiers)]) {
    let typing = ui.ctx().text_edit_focused();
    // A control with the keyboard focus uses Space, Enter, Esc, Tab and the arrows itself.
    let control_focused = !typing && ui.memory(|memory| memory.focused().is_some());
    for &(key, held) in numpad {
        editor.key(key, held, typing, view);
    }
    let events = ui.input(|input| input.events.clone());
    let mut taken = Vec::new();
    for (index, event) in events.iter().enumerate() {
        let Event::Key { key, pressed: true, modifiers, .. } = event else { continue };
        let held = held(*modifiers);
        let Some(key) = key_of(*key) else { continue };
        let used_by_controls = matches!(
            key,
            Key::Space | Key::Enter | Key::Left | Key::Right | Key::Up | Key::Down | Key::Escape | Key::Tab
        );
        let is_left = key == Key::Space && leaves_space(ui.ctx());
        if control_focused && used_by_controls && !is_left {
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
