//! Checks an edited document in memory; files that are already loaded are shared, not read again.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::sync::Arc;

use super::files::{Files, Readers};
use super::{FieldLocator, read_brush, read_cache, read_mesh, read_texture, shared, sort_and_cap};
use crate::assets::AssetFolders;
use crate::check;
use crate::document::{Object, Scene};
use crate::loaded::LoadedScene;
use crate::mesh_format::MeshReader;
use crate::problem::{Problem, Report};
use crate::shot::Choice;

impl LoadedScene {
    /// This scene with another document, checked as if it had been read from the same path. Files that are already
    /// loaded are shared, others that it names are read, and files that it no longer names are dropped.
    ///
    /// # Errors
    /// All problems, warnings included; at least one is fatal. An edited document has no text, so problems have no
    /// line. Instead, each has its `field_path`, and its message begins with that path, with names in place of numbers
    /// where things have names (`objects.apple.keys[1].scale: …`).
    pub fn with_scene(&self, mut scene: Scene, folders: &AssetFolders) -> Result<Self, Report> {
        let path = &self.path;
        let files_found = self.files.copied();
        let folders = &folders.noting(&files_found);
        let reader = MeshReader::default();
        let is_same = scene.shot == self.scene.shot && Choice::of(&scene) == Choice::of(&self.scene);
        let (lost, of_shot) = match self.scene.stage.shot.as_ref().filter(|_| is_same) {
            // A document that was edited has the shot on its stage already. One that was just read has not.
            Some(shot) if scene.stage.shot.is_none() => {
                let lost = Arc::clone(shot).enter(&mut scene);
                (lost.into_iter().map(super::lost_object).collect(), Vec::new())
            }
            _ => super::enter_shot(&reader, path, &mut scene, folders)?,
        };
        let locator = FieldLocator { path, written: None, applied: &[], edited: Some(&scene) };
        let mut problems: Vec<Problem> =
            check::check(&scene).into_iter().chain(lost).map(|finding| locator.problem(finding)).collect();
        let readers = Readers {
            mesh: &|name, with_points| match self.meshes.get(name) {
                Some(mesh) if mesh.points.is_some() || !with_points => Ok((Arc::clone(mesh), Vec::new())),
                _ => read_mesh(&reader, path, name, folders, with_points),
            },
            cache: &|name| match self.caches.get(name) {
                Some(cache) => Ok(Arc::clone(cache)),
                None => read_cache(path, name, folders),
            },
            texture: &|name| match self.textures.get(name) {
                Some(texture) => Ok((Arc::clone(texture), Vec::new())),
                None => read_texture(path, name, folders).map(shared),
            },
            brush: &|name| match self.brushes.get(name) {
                Some(brush) => Ok((Arc::clone(brush), Vec::new())),
                None => read_brush(path, name, folders).map(shared),
            },
        };
        let mut files =
            Files::read(&scene, &readers, |problem, field_path| locator.of_file(problem, field_path));
        let in_meshes = check::check_anew(&scene, &files.meshes, &files.caches, &self.known_in(&scene));
        problems.extend(in_meshes.into_iter().map(|finding| locator.problem(finding)));
        files.problems.splice(..0, of_shot.into_iter().chain(self.warnings_of_files(&files.meshes)));
        sort_and_cap(path, &mut problems, files.problems);
        if problems.iter().any(|problem| problem.severity.is_fatal()) {
            return Err(Report(problems));
        }
        let Files { meshes, caches, textures, brushes, .. } = files;
        Ok(Self {
            path: path.clone(),
            scene,
            meshes,
            caches,
            textures,
            brushes,
            files: files_found,
            warnings: problems,
        })
    }

