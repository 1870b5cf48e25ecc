//! Tests that strokes lie as they were dragged in the editor, in any view: the whole way from mouse positions to
//! guides to painted strokes.

use std::f64::consts::PI;
use std::sync::Arc;

use glam::{DAffine3, DVec2, DVec3};
use impasto_core::TriangleMesh;
use impasto_editor_model::camera_rig::FreeView;
use impasto_editor_model::path::{
    Faces, GuideStyle, ObjectView, PathSense, PathSettings, SurfacePath, mirrored,
};
use impasto_editor_model::picking::{Picker, View};
use impasto_painting::frame::LayerKind;
use impasto_painting::{FrameOptions, Painting, prepare};
use impasto_scene::document::{
    Direction, Falloff, Guide, GuideMode, Lens, ObjectKey, Region, Scale, Scene, Selector,
};
use impasto_scene::motion::{self, CameraPose};
use impasto_tests::shapes;

/// The size of the viewport, which has another shape than the scene's picture.
const SIZE_PX: [u32; 2] = [900, 640];

fn size_px() -> DVec2 {
    DVec2::new(f64::from(SIZE_PX[0]), f64::from(SIZE_PX[1]))
}

/// An object that is moved, turned and enlarged, and its region with these guides.
fn scene(direction: Direction, guides: Vec<Guide>) -> Scene {
    let mut scene = shapes::scene(vec![shapes::object("thing", 25_000)]);
    scene.strokes.layers = shapes::body_layer_alone();
    scene.strokes.contour = Some(0.0);
    (scene.strokes.length_px, scene.strokes.width_px) = (Some(8.0), Some(2.6));
    scene.camera.keys[0] = shapes::camera_key(0.0, [0.4, 0.9, 5.0], [0.4, 0.6, 0.0]);
    scene.camera.keys[0].roll_deg = 11.0;
    scene.objects[0].keys = vec![ObjectKey {
        translation: [0.4, 0.1, 0.2],
        rotation_deg: [5.0, -25.0, 8.0],
        scale: Scale::even(1.2),
        ..ObjectKey::at(0.0)
    }];
    scene.regions =
        vec![Region { direction, guides, ..Region::new("combed", Selector::Object("thing".to_owned())) }];
    scene
}

/// Only strokes this near to a drag are judged: there a brush with a radius of 45 px still has 0.99 of its strength.
const CORE_PX: f64 = 2.5;

/// A prepared scene, and the picker that finds its points under the mouse.
struct Setup {
    painting: Painting,
    picker: Picker,
    poses: Vec<DAffine3>,
    /// The frame that is looked at.
    frame: f64,
}

impl Setup {
    /// A scene with one object, which morphs into another mesh.
    fn bending(scene: Scene, meshes: [&TriangleMesh; 2], frame: f64) -> Self {
        let poses = motion::poses_at(&scene, frame);
        let painting = prepare(shapes::morphing(scene, meshes.map(TriangleMesh::clone))).unwrap();
        let mut picker = Picker::default();
        picker.follow(&painting, frame);
        Self { painting, picker, poses, frame }
    }

    fn new(scene: Scene, mesh: &TriangleMesh) -> Self {
        let poses = motion::poses_at(&scene, 0.0);
        let painting = prepare(shapes::loaded(scene, [mesh.clone()])).unwrap();
        let mut picker = Picker::default();
        picker.update(&[(Arc::clone(painting.surface(0)), impasto_painting::BodyShape::default())]);
        Self { painting, picker, poses, frame: 0.0 }
    }

    /// The guides of a drag through these pixels.
    fn drag(&self, view: &View, events: &[DVec2]) -> Vec<Guide> {
        let mut pick = |at_px| self.picker.pick(&view.ray(at_px), &self.poses, |_| true);
        let settings = PathSettings { radius_px: 45.0, steady: 0.0, faces: Faces::Front };
        let hit = pick(events[0]).expect("the press meets the thing");
        let mut path = SurfacePath::press(events[0], &hit, view, self.poses[0], &settings);
        for &event in &events[1..] {
            path.move_to(event, &mut pick);
        }
        let [seen, reference] = self.views(view);
        path.finished(&mut pick).guides(&style(), &seen, &reference)
    }

