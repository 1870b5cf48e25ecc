//! Tests of point caches: vertices stand where the file says, also if the object is placed elsewhere, held for several
//! frames, or shares its mesh. A cache that does not fit is refused, and one that is lost later is reported.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;
use std::time::Duration;

use glam::{DMat3, DVec3, Vec3};
use impasto_core::sampling::Particle;
use impasto_editor::rendering::Rendering;
use impasto_editor_model::document::Document;
use impasto_editor_model::render_settings::{Outcome, RenderDriver, RenderSettings};
use impasto_measure::{MeasureOptions, Metric, measure};
use impasto_painting::{FrameOptions, Painting, prepare};
use impasto_scene::document::Up;
use impasto_scene::load::{LoadOptions, load};
use impasto_tests::command::{impasto, root};

/// A plate of a square and a triangle that lies on it. Points 0 and 4 coincide, and no face has both.
const PLATE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 0\ng square\nf 1 2 3 4\ng triangle\nf 5 2 3\n";

/// The points of the plate at rest.
const REST: [[f32; 3]; 5] =
    [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.0]];

/// Writes the plate, a cache for it, and a scene of these objects. Returns the scene's path.
fn scene(folder: &Path, cache: &[u8], objects: &str) -> PathBuf {
    std::fs::write(folder.join("plate.obj"), PLATE).expect("written");
    std::fs::write(folder.join("plate.pc2"), cache).expect("written");
    let text = format!(
        "(version: 1, size: (64, 36), camera: (keys: [(frame: 0, eye: (0.5, 0.5, 3), target: (0.5, 0.5, 0))]), \
         timeline: (last: 4), objects: [{objects}])"
    );
    let path = folder.join("scene.ron");
    std::fs::write(&path, text).expect("written");
    path
}

/// An object that the cache moves, with further fields.
fn moved(name: &str, fields: &str) -> String {
    format!("(name: \"{name}\", mesh: \"plate.obj\", cache: \"plate.pc2\", {fields}),")
}

fn prepared(path: &Path) -> Painting {
    let loaded = load(path, &LoadOptions::default()).unwrap_or_else(|report| panic!("{report}"));
    prepare(Arc::new(loaded)).expect("good")
}

fn pc2(samples: &[Vec<[f32; 3]>], claimed: i32) -> Vec<u8> {
    let mut bytes = b"POINTCACHE2\0".to_vec();
    bytes.extend(1i32.to_le_bytes().into_iter().chain(claimed.to_le_bytes()));
    bytes.extend(0f32.to_le_bytes().into_iter().chain(2f32.to_le_bytes()));
    bytes.extend((samples.len() as i32).to_le_bytes());
    bytes.extend(samples.iter().flatten().flatten().flat_map(|number| number.to_le_bytes()));
    bytes
}

/// A cache of samples at frames 0, 2 and 4, in which every point has gone up by these heights.
fn raised(heights: [[f32; 5]; 3]) -> Vec<u8> {
    let raise = |heights: [f32; 5]| {
        REST.iter().zip(heights).map(|([x, y, z], height)| [*x, *y, z + height]).collect()
    };
    pc2(&heights.map(raise), 5)
}

/// Points 0 and 4 move apart, and the others stay.
const PARTING: [[f32; 5]; 3] = [[0.0; 5], [1.0, 0.0, 0.0, 0.0, -1.0], [2.0, 0.0, 0.0, 0.0, -2.0]];

/// Where each point of the file is at a frame, taken from the vertices of an object.
fn points(painting: &Painting, object: usize, frame: f64) -> [Vec3; 5] {
    let positions = painting.surface(object).positions_at(&painting.shapes_at(frame)[object]);
    let file = &painting.loaded().meshes["plate.obj"];
    let of_vertex = &file.points.as_ref().expect("a cache moves it").of_vertex;
    assert_eq!(positions.len(), of_vertex.len());
    std::array::from_fn(|point| {
        let mut found = of_vertex.iter().zip(&positions).filter(|(of, _)| **of == point as u32);
        let (_, at) = found.next().expect("a vertex at the point");
        assert!(found.all(|(_, other)| other == at), "the vertices of a point lie apart");
        *at
    })
}

