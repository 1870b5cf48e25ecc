//! The viewer of finished frames: a picture, made smaller if it does not fit, and a bar to play, step and scrub.
//! Nothing can be edited here.

use egui::{CentralPanel, Color32, Event, Frame, Panel, Rect, RichText, Role, Sense, TextureHandle, Ui};
use egui::{WidgetInfo, pos2, vec2};
use impasto_editor_model::finished_frames::FinishedFrames;
use impasto_editor_model::keymap::{Action, Key, Keymap, Modifiers, Scope};

use super::{divider, file_name, row, row_from_right, text_width, within};
use crate::icons;
use crate::theme::{Tokens, measure, type_face};
use crate::widgets::{self, Button, Tip, key_of};
use crate::window::tab_pressed;

const BAR: f32 = 44.0;
/// The least width that is left for the scrubbing line, points.
const LEAST_LINE: f32 = 120.0;

/// What the viewer shows.
#[derive(Clone, Copy)]
pub struct ViewerShown<'a> {
    /// The frames, and which of them is asked for.
    pub frames: &'a FinishedFrames,
    /// The picture of the frame that is shown; none if its file cannot be read, or no frame was read yet.
    pub picture: Option<&'a TextureHandle>,
    /// The index of the frame that is shown.
    pub shown: Option<usize>,
    /// Why that frame cannot be shown.
    pub fault: Option<&'a str>,
    /// The keys in use: those that play and step on the timeline do so here.
    pub keymap: &'a Keymap,
    /// The keys of the number pad that were pressed in this pass.
    pub numpad: &'a [(Key, Modifiers)],
    /// Whether a question is open over the viewer; all keys then go to the question.
    pub is_covered: bool,
}

/// What the viewer asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ViewerAsk {
    /// Go back to work.
    Close,
    /// Play, or stop.
    PlayOrStop,
    /// Stop, and go to the frame with this index. An index beyond either end means that end.
    GoTo(i64),
    /// Stop, and go this many frames on.
    Step(i64),
    /// Begin again at the end, or not.
    Loop(bool),
}

/// Shows the viewer in all of `ui`. Returns what it asks for, if anything.
pub fn frame_viewer(ui: &mut Ui, shown: &ViewerShown<'_>) -> Option<ViewerAsk> {
    let mut ask = by_key(ui, shown);
    let tokens = Tokens::of(ui);
    let frame = Frame::new().fill(tokens.alt);
    Panel::bottom("frame viewer").exact_size(BAR).resizable(false).frame(frame).show(ui, |ui| {
        ask = bar(ui, shown).or(ask);
    });
    let is_dark = ui.visuals().dark_mode;
    let ground = Frame::new().fill(if is_dark { tokens.field } else { tokens.app });
    CentralPanel::default().frame(ground).show(ui, |ui| picture(ui, shown));
    ask
}

fn by_key(ui: &Ui, shown: &ViewerShown<'_>) -> Option<ViewerAsk> {
    if shown.is_covered {
        return None;
    }
    let plain = |held: egui::Modifiers| Modifiers { ctrl: held.command, shift: held.shift, alt: held.alt };
    let asked = |key: Key, held: Modifiers| {
        Some(match shown.keymap.action_for(key, held, Scope::Animate) {
            _ if key == Key::Escape => ViewerAsk::Close,
            Some(Action::Play) => ViewerAsk::PlayOrStop,
            Some(Action::StepBack) => ViewerAsk::Step(-1),
            Some(Action::StepOn) => ViewerAsk::Step(1),
            Some(Action::FirstFrame) => ViewerAsk::GoTo(0),
            Some(Action::LastFrame) => ViewerAsk::GoTo(i64::MAX),
            _ => return None,
        })
    };
    let numpad = shown.numpad.iter().copied();
    let mut ask = tab_pressed(ui.ctx()).map(|held| (Key::Tab, plain(held))).into_iter().chain(numpad);
    let mut ask = ask.find_map(|(key, held)| asked(key, held));
    ui.input_mut(|input| {
        input.events.retain(|event| {
            let Event::Key { key, pressed: true, modifiers, .. } = event else { return true };
            let by_this = key_of(*key).and_then(|key| asked(key, plain(*modifiers)));
            ask = by_this.or(ask);
            by_this.is_none()
        });
    });
    ask
}

