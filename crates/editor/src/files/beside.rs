//! Copies a scene's files along when it is saved into another folder.

use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufRead as _, BufReader};
use std::path::{Path, PathBuf};

use impasto_scene::assets::{AssetFolders, AssetRequest};
use impasto_scene::mesh_format;
use impasto_scene::whole_file::{WholeFile, failure_in_words};

use super::incoming::Kind;

/// The files to copy, each under its path relative to the scene's folder.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Copies {
    files: BTreeMap<PathBuf, PathBuf>,
}

/// Why files were not copied. Existing files are untouched, and copies that were made are removed again.
#[derive(Debug, thiserror::Error)]
pub enum CopyError {
    /// The target folder has a different file of the same name.
    #[error("{} has another {}: choose another folder", folder.display(), name.display())]
    InTheWay {
        /// The file's path relative to either folder.
        name: PathBuf,
        /// The folder that was chosen.
        folder: PathBuf,
    },
    /// A file could not be read or written.
    #[error("{} could not be copied: {}", name.display(), failure_in_words(source))]
    Failed {
        /// Its path relative to the scene's folder.
        name: PathBuf,
        /// What the system said.
        source: io::Error,
    },
}

impl Copies {
    /// The files to copy from `from` to `to`: the files `names` of a scene, and the files that its meshes name in turn.
    /// Files outside `from`, missing files, and files that `to` has already are left out.
    ///
    /// # Errors
    /// If `to` has a different file of the same name.
    pub fn between<'a>(
        from: &Path,
        to: &Path,
        names: impl Iterator<Item = &'a str>,
    ) -> Result<Self, CopyError> {
        let root = std::fs::canonicalize(from).unwrap_or_else(|_| from.to_owned());
        let beside = root.join("scene.ron");
        let mut files = BTreeMap::new();
        for name in names {
            let request = AssetRequest { beside: &beside, root: &root, name, max_bytes: u64::MAX };
            let Ok(file) = AssetFolders::default().find(&request) else { continue };
            if Kind::of(&file) == Some(Kind::Mesh) {
                let named = mesh_format::companions(&file, &root).unwrap_or_default();
                for companion in named {
                    if let Ok(within) = companion.strip_prefix(&root) {
                        files.insert(within.to_owned(), companion.clone());
                    }
                }
            }
            files.insert(PathBuf::from(name.trim().replace('\\', "/")), file);
        }
        let mut copies = Self::default();
        for (name, file) in files {
            let target = to.join(&name);
            if std::fs::symlink_metadata(&target).is_err() {
                copies.files.insert(name, file);
            } else if !is_same(&file, &target) {
                return Err(CopyError::InTheWay { name, folder: to.to_owned() });
            }
        }
        Ok(copies)
    }

    /// How many files there are.
    pub fn count(&self) -> usize {
        self.files.len()
    }

    /// Copies the files into the folder `to`. No file is overwritten.
    ///
    /// # Errors
    /// The first file that could not be copied; the copies before it are removed again.
    pub fn carry_out(&self, to: &Path) -> Result<(), CopyError> {
        let mut written = Vec::new();
        for (name, file) in &self.files {
            let target = to.join(name);
            if let Err(source) = copy(file, &target) {
                for path in written {
                    // A copy that cannot be removed does no harm.
                    let _left = std::fs::remove_file(path);
                }
                return Err(CopyError::Failed { name: name.clone(), source });
            }
            written.push(target);
        }
        Ok(())
    }
}

/// Opens a regular file, to be read piece by piece: a point cache may be larger than the memory.
fn opened(file: &Path) -> io::Result<BufReader<File>> {
    let metadata = std::fs::metadata(file)?;
    if !metadata.is_file() || metadata.len() > mesh_format::max_bytes(file) {
        return Err(io::Error::other("it is no regular file, or too large"));
    }
    File::open(file).map(|file| BufReader::with_capacity(1 << 16, file))
}

fn is_same(a: &Path, b: &Path) -> bool {
    let equal = || -> io::Result<bool> {
        let (mut a, mut b) = (opened(a)?, opened(b)?);
        loop {
            let count = {
                let (here, there) = (a.fill_buf()?, b.fill_buf()?);
                let count = here.len().min(there.len());
                if here.is_empty() || there.is_empty() {
                    return Ok(here.is_empty() && there.is_empty());
                }
                if here[..count] != there[..count] {
                    return Ok(false);
                }
                count
            };
            a.consume(count);
            b.consume(count);
        }
    };
    equal().unwrap_or(false)
}

/// Copies one file. Fails if `target` has appeared in the meantime.
fn copy(file: &Path, target: &Path) -> io::Result<()> {
    if let Some(folder) = target.parent() {
        std::fs::create_dir_all(folder)?;
    }
    let mut copy = WholeFile::create(target)?;
    io::copy(&mut opened(file)?, &mut copy)?;
    copy.finish_new()
}

