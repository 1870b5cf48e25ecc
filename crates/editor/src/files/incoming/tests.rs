//! Tests of dropped and imported files: what is taken, copied and refused.

use std::fs;
use std::path::{Path, PathBuf};

use impasto_scene::assets::AssetFolders;
use impasto_scene::obj;

use super::*;

const OBJ: &str = "mtllib looks/all.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl skin\nf 1/1 2/1 3/1\n";
const MTL: &str =
    "newmtl skin\nKd 1 0 0\nmap_Kd ../pictures/skin.png\nnewmtl spare\nmap_Kd ../../secret.png\n";

/// A folder with a mesh of three files, a text beside the mesh, a file outside the mesh's folder, and an empty folder
/// for a scene.
struct Home(tempfile::TempDir);

impl Home {
    fn new() -> Self {
        let home = Self(tempfile::tempdir().expect("a temporary folder"));
        home.write("models/apple.obj", OBJ);
        home.write("models/looks/all.mtl", MTL);
        home.write("models/pictures/skin.png", "picture");
        home.write("models/diary.txt", "private");
        home.write("secret.png", "secret");
        fs::create_dir(home.at("scene")).expect("made");
        home
    }

    fn at(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, text: &str) {
        let path = self.at(name);
        fs::create_dir_all(path.parent().expect("a parent")).expect("made");
        fs::write(path, text).expect("written");
    }

    /// Writes a picture that can be decoded; returns its path.
    fn picture(&self, name: &str) -> PathBuf {
        let path = self.at(name);
        image::RgbaImage::from_pixel(4, 4, image::Rgba([200, 60, 40, 255])).save(&path).expect("written");
        path
    }

    /// The files under a folder, sorted.
    fn files(&self, folder: &str) -> Vec<String> {
        fn walk(folder: &Path, top: &Path, found: &mut Vec<String>) {
            for entry in fs::read_dir(folder).expect("a folder").flatten() {
                let path = entry.path();
                if path.is_dir() {
                    walk(&path, top, found);
                } else {
                    found.push(path.strip_prefix(top).expect("inside").display().to_string());
                }
            }
        }
        let mut found = Vec::new();
        walk(&self.at(folder), &self.at(folder), &mut found);
        found.sort();
        found
    }
}

#[test]
fn a_mesh_from_elsewhere_comes_with_what_it_names_and_with_nothing_else() {
    let home = Home::new();
    let adopted = adopt_mesh(&home.at("models/apple.obj"), &home.at("scene")).expect("adopted");
    assert_eq!(adopted.name, "meshes/apple/apple.obj");
    let all = ["meshes/apple/apple.obj", "meshes/apple/looks/all.mtl", "meshes/apple/pictures/skin.png"];
    assert_eq!(home.files("scene"), all);
    assert_eq!(adopted.copied.len(), 3);
    assert_eq!(
        fs::read_to_string(home.at("scene/meshes/apple/pictures/skin.png")).expect("there"),
        "picture"
    );

    let copy = home.at("scene").join(&adopted.name);
    let (mesh, _) = obj::read(&copy, &home.at("scene"), &AssetFolders::default()).expect("readable");
    assert_eq!(mesh.materials[0].color, [1.0, 0.0, 0.0], "the copy finds its materials");
}

#[test]
fn the_same_mesh_is_copied_once_and_another_of_its_name_beside_it() {
    let home = Home::new();
    let (mesh, scene) = (home.at("models/apple.obj"), home.at("scene"));
    adopt_mesh(&mesh, &scene).expect("adopted");
    let again = adopt_mesh(&mesh, &scene).expect("adopted");
    assert_eq!((again.name.as_str(), again.copied.len()), ("meshes/apple/apple.obj", 0));

    home.write("models/pictures/skin.png", "another picture");
    let other = adopt_mesh(&mesh, &scene).expect("adopted");
    assert_eq!((other.name.as_str(), other.copied.len()), ("meshes/apple-2/apple.obj", 3));
    assert_eq!(
        fs::read_to_string(home.at("scene/meshes/apple/pictures/skin.png")).expect("there"),
        "picture"
    );
    assert_eq!(home.files("scene").len(), 6, "a copy that was not finished stays");
}

