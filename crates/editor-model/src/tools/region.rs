//! The region tool for clicks: makes or extends a region by a flood of faces, a group or a material of the mesh.

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
    match around.hit(at_px).ok_or_else(|| Refusal::new(NOTHING_HERE)).and_then(|hit| chosen(&hit, around)) {
        Ok(commit) => ToolOutput { commit: Some(commit), ..ToolOutput::default() },
        Err(refusal) => ToolOutput::refusing(refusal),
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
