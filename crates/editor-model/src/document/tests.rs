//! Tests of documents with errors, and of files that other programs change.

use std::fs;
use std::path::{Path, PathBuf};

use impasto_scene::document::{CameraKey, Ease, Lens};
use impasto_scene::load::LoadOptions;

use super::*;
use crate::command::{Arrange, Command, Edit, KeyOf, SceneEdit, Time};

const QUAD: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";

struct Folder(tempfile::TempDir);

impl Folder {
    fn with(text: &str) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        fs::create_dir(folder.path().join("meshes")).expect("made");
        fs::write(folder.path().join("meshes/leaf.obj"), QUAD).expect("written");
        fs::write(folder.path().join("s.ron"), text).expect("written");
        Self(folder)
    }

    fn path(&self) -> PathBuf {
        self.0.path().join("s.ron")
    }

    fn text(&self) -> String {
        fs::read_to_string(self.path()).expect("there")
    }

    fn open(&self) -> Document {
        Document::open_with_problems(&self.path(), &LoadOptions::default()).expect("opens")
    }
}

fn scene(mesh: &str, more: &str) -> String {
    format!(
        "(\n  version: 1,\n  camera: (keys: [(frame: 0, eye: (0, 1, 4), target: (0, 0, 0))]),\n  objects: [(name: \"leaf\", mesh: \"{mesh}\")],\n{more})\n"
    )
}

fn broken() -> String {
    scene("leaf.obj", "  strokes: (widht_px: 9),\n  seed: \"x\",\n")
}

#[test]
fn an_empty_document_has_a_timeline_and_holds_meshes_that_were_read() {
    let folder = Folder::with("");
    let mut document = Document::empty(folder.0.path());
    assert_eq!(document.scene().timeline.last, LAST_FRAME);
    let path = folder.0.path().join("meshes/leaf.obj");
    let read = || Arc::new(load::load_mesh(&path, &LoadOptions::default().folders).expect("it is good").0);
    let [first, second] = [read(), read()];
    document.hold_mesh("leaf.obj", Arc::clone(&first));
    document.hold_mesh("leaf.obj", second);
    assert!(Arc::ptr_eq(&document.loaded().meshes["leaf.obj"], &first));
}

#[test]
fn after_another_edit_nothing_is_left_to_redo() {
    let folder = Folder::with(&scene("leaf.obj", ""));
    let mut document = folder.open();
    document.apply(&seed(1)).expect("it fits");
    document.undo().expect("there is an entry");
    document.apply(&seed(2)).expect("it fits");
    assert!(document.redo().is_none());
    assert_eq!(document.scene().seed, 2);
}

fn seed(seed: u32) -> Command {
    Command::Scene(SceneEdit::SetSeed(seed))
}

#[test]
fn a_scene_with_losses_cannot_take_the_place_of_its_file_until_they_are_settled() {
    let folder = Folder::with(&broken());
    let mut document = folder.open();
    assert_eq!(document.loss_count(), 3);
    assert!(!document.is_edited());
    assert!(document.lacks_mesh(&document.scene().objects[0].mesh), "a box stands in for the unusable mesh");
    let refused = document.save().expect_err("saving is refused while losses are left");
    assert!(matches!(refused, SaveError::Problems { count: 2, line: 5 }), "{refused}");
    assert!(document.save_as(&folder.path()).is_err());
    assert!(document.save_as(&folder.0.path().join("meshes/../s.ron")).is_err(), "another path to the file");
    // A copy can be saved, and the file stays as it is.
    document.save_copy(&folder.0.path().join("copy.ron")).expect("saved");
    let step = document.fix_certain().expect("fixed");
    assert_eq!(step.text, "Fix 2 problems");
    assert_eq!(document.scene().strokes.width_px, Some(9.0));
    assert_eq!(document.scene().objects[0].mesh, "meshes/leaf.obj");
    assert!(!document.lacks_mesh("meshes/leaf.obj"));
    assert_eq!(document.loss_count(), 1);
    assert!(document.is_edited() && document.save().is_err());
    assert_eq!(folder.text(), broken());
    // Undo brings the problems back.
    document.undo().expect("undone");
    assert_eq!((document.loss_count(), document.scene().strokes.width_px), (3, None));
    assert!(document.apply(&seed(3)).is_ok(), "a box stands in for the mesh again, so edits are allowed");
    document.undo().expect("undone");
    document.redo().expect("the edit again");
    document.undo().expect("undone");
    let text = document.source().expect("a source").text.replace("\"x\"", "7");
    document.read_text(&text).expect("read");
    document.fix_certain().expect("fixed");
    assert_eq!(document.loss_count(), 0);
    document.save().expect("saving is allowed once no loss is left");
    let saved = Document::open(&folder.path(), &LoadOptions::default()).expect("well");
    assert_eq!((saved.scene().seed, saved.scene()), (7, document.scene()));
}

