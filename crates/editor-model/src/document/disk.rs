//! A document and its files on disk: saving, reading again, and the copy of unsaved work.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use impasto_scene::assets::{AssetFolders, AssetRequest};
use impasto_scene::document::Scene;
use impasto_scene::loaded::LoadedScene;
use impasto_scene::problem::Report;
use impasto_scene::whole_file::failure_in_words;
use impasto_scene::{mesh_format, save};

use super::{Document, Step};
use crate::change::SceneChange;
use crate::recovery::{Copy, Work};
use crate::refusal::Refusal;
use crate::stamp::{self, Stamp};

/// Why a document was not saved.
#[derive(Debug, thiserror::Error)]
pub enum SaveError {
    /// The document has no file yet.
    #[error("this scene has no file yet: choose a name")]
    Unnamed,
    /// The scene would not find the files that it names if it were saved in the chosen folder.
    #[error("from {} the scene would not find {mesh:?}: save it in {}, or put the file there first", target.display(), folder.display())]
    FilesElsewhere {
        /// The file that was chosen.
        target: PathBuf,
        /// A file that the scene names.
        mesh: String,
        /// The folder that paths in the scene are relative to.
        folder: PathBuf,
    },
    /// The file could not be written.
    #[error("{} was not saved: {}", target.display(), failure_in_words(source))]
    Unwritable {
        /// The file.
        target: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The file was changed by another program since it was last read or saved here.
    #[error("{} was changed by another program since it was read", target.display())]
    ChangedOutside {
        /// The file.
        target: PathBuf,
    },
    /// Not all of the file could be read, and saving over it would lose the rest.
    #[error(
        "this scene has {count} problems left; saving over it would lose what could not be read (line {line}): save a copy"
    )]
    Problems {
        /// How many are left.
        count: usize,
        /// The line of the first one.
        line: usize,
    },
}

impl Document {
    /// Writes the scene to its file. At any moment the file on disk is whole: the old one or the new one.
    ///
    /// # Errors
    /// As [`Document::save_as`], and if there is no file yet, or another program has changed it.
    pub fn save(&mut self) -> Result<PathBuf, SaveError> {
        let file = self.file.clone().ok_or(SaveError::Unnamed)?;
        self.may_save_over(&file)?;
        if self.is_changed_outside() {
            return Err(SaveError::ChangedOutside { target: file });
        }
        self.save_as(&file)?;
        Ok(file)
    }

    /// As [`Document::save`], but also if another program has changed the file: that change is then overwritten.
    ///
    /// # Errors
    /// As [`Document::save_as`], and if there is no file yet.
    pub fn save_over(&mut self) -> Result<PathBuf, SaveError> {
        let file = self.file.clone().ok_or(SaveError::Unnamed)?;
        self.save_as(&file)?;
        Ok(file)
    }

    /// Whether the document's file has changed since it was last read or written here. A deleted file does not count,
    /// because saving would overwrite nothing.
    pub fn is_changed_outside(&self) -> bool {
        let is_other = |file: &PathBuf| Stamp::is_other(self.stamp.as_ref(), file) && file.exists();
        self.file.as_ref().is_some_and(is_other)
    }

    /// Writes the scene to a file, which is the document's own from then on. The history stays. Returns what
    /// [`Document::save_copy`] returns.
    ///
    /// # Errors
    /// As [`Document::save_copy`], and if `target` is the document's own file, parts of which could not be read.
    pub fn save_as(&mut self, target: &Path) -> Result<Vec<String>, SaveError> {
        self.may_save_over(target)?;
        let missing = self.save_copy(target)?;
        // Size and hash are those of the text written here, in case another program has already changed the file.
        let text = save::to_ron(self.scene());
        let written = |stamp| Stamp { bytes: text.len() as u64, hash: stamp::hash(text.as_bytes()), ..stamp };
        self.stamp = Stamp::of(target).map(written);
        self.file = Some(target.to_owned());
        self.loaded = Arc::new(LoadedScene { path: target.to_owned(), ..(*self.loaded).clone() });
        self.source = self.source.as_ref().and_then(|source| source.saved(text, self.scene())).map(Arc::new);
        self.history.mark_saved();
        Ok(missing)
    }

