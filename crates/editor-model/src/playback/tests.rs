//! Tests of playback with a simulated clock and slow pictures.

use super::*;

fn course(first: i64, last: i64, fps: f64) -> Course {
    Course { first, last, fps, looped: true, pacing: Pacing::RealTime }
}

/// The frame that the clock alone asks for.
fn by_clock(course: Course, start: i64, secs: f64) -> i64 {
    course.first
        + (start - course.first + (secs * course.fps + 1e-6).floor() as i64).rem_euclid(course.count())
}

#[test]
fn pictures_that_come_at_once_show_the_frame_of_the_clock() {
    for fps in [24.0, 23.976, 25.0, 29.97, 60.0] {
        let course = course(-10, 119, fps);
        let mut playback = Playback::default();
        playback.play(0.0, course, 100.0);
        let mut frames = BTreeSet::new();
        // The window asks for a frame 144 times a second, for two minutes.
        for step in 0..144 * 120 {
            let now = 100.0 + f64::from(step) / 144.0;
            let frame = playback.tick(course, now).unwrap();
            playback.shown(frame, now);
            let clock = by_clock(course, 0, now - 100.0);
            // Playback learns how far ahead to ask, so it may be one frame early.
            let ahead = (frame as i64 - clock).rem_euclid(course.count());
            assert!(ahead <= 1, "{fps} fps, {now} s: frame {frame}, the clock says {clock}");
            frames.insert(frame as i64);
        }
        assert_eq!(playback.dropped(), 0, "{fps} fps");
        assert!(playback.missed().next().is_none());
        assert_eq!(frames.len(), 130, "{fps} fps: not every frame of the loop is shown");
    }
}

/// A slow drawer: it draws the frame that was asked for last, and shows it when it is done.
struct Drawer {
    busy: Option<(f64, f64)>,
    takes_secs: f64,
}

impl Drawer {
    fn step(&mut self, asked: f64, shown: f64, now: f64) -> Option<f64> {
        let done = self.busy.take_if(|(_, until)| *until <= now).map(|(frame, _)| frame);
        if self.busy.is_none() && asked != done.unwrap_or(shown) {
            self.busy = Some((asked, now + self.takes_secs));
        }
        done
    }
}

#[test]
fn slow_pictures_are_shown_on_time_and_skipped_frames_are_counted() {
    for takes_secs in [0.02, 0.07, 0.11, 0.25] {
        let course = course(0, 119, 24.0);
        let mut playback = Playback::default();
        playback.play(0.0, course, 0.0);
        let mut drawer = Drawer { busy: None, takes_secs };
        let (mut shown, mut pictures, mut index, mut late) = (0.0, 0_u64, 0_i64, Vec::new());
        for step in 0..30_000 {
            let now = f64::from(step) / 1000.0;
            let asked = playback.tick(course, now).unwrap();
            let Some(frame) = drawer.step(asked, shown, now) else { continue };
            assert!(playback.shown(frame, now), "{takes_secs}: each picture is new");
            index += (frame as i64 - shown as i64).rem_euclid(120);
            (shown, pictures) = (frame, pictures + 1);
            if now > 5.0 {
                late.push((now * 24.0 - (index as f64 + 0.5)).abs());
            }
        }
        // Every frame that has passed was either shown or dropped.
        assert_eq!(playback.dropped() + pictures, index as u64, "{takes_secs}");
        assert_eq!(playback.dropped() == 0, takes_secs < 1.0 / 24.0, "{takes_secs}: {}", playback.dropped());
        let worst = late.iter().copied().fold(0.0, f64::max);
        assert!(worst <= 1.1, "{takes_secs}: {worst} frames off");
        assert!(playback.missed().all(|frame| (0..120).contains(&frame)));
    }
}

#[test]
fn drops_are_counted_and_remembered_exactly() {
    let course = course(0, 9, 10.0);
    let mut playback = Playback::default();
    playback.play(0.0, course, 0.0);
    // Playback ticks only once, in the middle of frame 3.
    assert_eq!(playback.tick(course, 0.35), Some(3.0));
    assert!(playback.shown(3.0, 0.35));
    assert_eq!((playback.dropped(), playback.missed().collect::<Vec<_>>()), (2, vec![1, 2]));
    // The same frame shown again, as an exact picture after a draft, is not a new frame.
    assert!(!playback.shown(3.0, 0.36));
    // Across the loop's end: 4 to 9 and 0 were never shown.
    playback.lead_secs = 0.0;
    assert_eq!(playback.tick(course, 1.15), Some(1.0));
    assert!(playback.shown(1.0, 1.15));
    assert_eq!(playback.dropped(), 9);
    assert_eq!(playback.missed().collect::<Vec<_>>(), [0, 1, 2, 4, 5, 6, 7, 8, 9]);
    // A late picture of the round before does not count for this round.
    assert!(!playback.shown(5.0, 1.16));
    playback.stop();
    assert_eq!(playback.dropped(), 9, "the count stays after the stop");
    playback.resume(4.0, course, 2.0);
    assert_eq!(playback.dropped(), 9, "the count stays after a scrub");
    playback.play(4.0, course, 3.0);
    assert_eq!((playback.dropped(), playback.missed().count()), (0, 0));
}

