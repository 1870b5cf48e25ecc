//! Tests of the keymap: no conflicts, documented keys, scopes.

use std::collections::HashMap;
use std::sync::LazyLock;

use super::*;

mod own;

static BLENDER: LazyLock<Keymap> = LazyLock::new(Keymap::default);
static MAYA: LazyLock<Keymap> = LazyLock::new(|| Keymap { preset: Preset::Maya, ..Keymap::default() });

fn keymaps() -> impl Iterator<Item = Keymap> {
    [Preset::Blender, Preset::Maya].into_iter().flat_map(|preset| {
        [Digits::Modes, Digits::NumPad].into_iter().map(move |digits| Keymap {
            preset,
            digits,
            own: OwnKeys::default(),
        })
    })
}

fn chord(text: &str) -> Chord {
    text.parse().unwrap()
}

fn does(keymap: &Keymap, text: &str, scope: Scope) -> Option<Action> {
    let Chord { key, held } = chord(text);
    keymap.action_for(key, held, scope)
}

#[test]
fn no_key_does_two_things_in_one_scope() {
    for keymap in keymaps() {
        let mut taken: HashMap<(Where, Chord), Action> = HashMap::new();
        for (binding, chords) in keymap.bindings() {
            for &place in binding.holds {
                for &chord in &chords {
                    if let Some(other) = taken.insert((place, chord), binding.action) {
                        panic!(
                            "{keymap:?}: {} is {other:?} and {:?} in {place:?}",
                            chord.text(),
                            binding.action
                        );
                    }
                }
            }
        }
        // A mode must not hide a key that works everywhere. Modal tools, fields and lanes may take such keys.
        for (&(place, chord), &action) in &taken {
            if place != Where::Everywhere
                && let Some(&shadowed) = taken.get(&(Where::Everywhere, chord))
            {
                let modes = [Scope::Arrange, Scope::Paint, Scope::Animate].map(Where::In);
                let purposely = !modes.contains(&place) || shadowed == action;
                assert!(purposely, "{keymap:?}: {place:?} hides {shadowed:?} behind {action:?}");
            }
        }
    }
}

#[test]
fn the_keys_of_both_presets_are_as_documented() {
    use Action as A;
    use Scope as S;
    let all: &[Scope] = &[S::Arrange, S::Paint, S::Animate];
    let posing: &[Scope] = &[S::Arrange, S::Animate];
    let paint: &[Scope] = &[S::Paint];
    let rows: &[(Action, &[Scope], &str, &str)] = &[
        (A::FrameSelected, all, "NumPad .", "F"),
        (A::FrameSelected, posing, "F", "F"),
        (A::FrameAll, all, "Home", "A"),
        (A::SizeRadius, paint, "F", "B"),
        (A::SizeStrength, paint, "Shift F", "Shift B"),
        (A::SmallerRadius, paint, "[", "["),
        (A::LargerRadius, paint, "]", "]"),
        (A::Arrange, all, "1", "1"),
        (A::Paint, all, "2", "2"),
        (A::Animate, all, "3", "3"),
        (A::TogglePaint, all, "Tab", "Tab"),
        (A::ViewFront, all, "NumPad 1", "Ctrl 1"),
        (A::ViewRight, all, "NumPad 3", "Ctrl 3"),
        (A::ViewTop, all, "NumPad 7", "Ctrl 7"),
        (A::ToggleOrthographic, all, "NumPad 5", "Ctrl 5"),
        (A::LookThrough, all, "NumPad 0", "Ctrl 0"),
        (A::Move, posing, "G", "W"),
        (A::Turn, posing, "R", "E"),
        (A::Scale, posing, "S", "R"),
        (A::Comb, paint, "C", "C"),
        (A::GuideCurve, paint, "V", "V"),
        (A::Fill, paint, "D", "D"),
        (A::TurnDirection, paint, "T", "T"),
        (A::Smooth, paint, "S", "S"),
        (A::Erase, paint, "E", "E"),
        (A::Region, paint, "M", "M"),
        (A::Amount, paint, "P", "P"),
        (A::Touch, paint, "U", "U"),
        (A::Pick, paint, "I", "I"),
        (A::SetKey, posing, "I", "S"),
        (A::Curves, posing, "C", "C"),
        (A::FlipUnderCursor, paint, "X", "X"),
        (A::Delete, posing, "X", "Delete"),
        (A::Delete, all, "Delete", "Delete"),
        (A::Delete, paint, "Backspace", "Backspace"),
        (A::Play, all, "Space", "Alt V"),
        (A::Play, all, "Space", "Space"),
        (A::StepBack, all, "←", "←"),
        (A::StepOn, all, "→", "→"),
        (A::PreviousKey, all, "↓", ","),
        (A::NextKey, all, "↑", "."),
        (A::FirstFrame, all, "Shift ←", "Shift ←"),
        (A::LastFrame, all, "Shift →", "Shift →"),
        (A::Compare, all, "K", "K"),
        (A::CycleDirections, all, "O", "O"),
        (A::ToggleTrust, all, "Shift O", "Shift O"),
        (A::ToggleColumn, all, "N", "N"),
        (A::MaximiseViewport, all, "Ctrl Space", "Ctrl Space"),
        (A::Undo, all, "Ctrl Z", "Z"),
        (A::Undo, all, "Ctrl Z", "Ctrl Z"),
        (A::Redo, all, "Ctrl Shift Z", "Shift Z"),
        (A::Redo, all, "Ctrl Y", "Ctrl Shift Z"),
        (A::Save, all, "Ctrl S", "Ctrl S"),
        (A::SaveAs, all, "Ctrl Shift S", "Ctrl Shift S"),
        (A::OpenScene, all, "Ctrl O", "Ctrl O"),
        (A::NewScene, all, "Ctrl N", "Ctrl N"),
        (A::ImportMesh, all, "Ctrl I", "Ctrl I"),
        (A::Render, all, "F12", "F12"),
        (A::Palette, all, "Ctrl P", "F3"),
        (A::Palette, all, "F3", "Ctrl P"),
        (A::Shortcuts, all, "F1", "F1"),
        (A::Hide, all, "H", "Ctrl H"),
        (A::ShowAll, all, "Alt H", "Ctrl Shift H"),
        (A::Lock, all, "L", "L"),
        (A::Duplicate, all, "Shift D", "Ctrl D"),
        (A::Rename, all, "F2", "F2"),
        (A::Add, all, "Shift A", "Shift A"),
        (A::SelectAll, all, "A", "Ctrl A"),
        (A::SelectNone, all, "Alt A", "Alt A"),
        (A::CameraFromView, all, "Ctrl Alt NumPad 0", "Ctrl Alt NumPad 0"),
        (A::Cancel, all, "Esc", "Esc"),
    ];
    for &(action, scopes, blender, maya) in rows {
        for &scope in scopes {
            assert_eq!(does(&BLENDER, blender, scope), Some(action), "Blender: {blender} in {scope:?}");
            assert_eq!(does(&MAYA, maya, scope), Some(action), "Maya: {maya} in {scope:?}");
        }
    }
}

