//! The chips, controls that float over the picture: view and shading at the top left, overlays at the top right, the
//! reference badge at the bottom left, the axis ball at the bottom right.

use egui::{Align2, Area, Id, Order, Rect, Ui, Vec2, vec2};
use impasto_editor_model::camera_rig::AxisView;
use impasto_editor_model::keymap::Action;
use impasto_editor_model::session::{DirectionLines, Mode, Session, Shading};

use super::{Badge, CameraChoice, ViewportEvents, ViewportInput};
use crate::icons;
use crate::panels::Ask;
use crate::theme::{Tokens, type_face};
use crate::widgets::{AxisBall, Tip, chip, chip_divider, combo, icon_toggle};

const INSET: f32 = 12.0;
const LOOKS: [(&str, CameraChoice); 5] = [
    ("Shot camera", CameraChoice::Shot),
    ("Free view", CameraChoice::Free),
    ("Front", CameraChoice::Along(AxisView::Front)),
    ("Right", CameraChoice::Along(AxisView::Right)),
    ("Top", CameraChoice::Along(AxisView::Top)),
];
const SHADINGS: [(&str, Shading); 3] =
    [("Painted", Shading::Painted), ("Shaded", Shading::Shaded), ("Trust", Shading::Trust)];

pub(super) fn show(ui: &Ui, area: Rect, input: &ViewportInput<'_>, events: &mut ViewportEvents) {
    float(ui, "view and shading", area, Align2::LEFT_TOP, |ui| {
        chip(ui, |ui| looks(ui, input, events));
    });
    float(ui, "overlays", area, Align2::RIGHT_TOP, |ui| {
        chip(ui, |ui| overlays(ui, input, events));
    });
    float(ui, "badge", area, Align2::LEFT_BOTTOM, |ui| {
        chip(ui, |ui| badge(ui, input, events));
    });
    if input.now.is_none() {
        float(ui, "axis ball", area, Align2::RIGHT_BOTTOM, |ui| {
            let view_from_world = glam::Mat3::from_mat4(input.camera.view_from_world().as_mat4());
            let ball = AxisBall { view_from_world }.show(ui, "Axis ball");
            events.orbit_px += glam::DVec2::new(f64::from(ball.dragged.x), f64::from(ball.dragged.y));
            if let Some(axis) = ball.clicked_axis {
                events.look = Some(CameraChoice::Along(axis_view(axis)));
            }
        });
    }
}

/// Shows contents in a corner, in a layer of their own, so that a press on them does not reach the picture.
fn float(ui: &Ui, name: &str, area: Rect, corner: Align2, contents: impl FnOnce(&mut Ui)) {
    let inner = area.shrink(INSET);
    let at = corner.pos_in_rect(&inner);
    Area::new(Id::unique(("viewport chip", name)))
        .order(Order::Middle)
        .pivot(corner)
        .fixed_pos(at)
        .constrain_to(area)
        .movable(false)
        .show(ui.ctx(), contents);
}

fn looks(ui: &mut Ui, input: &ViewportInput<'_>, events: &mut ViewportEvents) {
    let mut look = usize::from(!input.through_shot);
    if combo(ui, "View", Some(icons::CAMERA), &LOOKS.map(|(name, _)| name), &mut look).changed() {
        events.look = Some(LOOKS[look].1);
    }
    chip_divider(ui);
    let mut shading = SHADINGS.iter().position(|(_, of)| *of == input.session.shading).unwrap_or(0);
    if combo(ui, "Shading", Some(icons::SHADING), &SHADINGS.map(|(name, _)| name), &mut shading).changed() {
        let session = Session { shading: SHADINGS[shading].1, ..input.session.clone() };
        events.asks.push(Ask::Session(Box::new(session)));
    }
}

