//! A page with every control of the editor, laid out like its window. The example `gallery` shows it, and tests check
//! it.

mod bars;
mod column;

use egui::{CentralPanel, Color32, Frame, Panel, Rect, TextureHandle, UiBuilder, pos2, vec2};
use glam::Mat3;
use impasto_editor::icons;
use impasto_editor::theme::{Theme, Tokens, measure};
use impasto_editor::widgets::{self, AxisBall, Dialog, Toast};
use impasto_editor::window::tab_pressed;

/// What the controls of the page hold.
pub struct Page {
    pub theme: Theme,
    pub mode: usize,
    pub tool: usize,
    pub sense: usize,
    pub radius_px: f64,
    pub strength: f64,
    pub mirror: [bool; 3],
    pub view: usize,
    pub shading: usize,
    pub overlays: [bool; 5],
    pub selected: usize,
    pub skin: Color32,
    pub base: usize,
    pub angle: f64,
    pub brush: usize,
    pub length_px: f64,
    pub width_px: f64,
    pub coverage: f64,
    pub flatness: f64,
    pub open: [bool; 4],
    pub looped: bool,
    pub ticked: bool,
    pub asks: bool,
    pub answer: Option<usize>,
    pub toasts: Vec<Toast>,
    pub edits: Vec<&'static str>,
    pub tabs: usize,
    brushes: Vec<TextureHandle>,
}

impl Page {
    pub fn new(theme: Theme) -> Self {
        Self {
            theme,
            mode: 1,
            tool: 0,
            sense: 0,
            radius_px: 46.0,
            strength: 80.0,
            mirror: [false; 3],
            view: 0,
            shading: 0,
            overlays: [true, false, false, false, false],
            selected: 3,
            skin: Color32::from_rgb(0xD9, 0x5A, 0x4A),
            base: 0,
            angle: 35.0,
            brush: 1,
            length_px: 34.0,
            width_px: 9.0,
            coverage: 3.0,
            flatness: 1.0,
            open: [true, true, false, false],
            looped: true,
            ticked: false,
            asks: false,
            answer: None,
            toasts: Vec::new(),
            edits: Vec::new(),
            tabs: 0,
            brushes: Vec::new(),
        }
    }

    pub fn ui(&mut self, ui: &mut egui::Ui) {
        self.tabs += usize::from(tab_pressed(ui.ctx()).is_some());
        let tokens = Tokens::of(ui);
        let bar = |fill| Frame::new().fill(fill);
        Panel::top("top bar")
            .exact_size(measure::TOP_BAR)
            .frame(bar(tokens.alt))
            .show(ui, |ui| bars::top(self, ui));
        Panel::bottom("status")
            .exact_size(measure::STATUS_LINE)
            .frame(bar(tokens.alt))
            .show(ui, bars::status);
        Panel::bottom("strip")
            .exact_size(measure::STRIP)
            .frame(bar(tokens.alt))
            .show(ui, |ui| bars::strip(self, ui));
        Panel::right("column")
            .exact_size(280.0)
            .frame(bar(tokens.panel))
            .show(ui, |ui| column::column(self, ui));
        Panel::top("options").exact_size(measure::OPTIONS_BAR).frame(bar(tokens.panel)).show(ui, |ui| {
            bars::options(self, ui);
        });
        Panel::left("rail")
            .exact_size(measure::RAIL)
            .frame(bar(tokens.panel))
            .show(ui, |ui| bars::rail(self, ui));
        CentralPanel::default().frame(bar(tokens.app)).show(ui, |ui| self.viewport(ui));
        if self.asks {
            let asked = Dialog {
                title: "Save changes to \u{201c}still_life.ron\u{201d}?",
                words: "You edited it for 12 minutes.",
                verbs: &["Don\u{2019}t save", "Cancel", "Save"],
                cancel: 1,
            };
            if let Some(answer) = widgets::dialog(ui.ctx(), &asked) {
                self.answer = Some(answer);
                self.asks = false;
            }
        }
        let above = measure::STATUS_LINE + measure::STRIP;
        if let Some(done) = widgets::toasts(ui.ctx(), &self.toasts, above) {
            self.toasts.remove(done);
        }
    }

