//! The icon, name, key and tooltip of each tool.

use impasto_editor_model::keymap::Action;
use impasto_editor_model::session::Tool;

use crate::icons::{self, Icon};

/// How a tool is shown.
pub(super) struct ToolFace {
    pub(super) name: &'static str,
    pub(super) icon: Icon,
    /// The action whose key selects it.
    pub(super) action: Option<Action>,
    /// One sentence on what it does.
    pub(super) effect: &'static str,
}

pub(super) fn face(tool: Tool) -> ToolFace {
    let keyed =
        |action: Action, icon, effect| ToolFace { name: action.name(), icon, action: Some(action), effect };
    match tool {
        Tool::Select => keyed(Action::Select, icons::SELECT, "Picks things, and moves what is picked."),
        Tool::Move => keyed(Action::Move, icons::MOVE, "Moves what is selected along its arrows."),
        Tool::Turn => keyed(Action::Turn, icons::ROTATE, "Turns what is selected about its rings."),
        Tool::Scale => keyed(Action::Scale, icons::SCALE, "Makes what is selected larger or smaller."),
        Tool::AddLight => ToolFace {
            name: "Add light",
            icon: icons::LIGHT,
            action: None,
            effect: "Puts a light where one clicks.",
        },
        Tool::ShotCamera => ToolFace {
            name: "Shot camera tool",
            icon: icons::CAMERA,
            action: None,
            effect: "Moves the camera of the picture.",
        },
        Tool::Comb => keyed(Action::Comb, icons::COMB, "Strokes follow the drag."),
        Tool::GuideCurve => {
            keyed(Action::GuideCurve, icons::GUIDE, "Strokes follow a curve that is set point by point.")
        }
        Tool::Fill => keyed(Action::Fill, icons::FILL, "Gives a whole region one base direction."),
        Tool::TurnDirection => {
            keyed(Action::TurnDirection, icons::TURN, "Turns or flips a region's directions.")
        }
        Tool::Smooth => keyed(Action::Smooth, icons::SMOOTH, "Joins directions that lie side by side."),
        Tool::Erase => keyed(Action::Erase, icons::ERASE, "Brings the region's base direction back."),
        Tool::Amount => keyed(
            Action::Amount,
            icons::AMOUNT,
            "Makes strokes wider, longer, denser or flatter where it is dragged.",
        ),
        Tool::Touch => keyed(
            Action::Touch,
            icons::TOUCH,
            "Lays single strokes by hand over all others: a click one, a drag a long one along the surface.",
        ),
        Tool::Region => keyed(Action::Region, icons::REGION, "Says which faces belong to a region."),
        Tool::Pick => keyed(
            Action::Pick,
            icons::PICK,
            "Takes the angle under the cursor into Fill, and selects that region.",
        ),
    }
}
