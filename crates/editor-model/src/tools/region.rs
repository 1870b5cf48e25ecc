//! The region tool for clicks: makes or extends a region by a flood of faces, a group or a material of the mesh.

use glam::DVec3;
use impasto_core::flood::flooded;
use impasto_scene::document::{Patch, Region, Seed, Selector};

use super::{NOTHING_HERE, Surroundings, ToolEvent, ToolOutput};
use crate::command::{Command, Regions};
use crate::picking::Hit;
use crate::refusal::Refusal;
use crate::session::{RegionBy, RegionDoes};

/// Takes an event. Only a press does something; all other events give the words for the status line.
pub(super) fn take(event: &ToolEvent, around: &Surroundings) -> ToolOutput {
    let ToolEvent::Press { at_px, .. } = *event else {
        let what = match around.options.region_by {
            RegionBy::Flood => "flood from here",
            RegionBy::Group => "take a group",
            RegionBy::Material => "take a material",
            RegionBy::Brush => "",
        };
        let to = match (around.options.region_does, around.selected_region()) {
            (RegionDoes::Add, Some(region)) => format!(" into {}", around.scene().regions[region].name),
            _ => " into a new region".to_owned(),
        };
        return ToolOutput::saying(format!("[Click] {what}{to}"));
    };
    let hit = around.hit(at_px).ok_or_else(|| Refusal::new(NOTHING_HERE));
    match hit.and_then(|hit| Ok((chosen(&hit, around)?, taken(&hit, around)?))) {
        Ok((commit, None)) => ToolOutput { commit: Some(commit), ..ToolOutput::default() },
        Ok((commit, Some(words))) => ToolOutput { ask: Some((commit, words)), ..ToolOutput::default() },
        Err(refusal) => ToolOutput::refusing(refusal),
    }
}

/// What the click would take from other regions, in words; `None` if it takes nothing. Regions of whole objects do not
/// count, because they are there to be divided.
fn taken(hit: &Hit, around: &Surroundings) -> Result<Option<String>, Refusal> {
    let own = around.selected_region().filter(|_| around.options.region_does == RegionDoes::Add);
    let mut counts = vec![0_usize; around.scene().regions.len()];
    for triangle in covered(hit, around)? {
        let region = around.painted.region_at(&on_face(hit, triangle, around));
        if let Some(count) = region.filter(|region| Some(*region) != own).and_then(|at| counts.get_mut(at)) {
            *count += 1;
        }
    }
    let is_of_parts = |region: &Region| {
        !matches!(region.on, Selector::Object(_) | Selector::Everything | Selector::Collection(_))
    };
    let taken: Vec<String> = around
        .scene()
        .regions
        .iter()
        .zip(counts)
        .filter(|(region, count)| *count > 0 && is_of_parts(region))
        .map(|(region, count)| {
            let faces = if count == 1 { "1 triangle".to_owned() } else { format!("{count} triangles") };
            format!("{faces} of {}", region.name)
        })
        .collect();
    Ok((!taken.is_empty()).then(|| taken.join(", ")))
}

/// The triangles that a click covers.
fn covered(hit: &Hit, around: &Surroundings) -> Result<Vec<usize>, Refusal> {
    let unknown = || Refusal::new(NOTHING_HERE);
    let object = around.object(hit.object).ok_or_else(unknown)?;
    let surface = around.picker.surface(hit.object).ok_or_else(unknown)?;
    let (mesh, file) = (&surface.mesh, around.loaded.meshes.get(&object.mesh).ok_or_else(unknown)?);
    let named = |of_triangle: &[u32], index: Option<usize>| -> Vec<usize> {
        let is_named = |triangle: &usize| Some(of_triangle[*triangle] as usize) == index;
        (0..of_triangle.len()).filter(is_named).collect()
    };
    Ok(match patch(hit, around)?.0 {
        Patch::Group(name) => {
            named(&mesh.group_of_triangle, file.groups.iter().position(|known| *known == name))
        }
        Patch::Material(name) => {
            named(&mesh.material_of_triangle, file.materials.iter().position(|known| known.name == name))
        }
        Patch::Flood(seed, sharp_deg) => {
            let [at, normal] = [seed.at, seed.normal].map(DVec3::from);
            let reached = flooded(mesh, at, normal, sharp_deg.to_radians());
            (0..reached.len()).filter(|&triangle| reached[triangle]).collect()
        }
        _ => Vec::new(),
    })
}

