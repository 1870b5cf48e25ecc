//! What the column at the right of the window (tree and inspector) remembers between passes: what is open, searched,
//! renamed, copied.

use std::collections::BTreeMap;

use egui::{Context, Id};
use impasto_editor_model::{Document, Item};
use impasto_scene::document::StrokeSettings;

#[derive(Clone, Debug, Default)]
pub(super) struct ColumnState {
    /// Whether a section is open, for each that the user opened or folded, or that the command search opened.
    pub(super) sections: BTreeMap<String, bool>,
    /// Whether all sections are open, whatever `sections` says. It is true only for the column that is laid out unseen
    /// to find its controls.
    pub(super) all_open: bool,
    /// Whether the rows under an object are shown, by the object's name, for each object that was opened or folded.
    pub(super) rows: BTreeMap<String, bool>,
    /// The text that is searched for in the tree; none while the search is closed.
    pub(super) search: Option<String>,
    /// What is being renamed, and the new name as typed so far.
    pub(super) renaming: Option<(Item, String)>,
    /// Whether the menu of what can be added opens in the next pass.
    pub(super) opens_add_menu: bool,
    pub(super) copied_strokes: Option<StrokeSettings>,
    /// The layer of paint whose numbers are shown, by its name; none means the layer *body*.
    pub(super) paint_layer: Option<&'static str>,
    /// The item that was active in the previous pass. When another one is active, the tree scrolls to it.
    pub(super) active: Option<Item>,
}

impl ColumnState {
    pub(super) fn with<R>(ctx: &Context, act: impl FnOnce(&mut Self) -> R) -> R {
        ctx.data_mut(|data| act(data.get_temp_mut_or_default(Id::unique("right column"))))
    }

    /// The key of a section in `sections`, by its name: *Pose at frame 37* is one section for all frames, so that it
    /// stays open or folded when the frame changes.
    pub(super) fn key_of(section: &str) -> &str {
        section.split(" at ").next().unwrap_or(section)
    }
}

/// Opens the menu of what can be added, in the head of the tree.
pub fn open_add_menu(ctx: &Context) {
    ColumnState::with(ctx, |state| state.opens_add_menu = true);
}

/// Begins to rename the active item in its row of the tree. Returns whether its name can be changed.
pub fn rename(ctx: &Context, document: &Document) -> bool {
    let active = document.selection().active();
    let named = active
        .filter(|item| matches!(item, Item::Object(_) | Item::Region(_) | Item::Light(_) | Item::Touch(_)));
    ColumnState::with(ctx, |state| {
        state.renaming = named.map(|item| (item.clone(), item.name().to_owned()));
    });
    named.is_some()
}
