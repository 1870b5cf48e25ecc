//! Tests of new scenes: framing, backdrop, light, names and regions.

use glam::{DMat4, DVec4, Vec3};
use impasto_core::TriangleMesh;

use super::*;
use crate::motion::camera_at;

/// A box between two corners, wound outwards; with `open`, only its face at the lowest z, which faces −Z.
fn box_between(low: Vec3, high: Vec3, open: bool) -> MeshFile {
    let positions = (0..8)
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
    let mesh = TriangleMesh { positions, triangles, ..TriangleMesh::default() };
    MeshFile { mesh, groups: vec![String::new()], materials: Vec::new() }
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
        let scene = for_mesh(Path::new("x.obj"), &mesh);
        let seen = on_screen(&scene, &mesh);
        let reach = seen.iter().map(|point| point.x.abs().max(point.y.abs())).fold(0.0, f64::max);
        assert!((0.82..0.86).contains(&reach), "{center} {half}: reaches {reach}");
        assert!(seen.iter().all(|point| point.z.abs() <= 1.0), "{center} {half}: cut by near or far");
        let findings = crate::check::check(&scene);
        assert!(findings.is_empty(), "{center} {half}: {findings:?}");
    }
}

#[test]
fn a_single_point_still_gives_a_good_scene() {
    let mesh = box_between(Vec3::ONE, Vec3::ONE, false);
    let scene = for_mesh(Path::new("x.obj"), &mesh);
    assert!(crate::check::check(&scene).is_empty());
}

#[test]
fn an_open_mesh_is_looked_at_from_its_front() {
    let panel = box_between(Vec3::NEG_ONE, Vec3::ONE, true);
    let eye = for_mesh(Path::new("x.obj"), &panel).camera.keys[0].eye;
    assert!(eye[2] < -1.0 && eye[1] > 0.0, "{eye:?} does not face a panel that looks to −Z");
    let solid = box_between(Vec3::NEG_ONE, Vec3::ONE, false);
    let eye = for_mesh(Path::new("x.obj"), &solid).camera.keys[0].eye;
    assert!(eye[2] > 1.0 && eye[0] > 0.0 && eye[1] > 0.0, "{eye:?}");
}

#[test]
fn the_sun_comes_from_the_upper_left_front_of_the_picture() {
    for open in [false, true] {
        let scene = for_mesh(Path::new("x.obj"), &box_between(Vec3::NEG_ONE, Vec3::ONE, open));
        let direction = DVec3::from(scene.lights[0].direction.unwrap());
        let in_view = camera_at(&scene, 0.0).view_from_world().transform_vector3(direction);
        assert!(in_view.x > 0.3 && in_view.y < -0.3 && in_view.z < -0.3, "{in_view}");
    }
}

#[test]
fn names_come_from_the_file() {
    let mesh = box_between(Vec3::NEG_ONE, Vec3::ONE, false);
    let scene = for_mesh(Path::new("models/red apple.obj"), &mesh);
    assert_eq!(
        (scene.objects[0].name.as_str(), scene.objects[0].mesh.as_str()),
        ("red apple", "red apple.obj")
    );
    assert_eq!(scene.objects[1].mesh, built_in_mesh::BACKDROP);
    assert_eq!(scene.regions[0].on, Selector::Object("backdrop".to_owned()));
    let text = crate::save::to_ron(&scene);
    assert_eq!(crate::load::parse(Path::new("s.ron"), &text).unwrap(), scene);
}

#[test]
fn the_backdrop_stands_under_and_behind_the_model() {
    let center = Vec3::new(5.0, -3.0, 2.0);
    let mesh = box_between(center - 0.5, center + 0.5, false);
    let scene = for_mesh(Path::new("x.obj"), &mesh);
    let backdrop = &scene.objects[1];
    let at = backdrop.keys[0].translation;
    assert!((at[0] - 5.0).abs() < 1e-3 && (at[2] - 2.0).abs() < 1e-3);
    assert!(at[1] < -3.5 && at[1] > -3.51, "a hair under the model: {at:?}");
    // The wall stands on the far side, as the camera sees it.
    let pose = crate::motion::poses_at(&scene, 0.0)[1];
    let wall = pose.transform_point3(DVec3::new(0.0, 0.5, -0.28) * backdrop.scale.0[0]);
    let view = camera_at(&scene, 0.0).view_from_world();
    let depth = |point: DVec3| -view.transform_point3(point).z;
    assert!(depth(wall) > depth(center.as_dvec3()) + 0.5);
    // A model with the backdrop's name does not clash with it.
    let named = for_mesh(Path::new("backdrop.obj"), &mesh);
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
    let below = for_mesh(Path::new("x.obj"), &turned);
    let eye = below.camera.keys[0].eye;
    assert!(eye[1] < 0.0, "eye at {eye:?}");
    assert_eq!(below.objects.len(), 1);
}

/// A box whose faces are given to these groups in turn.
fn grouped(low: Vec3, high: Vec3, groups: &[&str]) -> MeshFile {
    let mut file = box_between(low, high, false);
    file.groups = groups.iter().map(|group| (*group).to_owned()).collect();
    let material = |name: &str| crate::mesh_file::Material {
        name: name.to_owned(),
        color: [0.5; 3],
        texture: None,
        gloss: 0.0,
    };
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
    let mut meshes = std::collections::BTreeMap::new();
    let mesh = grouped(Vec3::new(-1.0, 0.5, -1.0), Vec3::new(1.0, 2.5, 3.0), &["skin", "stem", "a\nb"]);
    for (count, expected) in ["apple", "apple 2", "apple 3"].into_iter().enumerate() {
        let name = add_mesh(&mut scene, "meshes/apple.obj", &mesh, &meshes);
        assert_eq!((name.as_str(), scene.objects.len()), (expected, count + 1));
        meshes.insert("meshes/apple.obj".to_owned(), std::sync::Arc::new(mesh.clone()));
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
