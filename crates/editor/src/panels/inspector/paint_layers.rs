//! The section *Paint layers* of the inspector: a list of the layers of paint, with the one that is laid last at the
//! top, and under the list the numbers of the selected layer.

use egui::{Align, Layout, Rect, Response, Ui, UiBuilder};
use impasto_editor_model::command::StrokeChange;
use impasto_scene::document::{LayerNumber, LayerSettings, Style};
use impasto_scene::presets::{self, LayerKind};

use super::Asker;
use super::brushes::{self, BrushRow};
use super::edited_strokes::EditedStrokes;
use super::layer_numbers::{EditedLayer, shown};
use super::number::Number;
use super::parts::{is_wide, note, reset, row, section, seen};
use crate::icons;
use crate::panels::brush_thumbnails::thumbnail;
use crate::panels::column_state::ColumnState;
use crate::theme::{Tokens, measure};
use crate::widgets::{self, LayerRow, Tip};

/// Width of the field with a layer's opacity, points.
const OPACITY: f32 = 52.0;

/// The layers of a region, or with `region: None` those of the scene and the ground under them.
pub(super) fn section_of(ui: &mut Ui, asker: &mut Asker<'_, '_>, region: Option<&str>) {
    let Some(place) = EditedStrokes::new(asker, region) else { return };
    let open_at_first = region.is_none() || is_wide(ui);
    section(ui, "Paint layers", "", open_at_first, |ui| {
        let order = presets::laying_order(asker.scene());
        list(ui, asker, &place, order);
        ui.add_space(4.0);
        let name = ColumnState::with(ui.ctx(), |state| state.paint_layer);
        let kind = order.into_iter().find(|kind| Some(kind.name()) == name);
        match kind {
            None if name == Some(presets::GROUND) && has_ground(asker, &place) => tone(ui, asker, &place),
            kind => selected(ui, asker, &place, kind.unwrap_or(LayerKind::Body)),
        }
    });
}

/// Whether the style is brush strokes. In the other styles the order of layers does not matter, and no touches lie over
/// them.
fn is_painted(asker: &Asker<'_, '_>) -> bool {
    matches!(asker.scene().style, Style::RotatingStrokes(_))
}

/// Whether the ground is one of the rows. It is not for a region, which has no ground of its own, nor in ink, which
/// lies on paper.
fn has_ground(asker: &Asker<'_, '_>, place: &EditedStrokes<'_>) -> bool {
    place.index.is_none() && is_painted(asker)
}

fn list(ui: &mut Ui, asker: &mut Asker<'_, '_>, place: &EditedStrokes<'_>, order: [LayerKind; 7]) {
    ui.scope(|ui| {
        ui.spacing_mut().item_spacing.y = 0.0;
        match asker.scene().touches.len() {
            _ if !is_painted(asker) => {}
            0 => {}
            1 => note(ui, "Over them lies 1 touch: it is in the tree."),
            count => note(ui, &format!("Over them lie {count} touches: they are in the tree.")),
        }
        let mut rows = Vec::new();
        for kind in order.into_iter().rev() {
            rows.push((kind, layer(ui, asker, place, EditedLayer::Paint(kind))));
        }
        if has_ground(asker, place) {
            layer(ui, asker, place, EditedLayer::Ground);
        }
        if place.index.is_none() && is_painted(asker) {
            drag(ui, asker, place, &rows);
        }
    });
}

/// One row of the list.
fn layer(ui: &mut Ui, asker: &mut Asker<'_, '_>, place: &EditedStrokes<'_>, layer: EditedLayer) -> Response {
    let name = layer.name();
    let loaded = asker.shown.document.shown();
    let mut mix: &[String] = &[];
    let mut idle = false;
    if let EditedLayer::Paint(kind) = layer {
        let resolved = place.resolved[0].layer_of(kind);
        mix = &resolved.brushes;
        let has_strokes = asker.scene().style.settings().preparation().has_strokes;
        idle = resolved.coverage == 0.0 || !has_strokes || !presets::paints_layer(asker.scene(), kind);
    }
    let mut used = brushes::by_count(mix);
    // Pictures are shown of the two brushes that the layer uses most.
    used.sort_by_key(|(_, times)| std::cmp::Reverse(*times));
    let pictures = used.iter().take(2).filter_map(|(name, _)| thumbnail(ui.ctx(), name, loaded));
    let tone = (layer == EditedLayer::Ground).then(|| seen(presets::stated_ground(place.own[0]).color));
    let chosen = ColumnState::with(ui.ctx(), |state| state.paint_layer).unwrap_or(LayerKind::Body.name());
    let pictures: Vec<_> = pictures.collect();
    let shown = LayerRow {
        name,
        selected: chosen == name,
        hidden: layer.is_hidden(&place.resolved[0], place.own[0]),
        idle,
        pictures: pictures.iter().map(|picture| picture.id()).collect(),
        tone,
        end: OPACITY + measure::ROW_END,
    }
    .show(ui);
    if shown.eye_clicked {
        asker.ask(layer.toggle(asker, place));
    }
    let inside = UiBuilder::new().max_rect(shown.end).layout(Layout::left_to_right(Align::Center));
    ui.scope_builder(inside, |ui| {
        ui.spacing_mut().item_spacing.x = 0.0;
        let Some(of) = LayerSettings::NUMBERS.iter().find(|of| of.number.field == "opacity") else { return };
        let name = format!("Opacity of {name}");
        let number = Number { unlabelled: Some(OPACITY), ..Number::share(&name, of.number.effect) };
        if layer.number(ui, asker, place, of, number) && reset(ui, &name) {
            asker.ask(layer.with(place, of, None));
        }
    });
    let brushes = if mix.len() > 1 { format!("Brushes: {}.", brushes::counted(mix)) } else { String::new() };
    let words = if idle { format!("It paints nothing now. {brushes}") } else { brushes };
    let tip = Tip { name, effect: layer.effect(), range: words.trim_end(), key: "" };
    let response = tip.on(shown.response);
    if response.clicked() || shown.eye_clicked {
        ColumnState::with(ui.ctx(), |state| state.paint_layer = Some(name));
    }
    response
}

