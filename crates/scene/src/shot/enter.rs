//! A shot enters a document that names it, and leaves it before the document is saved.

use std::sync::Arc;

use super::{Shot, Stage};
use crate::check::Finding;
use crate::document::{Object, Scene};
use crate::nearest::nearest;
use crate::problem::Severity;

impl Shot {
    /// Puts the shot on the scene's stage: adds its objects and lights, those that the document states by name overridden, and takes
    /// its frames where the document states none. Returns a warning for each name that the shot does not have any more.
    pub(crate) fn enter(self: &Arc<Self>, scene: &mut Scene) -> Vec<Finding> {
        let mut findings = Vec::new();
        for (index, object) in
            scene.objects.iter_mut().enumerate().filter(|(_, object)| object.mesh.is_empty())
        {
            match self.object_of_name.get(&object.name) {
                Some(&of) => object.mesh.clone_from(&self.objects[of].object.mesh),
                None => findings.push(self.lost(index, object)),
            }
        }
        let (known, lost) =
            std::mem::take(&mut scene.objects).into_iter().partition(|object| !object.mesh.is_empty());
        scene.objects = known;
        for brought in &self.objects {
            if scene.objects.iter().all(|object| object.name != brought.object.name) {
                scene.objects.push(brought.object.clone());
            }
        }
        for (brought, _) in &self.lights {
            if scene.lights.iter().all(|light| light.name != brought.name) {
                scene.lights.push(brought.clone());
            }
        }
        if (scene.timeline.first, scene.timeline.last) == (0, 0) {
            scene.timeline = self.timeline(scene.timeline.fps);
        }
        scene.stage = Stage { shot: Some(Arc::clone(self)), lost: Arc::new(lost) };
        findings
    }

    fn lost(&self, index: usize, object: &Object) -> Finding {
        let names = self.objects.iter().map(|brought| brought.object.name.as_str());
        let mend = match nearest(&object.name, names) {
            Some(near) => format!("did you mean {near:?}? What the scene states for it stays in the file"),
            None => "what the scene states for it stays in the file".to_owned(),
        };
        Finding {
            severity: Severity::Warning,
            field_path: format!("objects[{index}].name"),
            message: format!("the shot has no object {:?}", object.name),
            mend,
        }
    }
}

/// The document without what it only has from its shot, as it is saved. An object of the shot that was deleted is stated as hidden,
/// since it would come back.
pub fn left(scene: &Scene) -> Scene {
    let mut left = scene.clone();
    let Some(shot) = scene.stage.shot() else { return left };
    left.stage = Stage::default();
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
            Some(brought) if brought.mesh == object.mesh => Some(Object { mesh: String::new(), ..object }),
            _ => Some(object),
        })
        .chain(gone)
        .chain(scene.stage.lost.iter().cloned())
        .collect();
    left.lights.retain(|light| shot.lights.iter().all(|(brought, _)| brought != light));
    let timeline = shot.timeline(scene.timeline.fps);
    if timeline == scene.timeline {
        (left.timeline.first, left.timeline.last) = (0, 0);
    }
    left
}
