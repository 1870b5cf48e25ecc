//! From egui's events to plain ones: in order, no press lost, moves between two presses only as many as the hand made.

use egui::{Event, MouseWheelUnit, PointerButton, Ui};
use glam::DVec2;
use impasto_editor_model::keymap::{Button, Modifiers};

use super::framing::Framing;

/// What the pointer did over the viewport. Places in points from its upper left corner, Y down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointerEvent {
    /// What.
    pub kind: PointerKind,
    /// Where; while a button is held, perhaps outside.
    pub at_px: DVec2,
    /// With what held.
    pub held: Modifiers,
    /// Seconds of the window's clock.
    pub at_secs: f64,
}

/// What the pointer did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PointerKind {
    /// It moved.
    Moved,
    /// A button went down over the viewport.
    Pressed(Button),
    /// A button that went down over the viewport went up.
    Released(Button),
    /// The wheel, in steps; away from the hand is positive.
    Wheel(f64),
    /// Two fingers spread (above 1) or closed.
    Pinch(f64),
    /// It left the viewport, no button held.
    Left,
    /// It was pressed twice at one place. Comes after the second press.
    DoublePressed,
}

/// What is kept from one pass to the next.
#[derive(Clone, Debug, Default)]
pub(super) struct Held {
    buttons: Vec<Button>,
    last_px: DVec2,
    inside: bool,
}

impl Held {
    /// The events of this pass. `over` says whether a place of the window is on the picture and not on what floats over it.
    pub(super) fn events(
        &mut self,
        ui: &Ui,
        framing: &Framing,
        over: impl Fn(egui::Pos2) -> bool,
    ) -> Vec<PointerEvent> {
        let (raw, at_secs, double) = ui.input(|input| {
            let double = input.pointer.button_double_clicked(PointerButton::Primary);
            (input.raw.events.clone(), input.time, double)
        });
        let mut held = ui.input(|input| plain(input.modifiers));
        let mut events = Vec::new();
        for event in raw {
            let mut push = |kind, at_px, held| events.push(PointerEvent { kind, at_px, held, at_secs });
            match event {
                Event::PointerMoved(at) => {
                    let inside = over(at);
                    self.last_px = framing.from_window(at);
                    if inside || !self.buttons.is_empty() {
                        push(PointerKind::Moved, self.last_px, held);
                    } else if self.inside {
                        push(PointerKind::Left, self.last_px, held);
                    }
                    self.inside = inside;
                }
                Event::PointerButton { pos, button, pressed, modifiers } => {
                    held = plain(modifiers);
                    self.last_px = framing.from_window(pos);
                    let Some(button) = plain_button(button) else { continue };
                    if pressed && over(pos) {
                        self.inside = true;
                        if !self.buttons.contains(&button) {
                            self.buttons.push(button);
                        }
                        push(PointerKind::Pressed(button), self.last_px, held);
                    } else if !pressed && self.buttons.contains(&button) {
                        self.buttons.retain(|held| *held != button);
                        push(PointerKind::Released(button), self.last_px, held);
                    }
                }
                Event::PointerGone => {
                    if self.inside && self.buttons.is_empty() {
                        push(PointerKind::Left, self.last_px, held);
                    }
                    self.inside = false;
                }
                Event::MouseWheel { unit, delta, modifiers, .. } if self.inside => {
                    // Some systems turn the wheel sideways while Shift is held.
                    let turned = if delta.y == 0.0 { delta.x } else { delta.y };
                    let steps = f64::from(turned)
                        * match unit {
                            MouseWheelUnit::Point => 1.0 / 50.0,
                            MouseWheelUnit::Line => 1.0,
                            MouseWheelUnit::Page => 10.0,
                        };
                    push(PointerKind::Wheel(steps), self.last_px, plain(modifiers));
                }
                Event::Zoom(factor) if self.inside => {
                    push(PointerKind::Pinch(f64::from(factor)), self.last_px, held)
                }
                Event::WindowFocused(false) => {
                    for button in std::mem::take(&mut self.buttons) {
                        push(PointerKind::Released(button), self.last_px, held);
                    }
                }
                _ => {}
            }
        }
        if double && self.inside {
            events.push(PointerEvent {
                kind: PointerKind::DoublePressed,
                at_px: self.last_px,
                held,
                at_secs,
            });
        }
        events
    }

    /// Whether a drag that began here goes on.
    pub(super) fn is_dragging(&self) -> bool {
        !self.buttons.is_empty()
    }

    /// Whether the pointer is on the picture.
    pub(super) fn is_inside(&self) -> bool {
        self.inside
    }
}

fn plain(held: egui::Modifiers) -> Modifiers {
    Modifiers { ctrl: held.command || held.ctrl, shift: held.shift, alt: held.alt }
}

fn plain_button(button: PointerButton) -> Option<Button> {
    match button {
        PointerButton::Primary => Some(Button::Left),
        PointerButton::Middle => Some(Button::Middle),
        PointerButton::Secondary => Some(Button::Right),
        PointerButton::Extra1 | PointerButton::Extra2 => None,
    }
}
