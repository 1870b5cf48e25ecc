//! Meshes and scenes for which the right answers are known in closed form.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use crate::command::root;
use glam::{DVec3, Vec2, Vec3};
use impasto_core::TriangleMesh;
use impasto_scene::document::{
    Camera, CameraKey, Color, Direction, Ease, LayerSettings, Lens, Object, Reference, Region, Scene,
    Selector, StrokeSettings, Style, Timeline,
};
use impasto_scene::loaded::LoadedScene;
use impasto_scene::mesh_file::{Material, MeshFile, Texture};
use impasto_scene::presets::LayerKind;

/// A unit sphere of `columns` × `rows` quads (triangles at the poles), with its analytic normals.
pub fn sphere(columns: u32, rows: u32) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    for row in 0..=rows {
        for column in 0..=columns {
            let polar = std::f32::consts::PI * row as f32 / rows as f32;
            // Positions at the seam and the poles repeat exactly, so that the shell is closed.
            let around = std::f32::consts::TAU * (column % columns) as f32 / columns as f32;
            let radius = if row == 0 || row == rows { 0.0 } else { polar.sin() };
            let position = Vec3::new(radius * around.sin(), polar.cos(), radius * around.cos());
            mesh.positions.push(position);
            mesh.normals.push(position.normalize());
            mesh.uvs.push(Vec2::new(column as f32 / columns as f32, 1.0 - row as f32 / rows as f32));
        }
    }
    let at = |row: u32, column: u32| row * (columns + 1) + column;
    for row in 0..rows {
        for column in 0..columns {
            let [a, b] = [at(row, column), at(row + 1, column)];
            let [c, d] = [at(row + 1, column + 1), at(row, column + 1)];
            let triangles: &[[u32; 3]] = match row {
                0 => &[[a, b, c]],
                _ if row == rows - 1 => &[[a, b, d]],
                _ => &[[a, b, c], [a, c, d]],
            };
            push_polygon(&mut mesh, triangles);
        }
    }
    mesh
}

/// A square sheet of side 2 in the plane z = 0, facing +Z, of `cells` × `cells` quads.
pub fn sheet(cells: u32) -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    for row in 0..=cells {
        for column in 0..=cells {
            let uv = Vec2::new(column as f32, row as f32) / cells as f32;
            mesh.positions.push((uv * 2.0 - 1.0).extend(0.0));
            mesh.normals.push(Vec3::Z);
            mesh.uvs.push(uv);
        }
    }
    for row in 0..cells {
        for column in 0..cells {
            let a = row * (cells + 1) + column;
            let (b, d) = (a + 1, a + cells + 1);
            push_polygon(&mut mesh, &[[a, b, d + 1], [a, d + 1, d]]);
        }
    }
    mesh
}

/// The skin of the shipped apple: smooth, closed at stem and calyx, coarse.
pub fn apple_skin() -> TriangleMesh {
    let folder = root().join("scenes/meshes");
    let (file, _) = impasto_scene::obj::read(&folder.join("apple.obj"), &folder, &Default::default())
        .expect("the apple is shipped");
    let skin = file.groups.iter().position(|group| group == "skin").expect("the apple has a skin") as u32;
    let kept: Vec<usize> = (0..file.mesh.triangles.len())
        .filter(|&triangle| file.mesh.group_of_triangle[triangle] == skin)
        .collect();
    let pick = |array: &[u32]| kept.iter().map(|&triangle| array[triangle]).collect();
    TriangleMesh {
        triangles: kept.iter().map(|&triangle| file.mesh.triangles[triangle]).collect(),
        polygon_of_triangle: pick(&file.mesh.polygon_of_triangle),
        group_of_triangle: pick(&file.mesh.group_of_triangle),
        material_of_triangle: pick(&file.mesh.material_of_triangle),
        ..file.mesh
    }
}

/// A cube from −1 to 1 with flat normals.
pub fn cube() -> TriangleMesh {
    let mut mesh = TriangleMesh::default();
    for axis in 0..3 {
        for sign in [-1.0f32, 1.0] {
            let mut normal = Vec3::ZERO;
            normal[axis] = sign;
            let mut right = Vec3::ZERO;
            right[(axis + 1) % 3] = 1.0;
            let up = normal.cross(right);
            let first = mesh.positions.len() as u32;
            for (x, y) in [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)] {
                mesh.positions.push(normal + right * x + up * y);
                mesh.normals.push(normal);
                mesh.uvs.push(Vec2::new(x, y) * 0.5 + 0.5);
            }
            push_polygon(&mut mesh, &[[first, first + 1, first + 2], [first, first + 2, first + 3]]);
        }
    }
    mesh
}

fn push_polygon(mesh: &mut TriangleMesh, triangles: &[[u32; 3]]) {
    let polygon = mesh.polygon_count() as u32;
    for &triangle in triangles {
        mesh.triangles.push(triangle);
        mesh.polygon_of_triangle.push(polygon);
        mesh.group_of_triangle.push(0);
        mesh.material_of_triangle.push(0);
    }
}

/// An object with the mesh `{name}.obj` and this many particles.
pub fn object(name: &str, particles: u64) -> Object {
    Object { particles: Some(particles), ..Object::new(name, format!("{name}.obj")) }
}

/// A camera key without roll.
pub fn camera_key(frame: f64, eye: [f64; 3], target: [f64; 3]) -> CameraKey {
    CameraKey { frame, eye, target, roll_deg: 0.0, fov_y_deg: None, ease: Ease::Linear }
}