    fn may_save_over(&self, target: &Path) -> Result<(), SaveError> {
        let real = |path: &Path| path.canonicalize().unwrap_or_else(|_| path.to_owned());
        // If it is not known what a recovered copy lost, the copy has no `file`. Its `loaded.path` still names the file
        // that it came from, which must not be overwritten either.
        let is_own = real(target) == real(&self.loaded.path);
        match self.unread_parts().next().filter(|_| is_own) {
            Some(first) => Err(SaveError::Problems {
                count: self.unread_parts().count(),
                line: first.problem.place.map_or(1, |place| place.line),
            }),
            None => Ok(()),
        }
    }

    /// Writes the scene to another file; the document keeps its own. If `target` is in another folder, returns the
    /// files that the scene names but that are in neither folder.
    ///
    /// # Errors
    /// If a file that the scene names is in the scene's folder but not in that of `target`, or if writing fails.
    /// `target` is then untouched.
    pub fn save_copy(&self, target: &Path) -> Result<Vec<String>, SaveError> {
        let folder_of = |path: &Path| {
            let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
            let folder = folder.unwrap_or(Path::new("."));
            folder.canonicalize().unwrap_or_else(|_| folder.to_owned())
        };
        let mut missing = Vec::new();
        if folder_of(target) != folder_of(&self.loaded.path) {
            let is_there = |name: &&str| folder_of(target).join(name.trim().replace('\\', "/")).is_file();
            for name in self.files_named().filter(|name| !is_there(name)) {
                if self.file_at_hand(name).is_some() {
                    let (target, mesh, folder) =
                        (target.to_owned(), name.to_owned(), self.folder().to_owned());
                    return Err(SaveError::FilesElsewhere { target, mesh, folder });
                }
                missing.push(name.to_owned());
            }
        }
        let write = save::write(target, self.scene());
        write.map_err(|source| SaveError::Unwritable { target: target.to_owned(), source })?;
        Ok(missing)
    }

    /// The path of a file that the scene names; none if it is not in the scene's folder.
    pub fn file_at_hand(&self, name: &str) -> Option<PathBuf> {
        let root = self.folder();
        let beside = root.join("scene.ron");
        let request = AssetRequest { beside: &beside, root, name, max_bytes: u64::MAX };
        AssetFolders::default().find(&request).ok()
    }

    /// The files that the scene names, without built-in meshes.
    pub fn files_named(&self) -> impl Iterator<Item = &str> {
        let LoadedScene { scene, meshes, caches, textures, brushes, .. } = &*self.loaded;
        let of_meshes = meshes.keys().map(|name| mesh_format::file_and_node(name).0);
        let others = textures.keys().chain(brushes.keys()).chain(caches.keys()).chain(&scene.shot);
        let others = others.map(String::as_str);
        let names: BTreeSet<&str> = of_meshes.chain(others).collect();
        names.into_iter().filter(|name| !impasto_scene::built_in_mesh::is_built_in(name))
    }

    /// Reads the scene's file, and the files that it names, again. A difference becomes one entry of the history, so
    /// undo brings the edits back. If the file has errors, or there is no file, nothing changes.
    ///
    /// # Errors
    /// What is wrong with the file.
    pub fn reload(&mut self) -> Result<Step, Report> {
        let Some(file) = self.file.clone() else { return Ok(nothing()) };
        let read = Self::open(&file, &self.options)?;
        Ok(self.replace_by(read))
    }

    /// As [`Document::reload`], but reads as much as possible of a file with errors.
    ///
    /// # Errors
    /// If nothing can be read.
    pub fn read_again(&mut self) -> Result<Step, Report> {
        let Some(file) = self.file.clone() else { return Ok(nothing()) };
        let read = Self::open_with_problems(&file, &self.options)?;
        Ok(self.replace_by(read))
    }

    fn replace_by(&mut self, read: Self) -> Step {
        let change = SceneChange::between(self.scene(), read.scene());
        let sources = [self.source.clone(), read.source.clone()];
        let is_nothing = change.is_none() && sources.iter().all(Option::is_none);
        self.preview = None;
        (self.loaded, self.stamp, self.source) = (read.loaded, read.stamp, read.source);
        let before = self.selection.clone();
        self.select(before.clone());
        let text = if is_nothing { String::new() } else { "Read again".to_owned() };
        if !is_nothing {
            self.revision += 1;
            let selections = [before, self.selection.clone()];
            self.history.push(text.clone(), change.unwrap_or_default(), selections);
            self.history.mark_sources(sources);
        }
        self.history.mark_saved();
        Step { text, note: None }
    }

