//! Checks the document against its meshes: that guides and dabs lie on surfaces, groups and materials have triangles, a
//! morph has the topology of its mesh, and a point cache has as many points as its mesh.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::sync::Arc;

use glam::{DMat3, DVec3};
use impasto_core::nearest::nearest_point;

use super::{Findings, Known, shown};
use crate::document::{Guide, Object, PatchRef, Scene};
use crate::mesh_file::MeshFile;
use crate::morph;
use crate::point_cache::PointCache;

/// The most distances between a point and a triangle that one check may need: each point of a guide and each dab counts
/// once for every triangle of its mesh. Guides and dabs beyond the limit are not checked.
const MOST_DISTANCES: usize = 200_000_000;

pub(super) fn check(
    scene: &Scene,
    meshes: &BTreeMap<String, Arc<MeshFile>>,
    known: &Known,
    findings: &mut Findings,
) {
    for (index, object) in
        scene.objects.iter().enumerate().filter(|(index, _)| !known.objects.contains(index))
    {
        let Some(target) = object.morph.as_ref().and_then(|path| meshes.get(path)) else { continue };
        let Some(base) = meshes.get(&object.mesh) else { continue };
        if base.bend.as_ref().is_some_and(|bend| bend.skin.is_some()) {
            let message = format!("joints bend {} already: it cannot morph as well", shown(&object.mesh));
            findings.error(format!("objects[{index}].morph"), message, "use the file's own shape keys");
            continue;
        }
        if let Err(difference) = morph::target_of(base, target) {
            let message = format!("{} does not go with {}: {difference}", morph_name(object), object.mesh);
            let mend = "export both from the same mesh, with the same faces in the same order; a face without area is no face";
            findings.error(format!("objects[{index}].morph"), message, mend);
        }
    }
    let objects: HashMap<&str, &Object> =
        scene.objects.iter().map(|object| (object.name.as_str(), object)).collect();
    let mut covered: HashMap<*const MeshFile, Covered<'_>> = HashMap::new();
    let mut left = MOST_DISTANCES;
    for (index, region) in scene.regions.iter().enumerate() {
        let mesh_of = |name: &str| {
            let object = objects.get(name)?;
            Some((*object, meshes.get(&object.mesh)?))
        };
        if let Some((object, file)) = region.on.object().and_then(mesh_of) {
            let field_path = format!("regions[{index}].on");
            for patch in region.on.patches() {
                if matches!(patch, PatchRef::Group(_) | PatchRef::Material(_)) {
                    let covered = covered.entry(Arc::as_ptr(file)).or_insert_with(|| Covered::of(file));
                    covered.check(&field_path, patch, findings);
                }
                if let PatchRef::Dabs(dabs) = patch
                    && !known.dabs.contains(&index)
                {
                    let places = dabs.iter().map(|dab| (dab.at, dab.radius));
                    check_dabs(&field_path, places, (object, file), &mut left, findings);
                }
            }
        }
        for (amount_index, amount) in region.amounts.iter().enumerate() {
            let name = amount.object.as_deref().or(region.on.object());
            if let Some((object, file)) = name.and_then(mesh_of)
                && !known.amounts.contains(&(index, amount_index))
            {
                let field_path = format!("regions[{index}].amounts[{amount_index}].dabs");
                let places = amount.dabs.iter().map(|dab| (dab.at, dab.radius));
                check_dabs(&field_path, places, (object, file), &mut left, findings);
            }
        }
        let is_new = |guide: usize| !known.guides.contains(&(index, guide));
        for (guide_index, guide) in region.guides.iter().enumerate().filter(|(guide, _)| is_new(*guide)) {
            let name = guide.object.as_deref().or(region.on.object());
            if let Some((object, file)) = name.and_then(mesh_of) {
                let guide_path = format!("regions[{index}].guides[{guide_index}]");
                check_guide(&guide_path, guide, object, file, &mut left, findings);
            }
        }
    }
}

