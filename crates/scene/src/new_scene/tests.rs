//! Tests of new scenes: framing, backdrop, names and regions.

use std::collections::BTreeMap;
use std::sync::Arc;

use glam::{DMat4, DVec4, Quat, Vec3};
use impasto_core::TriangleMesh;

use super::framing::used_points;
use super::*;
use crate::built_in_mesh;
use crate::document::{Direction, Region, Selector};
use crate::motion::camera_at;

mod light_and_colour;

/// A box between two corners, wound outwards; with `open`, only its face at the lowest z, which faces −Z.
fn box_between(low: Vec3, high: Vec3, open: bool) -> MeshFile {
    let positions: Vec<Vec3> = (0..8)
        .map(|i| {
            let pick = |bit: usize, low: f32, high: f32| if i >> bit & 1 == 1 { high } else { low };
            Vec3::new(pick(0, low.x, high.x), pick(1, low.y, high.y), pick(2, low.z, high.z))
        })
        .collect();
    let mut triangles = vec![[0, 2, 1], [1, 2, 3]];
    if !open {
        triangles.extend([[4, 5, 6], [5, 7, 6], [0, 1, 4], [1, 5, 4], [2, 6, 3], [3, 6, 7]]);
        triangles.extend([[0, 4, 2], [2, 4, 6], [1, 3, 5], [3, 7, 5]]);
    }
    let middle = (low + high) / 2.0;
    let normals = positions.iter().map(|at| (*at - middle).normalize_or(Vec3::Y)).collect();
    let per_triangle = vec![0; triangles.len()];
    let mesh = TriangleMesh {
        positions,
        normals,
        material_of_triangle: per_triangle.clone(),
        group_of_triangle: per_triangle,
        triangles,
        ..TriangleMesh::default()
    };
    MeshFile::still(mesh, vec![String::new()], vec![material([0.8; 3])])
}

fn material(color: [f32; 3]) -> crate::mesh_file::Material {
    crate::mesh_file::Material::plain(String::new(), color)
}

/// Boxes as one mesh. Each box is a group of its own.
fn boxes(corners: &[[[f32; 3]; 2]]) -> MeshFile {
    let mut all = box_between(Vec3::ZERO, Vec3::ONE, false);
    all.mesh = TriangleMesh::default();
    all.groups = (0..corners.len()).map(|index| format!("box {index}")).collect();
    for (index, [low, high]) in corners.iter().enumerate() {
        let one = box_between(Vec3::from(*low), Vec3::from(*high), false).mesh;
        let first = all.mesh.positions.len() as u32;
        all.mesh.triangles.extend(one.triangles.iter().map(|corners| corners.map(|corner| corner + first)));
        all.mesh.positions.extend(one.positions);
        all.mesh.normals.extend(one.normals);
        all.mesh.group_of_triangle.extend(vec![index as u32; one.triangles.len()]);
        all.mesh.material_of_triangle.extend(one.material_of_triangle);
    }
    all
}

/// The scene of a mesh that is placed as the program finds best.
fn placed(path: &Path, mesh: &MeshFile) -> Scene {
    for_mesh(path, mesh, Placing::default()).scene
}

/// Normalised device coordinates of every vertex, through glam's own projection matrix.
fn on_screen(scene: &Scene, mesh: &MeshFile) -> Vec<DVec4> {
    let pose = camera_at(scene, 0.0);
    let Lens::Perspective { fov_y_deg, near, far } = pose.lens else { panic!("no perspective") };
    let aspect = f64::from(scene.size.0) / f64::from(scene.size.1);
    let clip_from_view =
        glam::dcamera::rh::proj::opengl::perspective(fov_y_deg.to_radians(), aspect, near, far);
    let clip_from_world: DMat4 = clip_from_view * pose.view_from_world();
    used_points(mesh)
        .map(|point| {
            let clip = clip_from_world * point.extend(1.0);
            clip / clip.w
        })
        .collect()
}

#[test]
fn meshes_of_any_size_and_place_fill_the_picture_up_to_the_margin() {
    for (center, half) in [
        (Vec3::ZERO, Vec3::ONE),
        (Vec3::new(5.0, -3.0, 2.0), Vec3::splat(5e-4)),
        (Vec3::new(1e5, 2e6, -3e4), Vec3::splat(5e5)),
        (Vec3::ZERO, Vec3::new(20.0, 0.1, 0.1)),
        (Vec3::ZERO, Vec3::new(0.1, 20.0, 0.1)),
        (Vec3::ZERO, Vec3::new(1.0, 0.0, 1.0)),
    ] {
        let mesh = box_between(center - half, center + half, false);
        let scene = placed(Path::new("x.obj"), &mesh);
        let seen = on_screen(&scene, &mesh);
        let reach = seen.iter().map(|point| point.x.abs().max(point.y.abs())).fold(0.0, f64::max);
        assert!((0.72..0.82).contains(&reach), "{center} {half}: reaches {reach}");
        assert!(seen.iter().all(|point| point.z.abs() <= 1.0), "{center} {half}: cut by near or far");
        let findings = crate::check::check(&scene);
        assert!(findings.is_empty(), "{center} {half}: {findings:?}");
    }
}