#[test]
fn digits_can_stand_in_for_the_number_pad() {
    for preset in [Preset::Blender, Preset::Maya] {
        let keymap = Keymap { preset, digits: Digits::NumPad, ..Keymap::default() };
        for (digit, action) in [
            ("1", Action::ViewFront),
            ("3", Action::ViewRight),
            ("7", Action::ViewTop),
            ("0", Action::LookThrough),
            ("5", Action::ToggleOrthographic),
        ] {
            assert_eq!(does(&keymap, digit, Scope::Animate), Some(action));
        }
        assert_eq!(does(&keymap, "2", Scope::Animate), None);
        assert_eq!(does(&keymap, "Tab", Scope::Animate), Some(Action::TogglePaint));
        assert_eq!(does(&keymap, "Ctrl Tab", Scope::Animate), Some(Action::NextMode));
    }
}

#[test]
fn letters_never_fire_while_typing() {
    for keymap in keymaps() {
        for letter in 'A'..='Z' {
            for held in [Modifiers::default(), Modifiers { shift: true, ..Default::default() }] {
                assert_eq!(keymap.action_for(Key::Letter(letter), held, Scope::Typing), None, "{letter}");
            }
        }
        for text in ["Space", "←", "Delete", "Backspace", "1", "Ctrl Z", "Ctrl A", "Ctrl ←", "Tab", "Alt V"]
        {
            assert_eq!(does(&keymap, text, Scope::Typing), None, "{text}");
        }
        assert_eq!(does(&keymap, "Ctrl S", Scope::Typing), Some(Action::Save));
        assert_eq!(does(&keymap, "F12", Scope::Typing), Some(Action::Render));
        assert_eq!(does(&keymap, "Esc", Scope::Typing), Some(Action::Cancel));
        assert_eq!(does(&keymap, "Ctrl Enter", Scope::Typing), Some(Action::ReadSource));
    }
}

