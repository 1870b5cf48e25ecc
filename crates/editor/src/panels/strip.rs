//! The timeline as one strip at the bottom of the window: transport, frame, ruler, range. When it is opened, the lanes
//! of keys take its place.

use egui::{Align2, Panel, Rect, RichText, Sense, Ui, pos2, vec2};
use impasto_editor_model::timeline::keyed_frames;
use impasto_scene::document::Timeline;
use impasto_scene::motion;

use super::timeline::across::{self, FrameScale, KEY};
use super::timeline::{self, transport};
use super::{Ask, PanelInput, row, row_from_right, within};
use crate::icons;
use crate::theme::{Tokens, measure, type_face};
use crate::widgets::{Button, Tip};

/// From the strip's top to the ruler's line, points.
const LINE: f32 = 35.0;
/// The least distance between two labels of the ruler, points.
const LABELS: f32 = 128.0;

/// Shows the timeline in the lowest 44 points of `ui`, or in as many as the lanes need.
pub fn strip(ui: &mut Ui, shown: &PanelInput<'_>, asks: &mut Vec<Ask>) {
    if shown.session.shows_lanes() {
        return timeline::lanes(ui, shown, asks);
    }
    timeline::leave_curves(ui, asks);
    let frame = egui::Frame::new().fill(Tokens::of(ui).alt);
    Panel::bottom("strip").exact_size(measure::STRIP).resizable(false).frame(frame).show(ui, |ui| {
        let whole = ui.max_rect();
        let left = within(ui, whole, row(), |ui| {
            transport::transport(ui, shown, asks);
            ui.min_rect().right()
        });
        let right = within(ui, whole, row_from_right(), |ui| {
            range(ui, shown, asks);
            ui.min_rect().left()
        });
        let across = left + 22.0..=(right - 66.0).max(left + 23.0);
        ruler(ui, Rect::from_x_y_ranges(across, whole.y_range()), shown, asks);
    });
}

/// The controls at the right end, from right to left.
fn range(ui: &mut Ui, shown: &PanelInput<'_>, asks: &mut Vec<Ask>) {
    ui.spacing_mut().item_spacing.x = measure::GAP;
    ui.add_space(6.0);
    let response = Button::new("Keys").name("Show keys").icon(icons::KEYS_UP).plain().show(ui);
    let effect = "Opens the lanes of keys.";
    if (Tip { name: "Show keys", key: "", effect, range: "" }).on(response).clicked() {
        asks.push(shown.session_with(|session| session.show_lanes(true)));
    }
    transport::finishes(ui, shown, asks);
    transport::looped(ui, shown, asks);
    let Timeline { fps, first, last, .. } = &shown.document.scene().timeline;
    for words in [format!("{fps} fps"), format!("{first}\u{2013}{last}")] {
        ui.label(RichText::new(words).font(type_face::small()).color(Tokens::of(ui).weak));
    }
    transport::dropped(ui, shown);
}

fn ruler(ui: &mut Ui, rect: Rect, shown: &PanelInput<'_>, asks: &mut Vec<Ask>) {
    let scene = shown.document.scene();
    let [first, last] = [scene.timeline.first, scene.timeline.last].map(|frame| frame as f64);
    let across = FrameScale { left: rect.left(), right: rect.right(), first, last };
    // Wider than the ruler, so that the first and the last frame can be hit from outside too.
    let response =
        ui.interact(rect.expand2(vec2(8.0, 0.0)), ui.scope_id().with("ruler"), Sense::click_and_drag());
    across::scrub(ui, &response, across, shown, asks);

    let clip = ui.painter().with_clip_rect(rect.expand2(vec2(12.0, 0.0)));
    let tokens = Tokens::of(ui);
    let (top, line) = (rect.top(), rect.top() + LINE);
    clip.hline(rect.x_range(), line, (1.0, tokens.out));
    for (frame, labelled) in across.ticks(across.label_step(LABELS)) {
        let x = across.x(frame);
        clip.vline(x, if labelled { top + 19.0 } else { top + 25.0 }..=line, (1.0, tokens.div));
        if labelled {
            across::number(ui, pos2(x + 4.0, top + 22.0), Align2::LEFT_CENTER, frame);
        }
    }
    across::finished(ui, clip.clip_rect(), across, line, shown);
    across::drops(ui, across, line + 3.0, shown);
    let reference = across.x(motion::referred_to(scene, &scene.reference).1);
    clip.vline(reference, top + 16.0..=line, (1.0, tokens.viridian));
    let pin = (icons::REFERENCE.glyph(), type_face::icon(12.0));
    clip.text(pos2(reference, top + 10.0), Align2::CENTER_CENTER, pin.0, pin.1, tokens.viridian);
    for frame in keyed_frames(scene) {
        clip.add(across::filled(across::diamond(pos2(across.x(frame), line), KEY), tokens.key));
    }
    let now = across.x(shown.session.frame);
    clip.vline(now, top + 5.0..=line + 1.0, (2.0, tokens.accent_text));
    if response.has_focus() {
        let ring = egui::Stroke::new(2.0, tokens.accent_text);
        ui.painter().rect_stroke(
            rect.shrink2(vec2(0.0, 3.0)),
            measure::CORNER,
            ring,
            egui::StrokeKind::Outside,
        );
    }
}