#[test]
fn a_single_point_still_gives_a_good_scene() {
    let mesh = box_between(Vec3::ONE, Vec3::ONE, false);
    let scene = placed(Path::new("x.obj"), &mesh);
    assert!(crate::check::check(&scene).is_empty());
}

#[test]
fn an_open_mesh_is_looked_at_from_its_front() {
    let panel = box_between(Vec3::NEG_ONE, Vec3::ONE, true);
    let eye = placed(Path::new("x.obj"), &panel).camera.keys[0].eye;
    assert!(eye[2] < -1.0 && eye[1] > 0.0, "{eye:?} does not face a panel that looks to −Z");
    let solid = box_between(Vec3::NEG_ONE, Vec3::ONE, false);
    let eye = placed(Path::new("x.obj"), &solid).camera.keys[0].eye;
    assert!(eye[2] > 1.0 && eye[0] > 0.0 && eye[1] > 0.0, "{eye:?}");
}

#[test]
fn names_come_from_the_file() {
    let mesh = box_between(Vec3::NEG_ONE, Vec3::ONE, false);
    let scene = placed(Path::new("models/red apple.obj"), &mesh);
    assert_eq!(
        (scene.objects[0].name.as_str(), scene.objects[0].mesh.as_str()),
        ("red apple", "red apple.obj")
    );
    assert_eq!(scene.objects[1].mesh, built_in_mesh::BACKDROP);
    assert_eq!(scene.regions[0].on, Selector::Group("backdrop".to_owned(), "wall".to_owned()));
    let text = crate::save::to_ron(&scene);
    assert_eq!(crate::load::parse(Path::new("s.ron"), &text).unwrap(), scene);
}

#[test]
fn the_backdrop_stands_under_and_behind_the_model() {
    let center = Vec3::new(5.0, -3.0, 2.0);
    let mesh = box_between(center - 0.5, center + 0.5, false);
    let scene = placed(Path::new("x.obj"), &mesh);
    let backdrop = &scene.objects[1];
    let at = backdrop.keys[0].translation;
    assert!((at[0] - 5.0).abs() < 1e-3 && (at[2] - 2.0).abs() < 1e-3);
    assert!(at[1] < -3.5 && at[1] > -3.51, "not just under the model: {at:?}");
    // The wall stands on the far side, as the camera sees it.
    let pose = crate::motion::poses_at(&scene, 0.0)[1];
    let wall = pose.transform_point3(DVec3::new(0.0, 0.5, -0.28) * backdrop.scale.0[0]);
    let view = camera_at(&scene, 0.0).view_from_world();
    let depth = |point: DVec3| -view.transform_point3(point).z;
    assert!(depth(wall) > depth(center.as_dvec3()) + 0.5);
    // A model with the backdrop's name does not clash with it.
    let named = placed(Path::new("backdrop.obj"), &mesh);
    assert!(crate::check::check(&named).is_empty());
    // When the camera looks from below, no floor hides the model.
    let ceiling = box_between(Vec3::NEG_ONE, Vec3::ONE, true);
    let mut turned = ceiling.clone();
    for position in &mut turned.mesh.positions {
        *position = Vec3::new(position.x, position.z, position.y);
    }
    for triangle in &mut turned.mesh.triangles {
        triangle.swap(0, 1);
    }
    let below = placed(Path::new("x.obj"), &turned);
    let eye = below.camera.keys[0].eye;
    assert!(eye[1] < 0.0, "eye at {eye:?}");
    assert_eq!(below.objects.len(), 1);
}

/// A box whose faces are given to these groups in turn.
fn grouped(low: Vec3, high: Vec3, groups: &[&str]) -> MeshFile {
    let mut file = box_between(low, high, false);
    file.groups = groups.iter().map(|group| (*group).to_owned()).collect();
    let material = |name: &str| crate::mesh_file::Material::plain(name.to_owned(), [0.5; 3]);
    file.materials = vec![material("wood"), material("spare"), material("")];
    let count = file.mesh.triangles.len();
    file.mesh.group_of_triangle = (0..count).map(|i| (i % groups.len()) as u32).collect();
    file.mesh.material_of_triangle = (0..count).map(|i| if i < 4 { 0 } else { 2 }).collect();
    file
}

