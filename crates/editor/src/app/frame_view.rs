//! Shows and plays the finished frames of a rendering in place of the editor's page. Closing them shows the sheet of
//! the rendering again.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use egui::{ColorImage, TextureHandle, TextureOptions, Ui};
use impasto_editor_model::finished_frames::FinishedFrames;
use impasto_editor_model::keymap::{Key, Modifiers};

use super::EditorApp;
use crate::frame_reading::FrameReading;
use crate::panels::frame_viewer::{self, ViewerAsk, ViewerShown};
use crate::window::Waker;

/// The finished frames, their files, and the one that is shown.
pub(super) struct FrameView {
    frames: FinishedFrames,
    reading: FrameReading,
    /// How many frames the rendering had finished when they were listed.
    done: u64,
    /// What is shown, with its index.
    shown: Option<(usize, Shown)>,
}

/// A picture on the screen, or why there is none.
enum Shown {
    Picture(Arc<ColorImage>, TextureHandle),
    Fault(String),
}

impl FrameView {
    /// Begins with the first of these frames.
    ///
    /// # Errors
    /// If there are no frames, or the system gives no thread.
    pub(super) fn open(
        (done, frames): (u64, Vec<(i64, PathBuf)>),
        fps: f64,
        waker: Waker,
    ) -> Result<Self, String> {
        let frames = FinishedFrames::new(frames, fps).ok_or("No finished frame is there any more")?;
        let reading = FrameReading::start(frames.paths(), move || waker.wake());
        let reading = reading.map_err(|error| format!("No thread to read the frames with: {error}"))?;
        Ok(Self { frames, reading, done, shown: None })
    }

    /// Takes the frames that are finished by now.
    fn extend(&mut self, (done, frames): (u64, Vec<(i64, PathBuf)>)) {
        self.done = done;
        if self.frames.extend(frames) && self.reading.replace(self.frames.paths()) {
            self.shown = None;
        }
    }

    /// Shows the frame that is due, or why it cannot be read. While that frame is not read yet, a viewer at rest keeps
    /// what it shows. A playing viewer shows the nearest earlier frame that is read or already shown; the last frame
    /// counts as earlier than the first.
    fn follow(&mut self, ui: &Ui, now_secs: f64) {
        let (at, count) = (self.frames.at(), self.frames.count());
        let most = if self.frames.is_playing() { count } else { 1 };
        for index in (0..most).map(|back| (at + count - back) % count) {
            let is_shown = self.shown.as_ref().is_some_and(|(shown, _)| *shown == index);
            match self.reading.picture(index) {
                Some(Ok(picture)) => {
                    let same =
                        |shown: &Shown| matches!(shown, Shown::Picture(old, _) if Arc::ptr_eq(old, &picture));
                    if !is_shown || !self.shown.as_ref().is_some_and(|(_, shown)| same(shown)) {
                        let image = Arc::clone(&picture);
                        let texture = match self.shown.take() {
                            Some((_, Shown::Picture(_, mut texture))) => {
                                texture.set(image, TextureOptions::LINEAR);
                                texture
                            }
                            _ => ui.ctx().load_texture("finished frame", image, TextureOptions::LINEAR),
                        };
                        self.shown = Some((index, Shown::Picture(picture, texture)));
                    }
                    return self.frames.shown(index, now_secs);
                }
                Some(Err(words)) => {
                    self.shown = Some((index, Shown::Fault(words)));
                    return self.frames.shown(index, now_secs);
                }
                None if is_shown => return,
                None => {}
            }
        }
    }
}

impl EditorApp {
    /// Shows the finished frames, and carries out what the user asks there.
    pub(super) fn show_frames(&mut self, ui: &mut Ui, numpad: &[(Key, Modifiers)]) {
        let is_covered = self.has_sheet();
        let Some(view) = &mut self.frame_view else { return };
        if let Some(finished) = self.render.finished_since(view.done) {
            view.extend(finished);
        }
        let now = ui.input(|input| input.time);
        view.frames.tick(now);
        view.follow(ui, now);
        let size = ui.max_rect().size() * ui.ctx().pixels_per_point();
        view.reading.want(view.frames.wanted(), [size.x, size.y].map(|side| side.max(1.0) as usize));
        let shown = ViewerShown {
            frames: &view.frames,
            picture: match &view.shown {
                Some((_, Shown::Picture(_, texture))) => Some(texture),
                _ => None,
            },
            shown: view.shown.as_ref().map(|(index, _)| *index),
            fault: match &view.shown {
                Some((_, Shown::Fault(words))) => Some(words),
                _ => None,
            },
            keymap: &self.editor.keymap,
            numpad,
            is_covered,
        };
        let asked = frame_viewer::frame_viewer(ui, &shown);
        let frames = &mut view.frames;
        match asked {
            None => {}
            Some(ViewerAsk::Close) => {
                self.frame_view = None;
                return self.render.unfold();
            }
            Some(ViewerAsk::PlayOrStop) => frames.play_or_stop(now),
            Some(ViewerAsk::GoTo(index)) => frames.go_to(index),
            Some(ViewerAsk::Step(by)) => frames.step(by),
            Some(ViewerAsk::Loop(looped)) => frames.looped = looped,
        }
        match frames.wait_secs(now) {
            Some(wait) => ui.ctx().request_repaint_after(Duration::from_secs_f64(wait.min(1.0))),
            None if asked.is_some() => ui.ctx().request_repaint(),
            None => {}
        }
    }
}