    /// Reads again the files that the scene names: shot, meshes, point caches and pictures. If the shot changes the
    /// scene, this makes an entry of the history, and the step's note says what came and went.
    ///
    /// # Errors
    /// What is wrong with the files, in the words to show. The scene then keeps the files as it read them before.
    pub fn read_files_again(&mut self) -> Result<Step, Refusal> {
        let scene = self.scene().without_shot();
        let (meshes, caches, textures, brushes) = Default::default();
        let (path, warnings) = (self.loaded.path.clone(), Vec::new());
        let files = Default::default();
        let bare =
            LoadedScene { path, scene: scene.clone(), meshes, caches, textures, brushes, files, warnings };
        let read = bare.with_scene(scene, &self.options.folders).map_err(|report| Refusal::of(&report))?;
        self.preview = None;
        let change = SceneChange::between(self.scene(), &read.scene);
        let note = self.scene().shot.as_ref().map(|shot| differences(shot, self.scene(), &read.scene));
        self.loaded = Arc::new(read);
        let Some(change) = change else { return Ok(nothing()) };
        let before = self.selection.clone();
        self.select(before.clone());
        self.revision += 1;
        let text = "Read the shot again".to_owned();
        let was_edited = self.is_edited();
        self.history.push(text.clone(), change, [before, self.selection.clone()]);
        // What comes from a shot is not saved in the scene file, so its change does not count as an unsaved edit.
        if !was_edited {
            self.history.mark_saved();
        }
        Ok(Step { text, note })
    }

    /// The paths of all files of the scene: the scene file, the files that it names, and the files that those name
    /// (materials, textures, buffers). The scene file is first. For each OBJ file, the MTL file of the same name is
    /// listed even if it does not exist.
    pub fn files_on_disk(&self) -> Vec<PathBuf> {
        let mut files: Vec<PathBuf> = self.file.iter().cloned().collect();
        let is_scene =
            |path: &Path| path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("ron"));
        files.extend(self.loaded.files.places().into_keys().filter(|path| !is_scene(path)));
        for name in self.files_named() {
            let path = self.folder().join(name.trim().replace('\\', "/"));
            if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("obj")) {
                files.push(path.with_extension("mtl"));
            }
            files.push(path);
        }
        let mut seen = BTreeSet::new();
        files.retain(|path| seen.insert(path.clone()));
        files
    }

    /// The unsaved work, for the recovery copy. If the user is editing the source text, that text is not included: the
    /// document does not know it.
    pub fn work(&self, at_unix_secs: u64) -> Work {
        let absolute = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
        let copy = Copy {
            file: self.file.as_deref().map(absolute),
            path: absolute(&self.loaded.path),
            stamp: self.stamp,
            at_unix_secs,
            changes: self.changes().max(usize::from(self.is_edited())),
            lossy: self.saving_loses(),
            text: String::new(),
            source: self.source.as_ref().map(|source| source.text.clone()),
            losses: self.source.as_ref().map(|source| source.losses_hash()),
            unread: None,
        };
        Work { copy, scene: Arc::clone(&self.loaded) }
    }
}

/// What came and went with a new export of a shot, in words to show.
fn differences(shot: &str, before: &Scene, after: &Scene) -> String {
    let names = |scene: &Scene| -> BTreeSet<String> {
        scene.objects.iter().map(|object| object.name.clone()).collect()
    };
    let (before, after) = (names(before), names(after));
    let listed = |names: Vec<&String>, what: &str| match names.len() {
        0 => None,
        1..=3 => {
            Some(format!("{what}: {}", names.iter().map(|name| name.as_str()).collect::<Vec<_>>().join(", ")))
        }
        many => Some(format!("{many} objects {what}")),
    };
    let changes = [
        listed(after.difference(&before).collect(), "new"),
        listed(before.difference(&after).collect(), "gone"),
    ];
    let changes: Vec<String> = changes.into_iter().flatten().collect();
    match changes.is_empty() {
        true => format!("{shot} was exported again, with the same objects"),
        false => format!("{shot} was exported again. {}", changes.join("; ")),
    }
}

fn nothing() -> Step {
    Step { text: String::new(), note: None }
}
