//! Point caches: files that say where every point of a mesh is, sample by sample. They are read one sample at a time.
//!
//! The format is PC2, which Blender, Maya, 3ds Max and Houdini write. All numbers are little-endian:
//!
//! | bytes | what |
//! |---|---|
//! | 12 | `POINTCACHE2` and a zero byte |
//! | 4 | version, a whole number: 1 |
//! | 4 | number of points, a whole number |
//! | 4 | frame of the first sample, a float |
//! | 4 | frames from one sample to the next, a float |
//! | 4 | number of samples, a whole number |
//! | 12 for each point of each sample | x, y, z, floats; sample by sample, points in the order of the mesh file |

use std::fmt;
use std::fs::File;
use std::io::{self, Read as _, Seek as _, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, OnceLock, PoisonError};

use glam::Vec3;

/// The header, in bytes.
const HEADER: u64 = 32;

/// One point of a sample, in bytes.
const POINT: u64 = 12;

/// To check the points' positions, a file of at most this many bytes is read whole. Of a larger one, some samples are
/// read.
const READ_WHOLE: u64 = 256 << 20;

/// How many samples of a larger file are read to check the points' positions.
const READ_SAMPLES: u64 = 16;

/// Coordinates beyond this are refused, as in meshes.
const FARTHEST: f32 = 1e9;

/// An open point cache.
pub struct PointCache {
    path: PathBuf,
    file: Mutex<File>,
    count: usize,
    samples: u64,
    first_frame: f64,
    frames_per_sample: f64,
    /// What is wrong with the points' positions; found when first asked for.
    fault_of_places: OnceLock<Option<Fault>>,
}

/// Prints the path alone, because a cache may be large.
impl fmt::Debug for PointCache {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.debug_tuple("PointCache").field(&self.path).finish()
    }
}

/// What is wrong with a cache, and what to do about it.
pub(crate) type Fault = [String; 2];

impl PointCache {
    /// Opens a cache and checks its header against its length. No position is read, since the file may hold more points
    /// than any mesh.
    ///
    /// # Errors
    /// What is wrong, and what to do about it.
    pub(crate) fn open(path: &Path) -> Result<Self, Fault> {
        let unread =
            |error: io::Error| [format!("it could not be read: {error}"), "check the file".to_owned()];
        let again = || "export the cache again".to_owned();
        let mut file = File::open(path).map_err(unread)?;
        let length = file.metadata().map_err(unread)?.len();
        let mut header = [0; HEADER as usize];
        if length < HEADER || file.read_exact(&mut header).is_err() || &header[..12] != b"POINTCACHE2\0" {
            return Err([
                "it is no PC2 file".to_owned(),
                "export the motion as PC2 (point cache 2)".to_owned(),
            ]);
        }
        let word = |at: usize| [0, 1, 2, 3].map(|byte| header[at + byte]);
        let (whole, float) =
            (|at: usize| i32::from_le_bytes(word(at)), |at: usize| f64::from(f32::from_le_bytes(word(at))));
        let (version, count, samples) = (whole(12), whole(16), whole(28));
        if version != 1 {
            return Err([format!("its version is {version}"), "only version 1 is known".to_owned()]);
        }
        if count <= 0 || samples <= 0 {
            return Err([format!("it has {count} points and {samples} samples"), again()]);
        }
        let (first_frame, frames_per_sample) = (float(20), float(24));
        if !(first_frame.is_finite() && frames_per_sample.is_finite() && frames_per_sample > 0.0) {
            let message =
                format!("it begins at frame {first_frame}, with {frames_per_sample} frames a sample");
            return Err([message, again()]);
        }
        let claimed = u128::from(HEADER) + u128::from(POINT) * count as u128 * samples as u128;
        if claimed != u128::from(length) {
            let message = format!(
                "it has {length} bytes, but {count} points in {samples} samples are {claimed} bytes: {}",
                if claimed > u128::from(length) { "it is cut short" } else { "there is more behind them" }
            );
            return Err([message, again()]);
        }
        Ok(Self {
            path: path.to_owned(),
            file: Mutex::new(file),
            count: count as usize,
            samples: samples as u64,
            first_frame,
            frames_per_sample,
            fault_of_places: OnceLock::new(),
        })
    }

    /// What is wrong with the points' positions, found by reading them at the first call. Call it only if the number of
    /// points is that of a mesh, since memory for a whole sample is taken.
    pub(crate) fn fault_of_places(&self) -> Option<&Fault> {
        let find = || {
            let whole = self.count as u64 * self.samples * POINT <= READ_WHOLE;
            let read = if whole { self.samples } else { READ_SAMPLES.min(self.samples) };
            let mut samples = (0..read).map(|number| number * (self.samples - 1) / (read - 1).max(1));
            samples.find_map(|number| {
                let error = self.sample(number).err()?;
                Some(match error.kind() {
                    io::ErrorKind::InvalidData => [error.to_string(), "export the cache again".to_owned()],
                    _ => [format!("sample {number} could not be read: {error}"), "check the file".to_owned()],
                })
            })
        };
        self.fault_of_places.get_or_init(find).as_ref()
    }

    /// The file.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// How many points it moves.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The frames of the first and the last sample.
    pub fn frames(&self) -> [f64; 2] {
        [self.first_frame, self.first_frame + (self.samples - 1) as f64 * self.frames_per_sample]
    }

