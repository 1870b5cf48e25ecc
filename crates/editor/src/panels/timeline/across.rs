//! What the timeline's two rulers share: the scale from frames to points, the scrubbing and the drawing. One ruler
//! belongs to the strip, the other to the lanes.

use egui::{Align2, Pos2, Rect, Response, Role, Shape, Ui, WidgetInfo, accesskit, pos2, vec2};
use impasto_editor_model::timeline::TimelineEvent;

use crate::panels::{Ask, PanelInput};
use crate::theme::{Tokens, type_face};

/// Half the width of a key, in points.
pub(in crate::panels) const KEY: f32 = 5.5;

/// Maps the frames from `first` to `last` onto the points from `left` to `right`.
#[derive(Clone, Copy, Debug)]
pub(in crate::panels) struct FrameScale {
    pub(in crate::panels) left: f32,
    pub(in crate::panels) right: f32,
    pub(in crate::panels) first: f64,
    pub(in crate::panels) last: f64,
}

impl FrameScale {
    fn span(self) -> f64 {
        (self.last - self.first).max(1.0)
    }

    pub(in crate::panels) fn x(self, frame: f64) -> f32 {
        self.left + (self.right - self.left) * ((frame - self.first) / self.span()) as f32
    }

    /// The frame under `x`, not rounded, and perhaps beyond the ends.
    pub(in crate::panels) fn place(self, x: f32) -> f64 {
        self.first + f64::from((x - self.left) / (self.right - self.left)) * self.span()
    }

    /// The whole frame under `x`, within the ends.
    pub(in crate::panels) fn frame(self, x: f32) -> f64 {
        // The ends of a zoomed ruler may lie between frames.
        let (first, last) = (self.first.ceil(), self.last.floor());
        self.place(x).round().clamp(first, last.max(first))
    }

    /// How many frames lie between labels that are at least `points` apart: 1, 2 or 5 times a power of ten.
    pub(in crate::panels) fn label_step(self, points: f32) -> f64 {
        let least = self.span() / f64::from((self.right - self.left).max(1.0)) * f64::from(points);
        let power = 10_f64.powf(least.max(1.0).log10().floor());
        let steps = [1.0, 2.0, 5.0, 10.0].map(|part| part * power);
        steps.into_iter().find(|step| *step >= least).unwrap_or(steps[3])
    }

    /// The frames that get a tick: whole frames at multiples of half of `step`. The flag of each tells whether the
    /// frame is a multiple of `step` itself and so gets a label. A `step` of 10 gives ticks at 0, 5, 10 and labels at 0
    /// and 10.
    pub(in crate::panels) fn ticks(self, step: f64) -> impl Iterator<Item = (f64, bool)> {
        let half = step / 2.0;
        let begin = (self.first / half).ceil();
        let count = ((self.last - self.first) / half).floor().max(0.0) as usize;
        (0..=count)
            .map(move |index| (begin + index as f64) * half)
            .filter(move |frame| *frame <= self.last && frame.fract() == 0.0)
            .map(move |frame| (frame, frame.rem_euclid(step) == 0.0))
    }
}

/// Lets a press or a drag on a ruler show the frame under the pointer; playback pauses meanwhile. Screen readers can
/// set the frame too.
pub(in crate::panels) fn scrub(
    ui: &Ui,
    response: &Response,
    across: FrameScale,
    shown: &PanelInput<'_>,
    asks: &mut Vec<Ask>,
) {
    let frame = shown.session.frame;
    response.widget_info(|| {
        let mut info = WidgetInfo::labeled(Role::Slider, true, "Ruler");
        info.value = Some(frame);
        info
    });
    response.ctx.accesskit_node_builder(response.id, |node| {
        node.set_min_numeric_value(across.first);
        node.set_max_numeric_value(across.last);
        node.add_action(accesskit::Action::SetValue);
    });
    let requested = response.ctx.input(|input| {
        let asked = input.accesskit_action_requests(response.id, accesskit::Action::SetValue).last();
        asked.and_then(|request| match request.data {
            Some(accesskit::ActionData::NumericValue(value)) => Some(value),
            _ => None,
        })
    });
    if let Some(to) = requested.filter(|value| value.is_finite()) {
        asks.push(Ask::Timeline(TimelineEvent::GoTo(to.clamp(across.first, across.last))));
    }
    let is_down = response.is_pointer_button_down_on() && ui.input(|input| input.pointer.primary_down());
    let held = is_down || response.clicked();
    let was_held = ui.data_mut(|data| {
        let was_held = data.get_temp::<bool>(response.id).unwrap_or_default();
        data.insert_temp(response.id, is_down);
        was_held
    });
    if let Some(at) = response.interact_pointer_pos().filter(|_| held) {
        let to = across.frame(at.x);
        if to != frame || !was_held {
            asks.push(Ask::Timeline(TimelineEvent::Scrub(to)));
        }
    }
    if (was_held || held) && !is_down {
        asks.push(Ask::Timeline(TimelineEvent::EndScrub));
    }
}