#[test]
fn added_meshes_stand_beside_each_other_with_a_region_for_each_group() {
    let mut scene = empty();
    assert!(crate::check::check(&scene).is_empty());
    let mut meshes = BTreeMap::new();
    let mesh = grouped(Vec3::new(-1.0, 0.5, -1.0), Vec3::new(1.0, 2.5, 3.0), &["skin", "stem", "a\nb"]);
    for (count, expected) in ["apple", "apple 2", "apple 3"].into_iter().enumerate() {
        let name = add_mesh(&mut scene, "meshes/apple.obj", &mesh, &meshes);
        assert_eq!((name.as_str(), scene.objects.len()), (expected, count + 1));
        meshes.insert("meshes/apple.obj".to_owned(), Arc::new(mesh.clone()));
    }
    let names: Vec<&str> = scene.regions.iter().map(|region| region.name.as_str()).collect();
    assert_eq!(names, ["skin", "stem", "a b", "skin 2", "stem 2", "a b 2", "skin 3", "stem 3", "a b 3"]);
    assert_eq!(scene.regions[3].on, Selector::Group("apple 2".to_owned(), "skin".to_owned()));
    assert_eq!(scene.regions[8].color, Some(REGION_COLORS[8]));
    assert!(crate::check::check(&scene).is_empty() && scene.objects[0].keys.is_empty());
    // The first mesh stays where its file puts it; the others stand on the same floor, beside it.
    let poses = crate::motion::poses_at(&scene, 0.0);
    let boxes: Vec<[DVec3; 2]> = poses
        .iter()
        .map(|pose| [[-1.0, 0.5, -1.0], [1.0, 2.5, 3.0]].map(|at| pose.transform_point3(DVec3::from(at))))
        .collect();
    for pair in boxes.windows(2) {
        assert!(pair[1][0].x > pair[0][1].x + 0.1, "{boxes:?}");
        assert!((pair[1][0].y - 0.5).abs() < 1e-3 && (pair[1][0].z + 1.0).abs() < 1e-3, "{boxes:?}");
    }
}

#[test]
fn regions_come_from_groups_else_materials_else_the_object() {
    let mesh = grouped(Vec3::ZERO, Vec3::ONE, &["all"]);
    let object = Object::new("chair", "chair.obj");
    let regions = regions_of(&object, &mesh);
    let on = |material: &str| Selector::Material("chair".to_owned(), material.to_owned());
    assert_eq!(regions.iter().map(|r| r.on.clone()).collect::<Vec<_>>(), [on("wood"), on("")]);
    assert_eq!(regions.iter().map(|r| r.name.as_str()).collect::<Vec<_>>(), ["wood", "chair"]);
    assert!(regions.iter().all(|region| region.direction == Direction::Auto && region.color.is_some()));
    let mut plain = mesh.clone();
    plain.mesh.material_of_triangle.fill(0);
    assert_eq!(regions_of(&object, &plain)[0].on, Selector::Object("chair".to_owned()));
    let of_group = Object { group: Some("all".to_owned()), ..object };
    assert_eq!(regions_of(&of_group, &mesh).len(), 1);
}

/// A four-legged animal that looks to +Z: legs, a body, and a head carried high in front.
fn animal() -> MeshFile {
    boxes(&[
        [[-0.4, 0.0, 0.9], [-0.2, 1.0, 1.1]],
        [[0.2, 0.0, 0.9], [0.4, 1.0, 1.1]],
        [[-0.4, 0.0, -1.1], [-0.2, 1.0, -0.9]],
        [[0.2, 0.0, -1.1], [0.4, 1.0, -0.9]],
        [[-0.45, 1.0, -1.3], [0.45, 1.7, 1.2]],
        [[-0.25, 1.6, 1.1], [0.25, 2.2, 1.9]],
    ])
}

fn turned(mesh: &MeshFile, turn: impl Fn(Vec3) -> Vec3) -> MeshFile {
    let mut turned = mesh.clone();
    for vectors in [&mut turned.mesh.positions, &mut turned.mesh.normals] {
        vectors.iter_mut().for_each(|vector| *vector = turn(*vector));
    }
    turned
}

