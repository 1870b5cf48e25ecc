//! A group of controls that floats over the picture.

use egui::{Frame, InnerResponse, Margin, Sense, Ui, vec2};

use super::draw;
use crate::theme::{Tokens, measure};

/// A group that floats over the picture, 32 points high, with its controls side by side.
pub fn chip<R>(ui: &mut Ui, contents: impl FnOnce(&mut Ui) -> R) -> InnerResponse<R> {
    let tokens = Tokens::of(ui);
    Frame::new()
        .fill(tokens.chip)
        .corner_radius(draw::group_corner())
        .inner_margin(Margin::symmetric(4, 3))
        .show(ui, |ui| {
            ui.horizontal(|ui| {
                ui.spacing_mut().item_spacing.x = 2.0;
                ui.set_height(measure::CHIP - 6.0);
                contents(ui)
            })
            .inner
        })
}

/// The line between two groups of one chip.
pub fn chip_divider(ui: &mut Ui) {
    let (rect, _) = ui.allocate_exact_size(vec2(9.0, 16.0), Sense::hover());
    ui.painter().vline(rect.center().x, rect.y_range(), (1.0, Tokens::of(ui).div));
}
