//! The timeline as one strip: transport, frame, ruler, range.

use egui::{
    Align2, Panel, Pos2, Rect, Response, RichText, Role, Sense, Shape, Ui, WidgetInfo, accesskit, pos2, vec2,
};
use impasto_editor_model::keymap::Action;
use impasto_scene::document::{Scene, Timeline};
use impasto_scene::motion;

use super::{Ask, Shown, row, row_from_right, within};
use crate::icons;
use crate::theme::{Tokens, measure, type_face};
use crate::widgets::{self, Button, NumberField, Tip};

/// From the strip's top to the ruler's line, points.
const LINE: f32 = 35.0;
/// Labels stand at least so far apart, points.
const LABELS: f32 = 128.0;
/// Half the width of a key.
const KEY: f32 = 5.5;
/// Frames beyond this are no frames.
const MOST: f64 = 1e6;

/// Takes the lowest 44 points of `ui`.
pub fn strip(ui: &mut Ui, shown: &Shown<'_>, asks: &mut Vec<Ask>) {
    let frame = egui::Frame::new().fill(Tokens::of(ui).alt);
    Panel::bottom("strip").exact_size(measure::STRIP).resizable(false).frame(frame).show(ui, |ui| {
        let whole = ui.max_rect();
        let left = within(ui, whole, row(), |ui| {
            transport(ui, shown, asks);
            ui.min_rect().right()
        });
        let right = within(ui, whole, row_from_right(), |ui| {
            range(ui, shown, asks);
            ui.min_rect().left()
        });
        let across = left + 22.0..=(right - 66.0).max(left + 23.0);
        ruler(ui, Rect::from_x_y_ranges(across, whole.y_range()), (shown, asks));
    });
}

fn transport(ui: &mut Ui, shown: &Shown<'_>, asks: &mut Vec<Ask>) {
    ui.spacing_mut().item_spacing.x = 1.0;
    ui.add_space(7.0);
    for (icon, action) in [
        (icons::FIRST_FRAME, Action::FirstFrame),
        (icons::PREVIOUS_FRAME, Action::StepBack),
        (icons::PLAY, Action::Play),
        (icons::NEXT_FRAME, Action::StepOn),
        (icons::LAST_FRAME, Action::LastFrame),
    ] {
        if action == Action::Play {
            let (at, tokens) = (ui.cursor().min, Tokens::of(ui));
            let top = ui.max_rect().center().y - measure::BUTTON / 2.0;
            let side = vec2(measure::BUTTON, measure::BUTTON);
            ui.painter().rect_filled(Rect::from_min_size(pos2(at.x, top), side), measure::CORNER, tokens.wid);
        }
        let response = widgets::icon_button(ui, icon, action.name());
        let response =
            Tip { name: action.name(), key: &shown.keys_of(action), effect: "", range: "" }.on(response);
        if response.clicked() {
            asks.push(Ask::Act(action));
        }
    }
    ui.add_space(6.0);
    let mut frame = shown.session.frame;
    let field = NumberField::new("Current frame", &mut frame, f64::NEG_INFINITY..=f64::INFINITY);
    if field.unlabelled(52.0).show(ui).changed {
        let frame = frame.clamp(-MOST, MOST);
        asks.push(shown.session_with(|session| session.frame = frame));
    }
}

/// From the right end.
fn range(ui: &mut Ui, shown: &Shown<'_>, asks: &mut Vec<Ask>) {
    ui.spacing_mut().item_spacing.x = measure::GAP;
    ui.add_space(6.0);
    let keys = Button::new("Keys").name("Show keys").icon(icons::KEYS_UP).plain();
    let response = ui.add_enabled_ui(false, |ui| keys.show(ui)).inner;
    response.on_disabled_hover_text("The lanes of keys come with playback");
    let mut looped = shown.session.looped;
    let response = widgets::icon_toggle(ui, icons::LOOP, "Loop", &mut looped);
    let effect = "Playing begins again at the end of the range.";
    if (Tip { name: "Loop", key: "", effect, range: "" }).on(response).changed() {
        asks.push(shown.session_with(|session| session.looped = looped));
    }
    let Timeline { fps, first, last } = &shown.document.scene().timeline;
    for words in [format!("{fps} fps"), format!("{first}\u{2013}{last}")] {
        ui.label(RichText::new(words).font(type_face::small()).color(Tokens::of(ui).weak));
    }
}

/// Where frames stand on the ruler.
#[derive(Clone, Copy)]
struct Across {
    left: f32,
    right: f32,
    first: f64,
    last: f64,
}

impl Across {
    fn x(self, frame: f64) -> f32 {
        let span = (self.last - self.first).max(1.0);
        self.left + (self.right - self.left) * ((frame - self.first) / span) as f32
    }

    /// The whole frame under `x`, within the range.
    fn frame(self, x: f32) -> f64 {
        let span = (self.last - self.first).max(1.0);
        let part = f64::from((x - self.left) / (self.right - self.left));
        (self.first + part * span).round().clamp(self.first, self.last)
    }
}

