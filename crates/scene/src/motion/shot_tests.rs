//! Tests of what a shot moves. They use a shot whose values are the time at which it is evaluated.

use std::sync::Arc;

use super::*;
use crate::document::{Light, LightKey, LightKind, Lost, ObjectKey, Scene, Seen};

/// A shot whose values are the time in seconds: the X of `thing` and of the camera, the weight by which `thing` bends,
/// the intensity of lights. `thing` is hidden from second 2 on.
#[derive(Debug)]
struct Clock;

impl Brought for Clock {
    fn has_camera(&self) -> bool {
        true
    }

    fn has_object(&self, name: &str) -> bool {
        name == "thing"
    }

    fn span_s(&self) -> Option<[f32; 2]> {
        None
    }

    fn at(&self, time_s: f64) -> Posed {
        let mut posed = Posed::default();
        posed.world_from_node.push(DAffine3::from_translation(DVec3::X * time_s));
        posed
    }

    fn pose_of(&self, posed: &Posed, name: &str) -> Option<DAffine3> {
        self.has_object(name).then(|| posed.world_from_node[0])
    }

    fn bends(&self, name: &str, _mesh: &str) -> bool {
        self.has_object(name)
    }

    fn bend_of(&self, posed: &Posed, name: &str, mesh: &str) -> Option<BendPose> {
        let weights = vec![time_of(posed) as f32];
        self.bends(name, mesh).then(|| BendPose { weights, ..BendPose::default() })
    }

    fn changes_visibility(&self) -> bool {
        true
    }

    fn is_visible(&self, posed: &Posed, name: &str) -> bool {
        !self.has_object(name) || time_of(posed) < 2.0
    }

    fn camera(&self, time_s: f64, _size: (u32, u32)) -> Option<Seen> {
        let world_from_view = DMat4::from_translation(DVec3::X * time_s);
        Some(Seen { world_from_view, lens: Lens::default(), shift: DVec2::ZERO })
    }

    fn in_collection(&self, _collection: &str, _object: &str) -> Option<bool> {
        None
    }

    fn exposure_stops(&self) -> f32 {
        0.0
    }

    fn light(&self, light: &Light, posed: &Posed) -> Light {
        Light { intensity: time_of(posed), ..light.clone() }
    }

    fn enter(self: Arc<Self>, _scene: &mut Scene) -> Vec<Lost> {
        Vec::new()
    }

    fn left(&self, scene: &Scene) -> Scene {
        scene.clone()
    }
}

fn time_of(posed: &Posed) -> f64 {
    posed.world_from_node[0].translation.x
}

/// A scene with ten frames a second and three objects: the shot's `thing` twice, the second one held for three frames,
/// and an object that is not the shot's.
fn scene() -> Scene {
    let mut scene = crate::new_scene::empty();
    scene.timeline.fps = 10.0;
    scene.stage.shot = Some(Arc::new(Clock));
    let thing = Object::new("thing", "shot.glb");
    scene.objects = vec![thing.clone(), Object { hold: 3, ..thing }, Object::new("other", "cube.obj")];
    scene
}

#[test]
fn a_shot_is_asked_for_the_second_of_the_frame_that_is_held() {
    let scene = scene();
    for (frame, held) in [(4.0, 3.0), (3.0, 3.0), (17.0, 15.0)] {
        let x = |index: usize| poses_at(&scene, frame)[index].translation.x;
        let stands = [x(0), x(1), x(2)];
        assert_eq!(stands, [frame / 10.0, held / 10.0, 0.0], "frame {frame}");
        let weights: Vec<_> =
            bends_at(&scene, frame).into_iter().map(|bend| bend.map(|bend| bend.weights)).collect();
        let wanted = [Some(vec![(frame / 10.0) as f32]), Some(vec![(held / 10.0) as f32]), None];
        assert_eq!(weights, wanted, "frame {frame}");
        assert_eq!(key_at(&scene, &scene.objects[1], frame).translation, [held / 10.0, 0.0, 0.0]);
    }
    assert_eq!(
        scene.objects.iter().map(|object| bends(&scene, object)).collect::<Vec<_>>(),
        [true, true, false]
    );
    // The shot does not move an object that has keys of its own.
    let mut keyed = scene;
    keyed.objects[0].keys = vec![ObjectKey { translation: [7.0, 0.0, 0.0], ..ObjectKey::at(0.0) }];
    assert_eq!(poses_at(&keyed, 4.0)[0].translation, DVec3::X * 7.0);
}

#[test]
fn the_shot_and_the_document_hide_objects() {
    let mut scene = scene();
    assert_eq!(hidden_at(&scene, 19.0), [false; 3]);
    assert_eq!(hidden_at(&scene, 20.0), [true, true, false]);
    scene.objects[2].hidden = true;
    assert_eq!(hidden_at(&scene, 19.0), [false, false, true]);
}

#[test]
fn a_light_without_keys_is_as_the_shot_has_it() {
    let mut scene = scene();
    let keys = vec![LightKey { intensity: Some(9.0), ..LightKey::at(0.0) }];
    let keyed = Light { keys, ..Light::new("keyed", LightKind::Ambient) };
    scene.lights = vec![Light::new("sun", LightKind::Sun), keyed];
    let alone: Vec<Light> = scene.lights.iter().map(|light| light_at(&scene, light, 25.0)).collect();
    assert_eq!(alone.iter().map(|light| light.intensity).collect::<Vec<_>>(), [2.5, 9.0]);
    assert_eq!(lights_at(&scene, 25.0), alone);
}

#[test]
fn a_camera_without_keys_is_that_of_the_shot() {
    let mut scene = scene();
    scene.camera.keys.clear();
    let camera = camera_at(&scene, 25.0);
    assert_eq!((camera.eye, camera.target.x, camera.roll_rad), (DVec3::X * 2.5, 2.5, 0.0));
    scene.camera.keys = crate::new_scene::empty().camera.keys;
    assert_ne!(camera_at(&scene, 25.0).eye, camera.eye);
}
