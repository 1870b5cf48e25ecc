//! The curves of the timeline: for one lane, the progress of its values from key to key, with handles to drag.

use egui::{
    Align2, CursorIcon, EventFilter, Id, Key, PointerButton, Popup, Pos2, Rect, Response, Role, Sense, Shape,
    Stroke, Ui, Vec2, WidgetInfo, pos2, vec2,
};
use impasto_editor_model::command::{Command, Time, ease_name};
use impasto_editor_model::timeline::{KeyAt, Lane, LaneKey, lanes};
use impasto_scene::document::Ease;
use impasto_scene::limits;

use super::across::{FrameScale, KEY, diamond, filled};
use super::clicked_lane;
use super::hand::LaneLayout;
use super::key_menu::KeyMenu;
use super::lanes::{is_selected, item, key_node};
use crate::panels::{Ask, PanelInput};
use crate::theme::{Tokens, measure, type_face};
use crate::widgets::{Tip, ease_line, keep_focus, leave_space};

/// Room above and below the curves, points.
const MARGIN: f32 = 14.0;

/// The arrow keys move a handle by this share of the way from one key to the next, in time or in value; with `Shift`
/// ten times as far.
const STEP: f64 = 0.01;

const HANDLES: [&str; 2] = ["First handle", "Second handle"];

/// Maps frames and shares to the window. A share is a value's progress from one key (0) to the next (1).
#[derive(Clone, Copy)]
struct Plot {
    area: Rect,
    across: FrameScale,
    /// The shares at the bottom and at the top.
    shares: [f64; 2],
}

impl Plot {
    fn y(self, share: f64) -> f32 {
        let [least, most] = self.shares;
        let part = (share - least) / (most - least);
        self.area.bottom() - MARGIN - (self.area.height() - 2.0 * MARGIN) * part as f32
    }

    fn share(self, y: f32) -> f64 {
        let [least, most] = self.shares;
        let part = (self.area.bottom() - MARGIN - y) / (self.area.height() - 2.0 * MARGIN).max(1.0);
        least + (most - least) * f64::from(part)
    }

    /// The place in the window of a point between the keys in frames `from` and `to`: `time` and `share` are 0 at the
    /// first key and 1 at the second.
    fn at(self, [from, to]: [f64; 2], [time, share]: [f64; 2]) -> Pos2 {
        pos2(self.across.x(from + (to - from) * time), self.y(share))
    }

    /// The handle whose place in the window is `at`, brought within its limits.
    fn handle(self, [from, to]: [f64; 2], at: Pos2) -> [f64; 2] {
        kept([(self.across.place(at.x) - from) / (to - from), self.share(at.y)])
    }
}

/// Brings a handle within its limits, and rounds it to thousandths, so that files stay short.
fn kept([time, share]: [f64; 2]) -> [f64; 2] {
    let rounded = |value: f64| (value * 1000.0).round() / 1000.0;
    [rounded(time.clamp(0.0, 1.0)), rounded(share.clamp(*limits::EASE_Y.start(), *limits::EASE_Y.end()))]
}

/// The ease with one handle moved. If both handles then lie where those of a linear ease do, the ease is linear.
fn with_handle(ease: Ease, index: usize, handle: [f64; 2]) -> Ease {
    let mut handles = match ease {
        Ease::Curve(first, second) => [first, second],
        named => named.handles().map(kept),
    };
    handles[index] = kept(handle);
    if handles == Ease::Linear.handles().map(kept) {
        Ease::Linear
    } else {
        Ease::Curve(handles[0], handles[1])
    }
}

#[derive(Clone, Debug)]
struct Drag {
    key: KeyAt,
    handle: usize,
    /// From the pointer to the middle of the handle.
    off: Vec2,
    /// The ease at the press.
    before: Ease,
    /// The shares at the bottom and the top at the press. This scale does not change during the drag.
    shares: [f64; 2],
}

/// What is remembered between passes.
#[derive(Clone, Debug, Default)]
struct Memory {
    /// The key at the left of the segment that was chosen.
    chosen: Option<KeyAt>,
    drag: Option<Drag>,
    menu: Option<KeyMenu>,
}

