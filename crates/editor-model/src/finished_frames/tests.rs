//! Playing, stepping and scrubbing through finished frames, by a clock of the test's own.

use super::*;

fn frames(count: usize) -> FinishedFrames {
    let files = (0..count).map(|index| (10 + index as i64, PathBuf::from(format!("f_{index}.png"))));
    FinishedFrames::new(files.collect(), 24.0).unwrap()
}

#[test]
fn it_plays_at_the_rate_of_the_film() {
    let mut film = frames(48);
    film.play_or_stop(100.0);
    for tick in 0..=240 {
        let now = 100.0 + f64::from(tick) / 120.0;
        film.tick(now);
        film.shown(film.at(), now);
    }
    assert_eq!(film.at(), 0, "two seconds are one round");
    assert_eq!(film.dropped(), 0);
    film.tick(102.51);
    assert_eq!(film.at(), 12);
    film.shown(12, 102.51);
    assert_eq!(film.dropped(), 11, "frames that came too late are skipped, and counted");
    film.play_or_stop(102.6);
    film.tick(103.0);
    assert_eq!((film.at(), film.is_playing()), (12, false));
}

#[test]
fn without_a_loop_it_ends_at_the_last_frame() {
    let mut film = frames(3);
    film.looped = false;
    film.play_or_stop(0.0);
    for tick in 0..40 {
        let now = f64::from(tick) / 100.0;
        film.tick(now);
        film.shown(film.at(), now);
    }
    assert_eq!((film.at(), film.is_playing()), (2, false));
    film.step(1);
    assert_eq!(film.at(), 2);
    film.looped = true;
    film.step(1);
    assert_eq!(film.at(), 0);
    film.step(-1);
    assert_eq!(film.frame(film.at()), (12, Path::new("f_2.png")));
    film.go_to(-7);
    assert_eq!(film.at(), 0);
    film.go_to(99);
    assert_eq!(film.at(), 2);
}

#[test]
fn it_reads_ahead_but_not_everything() {
    let mut film = frames(100);
    film.go_to(98);
    assert_eq!(film.wanted()[..5], [98, 97, 99, 0, 1]);
    assert!(film.wanted().len() <= AHEAD + 2);
    film.looped = false;
    assert_eq!(film.wanted(), [98, 97, 99]);
    film.play_or_stop(0.0);
    assert_eq!(film.wanted(), [98, 99]);
    let film = frames(1);
    assert_eq!(film.wanted(), [0]);
}

#[test]
fn there_is_nothing_to_see_without_a_frame() {
    assert!(FinishedFrames::new(Vec::new(), 24.0).is_none());
    assert_eq!(FinishedFrames::new(vec![(0, PathBuf::new())], f64::NAN).unwrap().fps(), 24.0);
}

#[test]
fn frames_that_are_finished_meanwhile_are_added() {
    let files = |count: i64| (0..count).map(|index| (10 + index, PathBuf::from(format!("f_{index}.png"))));
    let mut film = frames(3);
    film.go_to(2);
    assert!(film.extend(files(5).collect()));
    assert_eq!((film.count(), film.at(), film.frame(4).0), (5, 2, 14));
    assert!(!film.extend(files(5).collect()), "nothing new");
    assert!(!film.extend(Vec::new()), "a list without the shown frame is not taken");
    film.play_or_stop(0.0);
    assert!(film.extend(files(48).collect()));
    film.tick(1.0);
    film.tick(1.51);
    assert_eq!((film.at(), film.is_playing()), (14, true), "it goes on from the frame that is shown");
}
