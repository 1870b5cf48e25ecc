//! Tests of picking surfaces by rays. The picks are compared with a plain search of all triangles.

use glam::{DQuat, DVec2, Vec3};
use impasto_core::TriangleMesh;
use impasto_core::hash::scramble;
use impasto_scene::document::Lens;
use impasto_scene::motion::CameraPose;

use super::*;

/// An endless sequence of pseudo-random numbers in 0..1.
fn numbers() -> impl FnMut() -> f64 {
    let mut index = 0u32;
    move || {
        index += 1;
        f64::from(scramble(index)) / f64::from(u32::MAX)
    }
}

fn surface(mesh: TriangleMesh) -> (Arc<BodySurface>, BodyShape) {
    (Arc::new(BodySurface::still(mesh)), BodyShape::default())
}

fn mesh(positions: Vec<Vec3>, triangles: Vec<[u32; 3]>) -> TriangleMesh {
    let count = triangles.len();
    TriangleMesh {
        normals: vec![Vec3::Z; positions.len()],
        positions,
        triangles,
        polygon_of_triangle: (0..count as u32).collect(),
        group_of_triangle: vec![0; count],
        material_of_triangle: vec![0; count],
        ..Default::default()
    }
}

/// A closed ball of radius 1 that winds outwards.
fn ball(columns: u32, rows: u32) -> TriangleMesh {
    let (mut positions, mut triangles) = (vec![Vec3::Y], Vec::new());
    for row in 1..rows {
        let (sin, cos) = (std::f32::consts::PI * row as f32 / rows as f32).sin_cos();
        positions.extend((0..columns).map(|column| {
            let (x, z) = (std::f32::consts::TAU * column as f32 / columns as f32).sin_cos();
            Vec3::new(x * sin, cos, z * sin)
        }));
    }
    positions.push(Vec3::NEG_Y);
    let last = positions.len() as u32 - 1;
    let at = |row: u32, column: u32| match row {
        0 => 0,
        row if row == rows => last,
        row => 1 + (row - 1) * columns + column % columns,
    };
    for row in 0..rows {
        for column in 0..columns {
            let [a, b, c, d] =
                [at(row, column), at(row + 1, column), at(row + 1, column + 1), at(row, column + 1)];
            triangles
                .extend([[a, b, c], [a, c, d]].into_iter().filter(|[a, b, c]| a != b && b != c && c != a));
        }
    }
    let normals = positions.clone();
    TriangleMesh { normals, ..mesh(positions, triangles) }
}

/// Random triangles of many sizes.
fn heap(count: u32) -> TriangleMesh {
    let mut number = numbers();
    let mut positions = Vec::new();
    for _ in 0..count {
        let mut place = |size: f64| DVec3::new(number() - 0.5, number() - 0.5, number() - 0.5) * size;
        let (centre, size) = (place(6.0), 0.05 + 2.0 * place(1.0).x.abs());
        positions.extend([place(size), place(size), place(size)].map(|corner| (centre + corner).as_vec3()));
    }
    mesh(positions, (0..count).map(|triangle| [triangle * 3, triangle * 3 + 1, triangle * 3 + 2]).collect())
}

/// The nearest triangle, found by testing each one's plane and edges: (object, triangle, distance).
fn nearest_by_force(
    bodies: &[(Arc<BodySurface>, BodyShape)],
    poses: &[DAffine3],
    ray: &Ray,
) -> Option<(usize, u32, f64)> {
    let mut nearest: Option<(usize, u32, f64)> = None;
    for (object, ((surface, _), pose)) in bodies.iter().zip(poses).enumerate() {
        for triangle in 0..surface.mesh.triangles.len() {
            let [a, b, c] =
                surface.mesh.corners(triangle).map(|corner| pose.transform_point3(corner.as_dvec3()));
            let normal = (b - a).cross(c - a);
            let distance = (a - ray.origin).dot(normal) / ray.direction.dot(normal);
            let at = ray.origin + ray.direction * distance;
            let inside = [(a, b), (b, c), (c, a)]
                .iter()
                .all(|&(from, to)| (to - from).cross(at - from).dot(normal) >= 0.0);
            if inside && distance >= 0.0 && nearest.is_none_or(|(.., least)| distance < least) {
                nearest = Some((object, triangle as u32, distance));
            }
        }
    }
    nearest
}

