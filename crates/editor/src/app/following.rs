//! `impasto edit --follow`: follows another program, which writes its frame and view to our standard input as lines of
//! JSON. `{"frame": 12}` goes to a frame, `{"view": {"eye": …, "target": …}}` to a free view, and `{"view": null}` to
//! the shot camera.

use std::io::{BufRead as _, Read as _};
use std::sync::mpsc::{Receiver, channel};

use impasto_editor_model::camera_rig::Looking;
use impasto_editor_model::timeline::TimelineEvent;
use serde::{Deserialize, Deserializer};

use super::EditorApp;
use super::last_seen::free_view;
use crate::files::preferences::LastView;
use crate::window::Waker;

/// The longest line that is read, in bytes.
const LONGEST_LINE: u64 = 1 << 16;

/// What a line says. A field that the line leaves out is `None`, and changes nothing.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub(super) struct Told {
    #[serde(default)]
    frame: Option<f64>,
    /// `Some(None)` for the shot camera.
    #[serde(default, deserialize_with = "stated")]
    view: Option<Option<LastView>>,
}

/// Reads the value of a field that is present, as `Some`: `null` gives `Some(None)`.
fn stated<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<Option<LastView>>, D::Error> {
    Option::deserialize(deserializer).map(Some)
}

impl Told {
    /// Takes over what a later line says.
    fn then(&mut self, later: Self) {
        self.frame = later.frame.or(self.frame);
        self.view = later.view.or_else(|| self.view.take());
    }
}

/// The lines of the program that is followed; `told` is `None` if no program is followed.
#[derive(Default)]
pub(super) struct Following {
    told: Option<Receiver<Told>>,
}

impl Following {
    /// Begins to read standard input. At its end the window stays as it is.
    pub(super) fn stdin(waker: Waker) -> Self {
        let (send, told) = channel();
        std::thread::spawn(move || {
            let mut input = std::io::stdin().lock();
            loop {
                let mut line = Vec::new();
                let read = input.by_ref().take(LONGEST_LINE).read_until(b'\n', &mut line);
                if !matches!(read, Ok(count) if count > 0) {
                    return;
                }
                // A later version of the program may write lines that are unknown here: skip them.
                let Ok(told) = serde_json::from_slice(&line) else { continue };
                if send.send(told).is_err() {
                    return;
                }
                waker.wake();
            }
        });
        Self { told: Some(told) }
    }
}

impl EditorApp {
    /// Goes to the frame and the view that the other program shows. Lines that come during playback, or while the user
    /// moves the view, are dropped, so that the user is not disturbed.
    pub(super) fn follow(&mut self) {
        let Some(told) = &self.following.told else { return };
        let Some(mut last) = told.try_recv().ok() else { return };
        told.try_iter().for_each(|later| last.then(later));
        if self.editor.time().playback.is_playing() || self.editor.is_navigating() {
            return;
        }
        if let Some(frame) =
            last.frame.filter(|frame| frame.is_finite() && *frame != self.editor.session.frame)
        {
            self.editor.timeline(TimelineEvent::Scrub(frame));
            self.editor.timeline(TimelineEvent::EndScrub);
        }
        match last.view {
            Some(Some(view)) if view.is_sound() => {
                self.editor.looking = Looking::Free(free_view(&view, &self.editor.shot()));
            }
            Some(None) => self.editor.looking = Looking::Shot,
            _ => {}
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_word_counts() {
        let line = |text: &str| serde_json::from_str::<Told>(text).unwrap();
        let mut told = line(r#"{"frame": 3, "view": {"eye": [0, 0, 1], "target": [0, 0, 0]}}"#);
        assert!(matches!(&told.view, Some(Some(view)) if view.eye == [0.0, 0.0, 1.0]));
        told.then(line(r#"{"frame": 4}"#));
        assert!(told.frame == Some(4.0) && matches!(told.view, Some(Some(_))));
        told.then(line(r#"{"view": null, "of later": 1}"#));
        assert_eq!(told, Told { frame: Some(4.0), view: Some(None) });
    }
}