    /// The parts of `scene` that need no new check, because they equal parts of this scene. This scene has passed the
    /// checks: its morphs fit, and guides and dabs that no warning names lie on their surfaces.
    fn known_in(&self, scene: &Scene) -> check::Known {
        let old = &self.scene;
        let same_surface = |old: &Object, new: &Object| {
            let place = |object: &Object| (object.scale, object.up);
            place(old) == place(new)
                && [&old.mesh, &new.mesh].iter().all(|mesh| self.meshes.contains_key(*mesh))
                && (&old.mesh, &old.group, &old.morph, &old.cache)
                    == (&new.mesh, &new.group, &new.morph, &new.cache)
        };
        let old_objects: HashMap<&str, &Object> =
            old.objects.iter().map(|object| (object.name.as_str(), object)).collect();
        let mut known = check::Known::default();
        let mut kept = HashSet::new();
        for (index, object) in scene.objects.iter().enumerate() {
            if old_objects.get(object.name.as_str()).is_some_and(|old| same_surface(old, object)) {
                known.objects.insert(index);
                kept.insert(object.name.as_str());
            }
        }
        let doubted: Vec<&str> = self.warnings.iter().map(|warning| &*warning.field_path).collect();
        // Whether the list of warnings was cut off: then guides and dabs without a warning may be off their surfaces.
        let is_cut = self.warnings.iter().any(|warning| {
            warning.field_path.is_empty() && warning.path == self.path && warning.place.is_none()
        });
        let old_regions: HashMap<&str, usize> =
            old.regions.iter().enumerate().map(|(index, region)| (region.name.as_str(), index)).collect();
        for (index, region) in scene.regions.iter().enumerate().filter(|_| !is_cut) {
            let Some(&old_index) = old_regions.get(region.name.as_str()) else { continue };
            let old_region = &old.regions[old_index];
            let is_doubted = format!("regions[{old_index}].on");
            let is_kept = region.on.object().is_some_and(|object| kept.contains(object));
            if is_kept && region.on == old_region.on && !doubted.contains(&&*is_doubted) {
                known.dabs.insert(index);
            }
            for (amount_index, amount) in region.amounts.iter().enumerate() {
                let object = amount.object.as_deref().or(region.on.object());
                let was_sound = |place: &usize| {
                    old_region.amounts.get(*place) == Some(amount)
                        && amount.object.as_deref().or(old_region.on.object()) == object
                        && !doubted.contains(&&*format!("regions[{old_index}].amounts[{place}].dabs"))
                };
                let is_kept = object.is_some_and(|object| kept.contains(object));
                let places = [amount_index, amount_index + 1, amount_index.wrapping_sub(1)];
                if is_kept && places.iter().any(was_sound) {
                    known.amounts.insert((index, amount_index));
                }
            }
            for (guide_index, guide) in region.guides.iter().enumerate() {
                let object = guide.object.as_deref().or(region.on.object());
                let old_object = guide.object.as_deref().or(old_region.on.object());
                if object != old_object || !object.is_some_and(|object| kept.contains(object)) {
                    continue;
                }
                // The same index or one next to it: a guide before it may have been added or removed.
                let places = [guide_index, guide_index + 1, guide_index.wrapping_sub(1)];
                let was = places.into_iter().find(|&place| old_region.guides.get(place) == Some(guide));
                let is_well = |place: usize| {
                    let path = format!("regions[{old_index}].guides[{place}].");
                    !doubted.iter().any(|doubted| doubted.starts_with(&path))
                };
                if was.is_some_and(is_well) {
                    known.guides.insert((index, guide_index));
                }
            }
        }
        known
    }

    /// The old warnings about files that are still in use. Those files are not read again, so their warnings would be
    /// lost.
    fn warnings_of_files<T>(&self, still_named: &BTreeMap<String, T>) -> Vec<Problem> {
        let is_dropped = |problem: &Problem| {
            let mut dropped = self.meshes.keys().filter(|name| !still_named.contains_key(*name));
            dropped.any(|name| problem.path.ends_with(name))
        };
        // Warnings about the document have a field path; the new check finds those again.
        let of_files = self.warnings.iter().filter(|problem| problem.field_path.is_empty());
        let of_files = of_files.filter(|problem| problem.path != self.path || problem.place.is_some());
        of_files.filter(|problem| !is_dropped(problem)).cloned().collect()
    }
}

/// A field path with names in place of numbers, where things have names: `objects.apple.keys[1].scale`.
pub(super) fn named_path(scene: &Scene, field_path: &str) -> String {
    let named = |list: &str, index: usize| -> Option<&str> {
        let name = match list {
            "objects" => &scene.objects.get(index)?.name,
            "regions" => &scene.regions.get(index)?.name,
            "lights" => &scene.lights.get(index)?.name,
            "touches" => &scene.touches.get(index)?.name,
            _ => return None,
        };
        let is_plain =
            !name.is_empty() && !name.contains(['.', '[', ']']) && !name.contains(char::is_control);
        is_plain.then_some(name)
    };
    let found = || {
        let (list, rest) = field_path.split_once('[')?;
        let (index, rest) = rest.split_once(']')?;
        Some(format!("{list}.{}{rest}", named(list, index.parse().ok()?)?))
    };
    found().unwrap_or_else(|| field_path.to_owned())
}

#[cfg(test)]
mod tests;
