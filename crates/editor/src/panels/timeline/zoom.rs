//! Zooms the timeline: decides which frames its ruler spans, all or only those that the user zoomed to.

use egui::{Id, Rect, Ui};

use super::across::FrameScale;

/// The fewest frames that zooming in leaves visible.
const FEWEST: f64 = 8.0;

/// What is remembered between passes: the first and last visible frame (`None` for all frames), and the shown frame.
#[derive(Clone, Copy, Default)]
struct VisibleFrames {
    frames: Option<[f64; 2]>,
    shown: f64,
}

/// Handles the input of a pass, and returns the visible frames. `Ctrl` and the wheel zoom about the pointer, `Shift`
/// and the wheel pan, and a double click on the ruler shows all frames. The visible part follows the playhead.
pub(super) fn seen(ui: &Ui, area: Rect, ruler: Rect, whole: FrameScale, frame: f64) -> FrameScale {
    let id = Id::unique("frames that are seen");
    let mut seen = ui.data_mut(|data| data.get_temp::<VisibleFrames>(id)).unwrap_or_default();
    let (pointer, zoom, along, is_double) = ui.input(|input| {
        let is_double = input.pointer.button_double_clicked(egui::PointerButton::Primary);
        (input.pointer.hover_pos(), f64::from(input.zoom_delta()), input.smooth_scroll_delta().x, is_double)
    });
    if let Some(at) = pointer.filter(|at| area.contains(*at)) {
        seen.frames = zoomed(whole, seen.frames, zoom, at.x, along);
        if is_double && ruler.contains(at) {
            seen.frames = None;
        }
    }
    if seen.shown != frame {
        seen.frames = seen.frames.map(|frames| holding(frames, whole, frame));
    }
    seen.shown = frame;
    // The scene's range of frames may have changed since the last pass.
    seen.frames = seen.frames.and_then(|frames| within(frames, whole));
    ui.data_mut(|data| data.insert_temp(id, seen));
    seen.frames.map_or(whole, |[first, last]| FrameScale { first, last, ..whole })
}

/// The visible frames after a turn of the wheel; `None` for all of them.
fn zoomed(whole: FrameScale, frames: Option<[f64; 2]>, zoom: f64, x: f32, along_px: f32) -> Option<[f64; 2]> {
    let [first, last] = frames.unwrap_or([whole.first, whole.last]);
    if !zoom.is_finite() || zoom <= 0.0 || (zoom == 1.0 && along_px == 0.0) {
        return frames;
    }
    let now = FrameScale { first, last, ..whole };
    let place = now.place(x).clamp(first, last);
    let all = whole.last - whole.first;
    let span = ((last - first) / zoom).clamp(FEWEST.min(all), all);
    let share = if last > first { (place - first) / (last - first) } else { 0.0 };
    let moved = f64::from(along_px / (whole.right - whole.left)) * span;
    let first = place - share * span - moved;
    within([first, first + span], whole)
}

/// The frames shifted to lie within the whole; `None` if they span all of it.
fn within([first, last]: [f64; 2], whole: FrameScale) -> Option<[f64; 2]> {
    let (all, span) = (whole.last - whole.first, last - first);
    if span >= all * (1.0 - 1e-9) {
        return None;
    }
    let first = first.clamp(whole.first, whole.last - span);
    Some([first, first + span])
}

/// As many frames as before, shifted so that `frame` is among them.
fn holding([first, last]: [f64; 2], whole: FrameScale, frame: f64) -> [f64; 2] {
    let span = last - first;
    let first = if frame > last {
        // Playback goes on to the right: leave most of the room there.
        frame - 0.1 * span
    } else {
        first.min(frame)
    };
    within([first, first + span], whole).unwrap_or([whole.first, whole.last])
}

#[cfg(test)]
mod tests {
    use super::*;

    const WHOLE: FrameScale = FrameScale { left: 200.0, right: 1200.0, first: 0.0, last: 100.0 };

    #[test]
    fn the_frame_under_the_pointer_stays_there() {
        let mut frames: Option<[f64; 2]> = None;
        for (zoom, x) in [(2.0, 700.0), (1.5, 700.0), (1.25, 700.0)] {
            let before = frames.map_or(WHOLE, |[first, last]| FrameScale { first, last, ..WHOLE }).place(x);
            frames = zoomed(WHOLE, frames, zoom, x, 0.0);
            let [first, last] = frames.expect("zoomed in");
            let after = FrameScale { first, last, ..WHOLE }.place(x);
            assert!((before - after).abs() < 1e-9, "{before} {after}");
        }
        let [first, last] = frames.expect("zoomed in");
        assert!((last - first - 100.0 / 3.75).abs() < 1e-9);
        assert_eq!(zoomed(WHOLE, frames, 0.01, 700.0, 0.0), None, "zoomed out again: all frames show");
    }

    #[test]
    fn it_stays_within_the_whole_and_above_the_fewest() {
        let [first, last] = zoomed(WHOLE, None, 1e9, 1200.0, 0.0).expect("zoomed in");
        assert_eq!([first, last], [92.0, 100.0]);
        assert_eq!(zoomed(WHOLE, Some([92.0, 100.0]), 1.0, 700.0, -5000.0), Some([92.0, 100.0]));
        assert_eq!(zoomed(WHOLE, Some([92.0, 100.0]), 1.0, 700.0, 500.0), Some([88.0, 96.0]));
        assert_eq!(zoomed(WHOLE, Some([20.0, 40.0]), f64::NAN, 700.0, 0.0), Some([20.0, 40.0]));
        let still = FrameScale { first: 4.0, last: 4.0, ..WHOLE };
        assert_eq!(zoomed(still, None, 2.0, 700.0, 3.0), None);
    }

    #[test]
    fn the_playhead_is_followed() {
        assert_eq!(holding([20.0, 40.0], WHOLE, 30.0), [20.0, 40.0]);
        assert_eq!(holding([20.0, 40.0], WHOLE, 41.0), [39.0, 59.0]);
        assert_eq!(holding([20.0, 40.0], WHOLE, 99.0), [80.0, 100.0]);
        assert_eq!(holding([20.0, 40.0], WHOLE, 0.0), [0.0, 20.0]);
    }
}