    /// A view and the reference, in the object's space.
    fn views(&self, view: &View) -> [ObjectView; 2] {
        let shot = motion::camera_at(self.painting.scene(), 0.0);
        let frame = |frame: f64| self.picker.bends(0).then_some(frame);
        let seen = ObjectView::new(&view.camera, self.poses[0]).at_frame(frame(self.frame));
        [seen, ObjectView::new(&shot, self.poses[0]).at_frame(frame(0.0))]
    }

    /// Of each stroke of the body layer that faces the camera: its place in pixels (Y down) and its angle (Y up).
    fn strokes(&self, camera: &CameraPose) -> Vec<(DVec2, f64)> {
        let frame = self.painting.seen_by(camera, self.frame, &FrameOptions::new(SIZE_PX));
        let run = frame.layers.iter().find(|run| run.kind == LayerKind::Body).expect("a body layer");
        (run.first as usize..(run.first + run.count) as usize)
            .filter(|&index| frame.sources[index].facing > 0.35)
            .map(|index| {
                let [x, y] = frame.strokes[index].center_px.map(f64::from);
                let at_px = DVec2::new(x, size_px().y - y);
                (at_px, f64::from(frame.strokes[index].angle_rad))
            })
            .collect()
    }
}

fn style() -> GuideStyle {
    GuideStyle {
        mode: GuideMode::Comb,
        object: None,
        strength: 1.0,
        falloff: Falloff::Smooth,
        sense: PathSense::Along,
    }
}

fn lines_apart(a: f64, b: f64) -> f64 {
    let off = (a - b).rem_euclid(PI);
    off.min(PI - off).to_degrees()
}

/// The angle between the drag's tangent and each stroke within `reach_px` of the drag, degrees. Strokes at the ends of
/// the drag are left out.
fn errors(strokes: &[(DVec2, f64)], drag: impl Fn(f64) -> DVec2, reach_px: f64) -> Vec<f64> {
    let steps = 400;
    let way: Vec<DVec2> = (0..=steps).map(|step| drag(f64::from(step) / f64::from(steps))).collect();
    strokes
        .iter()
        .filter_map(|&(at_px, angle_rad)| {
            let (index, nearest) =
                way.iter().enumerate().min_by(|a, b| a.1.distance(at_px).total_cmp(&b.1.distance(at_px)))?;
            let inner = (steps as usize / 12..=steps as usize * 11 / 12).contains(&index);
            let tangent = way[(index + 1).min(way.len() - 1)] - way[index.saturating_sub(1)];
            let dragged_rad = (tangent * DVec2::new(1.0, -1.0)).to_angle();
            (inner && nearest.distance(at_px) < reach_px).then(|| lines_apart(angle_rad, dragged_rad))
        })
        .collect()
}

/// The shot's view, and free views that are turned from it, sideways and upwards; the last in parallel projection.
fn views(shot: &CameraPose, about: DVec3) -> Vec<(&'static str, View)> {
    let turned = |drag_px: [f64; 2]| {
        let mut free = FreeView::new(shot.clone());
        free.orbit(DVec2::from_angle(-shot.roll_rad).rotate(DVec2::from(drag_px)), about);
        free
    };
    let mut parallel = turned([-100.0, 0.0]);
    parallel.toggle_orthographic();
    vec![
        ("reference", FreeView::new(shot.clone())),
        ("30 right", turned([-100.0, 0.0])),
        ("60 right", turned([-200.0, 0.0])),
        ("60 left", turned([200.0, 0.0])),
        ("30 above", turned([0.0, 100.0])),
        ("45 left, 40 above", turned([150.0, 133.0])),
        ("30 right, parallel", parallel),
    ]
    .into_iter()
    .map(|(name, free)| (name, free.view(size_px())))
    .collect()
}

