//! Splits the input of a frame into passes, so that neither egui nor the editor misses a click or mixes up the order.

use egui::{Event, RawInput};

/// Splits the input since the last frame into passes. A pass has at most one press or release of a button. A key press
/// that follows a move or click of the pointer begins a new pass; a repeat does not.
///
/// A slow frame may gather a whole drag. egui looks at the pointer once per pass, and would miss the drag. The editor
/// handles the keys of a pass before the pointer: if `Ctrl Z` came in the same pass as the end of a drag, the editor
/// would handle the keys while the drag is still under way.
pub(super) fn one_thing_each(mut input: RawInput) -> Vec<RawInput> {
    let events = std::mem::take(&mut input.events);
    let mut parts = vec![Vec::new()];
    let (mut button_seen, mut pointer_seen) = (false, false);
    for event in events {
        let button = matches!(event, Event::PointerButton { .. });
        let key = matches!(event, Event::Key { pressed: true, repeat: false, .. });
        if button && button_seen || key && pointer_seen {
            parts.push(Vec::new());
            (button_seen, pointer_seen) = (false, false);
        }
        button_seen |= button;
        pointer_seen |= button || matches!(event, Event::PointerMoved(_));
        if let Some(part) = parts.last_mut() {
            part.push(event);
        }
    }
    let last = parts.len() - 1;
    let mut passes = Vec::with_capacity(parts.len());
    for (index, events) in parts.into_iter().enumerate() {
        let mut pass = RawInput { events, ..input.clone() };
        if index < last {
            pass.dropped_files.clear();
        }
        passes.push(pass);
    }
    passes
}

#[cfg(test)]
mod tests {
    use egui::{Modifiers, PointerButton, pos2};

    use super::*;

    fn button(pressed: bool) -> Event {
        Event::PointerButton {
            pos: pos2(1.0, 1.0),
            button: PointerButton::Primary,
            pressed,
            modifiers: Modifiers::NONE,
        }
    }

    #[derive(Debug)]
    struct Apple;

    impl egui::DroppedFile for Apple {
        fn path(&self) -> &std::path::Path {
            std::path::Path::new("apple.obj")
        }

        fn bytes(&self) -> Result<Vec<u8>, String> {
            Err("never read".to_owned())
        }
    }

    #[test]
    fn a_drag_within_one_frame_becomes_two_passes() {
        let moved = |x| Event::PointerMoved(pos2(x, 1.0));
        let events = vec![moved(0.0), button(true), moved(5.0), moved(9.0), button(false), Event::Copy];
        let passes = one_thing_each(RawInput { events, ..RawInput::default() });
        let events: Vec<_> = passes.into_iter().map(|pass| pass.events).collect();
        assert_eq!(
            events,
            [vec![moved(0.0), button(true), moved(5.0), moved(9.0)], vec![button(false), Event::Copy]]
        );
    }

    #[test]
    fn a_key_after_the_pointer_has_a_pass_of_its_own() {
        let moved = |x| Event::PointerMoved(pos2(x, 1.0));
        let key = |repeat| Event::Key {
            key: egui::Key::Z,
            physical_key: None,
            pressed: true,
            repeat,
            modifiers: Modifiers::CTRL,
        };
        let events = vec![
            key(false),
            key(false),
            moved(0.0),
            button(true),
            key(true),
            button(false),
            key(false),
            moved(1.0),
        ];
        let passes = one_thing_each(RawInput { events, ..RawInput::default() });
        let events: Vec<_> = passes.into_iter().map(|pass| pass.events).collect();
        assert_eq!(
            events,
            [
                vec![key(false), key(false), moved(0.0), button(true), key(true)],
                vec![button(false)],
                vec![key(false), moved(1.0)]
            ]
        );
    }

    #[test]
    fn a_dropped_file_arrives_once() {
        let events = vec![button(true), button(false)];
        let dropped_files = vec![std::sync::Arc::new(Apple) as _];
        let passes = one_thing_each(RawInput { events, dropped_files, ..RawInput::default() });
        assert_eq!(passes.iter().map(|pass| pass.dropped_files.len()).collect::<Vec<_>>(), [0, 1]);
    }

    #[test]
    fn a_quiet_frame_is_one_pass() {
        assert_eq!(one_thing_each(RawInput::default()).len(), 1);
    }
}