#[cfg(test)]
mod tests {
    use impasto_editor_model::Document;
    use impasto_scene::load::LoadOptions;

    use super::*;

    #[test]
    fn files_are_the_same_only_to_their_last_byte() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, bytes: &[u8]| {
            let path = folder.path().join(name);
            std::fs::write(&path, bytes).unwrap();
            path
        };
        let long = vec![7u8; 200_000];
        let mut other = long.clone();
        other[199_999] = 8;
        let [a, b, c, d] = [("a", &long[..]), ("b", &long), ("c", &other), ("d", &long[1..])]
            .map(|(name, bytes)| write(name, bytes));
        assert!(is_same(&a, &b) && !is_same(&a, &c) && !is_same(&a, &d) && !is_same(&d, &a));
        assert!(!is_same(&a, folder.path()));
    }

    const OBJ: &str = "mtllib a.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    const SCENE: &str = r#"(version: 1, size: (64, 36),
        camera: (lens: Perspective(fov_y_deg: 35), keys: [(frame: 0, eye: (0, 0, 4), target: (0, 0, 0))]),
        objects: [(name: "a", mesh: "meshes/a.obj")], regions: [])"#;

    fn scene() -> (tempfile::TempDir, Document) {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("meshes")).unwrap();
        let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
        write("meshes/a.obj", OBJ);
        write("meshes/a.mtl", "newmtl m\nKd 1 0 0\n");
        write("meshes/other.obj", OBJ);
        write("s.ron", SCENE);
        let document = Document::open(&folder.path().join("s.ron"), &LoadOptions::default()).unwrap();
        (folder, document)
    }

    fn between(document: &Document, to: &Path) -> Result<Copies, CopyError> {
        Copies::between(document.folder(), to, document.files_named())
    }

    #[test]
    fn a_scene_is_whole_in_another_folder() {
        let (_folder, mut document) = scene();
        let to = tempfile::tempdir().unwrap();
        let target = to.path().join("t.ron");
        assert!(document.save_as(&target).is_err(), "saved, though its mesh is not in the other folder");
        let copies = between(&document, to.path()).unwrap();
        assert_eq!(copies.count(), 2, "the mesh and its materials, and nothing else: {copies:?}");
        copies.carry_out(to.path()).unwrap();
        document.save_as(&target).unwrap();
        assert!(!to.path().join("meshes/other.obj").exists());
        let there = Document::open(&target, &LoadOptions::default()).unwrap();
        assert_eq!(there.loaded().meshes["meshes/a.obj"].materials.len(), 1);
        assert_eq!(between(&document, to.path()).unwrap().count(), 0, "they are there already");
    }

    #[test]
    fn a_missing_mesh_does_not_prevent_saving() {
        let (folder, mut document) = scene();
        std::fs::remove_file(folder.path().join("meshes/a.obj")).unwrap();
        let to = tempfile::tempdir().unwrap();
        assert_eq!(between(&document, to.path()).unwrap().count(), 0, "there is nothing to copy");
        let missing = document.save_as(&to.path().join("t.ron")).expect("saved without asking");
        assert_eq!(missing, ["meshes/a.obj"]);
    }

    #[test]
    fn names_with_backslashes_are_taken_along() {
        let (folder, _) = scene();
        let path = folder.path().join("s.ron");
        std::fs::write(&path, SCENE.replace("meshes/a.obj", "meshes\\\\a.obj")).unwrap();
        let mut document = Document::open(&path, &LoadOptions::default()).unwrap();
        let to = tempfile::tempdir().unwrap();
        between(&document, to.path()).unwrap().carry_out(to.path()).unwrap();
        document.save_as(&to.path().join("t.ron")).unwrap();
        Document::open(&to.path().join("t.ron"), &LoadOptions::default()).expect("whole there");
    }

    #[test]
    fn nothing_is_written_over() {
        let (_folder, document) = scene();
        let to = tempfile::tempdir().unwrap();
        std::fs::create_dir(to.path().join("meshes")).unwrap();
        let others = to.path().join("meshes/a.mtl");
        std::fs::write(&others, "newmtl other\n").unwrap();
        let words = between(&document, to.path()).unwrap_err().to_string();
        assert!(words.contains("a.mtl") && words.contains("choose another folder"), "{words}");

        // A file that appears after the check.
        std::fs::remove_file(&others).unwrap();
        let copies = between(&document, to.path()).unwrap();
        std::fs::write(to.path().join("meshes/a.obj"), "mine").unwrap();
        assert!(copies.carry_out(to.path()).is_err());
        assert_eq!(std::fs::read_to_string(to.path().join("meshes/a.obj")).unwrap(), "mine");
        assert!(!others.exists(), "what was copied before is gone again");
    }
}
