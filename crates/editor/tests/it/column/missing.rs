//! Tests of the inspector for an object whose mesh file is missing.

use egui_kittest::kittest::Queryable as _;
use impasto_editor::files::nearby::meshes_like;
use impasto_editor::theme::Theme;
use impasto_editor_model::command::{Arrange, Command};
use impasto_editor_model::{Document, Selection};
use impasto_scene::load::LoadOptions;

use super::{Column, SIZE, click, harness_of, object};

const LEAF: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

#[test]
fn the_mesh_that_is_likely_meant_is_one_click_away() {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str| std::fs::write(folder.path().join(name), LEAF).expect("it is written");
    ["leaf.obj", "box.obj"].into_iter().for_each(write);
    let mut document =
        Document::open(&folder.path().join("leaf.obj"), &LoadOptions::default()).expect("a mesh opens");
    let replace = Arrange::ReplaceMesh { object: "leaf".to_owned(), mesh: "box.obj".to_owned() };
    document.apply(&Command::Arrange(replace)).expect("it is there");
    std::fs::create_dir(folder.path().join("old")).expect("a folder");
    std::fs::rename(folder.path().join("leaf.obj"), folder.path().join("old/leaf.obj")).expect("it moves");
    document.undo().expect("there is an entry");
    assert!(!document.shown().meshes.contains_key("leaf.obj"), "the file is gone");
    document.select(Selection::from_iter(object("leaf")));

    let likely_meshes = meshes_like(document.folder(), &["leaf.obj"]);
    let mut harness = harness_of(Column { likely_meshes, ..Column::of(document) }, Theme::Dark, SIZE);
    assert!(harness.query_by_label("Locate mesh of leaf").is_some());
    click(&mut harness, "Use leaf.obj for leaf");
    assert_eq!(harness.state().log.last().map(String::as_str), Some("Use leaf.obj"));
    let leaf = harness.state().document.scene().objects.iter().find(|object| object.name == "leaf");
    assert_eq!(leaf.map(|leaf| leaf.mesh.as_str()), Some("old/leaf.obj"));
    assert!(harness.state().document.shown().meshes.contains_key("old/leaf.obj"));
    assert!(harness.query_by_label("Locate mesh of leaf").is_none(), "nothing is missing");
}
