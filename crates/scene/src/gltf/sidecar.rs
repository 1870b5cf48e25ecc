//! The sidecar of a glTF file: what the file itself cannot say. `shot.impasto.json` lies beside `shot.glb`;
//! `docs/from_blender.md` describes it.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use glam::DVec2;
use serde::Deserialize;

use crate::assets::{AssetError, AssetFolders, AssetRequest};
use crate::limits;
use crate::problem::{Problem, Report, Severity};

/// The largest sidecar that is read, in bytes.
const MAX_BYTES: u64 = 64 << 20;

/// The largest shift of a lens that is accepted, in half widths and half heights of the picture.
const MOST_SHIFT: f64 = 1000.0;

/// The brightest light from all around that is accepted, W/m²/sr.
const MOST_LIGHT: f64 = 1e6;

/// What a sidecar says; each field but `version` may be left out.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
pub(crate) struct Sidecar {
    #[serde(default)]
    version: u32,
    /// Frames per second: a time in the file, in seconds, multiplied by this is a frame.
    #[serde(default)]
    pub fps: Option<f64>,
    /// The first and the last frame.
    #[serde(default)]
    pub frames: Option<[i64; 2]>,
    /// The size of the picture, pixels.
    #[serde(default)]
    pub size: Option<[u32; 2]>,
    /// Which camera is looked through, and from which frame on.
    #[serde(default)]
    pub cuts: Vec<Cut>,
    /// The lens shifts of each camera, by the name of its node.
    #[serde(default)]
    shifts: BTreeMap<String, Shift>,
    /// Point caches by the name of a node; paths are relative to the glTF file.
    #[serde(default)]
    pub caches: BTreeMap<String, String>,
    /// The nodes of each collection.
    #[serde(default)]
    pub collections: BTreeMap<String, BTreeSet<String>>,
    /// Light from all around, red, green and blue, W/m²/sr.
    #[serde(default)]
    pub world: Option<[f64; 3]>,
    /// How much brighter the finished picture is shown, stops.
    #[serde(default)]
    pub exposure_stops: f32,
}

/// A cut: from this frame on, the picture is seen through this camera.
#[derive(Clone, Debug, PartialEq, Deserialize)]
pub(crate) struct Cut {
    pub frame: f64,
    /// The name of the camera's node.
    pub camera: String,
}

/// Lens shifts, one for each frame. They are added to positions in the picture, in half widths and half heights of the
/// camera's own picture.
#[derive(Clone, Debug, PartialEq, Deserialize)]
struct Shift {
    /// The frame of the first shift.
    #[serde(default)]
    first: f64,
    ndc: Vec<[f64; 2]>,
}

/// The path of a glTF file's sidecar.
pub(crate) fn path_beside(path: &Path) -> PathBuf {
    path.with_extension("impasto.json")
}

/// Reads the sidecar of a glTF file. A file without one gets a sidecar that states nothing.
///
/// # Errors
/// It cannot be read, or something that it states makes no sense.
pub(super) fn read(path: &Path, root: &Path, folders: &AssetFolders) -> Result<Sidecar, Report> {
    let beside = path_beside(path);
    if !beside.exists() {
        return Ok(Sidecar::default());
    }
    let name = beside.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let request = AssetRequest { beside: path, root, name: &name, max_bytes: MAX_BYTES };
    let asset = match folders.open(&request) {
        Ok(asset) => asset,
        Err(AssetError::Missing { .. }) => return Ok(Sidecar::default()),
        Err(error) => return Err(Report(vec![error.to_problem(Severity::Error, &beside, None)])),
    };
    // The problem's `place` will be where the scene names the shot. So the position in the sidecar goes into the
    // message.
    let found = serde_json::from_slice::<Sidecar>(&asset.bytes).map_err(|error| {
        let words = error.to_string();
        let message = words.split(" at line ").next().unwrap_or(&words).to_owned();
        format!("line {}, column {}: {message}", error.line(), error.column())
    });
    found.and_then(|sidecar| sidecar.fault().map_or(Ok(sidecar), Err)).map_err(|message| {
        Report(vec![Problem {
            severity: Severity::Error,
            path: beside,
            place: None,
            field_path: Box::default(),
            message,
            mend: "export the shot again".to_owned(),
        }])
    })
}

/// The sidecar of a glTF file in `root`, and the caches that it names and that are found there.
///
/// # Errors
/// As [`read`].
pub(super) fn companions(path: &Path, root: &Path) -> Result<Vec<PathBuf>, Report> {
    let folders = AssetFolders::default();
    let sidecar = read(path, root, &folders)?;
    let beside = path_beside(path);
    let request = |name| AssetRequest { beside: path, root, name, max_bytes: u64::MAX };
    let caches = sidecar.caches.values().filter_map(|name| folders.find(&request(name)).ok());
    Ok(Some(beside).filter(|beside| beside.is_file()).into_iter().chain(caches).collect())
}

