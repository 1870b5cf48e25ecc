//! Lists the controls of the inspector, so that the command search can find them.

use egui::accesskit::{Node, Role};
use egui::{Context, Id, RawInput, Rect, Vec2};

use super::inspector;
use crate::panels::column_state::ColumnState;
use crate::panels::{Ask, PanelInput, brush_thumbnails};
use crate::theme::{self, Theme};
use crate::widgets;

/// Size in points of the column that is laid out to list its controls. It is as wide as the column of a narrow window
/// and higher than any page.
const SIZE: Vec2 = Vec2::new(280.0, 40_000.0);

/// A control of the inspector for what is selected.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Control {
    /// Its name.
    pub name: String,
    /// The name of the section it is in; empty for a control above all sections. A section's head is in that section.
    pub section: String,
}

/// All enabled controls of the inspector for what is selected, from top to bottom, also in folded sections. Finds them
/// by laying out the inspector, with all sections open, in a second context that is never drawn. `ctx` keeps that
/// context for the next call.
pub fn controls(ctx: &Context, shown: &PanelInput<'_>) -> Vec<Control> {
    let key = Id::unique("where the inspector is laid out unseen");
    let unseen = ctx.data_mut(|data| {
        data.get_temp_mut_or_insert_with(key, || {
            let unseen = Context::default();
            theme::apply(&unseen, Theme::Dark, 1.0);
            unseen.enable_accesskit();
            ColumnState::with(&unseen, |state| state.all_open = true);
            unseen
        })
        .clone()
    });
    brush_thumbnails::share(ctx, &unseen);
    let screen_rect = Some(Rect::from_min_size(egui::Pos2::ZERO, SIZE));
    let mut output = unseen.run_ui(RawInput { screen_rect, ..RawInput::default() }, |ui| {
        let mut unheard: Vec<Ask> = Vec::new();
        inspector(ui, shown, &mut unheard);
    });
    let update = output.platform_output.accesskit_update.take();
    output.drop_without_applying_deltas();
    let mut nodes: Vec<Node> =
        update.into_iter().flat_map(|update| update.nodes).map(|(_, node)| node).collect();
    nodes.retain(|node| node.bounds().is_some() && is_control(node));
    let place = |node: &Node| node.bounds().map_or((0.0, 0.0), |rect| (rect.y0, rect.x0));
    nodes.sort_by(|a, b| {
        let ((top_a, left_a), (top_b, left_b)) = (place(a), place(b));
        top_a.total_cmp(&top_b).then(left_a.total_cmp(&left_b))
    });
    let mut section = String::new();
    let mut controls: Vec<Control> = Vec::new();
    for node in nodes {
        let name = node.label().unwrap_or_default().to_owned();
        if node.role() == Role::DisclosureTriangle {
            section.clone_from(&name);
        }
        let control = Control { name, section: section.clone() };
        if !control.name.is_empty() && !controls.contains(&control) {
            controls.push(control);
        }
    }
    controls
}

/// Opens the section of a control, and gives the control the focus in the next pass.
pub fn reach(ctx: &Context, control: &Control) {
    if !control.section.is_empty() {
        let key = ColumnState::key_of(&control.section).to_owned();
        ColumnState::with(ctx, |state| state.sections.insert(key, true));
    }
    widgets::reach(ctx, &control.section, &control.name);
}

/// Whether a node is an enabled control, or the head of a section.
fn is_control(node: &Node) -> bool {
    let role = matches!(
        node.role(),
        Role::Button
            | Role::CheckBox
            | Role::ColorWell
            | Role::ComboBox
            | Role::DisclosureTriangle
            | Role::ListItem
            | Role::RadioButton
            | Role::SpinButton
            | Role::TextInput
    );
    role && !node.is_disabled()
}