fn ruler(ui: &mut Ui, rect: Rect, (shown, asks): (&Shown<'_>, &mut Vec<Ask>)) {
    let scene = shown.document.scene();
    let [first, last] = [scene.timeline.first, scene.timeline.last].map(|frame| frame as f64);
    let across = Across { left: rect.left(), right: rect.right(), first, last };
    // The first and the last key can be hit from outside too.
    let response =
        ui.interact(rect.expand2(vec2(8.0, 0.0)), ui.scope_id().with("ruler"), Sense::click_and_drag());
    scrub(&response, across, (shown, asks));

    let clip = ui.painter().with_clip_rect(rect.expand2(vec2(12.0, 0.0)));
    ticks(ui, &clip, (rect, across));
    let reference = across.x(motion::referred_to(scene, &scene.reference).1);
    let tokens = Tokens::of(ui);
    let (top, line) = (rect.top(), rect.top() + LINE);
    clip.vline(reference, top + 16.0..=line, (1.0, tokens.viridian));
    let pin = (icons::REFERENCE.glyph(), type_face::icon(12.0));
    clip.text(pos2(reference, top + 10.0), Align2::CENTER_CENTER, pin.0, pin.1, tokens.viridian);
    for frame in keyed_frames(scene) {
        clip.add(diamond(pos2(across.x(frame), line), tokens.key));
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

/// A press or a drag shows the frame under the pointer; a screen reader may name one.
fn scrub(response: &Response, across: Across, (shown, asks): (&Shown<'_>, &mut Vec<Ask>)) {
    let frame = shown.session.frame;
    response.widget_info(|| {
        let mut info = WidgetInfo::labeled(Role::Slider, true, "Ruler");
        info.value = Some(frame);
        info
    });
    response.ctx.accesskit_node_builder(response.id, |node| {
        node.set_min_numeric_value(across.first);
        node.set_max_numeric_value(across.last);
        node.add_action(accesskit::Action::SetValue);
    });
    let told = response.ctx.input(|input| {
        let asked = input.accesskit_action_requests(response.id, accesskit::Action::SetValue).last();
        asked.and_then(|request| match request.data {
            Some(accesskit::ActionData::NumericValue(value)) => Some(value),
            _ => None,
        })
    });
    let held = response.is_pointer_button_down_on() || response.clicked();
    let pointed = response.interact_pointer_pos().filter(|_| held).map(|at| across.frame(at.x));
    let told = told.filter(|value| value.is_finite()).map(|value| value.clamp(across.first, across.last));
    if let Some(to) = told.or(pointed).filter(|to| *to != frame) {
        asks.push(shown.session_with(|session| session.frame = to));
    }
}

fn ticks(ui: &Ui, painter: &egui::Painter, (rect, across): (Rect, Across)) {
    let tokens = Tokens::of(ui);
    let line = rect.top() + LINE;
    painter.hline(rect.x_range(), line, (1.0, tokens.out));
    let step = label_step((across.last - across.first).max(1.0) / f64::from(rect.width().max(1.0)));
    let half = step / 2.0;
    let begin = (across.first / half).ceil();
    let count = ((across.last - across.first) / half).floor().max(0.0) as usize;
    for index in 0..=count {
        let frame = (begin + index as f64) * half;
        if frame > across.last || (step == 1.0 && frame.fract() != 0.0) {
            continue;
        }
        let (x, labelled) = (across.x(frame), frame.rem_euclid(step) == 0.0);
        let top = if labelled { rect.top() + 19.0 } else { rect.top() + 25.0 };
        painter.vline(x, top..=line, (1.0, tokens.div));
        if labelled {
            let at = pos2(x + 4.0, rect.top() + 22.0);
            painter.text(at, Align2::LEFT_CENTER, format!("{frame}"), type_face::ruler(), tokens.weak);
        }
    }
}

/// Frames between labels, where a point is so many frames: 1, 2 or 5 times a power of ten.
fn label_step(frames_per_point: f64) -> f64 {
    let least = frames_per_point * f64::from(LABELS);
    let power = 10_f64.powf(least.max(1.0).log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0].map(|part| part * power);
    steps.into_iter().find(|step| *step >= least).unwrap_or(steps[3])
}

/// The frames at which anything has a key, in order, each once.
fn keyed_frames(scene: &Scene) -> Vec<f64> {
    let camera = scene.camera.keys.iter().map(|key| key.frame);
    let objects = scene.objects.iter().flat_map(|object| object.keys.iter().map(|key| key.frame));
    let mut frames: Vec<f64> = camera.chain(objects).collect();
    frames.sort_by(f64::total_cmp);
    frames.dedup();
    frames
}

fn diamond(centre: Pos2, colour: egui::Color32) -> Shape {
    let corners = [vec2(0.0, -KEY), vec2(KEY, 0.0), vec2(0.0, KEY), vec2(-KEY, 0.0)];
    Shape::convex_polygon(corners.map(|corner| centre + corner).to_vec(), colour, egui::Stroke::NONE)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_stand_as_far_apart_as_they_need() {
        // 120 frames on a narrow and a wide strip, then a long film and a single second.
        assert_eq!(label_step(119.0 / 786.0), 20.0);
        assert_eq!(label_step(119.0 / 1388.0), 20.0);
        assert_eq!(label_step(10_000.0 / 786.0), 2000.0);
        assert_eq!(label_step(23.0 / 3200.0), 1.0);
    }

    #[test]
    fn a_place_on_the_ruler_and_its_frame_agree() {
        let across = Across { left: 232.0, right: 1018.0, first: -10.0, last: 119.0 };
        for frame in [-10.0, 0.0, 37.0, 119.0] {
            assert_eq!(across.frame(across.x(frame)), frame);
        }
        assert_eq!(across.frame(0.0), -10.0);
        assert_eq!(across.frame(5000.0), 119.0);
        let still = Across { first: 4.0, last: 4.0, ..across };
        assert_eq!(still.frame(600.0), 4.0);
    }
}