    fn viewport(&mut self, ui: &mut egui::Ui) {
        let whole = ui.max_rect();
        let at = |rect: Rect| UiBuilder::new().max_rect(rect);
        let corner = Rect::from_min_size(whole.min + vec2(12.0, 12.0), vec2(400.0, measure::CHIP));
        ui.scope_builder(at(corner), |ui| {
            widgets::chip(ui, |ui| {
                widgets::combo(
                    ui,
                    "View",
                    Some(icons::CAMERA),
                    &["Shot camera", "Free view"],
                    &mut self.view,
                );
                widgets::chip_divider(ui);
                widgets::combo(
                    ui,
                    "Shading",
                    Some(icons::SHADING),
                    &["Painted", "Lit", "Trust"],
                    &mut self.shading,
                );
            });
        });
        let wide = 5.0 * 26.0 + 4.0 * 2.0 + 8.0;
        let corner =
            Rect::from_min_size(pos2(whole.right() - 12.0 - wide, whole.top() + 12.0), vec2(wide, 32.0));
        ui.scope_builder(at(corner), |ui| {
            widgets::chip(ui, |ui| {
                let overlays = [
                    (icons::DIRECTIONS, "Directions"),
                    (icons::TRUST, "Trust"),
                    (icons::REGIONS, "Regions overlay"),
                    (icons::GRID, "Grid"),
                    (icons::COMPARE, "Compare"),
                ];
                for ((icon, name), on) in overlays.into_iter().zip(&mut self.overlays) {
                    widgets::icon_toggle(ui, icon, name, on);
                }
            });
        });
        let ball = Rect::from_min_size(whole.max - vec2(80.0, 80.0), vec2(68.0, 68.0));
        ui.scope_builder(at(ball), |ui| {
            AxisBall { view_from_world: Mat3::from_rotation_x(0.25) * Mat3::from_rotation_y(-0.45) }
                .show(ui, "Axis ball");
        });
        let middle = Rect::from_min_size(whole.min + vec2(24.0, 80.0), vec2(600.0, 200.0));
        ui.scope_builder(at(middle), |ui| {
            ui.horizontal(|ui| {
                widgets::primary_button(ui, "Use leaf.obj");
                widgets::Button::new("Locate\u{2026}").name("Locate").show(ui);
                widgets::Button::new("Stop").danger().show(ui);
                widgets::Button::new("Auto key").on(true).show(ui);
                if widgets::Button::new("Ask").plain().show(ui).clicked() {
                    self.asks = true;
                }
            });
            ui.add_space(8.0);
            widgets::checkbox(ui, "Don\u{2019}t show this at start", &mut self.ticked);
            for (name, theme) in [("Dark", Theme::Dark), ("Light", Theme::Light)] {
                if widgets::radio(ui, name, self.theme == theme).clicked() {
                    self.theme = theme;
                }
            }
        });
    }

    /// Pictures of brushes: white strokes on nothing.
    fn brushes(&mut self, ctx: &egui::Context) -> Vec<egui::TextureId> {
        if self.brushes.is_empty() {
            for half_width in [5.0_f32, 8.0, 3.0, 2.0, 6.0] {
                let pixel = |index: usize| {
                    let (x, y) = ((index % 80) as f32 - 40.0, (index / 80) as f32 - 30.0);
                    let beyond = (x.abs() - 24.0).max((y + x * 0.2).abs() - half_width);
                    Color32::from_white_alpha(((1.0 - beyond).clamp(0.0, 1.0) * 230.0) as u8)
                };
                let image = egui::ColorImage::new([80, 60], (0..80 * 60).map(pixel).collect());
                self.brushes.push(ctx.load_texture("brush", image, egui::TextureOptions::LINEAR));
            }
        }
        self.brushes.iter().map(TextureHandle::id).collect()
    }
}
