//! The bars of the test page that shows every control: top bar, tool options, tools, time strip and status line.

use egui::{Align, Layout, RichText, Sense, Ui, vec2};
use impasto_editor::icons::{self, Icon};
use impasto_editor::theme::{Tokens, measure, type_face};
use impasto_editor::widgets::{self, Button, NumberField};

use super::Page;

fn divider(ui: &mut Ui) {
    let (rect, _) = ui.allocate_exact_size(vec2(9.0, 20.0), Sense::hover());
    ui.painter().vline(rect.center().x, rect.y_range(), (1.0, Tokens::of(ui).div));
}

fn weak(ui: &mut Ui, words: &str) {
    ui.label(RichText::new(words).font(type_face::small()).color(Tokens::of(ui).weak));
}

fn icon(ui: &mut Ui, icon: Icon, size: f32) {
    ui.label(RichText::new(icon.glyph()).font(type_face::icon(size)).color(Tokens::of(ui).accent_text));
}

pub fn top(page: &mut Page, ui: &mut Ui) {
    ui.horizontal_centered(|ui| {
        ui.spacing_mut().item_spacing.x = 0.0;
        ui.add_space(15.0);
        icon(ui, icons::APP, measure::ICON);
        ui.add_space(5.0);
        ui.visuals_mut().widgets.inactive.weak_bg_fill = egui::Color32::TRANSPARENT;
        for menu in ["File", "Edit", "View", "Help"] {
            ui.menu_button(menu, |_| ());
        }
        ui.add_space(8.0);
        divider(ui);
        ui.add_space(4.0);
        widgets::icon_button(ui, icons::UNDO, "Undo");
        ui.add_space(4.0);
        ui.add_enabled_ui(false, |ui| widgets::icon_button(ui, icons::REDO, "Redo"));
        ui.add_space(12.0);
        ui.label("still_life.ron");
        ui.add_space(8.0);
        let (dot, _) = ui.allocate_exact_size(vec2(7.0, 7.0), Sense::hover());
        ui.painter().circle_filled(dot.center(), 3.5, Tokens::of(ui).ochre);
        ui.add_space(5.0);
        weak(ui, "edited");
        let room = 525.0 - ui.cursor().left();
        ui.add_space(room);
        widgets::mode_switch(ui, &mut page.mode);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.spacing_mut().item_spacing.x = 8.0;
            Button::new("Render\u{2026}").name("Render").icon(icons::RENDER).show(ui);
            widgets::icon_button(ui, icons::SEARCH, "Find a command");
        });
    });
}

pub fn options(page: &mut Page, ui: &mut Ui) {
    ui.horizontal_centered(|ui| {
        ui.spacing_mut().item_spacing.x = 8.0;
        ui.add_space(6.0);
        icon(ui, icons::COMB, measure::ICON);
        ui.label(RichText::new("Comb").font(type_face::head()));
        widgets::segmented(ui, &["Along", "Against"], &mut page.sense);
        divider(ui);
        weak(ui, "Radius");
        NumberField::new("Brush radius", &mut page.radius_px, 1.0..=100.0)
            .unlabelled(78.0)
            .unit("px")
            .show(ui);
        weak(ui, "Strength");
        NumberField::new("Brush strength", &mut page.strength, 0.0..=100.0)
            .unlabelled(72.0)
            .unit("%")
            .show(ui);
        divider(ui);
        weak(ui, "Mirror");
        widgets::toggle_group(ui, ["Mirror X", "Mirror Y", "Mirror Z"], &mut page.mirror);
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.add_space(8.0);
            widgets::icon_button(ui, icons::MORE_OPTIONS, "More tool options");
        });
    });
}

pub fn rail(page: &mut Page, ui: &mut Ui) {
    let tools = [
        (icons::COMB, "Comb", "C"),
        (icons::GUIDE, "Guide curve", "V"),
        (icons::FILL, "Fill direction", "D"),
        (icons::TURN, "Turn direction", "T"),
        (icons::SMOOTH, "Smooth", "S"),
        (icons::ERASE, "Erase to automatic", "E"),
        (icons::REGION, "Region", "M"),
        (icons::PICK, "Pick direction", "I"),
    ];
    ui.add_space(6.0);
    ui.vertical_centered(|ui| {
        ui.spacing_mut().item_spacing.y = 2.0;
        for (index, (icon, name, letter)) in tools.into_iter().enumerate() {
            if widgets::rail_button(ui, icon, name, letter, page.tool == index).clicked() {
                page.tool = index;
            }
        }
    });
}

pub fn strip(page: &mut Page, ui: &mut Ui) {
    ui.horizontal_centered(|ui| {
        ui.spacing_mut().item_spacing.x = 1.0;
        ui.add_space(8.0);
        for (icon, name) in [
            (icons::FIRST_FRAME, "First frame"),
            (icons::PREVIOUS_FRAME, "Previous frame"),
            (icons::PLAY, "Play"),
            (icons::NEXT_FRAME, "Next frame"),
            (icons::LAST_FRAME, "Last frame"),
        ] {
            widgets::icon_button(ui, icon, name);
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.spacing_mut().item_spacing.x = 8.0;
            ui.add_space(8.0);
            Button::new("Keys").name("Show keys").icon(icons::KEYS_UP).plain().show(ui);
            widgets::icon_toggle(ui, icons::LOOP, "Loop", &mut page.looped);
            weak(ui, "24 fps");
            weak(ui, "0\u{2013}119");
        });
    });
}

pub fn status(ui: &mut Ui) {
    ui.horizontal_centered(|ui| {
        ui.add_space(2.0);
        for (key, does) in
            [("Drag", "comb"), ("Shift", "smooth"), ("Ctrl", "against"), ("F", "radius"), ("Middle", "orbit")]
        {
            widgets::key_hint(ui, key, does);
        }
        ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
            ui.spacing_mut().item_spacing.x = 14.0;
            ui.add_space(-4.0);
            for words in ["llvmpipe", "41 fps", "5,774 strokes"] {
                weak(ui, words);
            }
        });
    });
}