#[test]
fn picking_equals_a_search_of_all_triangles() {
    let bodies = [surface(heap(400)), surface(ball(40, 20)), surface(heap(3))];
    let turn = DQuat::from_euler(glam::EulerRot::XYZ, 0.4, -1.0, 2.0);
    let poses = [
        DAffine3::from_scale_rotation_translation(DVec3::splat(0.7), turn, DVec3::new(1.0, 0.0, -2.0)),
        DAffine3::from_scale_rotation_translation(DVec3::splat(2.5), turn, DVec3::new(-1.0, 0.5, 0.0)),
        DAffine3::IDENTITY,
    ];
    let mut picker = Picker::default();
    picker.update(&bodies);
    let mut number = numbers();
    let (mut met, mut missed) = (0, 0);
    for index in 0..2000 {
        // Rays begin near by, or as far away as the camera of a parallel view may stand.
        let far = if index % 4 == 0 { 1e4 } else { 9.0 };
        let mut place = |size: f64| DVec3::new(number() - 0.5, number() - 0.5, number() - 0.5) * size;
        let origin = place(1.0).normalize() * far;
        let ray = Ray { origin, direction: (place(7.0) - origin).normalize() };
        let hit = picker.pick(&ray, &poses, |_| true);
        let wanted = nearest_by_force(&bodies, &poses, &ray);
        match (hit, wanted) {
            (Some(hit), Some((object, triangle, distance))) => {
                met += 1;
                assert!((hit.distance - distance).abs() < 1e-9 * far, "{} {distance}", hit.distance);
                assert_eq!((hit.object, hit.triangle), (object, triangle), "ray {index}");
                let at = ray.origin + ray.direction * distance;
                assert!((hit.position_in_world - at).length() < 1e-8 * far);
                let corners = bodies[object].0.mesh.corners(triangle as usize);
                let blend: DVec3 = corners
                    .iter()
                    .zip(hit.barycentric)
                    .map(|(corner, share)| corner.as_dvec3() * share)
                    .sum();
                assert!((blend - hit.position_in_model).length() < 1e-9);
            }
            (None, None) => missed += 1,
            other => panic!("ray {index}: {other:?}"),
        }
    }
    assert!(met > 500 && missed > 200, "{met} met, {missed} missed");
}

#[test]
fn hidden_objects_are_not_picked() {
    let bodies = [surface(ball(16, 8)), surface(ball(16, 8))];
    let poses = [DAffine3::from_translation(DVec3::Z * 4.0), DAffine3::IDENTITY];
    let mut picker = Picker::default();
    assert_eq!(picker.update(&bodies), 2);
    let ray = Ray { origin: DVec3::new(0.1, 0.1, 9.0), direction: DVec3::NEG_Z };
    assert_eq!(picker.pick(&ray, &poses, |_| true).unwrap().object, 0);
    assert_eq!(picker.pick(&ray, &poses, |object| object != 0).unwrap().object, 1);
    assert_eq!(picker.pick(&ray, &poses, |_| false), None);
    assert_eq!(picker.update(&bodies), 0, "nothing changed");
    assert_eq!(picker.update(&[bodies[1].clone(), surface(heap(3))]), 1);
    assert_eq!(picker.update(&[]), 0);
    assert_eq!(picker.pick(&ray, &poses, |_| true), None);
}

#[test]
fn the_painted_side_is_the_outside_of_what_is_closed_and_either_side_of_a_sheet() {
    let inside_out = TriangleMesh {
        triangles: ball(16, 8).triangles.iter().map(|&[a, b, c]| [a, c, b]).collect(),
        ..ball(16, 8)
    };
    let sheet = mesh(
        vec![Vec3::new(-1.0, -1.0, 0.0), Vec3::new(1.0, -1.0, 0.0), Vec3::new(0.0, 1.0, 0.0)],
        vec![[0, 1, 2]],
    );
    let pick = |mesh: TriangleMesh, from: DVec3| {
        let mut picker = Picker::default();
        picker.update(&[surface(mesh)]);
        let ray = Ray { origin: from, direction: (DVec3::new(0.01, -0.02, -0.1) - from).normalize() };
        picker.pick(&ray, &[DAffine3::IDENTITY], |_| true).unwrap()
    };
    assert!(pick(inside_out.clone(), DVec3::new(0.0, 0.0, 3.0)).flipped);
    for (mesh, winds_inwards) in [(ball(16, 8), false), (inside_out, true)] {
        let outside = pick(mesh.clone(), DVec3::new(0.0, 0.0, 3.0));
        assert!(outside.front && outside.normal_in_model.z > 0.9 && outside.face_normal_in_model.z > 0.9);
        if winds_inwards {
            continue;
        }
        let inside = pick(mesh, DVec3::new(0.0, 0.0, 0.2));
        assert!(!inside.front && inside.normal_in_model.dot(inside.position_in_model) > 0.5);
    }
    for z in [2.0, -2.0] {
        let hit = pick(sheet.clone(), DVec3::new(0.0, 0.0, z));
        assert!(hit.front && hit.normal_in_model.z * z > 0.0 && hit.flipped == (z < 0.0), "{z}");
        let particle = hit.particle();
        assert!((particle.position.as_dvec3() - hit.position_in_model).length() < 1e-6);
    }
}

