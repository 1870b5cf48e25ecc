//! Commands on things of every kind: names, parents, order, visibility, locks, copies, deletion.

use glam::{DAffine3, DMat3, DVec3};
use impasto_scene::document::{ObjectKey, Scene};
use impasto_scene::motion;

use super::time::keys_of_shot;
use super::touches::touch_mut;
use super::{Done, counted, object_mut, posable_object, region_mut, unlocked_object, unlocked_region};
use crate::euler;
use crate::names;
use crate::refusal::Refusal;
use crate::selection::{Item, Selection};

/// Names, parents, order, visibility, locks, copies, deletion.
#[derive(Clone, Debug, PartialEq)]
pub enum Edit {
    /// Deletes things. An object is deleted with all that lies on it: its regions and touches, and its guides and
    /// painted amounts in other regions. Its children move to its parent.
    Delete(Vec<Item>),
    /// Makes copies of objects (with their regions and touches), regions, lights, guides and touches, and selects the
    /// copies.
    Duplicate(Vec<Item>),
    /// Gives a thing another name.
    Rename(Item, String),
    /// Makes an object the child of another one, or of none. Its pose in the world at the reference's frame stays
    /// (nearly so if a parent has an uneven scale).
    SetParent {
        /// The object.
        object: String,
        /// The new parent, if any.
        parent: Option<String>,
    },
    /// Moves an object, a region, a light, a guide or a touch to another place in its list. Later regions win.
    Reorder(Item, usize),
    /// Hides objects, regions and touches, or shows them again.
    SetHidden(Vec<Item>, bool),
    /// Locks objects and regions against changes, or unlocks them. Locked ones can still be renamed, hidden, reordered
    /// and duplicated.
    SetLocked(Vec<Item>, bool),
}

impl Edit {
    pub(super) fn edit(&self, scene: &mut Scene) -> Result<Done, Refusal> {
        match self {
            Self::Delete(items) => delete(scene, items),
            Self::Duplicate(items) => duplicate(scene, items),
            Self::Rename(item, name) => rename(scene, item, name),
            Self::SetParent { object, parent } => set_parent(scene, object, parent.as_deref()),
            Self::Reorder(item, to) => reorder(scene, item, *to),
            Self::SetHidden(items, hidden) => {
                for item in items {
                    match item {
                        Item::Object(name) => object_mut(scene, name)?.hidden = *hidden,
                        Item::Region(name) => region_mut(scene, name)?.hidden = *hidden,
                        Item::Touch(name) => touch_mut(scene, name)?.hidden = *hidden,
                        _ => return Err(Refusal::new(format!("{} cannot be hidden", item.name()))),
                    }
                }
                let what = of_items(items);
                Ok(Done::new(if *hidden { format!("Hide {what}") } else { format!("Show {what}") }))
            }
            Self::SetLocked(items, locked) => {
                for item in items {
                    match item {
                        Item::Object(name) => object_mut(scene, name)?.locked = *locked,
                        Item::Region(name) => region_mut(scene, name)?.locked = *locked,
                        _ => return Err(Refusal::new(format!("{} cannot be locked", item.name()))),
                    }
                }
                let what = of_items(items);
                Ok(Done::new(if *locked { format!("Lock {what}") } else { format!("Unlock {what}") }))
            }
        }
    }
}

fn of_items(items: &[Item]) -> String {
    let names: Vec<&str> = items.iter().map(Item::name).collect();
    counted(&names, "things")
}

