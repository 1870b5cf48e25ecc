//! The column at the right of the window: the tree of all items above, the inspector of the selected one below.

use egui::{CentralPanel, Frame, Panel, Ui};

use super::{Area, Ask, PanelInput, area, inspector, tree};
use crate::theme::Tokens;

/// From this window width on, in points, the column is wider, and is shown beside both pictures of a comparison.
const WIDE: f32 = 1600.0;

/// In less width than this, in points, the column is not shown.
const LEAST: f32 = 780.0;

/// The largest share of the column's height that the tree may take.
const MOST_TREE: f32 = 0.6;

/// Whether the column leaves enough of the window for the picture, or for both pictures of a comparison.
pub fn column_fits(ui: &Ui, shown: &PanelInput<'_>) -> bool {
    let compares = shown.session.compare && !shown.document.scene().objects.is_empty();
    ui.available_width() >= if compares { WIDE } else { LEAST }
}

/// Shows the column at the right of `ui`, which loses that room. The line between tree and inspector can be dragged.
pub fn column(ui: &mut Ui, shown: &PanelInput<'_>, asks: &mut Vec<Ask>) {
    let is_wide = ui.ctx().content_rect().width() >= WIDE;
    let (width, tree_height): (f32, f32) = if is_wide { (336.0, 330.0) } else { (280.0, 252.0) };
    // The wide and the narrow column each remember where their lines were dragged to.
    let (whole, top) = if is_wide { ("wide column", "wide tree") } else { ("column", "tree") };
    let low = if is_wide { "low wide tree" } else { "low tree" };
    let frame = Frame::new().fill(Tokens::of(ui).panel);
    Panel::right(whole).default_size(width).size_range(240.0..=480.0).frame(frame).show(ui, |ui| {
        // In a low window the inspector keeps a part of the height.
        let most = (ui.available_height() * MOST_TREE).clamp(64.0, 640.0);
        // The height that the tree has in a low window is not remembered for a higher window.
        let top = if most < tree_height { low } else { top };
        let top = Panel::top(top).default_size(tree_height.min(most)).size_range(most.min(96.0)..=most);
        let top = top.resizable(true);
        top.frame(frame).show_separator_line(false).show(ui, |ui| {
            clip(ui);
            area(ui, Area::Tree, |ui| tree(ui, shown, asks));
        });
        CentralPanel::default().frame(frame).show(ui, |ui| {
            clip(ui);
            let whole = ui.max_rect();
            ui.painter().hline(whole.x_range(), whole.top() + 0.5, (1.0, Tokens::of(ui).div));
            area(ui, Area::Inspector, |ui| inspector(ui, shown, asks));
        });
    });
}

/// Hides the rows that are scrolled out of their part, so that they do not show in the other part.
fn clip(ui: &mut Ui) {
    ui.set_clip_rect(ui.clip_rect().intersect(ui.max_rect()));
}
