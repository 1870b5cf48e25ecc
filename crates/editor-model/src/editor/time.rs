//! Time in the editor: playing, scrubbing, keys, and loose poses (made with Auto key off and not keyed yet).

use super::{Editor, Offer, Said};
use crate::command::{Command, KeyOf, Pose, StrokesOf, Time};
use crate::keymap::Action;
use crate::playback::{Course, Pacing};
use crate::refusal::Refusal;
use crate::selection::Item;
use crate::session::Mode;
use crate::timeline::{KeyAt, KeysEvent, LoosePoses, TimeHand, TimelineEvent, lanes};

impl Editor {
    /// Playback, selected keys, poses that are not keyed.
    pub fn time(&self) -> &TimeHand {
        &self.time
    }

    /// Advances playback to `now_secs`, which is on the same clock as the pointer's events. Drops the loose poses if
    /// the current frame is no longer theirs, or the mode is no longer Animate. Must be called first in each pass of
    /// the window.
    pub fn tick(&mut self, now_secs: f64) {
        self.at_secs = now_secs;
        let (frame, mode) = (self.session.frame, self.session.mode);
        if self.time.loose.as_ref().is_some_and(|loose| loose.frame != frame || mode != Mode::Animate) {
            self.put_back();
        }
        if !self.time.playback.is_playing() {
            return;
        }
        if self.time.played != Some(frame) || self.document.scene().objects.is_empty() {
            // Something other than playback moved the playhead, or nothing is left to play.
            return self.time.playback.stop();
        }
        let course = self.course();
        self.time.playback.tick(course, now_secs);
    }

    /// The time of the last [`Editor::tick`].
    pub fn now_secs(&self) -> f64 {
        self.at_secs
    }

    /// The range, rate and looping of playback now.
    pub fn course(&self) -> Course {
        let timeline = &self.document.scene().timeline;
        Course {
            first: timeline.first,
            last: timeline.last,
            fps: timeline.fps,
            looped: self.session.looped,
            pacing: self.session.pacing,
        }
    }

    /// The frame that should be drawn now: the one that playback asks for, or else the one that is shown.
    pub fn frame_to_draw(&self) -> f64 {
        self.time.playback.asked().unwrap_or(self.session.frame)
    }

    /// Reports that a picture of this frame is shown. Returns whether playback goes on to it.
    pub fn shown_frame(&mut self, frame: f64) -> bool {
        let is_next = self.time.playback.shown(frame, self.at_secs);
        if is_next {
            self.session.frame = frame;
            self.time.played = Some(frame);
        }
        is_next
    }

    /// Handles an event of the timeline.
    pub fn timeline(&mut self, event: TimelineEvent) {
        match event {
            TimelineEvent::Scrub(frame) => {
                if self.time.scrubbing.is_none() {
                    self.time.scrubbing = Some(self.time.playback.is_playing());
                    self.time.playback.stop();
                }
                self.session.frame = frame;
            }
            TimelineEvent::EndScrub => {
                if self.time.scrubbing.take() == Some(true) {
                    self.time.playback.resume(self.session.frame, self.course(), self.at_secs);
                    self.time.played = Some(self.session.frame);
                }
            }
            TimelineEvent::GoTo(frame) => self.session.frame = frame,
            TimelineEvent::Keys(event) => self.keys(event),
        }
    }

    fn keys(&mut self, event: KeysEvent) {
        let lanes = lanes(self.document.scene());
        let Some(command) = self.time.keys.take(event, &lanes) else { return };
        let by = match &command {
            Command::Time(Time::MoveKeys(_, by) | Time::CopyKeys(_, by)) => *by,
            _ => 0.0,
        };
        let selected = self.time.keys.go(by);
        if !self.run(&command) {
            self.time.keys.select(selected);
        }
    }

