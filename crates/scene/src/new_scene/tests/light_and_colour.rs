//! Tests of the light, the colours and the ground of new scenes.

use super::*;

#[test]
fn the_sun_comes_from_the_upper_left_front_of_the_picture_unless_the_right_is_better_lit() {
    for open in [false, true] {
        let mut mesh = box_between(Vec3::NEG_ONE, Vec3::ONE, open);
        if open {
            // Its one face looks to −Z, and to the right in the picture: light from the left would only graze it.
            mesh.mesh.normals.fill(Vec3::NEG_Z);
        }
        let scene = placed(Path::new("x.obj"), &mesh);
        let direction = DVec3::from(scene.lights[0].direction.unwrap());
        let in_view = camera_at(&scene, 0.0).view_from_world().transform_vector3(direction);
        let to_right = if open { -in_view.x } else { in_view.x };
        assert!(to_right > 0.3 && in_view.y < -0.3 && in_view.z < -0.3, "{in_view}");
        assert!(!open || direction.z > 0.15, "{direction} does not light the panel");
    }
}

#[test]
fn the_light_comes_from_the_side_that_shows_more() {
    // A slab whose broad side looks to the right of the picture, and its mirror image.
    let light = |yaw_deg: f32| {
        let slab = box_between(Vec3::new(-1.0, 0.0, -0.1), Vec3::new(1.0, 1.0, 0.1), false);
        let turn = Quat::from_rotation_y(yaw_deg.to_radians());
        let mut mesh = turned(&slab, |at| turn * at);
        // Each face has its own corners, so that normals are those of the faces.
        let corners: Vec<Vec3> = mesh
            .mesh
            .triangles
            .iter()
            .flatten()
            .map(|&corner| mesh.mesh.positions[corner as usize])
            .collect();
        mesh.mesh.normals =
            corners.chunks(3).flat_map(|of| [(of[1] - of[0]).cross(of[2] - of[0]).normalize(); 3]).collect();
        mesh.mesh.triangles =
            (0..corners.len() as u32 / 3).map(|face| [3 * face, 3 * face + 1, 3 * face + 2]).collect();
        mesh.mesh.positions = corners;
        let placing = Placing { up: Some(Up::Y), view: ViewFrom::Front, ..Placing::default() };
        for_mesh(Path::new("x.obj"), &mesh, placing).scene.lights[0].direction.unwrap()[0]
    };
    assert!(light(50.0) < 0.0 && light(-50.0) > 0.0 && light(0.0) > 0.0);
}

#[test]
fn a_model_without_colours_gets_one_by_its_name_and_its_groups_neighbouring_ones() {
    let color = |object: &Object| object.material.as_ref().and_then(|material| material.color);
    let plain = box_between(Vec3::NEG_ONE, Vec3::ONE, false);
    let one = placed(Path::new("bunny.obj"), &plain);
    assert!(color(&one.objects[0]).is_some());
    assert_eq!(one, placed(Path::new("bunny.obj"), &plain));
    let other_names = ["cow", "duck", "teapot", "head", "car", "dragon"];
    let others = other_names.map(|name| color(&placed(Path::new(name), &plain).objects[0]));
    assert!(others.iter().any(|other| *other != color(&one.objects[0])), "{others:?}");
    let grouped = placed(Path::new("animal.obj"), &animal());
    assert_eq!(grouped.objects.len(), 7, "six groups and the ground");
    assert!(crate::check::check(&grouped).is_empty());
    let first = color(&grouped.objects[0]).unwrap().0;
    for object in &grouped.objects[1..6] {
        let own = color(object).unwrap().0;
        let apart = (0..3).map(|channel| (own[channel] - first[channel]).abs()).fold(0.0, f32::max);
        assert!((0.01..0.45).contains(&apart), "{own:?} beside {first:?}");
        assert_eq!(object.parent.as_deref(), Some("box 0"));
    }
    // A model's own colours stay.
    let mut red = plain.clone();
    red.materials = vec![material([0.9, 0.1, 0.1])];
    assert_eq!(placed(Path::new("x.obj"), &red).objects[0].material, None);
}

#[test]
fn light_is_as_strong_as_the_model_asks() {
    // The sunlight that a side facing the sun reflects, as `lighting.glsl` computes it before its soft shoulder.
    let reflected = |value: f32| {
        let mut mesh = box_between(Vec3::NEG_ONE, Vec3::ONE, false);
        mesh.materials = vec![material([value; 3])];
        let scene = placed(Path::new("x.obj"), &mesh);
        let albedo = f64::from(impasto_core::color::linear_from_srgb(value));
        0.62 * albedo * scene.lights[0].intensity
    };
    let [black, grey, white] = [0.08, 0.5, 0.98].map(reflected);
    assert!(black > 0.01 && black < grey && grey <= white, "{black} {grey} {white}");
    assert!(white < 0.75, "white burns out: {white}");
    assert!(reflected(0.25) > 0.15, "a dark model is too dark against the ground: {}", reflected(0.25));
}

#[test]
fn the_ground_is_quiet_and_its_own() {
    let mesh = box_between(Vec3::NEG_ONE, Vec3::ONE, false);
    let scene = placed(Path::new("a.obj"), &mesh);
    let other = placed(Path::new("b.obj"), &mesh);
    assert_ne!(scene.seed, other.seed);
    for region in &scene.regions {
        assert!(matches!(region.direction, Direction::Angle(_)), "{:?}", region.direction);
        assert!(region.strokes.angle_jitter_deg.is_some_and(|jitter| jitter <= 6.0));
    }
    let [wall, floor] = ["backdrop wall", "backdrop floor"]
        .map(|name| scene.regions.iter().find(|region| region.name == name).unwrap());
    assert_eq!(floor.direction, Direction::Angle(0.0));
    assert_ne!(wall.direction, floor.direction);
}
