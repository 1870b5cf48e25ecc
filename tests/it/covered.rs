//! Tests that a region covers the surface that it states, and that hidden regions and objects are left out of a picture
//! while the rest stays the same.

use std::collections::BTreeMap;

use glam::Vec3;
use impasto_gl_render::context::Driver;
use impasto_painting::frame::{Frame, LayerKind, Stroke};
use impasto_painting::{FrameOptions, prepare};
use impasto_scene::document::{Dab, Direction, ObjectKey, Patch, Region, Scene, Seed, Selector, Style};
use impasto_scene::loaded::LoadedScene;
use impasto_scene::mesh_file::MeshFile;
use impasto_tests::pictures::renderer;
use impasto_tests::shapes;

const SIZE_PX: [u32; 2] = [640, 360];

fn dab(x: f64, radius: f64, take_away: bool) -> Dab {
    Dab { at: [x, 0.0, 0.0], normal: [0.0, 0.0, 1.0], radius, take_away }
}

/// For each stroke on the front of a sheet (from −1 to 1): its particle's position, and whether the region `on`
/// covers it.
fn on_a_sheet(on: Selector) -> Vec<(Vec3, bool)> {
    let mut scene = shapes::scene(vec![shapes::object("thing", 6000)]);
    scene.regions = vec![Region { direction: Direction::Angle(20.0), ..Region::new("on", on) }];
    let mut loaded = LoadedScene::clone(&shapes::loaded(scene, [shapes::sheet(20)]));
    let mut file = MeshFile::clone(loaded.meshes.values().next().unwrap());
    // The left half of the sheet is a group of its own.
    file.groups.push("left".to_owned());
    for triangle in 0..file.mesh.triangles.len() {
        let [a, b, c] = file.mesh.corners(triangle);
        file.mesh.group_of_triangle[triangle] = u32::from((a + b + c).x < 0.0);
    }
    loaded.meshes.insert("thing.obj".to_owned(), file.into());
    let painting = prepare(loaded.into()).unwrap();
    let frame = painting.at(0.0, &FrameOptions::new(SIZE_PX));
    let particles = painting.particles(0);
    let body = frame.layers.iter().find(|run| run.kind == LayerKind::Body).unwrap();
    let strokes = frame.sources[body.first as usize..(body.first + body.count) as usize].iter();
    let found: Vec<(Vec3, bool)> =
        strokes.map(|source| (particles.at(source.particle as usize).position, source.region == 0)).collect();
    assert!(found.len() > 500);
    found
}

#[track_caller]
fn assert_covers(on: Selector, expected: impl Fn(Vec3) -> bool) {
    let found = on_a_sheet(on);
    for (at, is_on) in &found {
        assert_eq!(*is_on, expected(*at), "at {at}");
    }
    assert!(found.iter().any(|(_, on)| *on) && found.iter().any(|(_, on)| !*on));
}

#[test]
fn dabs_count_in_their_order() {
    let thing = || "thing".to_owned();
    let within = |at: Vec3, x: f32, radius: f32| (at - Vec3::X * x).length() <= radius;
    assert_covers(Selector::Dabs(thing(), vec![dab(0.0, 0.6, false), dab(0.2, 0.3, true)]), |at| {
        within(at, 0.0, 0.6) && !within(at, 0.2, 0.3)
    });
    assert_covers(
        Selector::Dabs(thing(), vec![dab(0.0, 0.6, false), dab(0.2, 0.3, true), dab(0.3, 0.1, false)]),
        |at| within(at, 0.0, 0.6) && !within(at, 0.2, 0.3) || within(at, 0.3, 0.1),
    );
    assert_covers(Selector::Dabs(thing(), vec![dab(0.2, 0.3, true), dab(0.0, 0.6, false)]), |at| {
        within(at, 0.0, 0.6)
    });
}

#[test]
fn several_patches_add_and_take_away_in_their_order() {
    let several = |patches| Selector::Several("thing".to_owned(), patches);
    let left = || Patch::Group("left".to_owned());
    let cut = || Patch::Dabs(vec![dab(0.0, 0.5, true), dab(0.7, 0.2, false)]);
    let within = |at: Vec3, x: f32, radius: f32| (at - Vec3::X * x).length() <= radius;
    assert_covers(several(vec![left(), cut()]), |at| {
        at.x < 0.0 && !within(at, 0.0, 0.5) || within(at, 0.7, 0.2)
    });
    assert_covers(several(vec![cut(), left()]), |at| at.x < 0.0 || within(at, 0.7, 0.2));
    assert_covers(several(vec![Patch::Whole, cut()]), |at| !within(at, 0.0, 0.5) || within(at, 0.7, 0.2));
    assert_covers(several(vec![left()]), |at| at.x < 0.0);
}

