//! The keymap: what each key does, in two presets (Blender's keys and Maya's). `Editor::key` decides which scope is
//! active. A modal tool takes every key. In the other scopes, a key that the scope does not bind falls back to the
//! bindings that hold everywhere. Text fields keep the keys that they use themselves.

mod hints;
mod own;
mod table;
#[cfg(test)]
mod tests;
mod text;

use crate::transform::Axis;

use table::{BINDINGS, DIGITS_AS_NUMPAD};

pub use own::{CommandId, CommandKeys, OwnKeys};
pub use text::NoChord;

/// An action that has a key, or could have one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Action {
    /// Begins an empty scene.
    NewScene,
    /// Opens a scene or a mesh file.
    OpenScene,
    /// Writes the scene to its file.
    Save,
    /// Asks for a file and saves there; it becomes the document's file.
    SaveAs,
    /// Asks for a file and saves there; the document keeps its own file.
    SaveCopy,
    /// Reads the scene's file again.
    Revert,
    /// Closes the window; unsaved work is asked about first.
    Quit,
    /// Adds a mesh to the scene.
    ImportMesh,
    /// Opens the dialog that renders frames.
    Render,
    /// Opens the dialog that renders frames, with a movie chosen as the kind of file.
    ExportMovie,
    /// Undoes the last entry of the history.
    Undo,
    /// Redoes the entry that was undone last.
    Redo,
    /// Searches all commands.
    Palette,
    /// Lists all keys.
    Shortcuts,
    /// Reads the scene from the text that was edited in the panel of problems.
    ReadSource,
    /// Gives the keyboard focus to the next area of the window.
    NextArea,
    /// Switches to this mode.
    Arrange,
    /// Switches to this mode.
    Paint,
    /// Switches to this mode.
    Animate,
    /// Switches to Paint, or from it back to the mode before.
    TogglePaint,
    /// Switches to the next mode.
    NextMode,
    /// Takes this tool of Arrange and Animate.
    Select,
    /// Moves what is selected, or takes the tool for it.
    Move,
    /// Turns what is selected, or takes the tool for it.
    Turn,
    /// Scales what is selected, or takes the tool for it.
    Scale,
    /// Takes this tool of Paint.
    Comb,
    /// Takes this tool of Paint.
    GuideCurve,
    /// Takes this tool of Paint.
    Fill,
    /// Takes this tool of Paint.
    TurnDirection,
    /// Takes this tool of Paint.
    Smooth,
    /// Takes this tool of Paint.
    Erase,
    /// Takes this tool of Paint.
    Region,
    /// Takes this tool of Paint.
    Amount,
    /// Takes this tool of Paint.
    Touch,
    /// Takes this tool of Paint.
    Pick,
    /// The radius follows the pointer until a press.
    SizeRadius,
    /// The strength follows the pointer until a press.
    SizeStrength,
    /// Makes the brush smaller.
    SmallerRadius,
    /// Makes the brush larger.
    LargerRadius,
    /// Flips the directions of the region under the cursor.
    FlipUnderCursor,
    /// Selects all objects; on a lane, all keys.
    SelectAll,
    /// Selects nothing.
    SelectNone,
    /// Deletes what is selected.
    Delete,
    /// Adds a copy of what is selected.
    Duplicate,
    /// Lets the user type a new name for what is selected.
    Rename,
    /// Opens the menu of things to add.
    Add,
    /// Hides what is selected, or shows it again.
    Hide,
    /// Shows everything.
    ShowAll,
    /// Locks what is selected, or unlocks it.
    Lock,
    /// Moves the view so that the selected objects, and those of selected regions, fill it.
    FrameSelected,
    /// Moves the view so that all objects fill it, except those that are hidden or have a built-in mesh.
    FrameAll,
    /// Looks from +Z.
    ViewFront,
    /// Looks from +X.
    ViewRight,
    /// Looks from +Y.
    ViewTop,
    /// Switches between a parallel view and a perspective one.
    ToggleOrthographic,
    /// Looks through the shot camera.
    LookThrough,
    /// Gives this view to the shot camera.
    CameraFromView,
    /// Compares with the reference.
    Compare,
    /// Switches the direction lines: off, plain, by region.
    CycleDirections,
    /// Shows or hides the trust overlay.
    ToggleTrust,
    /// Shows or hides the right column.
    ToggleColumn,
    /// Shows only the viewport, or everything again.
    MaximiseViewport,
    /// Sets keys for what is selected and for all loose poses.
    SetKey,
    /// Shows the curves between keys in the place of lanes, or the lanes again.
    Curves,
    /// Plays or stops.
    Play,
    /// Goes one frame back.
    StepBack,
    /// Goes one frame on.
    StepOn,
    /// Goes to the key before this frame.
    PreviousKey,
    /// Goes to the key after this frame.
    NextKey,
    /// Goes to the first frame.
    FirstFrame,
    /// Goes to the last frame.
    LastFrame,
    /// Moves the selected keys one frame back.
    NudgeKeysBack,
    /// Moves the selected keys one frame on.
    NudgeKeysOn,
    /// Constrains a transform to an axis.
    HoldAxis(Axis),
    /// Constrains a transform to the plane perpendicular to an axis.
    HoldPlane(Axis),
    /// Ends a modal tool and keeps what it did.
    Confirm,
    /// Ends a modal tool and undoes what it did.
    Cancel,
    /// Removes the last typed character, or the last point of a curve.
    TakeBack,
}