#[test]
fn what_is_dragged_is_what_is_seen_in_any_view() {
    let (mut worst, mut worst_curved, mut count) = (0.0f64, 0.0f64, 0);
    for (thing, mesh, every) in [("apple", shapes::apple_skin(), 1), ("sphere", shapes::sphere(96, 48), 2)] {
        let bare = Setup::new(scene(Direction::Auto, Vec::new()), &mesh);
        let centre =
            bare.picker.bounds_in_world([0], &bare.poses).map(|[low, high]| (low + high) * 0.5).unwrap();
        let shot = motion::camera_at(bare.painting.scene(), 0.0);
        // The apple is seen in every view, the sphere in every second one.
        for (index, (name, view)) in views(&shot, centre).into_iter().enumerate().step_by(every) {
            let middle = view.project(centre).unwrap() + DVec2::new(6.0, 9.0);
            let angles_deg = if index / every % 2 == 0 { [-77.0f64, 7.0] } else { [30.0, 137.0] };
            for angle_deg in angles_deg {
                let half = DVec2::from_angle(angle_deg.to_radians()) * 42.0;
                let straight = |t: f64| middle + half * (2.0 * t - 1.0);
                let arc = |t: f64| {
                    let (sin, cos) = ((t - 0.5) * 1.6).sin_cos();
                    middle + half * sin + half.perp() * (1.0 - cos)
                };
                let flatness = if angle_deg == 30.0 { 0.4 } else { 1.0 };
                let direction = if angle_deg == 7.0 { Direction::Angle(20.0) } else { Direction::Auto };
                for curved in [false, true].into_iter().take(if angle_deg == angles_deg[0] { 2 } else { 1 }) {
                    let drag: &dyn Fn(f64) -> DVec2 = if curved { &arc } else { &straight };
                    let events: Vec<DVec2> = (0..25).map(|event| drag(f64::from(event) / 24.0)).collect();
                    let guides = bare.drag(&view, &events);
                    assert_eq!(guides.len(), 1, "{thing}, {name}: the drag is not one guide");
                    assert_eq!(guides[0].view.is_none(), name == "reference");
                    let mut combed = scene(direction.clone(), guides);
                    combed.strokes.flatness = Some(flatness);
                    let found = errors(&Setup::new(combed, &mesh).strokes(&view.camera), drag, CORE_PX);
                    assert!(!found.is_empty(), "no stroke lies under the drag: {thing}, {name}");
                    let most = found.iter().copied().fold(0.0, f64::max);
                    if curved {
                        worst_curved = worst_curved.max(most);
                    } else {
                        count += found.len();
                        worst = worst.max(most);
                    }
                    if most > 0.5 {
                        println!("{thing}, {name}, {angle_deg}, curved {curved}: {most:.3}");
                    }
                }
            }
        }
    }
    println!(
        "dragged against shown: straight at most {worst:.3} over {count} strokes, curved {worst_curved:.3}"
    );
    assert!(count >= 60 && worst <= 0.5, "{worst} degrees over {count} strokes");
    assert!(worst_curved <= 3.0, "{worst_curved} degrees");
}

/// In the frame of the drag, strokes on the bent body lie as they were dragged. The guide is stored on the surface at
/// rest.
#[test]
fn what_is_dragged_on_a_bent_body_is_what_is_seen_then() {
    let mesh = shapes::sphere(192, 96);
    // Twisted about the upright axis, stretched sideways and bowed.
    let bent = |at: DVec3| {
        let (sin, cos) = (0.9 * at.y).sin_cos();
        DVec3::new(1.3 * (at.x * cos + at.z * sin), at.y + 0.25 * at.x * at.x, at.z * cos - at.x * sin)
    };
    let target = shapes::moved(&mesh, bent);
    let (mut worst, mut count) = (0.0f64, 0);
    for frame in [5.0, 10.0] {
        let moving = |guides: Vec<Guide>| {
            let mut moving = scene(Direction::Auto, guides);
            moving.timeline.last = 10;
            moving.objects[0].morph = Some("target.obj".to_owned());
            let first = moving.objects[0].keys[0].clone();
            moving.objects[0].keys.push(ObjectKey { frame: 10.0, morph: 1.0, ..first });
            moving
        };
        let bare = Setup::bending(moving(Vec::new()), [&mesh, &target], frame);
        let centre =
            bare.picker.bounds_in_world([0], &bare.poses).map(|[low, high]| (low + high) * 0.5).unwrap();
        let shot = motion::camera_at(bare.painting.scene(), 0.0);
        for (name, view) in views(&shot, centre).into_iter().step_by(2) {
            let middle = view.project(centre).unwrap() + DVec2::new(6.0, 9.0);
            for angle_deg in [7.0f64, -60.0] {
                let half = DVec2::from_angle(angle_deg.to_radians()) * 42.0;
                let straight = |t: f64| middle + half * (2.0 * t - 1.0);
                let events: Vec<DVec2> = (0..25).map(|event| straight(f64::from(event) / 24.0)).collect();
                let guides = bare.drag(&view, &events);
                assert!(guides[0].view.as_ref().is_some_and(|view| view.frame == Some(frame)), "{name}");
                let off = |at: DVec3| (at.length() - 1.0).abs();
                assert!(guides[0].points.iter().all(|point| off(DVec3::from(point.at)) < 0.01), "{name}");
                let combed = Setup::bending(moving(guides), [&mesh, &target], frame);
                let found = errors(&combed.strokes(&view.camera), straight, CORE_PX);
                assert!(!found.is_empty(), "no stroke lies under the drag: {name}");
                count += found.len();
                worst = found.iter().copied().fold(worst, f64::max);
            }
        }
    }
    println!("dragged on a bent body against shown: at most {worst:.3} over {count} strokes");
    assert!(count >= 40 && worst <= 0.5, "{worst} degrees over {count} strokes");
}

