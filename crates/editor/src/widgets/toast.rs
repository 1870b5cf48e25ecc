//! Toasts: short messages that come up at the bottom of the window and vanish by themselves.

use egui::{Align2, Area, Context, Frame, Id, Margin, Order, RichText, vec2};

use super::{Button, draw};
use crate::theme::{Tokens, measure, type_face};

/// The greatest width of a message, points; a longer one takes several lines.
const MOST_WIDE: f32 = 720.0;

/// A short message that comes up at the bottom of the window and vanishes by itself.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Toast {
    /// What happened.
    pub words: String,
    /// The text of its button; empty if it has none.
    pub action: String,
    /// Whether it reports an error.
    pub error: bool,
}

/// Shows the newest three of `shown`, with the newest at the bottom. The lowest `clear` points of the window stay free.
/// Returns the index in `shown` of the toast whose button was clicked.
pub fn toasts(ctx: &Context, shown: &[Toast], clear: f32) -> Option<usize> {
    let first = shown.len().saturating_sub(3);
    let mut clicked = None;
    let mut below = clear + measure::GAP;
    for (index, toast) in shown.iter().enumerate().skip(first).rev() {
        let area = Area::new(Id::unique(("toast", shown.len() - index)));
        let area = area.order(Order::Foreground).anchor(Align2::CENTER_BOTTOM, vec2(0.0, -below));
        let most = (ctx.content_rect().width() - 96.0).clamp(160.0, MOST_WIDE);
        let line = area.show(ctx, |ui| {
            ui.set_max_width(most);
            line(ui, toast)
        });
        below += line.response.rect.height() + measure::GAP;
        if line.inner {
            clicked = Some(index);
        }
    }
    clicked
}

fn line(ui: &mut egui::Ui, toast: &Toast) -> bool {
    let tokens = Tokens::of(ui);
    let edge = if toast.error { tokens.vermilion } else { tokens.div };
    Frame::new()
        .fill(tokens.wid)
        .stroke((1.0, edge))
        .corner_radius(draw::group_corner())
        .inner_margin(Margin {
            left: 12,
            right: if toast.action.is_empty() { 12 } else { 2 },
            top: 2,
            bottom: 2,
        })
        .show(ui, |ui| {
            ui.horizontal(|ui| {
                ui.set_min_height(measure::CHIP - 4.0);
                let words = RichText::new(&toast.words).font(type_face::body()).color(tokens.text);
                let button = if toast.action.is_empty() { 0.0 } else { 80.0 };
                let room = (ui.available_width() - button).max(80.0);
                let wide = draw::width(ui, &toast.words, type_face::body()).min(room);
                let label = ui.add_sized([wide, measure::CHIP - 4.0], egui::Label::new(words).wrap());
                label.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Alert, true, &toast.words));
                !toast.action.is_empty() && Button::new(&toast.action).plain().show(ui).clicked()
            })
            .inner
        })
        .inner
}