/// Draws the number of a tick, beside or above the tick.
pub(in crate::panels) fn number(ui: &Ui, at: Pos2, align: Align2, frame: f64) {
    ui.painter().text(at, align, format!("{frame}"), type_face::ruler(), Tokens::of(ui).weak);
}

/// Draws a bar, with its upper edge at `top`, at each frame that playback has dropped.
pub(in crate::panels) fn drops(ui: &Ui, across: FrameScale, top: f32, shown: &PanelInput<'_>) {
    let wide = ((across.right - across.left) / across.span() as f32).max(2.0);
    for frame in shown.time.playback.missed() {
        let left = across.x(frame as f64);
        let rect = Rect::from_min_size(pos2(left - wide / 2.0, top), vec2(wide, 4.0));
        ui.painter().rect_filled(rect, 0.0, Tokens::of(ui).ochre);
    }
}

/// Draws a line along the frames whose exact pictures are cached.
pub(in crate::panels) fn finished(ui: &Ui, clip: Rect, across: FrameScale, y: f32, shown: &PanelInput<'_>) {
    let half = (across.right - across.left) / across.span() as f32 / 2.0;
    let (painter, colour) = (ui.painter().with_clip_rect(clip), Tokens::of(ui).viridian);
    let mut frames = shown.numbers.finished.iter().copied().peekable();
    while let Some(first) = frames.next() {
        let mut last = first;
        while let Some(next) = frames.next_if_eq(&(last + 1)) {
            last = next;
        }
        let [left, right] = [first, last].map(|frame| across.x(frame as f64));
        painter.hline(left - half..=right + half, y, (3.0, colour));
    }
}

pub(in crate::panels) fn diamond(centre: Pos2, half: f32) -> Vec<Pos2> {
    [vec2(0.0, -half), vec2(half, 0.0), vec2(0.0, half), vec2(-half, 0.0)]
        .map(|corner| centre + corner)
        .to_vec()
}

pub(in crate::panels) fn filled(points: Vec<Pos2>, colour: egui::Color32) -> Shape {
    Shape::convex_polygon(points, colour, egui::Stroke::NONE)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn across(first: f64, last: f64, wide: f32) -> FrameScale {
        FrameScale { left: 100.0, right: 100.0 + wide, first, last }
    }

    #[test]
    fn labels_stand_as_far_apart_as_they_need() {
        // 120 frames on a narrow and a wide strip, and with closer labels; then a long film and a single second.
        assert_eq!(across(0.0, 119.0, 786.0).label_step(128.0), 20.0);
        assert_eq!(across(0.0, 119.0, 1388.0).label_step(128.0), 20.0);
        assert_eq!(across(0.0, 119.0, 1388.0).label_step(90.0), 10.0);
        assert_eq!(across(0.0, 10_000.0, 786.0).label_step(128.0), 2000.0);
        assert_eq!(across(0.0, 23.0, 3200.0).label_step(128.0), 1.0);
    }

    #[test]
    fn a_place_on_the_ruler_and_its_frame_agree() {
        let across = FrameScale { left: 232.0, right: 1018.0, first: -10.0, last: 119.0 };
        for frame in [-10.0, 0.0, 37.0, 119.0] {
            assert_eq!(across.frame(across.x(frame)), frame);
        }
        assert_eq!(across.frame(0.0), -10.0);
        assert_eq!(across.frame(5000.0), 119.0);
        let still = FrameScale { first: 4.0, last: 4.0, ..across };
        assert_eq!(still.frame(600.0), 4.0);
        // Zoomed in, the ends lie between frames.
        let zoomed = FrameScale { first: 12.3, last: 30.6, ..across };
        assert_eq!([0.0, 5000.0].map(|x| zoomed.frame(x)), [13.0, 30.0]);
    }

    #[test]
    fn ticks_lie_within_the_ends_and_on_whole_frames() {
        let ticks: Vec<_> = across(-3.0, 21.0, 100.0).ticks(20.0).collect();
        assert_eq!(ticks, [(0.0, true), (10.0, false), (20.0, true)]);
        // Half of a step of five is no whole frame.
        let fives: Vec<_> = across(0.0, 12.0, 100.0).ticks(5.0).map(|(frame, _)| frame).collect();
        assert_eq!(fives, [0.0, 5.0, 10.0]);
        assert!(across(0.0, 9.0, 100.0).ticks(1.0).all(|(frame, labelled)| frame.fract() == 0.0 && labelled));
    }
}
