//! A field for a number: dragged, typed, or stepped by arrow keys and the wheel.

use std::ops::RangeInclusive;

use egui::accesskit::{Action, ActionData};
use egui::{
    Align2, CornerRadius, CursorIcon, EventFilter, InputState, Key, Rect, Response, Role, Sense, Stroke,
    StrokeKind, Ui, WidgetInfo, pos2, vec2,
};

mod typed;

use self::typed::number_of;
use super::reach::reached;
use super::{Tip, draw};
use crate::icons;
use crate::theme::{Tokens, measure, type_face};

/// The width of the letter before a number, points.
const LETTER: f32 = 11.0;

/// A number in a box whose filled part shows where the number lies in its range.
///
/// It can be dragged, or typed after a click or `Enter`. While the field has the focus, the left and right arrow keys
/// step it, and so does the wheel over it. Without the focus, the wheel steps it only with `Ctrl`, and else scrolls the
/// panel that holds the field. A double click brings the default back. Typed text that is no number, or beyond the
/// limits, is marked and rejected.
pub struct NumberField<'a> {
    name: &'a str,
    value: &'a mut f64,
    range: RangeInclusive<f64>,
    limits: RangeInclusive<f64>,
    /// The words at its left, if any.
    label: Option<&'a str>,
    letter: &'a str,
    unit: &'a str,
    step: f64,
    decimals: usize,
    default: Option<f64>,
    width: Option<f32>,
    error: Option<&'a str>,
    refused: Option<&'a dyn Fn(f64) -> Option<String>>,
    reads: Option<Read<'a>>,
    warns: bool,
    centred: bool,
    tip: Tip<'a>,
}

/// Reads a number from what was typed.
type Read<'a> = &'a dyn Fn(&str) -> Option<f64>;

/// What the user did to a [`NumberField`]. What lies between `began` and `ended` is one step to undo.
#[derive(Clone, Debug)]
pub struct FieldResponse {
    /// The box.
    pub response: Response,
    /// The value has changed.
    pub changed: bool,
    /// In this pass a drag began, typing ended without `Esc`, or there was a step or a reset.
    pub began: bool,
    /// In this pass a drag ended, typing ended without `Esc`, or there was a step or a reset.
    pub ended: bool,
    /// In this pass the wheel, an arrow key or a screen reader stepped or set the value.
    pub stepped: bool,
    /// The change came from the reset icon or from a double click.
    pub reset: bool,
}

/// What a field remembers between passes.
#[derive(Clone, Debug, Default)]
struct Memory {
    /// The number as it is typed.
    typed: Option<String>,
    /// While it is dragged: the value at the press, and the value before rounding.
    dragged: Option<(f64, f64)>,
    /// Points scrolled since the last step.
    scrolled: f32,
}

impl<'a> NumberField<'a> {
    /// A field named `name` with its label at the left. The ends of `range` may be infinite.
    pub fn new(name: &'a str, value: &'a mut f64, range: RangeInclusive<f64>) -> Self {
        Self {
            name,
            value,
            limits: range.clone(),
            range,
            label: Some(name),
            letter: "",
            unit: "",
            step: 1.0,
            decimals: 0,
            default: None,
            width: None,
            error: None,
            refused: None,
            reads: None,
            warns: false,
            centred: false,
            tip: Tip::default(),
        }
    }

    /// Shows these words as the label, for a name that is too long to be the label itself.
    pub fn label(self, words: &'a str) -> Self {
        Self { label: Some(words), ..self }
    }

    /// Leaves out the label, so that only screen readers say the name. The box is `width` points wide.
    pub fn unlabelled(self, width: f32) -> Self {
        Self { label: None, width: Some(width), ..self }
    }

    /// The range for typing, the wheel and the arrow keys, where it is larger than the range of a drag.
    pub fn limits(self, limits: RangeInclusive<f64>) -> Self {
        Self { limits, ..self }
    }

    /// A letter in the box before the number: X, Y, Z.
    pub fn letter(self, letter: &'a str) -> Self {
        Self { letter, ..self }
    }

    /// The unit at the box's right end: `px`, `°`, `%`, `×`.
    pub fn unit(self, unit: &'a str) -> Self {
        Self { unit, ..self }
    }

    /// How far one step of the wheel or an arrow key goes, and how many decimals are shown and kept.
    pub fn step(self, step: f64, decimals: usize) -> Self {
        Self { step, decimals, ..self }
    }

    /// The value that a double click brings back. In a field with a label, so does the reset icon at the row's end.
    pub fn default_value(self, default: f64) -> Self {
        Self { default: Some(default), ..self }
    }