/// A hit at the middle of a triangle of the same object.
fn on_face(hit: &Hit, triangle: usize, around: &Surroundings) -> Hit {
    let Some(surface) = around.picker.surface(hit.object) else { return *hit };
    let [a, b, c] = surface.mesh.corners(triangle).map(|corner| corner.as_dvec3());
    let normal = (b - a).cross(c - a).normalize_or_zero();
    Hit {
        triangle: triangle as u32,
        barycentric: [1.0 / 3.0; 3],
        position_in_model: (a + b + c) / 3.0,
        normal_in_model: normal,
        face_normal_in_model: normal,
        ..*hit
    }
}

fn chosen(hit: &Hit, around: &Surroundings) -> Result<Command, Refusal> {
    let object = around.object(hit.object).ok_or_else(|| Refusal::new(NOTHING_HERE))?;
    if object.locked {
        return Err(Refusal::new(format!("{} is locked", object.name)));
    }
    let (patch, name) = patch(hit, around)?;
    let selected = around.selected_region().and_then(|region| around.scene().regions.get(region));
    match (around.options.region_does, selected) {
        (RegionDoes::TakeAway, _) => Err(Refusal::new("Only the brush takes away: choose Brush")),
        (RegionDoes::Add, Some(region)) => {
            if region.locked {
                return Err(Refusal::new(format!("{} is locked", region.name)));
            }
            let on = added(&region.on, &object.name, patch)
                .ok_or_else(|| Refusal::new(format!("{} does not lie on {}", region.name, object.name)))?;
            Ok(Command::Regions(Regions::SetSelector(region.name.clone(), on)))
        }
        (RegionDoes::New | RegionDoes::Add, _) => {
            let on = match patch {
                Patch::Group(group) => Selector::Group(object.name.clone(), group),
                Patch::Material(material) => Selector::Material(object.name.clone(), material),
                Patch::Flood(seed, sharp_deg) => Selector::Flood(object.name.clone(), seed, sharp_deg),
                other => Selector::Several(object.name.clone(), vec![other]),
            };
            Ok(Command::Regions(Regions::Add(Box::new(Region::new(name, on)))))
        }
    }
}

/// The patch that a click chooses, and a name for a region of it.
fn patch(hit: &Hit, around: &Surroundings) -> Result<(Patch, String), Refusal> {
    let object = around.object(hit.object).ok_or_else(|| Refusal::new(NOTHING_HERE))?;
    let unknown = || Refusal::new(format!("The mesh of {} names none here", object.name));
    let file = around.loaded.meshes.get(&object.mesh).ok_or_else(unknown)?;
    let surface = around.picker.surface(hit.object).ok_or_else(unknown)?;
    let triangle = hit.triangle as usize;
    match around.options.region_by {
        RegionBy::Group => {
            let group = surface.mesh.group_of_triangle.get(triangle);
            let name = group.and_then(|&group| file.groups.get(group as usize)).ok_or_else(unknown)?;
            Ok((Patch::Group(name.clone()), name.clone()))
        }
        RegionBy::Material => {
            let material = surface.mesh.material_of_triangle.get(triangle);
            let known = material.and_then(|&material| file.materials.get(material as usize));
            let name = known.map(|material| material.name.clone()).filter(|name| !name.is_empty());
            let name = name.ok_or_else(unknown)?;
            Ok((Patch::Material(name.clone()), name))
        }
        RegionBy::Flood | RegionBy::Brush => {
            let [at, normal] = [hit.position_in_model, hit.face_normal_in_model].map(|v| v.to_array());
            let sharp_deg = around.options.flood_deg.clamp(0.0, 180.0);
            Ok((Patch::Flood(Seed { at, normal }, sharp_deg), format!("{} part", object.name)))
        }
    }
}

/// The selector with one more patch on `object`; `None` if the selector is not of that object.
fn added(on: &Selector, object: &str, patch: Patch) -> Option<Selector> {
    if on.object() != Some(object) {
        return None;
    }
    let mut patches = match on.clone() {
        Selector::Several(_, patches) => patches,
        Selector::Group(_, group) => vec![Patch::Group(group)],
        Selector::Material(_, material) => vec![Patch::Material(material)],
        Selector::Dabs(_, dabs) => vec![Patch::Dabs(dabs)],
        Selector::Flood(_, seed, sharp_deg) => vec![Patch::Flood(seed, sharp_deg)],
        Selector::EachMaterial(material) => vec![Patch::Material(material)],
        Selector::Object(_) | Selector::Everything | Selector::Collection(_) => vec![Patch::Whole],
    };
    patches.push(patch);
    Some(Selector::Several(object.to_owned(), patches))
}
