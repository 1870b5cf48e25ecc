//! Selects and moves keys by the pointer over the timeline's lanes. The pointer's events are handled one by one, so
//! that none is lost when several come in one pass.

use egui::{Event, PointerButton, Popup, Pos2, Rect, Ui};
use impasto_editor_model::timeline::{KeyAt, KeysEvent, Lane, LanePosition, TimelineEvent};

use super::across::FrameScale;
use super::key_menu::KeyMenu;
use crate::panels::{Ask, PanelInput};
use crate::theme::measure;
use crate::widgets::press_closes_menu;

/// Where the lanes lie in the window.
#[derive(Clone, Copy)]
pub(super) struct LaneLayout<'a> {
    /// The visible part of the lanes, without their names.
    pub(super) area: Rect,
    /// Y of the top of the first lane.
    pub(super) top: f32,
    /// Height of a lane.
    pub(super) lane: f32,
    pub(super) across: FrameScale,
    pub(super) lanes: &'a [Lane],
}

impl LaneLayout<'_> {
    fn place(&self, at: Pos2) -> LanePosition {
        let y = at.y - self.top;
        // A place above the first lane counts as in the first lane.
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

/// What is remembered between passes.
#[derive(Clone, Debug, Default)]
struct Memory {
    down: bool,
    /// The menu that was opened last.
    menu: Option<KeyMenu>,
    copied: Vec<KeyAt>,
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
    let closes_menu = press_closes_menu(&ctx);
    for event in ui.input(|input| input.events.clone()) {
        match event {
            Event::PointerMoved(at) if memory.down || follows && over(at) => {
                tell(KeysEvent::Move(layout.place(at)));
            }
            Event::PointerButton { pos, button: PointerButton::Primary, pressed, modifiers } => {
                if pressed && over(pos) && !closes_menu {
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
                let key = layout.key(pos);
                let is_selected = |key: &&KeyAt| shown.time.keys.contains(&key.0, key.1);
                if let Some(key) = key.as_ref().filter(|key| !is_selected(key)) {
                    tell(KeysEvent::Select(key.clone()));
                }
                memory.menu = Some(key_menu(layout, pos, key, shown));
                Popup::open_id(&ctx, id);
            }
            Event::WindowFocused(false) if memory.down || follows => {
                memory.down = false;
                tell(KeysEvent::Cancel);
            }
            _ => {}
        }
    }
    if let Some(menu) = &memory.menu
        && let Some(copied) = menu.show(ui, id, &memory.copied, asks)
    {
        memory.copied = copied;
    }
    ui.data_mut(|data| data.insert_temp(id, memory));
}

/// The last key at or before a place on a lane; `None` before the first key, and from the last key on.
fn between(layout: &LaneLayout<'_>, at: Pos2) -> Option<KeyAt> {
    let place = layout.place(at);
    let lane = layout.lanes.get(place.lane)?;
    Some((lane.of.clone(), lane.left_of(place.frame)?.frame))
}

/// What the menu at a place of the lanes is about.
fn key_menu(layout: &LaneLayout<'_>, at: Pos2, key: Option<KeyAt>, shown: &PanelInput<'_>) -> KeyMenu {
    let place = layout.place(at);
    let lane = layout.lanes.get(place.lane).filter(|lane| !lane.locked && !lane.of_shot);
    let frame = key.as_ref().map_or(place.frame.round(), |key| key.1);
    let keys = match &key {
        Some(key) if shown.time.keys.contains(&key.0, key.1) => shown.time.keys.selected().to_vec(),
        Some(key) => vec![key.clone()],
        None => between(layout, at).into_iter().collect(),
    };
    let ease_of = |(of, frame): &KeyAt| {
        let lane = layout.lanes.iter().find(|lane| lane.of == *of)?;
        lane.keys.iter().find(|key| key.frame == *frame).map(|key| key.ease)
    };
    let ease = keys.first().and_then(ease_of);
    KeyMenu { keys, ease, is_on_key: key.is_some(), at, frame, lane: lane.map(|lane| lane.of.clone()) }
}
