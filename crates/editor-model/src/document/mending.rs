//! Lists the problems of a document, and repairs them; each repair is one entry of the history. A *loss* is a part of
//! the file that could not be used.

use std::path::PathBuf;
use std::sync::Arc;

use glam::DVec3;
use impasto_core::nearest::nearest_point;
use impasto_scene::document::{GuidePoint, Scene};
use impasto_scene::load::salvage::{self, Loss};
use impasto_scene::problem::Problem;

use super::{Document, Step};
use crate::change::SceneChange;
use crate::command::{Command, Directions};
use crate::refusal::Refusal;
use crate::source::Source;

/// One problem of the document, for a list.
#[derive(Clone, Debug, PartialEq)]
pub struct ProblemRow {
    /// The problem, and its place in the text.
    pub problem: Problem,
    /// What is used until the problem is mended, as a sentence; empty for warnings.
    pub instead: String,
    /// The possible repairs, the best last.
    pub repairs: Vec<Repair>,
}

/// A repair of a problem.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Repair {
    /// Lets the user choose a file in place of a missing one, such as a texture, and copies it there. Not for meshes.
    Bring {
        /// Where the missing file is looked for.
        to: PathBuf,
    },
    /// Reads the files again, in case the missing one is there now.
    Retry,
    /// Lets the user choose another mesh for an object.
    Locate {
        /// The object.
        object: String,
    },
    /// A change of the scene's text.
    Fix {
        /// Index of the loss in the source.
        loss: usize,
        /// What its button says: *Rename*, *Use leaf.obj*.
        verb: String,
        /// Whether the change is certain, because nothing else can have been meant.
        is_certain: bool,
    },
    /// Moves the points of a guide onto the surface.
    Snap {
        /// The region.
        region: String,
        /// The guide's index in the region.
        guide: usize,
    },
}

impl Document {
    /// All problems: first what could not be read or used, then the rest.
    pub fn problems(&self) -> Vec<ProblemRow> {
        let losses = self.open_losses().map(|(index, loss)| {
            let mut repairs = missing_file(&loss.problem, loss.mesh.is_some());
            let object_with = |mesh: &String| self.scene().objects.iter().find(|object| object.mesh == *mesh);
            if let Some(object) = loss.mesh.as_ref().and_then(object_with) {
                repairs.push(Repair::Locate { object: object.name.clone() });
            }
            repairs.extend(loss.fix.as_ref().map(|fix| Repair::Fix {
                loss: index,
                verb: fix.verb.clone(),
                is_certain: fix.is_certain,
            }));
            ProblemRow { problem: loss.problem.clone(), instead: loss.instead.clone(), repairs }
        });
        let warnings = self.loaded.warnings.iter().map(|problem| {
            let snap = guide_in(&problem.field_path).and_then(|(region, guide)| {
                let region = self.scene().regions.get(region)?.name.clone();
                Some(Repair::Snap { region, guide })
            });
            let mut repairs = missing_file(problem, false);
            repairs.extend(snap);
            ProblemRow { problem: problem.clone(), instead: String::new(), repairs }
        });
        losses.chain(warnings).collect()
    }

    /// How many problems [`Document::problems`] lists.
    pub fn problem_count(&self) -> usize {
        self.loss_count() + self.loaded.warnings.len()
    }

    /// How many losses are left.
    pub fn loss_count(&self) -> usize {
        self.open_losses().count()
    }

    /// Whether saving over the scene's file would lose a part of its text that could not be read. A mesh that is
    /// missing or cannot be used does not count, because the saved scene still names it.
    pub fn saving_loses(&self) -> bool {
        self.unread_parts().next().is_some()
    }

    /// The parts of the text that could not be read.
    pub(super) fn unread_parts(&self) -> impl Iterator<Item = &Loss> {
        self.open_losses().map(|(_, loss)| loss).filter(|loss| loss.mesh.is_none())
    }

    /// The losses that are left, with their indices. An unusable mesh counts only while the scene names it.
    fn open_losses(&self) -> impl Iterator<Item = (usize, &Loss)> {
        let losses = self.source.iter().flat_map(|source| source.losses.iter().enumerate());
        losses.filter(|(_, loss)| {
            let is_named = |mesh: &String| self.scene().objects.iter().any(|object| object.mesh == *mesh);
            loss.mesh.as_ref().is_none_or(is_named)
        })
    }

    /// Mends one loss.
    ///
    /// # Errors
    /// If it has no fix, or if what the fix changes was edited since. The document is then unchanged.
    pub fn fix_problem(&mut self, loss: usize) -> Result<Step, Refusal> {
        self.fix(&[loss])
    }

    /// Indices of the losses whose repair is certain.
    pub fn certain(&self) -> Vec<usize> {
        let is_certain = |loss: &Loss| loss.fix.as_ref().is_some_and(|fix| fix.is_certain);
        self.open_losses().filter(|(_, loss)| is_certain(loss)).map(|(index, _)| index).collect()
    }