fn picture(ui: &mut Ui, shown: &ViewerShown<'_>) {
    let (area, tokens) = (ui.max_rect(), Tokens::of(ui));
    let words = match (shown.picture, shown.fault) {
        (Some(picture), _) => {
            let size = picture.size_vec2();
            // Small pictures are not enlarged: a pixel stays a pixel.
            let most = 1.0 / ui.ctx().pixels_per_point();
            let scale = (area.width() / size.x).min(area.height() / size.y).min(most);
            let rect = Rect::from_center_size(area.center(), size * scale);
            let uv = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            ui.painter().image(picture.id(), rect, uv, Color32::WHITE);
            ""
        }
        (None, Some(fault)) => fault,
        (None, None) => "Reading\u{2026}",
    };
    let colour = if shown.fault.is_some() { tokens.vermilion } else { tokens.weak };
    let galley = ui.painter().layout(words.to_owned(), type_face::body(), colour, area.width() - 80.0);
    ui.painter().galley(area.center() - galley.size() / 2.0, galley, colour);
    let response = ui.interact(area, ui.scope_id().with("picture"), Sense::hover());
    let file = shown.shown.map(|index| file_name(shown.frames.frame(index).1)).unwrap_or_default();
    response.widget_info(|| {
        let mut info = WidgetInfo::labeled(Role::Image, true, "Finished frame");
        info.current_text_value = Some(if words.is_empty() { file.clone() } else { words.to_owned() });
        info
    });
}

fn bar(ui: &mut Ui, shown: &ViewerShown<'_>) -> Option<ViewerAsk> {
    let mut ask = None;
    let whole = ui.max_rect();
    let frames = shown.frames;
    let mut left = whole.left();
    within(ui, whole, row(), |ui| {
        ui.spacing_mut().item_spacing.x = 1.0;
        ui.add_space(7.0);
        let (icon, name) =
            if frames.is_playing() { (icons::PAUSE, "Pause") } else { (icons::PLAY, Action::Play.name()) };
        for (icon, name, action, asks) in [
            (icons::FIRST_FRAME, Action::FirstFrame.name(), Action::FirstFrame, ViewerAsk::GoTo(0)),
            (icons::PREVIOUS_FRAME, Action::StepBack.name(), Action::StepBack, ViewerAsk::Step(-1)),
            (icon, name, Action::Play, ViewerAsk::PlayOrStop),
            (icons::NEXT_FRAME, Action::StepOn.name(), Action::StepOn, ViewerAsk::Step(1)),
            (icons::LAST_FRAME, Action::LastFrame.name(), Action::LastFrame, ViewerAsk::GoTo(i64::MAX)),
        ] {
            let response = widgets::icon_button(ui, icon, name);
            let key = shown.keymap.shortcut_text(action).unwrap_or_default();
            if (Tip { name, key: &key, effect: "", range: "" }).on(response).clicked() {
                ask = Some(asks);
            }
        }
        let mut looped = frames.looped;
        let response = widgets::icon_toggle(ui, icons::LOOP, "Loop", &mut looped);
        let effect = "Playing begins again at the end.";
        if (Tip { name: "Loop", key: "", effect, range: "" }).on(response).changed() {
            ask = Some(ViewerAsk::Loop(looped));
        }
        divider(ui);
        left = ui.cursor().left();
    });
    let mut right = whole.right();
    within(ui, whole, row_from_right(), |ui| {
        ui.spacing_mut().item_spacing.x = measure::GAP;
        ui.add_space(4.0);
        let back = Button::new("Back to work").show(ui);
        let effect = "Closes the frames. Nothing was changed.";
        if (Tip { name: "Back to work", key: "Esc", effect, range: "" }).on(back).clicked() {
            ask = Some(ViewerAsk::Close);
        }
        right = ui.cursor().right() - measure::GAP;
    });
    let room = Rect::from_x_y_ranges(left..=right, whole.y_range());
    let line = words(ui, room, shown);
    scrub(ui, line, frames).map(ViewerAsk::GoTo).or(ask)
}