    /// Where the points are at a frame, in the space of the mesh file. Between two samples, points move evenly from one
    /// to the other; before the first and after the last, they stand still. Memory for two samples is taken, whatever
    /// the length of the file.
    ///
    /// # Errors
    /// Those of the system, and a position that is not finite, or is too far away.
    pub fn at(&self, frame: f64) -> io::Result<Vec<Vec3>> {
        let last = (self.samples - 1) as f64;
        let place = ((frame - self.first_frame) / self.frames_per_sample).max(0.0).min(last);
        let (sample, part) = (place.floor(), place.fract() as f32);
        let mut places = self.sample(sample as u64)?;
        if part > 0.0 {
            let number = sample as u64 + 1;
            let next = self.bytes(number)?;
            for (at, next) in places.iter_mut().zip(places_in(&next, number)) {
                *at = at.lerp(next?, part);
            }
        }
        Ok(places)
    }

    fn sample(&self, number: u64) -> io::Result<Vec<Vec3>> {
        places_in(&self.bytes(number)?, number).collect()
    }

    fn bytes(&self, number: u64) -> io::Result<Vec<u8>> {
        let mut bytes = vec![0; self.count * POINT as usize];
        {
            // A thread that panicked can only have left the file at another position, which is set anew here.
            let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
            file.seek(SeekFrom::Start(HEADER + number * self.count as u64 * POINT))?;
            file.read_exact(&mut bytes)?;
        }
        Ok(bytes)
    }
}

/// The positions in the bytes of a sample; an error for each that is not finite, or is too far away.
fn places_in(bytes: &[u8], sample: u64) -> impl Iterator<Item = io::Result<Vec3>> {
    let place = move |(number, point): (usize, &[u8; POINT as usize])| {
        let coordinate =
            |at: usize| f32::from_le_bytes([point[at], point[at + 1], point[at + 2], point[at + 3]]);
        let at = Vec3::from_array([0, 4, 8].map(coordinate));
        if at.is_finite() && at.abs().max_element() <= FARTHEST {
            return Ok(at);
        }
        let words = format!("point {number} of sample {sample} is at {at}");
        Err(io::Error::new(io::ErrorKind::InvalidData, words))
    };
    bytes.as_chunks::<{ POINT as usize }>().0.iter().enumerate().map(place)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn header(count: i32, first: f32, rate: f32, samples: i32) -> Vec<u8> {
        let mut bytes = b"POINTCACHE2\0".to_vec();
        bytes.extend(1i32.to_le_bytes().into_iter().chain(count.to_le_bytes()));
        bytes.extend(first.to_le_bytes().into_iter().chain(rate.to_le_bytes()).chain(samples.to_le_bytes()));
        bytes
    }

    fn with_places(mut bytes: Vec<u8>, places: &[[f32; 3]]) -> Vec<u8> {
        bytes.extend(places.as_flattened().iter().flat_map(|value| value.to_le_bytes()));
        bytes
    }

    fn opened(bytes: &[u8]) -> Result<PointCache, Fault> {
        let folder = tempfile::tempdir().expect("a folder for the test");
        let path = folder.path().join("flag.pc2");
        std::fs::write(&path, bytes).expect("the folder can be written");
        PointCache::open(&path)
    }

    #[test]
    fn points_move_evenly_between_samples_and_stand_before_and_after() {
        let places = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [1.0, 0.0, 4.0]];
        let cache = opened(&with_places(header(2, 10.0, 2.0, 2), &places)).expect("the cache is good");
        assert_eq!((cache.count(), cache.frames()), (2, [10.0, 12.0]));
        let at = |frame: f64| cache.at(frame).expect("it can be read");
        assert_eq!(at(3.0), at(10.0));
        assert_eq!(at(10.5), [Vec3::new(0.0, 0.5, 0.0), Vec3::new(1.0, 0.0, 1.0)]);
        assert_eq!(at(12.0), at(1e9));
        assert_eq!(at(12.0)[1], Vec3::new(1.0, 0.0, 4.0));
    }

    #[test]
    fn what_a_header_claims_is_held_against_the_file() {
        let one = [[0.0; 3]];
        for (bytes, expected) in [
            (b"POINTCACHE2".to_vec(), "no PC2 file"),
            (b"PNG".repeat(40), "no PC2 file"),
            (with_places(header(i32::MAX, 0.0, 1.0, i32::MAX), &one), "cut short"),
            (with_places(header(1, 0.0, 1.0, 2), &one), "cut short"),
            (with_places(header(1, 0.0, 1.0, 1), &[[0.0; 3]; 2]), "more behind"),
            (with_places(header(-1, 0.0, 1.0, 1), &one), "-1 points"),
            (with_places(header(1, 0.0, 0.0, 1), &one), "0 frames a sample"),
            (with_places(header(1, f32::NAN, 1.0, 1), &one), "frame NaN"),
        ] {
            let [message, mend] = opened(&bytes).expect_err(expected);
            assert!(message.contains(expected) && !mend.is_empty(), "{message}");
        }
    }

    #[test]
    fn a_place_that_is_nowhere_or_too_far_is_told_by_the_check_and_by_reading() {
        for odd in [f32::NAN, f32::NEG_INFINITY, 2e9] {
            let cache = opened(&with_places(header(1, 0.0, 1.0, 3), &[[0.0; 3], [0.0; 3], [0.0, odd, 0.0]]));
            let cache = cache.expect("no place is read when it is opened");
            let [message, mend] = cache.fault_of_places().expect("a place is odd");
            assert!(message.contains("point 0 of sample 2") && !mend.is_empty(), "{message}");
            for frame in [1.001, 2.0] {
                let error = cache.at(frame).expect_err("a place is odd").to_string();
                assert!(error.contains("point 0 of sample 2"), "{error}");
            }
            assert_eq!(cache.at(1.0).expect("it can be read"), [Vec3::ZERO]);
        }
        let cache = opened(&with_places(header(1, 0.0, 1.0, 1), &[[-1e9, 0.0, 1e9]])).expect("good");
        assert_eq!(cache.fault_of_places(), None);
    }
}
