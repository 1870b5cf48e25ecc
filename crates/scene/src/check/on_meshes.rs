//! Guides on surfaces, groups without triangles, morphs of equal topology.

use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

use glam::DVec3;

use super::{Findings, shown};
use crate::document::{Guide, Object, Scene, Selector};
use crate::mesh_file::MeshFile;
use crate::morph;

/// Distances of guides to triangles that are measured at most; past that, the rest is taken on trust.
const MOST_DISTANCES: usize = 200_000_000;

pub(super) fn check(scene: &Scene, meshes: &BTreeMap<String, Arc<MeshFile>>, findings: &mut Findings) {
    for (index, object) in scene.objects.iter().enumerate() {
        let Some(target) = object.morph.as_ref().and_then(|path| meshes.get(path)) else { continue };
        let Some(base) = meshes.get(&object.mesh) else { continue };
        if let Err(difference) = morph::target_of(base, target) {
            let message = format!("{} does not go with {}: {difference}", quoted(object), object.mesh);
            let mend = "export both from the same mesh, with the same faces in the same order; a face without area is no face";
            findings.error(format!("objects[{index}].morph"), message, mend);
        }
    }
    let objects: HashMap<&str, &Object> =
        scene.objects.iter().map(|object| (object.name.as_str(), object)).collect();
    let mut left = MOST_DISTANCES;
    for (index, region) in scene.regions.iter().enumerate() {
        let mesh_of = |name: &str| {
            let object = objects.get(name)?;
            Some((*object, meshes.get(&object.mesh)?))
        };
        if let Some((_, file)) = region.on.object().and_then(mesh_of) {
            check_covers(&format!("regions[{index}].on"), &region.on, file, findings);
        }
        for (guide_index, guide) in region.guides.iter().enumerate() {
            let name = guide.object.as_deref().or(region.on.object());
            if let Some((object, file)) = name.and_then(mesh_of) {
                let guide_path = format!("regions[{index}].guides[{guide_index}]");
                check_guide(&guide_path, guide, (object, file), (&mut left, findings));
            }
        }
    }
}

fn quoted(object: &Object) -> String {
    shown(object.morph.as_deref().unwrap_or_default())
}

/// A group or material that is named in the file and used by no triangle.
fn check_covers(field_path: &str, on: &Selector, file: &MeshFile, findings: &mut Findings) {
    let mesh = &file.mesh;
    if mesh.triangles.is_empty() {
        return; // Whoever read it has said so.
    }
    let (word, name, is_empty) = match on {
        Selector::Group(_, group) => {
            let used = |&g: &u32| file.groups.get(g as usize) == Some(group);
            let known = file.groups.contains(group);
            ("group", group, known && !mesh.group_of_triangle.iter().any(used))
        }
        Selector::Material(_, material) => {
            let used = |&m: &u32| file.materials.get(m as usize).is_some_and(|known| known.name == *material);
            let known = file.materials.iter().any(|known| known.name == *material);
            ("material", material, known && !mesh.material_of_triangle.iter().any(used))
        }
        Selector::Everything | Selector::Object(_) | Selector::Dabs(..) => return,
    };
    if is_empty {
        let message = format!("the {word} \"{}\" has no triangles: the region covers nothing", shown(name));
        findings.warning(field_path, message, "give it faces in the mesh file, or remove the region");
    }
}

fn check_guide(
    guide_path: &str,
    guide: &Guide,
    (object, file): (&Object, &MeshFile),
    (left, findings): (&mut usize, &mut Findings),
) {
    let mesh = &file.mesh;
    let model_from_file = object.model_from_file();
    if guide.radius <= 0.0 || mesh.triangles.is_empty() || object.scale.0.contains(&0.0) {
        return;
    }
    let of_object = |triangle: usize| {
        object.group.as_ref().is_none_or(|group| {
            let index = mesh.group_of_triangle.get(triangle).map_or(0, |&group| group as usize);
            file.groups.get(index) == Some(group)
        })
    };
    let mut farthest = (0.0, 0);
    for (index, point) in guide.points.iter().enumerate() {
        let Some(rest) = left.checked_sub(mesh.triangles.len()) else { return };
        *left = rest;
        let at = DVec3::from(point.at);
        let distance_to = |triangle: usize| {
            let corners = mesh.corners(triangle).map(|corner| model_from_file * corner.as_dvec3());
            (at - nearest_point(at, corners)).length()
        };
        let nearest = (0..mesh.triangles.len())
            .filter(|&triangle| of_object(triangle))
            .map(distance_to)
            .fold(f64::INFINITY, f64::min);
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

/// The point of a triangle that is nearest to `at` (Ericson, Real-Time Collision Detection, 5.1.5); of one without area,
/// of its edges.
fn nearest_point(at: DVec3, [a, b, c]: [DVec3; 3]) -> DVec3 {
    let (ab, ac) = (b - a, c - a);
    let normal = ab.cross(ac);
    let on_plane = at - normal * ((at - a).dot(normal) / normal.length_squared());
    let inside = |from: DVec3, to: DVec3| (to - from).cross(on_plane - from).dot(normal) >= 0.0;
    if normal.length_squared() > 0.0 && inside(a, b) && inside(b, c) && inside(c, a) {
        return on_plane;
    }
    let on_edge = |from: DVec3, to: DVec3| {
        let edge = to - from;
        let t = (at - from).dot(edge) / edge.length_squared();
        if t.is_finite() { from + edge * t.clamp(0.0, 1.0) } else { from }
    };
    let candidates = [on_edge(a, b), on_edge(b, c), on_edge(c, a)];
    candidates
        .into_iter()
        .min_by(|p, q| (at - *p).length_squared().total_cmp(&(at - *q).length_squared()))
        .unwrap_or(a)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearest_points_of_a_triangle() {
        let triangle = [DVec3::ZERO, DVec3::X, DVec3::Y];
        let near = |at: [f64; 3]| nearest_point(DVec3::from(at), triangle);
        assert_eq!(near([0.2, 0.2, 5.0]), DVec3::new(0.2, 0.2, 0.0));
        assert_eq!(near([-1.0, -1.0, 1.0]), DVec3::ZERO);
        assert!((near([1.0, 1.0, 0.0]) - DVec3::new(0.5, 0.5, 0.0)).length() < 1e-12);
        let needle = [DVec3::ZERO, DVec3::X, DVec3::X * 0.5];
        assert_eq!(nearest_point(DVec3::new(0.7, 3.0, 0.0), needle), DVec3::new(0.7, 0.0, 0.0));
    }
}