fn heights(painting: &Painting, object: usize, frame: f64) -> [f32; 5] {
    points(painting, object, frame).map(|at| at.z)
}

#[test]
fn a_cache_moves_the_points_of_its_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let painting = prepared(&scene(folder.path(), &raised(PARTING), &moved("plate", "")));
    for (frame, height) in [(0.0, 0.0), (1.0, 0.5), (2.0, 1.0), (3.0, 1.5), (4.0, 2.0)] {
        assert_eq!(heights(&painting, 0, frame), [height, 0.0, 0.0, 0.0, -height]);
    }
    assert_eq!(painting.faults(), Vec::<String>::new());
}

/// The deformation gradient at a point of the file.
fn gradient(painting: &Painting, point: u32, frame: f64) -> DMat3 {
    let mesh = &painting.surface(0).mesh;
    let of_vertex = &painting.loaded().meshes["plate.obj"].points.as_ref().expect("points").of_vertex;
    let is_there = |vertex: &u32| of_vertex[*vertex as usize] == point;
    let triangle = mesh.triangles.iter().position(|corners| corners.iter().any(is_there)).expect("a face");
    let corner = mesh.triangles[triangle].iter().position(is_there).expect("a corner");
    let barycentric = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]][corner];
    let (position, normal) = (Vec3::ZERO, Vec3::Z);
    let place = Particle { triangle: triangle as u32, barycentric, flipped: false, position, normal };
    painting.carried(0, &place, frame).expect("it is bent").gradient
}

/// Where two sheets lie on each other at rest, the gradient of each depends on its own edges alone.
#[test]
fn points_that_part_have_their_own_gradient() {
    let folder = tempfile::tempdir().expect("a folder");
    let painting = prepared(&scene(folder.path(), &raised(PARTING), &moved("plate", "")));
    let mesh = &painting.surface(0).mesh;
    assert!(mesh.normals.iter().all(|normal| *normal == Vec3::Z), "the faces look different ways");
    // Point 4 has one triangle, with points 1 and 2. They stay while point 4 goes down.
    let below = gradient(&painting, 4, 2.0);
    assert!(below.x_axis.abs_diff_eq(DVec3::new(1.0, 0.0, 1.0), 1e-5), "{below}");
    assert!(below.y_axis.abs_diff_eq(DVec3::Y, 1e-5), "{below}");
    // Point 0 goes up: all steps from it lead down.
    let above = gradient(&painting, 0, 2.0);
    assert!(above.x_axis.z < -0.4 && above.y_axis.z < -0.4, "{above}");
}

#[test]
fn objects_that_share_a_mesh_have_each_their_own_motion() {
    let folder = tempfile::tempdir().expect("a folder");
    let objects = [
        moved("a", ""),
        moved("b", "keys: [(frame: 0, translation: (2, 0, 0))]"),
        "(name: \"still\", mesh: \"plate.obj\"),".to_owned(),
        moved("on twos", "hold: 2"),
    ];
    let painting = prepared(&scene(folder.path(), &raised(PARTING), &objects.concat()));
    for (frame, held) in [(0.0, 0.0), (1.0, 0.0), (1.5, 0.0), (2.0, 1.0), (3.5, 1.0), (4.0, 2.0)] {
        let now = [frame as f32 / 2.0, 0.0, 0.0, 0.0, frame as f32 / -2.0];
        assert_eq!((heights(&painting, 0, frame), heights(&painting, 1, frame)), (now, now), "frame {frame}");
        assert_eq!(heights(&painting, 2, frame), [0.0; 5], "frame {frame}");
        assert_eq!(heights(&painting, 3, frame), [held, 0.0, 0.0, 0.0, -held], "frame {frame}");
        let bent = painting.bent_at(frame);
        let stands: Vec<bool> = bent.iter().map(Option::is_some).collect();
        assert_eq!(stands, [true, true, false, true], "frame {frame}");
    }
    assert!(Arc::ptr_eq(painting.surface(0), painting.surface(1)), "twins do not share their surface");
}

