//! Two tools. The turn tool turns a region's directions by a drag, or flips them by a click. Pick copies the direction
//! of a stroke.

use glam::DVec2;

use super::ring::Needle;
use super::{Paintable, Surroundings, ToolEvent, ToolOutput, waiting_words};
use crate::command::{Command, Directions};
use crate::keymap::{Action, Modifiers};
use crate::selection::Item;
use crate::session::{FillKind, Tool, ToolOptions};

/// Degrees of turn for each pixel of a drag; also the step of turns without Ctrl, degrees.
const DEG_PER_PX: f64 = 0.5;
/// The step of turns with Ctrl, degrees.
const STEP_DEG: f64 = 5.0;

#[derive(Clone, Debug, Default)]
pub(super) struct Turn {
    turning: Option<Turning>,
}

#[derive(Clone, Debug)]
struct Turning {
    on: Paintable,
    from_px: DVec2,
    by_deg: f64,
}

impl Turn {
    pub(super) fn is_busy(&self) -> bool {
        self.turning.is_some()
    }

    pub(super) fn take(&mut self, event: &ToolEvent, around: &Surroundings) -> ToolOutput {
        match *event {
            ToolEvent::Hover { at_px, .. } => waiting(at_px, around),
            ToolEvent::Press { at_px, .. } => match around.paintable(around.hit(at_px).as_ref()) {
                Err(refusal) => ToolOutput::refusing(refusal),
                Ok(on) if around.options.flip => ToolOutput {
                    commit: Some(Command::Directions(Directions::Flip(on.target))),
                    ..ToolOutput::default()
                },
                Ok(on) => {
                    self.turning = Some(Turning { on, from_px: at_px, by_deg: 0.0 });
                    self.under_way()
                }
            },
            ToolEvent::Move { at_px, held, .. } => {
                if let Some(turning) = &mut self.turning {
                    turning.follow(at_px, held);
                }
                self.under_way()
            }
            ToolEvent::Release { .. } => {
                let commit = self.turning.take().and_then(|turning| turning.command());
                ToolOutput { commit, ..ToolOutput::default() }
            }
            ToolEvent::Cancel | ToolEvent::FocusLost | ToolEvent::Key(Action::Cancel) => {
                self.turning = None;
                ToolOutput::default()
            }
            ToolEvent::Key(_) => self.under_way(),
        }
    }

    fn under_way(&self) -> ToolOutput {
        let Some(turning) = &self.turning else { return ToolOutput::default() };
        let words =
            format!("Turning {}, {}°   [Ctrl] by 5°  [Esc] take it back", turning.on.name, turning.by_deg);
        ToolOutput { preview: turning.command(), ..ToolOutput::saying(words) }
    }
}

impl Turning {
    fn follow(&mut self, at_px: DVec2, held: Modifiers) {
        let by_deg = (at_px.x - self.from_px.x) * DEG_PER_PX;
        if by_deg.is_finite() {
            let step = if held.ctrl { STEP_DEG } else { DEG_PER_PX };
            self.by_deg = (by_deg / step).round() * step;
        }
    }

    fn command(&self) -> Option<Command> {
        let (region, by_deg) = (self.on.target.clone(), self.by_deg);
        (by_deg != 0.0).then_some(Command::Directions(Directions::Turn { region, by_deg }))
    }
}

fn waiting(at_px: DVec2, around: &Surroundings) -> ToolOutput {
    let hit = around.hit(at_px);
    match around.paintable(hit.as_ref()) {
        Ok(on) => {
            // Lines look alike after a flip: an arrow shows which way strokes run.
            let shown = hit.as_ref().and_then(|hit| around.painted.shown_at(hit));
            let needle = shown.map(|shown| {
                let along = DVec2::from_angle(-shown.angle_rad);
                Needle { at_px, along, headed: true }
            });
            let words = waiting_words(Tool::TurnDirection, around.options, &on.name);
            ToolOutput { needle, ..ToolOutput::saying(words) }
        }
        Err(refusal) if hit.is_some() => ToolOutput { refusal: None, ..ToolOutput::refusing(refusal) },
        Err(_) => ToolOutput::saying(waiting_words(Tool::TurnDirection, around.options, "a region")),
    }
}

/// Pick: a press makes the direction under the pointer the angle of the Fill tool, and selects the region there.
pub(super) fn pick(event: &ToolEvent, around: &Surroundings) -> ToolOutput {
    let ToolEvent::Press { at_px, .. } = *event else {
        return ToolOutput::saying(waiting_words(Tool::Pick, around.options, ""));
    };
    let Some(hit) = around.hit(at_px) else {
        return ToolOutput::refusing(crate::refusal::Refusal::new(
            "Nothing to pick here: click on an object",
        ));
    };
    let region = around.painted.region_at(&hit).and_then(|region| around.scene().regions.get(region));
    let select = region.map(|region| Item::Region(region.name.clone()));
    let Some(shown) = around.painted.shown_at(&hit) else {
        return ToolOutput { select, ..ToolOutput::saying("No stroke shows here") };
    };
    // A fill states its angle in the region's reference view.
    let region = around.painted.region_at(&hit);
    let turned = super::fill::to_reference_rad(&hit, region, around).unwrap_or(0.0);
    let angle_deg = (shown.angle_rad + turned).to_degrees();
    let angle_deg = angle_deg - 180.0 * (angle_deg / 180.0).round();
    let fill_angle_deg = (angle_deg * 10.0).round() / 10.0;
    let options = ToolOptions { fill: FillKind::Angle, fill_angle_deg, ..around.options.clone() };
    let words = format!("Picked {fill_angle_deg}°, trust {:.2}", shown.trust);
    ToolOutput { select, options: Some(options), ..ToolOutput::saying(words) }
}