/// A key of the keyboard, by what is printed on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Key {
    /// `'A'..='Z'`.
    Letter(char),
    /// 0..=9 of the main row.
    Digit(u8),
    /// 0..=9 of the number pad.
    NumPad(u8),
    /// The number pad's point.
    NumPadPoint,
    /// F1..F35.
    Function(u8),
    /// `[ ] , . -`.
    Sign(char),
    /// The space bar.
    Space,
    /// Tabulator.
    Tab,
    /// Either Enter.
    Enter,
    /// Esc.
    Escape,
    /// Backspace.
    Backspace,
    /// Delete.
    Delete,
    /// Home.
    Home,
    /// Arrow to the left.
    Left,
    /// Arrow to the right.
    Right,
    /// Arrow upwards.
    Up,
    /// Arrow downwards.
    Down,
}

/// The keys that are held with another.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Modifiers {
    /// Ctrl.
    pub ctrl: bool,
    /// Shift.
    pub shift: bool,
    /// Alt.
    pub alt: bool,
}

/// A key with the modifiers that are held with it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Chord {
    /// The key.
    pub key: Key,
    /// What is held.
    pub held: Modifiers,
}

/// The program whose keys are followed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Preset {
    /// Blender's.
    #[default]
    Blender,
    /// Maya's.
    Maya,
}

/// What the digits of the main row do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Digits {
    /// 1 2 3 are modes.
    #[default]
    Modes,
    /// 1 3 7 5 0 are views, as on a number pad.
    NumPad,
}

/// The keys as the user set them.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Keymap {
    /// The preset: Blender's keys or Maya's.
    pub preset: Preset,
    /// What digits do.
    pub digits: Digits,
    /// Keys that the user chose in place of the preset's.
    pub own: OwnKeys,
}

/// The scopes of bindings. One scope is active at a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Scope {
    /// A modal move, turn or scale.
    Transform,
    /// A gesture or a curve under way.
    Drawing,
    /// A text field has the focus: letters are text.
    Typing,
    /// A lane of the timeline is focused and a key in it selected.
    Lane,
    /// In this mode, and none of the above.
    Arrange,
    /// In this mode, and none of the above.
    Paint,
    /// In this mode, and none of the above.
    Animate,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Where {
    Everywhere,
    In(Scope),
}

struct Binding {
    action: Action,
    name: &'static str,
    /// The scopes in which it applies.
    holds: &'static [Where],
    blender: &'static [Chord],
    maya: &'static [Chord],
}

impl Keymap {
    /// The action of a key; `None` if the key is text or has no meaning.
    pub fn action_for(&self, key: Key, held: Modifiers, scope: Scope) -> Option<Action> {
        let chord = Chord { key, held };
        let bound = |place: Where| {
            self.bindings()
                .find(|(binding, chords)| binding.holds.contains(&place) && chords.contains(&chord))
                .map(|(binding, _)| binding.action)
        };
        match scope {
            Scope::Transform | Scope::Drawing => bound(Where::In(scope)),
            Scope::Typing => bound(Where::In(scope)).or_else(|| {
                let not_text = matches!(key, Key::Function(_)) || held.ctrl;
                // Text fields handle these themselves.
                let own =
                    matches!(key, Key::Letter('A' | 'C' | 'V' | 'X' | 'Y' | 'Z') | Key::Left | Key::Right);
                (not_text && !own).then(|| bound(Where::Everywhere)).flatten()
            }),
            Scope::Lane => bound(Where::In(scope))
                .or_else(|| bound(Where::In(Scope::Animate)))
                .or_else(|| bound(Where::Everywhere)),
            Scope::Arrange | Scope::Paint | Scope::Animate => {
                bound(Where::In(scope)).or_else(|| bound(Where::Everywhere))
            }
        }
    }

    /// The first key of an action, as menus and tooltips write it; `None` if it has none.
    pub fn shortcut_text(&self, action: Action) -> Option<String> {
        let mut bindings = self.bindings();
        let (_, chords) =
            bindings.find(|(binding, chords)| binding.action == action && !chords.is_empty())?;
        chords.first().map(Chord::text)
    }