#[test]
fn an_animal_is_stood_on_its_feet_and_seen_from_the_side_of_its_head() {
    let animal = animal();
    let scene = placed(Path::new("x.obj"), &animal);
    assert_eq!(scene.objects[0].up, Up::Y);
    let eye = DVec3::from(scene.camera.keys[0].eye);
    assert!(eye.z > 0.3, "seen from behind: {eye}");
    let back_to_front = placed(Path::new("x.obj"), &turned(&animal, |at| Vec3::new(-at.x, at.y, -at.z)));
    assert!(back_to_front.camera.keys[0].eye[2] < -0.3, "{:?}", back_to_front.camera.keys[0].eye);
    // As a program with Z up writes it.
    let z_up = placed(Path::new("x.obj"), &turned(&animal, |at| Vec3::new(at.x, -at.z, at.y)));
    assert_eq!(z_up.objects[0].up, Up::Z);
    assert!(on_screen_turned(&z_up, &animal), "the head of the animal with Z up is not above its feet");
    // A glTF file says that Y is up, whatever it looks like.
    let gltf = placed(Path::new("x.glb"), &turned(&animal, |at| Vec3::new(at.x, -at.z, at.y)));
    assert_eq!(gltf.objects[0].up, Up::Y);
}

/// Whether the head of an animal that was turned to Z up stands above its feet in the picture.
fn on_screen_turned(scene: &Scene, animal: &MeshFile) -> bool {
    let view = camera_at(scene, 0.0).view_from_world();
    let height = |at: Vec3| {
        let in_file = DVec3::new(f64::from(at.x), f64::from(-at.z), f64::from(at.y));
        view.transform_point3(scene.objects[0].model_from_file() * in_file).y
    };
    let [feet, head] = [animal.mesh.positions[0], animal.mesh.positions[46]];
    height(head) > height(feet)
}

#[test]
fn a_model_stands_on_the_ground_that_is_asked_for() {
    let mesh = box_between(Vec3::NEG_ONE, Vec3::ONE, false);
    let on = |ground| for_mesh(Path::new("x.obj"), &mesh, Placing { ground, ..Placing::default() }).scene;
    let [backdrop, vignette, plain] = [Ground::Backdrop, Ground::Vignette, Ground::Plain].map(on);
    assert_eq!((vignette.objects[1].mesh.as_str(), plain.objects.len()), (built_in_mesh::PATCH, 1));
    assert_eq!((backdrop.regions.len(), vignette.regions.len(), plain.regions.len()), (2, 1, 0));
    assert_eq!(vignette.background, plain.background);
    assert_ne!(vignette.background, backdrop.background);
    for scene in [backdrop, vignette, plain] {
        assert_eq!(crate::check::check(&scene), vec![], "{:?}", scene.objects[0].name);
    }
}

#[test]
fn a_ground_that_is_chosen_later_is_the_one_of_a_new_scene() {
    let mesh = box_between(Vec3::new(3.0, -1.0, 7.0), Vec3::new(5.0, 1.0, 8.0), false);
    let on = |ground| for_mesh(Path::new("x.obj"), &mesh, Placing { ground, ..Placing::default() }).scene;
    let meshes = BTreeMap::from([("x.obj".to_owned(), Arc::new(mesh.clone()))]);
    for (_, ground) in Ground::ALL {
        let wanted = on(ground);
        let mut scene = on(Ground::Plain);
        assert_eq!(ground.lay_under(&mut scene, &meshes, None), Ok(()));
        // The camera is stated in rounded numbers, so the ground may be off by that rounding.
        for (object, other) in scene.objects.iter_mut().zip(&wanted.objects) {
            for (key, other) in object.keys.iter_mut().zip(&other.keys) {
                let apart = DVec3::from(key.translation).distance(DVec3::from(other.translation));
                assert!(apart < 2e-3, "{ground:?}: {apart}");
                assert!((key.rotation_deg[1] - other.rotation_deg[1]).abs() < 0.15, "{ground:?}");
                *key = other.clone();
            }
        }
        assert_eq!(scene, wanted, "{ground:?}");
        assert_eq!(Ground::of_scene(&scene), ground);
    }

    let mut scene = on(Ground::Plain);
    scene.background = Color([0.9, 0.1, 0.1]);
    let green = Some(Color([0.1, 0.7, 0.2]));
    assert_eq!(Ground::Vignette.lay_under(&mut scene, &meshes, green), Ok(()));
    assert_eq!(scene.background, Color([0.9, 0.1, 0.1]), "a background that somebody chose stays");
    let material = scene.objects[1].material.as_ref().unwrap();
    assert_eq!(material.color, Some(Color([0.1, 0.7, 0.2])));

    // A background that came from a coloured ground is replaced with the ground.
    let mut scene = on(Ground::Plain);
    let usual = scene.background;
    assert_eq!(Ground::Vignette.lay_under(&mut scene, &meshes, green), Ok(()));
    assert_ne!(scene.background, usual);
    scene.objects.truncate(1);
    scene.regions.clear();
    assert_eq!(Ground::Plain.lay_under(&mut scene, &meshes, green), Ok(()));
    assert_eq!(scene.background, usual);

    let mut from_below = on(Ground::Plain);
    from_below.camera.keys[0].eye[1] = -50.0;
    let laid = |scene: &mut Scene| Ground::Backdrop.lay_under(scene, &meshes, None);
    assert_eq!(laid(&mut from_below), Err(NoGround::SeenFromBelow));
    let mut hidden = on(Ground::Plain);
    hidden.objects[0].hidden = true;
    assert_eq!(laid(&mut hidden), Err(NoGround::NothingStands));
    // A name that is taken gets a number. The background of a plain ground is recognized, and replaced.
    let mut crowded = on(Ground::Plain);
    for name in ["backdrop", "wall", "the backdrop"] {
        crowded.objects.push(Object { hidden: true, ..Object::new(name, "x.obj") });
    }
    crowded.regions.push(Region::new("backdrop 2 floor", Selector::Object("wall".to_owned())));
    assert_eq!(laid(&mut crowded), Ok(()));
    assert_eq!(crowded.objects.last().unwrap().name, "backdrop 2");
    assert_eq!(crate::check::check(&crowded), vec![]);
    assert_eq!(crowded.regions.last().unwrap().name, "backdrop 2 floor", "a person's region wins");
    assert_ne!(crowded.background, on(Ground::Plain).background);
}

