//! The strip of buttons at the left of the viewport, with the tools of the mode.

use egui::scroll_area::ScrollBarVisibility;
use egui::{Panel, ScrollArea, Ui, vec2};
use impasto_editor_model::session::{Mode, Tool};

use super::tool_names::face;
use super::{Ask, PanelInput};
use crate::theme::{Tokens, measure};
use crate::widgets::{self, Tip};

const POSING: &[&[Tool]] =
    &[&[Tool::Select, Tool::Move, Tool::Turn, Tool::Scale], &[Tool::AddLight, Tool::ShotCamera]];
const PAINT: &[&[Tool]] = &[
    &[Tool::Comb, Tool::GuideCurve, Tool::Fill, Tool::TurnDirection, Tool::Smooth, Tool::Erase],
    &[Tool::Touch, Tool::Amount, Tool::Region, Tool::Pick],
];

/// Takes the left 48 points of `ui`.
pub fn rail(ui: &mut Ui, shown: &PanelInput<'_>, asks: &mut Vec<Ask>) {
    let frame = egui::Frame::new().fill(Tokens::of(ui).panel);
    Panel::left("rail").exact_size(measure::RAIL).resizable(false).frame(frame).show(ui, |ui| {
        // A low window with open lanes has no room for all tools, so they can be scrolled.
        ScrollArea::vertical().scroll_bar_visibility(ScrollBarVisibility::AlwaysHidden).show(ui, |ui| {
            ui.add_space(6.0);
            ui.vertical_centered(|ui| tools(ui, shown, asks));
        });
    });
}

fn tools(ui: &mut Ui, shown: &PanelInput<'_>, asks: &mut Vec<Ask>) {
    ui.spacing_mut().item_spacing.y = 2.0;
    let groups = if shown.session.mode == Mode::Paint { PAINT } else { POSING };
    for (index, group) in groups.iter().enumerate() {
        if index > 0 {
            let (rect, _) = ui.allocate_exact_size(vec2(30.0, 9.0), egui::Sense::hover());
            ui.painter().hline(rect.x_range(), rect.center().y, (1.0, Tokens::of(ui).div));
        }
        for tool in *group {
            button(ui, shown, *tool, asks);
        }
    }
}

fn button(ui: &mut Ui, shown: &PanelInput<'_>, tool: Tool, asks: &mut Vec<Ask>) {
    let face = face(tool);
    let key = face.action.map(|action| shown.keys_of(action)).unwrap_or_default();
    let letter = if key.chars().count() == 1 { key.as_str() } else { "" };
    let on = shown.session.tool() == tool;
    let response = widgets::rail_button(ui, face.icon, face.name, letter, on);
    let response = Tip { name: face.name, key: &key, effect: face.effect, range: "" }.on(response);
    if response.clicked() && !on {
        asks.push(shown.session_with(|session| session.set_tool(tool)));
    }
}
