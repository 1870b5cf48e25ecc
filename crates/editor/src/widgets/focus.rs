//! Lets a control say that it keeps the keyboard focus after a click, or that it does not use `Space`.

use egui::{Context, Id};

/// Lets a control that is dragged or clicked in this pass keep the focus, for its arrow keys or for typing.
pub fn keep_focus(ctx: &Context, control: Id) {
    ctx.data_mut(|data| data.insert_temp(kept_id(), Some(control)));
}

/// The control that asked to keep the focus in this pass.
pub(crate) fn take_kept(ctx: &Context) -> Option<Id> {
    ctx.data_mut(|data| data.remove_temp::<Option<Id>>(kept_id())).flatten()
}

/// Says that a control which has the focus uses no `Space`, so that the key does what the keymap says.
pub fn leave_space(ctx: &Context, control: Id) {
    ctx.data_mut(|data| data.insert_temp(space_id(), Some(control)));
}

/// Whether the control that has the focus said that it uses no `Space` ([`leave_space`]).
pub fn leaves_space(ctx: &Context) -> bool {
    let control: Option<Id> = ctx.data(|data| data.get_temp(space_id())).flatten();
    control.is_some() && ctx.memory(|memory| memory.focused()) == control
}

fn space_id() -> Id {
    Id::unique("control that leaves space")
}

fn kept_id() -> Id {
    Id::unique("control that keeps the focus")
}