#[test]
fn a_rest_frame_is_the_shape_in_which_strokes_are_laid() {
    let folder = tempfile::tempdir().expect("a folder");
    let raise = [[0.0; 5], [0.5, 0.0, 0.0, 0.5, 0.5], [1.0, 0.0, 0.0, 1.0, 1.0]];
    let painting = prepared(&scene(folder.path(), &raised(raise), &moved("plate", "rest: Frame(2)")));
    let mesh = &painting.surface(0).mesh;
    // A plane that rises to the left.
    let slope = Vec3::new(0.5, 0.0, 1.0).normalize();
    for (at, normal) in mesh.positions.iter().zip(&mesh.normals) {
        assert_eq!(at.z, 0.5 - 0.5 * at.x);
        assert!(normal.abs_diff_eq(slope, 1e-6), "{normal}");
    }
    let is_bent = |frame: f64| painting.bent_at(frame)[0].is_some();
    assert_eq!([0.0, 2.0, 4.0].map(is_bent), [true, false, true]);
    for (frame, height) in [(0.0, 0.0), (2.0, 0.5), (4.0, 1.0)] {
        assert_eq!(heights(&painting, 0, frame), [height, 0.0, 0.0, height, height]);
    }
    let down = gradient(&painting, 3, 0.0);
    let step = down * DVec3::new(1.0, 0.0, -0.5);
    assert!(step.abs_diff_eq(DVec3::X, 1e-5), "a step along the slope is not level at frame 0: {step}");
}

#[test]
fn a_cache_is_placed_as_its_mesh_is() {
    let folder = tempfile::tempdir().expect("a folder");
    let fields = "scale: (2, 3, 0.5), up: Z";
    let painting = prepared(&scene(folder.path(), &raised(PARTING), &moved("plate", fields)));
    let place = DMat3::from_diagonal(DVec3::new(2.0, 3.0, 0.5)) * Up::Z.y_up_from_file();
    for (frame, height) in [(0.0, 0.0), (2.0, 1.0), (4.0, 2.0)] {
        for (point, at) in points(&painting, 0, frame).into_iter().enumerate() {
            let [x, y, _] = REST[point];
            let z = [height, 0.0, 0.0, 0.0, -height][point];
            let expected = (place * Vec3::new(x, y, z).as_dvec3()).as_vec3();
            assert!(at.abs_diff_eq(expected, 1e-6), "point {point} at frame {frame}: {at} {expected}");
        }
    }
    // Up from the plate is Y in the scene, scaled by 3.
    assert_eq!(points(&painting, 0, 2.0)[0], Vec3::new(0.0, 3.0, 0.0));
}

#[test]
fn a_group_of_a_mesh_is_moved_by_the_cache_of_the_whole() {
    let folder = tempfile::tempdir().expect("a folder");
    let painting = prepared(&scene(folder.path(), &raised(PARTING), &moved("plate", "group: \"triangle\"")));
    let surface = painting.surface(0);
    assert_eq!(surface.mesh.triangles.len(), 1);
    let bent = painting.bent_at(4.0)[0].clone().expect("it is bent");
    let mut heights = surface.mesh.triangles[0].map(|vertex| bent.vertices.positions[vertex as usize].z);
    heights.sort_by(f32::total_cmp);
    assert_eq!(heights, [-2.0, 0.0, 0.0]);
    assert!(gradient(&painting, 4, 2.0).x_axis.abs_diff_eq(DVec3::new(1.0, 0.0, 1.0), 1e-5));
    painting.at(3.0, &FrameOptions::new([64, 36]));
    assert_eq!(painting.faults(), Vec::<String>::new());
}

/// A mesh without a scene is read before it is known that a cache moves it.
#[test]
fn a_mesh_without_a_scene_may_be_given_a_cache() {
    let folder = tempfile::tempdir().expect("a folder");
    scene(folder.path(), &raised(PARTING), "");
    let overrides = vec![("objects[0].cache".to_owned(), "plate.pc2".to_owned())];
    let options = LoadOptions { overrides, ..LoadOptions::default() };
    let loaded = load(&folder.path().join("plate.obj"), &options).unwrap_or_else(|report| panic!("{report}"));
    assert!(loaded.meshes["plate.obj"].points.is_some());
    assert_eq!(loaded.caches["plate.pc2"].count(), 5);
}

