//! The keys of both presets. Menus, tooltips, the command search and the list of shortcuts all read this table.

use super::{Action, Axis, Binding, Chord, Key, Modifiers, Scope, Where};

const EVERYWHERE: &[Where] = &[Where::Everywhere];
const POSING: &[Where] = &[Where::In(Scope::Arrange), Where::In(Scope::Animate)];
const PAINT: &[Where] = &[Where::In(Scope::Paint)];
const LANE: &[Where] = &[Where::In(Scope::Lane)];
const TYPING: &[Where] = &[Where::In(Scope::Typing)];
const TRANSFORM: &[Where] = &[Where::In(Scope::Transform)];
const MODAL: &[Where] = &[Where::In(Scope::Transform), Where::In(Scope::Drawing)];
const UNDERWAY: &[Where] =
    &[Where::In(Scope::Transform), Where::In(Scope::Drawing), Where::In(Scope::Typing), Where::Everywhere];

/// With [`super::Digits::NumPad`], these digits of the main row do what Blender's number pad does.
pub(super) const DIGITS_AS_NUMPAD: &[(Action, u8)] = &[
    (Action::ViewFront, 1),
    (Action::ViewRight, 3),
    (Action::ViewTop, 7),
    (Action::ToggleOrthographic, 5),
    (Action::LookThrough, 0),
];

/// A key with modifiers: `c` for Ctrl, `s` for Shift, `a` for Alt.
const fn held(key: Key, held: &[u8]) -> Chord {
    let mut modifiers = Modifiers { ctrl: false, shift: false, alt: false };
    let mut index = 0;
    while index < held.len() {
        match held[index] {
            b'c' => modifiers.ctrl = true,
            b's' => modifiers.shift = true,
            _ => modifiers.alt = true,
        }
        index += 1;
    }
    Chord { key, held: modifiers }
}

const fn plain(key: Key) -> Chord {
    Chord::plain(key)
}

const fn ctrl(key: Key) -> Chord {
    held(key, b"c")
}

const fn shift(key: Key) -> Chord {
    held(key, b"s")
}

const fn alt(key: Key) -> Chord {
    held(key, b"a")
}

const fn ctrl_shift(key: Key) -> Chord {
    held(key, b"cs")
}

const fn ctrl_alt(key: Key) -> Chord {
    held(key, b"ca")
}

/// A binding with the same keys in both presets.
const fn both(
    action: Action,
    name: &'static str,
    holds: &'static [Where],
    keys: &'static [Chord],
) -> Binding {
    Binding { action, name, holds, blender: keys, maya: keys }
}

/// A binding with different keys in each preset.
const fn each(
    action: Action,
    name: &'static str,
    holds: &'static [Where],
    blender: &'static [Chord],
    maya: &'static [Chord],
) -> Binding {
    Binding { action, name, holds, blender, maya }
}