/// Shows the name of the frame's file, the frame's number and the rate as words at the right of `room`, and leaves out
/// what does not fit. Returns the rest of `room`, for the scrubbing line.
fn words(ui: &mut Ui, room: Rect, shown: &ViewerShown<'_>) -> Rect {
    let tokens = Tokens::of(ui);
    let frames = shown.frames;
    let index = shown.shown.unwrap_or_else(|| frames.at());
    let (number, path) = frames.frame(index);
    let dropped = match frames.dropped() {
        0 => String::new(),
        count => format!(", {count} dropped"),
    };
    let count = format!("frame {number}, {} of {}", index + 1, frames.count());
    let rate = format!("{} fps{dropped}", frames.fps());
    // The numbers change while frames play, but the scrubbing line must keep its length. So room is kept for the widest
    // numbers.
    let most =
        format!("frame {}, {} of {}", frames.frame(frames.count() - 1).0, frames.count(), frames.count());
    let most_rate = format!("{} fps, 0000 dropped", frames.fps());
    let file = file_name(path);
    let mut right = room.right();
    for (words, widest, colour) in [
        (file.as_str(), file.as_str(), tokens.text),
        (&count, &most, tokens.weak),
        (&rate, &most_rate, tokens.weak),
    ] {
        let wide =
            text_width(ui, widest, type_face::number()).max(text_width(ui, words, type_face::number()));
        if right - wide - measure::GAP < room.left() + LEAST_LINE {
            continue;
        }
        let place = Rect::from_x_y_ranges(right - wide..=right, room.y_range());
        within(ui, place, row_from_right(), |ui| {
            let words = RichText::new(words).font(type_face::number()).color(colour);
            ui.add(egui::Label::new(words).extend()).on_hover_text(path.display().to_string());
        });
        right -= wide + 2.0 * measure::GAP;
    }
    Rect::from_min_max(room.min, pos2(right, room.max.y))
}

/// The line on which a drag or a click goes to a frame. Returns the index of that frame, if there is a drag or a click.
fn scrub(ui: &mut Ui, room: Rect, frames: &FinishedFrames) -> Option<i64> {
    let tokens = Tokens::of(ui);
    let area = room.shrink2(vec2(measure::GAP, 8.0));
    let response = ui.interact(area, ui.scope_id().with("scrub"), Sense::click_and_drag());
    let last = (frames.count() - 1).max(1) as f32;
    let x = |index: usize| area.left() + area.width() * index as f32 / last;
    let y = area.center().y;
    let painter = ui.painter();
    let line = Rect::from_min_max(pos2(area.left(), y - 2.0), pos2(area.right(), y + 2.0));
    painter.rect_filled(line, 2.0, tokens.wid);
    painter.rect_filled(line.with_max_x(x(frames.at())), 2.0, tokens.accent);
    let grip = if response.hovered() || response.dragged() { 7.0 } else { 6.0 };
    painter.circle(pos2(x(frames.at()), y), grip, tokens.text, (1.0, tokens.alt));
    response.widget_info(|| {
        let mut info = WidgetInfo::labeled(Role::Slider, true, "Frames");
        info.current_text_value = Some(format!("{} of {}", frames.at() + 1, frames.count()));
        info
    });
    let at = response.interact_pointer_pos().filter(|_| response.dragged() || response.clicked())?;
    let share = ((at.x - area.left()) / area.width().max(1.0)).clamp(0.0, 1.0);
    Some((share * (frames.count() - 1) as f32).round() as i64)
}
