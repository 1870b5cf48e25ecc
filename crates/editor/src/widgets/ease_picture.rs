//! Eases as lines, and a choice of them: each with its picture and its name.

use egui::{Align2, Color32, Painter, Pos2, Rect, Sense, Ui, pos2, vec2};
use impasto_editor_model::command::{ease_name, same_ease};
use impasto_editor_model::timeline::eases;
use impasto_scene::document::Ease;

use super::draw;
use super::segmented::choice;
use crate::theme::{Tokens, type_face};

/// Size of the picture of an ease beside its name.
const PICTURE: egui::Vec2 = vec2(17.0, 12.0);
const HEIGHT: f32 = 26.0;
const COLUMNS: usize = 3;

/// The curve of an ease between two keys. Time runs from x `from` to x `to`. The value of the first key is at y `low`,
/// that of the second at y `high`.
pub fn ease_line([from, to]: [f32; 2], [low, high]: [f32; 2], ease: Ease) -> Vec<Pos2> {
    let steps = match ease {
        Ease::Step => return vec![pos2(from, low), pos2(to, low), pos2(to, high)],
        Ease::Linear => 1_u8,
        Ease::Bounce => 96,
        _ => 48,
    };
    let at = |step: u8| {
        let time = f32::from(step) / f32::from(steps);
        pos2(from + (to - from) * time, low + (high - low) * ease.share(f64::from(time)) as f32)
    };
    (0..=steps).map(at).collect()
}

/// A small picture of an ease, scaled so that it fills the rectangle, overshoot included.
pub fn ease_picture(painter: &Painter, rect: Rect, ease: Ease, colour: Color32) {
    let [least, most] = ease.reach().map(|share| share as f32);
    let y = |share: f32| rect.bottom() - rect.height() * (share - least) / (most - least);
    painter.line(ease_line([rect.left(), rect.right()], [y(0.0), y(1.0)], ease), (1.4, colour));
}

/// Draws the picture of an ease at the left end of a menu row.
pub fn ease_before_row(ui: &Ui, row: Rect, ease: Ease) {
    let rect = Rect::from_center_size(row.left_center() + vec2(15.0, 0.0), PICTURE);
    ease_picture(ui.painter(), rect, ease, Tokens::of(ui).text);
}

/// All eases in a grid, with `now` on; each is named as in *Ease smooth*. Returns the ease that was picked.
pub fn ease_choice(ui: &mut Ui, now: Ease) -> Option<Ease> {
    let tokens = Tokens::of(ui);
    let all = eases(Some(now));
    let wide = ui.available_width();
    let rows = all.len().div_ceil(COLUMNS);
    let (rect, whole) = ui.allocate_exact_size(vec2(wide, rows as f32 * HEIGHT), Sense::hover());
    ui.painter().rect_filled(rect, draw::group_corner(), tokens.field);
    let mut picked = None;
    for (index, ease) in all.into_iter().enumerate() {
        let size = vec2(wide / COLUMNS as f32, HEIGHT);
        let corner = vec2((index % COLUMNS) as f32 * size.x, (index / COLUMNS) as f32 * size.y);
        let part = Rect::from_min_size(rect.min + corner, size);
        let response = ui.interact(part, whole.id.with(index), Sense::click());
        let on = same_ease(ease, now);
        if response.clicked() && !on {
            picked = Some(ease);
        }
        let seen = part.shrink(2.0);
        let name = ease_name(ease);
        let colour = choice(ui, &response, seen, &format!("Ease {name}"), on);
        let picture = Rect::from_center_size(seen.left_center() + vec2(14.0, 0.0), PICTURE);
        ease_picture(ui.painter(), picture, ease, colour);
        let at = seen.left_center() + vec2(27.0, 0.0);
        draw::words(ui.painter(), at, Align2::LEFT_CENTER, &capital(name), type_face::small(), colour);
    }
    picked
}

fn capital(name: &str) -> String {
    let mut name = name.to_owned();
    if let Some(first) = name.get_mut(..1) {
        first.make_ascii_uppercase();
    }
    name
}
