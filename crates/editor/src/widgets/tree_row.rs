//! The widget that draws one row of the scene tree.

use egui::{Align2, Color32, Rect, Response, Role, Sense, Ui, pos2, vec2};

use super::draw;
use crate::icons::{self, Icon};
use crate::theme::{Tokens, measure, type_face};

/// What stands before a row's name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RowMark {
    /// An icon that shows what kind of thing it is.
    Icon(Icon),
    /// The colour of a region or a touch.
    Colour(Color32),
    /// Something is wrong with it: a vermilion icon, and the name in the same colour.
    Wrong(Icon),
}

/// One row of the scene tree, as wide as the panel.
pub struct TreeRow<'a> {
    /// What the row shows.
    pub name: &'a str,
    /// What a screen reader says: *skin, region, 4 guides*.
    pub spoken: &'a str,
    /// What stands before the name.
    pub mark: RowMark,
    /// How deep it is nested: its number of ancestors, 0 at the top level.
    pub depth: usize,
    /// Whether its children are shown; `None` if it has none.
    pub expanded: Option<bool>,
    /// Whether it is selected.
    pub selected: bool,
    /// Words at its right end.
    pub note: &'a str,
    /// Whether a small ochre diamond at the right shows that it is animated.
    pub keyed: bool,
    /// Whether it is hidden: its eye is shut.
    pub hidden: bool,
    /// Whether it is locked.
    pub locked: bool,
}

/// What the user did to a [`TreeRow`].
#[derive(Clone, Debug)]
pub struct RowResponse {
    /// The row itself: a click selects, a double click renames, a drag moves it.
    pub response: Response,
    /// The little triangle was clicked.
    pub toggled: bool,
    /// The eye was clicked.
    pub hide_clicked: bool,
    /// The lock was clicked.
    pub lock_clicked: bool,
}

impl TreeRow<'_> {
    /// Draws it. The eye and the lock both show if the pointer is on the row or the row is selected. Otherwise each
    /// shows only while it is shut.
    pub fn show(&self, ui: &mut Ui) -> RowResponse {
        self.draw(ui, true)
    }

    /// Draws it without eye and lock.
    pub fn show_bare(&self, ui: &mut Ui) -> RowResponse {
        self.draw(ui, false)
    }

    fn draw(&self, ui: &mut Ui, has_buttons: bool) -> RowResponse {
        let tokens = Tokens::of(ui);
        let size = vec2(ui.available_width(), measure::TREE_ROW);
        let (rect, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
        let over = response.contains_pointer();
        let fill = match (self.selected, over) {
            (true, _) => tokens.sel,
            (false, true) => tokens.hov,
            (false, false) => Color32::TRANSPARENT,
        };
        ui.painter().rect_filled(rect, 0.0, fill);
        draw::named_state(&response, Role::TreeItem, self.spoken, self.selected);
        let weak = if over && !self.selected { tokens.text } else { tokens.weak };

        let left = rect.left() + 38.0 + 16.0 * self.depth as f32;
        let middle = rect.center().y;
        let toggled = self.expander(ui, pos2(left - 22.0, middle), &response);
        let (name_at, colour) = self.mark(ui, pos2(left, middle), weak);

        let mut end = rect.right() - measure::GAP;
        let mut clicks = [false; 2];
        // Each button has a fixed place, so that it does not move from under the pointer as the other comes and goes.
        let wanted = over || self.selected;
        let buttons = [
            (icons::LOCKED, icons::UNLOCKED, "Lock", self.locked),
            (icons::HIDDEN, icons::VISIBLE, "Hide", self.hidden),
        ];
        let mut at = end;
        for (slot, (shut, open, verb, on)) in buttons.into_iter().enumerate() {
            let centre = pos2(at - measure::SMALL_ICON / 2.0, middle);
            at -= measure::SMALL_ICON + measure::GAP;
            if has_buttons && (on || wanted) {
                let icon = if on { shut } else { open };
                clicks[slot] = self.small_button(ui, (centre, &response), (icon, weak), (verb, on));
                end = at;
            }
        }
        if self.keyed {
            let (half, centre) = (3.5, pos2(end - 4.0, middle));
            let corners = [vec2(0.0, -half), vec2(half, 0.0), vec2(0.0, half), vec2(-half, 0.0)];
            let corners = corners.map(|corner| centre + corner).to_vec();
            ui.painter().add(egui::Shape::convex_polygon(corners, tokens.key, egui::Stroke::NONE));
            end -= 8.0 + measure::GAP;
        }
        let note = draw::words(
            ui.painter(),
            pos2(end, middle),
            Align2::RIGHT_CENTER,
            self.note,
            type_face::small(),
            weak,
        );
        let room = note.left() - measure::GAP - name_at.x;
        let name = draw::without_middle(ui, self.name, type_face::body(), room);
        draw::words_within(ui, name_at, &name, type_face::body(), colour, room);
        draw::focus_ring(ui, &response, rect.shrink(3.0), 2.0);
        let response = if name == self.name { response } else { response.on_hover_text(self.name) };
        RowResponse { response, toggled, hide_clicked: clicks[1], lock_clicked: clicks[0] }
    }

    /// Draws what stands before the name; returns where the name begins and its colour.
    fn mark(&self, ui: &Ui, at: egui::Pos2, weak: Color32) -> (egui::Pos2, Color32) {
        let tokens = Tokens::of(ui);
        let text = if self.hidden { weak } else { tokens.text };
        match self.mark {
            RowMark::Icon(icon) => {
                draw::icon(ui.painter(), at, icon, measure::SMALL_ICON, weak);
                (at + vec2(14.0, 0.0), text)
            }
            RowMark::Wrong(icon) => {
                draw::icon(ui.painter(), at, icon, measure::SMALL_ICON, tokens.vermilion);
                (at + vec2(14.0, 0.0), tokens.vermilion)
            }
            RowMark::Colour(colour) => {
                let at = at - vec2(2.0, 0.0);
                ui.painter().rect_filled(Rect::from_center_size(at, vec2(12.0, 12.0)), 3.0, colour);
                (at + vec2(12.0, 0.0), text)
            }
        }
    }

    fn expander(&self, ui: &Ui, at: egui::Pos2, row: &Response) -> bool {
        let Some(open) = self.expanded else { return false };
        let icon = if open { icons::EXPANDED } else { icons::FOLDED };
        self.small_button(ui, (at, row), (icon, Tokens::of(ui).text), ("Expand", open))
    }

    fn small_button(
        &self,
        ui: &Ui,
        (at, row): (egui::Pos2, &Response),
        (icon, colour): (Icon, Color32),
        (verb, on): (&str, bool),
    ) -> bool {
        let hit = Rect::from_center_size(at, vec2(measure::HIT, measure::HIT));
        let response = ui.interact(hit, row.id.with(verb), Sense::click());
        let colour = if response.hovered() { Tokens::of(ui).text } else { colour };
        draw::icon(ui.painter(), at, icon, measure::SMALL_ICON, colour);
        draw::focus_ring(ui, &response, hit.shrink(2.0), measure::CORNER);
        draw::named_state(&response, Role::Button, &format!("{verb} {}", self.name), on);
        response.clicked()
    }
}
