//! Draws the lanes of the timeline: names at the left, keys and the curves between them at the right.

use egui::{
    Align2, Color32, Pos2, Rect, Role, Sense, Shape, Stroke, Ui, UiBuilder, WidgetInfo, accesskit, pos2, vec2,
};
use impasto_editor_model::command::{KeyOf, StrokesOf, ease_name};
use impasto_editor_model::keymap::Action;
use impasto_editor_model::timeline::{KeysEvent, Lane, LaneKey, TimelineEvent};
use impasto_editor_model::{Item, Selection};
use impasto_scene::document::Ease;

use super::across::{FrameScale, KEY, diamond, filled};
use super::clicked_lane;
use crate::icons::{self, Icon};
use crate::panels::{Ask, PanelInput, text_width};
use crate::theme::{Tokens, measure, type_face};
use crate::widgets::{self, Tip, ease_line};

/// How far the curve between two keys reaches above and below the middle, in points.
const SWING: f32 = 3.0;

/// How far it may reach from the middle where the ease overshoots, in points.
const MOST_SWING: f32 = 11.0;

/// Where a lane is drawn.
#[derive(Clone, Copy)]
pub(super) struct LaneRow {
    pub(super) rect: Rect,
    /// X at which its name ends and its keys begin.
    pub(super) names: f32,
    pub(super) across: FrameScale,
}

/// The item whose keys these are. `None` for the background and the strokes of the scene: these belong to no item, and
/// their settings show if nothing is selected.
pub(super) fn item(of: &KeyOf) -> Option<Item> {
    match of {
        KeyOf::Camera => Some(Item::Camera),
        KeyOf::Object(name) => Some(Item::Object(name.clone())),
        KeyOf::Light(name) => Some(Item::Light(name.clone())),
        KeyOf::Strokes(StrokesOf::Region(name)) => Some(Item::Region(name.clone())),
        KeyOf::Background | KeyOf::Strokes(StrokesOf::Scene) => None,
    }
}

pub(super) fn is_selected(selection: &Selection, of: &KeyOf) -> bool {
    item(of).is_some_and(|item| selection.contains(&item))
}

fn icon(of: &KeyOf) -> Icon {
    match of {
        KeyOf::Camera => icons::CAMERA,
        KeyOf::Object(_) => icons::OBJECT,
        KeyOf::Light(_) => icons::LIGHT,
        KeyOf::Background => icons::BACKDROP,
        KeyOf::Strokes(_) => icons::REGION,
    }
}

/// The name before the keys: a click selects the item; the camera can be locked to the view.
pub(super) fn name(ui: &mut Ui, row: LaneRow, lane: &Lane, shown: &PanelInput<'_>, asks: &mut Vec<Ask>) {
    let mut rect = row.rect;
    rect.max.x = row.names;
    let tokens = Tokens::of(ui);
    let response = ui.interact(rect, ui.scope_id().with(("lane", &lane.of)), Sense::click());
    let label = format!("Select {}", lane.of.name());
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &label));
    if response.clicked() {
        clicked_lane::note(ui, &lane.of);
        asks.push(Ask::Select(item(&lane.of).map(Selection::only).unwrap_or_default()));
    }
    if response.secondary_clicked() {
        let item = item(&lane.of);
        if !is_selected(shown.document.selection(), &lane.of) {
            asks.push(Ask::Select(item.clone().map(Selection::only).unwrap_or_default()));
        }
        asks.push(Ask::Menu(item));
    }
    if response.hovered() && !is_selected(shown.document.selection(), &lane.of) {
        ui.painter().rect_filled(rect, 0.0, tokens.hov);
    }
    let at = pos2(rect.left() + 20.0, rect.center().y);
    let font = type_face::icon(measure::SMALL_ICON);
    ui.painter().text(at, Align2::CENTER_CENTER, icon(&lane.of).glyph(), font, tokens.weak);
    let mut job =
        egui::text::LayoutJob::simple_singleline(lane.of.name().into_owned(), type_face::body(), tokens.text);
    job.wrap = egui::text::TextWrapping::truncate_at_width((rect.width() - 72.0).max(20.0));
    let galley = ui.painter().layout_job(job);
    let at = pos2(rect.left() + 36.0, rect.center().y - galley.size().y / 2.0);
    ui.painter().galley(at, galley, tokens.text);
    if response.has_focus() {
        let ring = Stroke::new(2.0, tokens.accent_text);
        ui.painter().rect_stroke(rect.shrink(2.0), measure::CORNER, ring, egui::StrokeKind::Inside);
    }
    let end = Rect::from_center_size(pos2(rect.right() - 18.0, rect.center().y), vec2(26.0, 26.0));
    if lane.of == KeyOf::Camera {
        let mut locked = shown.session.lock_to_view;
        let mut ui = ui.new_child(UiBuilder::new().max_rect(end));
        let icon = if locked { icons::LOCKED } else { icons::UNLOCKED };
        let response = widgets::icon_toggle(&mut ui, icon, "Lock to view", &mut locked);
        let effect = "In Animate, moving the view through the shot camera keys the shot.";
        let tip = Tip { name: "Lock to view", key: "", effect, range: "" };
        if tip.on(response).changed() {
            asks.push(shown.session_with(|session| session.lock_to_view = locked));
        }
    } else if lane.locked {
        let font = type_face::icon(measure::SMALL_ICON);
        ui.painter().text(end.center(), Align2::CENTER_CENTER, icons::LOCKED.glyph(), font, tokens.weak);
    }
}

