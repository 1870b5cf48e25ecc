//! The section of the inspector that lists a region's guides, and shows the settings of the selected one.

use egui::{Align2, Color32, DragAndDrop, Rect, Sense, Ui, WidgetInfo, pos2, vec2};
use impasto_editor_model::command::{Command, Directions, Edit, GuideSettings};
use impasto_editor_model::keymap::Action;
use impasto_editor_model::{Item, Selection};
use impasto_scene::document::{Falloff, Guide, GuideMode, Region};

use super::Asker;
use super::number::Number;
use super::parts::{is_wide, note, pick, row, section};
use crate::icons;
use crate::panels::Ask;
use crate::theme::{Tokens, measure, type_face};
use crate::widgets::{self, Tip};

pub(super) fn section_of(ui: &mut Ui, asker: &mut Asker<'_, '_>, [region, stored]: [&Region; 2]) {
    let active = match asker.shown.document.selection().active() {
        Some(Item::Guide(of, index)) if *of == region.name => Some(*index),
        _ => None,
    };
    let count = region.guides.len().to_string();
    // Unless it was opened or folded by hand, the section is open while a guide is selected, so that its row is seen.
    let open = is_wide(ui) || active.is_some();
    section(ui, "Guides", &count, open, |ui| {
        if region.guides.is_empty() {
            let keys = asker.shown.with_keys_of(Action::GuideCurve, " ({})");
            note(ui, &format!("No guides. Comb over the region, or draw a curve{keys}."));
        }
        let mut placed = Vec::new();
        for (index, guide) in region.guides.iter().enumerate() {
            let rect = guide_row(ui, asker, &region.name, index, guide, active == Some(index));
            placed.push(rect);
            if active == Some(index)
                && let Some(stored) = stored.guides.get(index)
            {
                settings(ui, asker, &region.name, index, [guide, stored]);
            }
        }
        reorder(ui, asker, &region.name, &placed);
    });
}

/// Shows where a dragged guide would go, and asks for the move when it is released.
fn reorder(ui: &Ui, asker: &mut Asker<'_, '_>, region: &str, placed: &[Rect]) {
    let Some(item) = DragAndDrop::payload::<Item>(ui.ctx()) else { return };
    let Item::Guide(of, from) = &*item else { return };
    let at = ui.input(|input| input.pointer.latest_pos()).filter(|at| ui.clip_rect().contains(*at));
    let Some(at) = at.filter(|_| of == region) else { return };
    let Some(last) = placed.len().checked_sub(1) else { return };
    let near = placed[0].top() - measure::HIT..=placed[last].bottom() + measure::HIT;
    if !near.contains(&at.y) || !placed[0].x_range().contains(at.x) {
        return;
    }
    let before = placed.iter().position(|rect| at.y < rect.center().y).unwrap_or(placed.len());
    let to = if *from < before { before - 1 } else { before };
    if to == *from {
        return;
    }
    let line_y = placed.get(before).map_or(placed[last].bottom(), |rect| rect.top());
    ui.painter().hline(placed[0].x_range(), line_y, (2.0, Tokens::of(ui).accent_text));
    if ui.input(|input| input.pointer.any_released()) {
        DragAndDrop::clear_payload(ui.ctx());
        asker.ask(Command::Edit(Edit::Reorder((*item).clone(), to)));
    }
}