#[test]
fn fixes_and_edits_both_hold_where_they_are_of_different_things() {
    let folder = Folder::with(&broken());
    let mut document = folder.open();
    document.apply(&Command::Scene(SceneEdit::SetSize(640, 480))).expect("done");
    document.fix_certain().expect("fixed");
    assert_eq!(document.scene().size, (640, 480));
    assert_eq!(document.scene().strokes.width_px, Some(9.0));
    // Two edits of the same thing conflict: nothing is lost, and the message says what to do.
    document.apply(&seed(4)).expect("done");
    let text = document.source().expect("a source").text.replace("\"x\"", "7");
    let refused = document.read_text(&text).expect_err("the seed was edited and changed in the text");
    assert!(refused.0.starts_with("seed was edited since"), "{refused}");
    assert_eq!(document.scene().seed, 4);
}

#[test]
fn a_fix_keeps_touches_and_brings_those_that_the_text_adds() {
    let touch =
        |name| format!("(name: \"{name}\", on: \"leaf\", points: [(at: (0.5, 0.5, 0), normal: (0, 0, 1))])");
    let more = format!("  touches: [{}],\n  strokes: (widht_px: 9),\n  seed: \"x\",\n", touch("glint"));
    let folder = Folder::with(&scene("meshes/leaf.obj", &more));
    let mut document = folder.open();
    document.apply(&Command::Scene(SceneEdit::SetSize(640, 480))).expect("done");
    document.fix_certain().expect("fixed");
    assert_eq!(document.scene().touches.len(), 1, "the fix lost or doubled a touch");
    let text = &document.source().expect("one problem is left").text;
    let text = text.replace("\"x\"", "7").replace("touches: [", &format!("touches: [{}, ", touch("rim")));
    document.read_text(&text).expect("read");
    assert_eq!((document.scene().size, document.scene().seed), ((640, 480), 7));
    let names: Vec<_> = document.scene().touches.iter().map(|touch| touch.name.as_str()).collect();
    assert_eq!(names, ["rim", "glint"]);
}

#[test]
fn choosing_another_mesh_replaces_a_missing_one_and_undo_brings_the_box_back() {
    let folder = Folder::with(&scene("lost.obj", ""));
    let mut document = folder.open();
    let rows = document.problems();
    assert_eq!(rows[0].repairs, [Repair::Retry, Repair::Locate { object: "leaf".to_owned() }]);
    let (object, mesh) = ("leaf".to_owned(), "meshes/leaf.obj".to_owned());
    document.apply(&Command::Arrange(Arrange::ReplaceMesh { object, mesh })).expect("replaced");
    assert_eq!(document.loss_count(), 0);
    document.undo().expect("undone");
    assert_eq!(document.loss_count(), 1);
    assert!(document.loaded().meshes.contains_key("lost.obj"));
    document.redo().expect("done again");
    document.save().expect("saved");
}

#[test]
fn a_missing_mesh_is_listed_and_does_not_keep_the_scene_from_being_saved() {
    let more = "  regions: [(name: \"tip\", on: Group(\"leaf\", \"tip\"), direction: Angle(30))],\n";
    let folder = Folder::with(&scene("lost.obj", more));
    let mut document = folder.open();
    assert!(document.loss_count() == 1 && !document.saving_loses());
    document.apply(&seed(9)).expect("done");
    document.save().expect("saved");
    // After saving, the mesh is still listed, with its line in the saved text.
    let rows = document.problems();
    assert_eq!(rows[0].repairs, [Repair::Retry, Repair::Locate { object: "leaf".to_owned() }]);
    let place = rows[0].problem.place.expect("a place");
    let line = folder.text().lines().nth(place.line - 1).expect("the line").to_owned();
    assert!(line[place.column - 1..].starts_with("\"lost.obj\""), "{place:?} in {line}");
    // The file holds the scene as it is. Its text can be read again once the mesh is there.
    let again = folder.open();
    assert_eq!(again.scene(), document.scene());
    assert_eq!((again.scene().seed, again.scene().regions.len(), again.loss_count()), (9, 1, 1));
    fs::write(folder.0.path().join("lost.obj"), QUAD.replace("f 1", "g tip\nf 1")).expect("written");
    let text = document.source().expect("a source").text.clone();
    document.read_text(&text).expect("read");
    assert!(document.loss_count() == 0 && !document.is_edited());
}

