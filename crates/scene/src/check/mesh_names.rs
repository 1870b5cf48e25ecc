//! Checks that the groups and materials that the document names exist in its meshes.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::sync::Arc;

use super::{Findings, did_you_mean, shown};
use crate::document::{PatchRef, Scene};
use crate::mesh_file::MeshFile;
use crate::problem::Severity;

pub(super) fn check(scene: &Scene, meshes: &BTreeMap<String, Arc<MeshFile>>, findings: &mut Findings) {
    let known: BTreeMap<&str, KnownNames> =
        meshes.iter().map(|(path, mesh)| (path.as_str(), KnownNames::of(path, mesh))).collect();
    for (index, object) in scene.objects.iter().enumerate() {
        if let (Some(group), Some(known)) = (&object.group, known.get(object.mesh.as_str())) {
            known.check(Kind::Group, group, Severity::Error, &format!("objects[{index}].group"), findings);
        }
    }
    let mesh_path_of: HashMap<&str, &str> =
        scene.objects.iter().map(|object| (object.name.as_str(), object.mesh.as_str())).collect();
    for (index, region) in scene.regions.iter().enumerate() {
        let mesh_path = region.on.object().and_then(|object| mesh_path_of.get(object));
        let Some(known) = mesh_path.and_then(|path| known.get(path)) else { continue };
        for patch in region.on.patches() {
            let (kind, name) = match patch {
                PatchRef::Group(group) => (Kind::Group, group),
                PatchRef::Material(material) => (Kind::Material, material),
                PatchRef::Whole | PatchRef::Dabs(_) | PatchRef::Flood(..) => continue,
            };
            // With a shot this is only a warning: the next export may bring the name back.
            let severity = if scene.shot.is_some() { Severity::Warning } else { Severity::Error };
            known.check(kind, name, severity, &format!("regions[{index}].on"), findings);
        }
    }
}

#[derive(Clone, Copy, Debug)]
enum Kind {
    Group,
    Material,
}

/// The names in one mesh, as sets: the check stays quick even if the mesh has many groups and the scene many regions.
struct KnownNames<'a> {
    mesh_path: &'a str,
    groups: BTreeSet<&'a str>,
    materials: BTreeSet<&'a str>,
}

impl<'a> KnownNames<'a> {
    fn of(mesh_path: &'a str, mesh: &'a MeshFile) -> Self {
        Self {
            mesh_path,
            groups: mesh.groups.iter().map(String::as_str).collect(),
            materials: mesh.materials.iter().map(|material| material.name.as_str()).collect(),
        }
    }

    fn check(&self, kind: Kind, name: &str, severity: Severity, field_path: &str, findings: &mut Findings) {
        let (word, known) = match kind {
            Kind::Group => ("group", &self.groups),
            Kind::Material => ("material", &self.materials),
        };
        if !known.contains(name) {
            findings.add(severity, || {
                let message = format!("there is no {word} \"{}\" in {}", shown(name), shown(self.mesh_path));
                (
                    field_path.to_owned(),
                    message,
                    did_you_mean(name, known.iter().copied().filter(|known| !known.is_empty())),
                )
            });
        }
    }
}