    /// The key of an action, as words that are shown in `scope` name it: the first key that triggers the action there,
    /// else the first that triggers nothing there. `None` if all keys of the action trigger something else there, or if
    /// it has no key.
    pub fn shortcut_text_in(&self, action: Action, scope: Scope) -> Option<String> {
        let chords = self.bindings().filter(|(binding, _)| binding.action == action);
        let chords: Vec<Chord> = chords.flat_map(|(_, chords)| chords.to_vec()).collect();
        let does = |chord: &Chord| self.action_for(chord.key, chord.held, scope);
        let here = chords.iter().find(|chord| does(chord) == Some(action));
        here.or_else(|| chords.iter().find(|chord| does(chord).is_none())).map(Chord::text)
    }

    /// Every binding that has keys, for a list of keys, in the order of the menus.
    pub fn listed(&self) -> impl Iterator<Item = Listed> {
        self.bindings().filter(|(_, chords)| !chords.is_empty()).map(|(binding, chords)| {
            let keys: Vec<String> = chords.iter().map(Chord::text).collect();
            let scope = match binding.holds.first() {
                Some(Where::In(scope)) => Some(*scope),
                _ => None,
            };
            let everywhere = binding.holds.contains(&Where::Everywhere);
            let scope = scope.filter(|_| !everywhere);
            Listed { action: binding.action, scope, keys: keys.join(", ") }
        })
    }

    /// What a button or the wheel of the pointer does to the view. `None` if it does nothing to the view: the event is
    /// then free for other uses, such as a drag of the tool.
    pub fn navigation(&self, button: Button, held: Modifiers) -> Option<Navigation> {
        let Modifiers { ctrl, shift, alt } = held;
        match (self.preset, button) {
            (_, Button::Wheel) if !alt => Some(Navigation::Zoom),
            (_, Button::Left) if alt => Some(Navigation::Orbit),
            (Preset::Blender, Button::Middle) if ctrl => Some(Navigation::Zoom),
            (Preset::Blender, Button::Middle) if shift => Some(Navigation::Pan),
            (Preset::Blender, Button::Middle) => Some(Navigation::Orbit),
            (Preset::Maya, Button::Middle) if alt => Some(Navigation::Pan),
            (Preset::Maya, Button::Right) if alt => Some(Navigation::Zoom),
            _ => None,
        }
    }

    /// Every binding with its keys. These are the keys that the user chose for it, or else the preset's keys, except
    /// those that the user gave to another binding.
    fn bindings(&self) -> impl Iterator<Item = (&'static Binding, Vec<Chord>)> {
        BINDINGS.iter().enumerate().map(|(index, binding)| {
            let chords = match self.own.of(index) {
                Some(own) => own.to_vec(),
                None => {
                    let mut chords = self.preset_chords(binding);
                    chords.retain(|chord| !self.own.takes(index, *chord));
                    chords
                }
            };
            (binding, chords)
        })
    }

    /// The keys of a binding in the preset, without changes by the user.
    fn preset_chords(&self, binding: &Binding) -> Vec<Chord> {
        let own = match self.preset {
            Preset::Blender => binding.blender,
            Preset::Maya => binding.maya,
        };
        let mut chords = own.to_vec();
        if self.digits == Digits::NumPad {
            chords
                .retain(|chord| !(matches!(chord.key, Key::Digit(_)) && chord.held == Modifiers::default()));
            let digit = DIGITS_AS_NUMPAD.iter().find(|(action, _)| *action == binding.action);
            chords.extend(digit.map(|&(_, digit)| Chord::plain(Key::Digit(digit))));
        }
        chords
    }
}

/// One line of a list of keys.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Listed {
    /// What the keys do.
    pub action: Action,
    /// The first scope in which they do it; `None` for everywhere.
    pub scope: Option<Scope>,
    /// The keys: *Ctrl Z, Z*.
    pub keys: String,
}

/// A button of the pointer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Button {
    /// The main button.
    Left,
    /// The wheel's own button.
    Middle,
    /// The secondary button.
    Right,
    /// Turns of the wheel.
    Wheel,
}

/// What a drag or the wheel does to the view.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Navigation {
    /// Moves the camera round a point.
    Orbit,
    /// Moves the camera parallel to the picture.
    Pan,
    /// Moves the camera nearer or farther.
    Zoom,
}

impl Action {
    /// Every action, in the order of the menus.
    pub fn all() -> impl Iterator<Item = Self> {
        BINDINGS.iter().map(|binding| binding.action)
    }

    /// Its name, as menus and the command search show it.
    pub fn name(self) -> &'static str {
        BINDINGS.iter().find(|binding| binding.action == self).map_or("", |binding| binding.name)
    }
}

impl Key {
    /// The character that the key types into a number.
    pub fn typed(self) -> Option<char> {
        match self {
            Self::Digit(digit) | Self::NumPad(digit) => char::from_digit(u32::from(digit), 10),
            Self::NumPadPoint | Self::Sign('.' | ',') => Some('.'),
            Self::Sign('-') => Some('-'),
            _ => None,
        }
    }
}

impl Chord {
    const fn plain(key: Key) -> Self {
        Self { key, held: Modifiers { ctrl: false, shift: false, alt: false } }
    }
}