#[test]
fn a_flood_stops_at_the_edges_of_a_cube() {
    let on = |patches: &dyn Fn(Seed) -> Selector| {
        let mut scene = shapes::scene(vec![shapes::object("thing", 6000)]);
        scene.camera.keys[0] = shapes::camera_key(0.0, [2.0, 2.0, 4.0], [0.0; 3]);
        let seed = Seed { at: [0.2, 0.1, 2.0], normal: [0.0, 0.1, 1.0] };
        scene.regions = vec![Region::new("on", patches(seed))];
        let painting = prepare(shapes::loaded(scene, [shapes::cube()])).unwrap();
        let frame = painting.at(0.0, &FrameOptions::new(SIZE_PX));
        let body = frame.layers.iter().find(|run| run.kind == LayerKind::Body);
        let body = *body.unwrap();
        (body.first..body.first + body.count)
            .map(|index| {
                let source = &frame.sources[index as usize];
                let normal = painting.particles(0).at(source.particle as usize).normal;
                (normal.z > 0.5, source.region == 0)
            })
            .collect::<Vec<_>>()
    };
    let name = || "thing".to_owned();
    let front = on(&|seed| Selector::Flood(name(), seed, 30.0));
    assert!(front.len() > 500 && front.iter().all(|(is_front, is_on)| is_front == is_on));
    assert!(on(&|seed| Selector::Flood(name(), seed, 91.0)).iter().all(|(_, is_on)| *is_on));
    let patched = on(&|seed| Selector::Several(name(), vec![Patch::Flood(seed, 30.0)]));
    assert_eq!(front, patched);
}

/// Two spheres, one in front of the other, and a sheet behind both, each with a region of its own.
fn three_things(edit: impl FnOnce(&mut Scene)) -> std::sync::Arc<LoadedScene> {
    let names = ["front", "back", "wall"];
    let mut scene = shapes::scene(names.map(|name| shapes::object(name, 3000)).into());
    let places = [([0.3, 0.0, 0.6], 0.6), ([-0.3, 0.0, -0.4], 0.6), ([0.0, 0.0, -1.5], 2.0)];
    for (object, (translation, scale)) in scene.objects.iter_mut().zip(places) {
        object.keys = vec![ObjectKey {
            translation,
            scale: impasto_scene::document::Scale::even(scale),
            ..ObjectKey::at(0.0)
        }];
    }
    scene.regions = names.map(|name| Region::new(name, Selector::Object(name.to_owned()))).into();
    edit(&mut scene);
    shapes::loaded(scene, [shapes::sphere(32, 16), shapes::sphere(32, 16), shapes::sheet(8)])
}

type Edit<'a> = &'a dyn Fn(&mut Scene);

fn strokes_by_source(frame: &Frame) -> BTreeMap<(u32, u32, u32), Stroke> {
    let mut found = BTreeMap::new();
    for run in &frame.layers {
        for index in run.first as usize..(run.first + run.count) as usize {
            let (source, stroke) = (&frame.sources[index], frame.strokes[index]);
            found.insert((run.kind as u32, stroke.body_id, source.particle), stroke);
        }
    }
    found
}

#[test]
fn what_is_hidden_is_left_out_and_no_bit_of_the_rest_changes() {
    let shown =
        |edit: &dyn Fn(&mut Scene)| prepare(three_things(edit)).unwrap().at(0.0, &FrameOptions::new(SIZE_PX));
    let all = strokes_by_source(&shown(&|_| {}));
    let cases: [(&str, Edit<'_>); 3] = [
        ("object", &|scene| scene.objects[0].hidden = true),
        ("region", &|scene| scene.regions[0].hidden = true),
        ("both, and locks", &|scene| {
            (scene.objects[0].hidden, scene.regions[0].hidden) = (true, true);
            (scene.objects[1].locked, scene.regions[2].locked) = (true, true);
        }),
    ];
    for (what, edit) in cases {
        let rest = strokes_by_source(&shown(edit));
        assert!(rest.len() > 500 && rest.keys().all(|(_, body, _)| *body != 1), "{what}");
        let others = all.iter().filter(|((_, body, _), _)| *body != 1);
        assert_eq!(others.clone().count(), rest.len(), "{what}");
        for (key, stroke) in others {
            assert_eq!(format!("{stroke:?}"), format!("{:?}", rest[key]), "{what}: {key:?}");
        }
    }
}

#[test]
fn a_hidden_body_is_not_drawn_and_casts_no_shadow() {
    let mut renderer = renderer(Driver::Egl);
    let mut picture = |edit: &dyn Fn(&mut Scene)| {
        let painting = prepare(three_things(|scene| {
            scene.lights = impasto_scene::new_scene::empty().lights;
            scene.lights[0].direction = Some([0.5, -0.2, -1.0]);
            scene.style = Style::Reference;
            edit(scene);
        }));
        let picture = renderer.render(&painting.unwrap().at(0.0, &FrameOptions::new(SIZE_PX))).unwrap();
        (picture.rgba8, renderer.read_reference().body_id)
    };
    let (shown, shown_ids) = picture(&|_| {});
    let (hidden, hidden_ids) = picture(&|scene| scene.objects[0].hidden = true);
    assert!([1, 2, 3].iter().all(|id| shown_ids.contains(id)));
    assert!(!hidden_ids.contains(&1) && hidden_ids.contains(&2) && hidden_ids.contains(&3));
    // Where the wall shows in both pictures, the shadow is gone and nothing is darker.
    let light = |rgba8: &[u8], pixel: usize| {
        rgba8[4 * pixel..4 * pixel + 3].iter().map(|&value| i32::from(value)).sum::<i32>()
    };
    let (mut lighter, mut darker) = (0, 0);
    for index in 0..shown_ids.len() {
        if shown_ids[index] == 3 && hidden_ids[index] == 3 {
            let change = light(&hidden, index) - light(&shown, index);
            lighter += u32::from(change > 30);
            darker += u32::from(change < -30);
        }
    }
    assert!(lighter > 500 && darker == 0, "{lighter} pixels lighter, {darker} darker");
}
