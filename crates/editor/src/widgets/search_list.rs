//! A list of rows that a search finds, in a sheet: the arrows move a mark, and Enter takes the marked row.

use egui::{Context, Key, Margin, Modifiers, Response, Role, TextEdit, Ui, WidgetInfo};

use super::dialog::sheet;

/// Which of the keys that move the mark or take its row were pressed in this pass.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct MarkKeys {
    pub(crate) up: bool,
    pub(crate) down: bool,
    pub(crate) enter: bool,
}

impl MarkKeys {
    /// Takes these keys out of the input.
    pub(crate) fn take(ui: &mut Ui) -> Self {
        ui.input_mut(|input| {
            let mut pressed = |key| input.consume_key(Modifiers::NONE, key);
            Self { up: pressed(Key::ArrowUp), down: pressed(Key::ArrowDown), enter: pressed(Key::Enter) }
        })
    }

    /// Whether the mark moves, so that its row has to be in view.
    pub(crate) fn moves(self) -> bool {
        self.up || self.down
    }

    /// The marked row after these keys, of `count` rows.
    pub(crate) fn mark(self, marked: usize, count: usize) -> usize {
        let moved = match self {
            Self { up: true, .. } => marked.saturating_sub(1),
            Self { down: true, .. } => marked + 1,
            _ => marked,
        };
        moved.min(count.saturating_sub(1))
    }
}

/// The field in which the search is typed, as wide as the sheet. `name` is for screen readers.
pub(crate) fn search_field(ui: &mut Ui, typed: &mut String, hint: &str, name: &str) -> Response {
    let field = TextEdit::singleline(typed)
        .hint_text(hint)
        .desired_width(f32::INFINITY)
        .margin(Margin::symmetric(8, 7))
        .show(ui)
        .response
        .response;
    field.widget_info(|| WidgetInfo { label: Some(name.to_owned()), ..WidgetInfo::new(Role::TextInput) });
    field
}

/// A [`sheet`] that remembers `M` while it is open. `contents` returns whether the sheet closes, and so does this
/// function.
pub(crate) fn sheet_with<M: Clone + Default + Send + Sync + 'static>(
    ctx: &Context,
    name: &str,
    width: f32,
    contents: impl FnOnce(&mut Ui, &mut M) -> bool,
) -> bool {
    let id = egui::Id::unique(("memory of a sheet", name));
    let mut memory = ctx.data(|data| data.get_temp::<M>(id)).unwrap_or_default();
    let closes = sheet(ctx, name, width, |ui| contents(ui, &mut memory));
    ctx.data_mut(|data| {
        if closes {
            data.remove::<M>(id);
        } else {
            data.insert_temp(id, memory);
        }
    });
    closes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mark_stays_within_the_rows() {
        let [up, down] = [(true, false), (false, true)].map(|(up, down)| MarkKeys { up, down, enter: false });
        assert_eq!([up.mark(0, 3), up.mark(2, 3), down.mark(1, 3), down.mark(2, 3)], [0, 1, 2, 2]);
        assert_eq!([down.mark(0, 0), MarkKeys::default().mark(7, 3)], [0, 2]);
        assert!(up.moves() && down.moves() && !MarkKeys::default().moves());
    }
}
