//! Tests of paintings kept on disk: a kept painting equals, bit for bit, one prepared from nothing, and only undamaged
//! bytes of the same scene are ever taken.

use std::collections::HashMap;
use std::path::Path;
use std::process::{Command, Output};
use std::sync::{Arc, Mutex};

use glam::Vec3;
use impasto_core::TriangleMesh;
use impasto_painting::{
    FindKept, FrameOptions, Kept, KeptBytes, KeptKey, Painting, PrepareOptions, Preparer, SeenFrom,
};
use impasto_scene::document::{Solver, Style};
use impasto_scene::load::{LoadOptions, load};
use impasto_scene::loaded::LoadedScene;
use impasto_scene::mesh_file::Texture;
use impasto_scene::motion::{self, CameraPose};
use impasto_tests::command::{impasto, root};
use impasto_tests::shapes;

use crate::warm_prepare::{Version, versions};

const OPTIONS: FrameOptions = FrameOptions::new([320, 240]);

/// Kept paintings in memory, by their keys: stands for the folder of `--cache`.
#[derive(Default)]
struct Shelf(Mutex<HashMap<KeptKey, Vec<u8>>>);

impl Shelf {
    /// Prepares a scene, taking a kept painting from here if there is one, and keeps what was made.
    fn prepare(&self, preparer: &mut Preparer, loaded: &Arc<LoadedScene>) -> Painting {
        let find = |key: &KeptKey| boxed(self.0.lock().unwrap().get(key).cloned());
        let painting = prepare_with(preparer, loaded, &find);
        if let Kept::NotThere(key) = painting.kept() {
            self.0.lock().unwrap().insert(*key, bytes(&painting, key));
        }
        painting
    }
}

fn boxed(bytes: Option<Vec<u8>>) -> Option<Box<dyn KeptBytes>> {
    bytes.map(|bytes| Box::new(bytes) as Box<dyn KeptBytes>)
}

fn prepare_with(preparer: &mut Preparer, loaded: &Arc<LoadedScene>, find: &FindKept<'_>) -> Painting {
    let options = PrepareOptions { kept: Some(find), ..PrepareOptions::default() };
    preparer.prepare_with(Arc::clone(loaded), &options).unwrap()
}

fn bytes(painting: &Painting, key: &KeptKey) -> Vec<u8> {
    let (to_keep, mut bytes) = (painting.to_keep().unwrap(), Vec::new());
    to_keep.write(key, &mut bytes).unwrap();
    assert_eq!(to_keep.bytes(), bytes.len() as u64);
    bytes
}

fn is_taken(painting: &Painting) -> bool {
    matches!(painting.kept(), Kept::Taken(..))
}

/// Asserts that two paintings have the same counts, areas, singularities and poles, and the same strokes, marks and
/// finish at these frames.
fn assert_same(what: &str, a: &Painting, b: &Painting, frames: &[f64]) {
    assert_eq!(a.particle_counts(), b.particle_counts(), "{what}");
    for object in 0..a.particle_counts().len() {
        assert_eq!(a.singularities(object), b.singularities(object), "{what}");
        assert_eq!(a.surface_area(object).to_bits(), b.surface_area(object).to_bits(), "{what}");
        assert_eq!(a.poles(object), b.poles(object), "{what}");
    }
    for &frame in frames {
        let [a, b] = [a, b].map(|painting| painting.at(frame, &OPTIONS));
        assert!(a.strokes.len() > 50, "{what} at {frame}: only {} strokes", a.strokes.len());
        let [of_a, of_b] = [&a, &b].map(|frame| bytemuck::cast_slice::<_, u8>(&frame.strokes));
        assert!(of_a == of_b, "{what} at {frame}: strokes differ");
        assert!(a.sources == b.sources && a.layers == b.layers, "{what} at {frame}: sources differ");
        assert!(a.brushes == b.brushes, "{what} at {frame}: marks differ");
        assert_eq!((a.finish, &a.palettes), (b.finish, &b.palettes), "{what} at {frame}");
    }
}