fn overlays(ui: &mut Ui, input: &ViewportInput<'_>, events: &mut ViewportEvents) {
    let session = input.session;
    let [directions_key, trust_key, compare_key] =
        [Action::CycleDirections, Action::ToggleTrust, Action::Compare]
            .map(|action| input.keymap.shortcut_text(action).unwrap_or_default());
    let mut wanted = session.clone();
    let shown = &mut wanted.overlays;
    let paints = session.mode == Mode::Paint;
    let toggle = |ui: &mut Ui, icon, (name, key, effect): (&str, &str, &str), on: &mut bool| {
        let response = icon_toggle(ui, icon, name, on).on_disabled_hover_text(effect);
        Tip { name, key, effect, range: "" }.on(response);
    };
    // Outside Paint, direction lines are drawn only for Trust, so there this toggle is off.
    let mut direction_lines = paints && shown.direction_lines != DirectionLines::Off;
    let before = direction_lines;
    let effect = if paints { "Short lines along the strokes." } else { "Directions show in Paint." };
    ui.add_enabled_ui(paints, |ui| {
        toggle(ui, icons::DIRECTIONS, ("Directions", directions_key.as_str(), effect), &mut direction_lines)
    });
    if direction_lines != before {
        shown.direction_lines = if direction_lines { DirectionLines::Plain } else { DirectionLines::Off };
    }
    let trust = ("Trust", trust_key.as_str(), "How far each turn can be trusted.");
    toggle(ui, icons::TRUST, trust, &mut shown.trust);
    toggle(ui, icons::REGIONS, ("Regions overlay", "", "Regions in their colours."), &mut shown.regions);
    toggle(ui, icons::GRID, ("Grid", "", "The floor."), &mut shown.grid);
    let mut compare = wanted.compare;
    let comparison = ("Compare", compare_key.as_str(), "The reference beside this frame.");
    toggle(ui, icons::COMPARE, comparison, &mut compare);
    if wanted != *session {
        events.asks.push(Ask::Session(Box::new(wanted)));
    }
    if compare != session.compare {
        events.asks.push(Ask::Act(Action::Compare));
    }
}

fn badge(ui: &mut Ui, input: &ViewportInput<'_>, events: &mut ViewportEvents) {
    let tokens = Tokens::of(ui);
    let (colour, words) = match input.badge {
        Badge::Reference(frame) => (tokens.viridian, format!("Reference, frame {frame:.0}")),
        Badge::Turned { frame, reference } => {
            (tokens.ochre, format!("Frame {frame:.0}, turned from reference {reference:.0}"))
        }
        Badge::Free(frame) => (tokens.ochre, format!("Free view, frame {frame:.0}")),
    };
    ui.add_space(4.0);
    let (at, _) = ui.allocate_exact_size(Vec2::splat(16.0), egui::Sense::hover());
    let font = type_face::icon(16.0);
    ui.painter().text(at.center(), Align2::CENTER_CENTER, icons::REFERENCE.glyph(), font, colour);
    ui.add_space(4.0);
    let galley = ui.painter().layout_no_wrap(words.clone(), type_face::small(), tokens.text);
    let (rect, label) = ui.allocate_exact_size(vec2(galley.size().x, 24.0), egui::Sense::hover());
    ui.painter().galley(rect.center() - galley.size() * 0.5, galley, tokens.text);
    label.widget_info(|| {
        let mut info = egui::WidgetInfo::labeled(egui::Role::Status, true, "Reference");
        info.current_text_value = Some(words.clone());
        info
    });
    ui.add_space(4.0);
    let (verb, name, colour) = if input.now.is_some() {
        ("Close", "Close the comparison", tokens.accent_text)
    } else {
        match input.badge {
            Badge::Reference(_) => ("Recapture", "Recapture reference", tokens.weak),
            Badge::Turned { .. } => ("Compare", "Compare with the reference", tokens.accent_text),
            Badge::Free(_) => ("To the shot", "To the shot", tokens.accent_text),
        }
    };
    if text_button(ui, verb, name, colour) {
        match (input.now.is_some(), input.badge) {
            (true, _) | (false, Badge::Turned { .. }) => events.asks.push(Ask::Act(Action::Compare)),
            (false, Badge::Reference(_)) => events.recapture = true,
            (false, Badge::Free(_)) => events.look = Some(CameraChoice::Shot),
        }
    }
    ui.add_space(2.0);
}

/// A button of plain words. Returns whether it was clicked.
fn text_button(ui: &mut Ui, words: &str, name: &str, colour: egui::Color32) -> bool {
    let tokens = Tokens::of(ui);
    let galley = ui.painter().layout_no_wrap(words.to_owned(), type_face::small(), colour);
    let size = galley.size() + vec2(12.0, 0.0);
    let (rect, response) = ui.allocate_exact_size(vec2(size.x, 24.0), egui::Sense::click());
    if response.hovered() || response.has_focus() {
        ui.painter().rect_filled(rect, 4.0, tokens.hov);
    }
    let at = rect.center() - galley.size() * 0.5;
    ui.painter().galley(at, galley, colour);
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, name));
    response.clicked()
}

fn axis_view(axis: glam::Vec3) -> AxisView {
    let largest = axis.abs().max_position();
    match (largest, axis[largest] > 0.0) {
        (0, true) => AxisView::Right,
        (0, false) => AxisView::Left,
        (1, true) => AxisView::Top,
        (1, false) => AxisView::Bottom,
        (_, true) => AxisView::Front,
        (_, false) => AxisView::Back,
    }
}
