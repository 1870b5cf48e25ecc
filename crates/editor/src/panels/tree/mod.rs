//! The scene tree, in which the user finds, selects, renames and moves the parts of a scene. Its rows are camera,
//! lights, objects with their regions, touches and child objects, regions without an object, and canvas.

mod add;
mod drop;
mod rows;

use egui::{Align, Layout, RichText, ScrollArea, Sense, Ui, vec2};
use impasto_editor_model::command::{Command, Edit};
use impasto_editor_model::{Item, Selection};

use super::column_state::ColumnState;
use super::{Ask, PanelInput};
use crate::icons;
use crate::theme::{Tokens, measure, type_face};
use crate::widgets::{self, Tip, TreeRow};
use rows::TreeLine;

pub(super) use add::{additions, entries as add_menu};
pub(super) use rows::region_color;

/// The scene tree. It fills the width and height of `ui`, which has no margins.
pub fn tree(ui: &mut Ui, shown: &PanelInput<'_>, asks: &mut Vec<Ask>) {
    ui.spacing_mut().item_spacing.y = 0.0;
    head(ui, shown, asks);
    let loaded = shown.document.shown();
    let active = shown.document.selection().active();
    let active_changed = ColumnState::with(ui.ctx(), |state| {
        let active_changed = state.active.as_ref() != active;
        if active_changed {
            state.active = active.cloned();
            let above = active.map(|item| rows::above(&loaded.scene, item)).unwrap_or_default();
            state.rows.extend(above.into_iter().map(|name| (name, true)));
        }
        active_changed
    });
    let state = ColumnState::with(ui.ctx(), |state| state.clone());
    let rows = rows::rows(shown.document, &state);
    let output = ScrollArea::vertical().id_salt("tree").auto_shrink(false).show(ui, |ui| {
        let mut placed = Vec::new();
        for row in &rows {
            let rect = match &state.renaming {
                Some((item, typed)) if row.item.as_ref() == Some(item) => {
                    rename_row(ui, row, typed.clone(), asks)
                }
                _ => show_row(ui, row, shown, active_changed, asks),
            };
            placed.push(rect);
        }
        words_below(ui, &rows, &state, loaded.scene.objects.is_empty());
        let below = ui.available_rect_before_wrap();
        if below.is_positive() {
            let below = ui.interact(below, ui.scope_id().with("below the rows"), Sense::click());
            if below.secondary_clicked() {
                asks.push(Ask::Menu(None));
            }
        }
        placed
    });
    drop::drag_and_drop(ui, &loaded.scene, &rows, &output.inner, output.inner_rect, asks);
}

fn head(ui: &mut Ui, shown: &PanelInput<'_>, asks: &mut Vec<Ask>) {
    let search = ColumnState::with(ui.ctx(), |state| state.search.clone());
    ui.horizontal(|ui| {
        ui.set_height(32.0);
        ui.add_space(4.0);
        if let Some(mut text) = search.clone() {
            let room = ui.available_width() - 2.0 * (measure::BUTTON + measure::GAP);
            let edit = egui::TextEdit::singleline(&mut text)
                .id(egui::Id::unique("search in the tree"))
                .hint_text("Search")
                .desired_width(room);
            let response = ui.add(edit);
            response
                .widget_info(|| egui::WidgetInfo::labeled(egui::Role::TextInput, true, "Name to search for"));
            let shut = response.lost_focus()
                && (text.is_empty() || ui.input(|input| input.key_pressed(egui::Key::Escape)));
            ColumnState::with(ui.ctx(), |state| state.search = (!shut).then_some(text));
        } else {
            ui.add_space(8.0);
            ui.label(RichText::new("Scene").font(type_face::head()));
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.add_space(6.0);
            let button = widgets::icon_button(ui, icons::ADD, "Add to scene");
            let tip = Tip { name: "Add", effect: "A mesh, a light or a region.", ..Tip::default() };
            add::menu(&tip.on(button), shown, asks);
            let mut open = search.is_some();
            let button = if open {
                widgets::icon_toggle(ui, icons::SEARCH, "Search scene", &mut open)
            } else {
                widgets::icon_button(ui, icons::SEARCH, "Search scene")
            };
            if button.clicked() {
                let shut = search.is_some();
                ColumnState::with(ui.ctx(), |state| state.search = (!shut).then(String::new));
                if !shut {
                    ui.memory_mut(|memory| {
                        memory.request_focus(egui::Id::unique("search in the tree"));
                    });
                }
            }
        });
    });
}