    /// Applies an action to the selected keys. Returns false if they do not have the keyboard focus, or if the action
    /// does not concern keys.
    pub(super) fn act_on_keys(&mut self, action: Action) -> bool {
        if !self.time.keys.has_focus() {
            return false;
        }
        match action {
            Action::Delete => {
                let keys: Vec<KeyAt> = self.time.keys.selected().to_vec();
                self.run(&Command::Time(Time::DeleteKeys(keys)));
            }
            Action::Duplicate => self.keys(KeysEvent::Copy),
            Action::SelectAll => self.keys(KeysEvent::SelectAll),
            Action::SelectNone => self.keys(KeysEvent::SelectNone),
            Action::Cancel => self.keys(KeysEvent::Cancel),
            Action::NudgeKeysBack | Action::NudgeKeysOn => {
                let by = if action == Action::NudgeKeysOn { 1.0 } else { -1.0 };
                let command = Command::Time(Time::MoveKeys(self.time.keys.selected().to_vec(), by));
                let (selected, at_secs) = (self.time.keys.go(by), self.at_secs);
                if !self.run_merged(&command, "nudge keys", at_secs) {
                    self.time.keys.select(selected);
                }
            }
            _ => return false,
        }
        true
    }

    /// Stops playback, if it runs.
    pub fn stop_playing(&mut self) {
        self.time.playback.stop();
    }

    pub(super) fn play_or_stop(&mut self) {
        if self.time.playback.is_playing() {
            return self.time.playback.stop();
        }
        if self.document.scene().objects.is_empty() {
            return self.refuse(&Refusal::new("There is nothing to play"));
        }
        self.put_back();
        self.time.playback.play(self.session.frame, self.course(), self.at_secs);
        self.time.played = Some(self.session.frame);
    }

    /// Sets keys for the selected things and for all loose poses.
    pub(super) fn set_key(&mut self) {
        let frame = self.session.frame;
        let loose = self.time.loose.take();
        let posed: Vec<String> =
            loose.iter().flat_map(|loose| loose.poses.iter().map(|(name, _)| name.clone())).collect();
        let mut commands: Vec<Command> =
            loose.iter().flat_map(|loose| loose.poses.iter().map(|(_, command)| command.clone())).collect();
        let keyed = self.document.selection().items().iter().filter_map(|item| match item {
            Item::Object(name) => Some(KeyOf::Object(name.clone())),
            Item::Camera => Some(KeyOf::Camera),
            Item::Light(name) => Some(KeyOf::Light(name.clone())),
            Item::Region(name) | Item::Guide(name, _) => {
                Some(KeyOf::Strokes(StrokesOf::Region(name.clone())))
            }
            Item::Touch(_) => None,
        });
        let is_posed = |of: &KeyOf| match of {
            KeyOf::Camera | KeyOf::Object(_) => posed.iter().any(|name| *name == of.name()),
            _ => false,
        };
        let keyed = keyed.filter(|of| !is_posed(of));
        commands.extend(keyed.map(|of| Command::Time(Time::SetKey(of, frame))));
        match &commands[..] {
            [] => self.refuse(&Refusal::new("Select an object, a light, a region or the camera first")),
            [command] => drop(self.keep(command)),
            several => {
                let text = format!("Key {} things at {frame}", several.len());
                self.keep(&Command::Several(text, commands));
            }
        }
    }

    /// With Auto key off in Animate, shows the poses that a command sets but does not key them: they become loose
    /// poses. Returns whether that worked, or `None` if the command has to go to the history.
    pub(super) fn pose_loosely(&mut self, command: &Command) -> Option<bool> {
        let frame = self.session.frame;
        if self.session.auto_key || self.session.mode != Mode::Animate {
            return None;
        }
        let mut poses = self.time.loose.as_ref().map_or_else(Vec::new, |loose| loose.poses.clone());
        for (name, pose) in poses_of(command, frame)? {
            poses.retain(|(other, _)| *other != name);
            poses.push((name, pose));
        }
        let loaded = std::sync::Arc::clone(self.document.loaded());
        let loose = LoosePoses { frame, poses, loaded };
        self.version += 1;
        match self.document.preview(&loose.command()) {
            Ok(()) => {
                self.time.put_back = None;
                let loaded = std::sync::Arc::clone(self.document.shown());
                self.time.loose = Some(LoosePoses { loaded, ..loose });
                Some(true)
            }
            Err(refusal) => {
                self.show_loose();
                self.refuse(&refusal);
                Some(false)
            }
        }
    }

    /// If `command` sets a key for a thing with a loose pose, takes that pose out and returns the command that keys it.
    pub(super) fn take_loose(&mut self, command: &Command) -> Option<Command> {
        let Command::Time(Time::SetKey(of, at_frame)) = command else { return None };
        let loose = self.time.loose.as_mut().filter(|loose| loose.frame == *at_frame)?;
        let index = loose.poses.iter().position(|(name, _)| *name == of.name())?;
        let (_, posed) = loose.poses.remove(index);
        if loose.poses.is_empty() {
            self.time.loose = None;
        }
        Some(posed)
    }

