//! The menu that a right click opens on the lanes: what can be done to the keys there, and at that frame.

use egui::containers::menu::menu_style;
use egui::{Id, Popup, PopupAnchor, PopupKind, Pos2, Ui};
use impasto_editor_model::command::{Command, KeyOf, Time, ease_name};
use impasto_editor_model::timeline::{KeyAt, TimelineEvent, eases};
use impasto_scene::document::Ease;

use crate::panels::Ask;
use crate::widgets::{MenuRow, ease_before_row};

/// What the menu is about.
#[derive(Clone, Debug)]
pub(super) struct KeyMenu {
    /// The keys that the menu changes: all selected ones if one of them was clicked, else the key that was clicked. If
    /// the click was between two keys of a lane, the left one of these. Empty if it was before or after all keys.
    pub(super) keys: Vec<KeyAt>,
    /// The ease of the first of them.
    pub(super) ease: Option<Ease>,
    /// Whether a key was hit.
    pub(super) is_on_key: bool,
    /// Where it opens.
    pub(super) at: Pos2,
    /// The frame there.
    pub(super) frame: f64,
    /// The owner of the lane there, if its keys can be changed.
    pub(super) lane: Option<KeyOf>,
}

enum Does {
    Ask(Box<Ask>),
    Copy,
}

impl Does {
    /// The ease that it gives to keys.
    fn ease(&self) -> Option<Ease> {
        match self {
            Self::Ask(ask) => match **ask {
                Ask::Do(Command::Time(Time::SetEase(_, ease))) => Some(ease),
                _ => None,
            },
            Self::Copy => None,
        }
    }
}

impl KeyMenu {
    /// Shows the menu while it is open. Returns the keys if they are to be copied.
    pub(super) fn show(&self, ui: &Ui, id: Id, copied: &[KeyAt], asks: &mut Vec<Ask>) -> Option<Vec<KeyAt>> {
        let popup = Popup::new(id, ui.ctx().clone(), PopupAnchor::Position(self.at), ui.layer_id());
        let popup = popup.kind(PopupKind::Menu).open_memory(None).style(menu_style);
        let chosen = popup.show(|ui| {
            ui.spacing_mut().item_spacing.y = 0.0;
            let rows = self.rows(copied);
            let widths =
                rows.iter().map(|(words, keys, _)| MenuRow { words, keys, ..MenuRow::default() }.width(ui));
            let wide = widths.fold(150.0, f32::max);
            ui.set_width(wide);
            let mut chosen = None;
            for (words, keys, does) in rows {
                let response = MenuRow { words: &words, keys, ..MenuRow::default() }.show(ui);
                if let Some(ease) = does.ease() {
                    ease_before_row(ui, response.rect, ease);
                }
                if response.clicked() {
                    chosen = Some(does);
                    ui.close();
                }
            }
            chosen
        });
        match chosen?.inner? {
            Does::Ask(ask) => {
                asks.push(*ask);
                None
            }
            Does::Copy => Some(self.keys.clone()),
        }
    }

    /// The rows: the words of each, its key on the keyboard, and what it does.
    fn rows(&self, copied: &[KeyAt]) -> Vec<(String, &'static str, Does)> {
        let time = |time: Time| Does::Ask(Box::new(Ask::Do(Command::Time(time))));
        let counted = |count: usize| if count == 1 { "key".to_owned() } else { format!("{count} keys") };
        let frame = self.frame;
        let mut rows = Vec::new();
        if !self.keys.is_empty() {
            rows.extend(eases(self.ease).map(|ease| {
                (format!("Ease {}", ease_name(ease)), "", time(Time::SetEase(self.keys.clone(), ease)))
            }));
        }
        if self.is_on_key {
            let count = counted(self.keys.len());
            rows.push((format!("Copy {count}"), "", Does::Copy));
            rows.push((format!("Delete {count}"), "Delete", time(Time::DeleteKeys(self.keys.clone()))));
        }
        let first = copied.iter().map(|(_, frame)| *frame).min_by(f64::total_cmp);
        if let Some(first) = first.filter(|first| *first != frame) {
            // Keys are pasted into the lane that they were copied from, which may not be the lane of this menu.
            let of = &copied[0].0;
            let is_alone = copied.iter().all(|(other, _)| other == of);
            let of = if is_alone && self.lane.as_ref() != Some(of) {
                format!(" of {}", of.name())
            } else {
                String::new()
            };
            let words = format!("Paste {}{of} at {frame}", counted(copied.len()));
            rows.push((words, "", time(Time::CopyKeys(copied.to_vec(), frame - first))));
        }
        if let Some(lane) = self.lane.as_ref().filter(|_| !self.is_on_key) {
            let words = format!("Key {} at {frame}", lane.name());
            rows.push((words, "", time(Time::SetKey(lane.clone(), frame))));
        }
        let go = Ask::Timeline(TimelineEvent::GoTo(frame));
        rows.push((format!("Go to frame {frame}"), "", Does::Ask(Box::new(go))));
        rows
    }
}