#[test]
fn a_mesh_in_the_scenes_folder_is_named_where_it_is() {
    let home = Home::new();
    let adopted = adopt_mesh(&home.at("models/apple.obj"), &home.at("")).expect("adopted");
    assert_eq!(adopted, Adopted { name: "models/apple.obj".to_owned(), copied: Vec::new() });
    // Two meshes are copied although they lie in the scene's folder, since a scene cannot name them: spaces at the
    // ends of a name are trimmed, and a backslash separates folders.
    for (name, plain) in [("scene/ a.obj", "meshes/a/a.obj"), ("scene/b\\c.obj", "meshes/b_c/b_c.obj")] {
        home.write(name, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
        assert_eq!(adopt_mesh(&home.at(name), &home.at("scene")).expect("adopted").name, plain);
        assert!(home.at("scene").join(plain).is_file());
    }
}

#[cfg(unix)]
#[test]
fn a_link_out_of_the_meshs_folder_is_not_followed() {
    let home = Home::new();
    fs::remove_file(home.at("models/pictures/skin.png")).expect("removed");
    std::os::unix::fs::symlink(home.at("secret.png"), home.at("models/pictures/skin.png")).expect("linked");
    adopt_mesh(&home.at("models/apple.obj"), &home.at("scene")).expect("adopted");
    assert_eq!(home.files("scene"), ["meshes/apple/apple.obj", "meshes/apple/looks/all.mtl"]);
}

#[test]
fn what_cannot_be_copied_leaves_nothing_behind() {
    let home = Home::new();
    home.write("models/bad.obj", "v 0 0 zero\nf 1 1 1\n");
    let words = adopt_mesh(&home.at("models/bad.obj"), &home.at("scene")).expect_err("refused").to_string();
    assert!(words.contains("zero"), "{words}");
    fs::create_dir_all(home.at("models/pictures/skin.png.d")).expect("made");
    home.write("models/looks/all.mtl", "newmtl skin\nmap_Kd ../pictures/skin.png.d\n");
    let words = adopt_mesh(&home.at("models/apple.obj"), &home.at("scene")).expect_err("refused").to_string();
    assert!(words.contains("not a regular file"), "{words}");
    assert_eq!(fs::read_dir(home.at("scene")).expect("a folder").count(), 0);
    home.write("scene/meshes", "a file in the way");
    assert!(matches!(
        adopt_picture(&home.picture("skin.png"), &home.at("nowhere/\0"), "textures"),
        Err(AdoptError::Unwritable { .. })
    ));
}

#[test]
fn a_picture_comes_into_the_folder_of_its_use() {
    let home = Home::new();
    let skin = home.picture("skin.png");
    let adopted = adopt_picture(&skin, &home.at("scene"), "textures").expect("adopted");
    assert_eq!(adopted.name, "textures/skin/skin.png");
    assert_eq!(home.files("scene"), ["textures/skin/skin.png"]);
    let there = home.at("scene").join(&adopted.name);
    let again = adopt_picture(&there, &home.at("scene"), "brushes").expect("adopted");
    assert_eq!((again.name, again.copied.len()), (adopted.name, 0), "a file of the scene's folder is copied");
}

#[test]
fn a_picture_that_cannot_be_used_is_refused_in_one_sentence_and_not_copied() {
    let home = Home::new();
    let refused = |name: &str| {
        let error = adopt_picture(&home.at(name), &home.at("scene"), "textures").expect_err("refused");
        assert!(home.files("scene").is_empty(), "{name} left something");
        error.to_string()
    };
    let words = refused("secret.png");
    assert!(words.starts_with("secret.png: the format of the picture is unknown; save it again"), "{words}");
    home.write("empty.png", "");
    assert!(refused("empty.png").contains("empty.png: the picture file is empty"));
    let whole = fs::read(home.picture("skin.png")).expect("there");
    fs::write(home.at("cut.png"), &whole[..whole.len() / 2]).expect("written");
    let words = refused("cut.png");
    assert!(
        words.starts_with("cut.png: the picture can not be decoded: it is damaged or cut short;")
            && !words.contains("left out"),
        "{words}"
    );
    assert!(refused("nowhere.png").contains("nowhere.png"));
}

#[test]
fn dropped_files_are_opened_begun_or_imported() {
    let home = Home::new();
    home.write("models/pear.OBJ", OBJ);
    home.write("a.ron", "");
    home.write("b.ron", "");
    let [apple, pear, scene, other, picture] =
        ["models/apple.obj", "models/pear.OBJ", "a.ron", "b.ron", "secret.png"].map(|name| home.at(name));
    let both = [apple.clone(), pear.clone(), apple.clone(), picture.clone()];
    let steps = |present| plan(&both, present).steps;
    let brush = Step::Picture(picture.clone());
    let begun = [Step::Begin(apple.clone()), Step::Import(pear.clone()), brush.clone()];
    assert_eq!(steps(Present::Nothing), begun, "each once, the first into a scene of its own");
    assert_eq!(steps(Present::Edited), [Step::Import(apple.clone()), Step::Import(pear), brush]);
    assert!(!plan(&both, Present::Edited).asks, "an import takes nothing away");

    for (present, asks) in [(Present::Nothing, false), (Present::Saved, false), (Present::Edited, true)] {
        let plan = plan(&[apple.clone(), scene.clone(), other.clone()], present);
        assert_eq!((&plan.steps[..], plan.asks), (&[Step::Open(scene.clone())][..], asks));
        assert_eq!(plan.refused.len(), 2, "{:?}", plan.refused);
        assert!(plan.refused[1].contains("b.ron"), "{:?}", plan.refused);
    }
    let alone = plan(&[picture], Present::Nothing);
    assert!(alone.steps.is_empty() && alone.refused[0].contains("open a mesh first"), "{alone:?}");
}

#[test]
fn files_that_cannot_be_read_are_refused_with_words() {
    let home = Home::new();
    home.write("chair.fbx", "");
    home.write("looks.mtl", "");
    home.write("shot_0001.EXR", "");
    for (name, words) in [
        (
            "shot_0001.EXR",
            "shot_0001.EXR is a rendered picture: Impasto writes EXR files and does not read them",
        ),
        ("models/diary.txt", "no scene"),
        ("chair.fbx", "export it as glTF or OBJ"),
        ("looks.mtl", "the OBJ file"),
        ("models", "is a folder"),
        ("gone.obj", "is not there"),
    ] {
        let plan = plan(&[home.at(name)], Present::Nothing);
        assert!(plan.steps.is_empty(), "{name}");
        assert!(plan.refused[0].contains(words), "{:?}", plan.refused);
    }
}

#[test]
fn only_an_empty_document_may_be_replaced_without_asking() {
    let home = Home::new();
    assert_eq!(Present::of(&Document::empty(&home.at("scene"))), Present::Nothing);
    let begun = Document::open(&home.at("models/apple.obj"), &Default::default()).expect("opened");
    assert_eq!(Present::of(&begun), Present::Edited);
}
