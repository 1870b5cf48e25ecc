//! Exact pictures of a shot's frames, kept in memory, so that playing again shows them at the full rate.

use std::sync::Arc;

use egui::ColorImage;

use super::ViewJob;

/// Kept pictures take no more than this, bytes: 260 frames of a window of 1280x800.
const MOST_BYTES: usize = 1 << 30;

/// Kept pictures also take no more than the available memory divided by this.
const SHARE: u64 = 4;

/// The exact picture of one frame.
#[derive(Clone)]
pub(super) struct Finished {
    /// What it is a picture of.
    pub(super) view: ViewJob,
    /// The version of its scene.
    pub(super) serial: u64,
    pub(super) image: Arc<ColorImage>,
    /// How many strokes it has, and how many of each region.
    pub(super) strokes: (usize, Vec<usize>),
}

impl Finished {
    fn bytes(&self) -> usize {
        bytes_of(&self.view)
    }
}

/// What the picture of a view takes, bytes.
fn bytes_of(view: &ViewJob) -> usize {
    view.size_px.iter().map(|&side| side as usize).product::<usize>() * 4
}

/// The kept pictures, all of one version of the scene.
#[derive(Default)]
pub(super) struct Film {
    /// The oldest first.
    kept: Vec<Finished>,
}

impl Film {
    /// The picture of a view, if it is kept.
    pub(super) fn of(&self, view: &ViewJob, serial: u64) -> Option<&Finished> {
        self.kept.iter().find(|kept| kept.serial == serial && kept.view.looks_like(view))
    }

    /// The frames of these views whose pictures are kept, in order.
    pub(super) fn frames(&self, views: &[ViewJob], serial: u64) -> Vec<i64> {
        let kept = views.iter().filter(|view| self.of(view, serial).is_some());
        let mut frames: Vec<i64> = kept.map(|view| view.frame as i64).collect();
        frames.sort_unstable();
        frames
    }

    /// Keeps a picture. If there is no room, pictures that are not `wanted` make way. If there is still no room, it
    /// is not kept, and false is returned.
    pub(super) fn keep(&mut self, finished: Finished, wanted: &[ViewJob]) -> bool {
        self.keep_within(finished, wanted, most_bytes())
    }

    fn keep_within(&mut self, finished: Finished, wanted: &[ViewJob], most_bytes: usize) -> bool {
        self.kept.retain(|kept| kept.serial == finished.serial);
        if self.of(&finished.view, finished.serial).is_some() {
            return true;
        }
        let mut bytes: usize = self.kept.iter().map(Finished::bytes).sum();
        let is_wanted = |kept: &Finished| wanted.iter().any(|view| kept.view.looks_like(view));
        self.kept.retain(|kept| {
            let goes = bytes + finished.bytes() > most_bytes && !is_wanted(kept);
            bytes -= if goes { kept.bytes() } else { 0 };
            !goes
        });
        let fits = bytes + finished.bytes() <= most_bytes;
        if fits {
            self.kept.push(finished);
        }
        fits
    }

    /// Drops all pictures, because the renderer would draw them differently now.
    pub(super) fn clear(&mut self) {
        self.kept.clear();
    }
}

fn most_bytes() -> usize {
    let share = impasto_scene::memory::available_bytes().map(|bytes| usize::try_from(bytes / SHARE));
    share.and_then(Result::ok).map_or(MOST_BYTES, |share| share.min(MOST_BYTES))
}

#[cfg(test)]
mod tests {
    use impasto_editor_model::session::Shading;
    use impasto_scene::{motion, new_scene};

    use super::*;

    fn view(frame: f64) -> ViewJob {
        ViewJob {
            camera: motion::camera_at(&new_scene::empty(), 0.0),
            frame,
            size_px: [10, 10],
            shot_height_px: 10.0,
            shading: Shading::Painted,
            lights: Vec::new(),
            moving: false,
        }
    }

    fn finished(view: &ViewJob, serial: u64) -> Finished {
        let image = Arc::new(ColorImage::filled([10, 10], egui::Color32::BLACK));
        Finished { view: view.clone(), serial, image, strokes: (0, Vec::new()) }
    }

    #[test]
    fn what_is_not_wanted_any_more_makes_way_and_an_edit_drops_all() {
        let mut film = Film::default();
        let wanted = [1.0, 2.0, 3.0].map(view);
        let room = 3 * 400;
        for frame in [7.0, 1.0, 2.0] {
            assert!(film.keep_within(finished(&view(frame), 1), &wanted, room));
        }
        assert_eq!(film.frames(&wanted, 1), [1, 2]);
        assert!(film.of(&view(7.0), 1).is_some(), "there was room for all");
        assert!(film.keep_within(finished(&wanted[2], 1), &wanted, room));
        assert!(film.of(&view(7.0), 1).is_none());
        assert_eq!(film.frames(&wanted, 1), [1, 2, 3]);
        // Nothing that is wanted makes way.
        assert!(!film.keep_within(finished(&view(4.0), 1), &wanted, room));
        assert!(film.keep_within(finished(&wanted[0], 1), &wanted, room), "it is kept already");
        // Another look, another version of the scene.
        let shaded = ViewJob { shading: Shading::Shaded, ..view(1.0) };
        assert!(film.of(&shaded, 1).is_none() && film.of(&view(1.0), 2).is_none());
        assert!(film.of(&ViewJob { moving: true, ..view(1.0) }, 1).is_some(), "playing is the same look");
        assert!(film.keep_within(finished(&wanted[0], 2), &wanted, room));
        assert_eq!((film.frames(&wanted, 1), film.frames(&wanted, 2)), (Vec::new(), vec![1]));
    }
}
