//! Tests that a turntable shows all objects as they are in the reference.

use std::sync::Arc;

use glam::{DAffine3, DVec3};
use impasto_measure::turntable;
use impasto_painting::prepare;
use impasto_scene::document::{ObjectKey, Reference, Scale};
use impasto_scene::load::{LoadOptions, load};
use impasto_scene::motion;
use impasto_tests::{command, shapes};

#[test]
fn objects_keep_pose_scale_and_morph_of_the_reference() {
    let mut scene = shapes::scene(vec![shapes::object("thing", 400)]);
    scene.camera.keys[0] = shapes::camera_key(0.0, [0.6, 1.0, 5.0], [0.0, 0.1, 0.0]);
    scene.objects[0].morph = Some("target.obj".to_owned());
    let last = ObjectKey {
        morph: 1.0,
        rotation_deg: [10.0, 20.0, 30.0],
        scale: Scale([1.5, 0.6, 1.0]),
        translation: [0.1, 0.2, 0.3],
        ..ObjectKey::at(10.0)
    };
    scene.objects[0].keys = vec![ObjectKey::at(0.0), last];
    scene.reference = Reference::Frame(6);
    scene.timeline.last = 10;
    let target = shapes::moved(&shapes::sheet(8), |at| at + DVec3::Z * at.x);
    let loaded = shapes::morphing(scene, [shapes::sheet(8), target]);
    let turned = turntable(&loaded).scene;
    assert_eq!((turned.timeline.first, turned.timeline.last), (6, 366));
    let pose = motion::poses_at(&loaded.scene, 6.0)[0];
    let morph = motion::morphs_at(&loaded.scene, 6.0)[0];
    assert!(morph > 0.1 && morph < 0.9);
    for frame in [6.0, 7.0, 200.0, 366.0] {
        let now: DAffine3 = motion::poses_at(&turned, frame)[0];
        assert!(now.abs_diff_eq(pose, 1e-9), "frame {frame}: {now:?} {pose:?}");
        assert_eq!(motion::morphs_at(&turned, frame), [morph]);
    }
    let camera = motion::camera_at(&turned, 6.0);
    assert!(camera.eye.abs_diff_eq(motion::camera_at(&loaded.scene, 6.0).eye, 1e-9));
    assert!(motion::camera_at(&turned, 186.0).eye.z < -4.0, "half a turn later it is not behind the object");
}

/// The parade has joints, shape keys and a point cache.
#[test]
fn bodies_that_bend_stay_in_the_shape_of_the_reference() {
    let path = command::root().join("scenes/parade.ron");
    let mut loaded = load(&path, &LoadOptions::default()).unwrap_or_else(|report| panic!("{report}"));
    loaded.scene.reference = Reference::Frame(13);
    let turned = turntable(&loaded);
    for frame in [13.0, 14.0, 373.0] {
        assert_eq!(motion::bends_at(&turned.scene, frame), motion::bends_at(&loaded.scene, 13.0));
        for (object, held) in turned.scene.objects.iter().zip(motion::cache_frames_at(&turned.scene, frame)) {
            assert!(object.cache.is_none() || held == 13.0, "{} is held at {held}", object.name);
        }
    }
    let parted = motion::bends_at(&loaded.scene, 0.0) != motion::bends_at(&loaded.scene, 13.0);
    assert!(parted, "the parade does not move, so that this test shows nothing");
    let _ = prepare(Arc::new(turned)).expect("it is a good scene");
}