#[test]
fn a_modal_tool_takes_every_key() {
    for keymap in keymaps() {
        assert_eq!(does(&keymap, "X", Scope::Transform), Some(Action::HoldAxis(Axis::X)));
        assert_eq!(does(&keymap, "Shift Y", Scope::Transform), Some(Action::HoldPlane(Axis::Y)));
        assert_eq!(does(&keymap, "Enter", Scope::Transform), Some(Action::Confirm));
        assert_eq!(does(&keymap, "Esc", Scope::Transform), Some(Action::Cancel));
        assert_eq!(does(&keymap, "Backspace", Scope::Drawing), Some(Action::TakeBack));
        for text in ["1", "Ctrl Z", "Space", "Tab", "G", "NumPad 7"] {
            assert_eq!(does(&keymap, text, Scope::Transform), None, "{text}");
        }
    }
    assert_eq!(
        [Key::Digit(7), Key::NumPad(7), Key::NumPadPoint, Key::Sign('-'), Key::Tab].map(Key::typed),
        [Some('7'), Some('7'), Some('.'), Some('-'), None]
    );
}

#[test]
fn arrows_nudge_only_in_a_focused_lane() {
    assert_eq!(does(&BLENDER, "→", Scope::Lane), Some(Action::NudgeKeysOn));
    assert_eq!(does(&BLENDER, "→", Scope::Animate), Some(Action::StepOn));
    assert_eq!(does(&BLENDER, "Space", Scope::Lane), Some(Action::Play));
    assert_eq!(does(&BLENDER, "I", Scope::Lane), Some(Action::SetKey));
}

#[test]
fn menus_write_keys_as_people_do() {
    for (keymap, action, text) in [
        (&*BLENDER, Action::SaveAs, "Ctrl Shift S"),
        (&*BLENDER, Action::LookThrough, "NumPad 0"),
        (&*MAYA, Action::LookThrough, "Ctrl 0"),
        (&*BLENDER, Action::CameraFromView, "Ctrl Alt NumPad 0"),
        (&*BLENDER, Action::Render, "F12"),
        (&*MAYA, Action::Move, "W"),
        (&*MAYA, Action::FrameSelected, "F"),
        (&*BLENDER, Action::LastFrame, "Shift →"),
        (&*BLENDER, Action::Cancel, "Esc"),
    ] {
        assert_eq!(keymap.shortcut_text(action).as_deref(), Some(text));
    }
    for action in Action::all() {
        assert!(!action.name().is_empty());
        for keymap in keymaps() {
            let text = keymap.shortcut_text(action);
            // The modes have no keys if the digits choose views instead.
            let digit = matches!(action, Action::Arrange | Action::Paint | Action::Animate)
                && keymap.digits == Digits::NumPad;
            // These have no key: they are only in the menu and the command search.
            let rare = matches!(action, Action::SaveCopy | Action::Revert | Action::ExportMovie);
            assert_eq!(text.is_none(), rare || digit, "{action:?} in {keymap:?}");
        }
    }
}

#[test]
fn menus_of_a_mode_show_no_key_that_does_something_else_in_it() {
    for (action, scope, text) in [
        (Action::Delete, Scope::Arrange, Some("X")),
        (Action::Delete, Scope::Paint, Some("Delete")),
        (Action::SetKey, Scope::Animate, Some("I")),
        (Action::SetKey, Scope::Paint, None),
        // A key that does nothing in this mode is still shown, so that users learn it.
        (Action::Touch, Scope::Arrange, Some("U")),
        (Action::Save, Scope::Paint, Some("Ctrl S")),
    ] {
        assert_eq!(BLENDER.shortcut_text_in(action, scope).as_deref(), text, "{action:?} in {scope:?}");
    }
}

#[test]
fn pointer_buttons_orbit_pan_and_zoom() {
    let [ctrl, shift, alt] = ["Ctrl A", "Shift A", "Alt A"].map(|text| chord(text).held);
    let none = Modifiers::default();
    use Navigation::{Orbit, Pan, Zoom};
    for (keymap, button, held, does) in [
        (&*BLENDER, Button::Middle, none, Some(Orbit)),
        (&*BLENDER, Button::Middle, shift, Some(Pan)),
        (&*BLENDER, Button::Middle, ctrl, Some(Zoom)),
        (&*BLENDER, Button::Wheel, none, Some(Zoom)),
        (&*BLENDER, Button::Left, alt, Some(Orbit)),
        (&*BLENDER, Button::Left, none, None),
        (&*BLENDER, Button::Right, alt, None),
        (&*MAYA, Button::Left, alt, Some(Orbit)),
        (&*MAYA, Button::Middle, alt, Some(Pan)),
        (&*MAYA, Button::Right, alt, Some(Zoom)),
        (&*MAYA, Button::Middle, none, None),
        (&*MAYA, Button::Wheel, none, Some(Zoom)),
        // Alt with the wheel scrubs.
        (&*MAYA, Button::Wheel, alt, None),
    ] {
        assert_eq!(keymap.navigation(button, held), does, "{keymap:?} {button:?} {held:?}");
    }
}