fn delete(scene: &mut Scene, items: &[Item]) -> Result<Done, Refusal> {
    // Items are sorted here and deleted from the last to the first, so that the indices of guides stay valid until they
    // are deleted.
    let mut items = items.to_vec();
    items.sort();
    items.dedup();
    let text = match &items[..] {
        [] => return Err(Refusal::new("Nothing is selected")),
        [Item::Guide(region, index)] => format!("Delete guide g{} of {region}", index + 1),
        items => format!("Delete {}", of_items(items)),
    };
    for item in items.iter().rev() {
        if !item.is_in(scene) {
            continue;
        }
        match item {
            Item::Camera => return Err(Refusal::new("The shot needs its camera")),
            Item::Light(name) => scene.lights.retain(|light| light.name != *name),
            Item::Region(name) => {
                unlocked_region(scene, name)?;
                scene.regions.retain(|region| region.name != *name);
            }
            Item::Guide(region, index) => {
                unlocked_region(scene, region)?.guides.remove(*index);
            }
            Item::Object(name) => delete_object(scene, name)?,
            Item::Touch(name) => {
                touch_mut(scene, name)?;
                scene.touches.retain(|touch| touch.name != *name);
            }
        }
    }
    Ok(Done::new(text).selecting(Selection::default()))
}

/// Deletes an object with what lies on it, and gives its children to its parent. Refuses if it is locked, or if a
/// child's pose may not be changed (it is locked, or the shot moves it).
pub(super) fn delete_object(scene: &mut Scene, name: &str) -> Result<(), Refusal> {
    let parent = unlocked_object(scene, name)?.parent.clone();
    let frame = motion::referred_to(scene, &scene.reference).1;
    let children: Vec<String> = scene
        .objects
        .iter()
        .filter(|object| object.parent.as_deref() == Some(name))
        .map(|object| object.name.clone())
        .collect();
    for child in children {
        reparent(scene, &child, parent.as_deref(), frame)?;
    }
    scene.objects.retain(|object| object.name != name);
    scene.regions.retain(|region| region.on.object() != Some(name));
    scene.touches.retain(|touch| touch.on != name);
    for region in &mut scene.regions {
        region.guides.retain(|guide| guide.object.as_deref() != Some(name));
        region.amounts.retain(|amount| amount.object.as_deref() != Some(name));
    }
    Ok(())
}

fn duplicate(scene: &mut Scene, items: &[Item]) -> Result<Done, Refusal> {
    let mut made = Vec::new();
    for item in items {
        match item {
            Item::Object(name) => made.push(Item::Object(duplicate_object(scene, name)?)),
            Item::Region(name) => {
                let mut region = region_mut(scene, name)?.clone();
                region.locked = false;
                region.name = names::unique(name, scene.regions.iter().map(|region| region.name.as_str()));
                made.push(Item::Region(region.name.clone()));
                scene.regions.push(region);
            }
            Item::Light(name) => {
                let light = scene.lights.iter().find(|light| light.name == *name);
                let mut light = light.ok_or_else(|| Refusal::unknown("light", name))?.clone();
                light.name = names::unique(name, scene.lights.iter().map(|light| light.name.as_str()));
                made.push(Item::Light(light.name.clone()));
                scene.lights.push(light);
            }
            Item::Guide(region, index) => {
                let guides = &mut unlocked_region(scene, region)?.guides;
                let guide = guides.get(*index).ok_or_else(|| Refusal::new("There is no such guide"))?.clone();
                guides.push(guide);
                made.push(Item::Guide(region.clone(), guides.len() - 1));
            }
            Item::Touch(name) => {
                let mut touch = touch_mut(scene, name)?.clone();
                touch.name = names::unique(name, scene.touches.iter().map(|touch| touch.name.as_str()));
                made.push(Item::Touch(touch.name.clone()));
                scene.touches.push(touch);
            }
            Item::Camera => return Err(Refusal::new("The shot has one camera")),
        }
    }
    if made.is_empty() {
        return Err(Refusal::new("Nothing is selected"));
    }
    Ok(Done::new(format!("Duplicate {}", of_items(items))).selecting(made.into_iter().collect()))
}

