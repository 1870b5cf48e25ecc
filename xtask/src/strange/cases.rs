//! Cases: the files of each, and the commands that are run on them.

use std::path::{Path, PathBuf};

use anyhow::Context as _;
use serde_json::Value;

use super::chance::Chance;
use super::page::Page;
use super::{binaries, damage, models, scenes, shots};

/// Larger files are not damaged: they are slow to paint, and find nothing more.
const MOST_BYTES: u64 = 256 << 10;

/// What cases are made from: files to damage, and the grammar of scene files.
pub struct Source {
    page: Page,
    files: Vec<PathBuf>,
}

/// Some files, and the commands that are run on one of them.
pub struct Case {
    pub kind: &'static str,
    /// Their names, and what is in them.
    pub files: Vec<(String, Vec<u8>)>,
    /// `check`, `render`, and one more.
    pub commands: Vec<Vec<String>>,
    /// What the commands may write.
    pub written: [&'static str; 4],
}

/// Files with their names: the one that is opened comes first.
type Files = Vec<(String, Vec<u8>)>;

/// Makes up the files of a case at random. Also returns the name of their kind.
type Draw = fn(&Source, &mut Chance) -> (&'static str, Files);

const KINDS: [Draw; 7] = [model, shot, scene, picture, moved, damaged, damaged];

/// Endings of files that a command opens, and of files that such a file may name.
const OPENED: [&str; 4] = ["obj", "glb", "gltf", "ron"];
const READ: [&str; 7] = ["mtl", "png", "jpg", "tga", "webp", "bin", "pc2"];

impl Source {
    /// Lists the files of `scenes/` and of the corpus, where `IMPASTO_CORPUS` names one.
    ///
    /// # Errors
    /// Where a folder cannot be read.
    pub fn read(root: &Path) -> anyhow::Result<Self> {
        let mut folders = vec![root.join("scenes")];
        folders.extend(std::env::var_os("IMPASTO_CORPUS").map(PathBuf::from));
        let mut files = Vec::new();
        while let Some(folder) = folders.pop() {
            for entry in std::fs::read_dir(&folder).with_context(|| folder.display().to_string())? {
                let path = entry?.path();
                if path.is_dir() {
                    folders.push(path);
                } else if ending(&path).is_some() && path.metadata()?.len() <= MOST_BYTES {
                    files.push(path);
                }
            }
        }
        files.sort();
        Ok(Self { page: Page::read(root)?, files })
    }

    /// The case with this number.
    pub fn case(&self, seed: u64, number: u64) -> Case {
        let mut chance = Chance::new(seed, number);
        let (kind, files) = KINDS[chance.below(KINDS.len())](self, &mut chance);
        let opened = files.first().map_or(String::new(), |(name, _)| name.clone());
        let words = |line: &str| -> Vec<String> {
            line.split(' ')
                .map(|word| if word == "FILE" { opened.clone() } else { word.to_owned() })
                .collect()
        };
        let mut commands = vec![
            words("check FILE"),
            words("render FILE -f 0 --size 96x64 --threads 1 --memory 1G -o out.png"),
        ];
        let is_scene = opened.ends_with(".ron");
        commands.push(match chance.below(5) {
            0 => words("info FILE --memory 1G --json"),
            1 => words("strokes FILE --frame 7 --size 96x64 --threads 1 --memory 1G -o out.csv"),
            2 if !is_scene => words("new FILE -o new.ron"),
            2 => words("set FILE strokes.width_px=12"),
            3 => words("render FILE -f 3 --style sumi_e --size 64x96 --threads 1 --memory 1G -o out.png"),
            _ => words("render FILE -f 11 --aov all --size 64x36 --threads 1 --memory 1G -o out.exr"),
        });
        Case { kind, files, commands, written: ["out.png", "out.csv", "new.ron", "out.exr"] }
    }

    /// A random file with one of these endings: its path and its bytes.
    fn any(&self, chance: &mut Chance, endings: &[&str]) -> (PathBuf, Vec<u8>) {
        let fitting: Vec<&PathBuf> =
            self.files.iter().filter(|path| ending(path).is_some_and(|end| endings.contains(&end))).collect();
        let Some(path) = fitting.get(chance.below(fitting.len())) else {
            return (PathBuf::from("m.obj"), Vec::new());
        };
        ((*path).clone(), std::fs::read(path).unwrap_or_default())
    }
}

fn ending(path: &Path) -> Option<&'static str> {
    let own = path.extension()?.to_str()?;
    OPENED.into_iter().chain(READ).find(|&end| end == own)
}

fn named(name: &str, bytes: Vec<u8>) -> (String, Vec<u8>) {
    (name.to_owned(), bytes)
}

fn model(_: &Source, chance: &mut Chance) -> (&'static str, Files) {
    let mut files = vec![named("m.obj", models::obj(chance)), named("m.mtl", models::mtl(chance))];
    files.push(named("t.png", binaries::picture(chance, "png")));
    if chance.may_be_odd() && chance.happens(0.2) {
        let other = files[1].1.clone();
        files[0].1 = damage::text(chance, &files[0].1, &other);
    }
    ("model", files)
}

fn shot(_: &Source, chance: &mut Chance) -> (&'static str, Files) {
    let mut files = vec![named("s.glb", shots::glb(chance))];
    if chance.happens(0.3) {
        files.push(named("s.impasto.json", shots::sidecar(chance)));
        files.push(named("c.pc2", binaries::cache(chance, 10)));
    }
    ("shot", files)
}

fn scene(source: &Source, chance: &mut Chance) -> (&'static str, Files) {
    let mut files = vec![named("a.ron", scenes::scene(chance, &source.page))];
    files.push(named("m.obj", small(chance)));
    files.push(named("m.mtl", models::mtl(chance)));
    files.push(named("s.glb", shots::glb(chance)));
    files.push(named("t.png", binaries::picture(chance, "png")));
    files.push(named("c.pc2", binaries::cache(chance, 8)));
    if chance.may_be_odd() && chance.happens(0.1) {
        let other = source.any(chance, &["ron"]).1;
        files[0].1 = damage::text(chance, &files[0].1, &other);
    }
    ("scene", files)
}

/// A box, or a strange model.
fn small(chance: &mut Chance) -> Vec<u8> {
    if chance.happens(0.2) { models::obj(chance) } else { cube() }
}

fn cube() -> Vec<u8> {
    let mut text = String::from("mtllib m.mtl\n");
    for corner in 0..8 {
        let at = |axis: usize| 2 * (corner >> axis & 1) - 1;
        text += &format!("v {} {} {}\n", at(0), at(1), at(2));
    }
    text += "g body\nusemtl red\nf 1 3 4 2\nf 5 6 8 7\ng stem\nf 1 2 6 5\nf 3 7 8 4\nusemtl leaf\ng leaf\nf 1 5 7 3\nf 2 4 8 6\n";
    text.into_bytes()
}

/// A box with a strange picture as its texture, its brush or the texture of its noise.
fn picture(source: &Source, chance: &mut Chance) -> (&'static str, Files) {
    let kind = chance.of(&["png", "bmp", "tga", "jpg", "webp"]);
    let bytes = match source.any(chance, &[kind]).1 {
        there if !there.is_empty() && chance.happens(0.5) => {
            let other = source.any(chance, &["png", "jpg", "tga", "webp"]).1;
            damage::bytes(chance, there, &other)
        }
        _ => binaries::picture(chance, kind),
    };
    let name = format!("t.{kind}");
    let (material, strokes) = match chance.below(3) {
        0 => (format!("material: (texture: \"{name}\"), "), String::new()),
        1 => (String::new(), format!("strokes: (brush: \"{name}\"), ")),
        _ => (format!("material: (noise_displace: (vertex: (texture: \"{name}\"))), "), String::new()),
    };
    let text = format!(
        "#![enable(implicit_some)]\n(version: 1, size: (96, 64), camera: (keys: [(frame: 0, eye: (1, 2, 4), target: (0, 0, 0))]), \
         objects: [(name: \"box\", mesh: \"m.obj\", {material})], {strokes})\n"
    );
    (
        "picture",
        vec![
            named("a.ron", text.into_bytes()),
            named(&name, bytes),
            named("m.obj", cube()),
            named("m.mtl", b"newmtl red\nKd 1 0 0\nnewmtl leaf\nKd 0 1 0\n".to_vec()),
        ],
    )
}

/// A box that a point cache moves.
fn moved(_: &Source, chance: &mut Chance) -> (&'static str, Files) {
    let text = "#![enable(implicit_some)]\n(version: 1, timeline: (first: 0, last: 12), \
        camera: (keys: [(frame: 0, eye: (1, 2, 4), target: (0, 0, 0))]), \
        objects: [(name: \"box\", mesh: \"m.obj\", cache: \"c.pc2\")])\n";
    (
        "point cache",
        vec![
            named("a.ron", text.into()),
            named("m.obj", cube()),
            named("m.mtl", b"newmtl red\nnewmtl leaf\n".to_vec()),
            named("c.pc2", binaries::cache(chance, 8)),
        ],
    )
}

/// A damaged copy of an existing file, beside sound copies of the files that it may name.
fn damaged(source: &Source, chance: &mut Chance) -> (&'static str, Files) {
    let (path, bytes) = source.any(chance, &OPENED);
    let end = ending(&path).unwrap_or("obj");
    let other = source.any(chance, &[end]).1;
    let parsed = serde_json::from_slice::<Value>(&bytes).ok();
    let (kind, bytes) = match (chance.below(4), parsed) {
        (0, _) => ("damaged bytes", damage::bytes(chance, bytes, &other)),
        (_, Some(mut tree)) => {
            damage::json(chance, &mut tree);
            ("damaged gltf", tree.to_string().into_bytes())
        }
        _ => match (end, glb_parts(&bytes)) {
            ("glb", Some((mut tree, numbers))) => {
                damage::json(chance, &mut tree);
                ("damaged glb", shots::whole(chance, &tree, &numbers))
            }
            ("glb", None) => ("damaged bytes", damage::bytes(chance, bytes, &other)),
            ("ron", _) => ("damaged scene", damage::text(chance, &bytes, &other)),
            _ => ("damaged obj", damage::text(chance, &bytes, &other)),
        },
    };
    let mut files = vec![named(&format!("a.{end}"), bytes)];
    files.extend(beside(&path));
    files.push(named("m.obj", small(chance)));
    (kind, files)
}

/// Small files in the same folder, which the damaged one may name.
fn beside(path: &Path) -> Files {
    let entries =
        path.parent().and_then(|folder| std::fs::read_dir(folder).ok()).into_iter().flatten().flatten();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.path()).filter(|other| other != path).collect();
    paths.sort();
    paths.retain(|other| {
        let is_read = ending(other).is_some_and(|end| READ.contains(&end));
        is_read && other.metadata().is_ok_and(|data| data.len() <= MOST_BYTES)
    });
    paths
        .iter()
        .take(20)
        .filter_map(|other| Some((other.file_name()?.to_str()?.to_owned(), std::fs::read(other).ok()?)))
        .collect()
}

/// The JSON and the binary data of a GLB file.
fn glb_parts(bytes: &[u8]) -> Option<(Value, Vec<u8>)> {
    let length = u32::from_le_bytes(bytes.get(12..16)?.try_into().ok()?) as usize;
    let tree = serde_json::from_slice(bytes.get(20..20 + length)?).ok()?;
    Some((tree, bytes.get(28 + length..).unwrap_or_default().to_vec()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_names_the_same_case_for_good() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the repository");
        let source = Source::read(root).expect("files");
        let mut kinds = std::collections::BTreeSet::new();
        for number in 0..60 {
            let [one, same, other] = [5, 5, 6].map(|seed| source.case(seed, number));
            assert!(one.files == same.files && one.commands == same.commands, "case {number}");
            assert!(one.files != other.files, "case {number}");
            kinds.insert(one.kind);
        }
        assert!(kinds.len() >= KINDS.len(), "{kinds:?}");
    }
}
