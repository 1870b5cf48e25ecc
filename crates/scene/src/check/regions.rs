//! Checks regions: what they cover, their directions, their guides.

use std::collections::{HashMap, HashSet};

use glam::DVec3;

use super::{Findings, did_you_mean, shown, strokes};
use crate::document::{Dab, Direction, Guide, GuideMode, PatchRef, Region, Scene, Seam, Selector};
use crate::limits;
use crate::problem::Severity;

pub(super) fn check(scene: &Scene, findings: &mut Findings) {
    findings.unique("regions", scene.regions.iter().map(|region| region.name.as_str()));
    let object_names = names_of_objects(scene);
    for (index, region) in scene.regions.iter().enumerate() {
        let region_path = format!("regions[{index}]");
        if let Some(object) = region.on.object().filter(|object| !object_names.contains(object)) {
            unknown_object(&format!("{region_path}.on"), object, scene, findings);
        }
        if let Selector::Collection(name) = &region.on
            && scene.stage.shot.as_ref().is_none_or(|shot| shot.in_collection(name, "").is_none())
        {
            let message = format!("there is no collection {name:?}: the region covers nothing");
            let mend =
                "collections come from Blender, with the shot: check the name, or name objects one by one";
            findings.warning(format!("{region_path}.on"), message, mend);
        }
        check_patches(&format!("{region_path}.on"), &region.on, findings);
        let turn = limits::MAX_ANGLE_DEG;
        findings.number(&format!("{region_path}.turn_deg"), region.turn_deg, -turn..=turn);
        check_direction(&format!("{region_path}.direction"), &region.direction, findings);
        if let Seam::Soft(distance) = region.seam {
            let range = limits::MIN_LENGTH..=limits::MAX_LENGTH;
            findings.number(&format!("{region_path}.seam"), distance, range);
        }
        for (guide_index, guide) in region.guides.iter().enumerate() {
            let guide_path = format!("{region_path}.guides[{guide_index}]");
            let of = guide.object.as_ref();
            check_object_of(("guide", &guide_path), (scene, &object_names), region, of, findings);
            check_guide(&guide_path, guide, findings);
        }
        strokes::check_of_region(&format!("{region_path}.strokes"), scene, index, findings);
    }
    check_covered(scene, findings);
    check_counts(scene, findings);
}

/// The names of all objects, as a set for many lookups.
pub(super) fn names_of_objects(scene: &Scene) -> HashSet<&str> {
    scene.objects.iter().map(|object| object.name.as_str()).collect()
}

pub(super) fn unknown_object(field_path: &str, object: &str, scene: &Scene, findings: &mut Findings) {
    // With a shot this is only a warning: the next export may bring the object back.
    let severity = if scene.shot.is_some() { Severity::Warning } else { Severity::Error };
    findings.add(severity, || {
        let known = scene.objects.iter().map(|object| object.name.as_str());
        let message = format!("there is no object \"{}\"", shown(object));
        (field_path.to_owned(), message, did_you_mean(object, known))
    });
}

fn check_direction(field_path: &str, direction: &Direction, findings: &mut Findings) {
    let turn = limits::MAX_ANGLE_DEG;
    match *direction {
        Direction::Angle(angle_deg) => findings.number(field_path, angle_deg, -turn..=turn),
        Direction::Crossing(first_deg, second_deg) => {
            findings.number(field_path, first_deg, -turn..=turn);
            findings.number(field_path, second_deg, -turn..=turn);
        }
        Direction::Along(axis) | Direction::Around(axis) => findings.direction(field_path, axis),
        Direction::Toward(point) => findings.vector(field_path, point),
        Direction::Auto | Direction::Up | Direction::Curvature(_) => {}
    }
}

