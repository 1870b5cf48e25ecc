//! Questions that must be answered before anything else, and the sheets that they stand on.

use egui::{Area, Color32, Context, CornerRadius, Frame, Id, Key, Margin, Modal, RichText, Ui};

use super::Button;
use crate::theme::{Theme, Tokens, measure, type_face};

/// A question that must be answered before anything else.
#[derive(Clone, Copy, Debug)]
pub struct Dialog<'a> {
    /// The question.
    pub title: &'a str,
    /// What one should know to answer it.
    pub words: &'a str,
    /// The choices, left to right. The last is the safe one, and `Enter` chooses it.
    pub verbs: &'a [&'a str],
    /// Index of the verb that `Esc` chooses.
    pub cancel: usize,
}

/// Index of the verb that was chosen in this pass of a [`dialog`], if any.
pub type DialogResponse = Option<usize>;

/// Shows a question over everything.
pub fn dialog(ctx: &Context, asked: &Dialog<'_>) -> DialogResponse {
    let mut chosen = None;
    let wide = ctx.fonts_mut(|fonts| {
        let mut width = |verb: &&str| {
            fonts.layout_no_wrap((*verb).to_owned(), type_face::head(), Color32::WHITE).size().x
        };
        let verbs = asked.verbs.iter().map(|verb| width(verb) + 32.0 + measure::GAP);
        verbs.sum::<f32>() + 2.0 * measure::SHEET_PADDING
    });
    sheet(ctx, asked.title, wide.max(432.0), |ui| {
        let tokens = Tokens::of(ui);
        ui.label(RichText::new(asked.title).font(type_face::title()).color(tokens.text));
        ui.add_space(4.0);
        ui.label(RichText::new(asked.words).font(type_face::body()).color(tokens.weak));
        ui.add_space(20.0);
        let row = egui::vec2(ui.available_width(), measure::SHEET_BUTTON);
        ui.allocate_ui_with_layout(row, egui::Layout::right_to_left(egui::Align::Center), |ui| {
            for (index, verb) in asked.verbs.iter().enumerate().rev() {
                let safe = index + 1 == asked.verbs.len();
                let button = Button::new(verb).on_sheet();
                let button = if safe { button.primary() } else { button };
                if button.show(ui).clicked() {
                    chosen = Some(index);
                }
            }
        });
        let (enter, escape) =
            ui.input(|input| (input.key_pressed(Key::Enter), input.key_pressed(Key::Escape)));
        // `Enter` on a verb that has the focus is a click on that verb.
        if chosen.is_none() && enter && ui.memory(|memory| memory.focused()).is_none() {
            chosen = asked.verbs.len().checked_sub(1);
        }
        if chosen.is_none() && escape {
            chosen = Some(asked.cancel);
        }
    });
    chosen
}

/// A sheet of `width` points in the middle of the window, with everything else behind a veil.
pub(crate) fn sheet<R>(ctx: &Context, name: &str, width: f32, contents: impl FnOnce(&mut Ui) -> R) -> R {
    let theme = if ctx.global_style().visuals.dark_mode { Theme::Dark } else { Theme::Light };
    let tokens = theme.tokens();
    let frame = Frame::new()
        .fill(tokens.panel)
        .stroke((1.0, tokens.div))
        .shadow(ctx.global_style().visuals.window_shadow)
        .corner_radius(CornerRadius::same(measure::SHEET_CORNER as u8))
        .inner_margin(Margin::same(measure::SHEET_PADDING as i8));
    let id = Id::unique(("sheet", name));
    let area: Area = Modal::default_area(id);
    let shown = Modal::new(id).area(area).backdrop_color(tokens.scrim).frame(frame).show(ctx, |ui| {
        ui.set_width(width - 2.0 * measure::SHEET_PADDING);
        contents(ui)
    });
    shown.response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Dialog, true, name));
    shown.inner
}