    /// Mends all losses whose repair is certain, as one entry of the history.
    ///
    /// # Errors
    /// As [`Document::fix_problem`].
    pub fn fix_certain(&mut self) -> Result<Step, Refusal> {
        self.fix(&self.certain())
    }

    fn fix(&mut self, losses: &[usize]) -> Result<Step, Refusal> {
        let source = self.source.clone().ok_or_else(|| Refusal::new("There is nothing to fix"))?;
        let fixed: Vec<&Loss> = losses.iter().filter_map(|&index| source.losses.get(index)).collect();
        let fixes: Vec<_> = fixed.iter().filter_map(|loss| loss.fix.as_ref()).collect();
        if fixes.is_empty() {
            return Err(Refusal::new("Nothing here can be fixed without you"));
        }
        let text = match fixed[..] {
            [one] => format!("Fix line {}", one.problem.place.map_or(1, |place| place.line)),
            _ => format!("Fix {} problems", fixes.len()),
        };
        self.read_instead(&salvage::mended(&source.text, &fixes), text)
    }

    /// Reads another text in place of the one that the scene was read from. The file on disk stays as it is.
    ///
    /// # Errors
    /// If nothing of the text can be read, or if it changes something that was edited since. The document is then
    /// unchanged.
    pub fn read_text(&mut self, text: &str) -> Result<Step, Refusal> {
        self.read_instead(text, "Read the source again".to_owned())
    }

    fn read_instead(&mut self, text: &str, words: String) -> Result<Step, Refusal> {
        let read = salvage::salvage_text(&self.loaded.path, text, &self.options)
            .map_err(|report| Refusal::of(&report))?;
        let after = Source::of(&read).map(Arc::new);
        let loaded = match &self.source {
            // The scene was edited since it was read: merge the edits with the new text.
            Some(source) if source.scene != *self.scene() => {
                let scene = merged_scene(&source.scene, &read.loaded.scene, self.scene())?;
                // The merged scene gets the meshes that were just read, with boxes in place of unusable ones.
                let held = after.as_ref().map(|after| after.held(&read.loaded));
                let held = held.as_ref().unwrap_or(&read.loaded);
                held.with_scene(scene, &self.options.folders).map_err(|report| Refusal::of(&report))?
            }
            _ => read.loaded,
        };
        let change = SceneChange::between(self.scene(), &loaded.scene);
        // If text and scene are the same, only the scene's files were read again, and there is nothing to save.
        let is_same = change.is_none() && self.source.as_ref().is_some_and(|source| source.text == text);
        let stays_saved = is_same && !self.is_edited();
        let sources = [self.source.clone(), after.clone()];
        self.preview = None;
        self.loaded = Arc::new(loaded);
        self.source = after;
        self.revision += 1;
        let before = self.selection.clone();
        self.select(before.clone());
        self.history.push(words.clone(), change.unwrap_or_default(), [before, self.selection.clone()]);
        self.history.mark_sources(sources);
        if stays_saved {
            self.history.mark_saved();
        }
        Ok(Step { text: words, note: None })
    }

    /// Moves the points of a guide onto the surface that they belong to.
    ///
    /// # Errors
    /// If there is no such guide or surface, or the region is locked.
    pub fn snap_guide(&mut self, region: &str, guide: usize) -> Result<Step, Refusal> {
        let scene = self.scene();
        let of = scene.regions.iter().find(|other| other.name == region);
        let (region_of, found) = of
            .and_then(|of| Some((of, of.guides.get(guide)?)))
            .ok_or_else(|| Refusal::unknown("region", region))?;
        let name = found.object.as_deref().or(region_of.on.object());
        let object = scene.objects.iter().find(|object| Some(object.name.as_str()) == name);
        let surface = object.and_then(|object| Some((object, self.loaded.meshes.get(&object.mesh)?)));
        let (object, file) = surface.ok_or_else(|| Refusal::new("There is no surface to snap to"))?;
        let model_from_file = object.model_from_file();
        let group = object.group.as_ref().and_then(|name| file.groups.iter().position(|known| known == name));
        let mesh = &file.mesh;
        let of_object = |triangle: &usize| {
            group.is_none_or(|group| {
                mesh.group_of_triangle.get(*triangle).is_some_and(|&own| own as usize == group)
            })
        };
        let snapped = |point: &GuidePoint| {
            let at = DVec3::from(point.at);
            let places = (0..mesh.triangles.len()).filter(of_object).map(|triangle| {
                let corners = mesh.corners(triangle).map(|corner| model_from_file * corner.as_dvec3());
                (nearest_point(at, corners), corners)
            });
            let squared = |place: &DVec3| (*place - at).length_squared();
            let (place, [a, b, c]) =
                places.min_by(|left, right| squared(&left.0).total_cmp(&squared(&right.0)))?;
            let normal = (b - a).cross(c - a).try_normalize();
            let normal = normal.map_or(point.normal, |normal| normal.to_array());
            Some(GuidePoint { at: place.to_array(), normal, ..point.clone() })
        };
        let points = found.points.iter().enumerate().filter_map(|(index, point)| {
            let guide = (region.to_owned(), guide);
            Some(Command::Directions(Directions::MoveGuidePoint { guide, point: index, to: snapped(point)? }))
        });
        let words = format!("Snap guide g{} to the surface", guide + 1);
        let command = Command::Several(words, points.collect());
        self.apply(&command)
    }
}

