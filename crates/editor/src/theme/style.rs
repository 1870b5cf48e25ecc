//! The theme as an egui style.

use egui::{Color32, Context, CornerRadius, Margin, Shadow, Stroke, Style, TextStyle, Visuals, vec2};

use super::{Theme, Tokens, fonts, measure, type_face};

/// Gives `ctx` the editor's fonts, measures and colours, and draws everything `scale` times as large (1 is 100 %).
pub fn apply(ctx: &Context, theme: Theme, scale: f32) {
    let first_time = ctx.data_mut(|data| {
        let seen = data.get_temp_mut_or_insert_with(egui::Id::unique("impasto fonts"), || false);
        !std::mem::replace(seen, true)
    });
    if first_time {
        ctx.set_fonts(fonts::definitions());
    }
    ctx.set_theme(match theme {
        Theme::Dark => egui::Theme::Dark,
        Theme::Light => egui::Theme::Light,
    });
    ctx.set_style_of(egui::Theme::Dark, style(Theme::Dark));
    ctx.set_style_of(egui::Theme::Light, style(Theme::Light));
    // The editor's own commands change the scale, so egui's keys for it are off.
    ctx.options_mut(|options| options.zoom_with_keyboard = false);
    ctx.set_zoom_factor(scale);
}

/// The smallest window that the bars and panels are laid out for, points.
const LEAST_LAYOUT: egui::Vec2 = vec2(800.0, 500.0);

/// The scale to draw with: the chosen one, or a smaller one (at least 0.5) if the bars and panels would have no room.
/// `window` is the window's size in points at scale 1.
pub fn fitting_scale(chosen: f32, window: egui::Vec2) -> f32 {
    let most = (window / LEAST_LAYOUT).min_elem();
    if most.is_finite() && most > 0.0 { chosen.min(most.max(0.5)) } else { chosen }
}

fn style(theme: Theme) -> Style {
    let mut style = Style {
        animation_time: 0.1,
        wrap_mode: None,
        visuals: visuals(theme),
        drag_value_text_style: TextStyle::Monospace,
        ..Style::default()
    };
    style.text_styles = [
        (TextStyle::Body, type_face::body()),
        (TextStyle::Button, type_face::body()),
        (TextStyle::Small, type_face::small()),
        (TextStyle::Heading, type_face::title()),
        (TextStyle::Monospace, type_face::number()),
        (TextStyle::Name("head".into()), type_face::head()),
        (TextStyle::Name("sheet title".into()), type_face::sheet_title()),
        (TextStyle::Name("ruler".into()), type_face::ruler()),
    ]
    .into();

    let spacing = &mut style.spacing;
    spacing.item_spacing = vec2(measure::GAP, 4.0);
    spacing.button_padding = vec2(10.0, 4.0);
    spacing.interact_size = vec2(measure::HIT, measure::FIELD);
    spacing.window_margin = Margin::same(measure::SHEET_PADDING as i8);
    spacing.menu_margin = Margin::same(4);
    spacing.indent = 16.0;
    spacing.slider_rail_height = 6.0;
    spacing.icon_width = 16.0;
    spacing.icon_spacing = measure::GAP;
    spacing.tooltip_width = 260.0;
    // The scroll bar lies over the padding of the rows, so that they reach the edge with or without one.
    spacing.scroll = egui::style::ScrollStyle {
        floating_allocated_width: 0.0,
        floating_width: 3.0,
        bar_width: 6.0,
        ..egui::style::ScrollStyle::thin()
    };

    style.interaction.tooltip_delay = 0.5;
    style.interaction.selectable_labels = false;
    style
}

fn visuals(theme: Theme) -> Visuals {
    let tokens = theme.tokens();
    let mut visuals = match theme {
        Theme::Dark => Visuals::dark(),
        Theme::Light => Visuals::light(),
    };
    // By default egui thickens light text. With this off, Inter looks as designed in both themes.
    visuals.text_options.color_transfer_function = egui::epaint::FontColorTransferFunction::Off;
    visuals.panel_fill = tokens.panel;
    visuals.window_fill = tokens.panel;
    visuals.extreme_bg_color = tokens.field;
    visuals.text_edit_bg_color = Some(tokens.field);
    visuals.code_bg_color = tokens.field;
    visuals.faint_bg_color = tokens.alt;
    visuals.weak_text_color = Some(tokens.weak);
    visuals.hyperlink_color = tokens.accent_text;
    visuals.warn_fg_color = tokens.ochre;
    visuals.error_fg_color = tokens.vermilion;
    visuals.selection.bg_fill = tokens.sel;
    visuals.selection.stroke = Stroke::new(1.0, tokens.accent_text);
    visuals.text_cursor.stroke = Stroke::new(1.5, tokens.accent_text);
    visuals.slider_trailing_fill = true;
    visuals.disabled_alpha = 0.5;
    visuals.window_stroke = Stroke::new(1.0, tokens.div);
    visuals.window_corner_radius = CornerRadius::same(measure::SHEET_CORNER as u8);
    visuals.menu_corner_radius = CornerRadius::same(measure::GROUP_CORNER as u8);
    let shadow = Shadow { offset: [0, 8], blur: 24, spread: 0, color: Color32::from_black_alpha(89) };
    visuals.window_shadow = shadow;
    visuals.popup_shadow = shadow;
    widgets(&mut visuals, tokens);
    visuals
}

fn widgets(visuals: &mut Visuals, tokens: &Tokens) {
    let widgets = &mut visuals.widgets;
    let states = [
        (&mut widgets.noninteractive, tokens.panel, tokens.text),
        (&mut widgets.inactive, tokens.wid, tokens.text),
        (&mut widgets.hovered, tokens.hov, tokens.text),
        (&mut widgets.active, tokens.act, tokens.text),
        (&mut widgets.open, tokens.act, tokens.text),
    ];
    for (state, fill, text) in states {
        state.bg_fill = fill;
        state.weak_bg_fill = fill;
        state.bg_stroke = Stroke::NONE;
        state.fg_stroke = Stroke::new(1.0, text);
        state.corner_radius = CornerRadius::same(measure::CORNER as u8);
        state.expansion = 0.0;
    }
    visuals.widgets.noninteractive.bg_stroke = Stroke::new(1.0, tokens.div);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_window_is_drawn_smaller_and_a_large_one_as_chosen() {
        assert_eq!(fitting_scale(1.0, vec2(3840.0, 2160.0)), 1.0);
        assert_eq!(fitting_scale(2.0, vec2(3840.0, 2160.0)), 2.0);
        assert_eq!(fitting_scale(1.0, vec2(640.0, 440.0)), 0.8);
        assert_eq!(fitting_scale(3.0, vec2(1600.0, 1000.0)), 2.0);
        assert_eq!(fitting_scale(1.5, vec2(0.0, 0.0)), 1.5, "a window that is not shown yet");
    }
}
