//! Tests that an edit recomputes only what depends on it: all other results are the same objects in memory.

use std::path::Path;
use std::sync::Arc;

use impasto_scene::document::{Direction, Falloff, Guide, GuideMode, GuidePoint, ObjectKey, Scene, Solver};
use impasto_scene::load::{LoadOptions, load};
use impasto_scene::loaded::LoadedScene;

use super::{Painting, Preparer};

/// A shipped scene whose objects state their particle counts, so that they do not depend on the view.
fn start() -> Arc<LoadedScene> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/sumi_e_apple.ron");
    let mut loaded = load(&path, &LoadOptions::default()).unwrap();
    loaded.scene.strokes.preset = Some("paper".to_owned());
    for object in &mut loaded.scene.objects {
        object.particles = Some(1500);
    }
    Arc::new(loaded)
}

fn edited(loaded: &Arc<LoadedScene>, edit: impl FnOnce(&mut Scene)) -> Arc<LoadedScene> {
    let mut edited = LoadedScene::clone(loaded);
    edit(&mut edited.scene);
    Arc::new(edited)
}

/// For each coat, whether its places, traits and lifts are the same objects as before.
fn reused(before: &Painting, now: &Painting) -> Vec<[bool; 3]> {
    let pairs = before.coats.iter().zip(&now.coats);
    pairs
        .map(|(before, now)| {
            [
                Arc::ptr_eq(&before.sampled, &now.sampled),
                Arc::ptr_eq(&before.traits, &now.traits),
                Arc::ptr_eq(&before.baked, &now.baked),
            ]
        })
        .collect()
}

#[test]
fn moving_an_object_recomputes_nothing() {
    let (start, mut preparer) = (start(), Preparer::default());
    let before = preparer.prepare(Arc::clone(&start)).unwrap();
    let moved = edited(&start, |scene| {
        let key = ObjectKey { frame: 30.0, translation: [0.4, 0.1, 0.0], ..scene.objects[0].keys[0].clone() };
        scene.objects[0].keys.push(key);
    });
    let now = preparer.prepare(moved).unwrap();
    assert_eq!(reused(&before, &now), [[true; 3]; 2]);
    assert!(Arc::ptr_eq(&before.order, &now.order) && Arc::ptr_eq(&before.brushes, &now.brushes));
    let surfaces = before.bodies.iter().zip(&now.bodies);
    assert!(surfaces.into_iter().all(|(before, now)| Arc::ptr_eq(&before.surface, &now.surface)));
}

#[test]
fn a_changed_angle_and_a_guide_turn_the_strokes_of_their_object_alone() {
    let (start, mut preparer) = (start(), Preparer::default());
    let before = preparer.prepare(Arc::clone(&start)).unwrap();
    let angle = edited(&start, |scene| scene.regions[0].direction = Direction::Angle(30.0));
    let turned = preparer.prepare(Arc::clone(&angle)).unwrap();
    assert_eq!(reused(&before, &turned), [[true, true, false], [true; 3]]);
    assert!(Arc::ptr_eq(&before.order, &turned.order));

    let point = |x: f64| GuidePoint { at: [x, 0.5, 0.4], normal: [0.0, 0.0, 1.0], turn_deg: 0.0 };
    let guide = Guide {
        mode: GuideMode::Comb,
        curve: false,
        object: None,
        view: None,
        points: vec![point(-0.2), point(0.2)],
        radius: 0.3,
        strength: 1.0,
        falloff: Falloff::Smooth,
    };
    let combed = edited(&angle, |scene| scene.regions[0].guides.push(guide));
    let now = preparer.prepare(combed).unwrap();
    assert_eq!(reused(&turned, &now)[1], [true; 3]);
    assert_eq!(reused(&turned, &now)[0][..2], [true; 2]);
}

#[test]
fn as_many_particles_can_be_numbered_with_any_solver() {
    let scene = &start().scene;
    for solver in [Solver::Tangent, Solver::HornExact] {
        let fits = |count: u64| super::fits(None, scene, &[count, 1], solver).is_ok();
        assert!(fits((1 << 31) - 1) && !fits(1 << 31), "{solver:?}");
    }
}