/// The repairs for a missing file. A mesh gets no [`Repair::Bring`], because the user can choose another mesh with
/// [`Repair::Locate`].
fn missing_file(problem: &Problem, is_mesh: bool) -> Vec<Repair> {
    let Some(to) = problem.missing_file() else { return Vec::new() };
    let bring = (!is_mesh).then_some(Repair::Bring { to });
    std::iter::once(Repair::Retry).chain(bring).collect()
}

/// The indices of region and guide in a path such as `regions[1].guides[2].points[0].at`.
fn guide_in(field_path: &str) -> Option<(usize, usize)> {
    let (region, rest) = field_path.strip_prefix("regions[")?.split_once("].guides[")?;
    let (guide, _) = rest.split_once("].points[")?;
    Some((region.parse().ok()?, guide.parse().ok()?))
}

/// Three-way merge of two versions, `left` and `right`, of the scene `from`. Refused if both changed the same thing,
/// each in another way.
fn merged_scene(from: &Scene, left: &Scene, right: &Scene) -> Result<Scene, Refusal> {
    macro_rules! merged {
        ($field:ident, $words:literal) => {
            merged_value(&from.$field, &left.$field, &right.$field, $words)?
        };
    }
    /// The merged list of one field, whose items have unique names.
    macro_rules! merged_by_name {
        ($field:ident) => {
            merged_list(&from.$field, &left.$field, &right.$field, |item| &item.name)?
        };
    }
    // Every field is named, so that a new one cannot be forgotten.
    Ok(Scene {
        version: right.version,
        size: merged!(size, "size"),
        seed: merged!(seed, "seed"),
        background: merged!(background, "background"),
        background_keys: merged!(background_keys, "background's keys"),
        shot: merged!(shot, "shot"),
        stage: if left.shot == from.shot { right.stage.clone() } else { left.stage.clone() },
        timeline: merged!(timeline, "timeline"),
        reference: merged!(reference, "reference"),
        further_references: merged!(further_references, "references"),
        camera: merged!(camera, "shot camera"),
        exposure: merged!(exposure, "exposure"),
        lights: merged_by_name!(lights),
        objects: merged_by_name!(objects),
        strokes: merged!(strokes, "strokes"),
        regions: merged_by_name!(regions),
        touches: merged_by_name!(touches),
        style: merged!(style, "style"),
        aovs: merged!(aovs, "AOVs"),
    })
}

fn merged_value<T: Clone + PartialEq>(from: &T, left: &T, right: &T, what: &str) -> Result<T, Refusal> {
    if left == from || left == right {
        Ok(right.clone())
    } else if right == from {
        Ok(left.clone())
    } else {
        Err(Refusal::new(format!("{what} was edited since: undo that first, or save a copy")))
    }
}

/// Three-way merge of lists of named things: `right`, with what `left` changed, added and removed since `from`. If one
/// of the two removed what the other changed, or if both added the same name, `right` wins. Refused if both changed a
/// thing, each in another way.
fn merged_list<T: Clone + PartialEq>(
    from: &[T],
    left: &[T],
    right: &[T],
    name: impl Fn(&T) -> &String,
) -> Result<Vec<T>, Refusal> {
    let find = |list: &'_ [T], wanted: &T| list.iter().position(|item| name(item) == name(wanted));
    let mut merged = Vec::new();
    for item in right {
        let [was, now] = [from, left].map(|list| find(list, item).map(|index| &list[index]));
        match (was, now) {
            (Some(was), Some(now)) => merged.push(merged_value(was, now, item, name(item))?),
            (Some(was), None) if was == item => {}
            _ => merged.push(item.clone()),
        }
    }
    for (index, item) in left.iter().enumerate() {
        if find(from, item).is_none() && find(right, item).is_none() {
            // `left` added this item. Of the items before it in `left`, it goes behind the nearest one that is in
            // `merged`, or first if there is none.
            let before = left[..index].iter().rev().find_map(|before| find(&merged, before));
            merged.insert(before.map_or(0, |at| at + 1), item.clone());
        }
    }
    Ok(merged)
}
