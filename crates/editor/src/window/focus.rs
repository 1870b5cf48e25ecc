//! Decides which keys move egui's focus, and which are the editor's.

use egui::{Context, Event, Id, Key, Modifiers, Plugin, RawInput, Ui};

use crate::widgets::{note_open_menu, take_kept};

/// Keeps egui's keyboard focus from taking the editor's keys: add it to the context as a plugin.
///
/// While nothing has the focus, `Tab` goes to the app ([`tab_pressed`]). While a control has the focus, `Tab` moves it
/// to the next control. A click gives up the focus, so that `Space` presses no button afterwards. Text fields keep it,
/// and so do controls that ask for it ([`crate::widgets::keep_focus`]).
#[derive(Debug, Default)]
pub struct FocusRules;

/// The modifiers of a `Tab` that was pressed in this pass while nothing had the focus.
pub fn tab_pressed(ctx: &Context) -> Option<Modifiers> {
    ctx.data(|data| data.get_temp(tab_id())).flatten()
}

fn tab_id() -> Id {
    Id::unique("tab for the app")
}

impl Plugin for FocusRules {
    fn debug_name(&self) -> &'static str {
        "impasto focus rules"
    }

    fn input_hook(&mut self, ctx: &Context, input: &mut RawInput) {
        note_open_menu(ctx);
        let mut tab = None;
        if ctx.memory(|memory| memory.focused()).is_none() {
            input.events.retain(|event| match event {
                Event::Key { key: Key::Tab, pressed: true, modifiers, .. } => {
                    tab = Some(*modifiers);
                    false
                }
                _ => true,
            });
        }
        ctx.data_mut(|data| data.insert_temp::<Option<Modifiers>>(tab_id(), tab));
    }

    fn on_end_pass(&mut self, ui: &mut Ui) {
        let kept = take_kept(ui.ctx());
        let clicked = ui.input(|input| input.pointer.any_pressed() || input.pointer.any_released());
        if clicked && !ui.ctx().text_edit_focused() {
            ui.memory_mut(|memory| {
                if let Some(focused) = memory.focused().filter(|focused| kept != Some(*focused)) {
                    memory.surrender_focus(focused);
                }
            });
        }
    }
}