fn duplicate_object(scene: &mut Scene, name: &str) -> Result<String, Refusal> {
    let object = object_mut(scene, name)?.clone();
    let mut copy = object.clone();
    copy.name = names::unique(name, scene.objects.iter().map(|object| object.name.as_str()));
    copy.locked = false;
    // The shot does not move the copy, so the copy gets keys: the motion that the shot gives the object.
    if scene.is_moved_by_shot(&object) {
        copy.keys = keys_of_shot(scene, &object);
    }
    let new = copy.name.clone();
    let of_it: Vec<_> =
        scene.regions.iter().filter(|region| region.on.object() == Some(name)).cloned().collect();
    for mut region in of_it {
        region.locked = false;
        region.name = names::unique(&region.name, scene.regions.iter().map(|region| region.name.as_str()));
        // `rename_object` gets a scene with only this region, so that nothing else is renamed.
        let mut alone =
            Scene { objects: Vec::new(), regions: vec![region], touches: Vec::new(), ..scene.clone() };
        names::rename_object(&mut alone, name, &new);
        scene.regions.append(&mut alone.regions);
    }
    let touches: Vec<_> = scene.touches.iter().filter(|touch| touch.on == name).cloned().collect();
    for mut touch in touches {
        touch.name = names::unique(&touch.name, scene.touches.iter().map(|touch| touch.name.as_str()));
        touch.on.clone_from(&new);
        scene.touches.push(touch);
    }
    scene.objects.push(copy);
    Ok(new)
}

fn rename(scene: &mut Scene, item: &Item, name: &str) -> Result<Done, Refusal> {
    let new = names::typed(name)?;
    let old = item.name().to_owned();
    let taken = |mut names: Box<dyn Iterator<Item = &str> + '_>| {
        if new != old && names.any(|name| name == new) {
            Err(Refusal::new(format!("Something else is named \"{new}\"")))
        } else {
            Ok(())
        }
    };
    match item {
        Item::Object(_) => {
            object_mut(scene, &old)?;
            if scene.stage.shot.as_ref().is_some_and(|shot| shot.has_object(&old)) {
                let shot = scene.shot.as_deref().unwrap_or("the shot");
                return Err(Refusal::new(format!("{old} has its name from {shot}: rename it there")));
            }
            taken(Box::new(scene.objects.iter().map(|object| object.name.as_str())))?;
            names::rename_object(scene, &old, &new);
        }
        Item::Region(_) => {
            taken(Box::new(scene.regions.iter().map(|region| region.name.as_str())))?;
            region_mut(scene, &old)?.name.clone_from(&new);
        }
        Item::Light(_) => {
            taken(Box::new(scene.lights.iter().map(|light| light.name.as_str())))?;
            let light = scene.lights.iter_mut().find(|light| light.name == old);
            light.ok_or_else(|| Refusal::unknown("light", &old))?.name.clone_from(&new);
        }
        Item::Touch(_) => {
            taken(Box::new(scene.touches.iter().map(|touch| touch.name.as_str())))?;
            touch_mut(scene, &old)?.name.clone_from(&new);
        }
        Item::Camera | Item::Guide(..) => return Err(Refusal::new("That has no name of its own")),
    }
    let renamed = match item {
        Item::Object(_) => Item::Object(new.clone()),
        Item::Region(_) => Item::Region(new.clone()),
        Item::Touch(_) => Item::Touch(new.clone()),
        _ => Item::Light(new.clone()),
    };
    Ok(Done::new(format!("Rename to {new}")).selecting(Selection::only(renamed)))
}

fn set_parent(scene: &mut Scene, object: &str, parent: Option<&str>) -> Result<Done, Refusal> {
    unlocked_object(scene, object)?;
    let mut above = parent;
    for _ in 0..=scene.objects.len() {
        let Some(name) = above else { break };
        if name == object {
            return Err(Refusal::new(format!("{object} cannot stand on what stands on it")));
        }
        let found = scene.objects.iter().find(|object| object.name == name);
        above = found.ok_or_else(|| Refusal::unknown("object", name))?.parent.as_deref();
    }
    let frame = motion::referred_to(scene, &scene.reference).1;
    let before = object_mut(scene, object)?.parent.clone();
    reparent(scene, object, parent, frame)?;
    Ok(Done::new(match (parent, before) {
        (Some(parent), _) => format!("Put {object} under {parent}"),
        (None, Some(before)) => format!("Take {object} off {before}"),
        (None, None) => format!("Take {object} off"),
    }))
}

