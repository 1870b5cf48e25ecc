//! Checks the objects of a scene: their names, parents, particle counts, scales and keys.

use std::collections::HashMap;

use super::{Findings, did_you_mean, noise_displace, short, shown};
use crate::document::{Object, Rest, Scene};
use crate::limits;

pub(super) fn check(scene: &Scene, findings: &mut Findings) {
    let objects = &scene.objects;
    findings.unique("objects", objects.iter().map(|object| object.name.as_str()));
    for (index, object) in objects.iter().enumerate() {
        let object_path = format!("objects[{index}]");
        // An object of the shot may leave out its mesh: the shot has it.
        if !(object.mesh.is_empty() && scene.shot.is_some()) {
            findings.name(&format!("{object_path}.mesh"), &object.mesh);
        }
        check_object(&object_path, object, findings);
    }
    check_particles(objects, findings);
    check_parents(objects, findings);
}

fn check_object(object_path: &str, object: &Object, findings: &mut Findings) {
    if let Some(texture) = object.material.as_ref().and_then(|material| material.texture.as_deref()) {
        findings.name(&format!("{object_path}.material.texture"), texture);
    }
    if let Some(gloss) = object.material.as_ref().and_then(|material| material.gloss) {
        findings.number(&format!("{object_path}.material.gloss"), gloss, 0.0..=1.0);
    }
    if let Some(noise) = object.material.as_ref().and_then(|material| material.noise_displace.as_ref()) {
        noise_displace::check(&format!("{object_path}.material"), noise, findings);
    }
    if let Some(morph) = &object.morph {
        findings.name(&format!("{object_path}.morph"), morph);
    }
    if let Some(cache) = &object.cache {
        findings.name(&format!("{object_path}.cache"), cache);
    }
    if let Rest::Frame(frame) = object.rest {
        findings.frame(&format!("{object_path}.rest"), frame as f64);
    }
    check_scale(&format!("{object_path}.scale"), object.scale.0, findings);
    findings.number(
        &format!("{object_path}.hold"),
        f64::from(object.hold),
        1.0..=f64::from(limits::MAX_HOLD),
    );
    findings.keys(&format!("{object_path}.keys"), &object.keys);
    for (index, key) in object.keys.iter().enumerate() {
        findings.vector(&format!("{object_path}.keys[{index}].translation"), key.translation);
        let turn = limits::MAX_ANGLE_DEG;
        for angle_deg in key.rotation_deg {
            findings.number(&format!("{object_path}.keys[{index}].rotation_deg"), angle_deg, -turn..=turn);
        }
        let bad = key.scale.0.into_iter().find(|scale| !limits::KEY_SCALE.contains(scale));
        let scale = bad.unwrap_or(key.scale.0[0]);
        findings.number(&format!("{object_path}.keys[{index}].scale"), scale, limits::KEY_SCALE);
        findings.number(&format!("{object_path}.keys[{index}].morph"), key.morph, 0.0..=1.0);
    }
    let without_target =
        object.keys.iter().position(|key| key.morph != 0.0).filter(|_| object.morph.is_none());
    if let Some(index) = without_target {
        let message = "the object has nothing to turn into";
        let mend = "name a mesh of equal topology in the object's `morph`";
        findings.error(format!("{object_path}.keys[{index}].morph"), message, mend);
    }
}

fn check_scale(field_path: &str, scale: [f64; 3], findings: &mut Findings) {
    let range = limits::MIN_LENGTH..=limits::MAX_LENGTH;
    let is_good = |component: &f64| *component == 0.0 || range.contains(component);
    if let Some(bad) = scale.iter().find(|component| !is_good(component)) {
        let (least, most) = (short(limits::MIN_LENGTH), short(limits::MAX_LENGTH));
        let mend = if *bad < 0.0 {
            "a mirrored mesh must be mirrored in its file; give a positive scale".to_owned()
        } else {
            format!("give a scale from {least} to {most}")
        };
        findings.error(field_path, format!("{} is no scale", short(*bad)), mend);
    } else if scale.contains(&0.0) {
        let mend = "give a scale above 0, or remove the object";
        findings.warning(field_path, "a scale of 0 leaves no surface; the object is not painted", mend);
    }
}

fn check_particles(objects: &[Object], findings: &mut Findings) {
    let mut sum = 0_u64;
    let mut is_sum_reported = false;
    for (index, object) in objects.iter().enumerate() {
        let Some(particles) = object.particles else { continue };
        let field_path = format!("objects[{index}].particles");
        if particles == 0 {
            let mend = "give a number above 0, or leave it out to have it found from the coverage";
            findings.warning(field_path, "no particles: the object is not painted", mend);
        } else if particles > limits::MAX_PARTICLES_OF_OBJECT {
            let limit = limits::MAX_PARTICLES_OF_OBJECT;
            let message = format!("{particles} particles are more than {limit}");
            findings.limit(field_path, message, format!("give at most {limit}"));
        } else {
            sum += particles; // No overflow: each is small, and a file holds no more than a million values.
            if sum > limits::MAX_PARTICLES && !is_sum_reported {
                is_sum_reported = true;
                let limit = limits::MAX_PARTICLES;
                let message = format!("with this object the scene has more than {limit} particles");
                findings.limit(field_path, message, "give the objects fewer");
            }
        }
    }
}

fn check_parents(objects: &[Object], findings: &mut Findings) {
    let index_of: HashMap<&str, usize> =
        objects.iter().enumerate().rev().map(|(index, object)| (object.name.as_str(), index)).collect();
    let parents: Vec<Option<usize>> = objects
        .iter()
        .map(|object| object.parent.as_deref().and_then(|parent| index_of.get(parent).copied()))
        .collect();
    for (index, object) in objects.iter().enumerate() {
        let Some(parent) = &object.parent else { continue };
        if parents[index].is_none() {
            let others = objects.iter().map(|other| other.name.as_str()).filter(|name| *name != object.name);
            findings.add(crate::problem::Severity::Error, || {
                let message = format!("there is no object \"{}\"", shown(parent));
                (format!("objects[{index}].parent"), message, did_you_mean(parent, others))
            });
        }
    }
    for index in first_of_each_cycle(&parents) {
        let name = shown(&objects[index].name);
        let message = format!("\"{name}\" is, through its parents, its own parent");
        findings.error(format!("objects[{index}].parent"), message, "take one of the parents away");
    }
}

/// The least index in each cycle of parents. Each object is visited at most twice.
fn first_of_each_cycle(parents: &[Option<usize>]) -> Vec<usize> {
    let mut walk_of: Vec<Option<usize>> = vec![None; parents.len()];
    let mut firsts = Vec::new();
    for start in 0..parents.len() {
        let mut at = Some(start);
        while let Some(index) = at.filter(|&index| walk_of[index].is_none()) {
            walk_of[index] = Some(start);
            at = parents[index];
        }
        // A walk that meets its own trail has gone round a cycle; one that meets an older trail finds nothing new.
        if let Some(index) = at.filter(|&index| walk_of[index] == Some(start)) {
            let round = std::iter::successors(parents[index], |&inner| parents[inner]);
            firsts.push(round.take_while(|&inner| inner != index).fold(index, usize::min));
        }
    }
    firsts.sort_unstable();
    firsts
}