/// Two neighbouring keys. The ease between them is stored in the left one.
#[derive(Clone, Copy)]
struct Segment {
    left: LaneKey,
    right: LaneKey,
}

impl Segment {
    fn frames(&self) -> [f64; 2] {
        [self.left.frame, self.right.frame]
    }
}

/// The id of the curves, under which their memory is stored.
fn memory_id() -> Id {
    Id::unique("curves of the timeline")
}

fn menu_id(curves: Id) -> Id {
    curves.with("menu")
}

/// The lane whose curves show. This is the lane whose name was clicked last, if its owner is selected or nothing is
/// selected. Otherwise it is the lane of the active item, else the first lane of a selected item, else the first lane
/// with two keys, else the first lane.
fn shown_lane<'a>(ui: &Ui, lanes: &'a [Lane], shown: &PanelInput<'_>) -> Option<&'a Lane> {
    let clicked = clicked_lane::last(ui);
    let selection = shown.document.selection();
    let active = selection.active();
    let by_name = lanes.iter().find(|lane| {
        Some(&lane.of) == clicked.as_ref() && (active.is_none() || is_selected(selection, &lane.of))
    });
    by_name
        .or_else(|| lanes.iter().find(|lane| active.is_some() && item(&lane.of).as_ref() == active))
        .or_else(|| lanes.iter().find(|lane| is_selected(selection, &lane.of)))
        .or_else(|| lanes.iter().find(|lane| lane.keys.len() > 1))
        .or_else(|| lanes.first())
}

/// Shows the curves of one lane where the keys of all lanes would be, and handles what the user does to them.
pub(super) fn curves(ui: &mut Ui, layout: &LaneLayout<'_>, shown: &PanelInput<'_>, asks: &mut Vec<Ask>) {
    let area = layout.area;
    let all = lanes(&shown.document.shown().scene);
    let Some(lane) = shown_lane(ui, &all, shown) else { return };
    let id = memory_id();
    let mut memory = ui.data_mut(|data| data.get_temp::<Memory>(id)).unwrap_or_default();
    let whole = ui.interact(area, id, Sense::click());
    let label = format!("{} curves", lane.of.name());
    whole.widget_info(|| WidgetInfo::labeled(Role::List, true, &label));
    if whole.clicked() || whole.secondary_clicked() {
        choose(&whole, layout, lane, None, &mut memory);
    }
    let segment = chosen_segment(lane, memory.chosen.as_ref(), shown.session.frame);
    let shares = memory.drag.as_ref().map_or_else(|| reach(lane, segment), |drag| drag.shares);
    let plot = Plot { area, across: layout.across, shares };

    draw(ui, plot, lane, segment);
    if lane.keys.len() < 2 {
        let words = if lane.of_shot { "moves as the shot has it" } else { "no two keys to go between" };
        let at = pos2(plot.across.left + 8.0, area.center().y);
        ui.painter().text(at, Align2::LEFT_CENTER, words, type_face::small(), Tokens::of(ui).weak);
    }
    draw_keys(ui, plot, lane, &whole, shown, asks);
    if let Some(segment) = segment {
        draw_now(ui, plot, segment, shown.session.frame);
        if !lane.locked && !lane.of_shot {
            for index in 0..HANDLES.len() {
                let on_handle = Handle { plot, segment, lane, index }.show(ui, &mut memory, asks);
                if on_handle.is_some_and(|response| response.secondary_clicked()) {
                    choose(&whole, layout, lane, Some(segment.left.frame), &mut memory);
                }
            }
        }
    }
    if memory.drag.is_some() && !ui.input(|input| input.pointer.any_down()) {
        // The handle could not end its drag itself, because it no longer shows. Its key may have been deleted, for
        // example.
        memory.drag = None;
        asks.push(Ask::EndPreview);
    }
    if let Some(menu) = &memory.menu {
        menu.show(ui, menu_id(id), &[], asks);
    }
    ui.data_mut(|data| data.insert_temp(id, memory));
}