fn show_row(
    ui: &mut Ui,
    row: &TreeLine,
    shown: &PanelInput<'_>,
    active_changed: bool,
    asks: &mut Vec<Ask>,
) -> egui::Rect {
    let selection = shown.document.selection();
    let selected = match &row.item {
        Some(item) => {
            let of_guide = |active: &Item| match active {
                Item::Guide(region, _) => *item == Item::Region(region.clone()),
                _ => false,
            };
            selection.contains(item) || selection.active().is_some_and(of_guide)
        }
        None => selection.items().is_empty() && !shown.document.scene().objects.is_empty(),
    };
    let drawn = TreeRow {
        name: &row.name,
        spoken: &row.spoken(),
        mark: row.mark,
        depth: row.depth,
        expanded: row.expanded,
        selected,
        note: &row.note,
        keyed: row.keyed,
        hidden: row.hidden,
        locked: row.locked,
    };
    let can_hide = matches!(row.item, Some(Item::Object(_) | Item::Region(_)));
    let answer = if can_hide { drawn.show(ui) } else { drawn.show_bare(ui) };
    let rect = answer.response.rect;
    if drawn.selected && active_changed {
        // With some space above and below, so that the row is clear of the list's faded edges.
        ui.scroll_to_rect(rect.expand2(vec2(0.0, 1.5 * measure::TREE_ROW)), None);
    }
    let Some(item) = &row.item else {
        if answer.response.clicked() {
            asks.push(Ask::Select(Selection::default()));
        } else if answer.response.secondary_clicked() {
            asks.push(Ask::Menu(None));
        }
        return rect;
    };
    if answer.response.secondary_clicked() {
        if !selection.contains(item) {
            asks.push(Ask::Select(Selection::only(item.clone())));
        }
        asks.push(Ask::Menu(Some(item.clone())));
    }
    if answer.toggled {
        let open = row.expanded != Some(true);
        ColumnState::with(ui.ctx(), |state| state.rows.insert(row.name.clone(), open));
    } else if answer.hide_clicked {
        asks.push(Ask::Do(Command::Edit(Edit::SetHidden(vec![item.clone()], !row.hidden))));
    } else if answer.lock_clicked {
        asks.push(Ask::Do(Command::Edit(Edit::SetLocked(vec![item.clone()], !row.locked))));
    } else if answer.response.clicked() {
        let adds = ui.input(|input| input.modifiers.shift || input.modifiers.command);
        let mut wanted = Selection::only(item.clone());
        if adds {
            wanted = selection.clone();
            wanted.toggle(item.clone());
        }
        asks.push(Ask::Select(wanted));
    }
    let named = *item != Item::Camera;
    let f2 = answer.response.has_focus() && ui.input(|input| input.key_pressed(egui::Key::F2));
    if named && (answer.response.double_clicked() || f2) {
        ColumnState::with(ui.ctx(), |state| state.renaming = Some((item.clone(), row.name.clone())));
    }
    drop::begin(&answer.response, item);
    rect
}

/// A row whose name is being typed.
fn rename_row(ui: &mut Ui, row: &TreeLine, mut typed: String, asks: &mut Vec<Ask>) -> egui::Rect {
    let size = vec2(ui.available_width(), measure::TREE_ROW);
    let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
    ui.painter().rect_filled(rect, 0.0, Tokens::of(ui).sel);
    let mut inside = rect.shrink2(vec2(8.0, 1.0));
    inside.min.x += 36.0 + 16.0 * row.depth as f32;
    let mut child = ui.new_child(egui::UiBuilder::new().max_rect(inside));
    let id = egui::Id::unique("name in the tree");
    let fresh = !child.memory(|memory| memory.has_focus(id)) && typed == row.name;
    let edit = egui::TextEdit::singleline(&mut typed).id(id).desired_width(inside.width());
    let response = child.add(edit);
    let name = format!("Rename {}", row.name);
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::TextInput, true, &name));
    if response.lost_focus() {
        let cancelled = ui.input(|input| input.key_pressed(egui::Key::Escape));
        ColumnState::with(ui.ctx(), |state| state.renaming = None);
        if let Some(item) = row.item.clone().filter(|_| !cancelled && typed.trim() != row.name) {
            asks.push(Ask::Do(Command::Edit(Edit::Rename(item, typed))));
        }
        return rect;
    }
    if fresh {
        response.request_focus();
        let mut state = egui::text_edit::TextEditState::load(ui.ctx(), id).unwrap_or_default();
        let all = egui::text::CCursorRange::two(
            egui::text::CCursor::default(),
            egui::text::CCursor::new(egui::text::CharIndex(typed.chars().count())),
        );
        state.cursor.set_char_range(Some(all));
        state.store(ui.ctx(), id);
    }
    ColumnState::with(ui.ctx(), |state| {
        if let Some((_, name)) = &mut state.renaming {
            *name = typed;
        }
    });
    rect
}

/// The words under the rows of an empty scene, or of a search that found nothing.
fn words_below(ui: &mut Ui, rows: &[TreeLine], state: &ColumnState, empty: bool) {
    let words = match &state.search {
        Some(text) if rows.is_empty() => format!("Nothing is named \u{201c}{}\u{201d}.", text.trim()),
        _ if empty => "No objects yet. Drop a mesh anywhere, or press +".to_owned(),
        _ => return,
    };
    let weak = Tokens::of(ui).weak;
    ui.add_space(16.0);
    egui::Frame::new().inner_margin(egui::Margin::symmetric(40, 0)).show(ui, |ui| {
        ui.vertical_centered(|ui| {
            if state.search.is_none() {
                ui.label(RichText::new(icons::OBJECT.glyph()).font(type_face::icon(28.0)).color(weak));
                ui.add_space(8.0);
            }
            ui.label(RichText::new(words).font(type_face::small()).color(weak));
        });
    });
}