impl Sidecar {
    /// The first thing in it that makes no sense, in words.
    fn fault(&self) -> Option<String> {
        if self.version != 1 {
            return Some(format!("its version is {}, and only version 1 is known", self.version));
        }
        if let Some(fps) = self.fps.filter(|fps| !(*fps > 0.0 && *fps <= 1e6)) {
            return Some(format!("`fps` is {fps}, and must be above 0 and at most 1000000"));
        }
        let is_far = |frame: f64| frame.is_nan() || frame.abs() > limits::MAX_FRAME;
        if let Some([first, last]) = self.frames
            && (first > last || is_far(first as f64) || is_far(last as f64))
        {
            return Some(format!("`frames` from {first} to {last} make no shot"));
        }
        if let Some([width, height]) = self.size
            && (width == 0 || height == 0)
        {
            return Some(format!("`size` is {width} by {height} pixels"));
        }
        if self.cuts.iter().any(|cut| is_far(cut.frame)) {
            return Some("a frame of `cuts` is too far away".to_owned());
        }
        if self.cuts.windows(2).any(|pair| pair[0].frame >= pair[1].frame) {
            return Some("the frames of `cuts` must increase".to_owned());
        }
        let is_odd = |value: f64| !value.is_finite() || value.abs() > MOST_SHIFT;
        let odd = self.shifts.iter().find(|(_, shift)| {
            is_far(shift.first)
                || shift.ndc.is_empty()
                || shift.ndc.iter().flatten().any(|&value| is_odd(value))
        });
        if let Some((camera, _)) = odd {
            return Some(format!("the shift of {camera:?} is empty or holds numbers beyond {MOST_SHIFT}"));
        }
        if let Some(world) =
            self.world.filter(|world| world.iter().any(|part| !(0.0..=MOST_LIGHT).contains(part)))
        {
            return Some(format!("`world` is {world:?}: numbers from 0 to {MOST_LIGHT}"));
        }
        let exposure = self.exposure_stops;
        (!(-16.0..=16.0).contains(&exposure))
            .then(|| format!("`exposure_stops` is {exposure}: from -16 to 16"))
    }

    /// The node name of the camera at a frame: that of the last cut up to the frame, or of the first cut if all are
    /// later. `None` without cuts.
    pub fn camera_at(&self, frame: f64) -> Option<&str> {
        /// Tolerance for rounded times, in frames.
        const OFF: f64 = 1e-4;
        let after = self.cuts.partition_point(|cut| cut.frame <= frame + OFF);
        self.cuts.get(after.saturating_sub(1)).map(|cut| cut.camera.as_str())
    }

    /// The shift of a camera's lens at a frame: half widths and half heights of its own picture, Y up. Linear between
    /// frames.
    pub fn shift_at(&self, camera: &str, frame: f64) -> DVec2 {
        let Some(shift) = self.shifts.get(camera) else { return DVec2::ZERO };
        let last = shift.ndc.len() - 1;
        let along = (frame - shift.first).clamp(0.0, last as f64);
        let index = along.floor() as usize;
        let [left, right] = [index, (index + 1).min(last)].map(|index| DVec2::from(shift.ndc[index]));
        left.lerp(right, along - index as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(text: &str) -> Sidecar {
        serde_json::from_str(text).unwrap()
    }

    #[test]
    fn cuts_hold_from_their_frame_on() {
        let cuts = r#"{"version": 1, "cuts": [{"frame": 1, "camera": "A"}, {"frame": 12, "camera": "B"}]}"#;
        let seen = [-5.0, 1.0, 11.5, 12.0, 99.0].map(|frame| of(cuts).camera_at(frame).unwrap().to_owned());
        assert_eq!(seen, ["A", "A", "A", "B", "B"]);
        assert_eq!(of(r#"{"version": 1}"#).camera_at(3.0), None);
    }

    #[test]
    fn shifts_are_linear_between_frames_and_hold_outside() {
        let sidecar =
            of(r#"{"version": 1, "shifts": {"A": {"first": 10, "ndc": [[0, 0], [0.5, -1], [0.5, 1]]}}}"#);
        assert_eq!(sidecar.shift_at("A", 3.0), DVec2::ZERO);
        assert_eq!(sidecar.shift_at("A", 10.5), DVec2::new(0.25, -0.5));
        assert_eq!(sidecar.shift_at("A", 40.0), DVec2::new(0.5, 1.0));
        assert_eq!(sidecar.shift_at("B", 11.0), DVec2::ZERO);
    }

    #[test]
    fn what_makes_no_sense_is_said() {
        for (text, word) in [
            (r#"{}"#, "version"),
            (r#"{"version": 2}"#, "version"),
            (r#"{"version": 1, "fps": 0}"#, "fps"),
            (r#"{"version": 1, "frames": [3, 1]}"#, "frames"),
            (r#"{"version": 1, "size": [0, 4]}"#, "size"),
            (r#"{"version": 1, "cuts": [{"frame": 2, "camera": "A"}, {"frame": 2, "camera": "B"}]}"#, "cuts"),
            (r#"{"version": 1, "shifts": {"A": {"ndc": []}}}"#, "\"A\""),
            (r#"{"version": 1, "shifts": {"A": {"ndc": [[1e9, 0]]}}}"#, "\"A\""),
            (r#"{"version": 1, "exposure_stops": 99}"#, "exposure_stops"),
        ] {
            let fault = of(text).fault().unwrap_or_else(|| panic!("{text}"));
            assert!(fault.contains(word), "{text}: {fault}");
        }
        assert_eq!(of(r#"{"version": 1, "of the future": 3}"#).fault(), None);
    }
}
