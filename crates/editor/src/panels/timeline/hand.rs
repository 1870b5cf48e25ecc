//! Selects and moves keys by the pointer over the timeline's lanes. Its events are handled one by one, so that none is
//! lost when several come in one pass.

use egui::{Event, Id, PointerButton, Popup, PopupAnchor, Pos2, Rect, Ui};
use impasto_editor_model::command::ease_name;
use impasto_editor_model::command::{Command, Time};
use impasto_editor_model::timeline::{KeyAt, KeysEvent, Lane, LanePosition, TimelineEvent};
use impasto_scene::document::Ease;

use super::across::FrameScale;
use crate::panels::{Ask, PanelInput};
use crate::theme::measure;
use crate::widgets::MenuRow;

/// Where the lanes lie in the window.
#[derive(Clone, Copy)]
pub(super) struct LaneLayout<'a> {
    /// The visible part of the lanes.
    pub(super) area: Rect,
    /// Top of the first lane.
    pub(super) top: f32,
    /// Height of a lane.
    pub(super) lane: f32,
    /// Maps frames to the window.
    pub(super) across: FrameScale,
    /// The lanes.
    pub(super) lanes: &'a [Lane],
}

impl LaneLayout<'_> {
    fn place(&self, at: Pos2) -> LanePosition {
        let y = at.y - self.top;
        // A place above the first lane counts as in the first.
        let lane = (y / self.lane).floor().max(0.0) as usize;
        LanePosition { x_px: f64::from(at.x), y_px: f64::from(y), frame: self.across.place(at.x), lane }
    }

    /// The key under the pointer: the nearest of the lane, if it is near enough.
    fn key(&self, at: Pos2) -> Option<KeyAt> {
        let lane = self.lanes.get(self.place(at).lane)?;
        let distance = |frame: f64| (self.across.x(frame) - at.x).abs();
        let near = lane.keys.iter().map(|key| key.frame);
        let nearest = near.min_by(|a, b| distance(*a).total_cmp(&distance(*b)))?;
        (distance(nearest) <= measure::HIT / 2.0).then(|| (lane.of.clone(), nearest))
    }
}

/// What the pointer remembers between passes.
#[derive(Clone, Debug, Default)]
struct Memory {
    down: bool,
    /// The open menu: the keys that it changes, whether the pointer hit one of them (or only the space behind it), and
    /// where it opens.
    menu: Option<(Vec<KeyAt>, bool, Pos2)>,
}

/// Turns the pointer's events into events of the timeline.
pub(super) fn hand(ui: &mut Ui, layout: &LaneLayout<'_>, shown: &PanelInput<'_>, asks: &mut Vec<Ask>) {
    let id = ui.scope_id().with("lanes hand");
    let layer = ui.layer_id();
    let ctx = ui.ctx().clone();
    let over = |at| layout.area.contains(at) && ctx.layer_id_at(at).is_none_or(|found| found == layer);
    let mut memory = ui.data_mut(|data| data.get_temp::<Memory>(id)).unwrap_or_default();
    let mut tell = |event| asks.push(Ask::Timeline(TimelineEvent::Keys(event)));
    let follows = shown.time.keys.follows();
    for event in ui.input(|input| input.events.clone()) {
        match event {
            Event::PointerMoved(at) if memory.down || follows && over(at) => {
                tell(KeysEvent::Move(layout.place(at)));
            }
            Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers } => {
                if pressed && over(pos) {
                    memory.down = true;
                    let adds = modifiers.shift || modifiers.command;
                    tell(KeysEvent::Press { at: layout.place(pos), key: layout.key(pos), adds });
                } else if !pressed && std::mem::take(&mut memory.down) {
                    tell(KeysEvent::Release);
                }
            }
            Event::PointerButton { pos, button: PointerButton::Secondary, pressed: true, .. }
                if over(pos) =>
            {
                if memory.down || follows {
                    memory.down = false;
                    tell(KeysEvent::Cancel);
                    continue;
                }
                let keys = match layout.key(pos) {
                    Some(key) if shown.time.keys.contains(&key.0, key.1) => {
                        Some((shown.time.keys.selected().to_vec(), true))
                    }
                    Some(key) => Some((vec![key], true)),
                    None => between(layout, pos).map(|key| (vec![key], false)),
                };
                memory.menu = keys.map(|(keys, hit)| (keys, hit, pos));
                if memory.menu.is_some() {
                    Popup::open_id(&ctx, id);
                }
            }
            Event::WindowFocused(false) if memory.down || follows => {
                memory.down = false;
                tell(KeysEvent::Cancel);
            }
            _ => {}
        }
    }
    if let Some((keys, hit, at)) = &memory.menu {
        menu(ui, id, *at, keys, *hit, asks);
    }
    ui.data_mut(|data| data.insert_temp(id, memory));
}

/// The left one of the two keys that a place lies between.
fn between(layout: &LaneLayout<'_>, at: Pos2) -> Option<KeyAt> {
    let place = layout.place(at);
    let lane = layout.lanes.get(place.lane)?;
    Some((lane.of.clone(), lane.left_of(place.frame)?.frame))
}

/// The menu of eases, with *Delete* where a key was hit.
fn menu(ui: &Ui, id: Id, at: Pos2, keys: &[KeyAt], hit: bool, asks: &mut Vec<Ask>) {
    let anchor = PopupAnchor::Position(at);
    let popup = Popup::new(id, ui.ctx().clone(), anchor, ui.layer_id());
    popup.kind(egui::PopupKind::Menu).open_memory(None).width(150.0).show(|ui| {
        for ease in [Ease::Smooth, Ease::Linear, Ease::Step] {
            let words = format!("Ease {}", ease_name(ease));
            if (MenuRow { words: &words, ..MenuRow::default() }).show(ui).clicked() {
                asks.push(Ask::Do(Command::Time(Time::SetEase(keys.to_vec(), ease))));
                ui.close();
            }
        }
        if hit {
            let words = if keys.len() == 1 { "Delete key" } else { "Delete keys" };
            if (MenuRow { words, keys: "Delete", ..MenuRow::default() }).show(ui).clicked() {
                asks.push(Ask::Do(Command::Time(Time::DeleteKeys(keys.to_vec()))));
                ui.close();
            }
        }
    });
}