/// Changes an object's parent. Its keys are converted from the old parent's space to the new one's, with both parents
/// as they stand at `frame`.
fn reparent(scene: &mut Scene, object: &str, parent: Option<&str>, frame: f64) -> Result<(), Refusal> {
    let poses = motion::poses_at(scene, frame);
    let pose_of = |name: Option<&str>| {
        let index = name.and_then(|name| scene.objects.iter().position(|object| object.name == name));
        index.map_or(DAffine3::IDENTITY, |index| poses[index])
    };
    let (old, new) = (parent_of(scene, object), parent);
    let new_from_old = pose_of(new).inverse() * pose_of(old.as_deref());
    let object = posable_object(scene, object)?;
    object.parent = parent.map(str::to_owned);
    if new_from_old.abs_diff_eq(DAffine3::IDENTITY, 1e-12) {
        return Ok(());
    }
    if object.keys.is_empty() {
        object.keys.push(ObjectKey::at(frame));
    }
    // Keys hold no shear, so the map is taken to be a translation, a rotation and an even scale. That is not
    // exact if a parent has an uneven scale.
    let factor = new_from_old.matrix3.determinant().cbrt();
    let turn: DMat3 = new_from_old.matrix3 * (1.0 / factor);
    for key in &mut object.keys {
        key.translation =
            new_from_old.transform_point3(DVec3::from(key.translation)).map(euler::tidy).to_array();
        key.rotation_deg = euler::degrees(turn * euler::matrix(key.rotation_deg), key.rotation_deg);
        key.scale = key.scale.times(factor, euler::tidy);
    }
    Ok(())
}

fn parent_of(scene: &Scene, object: &str) -> Option<String> {
    scene.objects.iter().find(|other| other.name == object).and_then(|object| object.parent.clone())
}

fn reorder(scene: &mut Scene, item: &Item, to: usize) -> Result<Done, Refusal> {
    fn shift<T>(list: &mut Vec<T>, from: Option<usize>, to: usize) -> Result<&'static str, Refusal> {
        let from = from.ok_or_else(|| Refusal::new("That is not there any more"))?;
        let moved = list.remove(from);
        let to = to.min(list.len());
        list.insert(to, moved);
        Ok(if to < from { "up" } else { "down" })
    }
    let name = item.name();
    let way = match item {
        Item::Object(_) => {
            let from = scene.objects.iter().position(|object| object.name == name);
            shift(&mut scene.objects, from, to)?
        }
        Item::Region(_) => {
            let from = scene.regions.iter().position(|region| region.name == name);
            shift(&mut scene.regions, from, to)?
        }
        Item::Light(_) => {
            let from = scene.lights.iter().position(|light| light.name == name);
            shift(&mut scene.lights, from, to)?
        }
        Item::Guide(region, index) => {
            let guides = &mut unlocked_region(scene, region)?.guides;
            let from = (*index < guides.len()).then_some(*index);
            let way = shift(guides, from, to)?;
            let to = to.min(guides.len() - 1);
            let selection = Selection::only(Item::Guide(region.clone(), to));
            return Ok(Done::new(format!("Move guide {way}")).selecting(selection));
        }
        Item::Touch(_) => {
            let from = scene.touches.iter().position(|touch| touch.name == name);
            shift(&mut scene.touches, from, to)?
        }
        Item::Camera => return Err(Refusal::new("The shot has one camera")),
    };
    Ok(Done::new(format!("Move {name} {way}")))
}