fn check_patches(field_path: &str, on: &Selector, findings: &mut Findings) {
    let patches = on.patches();
    if patches.is_empty() {
        let mend = "give it patches, as in Several(\"apple\", [Whole]), or remove it";
        findings.warning(field_path, "the region has no patches and covers nothing", mend);
    }
    for patch in patches {
        match patch {
            PatchRef::Dabs(dabs) => check_dabs(field_path, dabs, findings),
            PatchRef::Flood(seed, sharp_deg) => {
                findings.vector(field_path, seed.at);
                findings.direction(field_path, seed.normal);
                findings.number(field_path, sharp_deg, 0.0..=180.0);
            }
            PatchRef::Whole | PatchRef::Group(_) | PatchRef::Material(_) => {}
        }
    }
    let takes_away = |patch: &PatchRef<'_>| match patch {
        PatchRef::Dabs(dabs) => !dabs.is_empty() && dabs.iter().all(|dab| dab.take_away),
        _ => false,
    };
    if on.patches().first().is_some_and(takes_away) {
        let mend = "paint dabs that add, or put what they are to cut before them";
        findings.warning(field_path, "the region begins with dabs that take away from nothing", mend);
    }
}

fn check_dabs(field_path: &str, dabs: &[Dab], findings: &mut Findings) {
    if dabs.is_empty() {
        let mend = "paint it somewhere, or remove it";
        findings.warning(field_path, "the region has no dabs and covers nothing", mend);
    }
    // Values inside a variant such as `Dabs(…)` have no path of their own, so findings give the variant's path.
    for dab in dabs {
        findings.vector(field_path, dab.at);
        findings.direction(field_path, dab.normal);
        check_radius(field_path, "a dab", dab.radius, findings);
    }
}

pub(super) fn check_radius(field_path: &str, what: &str, radius: f64, findings: &mut Findings) {
    if radius <= 0.0 {
        let message = format!("{what} with a radius of {} reaches nothing", super::short(radius));
        findings.error(field_path, message, "give a radius above 0");
    } else {
        findings.number(field_path, radius, limits::MIN_LENGTH..=limits::MAX_LENGTH);
    }
}

/// Checks the `object` that an item of a region states. `what` is the kind of item for messages, such as "guide".
pub(super) fn check_object_of(
    (what, its_path): (&str, &str),
    (scene, object_names): (&Scene, &HashSet<&str>),
    region: &Region,
    object: Option<&String>,
    findings: &mut Findings,
) {
    let field_path = format!("{its_path}.object");
    match (object, region.on.object()) {
        (Some(object), _) if !object_names.contains(object.as_str()) => {
            unknown_object(&field_path, object, scene, findings);
        }
        (Some(object), Some(of_region)) if object != of_region => {
            let message = format!("the region lies on \"{}\"", shown(of_region));
            let mend = format!("remove it, or put the {what} into a region of its own");
            findings.error(field_path, message, mend);
        }
        (None, None) => {
            let mend = "name its object, as in object: \"apple\"";
            let message = format!("the region covers every object; whose {what} is this?");
            findings.error(its_path, message, mend);
        }
        _ => {}
    }
}

fn check_guide(guide_path: &str, guide: &Guide, findings: &mut Findings) {
    let path = |field: &str| format!("{guide_path}.{field}");
    check_radius(&path("radius"), "a guide", guide.radius, findings);
    findings.number(&path("strength"), guide.strength, 0.0..=1.0);
    for (index, point) in guide.points.iter().enumerate() {
        findings.vector(&path(&format!("points[{index}].at")), point.at);
        findings.direction(&path(&format!("points[{index}].normal")), point.normal);
        let turn = limits::MAX_ANGLE_DEG;
        findings.number(&path(&format!("points[{index}].turn_deg")), point.turn_deg, -turn..=turn);
    }
    let apart = |pair: &[crate::document::GuidePoint]| {
        (DVec3::from(pair[1].at) - DVec3::from(pair[0].at)).length() > limits::MIN_LENGTH
    };
    if guide.points.len() < 2 {
        let message = match guide.mode {
            GuideMode::Comb => "a guide of one point has no direction",
            GuideMode::Smooth => "a guide of one point is no gesture",
        };
        findings.error(path("points"), message, "give at least two points, in the order of the gesture");
    } else if !guide.points.windows(2).any(apart) {
        let message = "all points of the guide are the same: it has no direction";
        findings.error(path("points"), message, "give points that lie apart");
    }
    if let Some(view) = &guide.view {
        findings.vector(&path("view.eye"), view.eye);
        findings.vector(&path("view.target"), view.target);
        if (DVec3::from(view.eye) - DVec3::from(view.target)).length() < limits::MIN_LENGTH {
            let mend = "move one of them, or leave the view out";
            findings.error(path("view.target"), "eye and target are the same point", mend);
        }
        if let Some(frame) = view.frame {
            findings.frame(&path("view.frame"), frame);
        }
    }
}

