use glam::{DMat3, DVec3, EulerRot, Mat3};

use super::*;
use crate::TriangleMesh;
use crate::cofactors::cofactors_f32;
use crate::hash;
use crate::sampling::{PackedParticle, Particle};
use crate::solve::BakedParticles;

/// A bumpy sheet of 20 × 20 quads.
fn sheet() -> TriangleMesh {
    const SIDE: u32 = 20;
    let mut mesh = TriangleMesh::default();
    for row in 0..=SIDE {
        for column in 0..=SIDE {
            let [x, y] = [column, row].map(|at| at as f32 / SIDE as f32 - 0.5);
            mesh.positions.push(Vec3::new(x, y, 0.1 * (7.0 * x).sin() * (5.0 * y).cos()));
            let [dx, dy] =
                [0.7 * (7.0 * x).cos() * (5.0 * y).cos(), -0.5 * (7.0 * x).sin() * (5.0 * y).sin()];
            mesh.normals.push(Vec3::new(-dx, -dy, 1.0).normalize());
        }
    }
    for row in 0..SIDE {
        for column in 0..SIDE {
            let at = |row: u32, column: u32| row * (SIDE + 1) + column;
            let [a, b, c, d] =
                [at(row, column), at(row, column + 1), at(row + 1, column + 1), at(row + 1, column)];
            mesh.triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    mesh
}

fn moved(mesh: &TriangleMesh, by: impl Fn(DVec3) -> DVec3) -> Vec<Vec3> {
    mesh.positions.iter().map(|at| by(at.as_dvec3()).as_vec3()).collect()
}

#[test]
fn the_gradient_of_a_rigid_motion_is_its_rotation_everywhere() {
    let mesh = sheet();
    let gradients = Gradients::new(&mesh, Bonds::All);
    for angles in [[7.0f64, 30.0, 137.0], [-80.0, 12.0, 3.0]] {
        let [a, b, c] = angles.map(f64::to_radians);
        let turn = DMat3::from_euler(EulerRot::XYZ, a, b, c);
        let positions = moved(&mesh, |at| turn * at + DVec3::new(3.0, -2.0, 1.0));
        for gradient in gradients.at(&positions) {
            assert!(gradient.abs_diff_eq(turn.as_mat3(), 6.5e-6), "{gradient} {turn}");
        }
    }
}

#[test]
fn the_gradient_of_an_affine_map_is_exact_on_a_flat_surface() {
    let tilt = DMat3::from_euler(EulerRot::XYZ, 0.4, 2.4, -1.0);
    let mut mesh = sheet();
    for (at, normal) in mesh.positions.iter_mut().zip(&mut mesh.normals) {
        *at = tilt.as_mat3() * at.truncate().extend(0.0);
        *normal = tilt.z_axis.as_vec3();
    }
    let map =
        DMat3::from_cols(DVec3::new(2.5, 0.3, 0.0), DVec3::new(-0.4, 0.7, 0.2), DVec3::new(0.1, 0.0, 1.4));
    for gradient in Gradients::new(&mesh, Bonds::All).at(&moved(&mesh, |at| map * at)) {
        for tangent in [tilt.x_axis, tilt.y_axis] {
            assert!((gradient.as_dmat3() * tangent - map * tangent).length() < 2.8e-6);
        }
    }
}

#[test]
fn the_gradient_is_the_mean_of_what_edges_say_whatever_their_length() {
    let [right, up, left, down] = [Vec3::X, Vec3::Y, Vec3::X * -3.0, Vec3::Y * -0.5];
    let mesh = TriangleMesh {
        positions: vec![Vec3::ZERO, right, up, left, down],
        normals: vec![Vec3::Z; 5],
        triangles: vec![[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]],
        ..TriangleMesh::default()
    };
    // The edge to the right gets twice as long, the one upwards three times; the others stay.
    let positions = [Vec3::ZERO, right * 2.0, up * 3.0, left, down];
    let found = Gradients::new(&mesh, Bonds::All).at(&positions)[0];
    assert!(found.abs_diff_eq(Mat3::from_diagonal(Vec3::new(1.5, 2.0, 1.0)), 1e-6), "{found}");
}

#[test]
fn a_carried_normal_is_as_long_as_the_surface_has_grown() {
    let mesh = TriangleMesh {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(1.0, 1.0, 0.0)],
        normals: vec![Vec3::Z; 4],
        triangles: vec![[0, 1, 2], [1, 3, 2]],
        ..TriangleMesh::default()
    };
    let positions = moved(&mesh, |at| DVec3::new(3.0 * at.x, 0.5 * at.z, -2.0 * at.y));
    let gradients = Gradients::new(&mesh, Bonds::All).at(&positions);
    let carrier = Carrier::new(&positions, &gradients);
    let particle = Particle {
        triangle: 1,
        barycentric: [0.2, 0.3],
        flipped: true,
        position: Vec3::ZERO,
        normal: Vec3::ZERO,
    };
    let place = PackedParticle::of(&particle);
    let mut baked = BakedParticles::default();
    let lift = crate::lift::Lift { along: DVec3::X, across: DVec3::Y };
    baked.push(DVec3::new(0.8, 0.5, 0.0), DVec3::NEG_Z, lift);
    let carried = carrier.carry(&mesh, &[place], &baked, |_| 0.25);
    assert!(
        carried.placed.normal_of(0).abs_diff_eq(DVec3::new(0.0, -6.0, 0.0), 1e-5),
        "{}",
        carried.placed.normal_of(0)
    );
    let lift = carried.lift_of(0);
    assert!(
        lift.along.abs_diff_eq(DVec3::X * 3.0, 1e-5) && lift.across.abs_diff_eq(DVec3::NEG_Z * 2.0, 1e-5)
    );
    let lifted = carrier.place(&mesh, place).position + DVec3::NEG_Y * 0.25;
    assert!(carried.placed.position_of(0).abs_diff_eq(lifted, 1e-5));
}

#[test]
fn a_collapsed_or_mirrored_surface_gives_numbers() {
    let mesh = sheet();
    let gradients = Gradients::new(&mesh, Bonds::All);
    for by in
        [DVec3::ZERO, DVec3::new(1.0, 0.0, 0.0), DVec3::new(-1.0, 1.0, 1.0), DVec3::new(1e-20, 1e-20, 1e-20)]
    {
        let positions = moved(&mesh, |at| at * by);
        let bent = gradients.at(&positions);
        assert!(bent.iter().all(Mat3::is_finite), "{by}");
        let normals = gradients.normals(&mesh.normals, &bent);
        assert!(normals.iter().all(|normal| (normal.length() - 1.0).abs() < 1e-5), "{by}");
    }
}

#[test]
fn joints_and_targets_move_vertices_as_the_formula_says() {
    let bound = Vertices {
        positions: vec![Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, 2.0, 0.0)],
        normals: vec![Vec3::X, Vec3::Y],
    };
    let mut smile = Target::default();
    smile.push(0, Vec3::ZERO, Vec3::ZERO);
    smile.push(1, Vec3::new(0.0, 0.0, 1.0), Vec3::new(0.0, -1.0, 1.0));
    assert_eq!(smile.vertices, [1]);
    let skin = SkinWeights { per_vertex: 2, joints: vec![0, 1, 1, 0], weights: vec![0.25, 0.75, 1.0, 0.0] };
    let bend = Bend { bound, targets: vec![smile], skin: Some(skin), ..Bend::default() };
    let joints = vec![
        DAffine3::from_translation(DVec3::new(0.0, 4.0, 0.0)),
        DAffine3::from_scale(DVec3::new(1.0, 2.0, 3.0)),
    ];
    let bent = bend.at(&BendPose { weights: vec![0.5], joints });
    assert_eq!(bent.positions, [Vec3::new(1.0, 1.0, 0.0), Vec3::new(0.0, 4.0, 1.5)]);
    // The cofactors of the second joint are (6, 3, 2).
    let expected = Vec3::new(0.0, 3.0 * 0.5, 2.0 * 0.5).normalize();
    assert!(bent.normals[1].abs_diff_eq(expected, 1e-6), "{}", bent.normals[1]);
    assert_eq!(bend.at(&BendPose::default()), bend.bound);
}

