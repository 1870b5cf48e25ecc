//! Resizing the brush by F and Shift F: its radius or strength follows the pointer until a press.

use glam::DVec2;

use super::ring::Ring;
use super::{Surroundings, ToolEvent, ToolOutput};
use crate::keymap::Action;
use crate::session::ToolOptions;

/// Radii that a brush may have, pixels of the viewport.
const RADII_PX: std::ops::RangeInclusive<f64> = 2.0..=500.0;
/// `[` and `]` change the radius by this factor.
const RADIUS_STEP: f64 = 1.1;
/// How far the pointer moves for the full range of the strength, pixels.
const STRENGTH_PX: f64 = 200.0;

#[derive(Clone, Debug)]
pub(super) struct Sizing {
    what: What,
    from: ToolOptions,
    value: ToolOptions,
    from_px: Option<DVec2>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum What {
    Radius,
    Strength,
}

impl Sizing {
    /// Begins a resizing for the action of F or Shift F; `None` for any other action.
    pub(super) fn begin(action: Action, options: &ToolOptions, at_px: Option<DVec2>) -> Option<Self> {
        let what = match action {
            Action::SizeRadius => What::Radius,
            Action::SizeStrength => What::Strength,
            _ => return None,
        };
        Some(Self { what, from: options.clone(), value: options.clone(), from_px: at_px })
    }

    /// Also returns whether the resizing goes on.
    pub(super) fn take(&mut self, event: &ToolEvent, around: &Surroundings) -> (ToolOutput, bool) {
        let goes_on = match *event {
            ToolEvent::Hover { at_px, .. } | ToolEvent::Move { at_px, .. } => {
                let from_px = *self.from_px.get_or_insert(at_px);
                let by_px = at_px.x - from_px.x;
                if by_px.is_finite() {
                    match self.what {
                        What::Radius => self.value.radius_px = radius(self.from.radius_px + by_px),
                        What::Strength => {
                            self.value.strength = (self.from.strength + by_px / STRENGTH_PX).clamp(0.0, 1.0);
                        }
                    }
                }
                true
            }
            ToolEvent::Press { .. } | ToolEvent::Key(Action::Confirm) => false,
            ToolEvent::Cancel | ToolEvent::FocusLost | ToolEvent::Key(Action::Cancel) => {
                self.value = self.from.clone();
                false
            }
            ToolEvent::Release { .. } | ToolEvent::Key(_) => true,
        };
        let words = match self.what {
            What::Radius => format!("Radius {:.0} px", self.value.radius_px),
            What::Strength => format!("Strength {:.0} %", self.value.strength * 100.0),
        };
        let status = format!("{words}   [Click] keep  [Esc] back");
        let around = Surroundings { options: &self.value, ..*around };
        let rings = self.from_px.map_or_else(Vec::new, |at_px| Ring::all_at(at_px, &around));
        (ToolOutput { rings, options: Some(self.value.clone()), ..ToolOutput::saying(status) }, goes_on)
    }
}

/// The options after the action of `[` or `]`; `None` for any other action.
pub(super) fn stepped(action: Action, options: &ToolOptions) -> Option<ToolOptions> {
    let factor = match action {
        Action::SmallerRadius => 1.0 / RADIUS_STEP,
        Action::LargerRadius => RADIUS_STEP,
        _ => return None,
    };
    Some(ToolOptions { radius_px: radius(options.radius_px * factor), ..options.clone() })
}

fn radius(radius_px: f64) -> f64 {
    radius_px.clamp(*RADII_PX.start(), *RADII_PX.end())
}
