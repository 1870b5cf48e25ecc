//! Checks whether the values of a document make sense: each in range, consistent with each other, and naming things
//! that exist.
//!
//! Nothing here opens a file; only point caches, which are open already, are read. A finding names its field by a path
//! such as `objects[2].keys[1].frame`, which [`crate::locate::Located::place_of`] turns into a line and a column.

use std::collections::{BTreeMap, HashSet};
use std::sync::Arc;

use crate::document::{Ease, Key, Number, Scene};
use crate::limits;
use crate::mesh_file::MeshFile;
use crate::point_cache::PointCache;
use crate::problem::Severity;

mod amounts;
mod mesh_names;
mod noise_displace;
mod objects;
mod on_meshes;
mod regions;
mod shot;
mod strokes;
mod touches;

pub(crate) use strokes::brush_pictures;

/// One thing that is wrong, or odd, with one field.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Finding {
    /// Whether the scene can still be used.
    pub severity: Severity,
    /// The field, as in `objects[2].keys[1].frame`.
    pub field_path: String,
    /// What is wrong, as one sentence without a full stop.
    pub message: String,
    /// What to do about it, as one sentence without a full stop.
    pub mend: String,
}

/// All findings about a document by itself: at most [`limits::MAX_PROBLEMS`], and one that counts the rest.
///
/// The time is proportional to the document's size.
pub fn check(scene: &Scene) -> Vec<Finding> {
    let mut findings = Findings::default();
    shot::check(scene, &mut findings);
    objects::check(scene, &mut findings);
    strokes::check(scene, &mut findings);
    regions::check(scene, &mut findings);
    amounts::check(scene, &mut findings);
    touches::check(scene, &mut findings);
    findings.done()
}

/// Checks the document against its files: groups and materials exist and have triangles, guides and dabs lie on the
/// surface, morphs have equal topology, point caches fit. `meshes` and `caches` are keyed by the path written in the
/// document. A file that these maps lack could not be read, which was reported before: it is skipped.
pub fn check_with_meshes(
    scene: &Scene,
    meshes: &BTreeMap<String, Arc<MeshFile>>,
    caches: &BTreeMap<String, Arc<PointCache>>,
) -> Vec<Finding> {
    check_anew(scene, meshes, caches, &Known::default())
}

/// Like [`check_with_meshes`], but skips the parts listed in `known`.
pub(crate) fn check_anew(
    scene: &Scene,
    meshes: &BTreeMap<String, Arc<MeshFile>>,
    caches: &BTreeMap<String, Arc<PointCache>>,
    known: &Known,
) -> Vec<Finding> {
    let mut findings = Findings::default();
    mesh_names::check(scene, meshes, &mut findings);
    on_meshes::check(scene, meshes, known, &mut findings);
    on_meshes::check_caches(scene, meshes, caches, &mut findings);
    findings.done()
}

/// Parts of the document that an earlier check found right and that have not changed since.
#[derive(Debug, Default)]
pub(crate) struct Known {
    /// Objects whose morphs match their meshes, by index.
    pub(crate) objects: HashSet<usize>,
    /// Guides that lie on their surface: indices of region and guide.
    pub(crate) guides: HashSet<(usize, usize)>,
    /// Painted amounts whose dabs all touch their object: indices of region and amount.
    pub(crate) amounts: HashSet<(usize, usize)>,
    /// Regions whose dabs all touch their object, by index.
    pub(crate) dabs: HashSet<usize>,
}

/// Collects findings up to the limit, and counts the rest.
#[derive(Debug, Default)]
struct Findings {
    found: Vec<Finding>,
    left_out: usize,
    left_out_is_fatal: bool,
}

impl Findings {
    /// Adds a finding. `finding` runs only while there is room, since it may compare a wrong name with all known ones.
    fn add(&mut self, severity: Severity, finding: impl FnOnce() -> (String, String, String)) {
        if self.found.len() < limits::MAX_PROBLEMS {
            let (field_path, message, mend) = finding();
            self.found.push(Finding { severity, field_path, message, mend });
        } else {
            self.left_out += 1;
            self.left_out_is_fatal |= severity.is_fatal();
        }
    }

