//! The right column: the tree over the inspector.

use egui::{Frame, Panel, ScrollArea, Ui};

use super::{Ask, Shown, inspector, tree};
use crate::theme::Tokens;

/// A window at least so wide has a wider column.
const WIDE: f32 = 1600.0;

/// Takes the right column off the `Ui`.
pub fn column(ui: &mut Ui, shown: &Shown<'_>, asks: &mut Vec<Ask>) {
    let is_wide = ui.ctx().content_rect().width() >= WIDE;
    let (width, tree_height) = if is_wide { (336.0, 330.0) } else { (280.0, 252.0) };
    let fill = Tokens::of(ui).panel;
    let frame = Frame::new().fill(fill);
    Panel::right("column").default_size(width).size_range(240.0..=480.0).frame(frame).show(ui, |ui| {
        Panel::top("tree").exact_size(tree_height).resizable(false).frame(frame).show(ui, |ui| {
            tree(ui, shown, asks);
        });
        ScrollArea::vertical().id_salt("inspector").auto_shrink(false).show(ui, |ui| {
            inspector(ui, shown, asks);
        });
    });
}