#[test]
fn a_joint_that_there_is_not_moves_nothing_to_nowhere() {
    let bound = Vertices { positions: vec![Vec3::X], normals: vec![Vec3::X] };
    let skin = SkinWeights { per_vertex: 1, joints: vec![9], weights: vec![1.0] };
    let bend = Bend { bound, targets: Vec::new(), skin: Some(skin), ..Bend::default() };
    let bent = bend.at(&BendPose { weights: vec![], joints: vec![DAffine3::IDENTITY] });
    assert!(bent.positions[0].is_finite() && bent.normals == [Vec3::X]);
}

/// Two triangles that share an edge at rest. Each triangle has its own vertices along that edge.
fn hinge() -> TriangleMesh {
    TriangleMesh {
        positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Y, Vec3::X, Vec3::new(1.0, 1.0, 0.0)],
        normals: vec![Vec3::Z; 6],
        triangles: vec![[0, 1, 2], [3, 4, 5]],
        ..TriangleMesh::default()
    }
}

#[test]
fn what_parts_has_a_gradient_of_its_own_on_either_side() {
    let mesh = hinge();
    let quarter = DMat3::from_rotation_x(std::f64::consts::FRAC_PI_2);
    let mut positions = mesh.positions.clone();
    positions[3..].iter_mut().for_each(|at| *at = quarter.as_mat3() * *at + Vec3::Z);
    let mut lifted = Target::default();
    (3..6).for_each(|vertex| {
        lifted.push(vertex, positions[vertex as usize] - mesh.positions[vertex as usize], Vec3::ZERO)
    });
    let bound = Vertices { positions: mesh.positions.clone(), normals: mesh.normals.clone() };
    let morph = Bend { bound: bound.clone(), targets: vec![lifted], ..Bend::default() };
    let skin = SkinWeights {
        per_vertex: 2,
        joints: vec![0, 1, 0, 2, 0, 1, 3, 1, 3, 2, 3, 1],
        weights: [1.0, 0.0].repeat(6),
    };
    let skinned = Bend { bound, skin: Some(skin), ..Bend::default() };
    for bonds in [Bonds::Points(&[0, 1, 2, 3, 4, 5]), Bonds::Bend(&morph), Bonds::Bend(&skinned)] {
        let gradients = Gradients::new(&mesh, bonds).at(&positions);
        for (vertex, gradient) in gradients.iter().enumerate() {
            let expected = if vertex < 3 { Mat3::IDENTITY } else { quarter.as_mat3() };
            assert!(gradient.abs_diff_eq(expected, 1e-5), "{bonds:?}, {vertex}: {gradient}");
        }
    }
}