/// Warns of regions that a later one covers completely.
fn check_covered(scene: &Scene, findings: &mut Findings) {
    // For each object (key `o…`), group (`g…`) and material (`m…`), and for everything (the empty key): the index of
    // the last region on it.
    let mut last_of: HashMap<String, usize> = HashMap::new();
    let mut cover = |key: String, index: usize| last_of.insert(key, index);
    for (index, region) in scene.regions.iter().enumerate() {
        match &region.on {
            Selector::Everything => cover(String::new(), index),
            Selector::Object(object) => cover(format!("o{object}"), index),
            Selector::Group(object, group) => cover(format!("g{object}\0{group}"), index),
            Selector::Material(object, material) => cover(format!("m{object}\0{material}"), index),
            Selector::EachMaterial(_)
            | Selector::Collection(_)
            | Selector::Dabs(..)
            | Selector::Flood(..)
            | Selector::Several(..) => None,
        };
    }
    for (index, region) in scene.regions.iter().enumerate() {
        let own = match &region.on {
            Selector::Group(object, group) => Some(format!("g{object}\0{group}")),
            Selector::Material(object, material) => Some(format!("m{object}\0{material}")),
            _ => None,
        };
        let whole = region.on.object().map(|object| format!("o{object}"));
        let covering = [own, whole, Some(String::new())]
            .into_iter()
            .flatten()
            .filter_map(|key| last_of.get(&key).copied())
            .filter(|&other| other > index)
            .min();
        if let Some(other) = covering {
            let message =
                format!("the region \"{}\" after it covers all of it", shown(&scene.regions[other].name));
            let mend = "a later region wins: put the smaller one last, or remove one";
            findings.warning(format!("regions[{index}].on"), message, mend);
        }
    }
}

fn check_counts(scene: &Scene, findings: &mut Findings) {
    let guides = || scene.regions.iter().flat_map(|region| &region.guides);
    let mut patches = Vec::new();
    for region in &scene.regions {
        patches.extend(region.on.patches());
    }
    let dabs = patches.iter().map(|patch| match patch {
        PatchRef::Dabs(dabs) => dabs.len(),
        _ => 0,
    });
    let amounts = || scene.regions.iter().flat_map(|region| &region.amounts);
    let floods = patches.iter().filter(|patch| matches!(patch, PatchRef::Flood(..))).count();
    for (what, count, most) in [
        ("guides", guides().count(), limits::MAX_GUIDES),
        ("points of guides", guides().map(|guide| guide.points.len()).sum(), limits::MAX_GUIDE_POINTS),
        ("dabs", dabs.sum(), limits::MAX_DABS),
        ("painted amounts", amounts().count(), limits::MAX_AMOUNTS),
        ("dabs of amounts", amounts().map(|amount| amount.dabs.len()).sum(), limits::MAX_AMOUNT_DABS),
        ("floods", floods, limits::MAX_FLOODS),
        ("patches", patches.len(), limits::MAX_PATCHES),
    ] {
        if count > most {
            let message = format!("the scene has {count} {what}, more than {most}");
            findings.limit("regions", message, "paint with fewer and larger ones");
        }
    }
}