#[test]
fn a_clock_that_jumps_goes_on_where_the_film_was() {
    let course = course(0, 119, 24.0);
    for jump in [86_400.0 * 365.0, -3.0e9, f64::NAN] {
        let mut playback = Playback::default();
        playback.play(5.0, course, 10.0);
        assert_eq!(playback.tick(course, 10.5), Some(17.0));
        playback.shown(17.0, 10.5);
        let dropped = playback.dropped();
        playback.tick(course, 10.5 + jump);
        assert_eq!(playback.dropped(), dropped, "frames missed in the jump count as dropped");
        if jump.is_finite() {
            let now = 10.5 + jump;
            playback.lead_secs = 0.0;
            assert_eq!(playback.tick(course, now + 0.5), Some(29.0));
            assert!(playback.shown(29.0, now + 0.5));
        }
    }
}

#[test]
fn a_range_of_one_frame_plays() {
    for pacing in [Pacing::RealTime, Pacing::EveryFrame] {
        let still = Course { pacing, ..course(7, 7, 24.0) };
        let mut playback = Playback::default();
        playback.play(40.0, still, 0.0);
        for step in 0..1000 {
            assert_eq!(playback.tick(still, f64::from(step) * 0.01), Some(7.0));
        }
        assert!(playback.is_playing() && playback.dropped() == 0);
        let once = Course { looped: false, ..still };
        playback.play(7.0, once, 0.0);
        playback.tick(once, 1.0);
        assert!(!playback.is_playing(), "{pacing:?}");
    }
}

#[test]
fn without_a_loop_the_last_frame_is_shown_and_ends_it() {
    let once = Course { looped: false, ..course(0, 9, 10.0) };
    let mut playback = Playback::default();
    playback.play(0.0, once, 0.0);
    assert_eq!(playback.tick(once, 0.75), Some(7.0));
    assert!(playback.shown(7.0, 0.75));
    assert_eq!(playback.tick(once, 3.0), Some(9.0), "not beyond the end");
    assert!(playback.is_playing(), "it plays until the last frame is shown");
    assert!(playback.shown(9.0, 3.1));
    playback.tick(once, 3.2);
    assert!(!playback.is_playing());
    assert_eq!(playback.dropped(), 7);
    playback.play(9.0, once, 4.0);
    assert_eq!(playback.tick(once, 4.0), Some(0.0), "from the end it begins anew");
}

#[test]
fn every_frame_is_shown_in_turn_and_the_real_rate_is_reported() {
    let all = Course { pacing: Pacing::EveryFrame, ..course(0, 11, 24.0) };
    for (takes_secs, rate) in [(0.1, 1.0 / 0.102), (0.001, 24.0)] {
        let mut playback = Playback::default();
        playback.play(0.0, all, 0.0);
        let mut drawer = Drawer { busy: None, takes_secs };
        let (mut shown, mut seen) = (0.0, Vec::new());
        for step in 0..10_000 {
            let now = f64::from(step) / 1000.0;
            let asked = playback.tick(all, now).unwrap();
            let Some(frame) = drawer.step(asked, shown, now) else { continue };
            assert!(playback.shown(frame, now));
            shown = frame;
            seen.push(frame);
        }
        assert!(seen.iter().enumerate().all(|(index, frame)| *frame == ((index + 1) % 12) as f64));
        assert_eq!(playback.dropped(), 0);
        let told = playback.rate().unwrap();
        assert!((told - rate).abs() < 0.03 * rate, "{told} pictures a second, not {rate}");
        assert!((seen.len() as f64 / 10.0 - rate).abs() < 0.03 * rate, "{} pictures", seen.len());
    }
}

#[test]
fn another_range_goes_on_from_what_is_shown() {
    let long = course(0, 119, 24.0);
    let mut playback = Playback::default();
    playback.play(100.0, long, 0.0);
    playback.tick(long, 0.1);
    playback.shown(102.0, 0.1);
    let short = course(0, 9, 24.0);
    assert_eq!(playback.tick(short, 0.2), Some(0.0), "frame 102 is not in the new range");
    assert!(playback.wait_secs(0.2).unwrap() <= 1.0 / 24.0);
}