#[test]
fn mirror_images_show_mirrored_from_the_other_side() {
    let mesh = shapes::sphere(96, 48);
    let mut plain = scene(Direction::Auto, Vec::new());
    plain.objects[0].keys.clear();
    plain.camera.keys[0] = shapes::camera_key(0.0, [0.0, 0.3, 5.0], [0.0; 3]);
    let bare = Setup::new(plain.clone(), &mesh);
    let mut free = FreeView::new(motion::camera_at(&plain, 0.0));
    free.orbit(DVec2::new(-150.0, 40.0), DVec3::ZERO);
    let view = free.view(size_px());
    let ends = [DVec2::new(430.0, 300.0), DVec2::new(520.0, 350.0)];
    let guides = bare.drag(&view, &ends);
    let flip = DVec3::new(-1.0, 1.0, 1.0);
    let [seen, reference] = bare.views(&view);
    let images = mirrored(&guides[0], flip, &seen, &reference, &mut |at, facing, farthest| {
        bare.picker.closest_on_surface(0, at, facing, farthest)
    });
    assert_eq!(images.len(), 1);
    plain.regions[0].guides = images;
    let mut other = view.camera.clone();
    (other.eye, other.target) = (other.eye * flip, other.target * flip);
    let across = |t: f64| {
        let at = ends[0].lerp(ends[1], t);
        DVec2::new(size_px().x - at.x, at.y)
    };
    let found = errors(&Setup::new(plain, &mesh).strokes(&other), across, CORE_PX);
    let worst = found.iter().copied().fold(0.0, f64::max);
    println!("mirrored: at most {worst:.3} over {} strokes", found.len());
    assert!(found.len() >= 4 && worst <= 0.5, "{worst}");
}

#[test]
fn a_shipped_scene_is_picked_where_it_is_painted() {
    let folder = impasto_tests::command::root().join("scenes");
    let loaded = impasto_scene::load::load(&folder.join("simple_objects.ron"), &Default::default()).unwrap();
    let scene = loaded.scene.clone();
    let painting = prepare(Arc::new(loaded)).unwrap();
    let mut picker = Picker::default();
    let bodies: Vec<_> = (0..scene.objects.len())
        .map(|object| (Arc::clone(painting.surface(object)), impasto_painting::BodyShape::default()))
        .collect();
    picker.update(&bodies);
    let (camera, poses) = (motion::camera_at(&scene, 45.0), motion::poses_at(&scene, 45.0));
    let size = [640u32, 360];
    let view = View { camera: camera.clone(), size_px: DVec2::new(640.0, 360.0) };
    assert!(matches!(camera.lens, Lens::Perspective { .. }));
    let frame = painting.seen_by(&camera, 45.0, &FrameOptions::new(size));
    let run = frame.layers.iter().find(|run| run.kind == LayerKind::Body).unwrap();
    let (mut same, mut all) = (0, 0);
    for index in (run.first as usize..(run.first + run.count) as usize).step_by(3) {
        let object = frame.strokes[index].body_id as usize - 1;
        let particle = painting.particles(object).at(frame.sources[index].particle as usize);
        let at = poses[object].transform_point3(particle.position.as_dvec3());
        let Some(at_px) = view.project(at) else { continue };
        let Some(hit) = picker.pick(&view.ray(at_px), &poses, |_| true) else { continue };
        // The hit is at the stroke, or in front of it.
        assert!(hit.distance < view.ray(at_px).origin.distance(at) + 1e-4);
        all += 1;
        same += usize::from(hit.position_in_world.distance(at) < 1e-3);
    }
    println!("{same} of {all} particles are what is picked in front of them");
    assert!(all > 300 && same * 2 > all, "{same} of {all}");
}