/// Moves a layer that is dragged to another place of the list.
fn drag(ui: &Ui, asker: &mut Asker<'_, '_>, place: &EditedStrokes<'_>, rows: &[(LayerKind, Response)]) {
    let Some(from) = rows.iter().position(|(_, row)| row.dragged() || row.drag_stopped()) else { return };
    let Some(pointer) = ui.input(|input| input.pointer.latest_pos()) else { return };
    let to = rows.iter().filter(|(_, row)| row.rect.center().y < pointer.y).count();
    let goes_nowhere = to == from || to == from + 1;
    if !goes_nowhere {
        let rect = rows.iter().fold(Rect::NOTHING, |all, (_, row)| all.union(row.rect));
        let y = rows.get(to).map_or(rect.bottom(), |(_, row)| row.rect.top());
        ui.painter().hline(rect.x_range(), y, (2.0, Tokens::of(ui).accent_text));
    }
    if rows[from].1.drag_stopped() && !goes_nowhere {
        let mut order: Vec<LayerKind> = rows.iter().map(|(kind, _)| *kind).collect();
        let dragged = order.remove(from);
        order.insert(if to > from { to - 1 } else { to }, dragged);
        order.reverse();
        asker.ask(place.set(StrokeChange::LayerOrder(order.try_into().ok())));
    }
}

/// The brushes and numbers of a layer.
fn selected(ui: &mut Ui, asker: &mut Asker<'_, '_>, place: &EditedStrokes<'_>, kind: LayerKind) {
    let layer = EditedLayer::Paint(kind);
    // The body layer takes these from the stroke settings, and the section of those shows them.
    let is_twin = |field: &str| {
        kind == LayerKind::Body && matches!(field, "brush" | "length_px" | "width_px" | "coverage")
    };
    if place.index.is_none() && is_painted(asker) {
        order(ui, asker, place, kind);
    }
    if is_twin("brush") {
        let section = if place.index.is_none() { "All strokes" } else { "Strokes" };
        note(ui, &format!("Brush, size and coverage of the body: see {section}."));
    } else {
        let stated = layer.stated(place.own[1]);
        let is_own = stated.brush.is_some();
        let own = BrushRow { of: layer.name(), mix: &place.resolved[0].layer_of(kind).brushes, is_own };
        brushes::show(ui, asker, &own, |brush| place.set_layer(LayerSettings { brush, ..stated.clone() }));
    }
    let numbers = LayerSettings::NUMBERS.iter().filter(|of| !is_twin(of.number.field));
    for (of, number) in numbers.filter_map(|of: &'static LayerNumber| Some((of, shown(of)?))) {
        layer.number(ui, asker, place, of, number);
    }
}

/// Buttons that move a layer of the scene up and down.
fn order(ui: &mut Ui, asker: &mut Asker<'_, '_>, place: &EditedStrokes<'_>, kind: LayerKind) {
    let order = presets::laying_order(asker.stored());
    let Some(at) = order.iter().position(|other| *other == kind) else { return };
    row(ui, "Order", |ui| {
        let moves = [
            (icons::KEYS_UP, "Move layer up", at.checked_add(1).filter(|to| *to < order.len())),
            (icons::KEYS_DOWN, "Move layer down", at.checked_sub(1)),
        ];
        for (icon, name, to) in moves {
            let button = ui.add_enabled_ui(to.is_some(), |ui| widgets::icon_button(ui, icon, name)).inner;
            let effect = "Lays it later or earlier, in the whole scene; or drag its row.";
            let clicked = Tip { name, effect, ..Tip::default() }.on(button).clicked();
            if let Some(to) = to.filter(|_| clicked) {
                let mut moved = order;
                moved.swap(at, to);
                asker.ask(place.set(StrokeChange::LayerOrder(Some(moved))));
            }
        }
        if order != LayerKind::ALL && reset(ui, "Order of layers") {
            asker.ask(place.set(StrokeChange::LayerOrder(None)));
        }
    });
}

/// The colour of the ground.
fn tone(ui: &mut Ui, asker: &mut Asker<'_, '_>, place: &EditedStrokes<'_>) {
    let stated = EditedLayer::Ground.stated(place.own[1]);
    row(ui, "Tone", |ui| {
        let shown = seen(presets::stated_ground(place.own[0]).color);
        asker.colour(ui, "Tone of the ground", shown, |color| {
            place.set_layer(LayerSettings { color: Some(color), ..stated.clone() })
        });
        if stated.color.is_some() && reset(ui, "Tone of the ground") {
            asker.ask(place.set_layer(LayerSettings { color: None, ..stated.clone() }));
        }
    });
}