/// All bindings, in the order of the menus. An action that is listed twice has different keys in different scopes.
pub(super) const BINDINGS: &[Binding] = &[
    both(Action::NewScene, "New scene", EVERYWHERE, &[ctrl(Key::Letter('N'))]),
    both(Action::OpenScene, "Open", EVERYWHERE, &[ctrl(Key::Letter('O'))]),
    both(Action::Save, "Save", EVERYWHERE, &[ctrl(Key::Letter('S'))]),
    both(Action::SaveAs, "Save as", EVERYWHERE, &[ctrl_shift(Key::Letter('S'))]),
    both(Action::SaveCopy, "Save a copy", EVERYWHERE, &[]),
    both(Action::Revert, "Read again", EVERYWHERE, &[]),
    both(Action::Quit, "Quit", EVERYWHERE, &[ctrl(Key::Letter('Q'))]),
    both(Action::ImportMesh, "Import a mesh", EVERYWHERE, &[ctrl(Key::Letter('I'))]),
    both(Action::Render, "Render", EVERYWHERE, &[plain(Key::Function(12))]),
    both(Action::ExportMovie, "Export movie", EVERYWHERE, &[]),
    each(
        Action::Undo,
        "Undo",
        EVERYWHERE,
        &[ctrl(Key::Letter('Z'))],
        &[ctrl(Key::Letter('Z')), plain(Key::Letter('Z'))],
    ),
    each(
        Action::Redo,
        "Redo",
        EVERYWHERE,
        &[ctrl_shift(Key::Letter('Z')), ctrl(Key::Letter('Y'))],
        &[ctrl_shift(Key::Letter('Z')), ctrl(Key::Letter('Y')), shift(Key::Letter('Z'))],
    ),
    both(Action::Palette, "Find a command", EVERYWHERE, &[ctrl(Key::Letter('P')), plain(Key::Function(3))]),
    both(Action::Shortcuts, "Shortcuts", EVERYWHERE, &[plain(Key::Function(1))]),
    both(Action::ReadSource, "Read the source again", TYPING, &[ctrl(Key::Enter)]),
    both(Action::NextArea, "Next area", EVERYWHERE, &[plain(Key::Function(6))]),
    both(Action::Arrange, "Arrange", EVERYWHERE, &[plain(Key::Digit(1))]),
    both(Action::Paint, "Paint", EVERYWHERE, &[plain(Key::Digit(2))]),
    both(Action::Animate, "Animate", EVERYWHERE, &[plain(Key::Digit(3))]),
    both(Action::TogglePaint, "Paint and back", EVERYWHERE, &[plain(Key::Tab)]),
    both(Action::NextMode, "Next mode", EVERYWHERE, &[ctrl(Key::Tab)]),
    both(Action::Select, "Select", POSING, &[plain(Key::Letter('Q'))]),
    each(Action::Move, "Move", POSING, &[plain(Key::Letter('G'))], &[plain(Key::Letter('W'))]),
    each(Action::Turn, "Turn", POSING, &[plain(Key::Letter('R'))], &[plain(Key::Letter('E'))]),
    each(Action::Scale, "Scale", POSING, &[plain(Key::Letter('S'))], &[plain(Key::Letter('R'))]),
    both(Action::Comb, "Comb", PAINT, &[plain(Key::Letter('C'))]),
    both(Action::GuideCurve, "Guide curve", PAINT, &[plain(Key::Letter('V'))]),
    both(Action::Fill, "Fill direction", PAINT, &[plain(Key::Letter('D'))]),
    both(Action::TurnDirection, "Turn direction", PAINT, &[plain(Key::Letter('T'))]),
    both(Action::Smooth, "Smooth", PAINT, &[plain(Key::Letter('S'))]),
    both(Action::Erase, "Erase to automatic", PAINT, &[plain(Key::Letter('E'))]),
    both(Action::Region, "Region", PAINT, &[plain(Key::Letter('M'))]),
    both(Action::Amount, "Paint amount", PAINT, &[plain(Key::Letter('P'))]),
    both(Action::Touch, "Touch", PAINT, &[plain(Key::Letter('U'))]),
    both(Action::Pick, "Pick direction", PAINT, &[plain(Key::Letter('I'))]),
    each(Action::SizeRadius, "Brush radius", PAINT, &[plain(Key::Letter('F'))], &[plain(Key::Letter('B'))]),
    each(
        Action::SizeStrength,
        "Brush strength",
        PAINT,
        &[shift(Key::Letter('F'))],
        &[shift(Key::Letter('B'))],
    ),
    both(Action::SmallerRadius, "Smaller brush", PAINT, &[plain(Key::Sign('['))]),
    both(Action::LargerRadius, "Larger brush", PAINT, &[plain(Key::Sign(']'))]),
    both(Action::FlipUnderCursor, "Flip under the cursor", PAINT, &[plain(Key::Letter('X'))]),
    each(Action::SelectAll, "Select all", EVERYWHERE, &[plain(Key::Letter('A'))], &[ctrl(Key::Letter('A'))]),
    both(Action::SelectNone, "Select nothing", EVERYWHERE, &[alt(Key::Letter('A'))]),
    each(
        Action::Delete,
        "Delete",
        POSING,
        &[plain(Key::Letter('X')), plain(Key::Delete)],
        &[plain(Key::Delete)],
    ),
    both(Action::Delete, "Delete", PAINT, &[plain(Key::Delete), plain(Key::Backspace)]),
    each(
        Action::Delete,
        "Delete",
        LANE,
        &[plain(Key::Delete), plain(Key::Letter('X'))],
        &[plain(Key::Delete)],
    ),
    each(Action::Duplicate, "Duplicate", EVERYWHERE, &[shift(Key::Letter('D'))], &[ctrl(Key::Letter('D'))]),
    both(Action::Rename, "Rename", EVERYWHERE, &[plain(Key::Function(2))]),
    both(Action::Add, "Add", EVERYWHERE, &[shift(Key::Letter('A'))]),
    each(Action::Hide, "Hide", EVERYWHERE, &[plain(Key::Letter('H'))], &[ctrl(Key::Letter('H'))]),
    each(Action::ShowAll, "Show all", EVERYWHERE, &[alt(Key::Letter('H'))], &[ctrl_shift(Key::Letter('H'))]),
    both(Action::Lock, "Lock", EVERYWHERE, &[plain(Key::Letter('L'))]),
    each(
        Action::FrameSelected,
        "Frame selected",
        EVERYWHERE,
        &[plain(Key::NumPadPoint)],
        &[plain(Key::Letter('F'))],
    ),
    each(Action::FrameSelected, "Frame selected", POSING, &[plain(Key::Letter('F'))], &[]),
    each(Action::FrameAll, "Frame all", EVERYWHERE, &[plain(Key::Home)], &[plain(Key::Letter('A'))]),
    each(
        Action::ViewFront,
        "View from the front",
        EVERYWHERE,
        &[plain(Key::NumPad(1))],
        &[ctrl(Key::Digit(1))],
    ),
    each(
        Action::ViewRight,
        "View from the right",
        EVERYWHERE,
        &[plain(Key::NumPad(3))],
        &[ctrl(Key::Digit(3))],
    ),
    each(Action::ViewTop, "View from above", EVERYWHERE, &[plain(Key::NumPad(7))], &[ctrl(Key::Digit(7))]),
    each(
        Action::ToggleOrthographic,
        "Parallel view",
        EVERYWHERE,
        &[plain(Key::NumPad(5))],
        &[ctrl(Key::Digit(5))],
    ),
    each(
        Action::LookThrough,
        "Look through the shot camera",
        EVERYWHERE,
        &[plain(Key::NumPad(0))],
        &[ctrl(Key::Digit(0))],
    ),
    both(Action::CameraFromView, "Camera to this view", EVERYWHERE, &[ctrl_alt(Key::NumPad(0))]),
    both(Action::Compare, "Compare with the reference", EVERYWHERE, &[plain(Key::Letter('K'))]),
    both(Action::CycleDirections, "Directions", EVERYWHERE, &[plain(Key::Letter('O'))]),
    both(Action::ToggleTrust, "Trust", EVERYWHERE, &[shift(Key::Letter('O'))]),
    both(Action::ToggleColumn, "Right column", EVERYWHERE, &[plain(Key::Letter('N'))]),
    both(Action::MaximiseViewport, "Only the viewport", EVERYWHERE, &[ctrl(Key::Space)]),
    each(Action::SetKey, "Set key", POSING, &[plain(Key::Letter('I'))], &[plain(Key::Letter('S'))]),
    both(Action::Curves, "Curves", POSING, &[plain(Key::Letter('C'))]),
    each(Action::Play, "Play", EVERYWHERE, &[plain(Key::Space)], &[alt(Key::Letter('V')), plain(Key::Space)]),
    both(Action::StepBack, "Previous frame", EVERYWHERE, &[plain(Key::Left)]),
    both(Action::StepOn, "Next frame", EVERYWHERE, &[plain(Key::Right)]),
    each(Action::PreviousKey, "Previous key", EVERYWHERE, &[plain(Key::Down)], &[plain(Key::Sign(','))]),
    each(Action::NextKey, "Next key", EVERYWHERE, &[plain(Key::Up)], &[plain(Key::Sign('.'))]),
    both(Action::FirstFrame, "First frame", EVERYWHERE, &[shift(Key::Left)]),
    both(Action::LastFrame, "Last frame", EVERYWHERE, &[shift(Key::Right)]),
    both(Action::NudgeKeysBack, "Move keys one frame back", LANE, &[plain(Key::Left)]),
    both(Action::NudgeKeysOn, "Move keys one frame on", LANE, &[plain(Key::Right)]),
    both(Action::HoldAxis(Axis::X), "Along X", TRANSFORM, &[plain(Key::Letter('X'))]),
    both(Action::HoldAxis(Axis::Y), "Along Y", TRANSFORM, &[plain(Key::Letter('Y'))]),
    both(Action::HoldAxis(Axis::Z), "Along Z", TRANSFORM, &[plain(Key::Letter('Z'))]),
    both(Action::HoldPlane(Axis::X), "Across X", TRANSFORM, &[shift(Key::Letter('X'))]),
    both(Action::HoldPlane(Axis::Y), "Across Y", TRANSFORM, &[shift(Key::Letter('Y'))]),
    both(Action::HoldPlane(Axis::Z), "Across Z", TRANSFORM, &[shift(Key::Letter('Z'))]),
    both(Action::Confirm, "Keep", MODAL, &[plain(Key::Enter)]),
    both(Action::Cancel, "Cancel", UNDERWAY, &[plain(Key::Escape)]),
    both(Action::TakeBack, "Take back", MODAL, &[plain(Key::Backspace)]),
];