#[test]
fn the_nearest_point_of_a_surface() {
    let mut picker = Picker::default();
    let mesh = ball(64, 32);
    picker.update(&[surface(mesh.clone())]);
    let mut number = numbers();
    for _ in 0..200 {
        let to = DVec3::new(number() - 0.5, number() - 0.5, number() - 0.5) * 3.0;
        let found = picker.closest_on_surface(0, to, to, 0.5);
        let gap = (to.length() - 1.0).abs();
        if gap > 0.51 {
            assert_eq!(found, None, "{to}");
        } else if gap < 0.45 {
            let found = found.unwrap();
            // The facets lie within 0.005 of the ball.
            assert!((found.position.distance(to) - gap).abs() < 0.006, "{to} {found:?}");
            assert!(found.normal.dot(to.normalize()) > 0.98);
        }
    }
    assert_eq!(picker.closest_on_surface(0, DVec3::Y * 1.1, DVec3::NEG_Y, 0.2), None, "found facing away");
    assert_eq!(picker.closest_on_surface(7, DVec3::Y, DVec3::Y, 0.2), None);
}

#[test]
fn the_box_round_some_triangles_holds_no_others() {
    let mut picker = Picker::default();
    picker.update(&[surface(ball(64, 32))]);
    let [low, high] = picker.bounds_where(0, |hit| hit.position_in_world.x > 0.5).expect("there are some");
    assert!(low.x > 0.4 && (high.x - 1.0).abs() < 0.01, "{low} to {high}");
    assert!((low.y + 0.87).abs() < 0.1 && (high.y - 0.87).abs() < 0.1, "{low} to {high}");
    assert_eq!(picker.bounds_where(0, |_| false), None);
}

#[test]
fn the_ray_of_a_pixel_projects_back_to_it() {
    let lenses = [
        Lens::Perspective { fov_y_deg: 50.0, near: 0.1, far: 50.0 },
        Lens::Orthographic { height: 3.0, near: 0.1, far: 50.0 },
    ];
    for lens in lenses {
        for roll_rad in [0.0, 0.6, -2.4] {
            let camera = CameraPose {
                eye: DVec3::new(1.0, 2.0, 4.0),
                target: DVec3::ZERO,
                roll_rad,
                shift: DVec2::new(-0.4, 0.2),
                lens: lens.clone(),
            };
            let view = View { camera, size_px: DVec2::new(640.0, 360.0) };
            for at_px in [[320.0, 180.0], [0.0, 0.0], [600.5, 40.25]].map(DVec2::from) {
                let ray = view.ray(at_px);
                for distance in [0.0, 1.0, 20.0] {
                    let point = ray.origin + ray.direction * distance;
                    let back = view.project(point).unwrap();
                    assert!((back - at_px).length() < 1e-7, "{lens:?} {roll_rad}: {at_px} {back}");
                    assert!((view.at_depth_of(at_px, point) - point).length() < 1e-9);
                }
                assert_eq!(view.project(ray.origin - ray.direction * 0.01), None);
            }
            let [right, up, _] = view.axes();
            let (here, scale) = (DVec3::new(0.1, 0.2, 0.0), 0.01);
            let at = view.project(here).unwrap();
            let moved = view.project(here + right * scale).unwrap() - at;
            assert!((moved - DVec2::X * scale * view.px_per_unit(here)).length() < 1e-6, "{moved}");
            let moved = view.project(here + up * scale).unwrap() - at;
            assert!((moved + DVec2::Y * scale * view.px_per_unit(here)).length() < 1e-6, "{moved}");
        }
    }
}

#[test]
fn trees_of_another_picker_are_reused() {
    let bodies = [surface(mesh(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![[0, 1, 2]]))];
    let mut there = Picker::default();
    assert_eq!(there.update(&bodies), 1);
    let mut here = Picker::default();
    here.learn(there.clone());
    assert_eq!(here.update(&bodies), 0);
    let ray = Ray { origin: DVec3::new(0.2, 0.2, 1.0), direction: -DVec3::Z };
    let hits = [&there, &here].map(|picker| picker.pick(&ray, &[DAffine3::IDENTITY], |_| true));
    assert!(hits[0].is_some() && hits[0] == hits[1]);
    // The tree of another surface is not reused, even if the two are equal.
    let other = [surface(mesh(vec![Vec3::ZERO, Vec3::X, Vec3::Y], vec![[0, 1, 2]]))];
    let mut elsewhere = Picker::default();
    elsewhere.learn(there);
    assert_eq!(elsewhere.update(&other), 1);
}