    /// What is wrong with the value. The box gets a vermilion outline. If the field has a label, the words stand under
    /// the box.
    pub fn error(self, error: Option<&'a str>) -> Self {
        Self { error, ..self }
    }

    /// Lets `why` refuse a typed number that is within the limits: it returns the reason, or `None` to accept it.
    pub fn refused(self, why: &'a dyn Fn(f64) -> Option<String>) -> Self {
        Self { refused: Some(why), ..self }
    }

    /// Makes `reads` read the typed text, for a field that accepts more than one unit.
    pub fn reading(self, reads: &'a dyn Fn(&str) -> Option<f64>) -> Self {
        Self { reads: Some(reads), ..self }
    }

    /// Puts the number in the middle of its box.
    pub fn centred(self) -> Self {
        Self { centred: true, ..self }
    }

    /// If `warns`, shows the number in ochre: it belongs to a pose that is not keyed, and will be lost.
    pub fn warn(self, warns: bool) -> Self {
        Self { warns, ..self }
    }

    /// What the tooltip says; its range and default are filled in.
    pub fn tip(self, key: &'a str, effect: &'a str) -> Self {
        let tip = Tip { name: self.name, key, effect, range: "" };
        Self { tip, ..self }
    }

    /// Draws it.
    pub fn show(mut self, ui: &mut Ui) -> FieldResponse {
        let before = *self.value;
        let (row, frame) = self.place(ui);
        let response = ui.interact(frame, ui.next_auto_id().with(self.name), Sense::click_and_drag());
        ui.skip_ahead_auto_ids(1);
        let id = response.id;
        let mut memory = ui.data_mut(|data| data.get_temp::<Memory>(id)).unwrap_or_default();
        let (mut began, mut ended, mut was_step) = (false, false, false);

        let mut editor = None;
        let mut reset = false;
        if memory.typed.is_some() && self.is_double_clicked(ui, id, frame) {
            memory.typed = None;
            reset = true;
        } else if memory.typed.is_some() {
            let (done, cancelled) = self.type_in(ui, id, frame, &mut memory, &mut editor);
            began |= done && !cancelled;
            ended |= done && !cancelled;
        } else {
            let stepped = self.step_by_keys(ui, &response) + self.step_by_wheel(ui, &response, &mut memory);
            if stepped != 0.0 {
                self.set(before + stepped * self.step);
            }
            let spoken = self.set_by_screen_reader(ui, &response);
            was_step = stepped != 0.0 || spoken;
            began |= was_step;
            ended |= was_step;
            let (drag_began, drag_ended) = self.drag(ui, &response, &mut memory);
            began |= drag_began;
            ended |= drag_ended;
            let enter = response.has_focus() && ui.input(|input| input.key_pressed(Key::Enter));
            if response.clicked() || enter {
                memory.typed = Some(self.shown());
                memory.dragged = None;
            }
            if response.clicked() {
                self.type_in(ui, id, frame, &mut memory, &mut editor);
            }
        }
        reset |= self.reset(ui, row);
        began |= reset;
        ended |= reset;
        if editor.is_none() {
            self.draw(ui, &response, frame);
        }
        ui.data_mut(|data| data.insert_temp(id, memory));
        let changed = *self.value != before;
        let response = self.describe(response.on_hover_cursor(CursorIcon::ResizeHorizontal), changed);
        FieldResponse { response, changed, began, ended, stepped: was_step, reset }
    }

    /// Takes up the row, and draws the label and the error in it. Returns the row, and the box in it.
    fn place(&self, ui: &mut Ui) -> (Rect, Rect) {
        let Some(label) = self.label else {
            let width = self.width.unwrap_or(78.0);
            let (row, _) = ui.allocate_exact_size(vec2(width, measure::FIELD), Sense::hover());
            return (row, row);
        };
        let below = if self.error.is_some() { 18.0 } else { 0.0 };
        let size = vec2(ui.available_width(), measure::FIELD + below);
        let (mut row, _) = ui.allocate_exact_size(size, Sense::hover());
        let tokens = Tokens::of(ui);
        row.set_height(measure::FIELD);
        let mut frame = row;
        frame.min.x += measure::LABEL;
        frame.max.x = (frame.max.x - measure::ROW_END).max(frame.min.x + 48.0);
        let room = measure::LABEL - measure::GAP;
        // The unit stands in the box, so the label leaves it out.
        let label = label.strip_suffix(self.unit).map_or(label, str::trim_end);
        draw::words_within(ui, row.left_center(), label, type_face::body(), tokens.weak, room);
        if let Some(error) = self.error {
            let at = pos2(frame.left(), row.bottom() + 10.0);
            let room = row.right() - frame.left();
            draw::words_within(ui, at, error, type_face::small(), tokens.vermilion, room);
        }
        (row, frame)
    }

