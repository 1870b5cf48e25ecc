//! Draws the timeline's ruler: labels, the grips of the range, and marks for frames that are cached or that playback
//! dropped. Over ruler and lanes it draws the pin of the reference and the playhead.

use egui::{Align2, CursorIcon, Rect, Sense, Ui, pos2, vec2};
use impasto_editor_model::command::{Command, Time};
use impasto_editor_model::timeline::keyed_frames;
use impasto_scene::document::Scene;
use impasto_scene::motion;

use super::across::{self, FrameScale};
use crate::icons;
use crate::panels::{Ask, PanelInput};
use crate::theme::{Tokens, measure, type_face};

/// Height of the strip below the lanes in which the reference's pin stands.
pub(super) const PIN: f32 = 24.0;

pub(super) const HEIGHT: f32 = 28.0;
/// The least distance between labels, in points.
const LABELS: f32 = 90.0;

/// The scale at which the range and all keys fit into `rect`.
pub(super) fn across(scene: &Scene, rect: Rect) -> FrameScale {
    let keys = keyed_frames(scene);
    let [first, last] = [scene.timeline.first, scene.timeline.last].map(|frame| frame as f64);
    FrameScale {
        left: rect.left() + 50.0,
        right: (rect.right() - 64.0).max(rect.left() + 51.0),
        first: keys.first().copied().unwrap_or(first).min(first).floor(),
        last: keys.last().copied().unwrap_or(last).max(last).ceil(),
    }
}

/// Fills the area behind the ruler and the lanes; the range of the timeline is lighter.
pub(super) fn ground(ui: &Ui, rect: Rect, across: FrameScale, scene: &Scene) {
    let tokens = Tokens::of(ui);
    let [first, last] = [scene.timeline.first, scene.timeline.last].map(|frame| across.x(frame as f64));
    ui.painter().rect_filled(rect, 0.0, tokens.app);
    let lit = Rect::from_x_y_ranges(first..=last.max(first + 1.0), rect.y_range()).intersect(rect);
    if lit.is_positive() {
        ui.painter().rect_filled(lit, 0.0, tokens.panel);
    }
}

/// The ruler, with grips at the ends of the range. A drag on the ruler scrubs.
pub(super) fn ruler(
    ui: &mut Ui,
    rect: Rect,
    across: FrameScale,
    shown: &PanelInput<'_>,
    asks: &mut Vec<Ask>,
) {
    let response = ui.interact(rect, ui.scope_id().with("ruler"), Sense::click_and_drag());
    let is_gripped = grips(ui, rect, across, shown, asks);
    if !is_gripped {
        across::scrub(ui, &response, across, shown, asks);
    }
    let tokens = Tokens::of(ui);
    let step = across.label_step(LABELS);
    for (frame, labelled) in across.ticks(step) {
        let x = across.x(frame);
        let top = if labelled { rect.bottom() - 10.0 } else { rect.bottom() - 6.0 };
        ui.painter().vline(x, top..=rect.bottom(), (1.0, tokens.out));
        if labelled {
            across::number(ui, pos2(x, rect.top() + 8.0), Align2::CENTER_CENTER, frame);
        }
    }
    across::finished(ui, rect, across, rect.bottom() - 1.5, shown);
    across::drops(ui, across, rect.bottom() - 8.0, shown);
    if response.has_focus() {
        let ring = egui::Stroke::new(2.0, tokens.accent_text);
        ui.painter().rect_stroke(rect.shrink(1.0), measure::CORNER, ring, egui::StrokeKind::Inside);
    }
}

/// The grips that drag the ends of the range. Returns whether one is held, or was let go in this pass.
fn grips(ui: &mut Ui, rect: Rect, across: FrameScale, shown: &PanelInput<'_>, asks: &mut Vec<Ask>) -> bool {
    let timeline = &shown.document.shown().scene.timeline;
    let stored = &shown.document.scene().timeline;
    let mut is_gripped = false;
    for (salt, frame, side) in [("first grip", timeline.first, -1.0), ("last grip", timeline.last, 1.0)] {
        let x = across.x(frame as f64);
        // The grips lie outside of the range, so that the first and the last frame can be scrubbed to.
        let at = pos2(x + side * 8.0, rect.bottom() - 8.0);
        if !rect.contains(at) {
            continue;
        }
        let hit = Rect::from_center_size(at, vec2(12.0, 16.0));
        let response = ui.interact(hit, ui.scope_id().with(salt), Sense::drag());
        let response = response.on_hover_cursor(CursorIcon::ResizeHorizontal);
        let tokens = Tokens::of(ui);
        let colour = if response.hovered() || response.dragged() { tokens.text } else { tokens.out };
        let corners = vec![
            pos2(x + side, rect.bottom() - 1.0),
            pos2(x + side, rect.bottom() - 12.0),
            pos2(x + side * 9.0, rect.bottom() - 1.0),
        ];
        ui.painter().add(across::filled(corners, colour));
        is_gripped |= response.is_pointer_button_down_on() || response.drag_stopped();
        let Some(pointer) = response.interact_pointer_pos().filter(|_| response.dragged()) else {
            if response.drag_stopped() {
                let range = Time::SetRange(timeline.first, timeline.last);
                let is_same = (timeline.first, timeline.last) == (stored.first, stored.last);
                asks.push(if is_same { Ask::EndPreview } else { Ask::Do(Command::Time(range)) });
            }
            continue;
        };
        // `across` is made from the scene without this preview: if it followed the preview, the end would run away
        // from the pointer.
        let to = across.place(pointer.x - side * 8.0).round() as i64;
        let range = match side < 0.0 {
            true => Time::SetRange(to.min(timeline.last), timeline.last),
            false => Time::SetRange(timeline.first, to.max(timeline.first)),
        };
        asks.push(Ask::Preview(Command::Time(range)));
    }
    is_gripped
}

/// What is drawn over ruler and lanes: the reference's pin, and the playhead with its flag.
pub(super) fn over(ui: &Ui, rect: Rect, across: FrameScale, shown: &PanelInput<'_>) {
    let tokens = Tokens::of(ui);
    let scene = shown.document.scene();
    let painter = ui.painter().with_clip_rect(rect);
    let reference = across.x(motion::referred_to(scene, &scene.reference).1);
    painter.vline(reference, rect.top() + HEIGHT - 8.0..=rect.bottom(), (2.0, tokens.viridian));
    let pin = pos2(reference, rect.bottom() - 0.5 * PIN);
    painter.circle_filled(pin, 9.0, tokens.panel);
    let font = type_face::icon(14.0);
    painter.text(pin, Align2::CENTER_CENTER, icons::REFERENCE.glyph(), font, tokens.viridian);

    let frame = shown.session.frame;
    let now = across.x(frame);
    painter.vline(now, rect.top() + 16.0..=rect.bottom(), (2.0, tokens.accent_text));
    let words = format!("{frame}");
    let galley = painter.layout_no_wrap(words, type_face::ruler(), tokens.on_accent);
    let flag =
        Rect::from_center_size(pos2(now, rect.top() + 9.0), vec2((galley.size().x + 14.0).max(33.0), 17.0));
    painter.rect_filled(flag, 3.0, tokens.accent);
    painter.galley(flag.center() - galley.size() / 2.0, galley, tokens.on_accent);
}
