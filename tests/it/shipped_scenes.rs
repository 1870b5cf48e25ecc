//! Tests of the shipped scenes: each loads without a message and is saved as an equal scene, and the source paper's
//! three models have the counts of polygons and particles that it states.

use std::path::{Path, PathBuf};

use impasto_scene::load::{LoadOptions, load, parse};
use impasto_scene::save::to_ron;
use impasto_tests::command::root;
use impasto_tests::scenes as shared;

fn scenes(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let mut scenes: Vec<PathBuf> =
        entries.filter(|path| path.extension().is_some_and(|end| end == "ron")).collect();
    scenes.sort();
    assert!(scenes.len() >= 10, "{} scenes", scenes.len());
    scenes
}

#[test]
fn every_scene_loads_without_a_word_and_is_saved_equal() {
    for path in scenes(&root().join("scenes")) {
        let loaded = load(&path, &LoadOptions::default()).unwrap_or_else(|report| panic!("{report}"));
        assert_eq!(loaded.warnings, [], "{}", path.display());
        let text = to_ron(&loaded.scene);
        assert_eq!(parse(&path, &text).unwrap(), loaded.scene.without_shot(), "{}", path.display());
        assert_eq!(to_ron(&parse(&path, &text).unwrap()), text);
    }
}

#[test]
fn scenes_work_wherever_their_folder_lies() {
    let moved = tempfile::tempdir().unwrap();
    let to = moved.path().join("a folder with spaces");
    for folder in ["", "meshes"] {
        std::fs::create_dir_all(to.join(folder)).unwrap();
        for entry in std::fs::read_dir(root().join("scenes").join(folder)).unwrap() {
            let from = entry.unwrap().path();
            if from.is_file() {
                std::fs::copy(&from, to.join(folder).join(from.file_name().unwrap())).unwrap();
            }
        }
    }
    for path in scenes(&to) {
        load(&path, &LoadOptions::default()).unwrap_or_else(|report| panic!("{report}"));
    }
}

#[test]
fn the_papers_three_scenes_have_the_papers_counts() {
    for (name, polygons, particles) in
        [("apple", 550, 45_658), ("fish", 8_618, 90_213), ("simple_objects", 3_978, 355_467)]
    {
        let painting = shared::painting(name);
        let loaded = painting.loaded();
        let mesh = format!("meshes/{name}.obj");
        assert_eq!(loaded.meshes[&mesh].mesh.polygon_count(), polygons, "{name}");
        let objects = loaded.scene.objects.iter().zip(painting.particle_counts());
        let sum: usize = objects.filter(|(object, _)| object.mesh == mesh).map(|(_, count)| count).sum();
        assert_eq!(sum, particles, "{name}");
    }
}
