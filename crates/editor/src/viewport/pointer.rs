//! Translates egui's pointer events into the editor's, in the same order. The editor's coordinates are in points from
//! the viewport's upper left corner, Y down.

use egui::{Event, MouseWheelUnit, PointerButton, Ui};
use glam::DVec2;
use impasto_editor_model::camera_rig::ZOOM_PER_STEP;
use impasto_editor_model::editor::{PointerEvent, PointerKind};
use impasto_editor_model::keymap::{Button, Modifiers};

use super::framing::Framing;
use crate::widgets::press_closes_menu;
use crate::window::pressures;

/// What is known of the pointer, kept from one pass to the next.
#[derive(Clone, Debug, Default)]
pub(super) struct Pointer {
    buttons: Vec<Button>,
    last_px: DVec2,
    inside: bool,
}

impl Pointer {
    /// The events of this pass. `over` says whether a place in the window is on the picture itself. A chip or a sheet
    /// that covers the picture does not count.
    pub(super) fn events(
        &mut self,
        ui: &Ui,
        framing: &Framing,
        over: impl Fn(egui::Pos2) -> bool,
    ) -> Vec<PointerEvent> {
        let (raw, at_secs) = ui.input(|input| (input.raw.events.clone(), input.time));
        let mut held = ui.input(|input| plain(input.modifiers));
        let closes_menu = press_closes_menu(ui.ctx());
        let mut pressures = pressures(ui.ctx()).into_iter();
        let mut events = Vec::new();
        for event in raw {
            let pressure = match event {
                Event::PointerMoved(_) | Event::PointerButton { .. } => pressures.next().unwrap_or(1.0),
                _ => 1.0,
            };
            let mut push =
                |kind, at_px, held| events.push(PointerEvent { kind, at_px, held, at_secs, pressure });
            match event {
                Event::PointerMoved(at) => {
                    let inside = over(at);
                    self.last_px = framing.from_window(at);
                    if inside || !self.buttons.is_empty() {
                        push(PointerKind::Move, self.last_px, held);
                    } else if self.inside {
                        push(PointerKind::Leave, self.last_px, held);
                    }
                    self.inside = inside;
                }
                Event::PointerButton { pos, button, pressed, modifiers } => {
                    held = plain(modifiers);
                    self.last_px = framing.from_window(pos);
                    let Some(button) = plain_button(button) else { continue };
                    // A press that closes a menu does nothing else. Only a press of the right button goes on: it opens
                    // another menu.
                    if pressed && closes_menu && button != Button::Right {
                        continue;
                    }
                    if pressed && over(pos) {
                        self.inside = true;
                        if !self.buttons.contains(&button) {
                            self.buttons.push(button);
                        }
                        push(PointerKind::Press(button), self.last_px, held);
                    } else if !pressed && self.buttons.contains(&button) {
                        self.buttons.retain(|other| *other != button);
                        push(PointerKind::Release(button), self.last_px, held);
                        // A drag that leaves the picture sends no `Leave` until its last button is released.
                        self.inside = over(pos);
                        if !self.inside && self.buttons.is_empty() {
                            push(PointerKind::Leave, self.last_px, held);
                        }
                    }
                }
                Event::PointerGone => {
                    if self.inside && self.buttons.is_empty() {
                        push(PointerKind::Leave, self.last_px, held);
                    }
                    self.inside = false;
                }
                // With Alt the wheel steps through frames, which is done elsewhere. `held` is asked because on some
                // systems the modifiers of wheel events lack Alt.
                Event::MouseWheel { unit, delta, modifiers, .. } if self.inside && !held.alt => {
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
                    // The view zooms by the factor by which two fingers spread. So what lies between the fingers stays
                    // between them.
                    let steps = -f64::from(factor).ln() / ZOOM_PER_STEP.ln();
                    push(PointerKind::Wheel(steps), self.last_px, held);
                }
                Event::WindowFocused(false) => {
                    for button in std::mem::take(&mut self.buttons) {
                        push(PointerKind::Release(button), self.last_px, held);
                    }
                }
                _ => {}
            }
        }
        events
    }

    /// Whether a drag that began on the picture goes on.
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