#[test]
fn what_is_kept_equals_what_is_prepared_and_every_edit_has_a_key_of_its_own() {
    let shelf = Shelf::default();
    let mut before: Option<(KeptKey, &'static str)> = None;
    for Version { name, loaded, cold } in versions() {
        let made = shelf.prepare(&mut Preparer::default(), loaded);
        let key = match made.kept() {
            Kept::NotThere(key) | Kept::Taken(key, _) => *key,
            other => panic!("{name}: {other:?}"),
        };
        // What was kept of an earlier version is taken only for the version `nothing`, whose edit changes nothing.
        assert_eq!(is_taken(&made), *name == "nothing", "{name}");
        assert_eq!(before.is_some_and(|(other, _)| other == key), *name == "nothing", "{name}");
        before = Some((key, name));
        assert_same(name, &made, cold, &[0.0]);
        let taken = shelf.prepare(&mut Preparer::default(), loaded);
        assert!(is_taken(&taken), "{name}: {:?}", taken.kept());
        assert_same(name, &taken, cold, &[0.0, 7.5]);
        // A painting that was taken is written again as the same bytes.
        assert_eq!(bytes(&taken, &key), shelf.0.lock().unwrap()[&key], "{name}");
    }
}

#[test]
fn edits_after_a_start_from_what_was_kept_give_the_same_bits() {
    let shelf = Shelf::default();
    // Every third edit only: `warm_prepare` tries them all, without kept paintings.
    for pair in versions().windows(2).step_by(3) {
        let [start, next] = pair else { continue };
        shelf.prepare(&mut Preparer::default(), &start.loaded);
        let mut preparer = Preparer::default();
        assert!(is_taken(&shelf.prepare(&mut preparer, &start.loaded)));
        let edited = preparer.prepare(Arc::clone(&next.loaded)).unwrap();
        assert_same(next.name, &edited, &next.cold, &[7.5]);
    }
    // A preparer that knows another state can take a kept painting too, and prepare further edits from it.
    let [first, second, third] = [0, 8, 9].map(|index| &versions()[index]);
    let mut preparer = Preparer::default();
    preparer.prepare(Arc::clone(&first.loaded)).unwrap();
    shelf.prepare(&mut Preparer::default(), &second.loaded);
    assert!(is_taken(&shelf.prepare(&mut preparer, &second.loaded)));
    let edited = preparer.prepare(Arc::clone(&third.loaded)).unwrap();
    assert_same(third.name, &edited, &third.cold, &[7.5]);
}

/// A shipped scene whose strokes are five times as large, and so fewer, except where their region states their size.
fn shipped(name: &str, set: &[(&str, &str)]) -> Arc<LoadedScene> {
    let set = set.iter().chain(&[("strokes.scale", "5")]);
    let overrides = set.map(|&(path, value)| (path.to_owned(), value.to_owned())).collect();
    let options = LoadOptions { overrides, ..LoadOptions::default() };
    Arc::new(load(&root().join(format!("scenes/{name}.ron")), &options).unwrap())
}

#[test]
fn ink_morphs_noise_joints_caches_shots_and_every_solver_come_back_as_they_were() {
    let horn = [("style", "RotatingStrokes(solver: Horn)")];
    for (name, set, frame) in [
        ("sumi_e_apple", &[][..], 3.0),
        ("morph", &[], 20.0),
        ("explosion", &[], 11.0),
        ("parade", &[], 13.0),
        ("parade", &horn, 13.0),
        ("lane", &[], 5.0),
        ("morph", &[("strokes.preset", "\"paper\"")], 20.0),
    ] {
        let loaded = shipped(name, set);
        let shelf = Shelf::default();
        let made = shelf.prepare(&mut Preparer::default(), &loaded);
        // Read again, as another process does.
        let taken = shelf.prepare(&mut Preparer::default(), &shipped(name, set));
        assert!(!is_taken(&made) && is_taken(&taken), "{name}: {:?}", taken.kept());
        assert_same(name, &taken, &made, &[0.0, frame]);
        assert_same(name, &taken, &impasto_painting::prepare(loaded).unwrap(), &[frame]);
    }
}

/// Eight squares lie on each other: of 9,000 or more particles that are asked for, only 10 to 25 % find room. Long
/// before the last particle, ordinals (places in the progressive order) are no longer indices.
#[test]
fn faces_on_each_other_come_back_as_they_were_and_are_edited_to_the_same_bits() {
    let mut pile = TriangleMesh::default();
    for square in 0..8u32 {
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        pile.positions.extend(corners.map(|[x, y]| Vec3::new(x, y, 0.0)));
        pile.normals.extend([Vec3::Z; 4]);
        pile.triangles.extend([[0, 1, 2], [0, 2, 3]].map(|face| face.map(|corner| 4 * square + corner)));
    }
    let loaded = |particles: u64| {
        let mut scene = shapes::scene(vec![shapes::object("pile", particles)]);
        scene.strokes.layers = shapes::body_layer_alone();
        shapes::loaded(scene, [pile.clone()])
    };
    let (shelf, mut preparer) = (Shelf::default(), Preparer::default());
    for particles in [20_000, 20_001, 9000, 30_000, 29_999, 1500] {
        let loaded = loaded(particles);
        let cold = shelf.prepare(&mut Preparer::default(), &loaded);
        let taken = shelf.prepare(&mut Preparer::default(), &loaded);
        assert!(!is_taken(&cold) && is_taken(&taken), "{particles}: {:?}", taken.kept());
        assert_same("taken", &taken, &cold, &[0.0]);
        let edited = preparer.prepare(loaded).unwrap();
        assert_same("edited", &edited, &cold, &[0.0]);
        let share = cold.particle_total() as f64 / particles as f64;
        assert!(particles < 2000 || (0.1..0.25).contains(&share), "{particles}: {share}");
    }
}

#[test]
fn a_mesh_a_texture_and_a_brush_that_change_change_the_key() {
    let start = shapes::speckled(&small(Solver::Tangent));
    let key =
        |loaded: &Arc<LoadedScene>| match Shelf::default().prepare(&mut Preparer::default(), loaded).kept() {
            Kept::NotThere(key) => *key,
            other => panic!("{other:?}"),
        };
    let own = key(&start);
    assert_eq!(own, key(&Arc::new(LoadedScene::clone(&start))));
    let mut moved = LoadedScene::clone(&start);
    let mesh = moved.meshes.values_mut().next().unwrap();
    let vertex = &mut Arc::make_mut(mesh).mesh.positions[3].x;
    *vertex = f32::from_bits(vertex.to_bits() + 1);
    let mut painted = LoadedScene::clone(&start);
    let mesh = painted.meshes.values_mut().next().unwrap();
    Arc::make_mut(mesh).materials[0].color[0] *= 0.99;
    let mut elsewhere = LoadedScene::clone(&start);
    elsewhere.path = "/elsewhere/scene.ron".into();
    let mut textured = LoadedScene::clone(&start);
    let mesh = textured.meshes.values_mut().next().unwrap();
    let texture = &mut Arc::make_mut(mesh).materials[0].texture;
    let Texture { size_px, rgba8 } = &**texture.as_ref().unwrap();
    let mut rgba8 = rgba8.clone();
    rgba8[1][2] ^= 1;
    *texture = Some(Arc::new(Texture { size_px: *size_px, rgba8 }));
    let mut brushed = LoadedScene::clone(&start);
    let brush = |grey: u8| Arc::new(Texture { size_px: [2, 1], rgba8: vec![[0; 4], [grey; 4]] });
    brushed.brushes.insert("mark.png".to_owned(), brush(255));
    let with_brush = key(&Arc::new(brushed.clone()));
    brushed.brushes.insert("mark.png".to_owned(), brush(254));
    assert_ne!(with_brush, key(&Arc::new(brushed)));
    assert_ne!(own, with_brush);
    assert_ne!(own, key(&Arc::new(textured)));
    assert_ne!(own, key(&Arc::new(moved)));
    assert_ne!(own, key(&Arc::new(painted)));
    assert_eq!(own, key(&Arc::new(elsewhere)), "where the file lies does not matter");
}

/// A scene that is prepared quickly. With `Solver::Horn`, lists of neighbours are kept too.
fn small(solver: Solver) -> Arc<LoadedScene> {
    let mut scene = shapes::scene(vec![shapes::object("ball", 120)]);
    scene.style = Style::default();
    if let Style::RotatingStrokes(settings) = &mut scene.style {
        settings.solver = solver;
    }
    scene.strokes = Default::default();
    (scene.strokes.length_px, scene.strokes.width_px) = (Some(60.0), Some(30.0));
    shapes::loaded(scene, [shapes::sphere(12, 6)])
}

/// A kept painting is taken only for the further cameras and the margin round the picture for which it was made.
#[test]
fn what_further_cameras_and_wider_pictures_need_has_a_key_of_its_own() {
    let loaded = small(Solver::Tangent);
    let camera = |x: f64| {
        let mut pose = motion::camera_at(&loaded.scene, 0.0);
        pose.eye.x += x;
        [(pose, 0.0)]
    };
    let key = |seen_from: SeenFrom<'_>| {
        let options = PrepareOptions { kept: Some(&|_| None), seen_from, ..PrepareOptions::default() };
        let painting = Preparer::default().prepare_with(Arc::clone(&loaded), &options).unwrap();
        let Kept::NotThere(key) = painting.kept() else { panic!("it could be kept") };
        *key
    };
    let shot = |also: &[(CameraPose, f64)], margin: f64| key(SeenFrom::Shot { also, margin });
    let keys = [
        key(SeenFrom::SHOT),
        shot(&camera(0.5), SeenFrom::MARGIN),
        shot(&camera(1.5), SeenFrom::MARGIN),
        shot(&[], 3.0),
        shot(&camera(0.5), 3.0),
    ];
    for (index, key) in keys.iter().enumerate() {
        assert!(!keys[..index].contains(key), "key {index}");
    }
    assert!(keys[1] == shot(&camera(0.5), SeenFrom::MARGIN));
}