/// Called while keys or the folded strip are shown instead of curves. Takes back the drag of a handle if a shortcut hid
/// the curves during it.
pub(super) fn leave(ui: &Ui, asks: &mut Vec<Ask>) {
    let id = memory_id();
    let memory = ui.data(|data| data.get_temp::<Memory>(id)).filter(|memory| memory.drag.is_some());
    if let Some(memory) = memory {
        ui.data_mut(|data| data.insert_temp(id, Memory { drag: None, ..memory }));
        asks.push(Ask::EndPreview);
    }
}

/// Chooses the segment that begins at the key in frame `left`, or with `None` the one under the pointer. A right click
/// also opens its menu.
fn choose(whole: &Response, layout: &LaneLayout<'_>, lane: &Lane, left: Option<f64>, memory: &mut Memory) {
    let (at, opens_menu) =
        whole.ctx.input(|input| (input.pointer.interact_pos(), input.pointer.secondary_released()));
    let Some(at) = at else { return };
    let frame = layout.across.place(at.x);
    let Some(left) = lane.left_of(left.unwrap_or(frame)) else { return };
    let key = (lane.of.clone(), left.frame);
    memory.chosen = Some(key.clone());
    if opens_menu {
        memory.menu = Some(KeyMenu {
            keys: vec![key],
            ease: Some(left.ease),
            is_on_key: false,
            at,
            frame: frame.round(),
            lane: (!lane.locked && !lane.of_shot).then(|| lane.of.clone()),
        });
        Popup::open_id(&whole.ctx, menu_id(whole.id));
    }
}

/// The segment that has the handles: the one that was chosen, else the one at the frame, else the first.
fn chosen_segment(lane: &Lane, chosen: Option<&KeyAt>, frame: f64) -> Option<Segment> {
    let starts = &lane.keys[..lane.keys.len().saturating_sub(1)];
    let of_chosen = chosen
        .filter(|(of, _)| *of == lane.of)
        .and_then(|(_, frame)| starts.iter().position(|key| key.frame == *frame));
    let at_frame = || {
        let left = lane.left_of(frame)?;
        starts.iter().position(|key| key.frame == left.frame)
    };
    let index = of_chosen.or_else(at_frame).or((!starts.is_empty()).then_some(0))?;
    Some(Segment { left: lane.keys[index], right: lane.keys[index + 1] })
}

/// The range of shares that holds all curves of a lane, the handles that show, and 0 and 1.
fn reach(lane: &Lane, segment: Option<Segment>) -> [f64; 2] {
    let curves = lane.keys.iter().flat_map(|key| key.ease.reach());
    let handles = segment.into_iter().flat_map(|segment| segment.left.ease.handles()).map(|handle| handle[1]);
    curves.chain(handles).fold([0.0, 1.0], |[least, most], share| [share.min(least), share.max(most)])
}

/// Draws the lines of shares 0 and 1, and the curves.
fn draw(ui: &Ui, plot: Plot, lane: &Lane, chosen: Option<Segment>) {
    let tokens = Tokens::of(ui);
    let painter = ui.painter().with_clip_rect(plot.area);
    for (share, words) in [(0.0, "0"), (1.0, "1")] {
        let y = plot.y(share);
        painter.hline(plot.area.x_range(), y, (1.0, tokens.div));
        let at = pos2(plot.area.left() + 8.0, y);
        let font = type_face::ruler();
        let ground = Rect::from_center_size(at + vec2(3.0, 0.0), vec2(14.0, 12.0));
        painter.rect_filled(ground, 0.0, tokens.app);
        painter.text(at, Align2::LEFT_CENTER, words, font, tokens.weak);
    }
    for pair in lane.keys.windows(2) {
        let [from, to] = [0, 1].map(|index| plot.across.x(pair[index].frame));
        let is_chosen = chosen.is_some_and(|chosen| chosen.left.frame == pair[0].frame);
        let line = ease_line([from, to], [plot.y(0.0), plot.y(1.0)], pair[0].ease);
        let stroke = if is_chosen { Stroke::new(2.0, tokens.text) } else { Stroke::new(1.5, tokens.out) };
        if is_chosen {
            let rect = Rect::from_x_y_ranges(from..=to, plot.area.y_range());
            painter.rect_filled(rect, 0.0, tokens.sel.gamma_multiply(0.35));
        }
        painter.line(line, stroke);
    }
    if let Some(chosen) = chosen {
        let [from, to] = chosen.frames();
        let words = format!("{}, {from} to {to}", ease_name(chosen.left.ease));
        // Below the curves, where no handle is.
        let at = pos2(plot.across.x(from).max(plot.area.left()) + 12.0, plot.area.bottom() + 12.0);
        ui.painter().text(at, Align2::LEFT_CENTER, words, type_face::small(), tokens.weak);
    }
}