    fn error(&mut self, field_path: impl Into<String>, message: impl Into<String>, mend: impl Into<String>) {
        self.add(Severity::Error, || (field_path.into(), message.into(), mend.into()));
    }

    fn limit(&mut self, field_path: impl Into<String>, message: impl Into<String>, mend: impl Into<String>) {
        self.add(Severity::Limit, || (field_path.into(), message.into(), mend.into()));
    }

    fn warning(
        &mut self,
        field_path: impl Into<String>,
        message: impl Into<String>,
        mend: impl Into<String>,
    ) {
        self.add(Severity::Warning, || (field_path.into(), message.into(), mend.into()));
    }

    /// Checks that a number lies in a range. NaN lies in none.
    fn number(&mut self, field_path: &str, value: f64, range: std::ops::RangeInclusive<f64>) {
        if !range.contains(&value) {
            let mend = format!("give a number from {} to {}", short(*range.start()), short(*range.end()));
            self.error(field_path, format!("{} is out of range", short(value)), mend);
        }
    }

    /// Checks all numbers of a table of settings; `settings_path` is the path of the settings.
    fn numbers<T: 'static>(
        &mut self,
        settings_path: &str,
        settings: &T,
        numbers: impl Iterator<Item = &'static Number<T>>,
    ) {
        for number in numbers {
            let value = (number.get)(settings);
            self.number(&format!("{settings_path}.{}", number.field), value, number.limits.clone());
        }
    }

    /// Checks a number that may be left out.
    fn number_of<T>(&mut self, settings_path: &str, settings: &T, number: &Number<T, Option<f64>>) {
        if let Some(value) = (number.get)(settings) {
            self.number(&format!("{settings_path}.{}", number.field), value, number.limits.clone());
        }
    }

    /// Checks that each number of a point or a vector is at most [`limits::MAX_LENGTH`] from 0.
    fn vector(&mut self, field_path: &str, value: [f64; 3]) {
        if let Some(&bad) = value.iter().find(|component| !within(**component, limits::MAX_LENGTH)) {
            let limit = short(limits::MAX_LENGTH);
            let mend = format!("give three numbers from -{limit} to {limit}");
            self.error(field_path, format!("{} is out of range", short(bad)), mend);
        }
    }

    /// Checks a direction: a vector that is not zero.
    fn direction(&mut self, field_path: &str, value: [f64; 3]) {
        self.vector(field_path, value);
        if value.iter().all(|component| component.abs() < limits::MIN_LENGTH) {
            self.error(field_path, "a direction cannot be zero", "give three numbers that are not all 0");
        }
    }

    fn keys(&mut self, keys_path: &str, keys: &[impl Key]) {
        self.frames(keys_path, keys.iter().map(Key::frame));
        for (index, key) in keys.iter().enumerate() {
            if let Ease::Curve(first, second) = key.ease() {
                self.curve(&format!("{keys_path}[{index}].ease"), [first, second]);
            }
        }
    }

    /// Checks the handles of an ease: `x` in 0..=1, so that time never goes back, and `y` in [`limits::EASE_Y`].
    fn curve(&mut self, field_path: &str, handles: [[f64; 2]; 2]) {
        let ranges = [("x", 0.0..=1.0), ("y", limits::EASE_Y)];
        for ((axis, range), at) in ranges.into_iter().zip(0..2) {
            for bad in handles.map(|handle| handle[at]).into_iter().filter(|value| !range.contains(value)) {
                let (least, most) = (short(*range.start()), short(*range.end()));
                self.error(
                    field_path,
                    format!("{axis} of a handle is {}, out of range", short(bad)),
                    format!("give {axis} from {least} to {most}, as in Curve((0.25, 0.1), (0.25, 1))"),
                );
            }
        }
    }

    /// Checks that frames of keys are in range, and strictly increase.
    fn frames(&mut self, keys_path: &str, frames: impl Iterator<Item = f64>) {
        let mut before: Option<f64> = None;
        for (index, frame) in frames.enumerate() {
            if !within(frame, limits::MAX_FRAME) {
                let limit = short(limits::MAX_FRAME);
                self.error(
                    format!("{keys_path}[{index}].frame"),
                    format!("{} is no frame", short(frame)),
                    format!("give a number from -{limit} to {limit}"),
                );
                continue;
            }
            if let Some(before) = before.filter(|&before| frame <= before) {
                let (message, mend) = if frame == before {
                    (format!("two keys stand at frame {}", short(frame)), "remove one, or move it")
                } else {
                    let message = format!("frame {} stands behind frame {}", short(frame), short(before));
                    (message, "put the keys in the order of their frames")
                };
                self.error(format!("{keys_path}[{index}].frame"), message, mend);
            }
            before = Some(before.map_or(frame, |before| before.max(frame)));
        }
    }

    /// Checks a name: it is not empty, not too long, and without control characters.
    fn name(&mut self, field_path: &str, name: &str) {
        if name.trim().is_empty() {
            self.error(field_path, "the name is empty", "give it a name");
        } else if name.len() > limits::MAX_NAME_BYTES {
            let message = format!("the name is longer than {} bytes", limits::MAX_NAME_BYTES);
            self.error(field_path, message, "give it a shorter name");
        } else if name.chars().any(char::is_control) {
            self.error(field_path, "the name holds a control character", "use letters, digits and spaces");
        }
    }

    fn frame(&mut self, field_path: &str, frame: f64) {
        if !within(frame, limits::MAX_FRAME) {
            let limit = short(limits::MAX_FRAME);
            let mend = format!("give a number from -{limit} to {limit}");
            self.error(field_path, format!("{} is no frame", short(frame)), mend);
        }
    }

    /// Checks names, which must differ. `list_path` is the path of the list whose items have a `name`.
    fn unique<'a>(&mut self, list_path: &str, names: impl Iterator<Item = &'a str>) {
        let mut seen = HashSet::new();
        for (index, name) in names.enumerate() {
            let field_path = format!("{list_path}[{index}].name");
            self.name(&field_path, name);
            if !seen.insert(name) && !name.trim().is_empty() {
                let message = format!("the name \"{}\" is taken already", shown(name));
                self.error(field_path, message, "give each its own name");
            }
        }
    }

    fn done(mut self) -> Vec<Finding> {
        if self.left_out > 0 {
            let severity = if self.left_out_is_fatal { Severity::Error } else { Severity::Warning };
            let message = format!("{} more problems are not listed", self.left_out);
            let mend = "mend those above first".to_owned();
            self.found.push(Finding { severity, field_path: String::new(), message, mend });
        }
        self.found
    }
}

