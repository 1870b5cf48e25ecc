//! A widget: the head of a part of the inspector. A click on it folds or opens that part.

use egui::{Align2, Response, Role, Sense, Ui, pos2, vec2};

use super::draw;
use crate::icons;
use crate::theme::{Tokens, measure, type_face};

/// The head of a part of the inspector, as wide as the panel, with a line above it and `note` at its right end.
/// A click opens or folds it and sets `open`.
pub fn section(ui: &mut Ui, name: &str, note: &str, open: &mut bool) -> Response {
    let tokens = Tokens::of(ui);
    let (rect, mut response) =
        ui.allocate_exact_size(vec2(ui.available_width(), measure::SECTION_HEAD), Sense::click());
    if response.clicked() {
        *open = !*open;
        response.mark_changed();
    }
    let painter = ui.painter();
    if response.hovered() {
        painter.rect_filled(rect, 0.0, tokens.hov);
    }
    painter.hline(rect.x_range(), rect.top() + 0.5, (1.0, tokens.div));
    let middle = rect.center().y + 0.5;
    let arrow = if *open { icons::EXPANDED } else { icons::FOLDED };
    draw::icon(painter, pos2(rect.left() + 16.0, middle), arrow, measure::ICON, tokens.text);
    let at = pos2(rect.left() + 28.0, middle);
    draw::words(painter, at, Align2::LEFT_CENTER, name, type_face::head(), tokens.text);
    let end = pos2(rect.right() - measure::GAP, middle);
    let weak = if response.hovered() { tokens.text } else { tokens.weak };
    draw::words(painter, end, Align2::RIGHT_CENTER, note, type_face::small(), weak);
    draw::focus_ring(ui, &response, rect.shrink(3.0), 2.0);
    draw::named_state(&response, Role::DisclosureTriangle, name, *open);
    if !note.is_empty() {
        ui.ctx().accesskit_node_builder(response.id, |node| node.set_description(note));
    }
    response
}