/// Draws each key at the beginning of its own curve and at the end of the curve before.
fn draw_keys(
    ui: &mut Ui,
    plot: Plot,
    lane: &Lane,
    whole: &Response,
    shown: &PanelInput<'_>,
    asks: &mut Vec<Ask>,
) {
    let tokens = Tokens::of(ui);
    let painter = ui.painter().with_clip_rect(plot.area);
    let last = lane.keys.len().saturating_sub(1);
    for (index, key) in lane.keys.iter().enumerate() {
        let x = plot.across.x(key.frame);
        let [begin, end] = [0.0, 1.0].map(|share| pos2(x, plot.y(share)));
        if index > 0 && index < last {
            painter.vline(x, end.y..=begin.y, (1.0, tokens.div));
        }
        if index > 0 {
            painter.add(filled(diamond(end, KEY + 1.0), tokens.key));
        }
        if index < last || last == 0 {
            painter.add(filled(diamond(begin, KEY + 1.0), tokens.key));
        }
        let at = if index < last { begin } else { end };
        let is_selected = shown.time.keys.contains(&lane.of, key.frame);
        if is_selected {
            painter.add(Shape::closed_line(diamond(at, 10.0), Stroke::new(1.5, tokens.text)));
        }
        key_node(ui, lane, key, at, whole, is_selected, asks);
    }
}

/// Marks where the value is at the frame that is shown.
fn draw_now(ui: &Ui, plot: Plot, segment: Segment, frame: f64) {
    let [from, to] = segment.frames();
    let time = (frame - from) / (to - from);
    if (0.0..1.0).contains(&time) {
        let at = plot.at([from, to], [time, segment.left.ease.share(time)]);
        ui.painter().with_clip_rect(plot.area).circle_filled(at, 3.5, Tokens::of(ui).accent_text);
    }
}

/// A handle of the chosen segment.
#[derive(Clone, Copy)]
struct Handle<'a> {
    plot: Plot,
    segment: Segment,
    lane: &'a Lane,
    /// 0 for the handle of the left key, 1 for that of the right key.
    index: usize,
}