/// A scene of these objects, seen from (0, 0, 4) with a 35° lens. Its strokes lie at 20° without jitter, in the
/// colours of the plain render.
pub fn scene(objects: Vec<Object>) -> Scene {
    Scene {
        version: Scene::VERSION,
        size: (640, 360),
        seed: 7,
        background: Color::default(),
        background_keys: Vec::new(),
        exposure: 0.0,
        shot: None,
        stage: Default::default(),
        timeline: Timeline::default(),
        reference: Reference::Frame(0),
        further_references: Vec::new(),
        camera: Camera {
            of_shot: None,
            lens: Lens::Perspective { fov_y_deg: 35.0, near: 0.05, far: 100.0 },
            keys: vec![camera_key(0.0, [0.0, 0.0, 4.0], [0.0; 3])],
        },
        lights: Vec::new(),
        objects,
        strokes: StrokeSettings {
            angle_jitter_deg: Some(0.0),
            swing_deg: Some(0.0),
            size_jitter: Some(0.0),
            color_jitter: Some(0.0),
            temperature: Some(0.0),
            grading: Some(0.0),
            length_px: Some(20.0),
            width_px: Some(7.0),
            ..Default::default()
        },
        regions: vec![Region {
            direction: Direction::Angle(20.0),
            ..Region::new("all", Selector::Everything)
        }],
        touches: Vec::new(),
        style: Style::default(),
        aovs: Vec::new(),
    }
}

/// Layer settings that leave out all but the body layer, for tests that look at no other. This saves time: each layer
/// has particles of its own, and layers of small strokes have many.
pub fn body_layer_alone() -> Vec<LayerSettings> {
    let others = LayerKind::ALL.into_iter().filter(|kind| *kind != LayerKind::Body);
    let absent = |kind: LayerKind| LayerSettings {
        name: kind.name().to_owned(),
        coverage: Some(0.0),
        ..Default::default()
    };
    others.map(absent).collect()
}

/// Gives a scene's objects these meshes, in order, as if they had been read from files.
pub fn loaded(scene: Scene, meshes: impl IntoIterator<Item = TriangleMesh>) -> Arc<LoadedScene> {
    let meshes: BTreeMap<String, Arc<MeshFile>> = scene
        .objects
        .iter()
        .zip(meshes)
        .map(|(object, mesh)| {
            let plain = Material::plain(String::new(), [0.7, 0.4, 0.3]);
            let file = MeshFile::still(mesh, vec!["whole".to_owned()], vec![plain]);
            (object.mesh.clone(), Arc::new(file))
        })
        .collect();
    Arc::new(LoadedScene {
        path: PathBuf::from("scene.ron"),
        scene,
        meshes,
        caches: BTreeMap::new(),
        textures: BTreeMap::new(),
        brushes: BTreeMap::new(),
        files: Default::default(),
        warnings: Vec::new(),
    })
}

/// The scene with holes in its objects. They get a texture whose alpha rises from 0 at the left to 1 at the right, and
/// are drawn where alpha is at least `cutoff`.
pub fn with_holes(loaded: &LoadedScene, cutoff: f32) -> Arc<LoadedScene> {
    const TEXELS: u32 = 256;
    let row: Vec<[u8; 4]> = (0..TEXELS).map(|alpha| [255, 255, 255, alpha as u8]).collect();
    let texture = Arc::new(Texture { size_px: [TEXELS, 1], rgba8: row });
    let mut loaded = loaded.clone();
    for file in loaded.meshes.values_mut() {
        let mut cut = MeshFile::clone(file);
        cut.materials[0].texture = Some(Arc::clone(&texture));
        cut.materials[0].cutoff = Some(cutoff);
        *file = cut.into();
    }
    loaded.into()
}

/// A mesh with its vertices moved by `by`, and with normals computed from its faces.
pub fn moved(mesh: &TriangleMesh, by: impl Fn(DVec3) -> DVec3) -> TriangleMesh {
    let positions: Vec<Vec3> = mesh.positions.iter().map(|at| by(at.as_dvec3()).as_vec3()).collect();
    let mut normals = vec![Vec3::ZERO; positions.len()];
    for corners in &mesh.triangles {
        let [a, b, c] = corners.map(|vertex| positions[vertex as usize]);
        corners.iter().for_each(|&vertex| normals[vertex as usize] += (b - a).cross(c - a));
    }
    let normals = normals.iter().map(|normal| normal.normalize_or(Vec3::Y)).collect();
    TriangleMesh { positions, normals, ..mesh.clone() }
}

/// Gives a scene's first object the first mesh, and adds the second mesh as `target.obj`. The object morphs into it if
/// its `morph` names `target.obj`.
pub fn morphing(scene: Scene, [mesh, target]: [TriangleMesh; 2]) -> Arc<LoadedScene> {
    let mut loaded = LoadedScene::clone(&loaded(scene, [mesh]));
    let mut file = MeshFile::clone(loaded.meshes.values().next().expect("the scene has an object"));
    file.mesh = target;
    loaded.meshes.insert("target.obj".to_owned(), file.into());
    Arc::new(loaded)
}

/// The same scene with every mesh textured with cells of random grey, so that each stroke differs from its neighbours.
pub fn speckled(loaded: &LoadedScene) -> Arc<LoadedScene> {
    let size_px = [128, 64];
    let cell = |index: u32| {
        let grey = 40 + (impasto_core::hash::scramble(index) >> 24) as u8 / 2 + 40;
        [grey, grey, grey, 255]
    };
    let texture = Arc::new(Texture { size_px, rgba8: (0..size_px[0] * size_px[1]).map(cell).collect() });
    let mut speckled = loaded.clone();
    for file in speckled.meshes.values_mut() {
        let mut textured = MeshFile::clone(file);
        for material in &mut textured.materials {
            material.color = [1.0; 3];
            material.texture = Some(Arc::clone(&texture));
        }
        *file = Arc::new(textured);
    }
    Arc::new(speckled)
}