#[test]
fn a_cache_that_does_not_fit_is_refused_with_its_place() {
    let folder = tempfile::tempdir().expect("a folder");
    let sample = |count: usize| vec![vec![[0.0; 3]; count]; 2];
    let far = vec![vec![[0.0; 3]; 5], vec![[0.0, 2e9, 0.0]; 5]];
    for (bytes, expected) in [
        (pc2(&sample(4), 4), "plate.pc2 moves 4 points, but plate.obj has 5"),
        (pc2(&sample(5), 6), "cut short"),
        (pc2(&sample(5), 1_000_000_000), "cut short"),
        (pc2(&sample(5), 4), "more behind"),
        (b"POINTCACHE2\0 no".to_vec(), "no PC2 file"),
        (pc2(&[vec![[f32::NAN; 3]; 5]], 5), "point 0 of sample 0"),
        (pc2(&far, 5), "point 0 of sample 1"),
    ] {
        let path = scene(folder.path(), &bytes, &moved("plate", ""));
        let report = load(&path, &LoadOptions::default()).expect_err(expected).to_string();
        assert!(report.contains(expected), "{report}");
        assert!(report.contains("plate.pc2"), "{report}");
    }
    std::fs::remove_file(folder.path().join("plate.pc2")).expect("removed");
    let report = load(&folder.path().join("scene.ron"), &LoadOptions::default()).unwrap_err().to_string();
    assert!(report.contains("scene.ron:1:") && report.contains("not found"), "{report}");
}

fn errors(path: &Path) -> Vec<String> {
    let report = load(path, &LoadOptions::default()).expect_err("it is refused");
    report.0.iter().filter(|problem| problem.severity.is_fatal()).map(ToString::to_string).collect()
}

#[test]
fn a_cache_is_refused_where_it_can_not_go_with_the_mesh() {
    let folder = tempfile::tempdir().expect("a folder");
    let glb = moved("plate", "").replace("plate.obj", "parade.glb#Face");
    let path = scene(folder.path(), &raised(PARTING), &glb);
    std::fs::copy(root().join("scenes/meshes/parade.glb"), folder.path().join("parade.glb")).expect("copied");
    let told = errors(&path);
    assert!(told.len() == 1 && told[0].contains("does not say which points a cache moves"), "{told:?}");

    let path = scene(folder.path(), &raised(PARTING), &moved("plate", ""));
    let tiny = PLATE.replace("v 1 ", "v 1e-8 ").replace("1 0\n", "1e-8 0\n");
    std::fs::write(folder.path().join("plate.obj"), tiny).expect("written");
    let told = errors(&path);
    assert!(told.len() == 1 && told[0].contains("1e-8 across"), "{told:?}");
    assert!(told[0].contains("its point cache not"), "{told:?}");
}

/// Cuts the cache of a scene short, after the scene was read.
fn cut(folder: &Path) {
    let file = std::fs::OpenOptions::new().write(true).open(folder.join("plate.pc2"));
    file.and_then(|file| file.set_len(40)).expect("cut");
}

#[test]
fn a_cache_that_is_lost_later_leaves_the_body_at_rest_and_is_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = scene(folder.path(), &pc2(&vec![vec![[0.5; 3]; 5]; 3], 5), &moved("plate", ""));
    let painting = prepared(&path);
    cut(folder.path());
    let positions = painting.surface(0).positions_at(&painting.shapes_at(2.0)[0]);
    assert_eq!(positions, painting.surface(0).mesh.positions);
    assert!(painting.faults()[0].contains("plate.pc2, at frame 2"), "{:?}", painting.faults());
    assert!(painting.fault_words().is_some_and(|words| words.contains("plate.pc2, at frame 2")));
}