/// Whether a number is finite and at most `limit` from 0.
fn within(value: f64, limit: f64) -> bool {
    value.abs() <= limit
}

/// A number for a message, short however large it is.
fn short(value: f64) -> String {
    let size = value.abs();
    if size != 0.0 && value.is_finite() && !(1e-4..1e7).contains(&size) {
        format!("{value:e}")
    } else {
        format!("{value}")
    }
}

/// A name for a message: on one line, cut off after 60 characters.
fn shown(name: &str) -> String {
    let mut shown: String = name.chars().take(60).map(|c| if c.is_control() { ' ' } else { c }).collect();
    if name.chars().nth(60).is_some() {
        shown.push('…');
    }
    shown
}

/// The mend for a name that is not known: it offers the nearest known name, or else lists the known ones.
fn did_you_mean<'a>(name: &str, known: impl Iterator<Item = &'a str> + Clone) -> String {
    if let Some(near) = crate::nearest::nearest(name, known.clone()) {
        return format!("did you mean \"{}\"?", shown(near));
    }
    const LISTED: usize = 12;
    let listed: Vec<String> = known.clone().take(LISTED).map(|name| format!("\"{}\"", shown(name))).collect();
    match (listed.is_empty(), known.count() > LISTED) {
        (true, _) => "there is none".to_owned(),
        (false, true) => format!("known are {}, …", listed.join(", ")),
        (false, false) => format!("known are {}", listed.join(", ")),
    }
}

#[cfg(test)]
mod tests;
