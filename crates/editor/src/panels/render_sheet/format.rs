//! The format row of the render sheet. The user chooses the kind of files, and what EXR files hold beside the colour.

use egui::{Align2, Layout, Rect, Sense, Ui, pos2, vec2};
use impasto_editor_model::render_settings::{AovChoice, AovGroup, FileKind, RenderSettings};
use impasto_scene::aovs::AovRow;
use impasto_scene::document::Scene;

use super::{labelled, under};
use crate::panels::{row, within};
use crate::theme::{Tokens, measure, type_face};
use crate::widgets::{self, Tip};

/// The most AOVs in a column; a larger group has several columns.
const COLUMN: usize = 6;

/// Width of a column, points: room for the longest name, and some space.
const COLUMN_WIDTH: f32 = 104.0;

pub(super) fn format(ui: &mut Ui, scene: &Scene, settings: &mut RenderSettings) {
    labelled(ui, "Format", |ui| {
        let mut chosen = FileKind::ALL.iter().position(|kind| *kind == settings.kind).unwrap_or(0);
        if widgets::segmented(ui, &FileKind::ALL.map(FileKind::label), &mut chosen).changed() {
            settings.choose_kind(FileKind::ALL[chosen]);
        }
        if settings.kind.has_exr() {
            let words = settings.aovs.words(scene);
            let control = widgets::drop_down(ui, "AOVs", &words, |ui| menu(ui, scene, &mut settings.aovs));
            let effect = "What EXR files hold beside the colour: depth, mattes, the data of strokes.";
            Tip { name: "AOVs", effect, ..Tip::default() }.on(control);
        }
    });
    if settings.kind == FileKind::Movie {
        let words = "H.264 in a .mp4, ProRes 4444 in a .mov, VP9 in a .webm; made by ffmpeg.";
        under(ui, words, Tokens::of(ui).weak);
    }
}

/// The menu of AOVs: three choices that set them all, and a box to tick for each.
fn menu(ui: &mut Ui, scene: &Scene, choice: &mut AovChoice) {
    let style = &scene.style;
    let has = style.settings().aovs();
    let lacking = format!("The style {} has none.", style.info().label);
    let columns: Vec<_> = AovGroup::all().into_iter().flat_map(columns_of).collect();
    let lines = 2 + columns.iter().map(|(_, rows)| rows.len()).max().unwrap_or(0);
    let inner = vec2(columns.len() as f32 * COLUMN_WIDTH, lines as f32 * measure::HIT + measure::GAP);
    let (outer, _) = ui.allocate_exact_size(inner + vec2(2.0, 2.0) * measure::GAP, Sense::hover());
    let inner = outer.shrink(measure::GAP);
    let top = Rect::from_min_size(inner.min, vec2(inner.width(), measure::HIT));
    within(ui, top, row(), |ui| wholes(ui, scene, choice));
    for (index, (label, rows)) in columns.into_iter().enumerate() {
        let left = inner.left() + index as f32 * COLUMN_WIDTH;
        let head =
            Rect::from_min_size(pos2(left, top.bottom() + measure::GAP), vec2(COLUMN_WIDTH, measure::HIT));
        let colour = Tokens::of(ui).weak;
        ui.painter().text(head.left_center(), Align2::LEFT_CENTER, label, type_face::small(), colour);
        let column = Rect::from_min_max(head.left_bottom(), pos2(head.right(), inner.bottom()));
        within(ui, column, Layout::top_down(egui::Align::Min), |ui| {
            ui.spacing_mut().item_spacing.y = 0.0;
            for (words, row) in rows {
                let lacking = (!has.has(row.aov)).then_some(lacking.as_str());
                tick(ui, words, row, lacking, scene, choice);
            }
        });
    }
}

/// The label of an AOV within its group, and the AOV.
type Named = (&'static str, &'static AovRow);

/// The columns of a group; the first one carries the group's label.
fn columns_of(group: AovGroup) -> Vec<(&'static str, Vec<Named>)> {
    let rows: Vec<Named> = group.rows().collect();
    let labels = std::iter::once(group.label).chain(std::iter::repeat(""));
    labels.zip(rows.chunks(COLUMN).map(<[Named]>::to_vec)).collect()
}

fn wholes(ui: &mut Ui, scene: &Scene, choice: &mut AovChoice) {
    let is_empty = choice.set(scene).is_empty();
    let of_scene = AovChoice::OfScene.set(scene);
    ui.spacing_mut().item_spacing.x = 2.0 * measure::GAP;
    if widgets::radio_named(ui, "None", "No AOVs", is_empty).clicked() {
        *choice = AovChoice::NONE;
    }
    let on = *choice == AovChoice::OfScene && !is_empty;
    let radio = |ui: &mut Ui| widgets::radio_named(ui, "The scene\u{2019}s", "AOVs of the scene", on);
    let response = ui.add_enabled_ui(!of_scene.is_empty(), radio).inner;
    if response.on_disabled_hover_text("The scene\u{2019}s aovs name none").clicked() {
        *choice = AovChoice::OfScene;
    }
    if widgets::radio_named(ui, "All", "All AOVs", *choice == AovChoice::All).clicked() {
        *choice = AovChoice::All;
    }
}

/// The box of an AOV. If the style does not have this AOV, `lacking` says so.
fn tick(
    ui: &mut Ui,
    words: &str,
    row: &AovRow,
    lacking: Option<&str>,
    scene: &Scene,
    choice: &mut AovChoice,
) {
    let mut on = choice.set(scene).has(row.aov);
    let before = on;
    let show = |ui: &mut Ui| widgets::checkbox_named(ui, words, row.name, &mut on);
    let response = ui.add_enabled_ui(lacking.is_none(), show).inner;
    let tip = Tip { name: row.name, effect: row.summary, range: row.channels, ..Tip::default() };
    match lacking {
        None => drop(tip.on(response)),
        Some(lacking) => drop(Tip { range: lacking, ..tip }.on_disabled(response)),
    }
    if on != before {
        *choice = choice.with(row.aov, on, scene);
    }
}