    fn step_by_keys(&self, ui: &Ui, response: &Response) -> f64 {
        if !response.has_focus() {
            return 0.0;
        }
        let filter = EventFilter { horizontal_arrows: true, ..EventFilter::default() };
        ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
        ui.input(|input| {
            let up = input.num_presses(Key::ArrowRight) as f64;
            up - input.num_presses(Key::ArrowLeft) as f64
        })
    }

    fn step_by_wheel(&self, ui: &Ui, response: &Response, memory: &mut Memory) -> f64 {
        const POINTS_A_STEP: f32 = 40.0;
        let (is_under_pointer, has_focus) = (response.hovered(), response.has_focus());
        let scrolled = is_under_pointer.then(|| ui.input_mut(|input| scrolled(input, has_focus)));
        let Some(scrolled) = scrolled.flatten() else {
            memory.scrolled = 0.0;
            return 0.0;
        };
        memory.scrolled += scrolled;
        let steps = (memory.scrolled / POINTS_A_STEP).round();
        memory.scrolled -= steps * POINTS_A_STEP;
        f64::from(steps)
    }

    fn set_by_screen_reader(&mut self, ui: &Ui, response: &Response) -> bool {
        let before = *self.value;
        let (up, down, told) = ui.input(|input| {
            let told = input.accesskit_action_requests(response.id, Action::SetValue).last();
            (
                input.num_accesskit_action_requests(response.id, Action::Increment) as f64,
                input.num_accesskit_action_requests(response.id, Action::Decrement) as f64,
                told.and_then(|request| request.data.clone()),
            )
        });
        if up != down {
            self.set(before + (up - down) * self.step);
        }
        match told {
            Some(ActionData::NumericValue(value)) => self.set(value),
            Some(ActionData::Value(text)) => {
                if let Some(number) = self.read(&text) {
                    self.set(number);
                }
            }
            _ => (),
        }
        *self.value != before
    }

    fn drag(&mut self, ui: &Ui, response: &Response, memory: &mut Memory) -> (bool, bool) {
        let began = response.drag_started();
        if began {
            memory.dragged = Some((*self.value, *self.value));
        }
        if let Some((from, raw)) = &mut memory.dragged {
            let fine = if ui.input(|input| input.modifiers.shift) { 0.1 } else { 1.0 };
            let span = self.range.end() - self.range.start();
            let per_point =
                if span.is_finite() { span / f64::from(response.rect.width()) } else { self.step };
            *raw += f64::from(response.drag_delta().x) * per_point * fine;
            // A value typed beyond the range stays until the drag brings it back.
            *raw = raw.clamp(self.range.start().min(*from), self.range.end().max(*from));
            let (from, raw) = (*from, *raw);
            self.set(raw);
            if ui.input(|input| input.key_pressed(Key::Escape)) {
                *self.value = from;
                memory.dragged = None;
                ui.ctx().stop_dragging();
                return (began, true);
            }
        }
        let ended = response.drag_stopped() && memory.dragged.take().is_some();
        (began, ended)
    }

    fn reset(&mut self, ui: &mut Ui, row: Rect) -> bool {
        let Some(default) =
            self.default.filter(|default| self.label.is_some() && self.text_of(*default) != self.shown())
        else {
            return false;
        };
        let centre = pos2(row.right() - measure::ROW_END / 2.0 + 4.0, row.center().y);
        let hit = Rect::from_center_size(centre, vec2(measure::HIT, measure::HIT));
        let name = format!("Reset {}", self.name);
        let response = ui.interact(hit, ui.scope_id().with(&name), Sense::click());
        let tokens = Tokens::of(ui);
        let colour = if response.hovered() { tokens.text } else { tokens.weak };
        draw::icon(ui.painter(), centre, icons::UNDO, 14.0, colour);
        draw::focus_ring(ui, &response, hit, measure::CORNER);
        draw::named(&response, Role::Button, &name);
        if response.clicked() {
            *self.value = default;
        }
        response.clicked()
    }