impl Handle<'_> {
    fn key(&self) -> KeyAt {
        (self.lane.of.clone(), self.segment.left.frame)
    }

    fn set(&self, ease: Ease) -> Command {
        Command::Time(Time::SetEase(vec![self.key()], ease))
    }

    /// Draws its line and its circle, and handles what the user does to it. `None` if it lies outside the plot and no
    /// handle is being dragged.
    fn show(&self, ui: &mut Ui, memory: &mut Memory, asks: &mut Vec<Ask>) -> Option<Response> {
        let Self { plot, segment, lane, index } = *self;
        let [time, share] = segment.left.ease.handles()[index];
        let centre = plot.at(segment.frames(), [time, share]);
        let end = plot.at(segment.frames(), [index as f64; 2]);
        let painter = ui.painter().with_clip_rect(plot.area);
        let tokens = Tokens::of(ui);
        painter.line_segment([end, centre], (1.2, tokens.accent_text));
        let whole = Rect::from_center_size(centre, vec2(measure::HIT, measure::HIT));
        let hit = if memory.drag.is_some() { whole } else { whole.intersect(plot.area) };
        if !hit.is_positive() {
            return None;
        }
        let id = ui.scope_id().with(("handle", &lane.of, segment.left.frame.to_bits(), index));
        let response = ui.interact(hit, id, Sense::click_and_drag()).on_hover_cursor(CursorIcon::Grab);
        let words = format!("{time:.3}, {share:.3}");
        response.widget_info(|| {
            let mut info = WidgetInfo::labeled(Role::Slider, true, HANDLES[index]);
            info.current_text_value = Some(words.clone());
            info
        });
        let radius = if response.hovered() || response.dragged() { 6.5 } else { 5.5 };
        painter.circle(centre, radius, tokens.panel, Stroke::new(2.0, tokens.accent_text));
        if response.has_focus() {
            painter.circle_stroke(centre, 9.5, Stroke::new(2.0, tokens.accent_text));
            leave_space(ui.ctx(), response.id);
        }
        if response.double_clicked() {
            memory.drag = None;
            let ease = with_handle(segment.left.ease, index, Ease::Linear.handles()[index]);
            asks.extend((ease != segment.left.ease).then(|| Ask::Do(self.set(ease))));
        } else {
            self.drag(ui, &response, memory, asks);
            if response.clicked() {
                response.request_focus();
            }
            if response.dragged() || response.drag_stopped() || response.clicked() {
                keep_focus(ui.ctx(), response.id);
            }
            if let Some(moved) = stepped(ui, &response, [time, share], memory.drag.is_some()) {
                let ease = with_handle(segment.left.ease, index, moved);
                asks.push(Ask::DoMerged(self.set(ease), format!("{id:?}")));
            }
        }
        let effect =
            "How the value leaves or reaches a key. A double click straightens it; Esc takes a drag back.";
        Tip { name: HANDLES[index], key: "", effect, range: "" }.on(response.clone());
        Some(response)
    }

    /// Handles a drag, and previews it at once. The drag becomes one entry of the history when the handle is let go.
    fn drag(&self, ui: &Ui, response: &Response, memory: &mut Memory, asks: &mut Vec<Ask>) {
        if response.drag_started_by(PointerButton::Primary) {
            // With the focus, the handle gets Esc before the window does.
            response.request_focus();
            memory.chosen = Some(self.key());
            let centre = self.plot.at(self.segment.frames(), self.segment.left.ease.handles()[self.index]);
            let pressed = ui.input(|input| input.pointer.press_origin()).unwrap_or(centre);
            memory.drag = Some(Drag {
                key: self.key(),
                handle: self.index,
                off: centre - pressed,
                before: self.segment.left.ease,
                shares: self.plot.shares,
            });
        }
        let is_this = |drag: &Drag| drag.key == self.key() && drag.handle == self.index;
        let Some(drag) = memory.drag.clone().filter(is_this) else { return };
        if ui.input(|input| input.key_pressed(Key::Escape)) {
            memory.drag = None;
            ui.ctx().stop_dragging();
            asks.push(Ask::EndPreview);
            return;
        }
        let to = response.interact_pointer_pos().map(|at| {
            let handle = self.plot.handle(self.segment.frames(), at + drag.off);
            // A press without a move does not change the ease.
            let is_moved = handle != kept(drag.before.handles()[self.index]);
            if is_moved { with_handle(drag.before, self.index, handle) } else { drag.before }
        });
        if response.dragged_by(PointerButton::Primary) {
            asks.extend(to.map(|ease| Ask::Preview(self.set(ease))));
        } else {
            memory.drag = None;
            let changed = to.filter(|ease| *ease != drag.before);
            asks.push(changed.map_or(Ask::EndPreview, |ease| Ask::Do(self.set(ease))));
        }
    }
}

/// Where the arrow keys move a handle that has the focus. During a drag, Esc does not end the focus, so that the handle
/// gets Esc and the window does not.
fn stepped(ui: &Ui, response: &Response, [time, share]: [f64; 2], is_dragged: bool) -> Option<[f64; 2]> {
    if !response.has_focus() {
        return None;
    }
    let filter = EventFilter {
        horizontal_arrows: true,
        vertical_arrows: true,
        escape: is_dragged,
        ..EventFilter::default()
    };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, filter));
    let (along, up) = ui.input(|input| {
        let pressed = |key: Key| f64::from(u8::from(input.key_pressed(key)));
        let step = if input.modifiers.shift { 10.0 * STEP } else { STEP };
        let along = pressed(Key::ArrowRight) - pressed(Key::ArrowLeft);
        (along * step, (pressed(Key::ArrowUp) - pressed(Key::ArrowDown)) * step)
    });
    (along != 0.0 || up != 0.0).then(|| kept([time + along, share + up]))
}
