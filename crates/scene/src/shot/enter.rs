//! A shot enters a document that names it, and leaves it before the document is saved.

use std::sync::Arc;

use super::Shot;
use crate::document::{Color, Light, LightKind, Lost, Object, Scene, Stage, Timeline};
use crate::nearest::nearest;

/// Whether a scene states neither a rate nor frames. Then the rate is the shot's.
fn is_unstated(timeline: &Timeline) -> bool {
    *timeline == Timeline { animation: timeline.animation.clone(), ..Timeline::default() }
}

/// See [`crate::document::Brought::enter`].
pub(super) fn enter(shot: Arc<Shot>, scene: &mut Scene) -> Vec<Lost> {
    let mut missing = Vec::new();
    for (index, object) in scene.objects.iter_mut().enumerate().filter(|(_, object)| object.mesh.is_empty()) {
        if let Some(&of) = shot.object_of_name.get(&object.name) {
            object.mesh.clone_from(&shot.objects[of].object.mesh);
            // An object with keys of its own gets the cache too: keys move the whole object, a cache moves its points.
            if object.cache.is_none() {
                object.cache.clone_from(&shot.objects[of].object.cache);
            }
            continue;
        }
        let names = shot.objects.iter().map(|brought| brought.object.name.as_str());
        let near = nearest(&object.name, names).map(str::to_owned);
        missing.push(Lost { index, name: object.name.clone(), near });
    }
    let objects = std::mem::take(&mut scene.objects);
    let (known, lost): (Vec<Object>, Vec<Object>) =
        objects.into_iter().partition(|object| !object.mesh.is_empty());
    scene.objects = known;
    for brought in &shot.objects {
        if scene.objects.iter().all(|object| object.name != brought.object.name) {
            scene.objects.push(brought.object.clone());
        }
    }
    for (brought, _) in &shot.lights {
        if scene.lights.iter().all(|light| light.name != brought.name) {
            scene.lights.push(brought.clone());
        }
    }
    if let Some(sky) = shot.sky().filter(|_| scene.background == Color::default()) {
        scene.background = sky;
    }
    if is_unstated(&scene.timeline) {
        scene.timeline.fps = shot.rate();
    }
    if (scene.timeline.first, scene.timeline.last) == (0, 0) {
        (scene.timeline.first, scene.timeline.last) = shot.frames(scene.timeline.fps);
    }
    scene.stage = Stage { shot: Some(shot), lost: Arc::new(lost) };
    missing
}

/// See [`crate::document::Brought::left`].
pub(super) fn left(shot: &Shot, scene: &Scene) -> Scene {
    let mut left = Scene { stage: Stage::default(), ..scene.clone() };
    let objects = std::mem::take(&mut left.objects);
    let is_gone = |brought: &&Object| objects.iter().all(|object| object.name != brought.name);
    let brought = || shot.objects.iter().map(|brought| &brought.object);
    let gone: Vec<Object> = brought()
        .filter(is_gone)
        .map(|brought| Object { hidden: true, ..Object::new(brought.name.clone(), "") })
        .collect();
    left.objects = objects
        .into_iter()
        .filter_map(|object| match brought().find(|brought| brought.name == object.name) {
            Some(brought) if *brought == object => None,
            Some(brought) if brought.mesh == object.mesh => {
                let cache = object.cache.clone().filter(|_| object.cache != brought.cache);
                Some(Object { mesh: String::new(), cache, ..object })
            }
            _ => Some(object),
        })
        .chain(gone)
        .chain(scene.stage.lost.iter().cloned())
        .collect();
    left.lights.retain(|light| shot.lights.iter().all(|(brought, _)| brought != light));
    // Stands for a light of the shot that was deleted: an ambient light never follows the shot, and casts no shadow.
    let dark = |name: &str| Light { intensity: 0.0, ..Light::new(name, LightKind::Ambient) };
    let is_gone = |brought: &&Light| scene.lights.iter().all(|light| light.name != brought.name);
    let brought = shot.lights.iter().map(|(brought, _)| brought);
    left.lights.extend(brought.filter(is_gone).map(|brought| dark(&brought.name)));
    if shot.sky() == Some(scene.background) {
        left.background = Color::default();
    }
    if shot.frames(scene.timeline.fps) == (scene.timeline.first, scene.timeline.last) {
        (left.timeline.first, left.timeline.last) = (0, 0);
        if scene.timeline.fps == shot.rate() {
            left.timeline.fps = Timeline::default().fps;
        }
    }
    left
}
