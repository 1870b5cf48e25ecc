//! The right column of the page with every control, on which tests check how controls look and behave.

use egui::{Align, Frame, Layout, Margin, RichText, Ui};
use impasto_editor::icons;
use impasto_editor::theme::{Tokens, measure, type_face};
use impasto_editor::widgets::{self, FieldResponse, NumberField, RowMark, TreeRow};

use super::Page;

pub fn column(page: &mut Page, ui: &mut Ui) {
    ui.spacing_mut().item_spacing.y = 0.0;
    ui.horizontal(|ui| {
        ui.set_height(32.0);
        ui.add_space(4.0);
        ui.label(RichText::new("Scene").font(type_face::head()));
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.add_space(-2.0);
            widgets::icon_button(ui, icons::ADD, "Add to scene");
            widgets::icon_button(ui, icons::SEARCH, "Search scene");
        });
    });
    tree(page, ui);
    ui.add_space(12.0);
    let tokens = Tokens::of(ui);
    ui.painter().hline(ui.max_rect().x_range(), ui.cursor().top() + 0.5, (1.0, tokens.div));
    ui.horizontal(|ui| {
        ui.set_height(37.0);
        widgets::color_square(ui, "Region colour", &mut page.skin);
        ui.label(RichText::new("skin").font(type_face::head()));
        ui.label(RichText::new("on apple").font(type_face::small()).color(tokens.weak));
    });
    if widgets::section(ui, "Direction", "", &mut page.open[0]).clicked() {
        page.edits.push("Direction");
    }
    if page.open[0] {
        body(ui, |ui| {
            ui.horizontal(|ui| {
                ui.label(RichText::new("Base").color(tokens.weak));
                let room = measure::LABEL - ui.min_rect().width() - 8.0;
                ui.add_space(room);
                let choices = ["Angle", "Around", "Automatic"];
                widgets::combo(ui, "Base direction", None, &choices, &mut page.base);
                NumberField::new("Base angle", &mut page.angle, f64::NEG_INFINITY..=f64::INFINITY)
                    .unlabelled(64.0)
                    .unit("\u{b0}")
                    .show(ui);
            });
        });
    }
    widgets::section(ui, "Strokes", "", &mut page.open[1]);
    if page.open[1] {
        body(ui, |ui| strokes(page, ui));
    }
    widgets::section(ui, "Guides", "4", &mut page.open[2]);
    widgets::section(ui, "Advanced", "", &mut page.open[3]);
}

fn body(ui: &mut Ui, contents: impl FnOnce(&mut Ui)) {
    Frame::new().inner_margin(Margin { left: 12, right: 12, top: 0, bottom: 2 }).show(ui, |ui| {
        ui.spacing_mut().item_spacing.y = 4.0;
        contents(ui);
    });
}

fn strokes(page: &mut Page, ui: &mut Ui) {
    let pictures = page.brushes(ui.ctx());
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 3.0;
        ui.add_space(1.0);
        let names = ["Brush flat", "Brush oval", "Brush dry", "Brush thin", "Brush dabs"];
        for (index, (name, picture)) in names.into_iter().zip(pictures).enumerate() {
            if widgets::brush_thumbnail(ui, name, picture, page.brush == index).clicked() {
                page.brush = index;
            }
        }
    });
    let length = NumberField::new("Length", &mut page.length_px, 1.0..=100.0)
        .unit("px")
        .default_value(34.0)
        .tip("", "How long a stroke is in the picture.")
        .show(ui);
    note(&mut page.edits, &length);
    let error = (page.width_px > page.length_px).then_some("Wider than it is long.");
    let width = NumberField::new("Width", &mut page.width_px, 0.5..=32.0).unit("px").error(error).show(ui);
    note(&mut page.edits, &width);
    NumberField::new("Coverage", &mut page.coverage, 0.5..=6.0)
        .unit("\u{d7}")
        .step(0.1, 1)
        .default_value(2.5)
        .show(ui);
    NumberField::new("Flatness", &mut page.flatness, 0.0..=1.0)
        .unit("2D")
        .step(0.1, 1)
        .default_value(1.0)
        .show(ui);
}

fn note(edits: &mut Vec<&'static str>, field: &FieldResponse) {
    for (happened, what) in [(field.began, "began"), (field.changed, "changed"), (field.ended, "ended")] {
        if happened {
            edits.push(what);
        }
    }
}

fn tree(page: &mut Page, ui: &mut Ui) {
    let plain = |name, spoken, mark, depth| TreeRow {
        name,
        spoken,
        mark,
        depth,
        expanded: None,
        selected: false,
        note: "",
        keyed: false,
        hidden: false,
        locked: false,
    };
    let object = RowMark::Icon(icons::OBJECT);
    let stem = RowMark::Colour(egui::Color32::from_rgb(0xAA, 0x7C, 0x41));
    let rows = [
        TreeRow { keyed: true, ..plain("shot", "shot, camera", RowMark::Icon(icons::CAMERA), 0) },
        plain("window", "window, light", RowMark::Icon(icons::LIGHT), 0),
        TreeRow { keyed: true, expanded: Some(true), ..plain("apple", "apple, object", object, 0) },
        TreeRow {
            note: "4 guides",
            ..plain("skin", "skin, region, 4 guides", RowMark::Colour(page.skin), 1)
        },
        TreeRow { note: "around", ..plain("stem", "stem, region", stem, 1) },
        plain("leaf", "leaf, object", object, 1),
        plain("lemon", "lemon, object", object, 0),
        TreeRow { locked: true, ..plain("table", "table, object, locked", RowMark::Icon(icons::TABLE), 0) },
    ];
    for (index, row) in rows.into_iter().enumerate() {
        let shown = TreeRow { selected: page.selected == index, ..row }.show(ui);
        if shown.response.clicked() {
            page.selected = index;
        }
        if shown.toggled || shown.hide_clicked || shown.lock_clicked {
            page.edits.push("row");
        }
    }
}