    /// Shows the loose poses again after something else was shown or done.
    pub(super) fn show_loose(&mut self) {
        let Some(loose) = &self.time.loose else { return self.document.end_preview() };
        if self.document.preview(&loose.command()).is_ok() {
            let loaded = std::sync::Arc::clone(self.document.shown());
            self.time.loose = Some(LoosePoses { loaded, ..loose.clone() });
        } else {
            // A thing with a loose pose is gone, or locked.
            self.time.loose = None;
            self.document.end_preview();
        }
    }

    /// Drops the loose poses; [`Editor::pose_again`] restores them.
    pub(super) fn put_back(&mut self) {
        let Some(loose) = self.time.loose.take() else { return };
        self.document.end_preview();
        self.version += 1;
        let words = format!("{} went back to its keys", loose.names());
        self.said.push(Said { words, offers: Some(Offer::PoseAgain), is_refusal: false });
        self.time.put_back = Some(loose);
    }

    /// Undo for loose poses: drops those that are shown; if none are, restores those that were dropped last. Returns
    /// whether there were any.
    pub(super) fn undo_loose_pose(&mut self) -> bool {
        if let Some(loose) = self.time.loose.take() {
            self.document.end_preview();
            self.version += 1;
            self.say(format!("Undid: pose of {}", loose.names()));
            return true;
        }
        let is_put_back = self.time.put_back.is_some();
        self.pose_again();
        is_put_back
    }

    /// Restores the loose poses that were dropped last, at their frame.
    pub fn pose_again(&mut self) {
        let Some(loose) = self.time.put_back.take() else { return };
        self.time.playback.stop();
        (self.session.mode, self.session.frame) = (Mode::Animate, loose.frame);
        self.time.loose = Some(loose);
        self.show_loose();
        self.version += 1;
    }

    /// The status line for playback, dragged keys or loose poses; `None` if there are none of these.
    pub(super) fn time_status(&self) -> Option<String> {
        let playback = &self.time.playback;
        if playback.is_playing() {
            let Course { first, last, fps, pacing, .. } = self.course();
            let how = match (pacing, playback.dropped()) {
                (Pacing::RealTime, 1) => format!("{fps} fps, 1 frame dropped"),
                (Pacing::RealTime, dropped) => format!("{fps} fps, {dropped} frames dropped"),
                (Pacing::EveryFrame, _) => {
                    format!("every frame, {:.1} of {fps} fps", playback.rate().unwrap_or(0.0))
                }
            };
            return Some(format!("Playing {first}\u{2013}{last}, {how}   [Space] stop"));
        }
        if let Some(dragged) = self.time.keys.dragged() {
            let what = if dragged.copies { "Copy" } else { "Move" };
            let count = match self.time.keys.selected().len() {
                1 => "1 key".to_owned(),
                count => format!("{count} keys"),
            };
            let replaced = self.time.keys.replaces(&lanes(self.document.scene()));
            let replaced: Vec<String> = replaced.iter().map(|(_, frame)| format!("{frame}")).collect();
            let note = if replaced.is_empty() {
                String::new()
            } else {
                format!("  replaces {}", replaced.join(", "))
            };
            let by = dragged.by;
            return Some(format!("{what} {count} by {by:+}{note}   [Shift D] copy  [Esc] back"));
        }
        let loose = self.time.loose.as_ref()?;
        Some(format!("{} is not keyed here  [I] keep it", loose.names()))
    }
}

/// The poses that a command sets at a frame, each as a command; `None` if it does anything else.
fn poses_of(command: &Command, at_frame: f64) -> Option<Vec<(String, Command)>> {
    match command {
        Command::Time(Time::PoseAtFrame(pose, frame)) if *frame == at_frame => {
            let name = match pose {
                Pose::Camera(_) => KeyOf::Camera.name().into_owned(),
                Pose::Object(name, _) => name.clone(),
            };
            Some(vec![(name, command.clone())])
        }
        Command::Several(_, commands) if !commands.is_empty() => {
            let poses: Option<Vec<_>> = commands.iter().map(|command| poses_of(command, at_frame)).collect();
            poses.map(|poses| poses.into_iter().flatten().collect())
        }
        _ => None,
    }
}