#[test]
fn a_cache_that_is_lost_before_the_rest_is_made_is_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = scene(folder.path(), &raised(PARTING), &moved("plate", "rest: Frame(2)"));
    let loaded = load(&path, &LoadOptions::default()).unwrap_or_else(|report| panic!("{report}"));
    cut(folder.path());
    let painting = prepare(Arc::new(loaded)).expect("good");
    assert!(painting.faults()[0].contains("plate.pc2, at frame 2"), "{:?}", painting.faults());
}

#[test]
fn faults_of_several_bodies_are_told_once_each() {
    let folder = tempfile::tempdir().expect("a folder");
    // Not twins: each has a surface of its own.
    let objects = [moved("a", "scale: 1"), moved("b", "scale: 2, hold: 4"), moved("c", "scale: 3")];
    let painting = prepared(&scene(folder.path(), &raised(PARTING), &objects.concat()));
    cut(folder.path());
    painting.at(2.5, &FrameOptions::new([64, 36]));
    let faults = painting.faults();
    assert_eq!(faults.len(), 2, "{faults:?}");
    assert!(faults[0].contains("at frame 0") && faults[1].contains("at frame 2.5"), "{faults:?}");
}

/// Rendering from the editor fails, and measuring warns, if a cache was lost after the scene was read.
#[test]
fn who_draws_frames_tells_of_a_lost_cache() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = scene(folder.path(), &raised(PARTING), &moved("plate", ""));
    let document = Document::open(&path, &LoadOptions::default()).unwrap_or_else(|report| panic!("{report}"));
    let loaded = Arc::new(load(&path, &LoadOptions::default()).expect("good"));
    cut(folder.path());
    let settings = RenderSettings {
        output: folder.path().join("f_##.png").to_string_lossy().into_owned(),
        driver: RenderDriver::Osmesa,
        ..RenderSettings::of(document.scene())
    };
    let rendering =
        Rendering::start(settings.plan(&document, 2.0).unwrap(), Default::default(), || ()).unwrap();
    assert!(rendering.wait(Duration::from_secs(120)));
    let outcome = rendering.progress().outcome;
    let Some(Outcome::Failed(words)) = &outcome else { panic!("{outcome:?}") };
    assert!(words.contains("plate.pc2, at frame"), "{words}");

    let options = MeasureOptions { metrics: vec![Metric::M13], ..MeasureOptions::default() };
    let report = measure(&loaded, &options, &mut |_| ()).expect("measured");
    assert!(
        report.warnings.iter().any(|words| words.contains("plate.pc2, at frame")),
        "{:?}",
        report.warnings
    );
}

/// When a cache this long is loaded, only some of its samples are checked. The second is not one of them.
#[test]
fn commands_tell_of_a_sample_that_is_no_shape() {
    const SAMPLES: i32 = 4_500_000;
    let folder = tempfile::tempdir().expect("a folder");
    let mut cache = pc2(&[vec![[0.0; 3]; 5], vec![[f32::NAN; 3]; 5]], 5);
    cache[28..32].copy_from_slice(&SAMPLES.to_le_bytes());
    scene(folder.path(), &cache, &moved("plate", ""));
    let file = std::fs::OpenOptions::new().write(true).open(folder.path().join("plate.pc2"));
    file.and_then(|file| file.set_len(32 + 60 * SAMPLES as u64)).expect("a hole in a file takes no room");
    for arguments in [
        &["render", "scene.ron", "-o", "f_#.png", "--frames", "2"][..],
        &["strokes", "scene.ron", "--frame", "2", "-o", "strokes.csv"],
    ] {
        let output = Command::new(impasto()).args(arguments).current_dir(folder.path()).output().unwrap();
        let told = String::from_utf8_lossy(&output.stderr);
        assert!(!output.status.success(), "{arguments:?}");
        assert!(
            told.contains("plate.pc2, at frame") && told.contains("point 0 of sample 1 is at"),
            "{arguments:?}: {told}"
        );
    }
    assert!(folder.path().join("f_2.png").exists() && folder.path().join("strokes.csv").exists());
}
