//! Distinguishes a press that only closes an open menu from a press that does something.

use egui::{Context, Id, Popup};

fn id() -> Id {
    Id::unique("whether a menu was open when this pass began")
}

/// Notes whether a menu is open. To be called before each pass.
pub(crate) fn note_open_menu(ctx: &Context) {
    let is_open = Popup::is_any_open(ctx);
    ctx.data_mut(|data| data.insert_temp(id(), is_open));
}

/// Whether a press in this pass only closes a menu that was open. Such a press must begin no drag and no stroke. A menu
/// that was open before the pass counts too: if press and release came in one pass, the menu is closed by now.
pub(crate) fn press_closes_menu(ctx: &Context) -> bool {
    ctx.data(|data| data.get_temp::<bool>(id())).unwrap_or_default() || Popup::is_any_open(ctx)
}