#[test]
fn what_stays_together_has_one_gradient() {
    let mesh = hinge();
    let positions = moved(&mesh, |at| DVec3::new(at.x, at.y, at.x * at.y));
    let bound = Vertices { positions: mesh.positions.clone(), normals: mesh.normals.clone() };
    let step = |vertex: usize| (vertex as u32, positions[vertex] - mesh.positions[vertex], Vec3::ZERO);
    let mut morphed = Target::default();
    (0..6).map(step).for_each(|(vertex, position, normal)| morphed.push(vertex, position, normal));
    // Joints without weight count for nothing.
    let skin = SkinWeights {
        per_vertex: 2,
        joints: vec![0, 1, 0, 2, 0, 1, 0, 2, 0, 1, 0, 2],
        weights: [1.0, 0.0].repeat(6),
    };
    let bend = Bend { bound, targets: vec![morphed], skin: Some(skin), ..Bend::default() };
    for bonds in [Bonds::All, Bonds::Points(&[0, 1, 2, 2, 1, 3]), Bonds::Bend(&bend)] {
        let gradients = Gradients::new(&mesh, bonds).at(&positions);
        assert_eq!((gradients[1], gradients[2]), (gradients[4], gradients[3]), "{bonds:?}");
        assert_ne!(gradients[0], gradients[1]);
    }
}

#[test]
fn carried_normals_are_means_of_the_vectors_around_them() {
    let random = |which: u32| hash::unit(hash::scramble(which)) - 0.5;
    let vector = |which: u32| Vec3::new(random(which), random(which + 1), random(which + 2));
    let (mut behind, mut closest) = (0, 0.0f32);
    for case in 0..40u32 {
        let from = 1000 * case;
        // Some of these gradients bend a little, others much.
        let much = if case % 2 == 0 { 0.3 } else { 1.5 };
        let turn = Mat3::from_rotation_y(vector(from).x * 6.0);
        let gradient = |which: u32| {
            let [x, y, z] = [0, 3, 6].map(|column| vector(from + which + column) * much);
            turn + Mat3::from_cols(x, y, z)
        };
        let gradients = [100, 110, 120].map(gradient);
        let normals = [200, 203, 206].map(|which| (Vec3::Z + vector(from + which) * 0.5).normalize());
        for sample in 0..60 {
            let weights = |which: u32| {
                let own = [0, 1, 2].map(|corner| random(from + which + 7 * sample + corner) + 0.5);
                own.map(|weight| weight / own.iter().sum::<f32>())
            };
            let [u, v, w] = weights(300);
            let blended = gradients[0] * u + gradients[1] * v + gradients[2] * w;
            let [u, v, w] = weights(350);
            let normal = normals[0] * u + normals[1] * v + normals[2] * w;
            let carried = cofactors_f32(blended) * normal;
            let towards = vector(from + 900 + 3 * sample);
            // A mean reaches no farther in any direction than the farthest of its vectors.
            let farthest = normals_around(gradients, normals).map(|around| around.dot(towards));
            let farthest = farthest.fold(f32::NEG_INFINITY, f32::max);
            behind += u32::from(farthest <= 0.0);
            let reached = carried.dot(towards);
            assert!(reached <= farthest + 1e-6, "case {case}: {carried} towards {towards}");
            closest = closest.max(reached / farthest.abs());
        }
    }
    assert!(behind > 200 && closest > 0.9, "{behind}, {closest}");
}