#[test]
fn a_missing_mesh_whose_object_was_deleted_and_saved_is_listed_again_after_undo() {
    let folder = Folder::with(&scene("lost.obj", ""));
    let mut document = folder.open();
    let leaf = Item::Object("leaf".to_owned());
    document.apply(&Command::Edit(Edit::Delete(vec![leaf]))).expect("deleted");
    assert_eq!(document.loss_count(), 0);
    document.save().expect("saved");
    document.undo().expect("undone");
    assert!(document.loss_count() == 1 && document.lacks_mesh("lost.obj"));
    assert!(document.loaded().meshes.contains_key("lost.obj"), "the box is gone");
}

#[test]
fn a_guide_off_its_surface_is_listed_and_snaps_to_it() {
    let more = "  regions: [(name: \"skin\", on: Object(\"leaf\"), guides: [(radius: 0.1, points: [\n    (at: (0.2, 0.5, 0.42), normal: (0, 0, 1)), (at: (0.8, 0.5, 0.42), normal: (0, 0, 1))])])],\n";
    let folder = Folder::with(&scene("meshes/leaf.obj", more));
    let mut document = folder.open();
    assert_eq!(document.loss_count(), 0);
    let snap = Repair::Snap { region: "skin".to_owned(), guide: 0 };
    assert!(document.problems().iter().any(|row| row.repairs == [snap.clone()]));
    document.snap_guide("skin", 0).expect("snapped");
    assert!(document.problems().is_empty(), "{:?}", document.problems());
    for (point, x) in document.scene().regions[0].guides[0].points.iter().zip([0.2, 0.8]) {
        let off: f64 = point.at.iter().zip([x, 0.5, 0.0]).map(|(a, b)| (a - b).abs()).sum();
        assert!(off < 1e-6, "{:?}", point.at);
    }
    document.undo().expect("one step");
    assert_eq!(document.undo_count(), 0);
}

#[test]
fn a_file_changed_outside_is_not_saved_over_and_can_be_read_again() {
    let folder = Folder::with(&scene("meshes/leaf.obj", ""));
    let mut document = folder.open();
    document.apply(&seed(1)).expect("done");
    let theirs = scene("meshes/leaf.obj", "  seed: 9,\n");
    fs::write(folder.path(), &theirs).expect("written");
    assert!(document.is_changed_outside());
    assert!(matches!(document.save(), Err(SaveError::ChangedOutside { .. })));
    assert_eq!(folder.text(), theirs);
    let mut editor = crate::editor::Editor::new(document.clone());
    editor.take_said();
    assert!(editor.save(None).is_err());
    document.reload().expect("read");
    assert_eq!((document.scene().seed, document.is_edited()), (9, false));
    assert!(!document.is_changed_outside());
    // Undo brings back the edits that reading dropped.
    document.undo().expect("undone");
    assert_eq!((document.scene().seed, document.is_edited()), (1, true));
    document.save().expect("the change outside is known since it was read");
    // A file that cannot be read changes nothing.
    fs::write(folder.path(), "(version: 1, camera").expect("written");
    assert!(document.reload().is_err());
    assert_eq!(document.scene().seed, 1);
    // What the document itself saves is not reported as a change.
    document.save_as(&folder.path()).expect("a file chosen by hand is written over");
    assert!(!document.is_changed_outside());
    // If the user says so, the other program's change is overwritten. The message is that of any save.
    fs::write(folder.path(), &theirs).expect("written");
    editor.save_over().expect("written over");
    assert_eq!(editor.take_said().last().map(|said| said.words.clone()).as_deref(), Some("Saved s.ron"));
    assert_ne!(folder.text(), theirs);
}