#[test]
fn bytes_that_are_cut_changed_or_foreign_are_made_anew() {
    let loaded = small(Solver::Horn);
    let cold = impasto_painting::prepare(Arc::clone(&loaded)).unwrap();
    let first = prepare_with(&mut Preparer::default(), &loaded, &|_| None);
    let Kept::NotThere(key) = *first.kept() else { panic!("{:?}", first.kept()) };
    let whole = bytes(&first, &key);
    let mut preparer = Preparer::default();
    let mut unfit = |what: &str, bytes: Vec<u8>| {
        let painting = prepare_with(&mut preparer, &loaded, &move |_| boxed(Some(bytes.clone())));
        let Kept::Unfit(_, why) = painting.kept() else { panic!("{what}: {:?}", painting.kept()) };
        (why.clone(), painting)
    };
    for part in 0..20 {
        let (_, painting) = unfit("cut", whole[..whole.len() * part / 20].to_vec());
        assert_same("cut", &painting, &cold, &[0.0]);
    }
    let mut longer = whole.clone();
    longer.push(0);
    assert!(unfit("longer", longer).0.contains("damaged"));
    // Flipped bits: spread over all bytes, and one in every byte of the header and of the first array's length.
    let spread = (0..200).map(|number| (number * 7919 * 64 + number * 31) % (whole.len() * 8));
    for bit in spread.chain((0..88).map(|byte| byte * 8 + byte % 8)) {
        let mut flipped = whole.clone();
        flipped[bit / 8] ^= 1 << (bit % 8);
        unfit(&format!("bit {bit}"), flipped);
    }
    // Headers with a right checksum. The first is unchanged, so it is taken; the others have a wrong version, a wrong
    // key, or a claim of more arrays or bytes than there are.
    let with = |at: usize, value: &[u8]| {
        let mut bytes = whole.clone();
        bytes[at..at + value.len()].copy_from_slice(value);
        let arrays = u64::from_le_bytes(whole[56..64].try_into().unwrap()) as usize;
        bytes[72..76].fill(0);
        let crc = crc32fast::hash(&bytes[..80 + arrays * 16]);
        bytes[72..76].copy_from_slice(&crc.to_le_bytes());
        bytes
    };
    assert!(is_taken(&prepare_with(&mut Preparer::default(), &loaded, &|_| boxed(Some(with(
        0, b"impasto"
    ))))));
    assert!(unfit("version", with(16, &99u32.to_le_bytes())).0.contains("another version"));
    assert!(unfit("key", with(24, &[7; 32])).0.contains("another scene"));
    assert!(unfit("arrays", with(56, &u64::MAX.to_le_bytes())).0.contains("damaged"));
    assert!(unfit("length", with(80, &(u64::MAX - 63).to_le_bytes())).0.contains("damaged"));
    assert!(unfit("length", with(80, &(1u64 << 60).to_le_bytes())).0.contains("damaged"));
    for foreign in [b"".to_vec(), b"PNG".repeat(100), vec![0; 1 << 16], b"impasto prepared".to_vec()] {
        let (_, painting) = unfit("foreign", foreign);
        assert_same("foreign", &painting, &cold, &[0.0]);
    }
}

