//! Tests of the colours of strokes that another part of their own body covers, from strokes read back.

use glam::DVec3;
use impasto_gl_render::context::Driver;
use impasto_painting::{FrameOptions, prepare};
use impasto_scene::document::MaterialOverride;
use impasto_scene::loaded::LoadedScene;
use impasto_scene::mesh_file::{Material, MeshFile};
use impasto_tests::pictures::renderer;
use impasto_tests::shapes;

/// A white sheet, and 13 to 21 pixels behind it a black strip of the same body at 45 degrees to the gaze. No pixel of the strip
/// is seen. The left border of the picture cuts both.
fn strip_behind_a_sheet() -> LoadedScene {
    let mut mesh = shapes::sheet(8);
    let to_strip = |at: DVec3| DVec3::new(0.8 * at.x, 0.3 + 0.03 * at.y, -0.12 + 0.03 * at.y);
    let mut strip = shapes::moved(&shapes::sheet(8), to_strip);
    let vertices = mesh.positions.len() as u32;
    mesh.material_of_triangle = vec![0; mesh.triangles.len()];
    mesh.material_of_triangle.resize(mesh.triangles.len() + strip.triangles.len(), 1);
    let polygons = mesh.polygon_of_triangle.iter().max().map_or(0, |last| last + 1);
    mesh.polygon_of_triangle.extend(strip.polygon_of_triangle.iter().map(|polygon| polygon + polygons));
    mesh.group_of_triangle.append(&mut strip.group_of_triangle);
    mesh.triangles.extend(strip.triangles.iter().map(|corners| corners.map(|corner| corner + vertices)));
    mesh.positions.append(&mut strip.positions);
    mesh.normals.append(&mut strip.normals);
    mesh.uvs.append(&mut strip.uvs);

    let mut pot = shapes::object("pot", 20_000);
    pot.material = Some(MaterialOverride { unlit: true, ..Default::default() });
    let mut scene = shapes::scene(vec![pot]);
    scene.camera.keys = vec![shapes::camera_key(0.0, [2.74, 0.0, 4.0], [2.74, 0.0, 0.0])];
    let mut loaded = LoadedScene::clone(&shapes::loaded(scene, [mesh]));
    for file in loaded.meshes.values_mut() {
        let mut painted = MeshFile::clone(file);
        painted.materials = vec![
            Material::plain("sheet".to_owned(), [1.0; 3]),
            Material::plain("strip".to_owned(), [0.0; 3]),
        ];
        *file = painted.into();
    }
    loaded
}

#[test]
fn a_covered_stroke_has_the_colour_that_is_seen_also_where_its_middle_is_beyond_the_picture() {
    let mut renderer = renderer(Driver::Egl);
    let painting = prepare(strip_behind_a_sheet().into()).unwrap();
    let frame = painting.at(0.0, &FrameOptions::new([640, 360]));
    renderer.render(&frame).unwrap();
    let [mut inside, mut beyond] = [0, 0];
    for (stroke, resolved) in frame.strokes.iter().zip(renderer.resolved_strokes()) {
        if stroke.normal_in_world[2] > 0.9 || resolved.alpha < 0.05 {
            continue;
        }
        let green = resolved.color_linear[1];
        assert!(green > 0.8, "{green} at {:?}", stroke.center_px);
        // A ring of half a width round the middle is beyond the picture, too.
        *if stroke.center_px[0] < -4.0 { &mut beyond } else { &mut inside } += 1;
    }
    assert!(inside > 20 && beyond > 5, "{inside} strokes inside, {beyond} beyond");
}