#[test]
fn a_mesh_that_was_changed_is_read_again_without_an_entry() {
    let folder = Folder::with(&scene("meshes/leaf.obj", ""));
    let mut document = folder.open();
    let mesh: &Path = &folder.0.path().join("meshes/leaf.obj");
    assert!(document.files_on_disk().iter().any(|file| file == mesh));
    // An OBJ file may get materials later; a scene file has none.
    let materials = |file: &Path| document.files_on_disk().contains(&file.with_extension("mtl"));
    assert!(materials(mesh) && !materials(&folder.path()));
    fs::write(mesh, QUAD.replace("f 1 2 3 4", "f 1 2 3")).expect("written");
    document.read_files_again().expect("read");
    assert_eq!(document.loaded().meshes["meshes/leaf.obj"].mesh.triangles.len(), 1);
    assert!(!document.is_edited() && document.undo_count() == 0);
    fs::write(mesh, "f 1 2 3").expect("written");
    assert!(document.read_files_again().is_err());
    assert_eq!(document.loaded().meshes["meshes/leaf.obj"].mesh.triangles.len(), 1, "the good mesh stays");
}

#[test]
fn a_scene_whose_mesh_or_folder_is_gone_is_saved_elsewhere_and_what_is_missing_is_told_once() {
    for whole_folder in [false, true] {
        let folder = Folder::with(&scene("meshes/leaf.obj", ""));
        let mut editor = crate::editor::Editor::new(folder.open());
        let gone = if whole_folder { folder.0.path().to_owned() } else { folder.0.path().join("meshes") };
        let place = tempfile::tempdir().expect("a folder");
        fs::rename(gone, place.path().join("renamed")).expect("renamed");
        let elsewhere = place.path().join("elsewhere");
        fs::create_dir(&elsewhere).expect("made");
        let words = " without meshes/leaf.obj, which was not found";
        editor.save_copy(&elsewhere.join("copy.ron")).expect("written");
        editor.save(Some(&elsewhere.join("own.ron"))).expect("written");
        let said: Vec<String> = editor.take_said().into_iter().map(|said| said.words).collect();
        let copy = format!("Saved a copy as {}{words}", elsewhere.join("copy.ron").display());
        assert_eq!(said, [copy, format!("Saved own.ron{words}")]);
        assert_eq!(editor.document().file(), Some(&*elsewhere.join("own.ron")));
        let again = Document::open_with_problems(&elsewhere.join("copy.ron"), &LoadOptions::default());
        assert_eq!(again.expect("opens").scene(), editor.document().scene());
        // At its new place the scene is saved like any other.
        editor.save(None).expect("saved");
        assert_eq!(editor.take_said()[0].words, "Saved own.ron");
    }
}

/// Writes a recovery copy of a document, after `change` has edited that copy. Returns the recovered document and the
/// copy as it was read back.
fn brought_back(
    document: &Document,
    change: impl Fn(&mut crate::recovery::Copy),
) -> (Document, crate::recovery::Copy) {
    let place = tempfile::tempdir().expect("a folder");
    let mut work = document.work(1);
    change(&mut work.copy);
    crate::recovery::Recovery::open(place.path(), "1-1").expect("opens").keep(&work).expect("kept");
    let offers = crate::recovery::Recovery::offers(place.path());
    let copy = offers[0].copy.clone();
    (Document::recovered(&copy, &LoadOptions::default()).expect("opens"), copy)
}

#[test]
fn a_copy_of_a_scene_with_losses_never_takes_the_place_of_its_file() {
    let folder = Folder::with(&broken());
    let mut document = folder.open();
    document.apply(&Command::Scene(SceneEdit::SetSize(640, 480))).expect("done");
    // The unreadable parts come back as they were. They must be mended before the file can be overwritten.
    let (mut back, _) = brought_back(&document, |_| {});
    assert_eq!(back.scene().size, (640, 480));
    assert_eq!(back.source().expect("a source").text, broken());
    assert_eq!(back.loss_count(), document.loss_count());
    assert!(matches!(back.save(), Err(SaveError::Problems { .. })));
    // Without the source text, the recovered document has no file.
    let (mut back, _) = brought_back(&document, |copy| copy.source = None);
    assert_eq!(back.scene().size, (640, 480));
    assert!(matches!(back.save(), Err(SaveError::Unnamed)));
    assert_eq!(folder.text(), broken());
}