/// The keys of a lane, the curves between them, and what a drag would do.
pub(super) fn keys(ui: &mut Ui, row: LaneRow, lane: &Lane, shown: &PanelInput<'_>, asks: &mut Vec<Ask>) {
    let mut rect = row.rect;
    rect.min.x = row.names;
    let label = format!("{} keys", lane.of.name());
    let list = ui.interact(rect, ui.scope_id().with(("keys", &lane.of)), Sense::hover());
    list.widget_info(|| WidgetInfo::labeled(Role::List, true, &label));
    let tokens = Tokens::of(ui);
    let middle = rect.center().y;
    if lane.keys.is_empty() {
        let at = pos2(row.across.left + 8.0, middle);
        let is_auto = shown.session.auto_key && !lane.locked;
        let words = match (lane.of_shot, is_auto) {
            (true, _) => "moves as the shot has it".to_owned(),
            (false, true) => {
                format!("no keys: move it{}", shown.with_keys_of(Action::SetKey, ", or press {}"))
            }
            (false, false) => format!("no keys{}", shown.with_keys_of(Action::SetKey, ", press {}")),
        };
        ui.painter().text(at, Align2::LEFT_CENTER, words, type_face::small(), tokens.weak);
    }
    let painter = ui.painter().with_clip_rect(rect.intersect(ui.clip_rect()));
    for pair in lane.keys.windows(2) {
        let [from, to] = [0, 1].map(|index| row.across.x(pair[index].frame));
        if to - from > 2.0 * KEY + 4.0 {
            let line = curve([from + KEY + 2.0, to - KEY - 2.0], middle, pair[0].ease);
            painter.line(line, (1.3, tokens.out));
        }
    }
    let hand = &shown.time.keys;
    let dragged = hand.dragged().filter(|dragged| dragged.by != 0.0);
    let replaced: Vec<f64> = hand
        .replaces(std::slice::from_ref(lane))
        .into_iter()
        .filter(|(of, _)| *of == lane.of)
        .map(|(_, frame)| frame)
        .collect();
    for key in &lane.keys {
        let at = pos2(row.across.x(key.frame), middle);
        let is_selected = hand.contains(&lane.of, key.frame);
        let leaves = is_selected && dragged.is_some_and(|dragged| !dragged.copies);
        let is_replaced = replaced.contains(&key.frame);
        let fade = if leaves || is_replaced { 0.35 } else { 1.0 };
        mark(&painter, at, key.ease, tokens.key.gamma_multiply(fade));
        if is_selected && dragged.is_none() {
            painter.add(Shape::closed_line(diamond(at, 10.0), Stroke::new(1.5, tokens.text)));
        }
        if let Some(dragged) = dragged.filter(|_| is_selected) {
            let to = pos2(row.across.x(key.frame + dragged.by), middle);
            mark(&painter, to, key.ease, tokens.key);
            painter.add(Shape::closed_line(diamond(to, 10.0), Stroke::new(1.5, tokens.text)));
        }
        key_node(ui, lane, key, at, &list, is_selected, asks);
    }
    for frame in replaced {
        let at = pos2(row.across.x(frame) + 14.0, middle);
        let words = format!("replaces {frame}");
        let wide = text_width(ui, &words, type_face::small());
        let ground = Rect::from_min_size(at - vec2(4.0, 9.0), vec2(wide + 8.0, 18.0));
        painter.rect_filled(ground, 3.0, tokens.panel);
        painter.text(at, Align2::LEFT_CENTER, words, type_face::small(), tokens.vermilion);
    }
}

/// The accessibility node of a key; a click by a screen reader selects the key.
pub(super) fn key_node(
    ui: &mut Ui,
    lane: &Lane,
    key: &LaneKey,
    at: Pos2,
    list: &egui::Response,
    selected: bool,
    asks: &mut Vec<Ask>,
) {
    let hit = Rect::from_center_size(at, vec2(measure::HIT, measure::HIT));
    let ui = ui.new_child(UiBuilder::new().max_rect(hit).accessibility_parent(list.id));
    let response = ui.interact(hit, list.id.with(key.frame.to_bits()), Sense::hover());
    let label = format!("key at frame {}, {}", key.frame, ease_name(key.ease));
    response.widget_info(|| WidgetInfo::selected(Role::ListItem, true, selected, &label));
    ui.ctx().accesskit_node_builder(response.id, |node| node.add_action(accesskit::Action::Click));
    if ui.input(|input| input.has_accesskit_action_request(response.id, accesskit::Action::Click)) {
        let key = (lane.of.clone(), key.frame);
        asks.push(Ask::Timeline(TimelineEvent::Keys(KeysEvent::Select(key))));
    }
}

fn mark(painter: &egui::Painter, at: Pos2, ease: Ease, colour: Color32) {
    match ease {
        Ease::Linear => drop(painter.circle_filled(at, KEY, colour)),
        Ease::Step => {
            let rect = Rect::from_center_size(at, vec2(2.0 * KEY - 1.0, 2.0 * KEY - 1.0));
            painter.rect_filled(rect, 0.0, colour);
        }
        _ => drop(painter.add(filled(diamond(at, KEY + 1.5), colour))),
    }
}

/// The curve from one key to the next, in the shape of the ease.
fn curve([from, to]: [f32; 2], middle: f32, ease: Ease) -> Vec<Pos2> {
    // A short curve swings less, so that it does not get steep.
    let swing = SWING.min((to - from) / 12.0);
    let mut line = ease_line([from, to], [middle + swing, middle - swing], ease);
    // An overshoot stays within the lane.
    line.iter_mut().for_each(|at| at.y = at.y.clamp(middle - MOST_SWING, middle + MOST_SWING));
    line
}