#[test]
fn eight_threads_take_what_is_kept_while_it_is_made() {
    let (shelf, loaded) = (Shelf::default(), small(Solver::Tangent));
    let cold = impasto_painting::prepare(Arc::clone(&loaded)).unwrap();
    std::thread::scope(|scope| {
        for _ in 0..8 {
            scope.spawn(|| {
                for _ in 0..4 {
                    let painting = shelf.prepare(&mut Preparer::default(), &loaded);
                    assert_same("at once", &painting, &cold, &[0.0]);
                }
            });
        }
    });
    assert_eq!(shelf.0.lock().unwrap().len(), 1);
}

/// Arguments that give few strokes. Regions are left out, since they state lengths, which `strokes.scale` does not
/// change.
const SMALL: [&str; 6] = ["--set", "regions=[]", "--set", "strokes.scale=4", "--size", "160x90"];

fn strokes(folder: &Path, more: &[&str]) -> Output {
    run("strokes", folder, more, "")
}

/// Runs a command on a small scene, with the environment variable `IMPASTO_CACHE` set to `variable`.
fn run(name: &str, folder: &Path, more: &[&str], variable: &str) -> Output {
    let mut command = Command::new(impasto());
    command.env("IMPASTO_CACHE", variable);
    command.arg(name).arg(root().join("scenes/touching_cubes.ron")).args(SMALL).args(more);
    command.current_dir(folder).env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY");
    let output = command.output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    output
}

fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
}

#[test]
fn eight_processes_share_one_folder() {
    let folder = tempfile::tempdir().unwrap();
    let without = strokes(folder.path(), &[]).stdout;
    assert!(without.len() > 10_000);
    let together = || {
        std::thread::scope(|scope| {
            let running: Vec<_> =
                (0..8).map(|_| scope.spawn(|| strokes(folder.path(), &["--cache", "kept"]))).collect();
            for process in running {
                let output = process.join().unwrap();
                assert!(output.stdout == without, "the strokes differ");
                assert_eq!(String::from_utf8_lossy(&output.stderr), "");
            }
        });
    };
    together();
    let kept = names(&folder.path().join("kept"));
    assert!(kept.len() == 1 && kept[0].ends_with(".prepared"), "{kept:?}");
    together();
    assert_eq!(names(&folder.path().join("kept")), kept);
    // A damaged file is replaced, with one line of warning.
    let file = folder.path().join("kept").join(&kept[0]);
    let whole = std::fs::read(&file).unwrap();
    std::fs::write(&file, &whole[..whole.len() / 2]).unwrap();
    let mended = strokes(folder.path(), &["--cache", "kept"]);
    let words = String::from_utf8_lossy(&mended.stderr);
    assert!(words.lines().count() == 1 && words.contains("made anew"), "{words}");
    assert!(mended.stdout == without && std::fs::read(&file).unwrap() == whole);
    // The environment variable can name the folder too.
    assert!(run("strokes", folder.path(), &[], "other").stdout == without);
    assert_eq!(names(&folder.path().join("other")), kept);
}

#[test]
fn a_folder_that_cannot_be_used_costs_one_line_and_no_picture() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("file"), "no folder").unwrap();
    std::fs::create_dir(folder.path().join("small")).unwrap();
    let without = strokes(folder.path(), &[]).stdout;
    for arguments in [
        &["--cache", "missing/far/away"][..],
        &["--cache", "file"],
        &["--cache", "file/below"],
        &["--cache", "small", "--cache-size", "1K"],
        &["--cache", "/proc"],
    ] {
        let output = strokes(folder.path(), arguments);
        let words = String::from_utf8_lossy(&output.stderr);
        assert!(output.stdout == without, "{arguments:?}");
        assert!(words.lines().count() == 1 && words.starts_with("warning: "), "{arguments:?}: {words}");
    }
    assert_eq!(names(&folder.path().join("small")), [""; 0]);
    // `--quiet` leaves out all but errors.
    let quiet = ["-o", "frame.png", "--cache", "missing/far/away", "--quiet"];
    let output = run("render", folder.path(), &quiet, "");
    assert_eq!(String::from_utf8_lossy(&output.stderr), "");
}