#[test]
fn what_was_missing_when_a_copy_was_made_and_is_there_again_is_not_taken_for_deleted() {
    let folder = Folder::with(&broken());
    let mut document = folder.open();
    document.apply(&Command::Scene(SceneEdit::SetSize(640, 480))).expect("done");
    let place = tempfile::tempdir().expect("a folder");
    crate::recovery::Recovery::open(place.path(), "1-1")
        .expect("opens")
        .keep(&document.work(1))
        .expect("kept");
    let copy = crate::recovery::Recovery::offers(place.path())[0].copy.clone();
    // The missing mesh is put in its place.
    fs::write(folder.0.path().join("leaf.obj"), QUAD).expect("written");
    for unread in [None, Some("(version: 1)".to_owned())] {
        let has_text = unread.is_some();
        let copy = crate::recovery::Copy { unread, ..copy.clone() };
        let mut back = Document::recovered(&copy, &LoadOptions::default()).expect("opens");
        assert_eq!(back.source().is_some(), has_text, "an edited text is shown, whatever is wrong");
        assert!(matches!(back.save(), Err(SaveError::Unnamed)), "what was lost is not known any more");
    }
    assert_eq!(folder.text(), broken());
}

#[test]
fn a_text_that_was_being_edited_comes_back_letter_for_letter() {
    let folder = Folder::with(&broken());
    let document = folder.open();
    for typed in ["(version: 1,\r\n// end of what it is a copy of\n\n\u{e4}", "", "\n\n", "// edited| x\n"] {
        let (back, copy) = brought_back(&document, |copy| copy.unread = Some(typed.to_owned()));
        assert_eq!(copy.unread.as_deref(), Some(typed));
        assert_eq!(copy.source.as_deref(), Some(&*broken()));
        assert_eq!((copy.path.as_path(), copy.changes), (folder.path().as_path(), 0));
        assert_eq!(back.source().expect("a source").text, broken());
        assert!(!back.is_edited(), "only the text was");
    }
}

#[test]
fn a_shot_that_was_exported_again_is_no_edit_and_what_was_edited_stays_one() {
    const GLTF: &str = r#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"name": "leaf", "mesh": 0, "translation": [AT, 0, 0]}], "buffers": [{"byteLength": 36, "uri":
        "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}]}"#;
    let folder = Folder::with(
        "(version: 1, shot: \"shot.gltf\", camera: (keys: [(frame: 0, eye: (0, 0, 4), target: (0, 0, 0))]), timeline: (fps: 24, first: 10, last: 20))",
    );
    let export =
        |at: &str| fs::write(folder.0.path().join("shot.gltf"), GLTF.replace("AT", at)).expect("written");
    export("0");
    let mut document = folder.open();
    assert_eq!(
        crate::editor::Editor::new(document.clone()).session.frame,
        10.0,
        "the reference frame 0 lies before the timeline, so its first frame is shown"
    );
    export("0.5");
    document.read_files_again().expect("read");
    assert!(!document.is_edited() && document.undo_count() == 1);
    assert!(document.apply(&seed(9)).is_ok());
    export("1");
    document.read_files_again().expect("read");
    assert!(document.is_edited() && document.scene().seed == 9);
}

