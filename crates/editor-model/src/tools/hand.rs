//! Passes events to the active tool of the mode Paint, and to the resizing of its brush by F and Shift F.

use glam::DVec2;

use super::brush::Brush;
use super::curve::Curve;
use super::fill::Fill;
use super::sizing::{self, Sizing};
use super::touch::TouchTool;
use super::turn::{self, Turn};
use super::{Surroundings, ToolEvent, ToolOutput, region};
use crate::command::{Command, Directions};
use crate::keymap::Action;
use crate::session::{RegionBy, Tool, ToolOptions};

/// The largest radius of a touch, pixels of the viewport.
const MOST_TOUCH_PX: f64 = 100.0;

/// The active tool of Paint and its state.
#[derive(Clone, Debug, Default)]
pub struct Hand {
    tool: Option<Tool>,
    held: ToolState,
    sizing: Option<Sizing>,
    /// True between the press that ends a resizing and the release of the button: this press begins no gesture.
    ignores_release: bool,
    at_px: Option<DVec2>,
}

#[derive(Clone, Debug, Default)]
enum ToolState {
    #[default]
    Nothing,
    Brush(Brush),
    Curve(Curve),
    Fill(Fill),
    Turn(Turn),
    Touch(TouchTool),
}

impl Hand {
    /// Whether a gesture is under way: keys go to it first, and Esc ends it.
    pub fn is_busy(&self) -> bool {
        let held = match &self.held {
            ToolState::Nothing => false,
            ToolState::Brush(brush) => brush.is_busy(),
            ToolState::Curve(curve) => curve.is_busy(),
            ToolState::Fill(fill) => fill.is_busy(),
            ToolState::Turn(turn) => turn.is_busy(),
            ToolState::Touch(touch) => touch.is_busy(),
        };
        held || self.sizing.is_some()
    }

    /// Handles an event for a tool of Paint. If the tool has changed, the gesture of the previous tool is cancelled.
    pub fn take(&mut self, tool: Tool, event: &ToolEvent, around: &Surroundings) -> ToolOutput {
        if tool != Tool::Touch {
            return self.take_as(tool, event, around);
        }
        // A touch is much narrower than a brush, so it has a radius of its own. The same keys change it.
        let radius_px = around.options.radius_px;
        let options = ToolOptions { radius_px: around.options.touch_radius_px, ..around.options.clone() };
        let mut output = self.take_as(tool, event, &Surroundings { options: &options, ..*around });
        if let Some(options) = &mut output.options {
            options.touch_radius_px = options.radius_px.min(MOST_TOUCH_PX);
            options.radius_px = radius_px;
        }
        output
    }

    fn take_as(&mut self, tool: Tool, event: &ToolEvent, around: &Surroundings) -> ToolOutput {
        if self.tool != Some(tool) {
            let at_px = self.at_px;
            *self = Self { tool: Some(tool), held: ToolState::of(tool), at_px, ..Self::default() };
        }
        if let ToolEvent::Hover { at_px, .. }
        | ToolEvent::Press { at_px, .. }
        | ToolEvent::Move { at_px, .. } = *event
        {
            self.at_px = Some(at_px);
        }
        if let Some(sizing) = &mut self.sizing {
            let (output, goes_on) = sizing.take(event, around);
            if !goes_on {
                self.sizing = None;
                self.ignores_release = matches!(event, ToolEvent::Press { .. });
            }
            return output;
        }
        if self.ignores_release {
            match event {
                ToolEvent::Release { .. } => {
                    self.ignores_release = false;
                    return ToolOutput::default();
                }
                ToolEvent::Move { .. } => return ToolOutput::default(),
                _ => self.ignores_release = false,
            }
        }
        if let ToolEvent::Key(action) = *event
            && !self.is_busy()
            && let Some(output) = self.key(action, around)
        {
            return output;
        }
        match &mut self.held {
            ToolState::Brush(_) if tool == Tool::Region && around.options.region_by != RegionBy::Brush => {
                region::take(event, around)
            }
            ToolState::Brush(brush) => brush.take(tool, event, around),
            ToolState::Curve(curve) => curve.take(event, around),
            ToolState::Fill(fill) => fill.take(event, around),
            ToolState::Turn(turn) => turn.take(event, around),
            ToolState::Touch(touch) => touch.take(event, around),
            ToolState::Nothing if tool == Tool::Pick => turn::pick(event, around),
            ToolState::Nothing => ToolOutput::default(),
        }
    }

    /// Keys that every tool of Paint has.
    fn key(&mut self, action: Action, around: &Surroundings) -> Option<ToolOutput> {
        if let Some(options) = sizing::stepped(action, around.options) {
            let words = format!("Radius {:.0} px", options.radius_px);
            return Some(ToolOutput { options: Some(options), ..ToolOutput::saying(words) });
        }
        if let Some(mut sizing) = Sizing::begin(action, around.options, self.at_px) {
            let (output, _) = sizing.take(&ToolEvent::Key(action), around);
            self.sizing = Some(sizing);
            return Some(output);
        }
        if action == Action::FlipUnderCursor {
            let hit = self.at_px.and_then(|at_px| around.hit(at_px));
            return Some(match around.paintable(hit.as_ref()) {
                Ok(on) => ToolOutput {
                    commit: Some(Command::Directions(Directions::Flip(on.target))),
                    ..ToolOutput::default()
                },
                Err(refusal) => ToolOutput::refusing(refusal),
            });
        }
        None
    }
}

impl ToolState {
    fn of(tool: Tool) -> Self {
        match tool {
            Tool::Comb | Tool::Smooth | Tool::Erase | Tool::Region | Tool::Amount => {
                Self::Brush(Brush::default())
            }
            Tool::GuideCurve => Self::Curve(Curve::default()),
            Tool::Fill => Self::Fill(Fill::default()),
            Tool::TurnDirection => Self::Turn(Turn::default()),
            Tool::Touch => Self::Touch(TouchTool::default()),
            _ => Self::Nothing,
        }
    }
}
