//! The timeline with its lanes: transport, ruler, and lanes of keys for the camera, each object and whatever else has
//! keys.

pub(super) mod across;
mod clicked_lane;
mod curves;
mod hand;
mod key_menu;
mod lanes;
mod ruler;
pub(super) mod transport;
mod zoom;

use egui::{Color32, Panel, Rect, ScrollArea, Sense, Stroke, StrokeKind, Ui, pos2, vec2};
use impasto_editor_model::Session;
use impasto_editor_model::timeline;

use super::{Ask, PanelInput, row, row_from_right, within};
use crate::theme::{Tokens, measure};

use hand::LaneLayout;
use lanes::LaneRow;

/// Height of the row of buttons.
const BAR: f32 = 40.0;

/// The timeline's height, a lane's height and the width of names, in a window of this width.
fn measures(wide: f32) -> (f32, f32, f32) {
    if wide < 1600.0 { (224.0, 32.0, 168.0) } else { (256.0, 34.0, 200.0) }
}

/// The height of the timeline in a window of this width.
pub fn height(session: &Session, window_width: f32) -> f32 {
    if session.shows_lanes() { measures(window_width).0 } else { measure::STRIP }
}

/// Takes back the drag of a curve's handle if the curves were hidden during it.
pub(super) fn leave_curves(ui: &Ui, asks: &mut Vec<Ask>) {
    curves::leave(ui, asks);
}

/// The timeline with its lanes; takes the lowest part of `ui`.
pub(super) fn lanes(ui: &mut Ui, shown: &PanelInput<'_>, asks: &mut Vec<Ask>) {
    let (height, lane_height, names) = measures(ui.ctx().content_rect().width());
    let frame = egui::Frame::new().fill(Tokens::of(ui).alt);
    Panel::bottom("lanes").exact_size(height).resizable(false).frame(frame).show(ui, |ui| {
        let whole = ui.max_rect();
        let (bar, below) = whole.split_top_bottom_at_y(whole.top() + BAR);
        within(ui, bar, row(), |ui| {
            transport::transport(ui, shown, asks);
            transport::keying(ui, shown, asks);
        });
        within(ui, bar, row_from_right(), |ui| transport::range_fields(ui, shown, asks));
        ui.painter().hline(bar.x_range(), bar.bottom(), (1.0, Tokens::of(ui).div));

        let scene = shown.document.scene();
        let (names, right) = below.split_left_right_at_x(below.left() + names);
        let (top, rows) = below.split_top_bottom_at_y(below.top() + ruler::HEIGHT);
        let on_ruler = Rect::from_x_y_ranges(right.x_range(), top.y_range());
        let whole = ruler::across(scene, right);
        let across = zoom::seen(ui, right, on_ruler, whole, shown.session.frame);
        ruler::ground(ui, right, across, &shown.document.shown().scene);
        ui.painter().vline(names.right(), names.y_range(), (1.0, Tokens::of(ui).div));
        ruler::ruler(ui, on_ruler, across, shown, asks);

        let lanes = timeline::lanes(scene);
        let first = within(ui, rows, egui::Layout::top_down(egui::Align::Min), |ui| {
            rows_of(ui, &lanes, lane_height, names.right(), across, shown, asks)
        });
        let layout = LaneLayout {
            area: Rect::from_x_y_ranges(right.x_range(), rows.top()..=rows.bottom() - ruler::PIN),
            top: first,
            lane: lane_height,
            across,
            lanes: &lanes,
        };
        if shown.session.shows_curves() {
            curves::curves(ui, &layout, shown, asks);
            ruler::over(ui, right, across, shown);
            return;
        }
        curves::leave(ui, asks);
        ruler::over(ui, right, across, shown);
        hand::hand(ui, &layout, shown, asks);
        if let Some([from, to]) = shown.time.keys.boxed() {
            let corner = |[x, y]: [f64; 2]| pos2(x as f32, first + y as f32);
            let rect = Rect::from_two_pos(corner(from), corner(to));
            let tokens = Tokens::of(ui);
            let fill = tokens.accent_text.gamma_multiply(0.12);
            let line = Stroke::new(1.0, tokens.accent_text);
            ui.painter().with_clip_rect(layout.area).rect(rect, 0.0, fill, line, StrokeKind::Inside);
        }
    });
}

/// Shows the rows, which scroll. Returns the y at which the first one begins.
fn rows_of(
    ui: &mut Ui,
    lanes: &[timeline::Lane],
    height: f32,
    names: f32,
    across: across::FrameScale,
    shown: &PanelInput<'_>,
    asks: &mut Vec<Ask>,
) -> f32 {
    ui.spacing_mut().item_spacing.y = 0.0;
    // The reference's pin has room below the rows, where it hides no key.
    let high = ui.available_height() - ruler::PIN;
    let area = ScrollArea::vertical().id_salt("lanes").auto_shrink(false).max_height(high);
    // A newly selected item is scrolled into view.
    let active = shown.document.selection().active().cloned();
    let id = ui.scope_id().with("selected lane");
    let is_new = ui.data_mut(|data| {
        let before = data.get_temp::<Option<impasto_editor_model::Item>>(id).flatten();
        data.insert_temp(id, active.clone());
        before != active
    });
    let shown_rows = area.show(ui, |ui| {
        let size = vec2(ui.available_width(), lanes.len() as f32 * height);
        let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
        for (index, lane) in lanes.iter().enumerate() {
            let top = rect.top() + index as f32 * height;
            let rect = Rect::from_x_y_ranges(rect.x_range(), top..=top + height);
            if is_new && active.is_some() && active == lanes::item(&lane.of) {
                ui.scroll_to_rect(rect, None);
            }
            if !ui.is_rect_visible(rect) {
                continue;
            }
            let tokens = Tokens::of(ui);
            let is_selected = lanes::is_selected(shown.document.selection(), &lane.of);
            let fill = if is_selected { tokens.sel.gamma_multiply(0.8) } else { Color32::TRANSPARENT };
            let shows_curves = shown.session.shows_curves();
            let filled = if shows_curves { rect.with_max_x(names) } else { rect };
            ui.painter().rect_filled(filled, 0.0, fill);
            let row = LaneRow { rect, names, across };
            lanes::name(ui, row, lane, shown, asks);
            if !shows_curves {
                lanes::keys(ui, row, lane, shown, asks);
            }
        }
        rect.top()
    });
    shown_rows.inner
}
