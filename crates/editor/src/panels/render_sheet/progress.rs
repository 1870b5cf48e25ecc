//! The part of the render sheet that shows the progress of rendering, with a picture of the last frame beside it.

use egui::{Align2, Color32, Rect, Role, Sense, TextureHandle, Ui, WidgetInfo, pos2, vec2};
use impasto_editor_model::render_settings::{Outcome, RenderProgress, Stage};

use crate::icons;
use crate::panels::{file_name, row, within};
use crate::theme::{Tokens, measure, type_face};
use crate::widgets::Button;

const HEIGHT: f32 = 172.0;
const PICTURE: egui::Vec2 = egui::Vec2::new(240.0, 135.0);
const BAR: f32 = 8.0;
const LINE: f32 = 20.0;

/// Shows the progress as a card under the settings. Returns whether the user clicked *View frames*. This button is
/// there if the frames are `viewable`.
pub(super) fn card(
    ui: &mut Ui,
    progress: &RenderProgress,
    picture: Option<&TextureHandle>,
    viewable: bool,
) -> bool {
    let tokens = Tokens::of(ui);
    let (card, _) = ui.allocate_exact_size(vec2(ui.available_width(), HEIGHT), Sense::hover());
    ui.painter().rect_filled(card, measure::GROUP_CORNER, tokens.alt);
    let place = Rect::from_min_size(card.left_top() + vec2(14.0, (HEIGHT - PICTURE.y) / 2.0), PICTURE);
    ui.painter().rect_filled(place, measure::CORNER, tokens.field);
    if let Some(picture) = picture {
        let size = picture.size_vec2();
        let scale = (place.width() / size.x).min(place.height() / size.y);
        let uv = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        let rect = Rect::from_center_size(place.center(), size * scale);
        ui.painter().image(picture.id(), rect, uv, Color32::WHITE);
    }
    let words =
        Rect::from_min_max(pos2(place.right() + 16.0, place.top()), card.right_bottom() - vec2(14.0, 12.0));
    let (head, percent) = (progress.count(), format!("{:.0} %", progress.share() * 100.0));
    let painter = ui.painter();
    painter.text(words.left_top(), Align2::LEFT_TOP, &head, type_face::title(), tokens.text);
    let right = words.right_top() + vec2(0.0, 2.0);
    painter.text(right, Align2::RIGHT_TOP, &percent, type_face::number(), tokens.text);
    bar(ui, words, progress);
    let mut at = words.left_top() + vec2(0.0, 42.0);
    let last = progress.last.as_deref().map(|path| format!("last written: {}", file_name(path)));
    for line in [progress.time_words(), progress.frame_words(), last.unwrap_or_default()] {
        if !line.is_empty() {
            ui.painter().text(at, Align2::LEFT_TOP, line, type_face::small(), tokens.weak);
            at.y += LINE;
        }
    }
    state(ui, at + vec2(0.0, 4.0), words.right(), progress);
    let low =
        Rect::from_min_max(pos2(place.left(), place.bottom() - 36.0), place.max).shrink2(vec2(8.0, 4.0));
    let button = || Button::new("View frames").icon(icons::PLAY);
    viewable && within(ui, low, row(), |ui| button().show(ui).clicked())
}

fn bar(ui: &Ui, words: Rect, progress: &RenderProgress) {
    let tokens = Tokens::of(ui);
    let whole = Rect::from_min_size(words.left_top() + vec2(0.0, 24.0), vec2(words.width(), BAR));
    let done = whole.with_max_x(whole.left() + whole.width() * progress.share() as f32);
    ui.painter().rect_filled(whole, BAR / 2.0, tokens.field);
    ui.painter().rect_filled(done, BAR / 2.0, tokens.accent);
    let response = ui.interact(whole, ui.scope_id().with("progress"), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::ProgressIndicator, true, "Progress"));
    let share = progress.share();
    let spoken = format!("{}, {}", progress.count(), progress.time_words());
    ui.ctx().accesskit_node_builder(response.id, |node| {
        node.set_min_numeric_value(0.0);
        node.set_max_numeric_value(1.0);
        node.set_numeric_value(share);
        node.set_value(spoken);
    });
}

/// The current stage, or how rendering ended.
fn state(ui: &Ui, at: egui::Pos2, right: f32, progress: &RenderProgress) {
    let tokens = Tokens::of(ui);
    // No file has been written yet: the first frame is being drawn, or a movie, whose file appears only at its end.
    let no_file = progress.last.is_none() && progress.stage == Stage::Drawing && !progress.stopping;
    let is_without = no_file && progress.outcome.is_none();
    let (icon, colour) = match (&progress.outcome, progress.stage) {
        _ if is_without => (None, tokens.weak),
        (Some(Outcome::Failed(_)), _) => (Some(icons::ERROR), tokens.vermilion),
        (Some(Outcome::Stopped), _) => (Some(icons::DONE), tokens.text),
        (Some(Outcome::Done), _) => (Some(icons::DONE), tokens.viridian),
        (None, Stage::Drawing) if !progress.stopping => (Some(icons::DONE), tokens.viridian),
        (None, _) => (None, tokens.weak),
    };
    let mut at = at;
    if let Some(icon) = icon {
        let font = type_face::icon(measure::SMALL_ICON);
        ui.painter().text(at, Align2::LEFT_TOP, icon.glyph(), font, colour);
        at.x += measure::SMALL_ICON + 6.0;
    }
    let none_yet = if progress.kept > 0 { "No new file yet" } else { "No file is there yet" };
    let words = if is_without { none_yet.to_owned() } else { progress.state_words() };
    let galley = ui.painter().layout(words.clone(), type_face::small(), colour, right - at.x);
    let rect = Rect::from_min_size(at, galley.size());
    ui.painter().galley(at, galley, colour);
    let response = ui.interact(rect, ui.scope_id().with("state"), Sense::hover());
    response.widget_info(|| WidgetInfo::labeled(Role::Status, true, "Rendering state"));
    ui.ctx().accesskit_node_builder(response.id, |node| {
        node.set_live(egui::accesskit::Live::Polite);
        node.set_value(words);
    });
}
