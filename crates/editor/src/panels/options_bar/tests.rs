//! Tests that the options bar has room for long words at every width.

use egui::{Rect, accesskit, pos2, vec2};
use impasto_editor_model::keymap::Keymap;
use impasto_editor_model::session::{FillKind, RegionBy};
use impasto_editor_model::{Document, Session};

use super::*;
use crate::theme::{self, Theme};

/// German translations, as examples of long words. What is not listed stays English.
fn german(words: &'static str) -> &'static str {
    match words {
        "Along" => "Entlang",
        "Against" => "Entgegengesetzt",
        "Strength" => "Pinselst\u{e4}rke",
        "Falloff" => "Randabfall",
        "Steady" => "Beruhigung",
        "Mirror" => "Spiegeln",
        "Front faces only" => "Nur sichtbare Vorderseiten",
        "Automatic" => "Automatisch",
        "Curvature" => "Kr\u{fc}mmung",
        "Up" => "Aufw\u{e4}rts",
        "Around" => "Rundherum",
        "Angle" => "Winkelrichtung",
        "Flip" => "Umkehren",
        "By angle" => "Um einen Winkel",
        "Smooth" => "Gl\u{e4}tten",
        "Smear" => "Verwischen",
        "Brush" => "Pinselstriche",
        "Flood" => "Zusammenh\u{e4}ngend",
        "Group" => "Netzgruppe",
        "New" => "Neue Region",
        "Add" => "Hinzuf\u{fc}gen",
        "Take away" => "Wegnehmen",
        "Snap" => "Einrasten",
        "World" => "Weltachsen",
        "Local" => "Objektachsen",
        "View" => "Ansicht",
        "Guide curve" => "Richtungskurve",
        "Fill direction" => "Richtung f\u{fc}llen",
        "Erase to automatic" => "Auf Automatik zur\u{fc}cksetzen",
        words => words,
    }
}

/// Returns the box of each named control and label. The bar is `wide` points across, the window `window` points.
fn boxes(session: &Session, (wide, window): (f32, f32), say: Translate) -> Vec<(String, Rect)> {
    let ctx = egui::Context::default();
    ctx.enable_accesskit();
    theme::apply(&ctx, Theme::Dark, 1.0);
    let document = Document::empty(std::path::Path::new("."));
    let (time, keymap) = (Default::default(), Keymap::default());
    let shown = PanelInput::of(&document, session, &time, &keymap);
    let size = Rect::from_min_size(pos2(0.0, 0.0), vec2(window, 800.0));
    let input = || egui::RawInput { screen_rect: Some(size), ..egui::RawInput::default() };
    let mut found = Vec::new();
    for _ in 0..2 {
        let mut output = ctx.run_ui(input(), |ui| {
            let rect = Rect::from_min_size(pos2(0.0, 40.0), vec2(wide, measure::OPTIONS_BAR));
            within(ui, rect, row(), |ui| bar(ui, &shown, say));
        });
        let nodes =
            output.platform_output.accesskit_update.take().map(|update| update.nodes).unwrap_or_default();
        found = nodes.into_iter().filter_map(|(_, node)| named_box(&node)).collect();
        output.drop_without_applying_deltas();
    }
    found
}

fn named_box(node: &accesskit::Node) -> Option<(String, Rect)> {
    let name = node.label().or(node.value())?.to_owned();
    let bounds = node.bounds()?;
    let corner = |x: f64, y: f64| pos2(x as f32, y as f32);
    Some((name, Rect::from_min_max(corner(bounds.x0, bounds.y0), corner(bounds.x1, bounds.y1))))
}

fn sessions() -> Vec<Session> {
    let posing = [Tool::Select, Tool::Move, Tool::Turn, Tool::Scale, Tool::AddLight, Tool::ShotCamera];
    let paint = [
        Tool::Comb,
        Tool::GuideCurve,
        Tool::Fill,
        Tool::TurnDirection,
        Tool::Smooth,
        Tool::Erase,
        Tool::Amount,
        Tool::Region,
        Tool::Pick,
    ];
    let mut sessions = Vec::new();
    for tool in posing.into_iter().chain(paint) {
        let mode = if tool.is_for_paint() { Mode::Paint } else { Mode::Arrange };
        let mut session = Session { mode, ..Session::default() };
        session.set_tool(tool);
        session.options.fill = FillKind::Angle;
        for region_by in [RegionBy::Brush, RegionBy::Flood] {
            session.options.region_by = region_by;
            sessions.push(session.clone());
        }
    }
    sessions
}

#[test]
fn long_words_are_never_cut_and_never_overlap() {
    // Pairs of widths, of the bar and of the window. In the first two pairs, with the window sizes of the design, the
    // right column takes the rest of the window. In the third there is no column.
    for (wide, window) in [(1000.0, 1280.0), (1584.0, 1920.0), (960.0, 960.0)] {
        for session in sessions() {
            for say in [german as Translate, |words| words] {
                let boxes = boxes(&session, (wide, window), say);
                let tool = session.tool();
                assert!(boxes.iter().any(|(name, _)| name == "More tool options"), "{tool:?}");
                for (index, (name, rect)) in boxes.iter().enumerate() {
                    assert!(rect.right() <= wide, "{tool:?}: {name} ends at {}", rect.right());
                    assert!(
                        rect.top() >= 40.0 && rect.bottom() <= 80.0,
                        "{tool:?}: {name} leaves the bar: {rect:?}"
                    );
                    for (other, beside) in &boxes[index + 1..] {
                        let both = rect.intersect(*beside);
                        assert!(
                            both.width() <= 0.5 || both.height() <= 0.5,
                            "{tool:?}: {name} lies on {other}"
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn a_wide_window_shows_more() {
    let session = Session { mode: Mode::Paint, ..Session::default() };
    let names = |sizes| boxes(&session, sizes, |words| words).into_iter().map(|(name, _)| name);
    let narrow: Vec<_> = names((1000.0, 1280.0)).collect();
    let wide: Vec<_> = names((1584.0, 1920.0)).collect();
    for name in ["Soft falloff", "Steady", "Front faces only"] {
        assert!(!narrow.iter().any(|other| other == name), "{name} has no place at 1280");
        assert!(wide.iter().any(|other| other == name), "{name} is missing at 1920");
    }
}
