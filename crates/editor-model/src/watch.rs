//! Notices when files of the document change on disk, by polling their size and time.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use crate::document::Document;

/// Size and time of a file; none if it does not exist.
type SizeAndTime = Option<(u64, Option<SystemTime>)>;

/// The files of a document, as they were at the last poll.
#[derive(Debug, Default)]
pub struct Watch {
    files: BTreeMap<PathBuf, Watched>,
}

#[derive(Debug)]
struct Watched {
    /// Size and time when the file was first polled, or when its last change was found complete.
    known: SizeAndTime,
    /// Size and time at the last poll, if they differ from `known`: the file may still be being written.
    seen: Option<SizeAndTime>,
}

/// What changed on disk.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum News {
    /// Files that the scene uses, such as meshes, pictures or the shot.
    Files,
    /// The scene file itself, changed by another program.
    Scene,
}

impl Watch {
    /// Polls the document's files once. A changed file is reported only when two polls find it the same, because before
    /// that it may still be being written. Files that are new to the document are not reported.
    pub fn look(&mut self, document: &Document) -> Option<News> {
        let paths = document.files_on_disk();
        self.files.retain(|path, _| paths.contains(path));
        let mut news = None;
        for path in paths {
            let now = size_and_time(&path);
            let Some(watched) = self.files.get_mut(&path) else {
                self.files.insert(path, Watched { known: now, seen: None });
                continue;
            };
            if now == watched.known {
                watched.seen = None;
            } else if watched.seen != Some(now) {
                watched.seen = Some(now);
            } else {
                *watched = Watched { known: now, seen: None };
                let of_scene = document.file() == Some(&path);
                if !of_scene {
                    news = news.max(Some(News::Files));
                } else if document.is_changed_outside() {
                    news = news.max(Some(News::Scene));
                }
            }
        }
        news
    }
}

fn size_and_time(path: &Path) -> SizeAndTime {
    let metadata = std::fs::metadata(path).ok().filter(std::fs::Metadata::is_file)?;
    Some((metadata.len(), metadata.modified().ok()))
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;
    use crate::command::{Command, SceneEdit};

    const SCENE: &str = "(version: 1, camera: (keys: [(frame: 0, eye: (0, 1, 4), target: (0, 0, 0))]), \
        objects: [(name: \"leaf\", mesh: \"leaf.obj\")])";
    const QUAD: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n";

    /// A TGA file of one pixel with this red.
    fn pixel(red: u8) -> Vec<u8> {
        let mut bytes = vec![0; 18];
        (bytes[2], bytes[12], bytes[14], bytes[16]) = (2, 1, 1, 24);
        bytes.extend([0, 0, red]);
        bytes
    }

    #[test]
    fn what_meshes_name_is_watched_too() {
        let folder = tempfile::tempdir().expect("a folder");
        let at = |name: &str| folder.path().join(name);
        fs::write(at("s.ron"), SCENE).expect("written");
        fs::write(at("leaf.obj"), format!("mtllib of_leaves.mtl\nusemtl m\n{QUAD}")).expect("written");
        fs::write(at("of_leaves.mtl"), "newmtl m\nmap_Kd veins.tga\n").expect("written");
        fs::write(at("veins.tga"), pixel(1)).expect("written");
        let document = Document::open(&at("s.ron"), &Default::default()).expect("opens");
        assert!(document.loaded().warnings.is_empty(), "{:?}", document.loaded().warnings);
        let mut watch = Watch::default();
        assert_eq!(watch.look(&document), None);
        for (name, bytes) in [
            ("of_leaves.mtl", b"newmtl m\nKd 1 0 0\nmap_Kd veins.tga\n".to_vec()),
            ("veins.tga", [pixel(200), vec![0]].concat()),
        ] {
            fs::write(at(name), bytes).expect("written");
            assert_eq!([watch.look(&document), watch.look(&document)], [None, Some(News::Files)], "{name}");
        }
    }

    #[test]
    fn changes_by_other_programs_are_reported_once_the_file_is_complete() {
        let folder = tempfile::tempdir().expect("a folder");
        let [scene, mesh] = ["s.ron", "leaf.obj"].map(|name| folder.path().join(name));
        fs::write(&scene, SCENE).expect("written");
        fs::write(&mesh, QUAD).expect("written");
        let mut document = Document::open(&scene, &Default::default()).expect("opens");
        let mut watch = Watch::default();
        assert_eq!([watch.look(&document), watch.look(&document)], [None, None]);
        fs::write(&mesh, format!("{QUAD}# more\n")).expect("written");
        assert_eq!(watch.look(&document), None, "it may be half written");
        fs::write(&mesh, format!("{QUAD}# more and more\n")).expect("written");
        assert_eq!(watch.look(&document), None);
        assert_eq!([watch.look(&document), watch.look(&document)], [Some(News::Files), None]);
        // What the document itself saves is not reported.
        document.apply(&Command::Scene(SceneEdit::SetSeed(5))).expect("done");
        document.save().expect("saved");
        assert_eq!([watch.look(&document), watch.look(&document)], [None, None]);
        fs::write(&scene, format!("{SCENE} ")).expect("written");
        assert_eq!([watch.look(&document), watch.look(&document)], [None, Some(News::Scene)]);
        assert_eq!(watch.look(&document), None, "a change is reported once");
        // The files of another document are new, so they are not reported.
        let other = Document::empty(folder.path());
        assert_eq!([watch.look(&other), watch.look(&document)], [None, None]);
    }
}
