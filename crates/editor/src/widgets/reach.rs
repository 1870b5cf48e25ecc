//! Gives the keyboard focus to a control that is known by its name, for the command search.

use std::sync::Arc;

use egui::{Align, Context, Id, Response, Ui};

/// If the wanted control is not drawn within this many passes, the search for it ends.
const PATIENCE: u8 = 4;

#[derive(Clone)]
struct Wanted {
    name: Arc<str>,
    /// The name of the part that it is in; empty if it comes before the first part.
    part: Arc<str>,
    /// How many passes are left to find it in.
    passes: u8,
    /// Whether its part is being drawn.
    is_here: bool,
}

fn id() -> Id {
    Id::unique("control that is to have the focus")
}

/// Gives the focus to the control `name` in the part `part`, and scrolls to it, the next time it is drawn within
/// [`reachable`].
pub(crate) fn reach(ctx: &Context, part: &str, name: &str) {
    let wanted = Wanted { name: name.into(), part: part.into(), passes: PATIENCE, is_here: false };
    ctx.data_mut(|data| data.insert_temp(id(), wanted));
    ctx.request_repaint();
}

/// Draws contents whose controls [`reach`] can find; [`enter_part`] divides them into parts.
pub(crate) fn reachable<R>(ui: &mut Ui, contents: impl FnOnce(&mut Ui) -> R) -> R {
    enter_part(ui.ctx(), "");
    let shown = contents(ui);
    ui.data_mut(|data| {
        let Some(wanted) = data.get_temp::<Wanted>(id()) else { return };
        let passes = wanted.passes.saturating_sub(1);
        if passes == 0 {
            data.remove::<Wanted>(id());
        } else {
            data.insert_temp(id(), Wanted { passes, is_here: false, ..wanted });
        }
    });
    shown
}

/// Begins a part with a name; the part ends where the next one begins. To be called within [`reachable`].
pub(crate) fn enter_part(ctx: &Context, part: &str) {
    ctx.data_mut(|data| {
        if let Some(wanted) = data.get_temp::<Wanted>(id()) {
            let is_here = *wanted.part == *part;
            data.insert_temp(id(), Wanted { is_here, ..wanted });
        }
    });
}

/// To be called by each control with its name. Gives the control the focus if it is the wanted one.
pub(crate) fn reached(response: &Response, name: &str) {
    let wanted = response.ctx.data(|data| data.get_temp::<Wanted>(id()));
    if wanted.is_some_and(|wanted| wanted.is_here && *wanted.name == *name) {
        response.ctx.data_mut(|data| data.remove::<Wanted>(id()));
        response.request_focus();
        response.scroll_to_me(Some(Align::Center));
    }
}