fn guide_row(
    ui: &mut Ui,
    asker: &mut Asker<'_, '_>,
    region: &str,
    index: usize,
    guide: &Guide,
    selected: bool,
) -> Rect {
    let tokens = Tokens::of(ui);
    let (mut rect, response) =
        ui.allocate_exact_size(vec2(ui.available_width(), measure::HIT), Sense::click_and_drag());
    rect = rect.expand2(vec2(12.0, 0.0));
    let fill = match (selected, response.hovered()) {
        (true, _) => tokens.sel,
        (false, true) => tokens.hov,
        (false, false) => Color32::TRANSPARENT,
    };
    let painter = ui.painter();
    painter.rect_filled(rect, 0.0, fill);
    let (icon, kind) = match guide.mode {
        GuideMode::Comb if guide.curve => (icons::GUIDE, "curve"),
        GuideMode::Comb => (icons::COMB, "comb"),
        GuideMode::Smooth => (icons::SMOOTH, "smooth"),
    };
    let weak = if response.hovered() && !selected { tokens.text } else { tokens.weak };
    let font = type_face::icon(measure::SMALL_ICON);
    let at = pos2(rect.left() + 20.0, rect.center().y);
    painter.text(at, Align2::CENTER_CENTER, icon.glyph(), font, weak);
    let at = pos2(rect.left() + 36.0, rect.center().y);
    let name = format!("g{}", index + 1);
    let end = painter.text(at, Align2::LEFT_CENTER, &name, type_face::body(), tokens.text);
    let at = pos2(end.right() + 8.0, rect.center().y);
    let words = format!("{kind}, {} points", guide.points.len());
    painter.text(at, Align2::LEFT_CENTER, &words, type_face::small(), weak);
    if response.has_focus() {
        let ring = egui::Stroke::new(2.0, tokens.accent_text);
        painter.rect_stroke(rect.shrink(2.0), 2.0, ring, egui::StrokeKind::Inside);
    }
    let spoken = format!("Guide {name}");
    widgets::reached(&response, &spoken);
    response
        .widget_info(|| WidgetInfo::selected(egui::Role::ListItem, response.enabled(), selected, &spoken));
    if response.clicked() {
        let item =
            if selected { Item::Region(region.to_owned()) } else { Item::Guide(region.to_owned(), index) };
        asker.asks.push(Ask::Select(Selection::only(item)));
    }
    let item = Item::Guide(region.to_owned(), index);
    if response.secondary_clicked() {
        asker.asks.push(Ask::Select(Selection::only(item.clone())));
        asker.asks.push(Ask::Menu(Some(item.clone())));
    }
    if response.drag_started_by(egui::PointerButton::Primary) {
        response.dnd_set_drag_payload(item);
    }
    ui.ctx().accesskit_node_builder(response.id, |node| node.set_description(words));
    rect
}

fn settings(
    ui: &mut Ui,
    asker: &mut Asker<'_, '_>,
    region: &str,
    index: usize,
    [guide, stored]: [&Guide; 2],
) {
    let set = |settings| {
        let guide = (region.to_owned(), index);
        Command::Directions(Directions::SetGuide { guide, settings })
    };
    let radius = Number {
        range: 0.001..=(4.0 * stored.radius).max(0.1),
        limits: Some(0.001..=f64::INFINITY),
        step: (0.01, 3),
        ..Number::new("Guide radius", "How far the guide reaches, in units of the object.")
    };
    asker.number(ui, &radius, [guide.radius, stored.radius], |radius| {
        set(GuideSettings { radius, ..GuideSettings::default() })
    });
    let strength = Number {
        default: Some(1.0),
        ..Number::share("Guide strength", "How far strokes on the guide follow it.")
    };
    asker.number(ui, &strength, [guide.strength, stored.strength], |to| {
        set(GuideSettings { strength: to.or(Some(1.0)), ..GuideSettings::default() })
    });
    row(ui, "Guide falloff", |ui| {
        let kinds = [Falloff::Smooth, Falloff::Linear, Falloff::Flat];
        let chosen = kinds.iter().position(|kind| *kind == guide.falloff).unwrap_or(0);
        let tip = Tip {
            name: "Guide falloff",
            effect: "How strength fades towards the radius.",
            range: "Soft by default.",
            ..Tip::default()
        };
        if let Some(picked) = pick(ui, tip, &["Soft", "Even fade", "Full"], chosen) {
            asker.ask(set(GuideSettings { falloff: Some(kinds[picked]), ..GuideSettings::default() }));
        }
    });
    let item = Item::Guide(region.to_owned(), index);
    let last = asker.stored().regions.iter().find(|other| other.name == region);
    let last = last.map_or(0, |region| region.guides.len().saturating_sub(1));
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        if widgets::Button::new("Flip").name("Flip guide").show(ui).clicked() {
            asker.ask(Command::Directions(Directions::FlipGuide(region.to_owned(), index)));
        }
        if widgets::Button::new("Delete").name("Delete guide").danger().show(ui).clicked() {
            asker.ask(Command::Edit(Edit::Delete(vec![item.clone()])));
        }
        let moves = [
            (icons::KEYS_UP, "Guide up", index.checked_sub(1)),
            (icons::KEYS_DOWN, "Guide down", Some(index + 1).filter(|to| *to <= last)),
        ];
        for (icon, name, to) in moves {
            let effect = "A later guide lies over an earlier one.";
            let button = ui.add_enabled_ui(to.is_some(), |ui| widgets::icon_button(ui, icon, name)).inner;
            let clicked = Tip { name, effect, ..Tip::default() }.on(button).clicked();
            if let Some(to) = to.filter(|_| clicked) {
                asker.ask(Command::Edit(Edit::Reorder(item.clone(), to)));
            }
        }
    });
    ui.add_space(4.0);
}