/// A camera rolls by a whole turn in 72 frames. The roll in its keys goes on past 180 degrees and does not jump back.
#[test]
fn keys_of_a_shot_whose_camera_rolls_roll_on() {
    let folder = Folder::with("(version: 1, shot: \"shot.gltf\", timeline: (fps: 24, first: 0, last: 72))");
    // Times 0 to 3, then the quaternions of 0, 120, 240 and 360 degrees about z.
    let gltf = r#"{"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"name": "eye", "camera": 0, "translation": [0, 0, 4]}, {"name": "leaf", "mesh": 0}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.6, "znear": 0.1}}],
        "buffers": [{"byteLength": 80, "uri": "data:application/octet-stream;base64,AAAAAAAAgD8AAABAAABAQAAAAAAAAAAAAAAAAAAAgD8AAAAAAAAAANezXT8AAAA/AAAAAAAAAADXs10/AAAAvwAAAAAAAAAAMjENJQAAgL8="},
        {"byteLength": 36, "uri": "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA"}],
        "bufferViews": [{"buffer": 0, "byteLength": 80}, {"buffer": 1, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "SCALAR", "min": [0], "max": [3]},
        {"bufferView": 0, "byteOffset": 16, "componentType": 5126, "count": 4, "type": "VEC4"},
        {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 2}}]}],
        "animations": [{"samplers": [{"input": 0, "output": 1}],
        "channels": [{"sampler": 0, "target": {"node": 0, "path": "rotation"}}]}]}"#;
    fs::write(folder.0.path().join("shot.gltf"), gltf).expect("written");
    let mut document = folder.open();
    document.apply(&Command::Time(Time::OwnKeys(KeyOf::Camera))).expect("done");
    let keys = &document.scene().camera.keys;
    let [first, .., last] = &**keys else { panic!("{} keys", keys.len()) };
    assert!((first.frame, last.frame) == (0.0, 72.0), "{} to {}", first.frame, last.frame);
    assert!(
        ((last.roll_deg - first.roll_deg).abs() - 360.0).abs() < 1e-3,
        "{} to {}",
        first.roll_deg,
        last.roll_deg
    );
    let steps =
        keys.windows(2).map(|pair| (pair[1].roll_deg - pair[0].roll_deg) / (pair[1].frame - pair[0].frame));
    assert!(steps.map(f64::abs).all(|degrees| (degrees - 5.0).abs() < 1e-3), "each frame rolls by 5 degrees");
}

#[test]
fn merged_steps_that_cancel_each_other_leave_no_entry_and_join_none() {
    let files = Folder::with(&scene("leaf.obj", ""));
    let mut document = files.open();
    let first = document.scene().seed;
    document.apply(&seed(first + 7)).unwrap();
    let count = document.undo_count();
    let nudge = |document: &mut Document, to: u32, at_secs: f64| {
        document.apply_merged(&seed(to), "nudge", at_secs).unwrap();
    };
    nudge(&mut document, first + 8, 10.0);
    nudge(&mut document, first + 7, 10.1);
    assert_eq!(document.undo_count(), count, "to and back is nothing");
    nudge(&mut document, first + 9, 10.2);
    assert_eq!(document.undo_count(), count + 1, "and joins no older entry");
}

#[test]
fn near_and_far_leave_keyed_fields_of_view_and_a_field_of_view_clears_them() {
    let files = Folder::with(&scene("leaf.obj", ""));
    let document = files.open();
    let mut scene = document.scene().clone();
    let (eye, target) = ([0.0, 0.0, 4.0], [0.0; 3]);
    let key = CameraKey { frame: 0.0, eye, target, roll_deg: 0.0, fov_y_deg: Some(50.0), ease: Ease::Linear };
    scene.camera.keys = vec![key];
    let lens = |fov_y_deg: f64, near: f64| Lens::Perspective { fov_y_deg, near, far: 100.0 };
    scene.camera.lens = lens(35.0, 0.1);
    let keyed = |lens: Lens, scene: &Scene| {
        let mut edited = scene.clone();
        Command::Arrange(Arrange::SetLens(lens)).edit(&mut edited, document.loaded()).unwrap();
        edited.camera.keys[0].fov_y_deg
    };
    assert_eq!(keyed(lens(35.0, 0.2), &scene), Some(50.0));
    assert_eq!(keyed(lens(35.0, 0.1), &scene), None, "the field of view was stated, if as it is");
    assert_eq!(keyed(lens(40.0, 0.1), &scene), None);
    scene.camera.lens = Lens::Orthographic { height: 2.0, near: 0.1, far: 100.0 };
    let said = |height: f64, near: f64| {
        let lens = Lens::Orthographic { height, near, far: 100.0 };
        Command::Arrange(Arrange::SetLens(lens)).edit(&mut scene.clone(), document.loaded()).unwrap().text
    };
    assert_eq!(said(3.0, 0.1), "Set view height");
    assert_eq!(said(2.0, 0.2), "Set near and far");
    let perspective = Command::Arrange(Arrange::SetLens(lens(40.0, 0.1)));
    assert_eq!(perspective.edit(&mut scene.clone(), document.loaded()).unwrap().text, "Set projection");
}
