//! Tests of reading frames from files: which are read, which are dropped for others, what is said of a broken file.

use std::sync::mpsc;
use std::time::Duration;

use image::{Rgba, RgbaImage};

use super::*;

/// Frames of one colour each, as files.
fn files(count: u8, side: u32) -> (Vec<PathBuf>, tempfile::TempDir) {
    let folder = tempfile::tempdir().expect("a folder");
    let paths = (0..count).map(|index| {
        let path = folder.path().join(format!("f_{index}.png"));
        RgbaImage::from_pixel(side, side / 2, Rgba([index, 100, 200, 255])).save(&path).expect("written");
        path
    });
    (paths.collect(), folder)
}

/// A [`FrameReading`], and a function that waits until it has read one more frame.
fn reading(paths: Vec<PathBuf>, most_bytes: usize) -> (FrameReading, impl Fn()) {
    let (sender, receiver) = mpsc::channel();
    let wake = move || {
        // The test may have ended.
        let _ended = sender.send(());
    };
    let reading = FrameReading::within(paths, most_bytes, wake).expect("a thread");
    (reading, move || receiver.recv_timeout(Duration::from_secs(60)).expect("a frame"))
}

fn kept(reading: &FrameReading, count: usize) -> Vec<usize> {
    (0..count).filter(|index| reading.picture(*index).is_some()).collect()
}

#[test]
fn frames_come_in_the_order_of_need() {
    let (paths, _folder) = files(6, 8);
    let (reading, next) = reading(paths, MOST_BYTES);
    reading.want(vec![3, 4, 0], [8, 8]);
    for expected in [&[3][..], &[3, 4], &[0, 3, 4]] {
        next();
        // The thread may have read more frames than `next` has waited for.
        let kept = kept(&reading, 6);
        assert!(expected.iter().all(|index| kept.contains(index)), "{kept:?}");
    }
    let picture = reading.picture(4).expect("read").expect("whole");
    assert_eq!(picture.size, [8, 4]);
    assert_eq!(picture.pixels[0], egui::Color32::from_rgb(4, 100, 200));
}

#[test]
fn memory_stays_within_its_bound() {
    let (paths, _folder) = files(40, 32);
    let frame = 32 * 16 * 4;
    let (reading, next) = reading(paths, 5 * frame);
    for at in 0..40_usize {
        let wanted: Vec<usize> = (at..(at + 12).min(40)).collect();
        reading.want(wanted, [32, 32]);
        while reading.picture(at).is_none() {
            next();
        }
        let bytes = reading.shared.board().bytes();
        assert!(bytes <= 5 * frame, "{bytes} at {at}");
    }
    assert!(kept(&reading, 40).contains(&39));
}

#[test]
fn a_frame_that_is_too_large_is_shown_alone() {
    let (paths, _folder) = files(4, 64);
    let (reading, next) = reading(paths, 100);
    reading.want(vec![1, 2, 3], [64, 64]);
    next();
    assert_eq!(kept(&reading, 4), [1]);
    reading.want(vec![2, 3], [64, 64]);
    while reading.picture(2).is_none() {
        next();
    }
    assert_eq!(kept(&reading, 4), [2]);
}

#[test]
fn a_large_picture_is_reduced_to_what_is_shown() {
    let (paths, _folder) = files(1, 400);
    let (reading, next) = reading(paths, MOST_BYTES);
    for (shown, size) in [([100, 100], [100, 50]), ([150, 100], [200, 100]), ([1000, 1000], [400, 200])] {
        reading.want(vec![0], shown);
        while reading.picture(0).is_none_or(|picture| picture.expect("whole").size != size) {
            next();
        }
    }
}

#[test]
fn a_file_that_cannot_be_read_says_why() {
    let (mut paths, folder) = files(1, 8);
    paths.push(folder.path().join("gone.png"));
    paths.push(folder.path().join("no.png"));
    std::fs::write(&paths[2], "no picture").expect("written");
    let (reading, next) = reading(paths, MOST_BYTES);
    reading.want(vec![1, 2, 0], [8, 8]);
    while reading.picture(0).is_none() {
        next();
    }
    assert!(reading.picture(1).expect("a result").expect_err("missing").contains("gone.png is not there"));
    assert!(reading.picture(2).expect("a result").expect_err("broken").contains("no.png is no whole PNG"));
}

#[test]
fn a_frame_that_found_no_room_is_not_read_again_and_again() {
    let (mut paths, _folder) = files(3, 16);
    let (large, _other) = files(1, 64);
    paths[1].clone_from(&large[0]);
    let small_bytes = 16 * 8 * 4;
    let (reading, next) = reading(paths, 3 * small_bytes);
    reading.want(vec![0, 1, 2], [64, 64]);
    for _ in 0..3 {
        next();
    }
    assert_eq!(kept(&reading, 3), [0, 2], "the large one is let go, and the next is read");
    assert_eq!(reading.shared.board().next(), None);
    // Once the large frame is the most urgent, it is read.
    reading.want(vec![1, 2], [64, 64]);
    while reading.picture(1).is_none() {
        next();
    }
    assert_eq!(kept(&reading, 3), [1]);
}

#[test]
fn files_that_come_later_are_read_too() {
    let (paths, _folder) = files(3, 8);
    let (reading, next) = reading(paths[..2].to_vec(), MOST_BYTES);
    reading.want(vec![0], [8, 8]);
    next();
    assert!(!reading.replace(paths.clone()), "frames that were read are dropped");
    assert_eq!(kept(&reading, 3), [0]);
    reading.want(vec![2], [8, 8]);
    next();
    assert!(reading.picture(2).expect("read").is_ok());
    assert!(reading.replace(paths[1..].to_vec()), "frames at other indices are kept");
    assert_eq!(kept(&reading, 3), Vec::<usize>::new());
}

#[test]
fn a_picture_larger_than_the_memory_is_refused() {
    let info = FrameInfo { size_px: [1000, 1000], depth: Depth::Eight, has_alpha: true };
    let path = Path::new("f.png");
    assert!(fits(path, &info, None).is_ok());
    assert!(fits(path, &info, Some(48_000_000)).is_ok());
    assert!(fits(path, &info, Some(47_999_999)).unwrap_err().contains("1000 x 1000"));
    let deep = FrameInfo { depth: Depth::Sixteen, ..info };
    assert!(fits(path, &deep, Some(48_000_000)).is_err());
}