    fn draw(&self, ui: &Ui, response: &Response, frame: Rect) {
        let tokens = Tokens::of(ui);
        let painter = ui.painter();
        painter.rect_filled(frame, draw::corner(), tokens.field);
        let (least, most) = (*self.range.start(), *self.range.end());
        let part = if (most - least).is_finite() { (*self.value - least) / (most - least) } else { 0.0 };
        if part > 0.0 {
            let mut filled = frame;
            filled.set_width(frame.width() * part.min(1.0) as f32);
            let right =
                if filled.right() > frame.right() - measure::CORNER { measure::CORNER as u8 } else { 0 };
            let left = measure::CORNER as u8;
            painter.rect_filled(
                filled,
                CornerRadius { nw: left, sw: left, ne: right, se: right },
                tokens.sel,
            );
        }
        let line = if self.error.is_some() {
            Stroke::new(1.0, tokens.vermilion)
        } else if response.hovered() || response.dragged() {
            Stroke::new(1.0, tokens.out)
        } else {
            Stroke::NONE
        };
        painter.rect_stroke(frame, draw::corner(), line, StrokeKind::Inside);
        let colour = if self.warns { tokens.ochre } else { tokens.text };
        let mut at = frame.left_center() + vec2(8.0, 0.0);
        self.draw_letter(ui, frame);
        if !self.letter.is_empty() {
            at.x += LETTER;
        }
        let (at, align) =
            if self.centred { (frame.center(), Align2::CENTER_CENTER) } else { (at, Align2::LEFT_CENTER) };
        draw::words(painter, at, align, &self.shown(), type_face::number(), colour);
        let end = frame.right_center() - vec2(8.0, 0.0);
        draw::words(painter, end, Align2::RIGHT_CENTER, self.unit, type_face::small(), tokens.weak);
        draw::focus_ring(ui, response, frame, measure::CORNER);
    }

    fn draw_letter(&self, ui: &Ui, frame: Rect) {
        let (at, weak) = (frame.left_center() + vec2(8.0, 0.0), Tokens::of(ui).weak);
        draw::words(ui.painter(), at, Align2::LEFT_CENTER, self.letter, type_face::small(), weak);
    }

    fn describe(&self, mut response: Response, changed: bool) -> Response {
        if changed {
            response.mark_changed();
        }
        let (value, name) = (*self.value, self.name);
        reached(&response, name);
        response.widget_info(|| {
            let mut info = WidgetInfo::labeled(Role::SpinButton, response.enabled(), name);
            info.value = Some(value);
            info
        });
        let (least, most, step) = (*self.range.start(), *self.range.end(), self.step);
        let spoken = format!("{}{}", self.shown(), self.unit);
        response.ctx.accesskit_node_builder(response.id, |node| {
            node.add_action(Action::Increment);
            node.add_action(Action::Decrement);
            node.add_action(Action::SetValue);
            node.set_value(spoken);
            node.set_numeric_value_step(step);
            if (most - least).is_finite() {
                node.set_min_numeric_value(least);
                node.set_max_numeric_value(most);
            }
        });
        if self.tip.effect.is_empty() {
            return response;
        }
        let mut range = String::new();
        if (most - least).is_finite() {
            range = format!("{} to {}", self.text_of(least), self.text_of(most));
        }
        if let Some(default) = self.default {
            range = format!("{range}, default {}", self.text_of(default));
        }
        let range = [range.trim_start_matches(", "), "Ctrl and the wheel change it."];
        let range = if range[0].is_empty() { range[1].to_owned() } else { range.join(". ") };
        Tip { range: &range, ..self.tip }.on(response)
    }

    fn read(&self, typed: &str) -> Option<f64> {
        let number = self.reads.map_or_else(|| number_of(typed, self.unit), |read| read(typed));
        number.filter(|number| number.is_finite())
    }

    fn set(&mut self, value: f64) {
        let shift = 10_f64.powi(self.decimals as i32);
        let value = (value * shift).round() / shift;
        *self.value = value.clamp(*self.limits.start(), *self.limits.end());
    }

    fn shown(&self) -> String {
        self.text_of(*self.value)
    }

    fn text_of(&self, value: f64) -> String {
        let text = format!("{value:.*}", self.decimals);
        text.strip_prefix('-').map_or(text.clone(), |rest| format!("\u{2212}{rest}"))
    }
}

/// How far the wheel turned for the field, in points; `None` if the turn scrolls the panel that holds the field.
fn scrolled(input: &mut InputState, has_focus: bool) -> Option<f32> {
    if input.modifiers.command {
        // With Ctrl, egui turns the wheel into a zoom factor: exp(points * `scroll_zoom_speed`).
        return Some(input.zoom_delta().ln() / egui::InputOptions::default().scroll_zoom_speed);
    }
    // Consumed, so that the panel does not scroll as well.
    has_focus.then(|| std::mem::take(&mut input.smooth_scroll_delta).y)
}