/// Checks that each point cache moves as many points as its mesh has. If so, also checks that its positions are valid.
pub(super) fn check_caches(
    scene: &Scene,
    meshes: &BTreeMap<String, Arc<MeshFile>>,
    caches: &BTreeMap<String, Arc<PointCache>>,
    findings: &mut Findings,
) {
    for (index, object) in scene.objects.iter().enumerate() {
        let field_path = format!("objects[{index}].cache");
        let Some(name) = &object.cache else { continue };
        let (Some(cache), Some(mesh)) = (caches.get(name), meshes.get(&object.mesh)) else { continue };
        let Some(points) = &mesh.points else {
            let message = format!("{} does not say which points a cache moves", shown(&object.mesh));
            findings.error(field_path, message, "export the object as an OBJ file together with its cache");
            continue;
        };
        if points.count != cache.count() {
            let [cached, own] = [cache.count(), points.count];
            let message =
                format!("{} moves {cached} points, but {} has {own}", shown(name), shown(&object.mesh));
            findings.error(
                field_path,
                message,
                "export both from the same mesh, without modifiers that add points",
            );
        } else if let Some([message, mend]) = cache.fault_of_places() {
            findings.error(field_path, format!("{}: {message}", shown(name)), mend);
        }
    }
}

fn morph_name(object: &Object) -> String {
    shown(object.morph.as_deref().unwrap_or_default())
}

/// The groups and materials that a mesh file names but no triangle uses.
struct Covered<'a> {
    empty_groups: HashSet<&'a str>,
    empty_materials: HashSet<&'a str>,
}

impl<'a> Covered<'a> {
    fn of(file: &'a MeshFile) -> Self {
        let mesh = &file.mesh;
        // A mesh without triangles was reported when it was read.
        let empty = |names: Vec<&'a str>, used: &[u32]| -> HashSet<&'a str> {
            let mut is_used = vec![mesh.triangles.is_empty(); names.len()];
            for &name in used {
                if let Some(is_used) = is_used.get_mut(name as usize) {
                    *is_used = true;
                }
            }
            let mut empty = HashSet::new();
            // If several have the same name, the first counts.
            let mut seen = HashSet::new();
            for (name, is_used) in names.into_iter().zip(is_used) {
                if seen.insert(name) && !is_used {
                    empty.insert(name);
                }
            }
            empty
        };
        let groups = file.groups.iter().map(String::as_str).collect();
        let materials = file.materials.iter().map(|material| material.name.as_str()).collect();
        Self {
            empty_groups: empty(groups, &mesh.group_of_triangle),
            empty_materials: empty(materials, &mesh.material_of_triangle),
        }
    }

    /// Warns of a patch that covers nothing.
    fn check(&self, field_path: &str, patch: PatchRef<'_>, findings: &mut Findings) {
        let (word, name, is_empty) = match patch {
            PatchRef::Group(group) => ("group", group, self.empty_groups.contains(group)),
            PatchRef::Material(material) => ("material", material, self.empty_materials.contains(material)),
            PatchRef::Whole | PatchRef::Dabs(_) | PatchRef::Flood(..) => return,
        };
        if is_empty {
            let message =
                format!("the {word} \"{}\" has no triangles: the region covers nothing", shown(name));
            findings.warning(field_path, message, "give it faces in the mesh file, or remove the region");
        }
    }
}

/// Searches the triangles that an object shows, in the object's own space. Quick if successive queries lie close
/// together.
struct Reached<'a> {
    file: &'a MeshFile,
    model_from_file: DMat3,
    /// The group that the object shows; `None` for all.
    group: Option<u32>,
    /// The triangle found last: each search begins there.
    last: usize,
}

impl<'a> Reached<'a> {
    /// `None` if the object has no surface, or `radius` is not above 0.
    fn of(object: &Object, file: &'a MeshFile, radius: f64) -> Option<Self> {
        if radius <= 0.0 || file.mesh.triangles.is_empty() || object.scale.0.contains(&0.0) {
            return None;
        }
        let group =
            object.group.as_ref().and_then(|group| file.groups.iter().position(|known| known == group));
        let group = group.map(|group| group as u32);
        Some(Self { file, model_from_file: object.model_from_file(), group, last: 0 })
    }

    fn shows(&self, triangle: usize) -> bool {
        let own = self.file.mesh.group_of_triangle.get(triangle).copied().unwrap_or(0);
        self.group.is_none_or(|group| own == group)
    }

