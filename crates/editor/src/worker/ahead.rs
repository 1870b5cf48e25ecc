//! During playback, computes the next frame on a thread of its own while this one is drawn.

use std::sync::Arc;
use std::thread::JoinHandle;

use impasto_painting::{Frame, Painting, Recall};

use super::ViewJob;
use super::view_frame::{DrawOptions, frame_of};

/// A frame that is computed before it is asked for.
#[derive(Default)]
pub(super) struct Ahead(Option<Computing>);

struct Computing {
    view: ViewJob,
    size_px: [u32; 2],
    is_exact: bool,
    serial: u64,
    frame: JoinHandle<Frame>,
}

impl Ahead {
    /// Begins to compute the frame of a view that will likely be asked for next, at the size and quality of `options`.
    pub(super) fn begin(
        &mut self,
        painting: &Painting,
        serial: u64,
        view: &ViewJob,
        options: &DrawOptions<'_>,
        recall: Option<Arc<Recall>>,
    ) {
        let (size_px, is_exact) = (options.size_px, options.is_exact);
        let (painting, theirs) = (painting.clone(), view.clone());
        let compute = move || {
            let options = DrawOptions { size_px, is_exact, give_up: &|| false };
            frame_of(&painting, &theirs, &options, recall.as_deref())
        };
        // If no thread can be started, the frame is computed when it is asked for.
        let thread = std::thread::Builder::new().name("ahead".to_owned()).spawn(compute);
        self.0 = thread.ok().map(|frame| Computing { view: view.clone(), size_px, is_exact, serial, frame });
    }

    /// Takes the frame computed ahead, with its view; `None` if the frame cannot be shown for `view`. Scene, sizes,
    /// quality and shading must be those asked for here. The view of the frame must look like `view`, or be one frame
    /// before it while playback goes on to `next`.
    pub(super) fn take(
        &mut self,
        serial: u64,
        view: &ViewJob,
        next: Option<&ViewJob>,
        options: &DrawOptions<'_>,
    ) -> Option<(ViewJob, Frame)> {
        let ahead = self.0.take()?;
        let goes_on = next.is_some_and(|next| next.frame > view.frame);
        let is_just_before = goes_on && view.frame - ahead.view.frame == 1.0;
        let is_like = ahead.serial == serial
            && (ahead.size_px, ahead.is_exact) == (options.size_px, options.is_exact)
            && ahead.view.size_px == view.size_px
            && ahead.view.shot_height_px == view.shot_height_px
            && ahead.view.shading == view.shading
            && (view.looks_like(&ahead.view) || is_just_before);
        // If that thread panicked, the frame is computed again on this one, where a panic is reported.
        let frame = is_like.then(|| ahead.frame.join().ok()).flatten()?;
        Some((ahead.view, frame))
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use impasto_editor_model::session::Shading;
    use impasto_painting::prepare;
    use impasto_scene::load::{LoadOptions, load};
    use impasto_scene::motion;

    use super::*;

    #[test]
    fn what_is_computed_ahead_is_what_is_computed_in_its_turn() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/roll.ron");
        let painting = prepare(Arc::new(load(&path, &LoadOptions::default()).unwrap())).unwrap();
        let view = |frame| ViewJob {
            camera: motion::camera_at(painting.scene(), frame),
            frame,
            size_px: [160, 90],
            shot_height_px: 90.0,
            shading: Shading::Painted,
            lights: Vec::new(),
            moving: true,
        };
        let options = |side| DrawOptions { size_px: [side, 45], is_exact: false, give_up: &|| false };
        let mut ahead = Ahead::default();
        let next = view(6.0);
        assert!(ahead.take(1, &view(3.0), None, &options(80)).is_none());
        for (asked, next) in [(3.0, None), (4.0, Some(&next))] {
            ahead.begin(&painting, 1, &view(3.0), &options(80), None);
            let (of, frame) = ahead.take(1, &view(asked), next, &options(80)).unwrap();
            assert_eq!(of.frame, 3.0);
            let there = frame_of(&painting, &view(3.0), &options(80), None);
            assert!(!there.strokes.is_empty());
            assert_eq!(format!("{:?}", frame.strokes), format!("{:?}", there.strokes));
        }
        // Another frame, scene or size: the computed frame cannot be used.
        for (serial, asked, side) in [(1, 5.0, 80), (1, 2.0, 80), (2, 3.0, 80), (1, 3.0, 96)] {
            ahead.begin(&painting, 1, &view(3.0), &options(80), None);
            let taken = ahead.take(serial, &view(asked), Some(&next), &options(side));
            assert!(taken.is_none(), "{serial} {asked} {side}");
        }
        // At the end of playback the last frame itself is drawn, never the one before it.
        ahead.begin(&painting, 1, &view(3.0), &options(80), None);
        assert!(ahead.take(1, &view(4.0), Some(&view(4.0)), &options(80)).is_none());
    }
}