#[test]
fn low_models_are_seen_from_higher_up_than_tall_ones_and_see_their_floor() {
    let rise = |height: f32| {
        let mesh = box_between(Vec3::new(-1.0, 0.0, -1.0), Vec3::new(1.0, height, 1.0), false);
        let scene = placed(Path::new("x.obj"), &mesh);
        let key = &scene.camera.keys[0];
        let back = DVec3::from(key.eye) - DVec3::from(key.target);
        // The lower border of the picture shows the floor: the near plane does not cut it off.
        let gaze = -back.normalize();
        let up = gaze.cross(DVec3::Y).cross(gaze).normalize();
        let ray = gaze - up * 17.5f64.to_radians().tan();
        let Lens::Perspective { near, .. } = scene.camera.lens else { panic!("no perspective lens") };
        let floor = scene.objects[1].keys[0].translation[1];
        let depth = (key.eye[1] - floor) / -ray.y;
        assert!(near < depth, "height {height}: near {near}, floor at {depth}");
        back.y / back.with_y(0.0).length()
    };
    assert!(
        rise(0.05) > 0.35 && rise(2.0) < 0.33 && rise(4.0) < 0.22,
        "{} {} {}",
        rise(0.05),
        rise(2.0),
        rise(4.0)
    );
}

#[test]
fn up_and_view_are_as_the_user_says() {
    let animal = animal();
    for (_, up) in Up::ALL {
        let NewScene { scene, up_is_unsure } =
            for_mesh(Path::new("x.obj"), &animal, Placing { up: Some(up), ..Placing::default() });
        assert_eq!((scene.objects[0].up, up_is_unsure), (up, false));
        let seen = on_screen_at(&scene, &animal);
        assert!(seen < 0.83, "{up:?}: reaches {seen}");
    }
    let sides = [
        (ViewFrom::Front, DVec3::Z),
        (ViewFrom::Back, DVec3::NEG_Z),
        (ViewFrom::Left, DVec3::NEG_X),
        (ViewFrom::Right, DVec3::X),
        (ViewFrom::Top, DVec3::Y),
    ];
    for (view, side) in sides {
        let placing = Placing { up: Some(Up::Y), view, ..Placing::default() };
        let key = for_mesh(Path::new("x.obj"), &animal, placing).scene.camera.keys[0].clone();
        let back = (DVec3::from(key.eye) - DVec3::from(key.target)).normalize();
        assert!(back.dot(side) > 0.9, "{view:?}: {back}");
    }
}

/// How far the upright mesh reaches towards the picture's border, 1 at the border.
fn on_screen_at(scene: &Scene, mesh: &MeshFile) -> f64 {
    let turn = scene.objects[0].model_from_file();
    let upright = turned(mesh, |at| (turn * at.as_dvec3()).as_vec3());
    on_screen(scene, &upright).iter().map(|point| point.x.abs().max(point.y.abs())).fold(0.0, f64::max)
}