    /// How far away a triangle is, if that is less than `least`. Its box is compared first, which is cheaper.
    fn distance_below(&self, least: f64, at: DVec3, triangle: usize) -> Option<f64> {
        let corners = self.file.mesh.corners(triangle).map(|corner| self.model_from_file * corner.as_dvec3());
        let [low, high] = [DVec3::min, DVec3::max].map(|end| end(end(corners[0], corners[1]), corners[2]));
        let to_box = at - at.clamp(low, high);
        if to_box.length_squared() >= least * least {
            return None;
        }
        Some((at - nearest_point(at, corners)).length()).filter(|&distance| distance < least)
    }

    /// Whether a triangle that is shown lies within `radius` of `at`. One corner of each triangle is compared first,
    /// which is cheaper than the distance to the triangle.
    fn is_near(&mut self, at: DVec3, radius: f64) -> bool {
        let mesh = &self.file.mesh;
        let by_corner = |triangle: usize| {
            let corner = mesh.positions[mesh.triangles[triangle][0] as usize].as_dvec3();
            (at - self.model_from_file * corner).length_squared() < radius * radius
        };
        let from_last =
            || (self.last..mesh.triangles.len()).chain(0..self.last).filter(|&triangle| self.shows(triangle));
        let found = from_last()
            .find(|&triangle| by_corner(triangle))
            .or_else(|| from_last().find(|&triangle| self.distance_below(radius, at, triangle).is_some()));
        self.last = found.unwrap_or(self.last);
        found.is_some()
    }

    /// How far away the nearest triangle is.
    fn least_distance(&self, at: DVec3) -> f64 {
        let shown = (0..self.file.mesh.triangles.len()).filter(|&triangle| self.shows(triangle));
        shown.fold(f64::INFINITY, |least, triangle| self.distance_below(least, at, triangle).unwrap_or(least))
    }
}

fn check_guide(
    guide_path: &str,
    guide: &Guide,
    object: &Object,
    file: &MeshFile,
    left: &mut usize,
    findings: &mut Findings,
) {
    let Some(mut reached) = Reached::of(object, file, guide.radius) else { return };
    let mut farthest = (0.0, 0);
    for (index, point) in guide.points.iter().enumerate() {
        let Some(rest) = left.checked_sub(file.mesh.triangles.len()) else { break };
        *left = rest;
        let at = DVec3::from(point.at);
        if reached.is_near(at, guide.radius) {
            continue;
        }
        let nearest = reached.least_distance(at);
        if nearest > farthest.0 {
            farthest = (nearest, index);
        }
    }
    let (distance, index) = farthest;
    if distance >= guide.radius {
        let message = format!(
            "the guide is {} away from \"{}\", farther than it reaches ({})",
            super::short((distance * 1e4).round() / 1e4),
            shown(&object.name),
            super::short(guide.radius)
        );
        let mend = "move its points onto the surface, in the object's own space; it holds where it reaches";
        findings.warning(format!("{guide_path}.points[{index}].at"), message, mend);
    }
}

/// Warns of dabs that touch nothing. `dabs` gives the place and radius of each.
fn check_dabs(
    field_path: &str,
    dabs: impl ExactSizeIterator<Item = ([f64; 3], f64)>,
    (object, file): (&Object, &MeshFile),
    left: &mut usize,
    findings: &mut Findings,
) {
    let Some(mut reached) = Reached::of(object, file, 1.0) else { return };
    let (mut off, count) = (0, dabs.len());
    // A radius that is not above 0 and a place that is not finite are reported elsewhere.
    for (at, radius) in dabs.filter(|&(at, radius)| radius > 0.0 && DVec3::from(at).is_finite()) {
        let Some(rest) = left.checked_sub(file.mesh.triangles.len()) else { break };
        *left = rest;
        off += usize::from(!reached.is_near(DVec3::from(at), radius));
    }
    if off > 0 {
        let name = shown(&object.name);
        let message = format!("{off} of {count} dabs touch nothing of \"{name}\"");
        findings.warning(field_path, message, "move them onto the surface, in the object's own space");
    }
}
